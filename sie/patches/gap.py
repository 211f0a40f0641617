"""The gap beside and between patches: where it would be negative, its values, and its volume.

On panels that count from an edge g'/root is a Legendre series, and g the primitive of one. That
g'/root >= 0 all the way from the edge, or g >= 0, is verified by bounds and not by samples.
"""

from __future__ import annotations

from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ResolutionError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.numerics.tree import parts as portions

from .operator import Operator, gap_values
from .panels import (
    CLEARLY,
    DEEPEST,
    FARTHEST,
    FIRST,
    NODES,
    GapPanels,
    distance_of,
    gap_panels,
    parameter_of,
)
from .state import Findings, Overlap

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Bool = NDArray[np.bool_]

ROUNDING = 7e-14  # of max|H| on the patches times the distance from an edge
# of the load over E*/2: where h is rounded to less, a place that its rounding leaves open carries
# too little to look for it
NEGLIGIBLE = 1e-7
# halved at once, in 100 MB; a hundred patches have a thousand: more are values that are none
MOST = 2**15
OUT_OF_SIGHT = 1e16  # widths of the whole contact: from there doubles do not tell its edges


def overlaps(o: Operator, tilt: float, load: float) -> Findings:
    """Where the gap is negative by more than the rounding of h, at a tilt and a load over E*/2.

    Raises ResolutionError if that is open on more than `MOST` parts.
    """
    beyond = min(1.1 * o.pieces.horizon(tilt, o.patches.c) / o.patches.hull, OUT_OF_SIGHT)
    panels = gap_panels(o.patches, o.pieces, outside=True, farthest=max(FARTHEST, beyond))
    if not len(panels.gap):
        return Findings()
    side = sides(o, panels)
    parts, largest = _left_open(o, tilt, side, _parts(o, panels))
    bad: list[tuple[int, float, float, float]] = []
    doubts = [(0.0, 0.0)]
    for depth in range(DEEPEST):
        last = depth == DEEPEST - 1
        seen = _judged(o, (tilt, load), side, parts, last)
        gap, value, x = panels.gap[parts.panel], seen.value, seen.x
        wide = np.ptp(x, axis=1)
        for j, m in zip(*np.nonzero(seen.negative), strict=True):
            bad.append((int(gap[j]), float(x[j, m]), float(value[j, m]), float(wide[j])))
        if seen.unsure.any():
            worst = int(np.argmax(np.where(seen.unsure, seen.rounding, 0.0)))
            place = float(x[worst, np.argmin(value[worst])])
            doubts.append((float(seen.rounding[worst]), place))
        count = int(np.count_nonzero(seen.unknown))
        if not count or last:
            break
        if count > MOST:
            raise _undecided(count, x[seen.unknown])
        parts = parts._replace(opened=seen.opened).halved(seen.unknown)
    doubt, place = max(doubts, key=itemgetter(0))
    return Findings(overlap=_gathered(bad, largest), doubt=doubt, place=place)


class Parts(NamedTuple):
    """Parts of panels, from lo to hi in their parameter, ascending on each side of a gap.

    opened     whether the gap does nothing but open from the edge up to lo
    """

    panel: Index
    lo: Array
    hi: Array
    opened: Bool

    def halved(self, kept: Bool) -> Parts:
        """The halves of those that are kept."""
        twice = self.among(np.repeat(np.flatnonzero(kept), 2))
        twice.lo[1::2] = twice.hi[::2] = 0.5 * (twice.lo + twice.hi)[::2]
        twice.opened[1::2] = False
        return twice

    def among(self, some: Any) -> Parts:
        return Parts(self.panel[some], self.lo[some], self.hi[some], self.opened[some])

    def followed(self, run: Index, rising: Bool) -> Bool:
        """`opened` of these parts, by the side (run) of each panel and what rises all over."""
        after = (self.lo[1:] == self.hi[:-1]) & (np.diff(run[self.panel]) == 0)
        begins = self.opened | ~np.concatenate(([False], after))
        first = np.maximum.accumulate(np.where(begins, np.arange(len(begins)), 0))
        before: Index = np.cumsum(~rising) - ~rising
        return np.asarray(self.opened[first] & (before == before[first]))


