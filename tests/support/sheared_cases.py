"""Dissimilar bodies under P, then Q."""

from __future__ import annotations

from typing import Any

import numpy as np
from scenes import dissimilar

import sie

PROFILES = {
    "wedge": sie.Wedge(0.1),
    "parabola": sie.Parabola(1.0),
    "power": sie.Power(2.5, 0.4),
    "rounded flat": sie.RoundedFlat(0.5, 1.0),
    "uneven": sie.Polynomial((0.0, 0.0, 0.5, 0.03, 0.02)),
    "function": sie.FromFunction(slope="sinh(x)"),
    "shifted": sie.Parabola(1.0).shifted(3.0),
    "kinked": sie.Piecewise((-2.0, -0.4, 0.4, 2.0), ((0.6, 2.0), (0.0, 0.5), (-0.6, 2.0))),
}


def scene(
    profile: sie.Profile | None = None,
    beta: float = 0.3,
    friction: float = 0.3,
    part: float = 0.5,
    load: float = 1.0,
    **others: Any,
) -> sie.Scene:
    loads = {"normal_load": load, "tangential_load": part * friction * load}
    return dissimilar(profile, beta, friction, **loads, **others)


def solved(*args: Any, **kwargs: Any) -> sie.Solution:
    return sie.solve(scene(*args, **kwargs))


def zones(solution: sie.Solution) -> Any:
    ((e1, e2),) = solution.stick
    x1, x2 = solution.edges
    return np.array([x1, e1, e2, x2])
