"""P' and the middle of the contact, as the contact of dissimilar bodies grows.

While the load grows the rates Ṗ, Hp' ... know nothing of the profile: they are those of the flat
punch on the present contact. With s half the width of the contact, m its middle and D the slope
beside the flat punch (`flat`), the profile must be met as soon as the edges reach it,

    ∫ P'(σ) D((x - m(σ))/σ) dσ/σ = E*/2 h'(x)      at x = m(s) + s and at x = m(s) - s,

for all s: two equations for P' = dP/ds and m. On
a panel they are collocated: Chebyshev series of P', but for a power of the distance from its
beginning, and of m. A panel behind a kink of the profile has series in the logarithm of the
distance from where an edge passed that. The integral is a trapezoidal rule as in `pieces`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import with_weight

from .pieces import FINE

if TYPE_CHECKING:
    from .flat import FlatPunch

Array = NDArray[np.float64]

STEP = FINE.step

DEGREE = 24
NEAR = 0.5  # lengths of a panel: farther from its end a Gauss rule of its DEGREE suffices
REACH = 34.0  # e-folds of an integrand
NEWTONS, SETTLED, ROUGH = 20, 1e-13, 1e-9  # steps, and the size of one that ends them
SHORT_STEP = 1e-2  # after such a step the matrix is kept
STEEP, LEAST_SHARE = 0.9999, 1e-3  # of 1, |m'|; of a step, the part that may be taken
SHIFTED = 1e-4  # of the distance from an edge: for derivatives of the kernel
NOISY = 1e-10
STILL = 1e-15  # half-widths: a middle that moves by less stays, as under a symmetric profile
GRID: Array = np.linspace(-1.0, 1.0, 65)
LEAST_RISE = 1e-3  # of s: how far an edge moves at least in trials


class Rule(NamedTuple):
    """Parts of an interval, what is left of it, and weights."""

    part: Array
    rest: Array
    weight: Array


def trapezoidal(below: float, above: float) -> Rule:
    """The rule for integrands whose powers at the ends are larger than -1 by these numbers."""
    lo, hi = (math.ceil(REACH / room / STEP) for room in (below, above))
    v = STEP * np.arange(-lo, hi + 1)
    e = np.exp(-np.abs(v))
    near, far = e / (1.0 + e), 1.0 / (1.0 + e)
    return Rule(np.where(v < 0.0, near, far), np.where(v < 0.0, far, near), STEP * near * far)


@dataclass(frozen=True, eq=False)
class Panel:
    """P' and m for lo <= s <= hi.

    power       P' = (s - lo)^power times its series
    behind      how far lo lies beyond the kink from which distances are taken; inf if series are
                in s itself
    middle      m at lo
    series      of P'
    shifts      of m less a constant
    """

    lo: float
    hi: float
    power: float
    behind: float
    middle: float
    series: Array = field(repr=False)
    shifts: Array = field(repr=False)

    @property
    def length(self) -> float:
        return self.hi - self.lo

    @cached_property
    def _unit(self) -> float:
        """Half the length of the variable of the series."""
        far = self.length / self.behind
        return 0.5 * (math.log1p(far) if far else self.length)

    def variable(self, ahead: Any) -> Any:
        """That of the series at lo + ahead."""
        return self._between(0.0, ahead) - 1.0

    def _between(self, place: Any, by: Any) -> Any:
        """How far it goes from lo + place to lo + place + by, to relative accuracy."""
        if self.behind == math.inf:
            return by / self._unit
        return np.log1p(by / (self.behind + place)) / self._unit

    def ahead(self, variable: Array) -> Array:
        """The inverse of the variable."""
        part = self._unit * (1.0 + variable)
        return part if self.behind == math.inf else self.behind * np.expm1(part)

    def _rise(self, ahead: Array) -> Array:
        """ds over that of the variable."""
        if self.behind == math.inf:
            return np.full(np.shape(ahead), self._unit)
        values: Array = self._unit * (self.behind + ahead)
        return values

    def __call__(self, ahead: Array) -> Array:
        """P' at lo + ahead."""
        values: Array = chebyshev.evaluate(self.series, self.variable(ahead))
        return values * ahead**self.power if self.power else values + np.zeros(np.shape(ahead))

    def moved(self, place: Array, by: Array) -> Array:
        """m(lo + place + by) - m(lo + place), to relative accuracy however small `by` is."""
        if not self.shifts.any():
            return np.zeros(np.shape(by))
        start, far = np.broadcast_arrays(self.variable(place), self._between(place, by))
        values: Array = chebyshev.quotient(self.shifts, start, start + far) * far
        return values

    def turn(self, ahead: Array) -> Array:
        """m' at lo + ahead."""
        return _slope(self.shifts, self.variable(ahead)) / self._rise(ahead)

    @cached_property
    def whole_shift(self) -> float:
        """m at hi less that at lo."""
        return float(2.0 * self.shifts[1::2].sum())

    def spread(self, side: float) -> float:
        """How far the edge on this side moves on the panel."""
        return self.length + side * self.whole_shift

    @cached_property
    def places(self) -> tuple[Array, Array]:
        """s - lo and P' ds of a Gauss rule over the panel."""
        return self.rule(self.length)

    def rule(self, end: float) -> tuple[Array, Array]:
        """s - lo and P' ds of a Gauss rule from lo to lo + end."""
        part, _, weight = with_weight(DEGREE, 0.0, self.power)
        if self.behind == math.inf:
            ahead = end * part
            return ahead, end * weight * self(ahead)
        log = math.log1p(end / self.behind)
        ahead = self.behind * np.expm1(log * part)
        return ahead, log * (self.behind + ahead) * weight * self(ahead)

    def load(self, end: float) -> float:
        """∫P' ds from lo to lo + end, at most to hi."""
        return float(self.rule(min(end, self.length))[1].sum()) if end > 0.0 else 0.0


