"""How tractions change with Q at constant P while a contact spreads over what sticks as touched.

The zones are slip with q = -f p on a strip [x1, e0], stick [e0, e2], slip with q = f p on [e2, x2].
x1 and e0 move left as Q grows, and so do e2 and x2. Under Q + dQ the tractions change by ṗ dQ,
q̇ dQ: with h' and, in stick, γ fixed

    H ṗ = β q̇ in contact,     H q̇ = -β ṗ in stick,     q̇ = -f ṗ on the strip, f ṗ on [e2, x2],

as singular at x1, e2 and x2 as advancing edges allow, and bounded at e0. The map

    t = (x - x1)/(x2 - x) (x2 - e2)/(e2 - x1),      ṗ(x) = p̂(t)/(x2 - x),   q̇ alike,

takes x1, e0, e2, x2 to 0, ε, 1, ∞ and infinity to -ρ, ρ = (x2 - e2)/(e2 - x1). Beyond the strip p̂
and q̂ are those of `bonded_edge` times polynomials in 1/t,

    Φ = Σ t^-n (b_n Φ_0 + s_n Φ_1),                                             |t| > ε,

and next to it, by the inversion z = ε/t, which turns the sign of q, those times polynomials in 1/z,

    Φ = -z [Σ i_n z^-n Φ_0(z) + Σ j_n z^-n (1 - z) Φ_1(z)]*,   j_0 = 0,          |t| < 1.

Both are (-t)^(-1/2+iη) times Laurent series between ε and 1, whose coefficients agree for one ε if
F ṗ vanishes at infinity (∫ṗ dx = 0). With n < 6 what is neglected is ε³. ε is about
exp(-(π/2 + atan f)/η) times ρ, and may be as small as that is.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .bonded_edge import BondedEdge

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

ORDERS = 6  # of the polynomials in 1/t and in 1/z, which are joined at t = ε^(1/2)
STEPS, SETTLED = 6, 1e-14  # of the iteration, each of which gains a factor ε; of ln ε, the last one
FIRST = -1e3  # ln ε before it is known, when its powers do not count


class Weights(NamedTuple):
    """The weights of the solutions at one or more zones, for ∫q̇ dx = 1.

    outer       b_n and s_n, (2, ORDERS, zones)
    inner       i_n and j_n, the same, times ε^(1/2)
    log         ln ε

    Without those of n > 0 they are the weights for a strip that is not seen.
    """

    outer: Array
    inner: Array
    log: Array


class Lengths(NamedTuple):
    """Distances of a place x from the ends of the zones, and the lengths of these.

    to_x1, to_e2, to_x2     x - x1, e2 - x and x2 - x
    stuck, slipping         e2 - x1 and x2 - e2
    """

    to_x1: Array
    to_e2: Array
    to_x2: Array
    stuck: Array
    slipping: Array

    @property
    def t(self) -> Array:
        values: Array = self.slipping * self.to_x1 / (self.stuck * self.to_x2)
        return values

    @property
    def rest(self) -> Array:
        """1 - t."""
        whole = self.stuck + self.slipping
        values: Array = self.to_e2 * whole / (self.to_x2 * self.stuck)
        return values


class EdgeRates:
    """The rates for one β > 0 and f."""

    def __init__(self, beta: float, friction: float) -> None:
        self.beta, self.friction = beta, friction
        self.pair = BondedEdge(beta, friction, 0), BondedEdge(beta, friction, 1)
        self.theta, self.eta = self.pair[0].theta, self.pair[0].eta
        self.cos = math.cos(math.pi * self.theta)

    @property
    def sticking(self) -> float:
        """d₊ over the half-width: nearer to the edge what is touched sticks."""
        return math.exp(-(0.5 * math.pi - math.atan(self.friction)) / self.eta)

    # -- the weights -------------------------------------------------------------------------------

    def weights(self, rho: Array) -> Weights:
        """The weights where infinity is at t = -ρ."""
        one, other = (edge.beside(rho) for edge in self.pair)
        size = np.hypot(one.real, other.real)
        powers = (-1.0 / rho) ** np.arange(ORDERS)[:, None]
        outer, inner = np.zeros((2, ORDERS, len(rho))), np.zeros((2, ORDERS, len(rho)))
        outer[0, 0], outer[1, 0] = other.real / size, -one.real / size
        log, far = np.full(len(rho), FIRST), np.log(rho)
        for _ in range(STEPS):
            before, log = log, self._match_strip(outer, inner, (log, far))
            self._match_beyond(outer, inner, log)
            missed = (powers[1:] * (outer[0, 1:] * one.real + outer[1, 1:] * other.real)).sum(0)
            outer[0, 0] = (other.real - missed * one.real / size) / size
            outer[1, 0] = -(one.real + missed * other.real / size) / size
            if float(np.abs(log - before).max()) < SETTLED:
                break
        load = -math.pi * (powers * (outer[0] * one.imag + outer[1] * other.imag)).sum(0)
        return Weights(outer / load, inner / load, log)

    def _match_strip(self, outer: Array, inner: Array, logs: tuple[Array, Array]) -> Array:
        """Sets i_n and j_n by the coefficients of t^n; the next ln ε, from it and ln ρ."""
        log, far = logs
        eta, (B, S) = self.eta, (complex(edge.taylor[0]) for edge in self.pair)
        back = np.exp(1j * eta * log)
        for n in range(ORDERS - 1, 0, -1):
            inner[:, n] = 0.0
            value = self._beyond_strip(outer, n) * back * np.exp(n * log)
            value -= self._of_strip(inner, -n)
            inner[:, n] = _real_parts(value, B.conjugate(), S.conjugate())
        inner[0, 0] = 0.0
        own = B * (self._beyond_strip(outer, 0) - self._of_strip(inner, 0) / back)
        # The widest strip that is narrower than ρ
        log = far - np.mod(np.angle(own) / eta + far, math.pi / eta)
        inner[0, 0] = (own * np.exp(1j * eta * log)).real / abs(B) ** 2
        return log

    def _match_beyond(self, outer: Array, inner: Array, log: Array) -> None:
        """Sets b_n and s_n, n > 0, by the coefficients of t^-n."""
        B, S = (complex(edge.taylor[0]) for edge in self.pair)
        for n in range(ORDERS - 1, 0, -1):
            outer[:, n] = 0.0
            value = np.exp((n - 1j * self.eta) * log) * self._of_strip(inner, n)
            outer[:, n] = _real_parts(value - self._beyond_strip(outer, -n), B, S)

    def _beyond_strip(self, outer: Array, m: int) -> Complex:
        """The coefficient of t^m in the sum beyond the strip."""
        total: Complex = self._laurent[0][ORDERS + m] @ outer.reshape(2 * ORDERS, -1)
        return total

    def _of_strip(self, inner: Array, m: int) -> Complex:
        """The coefficient of z^m in the sum next to the strip."""
        total: Complex = self._laurent[1][ORDERS + m] @ inner.reshape(2 * ORDERS, -1)
        return total

    @cached_property
    def _laurent(self) -> tuple[Complex, Complex]:
        """What each weight adds to the coefficients of t^m, and of z^m, |m| < ORDERS."""
        B, S = (edge.taylor for edge in self.pair)
        inverted = (S - np.append(0.0, S[:-1])).conj()  # of (1 - z) Φ_1
        rows = np.zeros((2, 2 * ORDERS, 2, ORDERS), dtype=complex)
        for m in range(1 - ORDERS, ORDERS):
            for n in range(max(0, -m), ORDERS):
                rows[0, ORDERS + m, :, n] = B[m + n], S[m + n]
                rows[1, ORDERS + m, :, n] = B[m + n].conj(), inverted[m + n] if n else 0.0
        beyond, strip = rows.reshape(2, 2 * ORDERS, 2 * ORDERS)
        return beyond, strip

    # -- the rates ---------------------------------------------------------------------------------

    def inside(self, at: Lengths, weights: Weights, strip: bool = True) -> tuple[Array, ...]:
        """ṗ, f ṗ - q̇ and γ̇ in contact."""
        t, rest = at.t, at.rest
        pairs = [edge.inside(t, rest) for edge in self.pair]
        A, R = (self._beyond(weights, t, pairs[0][j], pairs[1][j]) for j in (0, 1))
        slips = at.to_e2 < 0.0
        p = np.where(slips, A - self.cos * self.beta * R, A)
        gamma = np.where(slips, (1.0 - self.beta**2) * self.cos * R, 0.0)
        deficit = np.where(slips, 0.0, R)
        if strip:
            near = np.log(t) < 0.5 * weights.log
            if near.any():
                own = Weights(*(part[..., near] for part in weights))
                p[near], deficit[near], gamma[near] = self._at_strip(t[near], own)
        return p / at.to_x2, deficit / at.to_x2, gamma / at.to_x2

    def _beyond(self, weights: Weights, t: Array, one: Any, other: Any) -> Any:
        b, s = weights.outer
        if len(b) == 1:
            return b[0] * one + s[0] * other
        v = 1.0 / t
        return _polynomial(b, v) * one + _polynomial(s, v) * other

    def _at_strip(self, t: Array, weights: Weights) -> tuple[Array, Array, Array]:
        """p̂, f p̂ - q̂ and γ̂ next to the strip and on it."""
        z, rest, factor, (of_B, of_S) = self._inverted(t, weights, 1.0)
        (A, R), (C, U) = (edge.inside(z, rest) for edge in self.pair)
        A, R = factor * (of_B * A + of_S * C), factor * (of_B * R + of_S * U)
        slips, f = z > 1.0, self.friction
        p = np.where(slips, A - self.cos * self.beta * R, A)
        q = np.where(slips, -f * p, R - f * A)
        return p, f * p - q, np.where(slips, (1.0 - self.beta**2) * self.cos * R, 0.0)

    def _inverted(
        self, t: Array, weights: Weights, side: float
    ) -> tuple[Array, Array, Array, tuple[Array, Array]]:
        """|z|, 1 - z, the weight of the inversion, and the polynomials of both solutions."""
        (i, j), log = weights.inner, weights.log
        z = np.exp(log - np.log(t))
        rest, v = 1.0 - side * z, side / z
        factor = np.exp(0.5 * log) / t  # z, where i and j have the factor ε^(-1/2)
        return z, rest, factor, (_polynomial(i, v), rest * _polynomial(j, v))

    def beside(self, at: Lengths, weights: Weights, strip: bool = True) -> Complex:
        """F ṗ + i F q̇ beside the contact, at t < 0; on the left to_x2 > 0."""
        m = -at.t
        one, other = (edge.beside(m) for edge in self.pair)
        values = self._beyond(weights, -m, one, other)
        if strip:
            near = np.log(m) < 0.5 * weights.log
            if near.any():
                own = Weights(*(part[..., near] for part in weights))
                z, _, factor, (of_B, of_S) = self._inverted(m[near], own, -1.0)
                one, other = (edge.beside(z) for edge in self.pair)
                values[near] = factor * (of_B * one + of_S * other).conj()
        beside: Complex = values / at.to_x2
        return beside


def _polynomial(coefficients: Array, v: Array) -> Array:
    total: Array = coefficients[-1]
    for c in coefficients[-2::-1]:
        total = c + v * total
    return total


def _real_parts(value: Complex, one: complex, other: complex) -> tuple[Array, Array]:
    """Real x and y with x one + y other = value."""
    whole = (one.conjugate() * other).imag
    return (value.conj() * other).imag / whole, -(value.conj() * one).imag / whole
