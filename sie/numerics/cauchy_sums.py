"""Fast sums Σ_j q_j / (t_j - z), many sources t_j on the line and many targets z in the plane.

The sources come in rows, one for each piece of a slope. The nodes of their `tree` serve the targets
far from them, and the caller computes the pairs (row, target) that are left exactly. For a node
with middle c, half-length a and moments A_n = Σ q_j T_n((t_j - c)/a), with s = (z - c)/a and ρ = s
+ sqrt(s-1) sqrt(s+1),

    Σ q_j / (z - t_j) = 2 / (a sqrt(s-1) sqrt(s+1)) [A_0/2 + Σ_{n>=1} A_n ρ^-n]

as the integral over the sources of the generating function of T_n (Mason & Handscomb, Chebyshev
Polynomials, 2003, eq. (1.51)).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import counted

from . import chebyshev
from .chord import Points
from .tree import CHARGES, POINTS, Level, Tree

Array = NDArray[np.float64]
Index = NDArray[np.int64]

SEPARATED = 2.0  # half-lengths: from fewer, by far, no row is served
CHUNK = 1 << 14  # targets taken at a time: what is held then fits into a cache


class KernelSums:
    """The sums over one set of sources.

    Rows [lo, lo + length], shape (K,), have sources at lo + offset; offsets and charges are (K, n).
    """

    def __init__(self, lo: Array, length: Array, offset: Array, charge: Array) -> None:
        owner = np.zeros(len(lo), dtype=np.int64)
        self.tree = Tree((lo, lo + length), owner, Points(lo[:, None], offset), charge[None])

    def far(self, z: Any) -> tuple[Any, Index, Index]:
        """(Σ q/(t - z) over all sources far from each target, rows k, targets i).

        The pairs (k, i) are the rows near a target, which the sum leaves out.
        """
        (total,), row, target = self._sums(z, 1)
        return total, row, target

    def far_pair(self, z: Any) -> tuple[Any, Any, Index, Index]:
        """The same with Σ q/(t - z)², the derivative, after the first."""
        (total, steep), row, target = self._sums(z, 2)
        return total, steep, row, target

    def _sums(self, z: Any, powers: int) -> tuple[list[Any], Index, Index]:
        def away(level: Level, node: Index, target: Index) -> Array:
            return np.asarray(np.abs(z[target] - level.middle[node]))

        found, totals = self.tree.split(len(z), away), [np.zeros_like(z) for _ in range(powers)]
        for level, node, target in found.far:
            s, half = (z[target] - level.middle[node]) / level.half[node], level.half[node]
            root = _root(s)
            A, w, size = MOMENTS @ level.charges[0].T, 1.0 / (s + root), half * root
            S = _series(A, node, w)
            add_pairs(totals[0], target, S / size)
            for steep in totals[1:]:  # -(w S' + S s/root) / (half root)², S(w) the series
                turned = _steep_series(A, node, w) + S * (s / root)
                add_pairs(steep, target, -turned / (size * size))
        return totals, found.row, found.group


MOMENTS = chebyshev.polynomials(CHARGES, POINTS)


def _root(s: Any) -> Any:
    """sqrt(s - 1) sqrt(s + 1), with the sign of s on the line."""
    if np.iscomplexobj(s):
        return np.sqrt(s - 1.0) * np.sqrt(s + 1.0)
    return np.copysign(np.sqrt(s * s - 1.0), s)


def _series(A: Array, node: Index, w: Any) -> Any:
    """-[A_0 + 2 Σ_{n>=1} A_n w^n] of each node by Horner's rule."""
    total = A[-1][node] * w
    for a in A[-2:0:-1]:
        total = (total + a[node]) * w
    return -2.0 * total - A[0][node]


def _steep_series(A: Array, node: Index, w: Any) -> Any:
    """w times the derivative of `_series`."""
    total = (len(A) - 1) * A[-1][node] * w
    for n in range(len(A) - 2, 0, -1):
        total = (total + n * A[n][node]) * w
    return -2.0 * total


def chunks(size: int) -> Iterable[slice]:
    """The targets in portions."""
    starts = range(0, size, CHUNK)
    portions = [slice(start, min(start + CHUNK, size)) for start in starts]
    return counted("points, portion", portions, len(starts))


def add_pairs(total: Any, targets: Index, values: Any) -> None:
    """total[i] += values of the pairs of target i."""
    if np.iscomplexobj(values):
        total.real += np.bincount(targets, values.real, len(total))
        total.imag += np.bincount(targets, values.imag, len(total))
    else:
        total += np.bincount(targets, values, len(total))
