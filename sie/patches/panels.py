"""Gauss-Legendre panels on the patches and in the gaps between them.

On a patch [a, b] the angle φ from the nearer edge, t = a + 2r sin²(φ/2) or b - 2r sin²(φ/2), takes
the square root out of the integrals; in a gap, from a patch on either side, the same of its width;
beside the outermost patches x = b + v². Panels end at the breaks of the slope, and are graded
towards an edge as far as the nearest other patch, or the patch behind a gap, asks for.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .chord import Chord, Points
from .pieces import Pieces

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class Rule(NamedTuple):
    """Nodes on a panel; the first panel at an edge, over the angle of the nearest singularity, and
    how the next ones grow.
    """

    nodes: int
    first: float
    growth: float


LONG, SHORT = Rule(16, 1.5, 4.0), Rule(8, 0.5, 2.0)
FINE = Rule(16, 0.5, 2.0)  # where values between the nodes are asked for as well
MANY = 6.0  # breaks on a patch, on average: short panels from there on
# half-widths of the whole contact: how far out the gap is looked at where the indenter does not end
FARTHEST = 1e4


@dataclass(frozen=True, eq=False)
class Patches:
    """The patches [a, b], ascending, disjoint; per period they lie in [a_1, a_1 + λ)."""

    a: Array
    b: Array
    chord: Chord

    @property
    def number(self) -> int:
        return len(self.a)

    @cached_property
    def r(self) -> Array:
        return np.asarray(0.5 * (self.b - self.a))

    @cached_property
    def c(self) -> Array:
        return np.asarray(self.a + self.r)

    @cached_property
    def gaps(self) -> Array:
        """Widths of the gaps to the right of each patch; inf beside the last one on the line."""
        following = np.append(self.a[1:], self.a[0] + self.chord.period)
        return np.asarray(following - self.b)

    @cached_property
    def edges(self) -> Array:
        """a_1, b_1, a_2, b_2 ..."""
        return np.stack((self.a, self.b), axis=1).ravel()

    def rule(self, pieces: Pieces) -> Rule:
        inside = np.searchsorted(pieces.ends, self.b) - np.searchsorted(pieces.ends, self.a)
        return SHORT if inside.sum() > MANY * self.number else LONG


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


def graded(first: float, growth: float, end: float) -> Array:
    """0, first, first growth, ... below end, end."""
    if not first < end / 1.3:
        return np.array([0.0, end])
    count = int(np.ceil(np.log(end / first / 1.3) / np.log(growth)))
    return np.concatenate(([0.0], first * growth ** np.arange(max(count, 1)), [end]))


def patch_panels(patches: Patches, pieces: Pieces) -> PatchPanels:
    rule = patches.rule(pieces)
    a, b, r = patches.a, patches.b, patches.r
    behind = np.concatenate((patches.gaps[-1:], patches.gaps[:-1]))
    lows, highs, owner, right = [], [], [], []
    start, stop = np.searchsorted(pieces.cuts, a, "right"), np.searchsorted(pieces.cuts, b)
    for i in range(patches.number):
        inner = pieces.cuts[start[i] : stop[i]]
        for side, gap in ((False, behind[i]), (True, patches.gaps[i])):
            cuts = np.array([0.0, 0.5 * np.pi])
            if gap < np.inf:
                nearest = 2.0 * np.arcsinh(np.sqrt(gap / (2.0 * r[i])))
                cuts = graded(rule.first * nearest, rule.growth, 0.5 * np.pi)
            inward = b[i] - inner if side else inner - a[i]
            inward = inward[inward < r[i]]
            if inward.size:
                breaks = 2.0 * np.arcsin(np.sqrt(inward / (2.0 * r[i])))
                cuts = np.unique(np.concatenate((cuts, breaks)))
            lows.append(cuts[:-1])
            highs.append(cuts[1:])
            owner.append(np.full(len(cuts) - 1, i))
            right.append(np.full(len(cuts) - 1, side))
    lo, hi, patch, at_right = (np.concatenate(v) for v in (lows, highs, owner, right))
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

    def parameter(self, panel: Index, distance: Array) -> Array:
        """The parameter at a distance from the edge."""
        width = self.width[panel]
        with np.errstate(invalid="ignore"):
            inner = 2.0 * np.arcsin(np.sqrt(np.minimum(distance / width, 1.0)))
        return np.where(np.isinf(width), np.sqrt(distance), inner)


def distance_of(parameter: Array, width: Array) -> tuple[Array, Array, Array]:
    """(distance from the edge, root, derivative of the distance) at a parameter of a gap of this
    width.
    """
    inner = np.isfinite(width)
    w = np.where(inner, width, 1.0)
    angle = np.where(inner, parameter, 0.0)
    distance = np.where(inner, w * np.sin(0.5 * angle) ** 2, parameter * parameter)
    root = np.where(inner, np.sin(angle), parameter)
    return distance, root, np.where(inner, 0.5 * w * root, 2.0 * parameter)


def gap_panels(
    patches: Patches, pieces: Pieces, outside: bool = False, farthest: float = FARTHEST
) -> GapPanels:
    """The panels of all gaps; `outside` adds the outer ones, or per period the last."""
    rule = FINE if outside else LONG
    a, b, r, N = patches.a, patches.b, patches.r, patches.number
    first = pieces.locate(a)
    last = pieces.locate(b, "left")
    hull = b[-1] - a[0]
    parts: list[tuple[Array, ...]] = []
    for i in range(-1, N):
        inner = 0 <= i < N - 1 or (i == N - 1 and patches.chord.periodic)
        if ((not inner or i == N - 1) and not outside) or (i < 0 and patches.chord.periodic):
            continue
        width = float(patches.gaps[i]) if inner else np.inf
        for side in (False, True):  # counted from patch i, from patch i + 1
            k = (i + 1) % N if side else i
            if k < 0 or (not inner and side != (i < 0)):
                continue
            piece, edge = (first[k], a[k]) if side else (last[k], b[k])
            own = edge - pieces.ends[piece] if side else pieces.ends[piece + 1] - edge
            followed = min(own + pieces.reach[piece], pieces.plain[piece])
            if inner:
                nearest = 2.0 * np.arcsinh(np.sqrt(2.0 * r[k] / width))
                end, limit = 0.5 * np.pi, 2.0 * np.arcsin(np.sqrt(min(followed / width, 1.0)))
            else:
                nearest, limit = np.sqrt(2.0 * r[k]), np.sqrt(followed)
                stop = edge - pieces.ends[0] if side else pieces.ends[-1] - edge
                end = np.sqrt(min(stop, farthest * hull))
                if not end > 0.0:
                    continue
            cuts = graded(rule.first * nearest, rule.growth, end)
            if limit < cuts[1]:
                cuts = np.concatenate(([0.0, limit], cuts[1:]))
            count = len(cuts) - 1
            parts.append(
                (
                    np.full(count, i),
                    np.full(count, side),
                    np.full(count, piece),
                    np.arange(count) == 0,
                    cuts[:-1],
                    cuts[1:],
                    np.full(count, width),
                    np.full(count, edge),
                )
            )
    if not parts:
        parts = [
            tuple(np.zeros(0, dtype=t) for t in (int, bool, int, bool, float, float, float, float))
        ]
    number, at_right, pieces_at, follows, lo, hi, widths, edges = (
        np.concatenate(p) for p in zip(*parts, strict=True)
    )
    g, w = chebyshev.gauss_legendre(rule.nodes)
    parameter = lo[:, None] + (hi - lo)[:, None] * g
    distance, root, derivative = distance_of(parameter, widths[:, None])
    points = Points(edges[:, None], np.where(at_right[:, None], -distance, distance))
    return GapPanels(
        number,
        at_right,
        pieces_at,
        follows,
        lo,
        hi,
        widths,
        points,
        root,
        derivative * (hi - lo)[:, None] * w,
    )
