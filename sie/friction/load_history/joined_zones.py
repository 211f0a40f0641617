"""A short part of a step in which a second zone of slip opens, and joins the first one.

Let the left end u of the stick zone recede with slip s while the right edge b grows and sticks
(`growing_edge`). As loads return in phase to what they were, a zone between u and where slip ended
before comes to slip nearly at once: a second zone of slip opens at its far end, and soon it has
joined the first one. The state after that is as in `receding_step`, up to what b brought into
contact meanwhile. There dq = κ dt/sqrt(b - x), so that

    q = k sqrt(b - x),

and k is known because strain is bounded where the edge was: of the two equations of `slip_zones`
that of the right end gives k, and the other one u. κ is in proportion to (A - π B ρ)/sqrt(ρ), and
changes as u leaps. Where it changes in proportion to time, q is that times

    1 - 2/3 (1 - κ0/κ1) (b - x)/l,

κ0 and κ1 before and after, l the length of the new contact. The error is by how much that moves u,
and the force of the change of q.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_zones import Drive, SlipZone, SlipZones, excess, slip_zone
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import false_position

from .frozen_edge import FrozenEdge
from .growing_contact import Course
from .marched_step import Held, places
from .receding_step import Receded, Side
from .slip_onset import Onset
from .sticking_zone import StickingZone

Array = NDArray[np.float64]

NO_END = "no end of the stick zone beyond the second zone of slip balances the loads"
PARTS = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.2, 0.4, 0.6, 0.8)  # of what may slip
SEEN = 33  # places between the old end and the new one at which it is seen which way they slip
SAME = 1e-9  # of a length: marks that are nearer are the old end
TURNED = 1e-6  # of the largest slip: what may seem to turn, which is rounding


@dataclass(frozen=True)
class NewContact:
    """What an edge brings into contact, with sqrt(d) [1 - 2/3 bend d/length] at distances d."""

    length: float
    bend: float = 0.0

    @property
    def breaks(self) -> Array:
        return np.zeros(0)

    def pressure(self, distance: Array) -> Array:
        q: Array = np.sqrt(distance) * (1.0 - self.bend / 1.5 * distance / self.length)
        return q

    @cached_property
    def zone(self) -> SlipZone:
        return slip_zone(self, self.length)


@dataclass(frozen=True, eq=False)
class Joined(Receded):
    """The state after two zones of slip have joined while an edge grew and stuck.

    factor    q over sqrt(b - x) where that edge brought points into contact
    """

    factor: float = 0.0

    @property
    def _grown(self) -> int:
        """0 if the left edge grew, 1 if the right one did."""
        return 1 if self.signs[0] else 0

    @property
    def then(self) -> Onset:
        """What goes on after its end."""
        return Onset(self.signs, (self.signs[0] != 0.0, self.signs[1] != 0.0))

    @property
    def stick(self) -> Interval:
        """The stick zone, with what came into contact."""
        known, contact = self.found.stick, self.pressure.contact
        return Interval(known.x1, contact.x2) if self._grown else Interval(contact.x1, known.x2)

    @property
    def kept(self) -> tuple[float, float]:
        return self.found.stick.x1, self.found.stick.x2

    def in_stick(self, x: Array) -> Array:
        known, contact = self.found.stick, self.pressure.contact
        came = x >= known.x2 if self._grown else x <= known.x1
        q = np.empty(x.shape)
        q[~came] = super().in_stick(x[~came])
        room = contact.x2 - x[came] if self._grown else x[came] - contact.x1
        q[came] = self.factor * np.sqrt(room)
        return q

    @property
    def _beside(self) -> tuple[Side, ...]:
        return (super()._beside[1 - self._grown],)

    @cached_property
    def work(self) -> float:
        """∫f p |Δg| dx at the mean pressure, as the part is short."""
        assert self.change is not None
        rates, contact = self.change.rates, self.pressure.contact
        strain = float(rates.strain(np.array(contact.m), np.array(contact.r)))
        part = 0.5 * (self.share - self.begun)
        return self.integrals.work - part * self.integrals.work_of(rates.P, strain)

    def slip_since(self, share: float, x: Array) -> Array:
        """The slip at places (1-d) that come into contact meanwhile, in proportion to time."""
        left = min(max((self.share - share) / (self.share - self.begun), 0.0), 1.0)
        slip: Array = left * self.slip(x)
        return slip

    @property
    def slips_on(self) -> bool:
        """Whether slip between the old end of the stick zone and the new one has its sign."""
        old, new = (zone[1 - self._grown] for zone in (self.before.stick, self.stick))
        x = np.linspace(old, new, SEEN)[1:-1]
        slip = (self.signs[0] or self.signs[1]) * self.slip(x)
        return bool(slip.min() >= -TURNED * slip.max())


@dataclass(frozen=True, eq=False)
class _Joining:
    """The equation of the length of the zone that slips.

    near     0 if it is the left one, 1 if it is the right one
    outer    the old contact and the new one
    frame    the edge at which it begins
    drive    the changes of the loads
    grown    what the other edge brought into contact
    """

    near: int
    outer: Interval
    frame: FrozenEdge
    drive: Drive
    grown: NewContact

    def zones(self, length: float) -> tuple[SlipZone, SlipZone]:
        """The zone that slips, and the new contact with its shear."""
        slips, unit = self.frame.zone(length), self.grown.zone
        rho = self.outer.r - 0.5 * (length + self.grown.length)
        rest = excess(unit, slips, self.outer.r, self.drive, 1 - self.near)
        return slips, replace(unit, force=(1.0 - rest / unit.strong(rho)) * unit.force)

    def missed(self, length: float) -> float:
        return excess(*self.zones(length), self.outer.r, self.drive, self.near)

    def bracket(self, least: float) -> tuple[float, float]:
        """Lengths between which the solution is, beyond a mark that is beyond a length."""
        most, beyond = 2.0 * self.outer.r - self.grown.length, (1.0 + SAME) * least
        marks = self.frame.breaks[(self.frame.breaks > beyond) & (self.frame.breaks < 0.5 * most)]
        low = next((mark for mark in marks.tolist() if self.missed(mark) < 0.0), most)
        for part in PARTS if low < most else ():
            high = low + part * (most - low)
            if self.missed(high) >= 0.0:
                return low, high
            low = high
        raise ContactError(NO_END)

    def length(self, low: float, high: float) -> float:
        ends, most = (self.missed(low), self.missed(high)), 2.0 * self.outer.r
        return false_position(
            self.missed, low, high, ends, lambda a, b, value: b - a <= 4.0 * EPS * most
        )


def joined(
    before: Held,
    course: Course,
    signs: tuple[float, float],
    span: tuple[float, float],
) -> Joined:
    """The state at the end of a part of a step, whose stick zone ends beyond an earlier mark.

    Raises ContactError where there is none.
    """
    near, (begun, share) = 0 if signs[0] else 1, span
    s, f, p = signs[near], course.contacts.scene.friction, course.pressure(share)
    old, new, loads = before.pressure.contact, p.contact, course.shear(share)
    edges = [min(old.x1, new.x1), max(old.x2, new.x2)]
    edges[1 - near] = new[1 - near]
    outer, side = Interval(*edges), (-1.0, 1.0)[near]

    def free(x: Array) -> Array:
        values: Array = p(x) - (s / f) * before.shear(x)
        return values

    frame = FrozenEdge(edges[near], side, 2.0 * outer.r, free, np.array(places(before, p)))
    drive = Drive((loads[0] - before.Q) / f, math.pi * (loads[1] - before.tau) / f, s, s)
    grown = NewContact(abs(new[1 - near] - old[1 - near]))
    if not grown.length > 0.0:
        raise ContactError(NO_END)
    equation = _Joining(near, outer, frame, drive, grown)
    bracket = equation.bracket(side * (edges[near] - before.stick[near]))
    length = equation.length(*bracket)
    zones = equation.zones(length)
    moves = (length, -grown.length) if near == 0 else (grown.length, -length)
    found = SlipZones(outer.moved(*moves), *(zones if near == 0 else zones[::-1]), drive)
    factor = s * f * float(zones[1].force[0] / grown.zone.force[0])
    frames = frame, frame  # of the one zone that slips
    state = Joined(before, p, f, signs, *loads, found, 0.0, course, begun, share, frames, factor)
    bent = replace(equation, grown=replace(grown, bend=_bend(state, course)))
    apart = abs(bent.length(*bracket) - length) / state.stick.r
    force = float(np.abs(bent.zones(length)[1].force - zones[1].force).sum()) / p.resultant
    return replace(state, error=max(apart, force))


def _bend(state: Joined, course: Course) -> float:
    """1 - κ0/κ1."""
    direction = 1.0 if state.signs[0] else -1.0
    s = state.signs[0] or state.signs[1]
    zone = StickingZone(course, direction, course.rates.mirrored(direction), s, state.friction)

    def kappa(rho: float, share: float) -> float:
        return (zone.load - math.pi * rho * float(zone.turn(np.array(share)))) / math.sqrt(rho)

    return 1.0 - kappa(state.before.stick.r, state.begun) / kappa(state.stick.r, state.share)
