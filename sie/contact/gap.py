"""The gap between the deformed bodies, outside the contact.

    gap'(x) = H(x) - (2/E*) 1/π ∫p(t)/(x - t) dt,        gap = ∫ gap' from the edge

The slope is exact, and relative to itself at a smooth edge, where gap ~ distance^(3/2). Its
integral is Gauss-Legendre in θ, x = m + r cosh θ, in which the square root disappears; panels are
graded by the breaks inside and cut at those outside the contact.

The gap opens all over where h' rises. For other profiles it is measured at many points and where it
is least: its slope changes sign there, however far the contact is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval
from sie.profiles import look
from sie.profiles.look import ROUNDING, beside, closer, falls, narrow_parts
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity

from .convexity import rises, rises_at

Array = NDArray[np.float64]

NODES = 20
DEGREE = 8.0  # of a series that they integrate over a panel
# Half-widths from an edge, as far as a gap is tested: between them a function needs few pieces.
DOUBLED: Array = np.geomspace(1.0, 1024.0, 11)
# The longest panel in θ: NODES then reach rounding (the nearest singularity is at θ = iπ or a
# graded break)
LONGEST = 0.5
NEAR = 4.0  # half-widths, how far out the gap of a function is tested at least
OUT = 1.0 + 1e-9  # of a reach: what is at it is within it
FAR = 1e3  # half-widths, how far out the gap is tested at least
HALVINGS = 60  # of the interval in which the gap is least
STEEP = 1e6  # times the slopes in the contact
SCAN = 40
# Distances from an edge, in half-widths.
AHEAD = np.concatenate((np.geomspace(1e-6, 1.0, SCAN), np.geomspace(1.0, FAR, 2 * SCAN)[1:]))


def gap(
    x: Array,
    density: SlopeDensity,
    slope: Slope,
    places: tuple[Array, Array] | None = None,
) -> Array:
    """The gap at x (1-d): 0 in contact, inf beyond the ends of the indenter.

    `slope` includes the tilt. A function's narrow valleys are looked for at `places`, left and
    right of the contact.
    """
    out = np.where(np.isnan(x), np.nan, 0.0)
    lo, hi = slope.domain
    # The surface sinks like a logarithm of the distance.
    out[(x < lo) | (x > hi) | np.isinf(x)] = np.inf
    x = np.where(np.isinf(x), np.nan, x)
    contact = density.contact
    hints: tuple[Array, ...] = (np.zeros(0), np.zeros(0))
    if slope.functions:
        found = beside(density.interval, slope) if places is None else places
        hints = tuple(narrow_parts(slope, some) for some in found)
    for side, cuts, outside in (
        (1.0, hints[1], (contact.from_right(x) < 0.0) & (x <= hi)),
        (-1.0, hints[0], (contact.from_left(x) < 0.0) & (x >= lo)),
    ):
        if outside.any():
            with np.errstate(over="ignore"):  # a gap may be larger than all doubles
                out[outside] = _on_one_side(x[outside], (side, cuts), density, slope)
    return out


def gap_slope(x: Array, density: SlopeDensity, slope: Slope) -> Array:
    """gap'(x) at x beside the contact, all on one side."""
    opening: Array = slope(x)
    near = np.abs(x) <= density.horizon
    if not near.all():  # beyond, the pressure is a force
        opening[~near] -= density.hilbert(x[~near]) / density.half_modulus
        if near.any():
            opening[near] = gap_slope(x[near], density, slope)
        return opening
    G, continued = density.gap_excess(x)
    difference: Array = opening - continued
    # On the piece that reaches the edge H is its own continuation; what is left there is rounding,
    # and would hide G next to the edge
    own = np.abs(difference) <= 16.0 * EPS * (np.abs(continued) + density.slope_scale)
    difference[own] = 0.0
    return difference + G


