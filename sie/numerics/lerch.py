"""The counterparts of 2 artanh sqrt(r) and 2 arctan sqrt(r) for the exponents of frictional edges.

    log(a):     Λ_a(r) = ∫_0^r t^(a-1)/(1 - t) dt = Σ r^(k+a)/(k+a)
    arctan(a):  A_a(r) = ∫_0^r t^(a-1)/(1 + t) dt = Σ (-1)^k r^(k+a)/(k+a)

These are r^a times Lerch's Φ(±r, 1, a); at a = 1/2, 2 artanh sqrt(r) and 2 arctan sqrt(r). They are
for |r| <= 1, 0 < a < 1, and A_a(r) = (-1)^-a Λ_a(-r). With d = -ln r, Λ is r^a times a power series
in r where Re d >= SWITCH, and nearer to 1 a Taylor series in d of Bernoulli's polynomials:

    Λ_a = -ln d + const - Σ B_n(a) (-d)^n / (n n!),        |d| < 2π

Erdélyi et al., Higher Transcendental Functions I (1953), §§ 1.11 (9), 1.13. The constant comes from
the other series, at SWITCH.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

SWITCH = 1.2
POWERS = 32  # e^(-32 SWITCH) is rounding
TERMS_REAL = 24  # (SWITCH/2π)^n is rounding
TERMS_COMPLEX = 62  # (|SWITCH + iπ|/2π)^n is rounding


@lru_cache(maxsize=64)
def _powers(a: float) -> Array:
    return 1.0 / (np.arange(POWERS) + a)


@lru_cache(maxsize=64)
def _bernoulli(a: float) -> Array:
    """-B_n(a) (-1)^n / (n n!) for n >= 1, after a constant that matches the series at SWITCH."""
    n = np.arange(TERMS_COMPLEX + 1)
    # B_n / n! from t / (e^t - 1) = 1 / Σ t^k / (k + 1)!
    inverse = np.array([1.0 / factorial(int(k) + 1) for k in n])
    numbers = np.zeros(len(n))
    numbers[0] = 1.0
    for k in n[1:]:
        numbers[k] = -np.dot(inverse[1 : k + 1], numbers[k - 1 :: -1][:k])
    exponential = np.array([a ** int(k) / factorial(int(k)) for k in n])
    polynomials = np.convolve(numbers, exponential)[: len(n)]
    c = np.zeros(len(n))
    c[1:] = -polynomials[1:] * (-1.0) ** n[1:] / n[1:]
    r = np.exp(-SWITCH)
    c[0] = (
        r**a * np.polynomial.polynomial.polyval(r, _powers(a))
        + np.log(SWITCH)
        - np.polynomial.polynomial.polyval(SWITCH, c)
    )
    return c


def log(a: float, r: Array, y: Array) -> Array:
    """Λ_a(r) for |r| <= 1, real or complex; y = 1 - r is given too, for accuracy near r = 1.

    It is infinite at y = 0.
    """
    far = np.abs(r) <= np.exp(-SWITCH)
    out = np.empty_like(r)
    if far.any():
        at = r[far]
        out[far] = at**a * _horner(_powers(a), at)
    if not far.all():
        d = -log1p(-y[~far])
        terms = TERMS_COMPLEX if np.iscomplexobj(r) else TERMS_REAL
        with np.errstate(divide="ignore"):
            out[~far] = _horner(_bernoulli(a)[:terms], d) - np.log(d)
    return out


def arctan(a: float, r: Array) -> Array:
    """A_a(r) for 0 <= r < inf."""
    inner = r <= 1.0
    out = np.empty_like(r)
    out[inner] = _arctan_inside(a, r[inner])
    if not inner.all():
        out[~inner] = np.pi / np.sin(np.pi * a) - _arctan_inside(1.0 - a, 1.0 / r[~inner])
    return out


def _arctan_inside(a: float, r: Array) -> Array:
    """(-1)^-a Λ_a(-r), both with the argument π of -r."""
    values = log(a, -r + 0.0j, np.conj(1.0 + r + 0.0j))
    return np.asarray((np.exp(-1j * np.pi * a) * values).real)


def log1p(u: Array) -> Array:
    """ln(1 + u), real or complex: NumPy's for complex numbers rounds 1 + u first."""
    if not np.iscomplexobj(u):
        real: Array = np.log1p(u)
        return real
    out = np.empty_like(u)
    squared = u.real * (2.0 + u.real) + u.imag * u.imag  # |1 + u|² - 1
    out.real = 0.5 * np.log1p(np.maximum(squared, -1.0))
    out.imag = np.arctan2(u.imag, 1.0 + u.real)
    return out


def _horner(c: Array, x: Array) -> Array:
    total = np.full_like(x, c[-1])
    for a in c[-2::-1]:
        total = total * x + a
    return total
