"""The normal problem at β = 0: from the slope of a profile and a load to the edges and the pressure.

Where the slope is a polynomial on each piece this is one search for the edges (`edges`) and one expansion. A slope given by a function is
resolved first, on a window that is fitted to the contact: relative accuracy is needed where the contact is, not where the domain is.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace

import numpy as np

from . import chebyshev
from .adaptive import NOISE, ROUGHEST, refined, rounding_noise
from .edges import Edges, Search
from .errors import ContactError, LoadError
from .geometry import Geometry
from .interval import EPS, Interval
from .panels import CHOP, Panels
from .profile import Profile
from .scene import Scene
from .sliding import SlidingDensity, SlidingGeometry, SlidingPanels
from .slope import Slope
from .slope_density import PanelDensity, SlopeDensity, TransformDensity
from .unseen import Pieces, between_pieces, between_points, expanded
from .widest import widest_contact

# What a scene may let the solver skip; `sie.solve(..., economy=())` switches all of it off.
ECONOMY = frozenset({"symmetry", "transform", "zero panels", "convexity", "shear", "sliding"})

# A window of a function's slope is refitted while it is longer than the contact by more than this factor ...
WINDOW = 1.6
FITTED = 1.25  # ... to the contact times this.
WINDOW_GROWTH = 8.0
MOST_GROWN, MOST_SHRUNK = 12, 120
GROWS = 1.5  # a window so much wider must carry so much more, or no wider one will be tried
# One Chebyshev series for the whole contact is tried up to this many points before the slope is cut into pieces.
LARGEST_TRANSFORM = 257
WINDOW_SIZES = np.geomspace(1e-140, 1e140, 561)
MAX_TILTS = 100
HUGE = 1e300  # stands for an open end of the bracket
# Looks at a function between the points that resolved it, each with the breaks that the last added.
LOOKS = 4
MISSED = 1e-9  # of the load times its farthest lever: a moment missed by more was not carried


@dataclass(frozen=True)
class Normal:
    """The found contact, and whether its symmetry halved the search."""

    edges: Edges
    symmetric: bool
    seen: tuple[float, ...] = ()  # breaks that a function's slope needs beside the declared ones

    def slope(self, profile: Profile) -> Slope:
        """H of the profile as it is pressed: with these breaks, and tilted."""
        return _broken(profile.pieces, self.seen).tilted(self.edges.tilt)


def normal_contact(scene: Scene, tol: float, economy: Collection[str] = ECONOMY, seen: tuple[float, ...] | None = None) -> Normal:
    """The edges, load, moment and tilt of a scene. Raises ContactError if one patch of contact cannot answer it.

    `seen` are the breaks found in a larger contact of the same profile, which need not be looked for again.
    """
    found = _contact(scene, tol, economy, seen)
    ends = zip(found.edges.sharp, scene.profile.ends_are_corners, scene.profile.domain, strict=True)
    for end in [end for is_sharp, is_corner, end in ends if is_sharp and not is_corner]:
        raise LoadError(
            f"the contact reaches the end of the trace at x = {end:.6g}, and what the indenter is like beyond is not known: "
            "lower the load or the tilt, or measure further out (a trace of the surface's height instead of the gap has the wrong sign)",
            end=end,
        )
    return found


def _broken(slope: Slope, places: tuple[float, ...]) -> Slope:
    for x in places:
        slope = slope.split_at(x)
    return slope


def _contact(scene: Scene, tol: float, economy: Collection[str], seen: tuple[float, ...] | None) -> Normal:
    profile = scene.profile
    if not profile.pieces.functions:
        return _searched(scene, profile.pieces, economy)
    looks = 0 if profile.convex or seen is not None else LOOKS
    seen = seen or ()
    lo, hi = _first_window(scene)
    ends = profile.domain
    carried = 0.0  # the largest load that the last window carried
    grown, shrunk, settled = 0, 0, False
    while True:
        open_ends = (lo > ends[0], hi < ends[1])
        try:
            resolved = refined(_broken(profile.pieces, seen), lo, hi, _resolution(tol))
            found = _searched(scene, resolved, economy)
        except LoadError as error:
            before, carried = carried, float(error.reached.get("load", 0.0))
            if not any(open_ends) or grown >= MOST_GROWN or (before and carried <= GROWS * before):
                raise  # a wider window changes nothing
            grown += 1
            lo, hi = _grown(lo, hi, ends)
            continue
        contact, sharp = found.edges.contact, found.edges.sharp
        if any(is_sharp and is_open for is_sharp, is_open in zip(sharp, open_ends, strict=True)):
            if grown >= MOST_GROWN:
                given = f"load {scene.normal_load:.6g}" if scene.normal_load else f"half-width {scene.half_width:.6g}"
                raise LoadError(f"the {given} makes contact reach beyond [{lo:.6g}, {hi:.6g}]: the slope rises too little, give a domain")
            grown, settled = grown + 1, shrunk > 0
            lo, hi = _grown(lo, hi, ends)
            continue
        margin = 0.5 * (FITTED - 1.0) * (contact.x2 - contact.x1)
        fitted = max(contact.x1 - margin, ends[0]), min(contact.x2 + margin, ends[1])
        # A window that had to grow again after it was fitted belongs to a profile that is not convex: it stays
        if hi - lo <= WINDOW * (contact.x2 - contact.x1) or fitted == (lo, hi) or settled or shrunk >= MOST_SHRUNK:
            found = replace(found, seen=seen)
            more = _unseen(found, resolved, scene, tol, economy) if looks else ()
            if not more:
                return found
            looks -= 1
            seen += more if profile.axis is None else (*more, *(2.0 * profile.axis - x for x in more))
            continue
        shrunk += 1
        lo, hi = fitted


def _unseen(found: Normal, resolved: Slope, scene: Scene, tol: float, economy: Collection[str]) -> tuple[float, ...]:
    """Where the slope needs a break that it does not have.

    By the pieces that gave the edges, and by what will give the pressure.
    """
    slope, contact = found.slope(scene.profile), found.edges.contact
    pieces = expanded(slope, resolved, contact)
    places = between_pieces(slope, pieces, contact)
    transform = not scene.epsilon and "transform" in economy
    series = _series(slope, contact, _resolution(tol)) if transform else None
    if series is None:
        resolved = refined(slope, contact.x1, contact.x2, _resolution(tol))
        final = expanded(slope, resolved, contact)
        places += between_pieces(slope, final, contact)
    else:
        final = Pieces(np.array([contact.x1]), np.array([contact.x2]), series[None])
    return places + between_points(slope, (pieces.H, final.H), contact)


def contact_under(
    load: float,
    tilt: float,
    scene: Scene,
    tol: float,
    economy: Collection[str] = ECONOMY,
    *,
    near: Interval | None = None,
    seen: tuple[float, ...] | None = None,
) -> Normal:
    """The contact of a scene's profile under another load, at another tilt; `near` is that under a load that may be almost the same."""
    profile = scene.profile
    if near is not None and profile.axis is not None and tilt == 0.0 and "symmetry" in economy and not profile.pieces.functions:
        search = Search(profile.pieces, 0.5 * scene.Estar, profile.axis, "zero panels" not in economy)
        contact = search.symmetric_near(load, near)
        if contact is not None:
            return Normal(search.finished(contact, load, 0.0, (False, False)), True)
    return normal_contact(Scene(profile=profile, modulus=scene.Estar, normal_load=load, tilt=tilt), tol, economy, seen)


