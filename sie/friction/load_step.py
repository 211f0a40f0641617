"""What each step of a load path does to the memory of a contact, and the steps that are refused.

Along a step P, Q, σ and the tilt change in proportion to time. `memory` says what slip of one sign
at both edges leaves, if the stick zone only recedes. With dΛ, dS the changes of level and shear,
whose effect at an edge is Re ∓ (ρ/r₀) Im (right, left; ρ the half-width of a zone), that is:

    both ends of the stick zone recede        s dS - dΛ >= 0 at both ends
    slip keeps its direction out to the edge  Re arccosh v ∓ (ρ/r₀) Im sqrt(v² - 1) >= 0 of
                                              s dS - dΛ, v ρ the distance of the edge
    a new front runs ahead of the edge        s (dS - κ dΛ) >= 0 at both edges
    the contacts are nested                   stick zone, corners and contact, by their edges

On several patches the effect at an edge is that of `patches.step_zones`, and >= 0 at all of them.
They are tested at the start, where the stick zone is widest, and during a step in which P or the
tilt changes. Where both edges grow and neither slips, |dS| <= dΛ there, a layer is added.

Slip of opposite signs at the two edges has no such memory: it depends on the loads at its end alone
as long as its zones grow, which is tested on the way.
"""

from __future__ import annotations

import math
from contextlib import suppress
from functools import cached_property
from itertools import pairwise
from typing import Protocol

import numpy as np

from sie.errors import ContactError
from sie.numerics.interval import Interval

from .load_history.turning_point import TurningPoint
from .loads import Loads
from .memory import BALANCED, LoadMemory, SlipEvent, in_proportion
from .slip_state import Slip
from .step_conditions import SLACK, TESTED, OneZone, Zones, inside, reached


