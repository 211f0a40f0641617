"""The error of a density by rounding of the equation's terms and of their positions.

The residual does not show this error. Near an eigenvalue of the equation and next to a narrow
gap, equally small residuals belong to densities further apart, and in a gap a small quantity, as
the coefficient of a bounded end, has the absolute error of the large ones. So roundings are drawn
at random, and the equation is solved for them.

Source: Higham, Accuracy and Stability of Numerical Algorithms (2002), § 1.6, for errors by
perturbation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import jacobi
from sie.numerics.interval import EPS

if TYPE_CHECKING:
    from sie.numerics.jacobi_weight import Weight

    from .interval_map import Map

Array = NDArray[Any]

DRAWS = 4  # of roundings
# a rounding's effect is hardly more than this times its root mean square over so few draws
LARGEST = 3.0


class Spread(NamedTuple):
    """The errors of one interval's density by rounding.

    They are those of φ and of φ ρ over the largest value there, and those of each coefficient.
    """

    relative: float
    coefficients: Array


def signs(rows: int) -> Array:
    """Roundings of 1 up or down, (rows, DRAWS), the same ones each time."""
    out: Array = EPS * np.random.default_rng(0).choice((-1.0, 1.0), (rows, DRAWS))
    return out


def spread(
    interval: Map, weight: Weight, quadrature: tuple[Array, Array], c: Array, off: Array
) -> Spread:
    """The spread from the coefficients' errors (n, DRAWS).

    `quadrature` is the nodes and the matrix to weights times values there (`jacobi.analysis`).
    """
    sigma, matrix = quadrature
    # A Gauss weight's root evens out the ends as the norm does in which polynomials are orthonormal
    norm = 1.0 / np.sqrt(jacobi.gauss(weight.real, len(sigma))[1])
    value, error = norm * np.abs(matrix @ c), norm * _root_mean_square(matrix @ off)
    rho = interval.distances(1.0 - sigma, 1.0 + sigma)[2]
    relative = [
        float((error * by).max()) / (float((value * by).max()) or 1.0) for by in (1.0, 1.0 / rho)
    ]
    return Spread(LARGEST * max(relative), LARGEST * _root_mean_square(off))


def _root_mean_square(draws: Array) -> Array:
    largest = float(np.abs(draws).max()) or 1.0  # whose square may be no number
    out: Array = largest * np.sqrt(np.mean(np.abs(draws / largest) ** 2, axis=1))
    return out


def unsure(x: Array, values: Array, rho: Array) -> Array:
    """The error of values(x) ρ by rounding of x: the change of the values over one rounding.

    It matters far from x = 0, and where values vary across a narrow gap; no solver can avoid it.
    """
    order = np.argsort(x)
    at, of, by = x[order], values[order], rho[order]
    steepness = np.abs(np.diff(of)) / np.maximum(np.diff(at), np.spacing(np.abs(at[1:])))
    between = steepness * EPS * np.abs(at[1:]) * np.minimum(by[1:], by[:-1])
    out = np.empty(len(x))
    out[order] = np.maximum(np.append(between, 0.0), np.append(0.0, between))
    return out