def pressure(normal: Normal, scene: Scene, tol: float, economy: Collection[str] = ECONOMY) -> SlopeDensity:
    """The pressure that answers the slope on the contact: a transform where the slope is smooth there, exact panels where it is not."""
    edges = normal.edges
    contact, G = edges.contact, 0.5 * scene.Estar
    common = (contact, G, edges.k1, edges.k2, edges.normal_load, edges.moment)
    declared = normal.slope(scene.profile)
    if scene.epsilon:
        slope = refined(declared, contact.x1, contact.x2, _resolution(tol))
        geometry = SlidingGeometry(slope, contact, scene.epsilon, keep_zero="zero panels" not in economy)
        return SlidingDensity(*common, SlidingPanels(geometry, edges.I0))
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
    epsilon, keep_zero = scene.epsilon, "zero panels" not in economy
    G = 0.5 * scene.Estar * math.cos(math.pi * epsilon)

    def edges_at(tilt: float) -> Edges:
        symmetric = axis if tilt == 0.0 and epsilon == 0.0 else None
        search = Search(slope.tilted(tilt), G, symmetric, keep_zero, epsilon)
        if scene.half_width is not None:
            contact, sharp = search.of_half_width(scene.half_width)
            if all(sharp):
                raise LoadError(
                    f"a sharp-edged contact of half-width {scene.half_width:.6g} carries any load: give normal_load instead of half_width"
                )
            return search.finished(contact, None, tilt, sharp)
        assert scene.normal_load is not None
        try:
            contact, sharp = search.symmetric(scene.normal_load) if symmetric is not None else search.general(scene.normal_load)
        except LoadError:
            widest = None if scene.profile.convex else widest_contact(search, scene.normal_load)
            if widest is None:
                raise
            contact, sharp = widest, (False, False)
        return search.finished(contact, scene.normal_load, tilt, sharp)

    if scene.moment is not None and scene.normal_load is not None:
        _refuse_outside(scene.moment, scene.normal_load, slope.domain)
    if scene.moment is None:
        return Normal(edges_at(scene.tilt), axis is not None and scene.tilt == 0.0 and epsilon == 0.0)
    edges = _tilt_of_moment(edges_at, scene.moment, Search(slope, G, epsilon=epsilon), scene.half_width is not None)
    return Normal(edges, axis is not None and edges.tilt == 0.0 and epsilon == 0.0)


