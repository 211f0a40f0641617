"""A step of Q and bulk stress at constant P: the state after it, with a verdict.

After a turn of the loads everything sticks; then slip begins at both edges, and the ends of the
stick zone recede. Such a state follows from the gradient that was locked in alone, whatever the
length of the step. It is accepted if friction holds at every place: |q| <= f p in stick, p >= 0,
and slip along q wherever the bodies slip.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .fields import Fields, cumulative, summed
from .search import (
    ROUGHLY,
    Carried,
    Zones,
    cuts_between,
    settled,
    zones_between,
    zones_of,
    zones_on_cells,
)

if TYPE_CHECKING:
    from .pieces import Places
    from .state import Question, State

Array = NDArray[np.float64]

CLOSED = 1e-12  # of f P: loads that are the same
TOLERATED = 1e-9  # of the largest f p, and of the largest slip: what the verdict forgives
ON_THE_WAY = 0.8, 0.9  # parts of a step, from which zones go on to its end
AWAY = 0.05  # of the stick zone: how far its ends go about, times the root of the part of f P


@dataclass(frozen=True, eq=False)
class Loaded:
    """A state of a contact under P, in the frame where β > 0.

    fields      p, q, γ
    Q, strain   Q, and the strain of bulk stress times E*/2
    before      the state in which the loads turned last, None under P alone
    step        changes of Q and strain since the point before
    friction    f; under P alone, that of a state may be smaller where nothing would slip
    base        the state from which the last step was solved, if not `before`
    halfway     the state on a step in which a loop closed, after which `step` is counted
    """

    fields: Fields
    Q: float
    strain: float
    before: Loaded | None = None
    step: tuple[float, float] = (0.0, 0.0)
    friction: float = 0.0
    base: Loaded | None = None
    halfway: Loaded | None = None

    @property
    def state(self) -> State:
        return self.fields.state

    @property
    def question(self) -> Question:
        return self.state.question

    @cached_property
    def zones(self) -> Zones:
        return zones_of(self.state)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places where γ is not smooth: ends of zones, and marks within the stick zone."""
        inside = {m for m in self.state.pieces.marks for lo, hi in self.zones.stick if lo < m < hi}
        return tuple(sorted({*inside, *self.zones.ends.tolist()[1:-1]}))

    def stepped(self, Q: float, strain: float) -> Loaded | None:
        """The state under other loads; None where no zones keep the friction law.

        Slip may go on in the present zones, from what was locked in when it began; else the loads
        turn, and everything sticks first. A step that passes loads at which they turned closes a
        loop there, and goes on as before it.
        """
        if Q == self.Q and strain == self.strain:
            return self
        back = self.returned(Q, strain)
        if back is not None:
            return back
        way = self._closed(Q, strain)
        beyond = way.stepped(Q, strain) if way is not None else None
        if beyond is not None:
            return replace(beyond, halfway=way)
        goes_on = self.before is not None and self._farther(Q, strain) > 1.0
        for base in (self.before, self) if goes_on else (self,):
            assert base is not None
            state = base.reached(Q, strain)
            if state is not None:
                step = Q - self.Q, strain - self.strain
                after = Loaded(Fields(state), Q, strain, base, step, self.friction)
                if after.verdict.holds and (base is self or after.within(self)):
                    return after
        return None

    def reached(self, Q: float, strain: float) -> State | None:
        """The state under other loads if all that sticks then sticks now, not yet a verdict on it.

        Where Newton's method fails from a guess, zones go on as between two parts of the way.
        """
        question = self.asked(Q, strain)
        start = guess(self, Q, strain)
        state = settled(question, start, self.marks) if start else None
        if state is not None:
            return state
        ends, signs = [], set()
        for part in ON_THE_WAY:
            loads = self.Q + part * (Q - self.Q), self.strain + part * (strain - self.strain)
            start = guess(self, *loads)
            state = settled(self.asked(*loads), start, self.marks, ROUGHLY) if start else None
            if state is None:
                return None
            ends.append(state.pieces.ends)
            signs.add(state.pieces.signs)
        ahead = 2.0 * ends[1] - ends[0]
        if len(signs) > 1 or not (np.diff(ahead) > 0.0).all():
            return None
        return settled(question, zones_between(ahead, signs.pop()), self.marks)

    def _closed(self, Q: float, strain: float) -> Loaded | None:
        """The last state in which the loads turned on the way to others, if a loop closes there."""
        step = np.array([Q - self.Q, strain - self.strain])
        for turn in self.turns:
            ahead = np.array([turn.Q - self.Q, turn.strain - self.strain])
            part = float(ahead @ step) / float(step @ step)
            off = float(np.abs(ahead - part * step).max())
            if 0.0 < part < 1.0 and off <= CLOSED * np.abs(step).max():
                return self.returned(turn.Q, turn.strain)
        return None

    def _farther(self, Q: float, strain: float) -> float:
        """How far other loads are from where the loads turned, over how far these are."""
        assert self.before is not None
        unit = sum(self.zones.widths)
        now, then = (
            abs(load - self.before.Q) + unit * abs(other - self.before.strain)
            for load, other in ((Q, strain), (self.Q, self.strain))
        )
        return now / then

    def returned(self, Q: float, strain: float) -> Loaded | None:
        """The earlier state under the same loads, if the loads closed a loop since then.

        What sticks there must be what it was; then what slipped since slipped back.
        """
        for turn in self.turns:
            same = abs(turn.Q - Q) <= CLOSED * self.friction * self.question.P
            if same and turn.strain == strain:
                at, (_, _, gamma) = turn.fields.nodes
                sticks = turn.state.sticks(at)
                change = gamma[sticks] - self.fields.gamma(at.x[sticks]) - (strain - self.strain)
                if float(np.abs(change).max()) <= TOLERATED * float(np.abs(gamma).max()):
                    step = Q - self.Q, strain - self.strain
                    base = self if self.before is turn else self.before
                    return replace(turn, step=step, base=base)
        return None

    @property
    def turns(self) -> tuple[Loaded, ...]:
        """The states, after that under P alone, in which the loads turned; the last one first."""
        found, turn = [], self.before
        while turn is not None and turn.before is not None:
            found.append(turn)
            turn = turn.before
        return tuple(found)

    def within(self, other: Loaded) -> bool:
        """Whether only what stuck there sticks."""
        (lo, hi), (first, last) = self.zones.stick[0], other.zones.stick[0]
        apart = TOLERATED * (last - first)
        return lo >= first - apart and hi <= last + apart

    def asked(self, Q: float, strain: float) -> Question:
        """The question of another load with what is locked in now."""
        change = strain - self.strain
        gamma = self.fields.gamma
        return self.question._replace(
            friction=self.friction, Q=Q, gamma=lambda x: gamma(x) + change
        )

    @property
    def first(self) -> Loaded:
        """The state under P alone."""
        state = self
        while state.before is not None:
            state = state.before
        return state

    @cached_property
    def _sliding(self) -> dict[int, Fields | None]:
        return {}

    def sliding(self, sign: int) -> Fields | None:
        """The fields, roughly, of full sliding under the same P, which no history matters to."""
        first = self.first
        if sign not in first._sliding:
            question = first.asked(sign * self.friction * self.question.P, 0.0)
            start = zones_between(first.zones.ends[[0, -1]], (sign,))
            state = settled(question, start, (), ROUGHLY)
            first._sliding[sign] = Fields(state) if state is not None else None
        return first._sliding[sign]

    @cached_property
    def verdict(self) -> Verdict:
        return verdict(self)


