"""V(z) of a slope with many pieces: the same formulas as in `panels`, at a cost close to linear in pieces plus points.

    far      a whole branch of pieces at once, as the Cauchy sum of its quadrature nodes (`summation`)
    near     the pairs (piece, point) that are left, a few for each point, in arrays of pairs: the closed form within the piece's reach,
             its quadrature beyond

Both ends of a piece in a pair have their own logarithm, and the neighbour may be far, where nothing takes its rounding away: each is
computed from the distance to its break itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.cauchy_sums import KernelSums, add_pairs, chunks

from .piece_quadrature import Geometry

Array = NDArray[np.float64]
Index = NDArray[np.int64]
# of the break, roots of its distances from both edges, and the points' indices
Logarithm = Callable[[Any, Any, Any, Any], Any]


class Pieces(NamedTuple):
    """What `combined` needs of the pieces: where they are, their series in T_n, the U-series behind the root, how far these serve."""

    geometry: Geometry
    half_length: Array
    series: Array
    continuation: Array
    reach: Array  # as a Bernstein parameter
    reach_in_s: Array  # on the line
    offset: Array  # of the quadrature nodes from lo (K, n) ...
    charge: Array  # ... and weight times H there
    sums: KernelSums


def combined(pieces: Pieces, z: Any, root: Any, log_of: Logarithm) -> tuple[Any, Index, Index]:
    """V(z) at all points, and where the closed forms of the first and of the last piece were used."""
    V = np.zeros_like(root)
    first, last = [], []
    for part in chunks(len(z)):
        far, k, i = pieces.sums.far(z[part])
        V[part] = far * root[part]
        if part.start:
            i = i + part.start
        s = place(pieces, k, z[i])
        near = within(pieces, k, s)
        beyond = ~near
        if beyond.any():
            _add(V, part, i[beyond], root[i[beyond]] * _quadrature(pieces, k[beyond], z[i[beyond]]))
        k, i, s = k[near], i[near], s[near]
        _add(V, part, i, _closed(pieces, (k, i, s), root, log_of))
        first.append(i[k == 0])
        last.append(i[k == len(pieces.series) - 1])
    none = [np.zeros(0, dtype=np.int64)]
    return V, np.concatenate(first or none), np.concatenate(last or none)


def _add(V: Any, part: slice, i: Index, values: Any) -> None:
    add_pairs(V[part], i - part.start, values)


def place(pieces: Pieces, k: Index, z: Any) -> Any:
    """s of each pair, -1 and 1 at the ends of its piece."""
    g = pieces.geometry
    return ((z - g.ends[0][k]) - g.tails[0][k]) / pieces.half_length[k] - 1.0


def within(pieces: Pieces, k: Index, s: Any) -> NDArray[np.bool_]:
    if np.iscomplexobj(s):
        within: NDArray[np.bool_] = (
            np.abs(s + np.sqrt(s - 1.0) * np.sqrt(s + 1.0)) <= pieces.reach[k]
        )
        return within
    return np.asarray(np.abs(s) <= pieces.reach_in_s[k])


def _quadrature(pieces: Pieces, k: Index, z: Any) -> Any:
    g = pieces.geometry
    distance = pieces.offset[k] - ((z - g.ends[0][k]) - g.tails[0][k])[:, None]
    return (pieces.charge[k] / distance).sum(axis=1)


def _closed(pieces: Pieces, pairs: tuple[Index, Index, Any], root: Any, log_of: Logarithm) -> Any:
    """H (L_hi - L_lo) + root Σ q_m U_m / l of pairs (k, i, s); an edge of the contact has no logarithm."""
    k, i, s = pairs
    g = pieces.geometry
    difference = np.zeros_like(s)
    for end, sign, edge in (
        (1, 1.0, len(pieces.series) - 1 if g.cut_right else -1),
        (0, -1.0, 0 if g.cut_left else -1),
    ):
        inner = np.flatnonzero(k != edge)
        of = k[inner]
        difference[inner] += sign * log_of(
            g.ends[end][of], g.root_left[end][of], g.root_right[end][of], i[inner]
        )
    H = chebyshev.evaluate(pieces.series.T[:, k], s)
    return H * difference + root[i] * chebyshev.evaluate_second_kind(pieces.continuation.T[:, k], s)
