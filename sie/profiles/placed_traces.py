"""The traces in a profile that may be tilted, shifted, mirrored, added and repeated.

The ends of a trace that is repeated meet where the last point stands one period after the first one
(both measure one place, and their mean counts) or where the step over the seam is no gap of the
trace, and where the trace bends by no more over the seam, in its fourth differences, than
elsewhere. Its spline is then periodic and twice continuously differentiable, over the seam too, and
λ of a smoothing spline is that of the trace.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.interval import EPS

from . import fitting
from .base import Profile, parts_of, total_tilt, with_part
from .sampled import Sampled, SplineProfile
from .splines import Spline, closed_spline

Array = NDArray[np.float64]

SAME = 0.01  # of a step: the last point is the first one of the next period
ROUGHEST = 2.0  # times the largest bend elsewhere: more of them might be larger
ROUNDING = 1e4 * EPS  # of the heights
ORDER = 4  # of the differences: to them a smooth trace is next to nothing, and a corner is none


class PlacedTrace(NamedTuple):
    """A trace in a profile.

    The position x of the profile is direction x + origin in the trace. The slope of the profile is
    direction times the slope of the trace, plus tilt.
    """

    trace: Sampled
    direction: float = 1.0
    origin: float = 0.0
    tilt: float = 0.0

    def x(self, points: Array) -> Array:
        """The places of the trace's points in the profile."""
        return self.direction * (points - self.origin)

    def extent(self, x1: float, x2: float) -> tuple[float, float]:
        """The ends, ascending, of a part of the profile in the trace."""
        lo, hi = sorted(self.origin + self.direction * end for end in (x1, x2))
        return lo, hi

    def gaps(self) -> tuple[fitting.Gap, ...]:
        """The gaps of the trace, where they stand in the profile."""
        placed = ((sorted(self.x(np.array([g.lo, g.hi])).tolist()), g) for g in self.trace.gaps)
        return tuple(fitting.Gap(lo, hi, gap.missing) for (lo, hi), gap in placed)

    def misfits(self, other: Sampled, period: float) -> Array:
        """The heights of the trace less the spline of another in its place, or of itself.

        The spline is periodic if traces with this period are and the ends of this one meet.
        """
        spline = self._replace(trace=other).spline(period)
        heights: Array = spline.height(np.clip(self.trace.points, *spline.domain))
        return self.trace.heights - heights

    def with_heights(self, points: Array, heights: Array, smoothing: float) -> Profile:
        """Other heights at points of the trace, where the trace stands in the profile."""
        other = Sampled(points, heights, smoothing)
        mirrored = self.direction < 0.0
        turned = other.mirrored() if mirrored else other
        return turned.shifted(self.origin if mirrored else -self.origin)

    # -- repeated ----------------------------------------------------------------------------------

    def spline(self, period: float) -> SplineProfile:
        """The spline of the trace that is repeated: the periodic one, if its ends meet."""
        meets = period < np.inf and self.seam(period).meets
        tilt = self.direction * self.tilt
        return ClosedTrace(self.trace, period, tilt) if meets else self.trace

    def seam(self, period: float) -> Seam:
        """The seam of the trace that is repeated."""
        x, h = _distinct(self.trace, period, self.direction * self.tilt)
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
        elsewhere = float(bends[ORDER + 1 : -ORDER].max(initial=0.0))
        usual = max(elsewhere, ROUNDING * float(np.abs(h).max()))
        return Seam(end, (float(bends[: ORDER + 1].max()), usual), left)


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


def _distinct(trace: Sampled, period: float, tilt: float) -> tuple[Array, Array]:
    """The points of one period and their heights with a tilt; of one place the mean."""
    x, h = trace.points, trace.heights + tilt * (trace.points - trace.points[0])
    if x[0] + period - x[-1] <= SAME * np.median(np.diff(x)):
        x, h = x[:-1], np.append(0.5 * (h[0] + h[-1]), h[1:-1])
    return x, h


def closed(profile: Profile, period: float) -> Profile:
    """The profile with periodic splines for the traces in it whose ends meet."""
    for placed in traces_in(profile):
        profile = with_part(profile, placed.trace, placed.spline(period))
    return profile


def open_seams(profile: Profile, period: float) -> tuple[Seam, ...]:
    """The seams of the traces in a profile whose ends do not meet."""
    seams = (placed.seam(period) for placed in traces_in(profile))
    return tuple(s for s in seams if not s.meets)


def traces_in(profile: Profile) -> Iterator[PlacedTrace]:
    """The traces in a profile that may be tilted, shifted, mirrored, added and repeated."""
    if profile.period < np.inf:
        profile = profile.profile  # type: ignore[attr-defined]
    tilt = total_tilt(profile)
    for part in parts_of(profile):
        if isinstance(part.profile, Sampled):
            yield PlacedTrace(part.profile, part.sign, -part.sign * part.shift, tilt)


def smoothing_remedy(profile: Profile) -> str:
    """What to try so that a trace in the profile touches in one patch, "" without a trace."""
    trace = next((placed.trace for placed in traces_in(profile)), None)
    if trace is None:
        return ""
    if trace.smoothing:
        return f"give the trace a larger smoothing than {trace.lam:.2g}"
    return 'give the trace smoothing = "gcv"'


def explained(error: ContactError, profile: Profile) -> ContactError:
    """The refusal of a contact, with the reason and the remedy if the profile has a trace."""
    trace = next((placed.trace for placed in traces_in(profile)), None)
    if trace is None or not error.reached:
        return error
    advice = smoothing_remedy(profile)
    if "end" in error.reached:
        advice = "levelled() takes the tilt of a trace out"
        if not trace.reading.side:
            advice += ', and heights = "surface" reads those of a surface, which are no gaps'
    return type(error)(f"{error.args[0]}; {advice}", **error.reached) if advice else error
