"""A stick zone whose ends move while the pressure changes, and the way of its receding end.

Integrals over the way of the end have nodes that are graded towards both ends, or that are few
where the place is far.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

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


class Kernel(NamedTuple):
    """What the way of an end adds to q* at places, by nodes of the way.

    rate      dq*/dt du
    change    its derivative by the time at which the end is at each node
    w, time   the nodes, and the times there
    """

    rate: Array
    change: Callable[[], Array]
    w: Array
    time: Array


@dataclass(frozen=True, eq=False)
class MovingZone(ABC):
    """A stick zone in the direction from the end that recedes to its other end.

    course      the contact
    direction   1 if the end that recedes is the left one, -1 if it is the right one
    rates       the rates of the loads in this direction
    sign        s, of the slip at the end that recedes
    friction    f
    """

    course: Course
    direction: float
    rates: Rates
    sign: float
    friction: float

    @property
    def load(self) -> float:
        """A, the rate of P less s/f times that of Q."""
        return self.rates.P - self.sign * self.rates.Q / self.friction

    def edge(self, time: Array) -> Array:
        """The edge of contact ahead, at times."""
        return self.direction * self.course.edge(self.direction > 0.0, time)

    def far_edge(self, time: Array) -> Array:
        """The edge of contact beside the end that recedes."""
        return self.direction * self.course.edge(self.direction < 0.0, time)

    def strain(self, time: Array) -> Array:
        """E*/2 times the rate of the tilt at times."""
        near, far = self.edge(time), self.far_edge(time)
        return self.rates.strain(0.5 * (near + far), 0.5 * (near - far))

    def turn(self, time: Array) -> Array:
        """B at times."""
        return self.strain(time) - self.sign * self.rates.tau / self.friction

    def held(self, panel: Panel, w: Array) -> tuple[Array, Array]:
        """(A - π ρ B) sqrt(r/ρ) if the edge ahead sticks, and 2 (dP - π r G dθ), at nodes w.

        Slip there begins by s where the first is negative, and by -s where it is the larger one.
        """
        time, u = panel.times(w), panel.start + panel.length * w**2
        near, far = self.edge(time), self.far_edge(time)
        rho, r = 0.5 * (near - u), 0.5 * (near - far)
        held = (self.load - math.pi * rho * self.turn(time)) * np.sqrt(r / rho)
        return held, 2.0 * (self.rates.P - math.pi * r * self.strain(time))

    @abstractmethod
    def half(self, u: float, time: float) -> float:
        """A length over which what happens at the end changes."""

    @abstractmethod
    def ahead(self, panel: Panel, w: Array) -> Array:
        """The other end of the stick zone at nodes w of a panel."""

    @abstractmethod
    def own(self, panel: Panel, place: Array, rule: Rule) -> Kernel:
        """What a panel adds at places on it or ahead, which stick from its start on."""

    @abstractmethod
    def added(self, panels: tuple[Panel, ...], place: Array) -> Array:
        """What panels add to q* at places that stick at their end."""

    @abstractmethod
    def room(self, panel: Panel, w: Array) -> tuple[Array, ...]:
        """By how much the other end goes on as it does, in several respects."""


def rows_of(chosen: NDArray[np.bool_], rule: Rule) -> list[tuple[NDArray[np.intp], Rule]]:
    """Places that are treated by a rule, a few at a time."""
    rows = np.flatnonzero(chosen)
    step = max(1, TOGETHER // len(rule[0]))
    return [(rows[k : k + step], rule) for k in range(0, len(rows), step)]
