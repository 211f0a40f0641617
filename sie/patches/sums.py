"""Sums over far nodes of a tree at blocks of places, in groups that share them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Chord, Points
from sie.numerics.tree import CHARGES, CHUNK, FAR, POINTS, Level, Separation
from sie.progress_bar import step_done

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# places of a group: sums of so many are interpolated
SEVERAL = 30

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
    size = max(CHUNK // columns, 1)
    for start in range(0, rows, size):
        step_done(0)
        yield slice(start, start + size)
