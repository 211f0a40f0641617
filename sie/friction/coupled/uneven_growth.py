"""The growth of a contact of dissimilar bodies under a profile that is not symmetric.

Pressed by P alone at a fixed tilt, the rate of every state is that of a flat punch of the present
contact [m - s, m + s], whose stick zone is [m - c s, m + c s]. So the load P'(s) ds comes with the
middle m(s), and at both edges of every contact equation (1) reads, with D = χ Ψ of the flat,

    ∫_a^s P'(σ) D((x - m(σ))/σ) dσ/σ = E*/2 h'(x),          x = m(s) + s,
    ∫_a^s P'(σ) D((m(σ) - x)/σ) dσ/σ = -E*/2 h'(x),         x = m(s) - s,

two Volterra equations for P' and m', which are solved panel by panel from the place of first
contact outwards, by collocation and Newton's method. P' = (s - a)^e times a polynomial on the first
panel and both are polynomials on every other one; a panel whose series do not decay is cut towards
its beginning. An edge that hardly moves is close to what the contact was when it was small: the
integrand is singular where τ = -1 next, at a σ before lo by half of lo and of the distance of x
from m(lo), or more. What stuck goes on to stick as long as both ends of the stick zone move
outwards, |m'| < c.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import with_weight

from .functions import FlatFunctions
from .panels import LONGEST, graded, totals

Array = NDArray[np.float64]

DEGREE = 18
SHORTER = 0.5 * LONGEST  # of a panel of v: beside the kernel its integrand has all of the series
NEWTONS = 14
CHOP = 1e-17  # of a panel's length: terms of the middle
SETTLED = 1e-12  # of P' and m': a step of Newton's method that small is the last but one
SHORT_STEP, ROUGH = 1e-3, 1e-7  # of a step: the matrix is kept below it; a longer one may follow
SHIFTED = 1e-4  # of the distance from the edge: steps of differences, in the matrix alone
NEAR = 0.5  # of a panel's length: nearer it is integrated on panels that shrink towards x
STEEP, LEAST_SHARE = 1.0 - 1e-9, 1e-3  # of m': steps beyond it are cut, to that part
LEAST_RISE = 1e-18  # of the growth: how far an edge moves at least, in a trial too
GRID = np.linspace(-1.0, 1.0, 33)  # where it is looked at


@dataclass(frozen=True, eq=False)
class UnevenPanel:
    """P'(s) = (s - lo)^power Σ c_k T_k and m'(s) = Σ r_k T_k for lo <= s <= hi.

    middle      m at lo
    """

    lo: float
    hi: float
    power: float
    middle: float
    series: Array = field(repr=False)
    rates: Array = field(repr=False)

    @property
    def length(self) -> float:
        return self.hi - self.lo

    def __call__(self, ahead: Array) -> Array:
        """P' at lo + ahead."""
        values: Array = chebyshev.evaluate(self.series, self.variable(ahead))
        return values * ahead**self.power if self.power else values

    def rate(self, ahead: Array) -> Array:
        """m' there."""
        values: Array = chebyshev.evaluate(self.rates, self.variable(ahead))
        return values

    def variable(self, ahead: Any) -> Any:
        return 2.0 / self.length * ahead - 1.0

    @cached_property
    def shifts(self) -> Array:
        """The series of m less that at lo."""
        values: Array = 0.5 * self.length * chebyshev.antiderivative(self.rates)
        return values

    def moved(self, place: Array, by: Array) -> Array:
        """m(lo + place + by) - m(lo + place), to relative accuracy however small `by` is."""
        rise = chebyshev.quotient(self._chopped, self.variable(place), self.variable(place + by))
        rise *= 2.0 / self.length * by
        return rise

    @cached_property
    def _chopped(self) -> Array:
        # Constants do not count
        size = np.abs(self.shifts[1:])
        kept = np.flatnonzero(size > CHOP * (0.5 * self.length + size.max()))
        return self.shifts[: kept[-1] + 2] if kept.size else self.shifts[:2]

    @cached_property
    def whole_shift(self) -> float:
        """m at hi less that at lo."""
        return float(self.shifts.sum())

    def spread(self, side: float) -> float:
        """How far the edge on this side moves on the panel."""
        return self.length + side * self.whole_shift

    @cached_property
    def places(self) -> tuple[Array, Array]:
        """s - lo and P' ds of a Gauss rule over the panel."""
        x, _, w = with_weight(DEGREE, 0.0, self.power)
        ahead = self.length * x
        return ahead, self.length * w * self(ahead)

    @cached_property
    def moved_at_places(self) -> Array:
        """m there less m at lo."""
        return self.moved(np.zeros(1), self.places[0])

    def load(self, ahead: float) -> float:
        """∫P' ds from lo on."""
        if ahead <= 0.0:
            return 0.0
        length = min(ahead, self.length)
        x, _, w = with_weight(DEGREE, 0.0, self.power)
        return float(length * w @ self(length * x))


