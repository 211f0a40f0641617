"""The Chebyshev series of a regular kernel in both variables, which fills systems of any size.

    k(x_i(s), x_j(σ)) = Σ_mn C_mn T_m(s) T_n(σ)            on each pair (i, j) of intervals

The number of nodes that k needs does not depend on g, nor the reverse. So k is sampled on a grid of
its own, all pairs of intervals in one call. Further rows and columns on no grid test the series. If
the first grid is too coarse, the decay of its coefficients determines the second one. A kernel that
no small grid resolves (a layer much thinner than its contact, a kink) has no series, and `system`
samples it at its own nodes, size by size.

Rows are at the extrema of T_n and columns at its zeros, midway between: no x is a t, so that a
difference of singular terms such as 1/tan(t - x) - 1/(t - x) may be given as it is.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS

from .formulation import PROBES, Kernel, Problem, positions, positive, sample_kernel
from .interval_map import Map

Array = NDArray[Any]

FIRST = 64  # points of the first grid on each interval
FEWEST = 12  # the same where there are many intervals
MOST = 1024  # points of all intervals together, on the first grid and on the second
TAIL = 4  # the last coefficients that must have decayed ...
DECAYED = 0.05  # ... to this part of the tolerance, ...
ROUNDING = 4.0 * EPS  # ... or to rounding
# The mean of what such a series misses between the points: rounding of k itself.
MISSED = 64.0 * EPS
# from a tail below this part of the largest coefficient the size needed is estimated ...
PREDICTABLE = 0.05
MARGIN = 1.25  # ... times this


class Series(NamedTuple):
    """C[i][j] of the module's docstring."""

    coefficients: tuple[tuple[Array, ...], ...]

    def at(self, s: list[Array], sigma: list[Array]) -> Array:
        """k at rows s and columns σ, with the intervals one after another."""
        rows = [
            [chebyshev.polynomials(c.shape[0], at).T @ c for c in of]
            for of, at in zip(self.coefficients, s, strict=True)
        ]
        columns = [
            chebyshev.polynomials(c.shape[1], at)
            for c, at in zip(self.coefficients[0], sigma, strict=True)
        ]
        return np.concatenate(
            [
                np.concatenate([r @ c for r, c in zip(of, columns, strict=True)], axis=1)
                for of in rows
            ]
        )


def series(problem: Problem, tol: float) -> Series | None:
    """The kernel's series, by one call of k or two; None where it has none.

    It is None also where k returns no finite values: direct sampling then raises the error; and for
    a kernel that is singular at an end, of which no difference from its largest value would show.
    """
    if problem.k is None or problem.generalised:
        return None
    n = max(min(FIRST, MOST // len(problem.maps)), FEWEST)
    for _ in range(2):
        try:
            found, needed = _sampled(problem.k, problem.maps, n, max(DECAYED * tol, ROUNDING))
        except ValueError:
            return None
        if found is not None:
            return found
        if needed * len(problem.maps) > MOST:
            return None
        n = needed
    return None


def _sampled(k: Kernel, maps: tuple[Map, ...], n: int, enough: float) -> tuple[Series | None, int]:
    """(series by n columns and n + 1 rows on each interval if these resolve k, size needed)."""
    s, sigma = np.concatenate((_extrema(n), PROBES)), np.concatenate((chebyshev.points(n), -PROBES))
    x, t = (
        np.concatenate([positions(m, 1.0 - at, 1.0 + at)[0] for m in maps]) for at in (s, sigma)
    )
    values = sample_kernel(k, x, t)
    rows, columns = (
        list(pairwise(range(0, (len(maps) + 1) * len(at), len(at)))) for at in (s, sigma)
    )
    blocks = [[values[i:j, a:b] for a, b in columns] for i, j in rows]
    analysed = [
        [_from_extrema(n) @ block[: n + 1, :n] @ _from_zeros(n) for block in of] for of in blocks
    ]
    tail = max(_tail(c) for of in analysed for c in of)
    if tail > enough:
        slow = tail > PREDICTABLE
        return None, MOST + 1 if slow else int(np.ceil(MARGIN * n * np.log(enough) / np.log(tail)))
    found = Series(tuple(tuple(of) for of in analysed))
    missed = np.abs(found.at([s] * len(maps), [sigma] * len(maps)) - values)
    # in the mean, as a difference of singular terms is rough where x and t happen to be close
    resolved = np.sqrt(np.mean(missed * missed)) <= max(enough, MISSED) * positive(
        np.abs(values).max()
    )
    return (found if resolved else None), MOST + 1


def _tail(c: Array) -> float:
    """The last coefficients in either variable over the largest one."""
    size = np.abs(c)
    return float(max(size[-TAIL:].max(), size[:, -TAIL:].max()) / positive(size.max()))


@lru_cache(maxsize=8)
def _extrema(n: int) -> Array:
    """The n + 1 points where |T_n| = 1 on [-1, 1], ascending, symmetric to the last bit."""
    return np.sin(0.5 * np.pi * np.arange(-n, n + 1, 2) / n)


@lru_cache(maxsize=8)
def _from_extrema(n: int) -> Array:
    """Values at the extrema -> coefficients: the trapezoidal rule in the angle."""
    k = np.arange(n + 1)
    weights = np.where((k == 0) | (k == n), 0.5, 1.0)
    return _cosine(2 * k[:, None] * k[::-1], 2 * n) * (2.0 / n) * weights * weights[:, None]


@lru_cache(maxsize=8)
def _from_zeros(n: int) -> Array:
    """Values at the zeros times this: coefficients, by the midpoint rule in the angle."""
    k = np.arange(n)
    return _cosine((2 * k[::-1, None] + 1) * k, 2 * n) * np.where(k == 0, 1.0 / n, 2.0 / n)


def _cosine(numerator: NDArray[np.int64], denominator: int) -> Array:
    """cos(π numerator / denominator), by an angle in the first quadrant.

    The cosine of k times a rounded angle would have k times the rounding error.
    """
    m = numerator % (2 * denominator)
    m = np.minimum(m, 2 * denominator - m)
    first = np.minimum(m, denominator - m)
    out: Array = np.where(m > first, -1.0, 1.0) * np.sin(
        np.pi * (denominator - 2 * first) / (2 * denominator)
    )
    return out
