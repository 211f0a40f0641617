"""The pressure whose slope H is given in pieces.

    p = E*/2 cos²(πε)/π V on the contact,        F = -E*/2 cos(πε)/π V elsewhere

with V of `potential`; ε = 0 unless dissimilar bodies slide. In full sliding q = f p
acts back on the pressure, and the exponents leave 1/2:

    1/π PV∫ p(t)/(x - t) dt + tan(πε) p(x) = E*/2 H(x),        tan πε = -β f

f with the sign of sliding. With w(x) = (x - x1)^(1/2+ε) (x2 - x)^(1/2-ε) the solution is

    p = E*/2 cos²(πε) (w/π PV∫ H/(w (t - x)) dt + tan(πε) H)

and V gives both terms at once. The singular ends are in `of_slope`.

References: Galin, Contact Problems (1961); Hills, Nowell & Sackfield (1993) § 2.5; Muskhelishvili
(1953) §§ 107-110 for the edges.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override
from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.profiles.functions import PowerLaw

from . import potential
from .of_slope import SlopeDensity
from .panels import Panels
from .piece_quadrature import Geometry

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# On the axis of a power below CUSP the pieces of its slope, which approach it, miss the pressure;
# at this fraction of the half-width beside it what else there is to the pressure is straight.
CUSP, BESIDE_CUSP = 2.0, 1e-9
STRAIGHT = 2.9  # powers from here on are straight so near to an axis


@dataclass(frozen=True, eq=False)
class PanelDensity(SlopeDensity):
    """H piece by piece."""

    panels: Panels

    @property
    @override
    def epsilon(self) -> float:
        return self.panels.edge.epsilon

    @property
    def _potential_scale(self) -> float:
        """F over V, where E*/2 = 1."""
        return -self.panels.edge.cos / math.pi

    @property
    @override
    def slope_scale(self) -> float:
        return self.panels.scale

    def _regular(self, x: Array) -> Array:
        p = self._by_pieces(x)
        for axis in self._steep:
            p[x == axis] = self._on_axes[axis]
        return p

    def _by_pieces(self, x: Array) -> Array:
        return (self.panels.edge.cos**2 / math.pi) * potential.on_contact(self.panels, x)

    @cached_property
    def _steep(self) -> dict[float, list[PowerLaw]]:
        """The powers about each axis of one below CUSP, without a corner: p is finite there."""
        slope, (lo, hi) = self.panels.geometry.slope, self.interval
        steep: dict[float, list[PowerLaw]] = {}
        for term in slope.functions:
            f, axis = term.function, term.shift
            if isinstance(f, PowerLaw) and 1.0 < f.exponent < STRAIGHT and lo < axis < hi:
                steep.setdefault(axis, []).append(f)
        return {
            axis: laws
            for axis, laws in steep.items()
            if min(law.exponent for law in laws) < CUSP
            and not slope.without_functions.corner(axis)[0]
        }

    @cached_property
    def _on_axes(self) -> dict[float, float]:
        """p on each axis: the mean of both sides, and what the powers alone rise by."""
        found = {}
        for axis, laws in self._steep.items():
            b = float(min(self.contact.from_left(axis), self.contact.from_right(axis)))
            y = BESIDE_CUSP * b
            beside = self._by_pieces(axis + y * np.array([-1.0, 1.0])).mean()
            rise = sum(law.cusp(y) for law in laws)
            found[axis] = float(beside + self.panels.edge.cos**2 * rise)
        return found

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

    def _pair(self, z: Complex) -> tuple[Complex, Complex]:
        V, dV = potential.upper(self.panels, z)
        return self._potential_scale * V, self._potential_scale * dV

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

    @override
    def moved(self, contact: Interval, dx: float, tail: float) -> Self:
        old = self.panels
        slope = old.geometry.slope.shifted(dx).shifted(tail)
        # A slope that ended with the contact still does: an ulp short of it, all of H would jump
        breaks = slope.breaks.copy()
        breaks[0], breaks[-1] = min(breaks[0], contact.x1), max(breaks[-1], contact.x2)
        panels = Panels(Geometry(replace(slope, breaks=breaks), contact), old.I0)
        return replace(self, contact=contact, panels=panels)
