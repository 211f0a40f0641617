"""The largest tangential load that friction carries, f P, and the reduced load P - |Q|/f."""

from __future__ import annotations

import math

from sie.errors import LoadError
from sie.numerics.interval import two_product


def refuse_sliding(friction: float, normal_load: float, Q: float) -> None:
    """Raises LoadError if friction cannot carry Q."""
    limit = friction * normal_load
    if abs(Q) > limit:
        enough = math.nextafter(abs(Q) / friction, math.inf)
        raise LoadError(
            f"|Q| = {abs(Q)!r} exceeds f P = {limit!r}: the bodies slide; lower tangential_load to "
            f"at most that, or raise normal_load to {enough!r} or friction",
            limit=limit,
        )


def remaining(friction: float, normal_load: float, Q: float) -> float:
    """P - |Q|/f, from (f P - |Q|)/f without cancellation."""
    product, rest = two_product(friction, normal_load)
    return ((product - abs(Q)) + rest) / friction
