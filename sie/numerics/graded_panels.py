"""Functions with roots at marks: rules and Chebyshev series on panels graded towards them.

Between two neighbouring marks [lo, hi] a place is

    x = lo + L sin²(π v/2) = hi - L cos²(π v/2),      0 <= v <= 1,

so that a series in the root of the distance from a mark is one in v. Panels of v shrink towards
both marks, for what has its next singularity just beyond one. Distances from both marks are kept,
and differences of places are formed from them, never by subtraction of places.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import chebyshev
from .chord import Points

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

# Breaks of v from a mark to the middle: of series, and of rules, which have to resolve what lies
# across a mark at the distances of the first panel of a series.
OF_SERIES = (0.0, 2e-4, 1.5e-3, 0.01, 0.06, 0.2, 0.5)
OF_RULES = (0.0, 3e-8, 4e-7, 4e-6, 4e-5, 3e-4, 2e-3, 0.012, 0.06, 0.2, 0.5)
DEGREE = 16  # terms of a series on a panel
NEAREST = 0.4  # of the distance of a singularity: so far reaches the first panel at most
NODES = 14  # of Gauss-Legendre on a panel


class Shares(NamedTuple):
    """Places between two marks, as shares of their distance from each, and weights."""

    lo: Array
    hi: Array
    weight: Array


def _shares(breaks: Sequence[float], s: Array, weight: Array) -> Shares:
    """Nodes s in [-1, 1] of each panel, from the left mark to the right one."""
    ends = np.array(breaks)
    half = 0.5 * np.diff(ends)[:, None]
    u = (ends[:-1, None] + half * (1.0 + s)).ravel()
    near, far = np.sin(0.5 * np.pi * u) ** 2, np.cos(0.5 * np.pi * u) ** 2
    pace = (0.5 * np.pi * np.sin(np.pi * u)).reshape(len(half), -1)
    w = (half * weight * pace).ravel()
    return Shares(np.append(near, far[::-1]), np.append(far, near[::-1]), np.append(w, w[::-1]))


@lru_cache(maxsize=16)
def gauss_shares(breaks: Sequence[float] = OF_RULES, nodes: int = NODES) -> Shares:
    """Nodes and weights of the rule between two marks at the distance 1."""
    return _shares(breaks, *np.polynomial.legendre.leggauss(nodes))


def breaks_for(beyond: float) -> tuple[float, ...]:
    """Breaks of a rule for what has its next singularity so far beyond an end, in v."""
    following = (*OF_RULES[2:], math.inf)
    kept = (b for b, c in zip(OF_RULES[1:], following, strict=True) if c > NEAREST * beyond)
    return 0.0, *kept


@lru_cache(maxsize=8)
def _series_shares() -> Shares:
    s = chebyshev.points(DEGREE)
    return _shares(OF_SERIES, s, np.zeros(DEGREE))


@dataclass(frozen=True, eq=False)
class Rule:
    """Places in intervals between marks, with weights.

    ends      the intervals, (n, 2)
    lo, hi    for each place the interval that it is in
    from_lo   its distance from lo
    from_hi   that from hi
    weight    of the integral over all intervals
    """

    ends: Array
    lo: Array
    hi: Array
    from_lo: Array
    from_hi: Array
    weight: Array

    @classmethod
    def of(cls, ends: Array, shares: Shares) -> Rule:
        """The same shares of each interval."""
        ends = np.asarray(ends, dtype=float).reshape(-1, 2)
        lo, hi = (np.repeat(e, len(shares.lo)) for e in ends.T)
        length = (ends[:, 1] - ends[:, 0])[:, None]
        return cls(
            ends,
            lo,
            hi,
            (length * shares.lo).ravel(),
            (length * shares.hi).ravel(),
            (length * shares.weight).ravel(),
        )

    @classmethod
    def graded(cls, ends: Array, breaks: Sequence[float] = OF_RULES) -> Rule:
        """The rule of Gauss and Legendre on panels graded to all ends."""
        return cls.of(ends, gauss_shares(breaks))

    def part(self, k: int) -> tuple[slice, Rule]:
        """The indices and the places of interval k, of those that have all as many places."""
        each = len(self.lo) // len(self.ends)
        at = slice(k * each, (k + 1) * each)
        return at, self.among(at, self.ends[k : k + 1])

    def among(self, at: Any, ends: Array | None = None) -> Rule:
        """Some of the places."""
        arrays = (self.lo, self.hi, self.from_lo, self.from_hi, self.weight)
        return Rule(self.ends if ends is None else ends, *(a[at] for a in arrays))

    @cached_property
    def points(self) -> Points:
        """The places, from the nearer mark."""
        near_lo = self.from_lo < self.from_hi
        anchor, offset = (self.lo, self.hi), (self.from_lo, -self.from_hi)
        return Points(np.where(near_lo, *anchor), np.where(near_lo, *offset))

    @property
    def x(self) -> Array:
        """The places, rounded."""
        return np.asarray(self.points.x)

    def apart(self, e: float) -> Array:
        """x - e for a place e that lies in none of the intervals."""
        right = e <= 0.5 * (self.lo + self.hi)
        return np.where(right, (self.lo - e) + self.from_lo, (self.hi - e) - self.from_hi)

    def apart_from(self, e: float) -> Array:
        """x - e for a place e that may lie anywhere but close to a place inside an interval."""
        near_lo = np.abs(self.lo - e) < np.abs(self.hi - e)
        return np.where(near_lo, (self.lo - e) + self.from_lo, (self.hi - e) - self.from_hi)

    def from_all(self, other: Rule) -> Array:
        """x - y as a matrix, y the places of a rule on other intervals."""
        columns = []
        for k, (lo, hi) in enumerate(other.ends):
            n = len(other.lo) // len(other.ends)
            part = slice(k * n, (k + 1) * n)
            right = (0.5 * (self.lo + self.hi) > 0.5 * (lo + hi))[:, None]
            columns.append(
                np.where(
                    right,
                    ((self.lo - hi) + self.from_lo)[:, None] + other.from_hi[part],
                    ((self.hi - lo) - self.from_hi)[:, None] - other.from_lo[part],
                )
            )
        return np.concatenate(columns, axis=1) if columns else np.zeros((len(self.lo), 0))


@dataclass(frozen=True, eq=False)
class Pieces:
    """A function as Chebyshev series on panels between marks; 0 beyond them.

    ends      the intervals between marks, (n, 2), ascending
    series    their coefficients, (n, panels, terms); panels from the left mark to the right one
    """

    ends: Array
    series: Array

    @classmethod
    def fitted(cls, ends: Array, values: Callable[[Rule], Array]) -> Pieces:
        """The function that has these values at the places of a rule on the intervals."""
        rule = cls.places(ends)
        return cls(rule.ends, cls.of_values(rule.ends, values(rule)))

    @staticmethod
    def of_values(ends: Array, values: Array) -> Array:
        """The series of values at `places`."""
        return chebyshev.transform(values.reshape(len(ends), -1, DEGREE))

    @staticmethod
    def places(ends: Array) -> Rule:
        """The places by whose values a function is fitted."""
        return Rule.of(ends, _series_shares())

    @classmethod
    def integral(cls, places: Rule, values: Array) -> Pieces:
        """The integral of a function of these values at `places`, from the first mark on."""
        half = 0.5 * np.diff(OF_SERIES)
        half = np.repeat(np.append(half, half[::-1]), DEGREE)
        stretched = values * np.pi * np.sqrt(places.from_lo * places.from_hi)
        pace = (stretched.reshape(len(places.ends), -1) * half).ravel()
        series = chebyshev.antiderivative(cls.of_values(places.ends, pace))
        whole = series.sum(axis=-1)
        before = np.cumsum(np.append(0.0, whole.ravel()[:-1])).reshape(whole.shape)
        series[..., 0] += before
        return cls(places.ends, series)

    @property
    def last(self) -> float:
        """The value at the last mark."""
        return float(self.series[-1, -1].sum())

    @property
    def marks(self) -> Array:
        """All ends, ascending."""
        return np.unique(self.ends)

    def __call__(self, x: Array) -> Array:
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        k = self._interval(flat)
        lo, hi = self.ends[k].T
        inside = (flat >= lo) & (flat <= hi)
        found = self._at(k, np.maximum(flat - lo, 0.0), np.maximum(hi - flat, 0.0))
        out: Array = np.where(inside, found, 0.0 * flat).reshape(x.shape)
        return out

    def on(self, rule: Rule) -> Array:
        """The values at the places of a rule, no interval of which has a mark inside."""
        middle = 0.5 * (rule.lo + rule.hi)
        k = self._interval(middle)
        lo, hi = self.ends[k].T
        from_lo = np.maximum((rule.lo - lo) + rule.from_lo, 0.0)
        from_hi = np.maximum((hi - rule.hi) + rule.from_hi, 0.0)
        inside = (middle > lo) & (middle < hi)
        return np.where(inside, self._at(k, from_lo, from_hi), 0.0)

    def _interval(self, x: Array) -> Ints:
        k: Ints = np.searchsorted(self.ends[:, 0], x, side="right") - 1
        return np.clip(k, 0, len(self.ends) - 1)

    def _at(self, k: Ints, from_lo: Array, from_hi: Array) -> Array:
        left = from_lo < from_hi
        near = np.where(left, from_lo, from_hi)
        u = np.arcsin(np.sqrt(np.minimum(near / (from_lo + from_hi), 0.5))) * (2.0 / np.pi)
        ends = np.array(OF_SERIES)
        panel = np.clip(np.searchsorted(ends, u, side="right") - 1, 0, len(ends) - 2)
        s = 2.0 * (u - ends[panel]) / (ends[panel + 1] - ends[panel]) - 1.0
        s, panel = np.where(left, s, -s), np.where(left, panel, 2 * len(ends) - 3 - panel)
        c = self.series[k, panel].T
        above, now, twice = np.zeros_like(s), c[-1], 2.0 * s
        for row in c[-2:0:-1]:
            above, now = now, row + twice * now - above
        found: Array = c[0] + s * now - above
        return found


def principal_value(
    source: Rule,
    density: tuple[Array, Array],
    x: Rule,
    roots: tuple[bool, bool],
    chord: Callable[[Array], Array],
) -> Array:
    """PV∫ ν'(t)/d(x, t) dt over the one interval of a rule, at places x in it.

    density   ν' at the places of the rule, and at x
    roots     whether ν' is like 1/sqrt(distance) at the left end, and at the right one

    With h = ν' σ, σ the root of the distances from such ends, h(x)/σ is subtracted under the
    integral, and its own integral added.
    """
    lo, hi = source.ends[0]
    from_lo, from_hi = (x.lo - lo) + x.from_lo, (hi - x.hi) + x.from_hi
    sigma, sigma_x = np.ones_like(source.lo), np.ones_like(from_lo)
    for rooted, near, near_x in zip(
        roots, (source.from_lo, source.from_hi), (from_lo, from_hi), strict=True
    ):
        if rooted:
            sigma, sigma_x = sigma * np.sqrt(near), sigma_x * np.sqrt(near_x)
    low = (from_lo[:, None] < 0.5 * (hi - lo)) & (source.from_lo < 0.5 * (hi - lo))
    step = np.where(low, from_lo[:, None] - source.from_lo, source.from_hi - from_hi[:, None])
    h_x = (density[1] * sigma_x)[:, None]
    inner = (density[0] * sigma * (step / chord(step)) - h_x) / step
    own = {
        (False, False): np.log(from_lo / from_hi),
        (True, False): -np.log(from_hi / (np.sqrt(hi - lo) + np.sqrt(from_lo)) ** 2),
        (False, True): np.log(from_lo / (np.sqrt(hi - lo) + np.sqrt(from_hi)) ** 2),
        (True, True): 0.0 * from_lo,
    }[roots]
    found: Array = inner @ (source.weight / sigma) + density[1] * own
    return found
