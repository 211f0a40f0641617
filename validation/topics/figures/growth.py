"""The figures of `validation.topics.growth`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import HEIGHT, Figure, axes, draw, labelled, legend_above
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    for name, label in (("time", "time [ms]"), ("memory", "peak of memory taken [MiB]")):
        drawing, ax = axes(height=HEIGHT + 0.8, head=1.2)
        draw(ax, found.curves(name))
        labelled(ax, "n", label, log="xy")
        legend_above(ax, 1)
        yield Figure(
            "growth-" + name,
            drawing,
            f"{label.split(' [')[0].capitalize()} against size; a slope of one is linear growth.",
        )
