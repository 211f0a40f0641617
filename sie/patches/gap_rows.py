"""What a point charge at any edge opens across any gap: the rows of the Jacobian that are dense.

    A_ie = Σ_{x in gap i} w(x)/d(x, e)

Gaps and edges are gathered in clusters. Clusters that are far from each other act through charges
on the Chebyshev points of both (`tree`), so that a pair of them takes so many kernels and not those
of all its nodes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .chord import Points
from .panels import GapPanels, Patches
from .sums import add, parts
from .tree import CHARGES, FAR, POINTS, gathered

Array = NDArray[np.float64]
Index = NDArray[np.int64]

TOGETHER = 16  # patches of a cluster, and the gaps behind them


class Clusters(NamedTuple):
    """Intervals (K,) by middles and half-lengths."""

    middle: Array
    half: Array

    @classmethod
    def between(cls, lo: Array, hi: Array) -> Clusters:
        return cls(0.5 * (lo + hi), 0.5 * (hi - lo))

    def points(self, k: Index) -> Points:
        return Points(self.middle[k, None], self.half[k, None] * POINTS)

    def within(self, k: Index, x: Points) -> Array:
        """Places (m, n) as parts of the half-lengths of their clusters (m,)."""
        step = (x.anchor - self.middle[k, None]) + x.offset
        return np.asarray(step / self.half[k, None])


def across_gaps(P: Patches, k: GapPanels, weight: Array) -> Array:
    """A (N - 1, 2N) for weights on the nodes of the gaps; (N, 2N) of a period that is closing."""
    N = P.number
    number, end = N - 1 + P.closing, np.append(P.a[1:], P.a[0] + P.chord.period)
    first, last = np.arange(0, N, TOGETHER), np.minimum(np.arange(0, N, TOGETHER) + TOGETHER, N) - 1
    edges = Clusters.between(P.a[first], P.b[last])
    behind = first < number
    gaps = Clusters.between(P.b[first[behind]], end[np.minimum(last, number - 1)[behind]])
    e = np.append(P.edges, np.repeat(P.edges[-1:], 2 * (-N % TOGETHER))).reshape(len(first), -1)
    # by cluster, gap in it, cluster, edge in it
    out = np.zeros((len(gaps.middle), TOGETHER, *e.shape))
    far = _far(P, gaps, edges)
    _add_near(out, (P, k, weight), e, far)
    I, J = np.nonzero(far)
    if I.size:
        sources, places = _spread(k, gaps, weight, out.shape[:2]), _weights(edges, e)
        for some in parts(len(I), CHARGES * max(CHARGES, e.shape[1])):
            i, j = I[some], J[some]
            kernel = 1.0 / P.chord.beyond(gaps.points(i), edges.points(j))
            out[i, :, j, :] = sources[i] @ kernel.transpose(0, 2, 1) @ places[j]
    return out.reshape(out.shape[0] * TOGETHER, -1)[:number, : 2 * N]


def _far(P: Patches, gaps: Clusters, edges: Clusters) -> NDArray[np.bool_]:
    """Whether clusters of gaps (K,) and of edges (L,) are far from each other, (K, L)."""
    if P.number <= 4 * TOGETHER:
        return np.zeros((len(gaps.middle), len(edges.middle)), dtype=bool)
    apart = np.abs(P.chord.difference(gaps.middle[:, None] - edges.middle))
    one, other = gaps.half[:, None], edges.half
    return np.asarray(apart >= FAR * np.maximum(one, other) + np.minimum(one, other))


def _spread(k: GapPanels, gaps: Clusters, weight: Array, shape: tuple[int, int]) -> Array:
    """The charges of each gap on the points of its cluster, (K, TOGETHER, CHARGES)."""
    u = gaps.within(k.gap // TOGETHER, k.points)
    out = np.zeros((shape[0] * shape[1], CHARGES))
    add(out, k.gap, gathered(u, weight[None])[0])
    return out.reshape(*shape, CHARGES)


def _weights(edges: Clusters, e: Array) -> Array:
    """What interpolates from the points of each cluster to its edges, (L, CHARGES, edges)."""
    u = edges.within(np.arange(len(e)), Points(e, np.zeros_like(e)))
    unit = gathered(u.reshape(-1, 1), np.ones((1, e.size, 1)))[0]
    return unit.reshape(*e.shape, CHARGES).transpose(0, 2, 1)


def _add_near(
    out: Array, nodes: tuple[Patches, GapPanels, Array], e: Array, far: NDArray[np.bool_]
) -> None:
    """The sums over the nodes of gaps as they are, at the clusters of edges that are not far."""
    P, k, weight = nodes
    cluster, panel = np.nonzero(~far[k.gap // TOGETHER].T)
    rows = out.reshape(-1, e.shape[1])
    for some in parts(len(panel), k.dx.shape[1] * e.shape[1]):
        p, j = panel[some], cluster[some]
        step = P.chord.apart(
            k.points.anchor[p, :, None] - e[j][:, :, None], k.points.offset[p, None, :]
        )
        sums = np.reciprocal(step, out=step) @ weight[p, :, None]
        add(rows, k.gap[p] * len(e) + j, sums[..., 0])
