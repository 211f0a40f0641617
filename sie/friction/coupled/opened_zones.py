"""The zones of a contact that slips inside its stick zone, and distances from their ends.

Places are counted from the old edge. Next to an end of a zone the distance from it is exact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .opened_rule import Zone

Array = NDArray[np.float64]


class Distances(NamedTuple):
    """Distances |x - end| of places from the ends of the zones."""

    x1: Array
    e0: Array
    h1: Array
    h2: Array
    e2: Array
    x2: Array

    def chi(self, power: float) -> Array:
        """|χ|, where μ is the power."""
        values: Array = (self.e0 * self.h1 * self.e2 / (self.x1 * self.h2 * self.x2)) ** power
        return values


class OpenedZones(NamedTuple):
    """The ends of the zones, counted from the old edge; x1 = e0 - strip."""

    strip: float
    e0: float
    h1: float
    h2: float
    e2: float
    x2: float

    @property
    def x1(self) -> float:
        return self.e0 - self.strip

    @property
    def opened(self) -> float:
        """The width of the slip zone inside the stick zone."""
        return self.h2 - self.h1

    @property
    def slipping(self) -> float:
        """That of the slip zone at x2."""
        return self.x2 - self.e2

    def in_strip(self, left: Array, right: Array) -> Distances:
        """The distances on the strip, given those from its ends."""
        _, e0, *ends = self
        return Distances(left, right, *(right + (end - e0) for end in ends))

    def in_left_stick(self, left: Array, right: Array) -> Distances:
        """The distances between e0 and h1, given those from both."""
        strip, e0, _, _, e2, x2 = self
        ahead = ((end - e0) - left for end in (e2, x2))
        return Distances(strip + left, left, right, self.opened + right, *ahead)

    def in_slip(self, left: Array, right: Array) -> Distances:
        """The distances between h1 and h2."""
        strip, e0, h1, h2, e2, x2 = self
        to_e0 = (h1 - e0) + left
        return Distances(strip + to_e0, to_e0, left, right, (e2 - h2) + right, (x2 - h2) + right)

    def in_right_stick(self, left: Array, right: Array) -> Distances:
        """The distances between h2 and e2."""
        strip, e0, _, h2, _, _ = self
        to_e0, slipping = (h2 - e0) + left, self.slipping
        return Distances(strip + to_e0, to_e0, self.opened + left, left, right, slipping + right)

    def ahead(self, left: Array, right: Array) -> Distances:
        """The distances between e2 and x2."""
        strip, e0, h1, h2, e2, _ = self
        to_e0 = (e2 - e0) + left
        return Distances(strip + to_e0, to_e0, (e2 - h1) + left, (e2 - h2) + left, left, right)

    def beside(self, rule: Zone) -> tuple[Distances, Distances]:
        """The distances beside the contact on the left, and on the right."""
        strip, e0, h1, h2, e2, x2 = self
        y, z = rule.left, rule.right
        left = Distances(y, y + strip, *(y + ((end - e0) + strip) for end in (h1, h2, e2, x2)))
        to_e0, to_h1, to_h2, to_e2 = (z + (x2 - end) for end in (e0, h1, h2, e2))
        return left, Distances(to_e0 + strip, to_e0, to_h1, to_h2, to_e2, z)
