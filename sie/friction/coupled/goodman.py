"""Goodman's approximation: β q is left out of equation (1), which makes p that without friction.

    H1 = Hp,      γ = Hq + β p      β > 0,   q = s f p where the bodies slip.

With w(z)² the product of the distances from both edges, bounded at these, and ω of `State.root`,

    p = w/π PV∫ (H1/w)/(t - x) dt,        1/π ∫q/(z - t) dt = ω/π ∫ν/(z - t) dt,

ν = (γ - β p)/|ω| in stick, q/ω in slip. p is bounded if ∫H1/w dt = 0, and ∫t H1/w dt is πP up to a
factor; q is bounded at the ends of n stick zones if the moments ∫ν t^k dt vanish for k < n, and
that with k = n is Q.

Under a flat punch p = P/(π w), and the stick zone is that of `flat.goodman_flat`.

Goodman (1962), J. Appl. Mech. 29, 515; docs/derivations/goodman.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .pieces import Pair, across
from .state import State

if TYPE_CHECKING:
    from .pieces import Places

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Uncoupled(State):
    """p, q and γ of Goodman's approximation for zones that need not be right."""

    def _w(self, at: Places) -> Array:
        """w over half the width, negative as χ of a slip zone is."""
        to_left, to_right = self._to_edges(at)
        values: Array = -np.sqrt(np.abs(to_left * to_right)) / self.half_width
        return values

    def _mass(self, at: Places) -> Array:
        values: Array = -self.question.slope(at.x) * at.weight / self._w(at)
        return values

    def pressure(self, at: Places, flow: Array) -> Array:
        """p from the integral of H1/w, or that of a flat punch."""
        if self.pieces.sharp:
            return -self.question.P / (math.pi * self.half_width * self._w(at))
        values: Array = self._w(at) * flow
        return values

    def pressure_in_slip(self, at: Places) -> Array:
        return self.pressure(at, self.psi(at, self.nodes, self._mass(self.nodes)))

    def rows(self, rules: Pair, kernel: Array) -> list[Array]:
        found, question = [], self.question
        flows = across(kernel, [self._mass(at) for at in rules])
        for at, flow in zip(rules, flows, strict=True):
            p, gamma, sticks = self.pressure(at, flow), np.zeros(len(at.x)), self.sticks(at)
            gamma[sticks] = question.gamma(at.x[sticks])
            found.append(np.stack((p, self.pieces.sign[at.zone] * question.friction * p, gamma)))
        return found

    @cached_property
    def missed(self) -> Array:
        question, t, at = self.question, self.nodes, self.halfway
        arm, mass, n = self._arm(t), self._mass(t), self.pieces.signs.count(0)
        of_p = np.array([mass.sum(), mass @ arm - question.P]) / question.P
        p, q, gamma = self.rows((at, t), self.cauchy(at, t))[1]
        nu = t.weight * np.where(self.sticks(t), question.beta * p - gamma, q) / self.root(t)
        moments = np.array([nu @ arm**k for k in range(n + 1)]) * self.half_width**n
        # Q as a part of what p is on the same nodes: next to sliding their errors are one
        moments[n] = (
            moments[n] - question.Q * float(p @ t.weight) / question.P
        ) / question.friction
        return np.append(of_p, moments / question.P)

    def rates(self, dQ: float, strain: float) -> tuple[Places, Array]:
        """p stays; q changes in the stick zone, by the gradient of a strip bonded there."""
        places = self.pieces.rule(0.5, 1.0)
        places = places.chosen(~self.sticks(places))
        (zone,) = np.flatnonzero(self.pieces.sign == 0.0)
        first, last = self.pieces.cut_of_ends[[zone, zone + 1]].tolist()
        from_first, from_last = (self.pieces.from_cut(places, cut) for cut in (first, last))
        far = dQ / math.pi - 0.5 * strain * (from_first + from_last)
        gamma = strain + np.sign(from_first) * far / np.sqrt(from_first * from_last)
        return places, gamma
