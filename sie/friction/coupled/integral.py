"""Antiderivatives by Chebyshev series, on panels that shrink towards both ends."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .half_potential import DISTANT

Array = NDArray[np.float64]

DEGREE = 16
RATIO, NEAREST = 3.0, 1e-14  # of panels towards an end: growth, and the first, in parts of the zone
# Panels beside a contact: the first, in half-widths, where H has a power of the distance; growth
NEAR_EDGE, FARTHER = 1e-9, 4.0


class Integral(NamedTuple):
    """∫f from cuts[0] to x, from Chebyshev series of f on panels between the cuts, which ascend."""

    cuts: Array
    series: Array
    before: Array

    def __call__(self, x: Array) -> Array:
        k = np.clip(np.searchsorted(self.cuts, x) - 1, 0, len(self.cuts) - 2)
        lo, hi = self.cuts[k], self.cuts[k + 1]
        part = chebyshev.evaluate(self.series.T[:, k], 2.0 * (x - lo) / (hi - lo) - 1.0)
        values: Array = self.before[k] + part
        return values


def integral(function: Callable[[Array], Array], cuts: Array) -> Integral:
    """The antiderivative of a function that the panels resolve."""
    half = 0.5 * np.diff(cuts)
    x = cuts[:-1, None] + half[:, None] * (1.0 + chebyshev.points(DEGREE))
    c = chebyshev.transform(function(x.ravel()).reshape(x.shape))
    series = half[:, None] * chebyshev.antiderivative(c)
    return Integral(cuts, series, np.append(0.0, np.cumsum(series.sum(axis=1))[:-1]))


def towards_ends(lo: float, hi: float, inner: Array) -> Array:
    """Cuts of [lo, hi] that shrink towards both ends, with those inside."""
    levels = math.ceil(math.log(1.0 / NEAREST) / math.log(RATIO))
    near = 0.5 * (hi - lo) * RATIO ** -np.arange(levels, -0.5, -1.0)
    cuts = np.concatenate(([lo], lo + near, hi - near, [hi], inner[(inner > lo) & (inner < hi)]))
    return np.unique(cuts)


def outwards(function: Callable[[Array], Array], distances: Array, width: float) -> Array:
    """∫f from 0 to each distance from an edge, or DISTANT, where f has a power of the distance."""
    distances = np.minimum(distances, DISTANT * width)
    far = float(distances.max())
    first = min(NEAR_EDGE * width, far)
    levels = math.ceil(math.log(far / first, FARTHER)) if far > first else 0
    cuts = np.append(0.0, np.minimum(first * FARTHER ** np.arange(levels + 1.0), far))
    return integral(function, np.unique(cuts))(distances)
