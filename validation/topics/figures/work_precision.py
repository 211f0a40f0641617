"""The figures of `validation.topics.work_precision`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    for key in found.keys("race: "):
        curves = found.curves(key)
        drawing, ax = axes()
        draw(ax, curves, floor=1e-17)
        labelled(ax, "time [ms]", "error / peak", key.removeprefix("race: "), log="xy")
        ax.set_ylim(1e-17, 10)
        legend(ax)
        name = "".join(c if c.isalnum() else "-" for c in key)
        yield Figure(
            name,
            drawing,
            f"{curves[0].about['says']}. Each mark is one size; lower and further left is better.",
        )
