"""The power of friction as Q grows on dissimilar bodies, and the shift of the indenter.

Under Q + dQ the pressure, the shear and the slip gradient change by ṗ dQ, q̇ dQ, γ̇ dQ. These obey
the equations of `coupled_zones` without slope and without γ, and may be infinite where the zones
end: Ψ has poles at e1 and e2, which are two more masses there,

    Ψ = 1/π ∫(ṗ/χ)/(z - t) dt + m1/(π (z - e1)) + m2/(π (z - e2)),     (1 - β²) ṗ = A in stick,
    γ̇ = (A - (1 - β²) ṗ)/β in slip,      ∫ṗ dx = 0,      ∫q̇ dx = -1/β ∫F dη beside the contact = 1.

The first condition gives m1/m2, the second their size. The power of friction is ∫f p ġ dx over
both slip zones, ġ the integral of 2/E* γ̇ from the stick zone on.

The shift is 2/E* ∫(γ - γ of P alone) dx from the stick zone to where both are Q/(πx), less that of
a bonded contact [-b, b]. There p + i q is (x - b)^(-1/2 - iη) (x + b)^(-1/2 + iη), tanh πη = β, and

    ∫_b^X Fq dx = Q/π [ln(2X/b) - Re ψ(1/2 + iη) + ψ(1/2)],       ψ the digamma function.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

from .coupled_integral import RATIO, integral
from .coupled_tangential import TangentialSearch, Trial
from .coupled_zones import StickProblem, stick_rule

Array = NDArray[np.float64]

LEVELS, ON_PANEL = 12, 8  # of a slip zone: panels towards its ends, and nodes
# Between marks of the tractions: nodes, panels towards them, parts of the contact that are one
ON_MARKS, SHRINKING, TOGETHER = 12, 16, 1e-10


class State(Protocol):
    """What is used of a state under P and Q, in its frame; see `coupled_sheared`."""

    @property
    def search(self) -> TangentialSearch: ...

    @property
    def trial(self) -> Trial: ...

    @property
    def Q(self) -> float: ...

    @property
    def turn(self) -> float: ...

    @property
    def friction(self) -> float: ...

    @property
    def frame_marks(self) -> tuple[float, ...]: ...

    def frame_pressure(self, u: Array) -> Array: ...

    def frame_shear(self, u: Array) -> Array: ...


class SlipRate:
    """∂/∂Q of the pressure and the slip in a state, in its frame."""

    def __init__(self, state: State) -> None:
        self.state = state
        search, zones = state.search, state.trial.zones
        exponents = 0.5 + search.theta, 0.5 - search.theta
        rule = stick_rule(zones, exponents, np.zeros(0), RATIO**-LEVELS * zones.stuck)
        none = np.zeros(len(rule.x))

        def with_poles(one: float, other: float) -> StickProblem:
            beta, f = search.beta, search.friction
            return StickProblem(zones, beta, f, rule, none, poles=(one, other))

        misses = with_poles(0.0, 1.0).missed, -with_poles(1.0, 0.0).missed
        one, other = (miss / max(map(abs, misses)) for miss in misses)
        self.problem, poles = with_poles(one, other), np.array([one, other])
        m = self.problem.map
        self._masses = poles * m.strength * m.zones.stuck * np.array([m.alpha, 1.0])
        self._per_load = 1.0 / self._load(poles)

    def _load(self, poles: Array) -> float:
        """∫q̇ dx, from x A as x tends to infinity, where Φ passes zero."""
        m, beta = self.problem.map, self.state.search.beta
        nodes, ends = (m.below, m.above), (np.array([0.0, 2.0]), np.array([2.0, 0.0]))
        far = np.array([1.0 + m.far]), np.array([1.0 - m.far])
        rate = m.weight * self.problem.A / (1.0 - beta * beta)
        quotient = np.zeros(len(rate))
        for (below, above), mass in ((nodes, rate), (ends, poles)):
            y = 0.5 * (below - above)
            quotient += m.kernel(nodes, (below, above)) @ (
                mass * m.k * y * m.kernel(far, (below, above))[0]
            )
        scale = 2.0 * m.alpha * m.zones.stuck / (m.k * (1.0 + m.alpha) * math.pi)
        return -scale * float(m.weight @ quotient)

    def gradient(self, side: float, from_stick: Array, from_edge: Array) -> Array:
        """γ̇ in the right (side 1) or left (-1) slip zone."""
        (x1, e1, e2, x2), (a1, a2) = self.problem.map.zones, self.problem.map.exponents
        beta, stuck = self.state.search.beta, e2 - e1
        # From e1, e2, x1, x2, positive in stick
        if side > 0.0:
            x, left, right = e2 + from_stick, stuck + from_stick, -from_stick
            to_left, to_right = left + (e1 - x1), from_edge
        else:
            x, left, right = e1 - from_stick, -from_stick, stuck + from_stick
            to_left, to_right = from_edge, right + (x2 - e2)
        chi = np.abs(right / to_right) ** a2 * np.abs(left / to_left) ** a1
        poles = (self._masses[0] / left - self._masses[1] / right) / math.pi
        p = side * math.cos(math.pi * self.problem.map.theta) * chi * (self.problem.Psi(x) + poles)
        rate: Array = self._per_load * (self.problem.A_at(left, right) - (1.0 - beta * beta) * p)
        return rate

    @property
    def power(self) -> float:
        """E*/2 ∫f p ġ dx over both slip zones."""
        return self._power(1.0) + self._power(-1.0)

    def _power(self, side: float) -> float:
        """∫γ̇ N dx, N what friction carries between x and the edge."""
        (x1, e1, e2, x2), state = self.state.trial.zones, self.state
        lo, hi = (e2, x2) if side > 0.0 else (x1, e1)
        cuts = state.search.gamma.cuts
        near = 0.5 * (hi - lo) * RATIO ** -np.arange(LEVELS, -0.5, -1.0)
        inner = cuts[(cuts > lo) & (cuts < hi)]
        ends = np.concatenate(([lo], lo + near, hi - near, [hi], inner))
        carried = integral(state.frame_pressure, np.unique(ends))
        from_stick, from_edge, weight = _slip_rule(
            hi - lo, *self.problem.map.exponents[:: int(side)]
        )
        x = e2 + from_stick if side > 0.0 else e1 - from_stick
        N = carried(x) if side < 0.0 else carried(np.array([hi])) - carried(x)
        gradient = self.gradient(side, from_stick, from_edge)
        return side * state.friction * float((weight * gradient) @ N)


def _slip_rule(length: float, stick: float, edge: float) -> tuple[Array, Array, Array]:
    """Distances from both ends of a slip zone and weights, for powers -stick, -edge there."""
    near = 0.5 * length * RATIO ** -np.arange(LEVELS, -0.5, -1.0)
    sides = []
    for power in (stick, edge):
        x, _, w = with_weight(ON_PANEL, 0.0, 0.0)
        first, _, mass = with_weight(ON_PANEL, 0.0, -power)
        span = np.diff(near)[:, None]
        distance = np.append(near[0] * first, (near[:-1, None] + span * x).ravel())
        sides.append((distance, np.append(near[0] * mass, (span * w).ravel())))
    (left, mass), (right, other) = sides
    return (
        np.append(left, length - right),
        np.append(length - left, right),
        np.append(mass, other),
    )


def tangential_shift(state: State) -> float:
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
