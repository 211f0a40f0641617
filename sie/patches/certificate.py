"""The certificate of contact in several patches, by sums that the solver did not use.

residual      max |1/π PV∫p(t)/(x - t) dt - E*/2 (h' + θ)| / peak; per period the kernel is
              (π/λ) cot(π(x - t)/λ)
equilibrium   |∫p dx - P| / P, |∫p x dx - M| / (P r)
gap           h + θx - 2/(πE*) ∫p ln|x - t| dt less the gap is constant in each gap: what it varies
              by beyond rounding, over the largest gap, or change of the integral, at these places
inequalities  the lowest bound of D over the largest D, and places where the gap would be negative
resolution    E*/2 |h' - its resolution| / peak of a function, at places of its own (`unseen`)
condition     relative change of the narrowest patch or gap per relative change of the load; it is
              large where a patch is about to appear, or two to merge
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.progress_bar import reported, step_done

from .chord import Points
from .density import PatchPressure
from .gap import gap
from .newton import Linear, conditions
from .operator import Found, Operator
from .panels import LONG, PatchPanels
from .pieces import ROUNDINGS
from .result import CLOSE, LEAST, PatchCertificate
from .state import Given, Unseen

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]
Height = Callable[[Array], Array]

# nodes on a part of a panel: of those that are graded slowly, and of those of many breaks
NODES, FEWER = 40, 24
STEEP = 4.0  # a panel that is so much longer than its neighbour is cut towards that one
DEEP = 26  # cuts towards a jump of H, each STEEP times nearer: p is infinite there like a logarithm
BESIDE = 5  # cuts towards edges, where there are few panels: down to SHORT
SHORT = 1e-3  # of a panel: on shorter parts the equation is not measured
# ulp of an edge: closer to it the edge's own rounding changes p by a part of 1e-6
APART = 5e5
PLACES = 120  # at which it is, about
TOGETHER = 32  # of them at once
EXPLAINED = 16.0  # times what half an ulp of the edges changes
MOST = 1e-3  # of the peak: where that is more nothing is certified
SHARED = 1e-9  # of the load of a patch: what the rounding of h may change without a note
# gaps that are measured, about, and at which parts of their widths
GAPS, PARTS = 8, np.array([0.07, 0.37, 0.72, 0.91])
NARROWEST = 1e-6  # of the whole contact: of a narrower gap doubles tell too few digits


@reported("certificate")
def certificate(
    found: Found,
    pressure: PatchPressure,
    asked_for: tuple[Given, Height],
    tol: float,
    missed: Unseen,
) -> PatchCertificate:
    """Measure an answer, by what was asked in units of E*/2 and the height h.

    `missed` is what the pieces of a function do not show.
    """
    (given, height), o, G = asked_for, found.operator, pressure.half_modulus
    P = o.patches
    rule, places = measured_on(pressure)
    p, at = (pressure.at_points(m.points, m.patch, m.piece) for m in (rule, places))
    p = _without_infinities(rule.points.x, p)
    peak = float(at.max())
    load = float(rule.weight @ p)
    hull, middle = 0.5 * P.hull, 0.5 * float(P.b[-1] + P.a[0])
    asked = G * given.load
    moment = 0.0
    if given.moment is not None:
        found_moment = float(rule.weight @ (p * (rule.points.x - middle))) + load * middle
        moment = abs(found_moment - G * given.moment) / (asked * hull)
    linear = conditions(found.state, o, given)
    condition = conditioning(found, given, linear)
    measured_to = max(LEAST, min(EXPLAINED * _rounding(o, linear, given, peak / G), MOST))
    return PatchCertificate(
        residual=_residual(pressure, (rule, p), (places, at)) / peak,
        force=abs(load - asked) / asked,
        moment=moment,
        gap=_error_of_gap(pressure, height, (rule, p), measured_to),
        lowest_pressure=min(found.findings.lowest, 0.0),
        patches=P.number,
        condition=condition,
        measured_to=measured_to,
        tol=tol,
        tension=tuple((t.lo, t.hi) for t in found.findings.tension),
        overlap=tuple((v.lo, v.hi) for v in (*found.findings.overlap, *missed.overlap)),
        resolution=G * missed.resolution / peak,
        lowest_gap=missed.lowest_gap,
        notes=(
            *_notes(condition),
            *_notes_on_heights(found, linear),
        ),
    )


def _without_infinities(x: Array, p: Array) -> Array:
    """p of a rule, infinite at a jump of H closer than doubles tell, there as beside it.

    With 0 there the rule would miss the load of that length, some ulps of x times p: a point charge
    to the places near the jump.
    """
    finite, infinite = np.isfinite(p), np.isinf(p)
    if not (infinite.any() and finite.any()):
        return np.where(finite, p, 0.0)
    beside = np.flatnonzero(finite)[np.argsort(x[finite])]
    filled = np.where(finite, p, 0.0)
    filled[infinite] = np.interp(x[infinite], x[beside], p[beside])
    return filled


def _notes(condition: float) -> tuple[str, ...]:
    if condition < CLOSE:
        return ()
    sentence = (
        f"note: a patch of contact is about to appear, or two to merge: a change of the load by "
        f"1e-9 changes the narrowest patch or gap by {1e-9 * condition:.0e} of its width"
    )
    return (sentence,)


def _notes_on_heights(found: Found, linear: Linear) -> tuple[str, ...]:
    """What the rounding of h leaves open: the loads of patches, and whether there is another."""
    P, doubt = found.state.patches, found.findings.doubt
    moved = linear.rounded_moves(found.state) / np.repeat(P.r, 2)
    share = 2.0 * float(np.nan_to_num(np.abs(moved)).max())
    notes = []
    if share > SHARED:
        notes.append(
            "note: the depths of the valleys are known to the rounding of h, and the loads of the "
            f"patches to {share:.0e} of them"
        )
    if doubt:
        notes.append(
            f"note: doubles of h tell {doubt:.0e} of a depth, and do not tell whether the bodies "
            f"touch at x = {found.findings.place:.6g}"
        )
    return tuple(notes)


def conditioning(found: Found, given: Given, linear: Linear) -> float:
    """The largest |d e / d ln P| of an edge e over its patch or gap."""
    state = found.state
    change = np.abs(linear.growth(state, given.load)) / state.patches.narrower
    return float(np.nan_to_num(change, nan=np.inf).max(initial=0.0))


def _rounding(o: Operator, linear: Linear, given: Given, peak: float) -> float:
    """The largest relative change of p, load or moment by rounding of the edges and the slope.

    All smooth edges move by half an ulp, as if at random. `peak` is in units of E*/2.

    An edge that moves is a point charge, which the conditions of the patches and of the load miss.
    """
    P = o.patches
    charge = 0.25 * linear.intensity * np.spacing(np.abs(P.edges))
    force = charge * P.chord.apart(np.repeat(P.r, 2))
    pole, _ = P.chord.poles(P.chord.difference(P.c[:, None] - P.edges))
    missed = np.linalg.norm(pole * (force / peak), axis=1)  # a square of the load may be no double
    part = force / given.load
    lever = P.edges / (0.5 * P.hull) if given.moment is not None else np.zeros_like(part)
    terms = o.pieces.terms(o.panels.piece, o.panels.points.x[:, 0])
    # the rounding of a function is that of its values from patch to patch
    between = slice(int(o.pieces.locate(P.a[0])), int(o.pieces.locate(P.b[-1])) + 1)
    series = np.abs(o.pieces.series[between]).sum(axis=1)
    largest = max(float(terms.max(initial=0.0)), float(series.max(initial=0.0)))
    return max(
        float((missed * o.S[:, 1]).max()) / np.pi,
        float(np.linalg.norm(part)),
        float(np.linalg.norm(part * lever)),
        float(np.spacing(largest)) / (2.0 * peak),
        _charge_of_closed_corners(o) / peak,
    )


def _charge_of_closed_corners(o: Operator) -> float:
    """What an ulp of the place of a concave corner inside a patch changes in H close to it.

    p has -(step of H)/π ln(distance) there: an ulp is a charge of as much to the nearest places.
    """
    k, pieces, ends = o.panels, o.pieces, np.stack(o.ends)
    at, length = k.piece + np.array([[0], [1]]), ends[1] - ends[0]
    concave = np.zeros(len(pieces.ends))
    concave[1:-1] = np.maximum(-pieces.steps, 0.0)
    meets = np.abs(ends - pieces.ends[at]) <= SHORT * length
    ulp = np.spacing(np.maximum(np.abs(ends), o.patches.r[k.patch]))
    charge = np.where(meets, concave[at] * ulp, 0.0) / np.pi
    long = length > 0.0  # rounding may leave a panel no length: no place is on it
    return float((charge[:, long] / (SHORT * length[long])).max(initial=0.0))


class Measure(NamedTuple):
    """Points on patches, the pieces of H that they are on, and weights dx."""

    points: Points
    patch: Index
    piece: Index
    weight: Array


def measured_on(pressure: PatchPressure) -> tuple[Measure, Measure]:
    """A composite rule on the panels of an operator, and places between its points.

    At the latter the equation is measured.

    The variable is bent at the ends of panels: p has breaks like s² ln s where H' of a spline has,
    and s^8 ln s is easy. At an edge p is smooth in the angle.
    """
    o = pressure.operator
    k = o.panels
    nodes = NODES if k.angle.shape[1] == LONG.nodes else FEWER
    panel, lo, length = _cut(k, _jumps_at_ends(o))
    g, w = _bent(lo == 0.0, nodes)
    rule = _at_angles(k, pressure, panel, lo[:, None] + length[:, None] * g)
    rule = rule._replace(weight=(length[:, None] * w).ravel() * rule.weight)
    r, edge = o.patches.r[k.patch[panel]], k.points.anchor[panel, 0]
    far = 2.0 * r * np.sin(0.5 * (lo + 0.25 * length)) ** 2 >= np.minimum(
        APART * np.spacing(np.abs(edge)), 0.1 * r
    )
    some = np.flatnonzero((length > SHORT * (k.hi - k.lo)[panel]) & far)
    some = some if some.size else np.arange(len(lo))
    some = some[:: max(len(some) // PLACES, 1)]
    number = min(-(-PLACES // len(some)), nodes // 2)
    # Not close to the ends of parts, between which a place makes the kernel as steep as it is
    # close, and midway between two points: beside one the quotient is rounding.
    wanted = 0.25 + 0.5 * (np.arange(number) + 0.5) / number
    g = g[some]
    after = (g[:, :, None] < wanted).sum(axis=1)
    part = 0.5 * (np.take_along_axis(g, after - 1, 1) + np.take_along_axis(g, after, 1))
    angle = lo[some, None] + length[some, None] * part
    return rule, _at_angles(k, pressure, panel[some], angle)


def _jumps_at_ends(o: Operator) -> Mask:
    """Whether H jumps at the end k.lo and at the end k.hi of each panel, (2, p)."""
    k, pieces = o.panels, o.pieces
    jump = np.zeros(len(pieces.ends), dtype=bool)
    jump[1:-1] = pieces.steps != 0.0
    ends = np.stack(o.ends)
    closest = pieces.ends[k.piece + np.array([[0], [1]])]
    reached = np.abs(ends - closest) <= SHORT * (ends[1] - ends[0])
    left, right = reached & jump[k.piece + np.array([[0], [1]])]
    return np.where(k.right, (right, left), (left, right)) & (np.stack((k.lo, k.hi)) > 0.0)


def _cut(k: PatchPanels, jumps: Mask) -> tuple[Index, Array, Array]:
    """Parts (panel, lowest angle, length) of the panels.

    Panels are whole, but beside a much shorter panel, and at a jump of H, no part is longer than
    STEEP times its distance from there.

    At a place on the shorter one the kernel is as steep as its length.
    """
    length = k.hi - k.lo
    order = np.lexsort((np.where(k.right, np.pi - k.hi, k.lo), k.patch))
    meet = k.patch[order][1:] == k.patch[order][:-1]
    left, right = np.full((2, len(length)), np.inf)  # lengths of the neighbours
    left[order[1:]] = np.where(meet, length[order[:-1]], np.inf)
    right[order[:-1]] = np.where(meet, length[order[1:]], np.inf)
    neighbours = np.where(k.right, (right, left), (left, right))  # towards k.lo and k.hi
    times = np.ceil((np.log(length) - np.log(neighbours)) / np.log(STEEP) - 1.0).clip(0.0)
    times = np.where(jumps, DEEP, times)
    if len(length) < PLACES:
        times[0, k.lo == 0.0] = BESIDE
    panels, lows, lengths = [], [], []
    for towards_lo, towards_hi in np.unique(times, axis=1).T.astype(int).tolist():
        chosen = np.flatnonzero((times[0] == towards_lo) & (times[1] == towards_hi))
        lower = STEEP ** -np.arange(towards_lo, 0.0, -1.0)
        upper = 1.0 - STEEP ** -np.arange(1.0, towards_hi + 1.0)
        part = np.concatenate(([0.0], lower, upper, [1.0]))
        lows.append((k.lo[chosen, None] + length[chosen, None] * part[:-1]).ravel())
        lengths.append((length[chosen, None] * np.diff(part)).ravel())
        panels.append(np.repeat(chosen, len(part) - 1))
    return np.concatenate(panels), np.concatenate(lows), np.concatenate(lengths)


def _bent(at_edge: Mask, nodes: int) -> tuple[Array, Array]:
    """Gauss' nodes and weights on [0, 1] in a bent variable.

    Its cube is the distance from an end, the upper one only where the lower one is an edge.
    """
    g, w = chebyshev.gauss_legendre(nodes)
    both = g**3 * (10.0 - 15.0 * g + 6.0 * g * g), 30.0 * w * (g * (1.0 - g)) ** 2
    upper = 1.0 - (1.0 - g) ** 3, 3.0 * w * (1.0 - g) ** 2
    place, weight = (np.where(at_edge[:, None], u, b) for u, b in zip(upper, both, strict=True))
    return place, weight


def _at_angles(k: PatchPanels, pressure: PatchPressure, panel: Index, angle: Array) -> Measure:
    """Points at angles (m, n) on panels (m,), with dx/d(angle) as weights."""
    r = pressure.operator.patches.r[k.patch[panel], None]
    inward = 2.0 * r * np.sin(0.5 * angle) ** 2
    offset = np.where(k.right[panel, None], -inward, inward)
    anchor = np.broadcast_to(k.points.anchor[panel], offset.shape)
    patch, piece = (np.repeat(v[panel], angle.shape[1]) for v in (k.patch, k.piece))
    return Measure(
        Points(anchor.ravel(), offset.ravel()), patch, piece, (r * np.sin(angle)).ravel()
    )


def _residual(
    pressure: PatchPressure, rule: tuple[Measure, Array], places: tuple[Measure, Array]
) -> float:
    """The largest residual at places with their pressures, by a rule with its own."""
    at, values = places
    x = at.points
    H = pressure.operator.pieces.value(at.piece, x.anchor, x.offset) + pressure.tilt
    found = principal_value(pressure, rule, (x, at.patch, values))
    return float(np.abs(found - pressure.half_modulus * H).max(initial=0.0))


def principal_value(
    pressure: PatchPressure, rule: tuple[Measure, Array], places: tuple[Points, Index, Array]
) -> Array:
    """1/π PV∫p(t)/(x - t) dt at places, their patches and pressures, by a rule with its own."""
    P, chord = pressure.operator.patches, pressure.operator.patches.chord
    (by, p), (x, own, values) = rule, places
    left, right = (chord.apart(x.anchor - e[own], x.offset) for e in (P.a, P.b))
    total = values * np.log(left / -right)
    for k in range(0, len(own), TOGETHER):
        step_done(0)
        some = slice(k, k + TOGETHER)
        distance = chord.difference(
            x.anchor[some, None] - by.points.anchor, x.offset[some, None] - by.points.offset
        )
        kernel = chord.kernel(distance)
        taken_out = np.where(by.patch == own[some, None], values[some, None], 0.0)
        total[some] += ((p - taken_out) * kernel) @ by.weight
    return np.asarray(total / np.pi)


def _error_of_gap(
    pressure: PatchPressure, height: Height, rule: tuple[Measure, Array], measured_to: float
) -> float:
    """The largest error of some gaps; p by its rule."""
    o, (by, p) = pressure.operator, rule
    P, chord, (lo, hi) = o.patches, o.patches.chord, o.pieces.domain
    inner = np.arange(P.number - 1 + chord.periodic)[:: -(-P.number // GAPS)]
    inner = inner[P.gaps[inner] > NARROWEST * P.hull]
    start, width = P.b[inner], P.gaps[inner]
    if not chord.periodic:
        beyond = min(P.hull, P.a[0] - lo), min(P.hull, hi - P.b[-1])
        start = np.concatenate((start, (P.a[0] - beyond[0], P.b[-1])))
        width = np.concatenate((width, beyond))
    if not width.size:
        return 0.0
    x = start[:, None] + width[:, None] * PARTS
    h, opened = (f(x.ravel()).reshape(x.shape) for f in (height, lambda x: gap(o, x)))
    open_ = np.isfinite(h) & np.isfinite(opened) & (width > 0.0)[:, None]
    h, opened = (np.where(open_, v, 0.0) for v in (h, opened))
    sums = np.zeros(x.shape)
    for k in zip(*np.nonzero(open_), strict=True):
        distance = chord.apart(x[k] - by.points.anchor, -by.points.offset)
        sums[k] = np.log(np.abs(distance)) @ (p * by.weight) / (np.pi * pressure.half_modulus)
    h = h + pressure.tilt * (x - start[:, None])
    rounding = o.pieces.rounding(x[:, 0], x[:, -1]) + ROUNDINGS * EPS * np.abs(sums).max(axis=1)
    size = np.maximum(opened.max(axis=1), _spread(sums, open_))
    rounding += (
        ROUNDINGS * (size / np.maximum(width, EPS * P.hull)) * np.spacing(np.abs(x).max(axis=1))
    )
    # the pressure itself is known to `measured_to` of its peak, and so is the slope of the gap
    rounding += measured_to * float(p.max()) / pressure.half_modulus * width
    error = _spread(h - sums - opened, open_) - rounding
    return float(np.maximum(error, 0.0).max() / (size.max() or 1.0))


def _spread(v: Array, some: Mask) -> Array:
    """The largest less the least of each row of v at some places, 0 of none."""
    return np.where(some, v, -np.inf).max(axis=1) - np.where(some, v, np.inf).min(axis=1)
