"""Features of a function that its resolution has missed.

The solver uses a function's values at some points only. That it changes between the points of a
resolution is shown by its values at the points of a low-discrepancy sequence,
{start + k (√5 - 1)/2} over the contact.

The digits of the contact's edges determine where the sequence starts, so no profile can be adapted
to it. SAMPLES is a Fibonacci number: the largest gap between so many points is 4.5e-4 of the
contact (Sós 1957, three gaps). A narrower feature may not be detected. Towards each edge there is a
point in every octave of the distance, because a kink close to an edge changes all of H beyond it.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS, Interval

from .look import values
from .resolution import NOISE, refuse_non_finite, rounding_noise
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
    )[:MOST]
    places: list[float] = []
    for start, end in runs:
        worst = start + int(np.argmax(missed[start:end]))
        places += x[[max(start - 1, 0), worst, min(end, len(x) - 1)]].tolist()
    return _new(places, slope, contact)


def _noise(slope: Slope, contact: Interval) -> float:
    return NOISE * rounding_noise(slope.inside, contact.x1, contact.x2)


def _new(places: list[float], slope: Slope, contact: Interval) -> tuple[float, ...]:
    return tuple(
        p for p in dict.fromkeys(places) if contact.x1 < p < contact.x2 and p not in slope.breaks
    )
