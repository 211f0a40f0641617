"""A parabola h = x²/(2R) whose fretting wear has ended, in many digits, with E* = R = b = 1.

b is the half-width before wear, c that of the stick zone: (c/b)² = 1 - Q/(f P). In the limit the
parabola carries P on (-c, c) with sharp edges; what would overlap the body beside it is worn,

    p(0)/p0 = c/b + (1 - c²/b²) b/(2c),      depth = [b² arcosh(x/c) - x sqrt(x² - c²)]/(2R),

deepest at x² = (b² + c²)/2, to the place where it is 0.
"""

from typing import Any, NamedTuple

import mpmath


class Worn(NamedTuple):
    """c/b, p(0)/p0, the end of wear over b, the largest depth times R/b², the volume R/b³."""

    stick: float
    middle: float
    end: float
    deepest: float
    volume: float


def worn_parabola(ratio: float, digits: int = 30) -> Worn:
    """The limit at Q/(f P) = ratio."""
    mp = mpmath.mp.clone()
    mp.dps = digits + 10
    c = mp.sqrt(1 - mp.mpf(ratio))

    def depth(x: Any) -> Any:
        return (mp.acosh(x / c) - x * mp.sqrt((x - c) * (x + c))) / 2

    end = mp.findroot(depth, (1 + mp.mpf(ratio) / 4, 1.8), solver="anderson")
    deepest = mp.sqrt((1 + c * c) / 2)

    def by_angle(t: Any) -> Any:
        return depth(c * mp.cosh(t)) * c * mp.sinh(t)

    volume = 2 * mp.quad(by_angle, mp.linspace(0, mp.acosh(end / c), 5))
    return Worn(c, c + (1 - c * c) / (2 * c), end, depth(deepest), volume)
