"""The pressure whose slope is H: p solves 1/π PV∫ p/(x - t) dt = E*/2 H in the contact.

Two forms know this in closed form, `TransformDensity` by a Chebyshev series (smooth H) and `PanelDensity` by exact panels (H with breaks).
Both carry the square-root singular ends of a sharp-edged punch apart, as k1/2 sqrt((1-s)/(1+s)) + k2/2 sqrt((1+s)/(1-s)), so that a
smooth edge stays smooth. `PowerDensity` has the pressure of a power law by series of its own.

Muskhelishvili, Singular Integral Equations (1953), §§ 107-115; Hills, Nowell & Sackfield, Mechanics of Elastic Contacts (1993), ch. 2.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.profiles.power_law import Corner, PowerLaw, PowerSlope
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope

from .base import Density, in_order, on_surface, reflected, refuse_side, shallow, zero_or_nan
from .panels import FAR_FIELD, Panels
from .piece_quadrature import Geometry
from .potential import Plane, outer_series

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# A Chebyshev series is continued beyond its interval only next to it, while it grows by less than this factor.
CONTINUATION = 4.0
# Powers below CUSP are steep on their axis; nearer to it than this fraction of the half-width,
# what else there is to the pressure is straight to rounding.
CUSP, BESIDE_CUSP = 2.0, 1e-9
STRAIGHT = 2.9  # powers from here on are straight so near to an axis


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
    def _pair(self, z: Complex) -> tuple[Complex, Complex]:
        """1/π∫p/(z-t) and its derivative for Im z > 0."""

    @abstractmethod
    def _far_pair(self, z: Complex) -> tuple[Complex, Complex]:
        """The same far from the contact, without the constant that the first tends to where an edge is singular."""

    @abstractmethod
    def _slope(self, x: Array) -> Array:
        """H inside the contact."""

    resolves = True  # whether a slope that is a function is known by its values at some points only

    def resolved_slope(self, x: Array) -> Array:
        """H inside the contact, x ascending, as the pressure knows it: of a function its resolution."""
        return self._slope(x)

    @property
    @abstractmethod
    def _slope_at_edges(self) -> tuple[float, float]:
        """H at both edges, which may lie between two doubles."""

    @property
    def _kinks(self) -> tuple[tuple[float, float], ...]:
        """(break, +inf or -inf) inside the contact where p' is infinite; -inf where p itself is infinite."""
        return ()

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
            for k, near, far in ((self.k1, left, right), (self.k2, right, left)):
                edge = near == 0.0
                ratio = far / np.where(edge, 1.0, near)
                p += np.where(
                    edge, np.inf if k else 0.0, 0.5 * k * self._edge(ratio, on_left=near is left)
                )
        return p

    def _edge(self, ratio: Array, on_left: bool) -> Array:
        """How a singular end goes with the ratio of the distances from the other end and from it."""
        return np.sqrt(ratio)

    def _singular_outside(self, left: Any, right: Any) -> Any:
        """k2/2 sqrt((s+1)/(s-1)) - k1/2 sqrt((s-1)/(s+1)), from z - x1 and z - x2 (complex: Im > 0; real: beside the contact)."""
        root = (
            np.sqrt(left) / np.sqrt(right)
            if np.iscomplexobj(left)
            else np.sqrt(np.abs(left / right))
        )
        return 0.5 * (self.k2 * root - self.k1 / root)

    def gap_excess(self, x: Array) -> tuple[Array, Array]:
        """(G, continued) of `_beside` in true units (a slope), singular ends included, for x on one side of the contact."""
        G, continued = in_order(self._beside, x)
        if self.k1 or self.k2:
            G = (
                G
                - self._singular_outside(self.contact.from_left(x), -self.contact.from_right(x))
                / self.half_modulus
            )
        return G, continued

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
        return self.half_modulus * self._slope(x)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        def potential(flat: Complex) -> Complex:
            real = flat.imag == 0.0
            F = np.empty(flat.shape, dtype=complex)
            if real.any():
                x = flat.real[real]
                F[real] = on_surface(self._hilbert(x), self(x), side)
            off = ~real
            if off.any():
                F[off] = reflected(self._in_upper, flat[off])
            return F

        F: Complex = self._in_plane(potential, z, side)
        return F

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        def derivative(flat: Complex) -> Complex:
            real = flat.imag == 0.0
            dF = np.empty(flat.shape, dtype=complex)
            if real.any():
                dF[real] = self._on_surface(flat.real[real], side)
            off = ~real
            if off.any():
                dF[off] = reflected(lambda upper: self._both_in_upper(upper)[1], flat[off])
            return dF

        dF: Complex = self._in_plane(derivative, z, side, derivative=True)
        return dF

    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        z = arguments.complexes("z", z)
        flat = z.ravel()
        if (flat.imag > 0.0).all() and (np.abs(flat) <= self.horizon).all():
            refuse_side(side)
            F, dF = self._both_in_upper(flat)
            return F.reshape(z.shape), dF.reshape(z.shape)
        return self.cauchy(z, side), self.cauchy_derivative(z, side)

    @property
    def singular(self) -> tuple[float, ...]:
        return self.interval

    @property
    def hilbert_at_edges(self) -> tuple[float, float]:
        left, right = self._slope_at_edges
        return self.half_modulus * left, self.half_modulus * right

    def _in_upper(self, z: Complex) -> Complex:
        if self.k1 or self.k2:
            return self._both_in_upper(z)[0]
        return self.half_modulus * self._off_axis(z)

    def _both_in_upper(self, z: Complex) -> tuple[Complex, Complex]:
        """(F, F') for Im z > 0 (1-d). Far from singular ends F and what these add tend to constants that cancel: both are left out."""
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
        """What the singular ends add to F and F', (2, n); `far` without the limit (k2 - k1)/2 of the first."""
        left, right, r = self.contact.from_left(z), -self.contact.from_right(z), self.contact.r
        root1, root2 = np.sqrt(left), np.sqrt(right)
        root, inverse = root1 / root2, root2 / root1
        sum_of_roots = root1 + root2
        ends = (
            (self.k2 / root2 + self.k1 / root1)
            * (r / sum_of_roots)  # root - 1 = 2r / (root2 (root1 + root2))
            if far
            else 0.5 * (self.k2 * root - self.k1 * inverse)
        )
        return np.array([ends, -0.5 * (r / left) * ((self.k2 * root + self.k1 * inverse) / right)])

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
        G[~near] = -self._powers(rho[~near]).real
        return G, continued

    @cached_property
    def _reach(self) -> float:
        return float(chebyshev.reach(self.series[None, :], CONTINUATION)[0])

    def _off_axis(self, z: Complex) -> Complex:
        left, right = self.contact.from_left(z), -self.contact.from_right(z)
        # ρ = 1/(s + sqrt(s-1) sqrt(s+1)): the other form, s - sqrt(...), cancels
        return self._powers(
            2.0 * self.contact.r / (left + right + 2.0 * np.sqrt(left) * np.sqrt(right))
        )

    def _pair(self, z: Complex) -> tuple[Complex, Complex]:
        F, dF = self._far_pair(z)
        return F + self.series[0], dF

    def _far_pair(self, z: Complex) -> tuple[Complex, Complex]:
        return outer_series(self.series, self.contact, z)

    def _powers(self, rho: Any) -> Any:
        """Σ_{n>=0} g_n ρ^n by Horner; g_0 belongs to the singular ends, whose part of F tends to -g_0 far away."""
        total = np.zeros_like(rho)
        for g in self.series[:0:-1]:
            total = (total + g) * rho
        return total + self.series[0]


