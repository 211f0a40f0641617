"""Gauss-Chebyshev and Gauss-Jacobi collocation for Cauchy singular integral equations.

    a φ(x) + b/π PV∫ φ(t)/(t - x) dt + ∫ k(x, t) φ(t) dt = g(x) + Σ d_j u_j(x),       with side conditions  ∫ φ x^power dx = value

On [-1, 1] the density is sought as φ = w Σ c_n p_n, w = (1-s)^α (1+s)^β with the exponents that a and b ask for and p_n orthonormal for w.
The singular part maps p_n to one constant times p̃_{n-κ}, orthonormal for 1/w (`jacobi`), κ = -(α + β) the index. So the matrix for c is
the identity, moved by κ places, plus the coefficients of what is smooth; side conditions fill the places that κ = 1 leaves open, and
free constants u_j answer the equation too many that κ = -1 brings.

Without k on one interval nothing is solved: c is a transform of g, for a = 0 a DCT. Otherwise the matrix is square, and about as well
conditioned as the identity plus k; LAPACK factorises it while it is small, and above DENSE unknowns GMRES solves it in steps of n²
operations whose number does not grow with n. Several intervals are coupled by their Cauchy kernels, which are smooth there; close
ones are graded towards each other (`grading`).

Sources: Erdogan & Gupta, Q. Appl. Math. 29 (1972); Erdogan, Gupta & Cook (1973); Elliott, SIAM J. Numer. Anal. 19 (1982), for the weighted
spaces in which the condition number stays bounded; Hackbusch & Sauter for equations of the second kind under GMRES.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import chebyshev, jacobi
from .errors import ContactError
from .grading import Affine, Map
from .interval import EPS
from .jacobi import Weight
from .jacobi_density import JacobiDensity, Part

Array = NDArray[Any]
Function = Callable[[Array], Any] | complex
Kernel = Callable[[Array, Array], Any]

# Nodes of the first attempt: on one interval, on each of several, and on graded ones.
SMALLEST, SMALLEST_OF_SEVERAL, SMALLEST_GRADED = 4, 8, 32
ENLARGED = 1.45  # from one attempt to the next: what is spent is not twice what is needed
LARGEST, LARGEST_TRANSFORM = 6000, 200_000  # unknowns with which a system, and a transform, gives up
TAIL = 2  # the last coefficients that must have decayed ...
DECAYED = 0.1  # ... to this part of the tolerance, relative to the largest
IDLE, SETTLED = 3, 1e-6  # after so many enlargements without progress an error below this is noise of g or k
# Points on no grid, where the equation's residual is measured.
PROBES = np.array([-0.967, -0.871, -0.537, 0.071, 0.467, 0.859, 0.973])
ROUNDING = 4.0 * EPS  # of the largest term of the equation: coefficients below it have decayed
# Unknowns up to which LAPACK's n³ costs less than GMRES.
DENSE = 1200
KRYLOV = 120
# A right-hand side that misses its consistency by more than this fraction is refused.
INCONSISTENT = 1e-9
# A solution so many times larger than its right-hand side belongs to a matrix that is singular to rounding.
SINGULAR = 1e10
# Of a kernel's coefficients in t: the first and the last ones are looked at, and below this they are rounding.
_FIRST, _LAST = slice(0, TAIL), slice(-TAIL, None)
NEGLIGIBLE = 64.0 * EPS


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
        """(name, function) of g and of everything whose multiple is unknown, last the constants by which g may miss its consistency."""
        excess = max(-sum(weight.kappa for weight in self.weights) - len(self.free), 0)
        bounded = [m for m, weight in zip(self.maps, self.weights, strict=True) if weight.kappa == -1]
        named = [("g", self.g), *((f"free[{j}]", f) for j, f in enumerate(self.free))]
        return named + [("constant", partial(_indicator, m.x1, m.x2)) for m in bounded[:excess]]


def _indicator(x1: float, x2: float, x: Array) -> Array:
    return np.where((x >= x1) & (x <= x2), 1.0, 0.0)


class Attempt(NamedTuple):
    """A density; by intervals how far its coefficients decayed, residual (and what it is blind to) and rounding; the constant that g
    lacks: all relative."""

    density: JacobiDensity
    tails: Array
    residuals: Array
    rounding: Array
    defect: float

    def unresolved(self, tol: float) -> NDArray[np.bool_]:
        unresolved: NDArray[np.bool_] = (self.tails > np.maximum(DECAYED * tol, self.rounding)) | (self.residuals > tol)
        return unresolved


def solve(problem: Problem, tol: float) -> JacobiDensity:
    """The density with as many nodes as tol asks for. Raises ContactError with the best `density` if it does not settle."""
    sizes, idle = problem.first_sizes(), 0
    best: JacobiDensity | None = None
    while True:
        tried = attempt(problem, sizes)
        more = tried.unresolved(tol)
        if not more.any():
            return consistent(tried)
        if best is None or tried.density.error < 0.5 * best.error:
            best, idle = tried.density, 0
        else:
            idle += 1
        sizes = tuple(int(np.ceil(ENLARGED * n)) if grows else n for n, grows in zip(sizes, more, strict=True))
        if sum(sizes) > (LARGEST_TRANSFORM if problem.is_transform else LARGEST) or (idle >= IDLE and best.error < SETTLED):
            raise ContactError(
                f"the density did not settle to tol = {tol:.1e}: with n = {best.n} nodes its estimated error is {best.error:.1e}; "
                "g or k is noisy or not smooth: raise tol, or end the intervals where it is not smooth",
                density=best,
            )


def consistent(found: Attempt) -> JacobiDensity:
    if found.defect > INCONSISTENT:
        raise ContactError(
            f"the right-hand side is not consistent: bounded ends ask for an integral of g that vanishes, and it misses a constant of "
            f"{found.defect:.1e} times g; free a constant, or let an end be singular",
            density=found.density,
        )
    return found.density


def attempt(problem: Problem, sizes: tuple[int, ...]) -> Attempt:
    """The density with so many nodes on each interval."""
    if problem.is_transform:
        return _by_transform(problem, sizes[0])
    system = System(problem, sizes)
    return system.attempt(system.solution())


# -- one interval, no kernel: a transform -------------------------------------------------------------------------------


def _by_transform(problem: Problem, n: int) -> Attempt:
    (interval,), (weight,) = problem.maps, problem.weights
    m, constant, kappa = n - weight.kappa, _constant(problem, weight), weight.kappa
    s, analysed = _transform(weight.inverse, m)
    at = np.concatenate((s, PROBES))
    x, _, _, stretch = _positions(interval, 1.0 - at, 1.0 + at)
    sampled = np.stack([sample(name, f, x) for name, f in problem.functions]) * stretch
    second = analysed(sampled[:, :m]) / constant  # the coefficients of p̃ ...
    c = np.zeros((len(second), n), dtype=second.dtype)
    c[:, max(kappa, 0) :] = second[:, max(-kappa, 0) :]  # ... are those of p, moved
    rows, values = _rows(problem, [_functionals(interval, weight, n)])
    found, unknown = _closed(c, second[:, : max(-kappa, 0)], rows, values, kappa)
    multiples = np.concatenate(([1.0], unknown))
    wanted = multiples @ sampled
    left_over = constant * jacobi.evaluate(weight.inverse, multiples @ second, PROBES) - wanted[m:]
    return _attempted(problem, [found], unknown, [Terms(n, left_over, wanted, sampled[0], 0.0)])


def _closed(c: Array, defects: Array, rows: Array, values: Array, kappa: int) -> tuple[Array, Array]:
    """The combination of the particular solutions c, g's first, and of the homogeneous one if κ = 1, that meets all conditions."""
    functions = len(c)
    if kappa == 1:
        c = np.concatenate((c, np.eye(1, c.shape[1], dtype=c.dtype)))
        defects = np.zeros((len(c), 0))
    if len(c) == 1:
        return c[0], np.zeros(0)
    matrix = np.concatenate((rows @ c.T, defects.T))
    wanted = np.concatenate((values, np.zeros(defects.shape[1])))
    unknown = _solved(matrix[:, 1:], wanted - matrix[:, 0])
    return c[0] + unknown @ c[1:], unknown[: functions - 1]


