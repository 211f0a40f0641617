"""The integrals over all gaps of poles at the centres of all patches: dense rows.

    A_ik = Σ_{x in gap i} w(x) κ(x - c_k),    B_ik = Σ_{x in gap i} w(x)/d(x, c_k)²

κ is 1/x, or the sum of that over all periods. Neighbours are gathered in clusters. Gaps act on
clusters of centres that are far from theirs through charges on Chebyshev points (`tree`), so that a
pair of clusters takes so many kernels and not those of all nodes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .panels import GapPanels, Patches
from .sums import add, parts
from .tree import CHARGES, FAR, POINTS, gathered

Array = NDArray[np.float64]

TOGETHER = 16  # patches of a cluster, and the gaps behind them


def across_gaps(P: Patches, k: GapPanels, weight: Array) -> Array:
    """A and B, (2, N - 1, N), for weights on the nodes of the gaps."""
    N, chord = P.number, P.chord
    c = np.append(P.c, np.repeat(P.c[-1:], -N % TOGETHER)).reshape(-1, TOGETHER)
    lo, hi = (
        P.b[:-1:TOGETHER],
        P.a[np.minimum(np.arange(TOGETHER, N + TOGETHER - 1, TOGETHER), N - 1)],
    )
    middle, half = 0.5 * (lo + hi), 0.5 * (hi - lo)
    away = chord.distance(middle[:, None], c[:, 0], c[:, -1])
    far = (away >= FAR * half[:, None]) & (N > 4 * TOGETHER)
    out = np.zeros((2, len(middle) * TOGETHER, *c.shape))
    _add_near(out, (P, k, weight), c, far)
    I, J = np.nonzero(far)
    if I.size:
        cluster = k.gap // TOGETHER
        u = ((k.points.anchor - middle[cluster, None]) + k.points.offset) / half[cluster, None]
        of_gaps = np.zeros((out.shape[1], CHARGES))
        add(of_gaps, k.gap, gathered(u, weight[None])[0])
        charges = of_gaps.reshape(len(middle), TOGETHER, CHARGES)
        by_cluster = out.reshape(2, *charges.shape[:2], *c.shape)
        points = half[:, None] * POINTS
        for some in parts(len(I), CHARGES * TOGETHER):
            i, j = I[some], J[some]
            step = chord.difference(middle[i, None, None] - c[j][:, None, :], points[i][:, :, None])
            for sums, kernel in zip(by_cluster, chord.poles(step), strict=True):
                sums[i, :, j, :] = charges[i] @ kernel
    return out.reshape(2, out.shape[1], -1)[:, : N - 1, :N]


def _add_near(
    out: Array, nodes: tuple[Patches, GapPanels, Array], c: Array, far: NDArray[np.bool_]
) -> None:
    """The sums over the nodes of gaps as they are, at the clusters of centres that are not far."""
    P, k, weight = nodes
    cluster, panel = np.nonzero(~far[k.gap // TOGETHER].T)
    for some in parts(len(panel), k.dx.shape[1] * TOGETHER):
        p, j = panel[some], cluster[some]
        step = P.chord.difference(
            k.points.anchor[p, :, None] - c[j][:, :, None], k.points.offset[p, None, :]
        )
        for sums, kernel in zip(out, P.chord.poles(step), strict=True):
            value = (kernel @ weight[p, :, None])[..., 0]
            add(sums.reshape(-1, TOGETHER), k.gap[p] * len(c) + j, value)
