"""A power law h = A |x - c|^m, m > 1, pressed upright: half-width, load and pressure.

A convex, symmetric contact is a superposition of flat punches whose half-width s grows with the
load (Jäger 1998). A flat punch under dP has the pressure dP/(π sqrt(s² - x²)). Here

    P(s) = E* A m W s^m,   W = ∫_0^(π/2) sin^m φ dφ = (sqrt(π)/2) Γ((m+1)/2) / Γ(m/2+1),

so that with ξ = |x - c|/b = 1/cosh T and s = b ξ cosh t all of the integrand is positive:

    p = 1/π ∫_|x-c|^b P'(s)/sqrt(s² - (x-c)²) ds = m P/(π b) J(ξ)
    J = ξ^(m-1) ∫_0^T cosh^(m-1) t dt

Two series, in w = (1-ξ)/(1+ξ) = tanh²(T/2), which vanishes at the edge, and in
q = (1-k)/(1+k) = exp(-2T), k = sqrt(1-ξ²), which vanishes on the axis. They follow from
cosh t = (1+v)/(1-v) with v = tanh²(t/2), and from cosh t = e^t (1 + e^(-2t))/2:

    J = 2 ξ^(m-1) sqrt(w) Σ a_n w^n/(2n+1),   Σ a_n w^n = (1+w)^(m-1)/(1-w)^m
    J = ((1+k)/2)^(m-1) Σ C(m-1, j) (q^j - q^((m-1)/2)) / (m-1-2j)

with (n+1) a_{n+1} = (2m-1) a_n + n a_{n-1}. All terms of the first are positive, and those of the
second with j < m. The series are joined at ξ² = 1/2, where w = q = 3 - 2 sqrt(2). The factor of
q^((m-1)/2), which is the power |x-c|^(m-1) of the slope, is not summed: both series have to agree
there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import LoadError
from sie.numerics.interval import EPS

Array = NDArray[np.float64]

# w and q where the two series are joined: the ratio of terms apart from the factors' growth
MEET = 3.0 - 2.0 * math.sqrt(2.0)
NEGLIGIBLE = EPS / 16.0  # of the sum
LARGEST = 300.0  # exponent: gamma functions overflow beyond
RANGE = 690.0  # of logarithms of doubles, some way from their ends
SMALLEST = 5e-324  # of the doubles, denormal: stands for 0 in a logarithm


@dataclass(frozen=True)
class PowerLaw:
    """h = coefficient |x - axis|^exponent."""

    exponent: float
    coefficient: float
    axis: float = 0.0

    @property
    def explicit(self) -> bool:
        """Whether the closed form serves; an exponent of 1 is a wedge."""
        return 1.0 < self.exponent <= LARGEST

    def load(self, b: float, half_modulus: float) -> float:
        """The load P that belongs to the half-width b."""
        return self._load(b, half_modulus, f"half-width {b:.6g}")

    def _load(self, b: float, half_modulus: float, given: str) -> float:
        m, A, factor = self.exponent, self.coefficient, self._factor
        rise = m * math.log(b)
        height = rise + math.log(A)
        stress = height + math.log(half_modulus)
        self._refuse_beyond_range(given, rise, height, stress)
        return half_modulus * (A * b**m) * factor

    def half_width(self, P: float, half_modulus: float) -> float:
        """The half-width b under the load P, by logarithms and one step of Newton's method."""
        m, scales = self.exponent, (half_modulus, self.coefficient, self._factor)
        size = (math.log(P) - math.fsum(map(math.log, scales))) / m
        given = f"load {P:.6g}"
        self._refuse_beyond_range(given, size)
        b = math.exp(size)
        return b + b * (P / self._load(b, half_modulus, given) - 1.0) / m

    def _refuse_beyond_range(self, given: str, *logarithms: float) -> None:
        if max(map(abs, logarithms)) > RANGE:
            raise LoadError(
                f"the {given} under h = {self.coefficient:.6g} |x|^{self.exponent:.6g} needs "
                "numbers beyond the range of doubles: choose other units"
            )

    def slope(self, b: float) -> float:
        """h' at the distance b from the axis."""
        return self.exponent * (self.coefficient * b ** (self.exponent - 1.0))

    @property
    def _factor(self) -> float:
        """2 m W."""
        m = self.exponent
        return m * math.sqrt(math.pi) * math.gamma(0.5 * (m + 1.0)) / math.gamma(0.5 * m + 1.0)

    def pressure(self, y: Array, near: Array, b: float) -> Array:
        """p over E*/2 at y = x - axis, `near` from the nearer edge of a contact of half-width b."""
        strain = self.coefficient * b ** (self.exponent - 1.0)
        return (self.exponent / math.pi * self._factor * strain) * self.superposed(y, near, b)

    def superposed(self, y: Array, near: Array, b: float) -> Array:
        """J at y = x - axis, given the distance of x from the nearer edge, to relative accuracy."""
        w = near / (2.0 * b - near)
        edge = w <= MEET
        J = np.empty_like(y)
        J[edge] = _near_edge(self.exponent, w[edge])
        J[~edge] = _near_axis(self.exponent, np.abs(y[~edge]) / b)
        return J


