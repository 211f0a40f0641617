"""The slope H = h' of an indenter, piece by piece: all that the numerics use of a profile.

On each piece, between two neighbouring breaks, H is a polynomial about an origin of its own plus
functions that are smooth there:

    H(t) = Σ_j coefficients[k, j] (t - origins[k])^j + Σ functions(t),   breaks[k] < t < breaks[k+1]

The first and last break are the ends of the indenter and may be infinite. Each piece has its own
origin because a profile is often small there and nowhere else: (t - a)/R on the rounded edge of a
punch must not be formed as t/R - a/R where that edge is 1e-12 of the width.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.numerics.interval import EPS, recentred, two_sum

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Vectorised = Callable[[Array], Any]

# Up to so many pieces of so low a degree, a loop over floats is cheaper than NumPy's calls.
FEW, LOW = 6, 4
# A break carries a true jump of h' (and a logarithmic infinity of the pressure) when the jump
# exceeds rounding by this factor.
JUMP = 256.0 * EPS
# The same for a function: its pieces are resolved one by one, and do not match to rounding.
SEEN_JUMP = 1e-9


@dataclass(frozen=True)
class FunctionTerm:
    """The function sign f(sign (t - shift)): a user's f, moved and mirrored with its profile."""

    function: Vectorised
    shift: float = 0.0
    sign: float = 1.0

    def __call__(self, offset: Array) -> Array:
        """Values at t, given offset = t - shift; `resolution` refuses those that are not finite."""
        with np.errstate(all="ignore"):
            if self.sign > 0.0:
                return arguments.real_values("slope", self.function, offset)
            return -arguments.real_values("slope", self.function, -offset)


class Row(NamedTuple):
    """One piece of a slope as plain floats, which cost less than arrays where there are few.

    Its coefficients are high order first.
    """

    lo: float
    hi: float
    origin: float
    coefficients: tuple[float, ...]

    def at(self, x: float) -> float:
        """H at x."""
        value = 0.0
        for c in self.coefficients:
            value = value * (x - self.origin) + c
        return value