@dataclass(frozen=True)
class Verdict:
    """How far a state is from the friction law; all are 0 or more where it is kept.

    deficit     the least f p - |q| in stick, over the largest f p; -1 where bodies would stick that
                did not touch before
    pressure    the least p, over the largest
    slip        the least slip along q since the state before, over the largest
    rate        the least rate of slip along q, over the largest
    """

    deficit: float
    pressure: float
    slip: float
    rate: float

    @property
    def worst(self) -> float:
        return min(self.deficit, self.pressure, self.slip, self.rate)

    @property
    def holds(self) -> bool:
        return self.worst >= -TOLERATED


def verdict(after: Loaded) -> Verdict:
    """The friction law, place by place."""
    f, (at, (p, q, gamma)) = after.question.friction, after.fields.nodes
    peak, sticks = float(p.max()), after.state.sticks(at)
    at_marks = after.fields(np.array(after.marks))  # too near to them nodes are not looked at
    least = [(f * rows[0] - np.abs(rows[1])).min() for rows in ((p[sticks], q[sticks]), at_marks)]
    deficit = float(min(least)) / (f * peak)
    slip = rate = 0.0
    if after.before is not None:
        before = after.before
        lo, hi = before.zones.ends[[0, -1]]
        touched = (at.x >= lo) & (at.x <= hi)
        deficit = deficit if touched[sticks].all() else -1.0
        change = np.zeros(len(at.x))
        change[touched] = gamma[touched] - before.fields.gamma(at.x[touched])
        change[touched] -= after.strain - before.strain
        slip = least_along(after.state, at.chosen(touched), change[touched])
        slips, growth = after.state.rates(*after.step)
        rate = least_along(after.state, slips, growth - after.step[1])
    return Verdict(deficit, float(p.min()) / peak, slip, rate)