def _left_open(o: Operator, tilt: float, side: Side, parts: Parts) -> tuple[Parts, Array]:
    """The parts on which a first look does not tell that the bodies are apart.

    With them come the largest gaps (N + 1,), no farther from an edge than the contact is wide.
    """
    k, (g, _) = side.panels, chebyshev.gauss_legendre(FIRST)
    anchor, sign = k.points.anchor[:, 0], side.sign
    far = anchor + sign * distance_of(k.hi, k.width)[0]
    tolerance = _tolerances(o, tilt, np.minimum(anchor, far), np.maximum(anchor, far))[1]
    open_, largest = np.ones(len(parts.lo), dtype=bool), np.zeros(o.patches.number + 1)
    for some in portions(len(parts.lo), FIRST):
        panel, lo, hi, _ = parts.among(some)
        value, x = opening(o, side, panel, lo[:, None] + (hi - lo)[:, None] * g)
        open_[some] = ~(
            chebyshev.lower_bound(value) > np.maximum(CLEARLY * value.mean(1), tolerance[panel])
        )
        last = (value @ chebyshev.legendre(FIRST)).sum(axis=1)  # at hi, such as the middle of a gap
        near = np.isfinite(last) & (np.abs(x[:, -1] - anchor[panel]) <= o.patches.hull)
        np.maximum.at(largest, k.gap[panel] + 1, np.where(near, last, 0.0))
    return parts.among(open_), largest


def _tolerances(o: Operator, tilt: float, lo: Array, hi: Array) -> tuple[Array, Array]:
    """The rounding of h on intervals that begin or end at an edge, and that of the gap."""
    rounding = o.pieces.rounding(lo, hi) + EPS * abs(tilt) * (hi - lo)
    return rounding, rounding + ROUNDING * float(np.abs(o.H).max()) * (hi - lo)


class Judged(NamedTuple):
    """What the gap at points (m, n) of parts (m,) tells.

    value      the gap
    x          its places
    negative   where the gap is negative for sure
    rounding   a bound of the rounding of h (m,)
    unsure     whether that rounding hides what the gap is
    unknown    whether a part has to be halved
    opened     what `Parts` has of that name
    """

    value: Array
    x: Array
    negative: Bool
    rounding: Array
    unsure: Bool
    unknown: Bool
    opened: Bool


def _judged(
    o: Operator, given: tuple[float, float], side: Side, parts: Parts, last: bool
) -> Judged:
    """What is known on parts at a tilt and a load; on the last ones no rounding is looked into."""
    tilt, load = given
    anchor = side.panels.points.anchor[parts.panel]
    g, _ = chebyshev.gauss_legendre(NODES)
    t = parts.lo[:, None] + (parts.hi - parts.lo)[:, None] * g
    value, x = opening(o, side, parts.panel, t)
    lo, hi = np.minimum(anchor[:, 0], x.min(axis=1)), np.maximum(anchor[:, 0], x.max(axis=1))
    rounding, tolerance = _tolerances(o, tilt, lo, hi)
    bound = chebyshev.lower_bound(value)
    rising = chebyshev.lower_bound(_opens(o, side, parts.panel, t)) >= 0.0
    opened = parts.followed(np.cumsum(side.panels.lo == 0.0), rising)
    opens = opened & rising
    matters = (rounding > NEGLIGIBLE * load) & ~opens & (bound < tolerance)
    enough = (bound >= -tolerance) & ~(matters & (not last)) | opens
    may_be = ~opens & (bound < -tolerance)
    negative = (value < -tolerance[:, None]) & may_be[:, None]
    sure = negative.any(axis=1)
    unsure = matters & ~sure & (value < tolerance[:, None]).any(axis=1)
    unknown = ~enough & ~sure & ~unsure
    return Judged(value, x, negative, rounding, unsure, unknown, opened)


def _undecided(count: int, x: Array) -> ResolutionError:
    return ResolutionError(
        f"whether the bodies overlap between x = {x.min():.6g} and {x.max():.6g} is still open on "
        f"{count} parts of the gap, and {MOST} are the most: raise the load, or give a smoother "
        "profile"
    )


