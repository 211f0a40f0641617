"""Spells of the growth of a contact in which its stick zone moves in one way.

A spell is a part of a panel of contacts (`growth`), between two values of v. In it

    r, m, dP/dy, lo, hi, K'/K        y from -1 to 1 in proportion to v

are Chebyshev series: half-width and centre of the contact, counted from the place of first touch,
the rate of the load, the ends of the stick zone and the modulus of its rates (`receding_flat`).
Either both ends advance, lo, hi = m ∓ k r, or one recedes, as `side` says.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.friction.coupled.tables import chopped, summed
from sie.numerics import chebyshev

from .growth import DEGREE, Panel
from .receding_flat import Distances, ratio
from .zone_table import ZoneTable

Array = NDArray[np.float64]

POINTS = 24  # of the series of a spell in which an end recedes, which is short
LOOKS = 32  # places at which the speeds of the ends are looked at
LEAST = 1e-18  # of the largest coefficient of a series, those left out


@dataclass(frozen=True, eq=False)
class Course:
    """The contacts of a part of a panel: r, m and dP/dy at y.

    panel           the panel of the table of contacts
    origin          centre at its beginning, from the place of first touch
    first, last     v at the ends of the part
    """

    panel: Panel
    origin: float
    first: float
    last: float

    def contacts(self, y: Array) -> tuple[Array, Array, Array]:
        half = 0.5 * (self.last - self.first)
        v = self.first + half * (1.0 + y)
        panel = self.panel
        grown = panel.begin - panel.lo + panel.scale * np.sinh(v) ** 2
        ahead = np.clip(grown, 0.0, panel.length)
        m = self.origin + panel.moved(np.zeros(ahead.shape), ahead)
        return panel.lo + ahead, m, panel.load_rate(ahead) * panel.scale * np.sinh(2.0 * v) * half

    def turn(self, v: Array) -> Array:
        """dm/dr at v."""
        panel = self.panel
        grown = panel.begin - panel.lo + panel.scale * np.sinh(v) ** 2
        return panel.turn(np.clip(grown, 0.0, panel.length))


@dataclass(frozen=True, eq=False)
class Spell:
    """A course with its stick zone.

    course      the contacts
    zones       stick zones of the flat
    side        0 where both ends advance, 1 where the left one recedes, -1 where the right one does
    series      rows r, m, dP/dy, lo, hi, K'/K
    bent        whether the receding end comes to a mark at the end, where its course is not smooth
    """

    course: Course
    zones: ZoneTable
    side: int
    series: tuple[Array, ...]
    bent: bool = False

    @cached_property
    def curves(self) -> tuple[Array, Array, Array, Array]:
        """The left and right edge of contact, and lo and hi."""
        r, m, _, lo, hi, _ = self.series
        n = max(len(r), len(m))
        r, m = (np.pad(c, (0, n - len(c))) for c in (r, m))
        return m - r, m + r, lo, hi

    @cached_property
    def _rows(self) -> Array:
        """The series of the four curves, r, dP/dy and K'/K, as columns."""
        r, _, rate, _, _, K = self.series
        every = (*self.curves, r, rate, K)
        n = max(map(len, every))
        return np.array([np.pad(c, (0, n - len(c))) for c in every]).T[:, :, None]

    def values(self, y: Array, count: int = 7) -> Array:
        """The first of the four curves, r, dP/dy and K'/K at y, as rows."""
        rows: Array = summed(self._rows[:, :count], np.broadcast_to(y, (count, *y.shape)))
        return rows

    @cached_property
    def ends(self) -> Array:
        """The four curves at the beginning and at the end, as rows."""
        return self.values(np.array([-1.0, 1.0]), 4).T

    @cached_property
    def speeds(self) -> Array:
        """The most by which each of these moves, over y."""
        y = chebyshev.points(LOOKS)
        rates = np.polynomial.chebyshev.chebder(self._rows[:, :4, 0])
        speeds: Array = np.abs(np.polynomial.chebyshev.chebval(y, rates)).max(axis=1)
        return speeds

    def until(self, y: float) -> Spell:
        """The part before y."""
        n = max(map(len, self.series))
        part = -1.0 + 0.5 * (y + 1.0) * (1.0 + chebyshev.points(n))
        r, m, rate, lo, hi, K = (np.atleast_1d(chebyshev.evaluate(c, part)) for c in self.series)
        first, last = self.course.first, self.course.last
        course = replace(self.course, last=first + 0.5 * (y + 1.0) * (last - first))
        rows = (r, m, 0.5 * (y + 1.0) * rate, lo, hi, np.broadcast_to(K, (n,)))
        return replace(self, course=course, series=_as_series(rows), bent=False)

    def shear(self, values: Array, places: Distances) -> Array:
        """q/(f p) of the rates in stick, from `values` there."""
        if self.side == 0:
            return ratio(self.zones.flat.natural, places)
        left, right, low, high, r, _, K = values
        if self.side > 0:
            return ratio(self.zones.zone((low - left) / r, K), places)
        zone = self.zones.zone((right - high) / r, K)
        return -ratio(zone, Distances(places.right, places.left, places.second, places.first))

    def marked_before(self, other: Spell) -> bool:
        """Whether the growth is not smooth between this spell and the next one."""
        new = self.course.panel is not other.course.panel
        return new or self.side != other.side or self.bent

    @property
    def receding(self) -> Array:
        """The series of the end that recedes."""
        return self.series[3] if self.side > 0 else self.series[4]


def advancing(course: Course, zones: ZoneTable) -> Spell:
    """The spell in which both ends of the stick zone advance."""
    r, m, rate = course.contacts(chebyshev.points(2 * DEGREE))
    lo, hi = m - zones.k * r, m + zones.k * r
    rows = (r, m, rate, lo, hi, np.full(len(r), zones.flat.ratio))
    return Spell(course, zones, 0, _as_series(rows))


def receding(course: Course, zones: ZoneTable, side: int, end: Array) -> Spell:
    """The spell in which one end recedes as this series says."""
    y = chebyshev.points(POINTS)
    r, m, rate = course.contacts(y)
    u = np.broadcast_to(chebyshev.evaluate(end, y), y.shape)
    e = 1.0 + side * (u - m) / r
    K = zones.ratio(e)
    other = m + side * r * (1.0 - zones.zone(e, K).right_slip)
    lo, hi = (u, other) if side > 0 else (other, u)
    return Spell(course, zones, side, _as_series((r, m, rate, lo, hi, K)))


def in_proportion(course: Course, zones: ZoneTable, turn: float, advance: float) -> Spell:
    """The spell from first touch on in which centre and receding end go in proportion to r.

    turn, advance   dm/dr, and how fast the receding end goes
    """
    r, _, rate = course.contacts(chebyshev.points(POINTS))
    side = 1 if turn > 0.0 else -1
    e = np.array([1.0 - abs(turn) + advance])
    K = zones.ratio(e)
    other = turn + side * (1.0 - zones.zone(e, K).right_slip)
    lo, hi = (side * advance * r, other * r)[::side]
    rows = (r, turn * r, rate, lo, hi, np.broadcast_to(K, r.shape))
    return Spell(course, zones, side, _as_series(rows))


def _as_series(rows: tuple[Array, ...]) -> tuple[Array, ...]:
    return tuple(chopped(c, LEAST) for c in chebyshev.transform(np.array(rows)))
