"""Partial slip of a flat punch on a dissimilar body: the stick zone of Spence's problem.

A flat of half-width 1 under P = 1, pressed without tangential load; β > 0, friction f. It sticks
on |x| < c, and in c < |x| < 1 the body slips outwards, q = f p sgn x. With θ = atan(β f)/π, h =
1/2 - θ, F = 1/π ∫p/(z - t) dt and D = F on the surface beside the contact,

    (1 - β²) p(x) = 2/π ∫_1^∞ η D(η)/(η² - x²) dη   |x| < c, from (12) and (1) by H² = -1
    F = χ Ψ,   χ = |(c² - x²)/(1 - x²)|^h,   Ψ = 1/π ∫_-c^c (p/χ)/(z - ξ) dξ     from (1) in slip

In ξ = c t and η = 1/(c t) both steps are one symmetric positive kernel, with o = 1 - c² t²,

    K v(s) = ∫_0^1 2 (1 - t²)^(θ-1/2) o^(1/2-θ) v(t)/(1 - c² t² s²) dt,     sqrt(1 - β²) = c^θ λ/π,

λ its largest eigenvalue, v(t) = p(c t). At θ = 0 λ is π with v0 = o^(-1/2); tested with v0 the
condition needs no difference of numbers of order one,

    ε = c^θ λ/π - 1 = ∫ w v expm1(θ ln(c (1-t²)/o)) dt / ∫ w v dt,   -ε (2 + ε) = β²,

with w = (1 - t²)^(-1/2), which fixes K'/K of the modulus c and so c and 1 - c, both to relative
accuracy. The rule is that of `pieces`.

The rates of every other contact are those of the flat punch between the same edges, whatever the
profile (docs/derivations/coupled_slip.md): D, and the rate of the slip gradient γ = Hq + β p, are
what is needed of it.

Spence (1973, 1975) for the problem; Muskhelishvili (1953) §§ 107-114 for the exponents.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.elliptic import Modulus, modulus_of_ratio
from sie.profiles.slope import polynomial_slope

from .fields import SHIFTS, Fields, cumulative, interpolated
from .goodman import Uncoupled
from .pieces import FINE, Pieces
from .state import HalfSlope, Question, Solved, State

Array = NDArray[np.float64]

STEP, SHIFT = FINE.step, FINE.step / SHIFTS  # of the rule, and of tables

WIDE = 116.0  # |v| at the ends of the stick zone, where 1 - c has its digits
# Where 1 - c is less than this the punch sticks all over, to the resolution of doubles.
FULL_STICK = 1e-15
# K'/K where 1 - c = c'²/2 is that, as c' = 4 exp(-π K/2K'); nearer than DOUBTFUL the guess cannot
# tell
NARROWEST_RATIO, DOUBTFUL = math.pi / math.log(8.0 / FULL_STICK), 1.05
SETTLED, MOST_STEPS = 1e-13, 20  # of the search for K'/K: where a step ends it
ALIKE = 1e-8  # the ratios that bound an eigenvalue, where one more step ends the iteration
# v in the slip zone between which γ is tabulated: beyond, it is a power of the distance
NEAREST_C, NEAREST_EDGE = -28.0, 40.0
MIRRORED, POINTS = 20, 10  # places of a table beyond infinity, and of an interpolation


@dataclass(frozen=True, eq=False)
class FlatPunch:
    """The flat punch for P = 1 on |x| < 1.

    beta, friction      β > 0 and f
    bonded              whether the slip zone is narrower than FULL_STICK; f is then that which
                        makes it about so wide
    modulus             k = c, the half-width of the stick zone
    pressure            p at the places c t of the rule, from the axis outwards
    approximate         whether β q is left out of equation (1)
    """

    beta: float
    friction: float
    bonded: bool
    modulus: Modulus
    pressure: Array = field(repr=False)
    approximate: bool = False

    @property
    def c(self) -> float:
        return self.modulus.k

    @property
    def rest(self) -> float:
        """1 - c to relative accuracy."""
        return self.modulus.rest

    @property
    def theta(self) -> float:
        return 0.0 if self.approximate else math.atan(self.beta * self.friction) / math.pi

    @property
    def exponent(self) -> float:
        """h = 1/2 - θ: p ~ (1 - x)^-h; of a large β f the difference would lose digits."""
        return 0.5 if self.approximate else math.atan2(1.0, self.beta * self.friction) / math.pi

    def state(self, b: float, load: float) -> State:
        """The punch of the half-width b under a load as a state."""
        line = polynomial_slope((-math.inf, math.inf), (0.0,), ((0.0,),))
        flat = HalfSlope(line, 0.0, (0.0, 0.0))
        question = Question(
            self.beta, self.friction, flat, np.zeros_like, load, 0.0, self.approximate
        )
        widths = self.rest * b, 2.0 * self.c * b, self.rest * b
        pieces = Pieces(-b, widths, (-1, 0, 1), (), (), self.theta, FINE, sharp=True)
        if self.approximate:
            return Uncoupled(pieces, question)
        return _Flat(pieces, question, load / b * self.pressure)

    @cached_property
    def _fields(self) -> Fields:
        return Fields(self.state(1.0, 1.0))

    # -- the slip gradient, and the slip -----------------------------------------------------------

    @cached_property
    def _in_slip(self) -> tuple[float, Array]:
        """γ e^(-h v) and the integral of γ, in c < x < 1, by v = ln((x - c)/(1 - x))."""
        first, rows = self._fields.tables[2]
        v = first + SHIFT * np.arange(rows.shape[1])
        e = np.exp(-np.abs(v))
        slip = cumulative(rows[2] * self.rest * e / (1.0 + e) ** 2) * SHIFT
        kept = (v > NEAREST_C) & (v < NEAREST_EDGE)
        gamma = rows[2] * np.exp(-self.exponent * v)
        return float(v[kept][0]), np.stack((gamma, slip))[:, kept]

    def gradient(self, from_c: Array, e: Array) -> Array:
        """γ at c + from_c = 1 - e."""
        v = np.log(from_c / e)
        values: Array = _told(self._in_slip, 0, v) * np.exp(self.exponent * v)
        return values

    def slip(self, from_c: Array, e: Array) -> Array:
        """The integral of γ from c."""
        return _told(self._in_slip, 1, np.log(from_c / e))

    # -- beside the contact ------------------------------------------------------------------------

    @cached_property
    def _beyond(self) -> tuple[float, Array]:
        """D τ (1 - τ^-2)^h and γ τ² (1 - τ^-2)^h, τ > 1, which are even in ln((τ - 1)/(τ + 1))."""
        lowest = math.floor((-33.0 + math.log(0.5 * self.rest)) / SHIFT)
        w = SHIFT * np.arange(lowest, 0)
        E = 2.0 * np.exp(w) / -np.expm1(w)
        t, (p, q, _) = self._fields.whole
        moments = np.stack((p, q * t.x)) * t.weight / math.pi
        values = moments @ (1.0 / (E[:, None] + self._fields.from_edge(1.0))).T
        values *= (1.0 + E) * (E * (2.0 + E) / (1.0 + E) ** 2) ** self.exponent
        at_infinity = moments.sum(axis=1, keepdims=True)
        return lowest * SHIFT, np.hstack((values, at_infinity, values[:, : -MIRRORED - 1 : -1]))

    def outside(self, E: Array) -> Array:
        """D at 1 + E."""
        return self._beside(0, E) / (1.0 + E)

    def gradient_beside(self, E: Array) -> Array:
        """γ at 1 + E, which is no more than Hq."""
        return self._beside(1, E) / (1.0 + E) ** 2

    def _beside(self, row: int, E: Array) -> Array:
        to_other = 2.0 + E
        values: Array = _told(self._beyond, row, np.log(E / to_other))
        return values * (E * to_other / (1.0 + E) ** 2) ** -self.exponent


def _told(table: tuple[float, Array], row: int, v: Array) -> Array:
    """A row of a table in steps SHIFT from a first v on."""
    first, rows = table
    place = np.clip((v.ravel() - first) / SHIFT, 0.0, rows.shape[1] - 1.0)
    values: Array = interpolated(rows[row : row + 1], place, POINTS)[0]
    return values.reshape(v.shape)


@dataclass(frozen=True, eq=False)
class _Flat(State):
    """The state of the flat punch, from its pressure in stick."""

    pressure: Array = field(repr=False)

    @cached_property
    def _solved(self) -> Solved:
        t, eta = self.nodes, self.beside
        sticks = self.sticks(t)
        half = self.pressure[: (np.count_nonzero(sticks) + 1) // 2]
        p, mass = np.concatenate((half[:0:-1], half)), np.zeros(len(t.x))
        mass[sticks] = p * t.weight[sticks] / self.chi(t)[sticks]
        chi = np.exp(self.pieces.log_chi(eta))
        D: Array = chi / math.pi * ((1.0 / self.pieces.apart(eta, t)) @ mass)
        return Solved(mass, D, self.psi(self.halfway, t, mass))


# -- the stick zone --------------------------------------------------------------------------------


@lru_cache(maxsize=1)
def half_rule() -> tuple[Array, Array, Array]:
    """t from 0 to 1, 1 - t, and weights for even functions."""
    v = STEP * np.arange(math.ceil(WIDE / STEP) + 1)
    e = np.exp(-v)
    near = 2.0 * e / (1.0 + e)
    dt = 0.5 * STEP * near * (2.0 - near)
    dt[0] *= 0.5
    return -np.expm1(-v) / (1.0 + e), near, dt


def squares(modulus: Modulus, t: Array, near: Array) -> tuple[Array, Array]:
    """1 - t² and 1 - c² t²."""
    one = near * (1.0 + t)
    return one, modulus.complement**2 + modulus.k**2 * one


class Trial(NamedTuple):
    """What -ε (2 + ε) exceeds β² by at some K'/K, the modulus, and p."""

    missed: float
    modulus: Modulus
    pressure: Array


