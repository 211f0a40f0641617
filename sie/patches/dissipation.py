"""The energy that slip dissipates on several patches and per period at constant load.

It is f² E, E = ∫ p_b gap_a dx for two loads a <= b, p_b the pressure under b and gap_a under a: the
work of f p on the slip f gap_a. All that is integrated is positive.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.numerics.chord import Points
from sie.numerics.graded_rule import graded, on_panels
from sie.numerics.zones import Zones, left_over
from sie.profiles.base import Profile
from sie.traction.base import Density
from sie.traction.combination import ZERO

Array = NDArray[np.float64]

LEVELS = ((32, 10), (200, 4), (2000, 1))  # of a graded rule where there are no more parts than ...
SHRUNK = 14  # times an interval about a minimum: to the root of rounding, which is enough
SAMPLES, LOWEST = 65, 8  # heights on a patch, and how many of their minima are refined


class Untouched:
    """The profile under no load: the gap is its height above its lowest point on some zones."""

    patches: tuple[tuple[float, float], ...] = ()
    pressure: Density = ZERO

    def __init__(self, profile: Profile, tilt: float, zones: Zones) -> None:
        self.profile, self.tilt = profile, tilt
        self.lowest = min(self._lowest(lo, hi) for lo, hi in zones)

    def gap(self, x: Array) -> Array:
        return np.maximum(self._height(x) - self.lowest, 0.0)

    def _height(self, x: Array) -> Array:
        return np.asarray(self.profile.height(x) + self.tilt * x)

    def _lowest(self, lo: float, hi: float) -> float:
        breaks = [b for b in self.profile.breaks if lo < b < hi]
        even = 0.5 * (lo + hi) - 0.5 * (hi - lo) * np.cos(np.linspace(0.0, np.pi, SAMPLES))
        x = np.unique(np.concatenate((even, breaks)))
        h = self._height(x)
        inner = np.flatnonzero((h[1:-1] <= h[:-2]) & (h[1:-1] <= h[2:])) + 1
        found = [float(h.min())]
        for k in inner[np.argsort(h[inner])][:LOWEST]:
            found.append(self._lowest_between(float(x[k - 1]), float(x[k + 1])))
        return min(found)

    def _lowest_between(self, lo: float, hi: float) -> float:
        """The minimum between two places with one minimum: an interval of a quarter each time."""
        lowest = np.inf
        for _ in range(SHRUNK):
            x = np.linspace(lo, hi, 9)
            h = self._height(x)
            k = int(np.argmin(h))
            lowest = min(lowest, float(h[k]))
            lo, hi = float(x[max(k - 1, 0)]), float(x[min(k + 1, 8)])
        return lowest


class Level(Protocol):
    """A contact without friction: its patches, the pressure on them, the gap beside."""

    @property
    def patches(self) -> tuple[tuple[float, float], ...]: ...
    @property
    def pressure(self) -> Density: ...
    def gap(self, x: Array) -> Array: ...


def work(lower: Level, upper: Level, period: float) -> float:
    """E: the pressure of the upper level times the gap of the lower one."""
    places, weight = slip_rule(upper, lower.patches, period)
    p = upper.pressure(places.x)
    # a node that rounding puts on a sharp edge
    return float(np.where(np.isfinite(p), weight * p, 0.0) @ lower.gap(places.x))


def slip_rule(upper: Level, stick: Zones, period: float) -> tuple[Points, Array]:
    """Places and weights on the patches beside the stick zones.

    They are in the angle between neighbouring ends of zones and breaks, and graded towards them.
    """
    breaks = np.array(upper.pressure.breaks)
    parts: list[tuple[float, float]] = []
    for lo, hi in left_over(upper.patches, stick, period):
        inside = breaks[(breaks > lo) & (breaks < hi)].tolist()
        ends = [lo, *inside, hi]
        parts += pairwise(ends)
    if not parts:
        return Points(np.zeros(0), np.zeros(0)), np.zeros(0)
    a, b = np.array(parts).T
    fractions = graded(next((level for most, level in LEVELS if len(parts) <= most), 0))
    cuts = np.unique(np.concatenate(([0.0], 0.5 * fractions, [0.5], 1.0 - 0.5 * fractions, [1.0])))
    angle, step = (np.pi * v.ravel() for v in on_panels(cuts))
    half = 0.5 * (b - a)[:, None]
    left = angle < 0.5 * np.pi
    offset = 2.0 * half * np.sin(0.5 * np.where(left, angle, np.pi - angle)) ** 2
    anchor = np.where(left, a[:, None], b[:, None])
    places = Points(anchor.ravel(), np.where(left, offset, -offset).ravel())
    return places, (half * np.sin(angle) * step).ravel()
