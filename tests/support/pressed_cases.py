"""Dissimilar bodies under P alone, and what their fields are compared with."""

from __future__ import annotations

from typing import Any

from scenes import dissimilar

import sie

PROFILES = {
    "flat": sie.Flat(1.0),
    "wedge": sie.Wedge(0.1),
    "parabola": sie.Parabola(1.0),
    "power": sie.Power(2.5, 0.4),
    "rounded flat": sie.RoundedFlat(0.5, 1.0),
    "polynomial": sie.Polynomial((0.0, 0.0, 0.5, 0.0, 0.2)),
    "function": sie.FromFunction(slope="sinh(x)"),
    "function without slope": sie.FromFunction(slope="0*x", domain=(-1.0, 1.0)),
    "shifted": sie.Parabola(1.0).shifted(3.0),
    "kinked": sie.Piecewise((-2.0, -0.4, 0.4, 2.0), ((0.6, 2.0), (0.0, 0.5), (-0.6, 2.0))),
}


def solved(*args: Any, **kwargs: Any) -> sie.Solution:
    return sie.solve(dissimilar(*args, **kwargs))
