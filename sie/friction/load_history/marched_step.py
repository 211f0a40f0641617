"""A step on top of any earlier shear: what it starts from, what it leaves, and its energy."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_state import IntegralsOfSlip
from sie.numerics.interval import Interval
from sie.traction.base import Density
from sie.traction.of_slope import SlopeDensity

from .frozen_edge import FrozenEdge
from .panel_shear import PanelShear

Array = NDArray[np.float64]

# How near to the ends of a stick zone, and to marks in it, |q| <= f p is tested, of its width, how
# far from them, of the way to the next one, and at how many places. A wedge has infinite p in the
# middle; a zone of slip that has just opened at a mark is too short to be found.
NEAREST, AT_MARK, FARTHEST, SCANNED = 1e-7, 1e-5, 0.49, 100
AT_EDGE = 1e-13  # of the contact: how well it is known when an edge passes a place
MUCH, HALVINGS = 0.1, 12  # of a stick zone: what stuck for a while; how often a while is halved


@dataclass(frozen=True, eq=False)
class Held:
    """What a step starts from.

    Q, tau      its loads
    pressure    p
    shear       q
    stick       the stick zone
    signs       the signs of slip to the left and the right of it, 0 where nothing slipped
    marks       places where q is not smooth
    gaps        zones between several stick zones that slipped, and the signs
    left        what q lacks of ±f p at places in the contact, given ±f, without cancellation
    """

    Q: float
    tau: float
    pressure: SlopeDensity
    shear: Density
    stick: Interval
    signs: tuple[float, float]
    marks: tuple[float, ...]
    gaps: tuple[tuple[float, float, float], ...] = ()
    left: Callable[[float, Array], Array] | None = None

    def lacking(self, bound: float, x: Array) -> Array:
        """What q lacks of ±f p at places (1-d), given ±f; 0 beyond the contact."""
        lack, contact = np.zeros(x.shape), self.pressure.contact
        inside = (x >= contact.x1) & (x <= contact.x2)
        at = x[inside]
        if self.left is not None:
            lack[inside] = self.left(bound, at)
        else:
            lack[inside] = bound * self.pressure(at) - self.shear(at)
        return lack

    def lacking_from(self, bound: float, place: float, side: float) -> Callable[[Array], Array]:
        """What q lacks of ±f p, over ±f, at distances from a place; as `FrozenEdge` has sides."""

        def lacking(x: Array) -> Array:
            return self.lacking(bound, x) / bound

        marks = np.array(places(self, self.pressure))
        return FrozenEdge(place, side, 2.0 * self.pressure.contact.r, lacking, marks).pressure


@dataclass(frozen=True, eq=False)
class MarchedStep(ABC):
    """A step on top of any earlier shear, and the state at its end.

    before      what it started from
    pressure    p at its end
    friction    f
    signs       the signs of slip to the left and the right of the stick zone
    Q, tau      the loads at its end
    """

    before: Held
    pressure: SlopeDensity
    friction: float
    signs: tuple[float, float]
    Q: float
    tau: float

    @property
    @abstractmethod
    def stick(self) -> Interval:
        """The stick zone."""

    @property
    def reach(self) -> tuple[float, float]:
        """The inner ends of what slipped in this step, on the left and on the right."""
        return self.stick.x1, self.stick.x2

    @property
    @abstractmethod
    def error(self) -> float:
        """The error of the ends of the stick zone over its half-width, from two tolerances."""

    @abstractmethod
    def in_stick(self, x: Array) -> Array:
        """q at places (1-d) in the stick zone."""

    @abstractmethod
    def slip(self, x: Array) -> Array:
        """The slip Δg in this step at places (1-d)."""

    @property
    @abstractmethod
    def span(self) -> tuple[float, float]:
        """The shares of the step of a path between which this part of it lies."""

    @abstractmethod
    def until(self, share: float) -> MarchedStep:
        """The same up to an earlier share of the step of the path."""

    def slip_since(self, share: float, x: Array) -> Array:
        """The slip at places (1-d) that come into contact at a share of the step of the path."""
        begun, end = self.span
        if share >= end:
            return np.zeros(x.shape)
        if share <= begun:
            return self.slip(x)
        first, slip = self.until(share), self.slip(x)
        contact = first.pressure.contact
        apart = np.stack((contact.from_left(x), contact.from_right(x)))
        at_edges = apart <= AT_EDGE * contact.r
        for k in np.flatnonzero(at_edges.any(axis=1)).tolist():
            slip[at_edges[k]] -= first.slip_at_edge(k)
        inside = ~at_edges.any(axis=0)
        if inside.any():
            slip[inside] -= first.slip(x[inside])
        return slip

    def slip_at_edge(self, k: int) -> float:
        """The slip in this step at the left edge of contact, k = 0, or the right one."""
        return float(self.slip(np.array([self.pressure.interval[k]]))[0])

    def kept_in(self, contact: Interval) -> tuple[tuple[float, float], ...]:
        """The zones that stuck since the contact was this one in the step."""
        left = max(self.reach[0], self.stick.x1, contact.x1)
        right = min(self.reach[1], self.stick.x2, contact.x2)
        cuts = [left, *(end for gap in self.gaps for end in gap[:2]), right]
        return tuple(zip(cuts[::2], cuts[1::2], strict=True))

    def latest(self) -> Held:
        """The state since which much of what sticks did so, the start if that is one."""
        begun, (share, end) = self.before, self.span
        widest = max(hi - lo for lo, hi in self.sticks)
        for _ in range(HALVINGS):
            if self._longest(begun).r >= 0.5 * MUCH * widest:
                break
            share = 0.5 * (share + end)
            begun = self.until(share).held
        return begun

    def _longest(self, begun: Held) -> Interval:
        """The longest zone that stuck since a state on the way."""
        zones = self.kept_in(begun.pressure.contact)
        return Interval(*max(zones, key=lambda zone: zone[1] - zone[0]))

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places where q is not smooth."""
        x1, x2 = self.stick.x1, self.stick.x2
        ends = (end for gap in self.gaps for end in gap[:2])
        inner = {x for x in (*self._places, *self.reach, *ends) if x1 < x < x2}
        return tuple(sorted(inner | {x1, x2, *self.pressure.breaks}))

    @property
    def _places(self) -> tuple[float, ...]:
        """Where p at both ends of the step, and q at its start, may not be smooth."""
        return places(self.before, self.pressure)

    @cached_property
    def shear(self) -> PanelShear:
        """q."""
        values = self._values, self.marks, self.Q
        return PanelShear(self.pressure.contact, *values, self._limit)

    def _limit(self, x: Array) -> Array:
        return self.friction * self.pressure(x)

    def _values(self, x: Array) -> Array:
        q: Array = np.where(x < self.stick.m, *self.signs) * self.friction * self.pressure(x)
        sticks = (x > self.stick.x1) & (x < self.stick.x2)
        q[sticks] = self.in_stick(x[sticks])
        return q

    @cached_property
    def held(self) -> Held:
        """What the next step starts from."""
        return Held(
            *(self.Q, self.tau, self.pressure, self.shear, self.stick, self.signs, self.marks),
            self.gaps,
        )

    @property
    def gaps(self) -> tuple[tuple[float, float, float], ...]:
        """Zones between several stick zones that slipped, and the signs."""
        return ()

    @property
    def sticks(self) -> tuple[tuple[float, float], ...]:
        """The stick zones."""
        cuts = (self.stick.x1, *(end for gap in self.gaps for end in gap[:2]), self.stick.x2)
        return tuple(zip(cuts[::2], cuts[1::2], strict=True))

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        """The zones of slip from left to right, and the signs."""
        (x1, x2), (left, right) = self.pressure.interval, self.signs
        whole = (x1, self.stick.x1, left), *self.gaps, (self.stick.x2, x2, right)
        return tuple(zone for zone in whole if zone[1] > zone[0])

    @property
    def scanned(self) -> tuple[Array, Array, Array]:
        """Places in the stick zones, q there, and |q| - f p over the largest f p.

        They are graded towards the marks but those of the profile, as slip that ended at one has
        left q next to f p, and some are where |q| - f p is largest between them.
        """
        marks = sorted({*self.marks}.difference(self.pressure.breaks))

        def values(x: Array) -> Array:
            return np.stack((x, self.in_stick(x), self.friction * self.pressure(x)))

        found = values(np.unique(np.concatenate([_graded(zone, marks) for zone in self.sticks])))
        x, q, f_p = found
        between = values(_tops(x, np.abs(q) - f_p))
        both = np.concatenate((found, between), axis=1)
        x, q, f_p = both[:, np.argsort(both[0])]
        return x, q, (np.abs(q) - f_p) / f_p.max()

    # -- integrals ---------------------------------------------------------------------------------

    @property
    def work(self) -> float:
        """The energy that slip dissipated."""
        return self.integrals.work

    @property
    def drag(self) -> float:
        """What the part adds to the shift of the indenter, as of `drag`."""
        return self._drag(self.before, self.span[0], HALVINGS)

    def _drag(self, begun: Held, share: float, halvings: int) -> float:
        """The same since a share of the step, in parts where no point stuck all along."""
        stuck, end = self._longest(begun), self.span[1]
        if stuck.r > 0.0 or not halvings:
            return drag(begun, self.held, stuck)
        between = self.until(0.5 * (share + end))
        before = between._drag(begun, share, halvings - 1)
        return before + self._drag(between.held, between.span[1], halvings - 1)

    @cached_property
    def integrals(self) -> IntegralsOfSlip:
        """Integrals of Δg."""
        contact = self.pressure.contact
        marks = np.array([*self._places, *self.marks, *self.reach])
        parts = []
        for side, sign, inner in zip((-1.0, 1.0), self.signs, self.reach, strict=True):
            edge = contact.x2 if side > 0.0 else contact.x1
            whole = FrozenEdge(edge, side, 2.0 * contact.r, self.pressure, marks)
            zone = whole.zone(side * (edge - inner))
            parts.append((zone, side, sign, sign * self.slip(edge - side * zone.from_edge)))
        return IntegralsOfSlip.over(parts, self.friction, contact.r)


