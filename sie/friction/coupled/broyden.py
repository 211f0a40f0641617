"""Broyden's steps to a zero of a few dozen conditions, in logarithms that may move by about 1.

The derivatives are those of an earlier zero nearby, or differences, corrected after every step.

Source: Broyden, Math. Comp. 19 (1965) 577.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STEP = 1e-6  # of a logarithm, for differences
FARTHEST = 0.7  # of a logarithm, a step
STEPS = 40
LOST = 1e-3  # of the logarithms: conditions that are missed by more may grow no more
CUT = 0.3  # of a step that leads away


def zero(
    missed: Callable[[Array], Array], values: Array, J: Array | None, settled: float
) -> tuple[Array, Array] | None:
    """The zero next to the values, and the derivatives J there; None where steps lead away."""
    now, fresh = missed(values), False
    for _ in range(STEPS):
        if not np.isfinite(now).all():
            return None
        if J is None:
            J, fresh = _differences(missed, values, now), True
        try:
            step = -np.linalg.solve(J, now)
        except np.linalg.LinAlgError:
            return None
        size = float(np.abs(step).max())
        step *= min(1.0, FARTHEST / size)
        later = missed(values + step)
        if not np.abs(later).max() < max(2.0 * np.abs(now).max(), LOST):
            if not fresh:
                J = None
                continue
            step *= CUT
            later = missed(values + step)
            if not np.isfinite(later).all():
                return None
        J = J + np.outer(later - now - J @ step, step) / (step @ step)
        values, now, fresh = values + step, later, False
        if size < settled:
            return values, J
    return None


def _differences(missed: Callable[[Array], Array], values: Array, now: Array) -> Array:
    """The derivatives of what is missed, `now` at the values."""
    columns = [missed(values + STEP * unit) - now for unit in np.eye(len(values))]
    J: Array = np.array(columns).T / STEP
    return J
