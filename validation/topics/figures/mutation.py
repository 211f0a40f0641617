"""The figure of `validation.topics.mutation`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from validation.harness.drawing import Figure, axes, labelled, legend_above
from validation.harness.records import Found
from validation.wrong_programs.mutants import BAR


def figures(found: Found) -> Iterator[Figure]:
    wrong, right = found.curves("mutants")
    drawing, ax = axes(height=0.2 * len(wrong.x) + 1.2, head=0.4)
    for curve, marker, colour in ((wrong, "x", "tab:red"), (right, "o", "tab:green")):
        ax.plot(
            np.clip(np.array(curve.y, dtype=float), 1e-17, 1e3),
            curve.x,
            marker,
            color=colour,
            mfc="none",
            label=curve.label,
        )
    ax.set_yticks(wrong.x, wrong.about["names"])
    ax.set_ylim(len(wrong.x) - 0.3, -0.7)
    ax.axvline(BAR, color="black", linewidth=0.8)
    labelled(ax, "what the checker measures", "", log="x")
    ax.set_xticks([1e-15, 1e-10, 1e-5, 1.0])
    legend_above(ax, 2)
    yield Figure(
        "mutants",
        drawing,
        "Each wrong program beside the right one, by the same checker; the line is the bar, 1e-13.",
    )
