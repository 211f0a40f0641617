"""E*/2 h' on the window that a contact may reach, and its principal value over any contact.

    1/π PV∫_x1^x2 H(t)/(t - x) dt,

panel by panel of Chebyshev series, with ∫T_n(s)/(s - σ) ds by its recurrence next to the panel
and by Gauss-Legendre nodes elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import EPS

if TYPE_CHECKING:
    from sie.profiles.slope import Slope

Array = NDArray[np.float64]

GROWTH = 1e3  # of T_n at a place: up to there the recurrence loses three digits
PER_DEGREE = 2.8  # Gauss nodes that a pole farther away asks for
LEAST = 1e-300


@dataclass(frozen=True, eq=False)
class HalfSlope:
    """E*/2 h' of a profile, resolved on [lo, hi] by a function (`profiles.resolution.refined`)."""

    slope: Slope
    half_modulus: float
    window: tuple[float, float]
    resolve: Callable[[Slope, float, float, float], Slope]

    def __call__(self, x: Array) -> Array:
        values: Array = self.half_modulus * self.slope(x)
        return values

    @property
    def kinks(self) -> tuple[float, ...]:
        """Places in the window where h' is not smooth."""
        lo, hi = self.window
        return tuple(x for x in self.slope.break_points if lo < x < hi)

    @cached_property
    def _resolved(self) -> Slope:
        lo, hi = self.slope.domain
        return self.resolve(self.slope, max(self.window[0], lo), min(self.window[1], hi), EPS)

    def principal(self, contact: tuple[float, float], x: Array, left: Array, right: Array) -> Array:
        """1/π PV∫H/(t - x) dt over the contact at places of known distances from its edges."""
        slope, total = self._resolved, np.zeros(len(x))
        breaks = slope.breaks
        for k in np.flatnonzero((breaks[1:] > contact[0]) & (breaks[:-1] < contact[1])):
            if slope.is_zero[k]:
                continue
            lo, hi = max(breaks[k], contact[0]), min(breaks[k + 1], contact[1])
            to_lo = left if lo == contact[0] else x - lo
            to_hi = right if hi == contact[1] else hi - x
            total += self._of_panel(int(k), (lo, hi), to_lo, to_hi)
        return self.half_modulus / math.pi * total

    def _of_panel(self, k: int, ends: tuple[float, float], to_lo: Array, to_hi: Array) -> Array:
        lo, half = ends[0], 0.5 * (ends[1] - ends[0])
        degree = int(self._resolved.degrees[k])
        series = chebyshev.transform(self._on(k, lo, half * (1.0 + chebyshev.points(degree + 1))))
        s = 0.5 * (to_lo - to_hi) / half
        outside = np.maximum(np.abs(s), 1.0)
        near = max(degree, 1) * np.arccosh(outside) < math.log(GROWTH)
        out = np.empty(len(s))
        if near.any():
            out[near] = _recurred(series, s[near], to_lo[near], to_hi[near])
        if not near.all():
            part, _, weight = gauss_jacobi(math.ceil(PER_DEGREE * max(degree, 1)) + 4, 0.0, 0.0)
            mass = weight * self._on(k, lo, 2.0 * half * part)
            out[~near] = (1.0 / (part - 0.5 * (1.0 + s[~near, None]))) @ mass
        return out

    def _on(self, k: int, start: float, ahead: Array) -> Array:
        """h' on one panel."""
        at = np.array([start])
        values: Array = self._resolved.local(np.array([k]), at, np.zeros(1), ahead[None, :])
        return values[0]


def _recurred(series: Array, s: Array, to_lo: Array, to_hi: Array) -> Array:
    """Σ c_n ∫T_n(t)/(t - s) dt."""
    before = np.log(np.maximum(np.abs(to_hi), LEAST) / np.maximum(np.abs(to_lo), LEAST))
    total, now = series[0] * before, 2.0 + s * before
    for n in range(1, len(series)):
        total += series[n] * now
        constant = 4.0 / (1.0 - n * n) if n % 2 == 0 else 0.0
        before, now = now, 2.0 * s * now - before + constant
    return total
