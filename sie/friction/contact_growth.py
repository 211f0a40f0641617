"""The contacts of one profile at one tilt under every load, and how fast they grow.

The contact under a load y is found by Newton's method from those under other loads. The distances
of the edges from the lowest points are nearly power laws, so that cubics in logarithms predict
them.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from sie.contact.edge_integrals import EdgeIntegrals
from sie.contact.edges import Search
from sie.contact.known_contact import Normal
from sie.numerics.interval import EPS, Interval, two_sum
from sie.problem.scene import Scene
from sie.profiles.resolution import refined

MARGIN = 0.02  # of the widest contact: how far beyond it a function is resolved
NEAR, STEPS = 0.25, 8  # Newton from an interpolated contact: its first step, and how many
# steps relative to the distance from where the profile touched first: rounding, and no solution
SETTLED, ASTRAY = 64.0 * EPS, 1e-9
FARTHEST = 2.0  # of the logarithms of distances from those of known contacts


class Contact(NamedTuple):
    """The contact under a load, which of its edges are sharp, and the edge integrals there."""

    interval: Interval
    sharp: tuple[bool, bool]
    integrals: EdgeIntegrals


class ContactGrowth:
    """The contacts of a scene's profile at the tilt of a normal contact, under loads up to its."""

    def __init__(self, scene: Scene, normal: Normal, economy: Collection[str]) -> None:
        tilt, widest = normal.edges.tilt, normal.edges.contact
        declared = scene.profile.pieces.tilted(tilt)
        margin = MARGIN * widest.r
        lo, hi = (
            max(widest.x1 - margin, declared.domain[0]),
            min(widest.x2 + margin, declared.domain[1]),
        )
        axis = scene.profile.axis if tilt == 0.0 and "symmetry" in economy else None
        self.search = Search(
            refined(declared, lo, hi, EPS), 0.5 * scene.Estar, axis, "zero panels" not in economy
        )
        self.breaks = declared.break_points
        self.touch = self.search.touch()
        self.top = normal.edges.normal_load
        self._ends = declared.domain
        # (ln y, logarithms of both edges' distances from where it touched first)
        self._known: list[tuple[float, float, float]] = []

    def contact(self, y: float) -> Contact:
        found = self._near(y)
        if found is None:
            search = self.search
            contact, sharp, k = (
                search.symmetric(y) if search.axis is not None else search.general(y)
            )
            found = Contact(contact, sharp, k or search.integrals(contact))
        self._learn(y, found)
        return found

    def rate(self, y: float) -> float:
        """d ln r/d ln y: an edge moves by dy/(G r J), and a sharp edge does not move."""
        (contact, sharp, k), G = self.contact(y), self.search.half_modulus
        rise1 = contact.r * k.JL - (0.5 * k.I0 if sharp[1] else 0.0)
        rise2 = contact.r * k.JR + (0.5 * k.I0 if sharp[0] else 0.0)
        moves = (0.0 if sharp[0] else 1.0 / rise1) + (0.0 if sharp[1] else 1.0 / rise2)
        return y * moves / (2.0 * G * contact.r)

    def passed(self, lo: float, hi: float) -> list[tuple[float, bool]]:
        """(break, whether the right edge passes it) between two loads, in the order of distance."""
        if not self.breaks:
            return []
        a, b = self.contact(lo).interval, self.contact(hi).interval
        slack = 4.0 * EPS * (b.r + abs(b.m))
        lo_end, hi_end = self._ends  # which an edge reaches, and does not pass
        left = [
            (x, False)
            for x in self.breaks
            if b.x1 + (0.0 if x == lo_end else slack) <= x < a.x1 - slack
        ]
        right = [
            (x, True)
            for x in self.breaks
            if a.x2 + slack < x <= b.x2 - (0.0 if x == hi_end else slack)
        ]
        both = left + right if self.search.axis is None else right
        return sorted(both, key=lambda pair: abs(pair[0] - a.m))

    def level_at(self, b: float, right: bool, near: Interval) -> float:
        """The load under which an edge is at b, 0 if it is not found."""
        search = self.search
        if search.axis is not None:
            d = abs(b - search.axis)
            contact = (
                Interval(2.0 * search.axis - b, b) if right else Interval(b, 2.0 * search.axis - b)
            )
            return search.load(contact, search.integrals(contact)) if d > 0.0 else 0.0
        contact = (
            Interval(near.x1, b, near.tail1, 0.0)
            if right
            else Interval(b, near.x2, 0.0, near.tail2)
        )
        previous = math.inf
        for _ in range(STEPS * 4):
            k = search.integrals(contact)
            J = k.JL if right else k.JR
            if not J > 0.0:
                return 0.0
            step = -2.0 * k.I0 / J
            if abs(step) >= 0.5 * previous or abs(step) <= SETTLED * contact.r:
                return search.load(contact, k) if abs(step) <= ASTRAY * contact.r else 0.0
            contact, previous = (
                (contact.moved(step, 0.0) if right else contact.moved(0.0, step)),
                abs(step),
            )
            if not contact.r > 0.0:
                return 0.0
        return 0.0

    def _near(self, y: float) -> Contact | None:
        """The contact by Newton's method from what the contacts of other loads say.

        None if that does not settle or an edge is sharp.
        """
        guess = self._guess(math.log(y))
        if guess is None:
            return None
        return near_contact(self.search, y, guess, self.top)

    def _learn(self, y: float, found: Contact) -> None:
        distances = _distances(found.interval, self.touch)
        if any(found.sharp) or min(distances) <= 0.0:
            return
        point = (math.log(y), math.log(distances[0]), math.log(distances[1]))
        k = bisect_left(self._known, point[:1])
        if k == len(self._known) or self._known[k][0] != point[0]:
            self._known.insert(k, point)

    def _guess(self, at: float) -> Interval | None:
        """The contact as guessed from the four nearest loads.

        The distances of the edges are nearly power laws, and cubics in logarithms fit them.
        """
        if len(self._known) < 2:
            return None
        first = max(min(bisect_left(self._known, (at,)) - 2, len(self._known) - 4), 0)
        table = np.array(self._known[first : first + 4])
        x, moves = table[:, 0], table[:, 1:]
        for order in range(1, len(x)):  # Neville
            t = ((at - x[: len(x) - order]) / (x[order:] - x[: len(x) - order]))[:, None]
            moves = moves[:-1] + t * (moves[1:] - moves[:-1])
        if not np.abs(moves[0] - table[:, 1:]).max(axis=1).min() <= FARTHEST:
            return None
        (d1, d2), (z1, z2) = np.exp(moves[0]).tolist(), self.touch
        (x1, tail1), (x2, tail2) = two_sum(z1, -d1), two_sum(z2, d2)
        return Interval(x1, x2, tail1, tail2)


