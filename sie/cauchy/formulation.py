"""A Cauchy equation prepared for the solver: its functions sampled, and the quality of a solution.

`Problem` is the equation with maps and weights, `Attempt` one solution with its estimated errors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.errors import ContactError
from sie.numerics import chebyshev, jacobi
from sie.numerics.interval import EPS
from sie.numerics.jacobi import Weight

from .density import JacobiDensity, Part
from .interval_map import Affine, Map
from .rounding import Spread

Array = NDArray[Any]
Function = Callable[[Array], Any] | complex
Kernel = Callable[[Array, Array], Any]

# Nodes of the first attempt: on one interval, on each of several, and on graded ones.
SMALLEST, SMALLEST_OF_SEVERAL, SMALLEST_GRADED = 4, 8, 32
TAIL = 2  # the last coefficients that must have decayed ...
DECAYED = 0.1  # ... to this part of the tolerance, relative to the largest
# Points on no grid, where the equation's residual is measured.
PROBES = np.array([-0.967, -0.871, -0.537, 0.071, 0.467, 0.859, 0.973])
ROUNDING = 4.0 * EPS  # of the largest term of the equation: coefficients below it have decayed
SUBNORMAL = (
    64.0 * 5e-324
)  # what numbers below 2e-308, with fewer digits than others, are rounded to
# A solution so many times larger than its right-hand side belongs to a matrix that is singular to
# rounding.
SINGULAR = 1e10


class Condition(NamedTuple):
    """∫ φ x^power dx over these intervals = value."""

    power: int
    intervals: tuple[int, ...]
    value: complex


@dataclass(frozen=True)
class Problem:
    """A well-posed question: `CauchyEquation` builds it."""

    maps: tuple[Map, ...]
    weights: tuple[Weight, ...]
    a: complex
    b: complex
    g: Function
    k: Kernel | None
    conditions: tuple[Condition, ...]
    free: tuple[Function, ...]

    @property
    def is_transform(self) -> bool:
        return self.k is None and len(self.maps) == 1

    def first_sizes(self) -> tuple[int, ...]:
        on_affine = SMALLEST if len(self.maps) == 1 else SMALLEST_OF_SEVERAL
        return tuple(on_affine if isinstance(m, Affine) else SMALLEST_GRADED for m in self.maps)

    @property
    def functions(self) -> list[tuple[str, Function]]:
        """(name, function) of g and of everything whose multiple is unknown, last the constants by
        which g may miss its consistency.
        """
        excess = max(-sum(weight.kappa for weight in self.weights) - len(self.free), 0)
        bounded = [
            m for m, weight in zip(self.maps, self.weights, strict=True) if weight.kappa == -1
        ]
        named = [("g", self.g), *((f"free[{j}]", f) for j, f in enumerate(self.free))]
        return named + [("constant", partial(_indicator, m.x1, m.x2)) for m in bounded[:excess]]


def _indicator(x1: float, x2: float, x: Array) -> Array:
    return np.where((x >= x1) & (x <= x2), 1.0, 0.0)


# -- what the equation is made of ------------------------------------------------------------------


def constant_of(problem: Problem, weight: Weight) -> Any:
    """a w p_n + b/π PV∫ w p_n/(t - x) dt = constant p̃_{n-κ}, p̃ as the inverse weight's own
    recurrence has it.
    """
    return -real_if_real(problem.b) / weight.sine * jacobi.second_sign(weight)


def real_if_real(value: complex) -> Any:
    return value.real if value.imag == 0.0 else value


def functionals(interval: Map, weight: Weight, n: int) -> tuple[Array, Array]:
    """(2, n): what ∫ φ dx and ∫ φ x dx are of the coefficients."""
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
    """x from the nearer end, x2 - x, x - x1, the density's factor ρ, dx/ds / ρ."""
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
    """k at all x (rows) and t (columns), in one call; refused unless it is finite and of that shape
    (or one number).
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
    try:
        found = np.linalg.solve(matrix, rhs)
    except np.linalg.LinAlgError:
        found = np.full(len(rhs), np.inf)
    if not np.linalg.norm(found) <= SINGULAR * np.linalg.norm(rhs):
        raise ContactError(
            "the equation is singular: its homogeneous form has a solution that the side "
            "conditions do not fix; "
            "give conditions that are independent, for each interval one where both ends are "
            "singular"
        )
    return found


# -- how good an attempt is ------------------------------------------------------------------------


class Attempt(NamedTuple):
    """A density; by intervals how far its coefficients decayed, residual (and what it is blind to),
    below what both are rounding; the constant that g lacks: all relative. And what rounding makes
    of each interval, where that takes another solution."""

    density: JacobiDensity
    tails: Array
    residuals: Array
    rounding: Array
    noise: Array
    defect: float
    spreads: Callable[[], list[Spread]] = list

    @property
    def progress(self) -> float:
        """What more nodes may lessen: the error but for rounding."""
        return max(float(self.tails.max()), float(self.residuals.max()))

    def unresolved(self, tol: float) -> NDArray[np.bool_]:
        tails, residuals = (
            self.tails > np.maximum(DECAYED * tol, self.rounding),
            self.residuals > np.maximum(tol, self.noise),
        )
        unresolved: NDArray[np.bool_] = tails | residuals
        return unresolved

    def answer(self) -> JacobiDensity:
        """The density, its errors with those of rounding."""
        spreads = self.spreads()
        if not spreads:
            return self.density
        parts = tuple(
            part.less_certain(of.coefficients)
            for part, of in zip(self.density.parts, spreads, strict=True)
        )
        return replace(
            self.density,
            parts=parts,
            error=max(self.density.error, *(of.relative for of in spreads)),
        )


class Terms(NamedTuple):
    """Of the equation on one interval: its nodes, what is left over at PROBES, and two terms of it
    everywhere; times dx/ds. And what its nodes miss of the integrals over it, relative; and how far
    the terms may be off because positions are rounded."""

    n: int
    left_over: Array
    wanted: Array
    other: Array
    aliased: float
    unsure: float


def attempted(
    problem: Problem,
    coefficients: list[Array],
    unknown: Array,
    terms: list[Terms],
    spreads: Callable[[], list[Spread]] = list,
) -> Attempt:
    largest = max(float(np.abs(c).max()) for c in coefficients)
    measured = [
        _measured(problem, i, c, of, largest)
        for i, (c, of) in enumerate(zip(coefficients, terms, strict=True))
    ]
    parts = tuple(of.part for of in measured)
    residuals, tails = (
        np.array([of.residual for of in measured]),
        np.array([of.tail for of in measured]),
    )
    error = max(float(tails.max()), float(residuals.max()), 2.0 * EPS)
    constants, lacking = unknown[: len(problem.free)], unknown[len(problem.free) :]
    density = JacobiDensity(
        parts, tuple(constants.tolist()), tuple(of.n for of in terms), error, float(residuals.max())
    )
    g = max(float(np.abs(of.wanted).max()) for of in terms)
    defect = (
        float(np.abs(lacking).max(initial=0.0)) * max(m.stretch for m in measured) / positive(g)
    )
    rounding, noise = (
        np.array([of.rounding for of in measured]),
        np.array([of.noise for of in measured]),
    )
    return Attempt(density, tails, residuals, rounding, noise, defect, spreads)


class _Measured(NamedTuple):
    part: Part
    tail: float
    residual: float
    rounding: float
    noise: float
    stretch: float


def _measured(problem: Problem, i: int, c: Array, of: Terms, largest: float) -> _Measured:
    """What is kept of one interval's coefficients, and how well they are known.

    Residuals are weighted as in the norm in which the singular operator is an isometry: next to a
    singular end of 1/w they mean less.
    """
    interval, weight = problem.maps[i], problem.weights[i]
    scale = positive(np.abs(c).max(), EPS * largest)
    term = positive(np.abs(of.wanted).max(), np.abs(of.other).max())
    inverse = weight.inverse
    norm = (1.0 - PROBES) ** (0.5 * inverse.alpha.real + 0.25) * (1.0 + PROBES) ** (
        0.5 * inverse.beta.real + 0.25
    )
    residual = max(float((np.abs(of.left_over) * norm).max() / (term * norm.max())), of.aliased)
    rough = max(ROUNDING * term, of.unsure, SUBNORMAL)
    rounding = rough * abs(inverse.total) ** 0.5 / (abs(constant_of(problem, weight)) * scale)
    tail, kept = (
        float(np.abs(c[-TAIL:]).max()) / scale,
        chebyshev.chopped_length(c, 0.25 * EPS * scale),
    )
    part = Part(
        interval,
        weight,
        c[:kept],
        np.full(kept, max(tail, residual, 2.0 * EPS) * scale / len(c) ** 0.5),
    )
    middle = interval.distances(np.ones(1), np.ones(1))[2]
    return _Measured(part, tail, residual, float(rounding), rough / term, float(middle[0]))


def positive(*scales: Any) -> float:
    """The largest of these, 1 where all vanish."""
    scale = float(max(scales))
    return scale if scale > 0.0 else 1.0
