"""The normal problem at β = 0: the edges and the pressure of a profile under a load.

Where the slope is a polynomial on each piece this is one search for the edges (`edges`) and one
expansion. A slope given by a function is resolved first, on a window that is fitted to the contact:
relative accuracy is needed where the contact is, not where the domain is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS, Interval, interval_about
from sie.numerics.root_finding import Bracket
from sie.problem.request import ECONOMY
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.power_law import PowerLaw
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.profiles.unresolved import Pieces, between_pieces, between_points, expanded

from . import given_moment
from .edges import PLACES, Edges, Found, Search
from .pressure import Normal, resolution, slope_series, upright_law, with_breaks
from .smooth_slope import smooth_contact
from .widest_contact import widest_contact

Array = NDArray[np.float64]


# A window of a function's slope is refitted while it is longer than the contact by more than this
# factor ...
WINDOW = 1.6
FITTED = 1.25  # ... to the contact times this.
WINDOW_GROWTH = 8.0
MOST_GROWN, MOST_SHRUNK = 12, 120
GROWS = 1.5  # a window so much wider must carry so much more, or no wider one will be tried
WINDOW_SIZES = np.geomspace(1e-140, 1e140, 561)
MAX_TILTS = 100  # tried, whether or not the profile can be tilted by so much
HUGE = 1e300  # stands for an open end of the bracket
SIZE = 1e120  # bounds a half-width and a pressure, whose squares are multiplied again
MOMENT = 1e304  # bounds a moment
NEARER = (
    "choose other units, or lessen what moves the contact away from x = 0, tilt, moment or shift"
)
# Looks at a function between the points that resolved it, each with the breaks that the last added.
LOOKS = 4
MISSED = 1e-9  # of the load times its farthest lever: a moment missed by more was not carried


def normal_contact(
    scene: Scene,
    tol: float,
    economy: Collection[str] = ECONOMY,
    seen: tuple[float, ...] | None = None,
) -> Normal:
    """The edges, load, moment and tilt of a scene. Raises ContactError if one patch of contact
    cannot answer it.

    `seen` are the breaks found in a larger contact of the same profile, which need not be looked
    for again.
    """
    found = _within_scale(scene, tol, economy, seen)
    ends = zip(found.edges.sharp, scene.profile.ends_are_corners, scene.profile.domain, strict=True)
    for end in [end for is_sharp, is_corner, end in ends if is_sharp and not is_corner]:
        raise LoadError(
            f"the contact reaches the end of the trace at x = {end:.6g}, and what the indenter is "
            "like beyond is not known: lower the load or the tilt, or measure further out",
            end=end,
        )
    return found


def _within_scale(
    scene: Scene, tol: float, economy: Collection[str], seen: tuple[float, ...] | None
) -> Normal:
    """`_contact`; LoadError where doubles cannot hold it: its places are too few, or its squares
    are no doubles.
    """
    if (
        scene.normal_load is not None
        and not 1.0 / arguments.LARGEST <= scene.normal_load / scene.Estar <= arguments.LARGEST
    ):
        raise LoadError(
            f"normal_load = {scene.normal_load:g} over E* = {scene.Estar:g} is a length out of "
            f"range: {arguments.REMEDY}"
        )
    try:
        # What that leaves is refused below.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            found = _contact(scene, tol, economy, seen)
    except ArithmeticError:
        raise LoadError(
            f"the search for the contact left the range of doubles, under {_asked(scene)}: {NEARER}"
        ) from None
    edges = found.edges
    (x1, x2), r, P = edges.contact[:2], edges.contact.r, edges.normal_load
    apart = math.ulp(max(abs(x1), abs(x2)))
    if not r >= PLACES * apart:
        raise LoadError(
            f"the contact at x = {edges.contact.m:.6g} is {2.0 * r:.6g} wide, where doubles are "
            f"{apart:.2g} apart: {NEARER}"
        )
    refuse_out_of_scale(r, P, scene.Estar)
    return found


def refuse_out_of_scale(r: float, load: float, Estar: float) -> None:
    """Raises LoadError for a contact of half-width r with sizes whose products are no doubles."""
    sizes = (
        ("half-width", r, SIZE),
        ("mean traction", 0.5 * load / r, SIZE),
        ("E* r²", Estar * r * r, MOMENT),
    )
    for name, size, largest in sizes:
        if not 1.0 / largest <= size <= largest:
            raise LoadError(
                f"the contact's {name} is {size:.6g}, whose products leave the range of doubles: "
                f"{arguments.REMEDY}"
            )


def _asked(scene: Scene) -> str:
    names = ("normal_load", "half_width", "moment", "tilt")
    return ", ".join(f"{name} = {value:g}" for name in names if (value := getattr(scene, name)))


def _contact(
    scene: Scene, tol: float, economy: Collection[str], seen: tuple[float, ...] | None
) -> Normal:
    profile = scene.profile
    law = upright_law(scene, economy)
    if law is not None and _asks_for_no_tilt(scene, law.axis):
        return Normal(_of_power_law(law, scene), True)
    if not profile.pieces.functions:
        return _searched(scene, profile.pieces, economy)
    looks = 0 if profile.convex or seen is not None else LOOKS
    seen = seen or ()
    smooth = (
        _smooth(scene, with_breaks(profile.pieces, seen), tol, "symmetry" in economy)
        if "transform" in economy
        else None
    )
    if smooth is not None and not (looks and _unseen_by_series(smooth, profile, tol)):
        return smooth
    lo, hi = _first_window(scene)
    ends = profile.domain
    carried = 0.0  # the largest load that the last window carried
    grown, shrunk, settled = 0, 0, False
    tilt = 0.0  # at which the last window was fitted: another may have its contact beyond it
    while True:
        open_ends = (lo > ends[0], hi < ends[1])
        try:
            resolved = refined(with_breaks(profile.pieces, seen), lo, hi, resolution(tol))
            found = _searched(scene, resolved, economy, tilt)
        except LoadError as error:
            before, carried = carried, float(error.reached.get("load", 0.0))
            if not any(open_ends) or grown >= MOST_GROWN or (before and carried <= GROWS * before):
                _refuse_infinite_ends(profile.pieces)
                raise  # a wider window changes nothing
            grown += 1
            lo, hi = _grown(lo, hi, ends)
            continue
        contact, sharp = found.edges.contact, found.edges.sharp
        if any(is_sharp and is_open for is_sharp, is_open in zip(sharp, open_ends, strict=True)):
            if grown >= MOST_GROWN:
                given = (
                    f"load {scene.normal_load:.6g}"
                    if scene.normal_load
                    else f"half-width {scene.half_width:.6g}"
                )
                raise LoadError(
                    f"the {given} makes contact reach beyond [{lo:.6g}, {hi:.6g}]: the slope "
                    "rises too little, give a domain"
                )
            grown, settled = grown + 1, shrunk > 0
            lo, hi = _grown(lo, hi, ends)
            continue
        margin = 0.5 * (FITTED - 1.0) * (contact.x2 - contact.x1)
        fitted = max(contact.x1 - margin, ends[0]), min(contact.x2 + margin, ends[1])
        # A window that had to grow again after it was fitted belongs to a profile that is not
        # convex: it stays
        if (
            hi - lo <= WINDOW * (contact.x2 - contact.x1)
            or fitted == (lo, hi)
            or settled
            or shrunk >= MOST_SHRUNK
        ):
            found = replace(found, seen=seen)
            more = _unseen(found, resolved, scene, tol, economy) if looks else ()
            if not more:
                return found
            looks -= 1
            seen += (
                more if profile.axis is None else (*more, *(2.0 * profile.axis - x for x in more))
            )
            continue
        shrunk += 1
        lo, hi = fitted
        tilt = found.edges.tilt


def _asks_for_no_tilt(scene: Scene, axis: float) -> bool:
    """Whether the moment is not given, or is that of a load on the axis."""
    if scene.moment is None or scene.normal_load is None:
        return scene.moment is None or scene.moment == axis == 0.0
    return scene.moment == axis * scene.normal_load


def _of_power_law(law: PowerLaw, scene: Scene) -> Edges:
    G = 0.5 * scene.Estar
    if scene.half_width is not None:
        r, P = scene.half_width, law.load(scene.half_width, G)
    else:
        assert scene.normal_load is not None
        r, P = law.half_width(scene.normal_load, G), scene.normal_load
    contact = interval_about(law.axis, r).rounded((law.axis,))
    return Edges(contact, P, contact.m * P, 0.0, (False, False), 0.0, 0.0, 0.0, 0)


def _smooth(scene: Scene, slope: Slope, tol: float, symmetry: bool) -> Normal | None:
    """The contact where one series resolves the slope, and no moment is given."""
    if scene.moment is not None or scene.epsilon:
        return None
    slope, G = slope.tilted(scene.tilt), 0.5 * scene.Estar
    axis = scene.profile.axis if symmetry and scene.tilt == 0.0 else None
    load = None if scene.normal_load is None else scene.normal_load / G
    found = smooth_contact(slope, load, scene.half_width, axis, resolution(tol))
    if found is None:
        return None
    contact, c = found.contact.rounded(slope.break_points), found.series
    c[0] = 0.0  # the edges' condition, which was met to rounding
    P, M = 0.5 * math.pi * G * contact.r * float(c[1]), 0.0
    if scene.normal_load is not None:
        P = scene.normal_load
    if len(c) > 2 and axis is None:
        M = 0.25 * math.pi * G * contact.r**2 * float(c[2])
    smooth, n = (False, False), found.evaluations
    edges = Edges(contact, P, contact.m * P + M, scene.tilt, smooth, 0.0, 0.0, 0.0, n)
    return Normal(edges, axis is not None, c)


def _refuse_infinite_ends(slope: Slope) -> None:
    """Raises LoadError where the slope is infinite at an end of the indenter, towards which no
    series resolves it.
    """
    ends = np.array([end for end in slope.domain if math.isfinite(end)])
    infinite = ends[~np.isfinite(slope(ends))]
    if len(infinite):
        raise LoadError(
            f"the slope is infinite at the end x = {infinite[0]:.6g} of its domain, which the "
            "contact comes near: narrow the domain"
        )


def _unseen_by_series(found: Normal, profile: Profile, tol: float) -> bool:
    """Whether the slope does what the series of the contact does not show."""
    assert found.series is not None
    contact = found.edges.contact
    series = Pieces(np.array([contact.x1]), np.array([contact.x2]), found.series[None])
    return bool(between_points(found.slope(profile), (series.H,), contact, resolution(tol)))


def _unseen(
    found: Normal, resolved: Slope, scene: Scene, tol: float, economy: Collection[str]
) -> tuple[float, ...]:
    """The places where the slope needs a break that it does not have.

    By the pieces that gave the edges, and by what will give the pressure.
    """
    slope, contact = found.slope(scene.profile), found.edges.contact
    accuracy = resolution(tol)
    pieces = expanded(slope, resolved, contact)
    places = between_pieces(slope, pieces, contact, accuracy)
    transform = not scene.epsilon and "transform" in economy
    series = slope_series(slope, contact, accuracy) if transform else None
    if series is None:
        resolved = refined(slope, contact.x1, contact.x2, accuracy)
        final = expanded(slope, resolved, contact)
        places += between_pieces(slope, final, contact, accuracy)
    else:
        final = Pieces(np.array([contact.x1]), np.array([contact.x2]), series[None])
    return places + between_points(slope, (pieces.H, final.H), contact, accuracy)


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
    """The contact of a scene's profile under another load, at another tilt; `near` is that under a
    load that may be almost the same.
    """
    profile = scene.profile
    upright = profile.axis is not None and tilt == 0.0 and "symmetry" in economy
    searched = not profile.pieces.functions and upright_law(scene, economy, tilt) is None
    if near is not None and upright and searched:
        search = Search(
            profile.pieces, 0.5 * scene.Estar, profile.axis, "zero panels" not in economy
        )
        contact = search.symmetric_near(load, near)
        if contact is not None:
            return Normal(search.finished(Found(contact), load, 0.0), True)
    return normal_contact(
        Scene(profile=profile, modulus=scene.Estar, normal_load=load, tilt=tilt), tol, economy, seen
    )


def _searched(scene: Scene, slope: Slope, economy: Collection[str], start: float = 0.0) -> Normal:
    """The edges for a resolved slope; the tilt of a given moment is searched from `start`."""
    axis = scene.profile.axis if "symmetry" in economy else None
    epsilon, keep_zero = scene.epsilon, "zero panels" not in economy
    G = 0.5 * scene.Estar * math.cos(math.pi * epsilon)

    def edges_at(tilt: float) -> Edges:
        symmetric = axis if tilt == 0.0 and epsilon == 0.0 else None
        search = Search(slope.tilted(tilt), G, symmetric, keep_zero, epsilon)
        if scene.half_width is not None:
            found = search.of_half_width(scene.half_width)
            if all(found.sharp):
                raise LoadError(
                    f"a sharp-edged contact of half-width {scene.half_width:.6g} carries any "
                    "load: give normal_load instead of half_width"
                )
            return search.finished(found, None, tilt)
        assert scene.normal_load is not None
        try:
            found = (
                search.symmetric(scene.normal_load)
                if symmetric is not None
                else search.general(scene.normal_load)
            )
        except LoadError:
            widest = None if scene.profile.convex else widest_contact(search, scene.normal_load)
            if widest is None:
                raise
            found = widest
        return search.finished(found, scene.normal_load, tilt)

    if scene.moment is not None and scene.normal_load is not None:
        _refuse_outside(scene.moment, scene.normal_load, slope.domain, scene.profile.domain)
    if scene.moment is None:
        return Normal(
            edges_at(scene.tilt), axis is not None and scene.tilt == 0.0 and epsilon == 0.0
        )
    search = Search(slope, G, epsilon=epsilon, keep_zero=keep_zero)
    at_fixed_width = scene.half_width is not None
    edges = None
    if (
        scene.normal_load is not None
        and epsilon == 0.0
        and (axis is None or scene.moment != axis * scene.normal_load)
    ):
        edges = given_moment.under_load(search, scene.normal_load, scene.moment)
    if scene.half_width is not None and epsilon == 0.0 and not scene.moment == axis == 0.0:
        edges = given_moment.of_half_width(search, scene.half_width, scene.moment)
        if edges is None and np.isinf(scene.profile.domain).all():
            raise LoadError(
                f"no contact of half-width {scene.half_width:.6g} with smooth edges was found that "
                f"has the moment {scene.moment:.6g}: give a smaller moment, or a larger half_width"
            )
    edges = edges or _tilt_of_moment(edges_at, scene.moment, search, at_fixed_width, start)
    return Normal(edges, axis is not None and edges.tilt == 0.0 and epsilon == 0.0)


def _refuse_outside(
    moment: float, load: float, window: tuple[float, float], domain: tuple[float, float]
) -> None:
    """Raises LoadError where the load acts beyond the window on which the slope is resolved, or
    beyond the indenter.
    """
    if window[0] < moment / load < window[1]:
        return
    acts = f"the moment {moment:.6g} puts the load at x = M/P = {moment / load:.6g}, "
    if domain[0] < moment / load < domain[1]:
        raise LoadError(
            f"{acts}beyond [{window[0]:.6g}, {window[1]:.6g}], where the slope was resolved: "
            "lower the moment"
        )
    raise LoadError(
        f"{acts}not within the indenter ({domain[0]:.6g}, {domain[1]:.6g}): lower the moment to "
        "below the load times that length"
    )


def _tilt_of_moment(
    edges_at: Callable[[float], Edges],
    moment: float,
    search: Search,
    at_fixed_width: bool,
    tilt: float,
) -> Edges:
    """The tilt whose pressure has the moment, by Newton in a bracket: M falls as the tilt grows."""
    bracket = Bracket((-math.inf, 0.0), (math.inf, 0.0))
    best = edges_at(tilt)
    edges = best
    left, missed = MAX_TILTS, [math.inf, math.inf]
    while left > 0:
        excess = edges.moment - moment
        if abs(excess) <= abs(best.moment - moment):
            best = edges
        bracket.cut((tilt, 0.0), above=excess > 0.0)
        if abs(excess) <= 2.0 * EPS * _reach(edges):
            break
        falls = _fall_of_moment(edges, search, at_fixed_width)
        missed.append(abs(excess))
        # Newton's steps may run to and fro across a part that is nearly flat
        astray = missed[-1] > 0.5 * missed[-3]
        wanted = tilt + excess / falls if falls > 0.0 else math.inf
        new, _ = bracket.place((wanted, 0.0), astray)
        (low, _), (high, _) = bracket.low, bracket.high
        settled = high - low <= 4.0 * EPS * min(max(abs(low), abs(high)), HUGE)
        if new == tilt or settled or not math.isfinite(new):
            break
        tilt, tried, spent = _carried(edges_at, new, best.tilt, left)
        left -= spent
        if tried is None:
            break
        edges = tried
    if abs(best.moment - moment) > MISSED * _reach(best):
        raise LoadError(
            f"the moment {moment:.6g} cannot be carried in one patch of contact: the nearest is "
            f"{best.moment:.6g} at a tilt of {best.tilt:.6g}; lower the moment or raise the load",
            moment=best.moment,
            tilt=best.tilt,
        )
    return best


def _carried(
    edges_at: Callable[[float], Edges], tilt: float, known: float, most: int
) -> tuple[float, Edges | None, int]:
    """The edges at a tilt, or half the way back to a known one as often as the profile cannot be
    tilted by so much; and the tilts tried.
    """
    for tried in range(1, most + 1):
        if abs(tilt - known) <= 4.0 * EPS * abs(known):
            return tilt, None, tried
        try:
            return tilt, edges_at(tilt), tried
        except ContactError:
            tilt = 0.5 * (tilt + known)
    return tilt, None, most


def _fall_of_moment(edges: Edges, search: Search, at_fixed_width: bool) -> float:
    """-dM/d(tilt): π/2 G r² (1 - 4ε²) at constant load; at constant half-width the load changes
    too, dm/d(tilt) = -π/J0, dP/dm = G r J1.
    """
    r, G = edges.contact.r, search.half_modulus / math.cos(math.pi * search.epsilon)
    falls = 0.5 * math.pi * G * r * r * (1.0 - 4.0 * search.epsilon**2)
    if at_fixed_width:
        k = replace(search, slope=search.slope.tilted(edges.tilt)).moments(edges.contact)
        rise = k.JR + k.JL  # 0 where a power of x underflows, or is straight to rounding
        falls += edges.contact.m * math.pi * G * r * (k.JR - k.JL) / rise if rise > 0.0 else 0.0
    return falls


def _reach(edges: Edges) -> float:
    """The moment of the load at the farther edge: what rounding of M is relative to."""
    return edges.normal_load * (edges.contact.r + abs(edges.contact.m))


def _first_window(scene: Scene) -> tuple[float, float]:
    """A little more than the contact where symmetry tells it; otherwise the domain where it is
    finite, or some way around the break nearest to x = 0, as far as the load or half-width asks
    for.

    A contact of half-width w under slopes of the size H(w) carries about G w H(w).
    """
    profile = scene.profile
    lo, hi = profile.domain
    upright = scene.tilt == scene.epsilon == 0.0 and scene.moment is None
    if scene.half_width is not None and profile.axis is not None and upright:
        reach = FITTED * scene.half_width
        return max(lo, profile.axis - reach), min(hi, profile.axis + reach)
    if np.isfinite(lo) and np.isfinite(hi):
        return lo, hi
    centre = min((b for b in (*profile.breaks, lo, hi) if np.isfinite(b)), key=abs, default=0.0)
    sizes = np.concatenate([centre + WINDOW_SIZES, centre - WINDOW_SIZES])
    with np.errstate(invalid="ignore", over="ignore"):
        H = profile.pieces.tilted(scene.tilt)(np.clip(sizes, lo, hi)).reshape(2, -1)
        # A tilted profile touches first where its slope has risen to 0, on one side: both have to
        # rise outwards
        outwards = 0.5 * scene.Estar * WINDOW_SIZES * H * [[1.0], [-1.0]]
        enough = [np.flatnonzero(~(force < (scene.normal_load or 0.0))) for force in outwards]
    reaches = [float(WINDOW_SIZES[k[0]]) for k in enough if k.size]
    given = () if scene.half_width is None else (scene.half_width,)
    size = max((*given, *reaches), default=1.0)
    return max(lo, centre - 4.0 * size), min(hi, centre + 4.0 * size)


def _grown(lo: float, hi: float, ends: tuple[float, float]) -> tuple[float, float]:
    middle, half = 0.5 * (lo + hi), 0.5 * WINDOW_GROWTH * (hi - lo)
    return max(middle - half, ends[0]), min(middle + half, ends[1])
