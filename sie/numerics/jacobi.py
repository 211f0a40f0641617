"""Jacobi polynomials for the weights of Cauchy equations, with real or complex exponents.

The weight w(s) = (1 - s)^α (1 + s)^β on [-1, 1] with α + β = -κ in {-1, 0, 1}: then (z - 1)^α (z +
1)^β has no cut but [-1, 1], and everything about w is elementary. With orthonormal p_n = π_n / ν_n
(∫ w p_j p_k = δ_jk; π_n monic) and p̃_n those of 1/w,

    1/π PV∫ w p_n/(s - t) dt  =  cosec(πα) p̃_{n-κ}(s) - cot(πα) w(s) p_n(s)
    1/π ∫ w p_n/(z - t) dt    =  cosec(πα) (p̃_{n-κ}(z) - (z - 1)^α (z + 1)^β p_n(z))

p̃_{-1} = 0. The four Chebyshev weights are the case α, β = ±1/2. For complex exponents the products
are bilinear, not Hermitian, and the Gauss nodes leave the real axis: polynomials may be integrated
there, but a user's function may not. So `analysis` samples on real nodes.

Sources: Tricomi (1957); Erdogan, Gupta & Cook, in Methods of Analysis and Solutions of Crack
Problems (1973); Gautschi (1981) for the continued fraction; Mason & Handscomb (2003).
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .interval import EPS

if TYPE_CHECKING:
    from .jacobi_weight import Exponent, Weight

Array = NDArray[Any]

# A series is continued off its interval while it grows by less than this factor; from there the
# continued fraction takes over.
GROWTH = 30.0
POLISHED = 8.0 * EPS
MAX_SWEEPS = 40
# Terms of the continued fraction, which serves only where a series of that many would grow
MOST_STEPS = 20_000


class Recurrence(NamedTuple):
    """b_{k+1} p_{k+1} = (s - a_k) p_k - b_k p_{k-1}, p_0 = first, in extended precision.

    The coefficients are a_0 ... a_n and b_0 = 0, b_1 ... b_n.
    """

    a: Array
    b: Array
    first: Any

    def rounded(self, kind: Any) -> Recurrence:
        return Recurrence(self.a.astype(kind), self.b.astype(kind), kind(self.first))


@lru_cache(maxsize=128)
def recurrence(weight: Weight, n: int) -> Recurrence:
    return _extended_recurrence(weight, n).rounded(weight.kind)


def _extended_recurrence(weight: Weight, n: int) -> Recurrence:
    kind: Any = np.longdouble if weight.is_real else np.clongdouble
    alpha, beta, total = kind(weight.alpha), kind(weight.beta), -weight.kappa
    if abs(alpha) < abs(beta):  # the smaller one has more digits
        beta = total - alpha
    else:
        alpha = total - beta
    a = np.empty(n + 1, dtype=kind)
    square = np.zeros(n + 1, dtype=kind)
    k = np.arange(1, n + 1, dtype=np.longdouble)  # k^4 is no int64
    a[0] = (beta - alpha) / (total + 2)
    a[1:] = (beta - alpha) * total / ((2 * k + total) * (2 * k + total + 2))
    if n:
        ends = alpha * beta if weight.kappa == 1 else (1 + alpha) * (1 + beta)
        square[1] = 4 * ends / ((2 + total) ** 2 * (3 + total))
        k = k[1:]
        square[2:] = (
            4
            * k
            * (k + alpha)
            * (k + beta)
            * (k + total)
            / ((2 * k + total) ** 2 * (2 * k + total + 1) * (2 * k + total - 1))
        )
    return Recurrence(a, np.sqrt(square), 1 / np.sqrt(kind(weight.total)))


@lru_cache(maxsize=64)
def second_sign(weight: Weight) -> float:
    """p̃_{n-κ} of the module's docstring over that of the inverse weight's own recurrence.

    It is +1 or -1, because complex square roots have two branches.
    """
    low, high = (weight, weight.inverse) if weight.kappa >= 0 else (weight.inverse, weight)
    first = recurrence(low, 1)
    norm = first.b[1] / first.first if weight.kappa else 1.0 / first.first
    return float(round((1.0 / (recurrence(high, 1).first * norm)).real))


def first_moment(weight: Weight) -> tuple[Any, Any]:
    """∫ w p_n (1 + s) ds for n = 0 and 1; those of higher n vanish."""
    r = recurrence(weight, 1)
    return (1.0 + r.a[0]) / r.first, r.b[1] / r.first


def polynomials(weight: Weight, n: int, s: Array) -> Array:
    """p_0(s) ... p_{n-1}(s), stacked along a new first axis; in extended precision if s is."""
    extended = s.dtype in (np.longdouble, np.clongdouble)
    r = _extended_recurrence(weight, n) if extended else recurrence(weight, n)
    p = np.empty((n, *s.shape), dtype=np.result_type(r.a, s))
    if n:
        p[0] = r.first
    for k in range(n - 1):
        p[k + 1] = (s - r.a[k]) * p[k]
        if k:
            p[k + 1] -= r.b[k] * p[k - 1]
        p[k + 1] /= r.b[k + 1]
    return p


def evaluate(weight: Weight, c: Array, s: Any) -> Any:
    """Σ c_n p_n(s) by Clenshaw's recurrence; s real or complex, any shape."""
    n = len(c)
    if n == 0:
        return 0.0 * s
    r = recurrence(weight, n)
    high, higher = c[-1] + 0.0 * s, 0.0
    for k in range(n - 2, -1, -1):
        high, higher = (
            c[k] + (s - r.a[k]) / r.b[k + 1] * high - r.b[k + 1] / r.b[k + 2] * higher,
            high,
        )
    return r.first * high


