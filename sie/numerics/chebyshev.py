"""Chebyshev series: points, transforms, evaluation, chopping.

A series c stands for Σ c_n T_n(s), s in [-1, 1]; arrays of series have the degree along the last
axis. The points are those of the first kind, s_k = cos((k + 1/2) π / N), which avoid the ends: a
slope may be singular there.

Sources: Mason & Handscomb, Chebyshev Polynomials (2003); Trefethen, Approximation Theory and
Approximation Practice (2013).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHORT = 12  # points up to which a matrix is faster than an FFT


@lru_cache(maxsize=64)
def points(n: int) -> Array:
    """The n Chebyshev points of the first kind, ascending, symmetric to the last bit."""
    s = np.sin(np.pi * np.arange(1 - n, n, 2) / (2 * n))
    s.flags.writeable = False
    return s


def charges(n: int) -> Array:
    """The charges on `points(n)` whose moments below n are A, as a matrix (moment, point).

    They are Q_i = 2/n Σ' A_m T_m(v_i).

    T_m(v_i) = cos(m (i + 1/2) π / n) with the angle reduced as an integer: a recurrence would lose
    n² ulp at the ends.
    """
    quarter = np.outer(np.arange(n), 2 * np.arange(n, 0, -1) - 1) % (4 * n)
    Q: Array = np.cos(np.pi / (2 * n) * quarter) * (2.0 / n)
    Q[0] *= 0.5
    return Q


def transform(values: Array) -> Array:
    """Coefficients of the interpolant through `values` at `points(n)`, along the last axis.

    It is a DCT by one complex FFT of length n.
    """
    n = values.shape[-1]
    if n <= SHORT:
        short: Array = values @ _matrix(n)
        return short
    v = values[..., ::-1]
    folded = np.concatenate((v[..., ::2], v[..., 1::2][..., ::-1]), axis=-1)
    c: Array = (np.fft.fft(folded, axis=-1) * _twiddle(n)).real
    return c


@lru_cache(maxsize=16)
def _matrix(n: int) -> Array:
    k, theta = np.arange(n), np.pi * (np.arange(n, 0, -1) - 0.5) / n
    m: Array = np.cos(theta[:, None] * k) * (2.0 / n)
    m[:, 0] *= 0.5
    return m


@lru_cache(maxsize=64)
def _twiddle(n: int) -> NDArray[np.complex128]:
    t: NDArray[np.complex128] = np.exp(-0.5j * np.pi * np.arange(n) / n) * (2.0 / n)
    t[0] *= 0.5
    return t


def evaluate(c: Array, s: Any) -> Any:
    """Σ c_n T_n(s) by Clenshaw's recurrence; s real or complex, any shape."""
    if len(c) == 1:
        return c[0] + 0.0 * s
    if len(c) == 2:
        return c[0] + c[1] * s
    twice = 2.0 * s
    high, higher = c[-1], 0.0
    for a in c[-2:0:-1]:
        high, higher = a + twice * high - higher, high
    return c[0] + s * high - higher


def evaluate_second_kind(c: Array, s: Any) -> Any:
    """Σ c_n U_n(s) by Clenshaw's recurrence; s real or complex, any shape.

    The result of a constant is a scalar.
    """
    if len(c) <= 1:
        return c[0] if len(c) else 0.0
    twice = 2.0 * s
    high, higher = c[-1] + 0.0 * s, 0.0
    for a in c[-2::-1]:
        high, higher = a + twice * high - higher, high
    return high


def polynomials(n: int, s: Array) -> Array:
    """T_0(s) ... T_{n-1}(s), stacked along a new first axis."""
    t = np.empty((n, *s.shape))
    t[0] = 1.0
    if n > 1:
        t[1] = s
    for k in range(2, n):
        t[k] = 2.0 * s * t[k - 1] - t[k - 2]
    return t


def antiderivative(c: Array) -> Array:
    """Coefficients of ∫_{-1}^s Σ c_n T_n, along the last axis."""
    n = c.shape[-1]
    padded = np.concatenate((c, np.zeros((*c.shape[:-1], 2))), axis=-1)
    k = np.arange(1, n + 1)
    out = np.zeros((*c.shape[:-1], n + 1))
    out[..., 1:] = (padded[..., :n] - padded[..., 2 : n + 2]) / (2 * k)
    out[..., 1] += 0.5 * c[..., 0]  # T_0 integrates to T_1, not to T_1 / 2
    out[..., 0] = -(out[..., 1:] * (-1.0) ** k).sum(axis=-1)
    return out


