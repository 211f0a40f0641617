"""A traction on a contact: its value, resultant, moment and Cauchy integral.

    p(x)                                                       0 outside the contact, inf where it is infinite
    hilbert(x)    =  1/π PV∫ p(t)/(x - t) dt                   on the whole surface
    cauchy(z)     =  1/π ∫ p(t)/(z - t) dt                     the potential Fp of the half-plane; at x ± i0: hilbert ∓ i p (Plemelj)

A density is "the pressure whose slope is H": p solves 1/π PV∫ p/(x - t) dt = E*/2 H in the contact. Two forms know this in closed form,
`TransformDensity` by a Chebyshev series (smooth H) and `PanelDensity` by exact panels (H with breaks). Both carry the square-root
singular ends of a sharp-edged punch apart, as k1/2 sqrt((1-s)/(1+s)) + k2/2 sqrt((1+s)/(1-s)), so that a smooth edge stays smooth.

Muskhelishvili, Singular Integral Equations (1953), §§ 107-115; Hills, Nowell & Sackfield, Mechanics of Elastic Contacts (1993), ch. 2.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import chebyshev
from .interval import Interval
from .panels import Panels

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# A Chebyshev series is continued beyond its interval only next to it, while it grows by less than this factor.
CONTINUATION = 4.0


def in_order(function: Callable[[Array], Any], x: Array) -> Any:
    """function(x) for a function that wants x ascending and returns one array or several of its shape."""
    if x.size < 2 or (x[1:] >= x[:-1]).all():
        return function(x)
    order = np.argsort(x, kind="stable")
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    values = function(x[order])
    return tuple(v[back] for v in values) if isinstance(values, tuple) else values[back]


def refuse_side(side: int) -> None:
    if side not in (-1, 0, 1):
        raise ValueError(f"side = {side!r} is not -1, 0 or 1: +1 is the limit from the body (y > 0), -1 from the other side")


class Density(ABC):
    """A traction p(x) on the surface, in units of stress; x and z in units of length.

    Attributes: `interval` (the two edges), `resultant` = ∫p dx, `moment` = ∫p x dx about x = 0.
    """

    resultant: float
    moment: float

    @property
    @abstractmethod
    def interval(self) -> tuple[float, float]: ...
    @abstractmethod
    def __call__(self, x: ArrayLike) -> Array:
        """p(x), same shape as x."""

    @abstractmethod
    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        """F(z) = 1/π ∫ p(t)/(z - t) dt, same shape as z.

        `side` says where a real z inside the contact is approached from: +1 the body (y > 0), -1 the other half-plane, 0 the
        principal value. Elsewhere it has no effect.
        """

    @abstractmethod
    def hilbert(self, x: ArrayLike) -> Array:
        """1/π PV∫ p(t)/(x - t) dt at real x, same shape as x."""

    def strength(self, x: float) -> float:
        """Where the density is infinite: the factor of that infinity, 0 elsewhere. It adds up when densities of one profile do."""
        return 0.0


@dataclass(frozen=True)
class Zero(Density):
    """No traction."""

    resultant: float = 0.0
    moment: float = 0.0

    @property
    def interval(self) -> tuple[float, float]:
        return 0.0, 0.0

    def __call__(self, x: ArrayLike) -> Array:
        return np.zeros(np.shape(x))

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return np.zeros(np.shape(z), dtype=complex)

    def hilbert(self, x: ArrayLike) -> Array:
        return np.zeros(np.shape(x))


ZERO = Zero()

# How far beside a place where infinite terms cancel their finite sum is looked at: the difference of both sides is the square of this.
BESIDE = 1e-7
CANCELLED = 1e-9  # a sum of strengths below this fraction of their sizes is rounding


@dataclass(frozen=True, eq=False)
class Combination(Density):
    """Σ factor density, each zero outside its own interval; `resultant` and `moment` are theirs, summed.

    >>> Combination(((2.0, ZERO),)).resultant
    0.0
    """

    terms: tuple[tuple[float, Density], ...]

    @cached_property
    def resultant(self) -> float:  # type: ignore[override]
        return sum(factor * density.resultant for factor, density in self.terms)

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        return sum(factor * density.moment for factor, density in self.terms)

    @property
    def interval(self) -> tuple[float, float]:
        ends = [density.interval for _, density in self.terms]
        return min(lo for lo, _ in ends), max(hi for _, hi in ends)

    def __call__(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        with np.errstate(invalid="ignore"):  # infinities that cancel are looked at below
            total = np.zeros(flat.shape)
            for factor, density in self.terms:
                total += factor * density(flat)
        for k in np.flatnonzero(~np.isfinite(total)):
            total[k] = self._at_infinity(float(flat[k]))
        return total.reshape(x.shape)

    def _at_infinity(self, x: float) -> float:
        """The sum where terms are infinite: finite where their strengths cancel."""
        total, size = self.strength(x), sum(abs(factor * density.strength(x)) for factor, density in self.terms)
        if abs(total) > CANCELLED * size:
            return math.copysign(math.inf, total)
        lo, hi = self.interval
        step = BESIDE * (hi - lo)
        sides = np.array([y for y in (x - step, x + step) if lo < y < hi])
        return float(np.mean(self(sides)))

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        total = np.zeros(np.shape(z), dtype=complex)
        for factor, density in self.terms:
            total = total + factor * density.cauchy(z, side)
        return total

    def hilbert(self, x: ArrayLike) -> Array:
        total = np.zeros(np.shape(x))
        for factor, density in self.terms:
            total = total + factor * density.hilbert(x)
        return total

    def strength(self, x: float) -> float:
        return sum(factor * density.strength(x) for factor, density in self.terms)


@dataclass(frozen=True, eq=False)
class Scaled(Density):
    """factor times a density: the shear traction of full sliding is f times the pressure."""

    density: Density
    factor: float

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return self.factor * self.density.resultant

    @property
    def moment(self) -> float:  # type: ignore[override]
        return self.factor * self.density.moment

    @property
    def interval(self) -> tuple[float, float]:
        return self.density.interval

    def __call__(self, x: ArrayLike) -> Array:
        return self.factor * self.density(x)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self.factor * self.density.cauchy(z, side)

    def hilbert(self, x: ArrayLike) -> Array:
        return self.factor * self.density.hilbert(x)


@dataclass(frozen=True, eq=False)
class SlopeDensity(Density):
    """The density that answers the slope H on `contact`; `half_modulus` = E*/2; k1, k2 its singular ends (0: smooth), as stresses."""

    contact: Interval
    half_modulus: float
    k1: float
    k2: float
    resultant: float
    moment: float

    @property
    def interval(self) -> tuple[float, float]:
        return self.contact.x1, self.contact.x2

    @property
    def epsilon(self) -> float:
        """The edges' exponents are 1/2 ± epsilon."""
        return 0.0

    @property
    @abstractmethod
    def slope_scale(self) -> float:
        """The largest |H| in the contact, about."""

    def strength(self, x: float) -> float:
        """k1, k2 at a sharp edge; ±1 under a corner of the profile, whose strength no load changes."""
        for edge, k in zip(self.interval, (self.k1, self.k2), strict=True):
            if x == edge and k:
                return k
        return self._corner(x)

    def _corner(self, x: float) -> float:
        return 0.0

    # What a form must know, on 1-d arrays, in units of E*/2 and without the singular ends.
    @abstractmethod
    def _regular(self, x: Array) -> Array:
        """p inside the contact, x ascending."""

    @abstractmethod
    def _beside(self, x: Array) -> tuple[Array, Array]:
        """(G, continued): 1/π∫p/(x-t) = continued - G for x beside the contact, all on one side.

        `continued` is H of the edge continued as a polynomial, or 0 where that is not safe; G vanishes at a smooth edge.
        """

    @abstractmethod
    def _off_axis(self, z: Complex) -> Complex:
        """1/π∫p/(z-t) for Im z > 0."""

    @abstractmethod
    def _slope(self, x: Array) -> Array:
        """H inside the contact."""

    def __call__(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        left, right = self.contact.from_left(flat), self.contact.from_right(flat)
        inside = np.minimum(left, right) >= 0.0
        if inside.all():
            return self._inside(flat, left, right).reshape(x.shape)
        p = np.zeros(flat.shape)
        p[inside] = self._inside(flat[inside], left[inside], right[inside])
        return p.reshape(x.shape)

    def _inside(self, x: Array, left: Array, right: Array) -> Array:
        p = self.half_modulus * in_order(self._regular, x)
        if self.k1 or self.k2:
            for k, near, far in ((self.k1, left, right), (self.k2, right, left)):
                edge = near == 0.0
                ratio = far / np.where(edge, 1.0, near)
                p += np.where(edge, np.inf if k else 0.0, 0.5 * k * self._edge(ratio, on_left=near is left))
        return p

    def _edge(self, ratio: Array, on_left: bool) -> Array:
        """How a singular end goes with the ratio of the distances from the other end and from it."""
        return np.sqrt(ratio)

    def _singular_outside(self, left: Any, right: Any) -> Any:
        """k2/2 sqrt((s+1)/(s-1)) - k1/2 sqrt((s-1)/(s+1)), from z - x1 and z - x2 (complex: Im > 0; real: beside the contact)."""
        root = np.sqrt(left) / np.sqrt(right) if np.iscomplexobj(left) else np.sqrt(np.abs(left / right))
        return 0.5 * (self.k2 * root - self.k1 / root)

    def gap_excess(self, x: Array) -> tuple[Array, Array]:
        """(G, continued) of `_beside` in true units (a slope), singular ends included, for x on one side of the contact."""
        G, continued = in_order(self._beside, x)
        if self.k1 or self.k2:
            G = G - self._singular_outside(self.contact.from_left(x), -self.contact.from_right(x)) / self.half_modulus
        return G, continued

    def hilbert(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        out = np.empty(flat.shape)
        left, right = self.contact.from_left(flat), self.contact.from_right(flat)
        inside = (left >= 0.0) & (right >= 0.0)
        out[inside] = self._hilbert_inside(flat[inside])
        for side in (left < 0.0, right < 0.0):
            if side.any():
                G, continued = self.gap_excess(flat[side])
                out[side] = self.half_modulus * (continued - G)
        return out.reshape(x.shape)

    def _hilbert_inside(self, x: Array) -> Array:
        return self.half_modulus * self._slope(x)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        refuse_side(side)
        z = np.asarray(z, dtype=complex)
        flat = z.ravel()
        F = np.empty(flat.shape, dtype=complex)
        real = flat.imag == 0.0
        if real.any():
            x = flat.real[real]
            F[real] = self.hilbert(x) - 1j * side * self(x) if side else self.hilbert(x)
        off = ~real
        if off.any():
            lower = flat.imag[off] < 0.0
            upper = np.where(lower, flat[off].conj(), flat[off])
            values = self.half_modulus * self._off_axis(upper)
            if self.k1 or self.k2:
                values += self._singular_outside(self.contact.from_left(upper), -self.contact.from_right(upper))
            F[off] = np.where(lower, values.conj(), values)
        return F.reshape(z.shape)


@dataclass(frozen=True, eq=False)
class TransformDensity(SlopeDensity):
    """Smooth H = Σ g_n T_n(s) on the contact: p = E*/2 sqrt(1-s²) Σ g_{n+1} U_n(s). One DCT gave g; nothing was solved."""

    series: Array

    @property
    def slope_scale(self) -> float:
        return float(np.abs(self.series).max())

    def _regular(self, x: Array) -> Array:
        left, right = self.contact.from_left(x), self.contact.from_right(x)
        root = np.sqrt(left) * np.sqrt(right) / self.contact.r
        if len(self.series) == 2:
            return root * self.series[1]
        r = 2.0 * self.contact.r
        p: Array = root * chebyshev.evaluate_second_kind(self.series[1:], (left - right) / r)
        return p

    def _slope(self, x: Array) -> Array:
        H: Array = chebyshev.evaluate(self.series, self.contact.s(x))
        return H

    def _beside(self, x: Array) -> tuple[Array, Array]:
        left, right = self.contact.from_left(x), self.contact.from_right(x)
        s = (left - right) / (2.0 * self.contact.r)
        root = np.sqrt(np.abs(left)) * np.sqrt(np.abs(right)) / self.contact.r
        rho = np.sign(s) / (np.abs(s) + root)
        near = np.abs(rho) * self._reach >= 1.0
        # T_n(s) - ρ^n = ± sqrt(s²-1) U_{n-1}(s)
        G = np.where(near, root * np.sign(s), 0.0)
        G[near] *= chebyshev.evaluate_second_kind(self.series[1:], s[near])
        continued = np.zeros_like(s)
        continued[near] = chebyshev.evaluate(self.series, s[near])
        G[~near] = -self._powers(rho[~near]).real
        return G, continued

    @cached_property
    def _reach(self) -> float:
        return float(chebyshev.reach(self.series[None, :], CONTINUATION)[0])

    def _off_axis(self, z: Complex) -> Complex:
        left, right = self.contact.from_left(z), -self.contact.from_right(z)
        # ρ = 1/(s + sqrt(s-1) sqrt(s+1)): the other form, s - sqrt(...), cancels
        return self._powers(2.0 * self.contact.r / (left + right + 2.0 * np.sqrt(left) * np.sqrt(right)))

    def _powers(self, rho: Any) -> Any:
        """Σ_{n>=0} g_n ρ^n by Horner; g_0 belongs to the singular ends, whose part of F tends to -g_0 far away."""
        total = np.zeros_like(rho)
        for g in self.series[:0:-1]:
            total = (total + g) * rho
        return total + self.series[0]


@dataclass(frozen=True, eq=False)
class PanelDensity(SlopeDensity):
    """H piece by piece: p = E*/(2π) V on the contact, F = -E*/(2π) V elsewhere (`panels`)."""

    panels: Panels

    @property
    def slope_scale(self) -> float:
        return self.panels.scale

    def _regular(self, x: Array) -> Array:
        return self.panels.on_contact(x) / np.pi

    def _slope(self, x: Array) -> Array:
        return self.panels.geometry.slope(x)

    def _beside(self, x: Array) -> tuple[Array, Array]:
        V, continued = self.panels.beside(x)
        return V / np.pi, continued

    def _off_axis(self, z: Complex) -> Complex:
        return self.panels.off_axis(z) / -np.pi

    def _corner(self, x: float) -> float:
        return next((math.copysign(1.0, infinite) for e, infinite in self.panels.jumps if e == x), 0.0)
