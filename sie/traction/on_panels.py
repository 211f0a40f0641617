"""The pressure whose slope H is given in pieces.

    p = E*/2 cos²(πε)/π V on the contact,        F = -E*/2 cos(πε)/π V elsewhere

with V of `potential`; ε = 0 unless dissimilar bodies slide. `PowerDensity` takes the pressure of an
upright power law from series of its own. In full sliding, `SlidingDensity`, q = f p acts back on
the pressure, and the exponents leave 1/2:

    1/π PV∫ p(t)/(x - t) dt + tan(πε) p(x) = E*/2 H(x),        tan πε = -β f

f with the sign of sliding. With w(x) = (x - x1)^(1/2+ε) (x2 - x)^(1/2-ε) the solution is

    p = E*/2 cos²(πε) (w/π PV∫ H/(w (t - x)) dt + tan(πε) H)

and V gives both terms at once. Singular ends add k1/2 ((x2-x)/(x-x1))^(1/2-ε) +
k2/2 ((x-x1)/(x2-x))^(1/2+ε).

References: Galin, Contact Problems (1961); Hills, Nowell & Sackfield (1993) § 2.5; Muskhelishvili
(1953) §§ 107-110 for the edges.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override
from sie.numerics import chebyshev, lerch
from sie.numerics.interval import Interval
from sie.profiles.power_law import Corner, PowerLaw, PowerSlope
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope

from . import potential
from .base import in_order
from .of_slope import SlopeDensity
from .panels import Panels
from .piece_quadrature import Geometry

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Powers below CUSP are steep on their axis; nearer to it than this fraction of the half-width,
# what else there is to the pressure is straight to rounding.
CUSP, BESIDE_CUSP = 2.0, 1e-9
STRAIGHT = 2.9  # powers from here on are straight so near to an axis


class OnPanels(SlopeDensity):
    """H piece by piece."""

    panels: Panels

    @property
    def _potential_scale(self) -> float:
        """F over V, where E*/2 = 1."""
        return -self.panels.edge.cos / math.pi

    @property
    @override
    def slope_scale(self) -> float:
        return self.panels.scale

    def _regular(self, x: Array) -> Array:
        if not self._cusps:
            return self._by_pieces(x)
        return self._joined(x, self._by_pieces, self._beside_cusp, np.empty(x.shape))

    def _by_pieces(self, x: Array) -> Array:
        return (self.panels.edge.cos**2 / math.pi) * potential.on_contact(self.panels, x)

    @cached_property
    def _cusps(self) -> dict[float, list[PowerLaw | Corner]]:
        """The powers and the corner at each axis of a power below CUSP, too steep for pieces."""
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
        """The ends of the pieces beside each axis, counted from it, and the pressure there.

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

    @override
    def resolved_slope(self, x: Array) -> Array:
        p, (lo, hi) = self.panels, self.panels.geometry.ends
        k = np.clip(np.searchsorted(hi, x), 0, len(hi) - 1)
        values: Array = chebyshev.evaluate(p.series.T[:, k], (x - lo[k]) / p.half_length[k] - 1.0)
        return values

    @property
    def _slope_at_edges(self) -> tuple[float, float]:
        p, g = self.panels, self.panels.geometry
        # A flat piece there was left out.
        left = float(p.series[0] @ (-1.0) ** np.arange(p.degree + 1)) if g.cut_left else 0.0
        return left, float(p.series[-1].sum()) if g.cut_right else 0.0

    def _beside(self, x: Array) -> tuple[Array, Array]:
        V, continued = potential.beside(self.panels, x)
        return (self.panels.edge.cos / math.pi) * V, continued

    def _corner(self, x: float) -> float:
        if x in self._cusps:
            jump = self.panels.geometry.slope.without_functions.corner(x)[0]
            return math.copysign(1.0, jump) if jump else 0.0
        at = (infinite for e, infinite in self.panels.jumps if e == x)
        return next((math.copysign(1.0, infinite) for infinite in at), 0.0)

    def _pair(self, z: Complex) -> tuple[Complex, Complex]:
        if not self._cusps:
            V, dV = potential.upper(self.panels, z)
            return self._potential_scale * V, self._potential_scale * dV
        out = np.empty((2, *z.shape), dtype=complex)
        F, dF = self._joined(z, self._pair_by_pieces, self._pair_beside_cusp, out)
        return F, dF

    def _pair_by_pieces(self, z: Complex) -> Complex:
        out: Complex = self._potential_scale * np.array(potential.upper(self.panels, z))
        return out

    def _far_pair(self, z: Complex) -> tuple[Complex, Complex]:
        V, dV = potential.far(self.panels, z, constant=False)
        return self._potential_scale * V, self._potential_scale * dV

    @property
    def _kinks(self) -> tuple[tuple[float, float], ...]:
        return self.panels.kinks

    @property
    def singular(self) -> tuple[float, ...]:
        """Breaks at which the slope of p is infinite.

        Among many pieces a kink is not distinguished from a break that resolves a function, but a
        jump is.
        """
        inner = self.panels.jumps if self.panels.many else self._kinks
        return (self.contact.x1, *sorted(e for e, _ in inner), self.contact.x2)

    @property
    @override
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

    @property
    @override
    def epsilon(self) -> float:
        return self.panels.edge.epsilon

    @override
    def moved(self, contact: Interval, dx: float, tail: float) -> Self:
        old = self.panels
        slope = old.geometry.slope.shifted(dx).shifted(tail)
        # A slope that ended with the contact still does: an ulp short of it, all of H would jump
        breaks = slope.breaks.copy()
        breaks[0], breaks[-1] = min(breaks[0], contact.x1), max(breaks[-1], contact.x2)
        panels = Panels(Geometry(replace(slope, breaks=breaks), contact), old.I0)
        return replace(self, contact=contact, panels=panels)


