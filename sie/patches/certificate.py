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

The pieces that resolved a function are compared with it: in the patches at places of a
low-discrepancy sequence, beside them where its slope turns. Where they differ it is resolved anew,
and the bounds of the gap are computed with that.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sie.errors import ResolutionError
from sie.numerics.interval import EPS, Interval
from sie.profiles.look import (
    FINER,
    across,
    beside,
    closer,
    falls,
    may_touch,
    misfit,
    narrow_parts,
    start_of,
    turns,
    values,
)
from sie.profiles.look import (
    MOST as MOST_PLACES,
)
from sie.profiles.pieces import ROUNDINGS
from sie.progress_bar import reported

from .density import PatchPressure
from .gap import gap, overlaps
from .newton import Linear, conditions_of
from .of_scene import Problem, whole_window
from .operator import Found, Operator
from .result import CLOSE, LEAST, PatchCertificate
from .rule import SHORT, Rule, principal_value
from .state import Unseen

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Height = Callable[[Array], Array]

EXPLAINED = 16.0  # times what half an ulp of the edges changes
MOST = 1e-3  # of the peak: where that is more nothing is certified
SHARED = 1e-8  # of the load of a patch: what the rounding of h may change without a note
# gaps that are measured, about, and at which parts of their widths
GAPS, PARTS = 8, np.array([0.07, 0.37, 0.72, 0.91])
MISFIT = 64.0 * EPS  # of a slope: what a patch's own window leaves out of it
MARGIN = 0.1  # of the way to a place beyond the window, by which a window has to hold it
SCALE = 1e-3  # of the load over E*/2: the least length that a gap is compared with
NARROWEST = 1e-6  # of the whole contact: of a narrower gap doubles tell too few digits


@reported("certificate")
def certificate(
    found: Found,
    pressure: PatchPressure,
    height: Height,
    tol: float,
    missed: Unseen,
) -> PatchCertificate:
    """Measure an answer, by the height h too; `missed` is what the pieces do not show of it."""
    given, o, G = found.given, found.operator, pressure.half_modulus
    P = o.patches
    rule, places = pressure.rules
    p, at = pressure.at_rule, pressure.at_points(places.points, places.patch, places.piece)
    peak, x = float(at.max()), places.points
    H = o.pieces.value(places.piece, x.anchor, x.offset) + pressure.tilt
    total = principal_value(P, rule, p, (x, places.patch), at)
    load = float(rule.weight @ p)
    hull, middle = 0.5 * P.hull, 0.5 * float(P.b[-1] + P.a[0])
    asked = G * given.load
    moment = 0.0
    if given.moment is not None:
        found_moment = float(rule.weight @ (p * (rule.points.x - middle))) + load * middle
        moment = abs(found_moment - G * given.moment) / (asked * hull)
    linear = conditions_of(found)
    condition = conditioning(found, linear)
    measured_to = max(LEAST, min(EXPLAINED * _rounding(found, linear, peak / G), MOST))
    return PatchCertificate(
        residual=float(np.abs(total - G * H).max(initial=0.0)) / peak,
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
        notes=_notes(found, condition),
    )


def _notes(found: Found, condition: float) -> tuple[str, ...]:
    """Of patches about to appear or merge, and of what the rounding of h leaves open."""
    share = found.state.patches.unknown_share(found.operator.pieces, found.given.load)
    notes = (
        (
            condition >= CLOSE,
            "a patch of contact is about to appear, or two to merge: a change of the load by 1e-9 "
            f"changes the narrowest patch or gap by {1e-9 * condition:.0e} of its width",
        ),
        (
            share > SHARED,
            "the depths of the valleys are known to the rounding of h, and the loads of the "
            f"patches to {share:.0e} of them",
        ),
    )
    return tuple(f"note: {sentence}" for holds, sentence in notes if holds)


def conditioning(found: Found, linear: Linear) -> float:
    """The largest |d e / d ln P| of an edge e over its patch or gap."""
    state = found.state
    change = np.abs(linear.growth(state, found.given.load)) / state.patches.narrower
    return float(np.nan_to_num(change, nan=np.inf).max(initial=0.0))


