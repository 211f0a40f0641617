"""The potential of a smooth slope off its contact: one series, which also serves far from any."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval

Array = NDArray[np.float64]

# Beyond so many widths from the centre of a contact |ρ| is less than
# 1/(2 FAR_FIELD + sqrt(4 FAR_FIELD² - 1)) = 0.172.
FAR_FIELD = 1.5


def outer_series(series: Array, contact: Interval, z: Any) -> tuple[Any, Any]:
    """Σ_{n>0} g_n ρ^n and its derivative, ρ = 1/(s + sqrt(s - 1) sqrt(s + 1)), off the contact.

    That is 1/π∫p/(z - t) dt of p = sqrt(1 - s²) Σ g_{n+1} U_n(s). The other form of ρ,
    s - sqrt(s² - 1), cancels. As dρ/dz = -ρ/R, the derivative is -Σ n g_n ρ^n / R.
    """
    left, right = contact.from_left(z), -contact.from_right(z)
    on_line, side = not np.iscomplexobj(z), 1.0
    if on_line:
        side = np.sign(left)
        left, right = np.abs(left), np.abs(right)
    root = side * (np.sqrt(left) * np.sqrt(right))
    rho = 2.0 * contact.r / (side * (left + right) + 2.0 * root)
    F, steep = np.zeros_like(rho), np.zeros_like(rho)
    for n in range(len(series) - 1, 0, -1):
        F += series[n]
        F *= rho
        steep += n * series[n]
        steep *= rho
    return F, -steep / root
