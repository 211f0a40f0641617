"""The stick zone of any growing contact, spell by spell, where one end of it recedes.

Both ends m ∓ k r advance until |dm/dr| = k; then the end u that would move inwards recedes. A place
slips as u arrives there, at the limit that it comes from: with V or U of `history`,

    V(u(r), r) = 0,

an equation of Abel's kind for u, as the rates are infinite at u. As u begins to recede, so smoothly
as m ∓ k r turns, u goes a quarter of the way of m ∓ k r: with u = λ τ² and τ² for that

    ∫_{-√λ T}^0 sqrt(λ T² - τ²) dτ + ∫_0^T (λ T² - (1 + λ) τ²/2)/sqrt(λ (T² - τ²)) dτ = 0

gives λ = 1/4. Where dm/dr jumps, as an edge passes a jump of the slope, |d(m ∓ k r)/dr| is w before
and w' after, and with dP/dr also λ² w' P'/(w P'') + 2 λ = 1 (docs/derivations/goodman.md).

The series of u on a part of a panel of contacts has V = 0 at Radau's points, which
hold the end of the part: Newton's method, with differences for derivatives. What the load before
the part adds to V is a series in the root of the distance from the u at its beginning. The end
recedes until m ∓ k r comes back to it, and then advances again.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev

from .end_course import DEGREE as COUNT
from .end_course import Unknown, points, slowing
from .first_touch import from_touch
from .growth import DEGREE, ContactTable
from .history import HIGH, LOW, lack, lack_in
from .other_end import end_rate, refuse_both, refuse_both_behind
from .spells import Course, Spell, advancing, receding
from .zone_table import ZoneTable

Array = NDArray[np.float64]

LONGEST, SHORTEST = 0.4, 1e-7  # parts, in v
FIRST = 0.1  # the first part tried
GROWTH, WELL = 2.0, 0.01  # a part is so much longer than one that was so well resolved
SLOWLY = 1.2  # ... and than one that was resolved
QUARTER = 0.25  # λ
TURNED = 1e-6  # of dm/dr: where it jumps by less the onset is one of a smooth growth
RESOLVED = 1e-11  # of the half-width: the last terms of the series of u
ROUGHLY = 1e-6  # of the way of u on the part: the same
CONVERGED, SETTLED = 1e-11, 1e-13  # of the half-width: what a step of Newton's method may still be
NEWTONS, AGAIN = 12, 5  # steps, and those after which derivatives are found again
DAMPING = (1.0, 0.5, 0.25, 0.1)  # of a step that leads too far
DIFFERENCE = 1e-6  # of the way of u on a part
HISTORY = 20  # points of the series of what earlier loads add
ROOM = 2.5  # of the way of u that is expected: to so far that series goes
LOOKS = 400  # places at which the ends are looked at
TURNING = 1e-9  # of dm/dr: an end that recedes so slowly is rounding
LEAST_CHANGE = 0.2  # of the length of a closing part, over that expected, at least
AGAIN_AHEAD, AT_MARK = "again ahead", "at a mark"
APART = 1e-10  # of the half-width: a mark that is nearer was reached
ON_MARK = 1.0 + 1e-9  # times the distance of a mark: so far u may go on the way to it
MOST = 240  # spells


class Trial(NamedTuple):
    """A part with a receding end, the last terms of its series, and to which goal it leads."""

    spell: Spell
    tail: float
    goal: str


def march(table: ContactTable, zones: ZoneTable) -> tuple[Spell, ...]:
    """The spells up to the contact of the table; ContactError where none are found."""
    return _March(table, zones).spells()


class _March:
    def __init__(self, table: ContactTable, zones: ZoneTable) -> None:
        self.table, self.zones = table, zones
        self.done: list[Spell] = []
        self.side = 0
        self._marks: set[float] = set()

    def spells(self) -> tuple[Spell, ...]:
        for panel, centre in zip(self.table.panels, self.table.centres, strict=False):
            origin = centre + self.table.middle - self.table.first_centre
            first, end = panel.depths
            course = Course(panel, origin, first, end)
            while course.first < end:
                course = self._advance(course) if self.side == 0 else self._recede(course)
        return tuple(self.done)

    # -- both ends advance -------------------------------------------------------------------------

    def _advance(self, course: Course) -> Course:
        """The rest of a course behind where one end begins to recede."""
        from scipy.optimize import brentq  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

        k, end = self.zones.k, course.last
        v = np.linspace(course.first, end, LOOKS + 1)
        turn = course.turn(v)
        fast = np.flatnonzero(np.abs(turn) > k + TURNING)
        onset = end
        if fast.size:
            i = int(fast[0])
            side = 1 if turn[i] > 0.0 else -1

            def ahead(place: float) -> float:
                return side * float(course.turn(np.array([place]))[0]) - k

            if i == 0:
                onset = course.first
            else:
                a, b = float(v[i - 1]), float(v[i])
                onset = a if ahead(a) >= 0.0 else float(brentq(ahead, a, b, xtol=1e-15))
            self.side, self.fresh, self.length = side, True, FIRST
            self.part = self._first_part(replace(course, first=onset))
        if onset > course.first:
            self._add(advancing(replace(course, last=onset), self.zones))
        elif not self.done:
            # Behind so small contacts that they grow in proportion
            self._add(from_touch(course, self.zones, self.side, self.table.ends[1]))
            self.fresh, self.length = False, self.done[0].course.last
            return replace(course, first=self.done[0].course.last)
        return replace(course, first=onset)

    def _first_part(self, course: Course) -> float:
        """λ: the way of u over that of m ∓ k r, as u begins to recede with this course."""
        if not self.done or self.done[-1].side:
            return QUARTER
        begun, before = course.contacts(np.array([-1.0]))[0], self.done[-1].course
        here = np.array([course.first]), np.array([before.last])
        if float(before.panel.hi) != float(course.panel.lo) or begun[0] > course.panel.lo:
            return QUARTER
        ahead = self.side * course.turn(here[0])[0] - self.zones.k
        behind = self.zones.k - self.side * before.turn(here[1])[0]
        if min(ahead, behind) < TURNED:
            return QUARTER
        rate, new = before.panel.load_rate(np.array([before.panel.length])), course.panel
        kappa = ahead / behind * float(rate[0] / new.load_rate(np.zeros(1))[0])
        return 1.0 / (1.0 + math.sqrt(1.0 + kappa))

    # -- one end recedes ---------------------------------------------------------------------------

    def _recede(self, course: Course) -> Course:
        """The rest of a course behind the next part of it."""
        if not self.fresh:
            refuse_both_behind(self.done[-1], course, self.zones)
        left = course.last - course.first
        length = min(self.length, left, LONGEST)
        if left - length < 0.2 * length:
            length = left
        stop = 0.0 if self.fresh else self._stop(course)
        mark, at_mark = self._next_mark(course)
        while True:
            if length < SHORTEST * max(1.0, course.first) or len(self.done) > MOST:
                raise _not_found(course)
            # First to where the end advances again, or reaches a mark
            if 0.0 < stop <= 1.5 * length:
                trial = self._trial(replace(course, last=course.first + stop), mark, AGAIN_AHEAD)
                if trial is not None and trial.spell.course.last <= course.last:
                    break
                length = min(length, 0.5 * stop)
            if 0.0 < at_mark <= 1.5 * length:
                trial = self._trial(replace(course, last=course.first + at_mark), mark, AT_MARK)
                if trial is not None and trial.spell.course.last <= course.last:
                    trial = None if self._met(trial.spell) <= 1.0 else trial
                if trial is not None and trial.spell.course.last <= course.last:
                    break
                length = min(length, 0.5 * at_mark)
            last = course.last if length == left else course.first + length
            trial = self._trial(replace(course, last=last), mark, "")
            met = 1.0 if trial is None else self._met(trial.spell)
            if trial is not None and met > 1.0:
                break
            # Where the end is met sooner the part ends before
            length *= 0.5 if trial is None or met <= 0.0 else 0.4 * (met + 1.0)
        refuse_both(trial.spell)
        self._add(trial.spell)
        part = trial.spell.course
        self.length = (part.last - part.first) * (
            GROWTH if trial.tail < WELL * RESOLVED else SLOWLY
        )
        self.fresh = False
        if trial.goal == AGAIN_AHEAD:
            self.side = 0
        return replace(course, first=part.last)

    def _stop(self, course: Course) -> float:
        """About how far in v m ∓ k r comes back to the end that recedes, 0 where it does not."""
        previous = self.done[-1]
        r, m, end = (np.polynomial.chebyshev.chebval(1.0, c) for c in self._ahead_of(previous))
        rates = [end_rate(c) for c in self._ahead_of(previous)]
        ahead = self.side * (m - end) - self.zones.k * r
        by_r = (self.side * (rates[1] - rates[2]) / rates[0]) - self.zones.k
        here, there = course.contacts(np.array([-1.0, 1.0]))[0].tolist()
        if not (by_r < 0.0 and ahead > 0.0):
            return 0.0
        grown = (here - ahead / by_r - course.panel.begin) / course.panel.scale
        return float(np.arcsinh(np.sqrt(grown))) - course.first if there > here else 0.0

    def _next_mark(self, course: Course) -> tuple[float, float]:
        """Where V is not smooth next as the end recedes, and about how far in v it is."""
        start = float(self.done[-1].ends[1, LOW if self.side > 0 else HIGH])
        apart = APART * self.table.end
        ahead = [x for x in self.marks if self.side * (x - start) > apart]
        if not ahead:
            return self.side * math.inf, 0.0
        mark = min(ahead, key=lambda x: self.side * x)
        if self.fresh:
            return mark, 0.0
        r = end_rate(self.done[-1].series[0])
        by_r = (mark - start) / end_rate(self.done[-1].receding) * r
        here, there = course.contacts(np.array([-1.0, 1.0]))[0].tolist()
        if not (by_r > 0.0 and there > here):
            return mark, 0.0
        grown = (here + by_r - course.panel.begin) / course.panel.scale
        return mark, float(np.arcsinh(np.sqrt(grown))) - course.first

    @property
    def marks(self) -> set[float]:
        return self._marks | {0.0}

    def _add(self, spell: Spell) -> None:
        if self.done:
            previous = self.done[-1]
            if previous.marked_before(spell):
                self._marks |= set(previous.ends[1].tolist())
        self.done.append(spell)

    @staticmethod
    def _ahead_of(spell: Spell) -> tuple[Array, Array, Array]:
        return spell.series[0], spell.series[1], spell.receding

    def _met(self, spell: Spell) -> float:
        """y at which m ∓ k r comes back to the end that recedes, 2 where it does not."""
        y = -1.0 + 2.0 * np.arange(1, LOOKS + 1) / LOOKS
        r, m, end = (chebyshev.evaluate(c, y) for c in (*spell.series[:2], spell.receding))
        ahead = self.side * (m - end) - self.zones.k * r
        back = np.flatnonzero(ahead < 0.0)
        if not back.size:
            return 2.0
        i = int(back[0])
        if i == 0:
            return -1.0
        return float(y[i] - ahead[i] * (y[i] - y[i - 1]) / (ahead[i] - ahead[i - 1]))

    def _trial(self, course: Course, mark: float, goal: str) -> Trial | None:
        """The next part, None where it is too long.

        With a goal it is so long that m ∓ k r comes back to the receding end, or that this end
        comes to the mark.
        """
        unknown, side = self._unknown(course, goal == AGAIN_AHEAD), self.side
        curve = LOW if side > 0 else HIGH
        start = float(unknown.start[0])
        far = min(ROOM * unknown.size, side * (mark - start))
        before = self._before(start, far)
        y, length = points()[0], course.last - course.first

        def missed(z: Array) -> tuple[Array, Spell]:
            part = course
            if goal:
                part = replace(course, last=course.first + length * float(z[-1]))
                z = z[:-1]
            spell = receding(part, self.zones, side, unknown.series(z))
            u = unknown.places(z)
            lacking = before(u) + lack_in(spell, u, y, side, curve)
            if goal == AGAIN_AHEAD:
                r, m, _ = part.contacts(np.ones(1))
                lacking = np.append(lacking, side * (m - u[-1]) - self.zones.k * r)
            elif goal:
                lacking = np.append(lacking, side * (u[-1] - mark))
            return lacking, spell

        def within(z: Array) -> bool:
            ahead = side * (unknown.places(z[:COUNT]) - start)
            long = goal and not LEAST_CHANGE < float(z[-1]) < 1.0 / LEAST_CHANGE
            return bool(ahead.min() >= 0.0 and ahead.max() <= ON_MARK * far and not long)

        z = np.append(unknown.start[1:], 1.0) if goal else unknown.start[1:]
        found = self._newton(missed, within, z, unknown.size)
        if found is None:
            return None
        z, spell = found
        way = np.append(0.0, unknown.places(z[:COUNT]) - start)
        tail = float(np.abs(points()[1] @ way)[-2:].max()) / self.table.end
        tail = max(tail, RESOLVED / ROUGHLY * tail * self.table.end / unknown.size)
        spell = replace(spell, bent=goal == AT_MARK)
        return Trial(spell, tail, goal) if tail < RESOLVED else None

    def _newton(
        self,
        missed: Callable[[Array], tuple[Array, Spell]],
        within: Callable[[Array], bool],
        z: Array,
        size: float,
    ) -> tuple[Array, Spell] | None:
        rates, half_width = np.zeros(0), self.table.end
        lacking, spell = missed(z)
        step = np.inf
        for number in range(NEWTONS):
            if number in (0, AGAIN):
                shifts = DIFFERENCE * np.eye(len(z))
                columns = [(missed(z + shift)[0] - lacking) / DIFFERENCE for shift in shifts]
                rates = np.array(columns).T
            if not (np.isfinite(rates).all() and np.isfinite(lacking).all()):
                return None
            try:
                change = np.linalg.solve(rates, -lacking)
            except np.linalg.LinAlgError:
                return None
            allowed = [part for part in DAMPING if within(z + part * change)]
            if not allowed:
                return None
            change, last, before = allowed[0] * change, step, lacking
            z, step = z + change, float(np.abs(change).max()) * size
            lacking, spell = missed(z)
            if step < SETTLED * half_width or (step < CONVERGED * half_width and step > 0.3 * last):
                return z, spell
            # Broyden's update of the derivatives
            rest = lacking - before - rates @ change
            rates = rates + np.outer(rest, change) / float(change @ change)
        return None

    def _unknown(self, course: Course, closing: bool) -> Unknown:
        """How u is sought: as a part of the way of m ∓ k r where it begins to recede."""
        y, inverse = points()
        course_points = chebyshev.points(2 * DEGREE)
        previous = self.done[-1]
        start = float(previous.ends[1, LOW if self.side > 0 else HIGH])
        if self.fresh:
            (r, m, _), (many, middle, _) = course.contacts(y), course.contacts(course_points)
            way = m - self.side * self.zones.k * r - start
            whole = middle - self.side * self.zones.k * many - start
            part = np.linalg.inv(np.polynomial.chebyshev.chebvander(y, COUNT - 1))

            def fresh_series(z: Array) -> Array:
                fraction = chebyshev.evaluate(part @ z, course_points)
                return chebyshev.transform(start + fraction * whole)

            begin = np.append(start, np.full(COUNT, self.part))
            size = self.part * float(np.abs(way).max())
            return Unknown(begin, lambda z: start + z * way, fresh_series, size)
        rate = end_rate(previous.receding) / end_rate(previous.series[0])
        r = course.contacts(np.append(-1.0, y))[0]
        way = rate * (r[1:] - r[0])
        size = float(np.abs(way).max())
        if closing:
            return slowing(start, 0.5 * float(way[-1]))

        def series(z: Array) -> Array:
            c: Array = inverse @ np.append(0.0, size * z)
            c[0] += start
            return c

        return Unknown(np.append(start, way / size), lambda z: start + size * z, series, size)

    def _before(self, start: float, far: float) -> Callable[[Array], Array]:
        """What the load before adds to V or U at places that u goes to."""
        side = self.side
        place = 0.5 * (1.0 + chebyshev.points(HISTORY))
        values = lack(tuple(self.done), start + side * far * place**2, side)
        series = chebyshev.transform(values)

        def at(u: Array) -> Array:
            root = np.sqrt(np.maximum(side * (u - start), 0.0) / far)
            return np.asarray(chebyshev.evaluate(series, 2.0 * root - 1.0))

        return at


def _not_found(course: Course) -> ContactError:
    r = float(course.contacts(np.array([-1.0]))[0][0])
    return ContactError(
        "the contact moves aside faster than its stick zone grows, and the stick zone that "
        f"recedes at one end is not found beyond a half-width of {r:.6g} in Goodman's "
        "approximation; raise the friction, reduce the tilt or the load, or give dundurs = 0 to "
        "neglect β"
    )
