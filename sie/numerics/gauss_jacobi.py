"""Gauss rules for x^b (1 - x)^a on (0, 1), with the distances of the nodes from both ends.

The nodes are eigenvalues of the matrix of the three-term recurrence (Golub & Welsch 1969), the
weights are Christoffel's numbers 1/Σ p_k², a sum of squares, which add up to a known mass. SciPy's
lose three digits.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LARGEST = 160.0  # sum of the exponents: gamma functions overflow beyond


class Rule(NamedTuple):
    """∫_0^1 f dx = Σ weight f(x) where f is x^b (1 - x)^a times a smooth function g."""

    x: Array
    rest: Array  # 1 - x
    weight: Array  # of g


@lru_cache(maxsize=64)
def gauss_jacobi(n: int, a: float, b: float) -> Rule:
    """The rule of n nodes for the weight x^b (1 - x)^a; a, b > -1."""
    k = np.arange(1.0, n)
    s = 2.0 * k + a + b
    middle = np.concatenate(([(b - a) / (a + b + 2.0)], (b * b - a * a) / (s * (s + 2.0))))
    squared = 4.0 * k * (k + a) * (k + b) / (s * s * (s + 1.0))
    squared[1:] *= (k[1:] + a + b) / (s[1:] - 1.0)
    squared[:1] = 4.0 * (1.0 + a) * (1.0 + b) / ((2.0 + a + b) ** 2 * (3.0 + a + b))
    beside = np.sqrt(squared)
    matrix = np.zeros((n, n))
    matrix.reshape(-1)[:: n + 1] = middle
    matrix.reshape(-1)[n :: n + 1] = beside  # LAPACK reads the lower triangle
    t = np.asarray(np.linalg.eigvalsh(matrix), dtype=float)
    p = np.ones((n, n))
    rise, last = (t - middle[:, None])[:-1] / beside[:, None], beside[:-1] / beside[1:]
    if n > 1:
        p[1] = rise[0]
    for j, ratio in enumerate(last.tolist(), 2):
        np.multiply(rise[j - 1], p[j - 1], out=p[j])
        p[j] -= ratio * p[j - 2]
    total = np.einsum("ji,ji->i", p, p)
    if a + b < LARGEST:
        mass = math.gamma(a + 1.0) * math.gamma(b + 1.0) / math.gamma(a + b + 2.0)
    else:
        mass = math.exp(math.lgamma(a + 1.0) + math.lgamma(b + 1.0) - math.lgamma(a + b + 2.0))
    weight = mass / total
    rule = Rule(0.5 * (1.0 + t), 0.5 * (1.0 - t), weight * (mass / weight.sum()))
    for array in rule:
        array.flags.writeable = False
    return rule


@lru_cache(maxsize=64)
def with_weight(n: int, a: float, b: float) -> Rule:
    """The same rule with weights of the whole integrand f."""
    x, rest, weight = gauss_jacobi(n, a, b)
    whole = weight * (x**-b * rest**-a)
    whole.flags.writeable = False
    return Rule(x, rest, whole)
