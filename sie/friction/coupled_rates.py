"""Energy that dissimilar bodies dissipate under Q, and the shift of the indenter.

The power of friction is ∫f p ġ dx over both slip zones, ġ that of `coupled_slip_rate`, and the
energy its integral over Q. With Q = f P sin²φ that is a smooth function of φ but where a zone
passes a kink of γ.

The shift is 2/E* ∫(γ - γ of P alone) dx from the stick zone to where both are Q/(πx), less that of
a bonded contact [-b, b]. There p + i q is (x - b)^(-1/2 - iη) (x + b)^(-1/2 + iη), tanh πη = β, and

    ∫_b^X Fq dx = Q/π [ln(2X/b) - Re ψ(1/2 + iη) + ψ(1/2)],       ψ the digamma function.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.polynomial.legendre import legvander
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.gauss_jacobi import with_weight

from .coupled_integral import RATIO, integral
from .coupled_sheared import ShearedContact
from .coupled_slip_rate import LEVELS, SlipRate

Array = NDArray[np.float64]

CERTIFIED, WANTED = 1e-6, 5e-7  # of the energy: the error that is allowed, and aimed at
NODES = 6  # of a panel in φ
STARTS = (0.03, 0.12), (0.1, 0.3)  # of φ: the first panel, behind a part without nodes
MOST = 40  # panels
# Between marks of the tractions: nodes, panels towards them, parts of the contact that are one
ON_MARKS, SHRINKING, TOGETHER = 12, 16, 1e-10


def _power(state: ShearedContact) -> float:
    """E*/2 ∫f p ġ dx over both slip zones: ∫γ̇ N dx, N what friction carries from x to the edge."""
    rate, zones = SlipRate(state.trial.zones, state.search.beta, state.friction), state.trial.zones
    return sum(_power_of_zone(state, rate, *zone) for zone in zones.slipping)


def _power_of_zone(
    state: ShearedContact, rate: SlipRate, side: float, stick: float, edge: float
) -> float:
    lo, hi = min(stick, edge), max(stick, edge)
    cuts = state.search.gamma.cuts
    near = 0.5 * (hi - lo) * RATIO ** -np.arange(LEVELS, -0.5, -1.0)
    inner = cuts[(cuts > lo) & (cuts < hi)]
    ends = np.concatenate(([lo], lo + near, hi - near, [hi], inner))
    carried = integral(state.frame_pressure, np.unique(ends))
    from_stick, from_edge, weight = rate.rule(side)
    x = stick + side * from_stick
    N = carried(x) if side < 0.0 else carried(np.array([hi])) - carried(x)
    gradient = rate.gradient(side, from_stick, from_edge)
    return side * state.friction * float((weight * gradient) @ N)


def tangential_energy(state: ShearedContact) -> float:
    """The energy dissipated while Q grew at constant P.

    Raises ContactError where that is not found to a part CERTIFIED.
    """
    search = state.search
    end = math.asin(min(math.sqrt(state.Q / search.limit), 1.0))

    def rate(angle: float) -> float:
        Q = search.limit * math.sin(angle) ** 2
        near = replace(state, trial=search.found(Q), Q=Q)
        return search.limit * math.sin(2.0 * angle) * _power(near)

    total, error, first = _started(rate, end, state.Q)
    whole, missed = _adaptive(rate, first, end)
    total, error = total + whole, error + missed
    if error > CERTIFIED * total:
        raise ContactError(
            f"the energy that dissimilar bodies dissipate under |Q| = {state.Q:.6g} is known to "
            f"{error / total:.1g} of it only, as the zones pass kinks of the profile on the way; "
            "smooth the profile, or set tangential_load = 0 for that of the normal load"
        )
    return total / search.normal.half_modulus


def _started(rate: Callable[[float], float], end: float, Q: float) -> tuple[float, float, float]:
    """The integral over the first panel, its error, and where it ends."""
    for near, first in STARTS:
        try:
            return *_extrapolated(rate, near * end, first * end), first * end
        except ContactError as error:
            reason = error
    raise ContactError(
        f"the energy that dissimilar bodies dissipate under |Q| = {Q:.6g} is a sum over the states "
        f"under smaller loads, and one of them is not found: {reason}"
    )


def _extrapolated(rate: Callable[[float], float], near: float, end: float) -> tuple[float, float]:
    """∫_0^end of the polynomial through values beyond `near`, and what a degree less changes.

    Next to Q = 0 the zones are narrow, or no state has them.
    """
    n = NODES + 1
    x, _, _ = with_weight(n, 0.0, 0.0)
    y, _, w = with_weight(n, 0.0, 0.0)
    values = np.array([rate(angle) for angle in (near + (end - near) * x).tolist()])
    places = 2.0 * (end * y - near) / (end - near) - 1.0
    totals = []
    for degree in (n - 2, n - 1):
        fitted = np.linalg.pinv(legvander(2.0 * x - 1.0, degree)) @ values
        totals.append(end * float(w @ (legvander(places, degree) @ fitted)))
    return totals[1], abs(totals[1] - totals[0])


def _adaptive(rate: Callable[[float], float], lo: float, hi: float) -> tuple[float, float]:
    """∫rate, and an estimate of its error: the panel that misses most is halved."""

    def gauss(lo: float, hi: float) -> float:
        x, _, w = with_weight(NODES, 0.0, 0.0)
        return (hi - lo) * float(w @ [rate(angle) for angle in (lo + (hi - lo) * x).tolist()])

    def panel(lo: float, hi: float, whole: float) -> tuple[float, float, float, float, float]:
        middle = 0.5 * (lo + hi)
        left, right = gauss(lo, middle), gauss(middle, hi)
        return abs(left + right - whole), lo, hi, left, right

    panels = [panel(lo, hi, gauss(lo, hi))]
    while True:
        total = sum(one[3] + one[4] for one in panels)
        error = sum(one[0] for one in panels)
        if error <= WANTED * total or len(panels) >= MOST:
            return total, error
        worst = max(panels)
        panels.remove(worst)
        _, lo, hi, left, right = worst
        middle = 0.5 * (lo + hi)
        panels += [panel(lo, middle, left), panel(middle, hi, right)]


def tangential_shift(state: ShearedContact) -> float:
    """The shift, less that of a bonded contact.

    It is that of γ by the logarithm of its shear, with ∫γ dx = β P/2 on either side of the axis
    under P alone.
    """
    from scipy.special import digamma  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

    search, start = state.search, state.trial.zones.e2
    normal, beta, gamma = search.normal, search.beta, search.gamma
    x, weight = _on_marks(state.frame_marks)
    q, p = state.frame_shear(x), state.frame_pressure(x)
    shift = float(weight @ (beta * (x > start) * p - q * np.log(np.abs(x - start)) / math.pi))
    inner = gamma.cuts[(gamma.cuts > 0.0) & (gamma.cuts < abs(start))]
    kept = integral(gamma.__call__, np.concatenate(([0.0], inner, [abs(start)])))
    shift += math.copysign(float(kept.series.sum()), start) - 0.5 * beta * normal.load
    eta = math.atanh(beta) / math.pi
    bonded = float(digamma(0.5 + 1j * eta).real) - float(digamma(0.5))
    shift += state.Q / math.pi * (math.log(0.5 * normal.b) + bonded)
    return state.turn * shift / normal.half_modulus


def _on_marks(marks: tuple[float, ...]) -> tuple[Array, Array]:
    """Nodes and weights on panels that shrink towards every mark, but those that are one."""
    x, _, w = with_weight(ON_MARKS, 0.0, 0.0)
    near = np.append(0.0, RATIO ** -np.arange(SHRINKING, -0.5, -1.0))
    part, mass = (near[:-1, None] + np.diff(near)[:, None] * x), np.diff(near)[:, None] * w
    nodes, weights, apart = [], [], TOGETHER * (marks[-1] - marks[0])
    lo = marks[0]
    for hi in marks[1:]:
        if hi - lo > apart:
            half = 0.5 * (hi - lo)
            nodes += [lo + half * part.ravel(), hi - half * part.ravel()]
            weights += [half * mass.ravel()] * 2
            lo = hi
    return np.concatenate(nodes), np.concatenate(weights)
