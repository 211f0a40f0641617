"""Contacts of piecewise polynomial slopes in 100 digits, by integrals that are exact.

With t = m + r s, s = sin φ, and φ_x the angle of the point x,

    ∫s^n dφ = [-s^(n-1) cos φ]/n + (n-1)/n ∫s^(n-2) dφ
    ∫dφ/(s - s_x) = [ln |sin((φ - φ_x)/2) / cos((φ + φ_x)/2)|] / cos φ_x
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import mpmath

from oracles.ends import Between

mp = mpmath.mp.clone()
mp.dps = 100
Number = Any
# Each piece's origin and coefficients, low order first
Rows = tuple[tuple[Number, tuple[Number, ...]], ...]


@dataclass(frozen=True)
class Exact(Between):
    """A contact [x1, x2] of a piecewise polynomial slope; `breaks` are the inner ones."""

    breaks: tuple[Number, ...]
    rows: Rows
    x1: Number
    x2: Number

    def angle(self, t: Number) -> Number:
        return mp.atan2(t - self.m, mp.sqrt((t - self.x1) * (self.x2 - t)))

    def parts(self) -> Iterator[tuple[Number, Number, Sequence[Number]]]:
        """(φ_lo, φ_hi, coefficients in s) of every piece in the contact."""
        inner = [b for b in self.breaks if self.x1 < b < self.x2]
        first = sum(b <= self.x1 for b in self.breaks)
        ends = [-mp.pi / 2, *map(self.angle, inner), mp.pi / 2]
        for (lo, hi), (origin, row) in zip(pairwise(ends), self.rows[first:], strict=False):
            yield lo, hi, _in_s(row, self.m - origin, self.r)

    def integral(self, *weights: Sequence[Number]) -> list[Number]:
        """∫ H w(s) dφ of several polynomials w, low order first."""
        totals = [mp.zero for _ in weights]
        for lo, hi, c in self.parts():
            powers = _powers(lo, hi, len(c) + 3)
            for k, weight in enumerate(weights):
                totals[k] += sum(
                    a * b * powers[i + j] for i, a in enumerate(c) for j, b in enumerate(weight)
                )
        return totals

    def stiffness(self) -> Number:
        """The smaller of d(r K2)/dx2 and -d(r K1)/dx1, of ∫H (1 ± s) dφ: how weakly an edge is
        determined.
        """
        h = self.r * mp.mpf(10) ** -40
        wider = (
            (Exact(self.breaks, self.rows, self.x1 - h, self.x2), (1, -1)),
            (Exact(self.breaks, self.rows, self.x1, self.x2 + h), (1, 1)),
        )
        return min(abs(c.r * c.integral(w)[0] - self.r * self.integral(w)[0]) / h for c, w in wider)

    def pressure(self, x: float, G: Number) -> Number:
        """G/π w(x) PV∫ H/(w (t - x)) dt."""
        at = mp.mpf(x)
        s, phi = (at - self.m) / self.r, self.angle(at)
        total = mp.zero
        for lo, hi, c in self.parts():
            quotient, rest = _divided(c, s)
            powers = _powers(lo, hi, max(len(quotient), 1))
            total += mp.cos(phi) * sum(q * v for q, v in zip(quotient, powers, strict=False))
            total += rest * (_logarithm(hi, phi) - _logarithm(lo, phi))
        return G * total / mp.pi


def _in_s(row: Sequence[Number], a: Number, r: Number) -> list[Number]:
    """Coefficients in s of Σ row_j (a + r s)^j, by Horner."""
    out = [mp.zero]
    for c in reversed(row):
        raised = [mp.zero, *(r * v for v in out)]
        out = [a * v + w for v, w in zip([*out, mp.zero], raised, strict=True)]
        out[0] += c
    return out


def _powers(lo: Number, hi: Number, n: int) -> list[Number]:
    """∫ sin^k φ dφ for k < n."""
    (a, c), (b, d) = (mp.sin(lo), mp.cos(lo)), (mp.sin(hi), mp.cos(hi))
    out = [hi - lo, c - d]
    for k in range(2, n):
        out.append((a ** (k - 1) * c - b ** (k - 1) * d) / k + out[k - 2] * (k - 1) / k)
    return out[:n]


def _divided(c: Sequence[Number], s: Number) -> tuple[list[Number], Number]:
    """(c(t) - c(s)) / (t - s), and c(s), by synthetic division."""
    out = [c[-1]]
    for a in reversed(c[:-1]):
        out.append(out[-1] * s + a)
    return out[-2::-1], out[-1]


def _logarithm(phi: Number, at: Number) -> Number:
    if abs(abs(phi) - mp.pi / 2) < mp.mpf(10) ** -98:
        return mp.zero
    return mp.log(abs(mp.sin((phi - at) / 2) / mp.cos((phi + at) / 2)))
