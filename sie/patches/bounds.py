"""Lower bounds of polynomials on panels, by which p >= 0 and gap >= 0 are verified.

A Legendre series on a panel is nowhere below c_0 - Σ|c_n|. A panel whose bound decides nothing is
halved.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

Array = NDArray[np.float64]

NODES = 8  # on a part of a panel
DEEPEST = 30  # halvings
TENSION = 1e-13  # of the largest D: rounding
# half-widths of the narrower patch beside it: a gap that edges in doubles do not tell from none
CLOSED = 2.5e-11


@lru_cache(maxsize=8)
def legendre(n: int) -> Array:
    """Values at the n Gauss nodes to Legendre coefficients, as a matrix (n, n)."""
    g, w = chebyshev.gauss_legendre(n)
    P = np.polynomial.legendre.legvander(2.0 * g - 1.0, n - 1)
    matrix = P * w[:, None] * (2.0 * np.arange(n) + 1.0)
    matrix.flags.writeable = False
    return matrix


def halves(lo: Array, hi: Array) -> tuple[Array, Array]:
    """The ends of the left halves of parts, then those of the right ones."""
    middle = 0.5 * (lo + hi)
    return np.concatenate((lo, middle)), np.concatenate((middle, hi))


def lower_bound(values: Array) -> Array:
    """Below all of a polynomial that has these values (m, n) at Gauss nodes."""
    c = values @ legendre(values.shape[1])
    return np.asarray(c[:, 0] - np.abs(c[:, 1:]).sum(axis=1))
