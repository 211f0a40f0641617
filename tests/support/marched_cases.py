"""Paths that are marched, and what their states are compared with."""

from functools import cache
from typing import Any

import numpy as np
from history_cases import P0, F, Points, S

import sie
from sie.friction.load_steps import loads_of, turning_points
from sie.paths.history import History
from sie.problem.request import ECONOMY

# Points are (P/P0, Q/F, σ/S, tilt).
MEAN_STRESS = [(1, 0, 0.3), (1, 0.5, 0.3), (1, -0.5, 0.3), (1, 0.5, 0.3)]
TRAVELLING = [(1, 0, 0), (1, 0.5, 3)]
BOTH_STICK = [(1, 0, 0), (1.6, 0.2, 0.2), (1.9, 0.7, 0.5)]


def followed(scene: sie.Scene, points: Points, parts: int = 1) -> History:
    return history_of(scene, path_of(points).subdivided(parts))


@cache
def history_of(scene: sie.Scene, path: sie.Path) -> History:
    """Tests share what they only read."""
    return sie.follow(scene, path)


def path_of(points: Points) -> sie.Path:
    tilt = [point[3] for point in points] if len(points[0]) == 4 else ()
    return sie.Path([(P * P0, Q * F, sigma * S) for P, Q, sigma, *_ in points], tilt=tilt)


def all_marched(scene: sie.Scene, points: Points) -> History:
    """The same, every step but the first one marched."""

    def steps(scene: sie.Scene, path: sie.Path, contacts: Any) -> tuple[Any, ...]:
        found = [turning_points(scene, path, contacts)[0]]
        for loads in loads_of(path)[1:]:
            found.append(contacts.in_parts(found[-1], loads))
        return tuple(found)

    return History(scene, path_of(points), 1e-13, ECONOMY, steps)


def inside(solution: sie.Solution, n: int = 41) -> Any:
    """Points of the contact away from its edges, where q falls like a square root."""
    x1, x2 = solution.edges
    return 0.5 * (x1 + x2) + 0.49 * (x2 - x1) * np.linspace(-1.0, 1.0, n)
