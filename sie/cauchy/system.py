"""Kernels and several intervals: a square system, the identity plus a smooth part.

Several intervals are coupled by their Cauchy kernels, which are smooth there; close ones are graded
towards each other (`interval_map`).
"""

from __future__ import annotations

from functools import cached_property, partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import jacobi
from sie.numerics.interval import EPS

from .attempt import TAIL, Attempt, Terms, attempted
from .formulation import (
    NEGLIGIBLE,
    PROBES,
    Problem,
    condition_rows,
    constant_of,
    functionals,
    moved,
    positions,
    positive,
    real_if_real,
    right_hand_side,
    sample,
    sample_kernel,
    solved,
)  # fmt: skip
from .rounding import Spread, signs, spread, unsure

Array = NDArray[Any]

# The first and the last of a kernel's coefficients in t are examined.
_FIRST, _LAST = slice(0, TAIL), slice(-TAIL, None)


class _Block(NamedTuple):
    """One interval of a system: the points of its rows (its probes last) and of its integrals."""

    x: Array
    rows: tuple[Array, Array, Array]  # x2 - x, x - x1, ρ
    right: Array
    left: Array
    t: Array
    columns: tuple[Array, Array, Array]  # x2 - t, t - x1, dt/dσ / ρ
    sigma: Array
    # values at the rows -> coefficients of p̃, over the constant of the singular part
    analysis: Array
    quadrature: Array  # coefficients c -> weights times values at the columns
    kappa: int


