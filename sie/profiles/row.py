"""Indenters on one rigid holder, and indenters that repeat themselves.

Row        h(x) is the least of the heights of several profiles, infinite beyond all of them
Periodic   h is that of one profile on one period, repeated for ever

The slope of a row is that of the profile that is lowest there. Where two of them cross the row has
a concave corner, which contact never reaches; where one ends below another h jumps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.arguments import abridged
from sie.inheritance import override
from sie.numerics.zones import united

from .base import Profile, function_slope
from .indenter import of_any_x
from .lowest_profile import finite_ends, inside, lowest_of
from .placed_traces import closed, open_seams
from .slope import Slope, chained, polynomial_slope

Array = NDArray[np.float64]
INF = float("inf")

POINTS = 38  # of a period at which its heights are compared
WHOLE = 1e-12  # of a period: by so much a profile may be longer, by rounding
LEVEL = 1e-9  # of the heights: by so much the ends of a period may differ, by rounding


@dataclass(frozen=True, init=False, repr=False)
class Row(Profile):
    """Several indenters on one rigid holder: h(x) is the least of theirs.

    Parameters
    ----------
    profiles : sequence of Profile
        The indenters, each where it stands: `shifted(dx)` moves one along the surface, `raised(dz)`
        away from it. At least one; none of them periodic.

    Raises
    ------
    ValueError
        If there is no profile, or one is not a profile or is periodic.

    Examples
    --------
    >>> from sie import Flat
    >>> row = Row([Flat(0.4).shifted(-0.6), Flat(0.5).shifted(0.8).raised(0.001)])
    >>> row.height([-0.5, 0.0, 0.5])
    array([0.   ,   inf, 0.001])
    """

    profiles: tuple[Profile, ...]

    def __init__(self, profiles: Iterable[Profile]) -> None:
        given = tuple(profiles) if isinstance(profiles, Iterable) else (profiles,)
        if not given:
            raise ValueError("a row without profiles: give at least one")
        for k, profile in enumerate(given):
            if not isinstance(profile, Profile):
                raise ValueError(
                    f"profiles[{k}] = {profile!r} is not a profile: give sie.Parabola(...) or "
                    "another"
                )
            if profile.period < INF:
                raise ValueError(
                    f"profiles[{k}] is periodic: make a row of what is in one period and repeat "
                    "that"
                )
        object.__setattr__(self, "profiles", given)

    def __repr__(self) -> str:
        return f"Row([{abridged(self.profiles)}])"

    @property
    @override
    def of_several(self) -> bool:
        return True

    @cached_property
    def lowest(self) -> tuple[tuple[float, float, int], ...]:
        """(lo, hi, which profile is the lowest there), ascending; -1 where there is none."""
        return tuple(lowest_of(self.profiles))

    @cached_property
    def walls(self) -> tuple[tuple[float, float], ...]:
        """Gaps (lo, hi) between the profiles, and places lo = hi where h jumps."""
        found = [(lo, hi) for lo, hi, k in self.lowest if k < 0]
        for (_, x, one), (_, _, other) in pairwise(self.lowest):
            beside = [self.profiles[k] for k in (one, other) if min(one, other) >= 0]
            if any(x in finite_ends(profile) for profile in beside):
                found.append((x, x))
        for lo, hi, k in self.lowest:
            found += [
                wall for wall in self.profiles[max(k, 0)].walls if lo < wall[0] and wall[1] < hi
            ]
        return united(found)

    @cached_property
    def pieces(self) -> Slope:
        """The slope of whichever profile is lowest; 0 where there is none."""
        if any(self.profiles[k].pieces.functions for _, _, k in self.lowest if k >= 0):
            ends = {x for run in self.lowest for x in run[:2]}
            inner = {b for p in self.profiles for b in p.breaks if min(ends) < b < max(ends)}
            return function_slope(sorted(ends | inner), self._lowest_slope)
        none = polynomial_slope((-INF, INF), (0.0,), ((0.0,),))
        slopes = [self.profiles[k].pieces if k >= 0 else none for _, _, k in self.lowest]
        return chained([s.within(lo, hi) for s, (lo, hi, _) in zip(slopes, self.lowest)])

    def _lowest_slope(self, x: Array) -> Array:
        """The slope of the lowest profile at x; 0 where there is none."""
        ends = np.array([hi for _, hi, _ in self.lowest[:-1]])
        which = np.array([k for _, _, k in self.lowest])[np.searchsorted(ends, x, side="right")]
        values = np.zeros(x.shape)
        for k in np.unique(which[which >= 0]).tolist():
            values[which == k] = self.profiles[k].pieces(x[which == k])
        return values

    @cached_property
    def _lowest_on(self) -> Array:
        """From where to where each profile is the lowest, if not all the way, (n, 2)."""
        reach = np.tile((INF, -INF), (len(self.profiles), 1))
        for lo, hi, k in self.lowest:
            reach[k] = (min(reach[k, 0], lo), max(reach[k, 1], hi)) if k >= 0 else reach[k]
        return reach

    @of_any_x
    @override
    def height(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        flat = x.ravel()
        order = np.argsort(flat, kind="stable")
        least = np.full(flat.shape, INF)
        for k, some in inside(self.profiles, self._lowest_on, flat[order]):
            least[some] = np.minimum(least[some], self.profiles[k].height(flat[order[some]]))
        out = np.empty(flat.shape)
        out[order] = least
        return out.reshape(x.shape)

    @cached_property
    def ends_are_corners(self) -> tuple[bool, bool]:
        """Those of the profiles that reach farthest."""
        lo, hi = self.domain
        left = [p.ends_are_corners[0] for p in self.profiles if p.domain[0] == lo]
        right = [p.ends_are_corners[1] for p in self.profiles if p.domain[1] == hi]
        return all(left), all(right)


@dataclass(frozen=True, init=False, repr=False)
class Periodic(Profile):
    """A profile that is repeated with a period: loads are then per period.

    Parameters
    ----------
    profile : Profile
        The indenter on one period: on its domain where that is bounded (and no longer than the
        period); otherwise on one period about its axis, or about x = 0 if it has none, with its
        neighbours where they are lower. Where it is shorter than the period there is no indenter
        between.
    period : float
        The length after which it is repeated.

    Raises
    ------
    ValueError
        If the period is not positive or the profile is longer, or is periodic already.

    Examples
    --------
    >>> from sie import Parabola
    >>> wave = Periodic(Parabola(1.0), period=2.0)
    >>> wave.height([0.5, 2.5])
    array([0.125, 0.125])
    """

    profile: Profile
    repeats: float

    def __init__(self, profile: Profile, period: float) -> None:
        if not isinstance(profile, Profile):
            raise ValueError(
                f"profile = {profile!r} is not a profile: give sie.Parabola(...) or another"
            )
        if profile.period < INF:
            raise ValueError("the profile is periodic already: give the one that is repeated")
        period = arguments.positive("period", period)
        lo, hi = profile.domain
        if abs(lo) < INF and abs(hi) < INF and hi - lo > period * (1.0 + WHOLE):
            raise ValueError(
                f"the profile is {hi - lo:g} long, more than its period {period:g}: "
                "give a longer period, or the part that is repeated"
            )
        object.__setattr__(self, "profile", profile)
        object.__setattr__(self, "repeats", period)

    def __repr__(self) -> str:
        return f"Periodic({self.profile!r}, period={self.repeats!r})"

    @property
    def period(self) -> float:
        """The distance after which the profile repeats itself, a length."""
        return self.repeats

    @cached_property
    def start(self) -> float:
        """The beginning of the period of `profile` that is repeated."""
        lo, hi = self._closed.domain
        if abs(lo) < INF:
            return lo
        if abs(hi) < INF:
            return hi - self.repeats
        return (self.profile.axis or 0.0) - 0.5 * self.repeats

    @cached_property
    def _closed(self) -> Profile:
        """The given profile, with periodic splines for its traces whose ends meet."""
        return closed(self.profile, self.repeats)

    @cached_property
    def repeated(self) -> Profile:
        """The profile that is repeated: the given one, or the lowest of it and its neighbours.

        The latter is taken where the ends of an unbounded one do not meet.
        """
        if all(abs(end) < INF for end in self._closed.domain) or self._level(self._closed):
            return self._closed
        return Row([self.profile.shifted(turn * self.repeats) for turn in (-1, 0, 1)])

    def _level(self, profile: Profile) -> bool:
        """Whether both ends of a period are equally high."""
        x = self.start + self.repeats * np.linspace(0.0, 1.0, POINTS)
        heights = profile.height(np.clip(x, *profile.domain))  # the last x is rounded
        size = np.abs(heights[np.isfinite(heights)]).max(initial=0.0)
        return bool(abs(heights[-1] - heights[0]) <= LEVEL * size)

    @cached_property
    def pieces(self) -> Slope:
        """H on one period, from `start`; shorter where the indenter is."""
        slope = self.repeated.pieces
        return slope.within(self.start, min(self.start + self.repeats, slope.domain[1]))

    @cached_property
    def walls(self) -> tuple[tuple[float, float], ...]:
        """Those in the period that begins at `start`; the last one may reach up to its end."""
        lo, hi = self.pieces.domain
        end = self.start + self.repeats
        found = [(a, b) for a, b in self.repeated.walls if lo < a and b < hi]
        if end - hi > WHOLE * self.repeats:
            found.append((hi, end))
        elif not self._level(self.repeated):
            found.append((hi, hi))
        return tuple(found)

    @property
    @override
    def joint(self) -> str:
        seams = open_seams(self.profile, self.repeats)
        if not seams:
            return ""
        hi = self.pieces.domain[1]
        left = seams[0].left
        how = f"with {left:.4g} without indenter" if left else "with a corner"
        return (
            f"note: the ends of the trace do not meet at x = {hi:.6g}, {seams[0]}: it repeats "
            f"{how}, where contact has an infinite pressure; cut it between two places of one "
            "height and slope"
        )

    def _within(self, x: Array) -> Array:
        """The same places in the period that begins at `start`."""
        return x - self.repeats * np.floor((x - self.start) / self.repeats)

    @override
    def slope(self, x: ArrayLike) -> Array:
        hi = self.pieces.domain[1]
        return self._in_period(lambda x: np.where(x > hi, INF, self.pieces(np.minimum(x, hi))), x)

    @override
    def height(self, x: ArrayLike) -> Array:
        return self._in_period(self.repeated.height, x)

    def _in_period(self, function: Callable[[Array], Array], x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        finite = np.isfinite(x)
        values = function(self._within(np.where(finite, x, self.start)))
        return np.where(finite, values, np.nan)[()]

    @property
    def breaks(self) -> tuple[float, ...]:
        """Those in the period that begins at `start`."""
        return tuple(self.pieces.breaks[1:-1].tolist())

    @property
    @override
    def domain(self) -> tuple[float, float]:
        return -INF, INF

    @property
    @override
    def axis(self) -> float | None:
        return self.profile.axis

    @override
    def tilted(self, slope: float) -> Profile:
        if arguments.measure("tilted", slope) != 0.0:
            raise ValueError(
                f"tilted({slope:g}) of a periodic profile is not periodic: leave it level"
            )
        return self

    @override
    def shifted(self, dx: float) -> Profile:
        return Periodic(self.profile.shifted(dx), self.repeats)

    @override
    def mirrored(self) -> Profile:
        return Periodic(self.profile.mirrored(), self.repeats)

    @override
    def raised(self, dz: float) -> Profile:
        return Periodic(self.profile.raised(dz), self.repeats)
