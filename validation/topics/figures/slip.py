"""The figures of `validation.topics.slip`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import HEIGHT, Figure, axes, draw, labelled, legend, legend_above
from validation.harness.records import Found
from validation.topics.slip import BAR, CONTACTS


def figures(found: Found) -> Iterator[Figure]:
    drawing, ax = axes(height=HEIGHT + 0.8, head=1.2)
    draw(ax, found.curves("loading"), floor=1e-18)
    ax.axhline(BAR, color="tab:red", linewidth=0.8)
    labelled(ax, "decades of (Q/fP)/(1 - Q/fP)", "error / largest value", log="y")
    legend_above(ax, 1)
    yield Figure(
        "slip-loading",
        drawing,
        "First loading, from next to no slip to next to sliding. The line: the bar, 1e-13. What "
        "ulps explain is drawn at 1e-18.",
    )
    for contact in CONTACTS:
        yield _shears(
            found,
            f"turns: {contact.name}",
            "x/R",
            "q R/(f P)",
            f"Shear of the {contact.name} contact in loading, unloading and reloading.",
        )
    yield _shears(
        found,
        "bulk",
        "x/b",
        "q R/(f P)",
        "Hertz under Q = 0.6 fP and a bulk stress that rises with it.",
    )
    drawing, ax = axes()
    draw(ax, found.curves("loops"))
    labelled(ax, "shift between the bodies / R", "Q/(fP)")
    ax.locator_params(axis="x", nbins=5)
    legend(ax)
    yield Figure(
        "slip-loops",
        drawing,
        "Rounded flat: Q over the shift beyond the elastic one, first loading left out; the area "
        "is the energy lost.",
    )


def _shears(found: Found, key: str, x: str, y: str, caption: str) -> Figure:
    drawing, ax = axes()
    draw(ax, found.curves(key))
    for curve in found.curves(key + " points"):
        ax.plot(curve.x, curve.y, ".", color="tab:red", ms=4.5, zorder=3)
    labelled(ax, x, y)
    legend(ax)
    name = "".join(c if c.isalnum() else "-" for c in key)
    return Figure("slip-" + name, drawing, caption + " Lines: solver; red: closed form.")