class System:
    """The equations for all coefficients c and free constants d, with n_i nodes on interval i.

    The rows are, interval by interval, the projections on p̃, with a condition before them where κ
    = 1 and without the first one where κ = -1. The projections that were left out and the remaining
    conditions follow, one for each free constant. So the matrix is the identity plus a smooth part,
    but for that border. The kernel is called once.
    """

    def __init__(self, problem: Problem, sizes: tuple[int, ...]) -> None:
        self.problem, self.sizes = problem, sizes
        self.blocks = [_block(problem, i, n) for i, n in enumerate(sizes)]
        self.regular, self.kernel = self._kernel()
        sampled = [
            sample(name, f, np.concatenate([b.x for b in self.blocks]))
            for name, f in problem.functions
        ]
        self.sampled = np.stack(sampled) * np.concatenate([b.rows[2] for b in self.blocks])
        of = [
            functionals(*parts) for parts in zip(problem.maps, problem.weights, sizes, strict=True)
        ]
        self.conditions, self.values = condition_rows(problem, of)

    def _kernel(self) -> tuple[Array | None, Array]:
        """k and all smooth parts, rows by columns, times ρ of the row, over ρ of the column."""
        x = np.concatenate([b.x for b in self.blocks])
        t = np.concatenate([b.t for b in self.blocks])
        rho = np.concatenate([b.rows[2] for b in self.blocks])[:, None]
        rest = np.concatenate([b.columns[2] for b in self.blocks])
        k = self.problem.k
        regular = None if k is None else sample_kernel(k, x, t) * rho * rest
        blocks = range(len(self.blocks))
        cauchy = np.concatenate(
            [np.concatenate([self._cauchy(i, j) for j in blocks], axis=1) for i in blocks]
        )
        out: Array = (real_if_real(self.problem.b) / np.pi) * cauchy
        return regular, out if regular is None else regular + out

    def _cauchy(self, i: int, j: int) -> Array:
        rows, columns = self.blocks[i], self.blocks[j]
        if i == j:
            smooth = self.problem.maps[i].smooth(columns.sigma, rows.right, rows.left)
            return np.zeros((len(rows.x), len(columns.t))) if smooth is None else smooth
        # t - x as a sum of positive distances: in a narrow gap t and x agree to many digits
        maps = self.problem.maps
        if j > i:
            distance = (maps[j].x1 - maps[i].x2) + rows.rows[0][:, None] + columns.columns[1]
        else:
            distance = -((maps[i].x1 - maps[j].x2) + rows.rows[1][:, None] + columns.columns[0])
        out: Array = rows.rows[2][:, None] * columns.columns[2] / distance
        return out

    @cached_property
    def _row_slices(self) -> list[slice]:
        ends = np.cumsum([0, *(len(b.x) for b in self.blocks)]).tolist()
        return [slice(i, j) for i, j in pairwise(ends)]

    @cached_property
    def _column_slices(self) -> list[slice]:
        ends = np.cumsum([0, *self.sizes]).tolist()
        return [slice(i, j) for i, j in pairwise(ends)]

    def _projected(self, values: Array) -> Array:
        """Rows sampled (first axis) -> coefficients of p̃, interval by interval."""
        return np.concatenate(
            [
                b.analysis.T @ values[rows][: -len(PROBES)]
                for b, rows in zip(self.blocks, self._row_slices, strict=True)
            ]
        )

    @cached_property
    def order(self) -> NDArray[np.int64]:
        """The order of the rows of (conditions, projections); see the class."""
        at, start, condition, late = [], len(self.values), 0, []
        for block, n in zip(self.blocks, self.sizes, strict=True):
            m = n - block.kappa
            own = list(range(start, start + m))
            if block.kappa == 1 and condition < len(self.values):
                own = [condition, *own]
                condition += 1
            elif block.kappa == -1:
                late.append(own[0])
                own = own[1:]
            at += own
            start += m
        return np.array(at + late + list(range(condition, len(self.values))))

    @cached_property
    def _free_columns(self) -> tuple[Array, Array]:
        """The columns of the free functions, normalised, and their divisors."""
        columns = np.concatenate(
            (
                np.zeros((len(self.values), len(self.sampled) - 1)),
                -self._projected(self.sampled[1:].T),
            )
        )
        scale = np.linalg.norm(columns, axis=0)
        scale[scale == 0.0] = 1.0
        return columns / scale, scale

    @cached_property
    def rhs(self) -> Array:
        """The right-hand side, in the order of the rows."""
        return np.concatenate((self.values, self._projected(self.sampled[0])))[self.order]

    @cached_property
    def matrix(self) -> Array:
        """The whole matrix."""
        smooth = np.concatenate(
            [
                self.kernel[:, at] @ b.quadrature
                for b, at in zip(self.blocks, self._column_slices, strict=True)
            ],
            axis=1,
        )
        projected = self._projected(smooth)
        start = 0
        for block, at in zip(self.blocks, self._column_slices, strict=True):
            n, m = at.stop - at.start, at.stop - at.start - block.kappa
            projected[start : start + m, at] += np.eye(m, n, k=block.kappa)
            start += m
        coefficients = np.concatenate((self.conditions, projected))
        return np.concatenate((coefficients, self._free_columns[0]), axis=1)[self.order]

    def _weighted(self, c: Array) -> Array:
        return np.concatenate(
            [b.quadrature @ c[at] for b, at in zip(self.blocks, self._column_slices, strict=True)]
        )

    def of_values(self) -> tuple[Array, Array]:
        """(x, R): the unknowns are R times the values of g at x, where all conditions are 0."""
        (block,) = self.blocks
        rows = slice(0, len(block.x) - len(PROBES))
        right = np.concatenate(
            (
                np.zeros((len(self.values), rows.stop)),
                block.analysis.T * block.rows[2][rows],
            )
        )
        return block.x[rows], solved(self.matrix, right[self.order])

    def solution(self) -> Array:
        """The unknowns."""
        return solved(self.matrix, self.rhs)

    def _aliased(self, c: Array, sizes: Array) -> list[float]:
        """The quadrature error of the integrals over each interval, over the terms at the rows.

        The residual does not show it, because it is integrated by the same nodes. The coefficients
        of k(x, ·) do: n Gauss nodes add those beyond 2n - m to the m-th. For complex exponents the
        nodes are not Gauss's, and all beyond n are in error.
        """
        missed = []
        for block, weight, at in zip(
            self.blocks, self.problem.weights, self._column_slices, strict=True
        ):
            of_row = float(np.abs(c[at]).max()) / sizes
            first, last = (
                np.abs(self.kernel[:, at] @ block.quadrature[:, part]).max(axis=1) * of_row
                for part in (_FIRST, _LAST)
            )
            tail, largest = float(last.max()), max(float(first.max()), float(last.max()))
            decay = tail / positive(largest)
            missed.append(tail * (decay if weight.is_real else float(decay > NEGLIGIBLE)))
        return missed

    def _spreads(self, c: Array, sizes: Array) -> list[Spread]:
        """The effect of rounding on each interval, by the sizes of the terms rounded at the rows.

        Near an eigenvalue of the equation, and next to narrow gaps, the residual does not show it.
        """
        rounded = signs(len(sizes) + len(self.rhs))
        at_rows, at_sums = rounded[: len(sizes)], rounded[len(sizes) :]
        terms = np.concatenate(
            (
                self.values[:, None] * at_sums[: len(self.values)],
                self._projected(sizes[:, None] * at_rows),
            )
        )[self.order]
        sums = np.abs(self.matrix[:, : len(c)]) @ np.abs(c)
        # Near an eigenvalue the identity and the smooth part cancel; both were rounded before
        sums[: len(c)] += np.abs(c)
        off = solved(self.matrix, terms + sums[:, None] * at_sums)
        of_interval = zip(
            self.problem.maps, self.problem.weights, self.blocks, self._column_slices, strict=True
        )
        return [
            spread(m, weight, (block.sigma, block.quadrature), c[at], off[at])
            for m, weight, block, at in of_interval
        ]

    def attempt(self, unknown: Array) -> Attempt:
        """The density of these unknowns, with its residuals, tails and rounding."""
        N = sum(self.sizes)
        c, d = unknown[:N], unknown[N:] / self._free_columns[1]
        multiples = np.concatenate(([1.0], d))
        wanted, vanishes = right_hand_side(self.problem, multiples, self.sampled, self.values)
        if vanishes:
            c = np.zeros_like(c)
        smooth = self.kernel @ self._weighted(c)
        size = [
            positive(np.abs(wanted[rows]).max(), np.abs(smooth[rows]).max())
            for rows in self._row_slices
        ]
        aliased = self._aliased(c, np.repeat(size, [len(b.x) for b in self.blocks]))
        varying = wanted if self.regular is None else wanted - self.regular @ self._weighted(c)
        off = [
            unsure(b.x, varying[at] / b.rows[2], b.rows[2])
            for b, at in zip(self.blocks, self._row_slices, strict=True)
        ]
        rounded = np.maximum(np.abs(wanted), np.abs(smooth)) + np.concatenate(off) / EPS
        terms = []
        for i, (block, rows, at) in enumerate(
            zip(self.blocks, self._row_slices, self._column_slices, strict=True)
        ):
            weight, probes = self.problem.weights[i], slice(rows.stop - len(PROBES), rows.stop)
            second = constant_of(self.problem, weight) * jacobi.evaluate(
                weight.inverse, moved(c[at], block.kappa), PROBES
            )
            left_over = second + smooth[probes] - wanted[probes]
            sizes = wanted[rows], smooth[rows], aliased[i], float(off[i].max())
            terms.append(Terms(at.stop - at.start, left_over, *sizes))
        return attempted(
            self.problem,
            [c[at] for at in self._column_slices],
            d,
            terms,
            partial(self._spreads, c, rounded),
        )


def _block(problem: Problem, i: int, n: int) -> _Block:
    interval, weight = problem.maps[i], problem.weights[i]
    s, analysis = jacobi.analysis(weight.inverse, n - weight.kappa)
    sigma, quadrature = jacobi.analysis(weight, n)
    at = np.concatenate((s, PROBES))
    x, *rows = positions(interval, 1.0 - at, 1.0 + at)
    t, to_right, to_left, _, rest = positions(interval, 1.0 - sigma, 1.0 + sigma)
    analysis = analysis / constant_of(problem, weight)
    return _Block(
        x,
        (rows[0], rows[1], rows[2]),
        1.0 - at,
        1.0 + at,
        t,
        (to_right, to_left, rest),
        sigma,
        analysis,
        quadrature,
        weight.kappa,
    )
