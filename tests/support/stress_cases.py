"""Scenes whose stress is looked at."""

from typing import Any

import sie

F = 0.3
STEEL = sie.Elastic(210e3, 0.3)


def sliding(scene: sie.Scene, friction: float = F, **changes: Any) -> sie.Solution:
    """The scene in full sliding."""
    P = sie.solve(scene).normal_load
    return sie.solve(scene).with_(friction=friction, tangential_load=friction * P, **changes)


PUNCH = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, half_width=1.0, poisson=0.3)
LOPSIDED = sie.Scene(
    profile=sie.Piecewise((-0.5, 1.0), ((0.25, 0.5), (0.0,), (-2.0, 2.0))),
    body=STEEL,
    normal_load=2e4,
)
SHARP = sie.Scene(profile=sie.Flat(1.0), body=STEEL, normal_load=100.0, tilt=1e-5)
SCENES = {
    "punch": PUNCH,
    "lopsided": LOPSIDED,
    "sharp": SHARP,
    "wedge": sie.Scene(profile=sie.Wedge(0.2), body=STEEL, normal_load=9.0),
}
