"""A slope H on its pieces without functions, and its height h: what several patches ask for.

    H[t, x]      = (H(t) - H(x)) / (t - x)       by Horner's scheme, by the recurrence of T_n[t, x]
    rise(x, y)   = h(y) - h(x)                   the same of the antiderivative, times y - x

Neither loses digits where the points come together. Between the indenters of a row there are pieces
without indenter (`void`): H is 0 there, h infinite, and only the rise across is known.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override
from sie.numerics import chebyshev
from sie.numerics.interval import EPS

from .resolution import TINY, refined
from .slope import Index, Slope

Array = NDArray[np.float64]

GROWTH = 8.0  # a piece is continued beyond its ends while its polynomial grows by no more
EASY = 1.5  # lengths: how far a polynomial of degree 3 or less is continued
WAVES = 6.0  # of these lengths a panel may take in
MISSED = 1e-9  # of the size of H: what differs by more from a function is not resolved
CORNER = 1e-9  # of H': a jump that is no rounding
# times the rounding of each term: what a series leaves out, and the sums over it, are as much
ROUNDINGS = 4.0
LEFT_OUT = 1e-15  # of the largest coefficient: what of a series is left out


@dataclass(frozen=True, eq=False)
class Pieces(Slope):
    """H on K pieces without functions, and the rises of h.

    across     (K,): h at the upper end less h at the lower one of a void piece; nan of others
    blur       (K,): the rounding of that
    """

    across: Array = field(default_factory=lambda: np.zeros(0))
    blur: Array = field(default_factory=lambda: np.zeros(0))

    @override
    def by_piece(self) -> dict[str, Any]:
        return super().by_piece() | {"across": self.across, "blur": self.blur}

    @cached_property
    def void(self) -> NDArray[np.bool_]:
        """Whether there is no indenter, (K,)."""
        return np.isfinite(self.across)

    # -- how far a piece may be continued, and how it bends ----------------------------------------

    @cached_property
    def reach(self) -> Array:
        """The length by which each piece may be continued beyond its ends."""
        n = max(self.coefficients.shape[1] - 1, 1)
        length = 2.0 * self._half
        reach = length * (EASY if n < 4 else 2.0 / n**2)
        if self.series.shape[1] > 1:
            rho = chebyshev.reach(self.series, GROWTH)
            far = self._half * (0.5 * (rho + 1.0 / rho) - 1.0)
            reach = np.where(self.series[:, 1:].any(axis=1), np.minimum(reach, far), reach)
        return np.asarray(np.where(self.void, 0.0, reach))

    @cached_property
    def plain(self) -> Array:
        """A length over which each piece is as good as a polynomial of low degree."""
        n = np.full(len(self.origins), self.coefficients.shape[1] - 1)
        if self.series.shape[1]:
            order = np.arange(self.series.shape[1])
            n = np.maximum(n, np.where(self.series != 0.0, order, 0).max(axis=1))
        with np.errstate(invalid="ignore"):
            return np.asarray(np.where(n < 4, np.inf, 2.0 * self._half / np.maximum(n, 1)))

    @cached_property
    def cuts(self) -> Array:
        """The ends, and between them as many places as the degree of a series asks for."""
        bounded = np.isfinite(self.plain) & np.isfinite(self._half)
        parts = np.ones(len(self.origins))
        parts[bounded] = 2.0 * self._half[bounded] / (WAVES * self.plain[bounded])
        if not (parts > 1.0).any():
            return self.breaks
        count = np.maximum(np.ceil(parts), 1.0).astype(int)
        inner = [
            np.linspace(a, b, n + 1)[:-1]
            for a, b, n in zip(self.breaks, self.breaks[1:], count)
            if n > 1
        ]
        return np.union1d(self.breaks, np.concatenate(inner))

    def jump_within(self, lo: Array, hi: Array) -> NDArray[np.bool_]:
        """Whether H jumps anywhere inside intervals."""
        x = self.breaks[1:-1][self.steps != 0.0]
        return np.asarray(np.searchsorted(x, hi) > np.searchsorted(x, lo, "right"))

    def bends(self, k: Index, above: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Whether H' jumps at the upper ends of pieces, or at the lower ones."""
        other = np.clip(np.where(above, k + 1, k - 1), 0, len(self.origins) - 1)
        x = self.breaks[k + above]
        with np.errstate(invalid="ignore"):
            own, theirs = self.curvature(k, x), self.curvature(other, x)
            jump = np.abs(own - theirs) > CORNER * np.maximum(np.abs(own), np.abs(theirs))
        return np.asarray(jump & np.isfinite(x))

    def curvature(self, k: Any, x: Any) -> Any:
        """H' of the pieces k at x."""
        return self.derivative.value(k, x, 0.0)

    # -- walls -------------------------------------------------------------------------------------

    def solid_around(self, x: Array) -> tuple[Array, Array]:
        """The ends of the interval without walls that each x is in."""
        void = np.flatnonzero(self.void)
        starts = np.concatenate((self.breaks[:1], self.breaks[void + 1]))
        stops = np.concatenate((self.breaks[void], self.breaks[-1:]))
        k = np.clip(np.searchsorted(starts, x, side="right") - 1, 0, len(starts) - 1)
        return starts[k], stops[k]

    @cached_property
    def concave(self) -> Array:
        """Concave corners, where H jumps down between two pieces of the indenter."""
        return np.asarray(self.breaks[1:-1][(self.steps < 0.0) & ~(self.void[:-1] | self.void[1:])])

    @cached_property
    def never_closed(self) -> Array:
        """Places that no contact covers: walls, and concave corners."""
        walls = self.breaks[1:-1][self.void[:-1] | self.void[1:]]
        return np.union1d(self.concave, walls)

    # -- divided differences and rises -------------------------------------------------------------

    def divided(self, k: Any, t: tuple[Any, Any], x: tuple[Any, Any]) -> Any:
        """H[t, x] of the pieces k at two points (anchor, offset)."""
        power = self.coefficients.T
        yt, yx = (p[0] - self.origins[k] + p[1] for p in (t, x))
        value = power[-1][k] + 0.0 * yt
        slope = np.zeros(np.broadcast(yt, yx).shape, dtype=np.result_type(yt, yx))
        for c in power[-2::-1]:
            slope = slope * yx + value
            value = value * yt + c[k]
        if self.series.shape[1] > 1:
            st, sx = (((p[0] - self._centre[k]) + p[1]) / self._half[k] for p in (t, x))
            slope = slope + _divided_series(self.series.T, k, st, sx) / self._half[k]
        return slope

    @cached_property
    def _height(self) -> Pieces:
        """h on the same pieces, each up to a constant of its own."""
        K, D = self.coefficients.shape
        power, series = np.zeros((K, D + 1)), self.series
        power[:, 1:] = self.coefficients / np.arange(1, D + 1)
        if series.shape[1]:
            series = chebyshev.antiderivative(series) * self._half[:, None]
        return replace(self, coefficients=power, series=series)

    def valleys(self, tilt: float, lo: float, hi: float) -> int:
        """How often H + tilt rises through 0 on [lo, hi], as the ends of its pieces show."""
        k = np.arange(int(self.locate(lo)), int(self.locate(hi, "left")) + 1)
        ends = np.clip((self.breaks[k], self.breaks[k + 1]), lo, hi)
        falls = self.value(k, ends, 0.0).T.ravel() < -tilt
        return int(np.count_nonzero(falls[:-1] & ~falls[1:]))

    def rise(self, k: Any, x: tuple[Any, Any], y: tuple[Any, Any]) -> Any:
        """h(y) - h(x) on the pieces k."""
        return self._height.divided(k, y, x) * ((y[0] - x[0]) + (y[1] - x[1]))

    def rises(self, x: Array, y: Array, *, walls: bool = False) -> Array:
        """h(y) - h(x) for x <= y, over any number of pieces; `walls`: those at x and y as well."""
        kx = self.locate(x, "left" if walls else "right")
        ky = np.maximum(self.locate(y, "right" if walls else "left"), kx)
        same = kx == ky
        upper, lower = np.where(same, y, self.breaks[kx + 1]), np.where(same, y, self.breaks[ky])
        total = np.where(self.void[kx] & (y > x), self.across[kx], 0.0)
        total += np.where(self.void[ky] & ~same, self.across[ky], 0.0)
        last = ~same & ~self.void[ky]
        for k, a, b, some in ((kx, x, upper, ~self.void[kx]), (ky, lower, y, last)):
            total[some] += self.rise(k[some], (a[some], 0.0), (b[some], 0.0))
        between = ky - kx > 1
        if between.any():
            cuts = np.stack((kx[between] + 1, ky[between]), axis=1).ravel()
            whole = np.append(self._whole, 0.0)
            total[between] += np.add.reduceat(whole, cuts)[::2]
        return total

    @cached_property
    def _whole(self) -> Array:
        """h at the upper end less h at the lower one of each piece (0 of an unbounded one)."""
        k = np.flatnonzero(np.isfinite(self._half) & ~self.void)
        whole = np.where(self.void, self.across, 0.0)
        whole[k] = self.rise(k, (self.breaks[k], 0.0), (self.breaks[k + 1], 0.0))
        return whole

    def rounding(self, x: Array, y: Array) -> Array:
        """A bound of the rounding error of h(y) - h(x) for x <= y.

        It is that of the terms of H over the way; of a series that of its places as well, and of
        the place of a concave corner.
        """
        kx = self.locate(x)
        ky = np.maximum(kx, self.locate(y, "left"))
        same = kx == ky
        total = self._rounding(kx, x, np.where(same, y, self.breaks[kx + 1]))
        total += self._rounding(ky, np.where(same, y, self.breaks[ky]), y)
        until, corners = self._roundings
        total += np.maximum(until[ky] - until[np.minimum(kx + 1, ky)], 0.0)
        return np.asarray(ROUNDINGS * EPS * (total + (corners[ky] - corners[kx])))

    @cached_property
    def _roundings(self) -> tuple[Array, Array]:
        """The terms of h over all pieces before each (0 of unbounded ones), and of its corners."""
        k = np.flatnonzero(np.isfinite(self._half))
        found = np.zeros(len(self.origins))
        found[k] = self._rounding(k, self.breaks[k], self.breaks[k + 1])
        corners = np.abs(self.breaks[1:-1] * np.minimum(self.steps, 0.0))
        return np.append(0.0, np.cumsum(found)), np.append(0.0, np.cumsum(corners))

    def _rounding(self, k: Index, x: Array, y: Array) -> Array:
        """The terms of h(y) - h(x) on pieces k, and what the places of a series come to."""
        length = y - x
        terms = np.maximum(self.terms(k, x), self.terms(k, y)) * length
        if self.series.shape[1] > 1:
            bent = np.abs(self.series[k, 1:]).sum(axis=1)
            terms = terms + np.where(length > 0.0, bent * np.maximum(np.abs(x), np.abs(y)), 0.0)
        return np.where(self.void[k], np.where(length > 0.0, self.blur[k] / EPS, 0.0), terms)

    # -- beside a profile --------------------------------------------------------------------------

    def missed(self, slope: Slope, x: Array) -> Array:
        """The places among x of a window on which the pieces differ from a function.

        What is narrower than the pieces that resolved it shows there.
        """
        inside = x[(x >= self.breaks[0]) & (x <= self.breaks[-1])]
        k = self.locate(inside)  # at a cut in a jump the mean of both sides is no value of it
        with np.errstate(all="ignore"):
            H, found = slope(inside), self.value(k, inside, 0.0)
            size = np.abs(self.series).sum(axis=1)[k]
        return np.asarray(inside[np.abs(H - found) > MISSED * np.maximum(size, np.abs(H))])

    def horizon(self, tilt: float, c: Array) -> float:
        """The distance from places c within which all valleys of h + tilt x are.

        On the line: the finite ends, and the roots of the outer polynomials (Fujiwara's bound).
        """
        ends = self.breaks[np.isfinite(self.breaks)]
        reach = [np.abs(ends[[0, -1], None] - c).max()] if ends.size else [0.0]
        for k in {0, len(self.origins) - 1}:
            power = self.coefficients[k].copy()
            power[0] += np.copysign(tilt, power[0])
            if power[1:].any() and not np.isfinite(self._half[k]):
                reach.append(np.abs(self.origins[k] - c).max() + root_bound(power))
        return float(max(reach))


