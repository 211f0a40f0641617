"""How fast the load grows with the contact, P'(s) = dP/ds, on panels of s.

s is half the width of the contact, less that of a flat base, so that short panels keep their
digits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

from .panels import NODES
from .tables import chopped, summed

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class GrowthPanel:
    """P'(s) = d^power Σ c_k T_k for lo <= s - origin <= hi, d the distance from a place before.

    From the origin, the half-width of a flat base, short panels keep their digits. The place, where
    P' is not smooth, lies `behind` the panel, and the series is one in the logarithm of d; if
    that is infinite, d = s - origin - lo, and the series is one in s.
    """

    origin: float
    lo: float
    hi: float
    power: float
    series: Array = field(repr=False)
    behind: float = math.inf

    def __call__(self, ahead: Array) -> Array:
        """P' at s = origin + lo + ahead."""
        values = summed(self._chopped, self.variable(ahead))
        return values * self.factor(ahead) if self.power else values

    def factor(self, ahead: Any) -> Any:
        """d^power."""
        return (ahead if self.behind == math.inf else self.behind + ahead) ** self.power

    @property
    def at_start(self) -> float:
        """The exponent of P' at lo."""
        return self.power if self.behind == math.inf else 0.0

    def variable(self, ahead: Array) -> Array:
        """That of the series."""
        length, behind = self.hi - self.lo, self.behind
        if behind == math.inf:
            return 2.0 / length * ahead - 1.0
        return 2.0 / math.log1p(length / behind) * np.log1p(ahead / behind) - 1.0

    @cached_property
    def _chopped(self) -> Array:
        return chopped(self.series)

    def nodes(self, part: Array | float) -> Any:
        """s - origin - lo at parts of the panel in that variable."""
        length, behind = self.hi - self.lo, self.behind
        if behind == math.inf:
            return length * part
        return behind * np.expm1(math.log1p(length / behind) * part)

    def rule(self, length: float, n: int, shift: float = 0.0) -> tuple[Array, Array]:
        """Places ahead of lo and weights of ds on a first part of the panel.

        They serve P' (s - lo)^shift times a smooth function.
        """
        x, _, w = with_weight(n, 0.0, self.at_start + shift)
        if self.behind == math.inf:
            return length * x, length * w
        log = math.log1p(length / self.behind)
        ahead = self.behind * np.expm1(log * x)
        return ahead, log * (self.behind + ahead) * w

    @cached_property
    def places(self) -> tuple[Array, Array]:
        """s - origin - lo and P' ds of a Gauss rule over the panel."""
        ahead, weight = self.rule(self.hi - self.lo, max(len(self.series), NODES))
        return ahead, weight * self(ahead)

    def load(self, ahead: float) -> float:
        """∫P' ds from its beginning to origin + ahead.

        That end may lie before the panel, on it or beyond.
        """
        if ahead <= self.lo:
            return 0.0
        return self._whole if ahead >= self.hi else self.load_and_rate(ahead)[0]

    @cached_property
    def _whole(self) -> float:
        return float(self.places[1].sum())

    def load_and_rate(self, ahead: float) -> tuple[float, float]:
        """∫P' ds from its beginning to origin + ahead on the panel, and P' there."""
        places, weight = self.rule(ahead - self.lo, max(len(self.series), NODES))
        values = self(np.append(places, ahead - self.lo))
        return float(weight @ values[:-1]), float(values[-1])


class Stack:
    """P' on several panels of one origin at once, given the number of the panel of each row."""

    def __init__(self, growth: Sequence[GrowthPanel]) -> None:
        columns = [(g.origin, g.lo, g.hi, g.behind, g.power, g.at_start) for g in growth]
        origin, lo, hi, behind, power, at_start = np.array(columns).reshape(-1, 6).T
        self.origin = float(origin[0]) if growth else 0.0
        self.lo, self.hi, self.behind, self.power, self.at_start = lo, hi, behind, power, at_start
        # Distances of lo from the place where P' has its power
        self.kink = np.where(at_start == 0.0, behind, 0.0)
        self._straight = np.isinf(behind)
        self._distance = np.where(self._straight, 0.0, behind)
        self._slope = 2.0 / np.where(self._straight, hi - lo, np.log1p((hi - lo) / behind))
        kept = [chopped(panel.series) for panel in growth]
        self._series = np.zeros((max(map(len, kept), default=1), len(kept), 1))
        for k, c in enumerate(kept):
            self._series[: len(c), k, 0] = c

    def __call__(self, panel: NDArray[np.intp], ahead: Array) -> Array:
        """P' at s = origin + lo + ahead."""
        values = summed(self._series[:, panel], self.variable(panel, ahead))
        return self.times_power(panel, ahead, values)

    def variable(self, panel: NDArray[np.intp], ahead: Array) -> Array:
        """That of the series."""
        straight = self._straight[panel]
        place = ahead / self.behind[panel][:, None]
        np.log1p(place, out=place)
        if straight.any():
            place[straight] = ahead[straight]
        place *= self._slope[panel][:, None]
        place -= 1.0
        return place

    def times_power(self, panel: NDArray[np.intp], ahead: Array, values: Array) -> Array:
        """The values times d^power, which replaces them."""
        power = self.power[panel]
        if power.any():
            values *= (self._distance[panel][:, None] + ahead) ** power[:, None]
        return values