def _slope(series: Array, y: Array) -> Array:
    """The derivative of a series."""
    orders = np.arange(1, len(series))
    values: Array = chebyshev.evaluate_second_kind(series[1:] * orders, y) + np.zeros(np.shape(y))
    return values


class Side(Protocol):
    """The profile beside the contact on one side.

    sign        1 on the right
    slope       sign times E*/2 h' at a distance outwards from where the panel begins
    """

    sign: float

    def slope(self, rise: Array) -> Array: ...


def slope_of(
    flat: FlatPunch, panels: list[Panel], side: float, rise: Array
) -> tuple[Array, Callable[[], Array]]:
    """∫P' D over panels at places that lie so far beyond their last edge, and its derivative."""
    E, s, mass, between = [], [], [], 0.0
    for panel in reversed(panels):
        if float(rise.min()) + between < NEAR * panel.length:
            part, rest, dx = trapezoidal(1.0 + min(panel.power, 0.0), 1.0)
            inside, left = panel.length * part, panel.length * rest
            E.append(between + left - side * panel.moved(np.array(panel.length), -left))
            mass.append(panel.length * dx * panel(inside))
        else:
            inside, weighted = panel.places
            E.append(
                between + panel.spread(side) - (inside + side * panel.moved(np.array(0.0), inside))
            )
            mass.append(weighted)
        s.append(panel.lo + inside)
        between += panel.spread(side)
    if not panels:
        return np.zeros(len(rise)), lambda: np.zeros(len(rise))
    away = np.maximum(rise[:, None] + np.concatenate(E), 1e-300)
    widths, load = np.concatenate(s), np.concatenate(mass)
    return kernel(flat, away, widths) @ load, lambda: kernel_rate(flat, away, widths) @ load


def kernel(flat: FlatPunch, E: Array, s: Array) -> Array:
    """D/s at a place that lies E beyond the edge of a contact of the half-width s."""
    values: Array = flat.outside(E / s) / s
    return values


def kernel_rate(flat: FlatPunch, E: Array, s: Array) -> Array:
    """The derivative of that with E, by a difference."""
    step = SHIFTED * E
    values: Array = (kernel(flat, E + step, s) - kernel(flat, E - step, s)) / (2.0 * step)
    return values


