"""One interval without a kernel: the density's coefficients are a transform of g.

For a = 0 that is a DCT, and nothing is solved.

Conditions and free functions determine a combination of particular solutions, by a system as small
as their number.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev, jacobi
from sie.numerics.jacobi_weight import Weight

from .attempt import Attempt, Terms, attempted
from .formulation import (
    PROBES,
    Problem,
    condition_rows,
    constant_of,
    functionals,
    positions,
    right_hand_side,
    sample,
    solved,
)
from .rounding import unsure

Array = NDArray[Any]


def by_transform(problem: Problem, n: int) -> Attempt:
    """The attempt with n coefficients, by transforms in place of a linear system."""
    (interval,), (weight,) = problem.maps, problem.weights
    m, constant, kappa = n - weight.kappa, constant_of(problem, weight), weight.kappa
    s, analysed = _transform(weight.inverse, m)
    at = np.concatenate((s, PROBES))
    x, _, _, stretch, _ = positions(interval, 1.0 - at, 1.0 + at)
    sampled = np.stack([sample(name, f, x) for name, f in problem.functions]) * stretch
    second = analysed(sampled[:, :m]) / constant  # the coefficients of p̃ ...
    c = np.zeros((len(second), n), dtype=second.dtype)
    c[:, max(kappa, 0) :] = second[:, max(-kappa, 0) :]  # ... are those of p, moved
    rows, values = condition_rows(problem, [functionals(interval, weight, n)])
    found, unknown = _closed(c, second[:, : max(-kappa, 0)], rows, values, kappa)
    multiples = np.concatenate(([1.0], unknown))
    wanted, vanishes = right_hand_side(problem, multiples, sampled, values)
    found, image = (0.0 * found, 0.0 * second[0]) if vanishes else (found, multiples @ second)
    left_over = constant * jacobi.evaluate(weight.inverse, image, PROBES) - wanted[m:]
    off = float(unsure(x, wanted / stretch, stretch).max())
    return attempted(problem, [found], unknown, [Terms(n, left_over, wanted, sampled[0], 0.0, off)])


def _closed(
    c: Array, defects: Array, rows: Array, values: Array, kappa: int
) -> tuple[Array, Array]:
    """The combination of particular solutions that meets all conditions.

    The particular solutions c begin with that of g, and the homogeneous one is added if κ = 1.
    """
    functions = len(c)
    if kappa == 1:
        c = np.concatenate((c, np.eye(1, c.shape[1], dtype=c.dtype)))
        defects = np.zeros((len(c), 0))
    if len(c) == 1:
        return c[0], np.zeros(0)
    matrix = np.concatenate((rows @ c.T, defects.T))
    wanted = np.concatenate((values, np.zeros(defects.shape[1])))
    unknown = solved(matrix[:, 1:], wanted - matrix[:, 0])
    return c[0] + unknown @ c[1:], unknown[: functions - 1]


def _transform(weight: Weight, n: int) -> tuple[Array, Callable[[Array], Array]]:
    """Nodes, and the map from values there to the coefficients of the first n polynomials.

    It is a DCT for the Chebyshev weights.
    """
    if not weight.is_chebyshev:
        s, A = jacobi.analysis(weight, n)
        return s, lambda values: values @ A
    kind = _KINDS[float(weight.alpha.real), float(weight.beta.real)]

    def by_dct(values: Array) -> Array:
        if np.iscomplexobj(values):
            return by_dct(values.real) + 1j * by_dct(values.imag)
        return kind(
            np.concatenate((chebyshev.transform(values), np.zeros((len(values), 2))), axis=-1)
        )

    return chebyshev.points(n), by_dct


def _first_kind(t: Array) -> Array:
    c = np.sqrt(0.5 * np.pi) * t[:, :-2]
    c[:, 0] *= np.sqrt(2.0)
    return c


def _second_kind(t: Array) -> Array:
    """T_n = (U_n - U_{n-2}) / 2."""
    c = 0.5 * (t[:, :-2] - t[:, 2:])
    c[:, 0] += 0.5 * t[:, 0]
    return np.sqrt(0.5 * np.pi) * c


def _third_kind(t: Array) -> Array:
    """T_n = (V_n + V_{n-1}) / 2."""
    c = 0.5 * (t[:, :-2] + t[:, 1:-1])
    c[:, 0] += 0.5 * t[:, 0]
    return np.sqrt(np.pi) * c


def _fourth_kind(t: Array) -> Array:
    """T_n = (W_n - W_{n-1}) / 2."""
    c = 0.5 * (t[:, :-2] - t[:, 1:-1])
    c[:, 0] += 0.5 * t[:, 0]
    return np.sqrt(np.pi) * c


# From Chebyshev coefficients (padded by two zeros) to those of the orthonormal polynomials of (1 -
# s)^α (1 + s)^β.
_KINDS = {
    (-0.5, -0.5): _first_kind,
    (0.5, 0.5): _second_kind,
    (-0.5, 0.5): _third_kind,
    (0.5, -0.5): _fourth_kind,
}