def _at_ratio(tau: float, pair: tuple[float, float], start: Array | None) -> Trial:
    """The punch of (β, f) at K'/K = τ, its pressure searched from that of another."""
    (beta, friction), modulus = pair, modulus_of_ratio(tau)
    c, theta = modulus.k, math.atan(beta * friction) / math.pi
    t, near, dt = half_rule()
    one, o = squares(modulus, t, near)
    weight = 2.0 * dt * one ** (theta - 0.5) * o ** (0.5 - theta)
    kernel = weight / (o[:, None] + c * c * np.outer(1.0 - one, one))
    v = _eigenvector(kernel, o**-0.5 if start is None else start)
    # ln(c (1-t²)/o), which is next to 0 where 1 - t is not small beside 1 - c
    part = -modulus.rest * (1.0 + c - c * one) / o
    logarithm = np.where(part > -0.5, np.log1p(np.maximum(part, -0.5)), np.log(c * one / o))
    tested = dt / np.sqrt(one) * v
    epsilon = float(tested @ np.expm1(theta * logarithm)) / float(tested.sum())
    v /= c ** (2.0 * theta) * (weight @ v)
    return Trial(-epsilon * (2.0 + epsilon) - beta * beta, modulus, v)


def _eigenvector(matrix: Array, v: Array) -> Array:
    """The positive eigenvector of a positive matrix.

    The largest ratio of (matrix v)/v bounds the eigenvalue, and inverse iteration with this shift
    keeps v positive and converges quadratically (Noda 1971).
    """
    diagonal = np.arange(len(v))
    for _ in range(MOST_STEPS):
        ratio = (matrix @ v) / v
        bound = float(ratio.max())
        shifted = matrix.copy()
        shifted[diagonal, diagonal] -= bound
        v = -np.asarray(np.linalg.solve(shifted, v), dtype=float)
        v /= v.max()
        if bound - float(ratio.min()) <= ALIKE * bound:
            break
    return matrix @ v


