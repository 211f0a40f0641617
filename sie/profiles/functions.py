"""Slopes that are functions: those of a user, and power laws h = A |x - c|^m."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie import arguments

Array = NDArray[np.float64]
Vectorised = Callable[[Array], Any]


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


@dataclass(frozen=True)
class FunctionTerm:
    """The function sign f(sign (t - shift)): a user's f, moved and mirrored with its profile."""

    function: Vectorised
    shift: float = 0.0
    sign: float = 1.0

    def __call__(self, offset: Array) -> Array:
        """Values at t, given offset = t - shift; `resolution` refuses those that are not finite."""
        with np.errstate(all="ignore"):
            if self.sign > 0.0:
                return arguments.real_values("slope", self.function, offset)
            return -arguments.real_values("slope", self.function, -offset)