class Side(NamedTuple):
    """The profile beside the contact on one side, between two places where it is not smooth.

    slope       sign times E*/2 h' at a distance outwards from where the panel begins
    sign        1 on the right
    """

    slope: Any
    sign: float


class History:
    """The panels that are solved, and what they add to the slope at places beside them."""

    def __init__(self, flat: FlatFunctions) -> None:
        self.flat = flat
        self.panels: list[UnevenPanel] = []

    def slope(self, side: float, ahead: Array, rise: Array) -> tuple[Array, Callable[[], Array]]:
        """∫P' D over all panels, and its derivative, for edges that rose so far beyond them.

        `ahead` is how far s is beyond them.
        """
        flat, n = self.flat, len(rise)
        near: list[tuple[NDArray[np.intp], Array, Array, Array]] = []
        far: list[tuple[Array, Array, Array]] = []
        between = beyond = 0.0
        for panel in reversed(self.panels):
            end = np.array([panel.length])
            before = panel.lo + 0.5 * (rise + between + panel.spread(side))
            if min(beyond, float(before.min())) < NEAR * panel.length:
                after, powers = beyond + ahead, (panel.power, 0.0)
                owner, inside, left, weight = graded(
                    np.full(n, end[0]), before, after, powers, longest=SHORTER, near=0.0
                )
                E = (rise[owner] + between)[:, None] + left - side * panel.moved(end, -left)
                near.append((owner, E, panel.lo + inside + E, panel(inside) * weight))
            else:
                inside, mass = panel.places
                E = between + panel.spread(side) - (inside + side * panel.moved_at_places)
                far.append((E, panel.lo + inside, mass))
            between += panel.spread(side)
            beyond += panel.length
        if far:
            E, s, mass = (np.concatenate(column) for column in zip(*far, strict=True))
            E = E + rise[:, None]
            near.append((np.arange(n), E, E + s, mass))

        def total(function: Callable[[FlatFunctions, Array, Array], Array]) -> Array:
            parts = [totals(k, function(flat, E, X) * mass, n) for k, E, X, mass in near]
            return sum(parts, np.zeros(n))

        return total(kernel), lambda: total(kernel_rate)


def kernel(flat: FlatFunctions, E: Array, X: Array) -> Array:
    """D(τ)/σ, where x lies E beyond the edge and X beyond the middle of the contact, X = τ σ."""
    values: Array = flat.outside((X - E) / X, E / X) / X
    return values


def kernel_rate(flat: FlatFunctions, E: Array, X: Array) -> Array:
    """The derivative of that with x, by a difference."""
    step = SHIFTED * E
    return (kernel(flat, E + step, X + step) - kernel(flat, E - step, X - step)) / (2.0 * step)


def collocated(
    history: History, panel: UnevenPanel, sides: tuple[Side, Side]
) -> UnevenPanel | None:
    """The panel with its series, from one with a guess of m'; None if no step converges.

    The matrix of Newton's method is kept while steps are short.
    """
    n = DEGREE
    start = np.zeros(n)
    start[: len(panel.rates)] = panel.rates
    panel = replace(panel, series=np.zeros(n), rates=start)
    equations = [Equations(history, panel, side) for side in sides]
    missed = np.concatenate([one.missed for one in equations])
    loads = np.concatenate([one.loads for one in equations])
    panel = replace(panel, series=np.asarray(np.linalg.lstsq(loads, missed)[0], dtype=float))
    matrix, before = np.zeros((0, 0)), math.inf
    for _ in range(NEWTONS):
        equations = [Equations(history, panel, side) for side in sides]
        missed = np.concatenate([one.missed for one in equations])
        if before > SHORT_STEP:
            matrix = np.concatenate([one.matrix for one in equations])
        try:
            step = np.linalg.solve(matrix, missed)
        except np.linalg.LinAlgError:
            return None
        share = _share(panel.rates, step[n:]) if np.isfinite(step).all() else 0.0
        if share == 0.0:
            return None
        series, rates = panel.series + share * step[:n], panel.rates + share * step[n:]
        panel = replace(panel, series=series, rates=rates)
        turned = float(np.abs(step[n:]).max())
        size = max(float(np.abs(step[:n]).max() / np.abs(series).max()), turned)
        if share == 1.0 and (size <= SETTLED or (before <= ROUGH and size > 0.5 * before)):
            return panel
        before = size / share
    return None