def quotient(c: Array, s: Array, t: Array) -> Array:
    """(Σ c_n T_n(t) - Σ c_n T_n(s)) / (t - s) for arrays s and t, however near to each other."""
    b, b_next = np.zeros_like(s), np.zeros_like(s)
    value, before, spare = np.zeros_like(t), np.zeros_like(t), np.empty_like(t)
    twice = 2.0 * t
    for a in c[:0:-1].tolist():
        np.multiply(twice, value, out=spare)
        spare -= before
        spare += 2.0 * b
        value, before, spare = spare, value, before
        b, b_next = a + 2.0 * s * b - b_next, b
    value *= t
    value -= before
    value += b
    return value


def divided(c: Array, end: float) -> Array:
    """(Σ c_n T_n(s) - Σ c_n T_n(end)) / (s - end), end = ±1, in T_j(s), along the last axis.

    T_n contributes 2 U_{n-1-j}(end), half of it for j = 0.
    """
    n = c.shape[-1]
    U = np.arange(1, n) * end ** np.arange(n - 1)
    d = np.zeros((*c.shape[:-1], max(n - 1, 0)))
    for j in range(n - 1):
        d[..., j] = 2.0 * (c[..., j + 1 :] @ U[: n - 1 - j])
    d[..., :1] *= 0.5
    return d


def second_kind_derivative(q: Array) -> Array:
    """U-coefficients of the derivative of Σ q_m U_m, along the last axis.

    The derivative of U_m is 2 Σ (j + 1) U_j over j = m - 1, m - 3, ...
    """
    d = np.zeros((*q.shape[:-1], max(q.shape[-1] - 1, 0)))
    for j in range(d.shape[-1]):
        d[..., j] = 2.0 * (j + 1) * q[..., j + 1 :: 2].sum(axis=-1)
    return d


def chopped_length(c: Array, floor: float) -> int:
    """The number of coefficients of c up to the last above `floor` (at least one is kept)."""
    matter = np.flatnonzero(np.abs(c) > floor)
    return int(matter[-1]) + 1 if matter.size else 1


def reach(c: Array, growth: float) -> Array:
    """The Bernstein radius up to which each series (K, N) can be continued beyond [-1, 1].

    It is the largest ρ with Σ|c_n| ρ^n <= growth max|c|.
    """
    size = np.abs(c)
    candidates, powers = _candidates(c.shape[-1], growth)
    fits = powers @ size.T <= growth * size.max(axis=-1)
    rho: Array = candidates[np.maximum(fits.sum(axis=0) - 1, 0)]
    return rho


@lru_cache(maxsize=64)
def _candidates(n: int, growth: float) -> tuple[Array, Array]:
    rho = np.geomspace(1.0, growth, 64)
    with np.errstate(over="ignore"):
        # Finite, so that a zero coefficient stays zero.
        powers = np.minimum(rho[:, None] ** np.arange(n), 1e280)
    return rho, powers


@lru_cache(maxsize=64)
def gauss_legendre(n: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes g in (0, 1), ascending, and weights that sum to 1, both to rounding.

    Newton on the recurrence in extended precision: NumPy's weights are off by up to 1e-12 where
    they are small.
    """
    k = np.arange(1, n + 1, dtype=np.longdouble)
    x = -np.cos(np.pi * (k - 0.25) / (n + 0.5))
    # Quadratic convergence from four digits; the last pass evaluates the weights at the root.
    for _ in range(5):
        before, at = np.ones_like(x), x
        for j in range(2, n + 1):
            before, at = at, ((2 * j - 1) * x * at - (j - 1) * before) / j
        x = x - at * (1 - x * x) / (n * (before - x * at))
    g = np.asarray(0.5 * (1 + x), dtype=float)
    w = np.asarray((1 - x * x) / (n * before) ** 2, dtype=float)
    g.flags.writeable = w.flags.writeable = False
    return g, w


@lru_cache(maxsize=8)
def legendre(n: int) -> Array:
    """Values at the n Gauss nodes to Legendre coefficients, as a matrix (n, n)."""
    g, w = gauss_legendre(n)
    P = np.polynomial.legendre.legvander(2.0 * g - 1.0, n - 1)
    matrix = P * w[:, None] * (2.0 * np.arange(n) + 1.0)
    matrix.flags.writeable = False
    return matrix


def lower_bound(values: Array) -> Array:
    """Below all of a polynomial that has these values (m, n) at Gauss nodes."""
    c = values @ legendre(values.shape[1])
    return np.asarray(c[:, 0] - np.abs(c[:, 1:]).sum(axis=1))
