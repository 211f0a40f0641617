"""A stick zone with one end that recedes and an edge of contact that grows and sticks.

The equations are in `growing_edge`. Integrals over the way of the end have nodes that are graded
towards both ends, or that are few where the place is far.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.graded_rule import NODES, graded_angle

from .growing_contact import Course, Rates, divided

Array = NDArray[np.float64]
# Nodes from 0 to 1, their distances from 1, and weights
Rule = tuple[Array, Array, Array]

HALVINGS, NEWTON, TINY = 8, 6, 1e-12  # for w at a time
TOGETHER = 40_000  # values at a time
_g, _w = chebyshev.gauss_legendre(NODES)
_sine, _cosine = np.sin(0.5 * math.pi * _g), np.cos(0.5 * math.pi * _g)
GRADED: Rule = graded_angle()
ROUGH: Rule = (_sine**2, _cosine**2, math.pi * _sine * _cosine * _w)
PLAIN: Rule = (_g**2, (1.0 - _g) * (1.0 + _g), 2.0 * _g * _w)


@dataclass(frozen=True, eq=False)
class Panel:
    """t = time + length w M, M = Σ c_n T_n(2w - 1), w² = (u - start)/length, up to w = `last`."""

    start: float
    length: float
    time: float
    series: Array
    last: float = 1.0

    @property
    def end(self) -> float:
        return self.start + self.length * self.last**2

    @property
    def until(self) -> float:
        """The time at the end."""
        return float(self.times(np.array(self.last)))

    def times(self, w: Array) -> Array:
        grown: Array = self.length * w * chebyshev.evaluate(self.series, 2.0 * w - 1.0)
        return self.time + grown

    def pace(self, w: Array) -> Array:
        """dt/du."""
        pace: Array = chebyshev.evaluate(self._doubled, 2.0 * w - 1.0) / (2.0 * w)
        return pace

    @cached_property
    def _doubled(self) -> Array:
        """M + w dM/dw as a series."""
        s = chebyshev.points(len(self.series))
        slope = divided(self.series, s, s)
        return chebyshev.transform(chebyshev.evaluate(self.series, s) + (1.0 + s) * slope)

    def root(self, time: Array) -> Array:
        """w at times, by halving and Newton's method."""
        lo, hi = np.zeros(time.shape), np.full(time.shape, self.last)
        for _ in range(HALVINGS):
            middle = 0.5 * (lo + hi)
            later = self.times(middle) > time
            lo, hi = np.where(later, lo, middle), np.where(later, middle, hi)
        w = 0.5 * (lo + hi)
        for _ in range(NEWTON):
            step = (self.times(w) - time) / (2.0 * self.length * w * self.pace(w))
            w = np.clip(w - step, TINY, self.last)
        return w


@dataclass(frozen=True, eq=False)
class Zone:
    """A stick zone in the direction from the end that recedes to the edge that grows.

    course      the contact
    direction   1 if the edge that sticks is the right one, -1 if it is the left one
    load        A, the rate of P less s/f times that of Q
    rates       the rates of the loads in this direction
    slip        s f
    friction    f
    """

    course: Course
    direction: float
    rates: Rates
    sign: float
    friction: float

    @property
    def load(self) -> float:
        return self.rates.P - self.sign * self.rates.Q / self.friction

    def edge(self, time: Array) -> Array:
        """b at times."""
        return self.direction * self.course.edge(self.direction > 0.0, time)

    def far_edge(self, time: Array) -> Array:
        """The edge of contact beside the end that recedes."""
        return self.direction * self.course.edge(self.direction < 0.0, time)

    def turn(self, time: Array) -> Array:
        """B at times."""
        pull = self.sign * self.rates.tau / self.friction
        if not self.rates.by_moment:
            return np.full(time.shape, self.rates.turn - pull)
        near, far = self.edge(time), self.far_edge(time)
        turn: Array = self.rates.strain(0.5 * (near + far), 0.5 * (near - far)) - pull
        return turn

    def held_by(self, time: Array, u: Array) -> tuple[Array, Array]:
        """By how much the edge sticks: what it may lose until it slips by s, and by -s."""
        near, far = self.edge(time), self.far_edge(time)
        rho, r = 0.5 * (near - u), 0.5 * (near - far)
        grown = 2.0 * (self.rates.P - math.pi * r * self.rates.strain(0.5 * (near + far), r))
        held = (self.load - math.pi * rho * self.turn(time)) * np.sqrt(r / rho)
        return held, grown - held


def added(zone: Zone, panels: tuple[Panel, ...], place: Array) -> Array:
    """What a way adds to q* at places that stick at its end."""
    total = np.zeros(len(place))
    touched = zone.course.passes(zone.direction > 0.0, zone.direction * place)
    for panel in panels:
        begun, until = (zone.edge(np.array(t)) for t in (panel.time, panel.until))
        far = (place - panel.end > panel.end - panel.start) & (begun - place > until - begun)
        for some, rule in rows_of(far, PLAIN) + rows_of(~far & (touched < panel.until), GRADED):
            (rate, _), w, _ = kernel(zone, panel, place[some], touched[some], rule)
            total[some] += (rate * panel.pace(w)).sum(axis=1)
    return total


def rows_of(chosen: NDArray[np.bool_], rule: Rule) -> list[tuple[NDArray[np.intp], Rule]]:
    """Places that are treated by a rule, a few at a time."""
    rows = np.flatnonzero(chosen)
    step = max(1, TOGETHER // len(rule[0]))
    return [(rows[k : k + step], rule) for k in range(0, len(rows), step)]


def kernel(
    zone: Zone, panel: Panel, place: Array, touched: Array, rule: Rule
) -> tuple[tuple[Array, Callable[[], Array]], Array, Array]:
    """The kernel dq*/dt du of places at nodes w, and a function for its derivative by time.

    `touched`: when each came into contact.
    """
    rise, fall, weight = rule
    late = touched > panel.time
    begun = np.where(late, touched, panel.time)
    first = np.zeros(len(place))
    if late.any():
        first[late] = panel.root(touched[late])
    low = panel.start + panel.length * first**2
    high = np.minimum(panel.end, place)
    length = (high - low)[:, None]
    grown = length * rise / panel.length  # w² - first²
    w = np.sqrt(first[:, None] ** 2 + grown)
    later = grown / (w + first[:, None])  # w - first
    s, s0 = 2.0 * w - 1.0, (2.0 * first - 1.0)[:, None]
    M = chebyshev.evaluate(panel.series, s)
    slope = divided(panel.series, s, s0) if late.any() else 0.0
    after = panel.length * later * (M + 2.0 * first[:, None] * slope)
    time = begun[:, None] + after
    right, course = zone.direction > 0.0, zone.course
    moves = zone.direction * course.moved(right, begun[:, None], time)
    room = np.where(late, 0.0, np.maximum(zone.edge(begun) - place, 0.0))[:, None]
    ahead = room + moves * after
    behind = (place - high)[:, None] + length * fall
    turn = zone.turn(time)
    square = behind * ahead
    # A way that is no way has nan; a place that has just come into contact has no way at all.
    root = np.sqrt(np.where(square > 0.0, square, np.where(length > 0.0, np.nan, np.inf)))
    du = length * weight
    rate = (zone.load / math.pi - 0.5 * turn * (behind - ahead)) / root

    def change() -> Array:
        pace = zone.direction * course.moved(right, time, time)
        by_time: Array = du * 0.5 * pace * (turn / root - rate / ahead)
        return by_time

    return (du * rate, change), w, time
