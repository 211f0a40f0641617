"""Where the gap beside one patch of contact is least, and the intervals where a value is negative.

The gap opens all over where h' rises. For other profiles it is measured at many points and where it
is least: its slope changes sign there, however far the contact is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval
from sie.profiles import look
from sie.profiles.look import ROUNDING, beside, closer, falls
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity

from .convexity import rises, rises_at
from .gap import gap, gap_slope

Array = NDArray[np.float64]
Intervals = tuple[tuple[float, float], ...]

NEAR = 4.0  # half-widths, how far out the gap of a function is tested at least
OUT = 1.0 + 1e-9  # of a reach: what is at it is within it
# Tension or overlap below this fraction of the peak is rounding.
TOLERATED = 1e-11
FAR = 1e3  # half-widths, how far out the gap is tested at least
HALVINGS = 60  # of the interval in which the gap is least
STEEP = 1e6  # times the slopes in the contact
SCAN = 40
# Distances from an edge, in half-widths.
AHEAD = np.concatenate((np.geomspace(1e-6, 1.0, SCAN), np.geomspace(1.0, FAR, 2 * SCAN)[1:]))
NAMED = 3  # intervals that a message names


def _least_gaps(
    density: SlopeDensity, slope: Slope, places: tuple[Array, Array]
) -> tuple[Array, float, float]:
    """Where the gap may be least beside the contact, and how far out left and right that is.

    Beyond the last place where h' falls the gap has at most one minimum more, as the pull of the
    contact falls with the distance.
    """
    contact = density.contact
    found: list[Array] = []
    reach = []
    for place, side in zip(places, (-1.0, 1.0), strict=True):
        x = closer(place, falls(look.values(slope, place))) if slope.functions else place
        outwards = x[1:] if side > 0.0 else x[-2::-1]
        outwards = outwards[side * (outwards - (contact.x2 if side > 0.0 else contact.x1)) > 0.0]
        with np.errstate(all="ignore"):
            H = side * slope(outwards)
            last = np.flatnonzero(falls(H))
        if slope.functions:
            distance = np.abs(outwards - (contact.x2 if side > 0.0 else contact.x1))
            load = density.resultant / density.half_modulus
            low = np.flatnonzero(look.may_touch(distance, H, contact.r, load))
            last = last[last <= low.max(initial=0)]
        end = int(last[-1]) + 2 if last.size else 0
        steep = np.flatnonzero(H[end:] > density.slope_scale)
        end = min(end + (int(steep[0]) + 1 if steep.size else 0), len(H))
        outwards = outwards[:end]
        reach.append(float(np.abs(outwards[-1:] - contact.m).max(initial=0.0)))
        if last.size and end > 1:
            found.append(_minima(outwards, side, density, slope))
    return np.concatenate((*found, np.zeros(0))), reach[0], reach[1]


def _minima(x: Array, side: float, density: SlopeDensity, slope: Slope) -> Array:
    """The places among x, outwards on one side, between which the gap's slope turns positive."""
    opening = side * gap_slope(x, density, slope)
    k = np.flatnonzero((opening[:-1] < 0.0) & (opening[1:] >= 0.0))
    closes, opens = x[k], x[k + 1]
    for _ in range(HALVINGS if k.size else 0):
        middle = 0.5 * (closes + opens)
        beyond = side * gap_slope(middle, density, slope) >= 0.0
        closes, opens = np.where(beyond, closes, middle), np.where(beyond, middle, opens)
    return opens


