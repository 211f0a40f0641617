"""How the slip of dissimilar bodies changes with Q at constant P.

Under Q + dQ the pressure, the shear and the slip gradient change by ṗ dQ, q̇ dQ, γ̇ dQ. These obey
the equations of `zones` without slope and without γ, and may be infinite where the zones
end: Ψ has poles at e1 and e2, which are two more masses there,

    Ψ = 1/π ∫(ṗ/χ)/(z - t) dt + m1/(π (z - e1)) + m2/(π (z - e2)),     (1 - β²) ṗ = A in stick,
    γ̇ = (A - (1 - β²) ṗ)/β in slip,      ∫ṗ dx = 0,      ∫q̇ dx = -1/β ∫F dη beside the contact = 1.

The first condition gives m1/m2, the second their size. E*/2 ġ is the integral of γ̇ from the stick
zone on. By the friction law ġ > 0 in slip: the zones depend on Q alone only as far as that holds.
Next to x1 it may not: there p of surfaces that come into contact lets γ̇ tend to infinity.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

from .integral import RATIO
from .zones import StickProblem, Zones, stick_rule

Array = NDArray[np.float64]

LEVELS, ON_PANEL = 12, 8  # of a slip zone: panels towards its ends, and nodes


class SlipRate:
    """∂/∂Q of the pressure and the slip with these zones; β > 0 and Q > 0."""

    def __init__(self, zones: Zones, beta: float, friction: float) -> None:
        self.beta, theta = beta, math.atan(beta * friction) / math.pi
        exponents = 0.5 + theta, 0.5 - theta
        rule = stick_rule(zones, exponents, np.zeros(0), RATIO**-LEVELS * zones.narrowest)
        none = np.zeros(len(rule.x))

        def with_poles(one: float, other: float) -> StickProblem:
            return StickProblem(zones, beta, friction, rule, none, poles=(one, other))

        misses = with_poles(0.0, 1.0).missed, -with_poles(1.0, 0.0).missed
        one, other = (miss / max(map(abs, misses)) for miss in misses)
        self.problem, poles = with_poles(one, other), np.array([one, other])
        m = self.problem.map
        self._masses = poles * m.strength * m.zones.stuck * np.array([m.alpha, 1.0])
        self._per_load = 1.0 / self._load(poles)

    def _load(self, poles: Array) -> float:
        """∫q̇ dx, from x A as x tends to infinity, where Φ passes zero."""
        m, beta = self.problem.map, self.beta
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
        beta, stuck = self.beta, e2 - e1
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
    def least(self) -> float:
        """The least ġ in the outer halves of the slip zones, over the largest.

        In the inner halves γ̇ has one sign, that of the mass.
        """
        least = math.inf
        for side in (-1.0, 1.0):
            from_stick, from_edge, weight = self.rule(side)
            order = np.argsort(from_stick)
            gradient = self.gradient(side, from_stick, from_edge)
            slip = side * np.cumsum((weight * gradient)[order])
            outer = slip[from_stick[order] > from_edge[order]]
            least = min(least, float(outer.min() / np.abs(slip).max()))
        return least

    def rule(self, side: float) -> tuple[Array, Array, Array]:
        """Distances from both ends of a slip zone and weights, for the powers of γ̇ there."""
        _, stick, edge = self.problem.map.zones.slipping[int(side > 0.0)]
        length = abs(edge - stick)
        near = 0.5 * length * RATIO ** -np.arange(LEVELS, -0.5, -1.0)
        sides = []
        for power in self.problem.map.exponents[:: int(side)]:
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
