"""The window on which a function's slope is resolved, fitted to the contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from sie.numerics.interval import Interval
from sie.profiles.slope import Slope

if TYPE_CHECKING:
    from sie.problem.scene import Scene

# A window is refitted while it is longer than the contact by more than this factor ...
WINDOW = 1.6
FITTED = 1.25  # ... to the contact times this.
WINDOW_GROWTH = 8.0
MOST_GROWN, MOST_SHRUNK = 12, 120
WINDOW_SIZES = np.geomspace(1e-140, 1e140, 561)


@dataclass
class Window:
    """The part [lo, hi] of an indenter on which its slope is resolved.

    ends       the ends of the indenter
    grown      how often the window grew, and shrunk: how often it was fitted to a contact
    settled    whether it grew after it was fitted: then the profile is not convex, and it stays
    """

    lo: float
    hi: float
    ends: tuple[float, float]
    grown: int = 0
    shrunk: int = 0
    settled: bool = False

    @property
    def is_open(self) -> tuple[bool, bool]:
        """Whether each end of the window is inside the indenter."""
        return self.lo > self.ends[0], self.hi < self.ends[1]

    @property
    def may_grow(self) -> bool:
        return any(self.is_open) and self.grown < MOST_GROWN

    def holds(self, x: float | None) -> bool:
        """Whether the place x, if there is one, is in the window."""
        return x is None or self.lo < x < self.hi

    def grow(self) -> None:
        middle, half = 0.5 * (self.lo + self.hi), 0.5 * WINDOW_GROWTH * (self.hi - self.lo)
        self.lo, self.hi = max(middle - half, self.ends[0]), min(middle + half, self.ends[1])
        self.grown += 1

    def fitted_to(self, contact: Interval) -> bool:
        """Whether the window fits the contact; if not, it is fitted now."""
        length = contact.x2 - contact.x1
        margin = 0.5 * (FITTED - 1.0) * length
        fitted = max(contact.x1 - margin, self.ends[0]), min(contact.x2 + margin, self.ends[1])
        stays = self.settled or self.shrunk >= MOST_SHRUNK or fitted == (self.lo, self.hi)
        if stays or self.hi - self.lo <= WINDOW * length:
            return True
        self.lo, self.hi = fitted
        self.shrunk += 1
        return False


def window_of(scene: Scene) -> Window:
    """The window at which the search for the contact begins."""
    return Window(*_first_window(scene), scene.profile.domain)


def reach_of_load(slope: Slope, load: float, first: float, last: float) -> list[float]:
    """The lengths w at which w H, beyond `last` and before `first`, is a load over E*/2."""
    ends = last + WINDOW_SIZES, first - WINDOW_SIZES
    with np.errstate(all="ignore"):
        force = WINDOW_SIZES * slope(np.clip(ends, *slope.domain)) * [[1.0], [-1.0]]
        enough = [np.flatnonzero(~(of_side < load)) for of_side in force]
    return [float(WINDOW_SIZES[k[0]]) for k in enough if k.size]


def _first_window(scene: Scene) -> tuple[float, float]:
    """The interval on which a search begins.

    It is a little more than the contact where symmetry gives that, otherwise the domain where that
    is finite, or a part around the break nearest to x = 0 that the load or half-width needs: a
    contact of half-width w under slopes of the size H(w) carries about G w H(w).
    """
    profile = scene.profile
    lo, hi = profile.domain
    upright = scene.tilt == scene.epsilon == 0.0 and scene.moment is None
    if scene.half_width is not None and profile.axis is not None and upright:
        reach = FITTED * scene.half_width
        return max(lo, profile.axis - reach), min(hi, profile.axis + reach)
    if np.isfinite(lo) and np.isfinite(hi):
        return lo, hi
    centre = min((b for b in (*profile.breaks, lo, hi) if np.isfinite(b)), key=abs, default=0.0)
    load = 2.0 * (scene.normal_load or 0.0) / scene.Estar
    reaches = reach_of_load(profile.pieces.tilted(scene.tilt), load, centre, centre)
    given = () if scene.half_width is None else (scene.half_width,)
    size = max((*given, *reaches), default=1.0)
    return max(lo, centre - 4.0 * size), min(hi, centre + 4.0 * size)
