"""The table [fatigue] of a scene file: constants of the material, and where a cycle is examined."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

DEPTHS = (0.01, 0.1)
# Constants, each with one that it needs beside it.
TOGETHER = (
    ("shear_limit", "findley_k"),
    ("fatemi_socie_k", "yield_stress"),
    ("yield_stress", "fatemi_socie_k"),
)
PARTS, MOST_PARTS, MOST_DEPTHS = 4, 100, 100


@dataclass(frozen=True)
class Fatigue:
    """The content of [fatigue]; 0 stands for a constant that is not given.

    Parameters
    ----------
    findley_k : float
        Weight of the normal stress in Findley's parameter.
    shear_limit : float
        What Findley's parameter may reach, in units of stress.
    fatemi_socie_k : float
        Weight of the normal stress in the parameter of Fatemi and Socie.
    yield_stress : float
        σ_y in the parameter of Fatemi and Socie.
    depth : float or list of float
        Where parameters are given beside the surface; without it DEPTHS of the largest half-width.
    parts : int
        At how many states each step of the cycle is examined, 4 if it is not given.
    """

    findley_k: float = 0.0
    shear_limit: float = 0.0
    fatemi_socie_k: float = 0.0
    yield_stress: float = 0.0
    depth: tuple[float, ...] = ()
    parts: int = PARTS


def fatigue_of(values: Mapping[str, Any]) -> Fatigue:
    """The content of [fatigue]. Raises ValueError for constants of no material."""
    for name, other in TOGETHER:
        if name in values and other not in values:
            raise ValueError(f"[fatigue] has {name} without {other}: give {other} = ... too")
    depth = values.get("depth", ())
    depth = depth if isinstance(depth, tuple) else (depth,)
    if len(depth) > MOST_DEPTHS:
        raise ValueError(f"[fatigue] depth has {len(depth)} values: give at most {MOST_DEPTHS}")
    parts = values.get("parts", PARTS)
    if not 1 <= parts <= MOST_PARTS:
        raise ValueError(f"[fatigue] parts = {parts} is not a number from 1 to {MOST_PARTS}")
    return Fatigue(**{**values, "depth": depth})
