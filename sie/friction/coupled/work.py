"""The energy that slip dissipates in a step: ∫∫ f p |dg| dx, by the rates of states on the way.

The power is smooth in the load between the turn of the loads and the loads at which an end of the
stick zone, or an edge on a kink of the profile, passes a mark. There the way is divided. Powers of
the distance from these loads are smooth in the variable of the rule, that of Clenshaw and Curtis,
whose nodes are doubled until two sums agree.
"""

from __future__ import annotations

import math
from bisect import insort
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError

from .search import ROUGHLY, Zones, passing, settled, zones_of
from .step import Loaded, guess, slip_along

if TYPE_CHECKING:
    from .state import Question, State

Array = NDArray[np.float64]

INTERVALS = (2, 4, 8, 16, 32)  # of the rule, one after the other
PROMISED = 3e-7  # of the energy of a step: what must be reached
FLATNESS = 3  # power of the distance from a load where the power is not smooth
CLOSE = 1e-5  # parts that are one, where zones are told from known ones
NARROW = 1e-5  # of an interval: the power there is taken for that farther in
SMALL = 0.03  # of a step: where powers may be told from later ones
TURNED = 1e-4  # of the power: what slip against q may take from it
TOWARDS_RETURN = [1.0 - 0.4**k for k in range(1, 11)]  # parts before a loop is closed at the end
APART = 1e-6  # of the step: marks that are passed nearer to its ends are not divided at


def work(previous: Loaded, after: Loaded) -> float:
    """E*/2 times the energy of the step that led to a state; ContactError where it is not known."""
    if after.halfway is not None and after is not previous:
        second = replace(after, halfway=None)
        return work(previous, after.halfway) + work(after.halfway, second)
    base = after.base or after.before
    if base is None or after is previous:
        return 0.0
    way, total = Way(previous, after, base), 0.0
    # the longest first: of a short part fewer digits count
    for first, last in sorted(pairwise(way.divided), key=lambda ends: ends[0] - ends[1]):
        total += _summed(way, first, last, total)
    return total