def _refuse_outside(moment: float, load: float, domain: tuple[float, float]) -> None:
    if not domain[0] < moment / load < domain[1]:
        raise LoadError(
            f"the moment {moment:.6g} puts the load at x = M/P = {moment / load:.6g}, "
            f"not within the indenter ({domain[0]:.6g}, {domain[1]:.6g}): lower the moment to below the load times that length"
        )


def _tilt_of_moment(edges_at: Callable[[float], Edges], moment: float, search: Search, at_fixed_width: bool) -> Edges:
    """The tilt whose pressure has the moment, by Newton in a bracket: M falls as the tilt grows."""
    low, high, tilt = -math.inf, math.inf, 0.0
    best = edges_at(tilt)
    edges = best
    for _ in range(MAX_TILTS):
        excess = edges.moment - moment
        if abs(excess) <= abs(best.moment - moment):
            best = edges
        low, high = (max(low, tilt), high) if excess > 0.0 else (low, min(high, tilt))
        if abs(excess) <= 2.0 * EPS * _reach(edges):
            break
        falls = _fall_of_moment(edges, search, at_fixed_width)
        new = tilt + excess / falls if falls > 0.0 else math.inf
        if not low < new < high:
            new = 0.5 * (low + high) if math.isfinite(low + high) else tilt
        if new == tilt or high - low <= 4.0 * EPS * min(max(abs(low), abs(high)), HUGE):
            break
        tilt, tried = _carried(edges_at, new, best.tilt)
        if tried is None:
            break
        edges = tried
    if abs(best.moment - moment) > MISSED * _reach(best):
        raise LoadError(
            f"the moment {moment:.6g} cannot be carried in one patch of contact: the nearest is {best.moment:.6g} "
            f"at a tilt of {best.tilt:.6g}; lower the moment or raise the load",
            moment=best.moment,
            tilt=best.tilt,
        )
    return best


