"""Gauss-Legendre panels on the patches and in the gaps between them.

On a patch [a, b] the angle φ from the nearer edge, t = a + 2r sin²(φ/2) or b - 2r sin²(φ/2), takes
the square root out of the integrals; in a gap, from a patch on either side, the same of its width;
beside the outermost patches x = b + v². Panels end at the breaks of the slope, and are graded
towards an edge as far as the nearest other patch, or the patch behind a gap, asks for.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Chord, Points

if TYPE_CHECKING:
    from sie.numerics.zones import Zones
    from sie.profiles.pieces import Pieces

Array = NDArray[np.float64]
Index = NDArray[np.int64]


Runs = tuple[Index, Array, Array]


class Rule(NamedTuple):
    """The nodes on a panel, and the lengths of panels.

    The first panel at an edge is given over the angle of the nearest singularity, the next ones by
    their growth.
    """

    nodes: int
    first: float
    growth: float


LONG, SHORT = Rule(16, 1.5, 4.0), Rule(10, 0.5, 2.0)
FINE = Rule(16, 0.5, 2.0)  # where values between the nodes are asked for as well
SLACK = 1.3  # the last panel of a graded row is longer than the others by no more
MANY = 6.0  # breaks on a patch, on average: short panels from there on
# half-widths of the whole contact: how far out the gap is tested where the indenter does not end
FARTHEST = 1e4
LITTLE = 0.25  # of a period
# parts of panels, on which bounds are found: the nodes of one, and how often it is halved
NODES, DEEPEST = 8, 30
# at a first look: the nodes of a panel, on which what varies by no more than this part of its mean
# is positive
FIRST, CLEARLY = 4, 0.5


@dataclass(frozen=True, eq=False)
class Patches:
    """The patches [a, b], ascending, disjoint; per period they lie in [a_1, a_1 + λ)."""

    a: Array
    b: Array
    chord: Chord

    @classmethod
    def of(cls, zones: Zones, chord: Chord) -> Patches:
        a, b = np.array(zones, dtype=float).T
        return cls(a, b, chord)

    @property
    def zones(self) -> tuple[tuple[float, float], ...]:
        return tuple(zip(self.a.tolist(), self.b.tolist(), strict=True))

    @property
    def number(self) -> int:
        return len(self.a)

    @cached_property
    def r(self) -> Array:
        return np.asarray(0.5 * (self.b - self.a))

    @cached_property
    def c(self) -> Array:
        return np.asarray(self.a + self.r)

    @property
    def hull(self) -> float:
        """The distance of the outermost two edges."""
        return float(self.b[-1] - self.a[0])

    @cached_property
    def gaps(self) -> Array:
        """Widths of the gaps to the right of each patch; inf beside the last one on the line."""
        following = np.append(self.a[1:], self.a[0] + self.chord.period)
        return np.asarray(following - self.b)

    @cached_property
    def beside(self) -> Array:
        """The width of the gap beside each edge, (2N,)."""
        return np.stack((np.roll(self.gaps, 1), self.gaps), axis=1).ravel()

    @property
    def narrower(self) -> Array:
        """The half-width of its patch or the gap beside it, the shorter, of each edge (2N,)."""
        return np.minimum(np.repeat(self.r, 2), self.beside)

    @property
    def closing(self) -> bool:
        """Whether little is left open of a period."""
        return self.chord.periodic and bool(self.gaps.sum() < LITTLE * self.chord.period)

    @cached_property
    def whole(self) -> Array:
        """d(b, a) of each patch; per period from the rest of it, where that is shorter."""
        width, rest = self.b - self.a, (self.a - self.b) + self.chord.period
        return np.asarray(self.chord.apart(0.0, np.minimum(width, rest)))

    @cached_property
    def edges(self) -> Array:
        """a_1, b_1, a_2, b_2 ..."""
        return np.stack((self.a, self.b), axis=1).ravel()

    def unknown_share(self, pieces: Pieces, load: float) -> float:
        """The part of a patch's load that the rounding of h decides, from patch to patch, about."""
        known = pieces.rounding(self.b[:-1], self.a[1:]).max(initial=0.0)
        return self.number * float(known) / load

    def rule(self, pieces: Pieces) -> Rule:
        inside = np.searchsorted(pieces.breaks, self.b) - np.searchsorted(pieces.breaks, self.a)
        many = inside.sum() > MANY * self.number and not pieces.series.any()
        return SHORT if many else LONG


