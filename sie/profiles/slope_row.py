"""One piece of a slope as plain floats, which cost less than arrays where there are few."""

from __future__ import annotations

from typing import NamedTuple


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
