"""The pieces of a profile on a window: its slope with functions resolved, walls, and periods."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS

from .base import Profile
from .look import across, narrow_parts
from .pieces import Pieces
from .resolution import TINY, refined, without_functions
from .slope import Slope

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# Periods: patches are found from one cut to the next, wherever that is.
COPIES = (-1.0, 0.0, 1.0, 2.0)
FEW = 16  # ends of parts about narrow valleys: beyond, they are cut only where they are missed


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
        parts.append(replace(pieces, breaks=pieces.breaks + shift, origins=pieces.origins + shift))
    return _joined(parts)


def _joined(parts: list[Pieces]) -> Pieces:
    """Pieces of intervals that follow each other."""
    most = max(p.series.shape[1] for p in parts)
    series = [np.pad(p.series, ((0, 0), (0, most - p.series.shape[1]))) for p in parts]
    names = ("origins", "coefficients", "void", "across", "blur")
    return Pieces(
        breaks=np.concatenate([parts[0].breaks[:1], *(p.breaks[1:] for p in parts)]),
        series=np.concatenate(series),
        **{name: np.concatenate([getattr(p, name) for p in parts]) for name in names},
    )


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
        if repeated and hi > pieces.breaks[-1]:  # the rest of a period
            pieces = _inserted(pieces, len(pieces.origins), hi)
            first, last = len(pieces.origins) - 1, 0
        elif lo == hi:
            k = int(np.searchsorted(pieces.breaks, lo))
            at_end = k == len(pieces.breaks) - 1
            pieces = _inserted(pieces, k, lo)
            first, last = k, 0 if at_end else k + 1
        else:
            first = max(int(np.searchsorted(pieces.breaks, lo, "right")) - 1, 0)
            last = int(np.searchsorted(pieces.breaks, min(hi, last_end)))
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
    inserted = {
        name: np.insert(getattr(pieces, name), k, 0.0, axis=0)
        for name in ("coefficients", "series", "across", "blur")
    }
    return replace(
        pieces,
        breaks=np.insert(pieces.breaks, min(k + 1, len(pieces.breaks)), end),
        origins=np.insert(pieces.origins, k, end),
        void=np.insert(pieces.void, k, True),
        **inserted,
    )


def _height(pieces: Pieces, k: Index, profile: Profile, side: float) -> Array:
    """h at the lower ends of pieces k, from inside; of those before k at the upper ends (-1)."""
    x = pieces.breaks[k]
    k = k if side > 0.0 else k - 1
    inner = x + side * np.minimum(pieces._half[k], 1.0)
    return np.asarray(profile.height(inner) - pieces.rise(k, (x, 0.0), (inner, 0.0)))


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
        pieces = without_functions(refined(slope.within(a, b), a, b, EPS))
        places = inside[ahead > 0.0], np.full(np.count_nonzero(ahead > 0.0), start)
        out[ahead > 0.0] = sign * pieces.rises(*places[:: int(-sign)])
    return np.where((x < lo) | (x > hi), np.inf, out)
