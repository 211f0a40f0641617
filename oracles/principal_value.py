"""Principal values by Gauss-Legendre quadrature in mpmath, to as many digits as the context has. It
shares nothing with the packages.

In the angle t = b sin θ the root of the paper's integrals is gone, ∫ f dt / (sqrt(b² - t²)(t - x))
= ∫ f dθ / (t - x), and what is left of the pole at θ = φ is folded: the sum of the integrand at φ +
s and φ - s is analytic in s.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Number = Any
GUARD = 30  # digits that folding may lose next to the pole


def context(digits: int) -> Any:
    """An mpmath context of its own; the global precision stays what it is."""
    import mpmath  # noqa: PLC0415

    mp = mpmath.mp.clone()
    mp.dps = digits
    return mp


def integral(mp: Any, f: Callable[[Number], Number], lo: Number, hi: Number) -> Number:
    """∫ f ds of an analytic function whose singularities may lie half the interval away, or at an
    end as powers of the distance.
    """
    return mp.quad(f, mp.linspace(lo, hi, 5), method="gauss-legendre", maxdegree=8)


def principal_value(
    mp: Any, f: Callable[[Number], Number], pole: Number, lo: Number, hi: Number
) -> Number:
    """PV∫_lo^hi f(θ) dθ for f with a simple pole at `pole`, inside or outside; graded towards
    it.
    """
    if not lo < pole < hi:
        near = lo if pole <= lo else hi
        distance = abs(pole - near)
        return _graded(mp, f, (lo, hi), near, distance)
    reach = min(pole - lo, hi - pole)
    folded = integral(mp, lambda s: f(pole + s) + f(pole - s), mp.zero, reach)
    if pole - lo > reach:
        return folded + _graded(mp, f, (lo, pole - reach), pole - reach, reach)
    return folded + (
        _graded(mp, f, (pole + reach, hi), pole + reach, reach) if hi - pole > reach else mp.zero
    )


def _graded(
    mp: Any,
    f: Callable[[Number], Number],
    ends: tuple[Number, Number],
    near: Number,
    distance: Number,
) -> Number:
    """Panels that double in length away from the end `near`, a `distance` from the pole."""
    lo, hi = ends
    total, start, length = mp.zero, mp.zero, distance
    while start < hi - lo:
        end = min(start + length, hi - lo)
        a, b = (lo + start, lo + end) if near == lo else (hi - end, hi - start)
        total += integral(mp, f, a, b)
        start, length = end, 2 * length
    return total
