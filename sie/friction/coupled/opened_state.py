"""The state of a contact that slips inside its stick zone, with given zones and slip gradient.

From the left edge on the contact has a strip [x1, e0] with q = -f p, sticks on [e0, h1], slips
along Q on [h1, h2], sticks on [h2, e2], and slips along Q on [e2, x2]. With p_s, full sliding of
[x1, x2] that is finite at x1, p = p_s + p_d and μ = 1/2 - θ

    F of p_d = χ Ψ,    χ = ((z - e0)/(z - x1))^μ ((z - h1)/(z - h2))^μ ((z - e2)/(z - x2))^μ,
    Ψ = 1/π ∫(p_d/χ)/(z - t) dt over both stick zones + 1/π ∫ρ/(z - t) dt on the strip,

ρ = -2κ p_s sin(πμ)/χ, and (1 - β²) p_d = A - β γ_d in stick with A = -1/π ∫D/(x - η) dη, D = χ Ψ
beside the contact: one equation of the second kind for Ψ there. What is given is γ in stick;
conditions on the zones are

    P,    p finite at x2,    Ψ = 0 at x1 and at h2,    ∫(γ - γ before) dx = 0 on [h1, h2].

They are linear in γ: it has columns, the first with all that is known, and so have they. The strip
is 1e-9 of what was gained and makes exponents real; beyond it the state is that of an edge that
sticks. Places are counted from the old edge.

docs/derivations/coupled_slip.md, "Below that load".
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval

from .opened_rule import FAR_NODES, beside_rule, strip_rule, zone_rule
from .opened_search import Search, SlidingOf
from .opened_zones import Distances, OpenedZones

Array = NDArray[np.float64]

DEEP = 1e-6  # of the slip zone inside: panels shrink so far towards its ends
# Of the contact, to x1: nearer the regular part of p_s is a power of the distance, which x tells to
# few digits
CLOSE = 1e-9
FINE = 1e-12  # the same of all slip zones where p is wanted next to their ends

Gradient = Callable[[Array], Array]


class OpenedState:
    """Ψ beside the contact and p_d in stick, in columns, with these zones.

    sliding     computes p_s for a contact
    gamma       computes γ at places of the stick zones, a row each, in columns
    before      ∫γ dx over the slip zone inside as it was before that slipped
    cuts        places where γ is not smooth
    fine        whether p is wanted next to the ends of the zones
    """

    def __init__(
        self,
        search: Search,
        sliding: SlidingOf,
        zones: OpenedZones,
        gamma: Gradient,
        cuts: Array,
        *,
        before: float,
        fine: bool = False,
    ) -> None:
        self.search, self.zones = search, zones
        beta, f = search.beta, search.friction
        self.mu, self.cos = 0.5 - search.theta, math.cos(math.pi * search.theta)
        b = search.normal.b
        self.sliding = sliding(Interval(zones.x1 - b, zones.x2 - b))
        self.deep = (FINE, FINE) if fine else (DEEP, 1.0)
        self.stick, weight, self.x, self.left_nodes = self._stuck(cuts)
        self.beside = beside_rule((zones.x1, zones.x2), (zones.strip, zones.slipping), -self.mu)
        self.mass = weight / self.stick.chi(self.mu)
        left, right = zones.beside(self.beside)
        self.mass_beside = self.beside.weight * np.append(left.chi(self.mu), right.chi(self.mu))
        self._on_strip()
        self.gamma = gamma(self.x)
        self.rest = self.gamma + 0.0  # γ_d
        self.rest[:, 0] -= f * search.H(self.x - b)
        self.rest[:, 0] -= beta * (1.0 + f * f) * self.full_sliding(self.x, self.stick)
        self._solve()
        self._conditions(before)

    # -- places ------------------------------------------------------------------------------------

    def _stuck(self, cuts: Array) -> tuple[Distances, Array, Array, int]:
        """Distances, weights and places in both stick zones, and how many are in the left one."""
        (strip, e0, h1, h2, e2, _), mu = self.zones, self.mu
        near, last = self.deep[0] * self.zones.opened, self.deep[1] * self.zones.slipping
        inner = cuts[(cuts > e0) & (cuts < h1)]
        one = zone_rule(h1 - e0, (strip, near), (-mu, -mu), inner - e0)
        inner = cuts[(cuts > h2) & (cuts < e2)]
        other = zone_rule(e2 - h2, (near, last), (mu - 1.0, -mu), inner - h2)
        parts = (
            self.zones.in_left_stick(one.left, one.right),
            self.zones.in_right_stick(other.left, other.right),
        )
        joined = Distances(*(np.concatenate(column) for column in zip(*parts, strict=True)))
        places = one.places(e0, h1), other.places(h2, e2)
        return joined, np.append(one.weight, other.weight), np.concatenate(places), len(one.left)

    def beside_inverse(self, x1: Array, x2: Array) -> Array:
        """1/(η - x) for all η beside the contact and places x in it, by distances of these."""
        values: Array = np.concatenate(
            (-1.0 / (self.beside.left[:, None] + x1), 1.0 / (self.beside.right[:, None] + x2))
        )
        return values

    # -- the equation ------------------------------------------------------------------------------

    def full_sliding(self, x: Array, at: Distances) -> Array:
        """p_s."""
        values, nearest = self.regular_sliding(x), CLOSE * (self.zones.x2 - self.zones.x1)
        near = at.x1 < nearest
        if near.any():
            there = self.regular_sliding(np.array([self.zones.x1 + nearest]))
            values[near] = there * (at.x1[near] / nearest) ** self.mu
        values += 0.5 * self.sliding.k2 * (at.x1 / at.x2) ** self.mu
        return values

    def _on_strip(self) -> None:
        """ρ dx on the strip."""
        zones, mu = self.zones, self.mu
        rule = strip_rule(zones.strip, mu)
        self.strip = zones.in_strip(rule.left, rule.right)
        p = self.full_sliding(zones.x1 + rule.left, self.strip)
        strength = -2.0 * self.search.beta * self.search.friction * math.sin(math.pi * mu)
        self.strip_mass = strength * p / self.strip.chi(mu) * rule.weight

    def _solve(self) -> None:
        beta = self.search.beta
        part = 1.0 - beta * beta
        kernel = self.beside_inverse(self.stick.x1, self.stick.x2)
        to_A = kernel.T * (self.mass_beside / math.pi)
        to_Psi = kernel * (self.mass / (math.pi * part))
        right = -beta * (to_Psi @ self.rest)
        of_strip = self.beside_inverse(self.strip.x1, self.strip.x2) @ self.strip_mass
        right[:, 0] += of_strip / math.pi
        matrix = np.eye(len(kernel)) - to_Psi @ to_A
        self.Psi = np.linalg.solve(matrix, right)
        self.p = (to_A @ self.Psi - beta * self.rest) / part  # p_d
        self.masses = self.mass[:, None] * self.p

    def _conditions(self, before: float) -> None:
        """What the conditions miss, over their sizes, in columns."""
        (strip, e0, h1, h2, _, x2), mu, at = self.zones, self.mu, self.stick
        normal, d, n = self.search.normal, x2 - self.zones.x1, self.left_nodes
        first = np.zeros(self.p.shape[1])
        first[0] = 1.0
        P = self.masses.sum(axis=0) + (self.strip_mass.sum() + self.sliding.resultant) * first
        factor = self.zones.slipping**mu * ((x2 - e0) * (x2 - h1) / (d * (x2 - h2))) ** mu
        at_x2 = (1.0 / at.x2) @ self.masses + (1.0 / self.strip.x2) @ self.strip_mass * first
        at_x2 = self.cos * factor / math.pi * at_x2 + 0.5 * self.sliding.k2 * d**mu * first
        at_x1 = (1.0 / at.x1) @ self.masses + (1.0 / self.strip.x1) @ self.strip_mass * first
        sides = np.append(np.full(n, -1.0), np.ones(len(self.x) - n))
        at_h2 = (sides / at.h2) @ self.masses - (1.0 / self.strip.h2) @ self.strip_mass * first
        slip = (self._slipped() - before * first) / self.zones.opened
        b, P0 = normal.b, normal.load
        stress = P0 / b
        self.missed = np.array(
            [
                (P - P0 * first) / P0,
                at_x2 / (stress * b**mu),
                at_x1 * math.sqrt(strip) / P0,
                at_h2 / stress,
                slip / stress,
            ]
        )
        self.load = self._load(first)

    def _load(self, first: Array) -> Array:
        """Q, by ∫F dη beside the contact: F is odd at infinity."""
        beta, f, far = self.search.beta, self.search.friction, FAR_NODES
        terms = self.mass_beside[:, None] * self.Psi
        n = len(self.beside.left)
        left, right = terms[:n], terms[n:]
        total = left[:-far].sum(axis=0) + right[:-far].sum(axis=0)
        total += (left[-far:] + right[-far:]).sum(axis=0)
        load: Array = f * self.sliding.resultant * first - total / beta
        return load

    # -- the slip zone inside ----------------------------------------------------------------------

    def inside(self, left: Array, right: Array) -> tuple[Array, Array]:
        """p_d and γ_d in the slip zone inside, in columns, given the distances from its ends."""
        at, n = self.zones.in_slip(left, right), self.left_nodes
        stick, strip = self.stick, self.strip
        # Ψ = 0 at h2: the factor x - h2 is taken out
        sums = (1.0 / (left[:, None] + stick.h1[:n])) @ (-self.masses[:n] / stick.h2[:n, None])
        sums -= (1.0 / (right[:, None] + stick.h2[n:])) @ (self.masses[n:] / stick.h2[n:, None])
        sums[:, 0] -= (1.0 / (left[:, None] + strip.h1)) @ (self.strip_mass / strip.h2)
        size = (at.e0 * at.e2 / (at.x1 * at.x2)) ** self.mu
        size = size * left**self.mu * right ** (1.0 - self.mu)
        p = -(self.cos / math.pi) * size[:, None] * sums
        A = self.beside_inverse(at.x1, at.x2).T @ (self.mass_beside[:, None] * self.Psi) / math.pi
        return p, (A - (1.0 - self.search.beta**2) * p) / self.search.beta

    def _slipped(self) -> Array:
        """∫γ dx over the slip zone inside."""
        near = DEEP * self.zones.opened
        rule = zone_rule(self.zones.opened, (near, near), (0.0, 0.0), np.zeros(0))
        at = self.zones.in_slip(rule.left, rule.right)
        x = rule.places(self.zones.h1, self.zones.h2)
        gamma = self.inside(rule.left, rule.right)[1]
        gamma[:, 0] += self.slid_gradient(x, at)
        total: Array = rule.weight @ gamma
        return total

    def slid_gradient(self, x: Array, at: Distances) -> Array:
        """γ - γ_d = f E*/2 h' + β (1 + f²) p_s."""
        search, f = self.search, self.search.friction
        values: Array = f * search.H(x - search.normal.b)
        return values + search.beta * (1.0 + f * f) * self.full_sliding(x, at)

    # -- p -----------------------------------------------------------------------------------------

    def stuck_pressure(self, x: Array, at: Distances, gamma: Array) -> Array:
        """p in stick, given γ; of the first column."""
        beta, sliding = self.search.beta, self.full_sliding(x, at)
        A = self.beside_inverse(at.x1, at.x2).T @ (self.mass_beside * self.Psi[:, 0]) / math.pi
        f = self.search.friction
        rest = gamma - f * self.search.H(x - self.search.normal.b) - beta * (1.0 + f * f) * sliding
        values: Array = sliding + (A - beta * rest) / (1.0 - beta * beta)
        return values

    def singular_part(self, at: Distances) -> Array:
        """(p - V) (x2 - x)^μ in the slip zone at x2, which vanishes at x2.

        V is p_s without its infinite part.
        """
        sums = (1.0 / (at.e2[:, None] + self.stick.e2)) @ self.masses[:, 0]
        sums += (1.0 / (at.e2[:, None] + self.strip.e2)) @ self.strip_mass
        size = (at.e0 * at.h1 * at.e2 / (at.x1 * at.h2)) ** self.mu
        values: Array = 0.5 * self.sliding.k2 * at.x1**self.mu + self.cos / math.pi * size * sums
        return values

    def regular_sliding(self, x: Array) -> Array:
        """V."""
        return self.sliding.regular(x - self.search.normal.b)

    def Psi_beside(self, at: Distances, on_right: bool) -> Array:
        """χ Ψ beside the contact: H p less that of full sliding."""
        nodes, strip = (
            (self.stick.x2, self.strip.x2) if on_right else (self.stick.x1, self.strip.x1)
        )
        d = at.x2 if on_right else at.x1
        sums = (1.0 / (d[:, None] + nodes)) @ self.masses[:, 0]
        sums += (1.0 / (d[:, None] + strip)) @ self.strip_mass
        values: Array = (1.0 if on_right else -1.0) / math.pi * at.chi(self.mu) * sums
        return values
