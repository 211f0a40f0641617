"""The measure dν_i on the patches and the root T_i, at blocks of places that share the patch i.

    W_i(x) = sqrt(d(x, a_i) d(b_i, x))
    S_i(x) = Π_{j≠i} sqrt(d(x, a_j) d(x, b_j)) / |d(x, c_j)|
    T_i(z) = sqrt(d(z, a_i) d(z, b_i)) S_i(z)
    dν_i = dt/|T_i|, on patch k with the sign of d(t, c_k)/d(t, c_i)

Far patches act on ln S_i through the charges of a tree.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .chord import Chord, Points
from .panels import GapPanels, Patches, PatchPanels, gap_panels, patch_panels
from .pieces import Pieces
from .tree import CHARGES, CHUNK, FAR, POINTS, Level, Separation, Tree

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# half-lengths of a panel, in its angle, from its middle: Gauss' rule sees no pole beyond
NEAR = 2.5
# places of a group: sums of so many are interpolated
SEVERAL = 30


FarSums = Callable[[Level, Index, Index, Points], Any]


class Groups(NamedTuple):
    """Groups of blocks: their first blocks and the ends (G + 1,), patches and extents."""

    starts: Index
    i: Index
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


@dataclass(frozen=True, eq=False)
class Measure:
    """The slope H on patches; `charge` (2N,) are the point charges of sharp edges, a_1, b_1, a_2
    ..., in units of slope.
    """

    patches: Patches
    pieces: Pieces
    charge: Array = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def Y(self) -> Array:
        return self.charge if self.charge.size else np.zeros(2 * self.patches.number)

    @cached_property
    def panels(self) -> PatchPanels:
        return patch_panels(self.patches, self.pieces)

    @cached_property
    def gaps(self) -> GapPanels:
        return gap_panels(self.patches, self.pieces)

    # -- the root ----------------------------------------------------------------------------------

    @cached_property
    def _tree_of_roots(self) -> Tree:
        """Charges of ln S at a, c and b of each patch."""
        P = self.patches
        sources = Points(np.stack((P.a, P.c, P.b), axis=1), np.zeros((P.number, 3)))
        charges = np.tile([0.5, -1.0, 0.5], (1, P.number, 1))
        return Tree((P.a, P.b), np.arange(P.number), sources, charges)

    def root(self, i: Index, x: Points, group: Index | None = None) -> tuple[Any, Any]:
        """(T_i, S_i) at blocks of points (B, n), or at points (m,); on patch i itself |T_i|."""
        P, d = self.patches, self.patches.chord.apart
        if x.offset.ndim == 1:
            T, S = self.root(i, Points(x.anchor[:, None], x.offset[:, None]))
            return T[:, 0], S[:, 0]
        S = self.others(i, x, group)
        j = i[:, None]
        left, right = d(x.anchor - P.a[j], x.offset), d(x.anchor - P.b[j], x.offset)
        if np.iscomplexobj(S):
            middle = d(x.anchor - P.c[j], x.offset)
            return middle * np.sqrt((left / middle) * (right / middle)) * S, S
        T = np.sqrt(np.abs(left * right)) * S
        return np.where((left < 0.0) & (right < 0.0), -T, T), S

    def others(self, i: Index, x: Points, group: Index | None = None) -> Any:
        """S_i at blocks of points; S_i > 0 off the other patches."""
        N = self.patches.number
        out = np.ones(x.offset.shape, dtype=x.offset.dtype)
        if N == 1:
            return out
        groups = self.groups(i, x, np.arange(len(i)) if group is None else group)
        if np.iscomplexobj(out):
            every = np.arange(len(groups.i))
            near = Separation([], np.tile(np.arange(N), len(every)), np.repeat(every, N))
        else:
            chord, extent = self.patches.chord, groups.wide
            near = self._tree_of_roots.separated(chord, groups.i, extent, extent)
            out *= np.exp(far_sums(self.patches, groups, near, x, self._logarithms)[..., 0])
        block, pair = groups.blocks(near.group)
        for some in parts(len(block), out.shape[1]):
            _multiply(out, block[some], self._factor(near.row[pair[some]], i, x, block[some]))
        return out

    def _logarithms(self, level: Level, node: Index, i: Index, x: Points) -> Any:
        """ln S of far nodes at places, (m, n, 1)."""
        step = steps(self.patches.chord, level.points(node), x)
        return np.log(np.abs(step, out=step), out=step) @ level.charges[0, node, :, None]

    def _factor(self, j: Index, i: Index, x: Points, block: Index) -> Any:
        """What patch j contributes to S_i at blocks."""
        P, d = self.patches, self.patches.chord.apart
        own = j == i[block]
        anchor, offset = x.anchor[block], x.offset[block]
        left, right, middle = (d(anchor - v[j, None], offset) for v in (P.a, P.b, P.c))
        middle[own] = 1.0
        ratio = (left / middle) * (right / middle)
        ratio[own] = 1.0
        return np.sqrt(ratio if np.iscomplexobj(ratio) else np.abs(ratio))

    # -- the measure on the patches ----------------------------------------------------------------

    @cached_property
    def weight(self) -> Array:
        """dt/W on each node, (p, n): the angle on the line."""
        k, P = self.panels, self.patches
        if not P.chord.periodic:
            return k.angle
        inward = np.abs(k.points.offset)
        outward = 2.0 * P.r[k.patch, None] - inward
        d = P.chord.apart
        return k.angle * np.sqrt(
            (inward / d(0.0, inward)) * (outward / d(2.0 * P.r[k.patch, None], -inward))
        )

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """The interval of each panel."""
        k, r = self.panels, self.patches.r[self.panels.patch]
        near, far = (
            k.points.anchor[:, 0] + np.where(k.right, -2.0, 2.0) * r * np.sin(0.5 * angle) ** 2
            for angle in (k.lo, k.hi)
        )
        return np.minimum(near, far), np.maximum(near, far)

    @cached_property
    def omega(self) -> Array:
        """dν_k on the nodes of patch k itself, (p, n)."""
        k = self.panels
        return np.asarray(self.weight / self.others(k.patch, k.points, k.patch))

    @cached_property
    def b(self) -> Array:
        """d(t, c_k) dν_k on the nodes, (p, n): dν_i is b/d(t, c_i) for every i."""
        k, P = self.panels, self.patches
        return self.omega * P.chord.apart(k.points.anchor - P.c[k.patch, None], k.points.offset)

    @cached_property
    def H(self) -> Array:
        """H on the nodes, less `H0`."""
        k = self.panels
        return self.pieces.value(k.piece[:, None], k.points.anchor, k.points.offset) - self.H0

    @cached_property
    def H0(self) -> float:
        """A value of H, taken out of all sums: only differences count."""
        k = self.panels
        return float(
            np.mean(self.pieces.value(k.piece, k.points.anchor[:, 0], k.points.offset[:, 0]))
        )

    @cached_property
    def tau(self) -> tuple[Array, Array]:
        """sqrt(d(t, edge)/d(other edge, t)) at both ends of each panel."""
        k, P = self.panels, self.patches
        d = P.chord.apart
        ends = []
        for angle in (k.lo, k.hi):
            s = 2.0 * P.r[k.patch] * np.sin(0.5 * angle) ** 2
            ends.append(np.sqrt(d(0.0, s) / d(2.0 * P.r[k.patch], -s)))
        return ends[0], ends[1]

    @cached_property
    def beside(self) -> tuple[Array, Array]:
        """The places close to each panel on the line, counted inwards from its edge: angles of
        NEAR half-lengths from its middle, imaginary ones beside the patch.
        """
        k = self.panels
        middle, reach = 0.5 * (k.lo + k.hi), NEAR * 0.5 * (k.hi - k.lo)
        inner = np.sin(0.5 * np.maximum(middle - reach, 0.0)) ** 2
        beside = np.sinh(0.5 * np.sqrt(np.maximum(reach**2 - middle**2, 0.0))) ** 2
        size = 2.0 * self.patches.r[k.patch]
        lo = np.where(reach > middle, -size * beside, size * inner)
        return lo, size * np.sin(0.5 * np.minimum(middle + reach, np.pi)) ** 2

    @cached_property
    def tree(self) -> Tree:
        """Charges of Hω, ω, Hb, b."""
        k = self.panels
        sources = np.stack((self.H * self.omega, self.omega, self.H * self.b, self.b))
        return Tree(self.ends, k.patch, k.points, sources)

    def groups(self, i: Index, x: Points, group: Index) -> Groups:
        """The groups of blocks that follow each other, and the intervals that they are in."""
        P = self.patches
        place = np.real(x.x)
        if P.chord.periodic:
            c = P.c[i, None]
            place = P.chord.difference(np.real(x.anchor) - c, np.real(x.offset)) + c
        first = np.flatnonzero(np.diff(group, prepend=-2))
        lo = np.minimum.reduceat(place.min(axis=1), first)
        hi = np.maximum.reduceat(place.max(axis=1), first)
        c = P.c[i[first]]  # b/d(t, c_i) of other patches has a pole there
        wide = np.minimum(lo, c), np.maximum(hi, c)
        return Groups(np.append(first, len(i)), i[first], (lo, hi), wide)


def far_sums(
    patches: Patches, groups: Groups, separation: Separation, x: Points, at: FarSums
) -> Any:
    """Sums over far nodes at blocks of points, (B, n, sets).

    Those far from all points of a group are interpolated within it, where they are many.
    """
    lo, hi = groups.narrow
    middle, half = 0.5 * (lo + hi), 0.5 * (hi - lo)
    shape = x.offset.shape
    many = (np.diff(groups.starts) * shape[1] > SEVERAL) & np.isrealobj(x.offset)
    nodes = Points(middle[:, None], half[:, None] * POINTS)
    total: Any = np.zeros((*shape, 1))
    field: Any = np.zeros((len(lo), CHARGES, 1))
    for level, node, group in separation.far:
        away = patches.chord.distance(level.middle[node], lo[group], hi[group])
        smooth = many[group] & (away - level.half[node] >= (FAR - 1.0) * half[group])
        block, pair = groups.blocks(group[~smooth])
        field = _summed(field, at, level, (node[smooth], group[smooth], groups.i), nodes)
        of_block = np.repeat(groups.i, np.diff(groups.starts))
        total = _summed(total, at, level, (node[~smooth][pair], block, of_block), x)
    if not many.any():
        return total
    g = np.repeat(np.arange(len(lo)), np.diff(groups.starts))
    some = np.flatnonzero(many[g])
    g, x, c = g[some], x[some], patches.c[groups.i[g[some]], None]
    place = patches.chord.difference(x.anchor - c, x.offset) + (c - middle[g, None])
    T = chebyshev.polynomials(CHARGES, place / half[g, None])
    series = chebyshev.transform(np.moveaxis(field, 1, 2))[g]
    total = total + np.zeros(series.shape[1])
    total[some] += T.transpose(1, 2, 0) @ series.transpose(0, 2, 1)
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


def edge_ratio(patches: Patches, i: Any) -> Array:
    """ρ_i(e) = d(e, c_k)/d(e, c_i) of all edges e, those of patch k: (2N,), or (i, 2N)."""
    d, c = patches.chord.apart, patches.c
    k = np.repeat(np.arange(patches.number), 2)
    own = d(patches.edges - c[k])
    rho = own / d(patches.edges - np.asarray(c[i])[..., None])
    return np.asarray(np.where(k == np.asarray(i)[..., None], 1.0, rho))


def steps(chord: Chord, t: Points, x: Points) -> Any:
    """d(t, x) of sources (m, s) and places (m, n): (m, n, s)."""
    return chord.apart(
        t.anchor[:, None, :] - x.anchor[:, :, None], t.offset[:, None, :] - x.offset[:, :, None]
    )


def ranges(first: Index, count: Index) -> Index:
    """first, first + 1, ... of each run."""
    return np.repeat(first - (np.cumsum(count) - count), count) + np.arange(count.sum())


def add(total: Any, row: Index, value: Any) -> None:
    """total[row] += value, rows in runs."""
    if not row.size:
        return
    first = np.flatnonzero(np.diff(row, prepend=-1))
    total[row[first]] += np.add.reduceat(value, first)


def _multiply(total: Any, row: Index, value: Any) -> None:
    if not row.size:
        return
    first = np.flatnonzero(np.diff(row, prepend=-1))
    total[row[first]] *= np.multiply.reduceat(value, first)


def parts(rows: int, columns: int) -> list[slice]:
    size = max(CHUNK // columns, 1)
    return [slice(start, start + size) for start in range(0, rows, size)]
