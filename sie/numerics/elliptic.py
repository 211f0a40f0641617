"""The modulus of elliptic integrals by the ratio of their quarter periods, next to 0 and 1 alike.

With τ = K'/K and the nome q = exp(-π τ), τ >= 1,

    k = (θ2/θ3)²,   k' = (θ4/θ3)²,   K = π/2 θ3²,      θ2 = 2 q^(1/4) Σ q^(n(n+1)),
    θ3 = 1 + 2 Σ q^(n²),   θ4 = 1 + 2 Σ (-1)^n q^(n²),

and for τ < 1 k and k' change places (Whittaker & Watson 1927, §§ 21.1, 22.3). So both k and k' keep
their relative accuracy.
"""

from __future__ import annotations

import math
from typing import NamedTuple

TERMS = 5  # of the theta series: q^(TERMS²) is far below rounding for τ >= 1


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
