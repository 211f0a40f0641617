"""The tilt whose pressure has a given moment, by Newton's method on contacts of given tilts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS
from sie.numerics.root_finding import Bracket

from .known_contact import PLACES, Edges

if TYPE_CHECKING:
    from .edges import Search

MAX_TILTS = 100  # tried, whether or not the profile can be tilted by so much
HUGE = 1e300  # stands for an open end of the bracket
MISSED = 1e-9  # of the load times its farthest lever: a moment missed by more was not carried


def refuse_outside(moment: float, load: float, search: Search, domain: tuple[float, float]) -> None:
    """Raises LoadError where the load acts too far outside.

    That is beyond the window on which the slope is resolved, beyond the indenter, or where the
    rounding of the slope carries the load in the narrowest contact that doubles show.
    """
    (lo, hi), lever = search.slope.domain, moment / load
    acts = f"the moment {moment:.6g} puts the load at x = M/P = {lever:.6g}"
    if not lo < lever < hi:
        lo, hi = (lo, hi) if domain[0] < lever < domain[1] else domain
        raise LoadError(
            f"{acts}, not within the indenter ({lo:.6g}, {hi:.6g}), or not where its slope was "
            "resolved: lower the moment to below the load times that length"
        )
    narrowest = PLACES * math.ulp(lever)
    if EPS * abs(float(search.slope(lever))) * narrowest * search.half_modulus >= load:
        raise LoadError(
            f"{acts}, where rounding of the slope is more than the load shows: lower the moment, "
            "or move the profile to where the load acts (shifted)"
        )


def tilt_of_moment(
    edges_at: Callable[[float], Edges],
    moment: float,
    search: Search,
    tilt: float,
) -> Edges:
    """The edges at the tilt whose pressure has the moment, by Newton's method in a bracket.

    M falls as the tilt grows; the search starts at `tilt`.
    """
    bracket = Bracket((-math.inf, 0.0), (math.inf, 0.0))
    edges = best = edges_at(tilt)
    left = MAX_TILTS
    while left > 0:
        excess = edges.moment - moment
        if abs(excess) <= abs(best.moment - moment):
            best = edges
        bracket.cut((tilt, 0.0), above=excess > 0.0)
        if abs(excess) <= 2.0 * EPS * _reach(edges):
            break
        falls = _fall_of_moment(edges, search)
        wanted = tilt + excess / falls if falls > 0.0 else math.inf
        new, _ = bracket.place((wanted, 0.0), abs(excess))
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
    """The edges at a tilt that the profile allows, and the number of tilts tried.

    The tilt goes half the way back to a known one as often as the profile cannot be tilted by so
    much.
    """
    for tried in range(1, most + 1):
        if abs(tilt - known) <= 4.0 * EPS * abs(known):
            return tilt, None, tried
        try:
            return tilt, edges_at(tilt), tried
        except ContactError:
            tilt = 0.5 * (tilt + known)
    return tilt, None, most


def _fall_of_moment(edges: Edges, search: Search) -> float:
    """-dM/d(tilt) at constant load, π/2 G r² (1 - 4ε²)."""
    r, G = edges.contact.r, search.half_modulus / math.cos(math.pi * search.epsilon)
    return 0.5 * math.pi * G * r * r * (1.0 - 4.0 * search.epsilon**2)


def _reach(edges: Edges) -> float:
    """The moment of the load at the farther edge: what rounding of M is relative to."""
    return edges.normal_load * (edges.contact.r + abs(edges.contact.m))
