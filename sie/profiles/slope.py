"""The slope H = h' of an indenter, piece by piece: all that the numerics use of a profile.

On each piece, between two neighbouring breaks, H is a polynomial about an origin of its own plus
functions that are smooth there, or the Chebyshev series that resolve them (`resolution`):

    H(t) = Σ_j coefficients[k, j] (t - origins[k])^j + Σ functions(t) + Σ_n series[k, n] T_n(s)

The first and last break are the ends of the indenter and may be infinite. Each piece has its own
origin because a profile is often small there and nowhere else: (t - a)/R on the rounded edge of a
punch must not be formed as t/R - a/R where that edge is 1e-12 of the width.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS, recentred, two_sum

if TYPE_CHECKING:
    from .functions import FunctionTerm

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# Up to so many pieces of so low a degree, a loop over floats is cheaper than NumPy's calls.
FEW, LOW = 6, 4
# A break carries a true jump of h' (and a logarithmic infinity of the pressure) when the jump
# exceeds the rounding of the terms of h' by this factor.
JUMP = 256.0 * EPS
# The same of functions and series: their pieces are resolved one by one, and do not match.
SEEN_JUMP = 1e-9
NO_SERIES = np.zeros((1, 0))
Pieced = TypeVar("Pieced", bound="Slope")


class Row(NamedTuple):
    """One piece of a slope as plain floats, which cost less than arrays where there are few.

    Its coefficients are high order first.
    """

    lo: float
    hi: float
    origin: float
    coefficients: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Slope:
    """H on its breaks.

    breaks          (K + 1,), ascending
    origins         (K,)
    coefficients    (K, D), low order first
    functions       what is added, of all pieces
    tails           (K, 2), what rounding took from coefficients[:, :2]: a tilt may cancel the rest
    orders          (K,), the Chebyshev degrees that resolve the functions; 0 where none is known
    series          (K, E), Chebyshev coefficients on each piece, in place of functions
    """

    breaks: Array
    origins: Array
    coefficients: Array
    functions: tuple[FunctionTerm, ...] = ()
    tails: Array | float = 0.0
    orders: Index | int = 0
    series: Array = field(default_factory=lambda: NO_SERIES)

    # -- values ------------------------------------------------------------------------------------

    def locate(self, x: Any, side: Literal["left", "right"] = "right") -> Index:
        """The piece at x; at a break the one on that side of it."""
        k = np.searchsorted(self.breaks, x, side=side) - 1
        return np.asarray(np.minimum(np.maximum(k, 0), len(self.origins) - 1))

    def value(self, k: Any, anchor: Any, offset: Any) -> Any:
        """H of the pieces k at anchor + offset, which is not rounded; continued beyond the ends."""
        y = (anchor - self.origins[k]) + offset
        column = self.coefficients.T
        total = column[-1][k]
        for c in column[-2::-1]:
            total = total * y + c[k]
        if self.series.shape[1]:
            s = ((anchor - self._centre[k]) + offset) / self._half[k]
            total = total + chebyshev.evaluate(self.series.T[:, k], s)
        for f in self.functions:
            total = total + f((anchor - f.shift) + offset)
        return total if np.shape(total) == np.shape(y) else total + np.zeros_like(y)

    def __call__(self, x: Any) -> Array:
        """H(x): the mean of both sides at a break; -inf and inf beyond the ends."""
        flat = np.asarray(x, dtype=float).ravel()
        # Beyond the ends the value is replaced; keep functions in their domain.
        inside = np.clip(flat, self.breaks[0], self.breaks[-1])
        left, right = self.locate(inside, "left"), self.locate(inside)
        values: Array = self.value(right, inside, 0.0)
        both = np.flatnonzero(left != right)
        if both.size:
            values[both] = 0.5 * (values[both] + self.value(left[both], inside[both], 0.0))
        values[flat < self.breaks[0]] = -np.inf
        values[flat > self.breaks[-1]] = np.inf
        return values.reshape(np.shape(x))

    def inside(self, x: Array) -> Array:
        """H at points x (K, n), each row inside one piece."""
        k = self.locate(x[:, x.shape[1] // 2])
        return np.asarray(self.value(k[:, None], 0.0, x))

    @cached_property
    def derivative(self) -> Self:
        """H' on the same pieces, without jumps of H; functions have no derivative here."""
        c, series = self.coefficients, self.series
        power = c[:, 1:] * np.arange(1, c.shape[1]) if c.shape[1] > 1 else np.zeros_like(c)
        if series.shape[1] > 1:
            series = np.polynomial.chebyshev.chebder(series, axis=1) / self._half[:, None]
        elif series.shape[1]:
            series = 0.0 * series
        return replace(self, coefficients=power, series=series, functions=(), tails=0.0)

    @cached_property
    def _centre(self) -> Array:
        with np.errstate(invalid="ignore"):
            return np.asarray(0.5 * (self.breaks[:-1] + self.breaks[1:]))

    @cached_property
    def _half(self) -> Array:
        return np.asarray(0.5 * np.diff(self.breaks))

    @property
    def _tails(self) -> Array:
        return np.broadcast_to(self.tails, (len(self.origins), 2))

    @cached_property
    def is_zero(self) -> NDArray[np.bool_]:
        """Whether each piece is flat and needs no work."""
        if self.functions:
            return np.zeros(len(self.origins), dtype=bool)
        return np.logical_not(self.coefficients.any(axis=1) | self.series.any(axis=1))

    @property
    def is_flat_punch(self) -> bool:
        """Whether all pieces are flat and the domain ends on both sides."""
        return bool(self.is_zero.all() and np.isfinite(self.domain).all())

    @cached_property
    def has_zero(self) -> bool:
        """Whether H is 0 on a whole piece."""
        return bool(self.is_zero.any())

    @cached_property
    def degrees(self) -> Index:
        """The degree that resolves each piece, (K,)."""
        least = max(self.coefficients.shape[1], self.series.shape[1]) - 1
        return np.maximum(least, np.broadcast_to(self.orders, self.origins.shape))

    @cached_property
    def degree(self) -> int:
        """The largest of them."""
        return int(self.degrees.max())

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """The pieces that are not flat, as plain floats."""
        ends = self.breaks.tolist()
        rows = zip(
            ends[:-1],
            ends[1:],
            self.origins.tolist(),
            self.coefficients[:, ::-1].tolist(),
            self.is_zero.tolist(),
            strict=True,
        )
        return tuple(Row(lo, hi, origin, tuple(c)) for lo, hi, origin, c, zero in rows if not zero)

    @cached_property
    def break_points(self) -> tuple[float, ...]:
        """The finite breaks as plain floats."""
        return tuple(b for b in self.breaks.tolist() if abs(b) < np.inf)

    @cached_property
    def few(self) -> bool:
        """Whether plain floats are faster than arrays."""
        if self.functions or self.degree > LOW:
            return False
        return len(self.origins) <= FEW or int(np.count_nonzero(~self.is_zero)) <= FEW

    @cached_property
    def without_functions(self) -> Slope:
        """The polynomial part of H."""
        return replace(self, functions=())

    # -- jumps -------------------------------------------------------------------------------------

    @cached_property
    def steps(self) -> Array:
        """By how much H jumps up at the inner breaks, (K - 1,); 0 where that is rounding.

        Functions are seen one ulp beside a break, where a power law may seem to jump, and compared
        with what they are farther from it.
        """
        k, x = np.arange(len(self.origins) - 1), self.breaks[1:-1]
        ulp = np.spacing(np.abs(x)) if self.functions else 0.0
        with np.errstate(invalid="ignore"):
            below, above = self.value(k, x, -ulp), self.value(k + 1, x, ulp)
            size = np.maximum(self.terms(k, x), self.terms(k + 1, x))
            if self.functions or self.series.shape[1]:
                gap = np.diff(self.breaks)
                off = 0.5 * np.minimum(gap[:-1], gap[1:])
                off = np.where(np.isfinite(off), off, ulp)
                sides = below, above, self.value(k, x, -off), self.value(k + 1, x, off)
                least = SEEN_JUMP * np.max((size, *np.abs(sides)), axis=0)
            else:  # a break is rounded too
                steep = np.maximum(*(self.derivative.terms(j, x) for j in (k, k + 1)))
                least = JUMP * (size + np.abs(x) * steep)
            return np.where(np.abs(above - below) > least, above - below, 0.0)

    def terms(self, k: Index, x: Array) -> Array:
        """The sum of the magnitudes of what H of the pieces k at x is the sum of."""
        y, total = np.abs(x - self.origins[k]), np.zeros(np.shape(x))
        for c in np.abs(self.coefficients[k]).T[::-1]:
            total = total * y + c
        return total + np.abs(self.series[k]).sum(axis=1) if self.series.shape[1] else total

    @cached_property
    def continuous(self) -> bool:
        """Whether H is known to be continuous, up to rounding.

        A function may jump at declared breaks.
        """
        return not self.functions and not self.steps.any()

    @cached_property
    def jumps(self) -> tuple[tuple[float, float], ...]:
        """(break, rise of H) for each inner break where H jumps."""
        there = np.flatnonzero(self.steps)
        return tuple(zip(self.breaks[1:-1][there].tolist(), self.steps[there].tolist()))

    def corner(self, x: float) -> tuple[float, float]:
        """Jumps of H and H' at a break x; of functions only that of H."""
        j = int(np.searchsorted(self.breaks, x)) - 1
        if not 0 <= j < len(self.steps):
            return 0.0, 0.0
        return float(self.steps[j]), float(self._kinks[j])

    @cached_property
    def _kinks(self) -> Array:
        k, x = np.arange(len(self.origins) - 1), self.breaks[1:-1]
        steep = self.derivative
        return np.asarray(steep.value(k + 1, x, 0.0) - steep.value(k, x, 0.0))

    @cached_property
    def corners(self) -> Array:
        """Jumps of the polynomials' Taylor coefficients at the inner breaks, (N - 1, D)."""
        k, inner = np.arange(len(self.origins)), self.breaks[1:-1]
        width = self.coefficients.shape[1]
        return self.about(k[1:], inner, width)[0] - self.about(k[:-1], inner, width)[0]

    def about(self, k: NDArray[np.int64], origins: Array, width: int) -> tuple[Array, Array]:
        """Coefficients of the pieces k about new origins, and tails."""
        c = np.zeros((len(k), width))
        c[:, : self.coefficients.shape[1]] = self.coefficients[k]
        return recentred(c, self._tails[k], self.origins[k], origins)

    @property
    def domain(self) -> tuple[float, float]:
        """The first and the last break, lengths."""
        return float(self.breaks[0]), float(self.breaks[-1])

    # -- other slopes ------------------------------------------------------------------------------

    def tilted(self, tilt: float) -> Slope:
        """The slope of h(x) + tilt x."""
        if tilt == 0.0:
            return self
        c, (level, rest) = self.coefficients.copy(), two_sum(self.coefficients[:, 0], tilt)
        tails = self._tails.copy()
        c[:, 0], tails[:, 0] = two_sum(level, rest + tails[:, 0])
        return replace(self, coefficients=c, tails=tails)._near_zeros()

    def _near_zeros(self) -> Slope:
        """The same with the zero of a straight piece as its origin, if no end of it is."""
        c, origins = self.coefficients, self.origins
        if c.shape[1] != 2 or len(origins) == 1:
            return self
        lo, hi = self.breaks[:-1], self.breaks[1:]
        bent = (c[:, 1] != 0.0) & (origins != lo) & (origins != hi)
        zeros = np.clip(origins - c[:, 0] / np.where(bent, c[:, 1], 1.0), lo, hi)
        if not bent.any():
            return self
        origins = np.where(bent, zeros, origins)
        c, tails = self.about(np.arange(len(origins)), origins, c.shape[1])
        return replace(self, origins=origins, coefficients=c, tails=tails)

    def split_at(self, x: float) -> Slope:
        """The same slope with one more break, at x."""
        k = int(np.searchsorted(self.breaks, x))
        if not self.breaks[0] < x < self.breaks[-1] or self.breaks[k] == x:
            return self
        twice = np.insert(np.arange(len(self.origins)), k, k - 1)
        return self.chosen(twice, np.insert(self.breaks, k, x))

    def by_piece(self) -> dict[str, Any]:
        """The fields that have a row for each piece."""
        K = len(self.origins)
        return {
            "origins": self.origins,
            "coefficients": self.coefficients,
            "tails": self._tails,
            "orders": np.broadcast_to(self.orders, K),
            "series": np.broadcast_to(self.series, (K, self.series.shape[1])),
        }

    def chosen(self, k: NDArray[Any], breaks: Array) -> Self:
        """These pieces, on other breaks."""
        rows = {name: values[k] for name, values in self.by_piece().items()}
        return replace(self, breaks=breaks, **rows)

    def within(self, lo: float, hi: float) -> Slope:
        """The same slope on [lo, hi], whose ends become the ends of the indenter."""
        split = self.split_at(lo).split_at(hi)
        kept = (split.breaks[:-1] >= lo) & (split.breaks[1:] <= hi)
        ends = np.append(split.breaks[:-1][kept], split.breaks[1:][kept][-1])
        return split.chosen(kept, ends)

    def shifted(self, dx: float) -> Slope:
        """The slope of h(x - dx)."""
        functions = tuple(replace(f, shift=f.shift + dx) for f in self.functions)
        breaks = self.breaks + dx
        moved = replace(self, breaks=breaks, origins=self.origins + dx, functions=functions)
        # A piece that is shorter than the doubles are apart there is gone.
        kept = np.diff(breaks) > 0.0
        ends = np.append(breaks[:-1][kept], breaks[-1])
        return moved if kept.all() else moved.chosen(kept, ends)

    def mirrored(self) -> Slope:
        """The slope of h(-x), that is -H(-x)."""
        back = self.chosen(np.arange(len(self.origins))[::-1], -self.breaks[::-1])
        c = -back.coefficients * (-1.0) ** np.arange(self.coefficients.shape[1])
        functions = tuple(replace(f, shift=-f.shift, sign=-f.sign) for f in self.functions)
        tails = back._tails * (-1.0, 1.0)
        return replace(
            back, origins=-back.origins, coefficients=c, functions=functions, tails=tails
        )

    def __add__(self, other: Slope) -> Slope:
        """The sum on the intersection of both domains, broken where either is."""
        lo, hi = max(self.breaks[0], other.breaks[0]), min(self.breaks[-1], other.breaks[-1])
        if not lo < hi:
            raise ValueError(f"{self.domain} and {other.domain} do not overlap: shift one first")
        merged = np.union1d(self.breaks, other.breaks)
        breaks = merged[(merged >= lo) & (merged <= hi)]
        mine, theirs = (
            np.searchsorted(s.breaks, breaks[:-1], side="right") - 1 for s in (self, other)
        )
        one, two = self.origins[mine], other.origins[theirs]
        nearer = _distance(one, breaks) <= _distance(two, breaks)
        origins = np.where(other.is_zero[theirs] | (~self.is_zero[mine] & nearer), one, two)
        width = max(self.coefficients.shape[1], other.coefficients.shape[1])
        c, tails = self.about(mine, origins, width)
        more, other_tails = other.about(theirs, origins, width)
        both, rest = two_sum(c[:, :2], more[:, :2])
        c += more
        tails = tails + other_tails
        c[:, :2], tails[:, :width] = two_sum(both, rest + tails[:, :width])
        return Slope(breaks, origins, c, self.functions + other.functions, tails)