class OnPanels(SlopeDensity):
    """H piece by piece: p = E*/(2π) V on the contact, F = -E*/(2π) V elsewhere (`panels`)."""

    panels: Panels
    _potential_scale = -1.0 / np.pi  # F over V, where E*/2 = 1

    @property
    def slope_scale(self) -> float:
        return self.panels.scale

    def _regular(self, x: Array) -> Array:
        if not self._cusps:
            return self._by_pieces(x)
        return self._joined(x, self._by_pieces, self._beside_cusp, np.empty(x.shape))

    def _by_pieces(self, x: Array) -> Array:
        return self.panels.on_contact(x) / np.pi

    @cached_property
    def _cusps(self) -> dict[float, list[PowerLaw | Corner]]:
        """Of each axis of a power below CUSP, too steep there for pieces: all that is not straight."""
        slope, (lo, hi) = self.panels.geometry.slope, self.interval
        cusps: dict[float, list[PowerLaw | Corner]] = {}
        for term in slope.functions:
            f = term.function
            if isinstance(f, PowerSlope) and 1.0 < f.exponent < STRAIGHT and lo < term.shift < hi:
                law = PowerLaw(f.exponent, f.coefficient, term.shift)
                cusps.setdefault(term.shift, []).append(law)
        for axis, laws in list(cusps.items()):
            if min(law.exponent for law in laws if isinstance(law, PowerLaw)) >= CUSP:
                del cusps[axis]
                continue
            corner = Corner(*slope.without_functions.corner(axis))
            if corner.jump or corner.bend:
                laws.append(corner)
        return cusps

    def _joined(self, place: Any, by_pieces: Any, beside_cusp: Any, out: Any) -> Any:
        """`out`, with values of the pieces and, next to an axis, of its powers; none of both."""
        left = np.ones(place.shape, dtype=bool)
        for axis, laws in self._cusps.items():
            b = float(min(self.contact.from_left(axis), self.contact.from_right(axis)))
            at = np.abs(place - axis) < BESIDE_CUSP * b
            if at.any():
                out[..., at] = beside_cusp(place[at], axis, b, laws)
                left &= ~at
        if left.any():
            out[..., left] = by_pieces(place[left])
        return out

    def _beside_cusp(self, x: Array, axis: float, b: float, laws: list[PowerLaw | Corner]) -> Array:
        """The pressure next to an axis: that of the powers alone, and a straight line."""
        beside, total = self._at_cusp_ends[axis]  # of the rounded ends
        left, right = (total - self._of_powers(laws, beside, b)).tolist()
        y = x - axis
        along = (y - beside[0]) / np.ptp(beside)
        return self._of_powers(laws, y, b) + left + (right - left) * along

    @cached_property
    def _at_cusp_ends(self) -> dict[float, tuple[Array, Array]]:
        """Where the pieces end beside each axis, counted from it, and the pressure there.

        Asked at once for all.
        """
        axes = np.array(list(self._cusps))[:, None]
        b = np.minimum(self.contact.from_left(axes), self.contact.from_right(axes))
        ends = axes + BESIDE_CUSP * b * [-1.0, 1.0]
        p = in_order(self._by_pieces, ends.ravel()).reshape(ends.shape)
        return dict(zip(self._cusps, zip(ends - axes, p, strict=True), strict=True))

    def _pair_beside_cusp(
        self, z: Complex, axis: float, b: float, laws: list[PowerLaw | Corner]
    ) -> Complex:
        """The same of the potential and its derivative, (2, n), at Im z > 0."""
        y, start = z - axis, np.array([1j * BESIDE_CUSP * b])
        rest, steep = self._pair_by_pieces(np.asarray(axis + start)) - self._potentials_of_powers(
            laws, start, b
        )
        out = self._potentials_of_powers(laws, y, b)
        out[0] += rest + steep * (y - start)
        out[1] += steep
        return out

    def _of_powers(self, laws: list[PowerLaw | Corner], y: Array, b: float) -> Array:
        """The pressure of the powers alone at y from their axis, in a contact of half-width b."""
        return np.sum([law.pressure(y, b - np.abs(y), b) for law in laws], axis=0)

    def _potentials_of_powers(self, laws: list[PowerLaw | Corner], y: Complex, b: float) -> Complex:
        """(F, F') of the same, (2, n)."""
        return np.sum([law.potentials_near_axis(y, b) for law in laws], axis=0)

    def _slope(self, x: Array) -> Array:
        return self.panels.geometry.slope(x)

    def resolved_slope(self, x: Array) -> Array:
        p, (lo, hi) = self.panels, self.panels.geometry.ends
        k = np.clip(np.searchsorted(hi, x), 0, len(hi) - 1)
        values: Array = chebyshev.evaluate(p.series.T[:, k], (x - lo[k]) / p.half_length[k] - 1.0)
        return values

    @property
    def _slope_at_edges(self) -> tuple[float, float]:
        p, g = self.panels, self.panels.geometry
        left = (
            float(p.series[0] @ (-1.0) ** np.arange(p.degree + 1)) if g.cut_left else 0.0
        )  # a flat piece there was left out
        return left, float(p.series[-1].sum()) if g.cut_right else 0.0

    def _beside(self, x: Array) -> tuple[Array, Array]:
        V, continued = self.panels.beside(x)
        return V / np.pi, continued

    def _off_axis(self, z: Complex) -> Complex:
        if not self._cusps:
            return self._off_axis_by_pieces(z)
        values: Complex = self._joined(
            z,
            self._off_axis_by_pieces,
            lambda *at: self._pair_beside_cusp(*at)[0],
            np.empty_like(z),
        )
        return values

    def _off_axis_by_pieces(self, z: Complex) -> Complex:
        F: Complex = self._potential_scale * self.panels.off_axis(z)
        return F

    def _corner(self, x: float) -> float:
        if x in self._cusps:
            jump = self.panels.geometry.slope.without_functions.corner(x)[0]
            return math.copysign(1.0, jump) if jump else 0.0
        at = (infinite for e, infinite in self.panels.jumps if e == x)
        return next((math.copysign(1.0, infinite) for infinite in at), 0.0)

    @cached_property
    def _plane(self) -> Plane:
        return Plane(self.panels)

    def _pair(self, z: Complex) -> tuple[Complex, Complex]:
        if not self._cusps:
            V, dV = self._plane(z)
            return self._potential_scale * V, self._potential_scale * dV
        out = np.empty((2, *z.shape), dtype=complex)
        F, dF = self._joined(z, self._pair_by_pieces, self._pair_beside_cusp, out)
        return F, dF

    def _pair_by_pieces(self, z: Complex) -> Complex:
        out: Complex = self._potential_scale * np.array(self._plane(z))
        return out

    def _far_pair(self, z: Complex) -> tuple[Complex, Complex]:
        V, dV = self._plane.far(z, constant=False)
        return self._potential_scale * V, self._potential_scale * dV

    @property
    def _kinks(self) -> tuple[tuple[float, float], ...]:
        return self._plane.kinks

    @property
    def singular(self) -> tuple[float, ...]:
        """Among many pieces a kink is not told from what resolves a function, but a jump is."""
        inner = self.panels.jumps if self.panels.many else self._kinks
        return (self.contact.x1, *sorted(e for e, _ in inner), self.contact.x2)

    @property
    def breaks(self) -> tuple[float, ...]:
        inner = {
            e
            for e in self.panels.geometry.ends.ravel().tolist()
            if self.contact.x1 < e < self.contact.x2
        }
        return (self.contact.x1, *sorted(inner), self.contact.x2)


