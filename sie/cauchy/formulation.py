"""A Cauchy equation prepared for the solver: maps, weights, conditions, sampled functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.errors import ContactError
from sie.numerics import jacobi
from sie.numerics.interval import EPS

from .interval_map import Affine, Map

if TYPE_CHECKING:
    from sie.numerics.jacobi_weight import Weight

Array = NDArray[Any]
Function = Callable[[Array], Any] | complex
Kernel = Callable[[Array, Array], Any]

# Nodes of the first attempt: on one interval, on each of several, on graded ones, and next to an
# end where k is singular.
SMALLEST, SMALLEST_OF_SEVERAL, SMALLEST_GRADED, SMALLEST_GENERALISED = 4, 8, 32, 112
# Points on no grid, where the equation's residual is measured.
PROBES = np.array([-0.967, -0.871, -0.537, 0.071, 0.467, 0.859, 0.973])
# A solution so many times larger than its right-hand side belongs to a matrix that is singular to
# rounding.
SINGULAR = 1e10
NEGLIGIBLE = 64.0 * EPS  # below this part of the largest, what a sum leaves is rounding


class Condition(NamedTuple):
    """∫ φ x^power dx over these intervals = value."""

    power: int
    intervals: tuple[int, ...]
    value: complex


@dataclass(frozen=True)
class Problem:
    """A well-posed equation with maps and weights; `CauchyEquation` builds it."""

    maps: tuple[Map, ...]
    weights: tuple[Weight, ...]
    a: complex
    b: complex
    g: Function
    k: Kernel | None
    conditions: tuple[Condition, ...]
    free: tuple[Function, ...]
    generalised: bool = False  # whether k is singular at an end

    def first_sizes(self) -> tuple[int, ...]:
        """The numbers of coefficients to begin with, one for each interval."""
        on_affine = SMALLEST if len(self.maps) == 1 else SMALLEST_OF_SEVERAL
        on_graded = SMALLEST_GENERALISED if self.generalised else SMALLEST_GRADED
        return tuple(on_affine if isinstance(m, Affine) else on_graded for m in self.maps)

    @property
    def functions(self) -> list[tuple[str, Function]]:
        """(name, function) of g and of all functions whose multiple is unknown.

        The last are the constants by which g may fail to be consistent.
        """
        excess = max(-sum(weight.kappa for weight in self.weights) - len(self.free), 0)
        bounded = [
            m for m, weight in zip(self.maps, self.weights, strict=True) if weight.kappa == -1
        ]
        named = [("g", self.g), *((f"free[{j}]", f) for j, f in enumerate(self.free))]
        return named + [("constant", partial(_indicator, m.x1, m.x2)) for m in bounded[:excess]]


def _indicator(x1: float, x2: float, x: Array) -> Array:
    return np.where((x >= x1) & (x <= x2), 1.0, 0.0)


# -- the terms of the equation --------------------------------------------------------------------


def constant_of(problem: Problem, weight: Weight) -> Any:
    """The constant in a w p_n + b/π PV∫ w p_n/(t - x) dt = constant p̃_{n-κ}.

    p̃ has the sign of the inverse weight's own recurrence.
    """
    return -real_if_real(problem.b) / weight.sine * jacobi.second_sign(weight)


def real_if_real(value: complex) -> Any:
    """The real part of a number without imaginary part, otherwise the number."""
    return value.real if value.imag == 0.0 else value


def functionals(interval: Map, weight: Weight, n: int) -> tuple[Array, Array]:
    """∫ φ dx and ∫ φ x dx as functionals of the coefficients, (2, n)."""
    total = np.zeros(n, dtype=weight.kind)
    total[0] = 1.0 / jacobi.recurrence(weight, 1).first
    if isinstance(interval, Affine):
        moment = interval.x1 * total
        moment[:2] += interval.r * np.array(jacobi.first_moment(weight))
        return total, moment
    sigma, quadrature = jacobi.analysis(weight, n)
    x, _, _, _, rest = positions(interval, 1.0 - sigma, 1.0 + sigma)
    return total if interval.is_even else rest @ quadrature, (x * rest) @ quadrature


def condition_rows(problem: Problem, functionals: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """The conditions as rows for all coefficients, each of norm 1, and their values."""
    widths = [len(of[0]) for of in functionals]
    rows = []
    for condition in problem.conditions:
        parts = [
            of[condition.power] * (i in condition.intervals) for i, of in enumerate(functionals)
        ]
        rows.append(np.concatenate(parts))
    if not rows:
        return np.zeros((0, sum(widths))), np.zeros(0)
    matrix = np.stack(rows)
    scale = np.linalg.norm(matrix, axis=1)
    return matrix / scale[:, None], np.array(
        [real_if_real(complex(c.value)) for c in problem.conditions]
    ) / scale


def positions(interval: Map, right: Array, left: Array) -> tuple[Array, Array, Array, Array, Array]:
    """(x from the nearer end, x2 - x, x - x1, the density's factor ρ, dx/ds / ρ)."""
    to_right, to_left, rho, rest = interval.distances(right, left)
    return (
        np.where(to_left < to_right, interval.x1 + to_left, interval.x2 - to_right),
        to_right,
        to_left,
        rho,
        rest,
    )


def moved(c: Array, index: int) -> Array:
    """The coefficients of p̃_{n-κ}."""
    return c[index:] if index >= 0 else np.concatenate((np.zeros(-index, dtype=c.dtype), c))


# -- functions sampled -----------------------------------------------------------------------------


def sample(name: str, function: Function, x: Array) -> Array:
    """function(x), refused unless it is finite and of x's shape (or one number)."""
    with np.errstate(all="ignore"):
        values = np.asarray(
            arguments.of_arrays(name, function, x) if callable(function) else function
        )
    if values.shape not in ((), x.shape):
        raise ValueError(
            f"{name} returned shape {values.shape} for x of shape {x.shape}: return one value for "
            "each x"
        )
    values = np.broadcast_to(_numeric(name, values), x.shape)
    bad = ~np.isfinite(values)
    if bad.any():
        raise ValueError(
            f"{name} returned {values[bad][0]} at x = {x[bad][0]:.6g}: it must be finite inside "
            "the intervals"
        )
    return values


def sample_kernel(k: Kernel, x: Array, t: Array) -> Array:
    """k at all x (rows) and t (columns), in one call.

    Refused unless it is finite and of that shape (or one number).
    """
    shape = (len(x), len(t))
    with np.errstate(all="ignore"):
        values = np.asarray(
            arguments.of_arrays(
                "k", k, np.broadcast_to(x[:, None], shape), np.broadcast_to(t, shape)
            )
        )
    if values.shape not in ((), shape):
        raise ValueError(
            f"k returned shape {values.shape} for x and t of shape {shape}: return one value for "
            "each pair"
        )
    values = np.broadcast_to(_numeric("k", values), shape)
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        i, j = bad[0]
        raise ValueError(
            f"k returned {values[i, j]} at x = {x[i]:.6g}, t = {t[j]:.6g}: a regular kernel is "
            "finite"
        )
    return values


def _numeric(name: str, values: Array) -> Array:
    if values.dtype.kind not in "biufc":
        raise ValueError(f"{name} returned values of type {values.dtype}: return numbers")
    return values if values.dtype.kind == "c" else values.astype(float)


def solved(matrix: Array, rhs: Array) -> Array:
    """The solution of a linear system. ContactError if the system is singular."""
    try:
        found = np.linalg.solve(matrix, rhs)
    except np.linalg.LinAlgError:
        found = np.full(len(rhs), np.inf)
    largest = positive(np.abs(rhs).max(initial=0.0))  # whose square may be no number
    if not np.linalg.norm(found / largest) <= SINGULAR * np.linalg.norm(rhs / largest):
        raise ContactError(
            "the equation is singular: its homogeneous form has a solution that the side "
            "conditions do not fix; give conditions that are independent, for each interval one "
            "where both ends are singular"
        )
    return found


def right_hand_side(
    problem: Problem, multiples: Array, sampled: Array, values: Array
) -> tuple[Array, bool]:
    """g + Σ d_j u_j from samples of g and u_j, and whether φ = 0 is the solution.

    It is where the free functions take g away, but for rounding, and all conditions ask for 0.
    """
    out = multiples @ sampled
    rounding = NEGLIGIBLE * (np.abs(multiples) @ np.abs(sampled)).max()
    free = len(multiples) == 1 + len(problem.free)  # and no constant that g should not need
    vanishes = free and bool(np.abs(out).max() <= rounding) and not values.any()
    return (np.zeros_like(out) if vanishes else out), vanishes


def positive(*scales: Any) -> float:
    """The largest of these, 1 where all vanish."""
    scale = float(max(scales))
    return scale if scale > 0.0 else 1.0
