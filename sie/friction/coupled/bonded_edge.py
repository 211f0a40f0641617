"""Tractions of a contact that sticks up to its left edge, infinite where its three zones end.

On the line t < 0 lies beside the contact, 0 < t < 1 sticks, and t > 1 slips with q = f p,

    t > 0:  H p = β q,      0 < t < 1:  H q = -β p,      tan πθ = β f,  tanh πη = β.

Φ = F p + i F q is multiplied by constants around 0, 1 and ∞ only. The solutions times any rational
function are solutions again, and all are sums of two of them, k = 0 and 1,

    Φ = C (-t)^(-1/2 + iη) ₂F₁(a, b; 1 + 2iη; t),       a = θ + iη,  b = k + 1/2 + iη,

C of the phase for which Φ is i t^(-1-k) next to infinity but for a multiple of 1 + i f. In stick
q - i p = Φ/(1 + β). With e = 1/2 - θ - k

    A = α t^(-1/2-θ) ₂F₁(a, a*; 1/2 + θ + k; 1 - 1/t),          p = A in stick,
    R = σ (1 - t)^e t^(-3/2+θ) ₂F₁(1 - a*, 1 - a; 1 + e; 1 - 1/t),   R = f p - q in stick,

are real for t > 0, where |1 - t|^e has the sign of (1 - t)^k, and in slip

    p = A - cos πθ β R,      γ = (1 - β²) cos πθ R.

docs/derivations/coupled_slip.md; Abramowitz, Stegun, 15.3.3-15.3.7.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Terms of a power series with |z| <= 0.62; -ln of the part of it that is left out
TERMS, DIGITS = 84, 38.0
STICK = 0.618  # of t: up to it the series is that about 0; t and 1/t - 1 are alike
LEAST = 1e-300  # of 1 - t, whose powers may be infinite
KEPT = 12  # coefficients of the series about 0 that are given away


class BondedEdge:
    """The solution k, as functions of t and its distance from 1."""

    def __init__(self, beta: float, friction: float, k: int) -> None:
        self.beta, self.friction, self.k = beta, friction, k
        eta, theta = math.atanh(beta) / math.pi, math.atan(beta * friction) / math.pi
        self.eta, self.theta = eta, theta
        a, b, c = theta + 1j * eta, k + 0.5 + 1j * eta, 1.0 + 2.0j * eta
        self.a, self.b, self.power = a, b, 0.5 - theta - k
        e = self.power
        to_edge = _gammas((c, b - a), (b, c - a)), _gammas((c, a - b), (a, c - b))
        C = 1j * abs(to_edge[1]) / to_edge[1]
        at_one = _gammas((c, e), (c - a, c - b)), _gammas((c, -e), (a, b))
        in_stick = 1j * math.exp(math.pi * eta) / (1.0 + beta) * C
        self.in_stick = in_stick
        self.alpha, self.sigma = -(in_stick * at_one[0]).imag, -(in_stick * at_one[1]).real
        self.about_0 = _series(a, b, c)
        self.taylor: Complex = C * self.about_0[:KEPT]
        self.beside_0 = _series(a, c - b, c)
        self.C, self.at_edge = C, ((C * to_edge[0]).real, (C * to_edge[1]).imag)
        self.beside_edge = (
            _series(a, 1.0 - b + a - a.conjugate(), 1.0 - b + a),
            _series(b, 1.0 - a + b - b.conjugate(), 1.0 - a + b),
        )
        self.of_A = _Real(a, 0.5 + theta + k)
        self.of_R = _Real(c - a, 1.0 + e)

    def inside(self, t: Array, rest: Array) -> tuple[Array, Array]:
        """A and R at t > 0, rest = 1 - t."""
        A, R = np.empty(t.shape), np.empty(t.shape)
        near = t <= STICK
        if near.any():
            place = t[near]
            size = np.exp((1j * self.eta - 0.5) * np.log(place))
            both = self.in_stick * size * _summed(self.about_0, place)
            A[near] = -both.imag
            R[near] = -self.friction * both.imag - both.real
        if not near.all():
            far = ~near
            place, from_1 = t[far], rest[far]
            singular = np.maximum(np.abs(from_1), LEAST) ** self.power
            if self.k:
                singular = np.copysign(singular, from_1)
            A[far] = self.alpha * place ** (-0.5 - self.theta) * self.of_A(place, from_1)
            R[far] = self.sigma * singular * place ** (self.theta - 1.5) * self.of_R(place, from_1)
        return A, R

    def beside(self, m: Array) -> Complex:
        """Φ = F p + i F q at t = -m."""
        values = np.empty(m.shape, dtype=complex)
        near = m <= 1.0
        if near.any():
            place = m[near]
            size = np.exp((1j * self.eta - 0.5) * np.log(place) - self.a * np.log1p(place))
            values[near] = self.C * size * _summed(self.beside_0, place / (1.0 + place))
        if not near.all():
            place = m[~near]
            z, rest = 1.0 / (1.0 + place), np.log1p(1.0 / place)
            of_p, of_q = (
                (np.exp(-power * rest) * _summed(series, z)).real
                for power, series in zip((self.a, self.b), self.beside_edge, strict=True)
            )
            values[~near] = (1.0 + 1j * self.friction) * self.at_edge[0] * of_p * place ** (
                -0.5 - self.theta
            ) + 1j * self.at_edge[1] * of_q * place ** (-1.0 - self.k)
        return values


class _Real:
    """₂F₁(a, a*; c; 1 - 1/t), real, for t > STICK."""

    def __init__(self, a: complex, c: float) -> None:
        b = a.conjugate()
        self.power = c - 2.0 * a.real
        self.about_1 = _series(a, b, c).real
        self.far = (
            _gammas((c, self.power), (c - a, c - b)).real * _series(a, b, 1.0 - self.power).real,
            _gammas((c, -self.power), (a, b)).real * _series(c - a, c - b, 1.0 + self.power).real,
        )

    def __call__(self, t: Array, rest: Array) -> Array:
        values = np.empty(t.shape)
        near = t <= 2.0
        values[near] = _summed(self.about_1, -rest[near] / t[near])
        if not near.all():
            z = 1.0 / t[~near]
            one, other = (_summed(series, z) for series in self.far)
            values[~near] = one + z**self.power * other
        return values


def _series(a: complex, b: complex, c: complex) -> Complex:
    """The coefficients of ₂F₁(a, b; c; z)."""
    n = np.arange(TERMS - 1)
    return np.cumprod(np.append(1.0 + 0.0j, (a + n) * (b + n) / ((c + n) * (n + 1.0))))


def _summed(series: NDArray[Any], z: Array) -> NDArray[Any]:
    """The power series at each z."""
    size = float(np.abs(z).max(initial=LEAST))
    if size < 1.0:
        series = series[: 2 + math.ceil(DIGITS / -math.log(size))]
    total = np.full(z.shape, series[-1])
    for c in series[-2::-1]:
        total *= z
        total += c
    return total


def _gammas(over: tuple[complex, ...], under: tuple[complex, ...]) -> complex:
    """The product of Γ over that of other Γ."""
    from scipy.special import loggamma  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

    logs = sum(complex(loggamma(complex(z))) for z in over)
    logs -= sum(complex(loggamma(complex(z))) for z in under)
    return cmath.exp(logs)
