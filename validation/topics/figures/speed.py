"""The figures of `validation.topics.speed`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, labelled
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    (ratios,) = found.curves("ratio")
    drawing, ax = axes(height=0.9 + 0.19 * len(ratios.y))
    ax.plot(ratios.x, ratios.y, "o", markersize=4)
    ax.set_yticks(list(ratios.y), ratios.about["names"])
    ax.invert_yaxis()
    labelled(ax, "time over that of the closed form (32)", "", log="x")
    yield Figure(
        "ratio",
        drawing,
        "Solving a case and 1001 pressures, as a multiple of 1001 values of the rounded punch's "
        "formula.",
    )
