"""Cubic splines through a trace, and the smoothing spline of a noisy one.

The smoothing spline minimises, over all functions f on the trace's interval (Reinsch 1967, SciPy's
`make_smoothing_spline`),

    Σ_i (h_i - f(x_i))² + λ ∫ f''² dx,          λ in units of length³

It is a natural cubic spline with a knot at every point, and averages over a length of about (λ
Δ)^(1/4), Δ the mean spacing. With thousands of points within that length a knot at every point
loses digits (the condition number is the fourth power of that number) and gains nothing. Then
KNOTS_IN_LENGTH knots in each such length are used, at points of the trace, and all points count (as
in R's `smooth.spline`).

With few points in that length (few enough for a knot at each) the second derivatives γ at the
points are solved for, and f follows (Reinsch's own form; Green & Silverman 1994, § 2.3): B-splines
would lose f between the points as λ → 0.

    (R + λ Q'Q) γ = Q'h,       f = h - λ Q γ,       Q'h second differences, R their mass matrix

λ is chosen by generalised cross validation (Craven & Wahba 1979): the smallest n Σ(h_i - f(x_i))² /
(n - tr A)², A the matrix from h to f(x). Its trace is exact for a short trace; for a long one it is
z·Az, the mean over a few fixed vectors of signs z (Girard 1989).

The effect of noise on the spline: if h = f + noise, independent from point to point and of variance
s², then f given h has the mean of the smoothing spline, and its coefficients have the covariance s²
(B'B + λE)^-1 (Wahba 1983). On the average over x this includes the bias that smoothing causes
(Nychka 1988).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS, two_product, two_sum

from .slope import Slope

Array = NDArray[np.float64]
INF = float("inf")

ALL_KNOTS = 1000  # up to so many points each is a knot
FEWEST_KNOTS = 250
# a spline on these differs from that on all points by 1e-5 of what smoothing changes
KNOTS_IN_LENGTH = 10.0
SHORT = KNOTS_IN_LENGTH**4  # λ over the cube of the mean spacing: up to so many points are averaged
EXACT_TRACE = 400
PROBES = 16
STEPS = 25  # of the first scan of the score, from a third of the spacing to the length of the trace
LONGEST = 4.0  # times the length of the trace: beyond it, averaging leaves a straight line
LOCAL = 50  # points whose misfit measures the noise
REFINED = 0.02  # of the logarithm of the averaging length
FADED = 52.0  # averaging lengths beyond which a point counts exp(-52/√2) = 1e-16
FORGOTTEN = 60  # points: of what is that far away a spline keeps less than 2^-60
MOST_TURNS = 20  # periods on either side: what averages over more leaves nothing of the trace


@dataclass(frozen=True)
class Spline:
    """A cubic spline f on its breaks (N+1,).

    c (N, 4) are its coefficients about the left end of each piece, low order first; tails (N,) is
    what rounding took from the slopes c[:, 1].
    """

    breaks: Array
    c: Array
    tails: Array

    @property
    def slope(self) -> Slope:
        """f', a parabola between neighbouring breaks."""
        slopes, tails = self.c[:, 1:] * np.arange(1.0, 4.0), np.outer(self.tails, (1.0, 0.0))
        return Slope(self.breaks, self.breaks[:-1], slopes, tails=tails)

    def tilted(self, slope: float) -> Spline:
        """f + slope (x - the first break)."""
        c = self.c.copy()
        c[:, 0] += slope * (self.breaks[:-1] - self.breaks[0])
        c[:, 1], rest = two_sum(c[:, 1], slope)
        return Spline(self.breaks, c, self.tails + rest)

    def __call__(self, x: Array) -> Array:
        """f(x), infinite beyond its ends."""
        breaks, c = self.breaks, self.c
        k = np.clip(np.searchsorted(breaks, x, side="right") - 1, 0, len(c) - 1)
        u = x - breaks[k]
        f = c[k, 0] + u * (c[k, 1] + u * (c[k, 2] + u * c[k, 3]))
        return np.where((x < breaks[0]) | (x > breaks[-1]), INF, f)


