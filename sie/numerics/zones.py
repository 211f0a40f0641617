"""Zones of contact, of stick and of slip: their union, and the parts that one leaves of another."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Zones = Sequence[tuple[float, float]]
Slips = tuple[tuple[float, float, float], ...]  # (lo, hi, direction of slip)


def united(zones: Zones) -> tuple[tuple[float, float], ...]:
    """The union of zones, ascending."""
    found: list[tuple[float, float]] = []
    for lo, hi in sorted(zones):
        if found and lo <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], hi)
        else:
            found.append((lo, hi))
    return tuple(found)


def left_over(
    outer: Zones, inner: Zones, period: float = math.inf
) -> tuple[tuple[float, float], ...]:
    """The parts of the outer zones beside the inner ones, which may be those of another period."""
    turns = (0.0,) if math.isinf(period) else (-period, 0.0, period)
    held = sorted((lo + turn, hi + turn) for turn in turns for lo, hi in inner)
    parts: list[tuple[float, float]] = []
    for a, b in outer:
        ends = [a]
        for lo, hi in held:
            if a < hi and lo < b:
                ends += [max(a, lo), min(hi, b)]
        ends.append(b)
        parts += [(lo, hi) for lo, hi in zip(ends[::2], ends[1::2], strict=True) if lo < hi]
    return tuple(parts)


def within(x: Array, zones: Zones, period: float = math.inf) -> NDArray[np.bool_]:
    """Whether x is in one of the zones, which are ascending."""
    if not len(zones):
        return np.zeros(x.shape, dtype=bool)
    a, b = np.array(zones).T
    if math.isfinite(period):
        x = x - period * np.floor((x - a[0]) / period)
    k = np.maximum(np.searchsorted(a, x, side="right") - 1, 0)
    inside: NDArray[np.bool_] = (x >= a[k]) & (x <= b[k])
    return inside
