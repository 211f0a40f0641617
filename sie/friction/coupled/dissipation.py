"""Energy that dissimilar bodies dissipate while P grows on a symmetric profile.

With φ and ĝ of the flat punch (`functions`), the load P'(s) ds lets every place slip by
2/E* P'(s) ĝ(x/s) ds under the pressure ∫P'(r) φ(x/r) dr/r of all narrower contacts, so that

    W = 4f/E* ∫∫ P'(r) P'(s) K(r/s) ds dr,   r < s < min(b, r/c),     K(ρ) = ∫ φ(u) ĝ(ρ u) du,

over c/ρ < u < 1. K is that of β and f alone, smooth for ρ < 1, next to 1 with broken powers of
1 - ρ. The integral over s is one of `profile`, smooth between the places where p or q is not.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .functions import FlatFunctions
from .panels import graded, totals
from .tables import Table

Array = NDArray[np.float64]

# Parts of 1 - c^(1/2), within which K hardly varies, and of the interval, to a singularity
RESOLVED, NEAREST = 1e-6, 1e-17


def tables_of_pair(flat: FlatFunctions) -> tuple[Table, Table]:
    """K beyond and before c^(1/2)."""
    middle, beyond = flat.middle, flat.beyond

    def K(rho: Array, e: Array) -> Array:
        return work_of_pair(flat, rho, e)

    edge = Table((middle, beyond), (1.0, 0.0), (middle, RESOLVED * beyond), K)
    return edge, Table((flat.c, flat.rest), (middle, beyond), (flat.c, beyond), K)


def work_of_pair(flat: FlatFunctions, rho: Array, e: Array) -> Array:
    """K at rho = 1 - e."""
    over = (flat.rest - e if flat.c > 0.5 else rho - flat.c) / rho
    nearest = NEAREST * over
    before, after = np.maximum(flat.c * e / rho, nearest), np.maximum(e / rho, nearest)
    owner, ahead, left, weight = graded(over, before, after, (1.0 + flat.h, -flat.h))
    rho, e, gap = (column[owner][:, None] for column in (rho, e, flat.c * e / rho))
    u, t = 1.0 - left, rho * (1.0 - left)
    p = flat.pressure(u.ravel(), left.ravel(), (gap + ahead).ravel())
    g = flat.slip(t.ravel(), (e + rho * left).ravel(), (rho * ahead).ravel())
    return totals(owner, (p * g).reshape(u.shape) * weight, len(over))
