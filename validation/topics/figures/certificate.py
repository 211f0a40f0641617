"""The figures of `validation.topics.certificate`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Curve, Found


def figures(found: Found) -> Iterator[Figure]:
    drawing, ax = axes()
    curves = found.curves("judged")
    for curve in curves:
        ax.plot(
            np.maximum(curve.x, 1e-18), curve.y, "o", ms=2.5, label=curve.label, alpha=0.6, mew=0
        )
    line = np.array([1e-18, 1e-1])
    draw(
        ax,
        [Curve("", "a third of the true error", line, line / 3, "dashed", {"colour": "tab:red"})],
    )
    labelled(ax, "true error of the pressure / peak", "the certificate's estimate", log="xy")
    legend(ax)
    yield Figure(
        "judged", drawing,
        "Each dot is a random contact. Below the line the estimate would be too small. "
        "Errors of zero are drawn at 1e-18.",
    )  # fmt: skip
