"""The widest contact that carries a load, where the search from the lowest point outwards finds none.

The base of a trace is rough: the load of the contacts that start at its lowest point rises and
falls again while they are as short as its waves, and the search ends there. So this search begins
at the widest contact and goes inwards, to the first that carries no more than the load. Whether
that needs tension or overlaps is for the inequalities to say.
"""

from __future__ import annotations

import math

from sie.errors import LoadError
from sie.numerics.root_finding import false_position

from .edges import Found, Search

NARROWER = 0.8  # each half-width tried is this part of the one before ...
NARROWEST = 1e-3  # ... down to this part of the widest
LEAST = 1e-6  # of the load: what less than that carries is taken for it in logarithms
CLOSE = 1e-4  # of the load: from there Newton's steps for both edges
MAX_STEPS = 60


def widest_contact(search: Search, load: float) -> Found | None:
    """The contact, with smooth edges, or None if no such contact is found."""
    lo, hi = search.slope.domain

    def excess(u: float) -> float:
        """ln of the carried load over the load, at ln of the half-width: nearly a straight line."""
        return math.log(max(_carried(search, math.exp(u)) / load, LEAST))

    try:
        widest = 0.5 * (hi - lo) if math.isfinite(hi - lo) else _wide_enough(search, load)
        bracket = _bracket(search, load, widest)
        if bracket is None:
            return None
        a, b = map(math.log, bracket)
        u = false_position(excess, a, b, (excess(a), excess(b)), lambda *at: abs(at[-1]) <= CLOSE)
        contact = search.of_half_width(math.exp(u)).contact
        return search.polished(contact, load / search.half_modulus, False)
    except LoadError:
        return None


def _wide_enough(search: Search, load: float) -> float:
    """A half-width whose contact reaches beyond all breaks and carries more than the load.

    The profile has no end. Raises LoadError if there is none.
    """
    breaks = search.slope.break_points
    widest = breaks[-1] - breaks[0] if breaks else 0.0
    for _ in range(MAX_STEPS if widest > 0.0 else 0):
        if _carried(search, NARROWER * widest) > load:
            return widest
        widest *= 2.0
    raise LoadError("no contact of a profile without an end carries more than the load")


def _bracket(search: Search, load: float, widest: float) -> tuple[float, float] | None:
    """Two half-widths, the first from outside between whose loads the load lies."""
    wider, r = 0.0, NARROWER * widest
    while r > NARROWEST * widest:
        try:
            if _carried(search, r) <= load:
                return (r, wider) if wider else None
            wider = r
        except LoadError:
            wider = 0.0
        r *= NARROWER
    return None


def _carried(search: Search, r: float) -> float:
    """The load of the contact of half-width r; raises LoadError if it ends at a corner."""
    found = search.of_half_width(r)
    if any(found.sharp):
        raise LoadError(f"a contact of half-width {r:.6g} ends at a corner")
    return search.load(found.contact, found.moments or search.moments(found.contact))