def derivative(weight: Weight, c: Array, s: Array) -> Array:
    """Σ c_n p_n'(s), at points on [-1, 1]."""
    n = len(c)
    r = recurrence(weight, n)
    p, slope = np.full(s.shape, r.first, dtype=r.a.dtype), np.zeros(s.shape, dtype=r.a.dtype)
    before, slope_before = np.zeros_like(p), np.zeros_like(p)
    total = np.zeros(s.shape, dtype=np.result_type(c, p))
    for k in range(n - 1):
        following = ((s - r.a[k]) * p - r.b[k] * before) / r.b[k + 1]
        slope_before, slope = slope, ((s - r.a[k]) * slope + p - r.b[k] * slope_before) / r.b[k + 1]
        before, p = p, following
        total += c[k + 1] * slope
    return total


def conjugate(weight: Weight, c: Array) -> Array:
    """The coefficients in p̃ of Σ c_n p̃_{n-κ}, with this module's sign of p̃."""
    sign = second_sign(weight)
    if weight.kappa == 1:
        return sign * c[1:]
    return sign * np.concatenate((np.zeros(-weight.kappa, dtype=c.dtype), c))


# -- Gauss quadrature ------------------------------------------------------------------------------


@lru_cache(maxsize=64)
def gauss(weight: Weight, n: int) -> tuple[Array, Array]:
    """Gauss-Jacobi nodes, ascending (by their real parts), and weights, to rounding.

    Both are complex for complex exponents.
    """
    s, w = _extended_gauss(weight, n)
    nodes, weights = s.astype(weight.kind), w.astype(weight.kind)
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


@lru_cache(maxsize=32)
def _extended_gauss(weight: Weight, n: int) -> tuple[Array, Array]:
    """The same before rounding.

    Asymptotic guesses; Ehrlich-Aberth sweeps, in which no two can fall on the same root; a last
    Newton step and Christoffel's weights 1 / Σ p_k² in extended precision.
    """
    if weight.is_chebyshev:
        return _chebyshev(weight, n)
    k = np.arange(n, 0, -1)
    s = np.cos((k - 0.25 + 0.5 * weight.alpha) * np.pi / (n + 0.5 * (1.0 - weight.kappa)))
    coarse, fine = recurrence(weight, n), _extended_recurrence(weight, n)
    for _ in range(MAX_SWEEPS):
        value, slope, _ = _value_and_slope(coarse, n, s)
        step = value / slope
        apart = s[:, None] - s
        np.fill_diagonal(apart, np.inf)
        step = step / (1.0 - step * (1.0 / apart).sum(axis=1))
        s = s - step
        if np.abs(step).max() <= POLISHED:
            break
    s = s.astype(fine.a.dtype)
    value, slope, _ = _value_and_slope(fine, n, s)
    s = s - value / slope
    return s, 1.0 / _value_and_slope(fine, n, s)[2]


def _chebyshev(weight: Weight, n: int) -> tuple[Array, Array]:
    """The four Chebyshev rules: zeros at equal angles.

    They are computed as sines, so that they are symmetric where the weight is.
    """
    a, b = weight.alpha.real, weight.beta.real
    step = 4.0 * np.arctan(np.longdouble(1.0)) / (n + 0.5 * (a + b + 1.0))
    from_left = step * (np.arange(n) + (0.75 + 0.5 * b))
    from_middle = step * (np.arange(n) - 0.5 * (n - 1) + 0.25 * (b - a))
    ends = (2.0 * np.sin(0.5 * from_left) ** 2) ** (b + 0.5) * (
        2.0 * np.cos(0.5 * from_left) ** 2
    ) ** (a + 0.5)
    return np.sin(from_middle), step * ends


def _value_and_slope(r: Recurrence, n: int, s: Array) -> tuple[Array, Array, Array]:
    """p_n, p_n' and Σ_{k<n} p_k²."""
    before, p = np.zeros_like(s), np.full_like(s, r.first)
    slope_before, slope = np.zeros_like(s), np.zeros_like(s)
    squares = p * p
    for k in range(n):
        following = ((s - r.a[k]) * p - r.b[k] * before) / r.b[k + 1]
        slope_before, slope = slope, ((s - r.a[k]) * slope + p - r.b[k] * slope_before) / r.b[k + 1]
        before, p = p, following
        if k < n - 1:
            squares += p * p
    return p, slope, squares


