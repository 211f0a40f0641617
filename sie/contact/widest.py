"""The widest contact that carries a load, where the search from the lowest point outwards finds none.

The base of a trace is rough: the load of the contacts that start at its lowest point rises and falls again while they are as short as its
waves, and the search ends there. Contacts as wide as the base know nothing of that. So the search begins at the widest and goes inwards, to
the first that carries no more than the load. Whether it needs tension or overlaps is for the inequalities to say.
"""

from __future__ import annotations

import math

from sie.errors import LoadError

from .edges import Found, Search

NARROWER = 0.8  # each half-width tried is this part of the one before ...
NARROWEST = 1e-3  # ... down to this part of the widest
CLOSE = 1e-4  # of the load: from there Newton's steps for both edges
MAX_STEPS = 60


def widest_contact(search: Search, load: float) -> Found | None:
    """The contact, with smooth edges, or None if no such contact is found."""
    lo, hi = search.slope.domain
    widest = 0.5 * (hi - lo)
    if not math.isfinite(widest):
        widest = _wide_enough(search, load)
    bracket = _bracket(search, load, widest)
    if bracket is None:
        return None
    (narrow, less), (wide, more) = bracket
    for _ in range(MAX_STEPS):
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
    try:
        return search.polished(search.of_half_width(r).contact, load / search.half_modulus, False)
    except LoadError:
        return None


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


def _bracket(
    search: Search, load: float, widest: float
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """((r, its load), (a wider one, its load)), the first from outside between which the load lies."""
    wider, r = None, NARROWER * widest
    while r > NARROWEST * widest:
        carried = _carried(search, r)
        if carried is not None and carried <= load:
            return None if wider is None else ((r, carried), wider)
        wider = None if carried is None else (r, carried)
        r *= NARROWER
    return None


def _carried(search: Search, r: float) -> float | None:
    """The load of the contact of half-width r; None if it ends at a corner."""
    try:
        found = search.of_half_width(r)
    except LoadError:
        return None
    return (
        None
        if any(found.sharp)
        else search.load(found.contact, found.moments or search.moments(found.contact))
    )
