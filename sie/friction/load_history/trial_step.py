"""A step of a load path with assumed signs of slip, and the tests that it has to pass.

The state at its end follows from that at its start where every point slips in one direction only.
Tested on the way are

    zones that grow                     the ends of the stick zone, and the edges of contact
    slip that keeps its direction       its rate next to the edges of contact, in closed form where
                                        it has one sign, by the slip itself otherwise
    |q| <= f p                          where it sticks to the end; elsewhere slip may begin earlier
                                        in the direction of its zone
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.loads import Loads
from sie.friction.step_conditions import SLACK, TESTED, inside, opens
from sie.numerics.interval import Interval
from sie.numerics.root_finding import false_position
from sie.traction.of_slope import SlopeDensity

from .growing_contact import Contacts, LoadChange
from .marched_step import Held, MarchedStep
from .receding_step import OPPOSING, Ends, Receded, receded
from .slip_rates import SlipRates

Array = NDArray[np.float64]

EXCEEDED = 1e-9  # of the largest f p: by so much |q| <= f p may be missed
LOCATED = 1e-7  # of a step: so well it is known where in it what is refused happens
# So well it is known when an end of the stick zone stops, of a step and of the rate of slip: what
# the end misses is of the second order.
SURE, STILL = 1e-10, 1e-9

# Of the half-width of contact: what is left of a zone of slip then, and where none was there before
VANISHED, NOTHING = 1e-5, 1e-12

ISLAND = "the shear in the stick zone reaches f p, and a second zone of slip opens there"
TURNS = "slip next to an edge of contact turns while it goes on farther in"
TRY = "this is not covered; change P, Q, σ and tilt in other proportions"

Signs = tuple[float, float]
GoesOn = tuple[bool, bool]


class Marchable(Contacts, Protocol):
    """The contacts of a path that is followed.

    level    Λ of loads
    shear    S of loads
    arm      π r₀
    """

    def level(self, loads: Loads) -> complex: ...
    def shear(self, loads: Loads) -> complex: ...
    @property
    def arm(self) -> float: ...


@dataclass(frozen=True, eq=False)
class Trial:
    """A step between two loads.

    held       what it starts from
    signs      the signs of slip to the left and the right of the stick zone
    goes_on    whether each end goes on from where it was, and does not begin at the edge of contact
    begun      the share of the whole step at its start
    """

    contacts: Marchable
    held: Held
    start: Loads
    end: Loads
    signs: Signs = (0.0, 0.0)
    goes_on: GoesOn = (False, False)
    begun: float = 0.0

    def with_signs(self, signs: Signs, goes_on: GoesOn) -> Trial:
        return replace(self, signs=signs, goes_on=goes_on)

    @property
    def friction(self) -> float:
        return self.contacts.scene.friction

    @property
    def constant(self) -> bool:
        """Whether the pressure does not change."""
        return self.start.normal == self.end.normal

    def shear(self, share: float) -> tuple[float, float]:
        """Q and τ after a share of the step."""
        return self.contacts.sheared_by(self.start.towards(self.end, share))

    def first(self, goes_on: GoesOn) -> Interval:
        """The stick zone at the start."""
        stick, contact = self.held.stick, self.held.pressure.contact
        left = stick.x1 if goes_on[0] else contact.x1
        return Interval(left, stick.x2 if goes_on[1] else contact.x2)

    def state(self, share: float) -> Receded:
        """The state after a share of the step, if both ends recede all along."""
        loads, shear = self.start.towards(self.end, share), self.shear(share)
        if abs(loads.Q) >= self.friction * loads.P * (1.0 - SLACK):
            raise ContactError("the bodies slide as a whole, |Q| = f P, which is not marched")
        ends = Ends(self.signs, self.goes_on if self.constant else (False, False))
        return receded(self.held, self.pressure(share), self.friction, shear, ends)

    def pressure(self, share: float) -> SlopeDensity:
        """p after a share of the step."""
        if self.constant:
            return self.held.pressure
        return self.contacts.pressure_at(self.start.towards(self.end, share))

    def stop(self) -> tuple[float, float] | None:
        """The share of the step after which an end advances, and 1 if it is the right one, or -1.

        None where slip has one direction, or no end stops. The pressure changes.
        """
        if self.signs[0] == self.signs[1]:
            return None
        rates = SlipRates(
            LoadChange(self.contacts, self.start, self.end).rates, self.friction, self.signs
        )

        def onwards(share: float) -> Array | None:
            try:
                state = self.state(share)
            except ContactError:
                return None
            contact = state.pressure.contact
            return rates.onwards(contact, state.stick) if inside(state.stick, contact) else None

        at_start = rates.onwards(self.held.pressure.contact, self.first(self.goes_on))
        least = int(at_start.argmin())
        if self.goes_on[least] and at_start[least] <= STILL * abs(at_start).max():
            return 0.0, (-1.0, 1.0)[least]
        bracket = _bracket(onwards)
        if bracket is None:
            return None
        (low, at_low), (high, at_high) = bracket
        k = int(at_high.argmin())

        def rate(share: float) -> float:
            found = onwards(share)
            return math.nan if found is None else float(found[k])

        def settled(a: float, b: float, value: float) -> bool:
            return b - a <= SURE or abs(value) <= STILL * float(at_low[k])

        share = false_position(rate, low, high, (float(at_low[k]), float(at_high[k])), settled)
        return share, (-1.0, 1.0)[k]

    def closed(self) -> tuple[float, tuple[bool, bool]] | None:
        """The share of the step at which a zone of slip vanishes at an edge that retreats.

        With it whether the left one does, and the right one; None where none vanishes. The zone
        that is left has slipped in the wrong direction, which is of the second order.
        """
        low, _ = narrowed(self._lost, 0.0, 1.0)
        if low == 0.0:
            return None
        last = self.state(low)
        stick, contact = last.stick, last.pressure.contact
        left = stick.x1 - contact.x1, contact.x2 - stick.x2
        if min(left) > VANISHED * contact.r:
            return None
        nothing = max(min(left), NOTHING * contact.r)
        return low, (left[0] <= nothing, left[1] <= nothing)

    def _lost(self, share: float) -> bool:
        """Whether no state is found after a share of the step."""
        try:
            self.state(share)
        except ContactError:
            return True
        return False

    # -- tests -------------------------------------------------------------------------------------

    def passed(self, share: float) -> Receded:
        """The state after a share of the step. Raises ContactError where a test fails."""
        self._solved(TESTED[0] * share)  # what fails from the start on is told as such
        before = end = self._solved(share)
        shares = (0.0, *(part * share for part in TESTED))
        for k, (earlier, later) in enumerate(pairwise(shares)):
            now = end if later == share else self._solved(later)
            if self._problem(before if k else None, now, end, (earlier, later)):
                raise self._located(before if k else None, end, (earlier, later))
            before = now
        if self.constant and end.opposing > OPPOSING:
            raise self.refusal(ISLAND, share)
        return end

    def _solved(self, share: float) -> Receded:
        try:
            return self.state(share)
        except ContactError as problem:
            early = share <= TESTED[0] and not self.constant
            why = f"{problem}: an edge of it sticks, or slip would advance" if early else problem
            raise self.refusal(str(why), share) from None

    def _problem(
        self, before: Receded | None, now: Receded, end: Receded, shares: tuple[float, float]
    ) -> str:
        """What is wrong with a state on the way from another one, "" for nothing."""
        zone, contact = before.stick if before else self.first(self.goes_on), now.pressure.contact
        if not inside(now.stick, zone):
            return "one end of the stick zone turns"
        if not inside(now.stick, contact):
            return "an edge of contact overtakes an end of the stick zone"
        if excess(now, end.stick)[1] > EXCEEDED:
            return ISLAND
        if not self._keeps_direction(before, now, shares):
            return TURNS
        return ""

    def _keeps_direction(
        self, before: Receded | None, now: Receded, shares: tuple[float, float]
    ) -> bool:
        """Whether all that slips does so in the direction of its zone."""
        (left, right), contact, arm = self.signs, now.pressure.contact, self.contacts.arm
        if left == right:
            start, end = (self.start.towards(self.end, share) for share in shares)
            pull = self.contacts.shear(end) - self.contacts.shear(start)
            rise = self.contacts.level(end) - self.contacts.level(start)
            zones = (now.stick, before.stick) if before else (now.stick,)
            return all(opens(complex(left * pull - rise), zone, contact, arm) for zone in zones)
        if self.constant:
            return True  # arccosh v <= sqrt(v² - 1)
        change = LoadChange(self.contacts, self.start, self.end)
        rates = SlipRates(change.rates, self.friction, self.signs)
        return rates.keep_direction(now.pressure, now.stick)

    def _located(
        self, before: Receded | None, end: Receded, shares: tuple[float, float]
    ) -> ContactError:
        """The refusal of what is wrong, with the loads at which it first is."""

        def said(share: float) -> str:
            return self._problem(before, self._solved(share), end, (shares[0], share))

        _, first = narrowed(lambda share: bool(said(share)), *shares)
        return self.refusal(said(first), first)

    def refusal(self, said: str, share: float) -> ContactError:
        """The refusal of what is wrong after a share of the step."""
        loads, whole = self.start.towards(self.end, share), 1.0 - (1.0 - self.begun) * (1.0 - share)
        return ContactError(f"{said}, at {loads}: {TRY}", share=whole, loads=tuple(loads))


def _bracket(
    onwards: Callable[[float], Array | None],
) -> tuple[tuple[float, Array], tuple[float, Array]] | None:
    """Two shares of a step, and by how much slip goes on there: at both ends, and not at one.

    None where it goes on all along, or no state is found beside one where it does not.
    """
    low, at_low, at_high = 0.0, None, None
    for high in TESTED:
        at_high = onwards(high)
        if at_high is None or at_high.min() < 0.0:
            break
        low, at_low = high, at_high
    else:
        return None
    while (at_low is None or at_high is None) and high - low > LOCATED:
        middle = 0.5 * (low + high)
        between = onwards(middle)
        if between is not None and between.min() >= 0.0:
            low, at_low = middle, between
        elif between is None and at_high is not None:
            low = middle  # zones so short are not found
        else:
            high, at_high = middle, between
    return None if at_low is None or at_high is None else ((low, at_low), (high, at_high))


def narrowed(wrong: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """The shares of a step between which something goes wrong that is wrong at the higher one."""
    while high - low > LOCATED:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if wrong(middle) else (middle, high)
    return low, high


def excess(state: MarchedStep, sticks: Interval) -> tuple[float, float]:
    """The largest |q| - f p in the stick zone of a state, over the largest f p.

    The second is that of what sticks to the end, or slips in another direction than at the end.
    """
    x, q, beyond = state.scanned
    along = np.where(x < sticks.m, *state.signs) * q > 0.0
    slips = along & ((x < sticks.x1) | (x > sticks.x2))
    return float(beyond.max()), float(beyond[~slips].max(initial=-1.0))
