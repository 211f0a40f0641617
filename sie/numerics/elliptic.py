"""Jacobi's elliptic functions of a real argument, for a modulus next to 0 and next to 1 alike.

The parameter is the ratio τ = K'/K of the quarter periods. With the nome q = exp(-π τ), τ >= 1,

    k = (θ2/θ3)²,   k' = (θ4/θ3)²,   K = π/2 θ3²,      θ2 = 2 q^(1/4) Σ q^(n(n+1)),
    θ3 = 1 + 2 Σ q^(n²),   θ4 = 1 + 2 Σ (-1)^n q^(n²),

and for τ < 1 k and k' change places (Whittaker & Watson 1927, §§ 21.1, 22.3). So both k and k' keep
their relative accuracy. The functions by descending Landen transformations (Bulirsch 1965).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TERMS = 5  # of the theta series: q^(TERMS²) is far below rounding for τ >= 1
SETTLED = 1e-9  # of the arithmetic-geometric mean, which converges quadratically


class Modulus(NamedTuple):
    """k, k' = sqrt(1 - k²) and the quarter periods K(k), K'(k) = K(k')."""

    k: float
    complement: float
    K: float
    K_complement: float

    @property
    def rest(self) -> float:
        """1 - k to relative accuracy."""
        return self.complement**2 / (1.0 + self.k)

    @property
    def swapped(self) -> Modulus:
        """The same with k and k' in each other's place."""
        return Modulus(self.complement, self.k, self.K_complement, self.K)


def modulus_of_ratio(tau: float) -> Modulus:
    """The modulus at which K'/K = τ > 0."""
    if tau < 1.0:
        return modulus_of_ratio(1.0 / tau).swapped
    q = math.exp(-math.pi * tau)
    theta2 = 2.0 * math.exp(-0.25 * math.pi * tau) * sum(q ** (n * (n + 1)) for n in range(TERMS))
    theta3 = 1.0 + 2.0 * sum(q ** (n * n) for n in range(1, TERMS))
    theta4 = 1.0 + 2.0 * sum((-1.0) ** n * q ** (n * n) for n in range(1, TERMS))
    K = 0.5 * math.pi * theta3 * theta3
    return Modulus((theta2 / theta3) ** 2, (theta4 / theta3) ** 2, K, tau * K)


def elliptic_functions(modulus: Modulus, part: Array, rest: Array) -> tuple[Array, Array, Array]:
    """sn, cn, dn of K part for 0 < part < 1, each to relative accuracy; rest is 1 - part."""
    far = part > 0.5
    sn, cn, dn = _descended(modulus.K * np.where(far, rest, part), modulus.complement**2)
    return (
        np.where(far, cn / dn, sn),
        np.where(far, modulus.complement * sn / dn, cn),
        np.where(far, modulus.complement / dn, dn),
    )


def _descended(u: Array, parameter: float) -> tuple[Array, Array, Array]:
    """sn, cn, dn of 0 < u <= K/2, given k'²."""
    means: list[tuple[float, float]] = []
    a = 1.0
    while True:
        g = math.sqrt(parameter)
        means.append((a, g))
        a, parameter, apart = 0.5 * (a + g), a * g, abs(a - g)
        if apart <= SETTLED * a:
            break
    cotangent = np.cos(a * u) / np.sin(a * u)
    c, dn = a * cotangent, np.ones_like(u)
    for a, g in reversed(means):
        ratio = c * cotangent
        c = c * dn
        dn = (g + ratio) / (a + ratio)
        cotangent = c / a
    sn = 1.0 / np.sqrt(1.0 + c * c)
    return sn, c * sn, dn
