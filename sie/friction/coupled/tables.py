"""Places on 0 <= t <= 1, and tables of functions that vary ever faster towards both ends."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .panels import APART, stretched

Array = NDArray[np.float64]

LENGTH, DEGREE = 1.0, 14  # of a panel of v, and of its series: (2 π + 6.4)^-14 is rounding
STRAIGHT = 0.5  # no longer in v, one panel is straight
# Of ln((y - m)/(n - y)): the panel next to the middle ends at MIDDLE and is straight in its inverse
# hyperbolic sine, times BEND; those beyond have one length; and their series
MIDDLE, BEND, LOG_LENGTH, LOG_DEGREE = 5.0, 0.3, 3.0, 28
STEEPEST = 8.0  # a power that such a panel resolves
NEAREST = 1e-6  # of the last mark: next to marks y has too few digits for a series in v
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
    """Chebyshev series of a function of t and e = 1 - t from one place to another, both given so.

    The function may be singular before the first and after the last place, by these distances; the
    panels are equally long in v of `stretched`. It keeps the relative distances from both.
    """

    def __init__(
        self,
        start: tuple[float, float],
        end: tuple[float, float],
        singular: tuple[float, float],
        function: Callable[[Array, Array], Array],
    ) -> None:
        self._start, self._end = start, end
        length = self._ahead(*end)
        before, after = (min(distance, APART * length) for distance in singular)
        whole = math.log1p(length / before) + math.log1p(length / after)
        n = math.ceil(whole / LENGTH) if whole > STRAIGHT else 1
        part = 0.5 * (1.0 + chebyshev.points(DEGREE))
        grown = (np.arange(n)[:, None] + part).ravel() / n
        left = grown[::-1]
        self._singular = (before, after) if whole > STRAIGHT else None
        self._per_panel, self._first = n / whole, math.log(before / (after + length))
        if self._singular:
            grown, left, _ = stretched(length, before, after, whole * grown, whole * left)
        else:
            grown, left, self._per_panel = length * grown, length * left, 1.0 / length
        values = function(start[0] + grown, end[1] + left)
        self.series = _in_powers() @ chebyshev.transform(values.reshape(n, DEGREE)).T

    def __call__(self, t: Array, e: Array) -> Array:
        place = self._ahead(t, e)
        if self._singular:
            (before, after), (t1, e1) = self._singular, self._end
            left = e - e1 if e1 < 0.5 else t1 - t
            place = np.log((before + place) / (after + left)) - self._first
        place = self._per_panel * place
        k = np.clip(place.astype(np.intp), 0, self.series.shape[1] - 1)
        place -= k
        place *= 2.0
        place -= 1.0
        values = self.series[-1][k]
        for c in self.series[-2::-1]:
            values *= place
            values += c[k]
        return values

    def _ahead(self, t: Any, e: Any) -> Any:
        """The distance from the start."""
        return t - self._start[0] if self._start[0] < 0.5 else self._start[1] - e


@lru_cache(maxsize=1)
def _in_powers() -> Array:
    """The matrix that takes a Chebyshev series to powers.

    Series have few terms, which decay, and lose no digits.
    """
    rows = [np.polynomial.chebyshev.cheb2poly(row) for row in np.eye(DEGREE)]
    matrix = np.zeros((DEGREE, DEGREE))
    for n, row in enumerate(rows):
        matrix[: len(row), n] = row
    return matrix


def chopped(c: Array, least: float = CHOP) -> Array:
    """A series without its last coefficients below this part of the largest one."""
    kept = np.flatnonzero(np.abs(c) > least * np.abs(c).max())
    return c[: kept[-1] + 1] if kept.size else c[:1]


def summed(c: Array, y: Array) -> Array:
    """Σ c_n T_n(y) by Clenshaw's recurrence, for numbers c_n or a column of them.

    For many points it takes half the time in three arrays.
    """
    twice, higher, high = 2.0 * y, np.zeros_like(y), np.empty_like(y)
    high[...] = c[-1] if len(c) > 1 else 0.0
    spare = np.empty_like(y)
    for a in c[-2:0:-1]:
        np.multiply(twice, high, out=spare)
        spare -= higher
        spare += a
        higher, high, spare = high, spare, higher
    high *= y
    high -= higher
    high += c[0]
    return high


def interpolated(
    function: Callable[[Array], Array], marks: Array, y: Array, power: float = 1.0
) -> Array:
    """A costly function at many places y between the first and the last mark, from few values.

    It varies like such a power. Between two marks m and n, next to which the function may have any
    powers of the distance, it is analytic in v = ln((y - m)/(n - y)) for |Im v| < π: Chebyshev
    series on panels of v, which are longer next to the marks, as it varies less there. Where a
    panel has no more places than its series has nodes, the values are the function's own.
    """
    gap = np.clip(np.searchsorted(marks, y) - 1, 0, len(marks) - 2)
    above, below = y - marks[gap], marks[gap + 1] - y
    far = np.flatnonzero(np.minimum(above, below) > NEAREST * marks[-1])
    parts = math.ceil(power / STEEPEST)
    place = _numbered(np.log(above[far] / below[far]), parts)
    panel = np.floor(place)
    # No place is so deep between two marks as so many panels
    most = parts + math.ceil(-math.log(NEAREST) / LOG_LENGTH)
    codes, which, count = np.unique(
        2 * most * gap[far] + most + panel.astype(np.intp), return_inverse=True, return_counts=True
    )
    often = count > LOG_DEGREE
    if not often.any():
        return function(y)
    served = often[which]
    own = np.ones(len(y), dtype=np.bool_)
    own[far[served]] = False
    k, number = np.divmod(codes[often], 2 * most)
    nodes = _nodes(number - most, parts, marks[k], marks[k + 1])
    known = function(np.concatenate((nodes.ravel(), y[own])))
    series = chebyshev.transform(known[: nodes.size].reshape(nodes.shape)).T
    column = (np.cumsum(often) - 1)[which[served]]
    values, at = np.empty(len(y)), 2.0 * (place - panel)[served] - 1.0
    values[own] = known[nodes.size :]
    values[far[served]] = chebyshev.evaluate(series[:, column], at)
    return values


def _nodes(number: NDArray[np.intp], parts: int, m: Array, n: Array) -> Array:
    """The Chebyshev points y of panels of these numbers between the marks m and n, as rows."""
    v = _from_number(number[:, None] + 0.5 * (1.0 + chebyshev.points(LOG_DEGREE)), parts)
    ratio = np.exp(-np.abs(v))
    near = (n - m)[:, None] * ratio / (1.0 + ratio)
    return np.where(v < 0.0, m[:, None] + near, n[:, None] - near)


def _numbered(v: Array, parts: int) -> Array:
    """The place v counted in panels from the middle: so many up to MIDDLE, then equally long."""
    size = np.abs(v)
    inner = np.arcsinh(BEND * size) * (parts / math.asinh(BEND * MIDDLE))
    return np.copysign(np.where(size < MIDDLE, inner, parts + (size - MIDDLE) / LOG_LENGTH), v)


def _from_number(place: Array, parts: int) -> Array:
    """v at such a place."""
    size = np.abs(place)
    inner = np.sinh(np.minimum(size, parts) * (math.asinh(BEND * MIDDLE) / parts)) / BEND
    return np.copysign(np.where(size < parts, inner, MIDDLE + LOG_LENGTH * (size - parts)), place)
