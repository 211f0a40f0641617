"""The intensity D of the traction at points of the patches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .chord import Points
from .close import Targets
from .measure import ranges
from .operator import Operator

Array = NDArray[np.float64]
Index = NDArray[np.int64]

BLOCK = 16  # places in a block
SHARED = 16  # blocks of a patch that share their far sums


def intensities(o: Operator, panel: Index, angle: Array) -> tuple[Array, Array]:
    """D at angles (m, n) on panels (m,), and where that is."""
    k, P = o.panels, o.patches
    right = k.right[panel, None]
    inward = 2.0 * P.r[k.patch[panel], None] * np.sin(0.5 * angle) ** 2
    x = Points(k.points.anchor[panel], np.where(right, -inward, inward))
    piece = np.broadcast_to(k.piece[panel, None], inward.shape)
    order = np.argsort(k.patch[panel], kind="stable")
    D = np.empty(inward.shape)
    D[order] = on_patches(o, k.patch[panel[order]], x[order], piece[order])
    return D, x.x


def on_patches(o: Operator, i: Index, x: Points, piece: Index) -> Array:
    """D_i at blocks of points x (B, n) on patches i (B,), ascending, on these pieces of H."""
    starts = np.flatnonzero(np.diff(i, prepend=-1))
    count = np.diff(np.append(starts, len(i)))
    group = np.cumsum(ranges(np.zeros_like(count), count) % SHARED == 0)
    owner = np.broadcast_to(i[:, None], x.offset.shape)
    reference = o.pieces.value(piece, x.anchor, x.offset)
    return np.asarray(o.D(Targets(i, group, x, reference, piece, owner, o.others(i, x, group))))


def at_edges(o: Operator) -> Array:
    """D at all edges (2N,); a smooth edge is that of no other charge."""
    P, N = o.patches, o.patches.number
    piece = np.stack((o.pieces.locate(P.a), o.pieces.locate(P.b, "left")), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = Points(P.edges.reshape(N, 2), np.zeros((N, 2)))
        return on_patches(o, np.arange(N), x, piece).ravel()


def blocks(i: Index, x: Array) -> Index:
    """Places of the patches i (m,) as blocks (B, n) of neighbours; the last of a patch fills up."""
    order = np.lexsort((x, i))
    starts = np.flatnonzero(np.diff(i[order], prepend=-1))
    stops = np.append(starts[1:], len(i))
    count = -(-(stops - starts) // BLOCK)
    first = np.repeat(starts, count) + BLOCK * ranges(np.zeros_like(count), count)
    return order[
        np.minimum(first[:, None] + np.arange(BLOCK), np.repeat(stops, count)[:, None] - 1)
    ]
