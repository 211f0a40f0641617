"""A stick zone with one end that recedes and one that advances, while the pressure changes.

The equations are in `advancing_end`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev

from .growing_contact import divided
from .moving_zone import GRADED, PLAIN, Kernel, MovingZone, Panel, Rule, rows_of
from .slip_rates import midpoints

Array = NDArray[np.float64]

FRONT_TERMS = 24  # of the end that advances, on a panel
NEWTON, SETTLED, CONVERGED = 30, 1e-15, 1e-11  # of the half-width: steps, and the last one of them
DIFFERENCE = 1e-6  # of a course: a step of time for a derivative
HALVINGS = 50
TRIED, STILL = 65, 1e-8  # places of an end that jumps; of the loads: what one misses that does not


class Instant(NamedTuple):
    """What the rates depend on, at times: the ends u and a, the edges, and P'/π, G θ' and B.

    s and n are sin² and the number of the midpoints on [a, x2].
    """

    u: Array
    a: Array
    x1: Array
    x2: Array
    strain: Array
    turn: Array
    load: float
    sine: Array

    def bend(self, x: Array) -> Array:
        """p' times the root of the distances from both edges."""
        bend: Array = self.load - self.strain * (x - 0.5 * (self.x1 + self.x2))
        return bend

    def pressure(self, x: Array) -> Array:
        """p'."""
        rate: Array = self.bend(x) / np.sqrt((x - self.x1) * (self.x2 - x))
        return rate

    def missed(self, load: float) -> tuple[Array, Array]:
        """By what a fails its equation, over π, and the derivative by it."""
        n = len(self.sine)
        total = 0.5 * self.turn * (self.a - self.u) - load / math.pi
        slope = 0.5 * self.turn
        for sine in self.sine:
            eta = self.a + (self.x2 - self.a) * sine
            root = np.sqrt((eta - self.u) / (eta - self.x1))
            bend = self.bend(eta)
            total = total + 2.0 / n * bend * root
            by_eta = 0.5 * bend * (1.0 / (eta - self.u) - 1.0 / (eta - self.x1)) - self.strain
            slope = slope + 2.0 / n * root * by_eta * (1.0 - sine)
        return total, slope

    def gain(self, behind: Array, ahead: Array) -> Array:
        """The rate of 2 p - q* at x in the stick zone, with x - u and a - x.

        Midpoints miss the pole at x by a factor in closed form, which times p' is known.
        """
        n, x, length = len(self.sine), self.u + behind, self.x2 - self.a
        whole = 0.5 * self.turn
        for sine in self.sine:
            eta = self.a + length * sine
            root = np.sqrt((eta - self.u) / (eta - self.x1))
            whole = whole + self.bend(eta) * root / (n * (ahead + length * sine))
        near = np.sqrt(np.divide(ahead, length, out=np.full(x.shape, np.inf), where=length > 0.0))
        known = np.tanh(2.0 * n * np.arcsinh(near))
        rate: Array = 2.0 * self.pressure(x) * known - 2.0 * np.sqrt(ahead / behind) * whole
        return rate


