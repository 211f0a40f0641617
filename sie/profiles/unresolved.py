"""Features of a function that its resolution has missed.

The solver uses a function's values at some points only. Two tests show that it changes between the
points of a resolution:

    its values differ from the resolved ones at the points of a low-discrepancy sequence,
    {start + k (√5 - 1)/2} over the contact;

    two neighbouring pieces differ where they meet: the function jumps between the end of a piece
    and the first point on it.

The digits of the contact's edges determine where the sequence starts, so no profile can be adapted
to it. SAMPLES is a Fibonacci number: the largest gap between so many points is 4.5e-4 of the
contact (Sós 1957, three gaps). A narrower feature may not be detected. Towards each edge there is a
point in every octave of the distance, because a kink close to an edge changes all of H beyond it.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS, Interval

from .look import values
from .pieces import Pieces
from .resolution import NOISE, in_series, refuse_non_finite, rounding_noise
from .slope import Slope

Array = NDArray[np.float64]
Known = Callable[[Array], Array]

SAMPLES = 2584
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
# The smallest distance from an edge, of the contact; one point in each octave of the distance.
CLOSEST, HALVINGS = 2.0**-40, 40
# A difference above this multiple of the tolerance shows that the slope was not resolved.
MISSED = 32.0
STEEPER = 8.0  # ulp of x: what these change in H is rounding
CLOSER = 129  # points about the worst
MOST = 64  # places that are bisected at once
FIRST_POINT = 0.003  # of a piece's length: the first of 17 Chebyshev points lies nearer to its end
CLOSE = 512.0  # ulp: a piece so short belongs to a jump, a kink or a cusp
JUMP = 0.25  # of the difference between two pieces, from one double to the next but one
BISECTIONS = 200


def expanded(slope: Slope, resolved: Slope, contact: Interval) -> Pieces:
    """The Chebyshev series of H on the pieces of its resolution inside a contact."""
    ends = resolved.breaks
    kept = np.flatnonzero((ends[1:] > contact.x1) & (ends[:-1] < contact.x2))
    breaks = ends[kept[0] : kept[-1] + 2]
    of_slope = slope.chosen(slope.locate(0.5 * (breaks[1:] + breaks[:-1])), breaks)
    return in_series(replace(of_slope, degrees=resolved.degrees[kept]))


def start_of(edges: tuple[float, ...]) -> float:
    """A number in [0, 1) that the digits of the edges determine."""
    return zlib.crc32(np.array(edges).tobytes()) / 2.0**32


def scattered(contact: Interval, start_at: int = 0) -> Array:
    """Points inside the contact: SAMPLES of the sequence that its edges determine.

    Further points halve their distance from an edge, down to CLOSEST of the contact.
    """
    fractions = start_of((contact.x1, contact.x2)) + _sequence(start_at)
    fractions -= fractions >= 1.0
    width = contact.x2 - contact.x1
    near = width * CLOSEST ** ((fractions[:HALVINGS] + np.arange(HALVINGS)) / HALVINGS)
    x = np.concatenate((contact.x1 + width * fractions, contact.x1 + near, contact.x2 - near))
    return x[(x > contact.x1) & (x < contact.x2)]


@lru_cache(maxsize=2)
def _sequence(start_at: int) -> Array:
    return np.asarray((GOLDEN * np.arange(start_at, start_at + SAMPLES)) % 1.0)


def misfit(
    slope: Slope,
    resolutions: Sequence[Known],
    contact: Interval,
    tol: float = EPS,
    start_at: int = 0,
) -> tuple[Array, Array]:
    """(x, the largest difference of some resolutions from H) on scattered points.

    The difference is set to 0 where it is within the tolerance, or may be rounding of x or of the
    function's own values.
    """
    x = scattered(contact, start_at)
    if len(x) < 2:
        return x, np.zeros(len(x))
    H = values(slope, x)
    refuse_non_finite(x, H)
    difference = np.abs(H - resolutions[0](x))
    for known in resolutions[1:]:
        np.maximum(difference, np.abs(H - known(x)), out=difference)
    allowed = MISSED * tol * float(np.abs(H).max())
    if difference.max() <= allowed:
        return x, np.zeros(len(x))
    x, order = np.unique(x, return_index=True)
    H, difference = H[order], difference[order]
    allowed += _noise(slope, contact)
    rises = np.abs(np.diff(H)) / np.diff(x)
    steep = np.maximum(np.append(rises, 0.0), np.append(0.0, rises))
    steeper = allowed + STEEPER * np.spacing(np.abs(x).max()) * steep
    return x, np.where(difference > steeper, difference, 0.0)


def largest_misfit(slope: Slope, known: Known, resolved: Slope, contact: Interval) -> float:
    """The largest |H - known(x)| beyond rounding, or difference between two pieces.

    The points are other than those of `between_points`. Two pieces that are both shorter than
    rounding of the contact, as next to the axis of |x|^1.04, leave nothing in the pressure beside
    them.
    """
    pieces = expanded(slope, resolved, contact)
    where, difference = _apart(slope, pieces, contact)
    length = np.diff(pieces.breaks)
    where &= np.maximum(length[:-1], length[1:]) > EPS * contact.r
    apart = float(difference[where].max(initial=0.0))
    x, missed = misfit(slope, [known], contact, start_at=SAMPLES)
    if not missed.any():
        return apart
    worst = int(np.argmax(missed))
    near = np.linspace(x[max(worst - 1, 0)], x[min(worst + 1, len(x) - 1)], CLOSER)
    return max(apart, float(missed[worst]), float(np.abs(slope(near) - known(near)).max()))


def between_points(
    slope: Slope, resolutions: Sequence[Known], contact: Interval, tol: float = EPS
) -> tuple[float, ...]:
    """Breaks around what a resolution of the slope has missed.

    Each run of neighbouring points that were missed gives its worst point, and the points beside
    the run.
    """
    x, missed = misfit(slope, resolutions, contact, tol)
    low = np.concatenate(([False], missed > 0.0, [False]))
    starts, ends = np.flatnonzero(low[1:] & ~low[:-1]), np.flatnonzero(low[:-1] & ~low[1:])
    runs = sorted(
        zip(starts.tolist(), ends.tolist(), strict=True),
        key=lambda run: -float(missed[slice(*run)].max()),
    )[:MOST]
    places: list[float] = []
    for start, end in runs:
        worst = start + int(np.argmax(missed[start:end]))
        places += x[[max(start - 1, 0), worst, min(end, len(x) - 1)]].tolist()
    return _new(places, slope, contact)


def between_pieces(
    slope: Slope, pieces: Pieces, contact: Interval, tol: float = EPS
) -> tuple[float, ...]:
    """Breaks where two pieces of a resolution differ at their common end, which is no break."""
    lo, hi = pieces.breaks[:-1], pieces.breaks[1:]
    apart, difference = _apart(slope, pieces, contact, tol)
    length = hi - lo
    near = np.maximum(
        FIRST_POINT * length,
        np.minimum(length, CLOSE * np.spacing(np.maximum(np.abs(lo), np.abs(hi)))),
    )
    j = np.flatnonzero(apart)[:MOST]
    brackets = np.stack((hi[j] - near[j], hi[j] + near[j + 1]), axis=1)
    places: list[float] = []
    jumps = _jumps(slope, brackets, difference[j])
    for bracket, jump in zip(brackets.tolist(), jumps, strict=True):
        places += bracket if jump is None else [jump]
    return _new(places, slope, contact)


def _apart(
    slope: Slope, pieces: Pieces, contact: Interval, tol: float = EPS
) -> tuple[NDArray[np.bool_], Array]:
    """(where two neighbouring pieces differ by more than rounding, by how much), (K - 1,) each."""
    lo, hi, c = pieces.breaks[:-1], pieces.breaks[1:], pieces.series
    difference = np.abs(c.sum(axis=1)[:-1] - (c @ (-1.0) ** np.arange(c.shape[1]))[1:])
    if not difference.size:
        return difference > 0.0, difference
    length, size = hi - lo, np.abs(c).sum(axis=1)
    steep = np.minimum(np.abs(c) @ np.arange(c.shape[1]) ** 2 / (0.5 * length), size / length)
    rounding = STEEPER * np.spacing(np.maximum(np.abs(lo), np.abs(hi))) * steep
    allowed = (
        MISSED * tol * float(size.max()) + _noise(slope, contact) + rounding[1:] + rounding[:-1]
    )
    return (difference > allowed) & ~np.isin(hi[:-1], slope.breaks), difference


def _noise(slope: Slope, contact: Interval) -> float:
    return NOISE * rounding_noise(slope.inside, contact.x1, contact.x2)


def _new(places: list[float], slope: Slope, contact: Interval) -> tuple[float, ...]:
    return tuple(
        p for p in dict.fromkeys(places) if contact.x1 < p < contact.x2 and p not in slope.breaks
    )


def _jumps(slope: Slope, brackets: Array, sizes: Array) -> list[float | None]:
    """The double in each bracket (J, 2) where the slope jumps by about its size, or None.

    All brackets are bisected at once, towards the larger difference.
    """
    if not len(brackets):
        return []
    (lo, hi), (at_lo, at_hi) = brackets.T.copy(), slope.inside(brackets).T.copy()
    for _ in range(BISECTIONS):
        middle = 0.5 * (lo + hi)
        open_ = (lo < middle) & (middle < hi)
        if not open_.any():
            break
        value = slope.inside(middle[:, None])[:, 0]
        below = np.abs(value - at_lo) > np.abs(at_hi - value)
        left, right = open_ & below, open_ & ~below
        hi[left], at_hi[left] = middle[left], value[left]
        lo[right], at_lo[right] = middle[right], value[right]
    x = np.stack((np.nextafter(lo, -np.inf), lo, hi, np.nextafter(hi, np.inf)), axis=1)
    values = slope.inside(x)
    rises = np.abs(values[:, 2:] - values[:, :-2])
    steepest = x[np.arange(len(x)), 1 + np.argmax(rises, axis=1)].tolist()
    jumps = (rises.max(axis=1) > JUMP * sizes).tolist()
    return [at if is_jump else None for at, is_jump in zip(steepest, jumps, strict=True)]
