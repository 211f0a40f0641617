"""The figures of `validation.topics.economy`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from validation.harness.drawing import Figure, axes, labelled, legend_above
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    saving, bare = found.curves("economy")
    drawing, ax = axes(height=3.0, head=0.4)
    place = np.array(saving.y, dtype=float)
    ax.set_yticks(place, saving.about["names"])
    ax.invert_yaxis()
    labelled(ax, "solve, 1001 pressures and shears [ms]", "", log="x")
    for curve, aside in ((saving, -0.18), (bare, 0.18)):
        ax.barh(place + aside, curve.x, height=0.34, label=curve.label)
    legend_above(ax, 2)
    yield Figure(
        "economy",
        drawing,
        "Time with what the plan skips, and with all of it computed. The answers are the same to "
        "rounding.",
    )
