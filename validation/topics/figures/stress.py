"""The figures of `validation.topics.stress`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found
from validation.topics.stress import BAR


def figures(found: Found) -> Iterator[Figure]:
    drawing, ax = axes()
    draw(ax, found.curves("depth"), floor=1e-17)
    ax.axhline(BAR, color="tab:red", linewidth=0.8)
    labelled(ax, "depth / b", "error of the stress / peak pressure", log="xy")
    if len(found.curves("depth")) < 6:
        legend(ax)
    yield Figure(
        "stress-depth",
        drawing,
        "Each case of the table, from next to the surface to far away. The line is the bar, 1e-13.",
    )
