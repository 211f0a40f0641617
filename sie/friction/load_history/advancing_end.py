"""A step in which one end of the stick zone recedes and the other one advances.

Let u recede with slip s to the left of it, and a advance with slip -s to the right, up to the edge
x2 of contact. With q = s f (p - q*) the rate of q* is 0 on the left and 2 p' on the right. At a it
has no root in the denominator,

    A = π B ρ + 2 ∫_a^x2 p'(η) sqrt((η - u)/(η - a)) dη,       A = P' - s Q'/f,   B = G θ' - s τ'/f,

which is an equation for a, given u and the time. In the stick zone [u, a] that leaves

    dq*/dt = sqrt((a - ξ)/(ξ - u)) {B + 2/π ∫_a^x2 p'(η) sqrt((η - u)/(η - a))/(η - ξ) dη}.

u arrives at ξ when q* is 0 there: an equation of Abel's kind for the time t(u). What a passes has
q* = 2 p then, and whatever strain: it sticks, and the rates do not contain it. The integrals are
sums over midpoints of an angle, the pole at ξ in closed form. At constant pressure 2ρ is constant,
and the zone travels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval

from .advancing_zone import AdvancingZone
from .end_motion import LOST, OVER, SAME, EndMotion
from .growing_contact import Course
from .marched_step import Held, places
from .moved_end import MovedEnd
from .moving_zone import GRADED, Panel
from .slip_onset import Onset

Array = NDArray[np.float64]

BOTH = "both ends of the stick zone would advance"
TOGETHER = 128  # places at a time


@dataclass(frozen=True, eq=False)
class EndAdvances(MovedEnd):
    """The state after one end of the stick zone receded while the other advanced.

    event    what ends it: 0 the zone of slip ahead has vanished, 1 its end recedes, OVER the course
    """

    zone: AdvancingZone
    event: int = OVER

    @property
    def then(self) -> Onset:
        """What goes on after its end."""
        d, (left, right) = self.zone.direction, self.signs
        if self.event == 1:
            return Onset(self.signs, (True, True))
        if self.event == OVER:
            return Onset(self.signs, (True, True), d)
        edge = np.array(self.share)
        near, far = self.zone.edge(edge), self.zone.far_edge(edge)
        grown = self.zone.rates.P - 0.5 * math.pi * (near - far) * self.zone.strain(edge)
        ahead = 0.0 if grown > 0.0 else self.zone.sign
        return Onset((left, ahead) if d > 0.0 else (ahead, right), (d > 0.0, d < 0.0))

    @cached_property
    def stick(self) -> Interval:
        d, contact = self.zone.direction, self.pressure.contact
        last = self.panels[-1]
        ends = d * last.end, d * float(self.zone.ahead(last, np.array(last.last)))
        x1, x2 = max(min(ends), contact.x1), min(max(ends), contact.x2)
        if self.event == 0:
            x1, x2 = (x1, contact.x2) if d > 0.0 else (contact.x1, x2)
        return Interval(x1, x2)

    def until(self, share: float) -> EndAdvances:
        earlier = super().until(share)
        return replace(earlier, event=OVER) if share < self.share else earlier

    @property
    def reach(self) -> tuple[float, float]:
        d = self.zone.direction
        ends = d * self.panels[-1].end, d * self.zone.first
        return min(ends), max(ends)

    @property
    def _places(self) -> tuple[float, ...]:
        """Where p and q may not be smooth.

        The end that recedes changes its speed at a mark, which is left where the other one was.
        """
        before, d = super()._places, self.zone.direction
        left = [d * float(self.zone.ahead(panel, np.zeros(()))) for panel in self._at_marks(before)]
        return *before, d * self.panels[0].start, d * self.zone.first, *left

    def in_stick(self, x: Array) -> Array:
        bound, place = self.zone.sign * self.friction, self.zone.direction * x
        total = bound * (self.zone.gained(self.panels, place) - self.pressure(x))
        old = place < self.zone.first
        total[old] -= self.before.lacking(-bound, x[old])
        return total

    @property
    def slip_goes_on(self) -> bool:
        """Whether slip keeps its direction up to both edges at the end."""
        return self.rates.keep_direction(self.pressure, self.stick)

    # -- slip --------------------------------------------------------------------------------------

    def slip(self, x: Array) -> Array:
        total = np.zeros(len(x))
        for first in range(0, len(x), TOGETHER):
            rows = slice(first, first + TOGETHER)
            place = self.zone.direction * x[rows]
            total[rows] = sum(self._slip(panel, place) for panel in self.panels)
        return total / self.pressure.half_modulus

    def _slip(self, panel: Panel, place: Array) -> Array:
        """E*/2 times the slip at places while the end that recedes passes a panel."""
        total, series = np.zeros(len(place)), self.zone.front(panel)
        behind, ahead = place < panel.end, place > self.zone.first
        until = np.full(len(place), panel.end)
        passed = self.zone.passing(series, place[ahead], panel.last)
        until[ahead] = panel.start + panel.length * passed**2
        rise, _, weight = GRADED
        for rows, side in ((behind, 0), (ahead & (until > panel.start), 1)):
            at, high = place[rows], until[rows]
            low = np.full(len(at), panel.start) if side else np.maximum(panel.start, at)
            length = (high - low)[:, None]
            w = np.sqrt(((low - panel.start)[:, None] + length * rise) / panel.length)
            end = self.zone.ahead(panel, w) if side else panel.start + panel.length * w**2
            distance = np.maximum(at[:, None] - end if side else end - at[:, None], 0.0)
            real = side if self.zone.direction > 0.0 else 1 - side
            rate = self.rates.beside(real, distance, self._ends(panel, w)) * panel.pace(w)
            total[rows] = length[:, 0] * (rate @ weight)
        return total


def end_advances(before: Held, course: Course, way: Onset, share: float) -> EndAdvances:
    """The state at the end of a course, or where the end no longer advances.

    The other end recedes from where it was, or from the edge of contact. Raises ContactError where
    there is none.
    """
    signs, goes_on, direction = way.signs, way.goes_on, way.advances
    rear = 0 if direction > 0.0 else 1
    s, f = signs[rear], course.contacts.scene.friction
    inner = before.stick if goes_on[rear] else before.pressure.contact
    start, first = direction * inner[rear], direction * before.stick[1 - rear]
    rates = course.rates.mirrored(direction)
    zone = AdvancingZone(course, direction, rates, s, f, first, first - start)
    first = zone.jump(start, share)
    zone = replace(zone, first=first, width=first - start)

    lacking = before.lacking_from(s * f, direction * start, -direction)

    def missing(u: Array) -> Array:
        """q* where the end arrives."""
        return lacking(u - start)

    old, edge = before.pressure.contact, course.pressure(course.hi)
    marks = sorted({direction * x for x in places(before, edge)})
    marks = [u for u in marks if u > start + SAME * old.r]
    motion = EndMotion(zone, missing)
    panels, event = motion.way(start, share, marks)
    lost = BOTH if event == LOST else ""
    error = abs(motion.end_from_fewer(panels) - panels[-1].end) / zone.half(panels[-1].end, share)
    end = course.hi if event == OVER else panels[-1].until
    Q, tau = course.shear(end)
    p = course.pressure(end) if end < course.hi else edge
    return EndAdvances(before, p, f, signs, Q, tau, zone, panels, end, error, lost, event)
