"""The pressure whose slope is H: p solves 1/π PV∫ p/(x - t) dt = E*/2 H in the contact.

`SlopeDensity` is the common part of all such densities. Where H is smooth the Chebyshev series of
`TransformDensity` solves the equation; where it has breaks the pieces of `on_panels` do. Both take
the singular ends of a sharp-edged punch apart, so that a smooth edge stays smooth:

    k1/2 ((x2-x)/(x-x1))^(1/2-ε) + k2/2 ((x-x1)/(x2-x))^(1/2+ε)

with ε = 0 unless dissimilar bodies slide.

Muskhelishvili, Singular Integral Equations (1953), §§ 107-115; Hills, Nowell & Sackfield, Mechanics
of Elastic Contacts (1993), ch. 2.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.inheritance import override
from sie.numerics import chebyshev, lerch
from sie.numerics.interval import Interval

from .base import Density, in_order, on_surface, reflected, refuse_side, shallow, zero_or_nan

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# A Chebyshev series is continued beyond its interval only next to it, while it grows by less than
# this factor.
CONTINUATION = 4.0
# Beyond so many widths from the centre of a contact |ρ| is less than
# 1/(2 FAR_FIELD + sqrt(4 FAR_FIELD² - 1)) = 0.172.
FAR_FIELD = 1.5


@dataclass(frozen=True, eq=False)
class SlopeDensity(Density):
    """The density whose slope is H on `contact`, with `half_modulus` = E*/2.

    k1, k2 are the intensities of its singular ends (0: smooth), as stresses.
    """

    contact: Interval
    half_modulus: float
    k1: float
    k2: float
    resultant: float
    moment: float

    @property
    @override
    def interval(self) -> tuple[float, float]:
        return self.contact.x1, self.contact.x2

    @property
    def epsilon(self) -> float:
        """The edges' exponents are 1/2 ± epsilon."""
        return 0.0

    def moved(self, contact: Interval, dx: float, tail: float) -> Self:
        """The same on `contact`, its own moved by dx + tail, with the same data of the slope."""
        return replace(self, contact=contact)

    @property
    @abstractmethod
    def slope_scale(self) -> float:
        """The largest |H| in the contact, about."""

    # A form defines these on 1-d arrays, in units of E*/2 and without the singular ends.
    @abstractmethod
    def _regular(self, x: Array) -> Array:
        """p inside the contact, x ascending."""

    @abstractmethod
    def _beside(self, x: Array) -> tuple[Array, Array]:
        """(G, continued): 1/π∫p/(x-t) = continued - G for x beside the contact, all on one side.

        `continued` is H of the edge continued as a polynomial, or 0 where that is not safe; G
        vanishes at a smooth edge.
        """

    @abstractmethod
    def _pair(self, z: Complex) -> tuple[Complex, Complex]:
        """1/π∫p/(z-t) and its derivative for Im z > 0."""

    @abstractmethod
    def _far_pair(self, z: Complex) -> tuple[Complex, Complex]:
        """F and F' far from the contact.

        The constant that F tends to where an edge is singular is left out.
        """

    @abstractmethod
    def _slope(self, x: Array) -> Array:
        """H inside the contact."""

    def resolved_slope(self, x: Array) -> Array:
        """H inside the contact, x ascending, as the pressure uses it.

        For a function this is its resolution.
        """
        return self._slope(x)

    @property
    @abstractmethod
    def _slope_at_edges(self) -> tuple[float, float]:
        """H at both edges, which may lie between two doubles."""

    @property
    def _kinks(self) -> tuple[tuple[float, float], ...]:
        """(break, +inf or -inf) inside the contact where p' is infinite.

        It is -inf where p itself is infinite.
        """
        return ()

    @override
    def __call__(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        flat = x.ravel()
        left, right = self.contact.from_left(flat), self.contact.from_right(flat)
        inside = np.minimum(left, right) >= 0.0
        if inside.all():
            return self._inside(flat, left, right).reshape(x.shape)
        p: Array = zero_or_nan(flat)
        p[inside] = self._inside(flat[inside], left[inside], right[inside])
        return p.reshape(x.shape)

    def _inside(self, x: Array, left: Array, right: Array) -> Array:
        p = self.half_modulus * in_order(self._regular, x)
        if self.k1 or self.k2:
            a, b = self._exponents
            for k, near, far, power in ((self.k1, left, right, b), (self.k2, right, left, a)):
                edge = near == 0.0
                ratio = far / np.where(edge, 1.0, near)
                p += np.where(edge, np.inf if k else 0.0, 0.5 * k * _power(ratio, power))
        return p

    @property
    def _exponents(self) -> tuple[float, float]:
        """1/2 + ε and 1/2 - ε."""
        return 0.5 + self.epsilon, 0.5 - self.epsilon

    def gap_excess(self, x: Array) -> tuple[Array, Array]:
        """(G, continued) of `_beside` in true units (a slope), singular ends included.

        All x are on one side of the contact.
        """
        G, continued = in_order(self._beside, x)
        if self.k1 or self.k2:
            ratio = np.abs(self.contact.from_left(x) / self.contact.from_right(x))
            a, b = self._exponents
            ends = self.k2 * _power(ratio, a) - self.k1 / _power(ratio, b)
            G = G - 0.5 * ends / (math.cos(math.pi * self.epsilon) * self.half_modulus)
        return G, continued

    @override
    def hilbert(self, x: ArrayLike) -> Array:
        return self._on_line(self._hilbert, x)

    def _hilbert(self, flat: Array) -> Array:
        out = np.empty(flat.shape)
        left, right = self.contact.from_left(flat), self.contact.from_right(flat)
        inside = (left >= 0.0) & (right >= 0.0)
        out[inside] = self._hilbert_inside(flat[inside])
        for side in (left < 0.0, right < 0.0):
            if side.any():
                G, continued = self.gap_excess(flat[side])
                out[side] = self.half_modulus * (continued - G)
        if self.k1 or self.k2:
            far = np.abs(flat - self.contact.m) > FAR_FIELD * 2.0 * self.contact.r
            out[far] = self._far_in_upper(
                np.asarray(flat[far] + 1j * shallow(self.contact.r), dtype=np.complex128)
            )[0].real
        return out

    def _hilbert_inside(self, x: Array) -> Array:
        H = self.half_modulus * self._slope(x)
        if not self.epsilon:
            return H
        # Where p is infinite so is this; only the slope's part is given there, as for ε = 0
        p = self(x)
        return H - math.tan(math.pi * self.epsilon) * np.where(np.isfinite(p), p, 0.0)

    @override
    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        def on_line(x: Array) -> Complex:
            return on_surface(self._hilbert(x), self(x), side)

        F: Complex = self._in_plane(self._split(on_line, 0), z, side)
        return F

    @override
    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        def on_line(x: Array) -> Complex:
            return self._on_surface(x, side)

        dF: Complex = self._in_plane(self._split(on_line, 1), z, side, derivative=True)
        return dF

    def _split(self, on_line: Callable[[Array], Complex], which: int) -> Callable[..., Complex]:
        """The potential (0) or its derivative (1) at flat places, those on the line apart."""

        def values(flat: Complex) -> Complex:
            real = flat.imag == 0.0
            out = np.empty(flat.shape, dtype=complex)
            if real.any():
                out[real] = on_line(flat.real[real])
            off = ~real
            if off.any():
                out[off] = reflected(lambda upper: self._both_in_upper(upper)[which], flat[off])
            return out

        return values

    @override
    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        z = arguments.complexes("z", z)
        flat = z.ravel()
        if (flat.imag > 0.0).all() and (np.abs(flat) <= self.horizon).all():
            refuse_side(side)
            F, dF = self._both_in_upper(flat)
            return F.reshape(z.shape), dF.reshape(z.shape)
        return self.cauchy(z, side), self.cauchy_derivative(z, side)

    @property
    @override
    def singular(self) -> tuple[float, ...]:
        return self.interval

    @property
    @override
    def hilbert_at_edges(self) -> tuple[float, float]:
        left, right = self._slope_at_edges
        return self.half_modulus * left, self.half_modulus * right

    def _both_in_upper(self, z: Complex) -> tuple[Complex, Complex]:
        """(F, F') for Im z > 0 (1-d).

        Far from singular ends F and what these add tend to constants that cancel: both are left
        out.
        """
        if not (self.k1 or self.k2):
            F, dF = self._pair(z)
            return self.half_modulus * F, self.half_modulus * dF
        far = np.abs(z - self.contact.m) > FAR_FIELD * 2.0 * self.contact.r
        out = np.empty((2, *z.shape), dtype=complex)
        out[:, far] = self._far_in_upper(z[far])
        out[:, ~far] = self.half_modulus * np.array(self._pair(z[~far])) + self._singular_pair(
            z[~far], far=False
        )
        return out[0], out[1]

    def _far_in_upper(self, z: Complex) -> Complex:
        return self.half_modulus * np.array(self._far_pair(z)) + self._singular_pair(z, far=True)

    def _singular_pair(self, z: Complex, far: bool) -> Complex:
        """The part of the singular ends in F and F', (2, n).

        `far` leaves out the limit (k2 - k1)/2 of the first.
        """
        left, right, r = self.contact.from_left(z), -self.contact.from_right(z), self.contact.r
        (a, b), half = self._exponents, 0.5 / math.cos(math.pi * self.epsilon)
        up, down = _power(left / right, a), 1.0 / _power(left / right, b)
        ends = self.k2 * up - self.k1 * down
        if far:
            logarithm = lerch.log1p(2.0 * r / right)
            ends = self.k2 * np.expm1(a * logarithm) - self.k1 * np.expm1(-b * logarithm)
        steep = (r / left) * ((self.k2 * a * up + self.k1 * b * down) / right)
        return np.array([half * ends, -2.0 * half * steep])

    def _on_surface(self, x: Array, side: int) -> Complex:
        """F' at real x: from the body's side, just below the surface; infinite where p' is."""
        c = self.contact
        at_edge = ((x == c.x1) | (x == c.x2)) & (
            np.minimum(abs(c.from_left(x)), abs(c.from_right(x))) == 0.0
        )
        inside = np.where(at_edge, np.nextafter(x, c.m), x)
        dF = self._both_in_upper(inside + 1j * shallow(c.r))[1]
        left_edge, right_edge = at_edge & (x == c.x1), at_edge & (x == c.x2)
        dF.imag[left_edge] = np.inf if self.k1 else -np.inf
        dF.imag[right_edge] = -np.inf if self.k2 else np.inf
        for e, steep in self._kinks:
            dF.imag[x == e] = -steep
        outside = (c.from_left(x) < 0.0) | (c.from_right(x) < 0.0)
        dF.imag[outside] = 0.0
        dF.imag = side * dF.imag if side else 0.0
        return dF


def _power(ratio: Any, exponent: float) -> Any:
    """ratio^exponent; a root is faster."""
    return np.sqrt(ratio) if exponent == 0.5 else ratio**exponent


@dataclass(frozen=True, eq=False)
class TransformDensity(SlopeDensity):
    """Smooth H = Σ g_n T_n(s) on the contact: p = E*/2 sqrt(1-s²) Σ g_{n+1} U_n(s).

    One DCT gave g; nothing was solved.
    """

    series: Array

    @property
    @override
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

    @property
    def _slope_at_edges(self) -> tuple[float, float]:
        return float(self.series @ (-1.0) ** np.arange(len(self.series))), float(self.series.sum())

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
        G[~near] = -self._pair(x[~near])[0]
        return G, continued

    @cached_property
    def _reach(self) -> float:
        return float(chebyshev.reach(self.series[None, :], CONTINUATION)[0])

    def _pair(self, z: Complex) -> tuple[Complex, Complex]:
        F, dF = self._far_pair(z)
        return F + self.series[0], dF

    def _far_pair(self, z: Complex) -> tuple[Complex, Complex]:
        return outer_series(self.series, self.contact, z)


def outer_series(series: Array, contact: Interval, z: Any) -> tuple[Any, Any]:
    """Σ_{n>0} g_n ρ^n and its derivative, ρ = 1/(s + sqrt(s - 1) sqrt(s + 1)), off the contact.

    That is 1/π∫p/(z - t) dt of p = sqrt(1 - s²) Σ g_{n+1} U_n(s). The other form of ρ,
    s - sqrt(s² - 1), cancels. As dρ/dz = -ρ/R, the derivative is -Σ n g_n ρ^n / R.
    """
    left, right = contact.from_left(z), -contact.from_right(z)
    on_line, side = not np.iscomplexobj(z), 1.0
    if on_line:
        side = np.sign(left)
        left, right = np.abs(left), np.abs(right)
    root = side * (np.sqrt(left) * np.sqrt(right))
    rho = 2.0 * contact.r / (side * (left + right) + 2.0 * root)
    F, steep = np.zeros_like(rho), np.zeros_like(rho)
    for n in range(len(series) - 1, 0, -1):
        F += series[n]
        F *= rho
        steep += n * series[n]
        steep *= rho
    return F, -steep / root
