"""Tractions that Q changed next to a corner of the profile in the stick zone.

They are infinite at the corner, and principal values lose the digits of the distance from it. What
Q adds is smooth there: it is a series in that distance, added to the tractions under P alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

Array = NDArray[np.float64]
Function = Callable[[Array], Array]

# How far the series reaches, as a part of the distance from the ends of the stick zone, and its
# degree: an even one has no node at the corner
REACH, DEGREE = 0.05, 8


class Corner(NamedTuple):
    """A corner of the profile in the stick zone, and how far from it the series reaches."""

    place: float
    reach: float

    def corrected(self, values: Array, u: Array, direct: Function, before: Function) -> None:
        """Puts the traction at u next to the corner into `values`.

        `direct` is that under P and Q, good at a distance, and `before` that under P alone.
        """
        distance = (u - self.place) / self.reach
        near = (np.abs(distance) < 1.0) & (distance != 0.0)
        if near.any():
            nodes = self.place + self.reach * chebyshev.points(DEGREE)
            series = chebyshev.transform(direct(nodes) - before(nodes))
            values[near] = before(u[near]) + chebyshev.evaluate(series, distance[near])


def stuck_corners(corners: tuple[float, ...], e1: float, e2: float) -> tuple[Corner, ...]:
    """The corners between both ends of a stick zone."""
    inside = (place for place in corners if e1 < place < e2)
    return tuple(Corner(place, REACH * min(place - e1, e2 - place)) for place in inside)