def chained(parts: Sequence[Pieced]) -> Pieced:
    """Slopes on intervals that follow each other, as one."""
    rows = [part.by_piece() for part in parts]
    whole: dict[str, Any] = {}
    for name in rows[0]:
        arrays = [row[name] for row in rows]
        if arrays[0].ndim == 2:
            width = max(a.shape[1] for a in arrays)
            arrays = [np.pad(a, ((0, 0), (0, width - a.shape[1]))) for a in arrays]
        whole[name] = np.concatenate(arrays)
    breaks = np.concatenate([parts[0].breaks[:1], *(part.breaks[1:] for part in parts)])
    return replace(parts[0], breaks=breaks, **whole)


def polynomial_slope(
    breaks: Sequence[float],
    origins: Sequence[float],
    coefficients: Sequence[Sequence[float]],
    tails: Array | float = 0.0,
) -> Slope:
    """A Slope from rows of polynomial coefficients of unequal length, and their tails."""
    width = max(len(row) for row in coefficients)
    c = np.array([[*row, *[0.0] * (width - len(row))] for row in coefficients], dtype=float)
    return Slope(np.asarray(breaks, dtype=float), np.asarray(origins, dtype=float), c, tails=tails)


def _distance(origins: Array, breaks: Array) -> Array:
    """The distance of each origin from its piece.

    It is 0 inside a bounded piece; else the distance from the one end, or from x = 0 without ends.
    Contact is near the finite breaks; a far origin makes large coefficients that cancel there.
    """
    lo, hi = breaks[:-1], breaks[1:]
    outside = np.maximum(np.maximum(lo - origins, origins - hi), 0.0)
    end = np.where(np.isfinite(lo), lo, np.where(np.isfinite(hi), hi, 0.0))
    return np.where(np.isfinite(lo) & np.isfinite(hi), outside, np.abs(origins - end))
