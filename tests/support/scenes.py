"""Scenes that several modules of tests ask about."""

from typing import Any

import sie
from sie import Profile, Scene


def dissimilar(
    profile: Profile | None = None, beta: float = 0.3, friction: float = 0.3, **loads: Any
) -> Scene:
    """Dissimilar bodies with friction, under P = 1 if no loads are given."""
    return Scene(
        profile=profile or sie.Parabola(1.0),
        modulus=2.0,
        dundurs=beta,
        friction=friction,
        **(loads or {"normal_load": 1.0}),
    )
