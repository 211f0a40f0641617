"""Densities whose Cauchy integrals are known exactly, in 40 digits: the reference for solvers of
Cauchy equations.

    φ(x) = w(s) f(s),   w = (1 - s)^α (1 + s)^β,   α + β = -κ,   x = m + r s
    f a polynomial plus poles r/(s - p) off [-1, 1]

W(z) = (z - 1)^α (z + 1)^β has no cut but [-1, 1], where it jumps by 2i sin πα w, and so
(Muskhelishvili 1953, § 110)

    1/π ∫ w f/(z - t) dt  =  -(W f - what W f has at infinity and at the poles) / sin πα

On the interval W is w cos πα ± i w sin πα. Nothing here comes from the package under test.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

Number = Any
Array = NDArray[Any]
mp = mpmath.mp.clone()
mp.dps = 40


def exponent(a: Number, b: Number, bounded: bool) -> Number:
    """The exponent α of the distance from the right end: a sin πα + b cos πα = 0.

    It is in [0, 1) where the solution is bounded, and in (-1, 0) where it is not.
    """
    a, b = mp.mpmathify(a), mp.mpmathify(b)
    real = mp.im(a) == mp.im(b) == 0
    theta = (
        -mp.atan2(mp.re(b), mp.re(a)) / mp.pi
        if real
        else mp.log((a - 1j * b) / (a + 1j * b)) / (2j * mp.pi)
    )
    up = theta - mp.floor(mp.re(theta))
    return up if bounded else up - 1


def exponents(a: Number, b: Number, ends: tuple[bool, bool]) -> tuple[Number, Number]:
    """(α, β) for ends = (left bounded, right bounded); the left end mirrors the equation, b ->
    -b.
    """
    return exponent(a, b, ends[1]), exponent(a, -b, ends[0])


@dataclass(frozen=True)
class Manufactured:
    """`polynomial` low order first in s; `poles` as pairs (p, r)."""

    x1: float
    x2: float
    alpha: Number
    beta: Number
    polynomial: tuple[Number, ...] = (1.0,)
    poles: tuple[tuple[Number, Number], ...] = ()
    m: Number = field(init=False)
    r: Number = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "m", (mp.mpf(self.x1) + mp.mpf(self.x2)) / 2)
        object.__setattr__(self, "r", (mp.mpf(self.x2) - mp.mpf(self.x1)) / 2)

    @property
    def kappa(self) -> int:
        return -int(mp.nint(mp.re(self.alpha + self.beta)))

    def f(self, s: Number) -> Number:
        value = mp.mpf(0)
        for c in reversed(self.polynomial):
            value = value * s + mp.mpmathify(c)
        return value + sum(mp.mpmathify(r) / (s - mp.mpmathify(p)) for p, r in self.poles)

    def W(self, z: Number) -> Number:
        return mp.power(z - 1, self.alpha) * mp.power(z + 1, self.beta)

    @cached_property
    def at_infinity(self) -> dict[int, Number]:
        """Coefficients of W f, from z^(degree - κ) downwards to z^-2."""
        degree = len(self.polynomial) - 1
        size = max(degree - self.kappa, -1) + 3
        binomial = [
            [mp.binomial(e, k) * sign**k for k in range(size + 3)]
            for e, sign in ((self.alpha, -1), (self.beta, 1))
        ]
        w = [
            sum(binomial[0][j] * binomial[1][k - j] for j in range(k + 1)) for k in range(size + 3)
        ]
        f = [mp.mpmathify(c) for c in reversed(self.polynomial)]
        f += [
            sum(mp.mpmathify(r) * mp.mpmathify(p) ** k for p, r in self.poles)
            for k in range(size + 3)
        ]
        top = degree - self.kappa
        return (
            {top - k: sum(w[j] * f[k - j] for j in range(k + 1)) for k in range(top + 3)}
            if top >= -2
            else {}
        )

    @cached_property
    def at_poles(self) -> list[tuple[Number, Number]]:
        return [(mp.mpmathify(p), mp.mpmathify(r) * self.W(mp.mpmathify(p))) for p, r in self.poles]

    def subtracted(self, s: Number) -> Number:
        regular = sum((c * s**k for k, c in self.at_infinity.items() if k >= 0), mp.mpf(0))
        return regular + sum(residue / (s - p) for p, residue in self.at_poles)

    # -- what is compared -------------------------------------------------------------------------

    def value(self, x: Number) -> Number:
        s = (mp.mpf(x) - self.m) / self.r
        return mp.power(1 - s, self.alpha) * mp.power(1 + s, self.beta) * self.f(s)

    def value_at(self, to_right: Number, to_left: Number) -> Number:
        """At these distances from the ends."""
        right, left = mp.mpf(to_right) / self.r, mp.mpf(to_left) / self.r
        return (
            mp.power(right, self.alpha)
            * mp.power(left, self.beta)
            * self.f(left - 1 if left < right else 1 - right)
        )

    def cauchy(self, z: Number) -> Number:
        """1/π ∫ φ/(z - t) dt; on the interval its principal value."""
        s = (mp.mpmathify(z) - self.m) / self.r
        inside = mp.im(s) == 0 and abs(mp.re(s)) < 1
        Wf = mp.cospi(self.alpha) * self.value(z) if inside else self.W(s) * self.f(s)
        return (self.subtracted(s) - Wf) / mp.sinpi(self.alpha)

    @property
    def total(self) -> Number:
        residues = sum(residue for _, residue in self.at_poles)
        return self.r * mp.pi / mp.sinpi(self.alpha) * (residues - self.at_infinity.get(-1, 0))

    @property
    def moment(self) -> Number:
        residues = sum(residue * p for p, residue in self.at_poles)
        about_m = (
            self.r**2 * mp.pi / mp.sinpi(self.alpha) * (residues - self.at_infinity.get(-2, 0))
        )
        return about_m + self.m * self.total

    @property
    def intensities(self) -> tuple[Number, Number]:
        """lim φ (distance)^-exponent at the left and the right end."""
        left = mp.power(2, self.alpha) * self.f(mp.mpf(-1)) * self.r**-self.beta
        right = mp.power(2, self.beta) * self.f(mp.mpf(1)) * self.r**-self.alpha
        return left, right


def right_hand_side(
    densities: Sequence[Manufactured],
    a: Number,
    b: Number,
    kernels: Sequence[tuple[Number, Number]] = (),
) -> Callable[[Any], Array]:
    """g(x), vectorised, of a φ + b/π PV∫ φ/(t - x) dt + Σ c ∫ φ/(t - x - shift) dt for the sum φ;
    `kernels` as pairs (c, shift).

    On the interval itself a φ and the cotangent's part of the principal value cancel, and are left
    out: g is smooth.
    """
    a, b = mp.mpmathify(a), mp.mpmathify(b)

    def at(x: float) -> complex:
        place = mp.mpf(float(x))
        total = mp.mpf(0)
        for d in densities:
            s = (place - d.m) / d.r
            own = abs(s) <= 1
            total -= b * (d.subtracted(s) / mp.sinpi(d.alpha) if own else d.cauchy(place))
            total -= sum(
                mp.mpmathify(c) * mp.pi * d.cauchy(place + mp.mpmathify(shift))
                for c, shift in kernels
            )
        return complex(total)

    def g(x: Any) -> Array:
        values: Array = np.array([at(v) for v in np.ravel(x)], dtype=complex).reshape(np.shape(x))
        return (
            values
            if np.abs(values.imag).max(initial=0.0) > 1e-25 * np.abs(values).max(initial=1e-300)
            else values.real
        )

    return g


def needed(
    densities: Sequence[Manufactured], tol: float, g: Callable[[Any], Array] | None = None
) -> tuple[int, ...]:
    """How many coefficients of f (or of g) are above tol: those of its Chebyshev series, which
    decay as any Jacobi series of it do.
    """
    sizes, n = [], 160
    theta = np.pi * (np.arange(n) + 0.5) / n
    for d in densities:
        s = np.cos(theta)
        values = exact(d.f, s) if g is None else g(float(d.m) + float(d.r) * s)
        c = np.abs(np.cos(np.outer(np.arange(n), theta)) @ values)
        sizes.append(int(np.flatnonzero(c > tol * c.max())[-1]) + 1 if c.any() else 1)
    return tuple(sizes)


def exact(function: Callable[[Number], Number], x: Any) -> Array:
    return np.array([complex(function(mp.mpmathify(v))) for v in np.asarray(x).tolist()])
