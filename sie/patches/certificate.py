"""The certificate of contact in several patches, by sums that the solver did not use.

residual      max |1/π PV∫p(t)/(x - t) dt - E*/2 (h' + θ)| / peak; per period the kernel is
              (π/λ) cot(π(x - t)/λ)
equilibrium   |∫p dx - P| / P, |∫p x dx - M| / (P r)
inequalities  the lowest bound of D over the largest D, and places where the gap would be negative
condition     relative change of the narrowest patch per relative change of the load; it is large
              where a patch is about to appear, or two to merge
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .density import PatchPressure
from .newton import conditions
from .operator import Found, Operator
from .panels import PatchPanels
from .result import GRADING, LEAST, PatchCertificate
from .state import Given, State

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]

NODES = 12  # on a part of a panel
# (panels, levels): where there are no more panels, their parts shrink towards the ends so often
LEVELS = ((24, 32), (60, 18))
BENT = 24  # nodes on a whole panel where there are more, or on its parts
STEEP = 4.0  # a panel that is so much longer than its neighbour is cut towards that one
SHORT = 1e-3  # of a panel: on shorter parts the equation is not measured
PLACES = 120  # at which it is, about
TOGETHER = 32  # of them at once
EXPLAINED = 16.0  # times an ulp of x
MOST = 1e-3  # of the peak: where an ulp of x can do more nothing is certified
JUMP = 1e-9  # of H: less is rounding
# what the sum on whole panels may miss where H jumps and p is infinite at their ends
ROUGH = 1e-7
CLOSE = 1e4  # condition from which a patch is about to appear, or two to merge


def certificate(
    found: Found, pressure: PatchPressure, given: Given, tol: float
) -> PatchCertificate:
    """Measure an answer; `given` is what was asked, in units of E*/2."""
    o, P = found.operator, found.operator.patches
    rule = _measure(o.panels, pressure)
    x, weight = rule.x, rule.weight
    p = pressure(x)
    p = np.where(np.isfinite(p), p, 0.0)
    peak = float(pressure(rule.at).max())
    residual = _residual(pressure, rule, p)
    load = float(weight @ p)
    hull = 0.5 * float(P.b[-1] - P.a[0])
    middle = 0.5 * float(P.b[-1] + P.a[0])
    asked = pressure.half_modulus * given.load
    moment = 0.0
    if given.moment is not None:
        moment = abs(
            float(weight @ (p * (x - middle)))
            + load * middle
            - pressure.half_modulus * given.moment
        ) / (asked * hull)
    f = found.findings
    condition = conditioning(found.state, o.pieces, given)
    return PatchCertificate(
        residual=residual / peak,
        force=abs(load - asked) / asked,
        moment=moment,
        lowest_pressure=min(f.lowest, 0.0),
        patches=P.number,
        condition=condition,
        measured_to=max(
            ROUGH if _misses_jumps(o) else LEAST, min(EXPLAINED * _rounding(rule, p) / peak, MOST)
        ),
        tol=tol,
        tension=tuple((t.lo, t.hi) for t in f.tension),
        overlap=tuple((v.lo, v.hi) for v in f.overlap),
        notes=_notes(condition),
    )


def _notes(condition: float) -> tuple[str, ...]:
    if condition < CLOSE:
        return ()
    sentence = (
        "note: a patch of contact is about to appear, or two to merge: a change of the load by "
        f"1e-9 changes the narrowest patch by {1e-9 * condition:.0e} of its width"
    )
    return (sentence,)


def conditioning(state: State, pieces: Any, given: Given) -> float:
    """|d ln r / d ln P| of the patch for which it is largest."""
    _, linear = conditions(state, pieces, given)
    size = np.abs(linear.matrix).max(axis=1)
    N = state.patches.number
    right = np.zeros(2 * N + 1)
    right[2 * N - 1] = given.load
    y = np.linalg.solve(linear.matrix / size[:, None], right / size)[: 2 * N]
    smooth = ~state.sharp
    D = np.where(smooth, linear.intensity, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        move = np.where(smooth, 2.0 * y / D, 0.0).reshape(-1, 2)
    change = np.abs(move).max(axis=1) / state.patches.r
    return float(np.nan_to_num(change, nan=np.inf).max(initial=0.0))


class Measure(NamedTuple):
    """Places x with weights dx and their patches; and places between them, on patches, where the
    equation is measured.
    """

    x: Array
    weight: Array
    patch: Index
    at: Array
    own: Index


def _misses_jumps(o: Operator) -> bool:
    """Whether H jumps on a patch and panels are not cut into parts."""
    k, pieces = o.panels, o.pieces
    if len(k.lo) <= LEVELS[-1][0]:
        return False
    x = pieces.ends[1:-1]
    patch = np.maximum(np.searchsorted(o.patches.a, x) - 1, 0)
    inner = np.flatnonzero((x > o.patches.a[patch]) & (x < o.patches.b[patch]))
    below, above = (pieces.value(inner + m, x[inner], 0.0) for m in (0, 1))
    size = np.maximum(np.abs(below), np.abs(above))
    return bool((np.abs(above - below) > JUMP * size).any())


def _measure(k: PatchPanels, pressure: PatchPressure) -> Measure:
    """A composite rule that is finer towards the ends of panels, where p' may be infinite and p
    too. At an edge p is smooth in the angle.

    The parts of few panels shrink towards such an end. Many are taken whole, or nearly, with the
    variable bent there: p has breaks like s² ln s where H' of a spline has, and s^8 ln s is easy.
    """
    levels = next((level for most, level in LEVELS if len(k.lo) <= most), 0)
    at_edge = k.lo == 0.0
    if not levels:
        parts = _cut_towards_shorter(k)
        return _placed(k, pressure, parts, _bent(parts[1] == 0.0))
    graded = GRADING ** np.arange(1.0, levels + 1.0)
    cuts = (np.array([0.0, 0.5]), graded, 1.0 - graded[::-1], np.ones(1))
    lows, lengths, panels = [], [], []
    for chosen, kept in ((~at_edge, cuts), (at_edge, cuts[:1] + cuts[2:])):
        part = np.unique(np.concatenate(kept))
        extent = (k.hi - k.lo)[chosen, None]
        lows.append((k.lo[chosen, None] + extent * part[:-1]).ravel())
        lengths.append((extent * np.diff(part)).ravel())
        panels.append(np.repeat(np.flatnonzero(chosen), len(part) - 1))
    lo, length, panel = (np.concatenate(v) for v in (lows, lengths, panels))
    return _placed(k, pressure, (panel, lo, length), chebyshev.gauss_legendre(NODES))


def _cut_towards_shorter(k: PatchPanels) -> tuple[Index, Array, Array]:
    """Parts (panel, lowest angle, length) of the panels: whole, but beside a much shorter panel no
    longer than STEEP times their distance from there.

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


