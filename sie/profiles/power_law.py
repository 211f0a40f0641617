"""A power law h = A |x - c|^m, which is no polynomial unless m is whole."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PowerLaw:
    """h = coefficient |x - axis|^exponent; as a function it is its own slope."""

    exponent: float
    coefficient: float
    axis: float = 0.0

    def __call__(self, y: Array) -> Array:
        """h' at x = axis + y."""
        return np.copysign(self.exponent * self.coefficient * np.abs(y) ** (self.exponent - 1.0), y)

    def cusp(self, y: float) -> float:
        """By how much p over E*/2 is higher on the axis than at a small distance y from it.

        Of a sum it is this law's part, for exponents between 1 and 3 (but for terms like y²):
        |t|^a, a = m - 1, has the transform 1/π PV∫ |t|^a/(x - t) dt = -tan(π a/2) |x|^a sign x.
        """
        a = self.exponent - 1.0
        return self.exponent * self.coefficient * y**a / math.tan(0.5 * math.pi * a)