def _on_one_side(x: Array, way: tuple[float, Array], density: SlopeDensity, slope: Slope) -> Array:
    """The gap at x on one side, with places at which a function has to be cut."""
    side, contact = way[0], density.contact
    distance = -(contact.from_right(x) if side > 0.0 else contact.from_left(x))
    # A distance over the contact's width may exceed all doubles, a quotient of roots does not.
    root_width = np.sqrt(2.0 * contact.r)
    theta = 2.0 * np.arcsinh(np.sqrt(distance) / root_width)
    cuts = _cuts(float(x[np.argmax(theta)]), float(theta.max()), way, contact, slope)
    # No double is nearer to the edge.
    beyond = np.nextafter(contact.x2 if side > 0.0 else contact.x1, side * np.inf)

    def integral(start: Array, length: Array) -> Array:
        g, w = chebyshev.gauss_legendre(NODES)
        t = start[:, None] + length[:, None] * g
        root = root_width * np.sinh(0.5 * t)
        d = root * root
        right, left = (contact.x2 + d) + contact.tail2, (contact.x1 - d) + contact.tail1
        at = np.maximum(right, beyond) if side > 0.0 else np.minimum(left, beyond)
        opening = side * gap_slope(at.ravel(), density, slope)
        values = opening.reshape(t.shape) * (root * (root_width * np.cosh(0.5 * t)))
        return length * (values @ w)

    k = np.clip(np.searchsorted(cuts, theta, side="right") - 1, 0, len(cuts) - 1)
    lengths = np.concatenate((np.diff(cuts), theta - cuts[k]))
    parts = integral(np.concatenate((cuts[:-1], cuts[k])), lengths)
    until = np.concatenate(([0.0], np.cumsum(parts[: len(cuts) - 1])))
    return until[k] + parts[len(cuts) - 1 :]


def _cuts(
    farthest: float, theta_max: float, way: tuple[float, Array], contact: Interval, slope: Slope
) -> Array:
    """Ends of the panels in θ, never farther apart than LONGEST.

    The panels are graded from the breaks inside and cut at those outside.
    """
    side, hints = way
    inner = slope.breaks[
        (contact.from_left(slope.breaks) > 0.0) & (contact.from_right(slope.breaks) > 0.0)
    ]
    near, far = (
        (contact.from_right(inner), contact.from_left(inner))
        if side > 0.0
        else (contact.from_left(inner), contact.from_right(inner))
    )
    first = float(
        min((2.0 * np.arctan2(np.sqrt(near), np.sqrt(far))).min(initial=LONGEST), LONGEST)
    )
    graded = first * 2.0 ** np.arange(int(np.ceil(np.log2(LONGEST / first))) + 1)
    even = np.arange(LONGEST, theta_max, LONGEST)
    edge = contact.x2 if side > 0.0 else contact.x1
    known = np.union1d(edge + side * contact.r * DOUBLED, hints)
    resolved = refined(slope, min(edge, farthest), max(edge, farthest), EPS, known)
    pieces = resolved.breaks
    if slope.functions:
        parts = np.maximum(np.ceil(resolved.degrees / DEGREE), 1.0).astype(int)
        pieces = np.interp(
            np.concatenate([k + np.arange(n) / n for k, n in enumerate(parts.tolist())]),
            np.arange(len(pieces)),
            pieces,
        )
    outside = -(contact.from_right(pieces) if side > 0.0 else contact.from_left(pieces))
    outside = outside[(outside > 0.0) & np.isfinite(outside)]
    breaks = 2.0 * np.arcsinh(np.sqrt(outside) / np.sqrt(2.0 * contact.r))
    cuts = np.unique(np.concatenate(([0.0], graded, even, breaks)))
    return cuts[(cuts < theta_max) | (cuts == 0.0)]


# -- where it is least -----------------------------------------------------------------------------


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
    close = np.minimum(np.abs(x - contact.x1), np.abs(x - contact.x2)) <= r
    depth = density.resultant / density.half_modulus
    scale = max(float(np.abs(values[close]).max(initial=0.0)), 1e-3 * depth)
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


def _beside(contact: Interval, slope: Slope) -> Array:
    """Points beside the contact, out to FAR half-widths or the ends of the indenter.

    Its breaks are among them.
    """
    lo, hi = slope.domain
    distance = contact.r * AHEAD
    outer = slope.breaks[np.isfinite(slope.breaks)]
    x = np.concatenate((contact.x2 + distance, contact.x1 - distance, outer))
    return x[((contact.from_left(x) < 0.0) | (contact.from_right(x) < 0.0)) & (x >= lo) & (x <= hi)]
