"""How the receding end of a stick zone is sought on one part of a march.

Its place u has a series whose points are Radau's, which hold the end of the part. Where m ∓ k r
comes back to u at the end of the part, u rests there, so that du/dy is 1 - y times a function.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

Array = NDArray[np.float64]

DEGREE = 10  # of the series of u


class Unknown(NamedTuple):
    """u at the points of a part by numbers of the size of one, and its series by these numbers."""

    start: Array
    places: Callable[[Array], Array]
    series: Callable[[Array], Array]
    size: float


def slowing(start: float, way: float) -> Unknown:
    """u on a part at whose end it rests: 1 - y times a positive function, which is sought."""
    y, size = points()[0], abs(way)

    def series(z: Array) -> Array:
        c: Array = size * (_slowed() @ z)
        c[0] += start
        return c

    def places(z: Array) -> Array:
        return np.asarray(chebyshev.evaluate(series(z), y))

    return Unknown(np.append(start, np.full(DEGREE, np.sign(way))), places, series, size)


@lru_cache(maxsize=1)
def points() -> tuple[Array, Array]:
    """Radau's points, and the matrix from values at -1 and at these to a series."""
    legendre = np.zeros(DEGREE + 1)
    legendre[-2:] = -1.0, 1.0
    y = np.sort(np.polynomial.legendre.legroots(legendre).real)
    y[-1] = 1.0
    matrix = np.polynomial.chebyshev.chebvander(np.append(-1.0, y), DEGREE)
    return y, np.linalg.inv(matrix)


@lru_cache(maxsize=1)
def _slowed() -> Array:
    """The matrix from g at the points to the series of ∫ g (1 - y) dy/2 from -1 on."""
    module = np.polynomial.chebyshev
    rows = np.linalg.inv(module.chebvander(points()[0], DEGREE - 1)).T
    slowed = [module.chebint(module.chebmul(row, [0.5, -0.5]), lbnd=-1.0) for row in rows]
    return np.array([np.pad(c, (0, DEGREE + 2 - len(c))) for c in slowed]).T
