"""Composite Gauss-Legendre quadrature in the angle φ, graded towards the breaks of a slope.

A corner of the slope leaves (x - e)^(m+1) ln|x - e| in the pressure, m the order of the derivative
of H that jumps there. Panels are graded towards the breaks, and none is much longer than its
neighbours. Each of a few breaks is treated as a corner. Where there are many (a trace), the jumps
at a break determine the number of levels, which for a smooth spline is none or one.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Chord, Points
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.graded_rule import GRADING, NODES, balanced, graded, on_panels
from sie.numerics.interval import EPS, Interval, angles, inner, position
from sie.patches.panels import Patches
from sie.patches.rule import Rule as PatchRule
from sie.profiles.functions import PowerLaw
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope

Array = NDArray[np.float64]

FEW_BREAKS = 40
# Panels need no grading to an edge, but the residual is wanted near it.
TOWARDS_EDGE = np.array([0.0625, 0.125, 0.1875])
# What the last panel of a graded rule leaves is rounding with LEVELS for the logarithm under a
# corner of the profile, and with fewer levels for the root at the end of a stick zone, and for the
# x ln|x| under a corner of the slope.
LEVELS, ROOT_LEVELS, KINK_LEVELS = 22, 14, 9
# Part of the distance from the next break: a resolution halves its pieces towards a break, and
# shorter pieces resolve another feature.
CLOSING_IN = 0.1
COMPARABLE = 0.05  # smaller panels close in on a corner, where rounding of x hides all
LONGEST = np.pi / 32  # of a panel where there are many
POINTS = 48  # at which the residual is measured: between the longest panels, where no node is near


class Rule(NamedTuple):
    """A rule on one contact, angles from the right edge, and places between its points.

    on         nodes and weights of ∫ dx; the patch of those next to an edge in sliding is -1
    line       the rest of the contact, as a patch
    between    ends of large panels, where no node is near
    """

    on: PatchRule
    line: Patches
    angle: Array
    between: Array

    @property
    def x(self) -> Array:
        """The nodes."""
        return np.asarray(self.on.points.x)

    @property
    def weight(self) -> Array:
        """Those of ∫ dx."""
        return self.on.weight


def finite(values: Array) -> Array:
    """The values, with 0 in place of infinities.

    A node that rounding put on a corner of the profile has the weight of rounding.
    """
    return np.where(np.isfinite(values), values, 0.0)


def composite_rule(
    contact: Interval,
    slope: Slope,
    also: Array | None = None,
    epsilon: float = 0.0,
    *,
    resolution: Slope | None = None,
) -> Rule:
    """The composite rule; `also` are places inside to be treated as breaks.

    `resolution` is the slope with its functions resolved in the contact.

    Graded towards the breaks, and cut at those that a function's resolution added: these may close
    in on a kink. The panels next to the edges take the powers ψ^(±2ε) of sliding into their
    weights.
    """
    many = not slope.functions and len(inner(contact, slope.breaks)) > FEW_BREAKS
    also = np.zeros(0) if also is None else also
    resolution = resolution or refined(slope, contact.x1, contact.x2, EPS)
    edges, large = (
        _panels_of_many(contact, slope, also) if many else _panels(contact, slope, also, resolution)
    )
    angle, weight = on_panels(edges)
    if epsilon:
        length = np.diff(edges)
        for k, power, start in ((0, -2.0 * epsilon, edges[0]), (-1, 2.0 * epsilon, edges[-1])):
            g, _, w = gauss_jacobi(NODES, 0.0, power)
            angle[k] = abs(start - length[k] * g)
            weight[k] = length[k] * w / g**power
    x = position(contact, angle)
    _count_from_breaks(x, contact, edges, np.union1d(inner(contact, resolution.breaks), also))
    x, weight, angle = x.ravel(), (weight * contact.r * np.sin(angle)).ravel(), angle.ravel()
    ends, patch = contact[:2], np.zeros(len(x), dtype=int)
    if epsilon:
        large = large[(large > edges[1]) & (large < edges[-2])]
        x2, x1 = position(contact, edges[[1, -2]]).tolist()
        ends, patch[:NODES], patch[-NODES:] = (x1, x2), -1, -1
    on = PatchRule(Points(np.zeros(1), x), patch, np.zeros(0, dtype=int), weight)
    return Rule(on, Patches.of((ends,), Chord()), angle, position(contact, large))


def _count_from_breaks(x: Array, contact: Interval, edges: Array, breaks: Array) -> None:
    """Count the nodes x (panels, NODES) on both panels beside each break from that break.

    By their angles alone they are rounded like the edges of the contact: with a corner at
    x = -1e-300 a node at x = 0 would take the logarithm of 1e-300 for that of its distance.
    """
    start, length = angles(contact, breaks)[::-1], np.diff(edges)
    k = np.searchsorted(edges, start).clip(max=len(length))
    found = edges[k] == start
    g = chebyshev.gauss_legendre(NODES)[0]
    for beside, step in ((k, g), (k - 1, -g[::-1])):  # x falls as the angle grows
        # the panels next to the edges have a rule of their own
        chosen = found & (beside > 0) & (beside < len(length) - 1)
        j, psi = beside[chosen], start[chosen, None]
        half_turn = 0.5 * length[j, None] * step
        offset = -2.0 * contact.r * np.sin(half_turn) * np.sin(psi + half_turn)
        x[j] = breaks[chosen, None] + offset


def _panels(contact: Interval, slope: Slope, also: Array, resolution: Slope) -> tuple[Array, Array]:
    """The ends of the panels, as angles from the right edge, and those of the largest."""
    levels = _levels_of_few(slope, also)
    cut = angles(contact, np.union1d(inner(contact, resolution.breaks), also))
    # Many breaks of a resolution close in on a few places by themselves; of few, each may be a
    # corner that was not declared
    towards = (
        cut
        if len(cut) <= FEW_BREAKS
        else angles(contact, np.union1d(inner(contact, slope.breaks), also))
    )
    ends = np.concatenate(([0.0], towards, [np.pi]))
    cut = cut[_shorter_than_graded(cut, ends)]
    cuts = [cut]
    inwards = graded(levels)[:-1]
    for k, (lo, hi) in enumerate(pairwise(ends)):
        left = inwards if k > 0 else TOWARDS_EDGE
        right = 1.0 - (inwards if k < len(ends) - 2 else TOWARDS_EDGE)[::-1]
        cuts.append(
            lo + (hi - lo) * np.concatenate(([0.0], left, np.linspace(0.25, 0.75, 9), right))
        )
    edges = balanced(np.unique(np.concatenate([*cuts, [np.pi]])))
    length = np.diff(edges)
    return edges, edges[1:-1][_largest(edges[1:-1], np.minimum(length[:-1], length[1:]))]


def _shorter_than_graded(cut: Array, ends: Array) -> NDArray[np.bool_]:
    """Whether each cut bounds a piece that is shorter than the grading towards the ends."""
    k = np.searchsorted(ends, cut, side="right").clip(1, len(ends) - 1)
    distance = np.minimum(cut - ends[k - 1], ends[k] - cut)
    beside = np.diff(cut, prepend=-np.inf, append=np.inf)
    return np.minimum(beside[:-1], beside[1:]) < CLOSING_IN * distance


def _panels_of_many(contact: Interval, slope: Slope, also: Array) -> tuple[Array, Array]:
    """The panels where the slope has many breaks, and the middles of the largest pieces.

    Each piece is one panel, graded where a break needs it.
    """
    cut = angles(contact, inner(contact, slope.breaks))
    ends = np.concatenate(([0.0], cut, [np.pi]))
    length = np.diff(ends)
    levels = _levels(slope, contact)[::-1]
    parts = np.ceil(length / LONGEST).astype(int)
    # The number of each part within its piece.
    number = np.arange(parts.sum()) - np.repeat(parts.cumsum() - parts, parts)
    within = np.repeat(ends[:-1], parts) + np.repeat(length / parts, parts) * number
    middle = 0.5 * (ends[:-1] + ends[1:])
    chosen = middle[_largest(middle, length)]
    cuts = [within, [np.pi], chosen, length[0] * TOWARDS_EDGE, np.pi - length[-1] * TOWARDS_EDGE]
    beside = LONGEST * graded(LEVELS - 1)
    cuts += [c + np.concatenate(([0.0], beside, -beside)) for c in angles(contact, also)]
    for level in range(1, int(levels.max()) + 1):
        at = np.flatnonzero(levels >= level)
        cuts += [cut[at] - GRADING**level * length[at], cut[at] + GRADING**level * length[at + 1]]
    every = np.unique(np.concatenate(cuts))
    return balanced(every[(every >= 0.0) & (every <= np.pi)]), chosen


def _levels_of_few(slope: Slope, also: Array) -> int:
    """The number of gradings at the breaks where these are few.

    Under powers |x|^(a+1) of the profile alone the pressure has |x|^a, which needs fewer.
    """
    powers = [f.function for f in slope.functions if isinstance(f.function, PowerLaw)]
    if not powers or len(powers) < len(slope.functions) or slope.coefficients.any() or also.size:
        return LEVELS if not slope.continuous else ROOT_LEVELS if also.size else KINK_LEVELS
    a = min(power.exponent for power in powers) - 1.0
    return math.ceil(max(math.log(EPS ** (-1.0 / (a + 1.0)) / NODES**2) / -math.log(GRADING), 0.0))


def _levels(slope: Slope, contact: Interval) -> NDArray[np.int64]:
    """The number of gradings at each break inside.

    After so many, the error of NODES nodes for (x - e)^(m+1) ln|x - e| is rounding.
    """
    b = slope.breaks[1:-1]
    inside = (contact.from_left(b) > 0.0) & (contact.from_right(b) > 0.0)
    longer = np.minimum(
        np.maximum(np.diff(slope.breaks)[:-1], np.diff(slope.breaks)[1:])[inside], 2.0 * contact.r
    )
    jumps = np.abs(slope.corners[inside])
    m = np.arange(jumps.shape[1])
    scale = float(np.abs(slope(np.array([contact.x1, contact.x2]))).max()) or 1.0
    size = (jumps * longer[:, None] ** m / (scale * EPS)) ** (1.0 / (m + 1)) / NODES**2
    return np.clip(
        np.ceil(np.log(np.maximum(size.max(axis=1), 1.0)) / -np.log(GRADING)), 0, LEVELS
    ).astype(np.int64)


def _largest(x: Array, size: Array) -> list[int]:
    """The largest in each of POINTS parts of the contact, by angles x."""
    part = np.minimum((x * (POINTS / np.pi)).astype(int), POINTS - 1)
    ascending = np.argsort(size)
    large = ascending[size[ascending] >= COMPARABLE * size.max()]
    return sorted(dict(zip(part[large].tolist(), large.tolist(), strict=True)).values())