@dataclass(frozen=True, eq=False)
class PanelDensity(OnPanels):
    """The same with its panels given."""

    panels: Panels


@dataclass(frozen=True, eq=False)
class PowerDensity(OnPanels):
    """A power law pressed upright: p in closed form (`power_law`), the potential by panels."""

    law: PowerLaw
    declared: Slope
    resolution: float
    resolves = False

    @cached_property
    def panels(self) -> Panels:  # type: ignore[override]
        pieces = refined(self.declared, self.contact.x1, self.contact.x2, self.resolution)
        return Panels(Geometry(pieces, self.contact))

    @property
    def slope_scale(self) -> float:
        return self.law.slope(self.contact.r)

    def _regular(self, x: Array) -> Array:
        near = np.minimum(self.contact.from_left(x), self.contact.from_right(x))
        J = self.law.superposed(x - self.law.axis, near, self.contact.r)
        mean = self.resultant / (np.pi * self.contact.r) / self.half_modulus
        return (self.law.exponent * mean) * J

    def _slope(self, x: Array) -> Array:
        return self.declared(x)

    @property
    def _slope_at_edges(self) -> tuple[float, float]:
        return -self.slope_scale, self.slope_scale

    def moved(self, contact: Interval, dx: float, tail: float) -> PowerDensity:
        """The same with its contact, and what it knows of the slope, moved by dx + tail."""
        law = replace(self.law, axis=self.law.axis + dx + tail)
        declared = self.declared.shifted(dx).shifted(tail)
        return replace(self, contact=contact, law=law, declared=declared)
