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

from .admissible import Found
from .density import PatchPressure
from .newton import Given, State, conditions
from .panels import PatchPanels
from .result import GRADING, LEAST, PatchCertificate

Array = NDArray[np.float64]

NODES = 12  # on a part of a panel
# (panels, levels): where there are no more panels, their parts shrink towards the ends so often
LEVELS = ((24, 32), (60, 18), (400, 8))
SHORT = 1e-3  # of a panel: on shorter parts the equation is not measured
PLACES = 120  # at which it is, about
TOGETHER = 32  # of them at once
EXPLAINED = 16.0  # times an ulp of x
MOST = 1e-3  # of the peak: where an ulp of x can do more nothing is certified
# what the sum that measures may miss of a rough profile, whose pieces it does not grade
ROUGH = 1e-9
CLOSE = 1e4  # condition from which a patch is about to appear, or two to merge


def certificate(
    found: Found, pressure: PatchPressure, given: Given, tol: float
) -> PatchCertificate:
    """Measure an answer; `given` is what was asked, in units of E*/2."""
    o, P = found.operator, found.operator.patches
    rough = len(o.panels.lo) > LEVELS[-1][0]
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
            ROUGH if rough else LEAST, min(EXPLAINED * _rounding(rule, p) / peak, MOST)
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
        "1e-9 "
        f"changes the narrowest patch by {1e-9 * condition:.0e} of its width"
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
    patch: Array
    at: Array
    own: Array


def _measure(k: PatchPanels, pressure: PatchPressure) -> Measure:
    """A composite rule, graded towards the ends of panels, where p' may be infinite and p too."""
    P = pressure.operator.patches
    levels = next((level for most, level in LEVELS if len(k.lo) <= most), 0)
    graded = GRADING ** np.arange(1.0, levels + 1.0)
    cuts = (np.array([0.0, 0.5]), graded, 1.0 - graded[::-1], np.ones(1))
    inside, at_edge = (
        np.unique(np.concatenate(cuts)),
        np.unique(np.concatenate(cuts[:1] + cuts[2:])),
    )
    lows, lengths, panels = [], [], []
    for chosen, part in (
        (k.lo > 0.0, inside),
        (k.lo == 0.0, at_edge),
    ):  # at an edge p is smooth in the angle
        extent = (k.hi - k.lo)[chosen, None]
        lows.append((k.lo[chosen, None] + extent * part[:-1]).ravel())
        lengths.append((extent * np.diff(part)).ravel())
        panels.append(np.repeat(np.flatnonzero(chosen), len(part) - 1))
    lo, length, panel = (np.concatenate(v) for v in (lows, lengths, panels))
    g, w = chebyshev.gauss_legendre(NODES)
    patch, right = k.patch[panel], k.right[panel]

    def place(angle: Array) -> Array:
        inward = 2.0 * P.r[patch, None] * np.sin(0.5 * angle) ** 2
        return np.where(right[:, None], P.b[patch, None] - inward, P.a[patch, None] + inward)

    angle = lo[:, None] + length[:, None] * g
    weight = length[:, None] * w * P.r[patch, None] * np.sin(angle)
    chosen = np.flatnonzero(length > SHORT * (k.hi - k.lo)[panel])
    chosen = chosen[:: max(len(chosen) // PLACES, 1)]
    middles = place((lo + 0.5 * length)[:, None])[chosen, 0]
    everywhere = np.repeat(patch, NODES)
    return Measure(place(angle).ravel(), weight.ravel(), everywhere, middles, patch[chosen])


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
        distance[distance == 0.0] = np.inf
        kernel = 1.0 / distance
        if chord.periodic:
            kernel = (np.pi / chord.period) / np.tan((np.pi / chord.period) * distance)
        taken_out = np.where(rule.patch == own[some, None], values[some, None], 0.0)
        total[some] += ((p - taken_out) * kernel) @ rule.weight
    H = o.pieces.value(o.pieces.locate(at), at, 0.0) + pressure.tilt
    return float(np.abs(total / np.pi - pressure.half_modulus * H).max(initial=0.0))
