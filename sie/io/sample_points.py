"""Sample points of an answer, dense at edges, breaks and peaks, and the height of a picture."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS
from sie.numerics.root_finding import false_positions
from sie.problem.request import POINTS

Array = NDArray[np.float64]

# Points beside the contact, on each side, as a fraction of those in it, and how far out they reach,
# in half-widths.
BESIDE = 0.25
REACH = 0.6
FEWEST = 12  # points on each of several patches, and in each gap
PER_BREAK = 4  # points for each break; where there are fewer, breaks are passed over
# Of a peak's neighbours, what is left out next to them, where p' may be infinite; and how far a
# sample may be from the zero of p', in half-widths, to be taken for it.
INSET, SAME_PLACE = 1e-9, 1e-12
LESSER = 0.5  # of the largest pressure: below it a peak is not looked for between samples
SAME_PEAK = 1e-9  # relative: a symmetric pressure has its peak twice
# A picture cuts a spike that is so many times the 95th percentile of the pressure over the contact.
# The picture then ends a little above that percentile.
SPIKE = 3.0
ABOVE_ORDINARY = 1.4


def inside(solution: Any, points: int = POINTS) -> Array:
    """About `points` positions from x1 to x2, ascending, with the edges and the breaks.

    Between breaks the points are Chebyshev's, dense at both ends. Half of all points are shared out
    by length (in the angle of the contact), half equally, so that a narrow rounded edge has points
    of its own. The breaks of a trace are too many, and are passed over. Each of several patches,
    and each gap, has at least FEWEST points.
    """
    (x1, x2), r, m = solution.edges, solution.half_width, solution.centre
    edges = [x for patch in solution.patches for x in patch] if len(solution.patches) > 1 else []
    breaks = (b for b in _corners(solution, points) if x1 < b < x2)
    ends = np.unique([x1, *breaks, *edges, x2])
    fewest = FEWEST if edges else 1
    angle = np.arccos(np.clip((m - ends) / r, -1.0, 1.0))
    share = 0.5 * np.diff(angle) / np.pi + 0.5 / (len(ends) - 1)
    parts = [
        lo + (hi - lo) * _gathered(max(round(points * s), fewest))
        for lo, hi, s in zip(ends[:-1], ends[1:], share, strict=True)
    ]
    return np.unique(np.concatenate([*parts, ends]))


def beside(solution: Any, points: int = POINTS) -> tuple[Array, Array]:
    """Positions left and right of the contact, ascending, without the edges.

    They end at a distance `reach`, or where the indenter ends.
    """
    (x1, x2), (lo, hi) = solution.edges, solution.scene.profile.domain
    left, right = max(x1 - reach(solution), lo), min(x2 + reach(solution), hi)
    t = np.linspace(0.0, 1.0, max(round(BESIDE * points), 2) + 1) ** 2
    sides = x1 + (left - x1) * t, x2 + (right - x2) * t, _corners(solution, points)
    x = np.unique(np.concatenate(sides))
    return x[(x >= left) & (x < x1)], x[(x > x2) & (x <= right)]


def reach(solution: Any) -> float:
    """REACH half-widths, or half the way to the contact of the next period if that is less."""
    (x1, x2), period = solution.edges, solution.scene.profile.period
    return min(REACH * solution.half_width, max(0.5 * (period - (x2 - x1)), 0.0))


def full(solution: Any) -> bool:
    """Whether all of a period is in contact, so that the contact has no edges."""
    return solution.contact_length >= solution.scene.profile.period


def _corners(solution: Any, points: int) -> tuple[float, ...]:
    breaks = solution.scene.profile.breaks
    return breaks if len(breaks) <= points // PER_BREAK else ()


def abscissae(solution: Any, points: int = POINTS) -> Array:
    """Left of the contact, in it, and right of it."""
    left, right = beside(solution, points)
    return np.concatenate((left, inside(solution, points), right))


def _gathered(n: int) -> Array:
    """n + 1 points (at least 2) from 0 to 1, dense at both."""
    return np.asarray(np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, max(n, 1) + 1)) ** 2)


def summits(solution: Any) -> tuple[Array, Array]:
    """The places of the maxima of the pressure, ascending, the highest where p' = 0, and p there.

    It is inf at a sharp edge or under a corner.
    """
    x = np.union1d(inside(solution), [solution.centre])
    if len(solution.patches) > 1:
        x = np.union1d(x, solution.pressure.breaks)
    p = solution.pressure(x)
    padded = np.concatenate(([-np.inf], p, [-np.inf]))
    top = np.flatnonzero((p > padded[:-2]) & (p >= padded[2:]))
    high = top[np.isfinite(p[top]) & (p[top] >= LESSER * p[np.isfinite(p)].max())]
    lo, hi = x[np.maximum(high - 1, 0)], x[np.minimum(high + 1, len(x) - 1)]
    inset = INSET * (hi - lo)
    zeros = false_positions(
        lambda t: -solution.pressure.cauchy_derivative(t).imag, lo + inset, hi - inset
    )
    own, values = high[np.searchsorted(hi, zeros)], solution.pressure(zeros)
    apart = np.abs(zeros - x[own]) > SAME_PLACE * solution.half_width
    better = apart & (values >= p[own] * (1.0 - 4.0 * EPS))
    x[own[better]], p[own[better]] = zeros[better], values[better]
    return x[top], p[top]


def peak(solution: Any) -> tuple[float, tuple[float, ...]]:
    """(largest pressure, where): at more than one x if the pressure is as large there."""
    x, p = summits(solution)
    largest = float(p.max())
    return largest, tuple(x[p >= (1.0 - SAME_PEAK) * largest].tolist())


def ceiling(solution: Any) -> float:
    """The largest pressure that a picture shows: the peak, unless it is infinite or narrow."""
    starts, stops = np.transpose(solution.patches)
    before = np.cumsum(stops - starts) - (stops - starts)
    along = solution.contact_length * (np.arange(400) + 0.5) / 400.0
    k = np.searchsorted(before, along, side="right") - 1
    p = solution.pressure(starts[k] + (along - before[k]))
    ordinary = float(np.quantile(p, 0.95, method="lower"))
    largest, _ = peak(solution)
    return largest if largest <= SPIKE * ordinary else ABOVE_ORDINARY * ordinary
