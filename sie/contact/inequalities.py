"""The inequalities of contact: p >= 0 where the bodies touch, gap >= 0 beside.

One patch of contact [x1, x2] is the answer only where both hold. They follow from h' that rises all
over. For other profiles they are verified at many points inside the contact, and beside it at many
points and where the gap is least: its slope changes sign there, however far the contact is. A
violation is an `InequalityError` that says where.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.errors import InequalityError, ResolutionError
from sie.numerics.interval import EPS, Interval, angles, inner, position
from sie.profiles import look
from sie.profiles.look import ROUNDING, beside, closer, falls
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity

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
# points in contact at which the sign of the pressure is tested, at least 3 on every piece
SCANNED = 600
ZOOMS, ZOOMED = 5, 10  # around its minima: how often, and places each time


def slope_rises(density: SlopeDensity, slope: Slope) -> bool:
    """Whether h' rises at all points of `verify_inequalities`, and no edge is in tension.

    Then p > 0 and gap > 0 follow.
    """
    contact = density.contact
    even = np.pi * (np.arange(SCANNED) + 0.5) / SCANNED
    inside = position(contact, even) if slope.functions else _scan(contact, slope)
    x = np.sort(np.concatenate((inside, inner(contact, slope.breaks), _beside(contact, slope))))
    H = slope(x)
    rounding = ROUNDING * density.slope_scale
    return (
        bool((H[1:] >= H[:-1] - rounding).all())
        and min(density.k1, density.k2) >= 0.0 < density.resultant
        and slope_rises_far(contact, slope)
    )


def slope_rises_far(contact: Interval, slope: Slope) -> bool:
    """Whether h' rises from place to place on the whole indenter beside the contact."""
    return rises_at(beside((contact.x1, contact.x2), slope), slope)


def rises_at(places: tuple[Array, Array], slope: Slope) -> bool:
    """Whether h' rises from place to place."""
    return not falls(look.values(slope, np.concatenate(places))).any()


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
        rises = np.flatnonzero(H[end:] > density.slope_scale)
        end = min(end + (int(rises[0]) + 1 if rises.size else 0), len(H))
        outwards = outwards[:end]
        reach.append(float(np.abs(outwards[-1:] - contact.m).max(initial=0.0)))
        if last.size and end > 1:
            found.append(_minima(outwards, side, density, slope))
    return np.concatenate((*found, np.zeros(0))), reach[0], reach[1]


def _minima(x: Array, side: float, density: SlopeDensity, slope: Slope) -> Array:
    """The places among x, outwards on one side, between which the gap's slope turns positive."""
    opening = side * gap_slope(x, density, slope)
    k = np.flatnonzero((opening[:-1] < 0.0) & (opening[1:] >= 0.0))
    falls, rises = x[k], x[k + 1]
    for _ in range(HALVINGS if k.size else 0):
        middle = 0.5 * (falls + rises)
        opens = side * gap_slope(middle, density, slope) >= 0.0
        falls, rises = np.where(opens, falls, middle), np.where(opens, middle, rises)
    return rises


def verify_inequalities(density: SlopeDensity, slope: Slope) -> None:
    """Verify p >= 0 inside and gap >= 0 outside; InequalityError names the places otherwise."""
    x = np.concatenate((_scan(density.contact, slope), inner(density.contact, slope.breaks)))
    p = density(x)
    peak = float(p[np.isfinite(p)].max())
    x, p = _with_minima(x, p, density)
    patch = (
        f"a single patch of contact [{density.interval[0]:.6g}, {density.interval[1]:.6g}] would"
    )
    worst = int(np.argmin(p))
    if p[worst] < -TOLERATED * peak or peak <= 0.0 or min(density.k1, density.k2) < 0.0:
        where = (
            float(x[worst])
            if min(density.k1, density.k2) >= 0.0
            else density.interval[int(density.k2 < density.k1)]
        )
        intervals = intervals_below(x, p / abs(peak))
        raise InequalityError(
            f"{patch} need tension at x = {where:.6g} (p = {float(p[worst]):.3g}, peak "
            f"{peak:.3g}){_among(intervals)}: the profile is not convex there and lifts off; give "
            "normal_load, under which several patches are found, raise the load or smooth the "
            "profile",
            x=where,
            edges=density.interval,
            tension=intervals,
        )
    x, gaps = relative_gaps(density, slope)
    if gaps.size and gaps.min() < -TOLERATED:
        where, intervals = float(x[np.argmin(gaps)]), intervals_below(x, gaps)
        raise InequalityError(
            f"{patch} overlap the body at x = {where:.6g}{_among(intervals)}: the profile touches "
            "there too; give normal_load, under which several patches are found, lower the load, "
            "raise it until they merge, or smooth the profile",
            x=where,
            edges=density.interval,
            overlap=intervals,
        )


