"""Sums over many sources at many targets: a tree of Chebyshev charges.

Rows of sources, in the order of their places, are gathered in leaves, leaves in pairs, and so on up
to one root. A node acts from afar through charges on the Chebyshev points of its interval (Dutt, Gu
& Rokhlin 1996), whatever the kernel, chords of a period included: their moments, up to their
number, are those of its sources, and the kernel is a series in T_n there that falls like ρ^-n with
ρ = s + sqrt(s² - 1) at s half-lengths from its middle. A group of targets takes every node at the
first level at which that is far; what is left are pairs (row, group) to be summed as they are. So
the cost grows like (sources + targets) log(sources).

Places come in blocks that share a group; the far sums at the blocks of a group are interpolated
within it (`far_sums`).

Greengard & Rokhlin (1987), Barnes & Hut (1986) for the tree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import step_done

from . import chebyshev
from .chord import Chord, Points

Array = NDArray[np.float64]
Index = NDArray[np.int64]

FAR = 2.0  # half-lengths of a node from its middle: its charges serve from here on
CHARGES = 28  # of a node: (FAR + sqrt(FAR² - 1))**-CHARGES is rounding
LEAF = 4  # rows in a leaf
FEWEST = 12  # rows: fewer are summed as they are ...
FEW = 1 << 14  # ... and rows times places: a tree takes longer
SHORTEST = 64.0  # ulp: the half-length of a node that is no longer than the spacing of doubles
CHUNK = 1 << 18  # entries of an array that are computed at once
SEVERAL = 30  # places of a group: sums of so many are interpolated
POINTS = chebyshev.points(CHARGES)
SPREAD = chebyshev.charges(CHARGES)


class Level(NamedTuple):
    """The nodes of a level.

    These are middles, half-lengths, the first and last owner of their rows, and charges (sets,
    nodes, CHARGES).
    """

    middle: Array
    half: Array
    first: Index
    last: Index
    charges: Array

    def points(self, node: Index) -> Points:
        return Points(self.middle[node, None], self.half[node, None] * POINTS)


class Separation(NamedTuple):
    """The nodes and rows that act on groups of targets.

    These are far nodes (level, node, group) by level, and near rows (row, group).
    """

    far: list[tuple[Level, Index, Index]]
    row: Index
    group: Index


class Tree:
    """The tree of rows [lo, hi] (K,) with owners, sources (K, n) and charges (sets, K, n)."""

    def __init__(self, ends: tuple[Array, Array], owner: Index, sources: Points, charges: Array):
        self.ends, self.owner, self.sources, self.charges = ends, owner, sources, charges
        self.order = np.argsort(ends[0] + ends[1], kind="stable")
        self.rows = len(owner)

    @cached_property
    def levels(self) -> list[Level]:
        """The levels, from the leaves to the root."""
        (lo, hi), owner, sources, charges = self.ends, self.owner, self.sources, self.charges
        levels: list[Level] = []
        spare = -self.rows % LEAF
        kept = np.append(self.order, np.repeat(self.order[-1:], spare))
        charges = charges[:, kept]
        charges[:, self.rows :] = 0.0
        shape = (len(kept) // LEAF, LEAF)
        start, end = lo[kept].reshape(shape).min(axis=1), hi[kept].reshape(shape).max(axis=1)
        owners = owner[kept].reshape(shape)
        first, last = owners.min(axis=1), owners.max(axis=1)
        points = Points(
            np.broadcast_to(sources.anchor, sources.offset.shape)[kept], sources.offset[kept]
        )
        while True:
            middle = 0.5 * (start + end)
            half = np.maximum(0.5 * (end - start), SHORTEST * np.spacing(np.abs(middle)))
            shape = (len(middle), -1)
            anchor, offset = points.anchor.reshape(shape), points.offset.reshape(shape)
            u = ((anchor - middle[:, None]) + offset) / half[:, None]
            charges = gathered(u, charges.reshape(len(charges), *shape))
            levels.append(Level(middle, half, first, last, charges))
            if len(middle) == 1:
                return levels
            if len(middle) % 2:  # an empty sibling for the last node
                middle, start, end = (np.append(v, end[-1]) for v in (middle, start, end))
                half, first, last = np.append(half, 0.0), _again(first), _again(last)
                charges = np.concatenate((charges, np.zeros_like(charges[:, :1])), axis=1)
            start, end = start[::2], end[1::2]
            first, last = np.minimum(first[::2], first[1::2]), np.maximum(last[::2], last[1::2])
            points = Points(np.repeat(middle[:, None], CHARGES, axis=1), half[:, None] * POINTS)

    def separated(
        self,
        chord: Chord,
        owner: Index,
        narrow: tuple[Array, Array],
        wide: tuple[Array, Array],
        places: int,
    ) -> Separation:
        """The nodes far from groups in the intervals `wide`; none for few rows, or few places.

        Those whose rows all are a group's own have to be far from its interval `narrow` only.
        """
        groups = len(owner)
        if self.rows < FEWEST or self.rows * places <= FEW:
            row = np.tile(self.order, groups)
            return Separation([], row, np.repeat(np.arange(groups), self.rows))

        def away(level: Level, node: Index, group: Index) -> Array:
            own = (level.first[node] == owner[group]) & (level.last[node] == owner[group])
            lo, hi = (np.where(own, v[group], w[group]) for v, w in zip(narrow, wide, strict=True))
            return np.asarray(chord.distance(level.middle[node], lo, hi))

        return self.split(groups, away)

    def split(self, groups: int, away: Callable[[Level, Index, Index], Array]) -> Separation:
        """What is far from groups and what is near, by the distance of each from middles."""
        node, group, far = np.zeros(groups, dtype=np.int64), np.arange(groups), []
        for number in range(len(self.levels) - 1, -1, -1):
            level = self.levels[number]
            served = away(level, node, group) >= FAR * level.half[node]
            if served.any():
                far.append((level, node[served], group[served]))
            node, group = node[~served], group[~served]
            if number:
                node, group = (2 * node[:, None] + np.arange(2)).ravel(), np.repeat(group, 2)
                exists = node < len(self.levels[number - 1].middle)
                node, group = node[exists], group[exists]
        row, group = (LEAF * node[:, None] + np.arange(LEAF)).ravel(), np.repeat(group, LEAF)
        exists = row < self.rows
        return Separation(far, self.order[row[exists]], group[exists])


def _again(v: Index) -> Index:
    return np.append(v, v[-1])


def gathered(u: Array, charges: Array) -> Array:
    """Charges (sets, nodes, CHARGES) with the moments of charges (sets, nodes, n) at u."""
    out = np.empty((*charges.shape[:2], CHARGES))
    size = max(CHUNK // (u.shape[1] * CHARGES), 1)
    for start in range(0, len(u), size):
        some = slice(start, start + size)
        T = chebyshev.polynomials(CHARGES, u[some]).transpose(1, 2, 0)
        out[:, some] = (charges[:, some].transpose(1, 0, 2) @ T @ SPREAD).transpose(1, 0, 2)
    return out


# -- sums at blocks of places ----------------------------------------------------------------------

FarSums = Callable[[Level, Index, Index, Points], Any]


class Groups(NamedTuple):
    """Groups of blocks: first blocks and the end (G + 1,), patches and their middles, extents."""

    starts: Index
    i: Index
    c: Array
    narrow: tuple[Array, Array]
    wide: tuple[Array, Array]

    def blocks(self, group: Index) -> tuple[Index, Index]:
        """(block, pair) of pairs (source, group) in the order of groups, ordered by blocks."""
        count = np.bincount(group, minlength=len(self.i))
        first = np.cumsum(count) - count
        of_block = np.repeat(np.arange(len(self.i)), np.diff(self.starts))
        number = count[of_block]
        block = np.repeat(np.arange(len(of_block)), number)
        return block, ranges(first[of_block], number)


def far_sums(
    chord: Chord,
    groups: Groups,
    separation: Separation,
    x: Points,
    at: FarSums,
    *,
    odd: bool = False,
) -> Any:
    """Sums over far nodes at blocks of points, (B, n, sets).

    Those far from all points of a group are interpolated within it, where they are many. `odd`:
    the sums change their sign from period to period, as 1/d does, and a point of the group may be
    given in another period than the middle of its patch.
    """
    lo, hi = groups.narrow
    middle, half = 0.5 * (lo + hi), 0.5 * (hi - lo)
    shape = x.offset.shape
    many = (np.diff(groups.starts) * shape[1] > SEVERAL) & np.isrealobj(x.offset)
    nodes = Points(middle[:, None], half[:, None] * POINTS)
    total: Any = np.zeros((*shape, 1))
    field: Any = np.zeros((len(lo), CHARGES, 1))
    for level, node, group in separation.far:
        away = chord.distance(level.middle[node], lo[group], hi[group])
        smooth = many[group] & (away - level.half[node] >= (FAR - 1.0) * half[group])
        block, pair = groups.blocks(group[~smooth])
        field = _summed(field, at, level, (node[smooth], group[smooth], groups.i), nodes)
        of_block = np.repeat(groups.i, np.diff(groups.starts))
        total = _summed(total, at, level, (node[~smooth][pair], block, of_block), x)
    if not many.any():
        return total
    series = chebyshev.transform(np.moveaxis(field, 1, 2))
    total = total + np.zeros(series.shape[1])
    of_block = np.repeat(np.arange(len(lo)), np.diff(groups.starts))
    inside = np.flatnonzero(many[of_block])
    for some in parts(len(inside), CHARGES * shape[1]):
        block, g = inside[some], of_block[inside[some]]
        step, c = x.anchor[block] - groups.c[g, None], groups.c[g, None]
        place = chord.difference(step, x.offset[block]) + (c - middle[g, None])
        T = chebyshev.polynomials(CHARGES, place / half[g, None])
        value = T.transpose(1, 2, 0) @ series[g].transpose(0, 2, 1)
        total[block] += value * chord.sign(step)[..., None] if odd else value
    return total


def _summed(
    total: Any, at: FarSums, level: Level, pairs: tuple[Index, Index, Index], x: Points
) -> Any:
    """The sums with those of pairs (node, row) of a level, i of all rows."""
    node, row, i = pairs
    for some in parts(len(node), CHARGES * x.offset.shape[1]):
        value = at(level, node[some], i[row[some]], x[row[some]])
        if total.shape[-1] < value.shape[-1] or np.iscomplexobj(value):
            total = total + np.zeros(value.shape[-1:], dtype=value.dtype)
        add(total, row[some], value)
    return total


def ranges(first: Index, count: Index) -> Index:
    """first, first + 1, ... of each run."""
    return np.repeat(first - (np.cumsum(count) - count), count) + np.arange(count.sum())


def add(total: Any, row: Index, value: Any) -> None:
    """total[row] += value, rows in runs."""
    _gathered(np.add, total, row, value)


def multiply(total: Any, row: Index, value: Any) -> None:
    """total[row] *= value, rows in runs."""
    _gathered(np.multiply, total, row, value)


def _gathered(operation: np.ufunc, total: Any, row: Index, value: Any) -> None:
    if row.size:
        first = np.flatnonzero(np.diff(row, prepend=-1))
        total[row[first]] = operation(total[row[first]], operation.reduceat(value, first))


def parts(rows: int, columns: int) -> Iterator[slice]:
    """Slices of rows, in each of which there are about CHUNK entries."""
    size = max(CHUNK // columns, 1)
    for start in range(0, rows, size):
        step_done(0)
        yield slice(start, start + size)