def _transform(weight: Weight, n: int) -> tuple[Array, Callable[[Array], Array]]:
    """Nodes, and the map from values there to the coefficients of p_0 ... p_{n-1}: a DCT for the Chebyshev weights."""
    if not {weight.alpha, weight.beta} <= {-0.5, 0.5}:
        s, A = jacobi.analysis(weight, n)
        return s, lambda values: values @ A
    kind = _KINDS[float(weight.alpha.real), float(weight.beta.real)]

    def by_dct(values: Array) -> Array:
        if np.iscomplexobj(values):
            return by_dct(values.real) + 1j * by_dct(values.imag)
        return kind(np.concatenate((chebyshev.transform(values), np.zeros((len(values), 2))), axis=-1))

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


# From Chebyshev coefficients (padded by two zeros) to those of the orthonormal polynomials of (1 - s)^α (1 + s)^β.
_KINDS = {(-0.5, -0.5): _first_kind, (0.5, 0.5): _second_kind, (-0.5, 0.5): _third_kind, (0.5, -0.5): _fourth_kind}


# -- kernels and several intervals: a system ----------------------------------------------------------------------------


class _Block(NamedTuple):
    """One interval of a system: where its rows are sampled (its probes last), and where its integrals are."""

    x: Array
    rows: tuple[Array, Array, Array]  # x2 - x, x - x1, dx/ds
    right: Array
    left: Array
    t: Array
    columns: tuple[Array, Array]  # x2 - t, t - x1
    sigma: Array
    analysis: Array  # values at the rows -> coefficients of p̃, over the constant of the singular part
    quadrature: Array  # coefficients c -> weights times values at the columns
    kappa: int