@dataclass(frozen=True, eq=False)
class AdvancingZone(MovingZone):
    """A stick zone of which one end recedes, and the other advances.

    first    where the end that advances was at the start
    width    the width at the start
    """

    first: float
    width: float

    def half(self, u: float, time: float) -> float:
        return 0.5 * self.width

    def at(self, time: Array, u: Array, near: Array, steps: int = NEWTON) -> Instant:
        """The zone at times, with one end at u and the other one near a place, nan if not found."""
        edges = self.far_edge(time), self.edge(time)
        sine, _ = midpoints(np.maximum(edges[1] - self.first, 0.0), near - u)
        now = Instant(
            *(u, near, *edges, self.strain(time), self.turn(time), self.rates.P / math.pi, sine)
        )
        if not steps:
            return now
        with np.errstate(invalid="ignore", divide="ignore"):
            for _ in range(steps):
                missed, slope = now.missed(self.load)
                step = -missed / slope
                most = 0.5 * (now.a - u)
                now = now._replace(a=now.a + np.clip(step, -most, most))
                if not np.abs(step).max() > SETTLED * np.abs(most).max():
                    break
        lost = ~(np.abs(step) <= CONVERGED * np.abs(most))
        return now._replace(a=np.where(lost, np.nan, now.a))

    def jump(self, u: float, time: float) -> float:
        """Where the end that advances is from a time on: farther out if slip has just turned.

        Raises ContactError where that is beyond the edge of contact.
        """
        edge = float(self.edge(np.array(time)))
        tried = self.first + (edge - self.first) * np.linspace(0.0, 1.0, TRIED)
        now = self.at(np.full(TRIED, time), np.full(TRIED, u), tried, steps=0)
        missed, _ = now.missed(self.load)
        if abs(missed[0]) <= STILL * abs(self.load):
            return self.first
        turned = np.flatnonzero(np.sign(missed[1:]) != np.sign(missed[:-1]))
        if not turned.size:
            raise ContactError("slip stops at once up to an edge of contact")
        near = tried[turned[0] : turned[0] + 2].mean(keepdims=True)
        found = self.at(np.array([time]), np.array([u]), near).a
        if not self.first <= found[0] <= edge:
            raise ContactError("slip stops at once up to an edge of contact")
        return float(found[0])

    def front(self, panel: Panel, later: float = 0.0) -> Array:
        """The end that advances on a panel as a series in 2w - 1, at somewhat later times."""
        w = 0.5 * (1.0 + chebyshev.points(FRONT_TERMS))
        u = panel.start + panel.length * w**2
        found = self.at(panel.times(w) + later, u, u + self.width)
        return chebyshev.transform(found.a)

    def ahead(self, panel: Panel, w: Array) -> Array:
        return chebyshev.evaluate(self.front(panel), 2.0 * w - 1.0)

    def room(self, panel: Panel, w: Array) -> tuple[Array, ...]:
        """By how much the zone of slip ahead has not vanished, and its end advances."""
        held, grown = self.held(panel, w)
        s = 2.0 * w - 1.0
        return held - grown, divided(self.front(panel), s, s)

    # -- what the way adds -------------------------------------------------------------------------

    def own(self, panel: Panel, place: Array, rule: Rule) -> Kernel:
        first = np.zeros(len(place))
        behind, w, du = _nodes(panel, place, first, rule)

        def rate(later: float) -> Array:
            now = self._instant(panel, w, later)
            x = place[:, None]
            with np.errstate(invalid="ignore", divide="ignore"):  # nan where a trial leaves contact
                added: Array = du * (2.0 * now.pressure(x) - now.gain(behind, now.a - x))
            return added

        here = rate(0.0)

        def change() -> Array:
            step = DIFFERENCE * (self.course.hi - self.course.lo)
            return (rate(step) - here) / step

        return Kernel(here, change, w, panel.times(w))

    def added(self, panels: tuple[Panel, ...], place: Array) -> Array:
        total = -self.gained(panels, place)
        for panel in panels:
            sine, _, weight = PLAIN
            w = panel.last * np.sqrt(sine)[None, :]
            now = self._instant(panel, w, 0.0)
            dt = panel.length * panel.last**2 * weight * panel.pace(w)
            total += (2.0 * now.pressure(place[:, None]) * dt).sum(axis=1)
        return total

    def gained(self, panels: tuple[Panel, ...], place: Array) -> Array:
        """What panels add to 2 p - q* at places since the end that advances has passed them."""
        total = np.zeros(len(place))
        for panel in panels:
            series = self.front(panel)
            begun, until = chebyshev.evaluate(series, np.array([-1.0, 2.0 * panel.last - 1.0]))
            late, reached = place > begun, place < until
            way = panel.end - panel.start
            far = (place - panel.end > way) & (begun - place > until - begun)
            for some, rule in rows_of(far, PLAIN) + rows_of(~far & reached, GRADED):
                at = place[some]
                first = np.zeros(len(at))
                first[late[some]] = self.passing(series, at[late[some]], panel.last)
                behind, w, du = _nodes(panel, at, first, rule)
                now = self._instant(panel, w, 0.0)
                s, s0 = 2.0 * w - 1.0, 2.0 * first[:, None] - 1.0
                room = np.where(late[some], 0.0, begun - at)[:, None]
                ahead = room + (s - s0) * divided(series, s, s0)
                rate = now.gain(behind, np.maximum(ahead, 0.0))
                total[some] += (du * rate * panel.pace(w)).sum(axis=1)
        return total

    def passing(self, series: Array, place: Array, last: float) -> Array:
        """The nodes w up to `last` at which the end that advances passes places."""
        lo, hi = np.zeros(place.shape), np.full(place.shape, last)
        for _ in range(HALVINGS if place.size else 0):
            middle = 0.5 * (lo + hi)
            passed = chebyshev.evaluate(series, 2.0 * middle - 1.0) >= place
            lo, hi = np.where(passed, lo, middle), np.where(passed, middle, hi)
        return hi

    def _instant(self, panel: Panel, w: Array, later: float) -> Instant:
        """The zone at nodes w of a panel, at somewhat later times."""
        time, u = panel.times(w) + later, panel.start + panel.length * w**2
        a = chebyshev.evaluate(self.front(panel, later), 2.0 * w - 1.0)
        edges = self.far_edge(time), self.edge(time)
        sine, _ = midpoints(np.maximum(edges[1] - a, 0.0), a - u)
        turns = self.strain(time), self.turn(time)
        return Instant(u, a, *edges, *turns, self.rates.P / math.pi, sine)


def _nodes(panel: Panel, place: Array, first: Array, rule: Rule) -> tuple[Array, Array, Array]:
    """Distances of places from nodes on a panel from w = `first` on, the nodes w, and du."""
    rise, fall, weight = rule
    low = panel.start + panel.length * first**2
    high = np.minimum(panel.end, place)
    length = (high - low)[:, None]
    behind = (place - high)[:, None] + length * fall
    w = np.sqrt(first[:, None] ** 2 + length * rise / panel.length)
    return behind, w, length * weight
