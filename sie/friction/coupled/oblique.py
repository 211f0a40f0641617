"""The flat of dissimilar bodies under P and Q that grow in proportion, and power laws made of it.

The equations of a flat of half-width 1, with its zones of stick and slip, keep their form under
y = (τ - μ)/(1 - μ τ), |μ| < 1, which leaves -1 and 1 in place: with p̂, q̂ of the flat under P alone

    p = w p̂(y),   q = w q̂(y),   γ = w γ̂(y),   w = sqrt(dy/dτ) = sqrt(1 - μ²)/(1 - μ τ)

obey (1), (12) and the friction law under other loads, as H p = w H p̂(y). With d = η D(η) and
e = η E(η) at η = 1/s beside the flat under P alone, their loads are

    P = π sqrt(1 - μ²) d(|μ|),   Q = -π sqrt(1 - μ²) e(μ),   d even and e odd,

so that every |Q| < f P has its μ. Under h = A |x|^j the contact is s (ν ± 1) while s grows from 0
to b. Its rates are those of such flats: with ρ = x/s, P' = C s^(j-1) and x > 0

    p(x) = C x^(j-1) ∫ ρ^-j p̂ w dy over ρ > x/b,   alike q and γ,   w = sqrt(1 - μ²)/(1 + μ y),
    slip(x) = 2 C/(j E*) x^j ∫ (max(ρ, x/b)^-j - (1 + ν)^-j) γ̂ w dy over c < y < 1.

Beside the contact y runs on, through infinity where μ > 0; in s = 1/y

    E*/2 h' = C I x^(j-1),   I = sqrt(1 - μ²) ∫ ρ^-j d/(s + μ) ds over -μ < s < 1.

x < 0 is the same with -μ and -ν, and ν makes both I equal. All holds while x = 0 sticks.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.root_finding import false_position

from .functions import FlatFunctions

Array = NDArray[np.float64]

LENGTH, DEGREE = 2.5, 20  # of a panel of v, and of its series
STEEP = 7.5  # of the logarithm of a power, on a panel at most
REACH = 80.0  # of v: next to an edge tractions are as small as exp(-v/2)
DEEPEST = 575.0  # of -ln of a power of ρ: beyond it p no longer varies
FASTEST = 18.0  # of artanh μ
WIDEST = 1.0 - 1e-9  # of ν


class Places(NamedTuple):
    """Distances from both ends of an interval, ascending, and weights."""

    below: Array
    above: Array
    weight: Array


def places(length: float, reach: tuple[float, float], step: float) -> Places:
    """Chebyshev points of panels of v = ln(below/above) between two bounds."""
    n = math.ceil((reach[1] - reach[0]) / step)
    steps = np.arange(n)[:, None] + 0.5 * (1.0 + chebyshev.points(DEGREE))
    v = (reach[0] + step * steps).ravel()
    ratio = np.exp(-np.abs(v))
    near, far = length * ratio / (1.0 + ratio), length / (1.0 + ratio)
    unit = chebyshev.antiderivative(chebyshev.transform(np.eye(DEGREE))).sum(axis=-1)
    weight = np.tile(0.5 * step * unit, n) * (near * far / length)
    return Places(np.where(v < 0.0, near, far), np.where(v < 0.0, far, near), weight)


class Running:
    """Integrals of rows of functions from each place between two to the upper end.

    The functions are analytic in v = ln(below/above), of the distances from both ends.
    """

    def __init__(
        self,
        length: float,
        reach: tuple[float, float],
        step: float,
        rows: Callable[[Array, Array], tuple[Array, ...]],
    ) -> None:
        self.places, self.start, self.step = places(length, reach, step), reach[0], step
        below, above, _ = self.places
        self.rows = np.stack(rows(below, above))
        values = (self.rows * (below * above / length)).reshape(len(self.rows), -1, DEGREE)
        self.last = values.shape[1]
        self.series = 0.5 * step * chebyshev.antiderivative(chebyshev.transform(values))
        totals = self.series.sum(axis=2)
        self.left = np.cumsum(totals[:, ::-1], axis=1)[:, ::-1]

    def __call__(self, row: int, below: Array, above: Array) -> Array:
        """∫ to the upper end."""
        with np.errstate(divide="ignore"):
            place = (np.log(below) - np.log(above) - self.start) / self.step
        place = np.clip(place, 0.0, self.last * (1.0 - 1e-16))
        k = np.minimum(place.astype(np.intp), self.last - 1)
        part = chebyshev.evaluate(self.series[row].T[:, k], 2.0 * (place - k) - 1.0)
        values: Array = self.left[row, k] - part
        return values

    def whole(self, row: int) -> float:
        return float(self.left[row, 0])


@dataclass(frozen=True, eq=False)
class Oblique:
    """The flat under P and Q in proportion, for x > 0 of a contact s (ν ± 1) under |x|^j.

    turn        artanh μ
    """

    flat: FlatFunctions
    turn: float
    nu: float
    j: float

    @property
    def mu(self) -> float:
        return math.tanh(self.turn)

    @property
    def above(self) -> float:
        """1 + μ."""
        return 2.0 / (1.0 + math.exp(-2.0 * self.turn))

    @property
    def below(self) -> float:
        """1 - μ."""
        return 2.0 / (1.0 + math.exp(2.0 * self.turn))

    @property
    def root(self) -> float:
        return 1.0 / math.cosh(self.turn)

    @property
    def _at_first(self) -> float:
        """1 + μ ν."""
        return self.above - self.mu * (1.0 - self.nu)

    @property
    def _at_c(self) -> float:
        """1 + μ c."""
        return self.above - self.mu * self.flat.rest

    @property
    def first(self) -> float:
        """y at x = 0."""
        return -(self.nu + self.mu) / self._at_first

    @property
    def _from_edge(self) -> float:
        """1 + y at x = 0."""
        return (1.0 - self.nu) * self.below / self._at_first

    @property
    def length(self) -> float:
        """c - y at x = 0."""
        return (self.above - self.flat.rest + self.nu * self._at_c) / self._at_first

    @property
    def _step(self) -> float:
        return min(LENGTH, STEEP / self.j)

    @property
    def edge(self) -> float:
        return 1.0 + self.nu

    @property
    def stuck(self) -> float:
        """ρ at the end of the stick zone."""
        return self.length * self._at_first / self._at_c

    def _factors(self, e: Array, from_first: Array) -> tuple[Array, Array]:
        """w and ρ, given 1 - y and the distance from y at x = 0."""
        mu = self.mu
        if mu < 0.0:
            below = self.above - mu * e
        else:
            below = self.below + mu * (from_first + self._from_edge)
        return self.root / below, self._at_first * from_first / below

    @cached_property
    def stick(self) -> Running:
        """From y to c: of p, of q, and of p ρ^(j + 1)."""
        flat, y0, c = self.flat, self.first, self.flat.c

        def rows(below: Array, above: Array) -> tuple[Array, ...]:
            y = np.where(below < above, y0 + below, c - above)
            t = np.abs(y)
            # c + y0 would lose digits next to the other edge
            from_c = np.where(y < 0.0, below + (self._from_edge - flat.rest), above)
            at = t, flat.rest + from_c, from_c
            p = flat.pressure(*at)
            q = np.sign(y) * (flat.friction * p - flat.shear_deficit(*at))
            w, rho = self._factors(flat.rest + above, below)
            power = w * rho**-self.j
            return p * power, q * power, p * w * rho

        # p̂ w is finite at both ends, but as large as their distances from the edges are small
        lowest = math.log(min(self._from_edge / self.length, 1.0)) - min(
            0.5 * REACH, DEEPEST / self.j
        )
        reach = lowest, 0.5 * REACH - math.log(flat.rest)
        return Running(self.length, reach, self._step, rows)

    @cached_property
    def slip(self) -> Running:
        """From y to the edge: of p, p ρ^(j + 1), γ ρ^j, γ, and of the slip."""
        flat = self.flat

        def rows(below: Array, above: Array) -> tuple[Array, ...]:
            at = 1.0 - above, above, below
            w, rho = self._factors(above, below + self.length)
            p, gamma, power = w * flat.pressure(*at), w * _gradient(flat, *at), rho**-self.j
            return p * power, p * rho, gamma * power, gamma, gamma * self._excess(rho)

        return Running(flat.rest, (-0.5 * REACH, REACH), self._step, rows)

    def _excess(self, rho: Array) -> Array:
        """ρ^-j less that at the edge."""
        values: Array = self.edge**-self.j * np.expm1(-self.j * np.log(rho / self.edge))
        return values

    @cached_property
    def beside(self) -> Running:
        """From s to 1: of H p ρ^j, what H p has more than at the edge, H p, and γ."""
        flat = self.flat

        def rows(below: Array, above: Array) -> tuple[Array, ...]:
            s, t, e = self._outside(below, above)
            outside, per_s = flat.outside(t, e), self.root / below
            inverse = self._inverse(self.nu, below, above)
            J = flat._J(1.0 / t, -e / t, flat._S_in_stick) / t
            gradient = np.sign(s) * (flat.friction * outside - J)
            power = inverse**self.j * per_s
            excess = self._excess(1.0 / inverse) * per_s
            return outside * per_s, outside * excess, outside * power, gradient * power

        return Running(self.above, (-REACH, REACH), self._step, rows)

    def _outside(self, below: Array, above: Array) -> tuple[Array, Array, Array]:
        """s, |s| and 1 - |s|, given s + μ and 1 - s."""
        s = np.where(below < above, below - self.mu, 1.0 - above)
        t = np.abs(s)
        return s, t, np.where(s > 0.0, above, below + self.below)

    def _inverse(self, nu: float, below: Array, above: Array) -> Array:
        """1/ρ, given s + μ and 1 - s."""
        both = self.mu + nu
        if self.mu < 0.0:
            values: Array = below / (self.above * (1.0 + nu) - both * above)
        else:
            values = below / (self.root**2 + both * below)
        return values

    @cached_property
    def rise(self) -> Callable[[float], float]:
        """ln I as a function of ν."""
        below, above, weight = places(self.above, (-REACH, REACH), self._step)
        _, t, e = self._outside(below, above)
        masses = weight * self.flat.outside(t, e) * self.root / below

        def rise(nu: float) -> float:
            powers = self.j * np.log(self._inverse(nu, below, above))
            largest = float(powers.max())
            return largest + math.log(float(masses @ np.exp(powers - largest)))

        return rise

    # -- at places ξ = x/b, given the distances from the edge and from the end of the stick zone ---

    def _from(self, xi: Array, from_edge: Array, from_c: Array) -> tuple[Array, Array, Array]:
        """1 - y, |y - c| and y - y0."""
        mu = self.mu
        below = self.below + mu * from_edge if mu > 0.0 else 1.0 - mu * (xi - self.nu)
        return (
            from_edge * self.above / below,
            from_c * self._at_c / below,
            xi * self.root**2 / (below * self._at_first),
        )

    def traction(self, row: int, xi: Array, from_edge: Array, from_c: Array) -> Array:
        """p (row 0) or q (row 1) over C b^(j - 1)."""
        raised = np.maximum(xi, math.exp(-min(0.45 * REACH, 0.9 * DEEPEST / self.j)))
        xi, from_c = raised, from_c - (raised - xi)
        e, beside_c, ahead = self._from(xi, from_edge, from_c)
        slips = xi > self.stuck
        total, factor = np.empty(len(xi)), self.flat.friction if row else 1.0
        total[slips] = factor * self.slip(0, beside_c[slips], e[slips])
        total[~slips] = self.stick(row, ahead[~slips], beside_c[~slips])
        total[~slips] += factor * self.slip.whole(0)
        return np.where(from_edge > 0.0, total, 0.0) * xi ** (self.j - 1.0)

    def slipped(self, xi: Array, from_edge: Array, from_c: Array) -> Array:
        """The slip over C b^j/(j E*/2)."""
        e, beside_c, _ = self._from(xi, from_edge, from_c)
        out, slips = np.full(len(xi), self.slip.whole(4)), xi > self.stuck
        own = beside_c[slips], e[slips]
        out[slips] = self.slip(4, *own)
        out[slips] += (self.slip.whole(3) - self.slip(3, *own)) * self._excess(xi[slips])
        return out * xi**self.j

    def gap(self, xi: Array, ahead: Array) -> Array:
        """The gap over C b^j/(j E*/2), `ahead` of the edge."""
        far = ahead + self.below
        below, above = self.root**2 / far, ahead * self.above / far
        opened = self.beside(1, below, above) - self._excess(xi) * self.beside(0, below, above)
        values: Array = xi**self.j * opened
        return values

    # -- whole -------------------------------------------------------------------------------------

    @cached_property
    def first_moment(self) -> float:
        """∫p x dx over C b^(j + 1)/(j + 1)."""
        return self.stick.whole(2) + self.slip.whole(1)

    @property
    def kept(self) -> float:
        """γ of what sticks, over C x^(j - 1)."""
        return self.slip.whole(2) + self.beside.whole(3)

    @cached_property
    def dissipation(self) -> float:
        """∫p γ dx in slip, the energy over f C² b^(2 j)/(j E*)."""
        s = self.slip
        below, above, weight = s.places
        w, rho = self._factors(above, below + self.length)
        p = s(0, below, above) * rho ** (self.j - 1.0)
        g = s.whole(3) - s(3, below, above)
        return float((p * g * w * w) @ weight)


def _gradient(flat: FlatFunctions, t: Array, e: Array, from_c: Array) -> Array:
    """γ̂ in the slip zone of the flat."""
    gamma, edge = np.empty(len(t)), e < flat.beyond
    near = t[~edge], e[~edge]
    chi = flat.weight(*near, from_c[~edge])
    gamma[~edge] = (1.0 - flat.beta**2) * flat.sine / flat.beta * chi * flat.S(*near)
    near = t[edge], e[edge]
    p = flat.pressure(*near, from_c[edge])
    gamma[edge] = flat.beta * (1.0 + flat.friction**2) * p - flat._J(*near, flat._S_in_stick)
    return gamma


def of_load(flat: FlatFunctions, z: float) -> float:
    """Q/P of μ = -tanh z, z >= 0."""
    s, e = np.array([math.tanh(z)]), np.array([2.0 / (1.0 + math.exp(2.0 * z))])
    if z == 0.0:
        return 0.0
    J = flat._J(1.0 / s, -e / s, flat._S_in_stick) / s
    return flat.friction - float((J / flat.outside(s, e))[0])


def inclination(flat: FlatFunctions, ratio: float) -> float:
    """artanh μ of Q/P = ratio, 0 <= ratio < f, not positive."""

    def missed(z: float) -> float:
        return of_load(flat, z) - ratio

    ends = -ratio, missed(FASTEST)
    if ratio == 0.0 or ends[1] <= 0.0:
        return -FASTEST if ratio else 0.0
    return -false_position(missed, 0.0, FASTEST, ends, lambda a, b, value: value == 0.0)


def centre(flat: FlatFunctions, turn: float, j: float) -> float:
    """ν with which the profile rises alike on both sides, given artanh μ."""
    if turn == 0.0:
        return 0.0
    right, left = (Oblique(flat, sign * turn, 0.0, j).rise for sign in (1.0, -1.0))

    def missed(nu: float) -> float:
        return right(nu) - left(-nu)

    ends = missed(-WIDEST), missed(WIDEST)
    return false_position(missed, -WIDEST, WIDEST, ends, lambda a, b, value: value == 0.0)