def _share(rates: Array, step: Array) -> float:
    """The part of a step that leaves |m'| < 1; 0 where none does."""
    share = 1.0
    at, more = (chebyshev.evaluate(c, GRID) for c in (rates, step))
    while np.abs(at + share * more).max() > STEEP:
        share *= 0.5
        if share < LEAST_SHARE:
            return 0.0
    return share


class Equations:
    """What the equation at the edge on one side misses on a panel, and its matrix."""

    def __init__(self, history: History, panel: UnevenPanel, side: Side) -> None:
        self.panel, self.side, self.flat = panel, side, history.flat
        n, sign, flat = DEGREE, side.sign, history.flat
        ahead = self.ahead = 0.5 * panel.length * (1.0 + chebyshev.points(n))
        to_c = (panel.lo + ahead) * (0.5 * flat.rest / flat.c)
        powers = panel.power, -flat.h
        self.rise = np.maximum(ahead + sign * panel.moved(np.zeros(1), ahead), LEAST_RISE * ahead)
        self.owner, self.inside, left, self.weight = graded(
            ahead, panel.lo + 0.5 * self.rise, to_c, powers, longest=SHORTER, near=0.0
        )
        E = left - sign * panel.moved(ahead[self.owner][:, None], -left)
        self.E = np.maximum(E, LEAST_RISE * left)
        self.X = panel.lo + self.inside + self.E
        self.known, self.change = history.slope(sign, ahead, self.rise)
        self.value = kernel(flat, self.E, self.X) * self.weight

    @cached_property
    def missed(self) -> Array:
        own = totals(self.owner, self.value * self.panel(self.inside), DEGREE)
        values: Array = self.side.slope(self.rise) - self.known - own
        return values

    @cached_property
    def loads(self) -> Array:
        """The matrix that takes the series of P' to the slope."""
        values = self.value
        if self.panel.power:
            values = values * self.inside**self.panel.power
        terms = chebyshev.polynomials(DEGREE, self.panel.variable(self.inside))
        return self._by_place(np.einsum("kij,ij->ik", terms, values))

    @property
    def matrix(self) -> Array:
        """The derivatives of the slope less that of the profile with both series."""
        panel, owner = self.panel, self.owner
        at_end = 0.5 * panel.length * _primitives(panel.variable(self.ahead))
        at_nodes = 0.5 * panel.length * _primitives(panel.variable(self.inside))
        mass = kernel_rate(self.flat, self.E, self.X) * panel(self.inside) * self.weight
        own = at_end[:, owner].T * mass.sum(axis=1)[:, None]
        shifts = self._by_place(own - np.einsum("kij,ij->ik", at_nodes, mass))
        step = SHIFTED * self.rise
        slopes = (self.side.slope(self.rise + sign * step) for sign in (1.0, -1.0))
        steepness = np.subtract(*slopes) / (2.0 * step)
        shifts += (self.change() - steepness)[:, None] * at_end.T
        return np.concatenate((self.loads, self.side.sign * shifts), axis=1)

    def _by_place(self, rows: Array) -> Array:
        summed = np.zeros((DEGREE, DEGREE))
        np.add.at(summed, self.owner, rows)
        return summed


def _primitives(y: Array) -> Array:
    """∫T_k from -1 to y, one row each."""
    values: Array = np.tensordot(_of_primitives(), chebyshev.polynomials(DEGREE + 1, y), axes=1)
    return values


@lru_cache(maxsize=1)
def _of_primitives() -> Array:
    return chebyshev.antiderivative(np.eye(DEGREE))