def _with_minima(x: Array, p: Array, density: SlopeDensity) -> tuple[Array, Array]:
    """Places and pressures, and those around minima that may be negative between the places."""
    order = np.argsort(x)
    x, p = x[order], p[order]
    k = 1 + np.flatnonzero((p[1:-1] <= p[:-2]) & (p[1:-1] <= p[2:]) & (x[2:] > x[:-2]))
    # a parabola through three values has its vertex above this
    k = k[3.0 * p[k] < p[k - 1] + p[k + 1]]
    lo, hi = x[k - 1], x[k + 1]
    for _ in range(ZOOMS if k.size else 0):
        between = lo[:, None] + (hi - lo)[:, None] * np.linspace(0.0, 1.0, ZOOMED)
        values = density(between.ravel()).reshape(between.shape)
        lowest = np.argmin(values, axis=1).clip(1, ZOOMED - 2)[:, None]
        lo, hi = (np.take_along_axis(between, lowest + s, axis=1)[:, 0] for s in (-1, 1))
        x, p = np.append(x, between), np.append(p, values)
    order = np.argsort(x, kind="stable")
    return x[order], p[order]


def relative_gaps(
    density: SlopeDensity, slope: Slope, finer: int = 1, start: float = 0.0
) -> tuple[Array, Array]:
    """Points beside the contact, out to FAR half-widths, and the relative gap there.

    It is relative to its largest value within one half-width. Where it may be least is looked for
    from place to place (`profiles.look.beside`), as close and beginning as given.
    """
    contact, r = density.contact, density.contact.r
    x = _beside(contact, slope)
    places = beside((contact.x1, contact.x2), slope, finer, start)
    seen = bool(slope.functions) and density.resolves
    if (seen or _opens_everywhere(x, density, slope)) and rises_at(places, slope):
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
    if seen:  # beyond, heights show that the gap is open
        left, right = (min(end, max(far, NEAR * r)) for end, far in zip((left, right), reach))
    left, right = max(left, reach[0] * OUT), max(right, reach[1] * OUT)
    x = x[np.abs(x - contact.m) < np.where(outward > 0.0, right, left)]
    if not x.size:
        return x, x
    try:
        values = gap(x, density, slope, places=places)
    except ResolutionError:  # of waves without end
        if not slope_rises(density, slope):
            raise
        return x, np.zeros(len(x))
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


def _among(intervals: Intervals) -> str:
    """The intervals, in a sentence that has named their worst point."""
    return f", for {shown(intervals)}" if any(lo < hi for lo, hi in intervals) else ""


def _scan(contact: Interval, slope: Slope) -> Array:
    """Points inside every piece in the contact, evenly in the angle.

    There are many in each where there are few pieces.
    """
    resolution = refined(slope, contact.x1, contact.x2, EPS) if slope.functions else slope
    ends = np.concatenate(([0.0], angles(contact, inner(contact, resolution.breaks)), [np.pi]))
    n = max(SCANNED // (len(ends) - 1), 3)
    fractions = (np.arange(n) + 0.5) / n
    return position(contact, (ends[:-1, None] + np.diff(ends)[:, None] * fractions).ravel())


def _beside(contact: Interval, slope: Slope) -> Array:
    """Points beside the contact, out to FAR half-widths or the ends of the indenter.

    Its breaks are among them.
    """
    lo, hi = slope.domain
    distance = contact.r * AHEAD
    outer = slope.breaks[np.isfinite(slope.breaks)]
    x = np.concatenate((contact.x2 + distance, contact.x1 - distance, outer))
    return x[((contact.from_left(x) < 0.0) | (contact.from_right(x) < 0.0)) & (x >= lo) & (x <= hi)]


def _opens_everywhere(x: Array, density: SlopeDensity, slope: Slope) -> bool:
    """Whether the gap grows outwards at x, so that it need not be integrated.

    At the breaks among x both sides count.

    Between its breaks a polynomial slope or a power has no feature that x misses.
    """
    if not (slope.functions or slope.continuous):
        x = np.concatenate((x, np.nextafter(x, -np.inf), np.nextafter(x, np.inf)))
    if _slope_rises_outwards(x, density, slope):
        return True
    left, right = density.contact.from_left(x) < 0.0, density.contact.from_right(x) < 0.0
    for sign, side in ((-1.0, left), (1.0, right)):
        if side.any() and not (sign * gap_slope(x[side], density, slope) >= 0.0).all():
            return False
    return True


def _slope_rises_outwards(x: Array, density: SlopeDensity, slope: Slope) -> bool:
    """Whether H rises from smooth edges on, over x beside the contact: then the gap opens.

    For p >= 0 in contact 1/π∫p/(x - t) dt falls outwards, from its value E*/2 H at the edge.
    """
    x1, x2 = density.interval
    if (density.k1 and x.min(initial=x1) < x1) or (density.k2 and x.max(initial=x2) > x2):
        return False
    H = slope(np.sort(np.concatenate((x, (x1, x2)))))
    return bool((H[1:] >= H[:-1]).all())