def _gathered(bad: list[tuple[int, float, float, float]], largest: Array) -> tuple[Overlap, ...]:
    """Neighbouring places of overlap as one.

    Each place comes with the width of the part that it is on.
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


class Side(NamedTuple):
    """The known values of g on panels that count from an edge.

    These are Legendre coefficients (p, n) of sign Φ and of the integrand, and g at its start.
    """

    panels: GapPanels
    sign: Array
    phi: Array
    primitive: Array
    start: Array


def sides(o: Operator, panels: GapPanels) -> Side:
    _, T, D = gap_values(o, panels)
    sign = np.where(panels.right, -1.0, 1.0)
    phi = sign[:, None] * T * D / (np.pi * panels.root)
    n = phi.shape[1]
    half = 0.5 * (panels.hi - panels.lo)
    _, _, derivative = distance_of(_nodes(panels), panels.width[:, None])
    integrand = half[:, None] * phi * panels.root * derivative
    c = integrand @ chebyshev.legendre(n)
    primitive = np.asarray(np.polynomial.legendre.legint(c, lbnd=-1, axis=1), dtype=float)
    first = np.flatnonzero(panels.lo == 0.0)
    run = np.cumsum(panels.lo == 0.0) - 1
    position = np.arange(len(run)) - first[run]
    # each gap has sums of its own: in one of all, those far beyond the contact would swamp them
    sums = np.zeros((len(first), int(position.max()) + 2))
    sums[run, position + 1] = primitive.sum(axis=1)
    start = np.cumsum(sums, axis=1)[run, position]
    return Side(panels, sign, phi @ chebyshev.legendre(n), primitive, start)


def _nodes(panels: GapPanels) -> Array:
    g, _ = chebyshev.gauss_legendre(panels.dx.shape[1])
    return np.asarray(panels.lo[:, None] + (panels.hi - panels.lo)[:, None] * g)


def opening(o: Operator, side: Side, panel: Index, t: Array) -> tuple[Array, Array]:
    """g and x at parameters t (m, n) on panels (m,)."""
    distance, anchor, x, sign, s = _placed(side, panel, t)
    # ∫ (H - reference) from the edge
    rise = o.pieces.rises(np.minimum(anchor, x).ravel(), np.maximum(anchor, x).ravel(), walls=True)
    referenced = _referenced(o, side.panels, panel, distance, sign)
    bent = side.start[panel, None] + _series(side.primitive, panel, s)
    return sign * (rise.reshape(x.shape) - referenced) + bent, x


def _opens(o: Operator, side: Side, panel: Index, t: Array) -> Array:
    """g'/root, away from the edge, at the same places."""
    k, pieces, (distance, anchor, x, sign, s) = side.panels, o.pieces, _placed(side, panel, t)
    root = distance_of(t, k.width[panel, None])[1]
    at, own, follows = pieces.locate(x), k.piece[panel][:, None], k.follows[panel, None]
    reference = pieces.value(own, anchor, np.where(follows, sign * distance, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        beyond = sign * (pieces.value(at, x, 0.0) - reference) / root
        beyond = np.where(follows & (at == own), 0.0, beyond)
        return np.asarray(_series(side.phi, panel, s) + beyond)


def _placed(side: Side, panel: Index, t: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Parameters t (m, n) of panels (m,): distance from the edge, edge, x, direction, s."""
    k = side.panels
    lo, hi, sign = k.lo[panel, None], k.hi[panel, None], side.sign[panel, None]
    distance = distance_of(t, k.width[panel, None])[0]
    anchor = np.broadcast_to(k.points.anchor[panel], distance.shape)
    return distance, anchor, anchor + sign * distance, sign, (2.0 * t - (lo + hi)) / (hi - lo)


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


def _parts(o: Operator, panels: GapPanels) -> Parts:
    """Panels cut at the breaks of H. Voids have none."""
    pieces = o.pieces
    edge = panels.points.anchor[:, 0]
    sign = np.where(panels.right, -1.0, 1.0)
    near, far = (edge + sign * distance_of(v, panels.width)[0] for v in (panels.lo, panels.hi))
    low, high = np.minimum(near, far), np.maximum(near, far)
    start, stop = np.searchsorted(pieces.cuts, low, "right"), np.searchsorted(pieces.cuts, high)
    count = np.maximum(stop - start, 0)
    panel = np.repeat(np.arange(len(low)), count)
    which = start[panel] + np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    cut = parameter_of(np.abs(pieces.cuts[which] - edge[panel]), panels.width[panel])
    every = np.concatenate((panel, np.arange(len(low)), np.arange(len(low))))
    place = np.concatenate((np.clip(cut, panels.lo[panel], panels.hi[panel]), panels.lo, panels.hi))
    order = np.lexsort((place, every))
    every, place = every[order], place[order]
    same = (every[1:] == every[:-1]) & (place[1:] > place[:-1])
    panel, lo, hi = every[:-1][same], place[:-1][same], place[1:][same]
    middle = edge[panel] + sign[panel] * distance_of(0.5 * (lo + hi), panels.width[panel])[0]
    solid = ~pieces.void[pieces.locate(middle)]
    return Parts(panel, lo, hi, lo == 0.0).among(solid)


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
    walled = pieces.void[piece] & (at > pieces.breaks[piece])
    beside = np.flatnonzero(~inside & ~walled & (at >= lo) & (at <= hi))
    if not beside.size:
        return out
    farthest = np.abs(at[beside] - 0.5 * (P.a[0] + P.b[-1])).max() / P.hull
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
    t = parameter_of(distance, panels.width[first])
    panel = first.copy()
    for _ in range(int((last - first).max(initial=0))):
        panel = np.where((panel < last) & (t > panels.hi[panel]), panel + 1, panel)
    value, _ = opening(o, side, panel, t[:, None])
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
    value, _ = opening(o, side, panel, t)
    _, _, derivative = distance_of(t, panels.width[panel, None])
    return float((value * derivative * length * w).sum())
