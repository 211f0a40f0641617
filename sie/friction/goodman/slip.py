"""Partial slip of dissimilar bodies as Goodman approximated it: β q is left out of equation (1).

The pressure is that without friction, under a profile that is symmetric about an axis: the stick
zone then grows with the contact. While the normal load grows the shear follows by superposition
(`shear`), at both ends in slip outwards, q = ± f p. Under Q at constant P it
changes by Δq, which leaves the slip gradient in stick as it is: HΔq = 0 on the stick zone, and
beside it Δq = d, what the shear lacks of f p (for Q > 0)

    d = f p - q.

d vanishes where the bodies slip in that direction already, and is 2 f p where they slipped
against it. So Δq is the shear of Cattaneo and Mindlin with d in place of f p, on the contact up to
the slip zone that remains, and the stick zone has their two equations (`slip_zones`).

Goodman (1962), J. Appl. Mech. 29, 515; docs/derivations/goodman.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.contact.edges import Search
from sie.errors import ContactError
from sie.friction.coupled.axis import symmetry_axis
from sie.friction.coupled.half_potential import Panels
from sie.friction.coupled.pressed import PARTS
from sie.friction.coupled.traction import resolved_panels
from sie.friction.coupled.two_sided import TwoSidedTraction
from sie.friction.slip_state import Slip, Step
from sie.friction.slip_zones import Drive, SlipZones, edge_frame, slip_zones
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import EPS, Interval
from sie.problem.load_limit import refuse_corner, refuse_sliding, remaining
from sie.traction.in_contact import InContact

from .frame import NEAREST, DeficitFrame
from .functions import GoodmanFlat, goodman_flat
from .growth import ContactTable
from .shear import GoodmanGrowth

Array = NDArray[np.float64]

ENERGY_NODES = 24
LIGHTER = 0.8  # of the load: under it the zone that sticks is examined again
SMALL = 1e-12  # of the half-width: marks nearer to each other are one
FIRST_ZONE = 0.25  # of the half-width: where the search for the zones under Q begins
KIND = "outwards on both sides while the normal load grew, β q neglected (Goodman)"
KIND_UNDER_Q = "outwards under P, then along Q, β q neglected (Goodman)"


@dataclass(frozen=True, eq=False)
class GoodmanSlip(Slip):
    """The state after the normal load, and Q at constant P.

    step     the contact and its loads
    flat     functions of the flat punch
    table    the contacts that it grew through
    zones    the zones under Q, None before
    """

    step: Step
    flat: GoodmanFlat
    table: ContactTable
    zones: SlipZones | None = field(default=None)

    @property
    def kind(self) -> str:  # type: ignore[override]
        return KIND if self.zones is None else KIND_UNDER_Q

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self.step.pressure.contact

    @property
    def friction(self) -> float:  # type: ignore[override]
        return self.step.scene.friction

    @property
    def sign(self) -> float:
        return math.copysign(1.0, self.step.scene.beta)

    @property
    def along(self) -> float:
        """The side towards which Q slips, for β > 0."""
        return math.copysign(1.0, self.sign * self.step.Q)

    @property
    def axis(self) -> float:
        return self.table.axis

    @cached_property
    def growth(self) -> GoodmanGrowth:
        return GoodmanGrowth(self.flat, self.table)

    @cached_property
    def normal_stick(self) -> tuple[float, float]:
        """The stick zone before Q."""
        c = self.flat.k * self.contact.r
        return self.axis - c, self.axis + c

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        if self.zones is None:
            return (self.normal_stick,)
        return ((self.zones.stick.x1, self.zones.stick.x2),)

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        ((c1, c2),), (x1, x2) = self.stick, self.step.pressure.interval
        left = -self.sign if self.zones is None else self.sign * self.along
        right = self.sign if self.zones is None else self.sign * self.along
        zones = (x1, c1, left), (c2, x2, right)
        return tuple(zone for zone in zones if zone[1] > zone[0])

    slip_zones = slipped

    @cached_property
    def lighter(self) -> GoodmanSlip | None:
        """The state under LIGHTER of the load, where that is another contact."""
        if not self.table.panels:
            return None
        step = self.step
        found = step.contact_under(LIGHTER * step.normal_load, step.normal.edges.tilt)
        before = replace(step, normal=found, pressure=step.pressure_on(found), Q=0.0)
        return GoodmanSlip(before, self.flat, contact_table(before, self.table.search, self.axis))

    @property
    def values(self) -> InContact:
        both = self.step.pressure, self.traction
        return InContact(self.contact, self.marks, lambda x, _: np.stack([f(x) for f in both]))

    @property
    def kept(self) -> tuple[tuple[float, float], GoodmanSlip | None]:
        """What sticks under Q, and the state before; or what stuck under a lighter load too."""
        (lo, hi), light = self.stick[0], self.lighter
        if self.zones is not None:
            return (lo, hi), replace(self, step=replace(self.step, Q=0.0), zones=None)
        c1, c2 = light.stick[0] if light is not None else self.normal_stick
        return (max(lo, c1), min(hi, c2)), light

    strain_kept = 0.0

    @property
    def least_slip(self) -> float:
        """The least slip in its direction in a slip zone before Q, over the largest."""
        if self.zones is not None or not self.slipped:
            return 0.0
        slip = [sign * self.slip(lo + (hi - lo) * PARTS) for lo, hi, sign in self.slipped]
        return float(np.min(slip) / np.abs(slip).max())

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places where q is not smooth, with the edges."""
        (x1, x2), m, k = self.step.pressure.interval, self.axis, self.flat.k
        distances = {part * r for r in self.table.ends for part in (k, 1.0)}
        places = {*self.stick[0], *self.normal_stick, *(m - d for d in distances)}
        places |= {m + d for d in distances}
        if not self.table.start:
            places.add(m)
        apart, marks = SMALL * self.contact.r, [x1]
        for x in sorted(places):
            if marks[-1] + apart < x < x2 - apart:
                marks.append(x)
        return *marks, x2

    # -- tractions ---------------------------------------------------------------------------------

    @cached_property
    def shear(self) -> TwoSidedTraction:
        contact = self.contact
        return TwoSidedTraction(
            self.traction, self._halves, self.axis, self.step.Q, self.marks, contact
        )

    def _halves(self) -> tuple[Panels, Panels]:
        """Series of q on both sides of the centre."""
        (x1, x2), contact = self.step.pressure.interval, self.contact
        power = -0.5 if any(self.step.normal.edges.sharp) else 0.5

        def half(side: float) -> Panels:
            inner = [0.0]
            for y in sorted(side * (x - self.axis) for x in self.marks):
                if inner[-1] + SMALL * contact.r < y < (1.0 - SMALL) * contact.r:
                    inner.append(y)

            def row(y: Array, _: Array) -> Array:
                return self.traction(np.clip(self.axis + side * y, x1, x2))[None]

            return resolved_panels(row, (*inner[1:], contact.r), power)[0]

        right = half(1.0)
        return right, right._replace(series=-right.series) if self.zones is None else half(-1.0)

    def normal_shear(self, x: Array) -> Array:
        """q before Q, for β > 0, at x on the contact."""
        y = np.abs(x - self.axis)
        q = self.friction * self.step.pressure(x)
        stuck = y <= 0.5 * (self.normal_stick[1] - self.normal_stick[0])
        q[stuck] = self.growth.shear(y[stuck])
        if self.table.corner_load:
            q[stuck] += self._of_corner(y[stuck])
        odd: Array = np.sign(x - self.axis) * q
        odd[y == 0.0] = 0.0
        return odd

    def _of_corner(self, y: Array) -> Array:
        """The shear of a flat punch as wide as the contact under the load of its corners."""
        t, flat = y / self.contact.r, self.flat
        square = (1.0 - t) * (1.0 + t)
        ratio = flat.ratio(t / flat.k, np.maximum(flat.k - t, 0.0) / flat.k, square)
        scale = flat.friction * self.table.corner_load / (math.pi * self.contact.r)
        q: Array = scale * ratio / np.sqrt(square)
        return q

    def traction(self, x: Array) -> Array:
        """q at any x (1-d)."""
        x1, x2 = self.step.pressure.interval
        q = np.zeros(x.shape)
        inside = (x >= x1) & (x <= x2)
        at = x[inside]
        if self.zones is None:
            q[inside] = self.normal_shear(at)
        else:
            lo, hi = self.stick[0]
            values = self.along * self.friction * self.step.pressure(at)
            stuck = (at > lo) & (at < hi)
            more = self.friction * self.along * self.zones.shear(at[stuck])
            values[stuck] = self.normal_shear(at[stuck]) + more
            q[inside] = values
        return self.sign * q + 0.0

    # -- Q at constant P ---------------------------------------------------------------------------

    def deficit(self, distance: Array, frame: DeficitFrame) -> Array:
        """d at distances inwards from the end of a frame."""
        (x1, x2), (c1, c2) = self.step.pressure.interval, self.normal_stick
        if frame.edge is None:
            x = (c2 if frame.side > 0.0 else c1) - frame.side * distance
            f_p = self.friction * self.step.pressure(x)
        else:
            x = (x2 if frame.side > 0.0 else x1) - frame.side * distance
            f_p = self.friction * frame.edge.pressure(distance)
        q = self.along * self._tabulated_shear(np.clip(x, x1, x2))
        q[~np.isfinite(q)] = 0.0
        against = (x <= c1) if self.along > 0.0 else (x >= c2)
        d: Array = np.where(against, 2.0 * f_p, f_p - q)
        # A place next to a corner may be rounded to it
        return np.maximum(np.where(np.isfinite(d), d, 0.0), 0.0)

    def _tabulated_shear(self, x: Array) -> Array:
        """`normal_shear` from its series: the zones are sought in many steps."""
        y = x - self.axis
        right, left = self.shear.halves
        return self.sign * np.where(y < 0.0, left.traction(np.abs(y)), right.traction(np.abs(y)))

    @property
    def frames(self) -> tuple[tuple[DeficitFrame, DeficitFrame], Interval]:
        """Both ends of the zones that Q may slip, and the interval between."""
        (x1, x2), (c1, c2) = self.step.pressure.interval, self.normal_stick
        ahead, behind = (c2, x1) if self.along > 0.0 else (c1, x2)
        inner = [x for x in self.marks if x1 < x < x2]
        frames = []
        for side in (-1.0, 1.0):
            continues = side == self.along
            end = ahead if continues else behind
            distances = sorted(side * (end - x) for x in inner)
            rest = self.flat.modulus.rest * self.contact.r
            edge = None if continues else edge_frame(self.step.pressure, self.step.slope, side)
            breaks = tuple(d for d in distances if d > SMALL * self.contact.r)
            frames.append(
                DeficitFrame(self.deficit, self.friction, side, rest, breaks, edge, self._narrow)
            )
        interval = Interval(x1, c2) if self.along > 0.0 else Interval(c1, x2)
        return (frames[0], frames[1]), interval

    @property
    def _narrow(self) -> float:
        """A part of the contact that is shorter than the stick zone: as of a wedge, 1 - Q/(f P)."""
        P = self.step.normal_load
        left = remaining(self.friction, P, self.step.Q) / P
        return 0.5 * max(left, EPS)

    def under_tangential_load(self) -> GoodmanSlip:
        """The state after Q."""
        frames, interval = self.frames
        drive = Drive(abs(self.step.Q) / self.friction, 0.0, 1.0, 1.0)
        part = abs(self.step.Q) / (self.friction * self.step.normal_load)
        length = FIRST_ZONE * part * interval.r
        found = slip_zones(frames, interval, drive, (length, length))
        left, right = (
            replace(frame, nearest=NEAREST).zone(zone.length)
            for frame, zone in zip(frames, (found.left, found.right), strict=True)
        )
        return replace(self, zones=replace(found, left=left, right=right))

    # -- slip --------------------------------------------------------------------------------------

    def slip(self, x: Array) -> Array:
        self._refuse_slip()
        x1, x2 = self.step.pressure.interval
        g, inside = np.zeros(x.shape), (x >= x1) & (x <= x2)
        y = np.abs(x[inside] - self.axis)
        values = self.growth.slip(y)
        if self.table.corner_load:
            t = y / self.contact.r
            values = values + self.table.corner_load * self.flat.slip(t, 1.0 - t)
        g[inside] = np.sign(x[inside] - self.axis) * values
        return np.asarray(self.sign / self.table.search.half_modulus * g)

    def _refuse_slip(self) -> None:
        if self.zones is not None:
            raise ContactError(
                f"the slip under tangential_load = {self.step.Q:g} is not computed in Goodman's "
                "approximation: zones, pressure, shear and stresses are; set tangential_load = 0 "
                "for the slip under the normal load"
            )

    @property
    def shift(self) -> float:
        self._refuse_slip()
        return 0.0

    @cached_property
    def energy(self) -> float:
        """The dissipated energy, ∫ f p |dg| over both slip zones while P grew."""
        self._refuse_slip()
        x, _, w = gauss_jacobi(ENERGY_NODES, 0.0, 0.0)
        total = 0.0
        for panel in self.table.panels:
            ahead = panel.length * x * x
            lost = self.growth.dissipation(panel.lo + ahead)
            total += 4.0 * panel.length * float((w * x * panel.load_rate(ahead)) @ lost)
        if self.table.corner_load:
            b, P = self.contact.r, self.table.corner_load
            total += 2.0 * P * float(self.growth.dissipation(np.array([b]))[0])
            t, e, dt = self.flat.slip_places
            own = dt / (math.pi * np.sqrt(e * (1.0 + t))) @ self.flat.slip(t, e)
            total += self.friction * P * P * float(own)
        return total / self.table.search.half_modulus


