"""A step in which the contact grows at both edges and sticks there, with loads in any proportion.

Nothing slips, and strain that is locked in drops out of the rate,

    dq/dt = [dQ/π - dτ (x - m)]/sqrt((x - x1)(x2 - x)),

of which a point has the integral since it came into contact. An edge sticks while |dQ ∓ π r dτ| <=
f (dP ∓ π G r dθ), - on the right and + on the left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics.graded_rule import graded_angle
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import false_position

from .growing_contact import Course, Rates
from .marched_step import Held, MarchedStep
from .slip_onset import Onset

Array = NDArray[np.float64]

RISE, _, WEIGHT = graded_angle()
WATCHED = 129  # times at which it is seen whether the edges stick
ROUNDING = 1e-12  # of the rate of the pressure: what an edge may seem to slip


@dataclass(frozen=True, eq=False)
class BothStick(MarchedStep):
    """The state after both edges grew and stuck.

    course    the contact
    begun     the share of the step at its start
    share     that at its end
    slips     the sign of slip that begins at the left and the right edge at the end, or 0
    """

    course: Course
    begun: float
    share: float
    slips: tuple[float, float] = (0.0, 0.0)

    @property
    def stick(self) -> Interval:
        contact = self.pressure.contact
        return Interval(contact.x1, contact.x2)

    @property
    def error(self) -> float:
        return 0.0

    @property
    def work(self) -> float:
        return 0.0

    @property
    def then(self) -> Onset:
        """What goes on after its end."""
        return Onset(self.slips, (False, False))

    @property
    def span(self) -> tuple[float, float]:
        return self.begun, self.share

    def until(self, share: float) -> BothStick:
        Q, tau = self.course.shear(share)
        p = self.course.pressure(share)
        return replace(self, pressure=p, Q=Q, tau=tau, share=share)

    def slip(self, x: Array) -> Array:
        return np.zeros(x.shape)

    def in_stick(self, x: Array) -> Array:
        q: Array = self.before.shear(x) + self._added(self.course.rates, x)
        return q

    @cached_property
    def held(self) -> Held:
        """What the next step starts from; q near an edge that begins to slip is nearly f p."""
        return replace(super().held, left=self._lacking)

    def _lacking(self, bound: float, x: Array) -> Array:
        rates = self.course.rates
        Q, tau = bound * rates.P - rates.Q, -rates.tau
        rest = self._added(rates._replace(Q=Q, tau=tau), x, bound)
        lack: Array = self.before.lacking(bound, x) + rest
        return lack

    def _added(self, rates: Rates, x: Array, bound: float = 0.0) -> Array:
        """∫[dQ/π - (dτ + bound G dθ)(x - m)]/w dt at places (1-d) since they came into contact."""
        course, total = self.course, np.zeros(x.shape)
        for rows in np.array_split(np.arange(len(x)), max(1, len(x) // 512)):
            at = x[rows]
            came = [np.maximum(course.passes(right, at), self.begun) for right in (False, True)]
            touched = np.maximum(*came)
            span = np.maximum(self.share - touched, 0.0)[:, None]
            time = touched[:, None] + span * RISE
            left, right = (
                # Where this edge brought x into contact there is no room but rounding.
                np.where(came[k] > self.begun, 0.0, side * (course.edge(k == 1, touched) - at))[
                    :, None
                ]
                + side * span * RISE * course.moved(k == 1, touched[:, None], time)
                for k, side in enumerate((-1.0, 1.0))
            )
            strain = rates.strain(at[:, None] + 0.5 * (right - left), 0.5 * (left + right))
            turn = rates.tau + bound * strain
            rate = (rates.Q / math.pi - 0.5 * turn * (left - right)) / np.sqrt(left * right)
            total[rows] = (span * rate) @ WEIGHT
        return total


def both_stick(before: Held, course: Course, begun: float) -> BothStick:
    """The state at the end of a course, or where an edge begins to slip."""
    times = course.times(begun, WATCHED)
    share, slips = course.hi, (0.0, 0.0)
    for k in (0, 1):
        room = _held(course, times, k)
        lost = np.flatnonzero(room[1:] < -ROUNDING * abs(course.rates.P))
        if not lost.size:
            continue
        j = int(lost[0])

        def left(time: float, k: int = k) -> float:
            return float(_held(course, np.array(time), k))

        ends = float(times[j]), float(times[j + 1])
        values = max(float(room[j]), 0.0), float(room[j + 1])
        at = false_position(left, *ends, values, lambda a, b, value: b - a <= 4.0 * EPS)
        if at < share:
            sign = math.copysign(1.0, _pull(course, np.array(at), k))
            share, slips = at, ((sign, 0.0), (0.0, sign))[k]
    Q, tau = course.shear(share)
    p = course.pressure(share)
    f = course.contacts.scene.friction
    return BothStick(before, p, f, (0.0, 0.0), Q, tau, course, begun, share, slips)


def _pull(course: Course, time: Array, k: int) -> Array:
    """What drives slip at the left edge, k = 0, or the right one."""
    outward = (1.0, -1.0)[k] * math.pi * 0.5 * (course.edge(True, time) - course.edge(False, time))
    pull: Array = course.rates.Q + outward * course.rates.tau
    return pull


def _held(course: Course, time: Array, k: int) -> Array:
    """By how much an edge sticks."""
    left, right = course.edge(False, time), course.edge(True, time)
    r = 0.5 * (right - left)
    strain = course.rates.strain(0.5 * (left + right), r)
    grown = course.rates.P + (1.0, -1.0)[k] * math.pi * r * strain
    held: Array = course.contacts.scene.friction * grown - np.abs(_pull(course, time, k))
    return held
