"""States under other loads, from that under one: steps of ln tan φ, Q = f P sin²φ.

Next to Q = 0 the edges leave those of the normal load like powers of tan φ, and next to f P like
powers of cot φ those of sliding, so that the change of each is continued as a power. Where slip
begins to oppose Q on the way down, no state follows: the load is found, to be named.
"""

from __future__ import annotations

import math
from collections.abc import Sized
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from sie.numerics.root_finding import false_position
from sie.problem.coverage import refused_load

from .iteration import SETTLED, Missing, Root

Array = NDArray[np.float64]

# Steps: the first one, the shortest and the longest one, and how much longer the next one is
STRIDE, SHORTEST, LONGEST, LONGER = 0.7, 1e-2, 2.0, 1.5
ROUGHLY = 1e-6  # of the conditions, on the way
NAMED = 3e-3  # of ln tan φ, or of the slip: the error of the least load that is named

# Of f P: where slip along Q in both zones begins above it, the zones depend on Q alone only above
# some larger load. On the grid of `oracles/sheared_grid.py` they do so from that load on in 16
# cases in which it is 0.02 to 0.49 f P, under parabolas, rounded flats and powers, and not up to
# 1.00 to 1.09 times that load in 10 of 11 in which it is 0.51 to 0.86 f P
LATE = 0.4

T = TypeVar("T", bound=Missing)


class Search(Protocol[T]):
    """What finds a state next to given edges."""

    @property
    def beta(self) -> float:
        """Dundurs' β."""

    @property
    def friction(self) -> float:
        """The coefficient f."""

    @property
    def limit(self) -> float:
        """f P."""

    @property
    def corners(self) -> Sized:
        """The corners of the profile in the contact."""

    @property
    def first_edges(self) -> Array:
        """The edges as Q tends to 0."""

    def start(self, Q: float) -> Array:
        """Edges next to those under Q."""

    def next_to(
        self, edges: Array, Q: float, slopes: Array | None = None, settled: float = SETTLED
    ) -> Root[T] | None:
        """The state under Q next to these edges; None where it is not found."""

    def least_slip(self, trial: T) -> float:
        """The least slip that Q + dQ adds along Q."""


class LoadPath(Generic[T]):
    """The states that a search finds one from the other."""

    def __init__(self, search: Search[T]) -> None:
        self.search = search

    def followed(self, now: T, load: float, Q: float) -> tuple[T, float, bool]:
        """The state under Q, in steps from that under another load.

        If a step finds none, it is the last one that was found, with the least load that has one,
        and whether slip would oppose Q below it.
        """
        place, end, before = self._place(load), self._place(Q), None
        way = math.copysign(1.0, end - place)
        stride = way * min(abs(end - place), STRIDE)
        while abs(stride) > SHORTEST:
            last = abs(end - place) <= abs(stride)
            to = end if last else place + stride
            aim = Q if last else self._load(to)
            guess = self._continued(before, (place, now), to)
            root = self.search.next_to(guess, aim, settled=SETTLED if last else ROUGHLY)
            if root is None:
                stride = 0.5 * (to - place)
                continue
            if self.search.least_slip(root.trial) < 0.0:
                return now, self._least_load((to, root.trial), (place, now)), True
            before, place, now, load = (place, now), to, root.trial, aim
            stride = way * min(abs(stride) * LONGER, LONGEST)
            if last:
                break
        return now, load, False

    def _place(self, Q: float) -> float:
        """ln tan φ."""
        return 0.5 * math.log(Q / (self.search.limit - Q))

    def _load(self, place: float) -> float:
        """Q there."""
        return self.search.limit / (1.0 + math.exp(-2.0 * place))

    def _continued(
        self, before: tuple[float, T] | None, now: tuple[float, T], place: float
    ) -> Array:
        """Edges at a place, whose changes since Q = 0 go on as powers, as between two states."""
        first = self.search.first_edges
        here = now[1].edges - first
        if before is None:
            one, other = (self.search.start(self._load(at)) - first for at in (now[0], place))
            growth, part = other / one, 1.0
        else:
            growth, part = here / (before[1].edges - first), (place - now[0]) / (now[0] - before[0])
        continued: Array = first + here * np.where(growth > 0.0, np.abs(growth), 1.0) ** part
        return continued

    def _least_load(self, opposing: tuple[float, T], along: tuple[float, T]) -> float:
        """The load under which the least slip passes zero, between those of two states."""
        (a, one), (b, other) = opposing, along
        ends = self.search.least_slip(one), self.search.least_slip(other)
        slopes: Array | None = None

        def least(place: float) -> float:
            nonlocal slopes, opposing, along
            guess = self._continued(opposing, along, place)
            root = self.search.next_to(guess, self._load(place), slopes, ROUGHLY)
            if root is None:
                return -1.0
            slip, slopes = self.search.least_slip(root.trial), root.slopes
            if slip < 0.0:
                opposing = place, root.trial
            else:
                along = place, root.trial
            return slip

        def settled(a: float, b: float, missed: float) -> bool:
            return b - a < NAMED or abs(missed) < NAMED

        return self._load(false_position(least, a, b, ends, settled))


def unless_late(search: Search[T], now: T, Q: float) -> T:
    """The state under Q; ContactError where slip would oppose Q under LATE f P.

    The same holds where the zones, followed down from Q, end above LATE f P. At corners of the
    profile they may end for another reason.
    """
    late = LATE * search.limit
    if late >= Q:
        return now
    root = search.next_to(search.start(late), late, settled=ROUGHLY)
    if root is not None:
        opposed = search.least_slip(root.trial) < 0.0
    else:
        _, end, opposed = LoadPath(search).followed(now, Q, late)
        opposed = opposed or (end > late and not search.corners)
    if opposed:
        raise refused_load(search.beta * search.friction, (Q, search.limit, search.limit), True)
    return now