def collocated(
    flat: FlatPunch, panels: list[Panel], panel: Panel, sides: tuple[Side, ...]
) -> Panel | None:
    """The panel with its series, from one with a guess of m; None if no step converges.

    The matrix of Newton's method is kept while steps are short.
    """

    def equations(panel: Panel) -> list[Equations]:
        return [Equations(flat, panels, panel, side) for side in sides]

    n = len(panel.series)
    now = equations(replace(panel, series=np.zeros(n)))
    missed, loads = (
        np.concatenate(part) for part in zip(*((e.missed, e.loads) for e in now), strict=True)
    )
    panel = replace(panel, series=np.linalg.lstsq(loads, missed, rcond=None)[0])
    matrix, before = np.zeros((0, 0)), math.inf
    for _ in range(NEWTONS):
        now = equations(panel)
        missed = np.concatenate([one.missed for one in now])
        if before > SHORT_STEP:
            matrix = np.concatenate([one.matrix for one in now])
        step = np.linalg.lstsq(matrix, missed, rcond=None)[0]
        change = np.append(0.0, step[n:])
        share = _share(panel, change) if np.isfinite(step).all() else 0.0
        if share == 0.0:
            return None
        panel = replace(
            panel, series=panel.series + share * step[:n], shifts=panel.shifts + share * change
        )
        moved = float(np.abs(change).max()) / panel.length
        size = max(float(np.abs(step[:n]).max() / np.abs(panel.series).max()), moved)
        if share == 1.0 and (size <= SETTLED or (before <= ROUGH and size > 0.5 * before)):
            stays = float(np.abs(panel.shifts).max()) <= STILL * panel.hi
            return replace(panel, shifts=np.zeros(n)) if stays else panel
        before = size / share
    return None


def _share(panel: Panel, change: Array) -> float:
    """The part of a step that leaves |m'| < 1; 0 where none does."""
    share, rise = 1.0, panel._rise(panel.ahead(GRID))
    at, more = (_slope(c, GRID) / rise for c in (panel.shifts, change))
    while np.abs(at + share * more).max() > STEEP:
        share *= 0.5
        if share < LEAST_SHARE:
            return 0.0
    return share


class Equations:
    """What the equation at the edge on one side misses on a panel, and its matrix."""

    def __init__(self, flat: FlatPunch, panels: list[Panel], panel: Panel, side: Side) -> None:
        self.flat, self.panel, self.side = flat, panel, side
        self.y = chebyshev.points(len(panel.series))
        self.ahead = panel.ahead(self.y)
        part, rest, weight = trapezoidal(1.0 + min(panel.power, 0.0), 1.0 - flat.exponent)
        ahead = self.ahead[:, None]
        self.part = part
        self.inside, left, self.weight = ahead * part, ahead * rest, ahead * weight
        least = LEAST_RISE * self.ahead
        self.rise = np.maximum(
            self.ahead + side.sign * panel.moved(np.array(0.0), self.ahead), least
        )
        E = left - side.sign * panel.moved(ahead, -left)
        self.E = np.maximum(E, LEAST_RISE * left)
        self.s = panel.lo + self.inside
        self.known, self.change = slope_of(flat, panels, side.sign, self.rise)
        self.value = kernel(flat, self.E, self.s) * self.weight

    @cached_property
    def missed(self) -> Array:
        own = (self.value * self.panel(self.inside)).sum(axis=1)
        values: Array = self.side.slope(self.rise) - self.known - own
        return values

    @cached_property
    def loads(self) -> Array:
        """The matrix that takes the series of P' to the slope."""
        value = self.value
        if self.panel.power:
            value = value * self.inside**self.panel.power
        terms = chebyshev.polynomials(len(self.y), self.panel.variable(self.inside))
        found: Array = np.einsum("kij,ij->ik", terms, value)
        return found

    @property
    def matrix(self) -> Array:
        """The derivatives of the slope less that of the profile, with both series."""
        n, panel = len(self.y), self.panel
        mass = kernel_rate(self.flat, self.E, self.s) * panel(self.inside) * self.weight
        # m less that at lo, at the edge and at the nodes, for each term but the constant
        lowest = (-1.0) ** np.arange(1, n)
        at_end = chebyshev.polynomials(n, self.y)[1:] - lowest[:, None]
        at_nodes = chebyshev.polynomials(n, panel.variable(self.inside))[1:]
        apart = (at_end + lowest[:, None])[:, :, None] - at_nodes
        apart *= self.part < 1.0 - NOISY  # nearer, rounding is larger than the difference
        own = np.einsum("kij,ij->ik", apart, mass)
        step = SHIFTED * self.rise
        slopes = (self.side.slope(self.rise + way * step) for way in (1.0, -1.0))
        steepness = np.subtract(*slopes) / (2.0 * step)
        shifts = own + (self.change() - steepness)[:, None] * at_end.T
        return np.concatenate((self.loads, self.side.sign * shifts), axis=1)
