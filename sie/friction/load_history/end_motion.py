"""The way of an end of the stick zone that recedes, by Newton's method on one panel after another.

A panel is as long as its series resolves. It ends at a mark of the earlier shear, where the speed
of the end changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.numerics.root_finding import false_position

from .moving_zone import GRADED, ROUGH, MovingZone, Panel

Array = NDArray[np.float64]

TERMS, FEWER = 16, 12  # of the time on a panel, and of what it is judged by
RESOLVED = 1e-12  # of ρ: what the last terms of a panel leave of its end
FIRST, SHORTEST = 0.05, 1e-8  # of ρ: the first panel, and the shortest
MOST_STEPS, SETTLED, ROUNDING = 12, 1e-14, 1e-9  # of Newton's method, of the series
MOST_PANELS = 300
SAME = 1e-12  # of a half-width: places that are nearer to each other are one
RETURNED = 1e-10  # of a step: what is left of it when its end returns to a mark
WATCHED = np.linspace(0.0, 1.0, 17)  # of a panel: where it is seen whether all goes on
OFTEN, DOUBLED, HALVED = 24, 4, 40
STEADY = np.ones(2)  # of M, for time in proportion to the distance
OVER, LOST = -1, -2  # in place of an event: the course is over, or the way is not found farther

UNSTEADY = "the end of the stick zone does not recede steadily"


@dataclass(frozen=True, eq=False)
class EndMotion:
    """The motion of an end of a stick zone.

    zone       the zone
    missing    q* at places (1-d) where the end arrives, as it was at the start
    """

    zone: MovingZone
    missing: Callable[[Array], Array]

    def way(self, u: float, time: float, marks: list[float]) -> tuple[tuple[Panel, ...], int]:
        """The way from a place at a time until an event, and which of `room` is lost there.

        It is OVER or LOST where none is. Raises ContactError where there is no way at all.
        """
        panels: list[Panel] = []
        rho, over = self.zone.half(u, time), self.zone.course.hi
        length = FIRST * rho
        while len(panels) < MOST_PANELS:
            most = min(
                *(m - u for m in marks if m > u + SAME * rho), self.zone.half(u, time), math.inf
            )
            length = most if length > 0.7 * most else length
            panel = self._panel(tuple(panels), (u, length, time), TERMS)
            if panel is None:
                if length <= SHORTEST * rho:
                    break
                length *= 0.4
                continue
            if panel.until >= over:
                panel = replace(panel, last=float(panel.root(np.array(over))))
            panel, event = _until_event(self.zone, panel)
            panels.append(panel)
            if panel.last < 1.0 or event >= 0 or over - panel.until <= RETURNED * over:
                return tuple(panels), event
            u, time = u + length, panel.until
            length *= 2.0
        if panels:
            return tuple(panels), LOST
        raise ContactError(UNSTEADY)

    def end_from_fewer(self, panels: tuple[Panel, ...]) -> float:
        """The end of the same way from fewer terms."""
        again: tuple[Panel, ...] = ()
        time = panels[0].time
        for panel in panels:
            found = self._panel(again, (panel.start, panel.length, time), FEWER) or panel
            again = (*again, found)
            time = found.until
        last = again[-1]
        reached = replace(last, last=float(last.root(np.array(min(panels[-1].until, time)))))
        return reached.end

    def _panel(
        self, before: tuple[Panel, ...], place: tuple[float, float, float], terms: int
    ) -> Panel | None:
        """One more panel, None where it is not found or not resolved."""
        start, length, time = place
        u = start + length * (0.5 * (1.0 + chebyshev.points(terms))) ** 2
        if (u <= start).any():
            return None
        known = self.missing(u) + self.zone.added(before, u)
        pace = self._first_pace(known[-1:], u[-1:], place)
        if pace is None:
            return None
        guess = 0.5 * pace * np.pad(STEADY, (0, terms - 2))
        panel = self._by_newton(Panel(start, length, time, guess), u, known)
        if panel is None or terms < TERMS:
            return panel
        c = np.abs(panel.series)
        resolved = c[-2:].max() * length <= RESOLVED * c.max() * self.zone.half(start, time)
        onwards = panel.pace(0.5 * (1.0 + chebyshev.points(OFTEN))) > 0.0
        return panel if resolved and onwards.all() else None

    def _by_newton(self, panel: Panel, u: Array, known: Array) -> Panel | None:
        """The panel whose way brings q* to 0 at places u when the end arrives."""
        before, latest = math.inf, 3.0 * self.zone.course.hi - 2.0 * panel.time
        for _ in range(MOST_STEPS):
            rate, change, w, time = self.zone.own(panel, u, GRADED)
            if not (np.isfinite(rate).all() and time.max() <= latest):
                return None
            s, pace = 2.0 * w - 1.0, panel.pace(w)
            T = chebyshev.polynomials(len(u), s)
            matrix = ((0.5 * T / w + _derivatives(T, s)) * rate).sum(axis=2).T
            matrix += (T * (panel.length * w * change() * pace)).sum(axis=2).T
            step = np.linalg.solve(matrix, -known - (rate * pace).sum(axis=1))
            panel = replace(panel, series=panel.series + step)
            size = float(np.abs(step).max() / np.abs(panel.series).max())
            if size <= SETTLED or 0.3 * before <= size <= ROUNDING:
                return panel
            before = size
        return None

    def _first_pace(
        self, known: Array, last: Array, place: tuple[float, float, float]
    ) -> float | None:
        """The constant dt/du with which the end of a panel is reached in time."""
        start, length, time = place

        def missed(pace: float) -> float:
            panel = Panel(start, length, time, 0.5 * pace * STEADY)
            return float(known[0] + pace * self.zone.own(panel, last, ROUGH).rate.sum())

        low, at_low, late = 0.0, math.nan, math.inf
        high = (self.zone.course.hi - time) / length
        at_high = missed(high)
        for _ in range(DOUBLED + HALVED):
            if at_high <= 0.0:
                break
            if at_high > 0.0:
                low, at_low = high, at_high
            else:
                late = high  # so late there is no such zone
            high = min(2.0 * high, 0.5 * (low + late)) if low else 0.25 * high
            at_high = missed(high)
        else:
            return None
        if not low:
            low, at_low = high, at_high
        for _ in range(HALVED):
            if not at_low <= 0.0:
                break
            high, at_high, low = low, at_low, 0.25 * low
            at_low = missed(low)
        if not at_low > 0.0:
            return None
        values = at_low, at_high
        return false_position(missed, low, high, values, lambda a, b, value: b - a <= 1e-3 * b)


def _derivatives(T: Array, s: Array) -> Array:
    """T_n'(s) from T_n(s), n first."""
    out = np.zeros(T.shape)
    out[1] = 1.0
    for n in range(2, len(T)):
        out[n] = 2.0 * s * out[n - 1] + 2.0 * T[n - 1] - out[n - 2]
    return out


def _until_event(zone: MovingZone, panel: Panel) -> tuple[Panel, int]:
    """A panel up to where room is lost, and in which respect, OVER for none."""
    w, last, event = panel.last * WATCHED, panel.last, OVER
    for k, values in enumerate(zone.room(panel, w)):
        lost = np.flatnonzero((values[:-1] >= 0.0) & (values[1:] < 0.0))
        if lost.size:
            j = int(lost[0])
            ends, at_ends = ((float(pair[j]), float(pair[j + 1])) for pair in (w, values))

            def left(at: float, k: int = k) -> float:
                return float(zone.room(panel, np.array(at))[k])

            at = false_position(left, *ends, at_ends, lambda a, b, value: b - a <= 4.0 * EPS)
            last, event = (at, k) if at < last else (last, event)
    return replace(panel, last=last), event
