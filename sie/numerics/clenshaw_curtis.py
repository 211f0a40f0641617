"""The rule of Clenshaw and Curtis; an integral whose nodes are doubled until two sums agree."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INTERVALS = (4, 8, 16, 32, 64, 128)  # of the rule, one after the other


def integral(
    function: Callable[[float], float], first: float, last: float, tol: float, others: float = 0.0
) -> float | None:
    """∫ of a function that may have roots of the distance at both ends.

    It is known to `tol` of it and of what others add to it; None where that is not reached.
    """
    values: dict[float, float] = {}
    sums: list[float] = []
    for n in INTERVALS:
        v, weight = clenshaw_curtis(n)
        places = (first + (last - first) * v**2 * (3.0 - 2.0 * v)).tolist()[1:-1]
        values |= {x: function(x) for x in places if x not in values}
        mean = (6.0 * weight * v * (1.0 - v))[1:-1] @ [values[x] for x in places]
        sums.append((last - first) * float(mean))
        if len(sums) > 1 and _error(sums) <= tol * (sums[-1] + others):
            return sums[-1]
    return None


def _error(sums: list[float]) -> float:
    """Of the last sum: the difference from the one before, or less where differences fall."""
    last = abs(sums[-1] - sums[-2])
    before = abs(sums[-2] - sums[-3]) if len(sums) > 2 else 0.0
    return last * min(1.0, last / before) if before else last


@lru_cache(maxsize=16)
def clenshaw_curtis(n: int) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], with n intervals."""
    k = np.arange(n + 1)
    angle, m = math.pi * k / n, np.arange(1, n // 2 + 1)
    factor = np.where(m == n // 2, 1.0, 2.0) / (4.0 * m**2 - 1.0)
    weight = (1.0 - np.cos(2.0 * np.outer(angle, m)) @ factor) / n
    weight[[0, -1]] *= 0.5
    return np.sin(0.5 * angle) ** 2, weight
