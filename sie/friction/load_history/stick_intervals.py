"""Several stick zones: their ends, and the shear between the zones of slip beside them.

Beside the stick zones [a_j, b_j], j = 1..N, the change of shear is known, D = s f p - q0. With

    R(z) = Π sqrt(z - a_j) sqrt(z - b_j),      F(z) = Δτ + R(z)/π ∫_slip D(ξ)/(R(ξ)(z - ξ)) dξ

F is the potential that is bounded at all ends, and ΔQ/(π z) far away. With the centres μ_j that is

    ∫_slip D/R Π_{i≠j}(ξ - μ_i) dξ = -π Δτ,    ∫_slip D/R Π_i(ξ - μ_i) dξ = ΔQ;

and no point of one stick zone moves from those of another: ∫(Re F - Δτ) dx = 0 over each gap, or

    ∫_slip D(ξ)/R(ξ) A(ξ) dξ = 0,              A(ξ) = PV∫_gap R(x)/(x - ξ) dx,

2N equations for as many ends. For ξ in the gap let |R| = ω S, ω the root of the distances from its
ends. S² is a polynomial, so that (S(x) - S(ξ))/(x - ξ) is known without cancellation, and the rest
is PV∫ω/(x - ξ) dx = -π (ξ - m), m the middle of the gap.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.graded_rule import graded, on_panels
from sie.numerics.interval import Interval

Array = NDArray[np.float64]
Values = Callable[[Array], Array]

LEVELS = 26  # GRADING**LEVELS is rounding
WIDE = 4  # levels more than the distance of the nearest singularity asks for
SAME = 1e-13  # of a zone: marks that are nearer to an end are that end
ROWS = 512  # places at a time
DIFFERENCE, MOST_STEPS = 1e-6, 20  # of Newton's method
SLOW = 0.1  # of the step before: with a larger one the derivatives are taken anew
MOST_TAKEN = 0.8  # of a zone, by one step
SETTLED, ROUNDING = 1e-12, 1e-9  # of the width beside an end: steps
TINY = 1e-300


class Zone(NamedTuple):
    """A zone of slip: its ends, distances of nodes from them, dξ and D dξ there."""

    lo: float
    hi: float
    from_lo: Array
    from_hi: Array
    weight: Array
    force: Array

    def apart(self, x: float) -> Array:
        """Distances of the nodes from a place beside the zone."""
        return self.from_lo + (self.lo - x) if x <= self.lo else self.from_hi + (x - self.hi)

    @property
    def places(self) -> Array:
        nearer: Array = np.where(
            self.from_lo < self.from_hi, self.lo + self.from_lo, self.hi - self.from_hi
        )
        return nearer


def zone(ends: tuple[float, float], marks: Array, values: Values) -> Zone:
    """Nodes in a zone, graded towards its ends and marks."""
    (lo, hi), ratios = ends, graded(LEVELS)
    length = hi - lo
    inner = np.unique(marks[(marks > lo + SAME * length) & (marks < hi - SAME * length)])
    at = 2.0 * np.arctan2(np.sqrt(inner - lo), np.sqrt(hi - inner))
    cuts = [np.array([0.0, np.pi])]
    for left, right in pairwise(np.concatenate(([0.0], at, [np.pi]))):
        near = 0.5 * (right - left) * np.append(ratios, 1.0)
        cuts += [np.array([left]), left + near, right - near]
    angle, step = on_panels(np.unique(np.concatenate(cuts)))
    half = 0.5 * angle.ravel()
    from_lo, from_hi = length * np.sin(half) ** 2, length * np.cos(half) ** 2
    weight = step.ravel() * length * np.sin(half) * np.cos(half)
    blank = Zone(lo, hi, from_lo, from_hi, weight, weight)
    return blank._replace(force=weight * values(blank.places))


@dataclass(frozen=True, eq=False)
class StickIntervals:
    """Stick zones and the slip beside them.

    ends     (N, 2) the ends a_j, b_j, ascending
    zones    the zones of slip from left to right, N + 1
    """

    ends: Array
    zones: tuple[Zone, ...]

    @property
    def number(self) -> int:
        return len(self.ends)

    def shear(self, x: Array) -> Array:
        """The change of q at places (1-d) in the stick zones."""
        out = np.empty(len(x))
        j = np.clip(np.searchsorted(self.ends[:, 0], x, side="right"), 1, self.number)
        for first in range(0, len(x), ROWS):
            rows = slice(first, first + ROWS)
            out[rows] = self._shear(x[rows], j[rows])
        return out

    def _shear(self, x: Array, j: NDArray[np.intp]) -> Array:
        root = np.sqrt(np.abs(np.prod(x[:, None] - self.ends.ravel(), axis=1)))
        total = np.zeros(len(x))
        for k, (zone_, charge) in enumerate(zip(self.zones, self._charges, strict=True)):
            right = k >= j
            distance = np.maximum(np.where(right, zone_.lo - x, x - zone_.hi), 0.0)
            nodes = np.where(right[:, None], zone_.from_lo, zone_.from_hi)
            sign = np.where((j + k) % 2, -1.0, 1.0) * np.where(right, 1.0, -1.0)
            total += sign * (np.reciprocal(distance[:, None] + nodes) @ charge)
        return root / math.pi * total

    @cached_property
    def _charges(self) -> list[Array]:
        """D dξ/|R| of each zone."""
        return [z.force / np.prod(self._roots(z), axis=0) for z in self.zones]

    def _roots(self, z: Zone) -> Array:
        """sqrt(|ξ - a_j| |ξ - b_j|), (N, nodes)."""
        return np.array([np.sqrt(z.apart(a) * z.apart(b)) for a, b in self.ends])

    # -- equations ---------------------------------------------------------------------------------

    def missed(self, dQ: float, dtau: float) -> Array:
        """By what the 2N equations fail."""
        N = self.number
        found = np.zeros(2 * N)
        for k, z in enumerate(self.zones):
            roots = self._roots(z)
            arms = np.array([0.5 * (z.apart(a) + z.apart(b)) for a, b in self.ends]) / roots
            side = np.where(np.arange(N) < k, 1.0, -1.0)
            for j in range(N):
                others = np.prod(np.delete(arms, j, axis=0), axis=0)
                found[j] += side[j] * float(z.force @ (others / roots[j]))
            found[N] += float(z.force @ np.prod(arms, axis=0))
            charge = self._charges[k] * np.prod(side)
            for gap in range(1, N):
                found[N + gap] += float(charge @ self._across(gap, k))
        found[:N] += math.pi * dtau
        found[N] -= dQ
        return found

    def _across(self, gap: int, k: int) -> Array:
        """A of a gap, which is to the right of so many stick zones, at the nodes of zone k."""
        (lo, hi), z = self.ends.ravel()[2 * gap - 1 : 2 * gap + 1].tolist(), self.zones[k]
        from_lo, from_hi, dx, root = self._rule(gap, hi - lo)
        x, outer = lo + from_lo, np.delete(self.ends.ravel(), [2 * gap - 1, 2 * gap])
        sign = -1.0 if (self.number - gap) % 2 else 1.0
        S = np.sqrt(np.abs(np.prod(x[:, None] - outer, axis=1)))
        if k > gap:
            return -sign * ((dx * root * S) @ np.reciprocal(from_hi[:, None] + z.apart(hi)))
        if k < gap:
            return sign * ((dx * root * S) @ np.reciprocal(from_lo[:, None] + z.apart(lo)))
        xi = z.places
        own = np.sqrt(np.abs(np.prod(xi[:, None] - outer, axis=1)))
        quotient = np.zeros((len(x), len(xi)))
        for n in range(len(outer)):
            before = np.prod(x[:, None] - outer[:n], axis=1)
            quotient -= before[:, None] * np.prod(xi[:, None] - outer[n + 1 :], axis=1)
        inner = (dx * root) @ (quotient / np.add.outer(S, own))
        return sign * (inner - math.pi * own * 0.5 * (z.from_lo - z.from_hi))

    def _rule(self, gap: int, length: float) -> tuple[Array, Array, Array, Array]:
        """Distances from the ends of a gap, dx and ω, graded as the stick zones beside it ask."""
        width = float(np.diff(self.ends, axis=1)[gap - 1 : gap + 1].min())
        levels = WIDE + math.ceil(max(0.5 * math.log(length / width, 4.0), 0.0))
        near = 0.5 * math.pi * np.append(graded(levels), 1.0)
        cuts = np.concatenate(([0.0], near, (math.pi - near)[-2::-1], [math.pi]))
        angle, step = on_panels(cuts)
        half = 0.5 * angle.ravel()
        root = length * np.sin(half) * np.cos(half)
        return length * np.sin(half) ** 2, length * np.cos(half) ** 2, step.ravel() * root, root


def settled(
    beside: Callable[[Array], StickIntervals],
    ends: Array,
    outer: Interval,
    change: tuple[float, float],
) -> tuple[StickIntervals, float]:
    """The stick zones by Newton's method from a guess (N, 2), and its last step.

    `beside` gives the zones of slip for ends, `change` is ΔQ and Δτ. The step is over the width of
    what is beside each end; it is infinite where the method does not settle.
    """
    last, inverse = np.inf, None
    for _ in range(MOST_STEPS):
        found = beside(ends)
        width = np.diff(np.concatenate(([outer.x1], ends.ravel(), [outer.x2])))
        nearest = np.minimum(width[:-1], width[1:])
        if not nearest.min() > SAME * outer.r:
            break
        missed = found.missed(*change)
        if inverse is None or np.abs((inverse @ missed) / nearest).max() > SLOW * last:
            h = DIFFERENCE * nearest
            moved = [beside(ends + d.reshape(ends.shape)).missed(*change) for d in np.diag(h)]
            matrix = (np.array(moved) - missed).T / h
            size = np.abs(matrix).max(axis=1)
            if not (np.isfinite(matrix).all() and size.min() > 0.0):
                break
            if not abs(np.linalg.det(matrix.T / size)) > 0.0:
                break
            inverse = np.linalg.inv(matrix.T / size).T / size
        step = -inverse @ missed
        told = float(np.abs(step / nearest).max())
        if told <= SETTLED or (told <= ROUNDING and told >= 0.5 * last):
            return found, told
        shorter = np.maximum(-np.diff(np.concatenate(([0.0], step, [0.0]))), TINY)
        share = min(1.0, float((MOST_TAKEN * width / shorter).min()))
        ends, last = ends + share * step.reshape(ends.shape), told
    return found, math.inf
