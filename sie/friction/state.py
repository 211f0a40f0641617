"""A state of stick and slip: contact, zones, and the shear that is locked in."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics.graded_panels import Pieces

Array = NDArray[np.float64]
Ends = tuple[tuple[float, float], ...]
Slips = tuple[tuple[float, float, float], ...]

SAME = 1e-11  # of the contact: marks that are closer are one


@dataclass(frozen=True, eq=False)
class Contact:
    """The contact under the loads at one moment.

    patches   ((x1, x2), ...), ascending; of a periodic contact those of one period
    limit     f p, a stress
    Q         the tangential load, force per length
    tau       a quarter of the bulk stress
    period    inf on the line
    """

    patches: Ends
    limit: Pieces
    Q: float
    tau: float
    period: float = np.inf

    @property
    def width(self) -> float:
        """From the first edge to the last one."""
        return self.patches[-1][1] - self.patches[0][0]

    @cached_property
    def peak(self) -> float:
        """The largest f p, about."""
        x = np.concatenate([np.linspace(a, b, 34)[1:-1] for a, b in self.patches])
        return float(self.limit(x).max())


@dataclass(frozen=True, eq=False)
class State:
    """Zones of stick and slip, and q.

    contact   the contact
    stick     the stick zones, ascending over all patches
    slip      the rest of the contact as (lo, hi, s), q = s f p; ascending
    shear     q, a stress; its marks are those of the state
    """

    contact: Contact
    stick: Ends
    slip: Slips
    shear: Pieces = field(repr=False)

    @property
    def marks(self) -> Array:
        """Where q is not smooth: edges, ends of zones now and before, corners of the profile."""
        return self.shear.marks

    @classmethod
    def untouched(cls, contact: Contact) -> State:
        """The state before anything was sheared: all sticks."""
        ends = intervals(contact.patches, contact.limit.marks, SAME * contact.width)
        return cls(contact, contact.patches, (), Pieces.fitted(ends, lambda rule: 0.0 * rule.lo))


def intervals(zones: Iterable[tuple[float, float]], marks: Array, same: float) -> Array:
    """Zones cut at the marks inside them, (n, 2)."""
    found = []
    for lo, hi in zones:
        inside = marks[(marks > lo + same) & (marks < hi - same)]
        kept = inside[np.diff(inside, prepend=-np.inf) > same]
        cuts = np.concatenate(([lo], kept, [hi]))
        found.append(np.stack((cuts[:-1], cuts[1:]), axis=1))
    return np.concatenate(found) if found else np.zeros((0, 2))


def between(patches: Ends, stick: Ends) -> Ends:
    """What of the patches is beside the stick zones, ascending."""
    found = []
    for lo, hi in patches:
        start = lo
        for a, b in stick:
            if lo <= a and b <= hi:
                if a > start:
                    found.append((start, a))
                start = b
        if hi > start:
            found.append((start, hi))
    return tuple(found)


def united(first: Ends, second: Ends) -> Ends:
    """The union of two sets of patches."""
    found: list[tuple[float, float]] = []
    for lo, hi in sorted((*first, *second)):
        if found and lo <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], hi)
        else:
            found.append((lo, hi))
    return tuple(found)


def overlaps(first: Ends, second: Ends) -> Ends:
    """The zones that lie in one zone of each of two sets."""
    pairs = ((max(a, c), min(b, d)) for a, b in first for c, d in second)
    return tuple((lo, hi) for lo, hi in pairs if lo < hi)