class System:
    """The equations for all coefficients c and free constants d, with n_i nodes on interval i.

    Rows in this order: interval by interval its projections on p̃, a condition before them where κ = 1, without the one too many
    where κ = -1; then those that were left out and the conditions that are left, to match the free constants. So the matrix is the
    identity plus what is smooth, but for that border.
    """

    def __init__(self, problem: Problem, sizes: tuple[int, ...]) -> None:
        self.problem, self.sizes = problem, sizes
        self.blocks = [_block(problem, i, n) for i, n in enumerate(sizes)]
        self.kernel = self._kernel()
        sampled = [sample(name, f, np.concatenate([b.x for b in self.blocks])) for name, f in problem.functions]
        stretch = np.concatenate([b.rows[2] for b in self.blocks])
        self.sampled = np.stack(sampled) * stretch
        functionals = [_functionals(*parts) for parts in zip(problem.maps, problem.weights, sizes, strict=True)]
        self.conditions, self.values = _rows(problem, functionals)

    def _kernel(self) -> Array:
        """What is smooth, rows by columns, times dx/ds of the row."""
        x, t = np.concatenate([b.x for b in self.blocks]), np.concatenate([b.t for b in self.blocks])
        stretch = np.concatenate([b.rows[2] for b in self.blocks])[:, None]
        k = self.problem.k
        regular = 0.0 if k is None else sample_kernel(k, x, t) * stretch
        blocks = range(len(self.blocks))
        cauchy = np.concatenate([np.concatenate([self._cauchy(i, j) for j in blocks], axis=1) for i in blocks])
        out: Array = regular + (_real_if_real(self.problem.b) / np.pi) * cauchy
        return out

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
        out: Array = rows.rows[2][:, None] / distance
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
        return np.concatenate([b.analysis.T @ values[rows][: -len(PROBES)] for b, rows in zip(self.blocks, self._row_slices, strict=True)])

    @cached_property
    def order(self) -> NDArray[np.int64]:
        """Which row of (conditions, projections) stands where; see the class."""
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
        """Of the free functions, normalised, and what they were divided by."""
        columns = np.concatenate((np.zeros((len(self.values), len(self.sampled) - 1)), -self._projected(self.sampled[1:].T)))
        scale = np.linalg.norm(columns, axis=0)
        scale[scale == 0.0] = 1.0
        return columns / scale, scale

    @cached_property
    def rhs(self) -> Array:
        return np.concatenate((self.values, self._projected(self.sampled[0])))[self.order]

    def matrix(self) -> Array:
        """The whole matrix."""
        smooth = np.concatenate([self.kernel[:, at] @ b.quadrature for b, at in zip(self.blocks, self._column_slices, strict=True)], axis=1)
        projected = self._projected(smooth)
        start = 0
        for block, at in zip(self.blocks, self._column_slices, strict=True):
            n, m = at.stop - at.start, at.stop - at.start - block.kappa
            projected[start : start + m, at] += np.eye(m, n, k=block.kappa)
            start += m
        coefficients = np.concatenate((self.conditions, projected))
        return np.concatenate((coefficients, self._free_columns[0]), axis=1)[self.order]

    def applied(self, unknown: Array) -> Array:
        """The matrix times a vector, in n² operations."""
        N = sum(self.sizes)
        c, d = unknown[:N], unknown[N:]
        weighted = self._weighted(c)
        projected = self._projected(self.kernel @ weighted)
        moved = [_moved(c[at], b.kappa) for b, at in zip(self.blocks, self._column_slices, strict=True)]
        rows = np.concatenate((self.conditions @ c, projected + np.concatenate(moved)))
        out: Array = (rows + self._free_columns[0] @ d)[self.order]
        return out

    def _weighted(self, c: Array) -> Array:
        return np.concatenate([b.quadrature @ c[at] for b, at in zip(self.blocks, self._column_slices, strict=True)])

    def solution(self) -> Array:
        return _solved(self.matrix(), self.rhs) if len(self.rhs) <= DENSE else self._by_gmres()

    def _aliased(self, c: Array, sizes: Array) -> list[float]:
        """For each interval, what its nodes miss of the integrals over it, relative to the terms' sizes at the rows.

        The residual is blind to it, as it integrates by the same nodes. The coefficients of k(x, ·) tell: n Gauss nodes mistake those
        beyond 2n - m for the m-th; for complex exponents, where nodes are not Gauss's, all beyond n.
        """
        missed = []
        for block, weight, at in zip(self.blocks, self.problem.weights, self._column_slices, strict=True):
            first, last = (np.abs(self.kernel[:, at] @ block.quadrature[:, part]).max(axis=1) / sizes for part in (_FIRST, _LAST))
            tail, largest = float(last.max()), max(float(first.max()), float(last.max()))
            decay = tail / _positive(largest)
            missed.append(float(np.abs(c[at]).max()) * tail * (decay if weight.is_real else float(decay > NEGLIGIBLE)))
        return missed

    def _by_gmres(self) -> Array:
        from scipy.sparse.linalg import LinearOperator, gmres  # noqa: PLC0415 -- heavy, and for the few who need it

        kind = np.result_type(self.kernel, self.rhs, *(b.analysis for b in self.blocks))
        operator = LinearOperator((len(self.rhs),) * 2, matvec=self.applied, dtype=kind)
        found, info = gmres(operator, self.rhs, rtol=4.0 * EPS, restart=KRYLOV, maxiter=3)
        # GMRES stops at rounding of its own recursion; what counts is the residual
        if info and np.linalg.norm(self.applied(found) - self.rhs) > np.sqrt(len(self.rhs)) * 64.0 * EPS * np.linalg.norm(self.rhs):
            raise ContactError(f"GMRES did not converge on {len(self.rhs)} unknowns: the equation is nearly singular or k is not smooth")
        out: Array = found
        return out

    def attempt(self, unknown: Array) -> Attempt:
        N = sum(self.sizes)
        c, d = unknown[:N], unknown[N:] / self._free_columns[1]
        smooth = self.kernel @ self._weighted(c)
        wanted = np.concatenate(([1.0], d)) @ self.sampled
        size = [_positive(np.abs(wanted[rows]).max(), np.abs(smooth[rows]).max()) for rows in self._row_slices]
        aliased = self._aliased(c, np.repeat(size, [len(b.x) for b in self.blocks]))
        terms = []
        for i, (block, rows, at) in enumerate(zip(self.blocks, self._row_slices, self._column_slices, strict=True)):
            weight, probes = self.problem.weights[i], slice(rows.stop - len(PROBES), rows.stop)
            second = _constant(self.problem, weight) * jacobi.evaluate(weight.inverse, _moved(c[at], block.kappa), PROBES)
            left_over = second + smooth[probes] - wanted[probes]
            terms.append(Terms(at.stop - at.start, left_over, wanted[rows], smooth[rows], aliased[i]))
        return _attempted(self.problem, [c[at] for at in self._column_slices], d, terms)