@dataclass(frozen=True, eq=False)
class Way:
    """The states of a step, by the part of it that is done.

    previous    the state before it
    after       that after it
    base        what is locked in
    known       zones that were found, by the part, ascending
    lost        the part up to which there is no state after a turn
    """

    previous: Loaded
    after: Loaded
    base: Loaded
    known: list[tuple[float, Zones]] = field(default_factory=list)
    lost: list[float] = field(default_factory=lambda: [0.0])

    @property
    def turned(self) -> bool:
        """Whether the loads turned at the beginning."""
        return self.base is self.previous

    @property
    def returns(self) -> bool:
        """Whether a loop closes at the end: then zones jump to those that were there before."""
        return self.after.base is not None

    @cached_property
    def marks(self) -> tuple[float, ...]:
        return self.base.marks

    def question(self, part: float) -> Question:
        """What the state at a part of the step is asked for."""
        return self.base.asked(*self.loads(part))

    @cached_property
    def divided(self) -> tuple[float, ...]:
        """Parts between which the power is smooth, with 0 and 1."""
        ending = self._ending
        if not self.returns:
            insort(self.known, (1.0, ending))
        if not (self.turned or self.returns):
            insort(self.known, (0.0, self.previous.zones))
        first, last = self._beginning, self._ending.ends
        kinks = self.after.question.slope.kinks
        places = {0: kinks, 1: (*self.marks, *kinks), 2: (*self.marks, *kinks), 3: kinks}
        passed = []
        for end, marks in places.items():
            span = last[end] - first[end]
            inside = [m for m in marks if APART < (m - first[end]) / (span or 1.0) < 1.0 - APART]
            # from the state that is known towards the beginning
            for mark in sorted(inside, key=lambda m: -abs(m - first[end])):
                passed.append(self._passed(end, mark))
        return (0.0, *sorted(passed), 1.0)

    @cached_property
    def _ending(self) -> Zones:
        """The zones at the end, where a loop that is closed there has not yet been left."""
        if not self.returns:
            return self.after.zones
        return [self._zones(part) for part in TOWARDS_RETURN][-1]

    @cached_property
    def _beginning(self) -> Array:
        """The ends of the zones at the beginning."""
        zones = self.previous.zones
        ends = zones.ends.copy()
        if self.turned:
            left, *_, right = zones.signs
            ends = ends[[0, 1 if left == self._ending.signs[0] else 0, -1, -1]]
            ends[2] = zones.ends[-2 if right == self._ending.signs[-1] else -1]
        return ends

    def _passed(self, end: int, mark: float) -> float:
        """The part at which an end passes a mark, by the known states before and after it."""
        start = self._beginning[end]
        ahead = abs(mark - start)
        places = {part: abs(zones.ends[end] - start) for part, zones in self.known}
        later = min((part for part, place in places.items() if place > ahead), default=None)
        if later is None:
            raise _unknown()
        sooner = max((part for part in places if part < later), default=0.0)
        done = places.get(sooner, 0.0)
        part = sooner + (later - sooner) * (ahead - done) / (places[later] - done)
        zones = self.near(part) or guess(self.base, *self.loads(part))
        found = passing(self.question, (part, zones), self.marks, end, mark) if zones else None
        if found is None or not 0.0 < found[0] < 1.0:
            raise _unknown()
        self._keep(*found)
        return found[0]

    def near(self, part: float) -> Zones | None:
        """Zones next to those at a part, from those that are known, if there are enough.

        After a turn widths grow about as powers of the part.
        """
        closest = sorted(self.known, key=lambda known: abs(known[0] - part))[:2]
        if len(closest) < 2 or closest[0][0] == part:
            return next((zones for known, zones in closest if known == part), None)
        (a, one), (b, other) = closest
        outside = self.turned and part < min(a, b)
        weight = math.log(part / a) / math.log(b / a) if outside else (part - a) / (b - a)
        edges, share = other.ends[[0, -1]], 1.0 - weight
        if outside:
            edges, share = self.previous.zones.ends[[0, -1]], part / a
        x1, x2 = edges + share * (one.ends[[0, -1]] - edges)
        slips, more = (np.log([known.widths[0], known.widths[-1]]) for known in (one, other))
        widths = slips + weight * (more - slips)
        if float(widths.max()) >= math.log(x2 - x1):
            return None
        left, right = np.exp(widths).tolist()
        stick = float(x2 - x1) - left - right
        return Zones(float(x1), (left, stick, right), one.signs) if stick > 0.0 else None

    def loads(self, part: float) -> tuple[float, float]:
        """Q and strain at a part of the step."""
        (dQ, strain), rest = self.after.step, 1.0 - part
        return self.after.Q - rest * dQ, self.after.strain - rest * strain

    def power(self, part: float) -> float | None:
        """∫ f p |dg| dx at a part of the step, per part.

        None soon after a turn where there is no state, as contact that is gained sticks first.
        """
        if self.turned and part < self.lost[0]:
            return None
        state = self._found(part)
        if state is None and self.turned and part < SMALL:
            self.lost[0] = part
            return None
        if state is None or state.pieces.signs != self._ending.signs:
            raise _unknown()
        return power(state, *self.after.step)

    def _found(self, part: float) -> State | None:
        """The state at a part of the step, roughly."""
        state, loads = self._settled(part, self.near(part)), self.loads(part)
        if state is None:
            state = self._settled(part, guess(self.base, *loads))
        if state is None:
            found = self.previous.stepped(*loads)
            if found is None or (found.base or found.before) is not self.base:
                return None
            state = found.state
        self._keep(part, state)
        return state

    def _keep(self, part: float, state: State) -> None:
        if all(abs(part - other) > CLOSE * part for other, _ in self.known):
            insort(self.known, (part, zones_of(state)))

    def _settled(self, part: float, start: Zones | None) -> State | None:
        return settled(self.question(part), start, self.marks, ROUGHLY) if start else None

    def _zones(self, part: float) -> Zones:
        state = self._found(part)
        if state is None:
            raise _unknown()
        return zones_of(state)


def power(state: State, dQ: float, strain: float) -> float:
    """∫ f p |dg| dx of a rate."""
    at, growth = state.rates(dQ, strain)
    slip = slip_along(state, at, growth - strain)
    lost = at.weight * state.question.friction * state.pressure_in_slip(at) * slip
    if lost[lost < 0.0].sum() < -TURNED * lost.sum():
        raise _unknown()
    return float(lost.sum())


