"""The figures of `validation.topics.collocation`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    for key, x, y, caption in (
        (
            "ligament",
            "ligament / length of the cracks",
            "relative error",
            "Two collinear cracks that nearly touch, against 40 digits.",
        ),
        (
            "layer",
            "unknowns n",
            "time [s]",
            "A thin layer: the time that the system takes.",
        ),
    ):
        drawing, ax = axes()
        draw(ax, found.curves(key), floor=1e-17)
        labelled(ax, x, y, log="xy")
        legend(ax)
        yield Figure("collocation-" + key, drawing, caption)
