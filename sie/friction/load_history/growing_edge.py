"""A step in which one end of the stick zone recedes, and the other, an edge, grows and sticks.

With s the slip at the end u that recedes, ξ the coordinate from there to the edge b(t) of contact,
and q = s f (p - q*), the part q* vanishes where it slips and changes in the stick zone [u, b] by

    dq*/dt = [A/π - B (ξ - μ)]/sqrt((ξ - u)(b - ξ)),    A = dP - s dQ/f,    B = G dθ - s dτ/f,

μ the centre and ρ the half-width of the zone. A point that the edge brings into contact has q* = 0.
The end arrives at ξ when q* is 0 there: an equation of Abel's kind for the time t(u),

    q*0(u) + ∫ [A/π - B (u - (v + b)/2)]/sqrt((u - v)(b - u)) dt(v) = 0,

with b = b(t). Time is a series in the root of the distance on each panel; it begins like
the root where the edge nearly slips from the start. The edge sticks while

    0 <= (A - π B ρ) sqrt(r/ρ) <= 2 (dP - π G r dθ),

r the half-width of contact; beyond it slips by s below, by -s above. The slip at u is that of the
stick zone's layer. `BothStick` has the state where neither edge slips.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval

from .end_motion import LOST, OVER, SAME, UNSTEADY, EndMotion
from .growing_contact import Course
from .marched_step import Held, places
from .moved_end import MovedEnd
from .moving_zone import GRADED, PLAIN, rows_of
from .slip_onset import Onset
from .sticking_zone import StickingZone

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class EdgeSticks(MovedEnd):
    """The state after one end of the stick zone receded while the other, an edge, grew and stuck.

    slips    the sign of the slip that begins at the edge at the end, 0 if none does
    joins    what is told of a second zone of slip at the end if it does not join the first one soon
    """

    zone: StickingZone
    slips: float = 0.0
    joins: str = ""

    @property
    def then(self) -> Onset:
        """What goes on after its end."""
        left, right = self.signs
        return Onset(
            (left or self.slips, right or self.slips), (left != 0.0, right != 0.0), joins=self.joins
        )

    @cached_property
    def stick(self) -> Interval:
        d, end = self.zone.direction, self.panels[-1].end
        edge = self.pressure.contact.x2 if d > 0.0 else self.pressure.contact.x1
        return Interval(min(d * end, edge), max(d * end, edge))

    @property
    def _places(self) -> tuple[float, ...]:
        """Where p and q may not be smooth.

        The end changes its speed at a mark, which is left at the edge at that time.
        """
        before, d = super()._places, self.zone.direction
        left = [d * float(self.zone.edge(np.array(panel.time))) for panel in self._at_marks(before)]
        return *before, d * self.panels[0].start, *left

    def in_stick(self, x: Array) -> Array:
        bound = (self.signs[0] or self.signs[1]) * self.friction
        way = self.zone.added(self.panels, self.zone.direction * x)
        q: Array = bound * (self.pressure(x) - way) - self.before.lacking(bound, x)
        return q

    def slip(self, x: Array) -> Array:
        place, total = self.zone.direction * x, np.zeros(len(x))
        side = 0 if self.zone.direction > 0.0 else 1
        for panel in self.panels:
            far = panel.start - place > panel.end - panel.start
            for some, rule in rows_of(far, PLAIN) + rows_of(~far & (place < panel.end), GRADED):
                low = np.maximum(panel.start, place[some])[:, None]
                length = (panel.end - low) * rule[0]
                w = np.sqrt(((low - panel.start) + length) / panel.length)
                distance = np.maximum(panel.start - place[some], 0.0)[:, None] + length
                rate = self.rates.beside(side, distance, self._ends(panel, w)) * panel.pace(w)
                total[some] += (panel.end - low)[:, 0] * (rate @ rule[2])
        return total / self.pressure.half_modulus


def edge_sticks(
    before: Held, course: Course, signs: tuple[float, float], goes_on: bool, share: float
) -> EdgeSticks:
    """The state at the end of a course, or where the edge that sticks begins to slip.

    `signs` has the sign of slip at the end that recedes, and 0 at the edge that grows.
    Raises ContactError where there is none.
    """
    direction = 1.0 if signs[0] else -1.0
    s, f = signs[0] or signs[1], course.contacts.scene.friction
    zone = StickingZone(course, direction, course.rates.mirrored(direction), s, f)
    old = before.pressure.contact
    inner = before.stick if goes_on else old
    start = inner.x1 if direction > 0.0 else -inner.x2

    lacking = before.lacking_from(s * f, direction * start, -direction)

    def missing(u: Array) -> Array:
        """q* where the end arrives."""
        return lacking(u - start)

    edge = course.pressure(course.hi)
    marks = sorted({direction * x for x in places(before, edge)})
    marks = [u for u in marks if u > start + SAME * old.r]
    motion = EndMotion(zone, missing)
    panels, event = motion.way(start, share, marks)
    slips = (s, -s)[event] if event >= 0 else 0.0
    judge = motion.end_from_fewer(panels)
    rho = 0.5 * (float(zone.edge(np.array(panels[-1].until))) - panels[-1].end)
    error = abs(judge - panels[-1].end) / rho
    end = course.hi if event == OVER else panels[-1].until
    Q, tau = course.shear(end)
    p = course.pressure(end) if end < course.hi else edge
    lost = UNSTEADY if event == LOST else ""
    return EdgeSticks(before, p, f, signs, Q, tau, zone, panels, end, error, lost, slips)
