"""The largest tangential load that friction carries, f P, and the reduced load P - |Q|/f."""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, Context

from sie.errors import LoadError
from sie.numerics.interval import two_product


def refuse_sliding(friction: float, normal_load: float, Q: float) -> None:
    """Raises LoadError if friction cannot carry Q."""
    limit = friction * normal_load
    if abs(Q) > limit:
        digits = next(
            n for n in range(6, 18) if n == 17 or f"{abs(Q):.{n}g}" != _within(limit, n, -1)
        )
        raise LoadError(
            f"|Q| = {abs(Q):.{digits}g} exceeds f P = {_within(limit, digits, -1)}: the bodies "
            "slide; lower tangential_load to at most that, or raise normal_load to "
            f"{_within(abs(Q) / friction, digits, 1)} or friction",
            limit=limit,
        )


def _within(value: float, digits: int, side: int) -> str:
    """A positive value to so many digits, not above it (side -1) or not below it (1).

    A value taken from a message thus stays within it.
    """
    shown = f"{value:.{digits}g}"
    if side * float(shown) < side * value:
        rounding = ROUND_CEILING if side > 0 else ROUND_FLOOR
        context = Context(prec=digits, rounding=rounding)
        shown = f"{float(context.create_decimal_from_float(value)):.{digits}g}"
    return shown


def remaining(friction: float, normal_load: float, Q: float) -> float:
    """P - |Q|/f, from (f P - |Q|)/f without cancellation."""
    product, rest = two_product(friction, normal_load)
    return ((product - abs(Q)) + rest) / friction