@dataclass(frozen=True, eq=False)
class Slope:
    """H on its breaks.

    breaks          (N + 1,), ascending
    origins         (N,)
    coefficients    (N, D), low order first
    degrees         (N,)
    tails           (N, 2), what rounding took from coefficients[:, :2]: a tilt may cancel the rest

    `degrees` is the Chebyshev degree that resolves each piece; it equals the polynomial's degree
    where there is no function.
    """

    breaks: Array
    origins: Array
    coefficients: Array
    degrees: NDArray[np.int64]
    functions: tuple[FunctionTerm, ...] = ()
    tails: Array | float = 0.0

    def locate(self, x: Any, side: Literal["left", "right"] = "right") -> Index:
        """The piece at x; at a break the one on that side of it."""
        k = np.searchsorted(self.breaks, x, side=side) - 1
        return np.asarray(np.minimum(np.maximum(k, 0), len(self.origins) - 1))

    def local(self, k: Any, start: Array, tail: Array, u: Array) -> Array:
        """H at t = (start + tail) + u on the pieces k, without rounding t.

        start and tail (K,), u (K, n).
        """
        c = self.coefficients[k]
        values: Array = c[:, -1:]
        if c.shape[1] > 1:
            y = ((start - self.origins[k]) + tail)[:, None] + u
            for j in range(c.shape[1] - 2, -1, -1):
                values = values * y + c[:, j : j + 1]
        for f in self.functions:
            values = values + f(((start - f.shift) + tail)[:, None] + u)
        return values if values.shape == u.shape else values + np.zeros_like(u)

    def local_derivative(self, k: Any, start: Array, tail: Array, u: Array) -> Array | float:
        """H' of the polynomials at the same points; functions have no derivative here."""
        c = self.coefficients[k]
        degree = c.shape[1] - 1
        if degree == 0:
            return 0.0
        values: Array = degree * c[:, -1:]
        if degree > 1:
            y = ((start - self.origins[k]) + tail)[:, None] + u
            for j in range(degree - 1, 0, -1):
                values = values * y + j * c[:, j : j + 1]
        return values

    def __call__(self, x: Any) -> Array:
        """H(x): the mean of both sides at a break; -inf and inf beyond the ends."""
        flat = np.asarray(x, dtype=float).ravel()
        right = np.searchsorted(self.breaks, flat, side="right") - 1
        left = np.searchsorted(self.breaks, flat, side="left") - 1
        last = len(self.origins) - 1
        values = self._on(np.clip(right, 0, last), flat)
        at_break = np.flatnonzero((left != right) & (left >= 0) & (right <= last))
        if at_break.size:
            values[at_break] = 0.5 * (values[at_break] + self._on(left[at_break], flat[at_break]))
        values[flat < self.breaks[0]] = -np.inf
        values[flat > self.breaks[-1]] = np.inf
        return values.reshape(np.shape(x))

    def inside(self, x: Array) -> Array:
        """H at points x (K, n), each row inside one piece."""
        k = self.locate(x[:, x.shape[1] // 2])
        return self.local(k, np.zeros(len(k)), np.zeros(len(k)), x)

    def _on(self, k: NDArray[np.int64], x: Array) -> Array:
        # Beyond the ends the value is replaced; keep functions in their domain.
        inside = np.clip(x, self.breaks[0], self.breaks[-1])
        return self.local(k, inside, np.zeros_like(inside), np.zeros((len(inside), 1)))[:, 0]

    @property
    def _tails(self) -> Array:
        return np.broadcast_to(self.tails, (len(self.origins), 2))

    @cached_property
    def is_zero(self) -> NDArray[np.bool_]:
        """Whether each piece is flat and needs no work."""
        if self.functions:
            return np.zeros(len(self.origins), dtype=bool)
        return np.logical_not(self.coefficients.any(axis=1))

    @property
    def is_flat_punch(self) -> bool:
        """Whether all pieces are flat and the domain ends on both sides."""
        return bool(self.is_zero.all() and np.isfinite(self.domain).all())

    @cached_property
    def has_zero(self) -> bool:
        """Whether H is 0 on a whole piece."""
        return bool(self.is_zero.any())

    @cached_property
    def degree(self) -> int:
        """The largest degree that resolves a piece."""
        return int(self.degrees.max()) if self.functions else self.coefficients.shape[1] - 1

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

    @cached_property
    def continuous(self) -> bool:
        """Whether H is known to be continuous, up to rounding.

        A function may jump at declared breaks.
        """
        if self.functions:
            return False
        below, above = self.at_breaks
        rounding = JUMP * max(map(abs, below + above), default=0.0)
        return all(abs(a - b) <= rounding for a, b in zip(below, above, strict=True))

    @cached_property
    def at_breaks(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The polynomials' H from the left and from the right of every inner break."""
        ends = self.breaks[1:-1]
        if self.few:  # a flat piece has no row
            below = {row.hi: row.at(row.hi) for row in self.rows}
            above = {row.lo: row.at(row.lo) for row in self.rows}
            left, right = ([H.get(b, 0.0) for b in ends.tolist()] for H in (below, above))
        else:
            k, zero = np.arange(len(ends)), np.zeros(len(ends))
            both = (self.local(j, ends, zero, zero[:, None])[:, 0] for j in (k, k + 1))
            left, right = (H.tolist() for H in both)
        return tuple(left), tuple(right)

    @cached_property
    def rises(self) -> tuple[tuple[float, float], ...]:
        """(break, rise of H) for each inner break where H jumps by more than rounding."""
        sides = zip(self.breaks[1:-1].tolist(), *self.at_breaks, strict=True)
        return tuple(
            (b, above - below)
            for b, below, above in sides
            if abs(above - below) > JUMP * max(abs(below), abs(above))
        )

    def corner(self, x: float) -> tuple[float, float]:
        """Jumps of H and H' at a break x; of functions only that of H, one ulp beside it."""
        j = int(np.searchsorted(self.breaks, x))
        if not 0 < j < len(self.origins):
            return 0.0, 0.0
        k, start, tail = np.array([j - 1, j]), np.array([x, x]), np.zeros(2)
        ulp = np.spacing(abs(x)) if self.functions else 0.0
        below, above = self.local(k, start, tail, np.array([[-ulp], [ulp]]))[:, 0].tolist()
        steep = self.local_derivative(k, start, tail, np.zeros((2, 1)))
        kink = float(steep[1, 0] - steep[0, 0]) if isinstance(steep, np.ndarray) else 0.0
        rounding = (SEEN_JUMP if self.functions else JUMP) * max(abs(below), abs(above))
        return (float(above - below) if abs(above - below) > rounding else 0.0), kink

    def after(self, x: float) -> float:
        """H just right of x, of few pieces."""
        return next((row.at(x) for row in self.rows if row.lo <= x < row.hi), 0.0)

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
        return self._recentred(np.where(bent, zeros, origins)) if bent.any() else self

    def _recentred(self, origins: Array) -> Slope:
        c, tails = self.about(np.arange(len(origins)), origins, self.coefficients.shape[1])
        return replace(self, origins=origins, coefficients=c, tails=tails)

    def split_at(self, x: float) -> Slope:
        """The same slope with one more break, at x."""
        k = int(np.searchsorted(self.breaks, x))
        if not self.breaks[0] < x < self.breaks[-1] or self.breaks[k] == x:
            return self
        twice = np.insert(np.arange(len(self.origins)), k, k - 1)
        return self.chosen(twice, np.insert(self.breaks, k, x))

    def chosen(self, k: NDArray[Any], breaks: Array) -> Slope:
        """These pieces, on other breaks."""
        return replace(
            self,
            breaks=breaks,
            origins=self.origins[k],
            coefficients=self.coefficients[k],
            degrees=self.degrees[k],
            tails=self._tails[k],
        )

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
        c = -self.coefficients[::-1] * (-1.0) ** np.arange(self.coefficients.shape[1])
        functions = tuple(replace(f, shift=-f.shift, sign=-f.sign) for f in self.functions)
        origins, tails = -self.origins[::-1], self._tails[::-1] * (-1.0, 1.0)
        return Slope(-self.breaks[::-1], origins, c, self.degrees[::-1], functions, tails)

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
        degrees = np.maximum(self.degrees[mine], other.degrees[theirs])
        return Slope(breaks, origins, c, degrees, self.functions + other.functions, tails)


def polynomial_slope(
    breaks: Sequence[float],
    origins: Sequence[float],
    coefficients: Sequence[Sequence[float]],
    tails: Array | float = 0.0,
) -> Slope:
    """A Slope from rows of polynomial coefficients of unequal length, and their tails."""
    width = max(len(row) for row in coefficients)
    c = np.array([[*row, *[0.0] * (width - len(row))] for row in coefficients], dtype=float)
    degrees = np.array([max(len(row) - 1, 0) for row in coefficients], dtype=np.int64)
    ends, origin = np.asarray(breaks, dtype=float), np.asarray(origins, dtype=float)
    return Slope(ends, origin, c, degrees, tails=tails)


def _distance(origins: Array, breaks: Array) -> Array:
    """The distance of each origin from its piece.

    It is 0 inside a bounded piece; else the distance from the one end, or from x = 0 without ends.
    Contact is near the finite breaks; a far origin makes large coefficients that cancel there.
    """
    lo, hi = breaks[:-1], breaks[1:]
    outside = np.maximum(np.maximum(lo - origins, origins - hi), 0.0)
    one_end = np.where(np.isfinite(lo), np.abs(origins - lo), np.abs(origins - hi))
    without_ends = np.where(np.isinf(one_end), np.abs(origins), one_end)
    return np.where(np.isfinite(lo) & np.isfinite(hi), outside, without_ends)
