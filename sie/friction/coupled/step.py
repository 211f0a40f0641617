"""A step of Q and bulk stress at constant P: the state after it, with a verdict.

After a turn of the loads everything sticks; then slip begins at both edges, and the ends of the
stick zone recede. Such a state follows from the gradient that was locked in alone, whatever the
length of the step. It is accepted if friction holds at every place: |q| <= f p in stick, p >= 0,
and slip along q wherever the bodies slip.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .fields import Fields, cumulative, summed
from .pieces import Places
from .search import Zones, settled, zones_between
from .state import Question, State

Array = NDArray[np.float64]

NEAR = 0.05  # of f P, and of the largest f p
CLOSED = 1e-12  # of f P: loads that are the same
TOLERATED = 1e-9  # of the largest f p, and of the largest slip: what the verdict forgives
HALVINGS = 3  # of a step whose end is not found at once
WIDTHS = (0.02, 0.1, 0.3, 0.6)  # of half a contact: slip zones that a bulk stress may open


@dataclass(frozen=True, eq=False)
class Loaded:
    """A state of a contact under P, in the frame where β > 0.

    fields      p, q, γ
    Q, strain   Q, and the strain of bulk stress times E*/2
    before      the state in which the loads turned last, None under P alone
    step        changes of Q and strain since the point before
    friction    f; under P alone, that of a state may be smaller where nothing would slip
    base        the state from which the last step was solved, if not `before`
    """

    fields: Fields
    Q: float
    strain: float
    before: Loaded | None = None
    step: tuple[float, float] = (0.0, 0.0)
    friction: float = 0.0
    base: Loaded | None = None

    @property
    def state(self) -> State:
        return self.fields.state

    @property
    def question(self) -> Question:
        return self.state.question

    @cached_property
    def zones(self) -> Zones:
        pieces = self.state.pieces
        return Zones(pieces.left, pieces.widths, pieces.signs)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places where γ is not smooth: ends of zones, and marks within the stick zone."""
        inside = {m for m in self.state.pieces.marks for lo, hi in self.zones.stick if lo < m < hi}
        return tuple(sorted({*inside, *self.zones.ends.tolist()[1:-1]}))

    def stepped(self, Q: float, strain: float, halvings: int = HALVINGS) -> Loaded | None:
        """The state under other loads; None where no zones keep the friction law.

        Where none is found at once, the step is halved. Slip may go on in the present zones, from
        what was locked in when it began; else the loads turn, and everything sticks first.
        """
        if Q == self.Q and strain == self.strain:
            return self
        step = Q - self.Q, strain - self.strain
        back = self.returned(Q, strain)
        if back is not None:
            return back
        if self.before is not None and self._farther(Q, strain) > 1.0:
            state = settled(self.before.asked(Q, strain), self.ahead(Q, strain), self.before.marks)
            after = (
                Loaded(Fields(state), Q, strain, self.before, step, self.friction)
                if state
                else None
            )
            if after is not None and after.verdict.holds and after.within(self):
                return after
        for signs in patterns(*step):
            for state in candidates(self, Q, strain, signs):
                after = Loaded(Fields(state), Q, strain, self, step, self.friction)
                if after.verdict.holds:
                    return after
        if not halvings:
            return None
        half = self.stepped(self.Q + 0.5 * step[0], self.strain + 0.5 * step[1], halvings - 1)
        found = half.stepped(Q, strain, 0) if half is not None else None
        return replace(found, step=step) if found is not None else None

    def ahead(self, Q: float, strain: float) -> Zones:
        """The zones if slip goes on, which widen about as the loads since the turn."""
        left, stick, right = self.zones.widths
        grown = min(self._farther(Q, strain), 1.0 + 0.5 * stick / (left + right))
        more = (grown - 1.0) * (left + right)
        return Zones(self.zones.left, (grown * left, stick - more, grown * right), self.zones.signs)

    def _farther(self, Q: float, strain: float) -> float:
        """How far other loads are from where the loads turned, over how far these are."""
        assert self.before is not None
        unit = self.friction * self.question.P / self.peak
        now, then = (
            abs(load - self.before.Q) + unit * abs(other - self.before.strain)
            for load, other in ((Q, strain), (self.Q, self.strain))
        )
        return now / then

    @property
    def peak(self) -> float:
        """The largest f p."""
        return self.friction * float(self.fields.nodes[1][0].max())

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
                    base = self.before if self.turned_from(turn) else self
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

    def near(self, other: Loaded, Q: float, strain: float) -> bool:
        """Whether loads are next to those of another state."""
        unit = self.friction * self.question.P
        return abs(Q - other.Q) <= NEAR * unit and abs(strain - other.strain) <= NEAR * self.peak

    def turned_from(self, turn: Loaded) -> bool:
        """Whether the loads are on their way back to that state already."""
        return self.before is not turn

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

    @cached_property
    def verdict(self) -> Verdict:
        return verdict(self)


