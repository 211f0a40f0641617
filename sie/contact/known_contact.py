"""A contact whose edges are known: every search for edges ends with it, every pressure begins."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval
from sie.profiles.base import Profile
from sie.profiles.slope import Slope

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Edges:
    """The contact, load, moment about x = 0 and tilt; which edges are sharp, and their k1, k2.

    k1 and k2 are stresses.
    """

    contact: Interval
    normal_load: float
    moment: float
    tilt: float
    sharp: tuple[bool, bool]
    k1: float
    k2: float
    I0: float
    evaluations: int


@dataclass(frozen=True)
class Normal:
    """The contact, and whether its symmetry halved the search.

    `series` are Chebyshev coefficients of a slope that is smooth there, and rises where seen.
    """

    edges: Edges
    symmetric: bool
    series: Array | None = field(default=None, compare=False, repr=False)
    seen: tuple[float, ...] = ()  # breaks that a function's slope needs beside the declared ones

    def slope(self, profile: Profile) -> Slope:
        """H of the profile as it is pressed: with these breaks, and tilted."""
        return with_breaks(profile.pieces, self.seen).tilted(self.edges.tilt)


def with_breaks(slope: Slope, places: tuple[float, ...]) -> Slope:
    for x in places:
        slope = slope.split_at(x)
    return slope
