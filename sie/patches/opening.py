"""The gap between the bodies beside several patches: what opens from the nearest edge on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .admissible import opening, sides
from .operator import Operator
from .panels import FARTHEST, gap_panels

Array = NDArray[np.float64]


def gap(o: Operator, x: Array) -> Array:
    """The gap at x (1-d): 0 in contact, inf where there is no indenter."""
    P, pieces = o.patches, o.pieces
    out = np.where(np.isnan(x), np.nan, np.inf)
    finite = np.flatnonzero(np.isfinite(x))
    at = x[finite]
    if P.chord.periodic:
        at = at - P.chord.period * np.floor((at - P.a[0]) / P.chord.period)
    left = np.searchsorted(P.a, at, side="right") - 1  # -1 left of all
    inside = (left >= 0) & (at <= P.b[np.maximum(left, 0)])
    out[finite[inside]] = 0.0
    lo, hi = pieces.domain
    piece = pieces.locate(at)
    walled = pieces.void[piece] & (at > pieces.ends[piece])
    beside = np.flatnonzero(~inside & ~walled & (at >= lo) & (at <= hi))
    if not beside.size:
        return out
    hull = P.b[-1] - P.a[0]
    farthest = np.abs(at[beside] - 0.5 * (P.a[0] + P.b[-1])).max() / hull
    panels = gap_panels(P, pieces, outside=True, farthest=max(FARTHEST, 1.1 * farthest))
    side = sides(o, panels)
    k = left[beside]
    start = np.where(k >= 0, P.b[np.maximum(k, 0)], -np.inf)
    following = np.append(P.a[1:], P.a[0] + P.chord.period if P.chord.periodic else np.inf)
    stop = np.where(k >= 0, following[np.maximum(k, 0)], P.a[0])
    right = stop - at[beside] < at[beside] - start
    distance = np.where(right, stop - at[beside], at[beside] - start)
    # panels come in the order of gaps, left side first, and of the parameter
    key = 2 * panels.gap + panels.right
    first = np.searchsorted(key, 2 * k + right)
    last = np.searchsorted(key, 2 * k + right, side="right") - 1
    t = panels.parameter(first, distance)
    panel = first.copy()
    for _ in range(int((last - first).max(initial=0))):
        panel = np.where((panel < last) & (t > panels.hi[panel]), panel + 1, panel)
    value, _, _ = opening(o, side, panel, t[:, None])
    out[finite[beside]] = np.maximum(value[:, 0], 0.0)
    return out
