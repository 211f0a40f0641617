"""The gap between the deformed bodies, outside the contact.

    gap'(x) = H(x) - (2/E*) 1/π ∫p(t)/(x - t) dt,        gap = ∫ gap' from the edge

The slope is exact, and relative to itself at a smooth edge, where gap ~ distance^(3/2). Its
integral is Gauss-Legendre in θ, x = m + r cosh θ, in which the square root disappears; panels are
graded by the breaks inside and cut at those outside the contact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval
from sie.profiles.look import beside, narrow_parts
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity

Array = NDArray[np.float64]

NODES = 20
DEGREE = 8.0  # of a series that they integrate over a panel
# ... and so few of them on a panel this short, relative to its θ (all singularities have
# Re θ = 0) and to 1
SHORT, SHORT_NODES = 0.125, 6
# Half-widths from an edge, as far as a gap is tested: between them a function needs few pieces.
DOUBLED: Array = np.geomspace(1.0, 1024.0, 11)
# The longest panel in θ: NODES then reach rounding (the nearest singularity is at θ = iπ or a
# graded break)
LONGEST = 0.5


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
        short = (length <= np.minimum(SHORT * start, SHORT)) & (not slope.functions)
        out = np.zeros(start.shape)
        for chosen, nodes in ((short, SHORT_NODES), (~short, NODES)):
            if chosen.any():
                out[chosen] = by_quadrature(start[chosen], length[chosen], nodes)
        return out

    def by_quadrature(start: Array, length: Array, nodes: int) -> Array:
        g, w = chebyshev.gauss_legendre(nodes)
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