# -- the pieces of a profile -----------------------------------------------------------------------


def without_functions(resolved: Slope) -> Pieces:
    """The pieces of a slope whose functions are resolved: these become series."""
    K, degree = len(resolved.origins), resolved.degree
    none, lo, half = np.zeros((K, 1)), resolved.breaks[:-1], 0.5 * np.diff(resolved.breaks)
    rows = resolved.by_piece() | {"across": np.full(K, np.nan), "blur": np.zeros(K)}
    if resolved.functions:
        plain = replace(resolved, coefficients=none)
        u = half[:, None] * (1.0 + chebyshev.points(degree + 1))
        series = chebyshev.transform(plain.value(np.arange(K)[:, None], lo[:, None], u))
        series[np.abs(series) < LEFT_OUT * np.abs(series).max()] = 0.0
        rows["series"] = series
    return Pieces(resolved.breaks, **rows)


def from_slope(slope: Slope, window: tuple[float, float], tol: float) -> Pieces:
    """The pieces of a slope; its functions are resolved on the window."""
    return without_functions(refined(slope, *window, tol))


def integral(slope: Slope, start: float, x: Array) -> Array:
    """∫ H from start to each x (any shape), by resolved pieces; inf beyond the indenter's ends."""
    lo, hi = slope.domain
    inside = np.clip(x, lo, hi)
    out = np.zeros(np.shape(x))
    for sign in (-1.0, 1.0):
        ahead = sign * (inside - start)
        if ahead.max(initial=0.0) <= TINY:  # half of it may be no double
            continue
        a, b = sorted((start, start + sign * float(ahead.max())))
        pieces = from_slope(slope.within(a, b), (a, b), EPS)
        places = inside[ahead > 0.0], np.full(np.count_nonzero(ahead > 0.0), start)
        out[ahead > 0.0] = sign * pieces.rises(*places[:: int(-sign)])
    return np.where((x < lo) | (x > hi), np.inf, out)


def root_bound(c: Array) -> float:
    """The distance from its origin within which a polynomial has all of its roots (Fujiwara 1916).

    It is 0 for a constant.
    """
    size = np.abs(c)
    degree = int(np.flatnonzero(size)[-1]) if size.any() else 0
    powers = 1.0 / np.arange(degree, 0, -1)
    return 2.0 * float(((size[:degree] / size[degree]) ** powers).max(initial=0.0))


def _divided_series(c: Array, k: Any, t: Any, x: Any) -> Any:
    """Σ c_n T_n[t, x] by T_{n+1}[t, x] = 2t T_n[t, x] + 2T_n(x) - T_{n-1}[t, x]."""
    before: Any = 0.0
    now: Any = np.ones(np.broadcast(t, x).shape, dtype=np.result_type(t, x))
    T_before: Any = 1.0
    T_now: Any = x
    total = c[1][k] * now
    for row in c[2:]:
        before, now = now, 2.0 * t * now + 2.0 * T_now - before
        T_before, T_now = T_now, 2.0 * x * T_now - T_before
        total = total + row[k] * now
    return total