def relative_gaps(
    density: SlopeDensity, slope: Slope, finer: int = 1, start: float = 0.0
) -> tuple[Array, Array]:
    """Points beside the contact, out to FAR half-widths, and the relative gap there.

    It is relative to its largest value within one half-width. Where it may be least is looked for
    from place to place (`profiles.look.beside`), as close and beginning as given.
    """
    contact, r = density.contact, density.contact.r
    x, edges = _beside(contact, slope), (contact.x1, contact.x2)
    places = beside(edges, slope, finer, start)
    if all(rises_at(side, slope) for side in places) if slope.functions else rises(slope, edges):
        return x, np.zeros(len(x))
    least, *reach = _least_gaps(density, slope, places)
    x = np.concatenate((x, least))
    # A function may overflow out there; from where it opens that steeply on, the gap is not tested
    outward = np.sign(x - contact.m)
    opens = ~(
        outward * slope(x)
        < STEEP * max(density.slope_scale, density.resultant / (density.half_modulus * r))
    )
    left, right = (
        np.abs(x[opens & (outward == side)] - contact.m).min(initial=np.inf) for side in (-1.0, 1.0)
    )
    if slope.functions:  # beyond, heights show that the gap is open
        left, right = (min(end, max(far, NEAR * r)) for end, far in zip((left, right), reach))
    left, right = max(left, reach[0] * OUT), max(right, reach[1] * OUT)
    x = x[np.abs(x - contact.m) < np.where(outward > 0.0, right, left)]
    if not x.size:
        return x, x
    values = gap(x, density, slope, places=places)
    scale = max(
        float(
            np.abs(values[np.minimum(np.abs(x - contact.x1), np.abs(x - contact.x2)) <= r]).max(
                initial=0.0
            )
        ),
        density.resultant / density.half_modulus * 1e-3,
    )
    rounding = _rounding(x, values, contact.m)
    return x, np.where(np.abs(values) > rounding, values, np.maximum(values, 0.0)) / scale


def _rounding(x: Array, gaps: Array, m: float) -> Array:
    """The rounding of the gap at x: a difference of heights is no more exact than they are.

    Those on the way from the contact count, and none beyond x.
    """
    found = np.zeros(len(x))
    for side in (x < m, x >= m):
        outwards = np.flatnonzero(side)[np.argsort(np.abs(x[side] - m), kind="stable")]
        heights = np.where(np.isfinite(gaps[outwards]), np.abs(gaps[outwards]), 0.0)
        found[outwards] = ROUNDING * np.maximum.accumulate(heights)
    return found


def intervals_below(x: Array, values: Array) -> Intervals:
    """The intervals where values are below -TOLERATED.

    They begin and end where values change sign between two of the points.
    """
    order = np.argsort(x, kind="stable")
    x, values = x[order], values[order]
    low = np.concatenate(([False], values < -TOLERATED, [False]))
    starts, ends = np.flatnonzero(low[1:] & ~low[:-1]), np.flatnonzero(low[:-1] & ~low[1:]) - 1

    def crossing(inner: int, outer: int) -> float:
        if (
            not 0 <= outer < len(x)
            or not np.isfinite(values[[inner, outer]]).all()
            or values[outer] <= 0.0
        ):
            return float(x[inner])
        return float(
            x[inner] + (x[outer] - x[inner]) * values[inner] / (values[inner] - values[outer])
        )

    return tuple(
        (crossing(i, i - 1), crossing(j, j + 1))
        for i, j in zip(starts.tolist(), ends.tolist(), strict=True)
    )


def shown(intervals: Intervals) -> str:
    shown = ", ".join(f"[{lo:.6g}, {hi:.6g}]" for lo, hi in intervals[:NAMED])
    return f"x in {shown}{f' and {len(intervals) - NAMED} more' if len(intervals) > NAMED else ''}"


def _beside(contact: Interval, slope: Slope) -> Array:
    """Points beside the contact, out to FAR half-widths or the ends of the indenter.

    Its breaks are among them.
    """
    lo, hi = slope.domain
    distance = contact.r * AHEAD
    outer = slope.breaks[np.isfinite(slope.breaks)]
    x = np.concatenate((contact.x2 + distance, contact.x1 - distance, outer))
    return x[((contact.from_left(x) < 0.0) | (contact.from_right(x) < 0.0)) & (x >= lo) & (x <= hi)]
