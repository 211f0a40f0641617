"""A place from which a zone of slip begins, with the frozen traction beside it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.friction.slip_zones import SlipZone, slip_zone
from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.traction.of_slope import SlopeDensity

from .panel_shear import SAME

Array = NDArray[np.float64]

# Of a width, and terms: where a traction next to its place is the root of the distance times a
# series in it.
NEAR, TERMS = 1e-3, 20
ROUNDINGS, TINY = 30.0, 1e-300  # of the largest traction: how many of them quadrature leaves


@dataclass(frozen=True, eq=False)
class FrozenEdge:
    """A place from which a slip zone begins, and the traction beside it.

    place     the place
    side      +1 on the right of the stick zone
    width     of all that may slip from here on
    values    the traction at x
    marks     places where it is not smooth
    """

    place: float
    side: float
    width: float
    values: Callable[[Array], Array]
    marks: Array

    def pressure(self, distance: Array) -> Array:
        traction = np.empty(distance.shape)
        near = distance < self._near
        traction[~near] = self.values(self.place - self.side * distance[~near])
        d = distance[near]
        traction[near] = np.sqrt(d) * chebyshev.evaluate(self._beside, 2.0 * d / self._near - 1.0)
        return traction

    @cached_property
    def _near(self) -> float:
        """How far a series in the distance holds; other marks are twice as far, on either side."""
        apart = np.abs(self.place - self.marks)
        others = apart[apart > SAME * self.width]
        return min(NEAR * self.width, 0.5 * float(others.min(initial=np.inf)))

    @cached_property
    def _beside(self) -> Array:
        """The traction next to the place over the root of the distance, as a series.

        Doubles x do not resolve short distances, and a step asks for zones of any shortness.
        """
        d = 0.5 * self._near * (1.0 + chebyshev.points(TERMS))
        over_root = self.values(self.place - self.side * d) / np.sqrt(d)
        return chebyshev.transform(over_root)

    @cached_property
    def breaks(self) -> Array:
        d = np.unique(self.side * (self.place - self.marks))
        return d[(d > SAME * self.width) & (d < self.width)]

    def zone(self, length: float, at_edge: int = 0) -> SlipZone:
        return slip_zone(self, length, at_edge)

    def rounding(self, zone: SlipZone, bound: SlopeDensity) -> float:
        """What rounding leaves of the traction in a zone, a difference of others like `bound`.

        It is over the largest traction there. Where marks are near, places x are rounded too.
        """
        largest = float(np.abs(zone.force / zone.weight).max(initial=TINY))
        rounded = EPS * bound.resultant / (bound.contact.r * largest)
        if zone.length > self._near:
            rounded += EPS * (abs(self.place) + self.width) / self._near
        return ROUNDINGS * rounded
