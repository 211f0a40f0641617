"""The inequalities by bounds and not by samples: lower bounds on panels, and D >= 0 on patches.

A Legendre series on a panel is nowhere below c_0 - Σ|c_n|. A panel whose bound decides nothing is
halved.

At a concave corner, where H jumps down, D falls without bound like a logarithm, which no polynomial
shows: a patch that covers one is in tension there, on an interval that may be too narrow for
doubles.

Beside a sharp edge D grows like 1/distance, which no polynomial shows either: there the bound is
that of D sin²(φ/2), of D times the distance from that edge over the width of the patch.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Points

from .operator import Operator, intensities, on_patches
from .panels import CLEARLY, DEEPEST, FIRST, NODES, halves
from .state import CLOSED, Tension

Array = NDArray[np.float64]
Index = NDArray[np.int64]

TENSION = 1e-13  # of the largest D: rounding
MANY = 1 << 14  # parts more than panels: where D is next to nothing but for one place they are few
HALVED = 42  # times the distance from a concave corner is


def tensions(o: Operator) -> tuple[tuple[Tension, ...], float]:
    """Where the patches are in tension, and the lowest bound of D over the largest D."""
    k = o.panels
    # a charge that pulls is an event of its own
    sharp = np.where(k.right, 1.0, -1.0) * o.Y[2 * k.patch + k.right] > 0.0
    panel, scale = _open(o, sharp)
    lo, hi, lowest = k.lo[panel], k.hi[panel], np.inf
    bad: list[tuple[int, float, float, float, float]] = []
    g, _ = chebyshev.gauss_legendre(NODES)
    for depth in range(DEEPEST if panel.size else 0):
        angle = lo[:, None] + (hi - lo)[:, None] * g
        D, x = intensities(o, panel, angle)
        finite = D[np.isfinite(D)]
        scale = max(scale, float(finite.max(initial=0.0)))
        least = -TENSION * scale
        distance = np.where(sharp[panel, None], np.sin(0.5 * angle) ** 2, 1.0)
        above = (np.where(np.isfinite(D), D, scale) - least) * distance
        bound = chebyshev.lower_bound(above) + least
        negative = least > D
        for j in np.flatnonzero(negative.any(axis=1)):
            bad += [(int(k.patch[panel[j]]), *run) for run in _runs(x[j], negative[j])]
        enough = bound >= least
        lowest = min(lowest, float(bound[enough].min(initial=np.inf)))
        lowest = min(lowest, float(np.where(negative, D, np.inf).min()))
        open_ = ~enough & ~negative.any(axis=1) & (depth < DEEPEST - 1)
        if not open_.any():
            break
        if np.count_nonzero(open_) > MANY + len(k.lo):
            raise FloatingPointError("rounding of D hides its sign")
        lo, hi = halves(lo[open_], hi[open_])
        panel = np.tile(panel[open_], 2)
    corners, deepest = _at_corners(o)
    bad += corners
    lowest = min(lowest, deepest)
    return tuple(_joined(bad)), lowest / scale if scale else 0.0


def _open(o: Operator, sharp: NDArray[np.bool_]) -> tuple[Index, float]:
    """The panels on which a first look leaves open whether D is positive, and the largest D."""
    k, every = o.panels, np.arange(len(o.panels.lo))
    g, _ = chebyshev.gauss_legendre(FIRST)
    D, _ = intensities(o, every, k.lo[:, None] + (k.hi - k.lo)[:, None] * g)
    with np.errstate(invalid="ignore"):
        clear = (
            (chebyshev.lower_bound(D) > CLEARLY * D.mean(axis=1))
            & np.isfinite(D).all(axis=1)
            & ~sharp
        )
    return np.flatnonzero(~clear), float(D[np.isfinite(D)].max(initial=0.0))


def _at_corners(o: Operator) -> tuple[list[tuple[int, float, float, float, float]], float]:
    """Runs of tension at the concave corners on patches, as `_runs` has them, and the lowest D."""
    P, pieces = o.patches, o.pieces
    corners = pieces.never_closed
    patch = np.searchsorted(P.a, corners, side="right") - 1
    covered = (patch >= 0) & (corners < P.b[np.maximum(patch, 0)]) & (corners > P.a[patch])
    corners, patch = corners[covered], patch[covered]
    if not corners.size:
        return [], np.inf
    before, after = pieces.locate(corners, "left"), pieces.locate(corners)
    behind = np.minimum(corners - pieces.breaks[before], corners - P.a[patch])
    ahead = np.minimum(pieces.breaks[after + 1] - corners, P.b[patch] - corners)
    halved = 0.5 ** np.arange(1.0, HALVED)
    offset = np.concatenate((-behind[:, None] * halved, ahead[:, None] * halved), axis=1)
    piece = np.where(offset < 0.0, before[:, None], after[:, None])
    places = Points(np.repeat(corners, offset.shape[1]), offset.ravel())
    _, D = on_patches(o, np.repeat(patch, offset.shape[1]), places, piece.ravel())
    D = D.reshape(offset.shape)
    deepest, pulls = D.min(axis=1), np.where(D < 0.0, offset, 0.0)
    left, right = -pulls.min(axis=1), pulls.max(axis=1)
    # D < 0 on half of the gap that opens there, of which a quarter at least is found
    narrower = 0.5 * np.minimum(corners - P.a[patch], P.b[patch] - corners)
    open_ = left + right > CLOSED * narrower
    lo, hi = corners - left, corners + right
    runs = [
        (int(patch[k]), float(lo[k]), float(lo[k]), float(hi[k]), float(hi[k]))
        for k in np.flatnonzero(open_)
    ]
    return runs, float(deepest[open_].min(initial=np.inf))


def _runs(x: Array, negative: NDArray[np.bool_]) -> list[tuple[float, float, float, float]]:
    """The nodes of a panel where D < 0, as (from, node, node, up to).

    They reach half-way to the next node, or as far beyond the panel's first or last one.
    """
    order = np.argsort(x)
    x, found = x[order], np.flatnonzero(negative[order])
    ends = np.concatenate((x[:1] - (x[1] - x[0]), 0.5 * (x[1:] + x[:-1]), x[-1:] + (x[-1] - x[-2])))
    at = x[found].tolist()
    return list(zip(ends[found].tolist(), at, at, ends[found + 1].tolist(), strict=True))


def _joined(bad: list[tuple[int, float, float, float, float]]) -> list[Tension]:
    """Runs of the same patch that touch, as one."""
    found: list[Tension] = []
    until = -np.inf
    for patch, start, lo, hi, stop in sorted(bad):
        if found and found[-1].patch == patch and start <= until:
            found[-1] = Tension(patch, min(lo, found[-1].lo), max(hi, found[-1].hi))
            until = max(until, stop)
        else:
            found.append(Tension(patch, lo, hi))
            until = stop
    return found