def goodman_slip(step: Step, search: Search) -> GoodmanSlip:
    """The state of a scene's contact after P and Q; ContactError where it is not solved.

    `search` finds contacts of the same slope up to this one.
    """
    scene, edges = step.scene, step.normal.edges
    if step.Q:
        refuse_sliding(scene.friction, step.normal_load, step.Q)
        refuse_corner(edges.sharp, step.Q)
    upright = replace(scene, profile=scene.profile.tilted(edges.tilt), tilt=0.0, moment=None)
    axis = symmetry_axis(upright, edges)
    if axis is None:
        raise _not_symmetric(step.Q)
    flat = goodman_flat(abs(scene.beta), scene.friction)
    state = GoodmanSlip(step, flat, contact_table(step, search, axis))
    _ = state.table.panels  # which refuse a contact that does not grow steadily
    return state.under_tangential_load() if step.Q else state


def contact_table(step: Step, search: Search, axis: float) -> ContactTable:
    """The contacts up to that of a step."""
    law = step.scene.profile.power_law if step.normal.edges.tilt == 0.0 else None
    return ContactTable(search, axis, step.normal.edges, step.slope.breaks, law)


def _not_symmetric(Q: float) -> ContactError:
    coupled = "" if Q else "leave coupling out, or "
    return ContactError(
        "coupling = 'goodman' on a contact that is not symmetric: its stick zone may recede as the "
        f"load grows, which Goodman's approximation does not follow; {coupled}give dundurs = 0 to "
        "neglect β"
    )
