"""Series of a costly function on a line, in roots of the distances from some marks."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

Array = NDArray[np.float64]

POINTS, TAIL = 16, 3  # of a panel, and of its coefficients those that must be small
SHORTEST = 1e-4  # of the root of the distance of two marks
ROUNDS = 14  # of cutting panels in two


class RootTable:
    """Series between the first and the last of ascending marks.

    tol     of the largest value: the last coefficients of a series
    """

    def __init__(self, function: Callable[[Array], Array], marks: Array, tol: float) -> None:
        starts = [(a, 1.0, 0.5 * (b - a)) for a, b in itertools.pairwise(marks.tolist())]
        backs = [(b, -1.0, 0.5 * (b - a)) for a, b in itertools.pairwise(marks.tolist())]
        self._halves = [half for pair in zip(starts, backs, strict=True) for half in pair]
        done: list[list[tuple[float, float, Array]]] = [[] for _ in self._halves]
        todo = [(k, 0.0, np.sqrt(half[2])) for k, half in enumerate(self._halves)]
        y, largest = 0.5 * (1.0 + chebyshev.points(POINTS)), 0.0
        for number in range(ROUNDS):
            places = []
            for k, lo, hi in todo:
                mark, side, _ = self._halves[k]
                places.append(mark + side * (lo + (hi - lo) * y) ** 2)
            values = function(np.concatenate(places)).reshape(len(todo), POINTS)
            largest = max(largest, float(np.abs(values).max()))
            rest = []
            for (k, lo, hi), c in zip(todo, chebyshev.transform(values), strict=True):
                small = float(np.abs(c[-TAIL:]).max()) <= tol * largest
                short = hi - lo <= SHORTEST * np.sqrt(self._halves[k][2])
                if small or short or number == ROUNDS - 1:
                    done[k].append((lo, hi, c))
                else:
                    middle = 0.5 * (lo + hi)
                    rest += [(k, lo, middle), (k, middle, hi)]
            if not rest:
                break
            todo = rest
        self._panels = [sorted(panels, key=lambda one: one[0]) for panels in done]

    def __call__(self, x: Array) -> Array:
        values = np.empty(x.shape)
        number = np.clip(np.searchsorted(self._cuts, x) - 1, 0, len(self._halves) - 1)
        for k in np.unique(number).tolist():
            own = number == k
            mark, side, _ = self._halves[k]
            root = np.sqrt(np.maximum(side * (x[own] - mark), 0.0))
            lo = np.array([panel[0] for panel in self._panels[k]])
            hi = np.array([panel[1] for panel in self._panels[k]])
            series = np.array([panel[2] for panel in self._panels[k]])
            j = np.clip(np.searchsorted(lo, root, side="right") - 1, 0, len(lo) - 1)
            y = 2.0 * (root - lo[j]) / (hi[j] - lo[j]) - 1.0
            values[own] = chebyshev.evaluate(series[j].T, np.clip(y, -1.0, 1.0))
        return values

    @property
    def _cuts(self) -> list[float]:
        """Where the halves begin, ascending, and the last ends."""
        cuts = []
        for a, _, half in self._halves[::2]:
            cuts += [a, a + half]
        return [*cuts, self._halves[-1][0]]
