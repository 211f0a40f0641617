"""What both equations ask of dissimilar bodies whose contact may be taken to stick on its left.

Where h' is known on the contact [x1, x2] and the slip gradient γ on [x1, e2], and q = f p beyond,
the printed equations (1) and (12) are tested with p̂, q̂ that obey their adjoint ones for h' = 0,

    x < e2   H p̂ = β q̂,  H q̂ = -β p̂,            x > e2   q̂ = 0,  H p̂ + f H q̂ = -β f p̂.

With t = (x - x1)/(x2 - x) (x2 - e2)/(e2 - x1) the potential Φ = F p̂ + i F q̂ is multiplied by
constants around t = 0, 1, ∞ only. Two of them, k = 0 and 1, are with tanh πη = β, tan πθ = β f

    Φ = C (-t)^(-1/2 + iη) ₂F₁(a, b; 1 + 2iη; t),     a = 3/2 - k + iη,  b = k - θ + iη,

C of such a phase that Φ next to infinity is real but for a multiple of (i - f)/t^(2 - k). Then

    ∫(p̂ E*/2 h' + q̂ γ) dx/(x2 - x) = 0,       ∫(p̂ E*/2 h' + q̂ γ) dx = P Re Φ + Q Im Φ at x = ∞.

Neither p nor q occurs: the conditions check edges, zones, γ and loads. Under P alone, Q = 0, the
left slip zone counts as known γ. Source: Abramowitz, Stegun, 15.3.3-15.3.7.
"""

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import loggamma

Array = NDArray[np.floating[Any]]
Function = Callable[[Array], Array]

TERMS = 60  # of a power series, |z| <= 1/2
NODES, LEVELS, RATIO, CROWDED = 16, 18, 0.25, 8.0  # of panels towards both ends of an interval


class BondedEdge:
    """p̂ and q̂ by t or 1/t, given with their distances from 1."""

    def __init__(self, beta: float, friction: float) -> None:
        self.beta, self.eta = beta, math.atanh(beta) / math.pi
        self.theta, self.c = math.atan(beta * friction) / math.pi, 1.0 + 2.0j * self.eta
        self.ab = [(1.5 - k + 1j * self.eta, k - self.theta + 1j * self.eta) for k in (0, 1)]
        self.sizes = [_gammas((self.c, a - b), (a, self.c - b)) for a, b in self.ab]

    def in_stick(self, k: int, t: Array, rest: Array) -> tuple[Array, Array]:
        """p̂ and q̂ where 0 < t < 1."""
        Phi = self._Phi(k, np.log(t) - 1j * math.pi) * _hypergeometric(*self.ab[k], self.c, t, rest)
        both = 1j * Phi / (1.0 + self.beta)
        return both.real, both.imag

    def in_slip(self, k: int, v: Array, rest: Array) -> Array:
        """p̂ where 0 < v = 1/t < 1."""
        a, b = self.ab[k]
        series = _hypergeometric(b, b.conjugate(), b - a + 1.0, v, rest).real
        strength = (-1.0) ** (k + 1) * abs(self.sizes[k]) * math.cos(math.pi * self.theta)
        values: Array = strength * v ** (0.5 + b.real) * series
        return values

    def beside(self, k: int, m: float) -> complex:
        """Φ at t = -m."""
        a, b = self.ab[k]
        rest = np.array([1.0 / (1.0 + m)])
        series = _hypergeometric(a, self.c - b, self.c, m * rest, rest)
        return complex((self._Phi(k, np.log(np.array([m]))) * rest**a * series)[0])

    def _Phi(self, k: int, log: NDArray[Any]) -> NDArray[Any]:
        """C exp((-1/2 + iη) log)."""
        size = self.sizes[k]
        values: NDArray[Any] = abs(size) / size * np.exp((-0.5 + 1j * self.eta) * log)
        return values


