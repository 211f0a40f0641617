"""The figures of `validation.topics.histories`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    drawing, (loop, zones) = axes(2)
    draw(loop, found.curves("loop"))
    labelled(loop, "rigid shift / R", "Q/(fP)", "Q and σ out of phase")
    loop.locator_params(axis="x", nbins=5)
    legend(loop)
    for curve in found.curves("zones"):
        stick = curve.label == "stick zone"
        zones.plot(curve.x, curve.y, color="tab:blue" if stick else "0.5")
    for label, color in (("contact", "0.5"), ("stick zone", "tab:blue")):
        zones.plot([], [], color=color, label=label)
    labelled(zones, "steps of the path", "x / half-width", "P, Q and σ in phase")
    zones.locator_params(axis="x", integer=True)
    legend(zones, loc="center")
    yield Figure(
        "histories",
        drawing,
        "Hertz. Above: Q against the rigid shift while the bulk stress runs a quarter of a cycle "
        "behind; the area is not the energy lost, since the bulk stress does work too. Below: ends "
        "of contact and stick zone while P, Q and bulk stress rise and fall together; after each "
        "turn slip starts at the edges anew.",
    )
