"""The widest contact that carries a load, where the search from the lowest point outwards finds none.

The base of a trace is rough: the load of the contacts that start at its lowest point rises and falls again while they are as short as its
waves, and the search ends there. Contacts as wide as the base know nothing of that. So the search begins at the widest and goes inwards, to
the first that carries no more than the load. Whether it needs tension or overlaps is for the inequalities to say.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from sie.errors import LoadError
from sie.profiles.resolution import integral
from sie.profiles.slope import Slope, polynomial_slope

from .edges import Found, Search

Pair = tuple[tuple[float, float], tuple[float, float]]

NARROWER = 0.8  # each half-width tried is this part of the one before ...
NARROWEST = 1e-3  # ... down to this part of the widest
CLOSE = 1e-4  # of the load: from there Newton's steps for both edges
MAX_STEPS = 60
MANY, FEWER = 4000, 1001  # pieces: where there are more, the half-width is looked for on fewer
ASTRAY, FEW_STEPS = 0.02, 12  # by which it may be wrong then, and steps to mend that


def widest_contact(search: Search, load: float) -> Found | None:
    """The contact, with smooth edges, or None if no such contact is found."""
    if len(search.slope.origins) <= MANY or search.slope.functions:
        r = _half_width(search, load, _bracket(search, load))
        return None if r is None else _polished(search, load, r)
    coarse = replace(search, slope=_coarser(search.slope))
    r = _half_width(coarse, load, _bracket(coarse, load))
    if r is None:
        return None
    found = _polished(search, load, r)
    if found is None:
        r = _half_width(search, load, _about(search, r), FEW_STEPS)
        found = _polished(search, load, r)
    return found


def _polished(search: Search, load: float, r: float | None) -> Found | None:
    if r is None:
        return None
    try:
        return search.polished(search.of_half_width(r).contact, load / search.half_modulus, False)
    except (LoadError, OverflowError):  # the latter of steps that run away
        return None


def _half_width(
    search: Search,
    load: float,
    bracket: Pair | None,
    most: int = MAX_STEPS,
) -> float | None:
    """That of the contact, about."""
    if bracket is None:
        return None
    (narrow, less), (wide, more) = bracket
    for _ in range(most):
        share = (
            math.log(load / less) / math.log(more / less) if less > 0.0 else 0.5
        )  # the load is nearly a power of the half-width
        r = narrow * (wide / narrow) ** min(max(share, 0.05), 0.95)
        carried = _carried(search, r)
        if carried is None:
            return None
        if abs(carried - load) <= CLOSE * load:
            break
        if carried < load:
            narrow, less = r, carried
        else:
            wide, more = r, carried
    return r


def _about(search: Search, r: float) -> Pair | None:
    """Two half-widths about another, with their loads."""
    narrow, wide = r * (1.0 - ASTRAY), r * (1.0 + ASTRAY)
    less, more = _carried(search, narrow), _carried(search, wide)
    if less is None or more is None or not 0.0 < less < more:
        return None
    return (narrow, less), (wide, more)


def _coarser(slope: Slope) -> Slope:
    """A slope of fewer pieces: straight lines through the means of many."""
    ends = np.array(slope.break_points)
    cuts = ends[np.unique(np.linspace(0, len(ends) - 1, FEWER).astype(int))]
    h = integral(slope, cuts[0], cuts)
    middle, mean = 0.5 * (cuts[1:] + cuts[:-1]), np.diff(h) / np.diff(cuts)
    rise = np.diff(mean) / np.diff(middle)
    breaks = np.concatenate((slope.breaks[:1], middle[1:-1], slope.breaks[-1:]))
    lines = list(zip(mean.tolist(), rise.tolist(), strict=False))
    return polynomial_slope(breaks.tolist(), middle[:-1].tolist(), lines)


def _wide_enough(search: Search, load: float) -> float:
    """A half-width, of a profile without an end, whose contact reaches beyond all breaks and carries more than the load; 0 if none."""
    breaks = search.slope.break_points
    widest = breaks[-1] - breaks[0] if breaks else 0.0
    for _ in range(MAX_STEPS):
        carried = _carried(search, NARROWER * widest) if widest > 0.0 else None
        if carried is None or carried > load:
            return widest if carried is not None else 0.0
        widest *= 2.0
    return 0.0


def _bracket(search: Search, load: float) -> Pair | None:
    """((r, its load), (a wider one, its load)), the first from outside between which the load lies."""
    lo, hi = search.slope.domain
    widest = 0.5 * (hi - lo)
    if not math.isfinite(widest):
        widest = _wide_enough(search, load)
    wider, r = None, NARROWER * widest
    while r > NARROWEST * widest:
        carried = _carried(search, r)
        if carried is not None and carried <= load:
            return None if wider is None else ((r, carried), wider)
        wider = None if carried is None else (r, carried)
        r *= NARROWER
    return None


def _carried(search: Search, r: float) -> float | None:
    """The load of the contact of half-width r; None if it ends at a corner, or is not found."""
    try:
        found = search.of_half_width(r)
    except (LoadError, OverflowError):
        return None
    return (
        None
        if any(found.sharp)
        else search.load(found.contact, found.moments or search.moments(found.contact))
    )