def missed(
    material: tuple[float, float],
    zones: tuple[float, float, float],
    loads: tuple[float, float],
    known: tuple[Function, Function],
    marks: tuple[float, ...],
) -> Array:
    """What the four conditions miss, over the sizes of their terms.

    material    β > 0 and f
    zones       x1, e2, x2
    loads       P and Q
    known       E*/2 h' and γ
    marks       where these are not smooth
    """
    functions, (x1, e2, x2), (slope, gamma) = BondedEdge(*material), zones, known
    total, size = np.zeros(4), np.zeros(4)
    ends = sorted({x1, e2, x2, *(x for x in marks if x1 < x < x2)})
    for lo, hi in itertools.pairwise(ends):
        left, right, weight = _rule(hi - lo)
        x = np.where(left < right, lo + left, hi - right)
        to_x1, to_x2 = (lo - x1) + left, (x2 - hi) + right
        over, under = to_x1 * (x2 - e2), to_x2 * (e2 - x1)
        apart = (x2 - x1) * ((e2 - hi) + right if hi <= e2 else (lo - e2) + left)
        for k in (0, 1):
            if hi <= e2:
                p, q = functions.in_stick(k, over / under, apart / under)
                terms = p * slope(x), q * gamma(x)
            else:
                terms = (
                    functions.in_slip(k, under / over, apart / over) * slope(x),
                    np.zeros(len(x)),
                )
            for row, factor in ((k, weight * (x2 - x1) / to_x2), (2 + k, weight)):
                total[row] += sum(float(factor @ term) for term in terms)
                size[row] += sum(float(factor @ np.abs(term)) for term in terms)
    for k in (0, 1):
        Phi = functions.beside(k, (x2 - e2) / (e2 - x1))
        total[2 + k] -= loads[0] * Phi.real + loads[1] * Phi.imag
    return total / size


def _rule(length: float) -> tuple[Array, Array, Array]:
    """Distances from both ends, and weights, on panels that shrink towards them."""
    x, w = np.polynomial.legendre.leggauss(NODES)
    x, w = 0.5 * (1.0 + x), 0.5 * w
    ends = 0.5 * length * np.append(0.0, RATIO ** np.arange(LEVELS, -1.0, -1.0))
    near, weight = ends[:-1, None] + np.diff(ends)[:, None] * x, np.diff(ends)[:, None] * w
    # The functions may be as infinite as 1/distance, but for a power: its nodes crowd at the end
    near[0], weight[0] = ends[1] * x**CROWDED, ends[1] * CROWDED * x ** (CROWDED - 1.0) * w
    near, weight = near.ravel(), weight.ravel()
    return (
        np.append(near, length - near),
        np.append(length - near, near),
        np.append(weight, weight),
    )


def _hypergeometric(a: complex, b: complex, c: complex, z: Array, rest: Array) -> NDArray[Any]:
    """₂F₁ at 0 < z < 1, rest = 1 - z; c - a - b is no integer."""
    values = np.empty(len(z), dtype=complex)
    near = z <= 0.5
    values[near] = _series(a, b, c, z[near])
    e, y = c - a - b, rest[~near]
    one = _gammas((c, e), (c - a, c - b)) * _series(a, b, 1.0 - e, y)
    values[~near] = one + y**e * _gammas((c, -e), (a, b)) * _series(c - a, c - b, 1.0 + e, y)
    return values


def _series(a: complex, b: complex, c: complex, z: Array) -> NDArray[Any]:
    total, term = np.ones(len(z), dtype=complex), np.ones(len(z), dtype=complex)
    for n in range(TERMS):
        term = term * ((a + n) * (b + n) / ((c + n) * (n + 1.0))) * z
        total = total + term
    return total


def _gammas(over: tuple[complex, ...], under: tuple[complex, ...]) -> complex:
    """The product of Γ over that of other Γ."""
    logs = sum(loggamma(complex(z)) for z in over) - sum(loggamma(complex(z)) for z in under)
    return complex(np.exp(logs))
