"""The variable in which functions that are singular beyond both ends of an interval are smooth."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

APART = 1e17  # times its length, from an interval: there a singularity is none


def stretched(length: Any, before: Any, after: Any, grown: Array, left: Array) -> tuple[Any, ...]:
    """Places of an interval by v = ln((B + y)/(C + L - y)): y and L - y, and dy/dv.

    `grown` of v lies behind and `left` ahead. y and L - y are the distances from the ends.

    A function that is singular at y = -B and y = C + L, and nowhere else on the line beside the
    interval, is analytic in v for |Im v| < π.
    """
    ratio, rise, back = before / (after + length), np.expm1(grown), np.expm1(left)
    below = 1.0 + ratio * (1.0 + rise)
    to_end = after * back / (1.0 + after / (before + length) * (1.0 + back))
    rate = before * (1.0 + ratio) * (1.0 + rise) / (below * below)
    return before * rise / below, to_end, rate
