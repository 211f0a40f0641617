"""Conditions of a load step that depend on the zones of stick and of contact alone."""

from __future__ import annotations

import math

from sie.numerics.interval import Interval

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