def _block(problem: Problem, i: int, n: int) -> _Block:
    interval, weight = problem.maps[i], problem.weights[i]
    s, analysis = jacobi.analysis(weight.inverse, n - weight.kappa)
    sigma, quadrature = jacobi.analysis(weight, n)
    at = np.concatenate((s, PROBES))
    x, *rows = _positions(interval, 1.0 - at, 1.0 + at)
    t, to_right, to_left, _ = _positions(interval, 1.0 - sigma, 1.0 + sigma)
    analysis = analysis / _constant(problem, weight)
    return _Block(x, (rows[0], rows[1], rows[2]), 1.0 - at, 1.0 + at, t, (to_right, to_left), sigma, analysis, quadrature, weight.kappa)


def _moved(c: Array, index: int) -> Array:
    """The coefficients of p̃_{n-κ}."""
    return c[index:] if index >= 0 else np.concatenate((np.zeros(-index, dtype=c.dtype), c))


# -- common to both -------------------------------------------------------------------------------------------------------


def _constant(problem: Problem, weight: Weight) -> Any:
    """a w p_n + b/π PV∫ w p_n/(t - x) dt = constant p̃_{n-κ}, p̃ as the inverse weight's own recurrence has it."""
    return -_real_if_real(problem.b) / weight.sine * jacobi.second_sign(weight)