def _summed(way: Way, first: float, last: float, total: float) -> float:
    """The integral of the power over a part of a step, beside that over others."""
    rough, values = (first > 0.0 or way.turned, last < 1.0 or way.returns), dict[float, float]()
    sums: list[float] = []
    for n in INTERVALS:
        sums.append((last - first) * _sum_of_rule(way, (first, last), rough, values, n))
        if not values:
            return _up_to_an_early_mark(way, last, total)
        if len(sums) > 1 and _error(sums) <= PROMISED * (sums[-1] + total):
            return sums[-1]
    raise _unknown()


def _up_to_an_early_mark(way: Way, last: float, total: float) -> float:
    """The integral up to a mark that is passed so soon after a turn that no state is found before.

    The power grows there: half of that at the mark is as far off as half of it.
    """
    power = way.power(last)
    if power is None or last * power > PROMISED * total:
        raise _unknown()
    return 0.5 * last * power


def _error(sums: list[float]) -> float:
    """Of the last sum: the difference from the one before, or less where differences fall."""
    last = abs(sums[-1] - sums[-2])
    before = abs(sums[-2] - sums[-3]) if len(sums) > 2 else 0.0
    return last * min(1.0, last / before) if before else last


def _sum_of_rule(
    way: Way,
    ends: tuple[float, float],
    rough: tuple[bool, bool],
    values: dict[float, float],
    n: int,
) -> float:
    """The mean power with n intervals of the rule; `values` keeps the powers."""
    v, weight = _clenshaw_curtis(n)
    s, slope = _flattened(v, *rough)
    inside = ((s > NARROW) | (not rough[0])) & ((s < 1.0 - NARROW) | (not rough[1]))
    for part in s[inside][::-1].tolist():
        if part not in values:
            power = way.power(ends[0] + (ends[1] - ends[0]) * part)
            if power is not None:
                values[part] = power
    if not values:
        return 0.0
    return float(weight * slope @ _filled(s, values, ends[0] == 0.0 and way.turned))


def _filled(s: Array, values: dict[float, float], turned: bool) -> Array:
    """Powers, of which those that are not known are told from the others.

    After a turn they go on as a power of the part.
    """
    known = np.array(sorted(values))
    powers = np.array([values[part] for part in known.tolist()])
    filled: Array = np.interp(s, known, powers)
    if turned and len(known) > 1:
        lower = (s < known[0]) & (s > 0.0)
        exponent = math.log(powers[1] / powers[0]) / math.log(known[1] / known[0])
        filled[lower] = powers[0] * (s[lower] / known[0]) ** max(exponent, 0.0)
    return filled


def _flattened(v: Array, at_first: bool, at_last: bool) -> tuple[Array, Array]:
    """The part of an interval and its derivative, which vanish to some order at rough ends."""
    if at_first and at_last:
        return v**3 * (10.0 - 15.0 * v + 6.0 * v**2), 30.0 * (v * (1.0 - v)) ** 2
    if at_first:
        return v**FLATNESS, FLATNESS * v ** (FLATNESS - 1)
    if at_last:
        return 1.0 - (1.0 - v) ** FLATNESS, FLATNESS * (1.0 - v) ** (FLATNESS - 1)
    return v, np.ones(len(v))


def _clenshaw_curtis(n: int) -> tuple[Array, Array]:
    """Nodes and weights on (0, 1), with n intervals."""
    k = np.arange(n + 1)
    angle, m = math.pi * k / n, np.arange(1, n // 2 + 1)
    factor = np.where(m == n // 2, 1.0, 2.0) / (4.0 * m**2 - 1.0)
    weight = (1.0 - np.cos(2.0 * np.outer(angle, m)) @ factor) / n
    weight[[0, -1]] *= 0.5
    return np.sin(0.5 * angle) ** 2, weight


def _unknown() -> ContactError:
    return ContactError(
        "the energy of this step is a sum over states on the way, of which one was not found, or "
        "is known to less than 1e-6; give the step in two parts"
    )
