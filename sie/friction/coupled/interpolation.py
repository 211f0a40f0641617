"""Values of a costly function at many places, from those at few.

Between two marks m and n, next to which the function may have any powers of the distance, it is
analytic in v = ln((y - m)/(n - y)) for |Im v| < π: Chebyshev series on panels of v.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

Array = NDArray[np.float64]

LENGTH, DEGREE = 2.5, 20  # of a panel of v, and of its series: (π/1.25 + 2.7)^-20 is rounding
STEEPEST = 10.0  # of the logarithm of a power, on a panel at most
NEAREST = 1e-6  # of the last mark: next to marks y has too few digits for a series in v


def interpolated(
    function: Callable[[Array], Array], marks: Array, y: Array, power: float = 1.0
) -> Array:
    """The function at y between the first and the last mark, which varies like such a power."""
    length = min(LENGTH, STEEPEST / power)
    k = np.clip(np.searchsorted(marks, y) - 1, 0, len(marks) - 2)
    above, below = y - marks[k], marks[k + 1] - y
    close = np.minimum(above, below) <= NEAREST * marks[-1]
    values = np.empty(len(y))
    if close.any():
        values[close] = function(y[close])
    k, place = k[~close], np.log(above[~close] / below[~close]) / length
    panel = np.floor(place)
    if not k.size:
        return values
    panels, which = np.unique(np.stack((k.astype(float), panel)), axis=1, return_inverse=True)
    v = length * (panels[1][:, None] + 0.5 * (1.0 + chebyshev.points(DEGREE)))
    m, n = (marks[panels[0].astype(np.intp) + j][:, None] for j in (0, 1))
    ratio = np.exp(-np.abs(v))
    near = (n - m) * ratio / (1.0 + ratio)
    nodes = np.where(v < 0.0, m + near, n - near)
    series = chebyshev.transform(function(nodes.ravel()).reshape(nodes.shape))
    values[~close] = chebyshev.evaluate(series.T[:, which.ravel()], 2.0 * (place - panel) - 1.0)
    return values
