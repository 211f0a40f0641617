"""The normal problem at β = 0: from the slope of a profile and a load to the edges and the pressure.

Where the slope is a polynomial on each piece this is one search for the edges (`edges`) and one expansion. A slope given by a function is
resolved first, on a window that is fitted to the contact: relative accuracy is needed where the contact is, not where the domain is.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np

from . import chebyshev
from .adaptive import refined
from .density import PanelDensity, SlopeDensity, TransformDensity
from .edges import Edges, Search
from .errors import ContactError, LoadError
from .geometry import Geometry
from .interval import EPS, Interval
from .panels import CHOP, Panels
from .profile import Profile
from .scene import Scene
from .slope import Slope

# What a scene may let the solver skip; `sie.solve(..., economy=())` switches all of it off.
ECONOMY = frozenset({"symmetry", "transform", "zero panels", "convexity"})

# A window of a function's slope is refitted while it is longer than the contact by more than this factor ...
WINDOW = 1.6
FITTED = 1.25  # ... to the contact times this.
WINDOW_GROWTH = 8.0
MAX_WINDOWS = 120
# One Chebyshev series for the whole contact is tried up to this many points before the slope is cut into pieces.
LARGEST_TRANSFORM = 257
MAX_TILTS = 100


@dataclass(frozen=True)
class Normal:
    """The found contact: its edges, the slope that was searched (without tilt), how the search was done."""

    edges: Edges
    slope: Slope
    symmetric: bool


def normal_contact(scene: Scene, tol: float, economy: Collection[str] = ECONOMY) -> Normal:
    """The edges, load, moment and tilt of a scene. Raises ContactError if one patch of contact cannot answer it."""
    profile = scene.profile
    if not profile.pieces.functions:
        return _searched(scene, profile.pieces, economy)
    lo, hi = _first_window(profile)
    ends = profile.domain
    found: Normal | None = None
    for _ in range(MAX_WINDOWS):
        open_ends = (lo > ends[0], hi < ends[1])
        try:
            found = _searched(scene, refined(profile.pieces, lo, hi, _resolution(tol)), economy)
        except LoadError:
            if not any(open_ends):
                raise
            lo, hi = _grown(lo, hi, ends)
            continue
        x1, x2 = found.edges.contact.x1, found.edges.contact.x2
        touches = (open_ends[0] and found.edges.sharp[0]) or (open_ends[1] and found.edges.sharp[1])
        if touches:
            lo, hi = _grown(lo, hi, ends)
        elif hi - lo > WINDOW * (x2 - x1):
            margin = 0.5 * (FITTED - 1.0) * (x2 - x1)
            fitted = max(x1 - margin, ends[0]), min(x2 + margin, ends[1])
            if fitted == (lo, hi):
                return found
            lo, hi = fitted
        else:
            return found
    raise LoadError(
        f"no window of the slope holds the contact after {MAX_WINDOWS} trials, the last was [{lo:.6g}, {hi:.6g}]: give a domain"
    )


def pressure(normal: Normal, scene: Scene, tol: float, economy: Collection[str] = ECONOMY) -> SlopeDensity:
    """The pressure that answers the slope on the contact: a transform where the slope is smooth there, exact panels where it is not."""
    edges = normal.edges
    contact, G = edges.contact, 0.5 * scene.Estar
    common = (contact, G, edges.k1, edges.k2, edges.normal_load, edges.moment)
    declared = scene.profile.pieces.tilted(edges.tilt)
    if "transform" in economy:
        series = _series(declared, contact, _resolution(tol))
        if series is not None:
            if not any(edges.sharp):
                series[0] = 0.0  # the edges' condition, which quadrature met to rounding
            return TransformDensity(*common, series)
    slope = refined(declared, contact.x1, contact.x2, _resolution(tol))
    return PanelDensity(*common, Panels(Geometry(slope, contact, keep_zero="zero panels" not in economy), edges.I0))


def _resolution(tol: float) -> float:
    return max(EPS, 1e-2 * tol) if tol > 1e-13 else EPS


def _searched(scene: Scene, slope: Slope, economy: Collection[str]) -> Normal:
    """The edges for a slope that is resolved; the tilt is searched for if the moment is what is given."""
    axis = scene.profile.axis if "symmetry" in economy else None
    G, keep_zero = 0.5 * scene.Estar, "zero panels" not in economy

    def edges_at(tilt: float) -> Edges:
        symmetric = axis if tilt == 0.0 else None
        search = Search(slope.tilted(tilt), G, symmetric, keep_zero)
        if scene.half_width is not None:
            contact, sharp = search.of_half_width(scene.half_width)
            if all(sharp):
                raise LoadError(
                    f"a sharp-edged contact of half-width {scene.half_width:.6g} carries any load: give normal_load instead of half_width"
                )
            return search.finished(contact, None, tilt, sharp)
        assert scene.normal_load is not None
        contact, sharp = search.symmetric(scene.normal_load) if symmetric is not None else search.general(scene.normal_load)
        return search.finished(contact, scene.normal_load, tilt, sharp)

    if scene.moment is None:
        return Normal(edges_at(scene.tilt), slope, axis is not None and scene.tilt == 0.0)
    edges = _tilt_of_moment(edges_at, scene.moment, G, slope if scene.half_width is not None else None)
    return Normal(edges, slope, axis is not None and edges.tilt == 0.0)


def _tilt_of_moment(edges_at: Callable[[float], Edges], moment: float, G: float, at_fixed_width: Slope | None) -> Edges:
    """The tilt whose pressure has the moment, by Newton in a bracket: M falls as the tilt grows, dM/d(tilt) = -π/2 G r² at constant P."""
    low, high, tilt = -np.inf, np.inf, 0.0
    best: Edges | None = None
    step = 0.0
    for _ in range(MAX_TILTS):
        try:
            edges = edges_at(tilt)
        except ContactError:
            if best is None:
                raise
            # beyond what the profile can be tilted by: come back half the way
            low, high = (low, tilt) if tilt > best.tilt else (tilt, high)
            tilt = 0.5 * (tilt + best.tilt)
            if abs(tilt - best.tilt) <= 4.0 * EPS * abs(best.tilt):
                break
            continue
        excess = edges.moment - moment
        r = edges.contact.r
        if best is None or abs(excess) <= abs(best.moment - moment):
            best = edges
        low, high = (max(low, tilt), high) if excess > 0.0 else (low, min(high, tilt))
        if abs(excess) <= 2.0 * EPS * (edges.normal_load * (r + abs(edges.contact.m))):
            break
        falls = 0.5 * np.pi * G * r * r
        if at_fixed_width is not None:
            k = Search(at_fixed_width.tilted(tilt), G).moments(edges.contact)
            falls += edges.contact.m * np.pi * G * r * k.J1 / k.J0
        step = excess / falls if falls > 0.0 else np.inf
        new = tilt + step
        if not low < new < high:
            new = 0.5 * (low + high) if np.isfinite(low + high) else tilt
        if new == tilt or (np.isfinite(low + high) and high - low <= 4.0 * EPS * max(abs(low), abs(high))):
            break
        tilt = new
    assert best is not None
    reach = best.normal_load * (best.contact.r + abs(best.contact.m))
    if abs(best.moment - moment) > 1e-9 * reach:
        raise LoadError(
            f"the moment {moment:.6g} cannot be carried in one patch of contact: the nearest is {best.moment:.6g} "
            f"at a tilt of {best.tilt:.6g}; lower the moment or raise the load",
            moment=best.moment,
            tilt=best.tilt,
        )
    return best


def _series(slope: Slope, contact: Interval, tol: float) -> np.ndarray | None:
    """Chebyshev coefficients of H over the whole contact, None if a break lies inside or they do not decay."""
    breaks = slope.break_points
    inner = bisect_right(breaks, contact.x1), bisect_left(breaks, contact.x2)
    if inner[0] < inner[1]:
        return None
    k = Geometry(slope, contact, keep_zero=True)
    if len(k.k) != 1:
        return None
    if not slope.functions:
        return k.chebyshev_slope(max(int(slope.degrees[k.k[0]]) + 1, 2))[0]
    n = 17
    while n <= LARGEST_TRANSFORM:
        c = k.chebyshev_slope(n)[0]
        scale = float(np.abs(c).max())
        if np.abs(c[-3:]).max() <= tol * scale:
            return c[: max(chebyshev.chopped_length(c, CHOP * scale), 2)]
        n = 2 * n - 1
    return None


def _first_window(profile: Profile) -> tuple[float, float]:
    """The domain where it is finite; otherwise a window about the breaks, or about the nearest point to x = 0."""
    lo, hi = profile.domain
    if np.isfinite(lo) and np.isfinite(hi):
        return lo, hi
    size = 8.0 * max((abs(b) for b in (*profile.breaks, lo, hi) if np.isfinite(b)), default=0.0) or 1.0
    return max(lo, -size), min(hi, size)


def _grown(lo: float, hi: float, ends: tuple[float, float]) -> tuple[float, float]:
    middle, half = 0.5 * (lo + hi), 0.5 * WINDOW_GROWTH * (hi - lo)
    return max(middle - half, ends[0]), min(middle + half, ends[1])
