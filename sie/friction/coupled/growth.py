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
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

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
SHORT_STEP, ROUNDING = 1e-2, 1e-14  # after such a step the matrix is kept; of the slope
STEEP, LEAST_SHARE = 0.9999, 1e-3  # of 1, |m'|; of a step, the part that may be taken
SHIFTED = 1e-4  # of the distance from an edge: for derivatives of the kernel
NOISY = 1e-10
LEAST = 1e-300
STILL = 1e-15  # half-widths: a middle that moves by less stays, as under a symmetric profile
GRID: Array = np.linspace(-1.0, 1.0, 65)
LEAST_RISE = 1e-3  # of s: how far an edge moves at least in trials


def trapezoidal(below: float, above: float) -> tuple[Array, Array, Array]:
    """Parts of an interval, what is left of it, and weights.

    The powers of integrands at the ends are larger than -1 by these numbers.
    """
    lo, hi = (math.ceil(REACH / room / STEP) for room in (below, above))
    v = STEP * np.arange(-lo, hi + 1)
    e = np.exp(-np.abs(v))
    near, far = e / (1.0 + e), 1.0 / (1.0 + e)
    return np.where(v < 0.0, near, far), np.where(v < 0.0, far, near), STEP * near * far


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

    def cut(self, length: float) -> Panel:
        """Its beginning, of this length."""
        if length >= self.length:
            return self
        short = replace(self, hi=self.lo + length)
        at = self.variable(short.ahead(chebyshev.points(len(self.series))))
        series, shifts = (
            chebyshev.transform(chebyshev.evaluate(c, at)) for c in (self.series, self.shifts)
        )
        return replace(short, series=series, shifts=shifts)

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


Kernel = Callable[[Array], Array]  # of the distance beyond the edge of a contact of half-width 1


class Before:
    """Integrals over all contacts before an edge reaches places, `ahead` of where a panel begins.

    rise        how far the edge moves until then
    """

    def __init__(
        self, flat: FlatPunch, panels: Sequence[Panel], panel: Panel, side: float, ahead: Array
    ) -> None:
        self.panel, self.ahead = panel, ahead
        rise = ahead + side * panel.moved(np.zeros(1), ahead)
        self.rise = np.maximum(rise, LEAST_RISE * ahead)
        part, rest, weight = trapezoidal(1.0 + min(panel.power, 0.0), 1.0 - flat.exponent)
        self.near = part > 1.0 - NOISY
        self.inside, left, self.weight = (ahead[:, None] * v for v in (part, rest, weight))
        E = left - side * panel.moved(ahead[:, None], -left)
        self.E, self.s = np.maximum(E, LEAST_RISE * left), panel.lo + self.inside
        apart, widths, loads, between = [np.zeros(0)], [np.zeros(0)], [np.zeros(0)], 0.0
        for other in reversed(panels):
            inside, mass = other.places
            left = other.length - inside
            if float(self.rise.min()) + between < NEAR * other.length:
                part, rest, dx = trapezoidal(1.0 + min(other.power, 0.0), 1.0)
                inside, left = other.length * part, other.length * rest
                mass = other.length * dx * other(inside)
            apart.append(between + left - side * other.moved(np.array(other.length), -left))
            widths.append(other.lo + inside)
            loads.append(mass)
            between += other.spread(side)
        self.beyond = np.maximum(self.rise[:, None] + np.concatenate(apart), LEAST)
        self.widths, self.loads = np.concatenate(widths), np.concatenate(loads)

    def integral(self, kernel: Kernel) -> Array:
        """∫P' kernel((x - edge)/s) ds/s."""
        own = kernel(self.E / self.s) / self.s * self.weight * self.panel(self.inside)
        values: Array = (
            own.sum(axis=1) + kernel(self.beyond / self.widths) / self.widths @ self.loads
        )
        return values

    def of_series(self, kernel: Kernel) -> Array:
        """The matrix that takes the series of P' to the part of this panel."""
        value = kernel(self.E / self.s) / self.s * self.weight
        if self.panel.power:
            value = value * self.inside**self.panel.power
        terms = chebyshev.polynomials(len(self.panel.series), self.panel.variable(self.inside))
        found: Array = np.einsum("kij,ij->ik", terms, value)
        return found

    def of_shifts(self, kernel: Kernel) -> tuple[Array, Array]:
        """Derivatives with the series of m outwards, but its constant: integral, and `rise`."""
        panel, n = self.panel, len(self.panel.shifts)
        lowest = ((-1.0) ** np.arange(1, n))[:, None]
        at_end = chebyshev.polynomials(n, panel.variable(self.ahead))[1:]
        at_nodes = chebyshev.polynomials(n, panel.variable(self.inside))[1:]
        apart = at_end[:, :, None] - at_nodes
        apart[:, :, self.near] = 0.0  # where rounding is larger than the difference
        own = _steepness(kernel, self.E, self.s) * panel(self.inside) * self.weight
        others = _steepness(kernel, self.beyond, self.widths) @ self.loads
        rise = (at_end - lowest).T
        return np.einsum("kij,ij->ik", apart, own) + others[:, None] * rise, rise


