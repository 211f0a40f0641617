"""A stick zone of constant width that travels: one end recedes, the other one advances.

At constant p the shear in the stick zone [c1, c2] changes by dq = [dQ/π - dτ (x - c)]/R. An end can
advance only where dq vanishes like a root, so that the width is 2ρ = 2 |dQ/(π dτ)|. With u the
end that recedes, ξ the coordinate in the direction of travel, and κ = ± dτ/dt,

    dq/dt = κ sqrt((u + 2ρ - ξ)/(ξ - u)),     s f p(u) - q0(u) = κ ∫ sqrt((v + 2ρ - u)/(u - v)) T dv

from where u began: the point at which the end arrives must have reached s f p. It is an equation of
Abel's kind, linear in T = dt/du, which is a series in the root of the distance on each panel. The
slip is 2/E* κ ρ ∫ (arccosh v ± sqrt(v² - 1)) T du behind and in front of the zone, v ρ the distance
from its centre. A step travels by ρ at most; a longer way takes several.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.graded_rule import graded_angle
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import false_position
from sie.traction.of_slope import SlopeDensity

from .marched_step import Held, MarchedStep, places

Array = NDArray[np.float64]

TERMS, FEWER = 18, 13  # of T on a panel, and of what it is judged by
# Of 2ρ: panels are halved towards a mark down to one length, and towards the end of the way to
# another.
SHORTEST, LONGEST = 1e-5, 0.1
TOGETHER = 512  # places at a time
RISE, FALL, WEIGHT = graded_angle()
ISLAND = "a second stick zone begins there, which is not covered"
NEAREST = 1e-12  # of the contact: marks nearer to an end of the way are that end


class Panel(NamedTuple):
    """T = Σ c_n T_n(2w - 1), w² = (u - start)/length, up to `end`."""

    start: float
    length: float
    series: Array
    end: float

    def terms(self, from_start: Array) -> Array:
        """T_n at distances from the start, n first."""
        w = np.sqrt(np.minimum(from_start / self.length, 1.0))
        return chebyshev.polynomials(len(self.series), 2.0 * w - 1.0)

    def time(self, u: float) -> float:
        """∫T from the start to u."""
        way = u - self.start
        return way * float(WEIGHT @ (self.series @ self.terms(way * RISE)))


@dataclass(frozen=True, eq=False)
class Way:
    """The way of a stick zone in the direction of travel: T on it, 2ρ, and κ."""

    panels: tuple[Panel, ...]
    width: float
    rate: float

    @property
    def end(self) -> float:
        return self.panels[-1].end

    def shear(self, place: Array) -> Array:
        """What the way adds to q at places that stick, until its end or until the zone leaves."""
        total = np.zeros(len(place))
        for panel in self.panels:
            at, kernel = self._kernel(panel, place)
            total += (kernel * np.tensordot(panel.series, panel.terms(at), 1)).sum(axis=1)
        return total

    def _kernel(self, panel: Panel, place: Array) -> tuple[Array, Array]:
        """Distances of nodes from the start of a panel, and κ sqrt((v + 2ρ - ξ)/(ξ - v)) dv."""
        low = np.maximum(panel.start, place - self.width)
        high = np.maximum(np.minimum(panel.end, place), low)
        length = (high - low)[:, None]
        behind = np.maximum(place - high, 0.0)[:, None] + length * FALL
        ahead = np.maximum(low + self.width - place, 0.0)[:, None] + length * RISE
        kernel = np.sqrt(ahead / np.where(length > 0.0, behind, 1.0))
        return (low - panel.start)[:, None] + length * RISE, self.rate * length * WEIGHT * kernel

    def slip(self, place: Array, front: bool) -> Array:
        """E*/2 times the slip at places behind the zone, or in front of it."""
        total, rho = np.zeros(len(place)), 0.5 * self.width
        for panel in self.panels:
            if front:
                low = np.full(len(place), panel.start)
                high = np.maximum(np.minimum(panel.end, place - self.width), low)
                beside = np.maximum(place - self.width - high, 0.0)
            else:
                low = np.minimum(np.maximum(panel.start, place), panel.end)
                high = np.full(len(place), panel.end)
                beside = np.maximum(low - place, 0.0)
            length = (high - low)[:, None]
            v = (beside[:, None] + length * (FALL if front else RISE)) / rho  # v - 1
            root = np.sqrt(v * (v + 2.0))
            grown = np.log1p(v + root) + (-root if front else root)
            T = np.tensordot(
                panel.series, panel.terms((low - panel.start)[:, None] + length * RISE), 1
            )
            total += self.rate * rho * (length * WEIGHT * grown * T).sum(axis=1)
        return total


@dataclass(frozen=True, eq=False)
class Travelled(MarchedStep):
    """The state after a stick zone has travelled.

    way        its way, in the coordinate direction × x
    direction  1 to the right, -1 to the left
    share      the part of the change of loads that was left, and is done
    error      the error of the end of the way over its half-width, from fewer terms of T
    """

    way: Way
    direction: float
    share: float
    error: float = 0.0

    @property
    def at_edge(self) -> bool:
        """Whether the advancing end has reached the edge of contact."""
        contact, stick = self.pressure.contact, self.stick
        left = contact.x2 - stick.x2 if self.direction > 0.0 else stick.x1 - contact.x1
        return left <= NEAREST * contact.r

    @property
    def stick(self) -> Interval:
        ends = self.direction * self.way.end, self.direction * (self.way.end + self.way.width)
        return Interval(min(ends), max(ends))

    @property
    def reach(self) -> tuple[float, float]:
        rear = self.direction * self.way.end
        before = self.before.stick
        return (rear, before.x2) if self.direction > 0.0 else (before.x1, rear)

    def in_stick(self, x: Array) -> Array:
        q: Array = self.before.shear(x) + self._parted(x, self.way.shear)
        return q

    def slip(self, x: Array) -> Array:
        place = self.direction * x
        slip = self._parted(x, lambda at: self.way.slip(at, front=False))
        slip += self._parted(x, lambda at: self.way.slip(at, front=True))
        slip[(place > self.way.end) & (place < self.way.panels[0].start + self.way.width)] = 0.0
        return slip / self.pressure.half_modulus

    def _parted(self, x: Array, function: Callable[[Array], Array]) -> Array:
        out = np.zeros(len(x))
        for first in range(0, len(x), TOGETHER):
            rows = slice(first, first + TOGETHER)
            out[rows] = function(self.direction * x[rows])
        return out


def travelled(
    before: Held, pressure: SlopeDensity, friction: float, loads: tuple[float, float]
) -> Travelled:
    """The state after the stick zone has travelled on the way to the loads Q and τ, by ρ at most.

    The advancing end starts where the width is 2ρ. Raises ContactError where there is no such way.
    """
    dQ, dtau = loads[0] - before.Q, loads[1] - before.tau
    direction = math.copysign(1.0, dQ) * math.copysign(1.0, dtau)
    rho, rate = abs(dQ / (math.pi * dtau)), direction * dtau
    stick, contact = before.stick, pressure.contact
    start = stick.x1 if direction > 0.0 else -stick.x2
    sign = math.copysign(1.0, rate)
    room = (contact.x2 if direction > 0.0 else -contact.x1) - (start + 2.0 * rho)

    def missing(u: Array) -> Array:
        """s f p - q0 where the end arrives."""
        x = direction * u
        q: Array = sign * friction * pressure(x) - before.shear(x)
        return q

    front = 1 if direction > 0.0 else 0
    if before.signs[1 - front] != sign or before.signs[front] != -sign:
        raise ContactError(
            "slip stops at one edge of the contact, and the stick zone would meet it: " + ISLAND
        )
    if not 2.0 * rho >= 2.0 * stick.r * (1.0 - NEAREST) or not room > NEAREST * rho:
        raise ContactError("the end of a stick zone reaches the edge of contact: " + ISLAND)
    limit = start + min(rho, room)
    marks = sorted({direction * x for x in places(before, pressure)})
    slack = NEAREST * contact.r
    ends = (start, *(u for u in marks if start + slack < u < limit - slack), limit)
    (way, share), (judge, _) = (
        _way(missing, ends, 2.0 * rho, rate, terms) for terms in (TERMS, FEWER)
    )
    Q, tau = loads if share == 1.0 else (before.Q + share * dQ, before.tau + share * dtau)
    signs = (sign, -sign) if direction > 0.0 else (-sign, sign)
    error = abs(way.end - judge.end) / rho
    return Travelled(before, pressure, friction, signs, Q, tau, way, direction, share, error)


def _way(
    missing: Callable[[Array], Array],
    ends: tuple[float, ...],
    width: float,
    rate: float,
    terms: int,
) -> tuple[Way, float]:
    """The way until the time 1, or up to the last of `ends`, and the time."""
    panels: list[Panel] = []
    time = 0.0
    for lo, hi in pairwise(ends):
        for start, end in pairwise(_cuts(lo, hi, (SHORTEST if hi < ends[-1] else LONGEST) * width)):
            panel = _solved(missing, Way(tuple(panels), width, rate), (start, end), terms)
            if time + panel.time(end) >= 1.0:
                reached = _reached(panel, 1.0 - time)
                return Way((*panels, panel._replace(end=reached)), width, rate), 1.0
            panels.append(panel)
            time += panel.time(end)
    return Way(tuple(panels), width, rate), time


def _cuts(lo: float, hi: float, least: float) -> list[float]:
    """Ends of panels between two places, halved towards the second."""
    halvings = max(math.ceil(math.log2((hi - lo) / least)), 0)
    return [*(hi - (hi - lo) * 0.5 ** np.arange(halvings + 1)).tolist(), hi]


def _solved(
    missing: Callable[[Array], Array], way: Way, ends: tuple[float, float], terms: int
) -> Panel:
    """T on one more panel, by collocation."""
    start, length = ends[0], ends[1] - ends[0]
    blank = Panel(start, length, np.zeros(terms), ends[1])
    u = start + length * (0.5 * (1.0 + chebyshev.points(terms))) ** 2
    at, kernel = way._kernel(blank, u)
    matrix = (blank.terms(at) * kernel).sum(axis=2).T
    panel = blank._replace(series=np.linalg.solve(matrix, missing(u) - way.shear(u)))
    if not (panel.series @ panel.terms(length * RISE) > 0.0).all():
        raise ContactError(
            "the end that recedes turns while the other one advances, which is not covered"
        )
    return panel


def _reached(panel: Panel, time: float) -> float:
    """Where a panel's time is over."""

    def excess(u: float) -> float:
        return panel.time(u) - time

    ends = panel.start, panel.end
    return false_position(excess, *ends, (excess(ends[0]), excess(ends[1])), _settled)


def _settled(a: float, b: float, value: float) -> bool:
    return abs(value) <= EPS