@lru_cache(maxsize=32)
def analysis(weight: Weight, n: int) -> tuple[Array, Array]:
    """Real nodes s_i and the matrix A (n, n) with ∫ w f p_k ds = Σ_i f(s_i) A_ik.

    This holds for polynomials f up to degree n - 1.

    The same sums are the coefficients of the interpolant, f = Σ_k p_k Σ_i f(s_i) A_ik. For real
    exponents A_ik = w_i p_k(s_i), of Gauss. For complex ones the nodes are those of |w|, and
    complex Gauss quadrature turns the one family of polynomials into the other. Nodes and
    polynomials are rounded at the end only: next to an end a rounded node costs n² digits of p_n,
    but none of f.
    """
    s, w = _extended_gauss(weight.real, n)
    A = (w[:, None] * polynomials(weight.real, n, s).T).astype(float)
    if not weight.is_real:
        at, w = _extended_gauss(weight, n)
        real = (w * polynomials(weight.real, n, at)).astype(complex)
        own = polynomials(weight, n, at).astype(complex)
        A = A @ (real @ own.T)
    nodes = s.astype(float)
    nodes.flags.writeable = False
    A.flags.writeable = False
    return nodes, A


# -- Cauchy integrals ------------------------------------------------------------------------------


def second(weight: Weight, c: Array, s: Array) -> Array:
    """cosec(πα) Σ c_n p̃_{n-κ}: the part of the Cauchy integral of w Σ c_n p_n that has no cut."""
    out: Array = evaluate(weight.inverse, conjugate(weight, c), s) / weight.sine
    return out


def cut(weight: Weight, value: Array, side: int) -> Array:
    """cot(πα) φ + i side φ, the part of the Cauchy integral with a cut, on the interval.

    side is 1 from y > 0, -1 from y < 0, and 0 for the principal value.
    """
    factor = weight.cotangent + 1j * side if side else weight.cotangent
    return _product(factor, value) if factor else np.zeros_like(value)


def _product(factor: Exponent, value: Array) -> Array:
    """factor times value, where the value is infinite in some of its parts at a singular end."""
    finite = np.isfinite(value)
    out: Array = factor * np.where(finite, value, 0.0)
    if not finite.all():
        endless = value[~finite]
        out[~finite] = infinite(factor * np.sign(endless.view(float)).view(endless.dtype))
    return out


def infinite(direction: Array) -> Array:
    """Infinity in each part, real and imaginary, of `direction` that is not zero.

    A product would make the other parts nan.
    """
    parts = np.ascontiguousarray(direction).view(float)
    out: Array = np.where(parts == 0.0, 0.0, np.copysign(np.inf, parts)).view(direction.dtype)
    return out


def cauchy(weight: Weight, c: Array, z: Array, right: Array, left: Array) -> Array:
    """1/π ∫ w Σ c_n p_n/(z - t) dt off the interval; right = z - 1 and left = z + 1.

    Both distances are given, for their accuracy.

    Near the interval by the closed form of the module's docstring; further out, where that cancels,
    by the continued fraction of the functions of the second kind.
    """
    out = np.empty(z.shape, dtype=complex)
    rho = bernstein(z, right, left)
    near = np.log(rho) <= math.log(GROWTH) / (len(c) + 1)
    if near.any():
        z_near, left_near = z[near], left[near]
        root = (right[near] / left_near) ** weight.alpha * left_near**-weight.kappa
        out[near] = second(weight, c, z_near) - root * evaluate(weight, c, z_near) / weight.sine
    if not near.all():
        out[~near] = _continued_fraction(weight, c, z[~near], float(rho[~near].min())) / np.pi
    return out


def bernstein(z: Array, right: Array, left: Array) -> Array:
    """The parameter ρ > 1 of the ellipse with foci ±1 through z.

    A ratio is negative on the interval only, whatever the signs of zeros.
    """
    rho: Array = np.abs(z + left * np.sqrt(right / left))
    return rho


def _continued_fraction(weight: Weight, c: Array, z: Array, rho: float) -> Array:
    """Σ c_n q_n, q_n = ∫ w p_n/(z - t) dt, the minimal solution of the recurrence.

    It is computed backwards from a degree beyond which all terms are below rounding.
    """
    extra = math.log(1.0 / EPS) / (2.0 * math.log(rho))
    steps = len(c) + min(math.ceil(extra), MOST_STEPS) + 2
    r = recurrence(weight, steps)
    ratio, total = np.zeros_like(z), np.zeros_like(z)
    for k in range(steps - 1, 0, -1):
        ratio = r.b[k] / (z - r.a[k] - r.b[k + 1] * ratio)  # q_k / q_{k-1}
        total = ratio * ((c[k] if k < len(c) else 0.0) + total)
    first = 1.0 / (r.first * (z - r.a[0] - r.b[1] * ratio))
    out: Array = first * (c[0] + total)
    return out
