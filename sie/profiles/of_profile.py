"""The pieces of a profile with its walls: the intervals without indenter, and the rise across them.

Functions are resolved on a window. Of a periodic profile there are several copies, as patches are
found from one cut to the next, wherever that is.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS

from .look import across, narrow_parts
from .pieces import Pieces, from_slope
from .slope import Index, Slope, chained

if TYPE_CHECKING:
    from .base import Profile

Array = NDArray[np.float64]

COPIES = (-1.0, 0.0, 1.0, 2.0)
FEW = 16  # ends of parts about narrow valleys: beyond, they are cut only where they are missed


def of_profile(
    profile: Profile, window: tuple[float, float], tol: float, cuts: Array | None = None
) -> Pieces:
    """The slope of a profile with its walls, functions resolved on the window.

    Between two of the `cuts` they are resolved to the rounding of the slopes there, and so they are
    about their narrow valleys. Of a periodic profile there are several copies.
    """
    pieces = _with_walls(_resolved(profile.pieces, window, tol, cuts), profile)
    if profile.period == np.inf:
        return pieces
    shifts = [turn * profile.period for turn in COPIES]
    copies = ((pieces.breaks + shift, pieces.origins + shift) for shift in shifts)
    return chained([replace(pieces, breaks=b, origins=o) for b, o in copies])


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
    return chained([from_slope(slope, part, tol) for part in pairwise(ends)])


def _with_walls(pieces: Pieces, profile: Profile) -> Pieces:
    """The pieces with those that have no indenter, and the rise across each of these."""
    (first_end, last_end), repeated = pieces.domain, profile.period < np.inf
    crossed = []
    for lo, hi in profile.walls:
        if not repeated and (hi <= first_end or lo >= last_end):
            continue  # beside the window
        rest = repeated and hi > pieces.breaks[-1]  # of a period
        if rest or lo == hi:
            k = len(pieces.origins) if rest else int(np.searchsorted(pieces.breaks, lo))
            at_end = k == len(pieces.origins)
            pieces = _inserted(pieces, k, hi)
            crossed.append((k, 0 if at_end else k + 1))
            continue
        first = max(int(np.searchsorted(pieces.breaks, lo, "right")) - 1, 0)
        last = int(np.searchsorted(pieces.breaks, min(hi, last_end)))
        pieces.across[first:last] = 0.0
        # beyond, something solid has to be in the window
        if first < last and lo >= first_end and hi <= last_end:
            crossed.append((first, last))
    if crossed:
        first_of, last_of = np.array(crossed).T
        after = _height_at(pieces, last_of, profile, 1.0)
        before = _height_at(pieces, first_of, profile, -1.0)
        pieces.across[first_of] = after - before
        pieces.blur[first_of] = EPS * (np.abs(after) + np.abs(before))
    return pieces


def _inserted(pieces: Pieces, k: int, end: float) -> Pieces:
    """A void piece before piece k, up to `end`."""
    rows = {name: np.insert(v, k, 0.0, axis=0) for name, v in pieces.by_piece().items()}
    rows["origins"][k] = end
    return replace(
        pieces, breaks=np.insert(pieces.breaks, min(k + 1, len(pieces.breaks)), end), **rows
    )


def _height_at(pieces: Pieces, k: Index, profile: Profile, side: float) -> Array:
    """h at the lower ends of pieces k, from inside; of those before k at the upper ends (-1)."""
    x = pieces.breaks[k]
    k = k if side > 0.0 else k - 1
    inner = x + side * np.minimum(pieces._half[k], 1.0)
    return np.asarray(profile.height(inner) - pieces.rise(k, (x, 0.0), (inner, 0.0)))
