"""Traces that are repeated: whether their ends meet, and the periodic spline of those that do.

The ends meet where the last point stands one period after the first one (both measure one place,
and their mean counts) or where the step over the seam is no gap of the trace, and where the seam is
no rougher than the trace. A parabola through the next points on either side gives a height and a
slope at the seam; what the two sides differ by is compared with the same difference in the middle
of the steps of the trace. The parabolas are as long as the spline averages, so that the difference
is judged within the noise.

The spline of a trace whose ends meet is periodic and twice continuously differentiable, over the
seam too. λ of a smoothing spline is that of the trace.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS

from . import fitting
from .base import Profile
from .derived import Placed, parts_of, total_tilt, with_part
from .sampled import Sampled
from .spline_profile import SplineProfile
from .splines import Spline, closed_spline

Array = NDArray[np.float64]

SAME = 0.01  # of a step: the last point is the first one of the next period
NEXT = 4  # points on one side, at least, through which a parabola is laid
AVERAGED = 2.0  # times the points that the spline averages
JUDGED = 2000  # places of the trace with which the seam is compared
ROUGHEST = 2.0  # times the largest of these: more of them might be rougher
ROUNDING = 64.0 * EPS  # of the heights, and of them over a step


class Seam(NamedTuple):
    """The place where a repeated trace begins anew.

    x                    the end of the period, in the trace
    height, slope        by how much both rise from the end of the trace to its next beginning
    usual                the largest (height, slope) by which the sides of a place of the trace
                         differ
    left                 the length from the last point to the next period, where it is a gap
    """

    x: float
    height: float
    slope: float
    usual: tuple[float, float]
    left: float = 0.0

    @property
    def meets(self) -> bool:
        """Whether the trace has as large differences elsewhere."""
        differ = abs(self.height), abs(self.slope)
        return not self.left and all(
            d <= ROUGHEST * usual for d, usual in zip(differ, self.usual, strict=True)
        )

    def __str__(self) -> str:
        parts = [
            f"{name} by {jump:.3g} ({abs(jump) / usual:.2g} times as much as anywhere in it)"
            if usual
            else f"{name} by {jump:.3g}"
            for name, jump, usual in zip(("height", "slope"), self[1:3], self.usual, strict=True)
        ]
        return ", ".join(parts)


@dataclass(frozen=True)
class ClosedTrace(SplineProfile):
    """The periodic spline of a trace less the line -tilt x, on one period from its first point."""

    trace: Sampled
    repeats: float
    tilt: float

    @cached_property
    def _spline(self) -> Spline:
        x, h = _distinct(self.trace, self.repeats, self.tilt)
        return closed_spline(x, h, self.repeats, self.trace.lam).tilted(-self.tilt)


def closed(profile: Profile, period: float) -> Profile:
    """The profile with periodic splines for the traces in it whose ends meet."""
    for part in _traces(profile):
        profile = with_part(profile, part.profile, spline_of(part, period))
    return profile


def spline_of(part: Placed, period: float) -> SplineProfile:
    """The spline of a trace that is repeated: the periodic one, if its ends meet."""
    trace: Sampled = part.profile  # type: ignore[assignment]
    meets = period < np.inf and seam(part, period).meets
    return ClosedTrace(trace, period, part.sign * part.tilt) if meets else trace


def open_seams(profile: Profile, period: float) -> tuple[Seam, ...]:
    """The seams of the traces in a profile whose ends do not meet."""
    seams = (seam(part, period) for part in _traces(profile))
    return tuple(s for s in seams if not s.meets)


def _traces(profile: Profile) -> list[Placed]:
    """The traces in a profile, each with the tilt of all parts."""
    tilt = total_tilt(profile)
    traces = (part for part in parts_of(profile) if isinstance(part.profile, Sampled))
    return [part._replace(tilt=tilt) for part in traces]


def _same_place(x: Array, period: float) -> bool:
    return bool(x[0] + period - x[-1] <= SAME * np.median(np.diff(x)))


def _distinct(trace: Sampled, period: float, tilt: float) -> tuple[Array, Array]:
    """The points of one period and their heights with a tilt; of one place the mean."""
    x, h = trace.points, trace.heights + tilt * (trace.points - trace.points[0])
    if _same_place(x, period):
        x, h = x[:-1], np.append(0.5 * (h[0] + h[-1]), h[1:-1])
    return x, h


def seam(part: Placed, period: float) -> Seam:
    """The seam of a trace that is repeated."""
    trace: Sampled = part.profile  # type: ignore[assignment]
    x = trace.points
    h = trace.heights + part.sign * part.tilt * (x - x[0])
    end = x[0] + period
    gap = () if _same_place(x, period) else fitting.gaps(np.append(x, end))
    many = min(max(NEXT, round(AVERAGED * trace.averaged)), len(x) // 2)
    steps = np.arange(many, len(x) - many + 1)
    steps = steps[:: max(len(steps) // JUDGED, 1)]
    usual = _differences(x, h, steps, many)
    jump = _differences(np.append(x[-many:], x[:many] + period), np.append(h[-many:], h[:many]),
                        np.array([many]), many)[0]  # fmt: skip
    size = float(np.abs(h).max())
    rounding = ROUNDING * size, ROUNDING * size / float(np.diff(x).min())
    largest = np.abs(usual).max(axis=0, initial=0.0).tolist()
    bars = max(largest[0], rounding[0]), max(largest[1], rounding[1])
    left = float(end - x[-1]) if any(g.hi == end for g in gap) else 0.0
    return Seam(float(end), float(jump[0]), float(jump[1]), bars, left)


def _differences(x: Array, h: Array, steps: NDArray[np.int64], many: int) -> Array:
    """(height, slope) by which the parabolas on both sides of the middle of each step differ."""
    middle = 0.5 * (x[steps - 1] + x[steps])
    sides = []
    for offsets in (np.arange(-many, 0), np.arange(many)):
        near = steps[:, None] + offsets
        u = x[near] - middle[:, None]
        length = np.abs(u).max(axis=1)
        powers = (u / length[:, None])[..., None] ** np.arange(3.0)
        c = np.einsum("ijk,ik->ij", np.linalg.pinv(powers)[:, :2], h[near])
        sides.append(c / length[:, None] ** np.arange(2.0))
    return sides[1] - sides[0]
