"""Contacts in full sliding and in full stick."""

import math
from typing import Any

import numpy as np

import sie

SIMILAR: dict[str, Any] = {"modulus": 2.0}
RIM = sie.RoundedFlat(half_flat=1.0, radius=50.0)


def slid(profile: sie.Profile, coupling: float, **given: Any) -> sie.Solution:
    """Full sliding in +x with β f = coupling."""
    pair: dict[str, Any] = {**SIMILAR, "dundurs": 0.5 * coupling, "friction": 2.0}
    return sie.solve(sie.Scene(profile=profile, **pair, sliding=1, **given))


def inside(solution: sie.Solution, n: int = 201) -> Any:
    """Places in the contact that crowd towards both edges."""
    return solution.centre + solution.half_width * np.cos((np.arange(n) + 0.5) * np.pi / n)


def bonded(beta: float, P: float = 5.0, Q: float = 2.0, b: float = 2.0, **given: Any) -> sie.Scene:
    """A flat punch in full stick."""
    pair: dict[str, Any] = {"modulus": 3.0, "dundurs": beta, "friction": math.inf}
    return sie.Scene(profile=sie.Flat(b), **pair, normal_load=P, tangential_load=Q, **given)
