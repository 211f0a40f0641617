"""Distances between answers: doubles held against numbers of many digits, nothing lost in the comparison."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath
import numpy as np

mp = mpmath.mp.clone()
mp.dps = 50


def apart(found: Sequence[float] | np.ndarray[Any, Any], true: Sequence[Any], factor: float = 1.0) -> float:
    """The largest difference over the largest true value; `factor` spoils the answer, for a control."""
    values = [mp.mpmathify(complex(v) if np.iscomplexobj(v) else float(v)) for v in np.ravel(found)]
    exact = [mp.mpmathify(t) for t in true]
    if len(values) != len(exact):
        raise ValueError(f"{len(values)} answers and {len(exact)} true values: give one for each")
    return float(max(abs(factor * v - t) for v, t in zip(values, exact, strict=True)) / max(map(abs, exact)))


def relative(found: float, true: Any, factor: float = 1.0) -> float:
    """|found/true - 1|."""
    return float(abs(mp.mpf(float(found)) * factor / mp.mpmathify(true) - 1))