def _steepness(kernel: Kernel, E: Array, s: Array) -> Array:
    """The derivative of kernel(E/s)/s with E, by a difference."""
    up, down = (kernel(factor * E / s) for factor in (1.0 + SHIFTED, 1.0 - SHIFTED))
    values: Array = (up - down) / (2.0 * SHIFTED * E * s)
    return values


def collocated(
    flat: FlatPunch, panels: list[Panel], panel: Panel, sides: tuple[Side, ...]
) -> Panel | None:
    """The panel with its series, from one with a guess of m; None where Newton finds none."""
    n = len(panel.series)
    ahead = panel.ahead(chebyshev.points(n))

    def before(panel: Panel) -> list[tuple[Side, Before]]:
        return [(side, Before(flat, panels, panel, side.sign, ahead)) for side in sides]

    now = before(replace(panel, series=np.zeros(n)))
    known, loads = _missed(flat, now), np.concatenate([b.of_series(flat.outside) for _, b in now])
    panel = replace(panel, series=np.linalg.lstsq(loads, known, rcond=None)[0])
    matrix, size = loads, math.inf
    for _ in range(NEWTONS):
        now, before_it = before(panel), size
        left = _missed(flat, now)
        if float(np.abs(left).max()) <= ROUNDING * float(np.abs(known).max()):
            return panel
        if size > SHORT_STEP:
            both = [(b.of_series(flat.outside), _of_shifts(flat, s, b)) for s, b in now]
            matrix = np.block([list(row) for row in both])
        step = np.linalg.lstsq(matrix, left, rcond=None)[0]
        change = np.append(0.0, step[n:])
        share = _share(panel, change) if np.isfinite(step).all() else 0.0
        if share == 0.0:
            return None
        series, shifts = panel.series + share * step[:n], panel.shifts + share * change
        panel = replace(panel, series=series, shifts=shifts)
        moved = float(np.abs(change).max()) / panel.length
        size = max(float(np.abs(step[:n]).max() / np.abs(series).max()), moved) / share
        if share == 1.0 and (size <= SETTLED or (before_it <= ROUGH and size > 0.5 * before_it)):
            stays = float(np.abs(shifts).max()) <= STILL * panel.hi
            return replace(panel, shifts=np.zeros(n)) if stays else panel
    return None


def _missed(flat: FlatPunch, now: list[tuple[Side, Before]]) -> Array:
    """E*/2 h' less the slope beside the contact, at the places of both sides."""
    return np.concatenate([s.slope(b.rise) - b.integral(flat.outside) for s, b in now])


def _of_shifts(flat: FlatPunch, side: Side, before: Before) -> Array:
    """The derivatives with the series of m of the latter less the former."""
    of_integral, rise = before.of_shifts(flat.outside)
    up, down = (side.slope(before.rise * (1.0 + way * SHIFTED)) for way in (1.0, -1.0))
    steepness = (up - down) / (2.0 * SHIFTED * before.rise)
    found: Array = side.sign * (of_integral - steepness[:, None] * rise)
    return found


def _share(panel: Panel, change: Array) -> float:
    """The part of a step that leaves |m'| < 1; 0 where none does."""
    share, rise = 1.0, panel._rise(panel.ahead(GRID))
    at, more = (_slope(c, GRID) / rise for c in (panel.shifts, change))
    while np.abs(at + share * more).max() > STEEP:
        share *= 0.5
        if share < LEAST_SHARE:
            return 0.0
    return share
