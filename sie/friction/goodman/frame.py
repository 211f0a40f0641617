"""The end of a zone that Q may slip in Goodman's approximation, and what the shear lacks there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sie.friction.coupled.panels import shrinking
from sie.friction.coupled.profile import NEAREST
from sie.friction.slip_zones import EdgeFrame, SlipZone
from sie.numerics.gauss_jacobi import gauss_jacobi

Array = NDArray[np.float64]

NODES = 16


@dataclass(frozen=True, eq=False)
class DeficitFrame:
    """What the shear lacks of the limit, at distances inwards from the end of its zone.

    deficit     f p - q at distances from the end
    friction    f
    scale       distance beyond the end to the next place where it is not smooth
    breaks      distances of such places inside, ascending
    nearest     the width of the stick zone, as a part of a zone's length
    """

    deficit: Callable[[Array, DeficitFrame], Array]
    friction: float
    side: float
    scale: float
    breaks: tuple[float, ...]
    edge: EdgeFrame | None
    nearest: float

    def zone(self, length: float) -> SlipZone:
        """A rule for the zone of this length, in roots at its ends.

        It is graded towards the breaks, and towards the stick zone as far as a part `nearest`.
        """
        if length <= 0.0:
            none = np.zeros(0)
            return SlipZone(0.0, none, none, none, none)
        # Marks that are a rounding apart may be at one distance from an end
        ends = np.unique([0.0, *(b for b in self.breaks if b < length), length])
        width = np.diff(ends)
        before = np.full(len(width), NEAREST * length)
        before[0] = self.scale
        after = np.append(before[1:], self.nearest * width[-1])
        owner, first, size, left, kind = shrinking(width, np.minimum(before, width), after)
        x, _, w = gauss_jacobi(NODES, 0.0, 0.0)
        places = np.array([x * x, x, 1.0 - x * x])
        weights = np.array([2.0 * x * w, w, 2.0 * x * w])
        rest = np.array([1.0 - x * x, 1.0 - x, x * x])
        distance = ends[owner][:, None] + first[:, None] + size[:, None] * places[kind]
        beyond = (length - ends[1:])[owner][:, None]
        from_stick = beyond + left[:, None] + size[:, None] * rest[kind]
        weight = size[:, None] * weights[kind]
        values = self.deficit(distance.ravel(), self)
        return SlipZone(
            length,
            from_stick.ravel(),
            distance.ravel(),
            weight.ravel(),
            weight.ravel() * values / self.friction,
        )
