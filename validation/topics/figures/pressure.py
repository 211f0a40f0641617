"""The figures of `validation.topics.pressure`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found
from validation.topics.pressure import PROMISE


def figures(found: Found) -> Iterator[Figure]:
    drawing, ax = axes()
    draw(ax, found.curves("certificate"), floor=1e-18)
    ax.axhline(PROMISE, color="tab:red", linewidth=1)
    labelled(ax, "case, in the order of the table", "error of the pressure / peak", log="y")
    legend(ax)
    yield Figure(
        "certificate", drawing,
        "The true error of each case, and the certificate's estimate, which does not use the "
        "truth. The line is the promise, 1e-13."
    )  # fmt: skip
