"""The state after a step that leaves several stick zones, on any earlier shear.

As in `receding_step` it follows from the shear at the start where each point slips in one direction
only: |q| <= f p, with slip where it is equal, is one convex problem for the whole step. A grid
tells how many stick zones there are and in which directions the zones beside them slip
(`grid_zones`); Newton's method finds their ends (`stick_intervals`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import chain, pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_state import IntegralsOfSlip
from sie.friction.step_conditions import TESTED, inside
from sie.numerics.halving import integral
from sie.numerics.interval import Interval
from sie.traction.of_slope import SlopeDensity

from .grid_zones import Guess, cells, guess, stepped
from .growing_contact import LoadChange
from .marched_step import Held, MarchedStep, places
from .receding_step import OPPOSING, Ends, Receded, Side, on_the_way, receded
from .stick_intervals import ROUNDING, StickIntervals, Zone, settled, zone

Array = NDArray[np.float64]

NONE = "no stick zones inside the contact balance the loads"
EXCEEDED = 1e-9  # of the largest f p: by so much |q| <= f p may be missed, which is rounding
# How often zones that a guess lacks are added: of stick where slip opposes, of slip beyond f p
LACKING = 3
KNOWN = 1e-2  # of a step: how well it is known when zones join
TURNED = 1e-3  # of the largest slip: as well does a grid know it
ADVANCES = "one of several stick zones grows at an end while it shrinks at others"
TURNED_BACK = (
    "slip beside several stick zones turns on the way where it goes over all of it again: the "
    "energy lost meanwhile is not known, the state at the end is"
)
TURNS = "slip beside one of several stick zones turns on the way"


class Stepping(Protocol):
    """A step between two loads: what it starts from, f, p and (Q, τ) after a share of it."""

    @property
    def held(self) -> Held: ...
    @property
    def friction(self) -> float: ...
    def pressure(self, share: float) -> SlopeDensity: ...
    def shear(self, share: float) -> tuple[float, float]: ...


@dataclass(frozen=True, eq=False)
class SeveralSticks(Receded):
    """The state after a step that leaves several stick zones.

    found         the stick zones, and the zones in which q changed
    directions    the signs of slip in these, from left to right
    one_way       whether slip had these directions all along
    """

    found: StickIntervals  # type: ignore[assignment]
    directions: tuple[float, ...] = ()
    one_way: bool = True

    @property
    def stick(self) -> Interval:
        """From the first to the last end."""
        return Interval(float(self.found.ends[0, 0]), float(self.found.ends[-1, 1]))

    @property
    def gaps(self) -> tuple[tuple[float, float, float], ...]:
        inner = self.found.ends.ravel()[1:-1].reshape(-1, 2).tolist()
        pairs = zip(inner, self.directions[1:-1], strict=True)
        return tuple((lo, hi, sign) for (lo, hi), sign in pairs)

    def in_stick(self, x: Array) -> Array:
        q: Array = self.before.shear(x) + self.found.shear(x)
        for lo, hi, sign in self.gaps:
            slips = (x > lo) & (x < hi)
            q[slips] = sign * self.friction * self.pressure(x[slips])
        return q

    def until(self, share: float, near: Receded | None = None) -> SeveralSticks:
        assert self.change is not None
        loads, pressure = self.change.shear(share), self.change.pressure(share)
        return stuck_in_several(self.before, pressure, self.friction, loads, near or self)

    @cached_property
    def work(self) -> float:
        """The energy of the parts of the step in which as many zones stick.

        Where it is one, the power of slip is in closed form; else it is ∫f p |Δg| dx less ∫∫f |Δg|
        dp dx.
        """
        if not self.one_way:
            raise ContactError(TURNED_BACK)
        change = self.change
        if change is None:
            return self.integrals.work
        state, scale, total = on_the_way(self), abs(self.integrals.work), 0.0
        for begun, end in pairwise((0.0, *_events(state), 1.0)):
            last = state(end)
            if state(0.5 * (begun + end)).gaps:
                until = last.integrals.work
                total += until - (state(begun).integrals.work if begun else 0.0)
                total -= integral(partial(_released, state, change), scale, (begun, end))
            else:
                total += replace(_in_one_zone(last), change=change, begun=begun, share=end).work
        return total

    def slip_at_edge(self, k: int) -> float:
        return MarchedStep.slip_at_edge(self, k)

    @property
    def _beside(self) -> tuple[Side, ...]:
        return *super()._beside, *((1.0, lo, hi) for lo, hi, _ in self.gaps)

    def _rounding(self, side: float) -> float:
        return 0.0

    def _steepness(self, side: float, end: float) -> Callable[[Array], Array]:
        def steepness(distance: Array) -> Array:
            x = end + side * distance
            change = self.shear.hilbert(x) - self.before.shear.hilbert(x)
            steep: Array = side * (change - (self.tau - self.before.tau))
            return steep

        return steepness

    @cached_property
    def integrals(self) -> IntegralsOfSlip:
        """Integrals of Δg."""
        contact, f, total = self.pressure.contact, self.friction, np.zeros(4)
        for sign, (z, slip) in zip(self.directions, self._in_zones, strict=True):
            left, right = z.apart(contact.x1), z.apart(contact.x2)
            moved = z.weight * slip / np.sqrt(left * right) / np.pi
            spread, lever = float(moved.sum()), float(moved @ (left - right))
            total += f * float(z.force @ slip), sign * spread, f * spread, 0.5 * f * lever
        return IntegralsOfSlip(*total.tolist())

    @property
    def cut(self) -> Guess:
        """A guess with stick zones also where slip is against the direction of its zone."""
        ends, signs, least = self.found.ends.tolist(), [], -OPPOSING * self.largest
        for sign, (z, slip) in zip(self.directions, self._in_zones, strict=True):
            turns = np.diff((slip < least).astype(int), prepend=0, append=0)
            starts, stops = np.flatnonzero(turns == 1), np.flatnonzero(turns == -1) - 1
            ends += np.stack((z.places[starts], z.places[stops]), axis=1).tolist()
            signs += [sign] * (len(starts) + 1)
        return Guess(np.array(sorted(ends)), tuple(signs))

    @property
    def excess(self) -> float:
        """The largest |q| - f p where it sticks, over the largest f p."""
        return float(self.scanned[2].max())

    @property
    def opened(self) -> Guess:
        """A guess with zones of slip also where |q| exceeds f p in the stick zones."""
        x, q, beyond = self.scanned
        turns = np.diff((beyond > EXCEEDED).astype(int), prepend=0, append=0)
        starts, stops = np.flatnonzero(turns == 1) - 1, np.flatnonzero(turns == -1)
        starts, stops = np.maximum(starts, 0), np.minimum(stops, len(x) - 1)
        ends = np.sort(np.concatenate((self.found.ends.ravel(), x[starts], x[stops])))
        gaps = [(lo, sign) for lo, _, sign in self.gaps]
        gaps += zip(x[starts].tolist(), np.sign(q[starts]).tolist(), strict=True)
        inner = (sign for _, sign in sorted(gaps))
        return Guess(ends.reshape(-1, 2), (self.signs[0], *inner, self.signs[1]))


def stuck_in_several(
    before: Held,
    pressure: SlopeDensity,
    friction: float,
    loads: tuple[float, float],
    near: Receded | None = None,
) -> SeveralSticks:
    """The state under a pressure and the loads Q and τ, sought near another one first.

    Raises ContactError where none is found.
    """
    change = loads[0] - before.Q, loads[1] - before.tau
    old, new = before.pressure.contact, pressure.contact
    outer = Interval(min(old.x1, new.x1), max(old.x2, new.x2))
    marks = np.array(places(before, pressure))

    bound = _times(friction, pressure)

    def state(first: Array, signs: tuple[float, ...]) -> SeveralSticks:
        def beside(ends: Array) -> StickIntervals:
            cuts = np.concatenate(([outer.x1], ends.ravel(), [outer.x2])).reshape(-1, 2)

            def slipping(cut: list[float], sign: float) -> Zone:
                lo, hi = cut
                return zone((lo, hi), marks, lambda x: sign * bound(x) - before.shear(x))

            return StickIntervals(ends, tuple(map(slipping, cuts.tolist(), signs)))

        found = settled(beside, first, outer, change)
        outermost = signs[0], signs[-1]
        return SeveralSticks(
            before, pressure, friction, outermost, *loads, *found, directions=signs
        )

    nearest = []
    if isinstance(near, SeveralSticks) and inside(near.stick, outer):
        nearest = [Guess(near.found.ends, near.directions)]
    for first in chain(nearest, guess(outer, before.shear, bound, change, marks)):
        found = _settled(state, first)
        if found is not None:
            return found
    raise ContactError(NONE)


def _settled(state: Callable[..., SeveralSticks], guess: Guess) -> SeveralSticks | None:
    """The state near a guess, with the short zones that it lacks; None where it fails."""
    for _ in range(LACKING):
        found = state(*guess)
        if not found.error < ROUNDING:
            return None
        opened = found.excess > EXCEEDED
        if not opened and found.opposing <= OPPOSING:
            return found
        guess = found.opened if opened else found.cut
    return None


def in_several_zones(step: Stepping) -> SeveralSticks:
    """The state at the end of a step in which all stick zones recede and no slip turns.

    Both are tested at five times on the way. Raises ContactError where they do not hold.
    """
    states: list[SeveralSticks] = []
    for share in reversed(TESTED):
        pressure, near = step.pressure(share), states[0] if states else None
        found = stuck_in_several(step.held, pressure, step.friction, step.shear(share), near)
        states.insert(0, found)
    for earlier, later in pairwise(states):
        if not all(_within(zone, earlier.sticks) for zone in later.sticks):
            raise ContactError(ADVANCES)
    edges, Q, tau = cells(states[-1].pressure.contact), step.held.Q, step.held.tau
    slip = np.array(
        [
            stepped(
                edges, step.held.shear, _times(step.friction, o.pressure), (o.Q - Q, o.tau - tau)
            )
            for o in states
        ]
    )[:, 1]
    grown = np.diff(slip, axis=0, prepend=0.0) * np.sign(slip[-1])
    if grown.min() < -TURNED * np.abs(slip[-1]).max():
        raise ContactError(TURNS)
    return replace(states[-1], one_way=_one_way(states))


def _one_way(states: list[SeveralSticks]) -> bool:
    """Whether each zone of slip on the way has the direction that slip has there at the end."""
    return all(
        sign == after
        for state in states[:-1]
        for lo, hi, sign in state.slipped
        for first, end, after in states[-1].slipped
        if first < 0.5 * (lo + hi) < end
    )


def _in_one_zone(state: Receded) -> Receded:
    """The same state of one stick zone, with nothing said of several ones."""
    ends, loads = Ends(state.signs, near=state.stick), (state.Q, state.tau)
    return receded(state.before, state.pressure, state.friction, loads, ends)


def _events(state: Callable[[float], Receded]) -> list[float]:
    """The shares of a step at which the number of stick zones changes."""
    found = []
    for ends in pairwise(TESTED):
        low, high = ends
        zones = len(state(high).gaps)
        while len(state(ends[0]).gaps) != zones and high - low > KNOWN:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if len(state(middle).gaps) == zones else (middle, high)
        if high < ends[1]:
            found.append(high)
    return found


def _released(state: Callable[[float], Receded], change: LoadChange, share: float) -> float:
    """∫f |Δg| dp/dt dx."""
    now = state(share)
    contact = now.pressure.contact
    strain = float(change.rates.strain(np.array(contact.m), np.array(contact.r)))
    return now.integrals.work_of(change.rates.P, strain)


def _times(friction: float, pressure: SlopeDensity) -> Callable[[Array], Array]:
    """The bound of the shear."""

    def bound(x: Array) -> Array:
        p: Array = friction * pressure(x)
        return p

    return bound


def _within(zone: tuple[float, float], others: tuple[tuple[float, float], ...]) -> bool:
    return any(inside(Interval(*zone), Interval(*other)) for other in others)
