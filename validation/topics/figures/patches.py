"""The figures of `validation.topics.patches`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import HEIGHT, Figure, axes, draw, labelled, legend, legend_above
from validation.harness.records import Found

FIGURES = (
    ("gaps", "gap / patch", "error", "xy", "Errors of edges and pressure while a gap closes."),
    (
        "events",
        "distance of the load from the event / load",
        "width",
        "xy",
        "Next to an event: the patch that has just appeared, and the gap before two patches merge.",
    ),
    (
        "events: pressure",
        "x",
        "p/E*",
        "",
        "A wavy punch in three patches; the narrowest appeared a little below this load.",
    ),
    ("wave", "x/λ", "p/E*", "", "Westergaard's wave from first touch to full contact."),
    ("rough", "x", "height", "", "A rough profile, and the surface that it presses down."),
    ("rough: pressure", "x", "p/E*", "", "The pressure on all patches of the rough profile."),
    (
        "rough: patch",
        "x",
        "p/E*",
        "",
        "The patch of the largest load, by this package and on a grid.",
    ),
    (
        "rough: race",
        "time [s]",
        "largest error / peak",
        "xy",
        "The rough profile by this package and by codes that work on grids.",
    ),
    ("growth", "points", "time [s]", "xy", "Rough profiles at a fixed density of patches."),
)


def figures(found: Found) -> Iterator[Figure]:
    for key, x, y, log, caption in FIGURES:
        curves = found.curves(key)
        many = len(curves) > 3
        drawing, ax = axes(height=HEIGHT + 0.6, head=0.9) if many else axes()
        draw(ax, curves, floor=1e-17 if "y" in log else None)
        labelled(ax, x, y, log=log)
        (legend_above(ax, 2) if many else legend(ax)) if len(curves) > 1 else None
        yield Figure("patches-" + key.replace(": ", "-"), drawing, caption)
