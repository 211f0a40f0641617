"""K'/K of the receding flat over the place of the end that recedes, as series.

Beside `receding_flat.zone`, for many places at once: the place is e = 1 + t1, its natural value e0
belongs to the end that advances, and beyond it the series go on smoothly. The curve is singular at
e = 0, and turns within k of e0, so that the series are in ln e below e0/2, and in arcsinh((e -
e0)/k) above.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.elliptic import modulus_of

from .receding_flat import RecedingFlat, Zone, receding_flat, resultant, zone_of_ratio

Array = NDArray[np.float64]

POINTS, LONGEST = 16, 0.5  # of a panel, and its length
NEAREST = 1e-8  # the least e: nearer to the edge of contact no stick zone is looked for
BEYOND = 0.2  # of k, or of e0: how far the series go on behind e0, for Newton's method
HALVINGS = 60


class ZoneTable:
    """Stick zones of the flat by e."""

    def __init__(self, flat: RecedingFlat) -> None:
        self.flat = flat
        self.e0, self.k = float(flat.natural.e[0]), float(flat.natural.k[0])
        self.scale = min(self.k, self.e0)

    def zone(self, e: Array, ratio: Array) -> Zone:
        return zone_of_ratio(e, ratio, self.flat.ratio)

    def ratio(self, e: Array) -> Array:
        """K'/K."""
        below = e < 0.5 * self.e0
        values = np.empty(e.shape)
        for own, (first, size, series) in zip((below, ~below), self._panels, strict=True):
            place = self._place(e[own], own is below)
            k = np.clip(((place - first) / size).astype(np.intp), 0, len(series) - 1)
            y = 2.0 * ((place - first) / size - k) - 1.0
            values[own] = chebyshev.evaluate(series[k].T, y)
        return values

    def _place(self, e: Array, below: bool) -> Array:
        if below:
            return np.log(np.maximum(e, NEAREST))
        return np.arcsinh(np.minimum(e - self.e0, BEYOND * self.scale) / self.scale)

    @cached_property
    def _panels(self) -> list[tuple[float, float, Array]]:
        """Both kinds of panels: their beginning, the length of each, and rows of series."""
        half = 0.5 * self.e0
        ends = (
            (math.log(NEAREST), math.log(max(half, 2.0 * NEAREST))),
            (math.asinh(-half / self.scale), math.asinh(BEYOND)),
        )
        kinds = []
        for below, (first, last) in zip((True, False), ends, strict=True):
            count = math.ceil((last - first) / LONGEST)
            size = (last - first) / count
            y = 0.5 * (1.0 + chebyshev.points(POINTS))
            place = (first + size * (np.arange(count)[:, None] + y)).ravel()
            e = np.exp(place) if below else self.e0 + self.scale * np.sinh(place)
            series = chebyshev.transform(self._solved(e).reshape(count, POINTS))
            kinds.append((first, size, series))
        return kinds

    def _solved(self, e: Array) -> Array:
        """K'/K between that of a stick zone as wide on both sides and the natural one."""
        wide = [modulus_of(1.0 - v, math.sqrt(v * (2.0 - v))) for v in e.tolist()]
        lo = np.array([m.K_complement / m.K for m in wide])
        hi = np.full(len(e), self.flat.ratio)
        rising = np.sign(resultant(self.zone(e, hi)))
        for _ in range(HALVINGS):
            middle = 0.5 * (lo + hi)
            same = np.sign(resultant(self.zone(e, middle))) == rising
            lo, hi = np.where(same, lo, middle), np.where(same, middle, hi)
        values: Array = 0.5 * (lo + hi)
        return values


@lru_cache(maxsize=8)
def zone_table(ratio: float) -> ZoneTable:
    return ZoneTable(receding_flat(ratio))
