"""Whether patches are the answer: p >= 0 on all of them and gap >= 0 beside them, by bounds and not
by samples.

    on a patch     D >= 0, panel by panel: a Legendre series has c_0 - Σ|c_n| as a lower bound
    beside one     g' / root >= 0 from the edge on, then g >= 0 in the same way

A panel whose bound says nothing is halved. Where the conditions of the edges hold as well this is
the answer: the problem is convex. At a concave corner, where H jumps down, D falls without bound
like a logarithm, which no polynomial shows: a patch that covers one is in tension there, on an
interval that may be too narrow for doubles. The gap at given points comes from the same series.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .chord import Points
from .newton import CLOSED
from .operator import Operator, gap_values, intensities, on_patches
from .panels import FARTHEST, GapPanels, distance_of, gap_panels
from .state import Findings, Overlap, State, Tension

Array = NDArray[np.float64]
Index = NDArray[np.int64]

NODES = 8  # on a part of a panel
DEEPEST = 30  # halvings
HALVED = 42  # times the distance from a concave corner is
TENSION = 1e-13  # of the largest D: rounding
OVERLAP, ROUNDING = 1e-11, 7e-14  # of the gap's largest g; of max|H| times its width


@dataclass(frozen=True, eq=False)
class Found:
    """A certified answer."""

    state: State
    operator: Operator
    findings: Findings
    rounds: int
    steps: int


def findings(o: Operator) -> Findings:
    tension, lowest = tensions(o)
    return Findings(tension, _overlaps(o), lowest)


@lru_cache(maxsize=8)
def legendre(n: int) -> Array:
    """Values at the n Gauss nodes to Legendre coefficients, as a matrix (n, n)."""
    g, w = chebyshev.gauss_legendre(n)
    P = np.polynomial.legendre.legvander(2.0 * g - 1.0, n - 1)
    matrix = P * w[:, None] * (2.0 * np.arange(n) + 1.0)
    matrix.flags.writeable = False
    return matrix


def lower_bound(values: Array) -> Array:
    """Below all of a polynomial that has these values (m, n) at Gauss nodes."""
    c = values @ legendre(values.shape[1])
    return np.asarray(c[:, 0] - np.abs(c[:, 1:]).sum(axis=1))


# -- on the patches --------------------------------------------------------------------------------


def tensions(o: Operator) -> tuple[tuple[Tension, ...], float]:
    """Where the patches pull, and the lowest bound of D over the largest D."""
    k = o.panels
    parts = np.stack((k.lo, k.hi), axis=1)
    panel = np.arange(len(k.lo))
    scale, lowest = 0.0, np.inf
    bad: list[tuple[int, float, float, float, float]] = []
    g, _ = chebyshev.gauss_legendre(NODES)
    for depth in range(DEEPEST):
        lo, length = parts[:, :1], np.diff(parts, axis=1)
        angle = lo + length * g
        D, x = intensities(o, panel, angle)
        finite = D[np.isfinite(D)]
        scale = max(scale, float(finite.max(initial=0.0)))
        bound = lower_bound(np.where(np.isfinite(D), D, scale))
        negative = -TENSION * scale > D
        for j in np.flatnonzero(negative.any(axis=1)):
            bad += [(int(k.patch[panel[j]]), *run) for run in _runs(x[j], negative[j])]
        enough = bound >= -TENSION * scale
        lowest = min(lowest, float(bound[enough].min(initial=np.inf)))
        lowest = min(lowest, float(np.where(negative, D, np.inf).min()))
        open_ = ~enough & ~negative.any(axis=1) & (depth < DEEPEST - 1)
        if not open_.any():
            break
        middle = parts[open_].mean(axis=1)
        parts = np.concatenate(
            (
                np.stack((parts[open_, 0], middle), axis=1),
                np.stack((middle, parts[open_, 1]), axis=1),
            )
        )
        panel = np.tile(panel[open_], 2)
    corners, deepest = _at_corners(o)
    bad += corners
    lowest = min(lowest, deepest)
    return tuple(_joined(bad)), lowest / scale if scale else 0.0


def _at_corners(o: Operator) -> tuple[list[tuple[int, float, float, float, float]], float]:
    """Runs of tension at the concave corners on patches, as `_runs` has them, and the lowest D."""
    P, pieces = o.patches, o.pieces
    corners = pieces.never_closed
    patch = np.searchsorted(P.a, corners, side="right") - 1
    covered = (patch >= 0) & (corners < P.b[np.maximum(patch, 0)]) & (corners > P.a[patch])
    corners, patch = corners[covered], patch[covered]
    if not corners.size:
        return [], np.inf
    widths, deepest = [], np.full(corners.shape, np.inf)
    for side in ("left", "right"):
        piece = pieces.locate(corners, side)
        end = pieces.ends[piece] if side == "left" else pieces.ends[piece + 1]
        edge = P.a[patch] if side == "left" else P.b[patch]
        room = np.minimum(np.abs(end - corners), np.abs(edge - corners))
        width = room[:, None] * 0.5 ** np.arange(1.0, HALVED)
        corner = np.broadcast_to(corners[:, None], width.shape)
        which = np.broadcast_to(piece[:, None], width.shape)
        D = on_patches(o, patch, Points(corner, -width if side == "left" else width), which)
        widths.append(np.where(D < 0.0, width, 0.0).max(axis=1))
        deepest = np.minimum(deepest, D.min(axis=1))
    left, right = widths
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
    """Runs of neighbouring nodes of a panel where D < 0: (from, first node, last node, up to).

    They reach half-way to the next node, or as far beyond the panel's first or last one.
    """
    order = np.argsort(x)
    x, negative = x[order], negative[order]
    ends = np.concatenate((x[:1] - (x[1] - x[0]), 0.5 * (x[1:] + x[:-1]), x[-1:] + (x[-1] - x[-2])))
    padded = np.concatenate(([False], negative, [False]))
    starts = np.flatnonzero(padded[1:] & ~padded[:-1])
    stops = np.flatnonzero(padded[:-1] & ~padded[1:])
    return [
        (float(ends[i]), float(x[i]), float(x[j - 1]), float(ends[j]))
        for i, j in zip(starts.tolist(), stops.tolist(), strict=True)
    ]


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


# -- beside the patches ----------------------------------------------------------------------------


class Side(NamedTuple):
    """What is known of g on panels that count from an edge: Legendre coefficients (p, n) of sign Φ
    and of the integrand, g at its start.
    """

    panels: GapPanels
    sign: Array
    phi: Array
    primitive: Array
    start: Array
    reference: Array


def _overlaps(o: Operator) -> tuple[Overlap, ...]:
    panels = gap_panels(o.patches, o.pieces, outside=True)
    if not len(panels.gap):
        return ()
    side = sides(o, panels)
    panel, lo, hi, edge = _parts(o, panels)
    largest = np.zeros(o.patches.number + 1)
    bad: list[tuple[int, float, float, float]] = []
    hull = float(o.patches.b[-1] - o.patches.a[0])
    H = float(np.abs(o.H).max())
    g, _ = chebyshev.gauss_legendre(NODES)
    for depth in range(DEEPEST):
        t = lo[:, None] + (hi - lo)[:, None] * g
        value, x, phi = opening(o, side, panel, t)
        gap = panels.gap[panel] + 1
        away = np.abs(x - panels.points.anchor[panel])
        if depth == 0:
            beside = np.where(np.isfinite(value) & (away <= hull), value, 0.0)
            np.maximum.at(largest, gap, beside.max(axis=1))
        tolerance = np.maximum(OVERLAP * largest[gap], ROUNDING * H * away.max(axis=1))
        enough = lower_bound(value) >= -tolerance
        enough |= edge & (lower_bound(phi) >= 0.0)
        negative = (value < -tolerance[:, None]) & ~enough[:, None]
        wide = x.max(axis=1) - x.min(axis=1)
        for j in np.flatnonzero(negative.any(axis=1)):
            bad += [
                (int(gap[j]) - 1, float(x[j, m]), float(value[j, m]), float(wide[j]))
                for m in np.flatnonzero(negative[j])
            ]
        open_ = ~enough & ~negative.any(axis=1)
        if not open_.any() or depth == DEEPEST - 1:
            break
        middle = 0.5 * (lo + hi)[open_]
        panel, edge = (
            np.tile(panel[open_], 2),
            np.concatenate((edge[open_], np.zeros(len(middle), dtype=bool))),
        )
        lo, hi = np.concatenate((lo[open_], middle)), np.concatenate((middle, hi[open_]))
    return _gathered(bad, largest)


def _gathered(bad: list[tuple[int, float, float, float]], largest: Array) -> tuple[Overlap, ...]:
    """Neighbouring places of overlap as one; each place comes with the width of the part that it is
    on.
    """
    found: list[Overlap] = []
    before = 0.0
    for gap, x, value, wide in sorted(bad):
        if found and found[-1].gap == gap and x - found[-1].hi <= 2.0 * max(wide, before):
            last = found[-1]
            deeper = -value > last.depth
            worst = (x, -value) if deeper else (last.x, last.depth)
            found[-1] = Overlap(gap, last.lo, x, *worst, last.largest)
        else:
            found.append(Overlap(gap, x, x, x, -value, float(largest[gap + 1])))
        before = wide
    return tuple(found)


def sides(o: Operator, panels: GapPanels) -> Side:
    reference, T, D = gap_values(o, panels)
    sign = np.where(panels.right, -1.0, 1.0)
    phi = sign[:, None] * T * D / (np.pi * panels.root)
    n = phi.shape[1]
    half = 0.5 * (panels.hi - panels.lo)
    _, _, derivative = distance_of(_nodes(panels), panels.width[:, None])
    integrand = half[:, None] * phi * panels.root * derivative
    c = integrand @ legendre(n)
    primitive = np.asarray(np.polynomial.legendre.legint(c, lbnd=-1, axis=1), dtype=float)
    whole = primitive.sum(axis=1)
    first = panels.lo == 0.0
    run = np.cumsum(first) - 1
    total = np.cumsum(whole) - whole
    start = total - total[np.flatnonzero(first)][run]
    return Side(panels, sign, phi @ legendre(n), primitive, start, reference)


def _nodes(panels: GapPanels) -> Array:
    g, _ = chebyshev.gauss_legendre(panels.dx.shape[1])
    return np.asarray(panels.lo[:, None] + (panels.hi - panels.lo)[:, None] * g)


def opening(o: Operator, side: Side, panel: Index, t: Array) -> tuple[Array, Array, Array]:
    """(g, x, sign g'/root where the reference follows H) at parameters t (m, n) on panels (m,)."""
    k, pieces = side.panels, o.pieces
    s = (2.0 * t - (k.lo + k.hi)[panel, None]) / (k.hi - k.lo)[panel, None]
    distance, root, _ = distance_of(t, k.width[panel, None])
    anchor = np.broadcast_to(k.points.anchor[panel], distance.shape)
    sign = side.sign[panel, None]
    x = anchor + sign * distance
    phi = _series(side.phi, panel, s)
    bent = side.start[panel, None] + _series(side.primitive, panel, s)
    # ∫ (H - reference) from the edge
    lower, upper = np.minimum(anchor, x), np.maximum(anchor, x)
    shape = x.shape
    rise = pieces.rises(lower.ravel(), upper.ravel(), walls=True).reshape(shape)
    rise -= _referenced(o, k, panel, distance, sign)
    here = pieces.value(pieces.locate(x), x, 0.0)
    follows = k.follows[panel, None]
    edge_value = pieces.value(k.piece[panel], k.points.anchor[panel, 0], 0.0)[:, None]
    continued = pieces.value(k.piece[panel][:, None], anchor, sign * distance)
    difference = np.where(follows, here - continued, here - edge_value)
    same = follows & (pieces.locate(x) == k.piece[panel][:, None])
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = phi + np.where(same, 0.0, sign * difference / root)
    return sign * rise * 1.0 + bent, x, slope


def _referenced(o: Operator, k: GapPanels, panel: Index, distance: Array, sign: Array) -> Array:
    """∫ of the reference between the edge and a distance from it, upwards in x."""
    pieces = o.pieces
    edge = k.points.anchor[panel]
    piece = k.piece[panel][:, None]
    value = pieces.value(piece, edge, 0.0)
    # up to where the piece is continued: the end of the first panel of the run
    first = np.flatnonzero(k.lo == 0.0)[np.cumsum(k.lo == 0.0) - 1][panel]
    limit, _, _ = distance_of(k.hi[first], k.width[first])
    near = np.minimum(distance, limit[:, None])
    risen = pieces.rise(piece, (edge, 0.0), (edge, sign * near))
    return np.asarray(sign * risen + value * (distance - near))


def _series(c: Array, panel: Index, s: Array) -> Array:
    """Σ c_n P_n(s) of the panels, by the three-term recurrence."""
    before, now = np.ones_like(s), s
    total = c[panel, 0][:, None] + c[panel, 1][:, None] * s
    for n in range(2, c.shape[1]):
        before, now = now, ((2 * n - 1) * s * now - (n - 1) * before) / n
        total = total + c[panel, n][:, None] * now
    return np.asarray(total)


def _parts(o: Operator, panels: GapPanels) -> tuple[Index, Array, Array, NDArray[np.bool_]]:
    """Panels cut at the breaks of H: (panel, lo, hi, whether it begins at the edge); of voids
    nothing.
    """
    pieces = o.pieces
    edge = panels.points.anchor[:, 0]
    sign = np.where(panels.right, -1.0, 1.0)
    near, far = (edge + sign * distance_of(v, panels.width)[0] for v in (panels.lo, panels.hi))
    low, high = np.minimum(near, far), np.maximum(near, far)
    start, stop = np.searchsorted(pieces.cuts, low, "right"), np.searchsorted(pieces.cuts, high)
    count = np.maximum(stop - start, 0)
    panel = np.repeat(np.arange(len(low)), count)
    which = start[panel] + np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    cut = panels.parameter(panel, np.abs(pieces.cuts[which] - edge[panel]))
    every = np.concatenate((panel, np.arange(len(low)), np.arange(len(low))))
    place = np.concatenate((np.clip(cut, panels.lo[panel], panels.hi[panel]), panels.lo, panels.hi))
    order = np.lexsort((place, every))
    every, place = every[order], place[order]
    same = (every[1:] == every[:-1]) & (place[1:] > place[:-1])
    panel, lo, hi = every[:-1][same], place[:-1][same], place[1:][same]
    middle = edge[panel] + sign[panel] * distance_of(0.5 * (lo + hi), panels.width[panel])[0]
    solid = ~pieces.void[pieces.locate(middle)]
    return panel[solid], lo[solid], hi[solid], (lo == 0.0)[solid]


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


def gap_volume(o: Operator) -> float:
    """∫ of the gap over all gaps between patches, or of a period, where there is an indenter."""
    panels = gap_panels(o.patches, o.pieces, outside=True)
    inner = np.flatnonzero(np.isfinite(panels.width))
    if not inner.size:
        return 0.0
    side = sides(o, panels)
    panel, lo, hi, _ = _parts(o, panels)
    kept = np.isin(panel, inner)
    panel, lo, length = panel[kept], lo[kept, None], (hi - lo)[kept, None]
    g, w = chebyshev.gauss_legendre(panels.dx.shape[1])
    t = lo + length * g
    value, _, _ = opening(o, side, panel, t)
    _, _, derivative = distance_of(t, panels.width[panel, None])
    return float((value * derivative * length * w).sum())
