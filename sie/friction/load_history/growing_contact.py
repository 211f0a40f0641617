"""The contact during a step, and the rates at which its loads change.

Each edge is a Chebyshev series of the share t of the step, for as long as it moves smoothly. Where
P grows manyfold it is one of log P: beside the place of first contact it is like a power of P.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.loads import Loads
from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.problem.scene import Scene
from sie.traction.of_slope import SlopeDensity

Array = NDArray[np.float64]

DEGREES = (16, 32)  # numbers of terms of an edge that are tried
MANYFOLD, OF_LOG = 8.0, (24, 48, 96)  # growth of P by which its logarithm is taken, and terms then
EARLIEST = -0.5  # of P: what times that are tried may be before the part
RESOLVED = 1e-13  # of the contact: what the last terms of a series leave
SHORTEST = 1e-7  # part of a step in which the edges are one series
HALVINGS, NEWTON = 12, 6  # for the time at which an edge is somewhere


class Contacts(Protocol):
    """What a step needs of a path.

    scene           profile, bodies and friction
    pressure_at     the pressure under loads, in one patch
    sheared_by      Q and τ of loads
    curved          whether the tilt follows from a moment, and not in proportion to time
    by_moment       whether moments are added along the path, not tilts
    """

    scene: Scene

    def pressure_at(self, loads: Loads) -> SlopeDensity: ...
    def sheared_by(self, loads: Loads) -> tuple[float, float]: ...
    @property
    def curved(self) -> bool: ...
    @property
    def by_moment(self) -> bool: ...


class Rates(NamedTuple):
    """dP, dQ, dτ in a step, and the moment that is added, or E*/2 times the tilt."""

    P: float
    Q: float
    tau: float
    turn: float
    by_moment: bool

    def strain(self, centre: Array, half: Array) -> Array:
        """E*/2 times the rate of the tilt of a contact.

        Where it follows from the moment M, dp = [dP/π - G dθ (x - m)]/w carries dM = m dP - π/2 G
        r² dθ.
        """
        if not self.by_moment:
            return np.full(np.shape(centre), self.turn)
        strain: Array = 2.0 * (centre * self.P - self.turn) / (math.pi * half**2)
        return strain

    def mirrored(self, direction: float) -> Rates:
        """The same in the coordinate direction × x."""
        turn = direction * self.turn
        return self._replace(tau=direction * self.tau, turn=turn)


@dataclass(frozen=True, eq=False)
class LoadChange:
    """A step between two loads, which change in proportion to its share t."""

    contacts: Contacts
    start: Loads
    end: Loads

    @cached_property
    def rates(self) -> Rates:
        """The changes of the loads in the whole step."""
        contacts = self.contacts
        (Q0, tau0), (Q, tau) = (contacts.sheared_by(at) for at in (self.start, self.end))
        turn = self.end.turn - self.start.turn
        if contacts.by_moment != contacts.curved:
            turn = 0.0  # a moment at constant P and tilt, or a tilt that the scene's moment causes
        elif not contacts.curved:
            turn *= 0.5 * contacts.scene.Estar
        return Rates(self.end.P - self.start.P, Q - Q0, tau - tau0, turn, contacts.curved)

    def loads(self, share: float) -> Loads:
        return self.start.towards(self.end, share)

    def shear(self, share: float) -> tuple[float, float]:
        """Q and τ."""
        return self.contacts.sheared_by(self.loads(share))

    def pressure(self, share: float) -> SlopeDensity:
        return self.contacts.pressure_at(self.loads(share))


class Span(NamedTuple):
    """A part of a step, which is passed in proportion to the share of the step, or to log P.

    lo, hi    shares of the step
    before    the share after which P would have grown from nothing; infinite where the share counts
    """

    lo: float
    hi: float
    before: float = math.inf

    @classmethod
    def of(cls, change: LoadChange, lo: float, hi: float) -> Span:
        """The part between two shares of a step."""
        first, last = change.loads(lo).P, change.loads(hi).P
        manyfold = last > MANYFOLD * first
        return cls(lo, hi, change.start.P / change.rates.P if manyfold else math.inf)

    @property
    def of_log(self) -> bool:
        """Whether the variable is log P."""
        return self.before < math.inf

    @property
    def length(self) -> float:
        """That of the variable."""
        return float(self._passed(np.array(self.hi)))

    def part(self, share: Array) -> Array:
        """How much of the variable has passed at a share of the step, from 0 to 1."""
        part: Array = self._passed(share) / self.length
        return part

    def share(self, part: Array) -> Array:
        """The share of the step at which so much of it has passed."""
        passed = self.length * part
        if self.of_log:
            passed = (self.lo + self.before) * np.expm1(passed)
        share: Array = np.minimum(self.lo + passed, self.hi)
        return share

    def pace(self, earlier: Array, later: Array) -> Array:
        """By how much the variable differs at two shares of the step, over their difference."""
        if not self.of_log:
            return np.ones(np.broadcast(earlier, later).shape)
        since = earlier + self.before
        grown = np.maximum((later - earlier) / since, EARLIEST)
        log = np.log1p(grown)
        return np.divide(log, grown, out=np.ones(grown.shape), where=grown != 0.0) / since

    def _passed(self, share: Array) -> Array:
        passed = share - self.lo
        if not self.of_log:
            return passed
        return np.log1p(np.maximum(passed / (self.lo + self.before), EARLIEST))


@dataclass(frozen=True, eq=False)
class Course(LoadChange):
    """A step between two loads, and its contact while both edges move smoothly.

    span       its shares of the step
    left       the left edge as a series
    right      the right edge
    """

    span: Span
    left: Array
    right: Array

    @property
    def lo(self) -> float:
        return self.span.lo

    @property
    def hi(self) -> float:
        return self.span.hi

    def edge(self, right: bool, share: Array) -> Array:
        at: Array = chebyshev.evaluate(self.right if right else self.left, self._scaled(share))
        return at

    def moved(self, right: bool, earlier: Array, later: Array) -> Array:
        """By how much an edge moves from one time to another over the time, without rounding."""
        series = self.right if right else self.left
        slope: Array = divided(series, self._scaled(earlier), self._scaled(later))
        return slope * 2.0 / self.span.length * self.span.pace(earlier, later)

    def passes(self, right: bool, x: Array) -> Array:
        """The times at which a growing edge is at x, `lo` where it was there before."""
        series, ahead = (self.right, 1.0) if right else (self.left, -1.0)
        lo, hi = np.full(x.shape, -1.0), np.full(x.shape, 1.0)
        for _ in range(HALVINGS):
            middle = 0.5 * (lo + hi)
            passed = ahead * (chebyshev.evaluate(series, middle) - x) >= 0.0
            lo, hi = np.where(passed, lo, middle), np.where(passed, middle, hi)
        at = 0.5 * (lo + hi)
        for _ in range(NEWTON):
            step = (chebyshev.evaluate(series, at) - x) / divided(series, at, at)
            at = np.clip(at - step, -1.0, 1.0)
        before = ahead * (x - self.edge(right, np.array(self.lo))) <= 0.0
        return np.where(before, self.lo, self.span.share(0.5 * (1.0 + at)))

    def times(self, share: float, number: int) -> Array:
        """So many times from a share of the step on."""
        begun = self.span.part(np.array(share))
        return self.span.share(begun + (1.0 - begun) * np.linspace(0.0, 1.0, number))

    def _scaled(self, share: Array) -> Array:
        scaled: Array = 2.0 * self.span.part(share) - 1.0
        return scaled


def divided(series: Array, a: Array, b: Array) -> Array:
    """(f(a) - f(b))/(a - b) of f = Σ c_n T_n, by the recurrence of the quotients of T_n."""
    before, now = np.zeros(np.broadcast(a, b).shape), np.ones(np.broadcast(a, b).shape)
    lower, T = np.ones(np.shape(b)), np.asarray(b, dtype=float)
    total = series[1] * now if len(series) > 1 else 0.0 * now
    for c in series[2:]:
        before, now = now, 2.0 * a * now + 2.0 * T - before
        lower, T = T, 2.0 * b * T - lower
        total = total + c * now
    return total


def course(change: LoadChange, lo: float) -> Course:
    """The course of a step from a share on, to where its edges do not go on smoothly."""
    span = Span.of(change, lo, 1.0)
    while span.hi - lo >= SHORTEST:
        for terms in OF_LOG if span.of_log else DEGREES:
            shares = span.share(0.5 * (1.0 + chebyshev.points(terms)))
            edges = [change.pressure(share).contact for share in shares.tolist()]
            series = chebyshev.transform(np.array([(e.x1, e.x2) for e in edges]).T)
            r = max(edge.r for edge in edges)
            if np.abs(series[:, -2:]).max() <= RESOLVED * r:
                left, right = (c[: chebyshev.chopped_length(c, EPS * r)] for c in series)
                return Course(change.contacts, change.start, change.end, span, left, right)
        span = Span.of(change, lo, float(span.share(np.array(0.25))))
    raise ContactError("the edges of the contact do not move smoothly")


class SmoothEdges:
    """The courses of a step, one after the other."""

    def __init__(self, change: LoadChange) -> None:
        self.change = change
        self._last: Course | None = None

    def at(self, share: float) -> Course:
        """The course that a share of the step is on; shares do not fall.

        A series of log P becomes shorter as P has grown.
        """
        last = self._last
        if last is None or share >= last.hi or (share > last.lo and last.span.of_log):
            self._last = last = course(self.change, share)
        return last