def patterns(dQ: float, strain: float) -> Iterator[tuple[int, ...]]:
    """Signs of zones, the likelier first."""
    s, t = (1 if dQ > 0.0 else -1), (1 if strain > 0.0 else -1)
    if dQ:
        yield s, 0, s
    if strain:
        yield t, 0, -t


def candidates(now: Loaded, Q: float, strain: float, signs: tuple[int, ...]) -> Iterator[State]:
    """States under a load from several starts."""
    question = now.asked(Q, strain)
    for turn in now.turns:  # next to loads that were there before, zones are next to those then
        if turn.zones.signs == signs and now.near(turn, Q, strain):
            state = settled(question, turn.zones, now.marks)
            if state is not None:
                yield state
    if signs[0] == signs[-1]:
        way = Approach(now, signs[0], strain)
        state = way.direct(Q)
        if state is not None:
            yield state
        return
    ends = now.zones.ends
    for part in WIDTHS:
        inner = 0.5 * part * (ends[-1] - ends[0])
        places = np.array([ends[0], ends[0] + inner, ends[-1] - inner, ends[-1]])
        state = settled(question, zones_between(places, signs), now.marks)
        if state is not None:
            yield state


class Approach:
    """Starts for slip of one sign at both edges, between the present state and sliding."""

    def __init__(self, now: Loaded, sign: int, strain: float) -> None:
        self.now, self.sign, self.strain = now, sign, strain
        self.limit = sign * now.friction * now.question.P

    def part(self, Q: float) -> float:
        """How far Q is on the way to sliding."""
        return (Q - self.now.Q) / (self.limit - self.now.Q)

    @cached_property
    def sliding(self) -> State | None:
        """The state of full sliding."""
        question = self.now.asked(self.limit, self.strain)
        ends = self.now.zones.ends
        return settled(question, zones_between(ends[[0, -1]], (self.sign,)), ())

    @cached_property
    def last_stick(self) -> tuple[float, float]:
        """The place that slips least, and the half-length of stick from which sliding is near."""
        assert self.sliding is not None
        lo, hi = self.bounds
        x = lo + (hi - lo) * np.linspace(0.0, 1.0, 203)[1:-1]
        inside = (x > self.sliding.pieces.ends[0]) & (x < self.sliding.pieces.ends[-1])
        x = x[inside]
        question = self.now.asked(self.limit, self.strain)
        slips = self.sign * (Fields(self.sliding).gamma(x) - question.gamma(x))
        k = int(np.argmin(np.cumsum((slips[1:] + slips[:-1]) * np.diff(x)))) + 1
        k = k if slips[k] > 0.0 else min(k + 1, len(x) - 1)
        rise = (slips[k] - slips[k - 1]) / (x[k] - x[k - 1])
        missing = abs(self.limit - self.now.Q)
        if rise <= 0.0:
            return float(x[k]), 0.5 * (hi - lo)
        x0 = float(np.clip(x[k] - slips[k] / rise, x[0], x[-1]))
        return x0, math.sqrt(2.0 * missing / (math.pi * rise))

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """What the stick zone stays between."""
        lo, hi = self.now.zones.ends[[0, -1]].tolist()
        slip = self.now.zones.slip
        if slip[0][2] == self.sign:
            lo = slip[0][1]
        if slip[-1][2] == self.sign:
            hi = slip[-1][0]
        return lo, hi

    def start(self, Q: float) -> Zones | None:
        """Zones next to those under Q."""
        if self.sliding is None:
            return None
        part, (lo, hi), (x0, half) = self.part(Q), self.bounds, self.last_stick
        left, right = min(half, x0 - lo), min(half, hi - x0)
        cos, sin = math.sqrt(1.0 - part), math.sqrt(part)
        e1 = x0 - cos * (left + (x0 - lo - left) * (1.0 - sin))
        e2 = x0 + cos * (right + (hi - x0 - right) * (1.0 - sin))
        old, new = self.now.zones.ends[[0, -1]], self.sliding.pieces.ends
        x1, x2 = old + part * (new - old)
        least = 1e-9 * (x2 - x1)
        e1, e2 = max(e1, x1 + least), min(e2, x2 - least)
        if not x1 < e1 < e2 < x2:
            return None
        return zones_between(np.array([x1, e1, e2, x2]), (self.sign, 0, self.sign))

    def direct(self, Q: float) -> State | None:
        """The state next to a start, if it is found."""
        question = self.now.asked(Q, self.strain)
        for start in (self.start, self.nested):
            zones = start(Q)
            state = settled(question, zones, self.now.marks) if zones is not None else None
            if state is not None:
                return state
        return None

    def nested(self, Q: float) -> Zones | None:
        """Zones that stick where the bodies would touch under what is left of P, as for β = 0."""
        if self.sliding is None:
            return None
        left = 1.0 - self.part(Q)
        lighter = self.now.asked(left * self.limit, self.strain)._replace(
            P=left * self.now.question.P
        )
        inner = settled(lighter, zones_between(self.sliding.pieces.ends, (self.sign,)), ())
        if inner is None:
            return None
        old, new = self.now.zones.ends[[0, -1]], self.sliding.pieces.ends
        x1, x2 = old + (1.0 - left) * (new - old)
        (lo, hi), least = self.bounds, 1e-9 * (x2 - x1)
        e1 = max(float(inner.pieces.ends[0]), lo + least, x1 + least)
        e2 = min(float(inner.pieces.ends[1]), hi - least, x2 - least)
        if not x1 < e1 < e2 < x2:
            return None
        return zones_between(np.array([x1, e1, e2, x2]), (self.sign, 0, self.sign))


def _unknowns(state: State) -> Array:
    return np.append(state.pieces.left, np.log(state.pieces.widths))


def _zones(u: Array, signs: tuple[int, ...]) -> Zones:
    return Zones(float(u[0]), tuple(np.exp(u[1:]).tolist()), signs)


@dataclass(frozen=True)
class Verdict:
    """How far a state is from the friction law; all are 0 or more where it is kept.

    deficit     the least f p - |q| in stick, over the largest f p
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
    deficit = float((f * p - np.abs(q))[sticks].min()) / (f * peak)
    slip = rate = 0.0
    if after.before is not None:
        before = after.before
        lo, hi = before.zones.ends[[0, -1]]
        touched = (at.x >= lo) & (at.x <= hi)
        change = np.zeros(len(at.x))
        change[touched] = gamma[touched] - before.fields.gamma(at.x[touched])
        change[touched] -= after.strain - before.strain
        slip = least_along(after.state, at.chosen(touched), change[touched])
        rates = after.state.rates(*after.step)
        rate = least_along(after.state, rates.at, rates.gamma - after.step[1])
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