@dataclass(frozen=True, eq=False)
class PatchPanels:
    """Panels (p,) on patches, nodes (p, n).

    patch, piece    (p,) indices
    right           (p,) whether the angle counts from b
    lo, hi          (p,) angles
    points          anchors (p, 1) and offsets (p, n)
    angle           (p, n) length of the panel times Gauss weights
    """

    patch: Index
    piece: Index
    right: NDArray[np.bool_]
    lo: Array
    hi: Array
    points: Points
    angle: Array


def _graded(rule: Rule, nearest: Array, end: Array, breaks: tuple[Index, Array]) -> Runs:
    """Panels of rows from 0 to `end` (R,): the row and the ends of each, ascending.

    They are graded over the distance `nearest` (R,) of the nearest singularity, and cut at breaks
    (row, place) as well.
    """
    first, every = rule.first * nearest, np.arange(len(end))
    steps = np.ceil(np.log(np.maximum(end / first, 1e-300) / SLACK) / np.log(rule.growth))
    count = np.where(first < end / SLACK, np.maximum(steps, 1.0), 0.0).astype(int)
    graded = np.repeat(every, count)
    power = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    row = np.concatenate((every, graded, breaks[0], every))
    place = np.concatenate((np.zeros(len(end)), first[graded] * rule.growth**power, breaks[1], end))
    order = np.lexsort((place, row))
    row, place = row[order], place[order]
    panel = (row[1:] == row[:-1]) & (place[1:] > place[:-1])
    return row[:-1][panel], place[:-1][panel], place[1:][panel]


