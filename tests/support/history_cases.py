"""Histories of P, Q, bulk stress and tilt."""

from dataclasses import replace
from typing import Any

import numpy as np

import sie

Points = list[tuple[float, ...]]

P0, f = np.pi / 4.0, 0.3
F, S = f * P0, 4.0 * f * P0 / np.pi
HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=P0, friction=f)
LOPSIDED = replace(HERTZ, profile=sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.125)))
# Points are (P/P0, Q/F, σ/S, tilt).
FALLING = [(1, 0, 0), (1, 0.4, 0.1), (0.7, 0.3, 0.3)]
IN_PHASE = [(1, 0, 0), (1.2, 0.55, 0.1), (0.9, -0.3, -0.1)]
OUT_OF_PHASE = [(1, 0.4, 0), (1, 0, 0.2), (1, -0.4, 0), (1, 0, -0.2), (1, 0.4, 0)]


MEAN_STRESS = [(1, 0, 0.3), (1, 0.5, 0.3), (1, -0.5, 0.3), (1, 0.5, 0.3)]


def scaled(points: Points) -> list[tuple[float, ...]]:
    return [(P * P0, Q * F, sigma * S, *tilt) for P, Q, sigma, *tilt in points]


def followed(scene: sie.Scene, points: Points, parts: int = 1) -> sie.History:
    tilt = [point[3] for point in points] if len(points[0]) == 4 else ()
    path = sie.Path([point[:3] for point in scaled(points)], tilt=tilt)
    return sie.follow(scene, path.subdivided(parts))


def hertz_stick(level: Any, tilt: Any) -> Any:
    """The contact of h' = x + tilt under level × P0, whose half-width is 1 under P0."""
    return -tilt - np.sqrt(level), -tilt + np.sqrt(level)


def inside(solution: sie.Solution, n: int = 21) -> Any:
    """Points of the contact away from its edges, where q falls like a square root."""
    x1, x2 = solution.edges
    return 0.5 * (x1 + x2) + 0.49 * (x2 - x1) * np.linspace(-1.0, 1.0, n)
