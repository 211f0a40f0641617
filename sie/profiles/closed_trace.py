"""Traces that are repeated: whether their ends meet, and the periodic spline of those that do.

The ends meet where the last point stands one period after the first one (both measure one place,
and their mean counts) or where the step over the seam is no gap of the trace, and where the trace
bends by no more over the seam, in its fourth differences, than elsewhere.

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
from .sampled import Sampled, SplineProfile
from .splines import Spline, closed_spline

Array = NDArray[np.float64]

SAME = 0.01  # of a step: the last point is the first one of the next period
ROUGHEST = 2.0  # times the largest bend elsewhere: more of them might be larger
ROUNDING = 1e4 * EPS  # of the heights
ORDER = 4  # of the differences: to them a smooth trace is next to nothing, and a corner is none


class Seam(NamedTuple):
    """The place where a repeated trace begins anew.

    x        the end of the period, in the trace
    bend     the largest fourth difference over it, and the largest one elsewhere
    left     the length from the last point to the next period, where it is a gap
    """

    x: float
    bend: tuple[float, float]
    left: float

    @property
    def meets(self) -> bool:
        """Whether there is no gap, and the trace bends as much elsewhere."""
        return not self.left and self.bend[0] <= ROUGHEST * self.bend[1]

    def __str__(self) -> str:
        over, elsewhere = self.bend
        return f"it bends {over / elsewhere:.3g} times as much there as anywhere in it"


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
    x, h = _distinct(trace, period, part.sign * part.tilt)
    end = float(x[0] + period)
    gaps = fitting.gaps(np.append(x, end))
    left = float(end - x[-1]) if any(g.hi == end for g in gaps) else 0.0
    # over ORDER + 1 neighbouring points each, beginning with those that the seam is among
    places = np.concatenate((x[-ORDER:] - period, x, x[:ORDER] + period))
    bends = np.concatenate((h[-ORDER:], h, h[:ORDER]))
    for k in range(1, ORDER + 1):
        span = places[k:] - places[:-k]
        bends = np.diff(bends) / span
    bends = np.abs(bends) * span**ORDER
    usual = max(
        float(bends[ORDER + 1 : -ORDER].max(initial=0.0)), ROUNDING * float(np.abs(h).max())
    )
    return Seam(end, (float(bends[: ORDER + 1].max()), usual), left)
