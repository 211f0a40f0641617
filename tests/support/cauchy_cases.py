"""A smooth kernel, and the places at which one is asked for, for tests of Cauchy equations."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

import sie

Array = NDArray[np.float64]
Kernel = Callable[[Array, Array], Any]


def smooth_kernel(x: Array, t: Array) -> Array:
    values: Array = 0.1 * np.exp(0.5 * x - t) * np.cos(x * t)
    return values


def counted(k: Kernel, intervals: Any = ((-1.0, 1.0),), g: Any = 1.0, a: Any = 0.0) -> Any:
    """(the numbers of values that k was asked for, density), held against that of more nodes."""
    calls = []

    def counting(x: Array, t: Array) -> Any:
        calls.append(x.size)
        return k(x, t)

    equation = sie.CauchyEquation(intervals, g, k=counting, a=a, total=(0.0,) * len(intervals))
    density = equation.solve()
    asked = list(calls)
    x = np.concatenate([x1 + (x2 - x1) * np.linspace(0.01, 0.99, 23) for x1, x2 in intervals])
    direct = equation.solve(n=max(64, *density.n))
    assert np.abs(density(x) - direct(x)).max() <= 1e-13 * np.abs(direct(x)).max()
    return asked, density
