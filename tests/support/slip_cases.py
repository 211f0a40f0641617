"""Contacts in partial slip."""

from typing import Any

import mpmath

import sie

mp = mpmath.mp.clone()
mp.dps = 70  # 40 are left where θ - sin θ cos θ of a thin rim cancels
E, F, P = 2.0, 0.5, 0.375


def sheared(profile: sie.Profile, fraction: float, load: float = P, **more: Any) -> sie.Solution:
    loads: dict[str, Any] = {"normal_load": load, "tangential_load": fraction * F * load}
    return sie.solve(sie.Scene(profile=profile, modulus=E, friction=F, **loads, **more))


def left_over(solution: sie.Solution) -> Any:
    """P - Q/f in exact arithmetic, from the doubles that the solver got."""
    scene = solution.scene
    return mp.mpf(scene.normal_load) - mp.mpf(scene.tangential_load) / mp.mpf(scene.friction)


def rounded_load(a: Any, s: Any) -> Any:
    """P of the contact of half-width s: E* s²/2 (θ - sin θ cos θ), cos θ = a/s."""
    theta = mp.acos(a / s)
    return E * s * s / 2 * (theta - mp.sin(theta) * mp.cos(theta))
