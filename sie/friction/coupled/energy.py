"""Energy that dissimilar bodies dissipate while Q grows at constant P.

It is the integral over Q of the power of friction, ∫f p ġ dx over both slip zones with ġ that of
`slip_rate`. With Q = f P sin²φ the power is smooth at Q = 0; next to f P it holds c ln c,
c = cos φ, of the stick zone that vanishes there. So the integral is taken over u,

    φ = π/2 (1 - (1 - u)³),       dQ/du = 3π/2 f P (1 - u)² sin 2φ,

by Clenshaw and Curtis' rule with twice as many parts until the sum settles. Where an edge of the
contact or of the stick zone passes a kink of γ or of the profile, a panel ends, and the nodes crowd
towards it like a cube. Next to Q = 0 the zones are narrow, or no state has them: there the
polynomial of the first panel is continued, and what the left slip zone may change where no state is
known is bounded. Each state is found from those that are known.

Source: Trefethen, Approximation Theory and Approximation Practice (2013), ch. 19.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.root_finding import false_position
from sie.problem.coverage import refused_slip
from sie.progress_bar import reported, step_done

from .integral import RATIO, integral, towards_ends
from .iteration import next_to
from .sheared import ShearedContact
from .slip_rate import LEVELS, SlipRate
from .tangential import Trial

Array = NDArray[np.float64]

CERTIFIED, WANTED = 1e-6, 5e-7  # of the energy: the error that is allowed, and aimed at
# The same of what surfaces may do under loads without a state, by a bound on it
UNSOLVED = 1e-6
# Of u: where the first panel begins, and may begin where smaller loads have no state
START, LATER = 0.03, (0.3, 0.2, 0.13, 0.09, 0.06)
PARTS, LEAST = (3, 6, 12, 24), 12  # of a panel, and of the last one
TRUSTED = 0.02  # how much closer a sum may be taken to be than the one with half as many parts
MOST = 200  # states
SETTLED = 1e-7  # of the conditions on the edges, before a last step
SMALL = 1e-2  # of the room of an edge: a last step
NEIGHBOURS = 5  # known states: edges are those of the polynomial through these
FEW = 6  # kinks passed by an edge that are found
# Of the way of an edge: kinks passed earlier cost more panels than they save; how well others are
# found
EARLY, PLACED = 0.1, 1e-4
TOGETHER = 1e-3  # of u: kinks passed at once


class PassedState(ShearedContact):
    """A state on the way, whose trial is as fine as the power of friction needs."""

    @property
    def state(self) -> Trial:
        return self.trial


class Growth:
    """The states while Q grows from 0 to that of a given state.

    `found` finds that under a Q, in the frame, where none is known next to it.
    """

    def __init__(self, state: ShearedContact, found: Callable[[float], ShearedContact]) -> None:
        self.state, self.search, self.found = state, state.search, found
        angle = math.asin(min(math.sqrt(state.Q / self.search.limit), 1.0))
        self.end = 1.0 - math.cbrt(1.0 - angle / (0.5 * math.pi))
        self.first, self.last = self.search.first_edges, state.trial
        self._known: dict[float, tuple[Array, Array | None]] = {self.end: (self.last.edges, None)}

    @property
    def states(self) -> int:
        """How many are known."""
        return len(self._known)

    def load(self, u: float) -> float:
        return self.search.limit * math.sin(0.5 * math.pi * (1.0 - (1.0 - u) ** 3)) ** 2

    def edges(self, u: float) -> Array:
        """The edges at u, after a last linear step."""
        if u not in self._known:
            step_done()
            near = sorted(self._known, key=lambda v: abs(v - u))[:NEIGHBOURS]
            slopes, root, Q = self._known[near[0]][1], None, self.load(u)
            for few in (len(near), 1):
                edges = np.array([self._known[v][0] for v in near[:few]])
                guess = _interpolation(np.array(near[:few]), u) @ edges
                root = root or next_to(self.search, guess, Q, slopes, SETTLED)
            if root and root.slopes is not None:
                step = np.linalg.solve(root.slopes, root.trial.missed)
                # Next to a corner of the profile derivatives may belong to other edges
                if (np.abs(step) < SMALL * self.search.room(root.trial.edges)).all():
                    self._known[u] = root.trial.edges - step, root.slopes
            if u not in self._known:
                self._known[u] = self.found(Q).trial.edges, None
        return self._known[u][0]

    def rate(self, u: float) -> float:
        """dW/du E*/2."""
        passed = self.passed_state(u)
        if self.search.corners and passed.least_deficit < -CERTIFIED:
            raise refused_slip(self.search.beta * self.state.friction, passed.Q / self.search.limit)
        angle = 0.5 * math.pi * (1.0 - (1.0 - u) ** 3)
        grown = 1.5 * math.pi * self.search.limit * (1.0 - u) ** 2 * math.sin(2.0 * angle)
        return grown * _power(passed)

    def passed_state(self, u: float) -> PassedState:
        """The state at u."""
        Q, edges, state = self.load(u), self.edges(u), self.state
        trial = self.search.trial(edges, Q, RATIO**-LEVELS * float(np.diff(edges).min()))
        return PassedState(self.search, trial, Q, state.sign, state.flip)

    def carried_on_left(self, u: float) -> float:
        """What friction carries in the left slip zone at u."""
        state = self.passed_state(u)
        cuts = towards_ends(state.trial.zones.x1, state.trial.zones.e1, state.search.gamma.cuts)
        carried = integral(state.frame_pressure, cuts)
        return state.friction * float(carried(cuts[-1:])[0])

    @cached_property
    def passed(self) -> list[float]:
        """u where an edge passes a kink, descending."""
        normal, last = self.search.normal, self.last.edges
        breaks = np.abs(self.search.slope.breaks)
        places = np.unique(np.concatenate((normal.marks, breaks)))
        places = np.unique(np.concatenate((-places, [0.0], places)))
        events = []
        for j in range(4):
            gone = (places - self.first[j]) / (last[j] - self.first[j])
            inside = places[(gone > EARLY) & (gone < 1.0)]
            events += [(j, place) for place in inside[: FEW + 1].tolist()]
        found = (
            sorted((self._passing(*e) for e in events), reverse=True) if len(events) <= FEW else []
        )
        ends = [self.end, *found]
        return [
            u for u, before in zip(found, ends, strict=False) if before - u > TOGETHER * self.end
        ]

    def _passing(self, j: int, place: float) -> float:
        """u where the edge j is at the place."""
        first, last = self.first[j], self.last.edges[j]
        way, ends = (
            last - first,
            ((first - place) / (last - first), (last - place) / (last - first)),
        )
        return false_position(
            lambda u: (float(self.edges(u)[j]) - place) / way,
            0.0,
            self.end,
            ends,
            lambda a, b, missed: abs(missed) < PLACED,
        )


def _power(state: ShearedContact) -> float:
    """E*/2 ∫f p ġ dx over both slip zones: ∫γ̇ N dx, N what friction carries from x to the edge.

    Raises ContactError where slip would oppose Q.
    """
    rate, zones = SlipRate(state.trial.zones, state.search.beta, state.friction), state.trial.zones
    if rate.least < 0.0:
        raise ContactError(f"slip would oppose Q under Q = {state.Q:.6g}")
    return sum(_power_of_zone(state, rate, *zone) for zone in zones.slipping)


def _power_of_zone(
    state: ShearedContact, rate: SlipRate, side: float, stick: float, edge: float
) -> float:
    lo, hi = min(stick, edge), max(stick, edge)
    cuts = state.search.gamma.cuts
    near = 0.5 * (hi - lo) * RATIO ** -np.arange(LEVELS, -0.5, -1.0)
    inner = cuts[(cuts > lo) & (cuts < hi)]
    ends = np.concatenate(([lo], lo + near, hi - near, [hi], inner))
    carried = integral(state.frame_pressure, np.unique(ends))
    from_stick, from_edge, weight = rate.rule(side)
    x = stick + side * from_stick
    N = carried(x) if side < 0.0 else carried(np.array([hi])) - carried(x)
    gradient = rate.gradient(side, from_stick, from_edge)
    return side * state.friction * float((weight * gradient) @ N)


@reported("dissipated energy, state")
def tangential_energy(state: ShearedContact, found: Callable[[float], ShearedContact]) -> float:
    """The energy dissipated while Q grew at constant P; `found` gives the state under another Q.

    Raises ContactError where the states found give it less surely than to a part CERTIFIED, or
    those that are not found may count more than UNSOLVED.
    """
    growth = Growth(state, found)
    try:
        total, error, unsolved = _sum_of_states(growth)
    except ContactError as missing:
        raise ContactError(
            f"the energy that dissimilar bodies dissipate under |Q| = {state.Q:.6g} is a sum over "
            f"the states under smaller loads, and one of them is not found: {missing}"
        ) from missing
    if error > CERTIFIED * total or unsolved > UNSOLVED * total:
        reason = (
            "what surfaces do that come into contact under the smallest of these loads is not "
            "solved"
            if unsolved > UNSOLVED * total
            else "zones pass kinks of the profile on the way, or are narrower there than is "
            "resolved; smooth the profile there"
        )
        raise ContactError(
            f"the energy that dissimilar bodies dissipate under |Q| = {state.Q:.6g} is known to "
            f"{(error + unsolved) / total:.1g} of it only, as {reason}; give a larger |Q|, or set "
            "tangential_load = 0 for the energy under the normal load"
        )
    return total / growth.search.normal.half_modulus


def _sum_of_states(growth: Growth) -> tuple[float, float, float]:
    """∫rate over all loads, its error, and what it may err where no state is found.

    Raises ContactError where too many of the states are not.
    """
    first = min([growth.end, *growth.passed])
    growth.rate(LATER[0] * first)
    try:
        return *_integral(growth, START), 0.0
    except ContactError:
        start = LATER[0]
    for part in LATER[1:]:
        try:
            growth.rate(part * first)
        except ContactError:
            break
        start = part
    return *_integral(growth, start), _unsolved(growth, start * first)


def _unsolved(growth: Growth, u: float) -> float:
    """How much the energy may err where states below u are not found.

    Surfaces that stick or slip back in the left slip zone there, where friction carries N, change
    what the rest carries by at most 2 N of Q. W goes with at most the third power of Q, and at
    least with that of u.
    """
    share = growth.carried_on_left(u) / growth.load(u)
    return 3.0 * 2.0 * share * growth.rate(u) * u / 3.0


def _integral(growth: Growth, part: float) -> tuple[float, float]:
    """∫rate from 0 on, and its error, with nodes from a part of the first panel on."""
    ends = [growth.end, *growth.passed]
    ends.append(part * ends[-1])
    panels = [(lo, hi, hi < growth.end, lo > ends[-1]) for hi, lo in pairwise(ends)][::-1]
    total = error = 0.0
    while panels:
        first = len(panels) == 1
        lo, hi, *crowded = panels.pop()
        value, missed = _panel(growth.rate, Panel(lo, hi, *crowded), first, total)
        # From a later start a shorter first panel would be continued farther than it is long
        cut = not first or part == START
        if cut and missed > WANTED * (total + value) and growth.states < MOST:
            middle = 0.5 * (lo + hi)
            below = 0.5 * lo if first else lo
            panels += [(below, middle, False, crowded[1]), (middle, hi, crowded[0], False)]
            continue
        total, error = total + value, error + missed
    return total, error


class Panel(NamedTuple):
    """lo < u < hi as a function of -1 <= t <= 1, whose nodes crowd towards marked ends."""

    lo: float
    hi: float
    at_hi: bool
    at_lo: bool

    def of(self, t: float) -> tuple[float, float]:
        """u and du/dt; exact at the ends."""
        s, length = 0.5 * (1.0 + t), self.hi - self.lo
        rest = 0.5 * (1.0 - t)
        if self.at_lo and self.at_hi:
            part, slope = s**3 * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * rest) ** 2
        elif self.at_lo:
            part, slope = s**3, 3.0 * s * s
        elif self.at_hi:
            part, slope = 1.0 - rest**3, 3.0 * rest * rest
        else:
            part, slope = s, 1.0
        u = self.lo + length * part if t < 1.0 else self.hi
        return u, 0.5 * length * slope

    @property
    def origin(self) -> float:
        """t of u = 0, on a panel that is not crowded at lo."""
        part = -self.lo / (self.hi - self.lo)
        return 1.0 - 2.0 * math.cbrt(1.0 - part) if self.at_hi else 2.0 * part - 1.0


def _panel(
    rate: Callable[[float], float], panel: Panel, first: bool, others: float
) -> tuple[float, float]:
    """∫rate over a panel, from u = 0 if it is the first one, and its error."""
    values: dict[int, float] = {}
    start, found, missed = panel.origin if first else -1.0, [], []
    for parts in PARTS:
        t = -np.cos(math.pi * np.arange(parts + 1) / parts)
        # Those that are nearly always needed in their order, so that each helps to find the next
        least = parts if others else max(parts, LEAST)
        for k in reversed(range(0, PARTS[-1] + 1, PARTS[-1] // least)):
            if k not in values:
                u, slope = panel.of(-math.cos(math.pi * k / PARTS[-1]))
                values[k] = slope * rate(u) if slope else 0.0
        nodes = np.array([values[k] for k in range(0, PARTS[-1] + 1, PARTS[-1] // parts)])
        whole = chebyshev.antiderivative(np.linalg.solve(chebvander(t, parts), nodes))
        found.append(float(whole.sum() - chebyshev.evaluate(whole, start)))
        missed = [abs(b - a) for a, b in pairwise(found)][-2:]
        # What the last doubling changed times how much less that is than the one before
        gain = max(missed[-1] / missed[-2], TRUSTED) if len(missed) == 2 else math.inf
        error = missed[-1] * min(gain, 1.0) if missed else math.inf
        if error <= WANTED * (others + found[-1]):
            break
    return found[-1], error


def _interpolation(x: Array, place: float) -> Array:
    """The weights of values at x in the polynomial through them."""
    apart = x[:, None] - x
    np.fill_diagonal(apart, 1.0)
    ahead = np.where(np.eye(len(x)) > 0.0, 1.0, place - x)
    weights: Array = (ahead / apart).prod(axis=1)
    return weights
