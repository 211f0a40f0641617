"""The contact during a step, and the rates at which its loads change.

Each edge is a Chebyshev series of the share t of the step, for as long as it moves smoothly.
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
RESOLVED = 1e-13  # of the contact: what the last terms of a series leave
SHORTEST = 1e-7  # part of a step in which the edges are one series
NEWTON = 40


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


@dataclass(frozen=True, eq=False)
class Course(LoadChange):
    """A step between two loads, and its contact while both edges move smoothly.

    lo, hi     shares of the step
    left       the left edge as a series of the share
    right      the right edge
    """

    lo: float
    hi: float
    left: Array
    right: Array

    def edge(self, right: bool, share: Array) -> Array:
        at: Array = chebyshev.evaluate(self.right if right else self.left, self._scaled(share))
        return at

    def moved(self, right: bool, earlier: Array, later: Array) -> Array:
        """By how much an edge moves from one time to another over the time, without rounding."""
        series = self.right if right else self.left
        slope: Array = divided(series, self._scaled(earlier), self._scaled(later))
        return slope * 2.0 / (self.hi - self.lo)

    def passes(self, right: bool, x: Array) -> Array:
        """The times at which a growing edge is at x, `lo` where it was there before."""
        lo, hi = np.full(x.shape, self.lo), np.full(x.shape, self.hi)
        ahead = 1.0 if right else -1.0
        for _ in range(NEWTON):
            middle = 0.5 * (lo + hi)
            passed = ahead * (self.edge(right, middle) - x) >= 0.0
            lo, hi = np.where(passed, lo, middle), np.where(passed, middle, hi)
            if (hi - lo).max(initial=0.0) <= 1e-3 * (self.hi - self.lo):
                break
        time = 0.5 * (lo + hi)
        for _ in range(6):
            step = (self.edge(right, time) - x) / self.moved(right, time, time)
            time = np.clip(time - step, self.lo, self.hi)
        return np.where(ahead * (x - self.edge(right, np.array(self.lo))) <= 0.0, self.lo, time)

    def _scaled(self, share: Array) -> Array:
        return ((share - self.lo) - (self.hi - share)) / (self.hi - self.lo)


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
    hi = 1.0
    while hi - lo >= SHORTEST:
        for terms in DEGREES:
            shares = lo + (hi - lo) * 0.5 * (1.0 + chebyshev.points(terms))
            edges = [change.pressure(share).contact for share in shares.tolist()]
            series = chebyshev.transform(np.array([(e.x1, e.x2) for e in edges]).T)
            r = max(edge.r for edge in edges)
            if np.abs(series[:, -2:]).max() <= RESOLVED * r:
                left, right = (c[: chebyshev.chopped_length(c, EPS * r)] for c in series)
                return Course(change.contacts, change.start, change.end, lo, hi, left, right)
        hi = lo + 0.25 * (hi - lo)
    raise ContactError("the edges of the contact do not move smoothly")


class SmoothEdges:
    """The courses of a step, one after the other."""

    def __init__(self, change: LoadChange) -> None:
        self.change = change
        self._last: Course | None = None

    def at(self, share: float) -> Course:
        """The course that a share of the step is on; shares do not fall."""
        if self._last is None or share >= self._last.hi:
            self._last = course(self.change, share)
        return self._last
