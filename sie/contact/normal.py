"""The normal problem at β = 0: the edges and the pressure of a profile under a load.

Where the slope is a polynomial on each piece this is one search for the edges (`edges`) and one
expansion. A slope given by a function is resolved first, on a window that is fitted to the contact:
relative accuracy is needed where the contact is, not where the domain is.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace

import numpy as np

from sie import arguments
from sie.errors import LoadError
from sie.numerics.interval import interval_about
from sie.problem.request import ECONOMY
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.look import between_points
from sie.profiles.pieces import without_functions
from sie.profiles.resolution import accuracy_for, refined
from sie.profiles.slope import Slope

from .edges import Found, Search
from .known_contact import (
    NEARER,
    Edges,
    Normal,
    not_one_patch,
    refuse_end,
    refuse_infinite_slope,
    refuse_unresolved,
    with_breaks,
)
from .smooth_slope import smooth_contact
from .tilt_of_moment import refuse_outside, tilt_of_moment
from .window import FITTED, MOST_GROWN, Window, window_of

# Tests of a function between the points that resolved it, each with the breaks that the last added.
LOOKS = 4


def normal_contact(
    scene: Scene,
    tol: float,
    economy: Collection[str] = ECONOMY,
    seen: tuple[float, ...] | None = None,
) -> Normal:
    """The edges, load, moment and tilt of a scene.

    Raises ContactError if one patch of contact cannot answer it.

    `seen` are the breaks found in a larger contact of the same profile, which need not be looked
    for again.
    """
    return one_series(scene, tol, economy, seen) or by_pieces(scene, tol, economy, seen)


def one_series(
    scene: Scene, tol: float, economy: Collection[str], seen: tuple[float, ...] | None = None
) -> Normal | None:
    """The contact in which one series resolves the slope of a function; None if none does."""
    profile = scene.profile
    if not profile.pieces.functions or "transform" not in economy or seen:
        return None
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        try:
            found = _smooth(scene, profile.pieces, tol, "symmetry" in economy)
        except ArithmeticError:
            return None
    known = profile.convex or seen is not None
    if found is None or (not known and _unseen_by_series(found, profile, tol)):
        return None
    refuse_unresolved(found.edges, scene)
    return found


def by_pieces(
    scene: Scene, tol: float, economy: Collection[str], seen: tuple[float, ...] | None = None
) -> Normal:
    """The contact by the pieces of the slope, and LoadError where doubles cannot hold it.

    Its places are then too few, or its squares are no doubles.
    """
    profile, load = scene.profile, scene.normal_load
    if load is not None and not 1.0 / arguments.LARGEST <= load / scene.Estar <= arguments.LARGEST:
        raise LoadError(
            f"normal_load = {load:g} over E* = {scene.Estar:g} is a length out of range: "
            f"{arguments.REMEDY}"
        )
    try:
        # What that leaves is refused below.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            if profile.pieces.functions:
                found = _in_window(scene, tol, economy, seen)
            else:
                found = _searched(scene, profile.pieces, economy)
    except ArithmeticError:
        raise LoadError(
            f"the search for the contact left the range of doubles, under {_asked(scene)}: {NEARER}"
        ) from None
    refuse_unresolved(found.edges, scene)
    for side in np.flatnonzero(found.edges.sharp).tolist():
        refuse_end(profile, side)
    return found


def of_one_patch(edges: Edges, scene: Scene, tol: float, economy: Collection[str]) -> Normal:
    """The contact under a load near edges that a search for patches has found."""
    axis = scene.profile.axis if "symmetry" in economy and edges.tilt == 0.0 else None
    found = Normal(edges, False)
    for _ in range(LOOKS):
        lo, hi = edges.contact.x1, edges.contact.x2
        margin, ends = 0.5 * (FITTED - 1.0) * (hi - lo), scene.profile.domain
        resolved = with_breaks(scene.profile.pieces, found.seen)
        if resolved.functions:
            window = max(lo - margin, ends[0]), min(hi + margin, ends[1])
            resolved = refined(resolved, *window, accuracy_for(tol))
        found = replace(found, edges=_closer(edges, scene, resolved, economy))
        more = _unseen(found, resolved, scene, tol) if resolved.functions else ()
        if not more:
            break
        found = replace(found, seen=found.seen + more)
    if axis is None:
        return found
    contact = interval_about(axis, found.edges.contact.r).rounded((axis,))
    centred = replace(found.edges, contact=contact, moment=axis * edges.normal_load)
    return replace(found, edges=centred, symmetric=True)


def _closer(edges: Edges, scene: Scene, slope: Slope, economy: Collection[str]) -> Edges:
    """The edges by their conditions on a resolved slope."""
    contact, sharp, load = edges.contact, edges.sharp, edges.normal_load

    def edges_at(tilt: float) -> Edges:
        search = _search(scene, slope.tilted(tilt), economy)
        found = search.near(contact, sharp, load) or Found(contact, sharp)
        return search.finished(found, load, tilt)

    if scene.moment is None:
        return edges_at(edges.tilt)
    search = _search(scene, slope, economy)
    return tilt_of_moment(edges_at, scene.moment, search, edges.tilt)


def _asked(scene: Scene) -> str:
    names = ("normal_load", "half_width", "moment", "tilt")
    return ", ".join(f"{name} = {value:g}" for name in names if (value := getattr(scene, name)))


def _in_window(
    scene: Scene, tol: float, economy: Collection[str], seen: tuple[float, ...] | None
) -> Normal:
    """The contact of a slope that is a function, resolved on a window about it.

    If breaks are not known the places are sought, LOOKS times, where the slope needs another.
    """
    profile, window, tilt = scene.profile, window_of(scene), 0.0
    looks, seen = 0 if profile.convex or seen is not None else LOOKS, seen or ()
    while True:
        while not window.holds(_lever(scene)) and window.may_grow:
            window.grow()
        resolved = with_breaks(profile.pieces, seen)
        resolved = refined(resolved, window.lo, window.hi, accuracy_for(tol))
        try:
            found = _searched(scene, resolved, economy, tilt)
        except LoadError:
            for side in (0, 1):
                refuse_infinite_slope(profile, side)
            raise
        edges = found.edges
        if any(sharp and is_open for sharp, is_open in zip(edges.sharp, window.is_open)):
            _refuse_wider(window, scene)
            window.settled = window.shrunk > 0
            window.grow()
        elif not window.fitted_to(edges.contact):
            tilt = edges.tilt  # another may have its contact beyond the window
        else:
            found = replace(found, seen=seen)
            more = _unseen(found, resolved, scene, tol) if looks else ()
            if not more:
                return found
            looks -= 1
            seen += more
            if profile.axis is not None:
                seen += tuple(2.0 * profile.axis - x for x in more)


def _lever(scene: Scene) -> float | None:
    """Where the load acts, if that is given."""
    if scene.moment is None:
        return None
    assert scene.normal_load is not None
    return scene.moment / scene.normal_load


def _refuse_wider(window: Window, scene: Scene) -> None:
    """Raises LoadError where contact reaches the ends of a window that has grown enough."""
    if window.grown < MOST_GROWN:
        return
    load, half_width = scene.normal_load, scene.half_width
    given = f"load {load:.6g}" if load else f"half-width {half_width:.6g}"
    raise LoadError(
        f"the {given} makes contact reach beyond [{window.lo:.6g}, {window.hi:.6g}]: the slope "
        "rises too little, give a domain"
    )


def _smooth(scene: Scene, slope: Slope, tol: float, symmetry: bool) -> Normal | None:
    """The contact where one series resolves the slope, and no moment is given."""
    if scene.moment is not None or scene.epsilon:
        return None
    slope, G = slope.tilted(scene.tilt), 0.5 * scene.Estar
    axis = scene.profile.axis if symmetry and scene.tilt == 0.0 else None
    load = None if scene.normal_load is None else scene.normal_load / G
    found = smooth_contact(slope, load, scene.half_width, axis, accuracy_for(tol))
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


def _unseen_by_series(found: Normal, profile: Profile, tol: float) -> bool:
    """Whether the slope has features that the series of the contact does not show."""
    assert found.series is not None
    contact = found.edges.contact
    none = np.zeros(1)
    ends = np.array([contact.x1, contact.x2])
    series = Slope(ends, none, none[:, None], series=found.series[None])
    return bool(between_points(found.slope(profile), (series,), contact, accuracy_for(tol)))


def _unseen(found: Normal, resolved: Slope, scene: Scene, tol: float) -> tuple[float, ...]:
    """The places where the slope needs a break that it does not have.

    By the pieces that gave the edges, and by those that will give the pressure.
    """
    slope, contact = found.slope(scene.profile), found.edges.contact
    accuracy = accuracy_for(tol)
    of_edges = without_functions(resolved.tilted(found.edges.tilt))
    of_pressure = without_functions(refined(slope, contact.x1, contact.x2, accuracy))
    return between_points(slope, (of_edges, of_pressure), contact, accuracy)


def _searched(scene: Scene, slope: Slope, economy: Collection[str], start: float = 0.0) -> Normal:
    """The edges for a resolved slope; the tilt of a given moment is searched from `start`."""
    if scene.moment is None:
        edges = _edges_at(scene.tilt, scene, slope, economy)
    else:
        edges = _of_moment(scene, slope, economy, start)
    symmetric = "symmetry" in economy and scene.profile.axis is not None
    return Normal(edges, symmetric and edges.tilt == scene.epsilon == 0.0)


def _of_moment(scene: Scene, slope: Slope, economy: Collection[str], start: float) -> Edges:
    """The edges at the tilt of a given moment, sought from `start`."""
    load, moment, search = scene.normal_load, scene.moment, _search(scene, slope, economy)
    assert load is not None
    assert moment is not None
    refuse_outside(moment, load, search, scene.profile.domain)
    return tilt_of_moment(
        lambda tilt: _edges_at(tilt, scene, slope, economy), moment, search, start
    )


def _search(scene: Scene, slope: Slope, economy: Collection[str]) -> Search:
    epsilon, keep_zero = scene.epsilon, "zero panels" not in economy
    G = 0.5 * scene.Estar * math.cos(math.pi * epsilon)
    return Search(slope, G, None, keep_zero, epsilon)


def _edges_at(tilt: float, scene: Scene, slope: Slope, economy: Collection[str]) -> Edges:
    """The edges under the given load, or of the given half-width, at a given tilt."""
    search = _search(scene, slope.tilted(tilt), economy)
    if "symmetry" in economy and tilt == search.epsilon == 0.0:
        search.axis = scene.profile.axis
    if scene.half_width is not None:
        found = search.of_half_width(scene.half_width)
        if all(found.sharp):
            raise LoadError(
                f"a sharp-edged contact of half-width {scene.half_width:.6g} carries any "
                "load: give normal_load instead of half_width"
            )
        edges = search.finished(found, None, tilt)
        if not edges.normal_load > 0.0:
            raise not_one_patch(scene)
        return edges
    load = scene.normal_load
    assert load is not None
    found = search.general(load) if search.axis is None else search.symmetric(load)
    return search.finished(found, load, tilt)