def _carried(edges_at: Callable[[float], Edges], tilt: float, known: float) -> tuple[float, Edges | None]:
    """The edges at a tilt, or half the way back to a known one as often as the profile cannot be tilted by so much."""
    while abs(tilt - known) > 4.0 * EPS * abs(known):
        try:
            return tilt, edges_at(tilt)
        except ContactError:
            tilt = 0.5 * (tilt + known)
    return tilt, None


def _fall_of_moment(edges: Edges, search: Search, at_fixed_width: bool) -> float:
    """-dM/d(tilt): π/2 G r² (1 - 4ε²) at constant load; at constant half-width the load changes too, dm/d(tilt) = -π/J0, dP/dm = G r J1."""
    r, G = edges.contact.r, search.half_modulus / math.cos(math.pi * search.epsilon)
    falls = 0.5 * math.pi * G * r * r * (1.0 - 4.0 * search.epsilon**2)
    if at_fixed_width:
        k = replace(search, slope=search.slope.tilted(edges.tilt)).moments(edges.contact)
        falls += edges.contact.m * math.pi * G * r * (k.JR - k.JL) / (k.JR + k.JL)
    return falls


def _reach(edges: Edges) -> float:
    """The moment of the load at the farther edge: what rounding of M is relative to."""
    return edges.normal_load * (edges.contact.r + abs(edges.contact.m))


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
    noise = NOISE * rounding_noise(slope.inside, contact.x1, contact.x2)
    n = 17
    while n <= LARGEST_TRANSFORM:
        c = k.chebyshev_slope(n)[0]
        scale = float(np.abs(c).max())
        if np.abs(c[-3:]).max() <= max(tol * scale, min(noise, ROUGHEST * scale)):
            return c[: max(chebyshev.chopped_length(c, max(CHOP * scale, 0.5 * noise)), 2)]
        n = 2 * n - 1
    return None


def _first_window(scene: Scene) -> tuple[float, float]:
    """A little more than the contact where symmetry tells it; otherwise the domain where it is finite, or some way around the break
    nearest to x = 0, as far as the load or half-width asks for.

    A contact of half-width w under slopes of the size H(w) carries about G w H(w).
    """
    profile = scene.profile
    lo, hi = profile.domain
    if scene.half_width is not None and profile.axis is not None and scene.tilt == scene.epsilon == 0.0:
        reach = FITTED * scene.half_width
        return max(lo, profile.axis - reach), min(hi, profile.axis + reach)
    if np.isfinite(lo) and np.isfinite(hi):
        return lo, hi
    centre = min((b for b in (*profile.breaks, lo, hi) if np.isfinite(b)), key=abs, default=0.0)
    if scene.half_width is not None:
        size = scene.half_width
    else:
        assert scene.normal_load is not None
        sizes = np.concatenate([centre + WINDOW_SIZES, centre - WINDOW_SIZES])
        with np.errstate(invalid="ignore", over="ignore"):
            H = profile.pieces.tilted(scene.tilt)(np.clip(sizes, lo, hi)).reshape(2, -1)
            # A tilted profile touches first where its slope has risen to 0, on one side: both have to rise outwards
            outwards = 0.5 * scene.Estar * WINDOW_SIZES * H * [[1.0], [-1.0]]
            enough = [np.flatnonzero(~(force < scene.normal_load)) for force in outwards]
        size = max((float(WINDOW_SIZES[k[0]]) for k in enough if k.size), default=1.0)
    return max(lo, centre - 4.0 * size), min(hi, centre + 4.0 * size)


def _grown(lo: float, hi: float, ends: tuple[float, float]) -> tuple[float, float]:
    middle, half = 0.5 * (lo + hi), 0.5 * WINDOW_GROWTH * (hi - lo)
    return max(middle - half, ends[0]), min(middle + half, ends[1])
