"""Places on 0 <= t <= 1, and tables of functions that vary ever faster towards both ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

Array = NDArray[np.float64]

DEGREE = 20  # of a panel as far from every singularity as it is long: (3 + sqrt(8))^-20 is rounding
LEAST = 1e-320
ROUNDING = 1e-9  # of a panel: no shorter one ends a table
CHOP = 2e-17  # of the largest coefficient


class Points(NamedTuple):
    """Places of t, with 1 - t and |t - c|, and a weight each."""

    t: Array
    rest: Array
    from_c: Array
    weight: Array

    def times(self, values: Array) -> Points:
        return self._replace(weight=self.weight * values)


def joined(*parts: Points) -> Points:
    """The places of all rules, in their order."""
    return Points(*(np.concatenate(column) for column in zip(*parts, strict=True)))


class Table:
    """Chebyshev series on panels of t, given t and e = 1 - t: relative to the distance from both
    ends.
    """

    def __init__(
        self, cuts: list[tuple[float, float]], function: Callable[[Array, Array], Array]
    ) -> None:
        ends = np.array(cuts)
        lo, hi = ends[:-1], ends[1:]
        self._in_t = hi[:, 0] <= 0.5
        self._keys = _key(lo[:, 0], lo[:, 1])
        column = np.where(self._in_t, 0, 1)
        rows = np.arange(len(lo))
        self._start, self._scale = lo[rows, column], 2.0 / (hi - lo)[rows, column]
        part = 0.5 * (1.0 + chebyshev.points(DEGREE))
        t, e = (lo[:, [k]] + (hi - lo)[:, [k]] * part for k in (0, 1))
        series = chebyshev.transform(function(t.ravel(), e.ravel()).reshape(t.shape))
        self.series = [chopped(row) for row in series]

    def __call__(self, t: Array, e: Array) -> Array:
        if len(self.series) == 1:
            return self._on(0, t if self._in_t[0] else e)
        k = np.searchsorted(self._keys, _key(t, e), side="right") - 1
        values = np.empty(k.shape)
        k = np.maximum(k, 0)
        for j in np.unique(k).tolist():
            here = k == j
            values[here] = self._on(j, (t if self._in_t[j] else e)[here])
        return values

    def _on(self, k: int, place: Array) -> Array:
        return summed(self.series[k], self._scale[k] * (place - self._start[k]) - 1.0)


def chopped(c: Array) -> Array:
    """A series without the last coefficients that are below rounding."""
    kept = np.flatnonzero(np.abs(c) > CHOP * np.abs(c).max())
    return c[: kept[-1] + 1] if kept.size else c[:1]


def summed(c: Array, y: Array) -> Array:
    """Σ c_n T_n(y) by Clenshaw's recurrence in three arrays: of many points it takes half the
    time.
    """
    twice, higher, high = 2.0 * y, np.zeros_like(y), np.full_like(y, c[-1] if len(c) > 1 else 0.0)
    spare = np.empty_like(y)
    for a in c[-2:0:-1].tolist():
        np.multiply(twice, high, out=spare)
        spare -= higher
        spare += a
        higher, high, spare = high, spare, higher
    high *= y
    high -= higher
    high += c[0]
    return high


def _key(t: Array, e: Array) -> Array:
    """A function that grows with t and keeps the relative distances from 0 and 1."""
    low = t < 0.5
    size = np.log2(np.maximum(np.where(low, t, e), LEAST))
    key: Array = np.where(low, size, -size)
    return key


def panel_cuts(
    start: tuple[float, float],
    end: tuple[float, float],
    longest: Callable[[float, float], float],
) -> list[tuple[float, float]]:
    """Ends of panels from start to end as (t, 1 - t), one of them at 1/2, no longer than `longest`
    at their start.
    """
    cuts = [start]
    while cuts[-1] != end:
        t, e = cuts[-1]
        length = longest(t, e)
        if t < 0.5:
            length = min(length, 0.5 - t)
        t, e = (t + length, 1.0 - (t + length)) if t < 0.5 else (1.0 - (e - length), e - length)
        left = end[0] - t if end[0] <= 0.5 else e - end[1]
        cuts.append((t, e) if left > ROUNDING * length else end)
    return cuts
