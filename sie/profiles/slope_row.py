"""What a slope is made of: functions, and pieces as floats, which cost less where they are few."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments

Array = NDArray[np.float64]
Vectorised = Callable[[Array], Any]


@dataclass(frozen=True)
class FunctionTerm:
    """The function sign f(sign (t - shift)): a user's f, moved and mirrored with its profile."""

    function: Vectorised
    shift: float = 0.0
    sign: float = 1.0

    def __call__(self, offset: Array) -> Array:
        """Values at t, given offset = t - shift."""
        # `resolution` refuses values that are not finite, and names the place.
        with np.errstate(all="ignore"):
            values = arguments.real_values("slope", self.function, self.sign * offset)
            signed: Array = self.sign * values
        return signed


class Row(NamedTuple):
    """One piece of a slope as plain floats; coefficients high order first."""

    lo: float
    hi: float
    origin: float
    coefficients: tuple[float, ...]

    def at(self, x: float) -> float:
        """H at x."""
        value = 0.0
        for c in self.coefficients:
            value = value * (x - self.origin) + c
        return value

    def steepness(self, x: float) -> float:
        """H'."""
        value = slope = 0.0
        for c in self.coefficients:
            slope = slope * (x - self.origin) + value
            value = value * (x - self.origin) + c
        return slope
