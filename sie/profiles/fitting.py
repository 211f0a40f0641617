"""Properties of a trace: its gaps, its outliers, its line."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS

Array = NDArray[np.float64]

FENCE = 6.0  # interquartile ranges above the upper quartile, and half a median more: a gap
DEVIANT = 5.0  # standard deviations: with Gaussian noise 1 of 20 traces of 1e5 points has one
GAUSSIAN = 1.4826  # standard deviations in the median of the absolute value
CONFIRMED = 2.0  # standard deviations
ROUNDS = 4
NEXT = 3  # points on one side of a point that is judged
NEIGHBOURS = 6  # points on one side through which a parabola is laid
FEWEST_NEIGHBOURS = 4
LOOKED_AT = 30  # points on one side, among which the neighbours are chosen
MOST_EXAMINED = 1000  # points


class Gap(NamedTuple):
    """An interval without points: its ends, and how many points of the typical step are missing."""

    lo: float
    hi: float
    missing: int


def gaps(x: Array) -> tuple[Gap, ...]:
    """Steps much longer than the others (Tukey's fence): irregular or graded points are no gaps."""
    step = np.diff(x)
    lower, middle, upper = np.quantile(step, (0.25, 0.5, 0.75)).tolist()
    wide = np.flatnonzero(step > upper + 0.5 * middle + FENCE * (upper - lower))
    missing = np.maximum(np.round(step[wide] / middle) - 1.0, 1.0).astype(int)
    return tuple(map(Gap, x[wide].tolist(), x[wide + 1].tolist(), missing.tolist()))


def outliers(x: Array, h: Array) -> tuple[int, ...]:
    """Indices of the points that stand out of the noise, ascending.

    A point is judged by a cubic through the next points on both sides: it is off if it misses that
    by many times the median. A corner or a kink of a trace without noise does so too. So the point
    must also lie off both parabolas through its neighbours, left and right, to the same side. The
    points next to an end are not judged. The search is repeated without the points that it found.
    """
    kept = np.arange(len(x))
    for _ in range(ROUNDS):
        outstanding = _outstanding(x[kept], h[kept])
        if not outstanding:
            break
        kept = np.delete(kept, outstanding)
    return tuple(np.setdiff1d(np.arange(len(x)), kept).tolist())


def _outstanding(x: Array, h: Array) -> list[int]:
    if len(x) <= 2 * NEXT:
        return []
    middle = np.arange(NEXT, len(x) - NEXT)
    near = middle[:, None] + np.delete(np.arange(-NEXT, NEXT + 1), NEXT)
    weights = _extrapolation(x[near], x[middle], 3)
    miss = np.zeros(len(x))
    miss[middle] = np.einsum("ij,ij->i", weights, h[middle, None] - h[near])  # their sum is 1
    miss[middle] /= np.sqrt(1.0 + np.einsum("ij,ij->i", weights, weights))
    size = np.abs(miss)
    few = 1.0 + 10.0 / len(middle)  # the spread of few points is uncertain
    usual = max(few * GAUSSIAN * float(np.median(size[middle])), EPS * float(np.abs(h).max()))
    suspects = np.flatnonzero(size > DEVIANT * usual)
    largest = suspects[np.argsort(-size[suspects], kind="stable")][:MOST_EXAMINED]
    return [k for k in largest.tolist() if _confirmed(x, h, miss, k, usual)]


def _confirmed(x: Array, h: Array, miss: Array, k: int, usual: float) -> bool:
    """Whether point k is also off the parabolas through its neighbours on either side."""
    for side in _sides(k, np.abs(miss)):
        off, uncertain = _off(x, h, k, side)
        if off * np.sign(miss[k]) <= max(0.5 * abs(miss[k]), CONFIRMED * usual * uncertain):
            return False
    return True


def _sides(k: int, size: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The next neighbours on the left and on the right, without those that may be outliers."""
    start, stop = max(k - LOOKED_AT, 0), k + 1 + LOOKED_AT
    near = start + np.flatnonzero(size[start:stop] <= 0.5 * size[k])
    return near[near < k][-NEIGHBOURS:], near[near > k][:NEIGHBOURS]


def _off(x: Array, h: Array, k: int, side: NDArray[np.int64]) -> tuple[float, float]:
    """(distance of point k from the parabola through some points, its deviation by unit noise)."""
    if len(side) < FEWEST_NEIGHBOURS:
        return 0.0, 1.0
    weights = _extrapolation(x[None, side], x[k : k + 1], 2)[0]
    return float(weights @ (h[k] - h[side])), float(np.sqrt(1.0 + weights @ weights))


def _extrapolation(x: Array, target: Array, degree: int) -> Array:
    """Weights (n, m) of heights at x (n, m) in the least-squares polynomial at `target`."""
    u = (x - target[:, None]) / np.ptp(x, axis=1)[:, None]
    weights: Array = np.linalg.pinv(u[..., None] ** np.arange(degree + 1))[:, 0]
    return weights


def line(x: Array, h: Array) -> tuple[float, float]:
    """(height at x = 0, slope) of the least-squares line."""
    m = float(x.mean())
    slope = float((x - m) @ (h - h.mean()) / ((x - m) @ (x - m)))
    return float(h.mean()) - slope * m, slope
