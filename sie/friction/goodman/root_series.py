"""Functions that are smooth between marks but for roots of the distances from them, as series.

Between two marks y = lo + (hi - lo) sin²θ; panels of θ are cut until they resolve the function.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

Array = NDArray[np.float64]

POINTS, RESOLVED, NARROW = 16, 1e-11, 1e-3  # of a panel, and when they suffice


class RootSeries:
    """A function of a place between the first and the last of some marks, from few values."""

    def __init__(self, function: Callable[[Array], Array], ends: Array) -> None:
        self.ends = ends
        open_ = [(k, 0.0, 0.5 * math.pi) for k in range(len(ends) - 1)]
        done: list[tuple[int, float, float, Array]] = []
        largest = 0.0
        while open_:
            gap, lo, hi = (np.array(column) for column in zip(*open_, strict=True))
            theta = lo[:, None] + 0.5 * (hi - lo)[:, None] * (1.0 + chebyshev.points(POINTS))
            y = ends[gap][:, None] + np.diff(ends)[gap][:, None] * np.sin(theta) ** 2
            V = function(y.ravel()).reshape(y.shape)
            largest = max(largest, float(np.abs(V).max()))
            series = chebyshev.transform(V)
            tail = np.abs(series[:, -3:]).max(axis=1)
            fine = (tail <= RESOLVED * largest) | (hi - lo < NARROW)
            done += [(gap[k], lo[k], hi[k], series[k]) for k in np.flatnonzero(fine)]
            rest = [(gap[k], lo[k], 0.5 * (lo[k] + hi[k]), hi[k]) for k in np.flatnonzero(~fine)]
            open_ = [part for k, a, m, b in rest for part in ((k, a, m), (k, m, b))]
        done.sort(key=lambda piece: piece[:2])
        self.lo, self.hi = (np.array([piece[j] for piece in done]) for j in (1, 2))
        self.begin = np.array([piece[0] + piece[1] / math.pi for piece in done])
        self.series = np.stack([piece[3] for piece in done])

    def __call__(self, y: Array) -> Array:
        k = np.clip(np.searchsorted(self.ends, y) - 1, 0, len(self.ends) - 2)
        part = np.clip((y - self.ends[k]) / (self.ends[k + 1] - self.ends[k]), 0.0, 1.0)
        theta = np.arcsin(np.sqrt(part))
        j = np.maximum(np.searchsorted(self.begin, k + theta / math.pi, side="right") - 1, 0)
        place = 2.0 * (theta - self.lo[j]) / (self.hi[j] - self.lo[j]) - 1.0
        values: Array = chebyshev.evaluate(self.series[j].T, place)
        return values
