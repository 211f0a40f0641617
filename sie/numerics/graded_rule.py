"""Composite Gauss-Legendre on panels that shrink towards what is singular.

Each panel is GRADING times as long as its neighbour away from the singular place e, so that it is
a third of its own length away from it. NODES nodes then leave 3**-32, which is rounding, of
|x - e|^a and of ln|x - e|; on the last panel, of length l, about (l/NODES²)^(a+1).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import chebyshev

Array = NDArray[np.float64]

NODES = 16
GRADING = 0.25


def graded(levels: int) -> Array:
    """Ends of panels towards 0, as fractions of the longest, ascending: GRADING**levels first."""
    return GRADING ** np.arange(float(levels), 0.0, -1.0)


def on_panels(cuts: Array) -> tuple[Array, Array]:
    """Nodes and weights between consecutive cuts, (panels, NODES)."""
    g, w = chebyshev.gauss_legendre(NODES)
    length = np.diff(cuts)[:, None]
    return cuts[:-1, None] + length * g, length * w


def balanced(cuts: Array) -> Array:
    """The cuts, with panels halved until none is longer than 1/GRADING times its neighbours.

    What is singular on a neighbouring panel is then far enough.
    """
    while True:
        length = np.diff(cuts)
        shortest = np.minimum(
            np.concatenate(([np.inf], length[:-1])), np.concatenate((length[1:], [np.inf]))
        )
        long = length > 1.01 * shortest / GRADING
        if not long.any():
            return cuts
        cuts = np.sort(np.concatenate((cuts, 0.5 * (cuts[:-1] + cuts[1:])[long])))
