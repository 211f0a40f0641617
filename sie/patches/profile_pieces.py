"""The pieces of a profile on a window: its slope with functions resolved, walls, and periods."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.profiles.base import Profile
from sie.profiles.look import across, narrow_parts
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope

from .pieces import Pieces

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# Periods: patches are found from one cut to the next, wherever that is.
COPIES = (-1.0, 0.0, 1.0, 2.0)
FEW = 16  # ends of parts about narrow valleys: beyond, they are cut only where they are missed
ROUNDING = 1e-15  # of the largest coefficient: what of a series is left out


def of_profile(
    profile: Profile, window: tuple[float, float], tol: float, cuts: Array | None = None
) -> Pieces:
    """The slope of a profile with its walls, functions resolved on the window.

    Between two of the `cuts` they are resolved to the rounding of the slopes there, and so they are
    about their narrow valleys. Of a periodic profile there are several copies.
    """
    slope = profile.pieces
    pieces = _with_walls(_resolved(slope, window, tol, cuts), profile.walls, profile)
    if profile.period == np.inf:
        return pieces
    parts = []
    for turn in COPIES:
        shift = turn * profile.period
        parts.append(replace(pieces, ends=pieces.ends + shift, origin=pieces.origin + shift))
    return _joined(parts)


def _joined(parts: list[Pieces]) -> Pieces:
    """Pieces of intervals that follow each other."""
    most = max(p.series.shape[1] for p in parts)
    series = [np.pad(p.series, ((0, 0), (0, most - p.series.shape[1]))) for p in parts]
    names = ("origin", "power", "void", "across", "blur")
    origin, power, *others = (np.concatenate([getattr(p, n) for p in parts]) for n in names)
    ends = np.concatenate([parts[0].ends[:1], *(p.ends[1:] for p in parts)])
    return Pieces(ends, origin, power, np.concatenate(series), *others)


def _resolved(slope: Slope, window: tuple[float, float], tol: float, cuts: Array | None) -> Pieces:
    if not slope.functions:
        return from_slope(slope, window, tol)
    narrow = narrow_parts(slope, across(slope, window))
    if len(narrow) > FEW:
        pieces = _between(slope, window, tol, cuts)
        if not pieces.missed(slope, narrow).size:
            return pieces
    return _between(slope, window, tol, narrow if cuts is None else np.union1d(cuts, narrow))


def _between(slope: Slope, window: tuple[float, float], tol: float, cuts: Array | None) -> Pieces:
    if cuts is None:
        return from_slope(slope, window, tol)
    ends = [window[0], *cuts[(cuts > window[0]) & (cuts < window[1])].tolist(), window[1]]
    return _joined([from_slope(slope, part, tol) for part in pairwise(ends)])


def _with_walls(pieces: Pieces, walls: tuple[tuple[float, float], ...], profile: Profile) -> Pieces:
    first_end, last_end = pieces.domain
    crossed = []
    for lo, hi in walls:
        repeated = profile.period < np.inf
        if not repeated and (hi <= first_end or lo >= last_end):
            continue  # beside the window
        if repeated and hi > pieces.ends[-1]:  # the rest of a period
            pieces = _inserted(pieces, len(pieces.origin), hi)
            first, last = len(pieces.origin) - 1, 0
        elif lo == hi:
            k = int(np.searchsorted(pieces.ends, lo))
            at_end = k == len(pieces.ends) - 1
            pieces = _inserted(pieces, k, lo)
            first, last = k, 0 if at_end else k + 1
        else:
            first = max(int(np.searchsorted(pieces.ends, lo, "right")) - 1, 0)
            last = int(np.searchsorted(pieces.ends, min(hi, last_end)))
            if first == last:
                continue
            pieces.void[first:last] = True
            if lo < first_end or hi > last_end:
                continue  # nothing solid is in the window on the other side
        crossed.append((first, last))
    if crossed:
        first, last = np.array(crossed).T
        after, before = _height(pieces, last, profile, 1.0), _height(pieces, first, profile, -1.0)
        pieces.across[first] = after - before
        pieces.blur[first] = EPS * (np.abs(after) + np.abs(before))
    return pieces


def _inserted(pieces: Pieces, k: int, end: float) -> Pieces:
    """A void piece before piece k, up to `end`."""
    return Pieces(
        np.insert(pieces.ends, k + 1, end) if k < len(pieces.ends) else np.append(pieces.ends, end),
        np.insert(pieces.origin, k, end),
        np.insert(pieces.power, k, 0.0, axis=0),
        np.insert(pieces.series, k, 0.0, axis=0),
        np.insert(pieces.void, k, True),
        np.insert(pieces.across, k, 0.0),
        np.insert(pieces.blur, k, 0.0),
    )


def _height(pieces: Pieces, k: Index, profile: Profile, side: float) -> Array:
    """h at the lower ends of pieces k, from inside; of those before k at the upper ends (-1)."""
    x = pieces.ends[k]
    k = k if side > 0.0 else k - 1
    inner = x + side * np.minimum(pieces._half[k], 1.0)
    return np.asarray(profile.height(inner) - pieces.rise(k, (x, 0.0), (inner, 0.0)))


def from_slope(slope: Slope, window: tuple[float, float], tol: float) -> Pieces:
    """The pieces of a slope; its functions are resolved on the window."""
    resolved = refined(slope, *window, tol)
    K = len(resolved.origins)
    series = np.zeros((K, 0))
    if resolved.functions:
        lo, length = resolved.breaks[:-1], np.diff(resolved.breaks)
        n = int(resolved.degrees.max()) + 1
        u = 0.5 * length[:, None] * (1.0 + chebyshev.points(n))
        only = replace(resolved, coefficients=np.zeros((K, 1)))
        series = chebyshev.transform(only.local(np.arange(K), lo, np.zeros(K), u))
        series[np.abs(series) < ROUNDING * np.abs(series).max()] = 0.0
    none, zero = np.zeros(K, dtype=bool), np.zeros(K)
    return Pieces(
        resolved.breaks, resolved.origins, resolved.coefficients, series, none, zero, zero.copy()
    )
