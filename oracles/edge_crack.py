"""K_I of an edge crack of depth a under a stress σ (y/a)^n on its faces, exactly, in many digits.

Mellin's transform makes the equation of the crack one of Wiener and Hopf. With u = 1 - s the symbol
of its kernel is tan(πu/2) M(u), M(u) = 1 - u²/sin²(πu/2), whose roots are Williams' exponents of a
free corner of 90°. Its factors are gamma functions and an integral, so that for any n > -1

    K/(σ sqrt(πa)) = Γ((n+1)/2)/(sqrt(π) Γ(n/2+1)) exp(-I),
    I = (n+1)/π ∫_0^∞ ln(1 - τ²/sinh²(πτ/2)) / ((n+1)² + τ²) dτ.

For n = 0 it is Koiter's constant 1.1215 (W. T. Koiter, J. Appl. Mech. 32 (1965) 237).
"""

from typing import Any

import mpmath


def edge_crack(power: float, digits: int = 30) -> Any:
    """K/(σ sqrt(πa))."""
    mp = mpmath.mp.clone()
    mp.dps = digits + 5
    n = mp.mpf(power) + 1

    def integrand(tau: Any) -> Any:
        half = mp.pi * tau / 2
        inside = tau / mp.sinh(half) if tau else 2 / mp.pi
        return mp.log(1 - inside**2) / (n**2 + tau**2)

    integral = mp.quad(integrand, [0, 1, 2, 4, 8, 16, 32, 64, 128])
    factor = mp.gamma(n / 2) / (mp.sqrt(mp.pi) * mp.gamma((n + 1) / 2))
    return factor * mp.exp(-n / mp.pi * integral)