def patch_panels(patches: Patches, pieces: Pieces) -> PatchPanels:
    rule = patches.rule(pieces)
    a, b, r, N = patches.a, patches.b, patches.r, patches.number
    # rows: both halves of each patch, counted from a and from b
    nearest = 2.0 * np.arcsinh(np.sqrt(patches.beside / (2.0 * np.repeat(r, 2))))
    start, stop = np.searchsorted(pieces.cuts, a, "right"), np.searchsorted(pieces.cuts, b)
    count = np.maximum(stop - start, 0)
    of = np.repeat(np.arange(N), count)
    cut = pieces.cuts[np.arange(count.sum()) + np.repeat(start - np.cumsum(count) + count, count)]
    inward = np.concatenate((cut - a[of], b[of] - cut))
    row = np.concatenate((2 * of, 2 * of + 1))
    half = inward < r[row // 2]
    row, inward = row[half], inward[half]
    angle = 2.0 * np.arcsin(np.sqrt(inward / (2.0 * r[row // 2])))
    row, lo, hi = _graded(rule, nearest, np.full(2 * N, 0.5 * np.pi), (row, angle))
    patch, at_right = row // 2, row % 2 == 1
    g, w = chebyshev.gauss_legendre(rule.nodes)
    phi = lo[:, None] + (hi - lo)[:, None] * g
    inward = 2.0 * r[patch, None] * np.sin(0.5 * phi) ** 2
    points = Points(
        np.where(at_right, b[patch], a[patch])[:, None],
        np.where(at_right[:, None], -inward, inward),
    )
    middle = points.x[:, rule.nodes // 2]
    return PatchPanels(
        patch, pieces.locate(middle), at_right, lo, hi, points, (hi - lo)[:, None] * w
    )


@dataclass(frozen=True, eq=False)
class GapPanels:
    """Panels (p,) in gaps, nodes (p, n).

    Gap i is to the right of patch i; on the line -1 and N - 1 are outside.

    gap             (p,) its number
    right           (p,) whether the panel counts from the right end of its gap
    piece           (p,) the piece of H at the edge that it counts from, as the patch has it
    follows         (p,) whether that piece may be continued over the panel
    lo, hi          (p,) the parameter: an angle, or v
    width           (p,) of the gap, inf outside
    points          anchors (p, 1) and offsets (p, n)
    root            (p, n) what vanishes at the edges like a square root: sin φ, or v
    dx              (p, n) dx times Gauss weights
    """

    gap: Index
    right: NDArray[np.bool_]
    piece: Index
    follows: NDArray[np.bool_]
    lo: Array
    hi: Array
    width: Array
    points: Points
    root: Array
    dx: Array

    def __getitem__(self, some: slice) -> GapPanels:
        return GapPanels(*(getattr(self, field.name)[some] for field in fields(self)))


def distance_of(parameter: Array, width: Array) -> tuple[Array, Array, Array]:
    """(distance from the edge, root, derivative of the distance) at a parameter of a gap.

    The gap has this width.
    """
    inner = np.isfinite(width)
    w = np.where(inner, width, 1.0)
    angle = np.where(inner, parameter, 0.0)
    distance = np.where(inner, w * np.sin(0.5 * angle) ** 2, parameter * parameter)
    root = np.where(inner, np.sin(angle), parameter)
    return distance, root, np.where(inner, 0.5 * w * root, 2.0 * parameter)


def parameter_of(distance: Array, width: Array) -> Array:
    """The parameter at a distance from the edge, of which `distance_of` gives the distance."""
    inner = np.isfinite(width)
    angle = 2.0 * np.arcsin(np.sqrt(np.minimum(distance / np.where(inner, width, 1.0), 1.0)))
    return np.where(inner, angle, np.sqrt(distance))


def _sides(
    N: int, outside: bool, closing: bool, periodic: bool
) -> tuple[Index, NDArray[np.bool_], NDArray[np.bool_]]:
    """The gap that each side belongs to, whether it is at the right of it, and of an inner gap.

    A gap i has two sides, from patch i upwards and from patch i + 1 downwards.
    """
    number, at_right = (v.ravel() for v in np.indices((N + 1, 2)))
    number, at_right = number - 1, at_right == 1
    inner = (number >= 0) & (number < N - 1 + periodic)
    outer = ((number == -1) & at_right) | ((number == N - 1) & ~at_right)
    kept = (inner & (outside | closing | (number < N - 1))) | (
        outer & ~inner & outside & (not periodic)
    )
    return number[kept], at_right[kept], inner[kept]


def gap_panels(
    patches: Patches, pieces: Pieces, outside: bool = False, farthest: float = FARTHEST
) -> GapPanels:
    """The panels of all gaps; `outside` adds the outer ones, or per period the last.

    Where a period is closing the last is there as well.
    """
    rule = FINE if outside else LONG
    a, b, N = patches.a, patches.b, patches.number
    number, at_right, inner = _sides(N, outside, patches.closing, patches.chord.periodic)
    k = (number + at_right) % N
    edge = np.where(at_right, a[k], b[k])
    piece = np.where(at_right, pieces.locate(a)[k], pieces.locate(b, "left")[k])
    width = np.where(inner, patches.gaps[number], np.inf)
    own = np.where(at_right, edge - pieces.breaks[piece], pieces.breaks[piece + 1] - edge)
    followed = np.minimum(own + pieces.reach[piece], pieces.plain[piece])
    size = 2.0 * patches.r[k]
    stop = np.where(at_right, edge - pieces.breaks[0], pieces.breaks[-1] - edge)
    far = np.sqrt(np.minimum(np.maximum(stop, 0.0), farthest * patches.hull))
    nearest = np.where(inner, 2.0 * np.arcsinh(np.sqrt(size / width)), np.sqrt(size))
    end = np.where(inner, 0.5 * np.pi, far)
    limit = parameter_of(followed, width)
    # waves of the pressure show beside an edge, and so does a kink of H close to it
    inward = edge - pieces.breaks[piece + at_right]
    # its integral asks for that of H' only, its values between the nodes for that of H'' as well
    bent = (outside | pieces.bends(piece, at_right)) & (np.abs(inward) < size)
    near = np.sqrt(np.abs(inward) / np.where(inner, width, 1.0))
    kink = np.where(bent, np.where(inner, 2.0 * np.arcsinh(near), near), np.inf)
    wave = parameter_of(pieces.plain[piece], width) / rule.first
    nearest = np.minimum(np.minimum(nearest, kink), wave)
    first = np.where(rule.first * nearest < end / SLACK, rule.first * nearest, end)
    shorter = np.flatnonzero(limit < first)
    row, lo, hi = _graded(rule, nearest, end, (shorter, limit[shorter]))
    g, w = chebyshev.gauss_legendre(rule.nodes)
    parameter = lo[:, None] + (hi - lo)[:, None] * g
    distance, root, derivative = distance_of(parameter, width[row, None])
    right = at_right[row]
    points = Points(edge[row, None], np.where(right[:, None], -distance, distance))
    dx = derivative * (hi - lo)[:, None] * w
    return GapPanels(
        number[row], right, piece[row], lo == 0.0, lo, hi, width[row], points, root, dx
    )


def halves(lo: Array, hi: Array) -> tuple[Array, Array]:
    """The ends of the left halves of parts, then those of the right ones."""
    middle = 0.5 * (lo + hi)
    return np.concatenate((lo, middle)), np.concatenate((middle, hi))
