"""The energy that slip dissipates in a step: ∫∫ f p |dg| dx, by the rates of states on the way.

The power is smooth in the load between the turn of the loads and the loads at which an end of the
stick zone, or an edge on a kink of the profile, passes a mark. There the way is divided. Roots of
the distance from these loads are smooth in the variable of the rule.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.clenshaw_curtis import integral

from .search import ROUGHLY, Zones, passing, settled, zones_of
from .step import Loaded, guess, slip_along

if TYPE_CHECKING:
    from .state import Question, State

Array = NDArray[np.float64]

PROMISED = 3e-7  # of the energy of a step: what must be reached
EARLY = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2)  # parts of a step, of which one has a state
LATE = (0.6, 0.9, 0.97, 0.99, 0.997, 0.999, 0.9997, 0.9999)  # the same before a loop closes
SAMPLES = (0.04, 0.1, 0.3, 0.6, 0.9)  # of a step, between which ends pass marks
EXTENDED = 2e-6  # of the energy: power times part, up to which it is not known after a turn
APART = 1e-6  # of the way of an end: marks nearer to its ends are not divided at
TURNED = 1e-4  # of the power: what slip against q may take from it


def work(previous: Loaded, after: Loaded) -> float:
    """E*/2 times the energy of the step that led to a state; ContactError where it is not known."""
    base = after.base or after.before
    if base is None or after is previous:
        return 0.0
    if after.halfway is not None:
        return work(previous, after.halfway) + work(after.halfway, replace(after, halfway=None))
    way, total = Way(previous, after, base), 0.0
    # the longest first: of a short part fewer digits count
    for first, last in sorted(pairwise(way.divided), key=lambda ends: ends[0] - ends[1]):
        found = integral(way.power, first, last, PROMISED, total)
        if found is None:
            raise _unknown()
        total += found
    if max(way.extended) > EXTENDED * total:
        raise _unknown()
    return total


@dataclass(frozen=True, eq=False)
class Way:
    """The states of a step, by the part of it that is done.

    previous    the state before it
    after       that after it
    base        what is locked in
    known       zones by the part
    extended    power times part, up to which after a turn it was not known: gained contact sticks
    """

    previous: Loaded
    after: Loaded
    base: Loaded
    known: dict[float, Zones] = field(default_factory=dict)
    extended: list[float] = field(default_factory=lambda: [0.0])

    @property
    def turned(self) -> bool:
        """Whether the loads turned at the beginning."""
        return self.base is self.previous

    @cached_property
    def divided(self) -> tuple[float, ...]:
        """Parts between which the power is smooth, with 0 and 1."""
        begin, end = self._beginning[1].ends, self._ending.ends
        kinks = self.after.question.slope.kinks
        inner = *self.base.marks, *kinks
        passed = [0.0, 1.0]
        for k, marks in enumerate((kinks, inner, inner, kinks)):
            way = float(end[k] - begin[k]) or 1.0
            within = [m for m in marks if APART < (m - begin[k]) / way < 1.0 - APART]
            passed += [self._passed(k, mark, way) for mark in within]
        return tuple(sorted(passed))

    def _passed(self, end: int, mark: float, way: float) -> float:
        """The part at which an end passes a mark, on its way."""
        parts, places = self._samples
        ahead = np.maximum.accumulate(math.copysign(1.0, way) * places[:, end])
        part = float(np.interp(math.copysign(mark, way * mark), ahead, parts))
        zones = guess(self.base, *self.loads(part))
        found = passing(self.question, (part, zones), self.base.marks, end, mark) if zones else None
        if found is None or not 0.0 < found[0] < 1.0:
            raise _unknown()
        return found[0]

    @cached_property
    def _samples(self) -> tuple[Array, Array]:
        """Some parts, and the ends of the zones."""
        first, zones = self._beginning
        each = [zones, *(self.zones(part) for part in SAMPLES), self._ending]
        return np.array([first, *SAMPLES, 1.0]), np.array([zones.ends for zones in each])

    @cached_property
    def _beginning(self) -> tuple[float, Zones]:
        """The first part with zones, and these."""
        if not self.turned:
            return 0.0, self.previous.zones
        for part in EARLY:
            state = self._found(part)
            if state is not None:
                return part, zones_of(state)
        raise _unknown()

    @cached_property
    def _ending(self) -> Zones:
        """The zones at the end, where a loop that is closed there has not yet been left."""
        return self.after.zones if self.after.base is None else [*map(self.zones, LATE)][-1]

    def question(self, part: float) -> Question:
        """What the state at a part of the step is asked for."""
        return self.base.asked(*self.loads(part))

    def loads(self, part: float) -> tuple[float, float]:
        """Q and strain at a part of the step."""
        (dQ, strain), rest = self.after.step, 1.0 - part
        return self.after.Q - rest * dQ, self.after.strain - rest * strain

    def power(self, part: float) -> float:
        """∫ f p |dg| dx at a part of the step, per part.

        Where it is not known soon after a turn it goes on from later ones: as the square of the
        part, but after P alone, where what slipped slips on.
        """
        for known in (part, *(later for later in EARLY if self.turned and later > part)):
            found = self._power(known)
            if found is not None:
                if known > part > EARLY[0]:
                    self.extended.append(part * found)
                return found * (part / known) ** (2.0 if self.base.before else 0.0)
        raise _unknown()

    def _power(self, part: float) -> float | None:
        """The same, None where it is not known, or slip would go against q."""
        state = self._found(part)
        if state is None or state.pieces.signs != self._ending.signs:
            return None
        (dQ, strain), friction = self.after.step, state.question.friction
        at, growth = state.rates(dQ, strain)
        slip = slip_along(state, at, growth - strain)
        lost = at.weight * friction * state.pressure_in_slip(at) * slip
        total = float(lost.sum())
        return total if lost[lost < 0.0].sum() >= -TURNED * total else None

    def _found(self, part: float) -> State | None:
        """The state at a part of the step, roughly."""
        loads, near = self.loads(part), sorted(self.known, key=lambda other: abs(other - part))
        for start in (guess(self.base, *loads), *(self.known[other] for other in near[:1])):
            state = start and settled(self.question(part), start, self.base.marks, ROUGHLY)
            if state:
                self.known[part] = zones_of(state)
                return state
        found = self.previous.stepped(*loads)
        return found.state if found and (found.base or found.before) is self.base else None

    def zones(self, part: float) -> Zones:
        """The zones at a part of the step."""
        state = self._found(part)
        if state is None:
            raise _unknown()
        return zones_of(state)


def _unknown() -> ContactError:
    return ContactError(
        "the energy of this step is a sum over states on the way, of which one was not found, or "
        "is known to less than 1e-6; give the step in two parts"
    )
