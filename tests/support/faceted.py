"""A profile class that states no more than it has to."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import sie
from sie.profiles.slope import Slope


@dataclass(frozen=True)
class Faceted(sie.Profile):
    """A parabola as a polygon of facets that touch it in their middles."""

    radius: float
    facet: float

    @cached_property
    def pieces(self) -> Slope:
        corners = self.facet * np.arange(-100, 101)
        slopes = 0.5 * (corners[1:] + corners[:-1]) / self.radius
        return sie.Piecewise(corners.tolist(), [[slope] for slope in slopes]).pieces