def near_contact(search: Search, load: float, guess: Interval, top: float) -> Contact | None:
    """The contact under a load by Newton's method from another one.

    None if that does not settle or an edge is sharp. `top` is the largest load, next to which
    rounding of the slope is small.
    """
    contact, target, previous = guess, load / search.half_modulus, NEAR
    touch, (lo, hi) = search.touch(), search.slope.domain
    for _ in range(STEPS):
        k, r = search.integrals(contact), contact.r
        if not (k.JL > 0.0 and k.JR > 0.0):
            return None
        step1, step2 = (
            (r * (k.I1 - k.I0) - target) / (r * k.JL),
            (target - r * (k.I1 + k.I0)) / (r * k.JR),
        )
        d1, d2 = _distances(contact, touch)
        size = max(abs(step1) / d1, abs(step2) / d2)
        if size <= SETTLED or previous * 0.25 <= size <= SETTLED * math.sqrt(top / load):
            return Contact(contact, (False, False), k)
        if not size <= previous:
            return None
        contact, previous = contact.moved(step1, step2), size
        if not (lo < contact.x1 and contact.x2 < hi):
            return None
    return None


def _distances(contact: Interval, touch: tuple[float, float]) -> tuple[float, float]:
    return (touch[0] - contact.x1) - contact.tail1, (contact.x2 - touch[1]) + contact.tail2
