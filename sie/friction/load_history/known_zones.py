"""Stick zones already computed under one normal load, from which the next one is estimated."""

from __future__ import annotations

from bisect import bisect_left

from sie.numerics.interval import Interval


class KnownZones:
    """Stick zones under one P, by depth. A cubic through the nearest four estimates the next."""

    def __init__(self) -> None:
        self._depths: list[float] = []
        self._contacts: list[Interval] = []

    def add(self, depth: float, contact: Interval) -> None:
        k = bisect_left(self._depths, depth)
        if k < len(self._depths) and self._depths[k] == depth:
            return
        self._depths.insert(k, depth)
        self._contacts.insert(k, contact)

    def guess(self, depth: float) -> Interval | None:
        if not self._depths:
            return None
        first = max(min(bisect_left(self._depths, depth) - 2, len(self._depths) - 4), 0)
        at, zones = self._depths[first : first + 4], self._contacts[first : first + 4]
        base = zones[0]
        # Neville's scheme for the distances of both edges from those of the first zone
        moves = [
            (c.x1 - base.x1 + (c.tail1 - base.tail1), c.x2 - base.x2 + (c.tail2 - base.tail2))
            for c in zones
        ]
        for order in range(1, len(at)):
            for k in range(len(at) - order):
                t = (depth - at[k]) / (at[k + order] - at[k])
                (a, b), (c, d) = moves[k], moves[k + 1]
                moves[k] = (a + t * (c - a), b + t * (d - b))
        zone = base.moved(*moves[0])
        return zone if zone.x1 < zone.x2 else None
