"""The distances of an edge from where the profile touches first, at which its search starts."""

from __future__ import annotations

import math
from bisect import bisect_right

from sie.numerics.interval import EPS
from sie.profiles.slope import Slope

# P/(G κ) of a linear rise in units of a²: beyond it the flat base, of half-width a, is negligible
# for a guess. Below this tan θ two terms of its series are rounding; else so many steps are enough.
LEAST_FLAT, NARROW_RIM, NEWTONS = 1e-20, 1e-2, 4


def first_guess(slope: Slope, z: float, target: float) -> float:
    """The distance from z, the edge of the part that touches first, at which a search starts."""
    hi = slope.domain[1]
    if math.isfinite(hi):
        return 0.5 * (hi - z)
    breaks = slope.break_points
    ahead = bisect_right(breaks, z)
    if ahead < len(breaks):
        return breaks[ahead] - z
    # Not within rounding of z, where the load would be noise
    return (
        max(z - breaks[0], abs(z))
        if breaks and breaks[0] < z
        else max(target, math.sqrt(EPS) * abs(z))
    )


def of_linear_rise(slope: Slope, axis: float, z: float, target: float) -> float:
    """The edge's distance from z in closed form if H = κ (x - z) from there to the edge, or 0.

    With a = z - axis, r = a/cos θ: P/G = κ r² (θ - sin θ cos θ), that is, for u = tan θ,
    (1 + u²) arctan u - u = P/(G κ a²), whose derivative is 2u arctan u.
    """
    row = next((row for row in slope.rows if row.lo <= z < row.hi), None)
    if slope.functions or row is None or row.origin != z or len(row.coefficients) != 2:
        return 0.0
    curvature, start = row.coefficients
    if start or not curvature > 0.0:
        return 0.0
    a, scaled = z - axis, target / curvature
    if not a * a > LEAST_FLAT * scaled:
        distance = math.sqrt(2.0 / math.pi * scaled)
    else:
        wanted = scaled / (a * a)
        # Both are lower bounds: of a small u, and of a large one
        u = max((1.5 * wanted) ** (1.0 / 3.0), math.sqrt(2.0 / math.pi * wanted))
        if u < NARROW_RIM:
            u *= 1.0 + u * u / 15.0
        else:
            for _ in range(NEWTONS):
                angle = math.atan(u)
                u -= ((1.0 + u * u) * angle - u - wanted) / (2.0 * u * angle)
        distance = a * u * u / (1.0 + math.hypot(1.0, u))
    return distance if 0.0 < distance < row.hi - z else 0.0
