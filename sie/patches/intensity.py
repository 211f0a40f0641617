"""The intensity D of the traction at points of the patches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .chord import Points
from .operator import Operator, Targets

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def intensities(o: Operator, panel: Index, angle: Array) -> tuple[Array, Array]:
    """D at angles (m, n) on panels (m,), and where that is."""
    k, P = o.panels, o.patches
    patch, right = k.patch[panel], k.right[panel]
    inward = 2.0 * P.r[patch, None] * np.sin(0.5 * angle) ** 2
    anchor = np.broadcast_to(np.where(right, P.b[patch], P.a[patch])[:, None], inward.shape)
    x = Points(anchor, np.where(right[:, None], -inward, inward))
    piece = np.broadcast_to(k.piece[panel, None], inward.shape)
    return on_patches(o, np.broadcast_to(patch[:, None], inward.shape), x, piece), x.x


def on_patches(o: Operator, patch: Index, x: Points, piece: Index) -> Array:
    """D_k at points x on patches k, on these pieces of H; any shape."""
    P = o.patches
    shape = x.offset.shape
    owner, anchor, offset = patch.ravel(), x.anchor.ravel(), x.offset.ravel()
    D = np.empty(owner.shape)
    flat = Points(anchor, offset)
    which = piece.ravel()
    reference = o.pieces.value(which, anchor, offset)
    S = o.others(owner, flat)
    order = np.argsort(owner, kind="stable")
    starts = np.flatnonzero(np.diff(owner[order], prepend=-1))
    for some in np.split(order, starts[1:]):
        i = int(owner[some[0]])
        group = o.group(i, float(P.a[i]), float(P.b[i]))
        for part in _clusters(flat.x[some], some, P.r[i]):
            close = (
                o.group(i, float(flat.x[part].min()), float(flat.x[part].max()))
                if len(part) < len(some)
                else group
            )
            targets = Targets(flat[part], reference[part], which[part], S[part], owner[part])
            D[part] = close.D(targets)
    return D.reshape(shape)


def _clusters(x: Array, index: Index, r: float) -> list[Index]:
    """Targets in runs of neighbours, so that cells far from a run act through charges."""
    if len(index) <= 256:
        return [index]
    order = index[np.argsort(x, kind="stable")]
    return np.array_split(order, max(len(order) // 128, 1))
