"""Zones of stick and slip, cut into pieces, and one quadrature rule for all of them.

On a piece [l, r] the trapezoidal rule in v = ln((x - l)/(r - x)), and beside the contact [x1, x2]
the same in v = ln((x - x2)/(x - x1)), through infinity. Any power of the distance from an end, and
the Cauchy kernel of every other piece, however narrow or near, is analytic for |Im v| < π: the
error is e^(-2π²/h) with the step h. Principal values need no subtraction where sources and targets
are half a step apart.

A place is a distance from one of the cuts, so that differences keep their digits next to cuts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

STEP = 0.5  # h: e^(-2π²/h) is 7e-18; next to poles of the integrands much is left of that
ONCE = 320.0  # e-folds that a double holds
ONE = 1e-7  # of the contact: marks that are nearer to others are one
SAME = 1e-13  # of a zone: marks nearer to its ends are one with them


class Fineness(NamedTuple):
    """How fine a rule is.

    step        h
    reach       e-folds of an integrand, beyond which the rule is cut
    inner       the same at a mark inside a zone, where principal values miss what is left out
    """

    step: float
    reach: float
    inner: float


FINE = Fineness(STEP, 38.0, 60.0)  # f p - q is known next to the end of a stick zone too
QUICK = Fineness(0.8, 19.0, 23.0)  # to about 1e-8


class Places(NamedTuple):
    """Places as distances `offset` from the cuts `anchor`, ascending by anchor.

    x           the same, rounded
    weight      of the rule
    zone        the zone of each place
    piece       its piece
    """

    anchor: Index
    offset: Array
    x: Array
    weight: Array
    zone: Index
    piece: Index

    def chosen(self, some: NDArray[np.bool_] | slice) -> Places:
        """Some of them."""
        return Places._make(column[some] for column in self)


Pair = tuple[Places, Places]  # two rules, half a step apart


@dataclass(frozen=True, eq=False)
class Pieces:
    """Zones from the left to the right edge of the contact, with marks inside them.

    left        the left edge
    widths      of the zones, which are known better than from their ends
    signs       0 of a stick zone, s of a slip zone with q = s f p
    marks       places where the γ of what sticks is not smooth
    kinks       places where h' is not smooth
    theta       atan(β f)/π, β > 0
    fineness    of the rules
    sharp       whether the edges are corners, at which exponents are smaller by 1
    """

    left: float
    widths: tuple[float, ...]
    signs: tuple[int, ...]
    marks: tuple[float, ...]
    kinks: tuple[float, ...]
    theta: float
    fineness: Fineness = FINE
    sharp: bool = False

    @cached_property
    def ends(self) -> Array:
        """The ends of the zones."""
        return self.left + np.append(0.0, np.cumsum(self.widths))

    @cached_property
    def _cut(self) -> tuple[Array, Array, Index, Index]:
        """Cuts, lengths of the pieces, the zone of each piece, and which cuts end zones."""
        cuts, lengths, zones, ends = [self.left], [], [], [0]
        for k, width in enumerate(self.widths):
            lo, done = float(self.ends[k]), 0.0
            for mark in self._marks(self.signs[k]):
                ahead = mark - lo
                if done + SAME * width < ahead < width * (1.0 - SAME):
                    cuts.append(mark)
                    lengths.append(ahead - done)
                    zones.append(k)
                    done = ahead
            cuts.append(float(self.ends[k + 1]))
            lengths.append(width - done)
            zones.append(k)
            ends.append(len(cuts) - 1)
        return np.array(cuts), np.array(lengths), np.array(zones), np.array(ends)

    def _marks(self, sign: int) -> list[float]:
        """Cuts of a zone: kinks, and where it sticks marks that are apart from these."""
        if sign:
            return sorted(self.kinks)
        apart = ONE * sum(self.widths)
        kept = list(self.kinks)
        for mark in self.marks:
            if all(abs(mark - other) > apart for other in kept):
                kept.append(mark)
        return sorted(kept)

    @property
    def cuts(self) -> Array:
        return self._cut[0]

    @property
    def lengths(self) -> Array:
        return self._cut[1]

    @property
    def cut_of_ends(self) -> Index:
        """The numbers of the cuts that end zones."""
        return self._cut[3]

    @property
    def zone_of_piece(self) -> Index:
        return self._cut[2]

    @property
    def length(self) -> float:
        """Of the contact."""
        return float(self.lengths.sum())

    @cached_property
    def slip_zones(self) -> int:
        """Their number, less that of sharp edges: the power of χ far away."""
        return sum(1 for sign in self.signs if sign) - 2 * self.sharp

    @cached_property
    def sign(self) -> Array:
        return np.array(self.signs, dtype=float)

    @cached_property
    def powers(self) -> Array:
        """The exponent of χ at each cut, 0 inside a zone."""
        powers, ends = np.zeros(len(self.cuts)), self.cut_of_ends
        for k, sign in enumerate(self.signs):
            if sign:
                powers[ends[k]], powers[ends[k + 1]] = (
                    0.5 - sign * self.theta,
                    0.5 + sign * self.theta,
                )
        powers[[0, -1]] -= self.sharp
        return powers

    @cached_property
    def _between(self) -> Array:
        """Differences of the cuts."""
        n, apart = len(self.cuts), np.zeros((len(self.cuts),) * 2)
        for i in range(n):
            apart[i, :i] = np.cumsum(self.lengths[:i][::-1])[::-1]
        return apart - apart.T

    def rule(self, shift: float, lowered: float = 0.0, finer: int = 1) -> Places:
        """Nodes at v = (k + shift) h on every piece, or those of several shifts together.

        `lowered`: what the exponents of the integrands at the ends of zones are smaller by.
        """
        power = np.where(self.powers != 0.0, self.powers - lowered, 0.0)
        h, reach_of_one, inner = self.fineness
        # of (1) the integrands have these powers, and of (12) a root at the ends of stick zones
        reach = reach_of_one / (1.0 - np.maximum(np.abs(power), 0.5))
        reach[self.powers == 0.0] = inner
        # what is summed varies down to the width of the narrower zone, from there on as its power
        for zone, cut in enumerate(self.cut_of_ends[1:-1]):
            wide, narrow = sorted(self.widths[zone : zone + 2], reverse=True)
            reach[cut] += math.log(wide / narrow)
        reach = np.minimum(reach, ONCE)
        columns = []
        for k, length in enumerate(self.lengths.tolist()):
            lo, hi = (math.ceil(reach[k + side] / h) for side in (0, 1))
            v = h * (np.arange(-lo * finer, (hi + 1) * finer) / finer + shift)
            e = np.exp(-np.abs(v))
            near, far, on_left = length * e / (1.0 + e), length / (1.0 + e), v < 0.0
            columns.append(
                (
                    np.where(on_left, k, k + 1),
                    np.where(on_left, near, -near),
                    h / finer * near * far / length,
                    np.full(len(v), k),
                )
            )
        anchor, offset, weight, piece = (np.concatenate(c) for c in zip(*columns, strict=True))
        return Places(
            anchor, offset, self.cuts[anchor] + offset, weight, self.zone_of_piece[piece], piece
        )

    def outside(self, lowered: float = 0.0) -> Places:
        """Nodes beside the contact, on the left edge's side first, at half-steps.

        What is integrated varies over distances as short as the zones at the edges.
        """
        L, h = self.length, self.fineness.step
        to_right, to_left = (
            math.ceil(self._reach_beside(power, width, lowered) / h)
            for power, width in (
                (self.powers[-1], self.widths[-1]),
                (self.powers[0], self.widths[0]),
            )
        )
        v = h * (np.arange(to_left, -to_right - 1, -1) - 0.5)
        d = L * np.exp(-np.abs(v)) / -np.expm1(-np.abs(v))
        on_left = v > 0.0
        anchor = np.where(on_left, 0, len(self.cuts) - 1)
        offset, none = np.where(on_left, -d, d), np.zeros(len(v), dtype=int)
        return Places(anchor, offset, self.cuts[anchor] + offset, h * d * (d + L) / L, none, none)

    def _reach_beside(self, power: float, width: float, lowered: float) -> float:
        """e-folds next to an edge, where the integrand has the exponent 0, or power - lowered."""
        smallest = 1.0 + min(power - lowered, 0.0)
        return self.fineness.reach / smallest + math.log(self.length / width)

    def apart(self, one: Places, other: Places) -> Array:
        """x - t of all pairs."""
        out, numbers = np.empty((len(one.x), len(other.x))), np.arange(len(self.cuts) + 1)
        rows, columns = (np.searchsorted(p.anchor, numbers).tolist() for p in (one, other))
        between = self._between
        for i, (first, last) in enumerate(pairwise(rows)):
            for j, (start, stop) in enumerate(pairwise(columns)):
                # in contact a place is less than half as far from its cut as the next cut is
                block = out[first:last, start:stop]
                offset = between[i, j] + one.offset[first:last]
                np.subtract.outer(offset, other.offset[start:stop], out=block)
        return out

    def from_cut(self, at: Places, cut: int) -> Array:
        """x less a cut."""
        out: Array = self._between[at.anchor, cut] + at.offset
        return out

    def log_chi(self, at: Places, lowered: float = 0.0) -> Array:
        """ln |χ|, χ = Π (distance from an end of slip)^power."""
        out = np.zeros(len(at.x))
        for k in np.flatnonzero(self.powers):
            out += (self.powers[k] - lowered) * np.log(np.abs(self.from_cut(at, int(k))))
        return out

    @cached_property
    def turns(self) -> Array:
        """(-1)^N of each zone, N the number of slip zones to the right of it, less a sharp edge."""
        slips = np.array([sign != 0 for sign in self.signs])
        return (-1.0) ** (slips[::-1].cumsum()[::-1] - slips - self.sharp)


def across(kernel: Array, masses: Sequence[Array]) -> tuple[Array, Array]:
    """PV integrals of masses on each of two rules, at the places of the other one."""
    return kernel @ masses[1], -(masses[0] @ kernel)