def places(before: Held, pressure: SlopeDensity) -> tuple[float, ...]:
    """Where p at both ends of a step, and q at its start, may not be smooth."""
    ends = before.stick.x1, before.stick.x2, *before.pressure.interval, *pressure.interval
    return *before.marks, *ends, *pressure.breaks


def _graded(zone: tuple[float, float], marks: Iterable[float]) -> Array:
    """Places in a zone, graded towards its ends and ascending marks in it."""
    (lo, hi), width = zone, zone[1] - zone[0]
    ends = [lo]
    for x in marks:
        if ends[-1] + 3.0 * AT_MARK * width < x < hi - 3.0 * AT_MARK * width:
            ends.append(x)
    least = width * np.array([NEAREST, *[AT_MARK] * (len(ends) - 1), NEAREST])
    places = []
    for (a, b), near in zip(pairwise([*ends, hi]), pairwise(least), strict=True):
        up, down = (np.geomspace(first, FARTHEST * (b - a), SCANNED) for first in near)
        places += [a + up, b - down]
    return np.concatenate(places)


def _tops(x: Array, values: Array) -> Array:
    """Where values at ascending places are largest between them, by parabolas."""
    low, top, high = values[:-2], values[1:-1], values[2:]
    here = np.flatnonzero((top >= low) & (top > high))
    back, ahead = np.diff(x)[here], np.diff(x)[here + 1]
    fall, drop = (top - low)[here] / back, (top - high)[here] / ahead
    vertex: Array = x[here + 1] + 0.5 * (fall * ahead - drop * back) / (fall + drop)
    return vertex


