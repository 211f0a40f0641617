"""Partial slip of a flat punch on a dissimilar body: the stick zone of Spence's problem.

A flat of half-width 1 under P = 1, pressed without tangential load; β > 0, friction f. It sticks
on |x| < c, and in c < |x| < 1 the body slips outwards, q = f p sgn x. With θ = atan(β f)/π, h =
1/2 - θ, F = 1/π ∫p/(z - t) dt and D = F on the surface beside the contact,

    (1 - β²) p(x) = 2/π ∫_1^∞ η D(η)/(η² - x²) dη   |x| < c, from (12) and (1) by H² = -1
    F = χ Ψ,   χ = |(c² - x²)/(1 - x²)|^h,   Ψ = 1/π ∫_-c^c (p/χ)/(z - ξ) dξ     from (1) in slip

In ξ = c sn u and η = 1/sn u, with the modulus c, both steps are one symmetric positive kernel

    K v(u') = ∫_0^K 2 cn^2θ dn^(2-2θ) v(u)/(1 - c² sn²u sn²u') du,      sqrt(1 - β²) = c^θ λ/π,

λ its largest eigenvalue, v(u) = p(c sn u). The singularities of all functions are one quarter
period off the interval: a Gauss-Jacobi rule converges geometrically for every c. At θ = 0 λ is π
with v0 = 1/dn; tested with v0 the condition needs no difference of numbers of order one,

    ε = c^θ λ/π - 1 = ∫ dn v expm1(θ ln(c cn²/dn²)) du / ∫ dn v du,     -ε (2 + ε) = β²,

which fixes K'/K and so c and 1 - c, both to relative accuracy.

Spence (1973, 1975) for the problem; Muskhelishvili (1953) §§ 107-114 for the exponents.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.elliptic import Modulus, elliptic_functions, modulus_of_ratio
from sie.numerics.gauss_jacobi import gauss_jacobi, with_weight

Array = NDArray[np.float64]

# -ln of the error that a rule may leave: of even functions, of others, and, beside a factor of at
# most e^-12, of products of the kernel and the pressure
DIGITS, ACROSS, OF_KERNEL = 38.0, 46.0, 25.0
NEARER = 0.8  # of K'/K: the nearest singularity of weights and of what is derived from the solution
SPARE = 4
LONG = 0.4  # K'/K below it: a rule of all nodes at once would lose digits of its weights
# Nodes of the double exponential rule for the logarithm in ε: its step, and where it is cut.
STEP, LAST = 0.09, 42
# Where 1 - c is less than this the punch sticks all over, to the resolution of doubles.
FULL_STICK = 1e-15
# K'/K where 1 - c = c'²/2 is that, as c' = 4 exp(-π K/2K'); nearer than DOUBTFUL the guess cannot
# tell
NARROWEST_RATIO, DOUBTFUL = math.pi / math.log(8.0 / FULL_STICK), 1.05
# beyond it c = 4 exp(-π K'/2K) is lost even beside a double's smallest lengths; c² is a double
WIDEST_RATIO = 200.0
SETTLED, MOST_STEPS = 1e-13, 20  # of the search for K'/K: where a step ends it
TOGETHER = 2**13  # entries of a matrix that are computed at once
ALIKE = 1e-8  # the ratios that bound an eigenvalue, where one more step ends the iteration


@dataclass(frozen=True, eq=False)
class FlatPunch:
    """The solution of the eigenvalue problem, for P = 1 on |x| < 1.

    beta, friction      β > 0 and f
    bonded              whether the slip zone is narrower than FULL_STICK; f is then that which
                        makes it about so wide
    modulus             k = c, the half-width of the stick zone
    square, remainder   sn² and cn² at the nodes
    weight              of the rule for 2 cn^2θ dn^(2-2θ) du
    pressure            p(c sn u) at the nodes
    eigenvalue          λ
    """

    beta: float
    friction: float
    bonded: bool
    modulus: Modulus
    square: Array = field(repr=False)
    remainder: Array = field(repr=False)
    weight: Array = field(repr=False)
    pressure: Array = field(repr=False)
    eigenvalue: float

    @cached_property
    def theta(self) -> float:
        return math.atan(self.beta * self.friction) / math.pi

    @property
    def exponent(self) -> float:
        """h = 1/2 - θ, θ = arctan(βf)/π: p ~ (1 - x)^-h."""
        # Of a large βf, 1/2 - θ would lose digits
        return math.atan2(1.0, self.beta * self.friction) / math.pi

    @cached_property
    def kernel_of_one(self) -> Array:
        """K 1 at the nodes."""
        return sum_of_poles(*_poles(self.modulus, self.remainder), self.remainder, self.weight)


def nodes_for(ratio: float) -> int:
    """The number of nodes of a Gauss rule that resolves singularities at ±i ratio.

    It holds for even functions on (-1, 1).
    """
    return math.ceil(DIGITS / (4.0 * math.asinh(ratio))) + SPARE


def long_rule(
    ratio: float, a: float, b: float, digits: float = ACROSS
) -> tuple[Array, Array, Array]:
    """Nodes on (0, 1), their distances from 1, and weights for the powers a at 1 and b at 0.

    The nearest singularities are at half the interval's length times ratio.

    A long interval is cut, as few nodes cost less to find.
    """
    n = math.ceil(1.0 / ratio)
    nodes = math.ceil(digits / (2.0 * math.asinh(NEARER * min(n * ratio, 1.5)))) + SPARE
    if n == 1:
        return with_weight(nodes, a, b)
    ends = with_weight(nodes, 0.0, b), with_weight(nodes, a, 0.0)
    panels = (ends[0], *[with_weight(nodes, 0.0, 0.0)] * (n - 2), ends[1])
    x = np.concatenate([(k + panel.x) / n for k, panel in enumerate(panels)])
    rest = np.concatenate([(n - 1 - k + panel.rest) / n for k, panel in enumerate(panels)])
    return x, rest, np.concatenate([panel.weight / n for panel in panels])


def _kernel(modulus: Modulus, one: Array, other: Array) -> Array:
    """1/(1 - c² sn²u sn²u') from both cn²: nothing cancels as c approaches 1."""
    near, rise = _poles(modulus, one)
    kernel = rise[:, None] * other
    kernel += near[:, None]
    return np.divide(1.0, kernel, out=kernel)


def _poles(modulus: Modulus, one: Array) -> tuple[Array, Array]:
    """Its denominator as a linear function of the other cn²."""
    square = modulus.k**2
    return modulus.complement**2 + square * one, square * (1.0 - one)


def sum_of_poles(near: Array, rise: Array | float, remainder: Array, masses: Array) -> Array:
    """Σ masses/(near + rise remainder), of a few places at a time: larger matrices cost more."""
    rise = np.broadcast_to(rise, near.shape)
    total, step = np.empty(len(near)), max(1, TOGETHER // len(masses))
    for k in range(0, len(near), step):
        part = slice(k, k + step)
        poles = rise[part, None] * remainder
        poles += near[part, None]
        total[part] = np.divide(1.0, poles, out=poles) @ masses
    return total


def _quarter(ratio: float, theta: float) -> tuple[Array, Array, Array]:
    """Parts of the quarter period, what remains of it, and weights; K'/K is about ratio.

    The rule is for even functions with the power 2θ at the end.
    """
    if ratio < LONG:
        return long_rule(2.0 * ratio, 2.0 * theta, 0.0, OF_KERNEL)
    square, rest, weight = gauss_jacobi(nodes_for(NEARER * min(ratio, 1.5)), 2.0 * theta, -0.5)
    part = np.sqrt(square)
    return part, rest / (1.0 + part), 0.5 * weight * rest ** (-2.0 * theta)


class Trial(NamedTuple):
    """What -ε (2 + ε) exceeds β² by at some K'/K, and the punch with this stick zone."""

    missed: float
    punch: FlatPunch


def _at_ratio(
    tau: float, punch: tuple[float, float], near: float, before: FlatPunch | None
) -> Trial:
    """The punch of (β, f) at K'/K = τ, by the rule for `near`, from one by the same rule."""
    (beta, friction), modulus = punch, modulus_of_ratio(tau)
    theta = math.atan(beta * friction) / math.pi
    part, rest, weight = _quarter(near, theta)
    sn, cn, dn = elliptic_functions(modulus, part, rest)
    W = 2.0 * modulus.K * weight * cn ** (2.0 * theta) * dn ** (2.0 - 2.0 * theta)
    remainder = cn * cn
    start = 1.0 / dn if before is None else before.pressure
    kernel = _kernel(modulus, remainder, remainder)
    kernel *= W
    eigenvalue, v = _largest(kernel, start)
    v /= modulus.k ** (2.0 * theta) * (W @ v)
    part, rest, dx = double_exponential()
    _, cn, dn = elliptic_functions(modulus, part, rest)
    tested = dx * dn * sum_of_poles(*_poles(modulus, cn * cn), remainder, W * v)
    logarithm = np.log(modulus.k * (cn / dn) ** 2)
    epsilon = float(tested @ np.expm1(theta * logarithm)) / float(tested.sum())
    found = FlatPunch(beta, friction, False, modulus, sn * sn, remainder, W, v, eigenvalue)
    return Trial(-epsilon * (2.0 + epsilon) - beta * beta, found)


def _largest(matrix: Array, v: Array) -> tuple[float, Array]:
    """The largest eigenvalue of a positive matrix, and its positive eigenvector.

    The largest ratio of (matrix v)/v bounds it, and inverse iteration with this shift keeps v
    positive and converges quadratically (Noda 1971).
    """
    diagonal = matrix.reshape(-1)[:: len(v) + 1]
    own = diagonal.copy()
    for _ in range(MOST_STEPS):
        ratio = (matrix @ v) / v
        bound = float(ratio.max())
        diagonal[:] = own - bound
        v = -np.asarray(np.linalg.solve(matrix, v), dtype=float)
        diagonal[:] = own
        v /= v.max()
        if bound - float(ratio.min()) <= ALIKE * bound:
            break
    v = matrix @ v
    return float((v @ matrix @ v) / (v @ v)), v


@lru_cache(maxsize=1)
def double_exponential() -> tuple[Array, Array, Array]:
    """x, 1 - x and dx on (0, 1), for logarithms at the ends."""
    t = STEP * np.arange(-LAST, LAST + 1)
    e = np.exp(np.pi * np.sinh(t))
    x, rest = e / (1.0 + e), 1.0 / (1.0 + e)
    return x, rest, STEP * np.pi * np.cosh(t) * x * rest


@lru_cache(maxsize=8)
def flat_punch(beta: float, friction: float) -> FlatPunch:
    """The flat punch in partial slip; β > 0, f > 0.

    Where the slip zone would be narrower than FULL_STICK, friction is that which makes it about so
    wide: under a larger one the tractions differ only within such a distance of the edges.
    """
    phase = _phase(beta, friction)
    guess = min(phase / math.atan(friction), WIDEST_RATIO)
    if guess == WIDEST_RATIO:
        return _at_ratio(guess, (beta, friction), guess, None).punch
    if guess < DOUBTFUL * NARROWEST_RATIO:
        narrowest = NARROWEST_RATIO
        certain = guess < narrowest / DOUBTFUL
        if certain or _at_ratio(narrowest, (beta, friction), narrowest, None).missed > 0.0:
            friction = math.tan(phase / narrowest)
            friction = math.tan(_phase(beta, friction) / narrowest)
            return replace(_root(narrowest, beta, friction), bonded=True)
    return _root(guess, beta, friction)


def _phase(beta: float, friction: float) -> float:
    """About atan(f) K'/K: Goodman's β, corrected for larger constants by a fit to solutions."""
    square = beta * beta
    return beta * (1.0 + square * (0.5 + square / 3.0 + 0.054 * math.atan(friction) ** 2))


def _root(guess: float, beta: float, friction: float) -> FlatPunch:
    """The punch that meets the condition -ε (2 + ε) = β², by the secant method in ln K'/K."""
    place, slope, step, missed, punch = math.log(guess), 0.0, 0.0, math.inf, None
    # As K'/K is about β/arctan(f), and what is missed is a function of it and of βf, less β²
    rise = 2.0 / (1.0 + friction / ((1.0 + friction * friction) * math.atan(friction)))
    for _ in range(MOST_STEPS):
        before = missed
        missed, punch = _at_ratio(math.exp(place), (beta, friction), guess, punch)
        if missed == before:
            break
        if math.isfinite(before):
            slope = (before - missed) / step
        step = missed / (slope or rise * (missed + beta * beta))
        if abs(step) <= SETTLED:
            break
        place -= step
    assert punch is not None
    return punch
