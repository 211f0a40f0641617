"""Scenes that several modules of tests ask about."""

from typing import Any

import sie
from sie import Profile, Scene

PUNCH = sie.RoundedFlat(1.0, 2.0)


def scene(profile: Profile = PUNCH, **given: Any) -> Scene:
    """E* = 1 under P = 1, if no body and no half-width are given; what is ... is left out."""
    bodies = {} if {"body", "indenter"} & given.keys() else {"modulus": 1.0}
    loads = {} if "half_width" in given else {"normal_load": 1.0}
    given = {"profile": profile} | bodies | loads | given
    return Scene(**{name: value for name, value in given.items() if value is not ...})


def solved(profile: Profile = PUNCH, **given: Any) -> sie.Solution:
    return sie.solve(scene(profile, **given))


def dissimilar(
    profile: Profile | None = None, beta: float = 0.3, friction: float = 0.3, **loads: Any
) -> Scene:
    """Dissimilar bodies with friction, under P = 1 if no loads are given."""
    given: dict[str, Any] = {"modulus": 2.0, "dundurs": beta, "friction": friction}
    return Scene(profile=profile or sie.Parabola(1.0), **given, **(loads or {"normal_load": 1.0}))
