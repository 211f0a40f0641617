"""Distances between answers: doubles compared with numbers of many digits, without rounding.

`largest` and `smallest` of several numbers are nan if one is nan. Python's max and min ignore a
nan, and so a missing answer.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import mpmath
import numpy as np

mp = mpmath.mp.clone()
mp.dps = 50


def largest(numbers: Iterable[float]) -> float:
    """nan if any of them is."""
    return float(np.max(np.array([*numbers], dtype=float)))


def smallest(numbers: Iterable[float]) -> float:
    """nan if any of them is."""
    return float(np.min(np.array([*numbers], dtype=float)))


def apart(
    found: Sequence[float] | np.ndarray[Any, Any], true: Sequence[Any], factor: float = 1.0
) -> float:
    """The largest difference over the largest true value; `factor` spoils the answer, for a
    control.
    """
    values = [mp.mpmathify(complex(v) if np.iscomplexobj(v) else float(v)) for v in np.ravel(found)]
    exact = [mp.mpmathify(t) for t in true]
    if len(values) != len(exact):
        raise ValueError(f"{len(values)} answers and {len(exact)} true values: give one for each")
    scale = max(map(abs, exact))
    return largest(abs(factor * v - t) / scale for v, t in zip(values, exact, strict=True))


def relative(found: float, true: Any, factor: float = 1.0) -> float:
    """|found/true - 1|."""
    return float(abs(mp.mpf(float(found)) * factor / mp.mpmathify(true) - 1))