class Contacts(Protocol):
    """The contacts of a scene under the loads of a path.

    level            Λ, counted from the tilt of the first point
    shear            S
    zones            the zones of contact under loads
    sticking         the stick zones of a contact that was never sheared before S rose to a depth
    first_loading    the state of such a contact
    curved           whether the tilt follows from a moment, and not in proportion to time in a step
    """

    def level(self, loads: Loads) -> complex: ...
    def shear(self, loads: Loads) -> complex: ...
    def zones(self, loads: Loads) -> Zones: ...
    def sticking(self, normal: tuple[float, float], depth: complex) -> Zones: ...
    def first_loading(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    @property
    def curved(self) -> bool: ...


class NotLayered(ContactError):
    """No superposition of layers answers a step. The sentence says what happens in it."""


class Step:
    """A step from one turning point to other loads, which change Λ by `rise` and S by `pull`."""

    def __init__(
        self, contacts: Contacts, before: TurningPoint, loads: Loads, rise: complex, pull: complex
    ) -> None:
        self.contacts, self.before, self.loads = contacts, before, loads
        self.rise, self.pull, self.memory = rise, pull, before.memory

    @property
    def k(self) -> float:
        return self.memory.top.k if self.memory.top else 0.0

    @cached_property
    def parts(self) -> tuple[tuple[complex, complex], ...]:
        """The changes of Λ and S from one tested time to the next.

        This is one part, if both are in proportion to time, and more where the tilt follows from a
        moment.
        """
        if not self.contacts.curved:
            return ((self.rise, self.pull),)
        shares = (0.0, *TESTED)
        levels = [self.contacts.level(self._at(share)) for share in shares]
        return tuple(
            (after - before, (end - start) * self.pull)
            for (before, after), (start, end) in zip(
                pairwise(levels), pairwise(shares), strict=True
            )
        )

    # -- the kinds of a step -----------------------------------------------------------------------

    def in_proportion(self) -> TurningPoint:
        """At constant P and tilt, with all earlier changes of S in one proportion."""
        turned = self.opposite
        sign = math.copysign(1.0, self.pull.imag if turned else self.pull.real)
        memory, slips = self.memory.changed(0.0, self.pull, sign)
        return TurningPoint(self.loads, memory, slips, turned)

    @property
    def opposite(self) -> bool:
        """Whether the bulk stress pulls the two edges in opposite directions."""
        if not self.pull.imag:
            return False
        contact = self.contacts.zones(self.loads)
        return contact.two_signed and bool(np.prod(contact.at_ends(self.pull)) < 0.0)

    def reversed(self, sign: float) -> TurningPoint:
        """Slip of this sign after slip of the other one, in a steady cycle."""
        if self.before.turned:
            found = self.in_proportion()
            if not self._state(1.0, 0.5 * sign * self.pull).advancing:
                raise ContactError("zones of slip would retreat on the way: " + UNSTEADY)
            return found
        try:
            one_way = self.one_sign((sign,)) or self.late()
        except NotLayered as problem:
            raise ContactError(f"{problem}: {UNSTEADY}") from None
        if one_way is None:
            raise ContactError(
                "slip does not start at both edges in one direction, or the stick zone does not "
                "recede at both ends: " + UNSTEADY
            )
        return one_way

    def refuse_retreat(self) -> None:
        """Refuse a change of direction after a first loading whose slip zones retreated."""
        depth, _ = self.memory.deepest
        if not self.contacts.first_loading(self.before.loads.normal, depth, True).advancing:
            why = self.before.why or "it is followed in one patch only; lower Q or σ there"
            raise ContactError(
                "zones of slip retreat on the way to the first point, and what they leave depends "
                f"on that way: {why}"
            )

    def upright(self) -> TurningPoint:
        """At constant tilt and bulk stress: contacts are nested by their loads."""
        memory, slips = self.memory.changed(self.rise, self.pull, within=self._within)
        return self._reached(memory, slips)

    def general(self) -> TurningPoint:
        found = None if self.before.turned else self._stuck() or self.one_sign() or self.late()
        return found or self._both_signs()

    def one_sign(self, signs: tuple[float, ...] = (1.0, -1.0)) -> TurningPoint | None:
        """Slip in one direction from the start of the step to its end."""
        contact, (rise, pull) = self.contacts.zones(self.before.loads), self.parts[0]
        for sign in signs:
            start = self._zone(0.0, self.memory) if self.k == sign else contact
            if not start.opens(sign * pull - rise, contact):
                continue
            ahead = sign * (pull - self.k * rise) if self.rise and self.k != sign else 0.0
            if not contact.opens(ahead, contact):
                continue
            memory, slips = self._slipped(sign, 1.0)
            if self.rise:
                self._test_on_the_way(sign)
            return self._reached(memory, slips)
        return None

    def _stuck(self) -> TurningPoint | None:
        """No slip: layers are added in proportion to P, or taken off as they were added."""
        rise, pull, k = self.rise, self.pull, self.k
        if self.bares:
            return self._reached(self.memory.raised(rise, k), ())
        if not self.sticks:
            return None
        if pull and not all(in_proportion(p, r) for r, p in self.parts):
            raise NotLayered(
                "the contact grows and sticks while Q, bulk stress and tilt do not change in "
                "proportion to P and tilt"
            )
        return self._reached(self.memory.raised(rise, (pull / rise).real), ())

    @property
    def bares(self) -> bool:
        """Whether layers are taken off as they were added, and both edges retreat."""
        balanced = abs(self.pull - self.k * self.rise) <= BALANCED * abs(self.rise)
        if not (self.rise and balanced) or self.contacts.curved:
            return False
        return all(contact.at_ends(self.rise).max() < 0.0 for contact in self._contacts)

    @property
    def bared(self) -> float:
        """The share of the step after which the top layer is gone without slip.

        It is at least 1 where the layer is not gone.
        """
        top = self.memory.top
        if top is None or not self.bares or not in_proportion(top.thickness, self.rise):
            return math.inf
        return -(top.thickness / self.rise).real

    def without_top(self) -> LoadMemory:
        assert self.memory.top is not None
        return LoadMemory(self.memory.level - self.memory.top.thickness, self.memory.top.below)

    @property
    def sticks(self) -> bool:
        """Whether both edges grow, and neither slips."""
        for rise, pull in self.parts:
            for contact in self._contacts:
                limits, pulls = contact.at_ends(rise), contact.at_ends(pull)
                if not (limits > 0.0).all() or (np.abs(pulls) > limits * (1.0 + SLACK)).any():
                    return False
        return True

    @cached_property
    def _contacts(self) -> tuple[Zones, Zones]:
        """The zones of contact at the start and at the end."""
        return self.contacts.zones(self.before.loads), self.contacts.zones(self.loads)

    def late(self) -> TurningPoint | None:
        """A new front that an edge of a shrinking contact holds up at first.

        Earlier slip goes on there meanwhile, and the new front has to pass all of it.
        """
        sign = -self.k
        front, ahead = sign * self.pull - self.rise, sign * (self.pull - self.k * self.rise)
        if abs(sign) != 1.0 or not self.rise:
            return None
        whole, contact = self._contacts
        if not (whole.opens(front, whole) and contact.opens(ahead, contact)):
            return None
        memory, slips = self._slipped(sign, 1.0)
        zone = self._zone(1.0, memory)
        if not (zone.lie_in(contact) and zone.opens(front, contact) and self._passes(zone)):
            return None
        return self._reached(memory, tuple(slip._replace(timed=False) for slip in slips))

    def _passes(self, zone: Zones) -> bool:
        """Whether a front that ends at this zone has passed slip that went on meanwhile."""
        old, contacts = self._zone(0.0, self.memory), self._contacts
        if not (isinstance(zone, OneZone) and isinstance(old, OneZone)):
            stopped = old.at_ends(self.k * self.pull - self.rise)
            return bool(stopped.max() <= 0.0) and zone.lie_in(old)
        ends = [end for contact in contacts for interval in contact.intervals for end in interval]
        widest = Interval(min(ends), max(ends))
        return all(
            inside(zone.zone, self._out_of_reach(self.k * pull - rise, old, widest))
            for rise, pull in self.parts
        )

    def _out_of_reach(self, change: complex, old: OneZone, widest: Interval) -> Interval:
        """What slip beside an old stick zone does not reach that goes on at one edge.

        `change` is κ dS - dΛ, which is positive at the edge that holds up a new front.
        """
        reach, right = reached(change, widest, old.arm), int(change.imag < 0.0)
        edge = widest[not right]
        room = old.zone.x2 - edge if right else edge - old.zone.x1
        if not self.contacts.curved and reach < room:
            # The end of the old stick zone recedes until the other edge has come nearer by the
            # difference. Q alone that drove it as at the start would bring it farther.
            near = (
                share
                for share in TESTED
                if abs(self._edges_at(share)[not right] - edge) >= room - reach
            )
            receding = OneZone(Interval(0.0, room), old.arm)
            drive = next(near, 1.0) * float(receding.at_ends(change)[right])
            with suppress(ContactError):
                memory, _ = self.memory.changed(0.0, self.k * drive, self.k, self._within)
                ((lo, hi),) = self._zone(0.0, memory).intervals
                reach = max(reach, hi - edge if right else edge - lo)
        return Interval(edge, edge + reach) if right else Interval(edge - reach, edge)

    def _edges_at(self, share: float) -> tuple[float, float]:
        intervals = self.contacts.zones(self._at(share)).intervals
        return intervals[0][0], intervals[-1][1]

    def _both_signs(self) -> TurningPoint:
        """Slip in opposite directions at the two edges, in one direction since nothing slipped."""
        top = self.memory.top
        total = self.contacts.shear(self.loads)
        sign = math.copysign(1.0, total.imag)
        begun = top is None or (self.before.turned and top.below is None and top.k == sign)
        if top is None and not self._contacts[0].two_signed:
            raise NotLayered("slip would have opposite directions at the edges of the patches")
        if not (begun and total.imag and self._contacts[0].two_signed):
            raise NotLayered(self._why())
        memory, slips = self.memory.changed(self.rise, self.pull, sign)
        states = [
            self._state(share, sign * self.contacts.shear(self._at(share)))
            for share in (0.0, *TESTED)
        ]
        for share, earlier, state in zip(TESTED, states, states[1:], strict=False):
            (contact,) = self.contacts.zones(self._at(share)).intervals
            if not (inside(state.stick_zone, Interval(*contact)) and _grown(earlier, state)):
                raise NotLayered(
                    "zones of slip in opposite directions would retreat at one end on the way"
                )
        return TurningPoint(self.loads, memory, slips, turned=True, straight=False)

    # -- conditions --------------------------------------------------------------------------------

    def _test_on_the_way(self, sign: float) -> None:
        parts = self.parts if self.contacts.curved else self.parts * len(TESTED)
        for share, (rise, pull) in zip(TESTED, parts, strict=True):
            try:
                memory, _ = self._slipped(sign, share)
            except ContactError:
                continue  # one end is at a corner: the state at the end of the step is judged
            zone, contact = self._zone(share, memory), self.contacts.zones(self._at(share))
            if not zone.lie_in(contact):
                raise NotLayered("an edge of the contact overtakes the slip")
            if not zone.opens(sign * pull - rise, contact):
                raise NotLayered("slip next to an edge would turn while it goes on farther in")

    def _within(self, first: complex, second: complex) -> bool:
        """Whether the contact at one depth lies within that at another."""
        normal = self.before.loads.normal
        one, other = (self.contacts.sticking(normal, depth) for depth in (first, second))
        if one.lie_in(other):
            return True
        if other.lie_in(one):
            return False
        raise NotLayered(
            f"one end of the stick zone passes that of an earlier one, and the other does not: "
            f"{one} and {other}"
        )

    def _reached(self, memory: LoadMemory, slips: tuple[SlipEvent, ...]) -> TurningPoint:
        """The turning point, if its layers lie within the contact and |κ| <= 1 bounds |q|."""
        top = memory.top
        tilted = top and isinstance(top.depth, complex) and self.loads.P < self.before.loads.P
        if tilted and not self._zone(1.0, memory).lie_in(self.contacts.zones(self.loads)):
            raise NotLayered("an edge of the contact overtakes the slip")
        crossed = top and top.below and any(not slip.timed for slip in slips)
        if top and top.below and crossed:
            thinnest = self._zone(1.0, memory).at_ends(top.below.thickness).min()
            if thinnest < 0.0:
                raise NotLayered(
                    "between the stick zone and an earlier one the shear may exceed f p"
                )
        return TurningPoint(self.loads, memory, slips, self.before.turned, straight=False)

    # -- states on the way -------------------------------------------------------------------------

    def _at(self, share: float) -> Loads:
        return self.before.loads.towards(self.loads, share)

    def _slipped(self, sign: float, share: float) -> tuple[LoadMemory, tuple[SlipEvent, ...]]:
        """The memory after a share of the step."""
        loads = self._at(share)
        rise = self.contacts.level(loads) - self.memory.level
        return self.memory.changed(rise, share * self.pull, sign, self._within)

    def _zone(self, share: float, memory: LoadMemory) -> Zones:
        """The stick zones below the uppermost layer; all of the contact where there is none."""
        if memory.top is None:
            return self.contacts.zones(self._at(share))
        return self.contacts.sticking(self._at(share).normal, memory.top.thickness)

    def _state(self, share: float, depth: complex) -> Slip:
        """The state after first loading to a depth, with slip in both directions."""
        return self.contacts.first_loading(self._at(share).normal, depth, True)

    def _why(self) -> str:
        """What happens in a step that no superposition covers."""
        effects = self._contacts[0].at_ends(self.pull - self.k * self.rise)
        if self.before.turned:
            return "slip in opposite directions at the two edges changes its proportion"
        if effects.min() * effects.max() < 0.0:
            return "slip turns at one edge and goes on, or stops, at the other"
        return "one end of the stick zone recedes and the other does not"


UNSTEADY = (
    "the steady state is not that of one stick zone, which is all that is covered; change P, Q, σ "
    "and tilt in other proportions"
)


def _grown(earlier: Slip, later: Slip) -> bool:
    """Whether the zones of slip have grown, and slip in them."""
    if not inside(later.stick_zone, earlier.stick_zone):
        return False
    contact = later.contact
    x = contact.m + contact.r * np.cos(np.pi * (np.arange(64) + 0.5) / 64)
    before, after = earlier.slip(x), later.slip(x)
    room = SLACK * float(np.abs(after).max())
    return bool(((after - before) * np.sign(after) >= -room).all())
