"""Fast sums Σ_j q_j / (t_j - z), many sources t_j on the line and many targets z in the plane.

The sources come in rows, one for each piece of a slope, that ascend and do not overlap. Rows are
gathered in leaves, leaves in pairs, and so on up to one root: a tree whose every node is an
interval with centre c and half-length a. With u = (t - c)/a, s = (z - c)/a and ρ = s + sqrt(s-1)
sqrt(s+1) the kernel is a geometric series outside the interval,

    Σ q_j / (z - t_j) = 2 / (a sqrt(s-1) sqrt(s+1)) [A_0/2 + Σ_{n>=1} A_n ρ^-n]
    A_n = Σ_j q_j T_n(u_j)

of which TERMS terms leave rounding where |ρ| >= SEPARATION (s = ±2 on the line). A target takes
every node's sum at the first level at which it is that far; what is left at the leaves are pairs
(row, target), few for each target, which the caller computes exactly. So the cost grows like
(sources + targets) log(sources), in a handful of array operations for each level and term.

Moments of a node come from its children's as from sources: a child's moments up to TERMS are those
of TERMS charges on its Chebyshev points.

Greengard & Rokhlin (1987), Barnes & Hut (1986) for the tree; Dutt, Gu & Rokhlin (1996) for
Chebyshev series in one dimension; Mason & Handscomb, Chebyshev Polynomials (2003), eq. (1.51), for
the series: ∫ over sources of the generating function of T_n.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import counted

from . import chebyshev

Array = NDArray[np.float64]
Index = NDArray[np.int64]

SEPARATED = 2.0  # |s| of a target on the line that a node's series serves
SEPARATION = SEPARATED + float(np.sqrt(SEPARATED**2 - 1.0))  # the same as |ρ|
TERMS = 30  # SEPARATION**-TERMS is a tenth of rounding
SHORTEST = 64.0  # ulp: the half-length of a node whose rows are shorter than the spacing of doubles
LEAF = 4  # rows in a leaf
CHUNK = 1 << 14  # targets taken at a time: what is held then fits into a cache


class KernelSums:
    """The tree of one set of sources."""

    def __init__(self, lo: Array, length: Array, offset: Array, charge: Array) -> None:
        """Build the tree of rows [lo, lo + length], shape (K,).

        The sources lie at lo + offset; offsets and charges have the shape (K, n).
        """
        self.rows = len(lo)
        spare = -self.rows % LEAF
        lo, length = (np.concatenate((a, np.repeat(a[-1:], spare))) for a in (lo, length))
        offset, charge = (
            np.concatenate((a, np.zeros((spare, a.shape[1])))) for a in (offset, charge)
        )
        start, end = lo[::LEAF], (lo + length)[LEAF - 1 :: LEAF]
        centre = 0.5 * (start + end)
        half = np.maximum(0.5 * (end - start), SHORTEST * np.spacing(np.abs(centre)))
        leaf = np.repeat(np.arange(len(start)), LEAF)
        u = ((lo - centre[leaf])[:, None] + offset) / half[leaf, None]
        A = _moments(u.reshape(len(start), -1), charge.reshape(len(start), -1))
        self.levels = [(centre, half, A)]  # from the leaves to the root
        while len(start) > 1:
            if len(start) % 2:
                # An empty sibling for the last node: it has an interval, but nothing in it
                start, end = np.append(start, end[-1]), np.append(end, end[-1])
                centre, half = np.append(centre, end[-1]), np.append(half, 0.0)
                A = np.concatenate((A, np.zeros((TERMS, 1))), axis=1)
            start, end = start[::2], end[1::2]
            above = 0.5 * (start + end)
            size = np.maximum(0.5 * (end - start), SHORTEST * np.spacing(np.abs(above)))
            u = (
                (centre.reshape(-1, 2) - above[:, None])[..., None]
                + half.reshape(-1, 2, 1) * POINTS
            ) / size[:, None, None]
            A = _moments(u.reshape(len(start), -1), (A.T @ CHARGES).reshape(len(start), -1))
            centre, half = above, size
            self.levels.append((centre, half, A))

    def far(self, z: Any) -> tuple[Any, Index, Index]:
        """(Σ q/(t - z) over all sources far from each target, rows k, targets i).

        The pairs (k, i) are the rows near a target, which the sum leaves out.
        """
        total = np.zeros_like(z)
        near = (np.zeros(len(z), dtype=np.int64), np.arange(len(z)))
        for branch in self._branches(z, near):
            total += _gathered(branch.at, branch.sum(), len(z))
            near = branch.left
        return total, *self._pairs(*near)

    def far_pair(self, z: Any) -> tuple[Any, Any, Index, Index]:
        """The same with Σ q/(t - z)², the derivative, after the first."""
        total, steep = np.zeros_like(z), np.zeros_like(z)
        near = (np.zeros(len(z), dtype=np.int64), np.arange(len(z)))
        for branch in self._branches(z, near):
            total += _gathered(branch.at, branch.sum(), len(z))
            steep += _gathered(branch.at, branch.derivative(), len(z))
            near = branch.left
        return total, steep, *self._pairs(*near)

    def _branches(self, z: Any, start: tuple[Index, Index]) -> Iterator[_Branch]:
        """The targets of each level from the root down, and the pairs for the next level."""
        node, target = start
        for level in range(len(self.levels) - 1, -1, -1):
            centre, half, A = self.levels[level]
            s = (z[target] - centre[node]) / half[node]
            root = _root(s)
            served = np.abs(s + root) >= SEPARATION
            at, of = target[served], node[served]
            s, root = s[served], root[served]
            node, target = node[~served], target[~served]
            if level:
                node, target = (2 * node[:, None] + np.arange(2)).ravel(), np.repeat(target, 2)
                exists = node < len(self.levels[level - 1][0])
                node, target = node[exists], target[exists]
            yield _Branch(A, of, at, s, root, half[of], (node, target))

    def _pairs(self, node: Index, target: Index) -> tuple[Index, Index]:
        """(row, target) of the leaves that are left."""
        rows, targets = (LEAF * node[:, None] + np.arange(LEAF)).ravel(), np.repeat(target, LEAF)
        exists = rows < self.rows
        return rows[exists], targets[exists]


class _Branch(NamedTuple):
    """Moments of a level's nodes, the nodes `of` that serve the targets `at`, and s, sqrt(s² - 1).

    The half-lengths of the nodes and the remaining pairs follow.
    """

    A: Array
    of: Index
    at: Index
    s: Any
    root: Any
    half: Array
    left: tuple[Index, Index]

    def sum(self) -> Any:
        """Σ q/(t - z)."""
        return _series(self.A, self.of, 1.0 / (self.s + self.root)) / (self.half * self.root)

    def derivative(self) -> Any:
        """Σ q/(t - z)²: -(w S' + S s/root) / (half root)², S(w) the series, w = 1/(s + root)."""
        w = 1.0 / (self.s + self.root)
        S, steep = _series(self.A, self.of, w), _steep_series(self.A, self.of, w)
        size = self.half * self.root
        return -(steep + S * (self.s / self.root)) / (size * size)


def chunks(size: int) -> Iterable[slice]:
    """The targets in portions."""
    starts = range(0, size, CHUNK)
    portions = [slice(start, min(start + CHUNK, size)) for start in starts]
    return counted("points, portion", portions, len(starts))


def add_pairs(total: Any, targets: Index, values: Any) -> None:
    """total[i] += values of the pairs of target i."""
    total += _gathered(targets, values, len(total))


def _gathered(targets: Index, values: Any, size: int) -> Any:
    if np.iscomplexobj(values):
        return np.bincount(targets, values.real, size) + 1j * np.bincount(
            targets, values.imag, size
        )
    return np.bincount(targets, values, size)


def _root(s: Any) -> Any:
    """sqrt(s - 1) sqrt(s + 1), with the sign of s on the line.

    It is set to zero inside the interval, where no series serves.
    """
    if np.iscomplexobj(s):
        return np.sqrt(s - 1.0) * np.sqrt(s + 1.0)
    return np.copysign(np.sqrt(np.maximum(s * s - 1.0, 0.0)), s)


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


def _moments(u: Array, charge: Array) -> Array:
    """A_n = Σ_j q_j T_n(u_j): (TERMS, nodes) of sources (nodes, n)."""
    A = np.empty((TERMS, len(u)))
    before, now, twice = np.ones_like(u), u, 2.0 * u
    A[0] = charge.sum(axis=1)
    for n in range(1, TERMS):
        A[n] = np.einsum("ij,ij->i", charge, now)
        before, now = now, twice * now - before
    return A


POINTS = chebyshev.points(TERMS)
# In every level of the tree the moments become charges on these points.
CHARGES = chebyshev.charges(TERMS)
