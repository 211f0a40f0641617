"""The traces in a profile that may be tilted, shifted, mirrored, added and repeated."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError

from . import fitting
from .base import Profile
from .closed_trace import spline_of
from .derived import Placed, parts_of, total_tilt
from .row import Periodic
from .sampled import Sampled

Array = NDArray[np.float64]


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
        spline = spline_of(Placed(other, self.direction, self.tilt), period)
        heights: Array = spline.height(np.clip(self.trace.points, *spline.domain))
        return self.trace.heights - heights

    def with_heights(
        self, points: Array, heights: Array, smoothing: float, period: float
    ) -> Profile:
        """Other heights at points of the trace, where the trace stands in the profile."""
        other = Sampled(points, heights, smoothing)
        mirrored = self.direction < 0.0
        turned = other.mirrored() if mirrored else other
        moved = turned.shifted(self.origin if mirrored else -self.origin)
        return Periodic(moved, period) if period < np.inf else moved


def traces_in(profile: Profile) -> Iterator[PlacedTrace]:
    """The traces in a profile that may be tilted, shifted, mirrored, added and repeated."""
    profile = profile.profile if isinstance(profile, Periodic) else profile
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
    if "end" in error.reached:
        advice = fitting.reason_at_an_end(trace.points, trace.heights, trace.reading.side)
    else:
        advice = smoothing_remedy(profile)
    return type(error)(f"{error.args[0]}; {advice}", **error.reached) if advice else error
