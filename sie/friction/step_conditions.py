"""Conditions of a load step that depend on the zones of stick and of contact alone."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval

Array = NDArray[np.float64]

# Parts of a step at which its conditions are tested.
TESTED = (0.05, 0.25, 0.5, 0.75, 1.0)
# of a change of load, and of a half-width: by so much a condition may be missed, which is rounding
SLACK = 1e-11


def opens(front: complex, zone: Interval, contact: Interval, arm: float) -> bool:
    """Whether slip beside a stick zone keeps its direction out to both edges of contact."""
    lengths = zone.x1 - contact.x1, contact.x2 - zone.x2
    turn = math.pi * zone.r / arm * front.imag if front.imag else 0.0
    if zone.r == 0.0:
        return front.real >= 0.0
    for length, outward in zip(lengths, (turn, -turn), strict=True):
        v = 1.0 + max(length, 0.0) / zone.r
        beside = math.acosh(v) / math.sqrt((v - 1.0) * (v + 1.0)) if v > 1.0 else 1.0
        if front.real * beside + outward < -SLACK * abs(front):
            return False
    return True


def inside(one: Interval, other: Interval) -> bool:
    slack = SLACK * (other.r + abs(other.m))
    return one.x1 >= other.x1 - slack and one.x2 <= other.x2 + slack


def reached(change: complex, contact: Interval, arm: float) -> float:
    """How near to the other edge slip comes that goes on at an edge which holds up a new front.

    The end of that slip advances, and the change of κ S - Λ is 0 at it: it comes no nearer than the
    end of a zone from the other edge for which that holds.
    """
    width = 2.0 * arm / math.pi * abs(change.real / change.imag) if change.imag else math.inf
    return min(width, 2.0 * contact.r)


class Zones(ABC):
    """Zones of contact or of stick, as the conditions of a step need them.

    intervals    (lo, hi), ascending
    two_signed   whether slip in opposite directions at the edges of this contact is solved
    """

    two_signed = False

    @property
    @abstractmethod
    def intervals(self) -> tuple[tuple[float, float], ...]: ...

    @abstractmethod
    def at_ends(self, change: complex) -> Array:
        """The effect of a change of Λ or S at the ends, each times a positive factor."""

    @abstractmethod
    def opens(self, front: complex, contact: Zones) -> bool:
        """Whether slip beside these stick zones keeps its direction out to the edges of contact."""

    def lie_in(self, others: Zones) -> bool:
        """Whether each of these zones lies in one of the others."""
        return all(
            any(inside(Interval(*one), Interval(*other)) for other in others.intervals)
            for one in self.intervals
        )

    def __str__(self) -> str:
        return " and ".join(f"[{lo:.6g}, {hi:.6g}]" for lo, hi in self.intervals) or "none"


@dataclass(frozen=True)
class OneZone(Zones):
    """One zone, and the length by which bulk stress and tilt are made forces."""

    zone: Interval
    arm: float
    two_signed = True

    @property
    def intervals(self) -> tuple[tuple[float, float], ...]:
        return ((self.zone.x1, self.zone.x2),)

    def at_ends(self, change: complex) -> Array:
        turn = math.pi * self.zone.r / self.arm * change.imag if change.imag else 0.0
        return np.array([change.real + turn, change.real - turn])

    def opens(self, front: complex, contact: Zones) -> bool:
        whole = Interval(contact.intervals[0][0], contact.intervals[-1][1])
        return opens(front, self.zone, whole, self.arm)
