"""Places at which a function is looked at, beside a contact and in it.

A valley of h has a part on which h' rises between two on which it falls. The places are so close
that two of them are on every valley that is wider, at half of its depth, than SEEN of its distance
from the middle of the contact: there the slope falls from one place to the next. Between such
places further ones show the valley itself. A certificate looks at other places, closer by FINER.

In a contact, what a resolution has missed is shown by the values at the points of a low-discrepancy
sequence, {start + k (√5 - 1)/2} over the contact. The digits of its edges determine where the
sequence starts, so no profile can be adapted to it. SAMPLES is a Fibonacci number: the largest gap
between so many points is 4.5e-4 of the contact (Sós 1957, three gaps). A narrower feature may not
be detected. Towards each edge there is a point in every octave of the distance, because a kink
close to an edge changes all of H beyond it.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS, Interval

from .resolution import NOISE, refuse_non_finite, rounding_noise

if TYPE_CHECKING:
    from .slope import Slope

Array = NDArray[np.float64]
Bool = NDArray[np.bool_]
Known = Callable[[Array], Array]

SEEN = 0.01  # width of a valley at half of its depth, of its distance from the contact's middle
FINER = 8
CLOSELY = 1e6  # half-widths: how far out places are as close as that
# half-widths, how far out the slope of an indenter without ends is looked at, and a function
FARTHEST, FAR = 1e140, 1e30
DENSE = 20  # places for each factor 10 of the distance, beyond and next to an edge
EVEN = 1000  # places between the ends of an indenter that is made of polynomials
NEAREST = 1e-6  # half-widths from an edge
# places of a window: even ones, and on each side of its middle, from a part of the window on
ACROSS, PLACES, NARROW = 10_000, 6000, 1e-6
BETWEEN = 32  # further places between two where the slope falls, and between their neighbours
CLOSE = 0.1  # of the largest height on the way: so low a place may be one of contact
WIDE = 1.0 / 32.0  # of all places: of a part that long the resolution needs no hint
BESIDE = 2.0  # lengths of a part on which the slope falls: beyond, a narrow valley is over
MOST = 128  # ends of parts on which it falls: waves in greater number show by themselves
COARSE = np.append(0.0, np.geomspace(NEAREST, FARTHEST, int(DENSE * np.log10(FARTHEST / NEAREST))))
ROUNDING = 8.0 * EPS  # of a slope, by which a rising one may fall
SAMPLES = 2584  # of the low-discrepancy sequence
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
# The smallest distance from an edge, of the contact; one point in each octave of the distance.
CLOSEST, HALVINGS = 2.0**-40, 40
# A difference above this multiple of the tolerance shows that the slope was not resolved.
MISSED = 32.0
STEEPER = 8.0  # ulp of x: what these change in H is rounding
CLOSER = 129  # points about the worst
BISECTED = 64  # places that are bisected at once


@lru_cache(maxsize=2)
def _distances(finer: int) -> tuple[Array, int]:
    """Distances from an edge in half-widths, ascending, and how many are next to it."""
    step = 0.5 * SEEN / finer
    close = np.expm1(np.arange(step, np.log(CLOSELY), step))
    near = np.geomspace(NEAREST, close[0], int(DENSE * np.log10(close[0] / NEAREST)) + 1)[:-1]
    far = np.geomspace(CLOSELY, FAR, int(DENSE * np.log10(FAR / CLOSELY)))
    return np.concatenate(([0.0], near, close, far)), len(near) + 1


def beside(
    edges: tuple[float, float], slope: Slope, finer: int = 1, start: float = 0.0
) -> tuple[Array, Array]:
    """Places beside a contact on the whole indenter, ascending: left of it and right of it.

    `start` in [0, 1) moves all places but the first ones, by as much of the way to the next.
    """
    r = 0.5 * (edges[1] - edges[0])
    distances, near = _distances(finer) if slope.functions else (COARSE, len(COARSE))
    distance = r * distances
    if start:
        moved = 1.0 + 0.5 * SEEN / finer * start
        distance[near:] = (distance[near:] + r) * moved - r
    left, right = edges[0] - distance[::-1], edges[1] + distance
    lo, hi = slope.domain
    breaks = slope.breaks[np.isfinite(slope.breaks)]
    if not breaks.size:
        return left, right
    if np.isfinite(hi - lo) or (len(breaks) > 1 and not slope.functions):
        number = ACROSS if slope.functions else EVEN
        breaks = np.concatenate((breaks, np.linspace(breaks[0], breaks[-1], number)))
    left = np.concatenate((breaks[breaks <= edges[0]], left[left > lo]))
    right = np.concatenate((right[right < hi], breaks[breaks >= edges[1]]))
    return np.sort(left, kind="stable"), np.sort(right, kind="stable")


def across(slope: Slope, window: tuple[float, float], start: float = 0.0) -> Array:
    """Places of a bounded window, even ones and others that crowd towards its middle.

    `start` in [0, 1) moves the even ones by as much of the way to the next.
    """
    middle, far = 0.5 * (window[0] + window[1]), 0.5 * (window[1] - window[0])
    near = far * np.geomspace(NARROW, 1.0, PLACES)
    even = np.linspace(*window, ACROSS)
    even += start * (even[1] - even[0])
    x = np.unique(np.concatenate((even, middle - near, middle + near, slope.breaks)))
    return np.asarray(x[(x >= window[0]) & (x <= window[1])])


def values(slope: Slope, x: Array) -> Array:
    """H at ascending places x; infinities and nan where a function overflows."""
    with np.errstate(all="ignore"):
        return slope(x)


def falls(H: Array) -> Bool:
    """Whether a slope falls from one place to the next by more than its rounding."""
    with np.errstate(invalid="ignore"):
        return np.asarray(H[1:] - H[:-1] < -ROUNDING * np.abs(H[:-1]))


def closer(x: Array, falling: Bool) -> Array:
    """The places x, and more about those between which the slope falls, unless these are many."""
    runs = np.count_nonzero(falling[1:] & ~falling[:-1])
    wide = falling.copy()
    wide[1:] |= falling[:-1]
    wide[:-1] |= falling[1:]
    k = np.flatnonzero(wide)
    if not k.size or 2 * runs > MOST:
        return x
    part = np.arange(1, BETWEEN + 1) / (BETWEEN + 1)
    more = x[k, None] + (x[k + 1] - x[k])[:, None] * part
    return np.unique(np.concatenate((x, more.ravel())))


def may_touch(distance: Array, H: Array, r: float, load: float) -> Bool:
    """Whether the bodies may touch at distances from an edge, by the height that slopes add up to.

    A load over E*/2 on places no closer to the edge than r/2 on the mean lowers the surface at a
    distance d by less than load/π (ln(2 (d + r)/r) + 1). A height that is not known counts.
    """
    with np.errstate(all="ignore"):
        steps = np.diff(distance, prepend=0.0)
        h = np.cumsum(0.5 * steps * (H + np.append(H[:1], H[:-1])))
        lowered = load / np.pi * (np.log(2.0 * (distance + r) / r) + 1.0)
        above = h - CLOSE * np.maximum.accumulate(h) > lowered
    return np.asarray(~above & np.isfinite(h))


def narrow_parts(slope: Slope, x: Array) -> Array:
    """Ends of the parts on which a slope falls, and places beyond; none if it rises from x to x.

    Pieces that end there show a valley to a resolution, which else may pass over it.
    """
    falling = falls(values(slope, x))
    if not falling.any():
        return x[:0]
    x = closer(x, falling)
    return run_ends(x, falls(values(slope, x)))


def turns(slope: Slope, x: Array) -> Array:
    """The places among x where a slope begins to fall, or to rise: the ends of narrow features."""
    ends = np.diff(np.concatenate(([False], falls(values(slope, x)), [False])))
    return np.asarray(x[np.flatnonzero(ends)])


def run_ends(x: Array, falling: Bool) -> Array:
    """Ends of the runs of places between which a slope falls, and places BESIDE them."""
    ends = np.flatnonzero(np.diff(np.concatenate(([False], falling, [False]))))
    room = WIDE * (x[-1] - x[0])
    narrow = np.repeat(x[ends[1::2]] - x[ends[::2]] < room, 2)
    if np.count_nonzero(narrow) > MOST:
        return x[:0]
    lo, hi = x[ends[narrow]].reshape(-1, 2).T
    away = BESIDE * (hi - lo)
    found = np.unique(np.concatenate((lo - away, lo, hi, hi + away)))
    return np.asarray(found[(found > x[0]) & (found < x[-1])])


# -- in a contact ----------------------------------------------------------------------------------


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
    allowed += NOISE * rounding_noise(slope.inside, contact.x1, contact.x2)
    rises = np.abs(np.diff(H)) / np.diff(x)
    steep = np.maximum(np.append(rises, 0.0), np.append(0.0, rises))
    steeper = allowed + STEEPER * np.spacing(np.abs(x).max()) * steep
    return x, np.where(difference > steeper, difference, 0.0)


def largest_misfit(slope: Slope, known: Known, contact: Interval) -> float:
    """The largest |H - known(x)| beyond rounding, at points that `between_points` does not use."""
    x, missed = misfit(slope, [known], contact, start_at=SAMPLES)
    if not missed.any():
        return 0.0
    worst = int(np.argmax(missed))
    near = np.linspace(x[max(worst - 1, 0)], x[min(worst + 1, len(x) - 1)], CLOSER)
    return max(float(missed[worst]), float(np.abs(slope(near) - known(near)).max()))


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
    )[:BISECTED]
    places: list[float] = []
    for start, end in runs:
        worst = start + int(np.argmax(missed[start:end]))
        places += x[[max(start - 1, 0), worst, min(end, len(x) - 1)]].tolist()
    inside = (p for p in dict.fromkeys(places) if contact.x1 < p < contact.x2)
    return tuple(p for p in inside if p not in slope.breaks)
