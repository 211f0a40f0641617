"""The weights (1 - s)^α (1 + s)^β of Cauchy equations, with α + β = -κ in {-1, 0, 1}.

The exponents are real, or complex where a and b of the equation have different phases.
"""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .interval import EPS

Array = NDArray[Any]
Exponent = float | complex

PHASE = 4.0 * EPS  # an imaginary part of a/b below it is rounding of constants of one phase


class Weight(NamedTuple):
    """(1 - s)^alpha (1 + s)^beta with alpha + beta = -kappa."""

    alpha: Exponent
    beta: Exponent
    kappa: int  # the index

    @property
    def inverse(self) -> Weight:
        return Weight(-self.alpha, -self.beta, -self.kappa)

    @property
    def is_real(self) -> bool:
        return not isinstance(self.alpha, complex)

    @property
    def is_chebyshev(self) -> bool:
        """Whether it is one of the four Chebyshev weights."""
        return {self.alpha, self.beta} <= {-0.5, 0.5}

    @property
    def kind(self) -> Any:
        """The NumPy type of its polynomials' coefficients."""
        return np.float64 if self.is_real else np.complex128

    @property
    def real(self) -> Weight:
        """Its modulus on the real axis."""
        return Weight(float(self.alpha.real), float(self.beta.real), self.kappa)

    @property
    def sine(self) -> Exponent:
        """sin πα, from the smaller exponent: next to ±1 the other has lost its digits."""
        if abs(self.beta) < abs(self.alpha):
            return sin_pi(self.beta)
        return sin_pi(self.alpha)

    @property
    def cotangent(self) -> Exponent:
        """cot πα."""
        return sin_pi(self.alpha + 0.5) / self.sine

    @property
    def total(self) -> Exponent:
        """∫ w ds, by the reflection formula of Γ."""
        if self.kappa == 1:
            return -math.pi / self.sine
        if self.alpha == 0.0:  # the modulus of a weight with imaginary exponents
            return 2.0
        return (2.0 if self.kappa == 0 else 2.0 * self.beta) * (math.pi * self.alpha / self.sine)

    def __call__(self, right: Array, left: Array) -> Array:
        """w from the distances 1 - s and 1 + s."""
        if self.alpha == self.beta == 0.5:
            half: Array = np.sqrt(right) * np.sqrt(left)
            return half
        values: Array = right**self.alpha * left**self.beta
        return values


def sin_pi(a: Exponent) -> Exponent:
    """sin πa, from the distance to the nearest whole number."""
    nearest = round(a.real)
    near, sign = a - nearest, 1.0 if nearest % 2 == 0 else -1.0
    return sign * (
        cmath.sin(math.pi * near) if isinstance(near, complex) else math.sin(math.pi * near)
    )


def weight_of(a: complex, b: complex, bounded: tuple[bool, bool]) -> Weight | None:
    """The weight of a φ + b/π PV∫ φ/(t - x) dt on one interval; None if there is none.

    The density is bounded or singular at (left, right).

    α = θ + N, β = -θ + M with θ = ln((a - ib)/(a + ib)) / 2πi = -atan(b/a)/π and integers N, M that
    make Re α, Re β positive (bounded) or negative. Of a and b only the ratio counts.
    """
    ratio: Exponent = a / b
    if abs(ratio.imag) <= PHASE * abs(ratio):
        # a and b have one phase; equal weights must be of equal type, as keys of caches.
        ratio = ratio.real
    theta = (
        -_arctangent(1.0 / ratio) / math.pi
        if abs(ratio) > 1.0
        else _arctangent(ratio) / math.pi - 0.5
    )
    alpha, beta = _end(theta, bounded[1]), _end(-theta, bounded[0])
    if alpha is None or beta is None:
        return None
    return Weight(alpha, beta, -round((alpha + beta).real))


def _arctangent(ratio: Exponent) -> Exponent:
    return cmath.atan(ratio) if isinstance(ratio, complex) else math.atan(ratio)


def _end(theta: Exponent, bounded: bool) -> Exponent | None:
    """theta + N in [0, 1) if bounded, in (-1, 0) if not."""
    if bounded:
        return theta - math.floor(theta.real)
    return theta - math.ceil(theta.real) if theta.real != math.ceil(theta.real) else None