def drag(start: Held, end: Held, stuck: Interval) -> float:
    """π E*/2 times the shift of the indenter, but for a multiple of ΔQ that is always the same.

    It is the change of the displacement where the surface stuck all along. Its mean under the
    pressure of a flat punch there, of the centre μ and the half-width ρ, is

        π Δτ μ - ΔQ ln ρ - ∫Δq arccosh|(x - μ)/ρ| dx,

    the integral over the rest. Raises ContactError where nothing stuck all along.
    """
    if not stuck.r > 0.0:
        raise ContactError(
            "no point stuck all along: how far slip shifts the indenter is not covered; give a "
            "turning point on the way"
        )
    old, new = start.pressure.contact, end.pressure.contact
    marks = np.array([*places(start, end.pressure), *end.marks, *stuck])

    def change(x: Array) -> Array:
        added: Array = end.shear(x) - start.shear(x)
        return added

    total = math.pi * (end.tau - start.tau) * stuck.m - (end.Q - start.Q) * math.log(stuck.r)
    for side, edge, inner in (
        (-1.0, min(old.x1, new.x1), stuck.x1),
        (1.0, max(old.x2, new.x2), stuck.x2),
    ):
        frame = FrozenEdge(edge, side, 2.0 * max(old.r, new.r), change, marks)
        zone = frame.zone(side * (edge - inner))
        total -= float(zone.force @ np.arccosh(1.0 + zone.from_stick / stuck.r))
    return total