def least_along(state: State, at: Places, gamma: Array) -> float:
    """The least slip along q of a gradient at nodes, over the largest."""
    slip = slip_along(state, at, gamma, summed)
    largest = float(np.abs(slip).max(initial=0.0))
    return float(slip.min(initial=0.0)) / largest if largest else 0.0


def slip_along(
    state: State, at: Places, gamma: Array, total: Callable[[Array], Array] = cumulative
) -> Array:
    """∫γ dx from the stick zone, along q, at the nodes in slip zones at the edges."""
    out = []
    last = len(state.pieces.signs) - 1
    for zone, sign in ((0, state.pieces.signs[0]), (last, state.pieces.signs[last])):
        own = at.zone == zone
        step = at.weight[own] * gamma[own]
        # towards the left edge the sum runs from the right
        grown = -total(step[::-1])[::-1] if zone == 0 else total(step)
        out.append(sign * grown)
    return np.concatenate(out)


def guess(base: Loaded, Q: float, strain: float) -> Zones | None:
    """Zones next to those under other loads, from cells."""
    old, dQ, P = base.zones.ends[[0, -1]], Q - base.Q, base.question.P
    states, sliding = [(1.0, base.fields, old)], None
    if dQ:
        sign = 1 if dQ > 0.0 else -1
        limit = sign * base.friction * P
        part = dQ / (limit - base.Q)
        sliding = base.sliding(sign)
        if sliding is not None:
            states = [(1.0 - part, base.fields, old)]
            states.append((part, sliding, sliding.state.pieces.ends))
    x1, x2 = np.sum([part * ends for part, _, ends in states], axis=0).tolist()
    cuts = cuts_between(x1, x2)
    x = 0.5 * (cuts[1:] + cuts[:-1])
    p, q = np.zeros(len(x)), np.zeros(len(x))
    for part, fields, (lo, hi) in states:
        stretch = (hi - lo) / (x2 - x1)
        p += part * stretch * fields(lo + stretch * (x - x1))[0]
    touched = (x > old[0]) & (x < old[1])
    q[touched] = base.fields(x[touched])[1]
    carried = Carried(cuts, base.friction * p, q)
    found = zones_on_cells(carried, dQ, strain - base.strain)
    if found is None:
        return nearly_sliding(base, (Q, strain), sliding) if sliding is not None else None
    return kept_within(found, base.zones, abs(dQ) / (base.friction * P))


def nearly_sliding(base: Loaded, loads: tuple[float, float], sliding: Fields) -> Zones | None:
    """Zones of a Q next to sliding: what slips least then sticks, over a length like a root."""
    question, (sign,) = base.asked(*loads), sliding.state.pieces.signs
    lo, hi = sliding.state.pieces.ends
    x = lo + (hi - lo) * np.linspace(0.0, 1.0, 203)[1:-1]
    x = x[(x > base.zones.ends[0]) & (x < base.zones.ends[-1])]
    slips = sign * (sliding.gamma(x) - question.gamma(x))
    k = int(np.argmin(np.cumsum((slips[1:] + slips[:-1]) * np.diff(x)))) + 1
    k = k if slips[k] > 0.0 else min(k + 1, len(x) - 1)
    rise = (slips[k] - slips[k - 1]) / (x[k] - x[k - 1])
    if rise <= 0.0:
        return None
    x0 = float(np.clip(x[k] - slips[k] / rise, x[0], x[-1]))
    left = sign * base.friction * question.P - question.Q
    half = math.sqrt(2.0 * abs(left) / (math.pi * rise))
    ends = np.array([lo, max(x0 - half, 0.5 * (lo + x0)), min(x0 + half, 0.5 * (hi + x0)), hi])
    return zones_between(ends, (sign, 0, sign))


def kept_within(found: Zones, old: Zones, part: float) -> Zones:
    """Zones where slip that goes on with its sign begins at the old end of stick.

    That end leaves its place like the root of the load.
    """
    ends, away = found.ends.copy(), AWAY * math.sqrt(part) * (old.stick[0][1] - old.stick[0][0])
    if found.signs[0] == old.signs[0]:
        ends[1] = min(max(ends[1], old.ends[1] + away), 0.5 * (ends[1] + ends[2]))
    if found.signs[-1] == old.signs[-1]:
        ends[-2] = max(min(ends[-2], old.ends[-2] - away), 0.5 * (ends[-2] + ends[-3]))
    return zones_between(ends, found.signs) if (np.diff(ends) > 0.0).all() else found
