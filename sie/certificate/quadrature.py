"""Composite Gauss-Legendre quadrature in the angle φ, graded towards the breaks of a slope.

A corner of the slope leaves (x - e)^(m+1) ln|x - e| in the pressure, m the order of the derivative
of H that jumps there. Panels are graded towards the breaks, and none is much longer than its
neighbours. The jumps at a break determine the number of levels, which for a smooth spline is none
or one; each break of a function is treated as a corner.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Chord, Points
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.graded_rule import GRADING, NODES, balanced, on_panels
from sie.numerics.interval import EPS, Interval, angles, inner, position
from sie.patches.panels import Patches
from sie.patches.rule import Rule as PatchRule
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
LONGEST, PARTS = np.pi / 16, 8  # of a panel; panels of a piece at least where pieces are few
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
    also = np.zeros(0) if also is None else also
    resolution = resolution or refined(slope, contact.x1, contact.x2, EPS)
    breaks = np.union1d(inner(contact, resolution.breaks), also)
    edges = _panels(contact, slope, also, breaks)
    length = np.diff(edges)
    large = edges[1:-1][_largest(edges[1:-1], np.minimum(length[:-1], length[1:]))]
    angle, weight = on_panels(edges)
    if epsilon:
        for k, power, start in ((0, -2.0 * epsilon, edges[0]), (-1, 2.0 * epsilon, edges[-1])):
            g, _, w = gauss_jacobi(NODES, 0.0, power)
            angle[k] = abs(start - length[k] * g)
            weight[k] = length[k] * w / g**power
    x = position(contact, angle)
    _count_from_breaks(x, contact, edges, breaks)
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


def _panels(contact: Interval, slope: Slope, also: Array, breaks: Array) -> Array:
    """The ends of the panels, as angles from the right edge."""
    # Many breaks of a resolution close in on a few places by themselves; of few, each may be a
    # corner that was not declared
    towards = breaks
    if slope.functions and len(breaks) > FEW_BREAKS:
        towards = np.union1d(inner(contact, slope.breaks), also)
    ends = np.concatenate(([0.0], angles(contact, towards), [np.pi]))
    length, resolved = np.diff(ends), angles(contact, breaks)
    least = PARTS if len(towards) <= FEW_BREAKS else 1
    parts = np.ceil(length / LONGEST).clip(min=least).astype(int)
    # The number of each part within its piece.
    number = np.arange(parts.sum()) - np.repeat(parts.cumsum() - parts, parts)
    cuts = [ends, np.repeat(ends[:-1], parts) + np.repeat(length / parts, parts) * number]
    cuts += [length[0] * TOWARDS_EDGE, np.pi - length[-1] * TOWARDS_EDGE]
    cuts += [resolved[_shorter_than_graded(resolved, ends)]]
    levels = _levels(slope, contact, towards, also)[::-1]
    for level in range(1, int(levels.max(initial=0)) + 1):
        at = np.flatnonzero(levels >= level)
        share, cut = GRADING**level, ends[1:-1][at]
        cuts += [cut - share * length[at], cut + share * length[at + 1]]
    every = np.unique(np.concatenate(cuts))
    # Parts and gradings meet in places that are the same but for rounding
    apart = np.append(True, np.diff(every) > 4.0 * np.spacing(every[1:]))
    return balanced(every[apart | np.isin(every, ends)])


def _shorter_than_graded(cut: Array, ends: Array) -> NDArray[np.bool_]:
    """Whether each cut bounds a piece that is shorter than the grading towards the ends."""
    k = np.searchsorted(ends, cut, side="right").clip(1, len(ends) - 1)
    distance = np.minimum(cut - ends[k - 1], ends[k] - cut)
    beside = np.diff(cut, prepend=-np.inf, append=np.inf)
    return np.minimum(beside[:-1], beside[1:]) < CLOSING_IN * distance


def _levels(slope: Slope, contact: Interval, towards: Array, also: Array) -> NDArray[np.int64]:
    """The number of gradings at each break.

    After so many, the error of NODES nodes for (x - e)^(m+1) ln|x - e| is rounding, m the order of
    the derivative of H that jumps; a function may have any corner.
    """
    if slope.functions:
        return np.full(len(towards), LEVELS)
    b = inner(contact, slope.breaks[1:-1])
    inside = np.isin(slope.breaks[1:-1], b)
    pieces = np.diff(slope.breaks)
    longer = np.minimum(np.maximum(pieces[:-1], pieces[1:])[inside], 2.0 * contact.r)
    jumps = np.abs(slope.corners[inside])
    m = np.arange(jumps.shape[1])
    scale = float(np.abs(slope(np.array([contact.x1, contact.x2]))).max()) or 1.0
    size = (jumps * longer[:, None] ** m / (scale * EPS)) ** (1.0 / (m + 1)) / NODES**2
    levels = np.where(np.isin(towards, also), ROOT_LEVELS, 0)
    found = np.ceil(np.log(np.maximum(size.max(axis=1), 1.0)) / -np.log(GRADING))
    known = np.searchsorted(towards, b)
    most = np.where(slope.steps[inside] != 0.0, LEVELS, KINK_LEVELS)
    levels[known] = np.maximum(levels[known], np.minimum(found, most).astype(int))
    return levels


def _largest(x: Array, size: Array) -> list[int]:
    """The largest in each of POINTS parts of the contact, by angles x."""
    part = np.minimum((x * (POINTS / np.pi)).astype(int), POINTS - 1)
    ascending = np.argsort(size)
    large = ascending[size[ascending] >= COMPARABLE * size.max()]
    return sorted(dict(zip(part[large].tolist(), large.tolist(), strict=True)).values())