@dataclass(frozen=True, eq=False)
class PowerDensity(OnPanels):
    """A power law pressed upright: p in closed form (`power_law`), the potential by panels."""

    law: PowerLaw
    declared: Slope
    resolution: float
    resolves = False

    @cached_property
    def panels(self) -> Panels:  # type: ignore[override]
        """The panels of the declared pieces and their resolution on the contact."""
        pieces = refined(self.declared, self.contact.x1, self.contact.x2, self.resolution)
        return Panels(Geometry(pieces, self.contact))

    @property
    @override
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

    @override
    def moved(self, contact: Interval, dx: float, tail: float) -> Self:
        law = replace(self.law, axis=self.law.axis + dx + tail)
        declared = self.declared.shifted(dx).shifted(tail)
        return replace(self, contact=contact, law=law, declared=declared)


class SlidingDensity(PanelDensity):
    """The pressure in full sliding."""

    def _of_powers(self, laws: list[PowerLaw | Corner], y: Array, b: float) -> Array:
        """The same with H sin πε cos πε added: then 1/π PV∫p/(x - t) dt + p tan πε = H."""
        slope = np.sum([law.slope_at(y) for law in laws], axis=0)
        cos, sin = self.panels.edge.cos, math.sin(math.pi * self.epsilon)
        return cos * cos * super()._of_powers(laws, y, b) + sin * cos * slope

    def _potentials_of_powers(self, laws: list[PowerLaw | Corner], y: Complex, b: float) -> Complex:
        """The same: Re((1 + i tan πε) F) = H."""
        turn = self.panels.edge.cos * np.exp(-1j * np.pi * self.epsilon)
        out: Complex = turn * super()._potentials_of_powers(laws, y, b)
        return out

    def _singular_pair(self, z: Complex, far: bool) -> Complex:
        left, right, r = self.contact.from_left(z), -self.contact.from_right(z), self.contact.r
        at_left, half = 0.5 + self.epsilon, 0.5 / self.panels.edge.cos
        logarithm = lerch.log1p(2.0 * r / right) if far else np.log(left / right)
        power = np.expm1 if far else np.exp
        ends = self.k2 * power(at_left * logarithm) - self.k1 * power((at_left - 1.0) * logarithm)
        steep = self.k2 * at_left * np.exp(at_left * logarithm) - self.k1 * (
            at_left - 1.0
        ) * np.exp((at_left - 1.0) * logarithm)
        return np.array([half * ends, -2.0 * half * r * steep / (left * right)])

    def _hilbert_inside(self, x: Array) -> Array:
        # Where p is infinite so is this; only the slope's part is given there, as for similar
        # bodies
        p = self(x)
        return self.half_modulus * self._slope(x) - math.tan(math.pi * self.epsilon) * np.where(
            np.isfinite(p), p, 0.0
        )

    def _edge(self, ratio: Array, on_left: bool) -> Array:
        out: Array = ratio ** (0.5 - self.epsilon if on_left else 0.5 + self.epsilon)
        return out

    def _singular_outside(self, left: Any, right: Any) -> Any:
        ratio = left / right if np.iscomplexobj(left) else np.abs(left / right)
        return (0.5 / self.panels.edge.cos) * (
            self.k2 * ratio ** (0.5 + self.epsilon) - self.k1 * ratio ** (self.epsilon - 0.5)
        )
