"""The figures of `validation.topics.sliding`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found
from validation.topics.sliding import SLIDERS


def figures(found: Found) -> Iterator[Figure]:
    for slider in SLIDERS:
        caption = (
            f"Pressure under a sliding {slider.name}, βf from 0 to 0.49, friction on the "
            "half-plane towards +x."
        )
        yield _pressures(found, f"p: {slider.name}", "x / length unit", "r p/P", caption)
    yield _pressures(
        found,
        "bonded",
        "x/b",
        "traction · b/P",
        "Bonded flat punch, β = 0.3, Q = -0.4 P, free to tilt.",
    )


def _pressures(found: Found, key: str, x: str, y: str, caption: str) -> Figure:
    drawing, ax = axes()
    curves = found.curves(key)
    draw(ax, curves)
    for curve in found.curves(key + " points"):
        ax.plot(curve.x, curve.y, ".", color="tab:red", ms=4.5, zorder=3)
    labelled(ax, x, y)
    lowest = min(0.0, *(min(c.y) for c in curves))
    ax.set_ylim(max(lowest, -1.2) * 1.05, min(1.3, 1.1 * max(max(c.y) for c in curves)))
    legend(ax)
    name = "".join(c if c.isalnum() else "-" for c in key)
    return Figure("sliding-" + name, drawing, caption + " Lines: solver; red: closed form.")
