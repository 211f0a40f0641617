"""Upright symmetric profiles with a closed form: T(r), r(T) and p(x; r)/G.

Those of a rounded flat (Steuerman 1939; Ciavarella, Hills & Monno 1998, eqs 32 and 35) are written
as sums of positive terms, in τ = sqrt((b - a)/(b + a)) and t = sqrt((b - |x|)/(b + |x|)), with

    A(y) = (1 + y²) atan(y)/y - 1,      B(y) = 1 - (1 - y²) artanh(y)/y

which are ~ 2y²/3: T = b²/R 2τ/(1 + τ²) (A(τ) + 2τ²/(1 + τ²)), and p/G is 4b/(πR) τ/(1 + τ²)
t/(1 + t²) times 2A(τ) + B(τt) + B(τ/t) on the flat; beside it the last term is 2 - B(t/τ).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.contact.normal import normal_contact
from sie.contact.pressure import pressure as pressure_on
from sie.inheritance import override
from sie.numerics.interval import EPS
from sie.problem.scene import Scene
from sie.profiles.shapes import Power

from .families import Array, Contact, Family

TOL = 1e-13
MOST_STEPS, CLOSE = 40, 1e-8  # of Newton's method; what is left is the square of the last step
SHORT, TERMS = 0.25, 12  # up to this argument a series of so many terms is right to rounding


@dataclass(frozen=True)
class Closed(Family):
    """T(r), r(T) and p(x; r)/G of a symmetric profile by formulas of its parameters."""

    formulas: tuple[Callable[..., Array], Callable[..., Array], Callable[..., Array]]
    parameters: tuple[Array, ...]
    centred: Callable[..., Array] | None = None  # where a tilt moves it; None if it may not tilt

    @override
    def takes(self, tilt: Array, of_width: bool) -> NDArray[np.bool_]:
        return tilt == 0.0 if self.centred is None else np.ones(tilt.shape, dtype=bool)

    @override
    def contact(self, size: Array, tilt: Array, of_width: bool) -> Contact:
        load, width, _ = self.formulas
        r = size if of_width else width(size, *self.parameters)
        T = load(size, *self.parameters) if of_width else size
        m = 0.0 * r if self.centred is None else self.centred(tilt, *self.parameters)
        return Contact(m, r, T, 0.0 * r)

    @override
    def pressure(self, contact: Contact, tilt: Array, x: Array) -> Array:
        columns = (v[:, None] for v in (contact.r, contact.T, *self.parameters))
        return self.formulas[2](x, *columns)

    @override
    def part(self, which: Any) -> Closed:
        return Closed(self.formulas, tuple(v[which] for v in self.parameters), self.centred)


def _root(x: Array, r: Array) -> Array:
    return np.sqrt(np.maximum((r - x) * (r + x), 0.0))


HERTZ = (
    lambda r, R: 0.5 * math.pi * r * r / R,
    lambda T, R: np.sqrt(2.0 * T * R / math.pi),
    lambda x, r, T, R: _root(x, r) / R,
)
PUNCH = (
    lambda r, a: np.full_like(r, np.nan),
    lambda T, a: a + 0.0 * T,
    lambda x, r, T, a: T / (math.pi * _root(x, r)),
)
TIP = (
    lambda r, s: 2.0 * s * r,
    lambda T, s: 0.5 * T / s,
    lambda x, r, T, s: 2.0 * s / math.pi * np.arccosh(np.maximum(r / np.abs(x), 1.0)),
)


def _series(y: Array, sign: float) -> Array:
    """Σ (sign y²)^n 2/((2n - 1)(2n + 1)), n >= 1."""
    t, total = sign * y * y, np.zeros_like(y)
    for n in range(TERMS, 0, -1):
        total = t * (2.0 / (4.0 * n * n - 1.0) + total)
    return total


def _A(y: Array) -> Array:
    """(1 + y²) atan(y)/y - 1, without cancellation."""
    y = np.maximum(y, EPS * EPS)
    return np.where(
        y < SHORT, -_series(np.minimum(y, SHORT), -1.0), (1.0 + y * y) * np.arctan(y) / y - 1.0
    )


def _B(y: Array) -> Array:
    """1 - (1 - y²) artanh(y)/y, 0 <= y <= 1, without cancellation."""
    out = 1.0 - (1.0 - y * y) * np.arctanh(np.clip(y, SHORT, 1.0 - 0.5 * EPS)) / np.maximum(
        y, SHORT
    )
    short = y < SHORT
    if short.any():
        out[short] = _series(y[short], 1.0)
    return out


def _punch_load(d: Array, a: Array, R: Array) -> Array:
    """T of the rim d = b - a: b²/R 2τ/(1 + τ²) (A(τ) + 2τ²/(1 + τ²)), τ² = d/(2a + d)."""
    t, b = d / (2.0 * a + d), a + d
    root, share = np.sqrt(t), t / (1.0 + t)
    return b * b / R * 2.0 * root / (1.0 + t) * (_A(root) + 2.0 * share)


def punch_width(T: Array, a: Array, R: Array) -> Array:
    """b: Newton's method in ln(b - a), from where the limits of a small and a large rim join."""
    length = np.sqrt(2.0 * T * R)
    d = length / (math.sqrt(math.pi) + 2.0 * (a / length) ** (1.0 / 3.0))
    for _ in range(MOST_STEPS):
        found = _punch_load(d, a, R)
        rises = 4.0 * (a + d) / R * np.arctan(np.sqrt(d / (2.0 * a + d)))
        step = np.log(T / found) * found / (d * rises)
        d = d * np.exp(step)
        if np.abs(step).max(initial=0.0) < CLOSE:
            break
    return a + d


def _punch_pressure(x: Array, b: Array, T: Array, a: Array, R: Array) -> Array:
    """The pressure of Steuerman, as a sum of positive terms."""
    rim = np.sqrt((b - a) / (b + a))
    y = np.abs(x)
    t = np.sqrt(np.maximum(b - y, 0.0) / (b + y))
    inside = y <= a
    low, high = np.where(inside, rim, t), np.where(inside, t, rim)
    end = _B(low / np.maximum(high, EPS * EPS))
    end = np.where(inside, end, 2.0 - end)
    # doubles hold b to rounding, and b - a to less: the load makes up for it
    factor = 4.0 * b / (math.pi * R) * rim / (1.0 + rim * rim) * (T / _punch_load(b - a, a, R))
    return factor * t / (1.0 + t * t) * (2.0 * _A(rim) + _B(rim * t) + end)


ROUNDED = (lambda b, a, R: _punch_load(b - a, a, R), punch_width, _punch_pressure)


def power(m: float) -> tuple[Callable[..., Array], Callable[..., Array], Callable[..., Array]]:
    """The formulas of |x|^m times a coefficient: all contacts of it are alike."""
    scene = Scene(profile=Power(m, 1.0), modulus=2.0, half_width=1.0)
    normal = normal_contact(scene, TOL)
    factor, unit = normal.edges.normal_load, pressure_on(normal, scene, TOL)
    return (
        lambda r, A: factor * A * r**m,
        lambda T, A: (T / (factor * A)) ** (1.0 / m),
        lambda x, r, T, A: T / (factor * r) * unit(np.clip(x / r, -1.0, 1.0)),
    )
