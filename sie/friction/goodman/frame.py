"""The end of a zone that Q may slip in Goodman's approximation, and what the shear lacks there."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.friction.slip_zones import EdgeFrame, SlipZone
from sie.numerics.gauss_jacobi import gauss_jacobi

Array = NDArray[np.float64]

NODES = 16
NEAREST = 1e-17  # of the half-width, to a singularity that x may be on
GROWTH = 2.0  # a panel's length over its distance from the singularity
FAR = 1e300  # stands for no singularity


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


def totals(owner: NDArray[np.intp], values: Array, n: int) -> Array:
    """The sums of rows of values that belong to each of n intervals."""
    total: Array = np.bincount(owner, values.sum(axis=1), minlength=n).astype(float)
    return total


def shrinking(length: Array, before: Array, after: Array) -> tuple[Array, ...]:
    """Panels of intervals, as arrays.

    These are the interval of each, its beginning, its length, what is left behind it, and the
    number of its rule: at the start, between, or at the end.

    From either end they grow in proportion to the distance from the singularity beyond it.
    """
    first = np.where(np.isinf(after), length, 0.5 * length)
    owner, k, start, size = geometric(first, before)
    backwards, j, behind, back = geometric(length - first, after)
    return (
        np.concatenate((owner, backwards)),
        np.concatenate((start, length[backwards] - behind - back)),
        np.concatenate((size, back)),
        np.concatenate((length[owner] - start - size, behind)),
        np.concatenate((np.minimum(k, 1), np.where(j == 0, 2, 1))),
    )


def geometric(length: Array, scale: Array) -> tuple[Any, ...]:
    """(owner, number, beginning, length) of panels that grow with the distance from -scale."""
    scale = np.minimum(scale, FAR)
    folds = np.log1p(length / scale)
    count = np.ceil(folds / math.log1p(GROWTH)).astype(np.intp)
    owner = np.repeat(np.arange(len(count)), count)
    k = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    ratio, scale = (folds / np.maximum(count, 1))[owner], scale[owner]
    start = scale * np.expm1(k * ratio)
    return owner, k, start, scale * np.expm1((k + 1) * ratio) - start
