"""What the resolution of a function has not seen, looked for where it did not look.

A function is known by its values at some points only. Two things tell that it changes between the points of a resolution:

    its values at the points of a low-discrepancy sequence, {start + k (√5 - 1)/2} over the contact, differ from the resolved ones;
    two neighbouring pieces differ where they meet: the function jumps between the end of a piece and the first point on it.

The digits of the contact's edges determine where the sequence starts, so no profile can be made to agree with it. SAMPLES is a Fibonacci
number: the largest gap between so many points is 2.9e-4 of the contact (Sós 1957, three gaps); what is narrower may stay unseen.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import chebyshev
from .adaptive import NOISE, refuse_non_finite, rounding_noise
from .interval import EPS, Interval
from .slope import Slope

Array = NDArray[np.float64]
Known = Callable[[Array], Array]

SAMPLES = 4181
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
MISSED = 32.0 * EPS  # of the largest slope: what differs by more was not seen
STEEPER = 8.0  # ulp of x: what these change in H is rounding
CLOSER = 129  # points about the worst
MOST = 64  # places that are looked at more closely at once
FIRST_POINT = 0.003  # of a piece's length: the first of 17 Chebyshev points lies nearer to its end
CLOSE = 512.0  # ulp: a piece so short belongs to a jump, a kink or a cusp
JUMP = 0.25  # of the difference between two pieces, from one double to the next but one
BISECTIONS = 200


def scattered(contact: Interval, start_at: int = 0) -> Array:
    """Points inside the contact, ascending: SAMPLES of the low-discrepancy sequence that its edges determine."""
    start = zlib.crc32(np.array([contact.x1, contact.x2]).tobytes()) / 2.0**32
    fractions = np.sort((start + GOLDEN * np.arange(start_at, start_at + SAMPLES)) % 1.0)
    x = contact.x1 + (contact.x2 - contact.x1) * fractions
    return x[(x > contact.x1) & (x < contact.x2)]


def misfit(slope: Slope, resolutions: Sequence[Known], contact: Interval, start_at: int = 0) -> tuple[Array, Array]:
    """(x, how far the worst of some resolutions is from H) on scattered points; 0 where that may be rounding.

    Of H, that is, of the function's own making, and of x.
    """
    x = scattered(contact, start_at)
    if len(x) < 2:
        return x, np.zeros(len(x))
    H = slope(x)
    refuse_non_finite(x, H)
    difference = np.max([np.abs(H - known(x)) for known in resolutions], axis=0)
    rises = np.abs(np.diff(H)) / np.diff(x)
    steep = np.maximum(np.append(rises, 0.0), np.append(0.0, rises))
    allowed = MISSED * float(np.abs(H).max()) + _noise(slope, contact) + STEEPER * np.spacing(np.abs(x).max()) * steep
    return x, np.where(difference > allowed, difference, 0.0)


def largest_misfit(slope: Slope, known: Known, resolved: Slope, contact: Interval) -> float:
    """The largest |H - known(x)| beyond rounding, at points that did not serve `between_points`, or difference between two pieces."""
    pieces = _common_ends(slope, resolved, contact)
    apart = float(pieces.difference[pieces.apart].max(initial=0.0))
    x, missed = misfit(slope, [known], contact, SAMPLES)
    if not missed.any():
        return apart
    worst = int(np.argmax(missed))
    near = np.linspace(x[max(worst - 1, 0)], x[min(worst + 1, len(x) - 1)], CLOSER)
    return max(apart, float(missed[worst]), float(np.abs(slope(near) - known(near)).max()))


def between_points(slope: Slope, resolutions: Sequence[Known], contact: Interval) -> tuple[float, ...]:
    """Breaks around what a resolution of the slope has missed: the worst of neighbouring points, and those beside these."""
    x, missed = misfit(slope, resolutions, contact)
    low = np.concatenate(([False], missed > 0.0, [False]))
    starts, ends = np.flatnonzero(low[1:] & ~low[:-1]), np.flatnonzero(low[:-1] & ~low[1:])
    runs = sorted(zip(starts.tolist(), ends.tolist(), strict=True), key=lambda run: -float(missed[slice(*run)].max()))[:MOST]
    places: list[float] = []
    for start, end in runs:
        worst = start + int(np.argmax(missed[start:end]))
        places += x[[max(start - 1, 0), worst, min(end, len(x) - 1)]].tolist()
    return _new(places, slope, contact)


def between_pieces(slope: Slope, resolved: Slope, contact: Interval) -> tuple[float, ...]:
    """Breaks where two pieces of its resolution, which no break tells apart, differ at their common end."""
    lo, hi, difference, apart = _common_ends(slope, resolved, contact)
    length = hi - lo
    near = np.maximum(FIRST_POINT * length, np.minimum(length, CLOSE * np.spacing(np.maximum(np.abs(lo), np.abs(hi)))))
    places: list[float] = []
    for j in np.flatnonzero(apart)[:MOST].tolist():
        bracket = (float(hi[j] - near[j]), float(hi[j] + near[j + 1]))
        jump = _jump(slope, *bracket, float(difference[j]))
        places += bracket if jump is None else [jump]
    return _new(places, slope, contact)


class _CommonEnds(NamedTuple):
    """Pieces [lo, hi] (K,), how far two neighbours differ at their common end (K - 1,), and where that is more than rounding."""

    lo: Array
    hi: Array
    difference: Array
    apart: NDArray[np.bool_]


def _common_ends(slope: Slope, resolved: Slope, contact: Interval) -> _CommonEnds:
    (lo, hi), c = _expanded(slope, resolved, contact)
    difference = np.abs(c.sum(axis=1)[:-1] - (c @ (-1.0) ** np.arange(c.shape[1]))[1:])
    length, size = hi - lo, np.abs(c).sum(axis=1)
    steep = np.minimum(np.abs(c) @ np.arange(c.shape[1]) ** 2 / (0.5 * length), size / length)
    rounding = STEEPER * np.spacing(np.maximum(np.abs(lo), np.abs(hi))) * steep
    allowed = MISSED * float(size.max()) + _noise(slope, contact) + rounding[1:] + rounding[:-1]
    return _CommonEnds(lo, hi, difference, (difference > allowed) & ~np.isin(hi[:-1], slope.breaks))


def on_pieces(slope: Slope, resolved: Slope, contact: Interval) -> Known:
    """H(x) in the contact by the pieces of its resolution."""
    (lo, hi), c = _expanded(slope, resolved, contact)

    def known(x: Array) -> Array:
        k = np.clip(np.searchsorted(hi, x), 0, len(hi) - 1)
        s = (2.0 * x - lo[k] - hi[k]) / (hi[k] - lo[k])
        values: Array = chebyshev.evaluate(c[0] if len(c) == 1 else c.T[:, k], s)
        return values

    return known


def _expanded(slope: Slope, resolved: Slope, contact: Interval) -> tuple[tuple[Array, Array], Array]:
    """((lo, hi), Chebyshev coefficients) of the pieces in the contact."""
    ends = resolved.breaks
    kept = np.flatnonzero((ends[1:] > contact.x1) & (ends[:-1] < contact.x2))
    lo, hi = ends[:-1][kept], ends[1:][kept]
    s = chebyshev.points(int(resolved.degrees[kept].max()) + 1)
    return (lo, hi), chebyshev.transform(slope.inside(0.5 * (lo + hi)[:, None] + 0.5 * (hi - lo)[:, None] * s))


def _noise(slope: Slope, contact: Interval) -> float:
    return NOISE * rounding_noise(slope.inside, contact.x1, contact.x2)


def _new(places: list[float], slope: Slope, contact: Interval) -> tuple[float, ...]:
    return tuple(p for p in dict.fromkeys(places) if contact.x1 < p < contact.x2 and p not in slope.breaks)


def _jump(slope: Slope, lo: float, hi: float, size: float) -> float | None:
    """The double in [lo, hi] where the slope jumps by about `size`, by bisection towards the larger difference; None if it does not."""

    def H(*x: float) -> Array:
        return slope.inside(np.array([x]))[0]

    at_lo, at_hi = H(lo, hi).tolist()
    for _ in range(BISECTIONS):
        middle = 0.5 * (lo + hi)
        if not lo < middle < hi:
            break
        value = float(H(middle)[0])
        if abs(value - at_lo) > abs(at_hi - value):
            hi, at_hi = middle, value
        else:
            lo, at_lo = middle, value
    x = [math.nextafter(lo, -math.inf), lo, hi, math.nextafter(hi, math.inf)]
    values = H(*x)
    rises = np.abs(values[2:] - values[:-2])
    return x[1 + int(np.argmax(rises))] if rises.max() > JUMP * size else None
