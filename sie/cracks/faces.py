"""Which faces of a crack touch, by cells of constant opening: a linear complementarity problem.

A cell that is open by U has a dislocation at either end. Their stress on the faces is -A U, A with
a positive diagonal and negative other entries, so that

    U >= 0,      A U - σ >= 0,      U (A U - σ) = 0

has one solution, and policy iteration, which solves for the open cells and then opens what is in
tension and closes what overlaps, ends after a few steps. Cells are graded towards mouth and tip.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CELLS, SHORTEST = 72, 1e-4  # their number, and the least next to the mouth, of the depth
ROUNDS = 200


def open_zones(stress: Callable[[Array], Array]) -> tuple[tuple[float, float], ...]:
    """The zones of a crack of depth 1 whose faces are apart under a stress, to a cell."""
    edges, middles, A = cells()
    return _zones(opened(A, stress(middles)), edges)


@lru_cache(maxsize=1)
def cells() -> tuple[Array, Array, Array]:
    """The edges of the cells, their middles, and A."""
    half = CELLS // 2
    deep = 1.0 - 0.5 * np.linspace(1.0, 0.0, half + 1) ** 2
    edges = np.concatenate(([0.0], np.geomspace(SHORTEST, 0.5, half)[:-1], deep))
    middles = 0.5 * (edges[1:] + edges[:-1])
    y, t = middles[:, None], edges[None, :]
    s = t + y
    of_dislocation = (1.0 / (t - y) - 1.0 / s + 6.0 * y / s**2 - 4.0 * y**2 / s**3) / np.pi
    return edges, middles, of_dislocation[:, 1:] - of_dislocation[:, :-1]


def opened(A: Array, stress: Array) -> NDArray[np.bool_]:
    """Whether each cell is open under the stresses at their middles."""
    apart = np.ones(stress.shape, dtype=bool)
    for _ in range(ROUNDS):
        U = np.zeros(len(stress))
        U[apart] = np.linalg.solve(A[np.ix_(apart, apart)], stress[apart])
        found = np.where(apart, U > 0.0, stress - A @ U > 0.0)
        if (found == apart).all():
            break
        apart = found
    return apart


def _zones(apart: NDArray[np.bool_], edges: Array) -> tuple[tuple[float, float], ...]:
    change = np.flatnonzero(np.diff(np.concatenate(([False], apart, [False])).astype(int)))
    return tuple((float(edges[i]), float(edges[j])) for i, j in change.reshape(-1, 2))
