"""The contact of dissimilar bodies under a symmetric convex profile, pressed with friction.

Zones, tractions, slip, gap and dissipated energy follow from P' and the half-width b
(`normal`).

β < 0 only turns the sign of the shear and of the slip.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.numerics.interval import Interval, interval_about
from sie.profiles.base import Profile
from sie.traction.base import on_line, zero_or_nan
from sie.traction.in_contact import InContact

from .dissipation import tables_of_pair, work_of_pair
from .flat import double_exponential
from .functions import FlatFunctions
from .growth import load_slope
from .half_potential import DISTANT, Panels
from .load_rate import GrowthPanel
from .panels import INNERMOST, graded, totals
from .profile import Kernel, Superposition
from .tables import interpolated
from .traction import CoupledTraction, joined_panels

Array = NDArray[np.float64]

FALLING = 1e-9  # of the largest P': below it a negative one is not rounding
ON_PANEL = 24
CLOSEST = 1e-17  # of r: as near a contact begins the sum over wider ones, not smooth there
FEW = 12  # marks: between more of them interpolation saves little
# half-widths: the first panel beside the edge, where H has a power of the distance
NEAR_EDGE = 1e-9
# half-widths: in wider strips beside a flat base rounding of y changes p by 1e-12 or less, as at
# distances from the edge whose square is BESIDE of a strip, where p falls with the square
NARROW, BESIDE = 1e-4, 1e-2
LIGHTER = 0.9  # of the growth beyond the flat base: what sticks then sticks already
PARTS: Array = np.linspace(0.0625, 0.9375, 8)  # of a slip zone, at which slip is tested


@dataclass(frozen=True, eq=False)
class CoupledContact:
    """The state under the load P, with y = |x - axis|.

    flat            functions of the flat punch; |β| and f
    growth          P' on panels, from the axis outwards
    corner_load     what an indenter whose end is a corner carries beyond ∫P'
    axis, ahead     the contact is axis ± b, b = a + ahead beyond the flat base
    load            P
    sign            of β
    half_modulus    E*/2
    kinks           y at which h' or h'' jumps, up to b
    """

    flat: FlatFunctions
    growth: tuple[GrowthPanel, ...]
    corner_load: float
    axis: float
    ahead: float
    load: float
    sign: float
    half_modulus: float
    kinks: tuple[float, ...] = field(default=())

    @cached_property
    def b(self) -> float:
        """Half the width of the contact."""
        return (self.growth[0].origin if self.growth else 0.0) + self.ahead

    @property
    def c(self) -> float:
        """Half the width of the stick zone."""
        return self.b if self.full_stick else self.flat.c * self.b

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        return ((self.axis - self.c, self.axis + self.c),)

    @property
    def slip_width(self) -> float:
        """The width of each zone of slip, to full relative accuracy."""
        return 0.0 if self.full_stick else self.flat.rest * self.b

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        if self.full_stick:
            return ()
        left = (self.axis - self.b, self.axis - self.c, -self.sign)
        return left, (self.axis + self.c, self.axis + self.b, self.sign)

    @cached_property
    def tractions(self) -> tuple[CoupledTraction, CoupledTraction]:
        """p and q with their potentials, which share their panels."""
        contact = interval_about(self.axis, self.b).rounded((self.axis,))

        @lru_cache(maxsize=1)
        def panels() -> tuple[Panels, ...]:
            return joined_panels(self.pressure_and_shear, self.marks, self.edge_power)

        return (
            CoupledTraction(
                self.pressure, lambda: panels()[0], 1.0, self.load, self.marks, contact
            ),
            CoupledTraction(self.shear, lambda: panels()[1], -1.0, 0.0, self.marks, contact),
        )

    @property
    def edge_power(self) -> float:
        """The exponent of the tractions at the edge."""
        return -self.flat.h if self.corner_load else 1.0 - self.flat.h

    @property
    def marks(self) -> tuple[float, ...]:
        """y where p or q is not smooth, up to b: kinks of the profile, and c times them."""
        places = (*self.kinks, self.b, self.flat_base)
        inside = {y for place in places for y in (place, self.flat.c * place) if 0.0 < y < self.b}
        return (*sorted(inside), self.b)

    @property
    def values(self) -> InContact:
        """The values of p and q, which far beside a flat base follow from distances alone."""
        beyond = (self.flat_base - self.b) + self.ahead if self.growth else 0.0
        contact = Interval(-self.b, self.b, -beyond, beyond)
        marks = (*(-y for y in reversed(self.marks)), 0.0, *self.marks)
        exact = self.narrow or self.corner_load > 0.0
        return InContact(contact, marks, self._both_halves, self.axis, exact)

    def _both_halves(self, x: Array, rest: Array) -> Array:
        """Rows of p and q at x from the axis, of which one half is computed."""
        y = np.abs(x)
        _, first, every = np.unique(
            np.where(rest < y, rest, -y), return_index=True, return_inverse=True
        )
        p, q = self.pressure_and_shear(np.minimum(y, self.b)[first], rest[first])[:, every]
        return np.stack((p, np.sign(x) * q))

    @property
    def kept(self) -> tuple[tuple[float, float], CoupledContact | None]:
        """What stuck under a lighter load, and the state under that; None under a flat punch."""
        if not self.growth:
            return self.stick[0], None
        ahead = self.ahead if self.corner_load else LIGHTER * self.ahead
        load, b = sum(panel.load(ahead) for panel in self.growth), self.flat_base + ahead
        kinks = tuple(k for k in self.kinks if k < b)
        before = replace(self, ahead=ahead, corner_load=0.0, load=load, kinks=kinks)
        return before.stick[0], before

    @property
    def kind(self) -> str:
        """The slip under a normal load alone, in words."""
        if self.full_stick:
            return "full stick, its zones narrower than 1e-15 of the contact; β couples p and q"
        way = "outwards" if self.sign > 0.0 else "inwards"
        return f"{way} on both sides while the normal load grew; β couples p and q"

    shift = strain_kept = 0.0

    @property
    def least_slip(self) -> float:
        """The least slip in its direction in a slip zone, over the largest."""
        if self.full_stick:
            return 0.0
        slip = self.sign * self.slip(self.c + (self.b - self.c) * PARTS)
        return float(slip.min() / np.abs(slip).max())

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x, same shape: 0 outside the contact."""

        def value(flat: Array) -> Array:
            y = np.abs(flat - self.axis)
            inside = y <= self.b
            g = np.zeros(flat.shape)
            g[inside] = np.sign(flat[inside] - self.axis) * self.slip(y[inside])
            return g

        return on_line(value, x)

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        lo, hi = profile.domain
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        y = np.abs(flat - self.axis)
        beside = (y > self.b) & np.isfinite(flat) & (out == 0.0)
        if beside.any():
            edge = self.axis + self.b * np.sign(flat[beside] - self.axis)
            rise = profile.height(flat[beside]) - profile.height(np.clip(edge, lo, hi))
            out[beside] = rise - self.raised(y[beside])
        return out.reshape(np.shape(x))

    @property
    def full_stick(self) -> bool:
        """Whether the slip zones are narrower than a part FULL_STICK of the contact."""
        return self.flat.punch.bonded

    @cached_property
    def superposition(self) -> Superposition:
        return Superposition(self.flat, self.growth)

    @property
    def narrow(self) -> bool:
        """Whether the strip beside a flat base is too narrow for its places to be known by y."""
        return bool(self.growth) and self.ahead < NARROW * self.flat_base

    @property
    def flat_base(self) -> float:
        """Half the width of the profile's flat base, or of the flat punch."""
        return self.growth[0].origin if self.growth else self.b

    def pressure(self, y: Array, rest: Array | None = None) -> Array:
        """p at 0 <= y <= b; rest is b - y where that is known better than from y."""
        p = self._of(self.superposition.pressure, y, rest)
        if not self.flat_base:
            p[y == 0.0] = self._pressure_on_axis
        return p + self._of_corner(self.flat.pressure, y, self.b, rest)

    def shear(self, y: Array, rest: Array | None = None) -> Array:
        """q on the right; odd in x."""
        q: Array = self.pressure_and_shear(y, rest)[1]
        return q

    def pressure_and_shear(self, y: Array, rest: Array | None = None) -> Array:
        """Rows of p and q."""
        deficit = self._of(self.superposition.shear_deficit, y, rest)
        deficit += self._of_corner(self.flat.shear_deficit, y, self.b, rest)
        p = self.pressure(y, rest)
        q = self.flat.friction * p
        inside = deficit != 0.0
        q[inside] -= deficit[inside]
        q[y == 0.0] = 0.0
        return np.stack((p, self.sign * q))

    def slip(self, y: Array) -> Array:
        """The slip since y came into contact, on the right; odd in x."""
        g = self._of(self.superposition.slip, y) + self._of_corner(self.flat.slip, y, 1.0)
        return self.sign / self.half_modulus * g

    def _of(self, function: Callable[..., Array], y: Array, rest: Array | None = None) -> Array:
        def direct(y: Array) -> Array:
            return function(y, np.full(len(y), self.ahead))

        values = np.zeros(len(y))
        inside = (y > 0.0) & (y <= self.b) if not self.flat_base else y <= self.b
        if rest is not None and self.narrow:
            near = rest < math.sqrt(BESIDE * self.flat_base * self.ahead)
            values[near] = function(
                y[near], np.full(near.sum(), self.ahead), self.ahead - rest[near]
            )
            inside &= ~near
        y = np.maximum(y, INNERMOST * self.b / self.flat.c)
        if not self.growth or len(self.marks) > FEW:
            values[inside] = direct(y[inside])
        else:
            # Smooth and even about the axis under a flat base
            first = -self.marks[0] if self.flat_base else 0.0
            power = max(1.0, *(panel.power for panel in self.growth))
            marks = np.array((first, *self.marks))
            values[inside] = interpolated(direct, marks, y[inside], power)
        return values

    def _of_corner(
        self,
        function: Callable[[Array, Array, Array], Array],
        y: Array,
        unit: float,
        rest: Array | None = None,
    ) -> Array:
        """A function of the flat punch of half-width b under the load of the corner."""
        if not self.corner_load:
            return np.zeros(len(y))
        t, c = y / self.b, self.flat.c
        e = (self.b - y if rest is None else rest) / self.b
        from_c = np.abs(self.flat.rest - e) if c > 0.5 else np.abs(t - c)
        return self.corner_load / unit * function(t, e, from_c)

    @cached_property
    def _pressure_on_axis(self) -> float:
        """p(0) = A(0) ∫P'/s ds without a flat base; inf under a wedge."""
        first, *others = self.growth
        A = float(self.flat.A(np.array([0.0]), np.array([1.0]))[0])
        start = float(first(np.array([0.0]))[0]) if not first.power else 0.0
        if abs(start) > FALLING * float(np.abs(first.series).max()):
            return math.inf
        hi = min(first.hi, self.ahead)
        s, weight = first.rule(hi, ON_PANEL, -1.0 if first.power else 0.0)
        total = float(weight @ (first(s) / s))
        for panel in others:
            if panel.lo < self.ahead:
                ahead, weight = panel.rule(min(panel.hi, self.ahead) - panel.lo, ON_PANEL)
                total += float(weight @ (panel(ahead) / (panel.lo + ahead)))
        return A * total

    # -- beside the contact ------------------------------------------------------------------------

    def hilbert_outside(self, y: Array) -> Array:
        """1/π PV∫p/(y - t) dt at y > b."""
        H = load_slope(self.flat, self.growth, self.ahead, y)
        if self.corner_load:
            H += self.corner_load * self.flat.outside(self.b / y, (y - self.b) / y) / y
        return H

    def raised(self, y: Array) -> Array:
        """2/E* times the integral of that from b to each y >= b.

        The surfaces part by so much less than the profile rises.
        """
        # Beyond, it is nothing beside the profile's rise
        ahead = np.minimum(y - self.b, DISTANT * self.b)
        none = np.full(len(y), np.inf)
        owner, places, _, weight = graded(
            ahead, np.full(len(y), NEAR_EDGE * self.b), none, near=0.0
        )
        H = self.hilbert_outside((self.b + places).ravel()).reshape(places.shape)
        return totals(owner, H * weight, len(y)) / self.half_modulus

    @cached_property
    def energy(self) -> float:
        """The dissipated energy: ∫ f p |dg| over both slip zones, while P grew."""
        flat, stack, corner = self.flat, self.superposition.stack, self.corner_load
        both = 0.5 * corner**2 * float(work_of_pair(flat, np.ones(1), np.zeros(1))[0])
        if self.growth:
            part, _, dx = double_exponential()
            inside = {mark - stack.origin for mark in self.marks}
            ends = {stack.lo[0], self.ahead, *(s for s in inside if 0.0 < s < self.ahead)}
            cuts = np.array(sorted(ends))
            lo, size = cuts[:-1, None], np.diff(cuts)[:, None]
            beyond, first = lo + size * part, np.searchsorted(stack.lo, lo, "right") - 1
            panel = np.maximum(np.searchsorted(stack.lo, beyond) - 1, first)
            # From the ends of intervals, where P' may be infinite, distances keep their digits
            from_lo = ((lo - stack.lo[panel]) + size * part).reshape(-1, 1)
            mass = stack(panel.ravel(), from_lo)[:, 0] * (size * dx).ravel()
            both += float(mass @ self._of_later_layers(beyond.ravel()))
        return 2.0 * flat.friction * both / self.half_modulus

    def _of_later_layers(self, beyond: Array) -> Array:
        """∫P' K ds over the wider contacts, for contacts of half-width origin + beyond."""
        flat, origin = self.flat, self.superposition.stack.origin
        edge, stick = tables_of_pair(flat)
        out, back = flat.beyond / flat.middle, flat.from_c_to_middle / (flat.c * flat.middle)
        kernels = (
            Kernel(lambda t, e, d: edge(t, e), flat.middle, 1.0, CLOSEST, back, out),
            Kernel(lambda t, e, d: stick(t, e), flat.c, flat.middle, out, span=back),
        )
        r, e = origin + beyond, (self.ahead - beyond) / self.b
        work = self.superposition._sum(kernels, r, np.full(len(r), self.ahead), over_s=False)
        if self.corner_load:
            slips = e < flat.rest
            work[slips] += self.corner_load * work_of_pair(flat, 1.0 - e[slips], e[slips])
        return work
