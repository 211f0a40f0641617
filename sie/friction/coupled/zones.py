"""Coupled stick and slip in a contact whose edges and stick zone are given, under P and Q.

The contact is [x1, x2], [e1, e2] sticks with the slip gradient γ, and on both sides q = f p
(β > 0, Q > 0). Full sliding under the whole load on the same contact, p_s, leaves a problem of a
flat punch,

    p_d = p - p_s,   γ_d = γ - f E*/2 h' - β (1 + f²) p_s,   F = 1/π ∫p_d/(z - t) dt = χ Ψ,
    χ = |(x - e2)/(x - x2)|^a2 |(x - e1)/(x - x1)|^a1,   Ψ = 1/π ∫(p_d/χ)/(z - t) dt,

a1 = 1/2 + θ, a2 = 1/2 - θ, tan πθ = β f, ∫p_d dt = 0. As in docs/derivations/coupled_slip.md

    A = -1/π ∫ F/(x - η) dη beside the contact,      (1 - β²) p_d = A - β γ_d   in stick.

A map x -> y, a ratio of linear functions, takes x1, e1, e2, x2 to -1/k, -1, 1, 1/k, and the surface
beside the contact, through infinity, to y = 1/(k s), |s| < 1. With the denominator n(y) of the map
both steps are one symmetric kernel, A/n = K Φ/π², Φ = K (p_d/n),

    K v(s) = ∫ W v/(1 - k s y) dy,      W = ((1 - k y)/(1 - y))^a2 ((1 + k y)/(1 + y))^a1,

which a Gauss-Jacobi rule in u, y = sn u, resolves for all k. γ_d has kinks: it is integrated on
panels. All of Φ is of the order of β, and is kept divided by it.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.elliptic import elliptic_functions, modulus_of
from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import EPS

from .flat import DIGITS, NEARER, SPARE
from .panels import geometric

Array = NDArray[np.float64]

NODES = 12
CLOSE = 1e-3  # of a panel: nearer to a node a difference quotient has lost digits
MOST_NODES = 400
ROUNDINGS = 1e3  # of the edges: cuts that are nearer to each other are one
TOGETHER = 2**15  # entries of a matrix that are computed at once


class Zones(NamedTuple):
    """x1 < e1 < e2 < x2: the edges of the contact, and of the stick zone in it."""

    x1: float
    e1: float
    e2: float
    x2: float

    @property
    def stuck(self) -> float:
        """The length of the stick zone."""
        return self.e2 - self.e1

    @property
    def narrowest(self) -> float:
        """The length of the shortest of the three zones."""
        return float(np.diff(self).min())

    @property
    def slipping(self) -> tuple[tuple[float, float, float], ...]:
        """(side, end at the stick zone, edge) of both slip zones."""
        return (-1.0, self.e1, self.x1), (1.0, self.e2, self.x2)


class Rule(NamedTuple):
    """Places in the stick zone, their distances from its ends, and weights.

    The weights are those of (x - e1)^-a1 (e2 - x)^-a2 dx; `ends` are e1 and e2.
    """

    ends: tuple[float, float]
    x: Array
    left: Array
    right: Array
    weight: Array


def stick_rule(zones: Zones, exponents: tuple[float, float], cuts: Array, nearest: float) -> Rule:
    """Gauss rules on panels between the cuts, which shrink towards both ends of the stick zone.

    The first panels are at most twice as long as the slip zone beside them, or as nearest.
    """
    half = 0.5 * zones.stuck
    sides = []
    for side, (end, beside, power) in enumerate(
        (
            (zones.e1, zones.e1 - zones.x1, exponents[0]),
            (zones.e2, zones.x2 - zones.e2, exponents[1]),
        )
    ):
        ahead = np.sort(cuts - end if side == 0 else end - cuts)
        # Nodes of a panel a few roundings long would coincide
        least = ROUNDINGS * EPS * max(abs(zones.e1), abs(zones.e2))
        ahead = ahead[np.diff(ahead, prepend=0.0) > least]
        ends = np.concatenate(([0.0], ahead[(ahead > least) & (ahead < half - least)], [half]))
        scale = np.append(min(beside, nearest), ends[1:-1])
        owner, _, start, size = geometric(np.diff(ends), scale)
        start = ends[owner] + start
        x, _, w = with_weight(NODES, 0.0, 0.0)
        at, mass = start[:, None] + size[:, None] * x, size[:, None] * w
        x, _, w = with_weight(NODES, 0.0, -power)
        at[0], mass[0] = size[0] * x, size[0] * w
        sides.append((at.ravel(), mass.ravel()))
    (left, mass), (right, others) = sides
    left, right = (
        np.append(left, zones.stuck - right[::-1]),
        np.append(zones.stuck - left, right[::-1]),
    )
    x = np.where(left < right, zones.e1 + left, zones.e2 - right)
    weight = np.append(mass, others[::-1]) * left ** -exponents[0] * right ** -exponents[1]
    return Rule((zones.e1, zones.e2), x, left, right, weight)


class Map:
    """The map of a stick zone in its contact, and K on Gauss nodes of it.

    The nodes y are also those s. at_right, at_left and far are s of x2, x1 and of infinity.
    """

    def __init__(self, zones: Zones, theta: float) -> None:
        x1, e1, e2, x2 = self.zones = zones
        self.theta, self.exponents = theta, (0.5 + theta, 0.5 - theta)
        slips = (x2 - e2) * (e1 - x1)
        L = math.sqrt((x2 - e1) * (e2 - x1) / slips)
        k = zones.stuck * (x2 - x1) / slips / (1.0 + L) ** 2
        self.modulus, self.k, self.rest = (
            modulus_of(k, 2.0 * math.sqrt(L) / (1.0 + L)),
            k,
            2.0 / (1.0 + L),
        )
        self.alpha = math.sqrt((x2 - e1) / (x2 - e2) * ((e1 - x1) / (e2 - x1)))
        self.far = (1.0 - self.alpha) / (k * (1.0 + self.alpha))
        self.below, self.above, self.weight, self.plain = self._nodes()

    def _nodes(self) -> tuple[Array, Array, Array, Array]:
        """1 + y, 1 - y, W dy and (1 - y)^-a2 (1 + y)^-a1 dy at the nodes."""
        m, (a1, a2) = self.modulus, self.exponents
        ratio = min(m.K_complement / m.K, 1.5)
        n = min(math.ceil(DIGITS / (2.0 * math.asinh(NEARER * ratio))) + SPARE, MOST_NODES)
        part, rest, w = with_weight(n, 2.0 * self.theta, -2.0 * self.theta)
        from_end = np.minimum(part, rest)
        sn, cn, dn = elliptic_functions(m, 1.0 - 2.0 * from_end, 2.0 * from_end)
        near = cn * cn / (1.0 + sn)
        on_right = part > rest
        below = np.where(on_right, 1.0 + sn, near)
        above = np.where(on_right, near, 1.0 + sn)
        plain = 2.0 * m.K * w * cn * dn * above**-a2 * below**-a1
        return below, above, plain * self._numerator(below, above), plain

    def _numerator(self, below: Array, above: Array) -> Array:
        """(1 - k y)^a2 (1 + k y)^a1."""
        a1, a2 = self.exponents
        values: Array = (self.rest + self.k * above) ** a2 * (self.rest + self.k * below) ** a1
        return values

    def kernel(self, s: tuple[Array, Array], y: tuple[Array, Array]) -> Array:
        """1/(1 - k s y), given the distances (1 + s, 1 - s) and (1 + y, 1 - y)."""
        (s_below, s_above), (y_below, y_above) = s, y
        same = (s_below < s_above)[:, None] == (y_below < y_above)
        s_near, y_near = np.minimum(s_below, s_above)[:, None], np.minimum(y_below, y_above)
        apart = s_near + y_near - s_near * y_near  # 1 - |s y|
        values: Array = 1.0 / np.where(
            same, self.rest + self.k * apart, 1.0 + self.k * (1.0 - apart)
        )
        return values

    def denominator(self, below: Array, above: Array) -> Array:
        """n(y)."""
        values: Array = above + self.alpha * below
        return values

    def place(self, below: Array, above: Array) -> Array:
        """x - (e1 + e2)/2 at y."""
        half = 0.5 * self.zones.stuck
        place: Array = half * (self.alpha * below - above) / self.denominator(below, above)
        return place

    def of_rule(self, rule: Rule) -> tuple[Array, Array, Array]:
        """1 + y and 1 - y at the places of the rule, and W/n dy there."""
        scale = self.alpha * rule.right + rule.left
        below, above = 2.0 * rule.left / scale, 2.0 * self.alpha * rule.right / scale
        mass = 0.5 * self.alpha ** -self.exponents[1] * rule.weight
        return below, above, mass * self._numerator(below, above)

    @property
    def strength(self) -> float:
        """1/χ over W: (B2/Δ)^a2 (B1/(α Δ))^a1."""
        (x1, e1, e2, x2), alpha, (a1, a2) = self.zones, self.alpha, self.exponents
        right, left = (x2 - e1) + alpha * (x2 - e2), alpha * (e2 - x1) + (e1 - x1)
        return (right / self.zones.stuck) ** a2 * (left / (alpha * self.zones.stuck)) ** a1


class Answer(NamedTuple):
    """The defects of the conditions with given zones: each is 0 in the state that is sought.

    load            a measure of ∫p_d, a stress
    left, right     p times the distance from the edge, to the powers a1 and a2, over β
    stuck           ∫(f p - q) dx
    """

    load: float
    left: float
    right: float
    stuck: float


class StickProblem:
    """p_d/β in a contact with these zones, for γ_d at the places of the rule; Φ/β at the nodes.

    poles       of Φ at y = -1 and 1, for states that are infinite at the ends of the stick zone
    """

    def __init__(
        self,
        zones: Zones,
        beta: float,
        friction: float,
        rule: Rule,
        gamma: Array,
        *,
        poles: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.beta, self.friction, self.rule, self.gamma = beta, friction, rule, gamma
        self.map = Map(zones, math.atan(beta * friction) / math.pi)
        m = self.map
        nodes = (m.below, m.above)
        ends = np.array([2.0, 0.0, 1.0 + m.far]), np.array([0.0, 2.0, 1.0 - m.far])
        s = np.append(m.below, ends[0]), np.append(m.above, ends[1])
        own = m.kernel(s, nodes) * m.weight
        below, above, mass = m.of_rule(rule)
        source = -(m.kernel(s, (below, above)) @ (mass * gamma)) / (1.0 - beta * beta)
        source += m.kernel(s, (np.array([0.0, 2.0]), np.array([2.0, 0.0]))) @ np.array(poles)
        n = len(m.weight)
        whole = own @ own[:n] / ((1.0 - beta * beta) * math.pi**2)
        # ∫p_d = 0 is asked of Φ, and what the equations then miss is an unknown: next to β = 0 a
        # pressure that varies like that of a flat punch nearly solves them
        system = np.zeros((n + 1, n + 1))
        system[:n, :n] = np.eye(n) - whole[:n]
        system[:n, n] = 1.0
        system[n, :n], system[n, n] = whole[-1], -1.0
        solved = np.linalg.solve(system, np.append(source[:n], -source[-1]))
        self.Phi, self.missed = solved[:n], float(solved[n])
        self.at_right, self.at_left, _ = (whole[n:] @ self.Phi + source[n:] - self.missed).tolist()
        self.A = (own[:n] @ self.Phi) / math.pi**2  # A/(β n)

    @property
    def answer(self) -> Answer:
        m, (x1, e1, e2, x2) = self.map, self.map.zones
        a1, a2 = m.exponents
        cos = math.cos(math.pi * m.theta)
        common = cos / math.pi * m.strength * m.zones.stuck
        right = (x2 - e2) ** (a2 - 1.0) * ((x2 - e1) / (x2 - x1)) ** a1 * m.rest
        left = (e1 - x1) ** a1 / (e2 - x1) ** (1.0 - a2) / (x2 - x1) ** a2 * (1.0 + m.k)
        return Answer(
            self.missed,
            common * left * self.at_left,
            common * right * self.at_right,
            self._stuck(cos),
        )

    def _stuck(self, cos: float) -> float:
        """∫(f p - q) dx = cos πθ ∫ (β (1 + f²) A - (1 + κ²) γ_d)/(1 - β²) x dx/R.

        R = (x - e1)^a1 (e2 - x)^a2.
        """
        m, beta, f = self.map, self.beta, self.friction
        place = m.place(m.below, m.above)
        of_A = 2.0 * m.alpha ** m.exponents[1] * float((self.A * place) @ m.plain)
        middle = 0.5 * (self.rule.left - self.rule.right)
        of_gamma = float((self.gamma * middle) @ self.rule.weight)
        both = beta * beta * (1.0 + f * f) * of_A - (1.0 + (beta * f) ** 2) * of_gamma
        return cos * both / (1.0 - beta * beta)

    # -- what follows from Φ ---------------------------------------------------------------------

    def A_at(self, left: Array, right: Array) -> Array:
        """A/β at x, given x - e1 and e2 - x, which may be negative beside the stick zone."""
        m = self.map
        scale = m.alpha * right + left
        below, above = 2.0 * left / scale, 2.0 * m.alpha * right / scale
        Phi = m.weight * self.Phi / math.pi**2
        values: Array = m.denominator(below, above) * (
            m.kernel((below, above), (m.below, m.above)) @ Phi
        )
        return values

    @cached_property
    def of_rule(self) -> tuple[Array, Array]:
        """p_d/β and g at the places of the rule; H(f p - q) + β f (f p - q) = g in stick."""
        A = self.A_at(self.rule.left, self.rule.right)
        return (A - self.gamma) / (1.0 - self.beta**2), self._g(A, self.gamma)

    def _g(self, A: Array, gamma: Array) -> Array:
        beta, f = self.beta, self.friction
        both = beta * beta * (1.0 + f * f) * A - (1.0 + (beta * f) ** 2) * gamma
        g: Array = both / (1.0 - beta * beta)
        return g

    @cached_property
    def masses(self) -> Array:
        """p_d/(β χ) dx at the places of the rule."""
        (x1, _, _, x2), (a1, a2), rule = self.map.zones, self.map.exponents, self.rule
        to_left, to_right = (
            rule.left + (self.map.zones.e1 - x1),
            rule.right + (x2 - self.map.zones.e2),
        )
        masses: Array = rule.weight * to_right**a2 * to_left**a1 * self.of_rule[0]
        return masses

    def Psi(self, x: Array) -> Array:
        """Ψ/β beside the stick zone."""
        step = max(1, TOGETHER // len(self.rule.x))
        if len(x) > step:
            return np.concatenate([self.Psi(x[i : i + step]) for i in range(0, len(x), step)])
        Psi: Array = (1.0 / self._apart(x)) @ self.masses / math.pi
        return Psi

    def deficit(self, x: Array, gamma: Array) -> Array:
        """f p - q in stick, given γ_d there."""
        left, right = x - self.map.zones.e1, self.map.zones.e2 - x
        (a1, a2), kappa = self.map.exponents, self.beta * self.friction
        g = self._g(self.A_at(left, right), gamma)
        R = left**a1 * right**a2
        return -R / (math.pi * (1.0 + kappa * kappa)) * self._differences(x, g)

    def H_deficit(self, x: Array) -> Array:
        """1/π ∫(f p - q)/(x - t) dt beside the stick zone."""
        zones, (a1, a2) = self.map.zones, self.map.exponents
        end = np.where(x > zones.e2, zones.e2, zones.e1)
        g_left, g_right = self.of_rule[1][[0, -1]].tolist()
        g = np.where(x > zones.e2, g_right, g_left)
        X = np.sign(x - end) * np.abs(x - zones.e1) ** a1 * np.abs(x - zones.e2) ** a2
        cos = math.cos(math.pi * self.map.theta)
        H: Array = g + X * cos / math.pi * self._differences(x, g)
        return H

    def _differences(self, x: Array, g: Array) -> Array:
        """∫(g(t) - g)/(R (x - t)) dt."""
        step = max(1, TOGETHER // len(self.rule.x))
        if len(x) > step:
            parts = (slice(i, i + step) for i in range(0, len(x), step))
            return np.concatenate([self._differences(x[part], g[part]) for part in parts])
        apart = self._apart(x)
        # By the distance from the nearer end of the stick zone nodes next to it differ
        at_left = self.rule.left < self.rule.right
        nodes = np.where(at_left, self.rule.left, -self.rule.right)
        widths = np.ptp(nodes.reshape(-1, NODES), axis=1)
        rows, columns = np.nonzero(np.abs(apart) < np.repeat(CLOSE * widths, NODES))
        apart[rows, columns] = 1.0
        quotients = self.of_rule[1] - g[:, None]
        quotients /= apart
        for i, j in zip(rows.tolist(), columns.tolist(), strict=True):
            # So close, rounding counts: the value is interpolated from the others of the panel
            panel = slice(j - j % NODES, j - j % NODES + NODES)
            quotients[i, j] = quotients[i, panel] @ _from_others(nodes[panel], j % NODES)
        values: Array = quotients @ self.rule.weight
        return values

    def _apart(self, x: Array) -> Array:
        """x - t for all ascending places t of the rule, from the nearer end of the stick zone."""
        zones, rule = self.map.zones, self.rule
        near = int(np.count_nonzero(rule.left < rule.right))
        apart = np.empty((len(x), len(rule.left)))
        np.subtract((x - zones.e1)[:, None], rule.left[:near], out=apart[:, :near])
        np.subtract(rule.right[near:], (zones.e2 - x)[:, None], out=apart[:, near:])
        return apart


def _from_others(x: Array, j: int) -> Array:
    """The weights with which a polynomial at the nodes but x_j gives that at x_j."""
    # They do not depend on the unit; products of lengths such as 1e-30 underflow
    apart = (x[:, None] - x) / np.ptp(x)
    np.fill_diagonal(apart, 1.0)
    weights = 1.0 / np.delete(apart, j, axis=1).prod(axis=1)
    weights *= np.delete(apart[j], j).prod() / apart[j]
    weights[j] = 0.0
    return weights