def _bent(at_edge: Mask) -> tuple[Array, Array]:
    """Gauss' nodes and weights on [0, 1] in a variable whose cube the distance from an end is; from
    the upper end only where the lower one is an edge.
    """
    g, w = chebyshev.gauss_legendre(BENT)
    both = g**3 * (10.0 - 15.0 * g + 6.0 * g * g), 30.0 * w * (g * (1.0 - g)) ** 2
    upper = 1.0 - (1.0 - g) ** 3, 3.0 * w * (1.0 - g) ** 2
    place, weight = (np.where(at_edge[:, None], u, b) for u, b in zip(upper, both, strict=True))
    return place, weight


def _placed(
    k: PatchPanels,
    pressure: PatchPressure,
    parts: tuple[Index, Array, Array],
    rule: tuple[Array, Array],
) -> Measure:
    """The rule on [0, 1], laid on parts (panel, lowest angle, length)."""
    P = pressure.operator.patches
    (panel, lo, length), (g, w) = parts, rule
    patch, right = k.patch[panel], k.right[panel]
    edge, away = (
        np.where(right, P.b[patch], P.a[patch])[:, None],
        np.where(right, -1.0, 1.0)[:, None],
    )

    def inward(angle: Array) -> Array:
        return np.asarray(2.0 * P.r[patch, None] * np.sin(0.5 * angle) ** 2)

    angle = lo[:, None] + length[:, None] * g
    weight = length[:, None] * w * P.r[patch, None] * np.sin(angle)
    meant = inward(angle)
    x = edge + away * meant
    # the pressure is that of the double x, and goes like the root of its distance from the edge
    ratio = np.abs(x - edge) / meant
    sharp = pressure.operator.Y[2 * patch + right] != 0.0
    weight *= np.where(
        sharp[:, None], np.sqrt(ratio), 1.0 / np.sqrt(np.where(ratio > 0.0, ratio, 1.0))
    )
    chosen = np.flatnonzero(length > SHORT * (k.hi - k.lo)[panel])
    chosen = chosen[:: max(len(chosen) // PLACES, 1)]
    middles = (edge + away * inward((lo + 0.5 * length)[:, None]))[chosen, 0]
    everywhere = np.repeat(patch, angle.shape[1])
    return Measure(x.ravel(), weight.ravel(), everywhere, middles, patch[chosen])


def _rounding(rule: Measure, p: Array) -> float:
    """The change of p by an ulp of x where the equation is measured."""
    order = np.argsort(rule.x, kind="stable")
    x, p = rule.x[order], p[order]
    k = np.clip(np.searchsorted(x, rule.at), 1, len(x) - 1)
    apart = np.maximum(x[k] - x[k - 1], np.spacing(np.abs(x[k])))
    return float((np.abs(p[k] - p[k - 1]) / apart * np.spacing(np.abs(x).max())).max(initial=0.0))


def _residual(pressure: PatchPressure, rule: Measure, p: Array) -> float:
    """The largest residual at the chosen places."""
    o = pressure.operator
    P, chord = o.patches, o.patches.chord
    at, own = rule.at, rule.own
    values = pressure(at)
    total = values * np.log(chord.apart(at - P.a[own]) / chord.apart(P.b[own] - at))
    for k in range(0, len(at), TOGETHER):
        some = slice(k, k + TOGETHER)
        distance = at[some, None] - rule.x
        distance[distance == 0.0] = np.nan
        kernel = 1.0 / distance
        if chord.periodic:
            kernel = (np.pi / chord.period) / np.tan((np.pi / chord.period) * distance)
        kernel[np.isnan(kernel)] = 0.0
        taken_out = np.where(rule.patch == own[some, None], values[some, None], 0.0)
        total[some] += ((p - taken_out) * kernel) @ rule.weight
    H = o.pieces.value(o.pieces.locate(at), at, 0.0) + pressure.tilt
    return float(np.abs(total / np.pi - pressure.half_modulus * H).max(initial=0.0))
