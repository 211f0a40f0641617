"""A composite rule on patches and places between its points, which no solver uses.

The certificates integrate values of tractions by it.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Points
from sie.numerics.tree import parts

from .panels import LONG, Patches, PatchPanels

if TYPE_CHECKING:
    from .measure import Measure

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]

# nodes on a part of a panel: of those that are graded slowly, and of those of many breaks
NODES, FEWER = 40, 24
STEEP = 4.0  # a panel that is so much longer than its neighbour is cut towards that one
DEEP = 26  # cuts towards a jump of H, each STEEP times nearer: p is infinite there like a logarithm
BESIDE = 5  # cuts towards edges, where there are few panels: down to SHORT
SHORT = 1e-3  # of a panel: on shorter parts the equation is not measured
# ulp of an edge: closer to it the edge's own rounding changes p by a part of 1e-6
APART = 5e5
PLACES = 120  # at which it is, about


class Rule(NamedTuple):
    """Points on patches, the pieces of H that they are on, and weights dx."""

    points: Points
    patch: Index
    piece: Index
    weight: Array


def rule_of(o: Measure) -> tuple[Rule, Rule]:
    """A composite rule on the panels of an operator, and places between its points.

    At the latter the equation is measured.

    The variable is bent at the ends of panels: p has breaks like s² ln s where H' of a spline has,
    and s^8 ln s is easy. At an edge p is smooth in the angle.
    """
    k = o.panels
    nodes = NODES if k.angle.shape[1] == LONG.nodes else FEWER
    panel, lo, length = _cut(k, _jumps_at_ends(o))
    g, w = _bent(lo == 0.0, nodes)
    rule = _at_angles(o, panel, lo[:, None] + length[:, None] * g)
    rule = rule._replace(weight=(length[:, None] * w).ravel() * rule.weight)
    r, edge = o.patches.r[k.patch[panel]], k.points.anchor[panel, 0]
    far = 2.0 * r * np.sin(0.5 * (lo + 0.25 * length)) ** 2 >= np.minimum(
        APART * np.spacing(np.abs(edge)), 0.1 * r
    )
    some = np.flatnonzero((length > SHORT * (k.hi - k.lo)[panel]) & far)
    some = some if some.size else np.arange(len(lo))
    some = some[:: max(len(some) // PLACES, 1)]
    number = min(-(-PLACES // len(some)), nodes // 2)
    # Not close to the ends of parts, between which a place makes the kernel as steep as it is
    # close, and midway between two points: beside one the quotient is rounding.
    wanted = 0.25 + 0.5 * (np.arange(number) + 0.5) / number
    g = g[some]
    after = (g[:, :, None] < wanted).sum(axis=1)
    part = 0.5 * (np.take_along_axis(g, after - 1, 1) + np.take_along_axis(g, after, 1))
    angle = lo[some, None] + length[some, None] * part
    return rule, _at_angles(o, panel[some], angle)


def _jumps_at_ends(o: Measure) -> Mask:
    """Whether H jumps at the end k.lo and at the end k.hi of each panel, (2, p)."""
    k, pieces = o.panels, o.pieces
    jump = np.zeros(len(pieces.breaks), dtype=bool)
    jump[1:-1] = pieces.steps != 0.0
    ends = np.stack(o.ends)
    closest = pieces.breaks[k.piece + np.array([[0], [1]])]
    reached = np.abs(ends - closest) <= SHORT * (ends[1] - ends[0])
    left, right = reached & jump[k.piece + np.array([[0], [1]])]
    return np.where(k.right, (right, left), (left, right)) & (np.stack((k.lo, k.hi)) > 0.0)


def _cut(k: PatchPanels, jumps: Mask) -> tuple[Index, Array, Array]:
    """Parts (panel, lowest angle, length) of the panels.

    Panels are whole, but beside a much shorter panel, and at a jump of H, no part is longer than
    STEEP times its distance from there.

    At a place on the shorter one the kernel is as steep as its length.
    """
    length = k.hi - k.lo
    order = np.lexsort((np.where(k.right, np.pi - k.hi, k.lo), k.patch))
    meet = k.patch[order][1:] == k.patch[order][:-1]
    left, right = np.full((2, len(length)), np.inf)  # lengths of the neighbours
    left[order[1:]] = np.where(meet, length[order[:-1]], np.inf)
    right[order[:-1]] = np.where(meet, length[order[1:]], np.inf)
    neighbours = np.where(k.right, (right, left), (left, right))  # towards k.lo and k.hi
    times = np.ceil((np.log(length) - np.log(neighbours)) / np.log(STEEP) - 1.0).clip(0.0)
    times = np.where(jumps, DEEP, times)
    if len(length) < PLACES:
        times[0, k.lo == 0.0] = BESIDE
    panels, lows, lengths = [], [], []
    for towards_lo, towards_hi in np.unique(times, axis=1).T.astype(int).tolist():
        chosen = np.flatnonzero((times[0] == towards_lo) & (times[1] == towards_hi))
        lower = STEEP ** -np.arange(towards_lo, 0.0, -1.0)
        upper = 1.0 - STEEP ** -np.arange(1.0, towards_hi + 1.0)
        part = np.concatenate(([0.0], lower, upper, [1.0]))
        lows.append((k.lo[chosen, None] + length[chosen, None] * part[:-1]).ravel())
        lengths.append((length[chosen, None] * np.diff(part)).ravel())
        panels.append(np.repeat(chosen, len(part) - 1))
    return np.concatenate(panels), np.concatenate(lows), np.concatenate(lengths)


def _bent(at_edge: Mask, nodes: int) -> tuple[Array, Array]:
    """Gauss' nodes and weights on [0, 1] in a bent variable.

    Its cube is the distance from an end, the upper one only where the lower one is an edge.
    """
    g, w = chebyshev.gauss_legendre(nodes)
    both = g**3 * (10.0 - 15.0 * g + 6.0 * g * g), 30.0 * w * (g * (1.0 - g)) ** 2
    upper = 1.0 - (1.0 - g) ** 3, 3.0 * w * (1.0 - g) ** 2
    place, weight = (np.where(at_edge[:, None], u, b) for u, b in zip(upper, both, strict=True))
    return place, weight


def _at_angles(o: Measure, panel: Index, angle: Array) -> Rule:
    """Points at angles (m, n) on panels (m,), with dx/d(angle) as weights."""
    k = o.panels
    r = o.patches.r[k.patch[panel], None]
    inward = 2.0 * r * np.sin(0.5 * angle) ** 2
    offset = np.where(k.right[panel, None], -inward, inward)
    anchor = np.broadcast_to(k.points.anchor[panel], offset.shape)
    patch, piece = (np.repeat(v[panel], angle.shape[1]) for v in (k.patch, k.piece))
    return Rule(Points(anchor.ravel(), offset.ravel()), patch, piece, (r * np.sin(angle)).ravel())


def principal_value(
    P: Patches, rule: Rule, f: Array, at: tuple[Points, Index], values: Array
) -> Array:
    """1/π PV∫f(t)/(x - t) dt at places, with their patches and values, of f on a rule's points."""
    chord, (x, own) = P.chord, at
    left, right = (chord.apart(x.anchor - e[own], x.offset) for e in (P.a, P.b))
    total = values * np.log(left / -right)
    for some in parts(len(own), len(f)):
        distance = chord.difference(
            x.anchor[some, None] - rule.points.anchor, x.offset[some, None] - rule.points.offset
        )
        kernel = chord.kernel(distance)
        first = some.start + np.flatnonzero(np.diff(own[some], prepend=-1))
        for lo, hi in pairwise([*first.tolist(), some.start + len(kernel)]):
            there = rule.patch == own[lo]
            taken_out = values[lo:hi, None] * (1.0 if there.all() else there)
            left = kernel[lo - some.start : hi - some.start]
            left *= f - taken_out
            total[lo:hi] += left @ rule.weight
    return np.asarray(total / np.pi)
