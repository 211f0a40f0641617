"""A stick zone with one end that recedes and an edge of contact that grows and sticks.

The equations are in `growing_edge`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .growing_contact import divided
from .moving_zone import GRADED, PLAIN, Kernel, MovingZone, Panel, Rule, rows_of

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StickingZone(MovingZone):
    """A stick zone of which one end recedes, and the other is an edge that grows."""

    def half(self, u: float, time: float) -> float:
        return 0.5 * (float(self.edge(np.array(time))) - u)

    def ahead(self, panel: Panel, w: Array) -> Array:
        return self.edge(panel.times(w))

    def room(self, panel: Panel, w: Array) -> tuple[Array, ...]:
        """By how much the edge sticks: what it may lose until it slips by s, and by -s."""
        held, grown = self.held(panel, w)
        return held, grown - held

    def added(self, panels: tuple[Panel, ...], place: Array) -> Array:
        total = np.zeros(len(place))
        touched = self.course.passes(self.direction > 0.0, self.direction * place)
        for panel in panels:
            begun, until = (self.edge(np.array(t)) for t in (panel.time, panel.until))
            far = (place - panel.end > panel.end - panel.start) & (begun - place > until - begun)
            for some, rule in rows_of(far, PLAIN) + rows_of(~far & (touched < panel.until), GRADED):
                rate, _, w, _ = self._kernel(panel, place[some], touched[some], rule)
                total[some] += (rate * panel.pace(w)).sum(axis=1)
        return total

    def own(self, panel: Panel, place: Array, rule: Rule) -> Kernel:
        return self._kernel(panel, place, np.full(len(place), self.course.lo), rule)

    def _kernel(self, panel: Panel, place: Array, touched: Array, rule: Rule) -> Kernel:
        """The kernel of places that came into contact at times `touched`."""
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
        right, course = self.direction > 0.0, self.course
        moves = self.direction * course.moved(right, begun[:, None], time)
        room = np.where(late, 0.0, np.maximum(self.edge(begun) - place, 0.0))[:, None]
        ahead = room + moves * after
        behind = (place - high)[:, None] + length * fall
        turn = self.turn(time)
        square = behind * ahead
        # A way that is no way has nan; a place that has just come into contact has no way at all.
        root = np.sqrt(np.where(square > 0.0, square, np.where(length > 0.0, np.nan, np.inf)))
        du = length * weight
        rate = (self.load / math.pi - 0.5 * turn * (behind - ahead)) / root

        def change() -> Array:
            pace = self.direction * course.moved(right, time, time)
            by_time: Array = du * 0.5 * pace * (turn / root - rate / ahead)
            return by_time

        return Kernel(du * rate, change, w, time)