def interpolating_spline(x: Array, h: Array, ends: str = "not-a-knot") -> Spline:
    """The spline through the points; not-a-knot at the ends, so that a cubic is reproduced.

    Its f'' γ is solved for, its slopes are two doubles: a tilt cancels them without a loss.
    """
    step, (chord, tail) = np.diff(x), _chords(x, h)
    beyond = FORGOTTEN if ends == "periodic" else 0
    around = np.arange(-beyond, len(step) + beyond)
    wrapped = (np.take(v, around, mode="wrap") for v in (step, chord, tail))
    gamma = _not_a_knot(*wrapped)[beyond : beyond + len(x)]
    slope, rest = two_sum(chord, -step * (2.0 * gamma[:-1] + gamma[1:]) / 6.0)
    cubic = np.diff(gamma) / (6.0 * step)
    return Spline(x, np.stack((h[:-1], slope, 0.5 * gamma[:-1], cubic), axis=1), rest + tail)


def smoothing_spline(x: Array, h: Array, lam: float) -> Spline:
    """The smoothing spline with λ = lam > 0, with breaks at its knots.

    It is that of h less the line between its ends, plus this line, which takes no digits.
    """
    level = float((h[-1] - h[0]) / (x[-1] - x[0]))
    rise, rounded = two_product(level, x)
    left, rest = two_sum(h, -rise)
    rest -= rounded
    problem = _Problem(x, (left - left[0]) + (rest - rest[0]))
    breaks, c = problem.spline(lam / problem.length**3)
    c[:, 0] += h[0]
    return Spline(breaks, c, np.zeros(len(c))).tilted(level)


def closed_spline(x: Array, h: Array, period: float, lam: float) -> Spline:
    """The periodic spline on [x_0, x_0 + period] through points of one period, or along them.

    With λ > 0 it is the smoothing spline of the points repeated, so often that nothing of the ends
    is left. A spline with the same knots and values there is this one.
    """
    knots, f = x, h
    if lam:
        averaged = (lam * (len(x) / period) ** 3) ** 0.25
        most = min(math.ceil(FADED * averaged / len(x)), MOST_TURNS)
        turns = np.arange(-most, most + 1.0)
        repeated = (x + period * turns[:, None]).ravel()
        smooth = smoothing_spline(repeated, np.tile(h, len(turns)), lam)
        inner = smooth.breaks[(smooth.breaks > x[0]) & (smooth.breaks < x[0] + period)]
        inner = inner[: np.searchsorted(inner, x[-1], side="right")]
        knots = np.append(x[0], inner)
        f = smooth(knots)
    end = x[0] + period
    return interpolating_spline(np.append(knots, end), np.append(f, f[0]), "periodic")


def longest_lambda(x: Array) -> float:
    """The λ beyond which a smoothing spline is a straight line."""
    return float((x[-1] - x[0]) ** 3 * len(x) * LONGEST**4)


def cross_validated(x: Array, h: Array) -> float:
    """The λ of the smallest score of generalised cross validation."""
    from scipy.optimize import minimize_scalar  # noqa: PLC0415

    problem = _Problem(x, h)

    def score(averaging: float) -> float:
        return problem.score(len(x) * float(np.exp(4.0 * averaging)))

    grid = np.linspace(-np.log(3.0 * len(x)), 0.0, STEPS)
    best = int(np.argmin([score(u) for u in grid.tolist()]))
    around = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, STEPS - 1)])
    averaging = float(
        minimize_scalar(score, bounds=around, method="bounded", options={"xatol": REFINED}).x
    )
    return float(len(x) * np.exp(4.0 * averaging)) * problem.length**3


def noise_level(x: Array, h: Array, lam: float, between: tuple[float, float]) -> float:
    """The standard deviation of the noise of the heights, by the misfit about these places.

    Without bias its sum of squares has the expectation s² tr (I - A)².
    """
    problem = _Problem(x, h)
    rss, left = problem.misfit(lam / problem.length**3, _local(x, *between))
    return math.sqrt(rss / left) * problem.unit


