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
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from sie.numerics.elliptic import Modulus, elliptic_functions, modulus_of_ratio
from sie.numerics.gauss_jacobi import gauss_jacobi

Array = NDArray[np.float64]

DIGITS = 38.0  # -ln of the error that a rule may leave
NEARER = 0.8  # of K'/K: the nearest singularity of weights and of what is derived from the solution
SPARE = 4
# Nodes of the double exponential rule for the logarithm in ε: its step, and where it is cut.
STEP, LAST = 0.09, 42
# Where 1 - c is less than this the punch sticks all over, to the resolution of doubles.
FULL_STICK = 1e-15
# K'/K where 1 - c = c'²/2 is that, as c' = 4 exp(-π K/2K'); nearer than DOUBTFUL the guess does not
# decide
NARROWEST_RATIO, DOUBTFUL = math.pi / math.log(8.0 / FULL_STICK), 1.3
# beyond it c = 4 exp(-π K'/2K) is lost even beside a double's smallest lengths
WIDEST_RATIO = 250.0
FIRST_STEP, SETTLED, MOST_STEPS = 0.02, 1e-14, 20


@dataclass(frozen=True, eq=False)
class FlatPunch:
    """The solution of the eigenvalue problem, for P = 1 on |x| < 1.

    beta, friction      β > 0 and f, such that 1 - c >= FULL_STICK
    modulus             k = c, the half-width of the stick zone
    square, remainder   sn² and cn² at the nodes
    weight              of the rule for 2 cn^2θ dn^(2-2θ) du
    pressure            p(c sn u) at the nodes
    eigenvalue          λ
    """

    beta: float
    friction: float
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
        return 0.5 - self.theta

    @cached_property
    def kernel_of_one(self) -> Array:
        """K 1 at the nodes."""
        one: Array = _kernel(self.modulus, self.remainder, self.remainder) @ self.weight
        return one


def nodes_for(ratio: float, digits: float = DIGITS) -> int:
    """How many nodes of a Gauss rule for even functions on (-1, 1) resolve singularities at ±i
    ratio.
    """
    return math.ceil(digits / (4.0 * math.asinh(ratio))) + SPARE


def _kernel(modulus: Modulus, one: Array, other: Array) -> Array:
    """1/(1 - c² sn²u sn²u') from both cn²: nothing cancels as c approaches 1."""
    sum_of_both = one[:, None] + other - one[:, None] * other
    kernel: Array = 1.0 / (modulus.complement**2 + modulus.k**2 * sum_of_both)
    return kernel


def _at_ratio(tau: float, beta: float, friction: float, n: int) -> tuple[float, FlatPunch]:
    """-ε (2 + ε) at K'/K = τ, and the punch with this stick zone."""
    theta = math.atan(beta * friction) / math.pi
    modulus = modulus_of_ratio(tau)
    square, rest, weight = gauss_jacobi(n, 2.0 * theta, -0.5)
    part = np.sqrt(square)
    sn, cn, dn = elliptic_functions(modulus, part, rest / (1.0 + part))
    W = modulus.K * weight * (cn / rest) ** (2.0 * theta) * dn ** (2.0 - 2.0 * theta)
    root, remainder = np.sqrt(W), cn * cn
    kernel = _kernel(modulus, remainder, remainder)
    values, vectors = np.linalg.eigh(root[:, None] * kernel * root)
    v = np.abs(vectors[:, -1]) / root
    v /= modulus.k ** (2.0 * theta) * (W @ v)
    part, rest, dx = double_exponential()
    _, cn, dn = elliptic_functions(modulus, part, rest)
    tested = dx * dn * (_kernel(modulus, cn * cn, remainder) @ (W * v))
    logarithm = np.log(modulus.k * (cn / dn) ** 2)
    epsilon = float(tested @ np.expm1(theta * logarithm)) / float(tested.sum())
    punch = FlatPunch(beta, friction, modulus, sn * sn, remainder, W, v, float(values[-1]))
    return -epsilon * (2.0 + epsilon), punch


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

    Where the slip zone would be narrower than FULL_STICK, friction is that which makes it so wide:
    under a larger one the tractions differ only within such a distance of the edges.
    """
    # Goodman's β/f, corrected for large ones: the oscillation of a bonded edge spans the phase
    # atan f
    guess = min(math.atanh(beta) / math.atan(friction), WIDEST_RATIO)
    n = nodes_for(NEARER * min(guess, 1.5))
    if guess == WIDEST_RATIO:
        return _at_ratio(guess, beta, friction, n)[1]
    if guess < DOUBTFUL * NARROWEST_RATIO:
        n = nodes_for(NEARER * NARROWEST_RATIO)
        if _at_ratio(NARROWEST_RATIO, beta, friction, n)[0] > beta * beta:
            return _root(
                math.log(math.tan(math.atanh(beta) / NARROWEST_RATIO)),
                beta,
                lambda log_f: _at_ratio(NARROWEST_RATIO, beta, math.exp(log_f), n),
            )
    return _root(
        math.log(guess), beta, lambda log_tau: _at_ratio(math.exp(log_tau), beta, friction, n)
    )


def _root(start: float, beta: float, at: Callable[[float], tuple[float, FlatPunch]]) -> FlatPunch:
    """The punch that meets the condition -ε (2 + ε) = β², by the secant method."""
    before, missed_before = start, at(start)[0] - beta * beta
    after = start + FIRST_STEP
    for _ in range(MOST_STEPS):
        value, punch = at(after)
        missed = value - beta * beta
        if abs(after - before) <= SETTLED or missed == missed_before:
            break
        step = missed * (after - before) / (missed - missed_before)
        before, missed_before, after = after, missed, after - step
    return punch
