"""p, q and γ of a state at any place, from tables in the variable of the quadrature.

The fields are computed at four shifts of the rule, and interpolated between equidistant v: whatever
power of the distance they have at an end, they are smooth in v.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import sici

from .pieces import Pair, across

if TYPE_CHECKING:
    from .pieces import Places
    from .state import State

Array = NDArray[np.float64]

SHIFTS = 4
POINTS = 14  # of the interpolation
FARTHEST = 22.0  # |v| beyond which fields go on as a power of the distance from an edge
DEEP = 33.0  # |v| up to which p and γ are told at marks inside the contact
DEEPEST = 50.0  # the same next to the end of a zone: slip zones may be as narrow as 1e-15
NEAR_EDGE = 1e-3  # of the contact: up to there the distance from an edge tells a place best
LEFT_OUT = 24.0  # e-folds that a rule goes on beyond: what it leaves out is then 4e-11 of p
LAST = 745.0  # e-folds that doubles have
FLAT = 1e-8  # of p and q: what changes less in v is no logarithm
NEAREST = 1e-8  # of the contact: nodes that are nearer to a mark are not looked at
AT_NODE = 1e-30  # of a step: stands for no distance from a node


@dataclass(frozen=True, eq=False)
class Fields:
    """The fields of a state."""

    state: State

    def __call__(self, x: Array, rest: Array | None = None) -> Array:
        """Rows of p, q and γ at places in contact, at distances `rest` from the nearer edge."""
        (k, v), rows = self._located(x, rest), np.empty((3, len(x)))
        for piece in np.unique(k).tolist():
            rows[:, k == piece] = self.on_piece(piece, v[k == piece])
        return rows

    def gamma(self, x: Array) -> Array:
        """γ in contact."""
        (k, v), values = self._located(x, None), np.empty(len(x))
        for piece in np.unique(k).tolist():
            own = k == piece
            values[own] = self._told(piece, v[own], [2], self._last_pressure)[0]
        return values

    def on_piece(self, piece: int, v: Array) -> Array:
        """Rows of p, q and γ at places of a piece."""
        pieces, rows = self.state.pieces, np.empty((3, len(v)))
        for row, far in (([0, 2], self._last_pressure), ([1], self._last_shear)):
            rows[row] = self._told(piece, v, row, far)
        for side in (-1, 1):
            if 0 <= piece + side < len(pieces.lengths):
                self._next_to_cut(piece, side, v, rows)
            else:
                beyond = np.maximum(side * v - FARTHEST, 0.0)
                rows[:2] *= np.exp(-pieces.powers[-1 if side > 0 else 0] * beyond)
        sign = pieces.sign[pieces.zone_of_piece[piece]]
        if sign:
            rows[1] = sign * self.state.question.friction * rows[0]
        return rows

    def _told(self, piece: int, v: Array, row: list[int], far: Callable[[int, int], float]) -> Any:
        """Some rows by the table of a piece, as far as that tells them."""
        first, table = self.tables[piece]
        place = np.clip(v, -far(piece, -1), far(piece, 1)) - first
        return interpolated(table[row], place * (SHIFTS / self.state.pieces.fineness.step))

    def _located(self, x: Array, rest: Array | None) -> tuple[NDArray[np.intp], Array]:
        """The piece of each place, and v on it."""
        k, lo, hi = self._distances(x, rest)
        with np.errstate(divide="ignore"):
            v = np.log(np.maximum(lo, 0.0)) - np.log(np.maximum(hi, 0.0))
        return k, np.clip(v, -LAST, LAST)

    def _distances(self, x: Array, rest: Array | None) -> tuple[NDArray[np.intp], Array, Array]:
        """The piece of each place, and its distances from the ends of that."""
        pieces = self.state.pieces
        cuts, last = pieces.cuts, len(pieces.cuts) - 2
        k = np.clip(np.searchsorted(cuts, x, side="right") - 1, 0, last)
        lo, hi = x - cuts[k], cuts[k + 1] - x
        if rest is None:
            return k, lo, hi
        # next to an edge distances from that tell more
        for left in (True, False):
            lengths = pieces.lengths if left else pieces.lengths[::-1]
            ends = np.append(0.0, np.cumsum(lengths))
            own = (rest < NEAR_EDGE * pieces.length) & ((x < 0.5 * (cuts[0] + cuts[-1])) == left)
            j = np.clip(np.searchsorted(ends, rest[own], side="right") - 1, 0, last)
            outer, inner = rest[own] - ends[j], ends[j + 1] - rest[own]
            k[own] = j if left else last - j
            lo[own], hi[own] = (outer, inner) if left else (inner, outer)
        return k, lo, hi

    def _last_pressure(self, piece: int, side: int) -> float:
        """|v| up to which p and γ are told."""
        pieces = self.state.pieces
        if not 0 <= piece + side < len(pieces.lengths):
            return FARTHEST
        sticks = not pieces.sign[pieces.zone_of_piece[piece]]
        deepest = sticks and pieces.powers[piece + (side > 0)] != 0.0
        return self._within(piece, side, DEEPEST if deepest else DEEP)

    def _within(self, piece: int, side: int, far: float) -> float:
        """|v| that the table reaches, at most this."""
        first, table = self.tables[piece]
        last = first + (table.shape[1] - 1) * self.state.pieces.fineness.step / SHIFTS
        return min(far, last if side > 0 else -first)

    def _last_shear(self, piece: int, side: int) -> float:
        """|v| up to which q is told: nearer to a narrow slip zone, next to which it varies more."""
        pieces, other = self.state.pieces, piece + side
        if not 0 <= other < len(pieces.lengths):
            return FARTHEST
        if not pieces.powers[piece + (side > 0)]:
            return max(FARTHEST, pieces.fineness.inner - LEFT_OUT)
        width = pieces.widths[pieces.zone_of_piece[other]]
        more = 0.5 * max(math.log(pieces.lengths[piece] / width), 0.0)
        return self._within(piece, side, min(DEEPEST, FARTHEST + more))

    def _next_to_cut(self, piece: int, side: int, v: Array, rows: Array) -> None:
        """Sets p and q too near to a cut on that side of a piece for what tables tell.

        At marks both may have a logarithm; next to slip f p - |q| is a power of the distance.
        """
        pieces = self.state.pieces
        signs, power = pieces.sign[pieces.zone_of_piece], pieces.powers[piece + (side > 0)]
        (first, table), step = self.tables[piece], pieces.fineness.step
        for row, last in enumerate(
            (self._last_pressure(piece, side), self._last_shear(piece, side))
        ):
            near = np.flatnonzero(side * v > last)
            if not near.size or (row == 0 and power):
                continue
            place = side * np.array([last, last - 1.0])
            (p, _), (q, _) = both = interpolated(table[:2], (place - first) * (SHIFTS / step))
            beyond = side * v[near] - last
            if power:
                full = signs[piece + side] * self.state.question.friction
                rows[1, near] = full * rows[0, near] - (full * p - q) * np.exp(-power * beyond)
                continue
            rise = both[row, 0] - both[row, 1]
            if abs(rise) < FLAT * np.abs(both).max():
                continue
            rows[row, near] = both[row, 0] + rise * beyond

    @cached_property
    def whole(self) -> tuple[Places, Array]:
        """The nodes of all shifts, ascending, and rows of p, q and γ.

        With ω the product of the roots of both distances over the stick zones, by (12)

            1/π ∫q/(z - t) dt = ω/π ∫μ/(z - t) dt,   μ = (γ - β p)/|ω| in stick, q/ω in slip,

        which gives γ in slip and q in stick. By (1) q would lose digits like 1/β, and next to slip
        what the rule leaves out at the end, a point mass over β f, would put q beyond f p.
        """
        every = self.state.pieces.rule(0.0, finer=SHIFTS)
        rules = [every.chosen(slice(shift, None, SHIFTS)) for shift in range(SHIFTS)]
        rules = [at._replace(weight=SHIFTS * at.weight) for at in rules]
        half = SHIFTS // 2
        pairs = [self._on_pair((rules[k], rules[k + half])) for k in range(half)]
        rows = [pair[k] for k in (0, 1) for pair in pairs]
        return every, np.stack(rows, axis=2).reshape(3, -1)

    def _on_pair(self, rules: Pair) -> list[Array]:
        """p, q and γ on rules half a step apart."""
        state, beta = self.state, self.state.question.beta
        kernel = state.cauchy(*rules)
        rows = state.rows(rules, kernel)
        roots, held = [state.root(at) for at in rules], [state.sticks(at) for at in rules]
        sources = [
            np.where(sticks, beta * p - gamma, q) * at.weight / root
            for sticks, (p, q, gamma), at, root in zip(held, rows, rules, roots, strict=True)
        ]
        flows = across(kernel, sources)
        for row, sticks, root, flow in zip(rows, held, roots, flows, strict=True):
            row[2, ~sticks] = (beta * row[0] + root * flow)[~sticks]
            row[1, sticks] = (root * flow)[sticks]
        return rows

    @cached_property
    def tables(self) -> list[tuple[float, Array]]:
        """The first v and the rows of each piece."""
        (every, rows), lengths = self.whole, self.state.pieces.lengths
        ends = np.searchsorted(every.piece, np.arange(len(lengths) + 1))
        first = np.log(every.offset[ends[:-1]] / lengths).tolist()
        return [(v, rows[:, lo:hi]) for v, lo, hi in zip(first, ends[:-1], ends[1:], strict=True)]

    def from_edge(self, side: float) -> Array:
        """The distances of all nodes from the edge of that side."""
        pieces, t = self.state.pieces, self.whole[0]
        return pieces.from_cut(t, 0) if side < 0.0 else -pieces.from_cut(t, len(pieces.cuts) - 1)

    def raised(self, apart: Array, side: float) -> Array:
        """∫Hp dx from an edge to places so far beside it, outwards."""
        t, (p, _, _) = self.whole
        values: Array = np.log1p(apart[:, None] / self.from_edge(side)) @ (t.weight * p) / math.pi
        return values

    def beside(self, apart: Array, side: float) -> Array:
        """Hp and Hq so far beside an edge."""
        t, fields = self.whole
        kernel = side / (apart[:, None] + self.from_edge(side)) / math.pi
        values: Array = (t.weight * fields[:2]) @ kernel.T
        return values

    @cached_property
    def nodes(self) -> tuple[Places, Array]:
        """The same without those that are nearer to a cut than what matters."""
        every, fields = self.whole
        kept = np.abs(every.offset) > NEAREST * self.state.pieces.length
        return every.chosen(kept), fields[:, kept]


def interpolated(table: Array, place: Any, points: int = POINTS) -> Any:
    """Columns of a table at fractional places, or next to the line, by Lagrange's polynomials."""
    first = np.clip(np.floor(place.real).astype(int) - points // 2 + 1, 0, table.shape[1] - points)
    nodes = np.arange(points)[:, None]
    apart = (place - first) - nodes
    apart[np.abs(apart) < AT_NODE] = AT_NODE
    share = _binomial(points)[:, None] / apart
    return np.einsum("ijk,jk->ik", table[:, first + nodes], share) / share.sum(axis=0)


@lru_cache(maxsize=4)
def _binomial(points: int) -> Array:
    """The weights of equidistant points."""
    return np.array([(-1.0) ** j * math.comb(points - 1, j) for j in range(points)])


def cumulative(values: Array) -> Array:
    """The integral of equidistant values up to each place, in steps, by the sinc series.

    The integrand vanishes towards both ends: error e^(-π²/h).
    """
    k = np.arange(1 - len(values), len(values))
    total: Array = np.convolve(values, 0.5 + sici(math.pi * k)[0] / math.pi, "valid")
    return total


def summed(values: Array) -> Array:
    """The same by neighbours alone, where what is far away may not be smooth."""
    half = len(_STENCIL) // 2
    padded = np.concatenate((np.zeros(half), values, np.zeros(half)))
    total: Array = np.cumsum(np.convolve(padded, _STENCIL[::-1], "valid")[: len(values)])
    return total


def _integral_of_step(points: int) -> Array:
    """Weights of equidistant values for the integral between the two in the middle."""
    t = np.arange(points) - (points - 1) / 2.0
    powers = np.arange(points)
    exact = np.where(powers % 2 == 0, 2.0 * 0.5 ** (powers + 1) / (powers + 1), 0.0)
    return np.asarray(np.linalg.solve(t ** powers[:, None], exact))


_STENCIL = _integral_of_step(10)