def _rounding(found: Found, linear: Linear, peak: float) -> float:
    """The largest relative change of p, load or moment by rounding of the edges and the slope.

    All smooth edges move by half an ulp, as if at random. `peak` is in units of E*/2.

    An edge that moves is a point charge, which the conditions of the patches and of the load miss.
    """
    o, P, given = found.operator, found.state.patches, found.given
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
    concave = np.zeros(len(pieces.breaks))
    concave[1:-1] = np.maximum(-pieces.steps, 0.0)
    meets = np.abs(ends - pieces.breaks[at]) <= SHORT * length
    ulp = np.spacing(np.maximum(np.abs(ends), o.patches.r[k.patch]))
    charge = np.where(meets, concave[at] * ulp, 0.0) / np.pi
    long = length > 0.0  # rounding may leave a panel no length: no place is on it
    return float((charge[:, long] / (SHORT * length[long])).max(initial=0.0))


def _error_of_gap(
    pressure: PatchPressure, height: Height, rule: tuple[Rule, Array], measured_to: float
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


# -- what the pieces do not show -------------------------------------------------------------------


def unseen(found: Found, problem: Problem) -> Unseen:
    """What the pieces of a contact have missed; nothing of a profile that is no function."""
    if not problem.by_slope:
        return Unseen()
    o, P, slope = found.operator, found.state.patches, problem.slope
    edges = float(P.a[0]), float(P.b[-1])
    x = _looked_at(problem, edges)
    turn = turns(slope, x)
    missed = o.pieces.missed(slope, turn)
    beyond = _beyond(found, problem, x)
    resolution = _misfit(found, problem)
    if not missed.size and not beyond.size:
        return Unseen(resolution)
    narrow = narrow_parts(slope, x)
    narrow = narrow if narrow.size else missed[:MOST_PLACES]
    window = whole_window(problem) if problem.chord.periodic else o.pieces.domain
    if beyond.size:
        away = MARGIN * np.ptp(np.append(beyond, edges))
        lo, hi = float(beyond.min()) - away, float(beyond.max()) + away
        window = max(min(window[0], lo), x[0]), min(max(window[1], hi), x[-1])
    try:
        pieces = problem.pieces(window, narrow)
        seen = overlaps(Operator(P, pieces, o.Y), found.state.tilt, problem.given.load).overlap
    except ResolutionError:  # of waves without end
        return Unseen(resolution)
    least = SCALE * problem.given.load
    lowest = min((-v.depth / max(v.largest, least) for v in seen), default=0.0)
    return Unseen(resolution, lowest, seen)


def _looked_at(problem: Problem, edges: tuple[float, float]) -> Array:
    """The places of the certificate, on the whole indenter or on a period."""
    slope, start = problem.slope, start_of(edges)
    if problem.chord.periodic:
        return across(slope, whole_window(problem), start)
    left, right = beside(edges, slope, FINER, start)
    x = np.concatenate((left, across(slope, edges, start), right))
    return np.unique(x[np.isfinite(x)])


def _beyond(found: Found, problem: Problem, x: Array) -> Array:
    """The places among x, and closer ones, beyond the window where the bodies may touch."""
    P, (lo, hi), places = found.state.patches, found.operator.pieces.domain, []
    for side, edge, end in ((-1.0, float(P.a[0]), lo), (1.0, float(P.b[-1]), hi)):
        distance = side * (x - edge)
        out = np.sort(distance[distance > 0.0])
        if problem.chord.periodic or not out.size or side * (end - edge) >= out[-1]:
            continue
        out = closer(out, falls(side * values(problem.slope, edge + side * out)))
        H = side * (values(problem.slope, edge + side * out) + found.state.tilt)
        low = may_touch(out, H, float(P.r.min()), problem.given.load)
        places.append(edge + side * out[low & (out > side * (end - edge))])
    return np.concatenate((*places, np.zeros(0)))


def _misfit(found: Found, problem: Problem) -> float:
    """The largest difference between a function and its pieces, beyond rounding, on the patches."""
    pieces, P = found.operator.pieces, found.state.patches
    largest = 0.0
    for a, b in zip(P.a.tolist(), P.b.tolist(), strict=True):
        if problem.domain[0] <= a and b <= problem.domain[1]:
            _, missed = misfit(problem.slope, (pieces,), Interval(a, b), MISFIT)
            largest = max(largest, float(missed.max(initial=0.0)))
    return largest