# beyond it c = 4 exp(-π K'/2K) is lost even beside a double's smallest lengths; c² is a double
WIDEST_RATIO = 200.0


def goodman_flat(beta: float, friction: float) -> FlatPunch:
    """The flat punch in Goodman's approximation, of which K'/K = β/f and p = 1/(π sqrt(1 - x²)).

    Where the slip zone would be narrower than rounding, f is that which makes it so wide.
    """
    bonded = beta < NARROWEST_RATIO * friction
    friction = beta / NARROWEST_RATIO if bonded else friction
    modulus = modulus_of_ratio(min(beta / friction, WIDEST_RATIO))
    t, near, _ = half_rule()
    _, square = squares(modulus, t, near)
    pressure = 1.0 / (math.pi * np.sqrt(square))
    return FlatPunch(beta, friction, bonded, modulus, pressure, approximate=True)


@lru_cache(maxsize=8)
def flat_punch(beta: float, friction: float) -> FlatPunch:
    """The flat punch in partial slip; β > 0, f > 0.

    Where the slip zone would be narrower than FULL_STICK, friction is that which makes it about so
    wide: under a larger one the tractions differ only within such a distance of the edges.
    """
    phase = _phase(beta, friction)
    guess = phase / math.atan(friction)
    if guess < DOUBTFUL * NARROWEST_RATIO:
        narrowest = NARROWEST_RATIO
        certain = guess < narrowest / DOUBTFUL
        if certain or _at_ratio(narrowest, (beta, friction), None).missed > 0.0:
            friction = math.tan(phase / narrowest)
            friction = math.tan(_phase(beta, friction) / narrowest)
            return _root(narrowest, beta, friction, bonded=True)
    return _root(guess, beta, friction, bonded=False)


def _phase(beta: float, friction: float) -> float:
    """About atan(f) K'/K: Goodman's β, corrected for larger constants by a fit to solutions."""
    square = beta * beta
    return beta * (1.0 + square * (0.5 + square / 3.0 + 0.054 * math.atan(friction) ** 2))


def _root(guess: float, beta: float, friction: float, bonded: bool) -> FlatPunch:
    """The punch that meets the condition -ε (2 + ε) = β², by the secant method in ln K'/K."""
    place, slope, step, missed, found = math.log(guess), 0.0, 0.0, math.inf, None
    # As K'/K is about β/arctan(f), and what is missed is a function of it and of βf, less β²
    rise = 2.0 / (1.0 + friction / ((1.0 + friction * friction) * math.atan(friction)))
    for _ in range(MOST_STEPS):
        before = missed
        found = _at_ratio(math.exp(place), (beta, friction), found.pressure if found else None)
        missed = found.missed
        if missed == before:
            break
        if math.isfinite(before):
            slope = (before - missed) / step
        step = missed / (slope or rise * (missed + beta * beta))
        if abs(step) <= SETTLED:
            break
        place -= step
    assert found is not None
    return FlatPunch(beta, friction, bonded, found.modulus, found.pressure)