@dataclass(frozen=True)
class PowerSlope:
    """The slope exponent coefficient |y|^(exponent - 1) sign y, as a function of an array y."""

    exponent: float
    coefficient: float

    def __call__(self, y: Array) -> Array:
        """h' at the distances y from the axis."""
        return np.copysign(self.exponent * self.coefficient * np.abs(y) ** (self.exponent - 1.0), y)


def _near_edge(m: float, w: Array) -> Array:
    return 2.0 * np.exp((1.0 - m) * (2.0 * np.arctanh(w))) * np.sqrt(w) * _horner(_edge_terms(m), w)


def _near_axis(m: float, xi: Array) -> Array:
    s = _axis_terms(m)
    root = 1.0 + np.sqrt((1.0 - xi) * (1.0 + xi))
    ratio = xi / root  # sqrt(q)
    power = np.exp((m - 1.0) * np.log1p(-0.5 * xi * ratio))
    out: Array = power * (_horner(s.rest, ratio * ratio) - s.singular(ratio))
    out[xi == 0.0] = 1.0 / (m - 1.0)
    return out


class _AxisTerms(NamedTuple):
    """The series about the axis: `rest` lacks the term j = `nearest`, where m - 1 - 2j may vanish.

    `binomial` is C of that term, `power` the factor of q^((m-1)/2) that is left without it.
    """

    exponent: float
    rest: tuple[float, ...]
    nearest: int
    binomial: float
    power: float

    def singular(self, ratio: Array) -> Array:
        """C (q^((m-1)/2) - q^j)/(m-1-2j) + power q^((m-1)/2), with ratio = sqrt(q)."""
        m, even = self.exponent, 2.0 * self.nearest
        apart = abs(m - 1.0 - even)
        log_ratio = np.log(np.maximum(ratio, SMALLEST))
        quotient = np.expm1(apart * log_ratio) / apart if apart else log_ratio
        out: Array = self.power * ratio ** (m - 1.0)
        out += self.binomial * quotient * ratio ** min(m - 1.0, even)
        return out


def _horner(c: tuple[float, ...], x: Array) -> Array:
    total = np.full_like(x, c[-1])
    for a in c[-2::-1]:
        total *= x
        total += a
    return total


@lru_cache(maxsize=32)
def _edge_terms(m: float) -> tuple[float, ...]:
    """a_n/(2n+1) as far as they matter at `MEET`."""
    before, a, n = 0.0, 1.0, 0
    terms, power, total = [1.0], 1.0, 1.0
    while terms[-1] * power > NEGLIGIBLE * total:
        before, a, n = a, ((2.0 * m - 1.0) * a + n * before) / (n + 1), n + 1
        power *= MEET
        terms.append(a / (2 * n + 1))
        total += terms[-1] * power
    return tuple(terms)


@lru_cache(maxsize=32)
def _axis_terms(m: float) -> _AxisTerms:
    nearest = round(0.5 * (m - 1.0))
    terms: list[float] = []
    binomial, at_nearest, size, largest, j = 1.0, 1.0, 1.0, 0.0, 0
    while j <= nearest + 1 or size > NEGLIGIBLE * largest:
        if j == nearest:
            at_nearest = binomial
        terms.append(0.0 if j == nearest else binomial / (m - 1.0 - 2 * j))
        size = abs(terms[-1]) * MEET**j
        largest = max(largest, size)
        binomial *= (m - 1.0 - j) / (j + 1.0)
        j += 1
    series = _AxisTerms(m, tuple(terms), nearest, at_nearest, 0.0)
    meet = np.array([MEET])
    common = (0.5 + math.sqrt(0.125)) ** (m - 1.0)
    here = _horner(series.rest, meet) - series.singular(np.sqrt(meet))
    left_over = float((here - _near_edge(m, meet) / common)[0])
    return series._replace(power=left_over / MEET ** (0.5 * (m - 1.0)))