def _real_if_real(value: complex) -> Any:
    return value.real if value.imag == 0.0 else value


def _functionals(interval: Map, weight: Weight, n: int) -> tuple[Array, Array]:
    """(2, n): what ∫ φ dx and ∫ φ x dx are of the coefficients."""
    total = np.zeros(n, dtype=weight.kind)
    total[0] = 1.0 / jacobi.recurrence(weight, 1).first
    if isinstance(interval, Affine):
        moment = interval.x1 * total
        moment[:2] += interval.r * np.array(jacobi.first_moment(weight))
        return total, moment
    sigma, quadrature = jacobi.analysis(weight, n)
    return total, _positions(interval, 1.0 - sigma, 1.0 + sigma)[0] @ quadrature


def _rows(problem: Problem, functionals: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """The conditions as rows for all coefficients, each of norm 1, and their values."""
    widths = [len(of[0]) for of in functionals]
    rows = []
    for condition in problem.conditions:
        parts = [of[condition.power] * (i in condition.intervals) for i, of in enumerate(functionals)]
        rows.append(np.concatenate(parts))
    if not rows:
        return np.zeros((0, sum(widths))), np.zeros(0)
    matrix = np.stack(rows)
    scale = np.linalg.norm(matrix, axis=1)
    return matrix / scale[:, None], np.array([_real_if_real(complex(c.value)) for c in problem.conditions]) / scale


def _positions(interval: Map, right: Array, left: Array) -> tuple[Array, Array, Array, Array]:
    """x from the nearer end, x2 - x, x - x1, dx/ds."""
    to_right, to_left, stretch = interval.distances(right, left)
    return np.where(to_left < to_right, interval.x1 + to_left, interval.x2 - to_right), to_right, to_left, stretch


def sample(name: str, function: Function, x: Array) -> Array:
    """function(x), refused unless it is finite and of x's shape (or one number)."""
    with np.errstate(all="ignore"):
        values = np.asarray(function(x) if callable(function) else function)
    if values.shape not in ((), x.shape):
        raise ValueError(f"{name} returned shape {values.shape} for x of shape {x.shape}: return one value for each x")
    values = np.broadcast_to(_numeric(name, values), x.shape)
    bad = ~np.isfinite(values)
    if bad.any():
        raise ValueError(f"{name} returned {values[bad][0]} at x = {x[bad][0]:.6g}: it must be finite inside the intervals")
    return values


def sample_kernel(k: Kernel, x: Array, t: Array) -> Array:
    """k at all x (rows) and t (columns), in one call; refused unless it is finite and of that shape (or one number)."""
    shape = (len(x), len(t))
    with np.errstate(all="ignore"):
        values = np.asarray(k(np.broadcast_to(x[:, None], shape), np.broadcast_to(t, shape)))
    if values.shape not in ((), shape):
        raise ValueError(f"k returned shape {values.shape} for x and t of shape {shape}: return one value for each pair")
    values = np.broadcast_to(_numeric("k", values), shape)
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        i, j = bad[0]
        raise ValueError(f"k returned {values[i, j]} at x = {x[i]:.6g}, t = {t[j]:.6g}: a regular kernel is finite")
    return values


def _numeric(name: str, values: Array) -> Array:
    if values.dtype.kind not in "biufc":
        raise ValueError(f"{name} returned values of type {values.dtype}: return numbers")
    return values if values.dtype.kind == "c" else values.astype(float)


def _solved(matrix: Array, rhs: Array) -> Array:
    try:
        found = np.linalg.solve(matrix, rhs)
    except np.linalg.LinAlgError:
        found = np.full(len(rhs), np.inf)
    if not np.linalg.norm(found) <= SINGULAR * np.linalg.norm(rhs):
        raise ContactError(
            "the equation is singular: its homogeneous form has a solution that the side conditions do not fix; "
            "give conditions that are independent, for each interval one where both ends are singular"
        )
    return found


class Terms(NamedTuple):
    """Of the equation on one interval: its nodes, what is left over at PROBES, and two terms of it everywhere; times dx/ds.
    And what its nodes miss of the integrals over it, relative."""

    n: int
    left_over: Array
    wanted: Array
    other: Array
    aliased: float


def _attempted(problem: Problem, coefficients: list[Array], unknown: Array, terms: list[Terms]) -> Attempt:
    largest = max(float(np.abs(c).max()) for c in coefficients)
    measured = [_measured(problem, i, c, of, largest) for i, (c, of) in enumerate(zip(coefficients, terms, strict=True))]
    parts = tuple(of.part for of in measured)
    residuals, tails = np.array([of.residual for of in measured]), np.array([of.tail for of in measured])
    error = max(float(tails.max()), float(residuals.max()), 2.0 * EPS)
    constants, lacking = unknown[: len(problem.free)], unknown[len(problem.free) :]
    density = JacobiDensity(parts, tuple(constants.tolist()), tuple(of.n for of in terms), error, float(residuals.max()))
    g = max(float(np.abs(of.wanted).max()) for of in terms)
    defect = float(np.abs(lacking).max(initial=0.0)) * max(m.stretch for m in measured) / _positive(g)
    return Attempt(density, tails, residuals, np.array([of.rounding for of in measured]), defect)


class _Measured(NamedTuple):
    part: Part
    tail: float
    residual: float
    rounding: float
    stretch: float


def _measured(problem: Problem, i: int, c: Array, of: Terms, largest: float) -> _Measured:
    """What is kept of one interval's coefficients, and how well they are known.

    Residuals are weighted as in the norm in which the singular operator is an isometry: next to a singular end of 1/w they mean less.
    """
    interval, weight = problem.maps[i], problem.weights[i]
    scale = _positive(np.abs(c).max(), EPS * largest)
    term = _positive(np.abs(of.wanted).max(), np.abs(of.other).max())
    inverse = weight.inverse
    norm = (1.0 - PROBES) ** (0.5 * inverse.alpha.real + 0.25) * (1.0 + PROBES) ** (0.5 * inverse.beta.real + 0.25)
    residual = max(float((np.abs(of.left_over) * norm).max() / (term * norm.max())), of.aliased)
    rounding = ROUNDING * term * abs(inverse.total) ** 0.5 / (abs(_constant(problem, weight)) * scale)
    part = Part(interval, weight, c[: chebyshev.chopped_length(c, 0.25 * EPS * scale)])
    middle = interval.distances(np.ones(1), np.ones(1))[2]
    return _Measured(part, float(np.abs(c[-TAIL:]).max()) / scale, residual, float(rounding), float(middle[0]))


def _positive(*scales: Any) -> float:
    """The largest of these, 1 where all vanish."""
    scale = float(max(scales))
    return scale if scale > 0.0 else 1.0