def _local(x: Array, lo: float, hi: float) -> slice:
    """The points between two x, or LOCAL points about them."""
    start, stop = np.searchsorted(x, (lo, hi)).tolist()
    start = max(min((start + stop - LOCAL) // 2, start, len(x) - LOCAL), 0)
    return slice(start, max(stop, start + LOCAL))


class _Problem:
    """A trace in its own units: x from 0 to 1, λ with it, and heights of the order of 1 about 0."""

    def __init__(self, x: Array, h: Array) -> None:
        self.x, self.length = x, float(x[-1] - x[0])
        self.u = (x - x[0]) / self.length
        self.origin = float(h[0])
        self.unit = float(np.ptp(h)) or 1.0
        self.h = (h - self.origin) / self.unit
        self._bases: dict[int, _Basis] = {}

    def basis(self, lam: float) -> _Basis:
        n = len(self.x)
        needed = KNOTS_IN_LENGTH * (lam / n) ** -0.25
        knots = FEWEST_KNOTS * 2 ** int(np.ceil(np.log2(max(needed / FEWEST_KNOTS, 1.0))))
        knots = n if n <= ALL_KNOTS or 2 * knots > n else knots
        if knots not in self._bases:
            self._bases[knots] = _Basis(
                self.u, self.h, np.round(np.linspace(0.0, n - 1.0, knots)).astype(np.int64)
            )
        return self._bases[knots]

    def score(self, lam: float) -> float:
        basis, n = self.basis(lam), len(self.x)
        misfit = self.h - basis.values @ basis.coefficients(lam)
        return float(n * (misfit @ misfit) / (n - basis.traces(lam)[0]) ** 2)

    def misfit(self, lam: float, part: slice) -> tuple[float, float]:
        """(sum of squares of the misfit of some points, their share of tr (I - A)²)."""
        basis, n = self.basis(lam), len(self.x)
        misfit = (self.h - basis.values @ basis.coefficients(lam))[part]
        once, twice = basis.traces(lam)
        return float(misfit @ misfit), len(misfit) * max(1.0 - (2.0 * once - twice) / n, EPS)

    def spline(self, lam: float) -> tuple[Array, Array]:
        from scipy.interpolate import BSpline  # noqa: PLC0415

        if lam * (len(self.x) - 1.0) ** 3 <= SHORT:
            return self.x, self._in_given_units(_reinsch(self.u, self.h, lam))
        basis = self.basis(lam)
        knots, spline = self.u[basis.chosen], BSpline(basis.knots, basis.coefficients(lam), 3)
        return self.x[basis.chosen], self._in_given_units(
            _pieces(knots, spline(knots), spline(knots, 2))
        )

    def _in_given_units(self, c: Array) -> Array:
        c = c * (self.unit / self.length ** np.arange(4.0))
        c[:, 0] += self.origin
        return c


def _chords(x: Array, h: Array) -> tuple[Array, Array]:
    """The slopes between neighbouring points, in two doubles."""
    (step, cut), (rise, rest) = (two_sum(v[1:], -v[:-1]) for v in (x, h))
    chord = rise / step
    product, rounded = two_product(chord, step)
    return chord, ((rise - product) - rounded + (rest - chord * cut)) / step


def _not_a_knot(step: Array, chord: Array, tail: Array) -> Array:
    """f'' at the points of a spline whose first and last two pieces are one cubic each."""
    from scipy.linalg import solve_banded  # noqa: PLC0415 -- heavy, and for traces only

    bends = np.diff(chord) + np.diff(tail)
    system, first, last = not_a_knot_bands(step)
    inner = solve_banded((1, 1), system, 6.0 * bends, check_finite=False)
    return np.concatenate(([first @ inner[:2]], inner, [last @ inner[-2:]]))


def not_a_knot_bands(step: Array) -> tuple[Array, Array, Array]:
    """The bands (3, n - 2) of the equations of the inner f'', and the outer ones by the next two.

    On the right is 6 times the change of slope from chord to chord.
    """
    begin, end = step[0] / step[1], step[-1] / step[-2]
    system = np.zeros((3, len(step) - 1))
    system[1] = 2.0 * (step[:-1] + step[1:])
    system[0, 1:] = system[2, :-1] = step[1:-1]
    system[1, 0] += step[0] * (1.0 + begin)
    system[0, 1] -= step[0] * begin
    system[1, -1] += step[-1] * (1.0 + end)
    system[2, -2] -= step[-1] * end
    return system, np.array([1.0 + begin, -begin]), np.array([-end, 1.0 + end])


def _reinsch(x: Array, h: Array, lam: float) -> Array:
    """Coefficients about the left end of each piece, from the spline's second derivatives."""
    from scipy.linalg import solveh_banded  # noqa: PLC0415

    step = np.diff(x)
    right_side = np.diff(np.diff(h) / step)
    # Columns of Q have the entries a, b, c at three neighbouring points
    a, c = 1.0 / step[:-1], 1.0 / step[1:]
    b = -a - c
    system = np.zeros((3, len(right_side)))
    system[2] = (step[:-1] + step[1:]) / 3.0 + lam * (a * a + b * b + c * c)
    system[1, 1:] = step[1:-1] / 6.0 + lam * (b[:-1] * a[1:] + c[:-1] * b[1:])
    system[0, 2:] = lam * c[:-2] * a[2:]
    gamma = solveh_banded(system, right_side, check_finite=False)
    f = h.copy()
    for entries, part in ((a, slice(0, -2)), (b, slice(1, -1)), (c, slice(2, None))):
        f[part] -= lam * entries * gamma
    return _pieces(x, f, np.concatenate(([0.0], gamma, [0.0])))


def _pieces(x: Array, f: Array, second: Array) -> Array:
    """Coefficients of the cubic spline with these values and second derivatives at its knots.

    They are about the left end of each piece.

    Both pieces at a knot take the same slope there, to the last digit: a jump of h' would be a
    corner of the indenter.
    """
    step = np.diff(x)
    chord = np.diff(f) / step
    last = chord[-1] + step[-1] * (second[-2] + 2.0 * second[-1]) / 6.0
    slope = np.append(chord - step * (2.0 * second[:-1] + second[1:]) / 6.0, last)
    excess = slope[:-1] + slope[1:] - 2.0 * chord
    return np.stack(
        (f[:-1], slope[:-1], (chord - slope[:-1] - excess) / step, excess / (step * step)), axis=1
    )


@dataclass
class _Basis:
    """Cubic B-splines on the chosen points: data and bending energy as banded matrices (upper)."""

    u: Array
    h: Array
    chosen: NDArray[np.int64]

    def __post_init__(self) -> None:
        from scipy.interpolate import BSpline  # noqa: PLC0415

        inner = self.u[self.chosen]
        self.knots = np.concatenate(([inner[0]] * 3, inner, [inner[-1]] * 3))
        self.values: Any = BSpline.design_matrix(self.u, self.knots, 3)
        self._gram = _upper(self.values.T @ self.values)
        self._bending = _upper(self._energy(inner))
        self._data = self.values.T @ self.h

    def _energy(self, inner: Array) -> Any:
        """∫ B_i'' B_j'': B'' is linear between knots, with values S c there."""
        from scipy.sparse import diags  # noqa: PLC0415

        t, m = self.knots, len(inner)
        first, second = 3.0 / (t[4 : m + 5] - t[1 : m + 2]), 2.0 / (t[4 : m + 4] - t[2 : m + 2])
        S = diags([-second, second], [0, 1], shape=(m, m + 1)) @ diags(
            [-first, first], [0, 1], shape=(m + 1, m + 2)
        )
        step = np.diff(inner) / 6.0
        mass = diags([step, 2.0 * (np.append(step, 0.0) + np.append(0.0, step)), step], [-1, 0, 1])
        return S.T @ mass @ S

    def coefficients(self, lam: float) -> Array:
        return self.solved(lam, self._data)

    def traces(self, lam: float) -> tuple[float, float]:
        """tr A = tr (B'B + λE)^-1 B'B, and tr A²."""
        if len(self.chosen) <= EXACT_TRACE:
            hat = self.solved(lam, self._full)
            return float(np.trace(hat)), float(np.einsum("ij,ji", hat, hat))
        signs, projected = self._probes
        fitted = self.values @ self.solved(lam, projected)
        return float((signs * fitted).sum() / PROBES), float((fitted * fitted).sum() / PROBES)

    @cached_property
    def _full(self) -> Array:
        full: Array = (self.values.T @ self.values).toarray()
        return full

    @cached_property
    def _probes(self) -> tuple[Array, Array]:
        signs: Array = np.where(
            np.random.default_rng(0).integers(0, 2, (len(self.u), PROBES)) > 0, 1.0, -1.0
        )
        projected: Array = self.values.T @ signs
        return signs, projected

    def solved(self, lam: float, right: Array) -> Array:
        from scipy.linalg import solveh_banded  # noqa: PLC0415

        solved: Array = solveh_banded(self._gram + lam * self._bending, right, check_finite=False)
        return solved


def _upper(matrix: Any) -> Array:
    """The diagonal and three above it, as SciPy stores them."""
    band = np.zeros((4, matrix.shape[0]))
    for k in range(4):
        band[3 - k, k:] = matrix.diagonal(k)
    return band
