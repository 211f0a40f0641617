"""The widest contact that carries a load, for profiles where the outward search finds none.

The base of a trace is rough: the load of the contacts that start at its lowest point rises and
falls again while they are as short as its waves, and the search ends there. So this search begins
at the widest contact and goes inwards, to the first that carries no more than the load. The
inequalities show whether that contact needs tension or overlap. Where the slope has very many
pieces the half-width is searched for on fewer pieces first.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from sie.errors import LoadError
from sie.numerics.root_finding import false_position
from sie.profiles.profile_pieces import integral
from sie.profiles.slope import Slope, polynomial_slope
from sie.progress_bar import reported

from .edges import Found, Search

NARROWER = 0.8  # each half-width tried is this part of the one before
# Parts of the widest. The window of a function is fitted to the contact, which is 0.8 of it:
# whether that carries more than the load is rounding, so that a wider one is tried first.
TRIED = (0.95, *(NARROWER**k for k in range(1, 31)))
LEAST = 1e-6  # of the load: what carries less counts as this much in logarithms
CLOSE = 1e-4  # of the load: from there Newton's steps for both edges
MAX_STEPS = 60
MANY, FEWER = 4000, 1001  # pieces: where there are more, the half-width is sought on fewer
ASTRAY = 0.02  # by which it may be wrong then


@reported("half-width of the contact")
def widest_contact(search: Search, load: float) -> Found | None:
    """The contact, with smooth edges, or None if no such contact is found."""
    few = len(search.slope.origins) <= MANY or bool(search.slope.functions)
    coarse = search if few else replace(search, slope=_coarser(search.slope))
    try:
        r = _half_width(coarse, load, _bracket(coarse, load))
    except (LoadError, OverflowError):  # the latter of steps that diverge
        return None
    found = _polished(search, load, r)
    if found is None and not few:
        try:
            r = _half_width(search, load, (r * (1.0 - ASTRAY), r * (1.0 + ASTRAY)))
        except (LoadError, OverflowError):
            return None
        found = _polished(search, load, r)
    return found


def _polished(search: Search, load: float, r: float) -> Found | None:
    try:
        return search.polished(search.of_half_width(r).contact, load / search.half_modulus, False)
    except (LoadError, OverflowError):
        return None


def _half_width(search: Search, load: float, bracket: tuple[float, float]) -> float:
    """The half-width between these whose contact carries the load, to CLOSE."""

    def excess(u: float) -> float:
        """ln of the carried load over the load, at ln of the half-width: nearly a straight line."""
        return math.log(max(_carried(search, math.exp(u)) / load, LEAST))

    a, b = map(math.log, bracket)
    ends = excess(a), excess(b)
    if not ends[0] <= 0.0 < ends[1]:
        raise LoadError("the load is not that of a contact between these half-widths")
    return math.exp(false_position(excess, a, b, ends, lambda *at: abs(at[-1]) <= CLOSE))


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


def _bracket(search: Search, load: float) -> tuple[float, float]:
    """Two half-widths, the first from outside between whose loads the load lies."""
    lo, hi = search.slope.domain
    widest = 0.5 * (hi - lo) if math.isfinite(hi - lo) else _wide_enough(search, load)
    wider = 0.0
    for r in [part * widest for part in TRIED]:
        try:
            if _carried(search, r) <= load:
                if wider:
                    return r, wider
                break
            wider = r
        except (LoadError, OverflowError):
            wider = 0.0
    raise LoadError("no two half-widths were found with the load between theirs")


def _wide_enough(search: Search, load: float) -> float:
    """A half-width, for a profile without an end, that carries more than the load.

    The contact reaches beyond all breaks. Raises LoadError if there is none.
    """
    breaks = search.slope.break_points
    widest = breaks[-1] - breaks[0] if breaks else 0.0
    for _ in range(MAX_STEPS if widest > 0.0 else 0):
        if _carried(search, NARROWER * widest) > load:
            return widest
        widest *= 2.0
    raise LoadError("no contact of a profile without an end carries more than the load")


def _carried(search: Search, r: float) -> float:
    """The load of the contact of half-width r; raises LoadError if it ends at a corner."""
    found = search.of_half_width(r)
    if any(found.sharp):
        raise LoadError(f"a contact of half-width {r:.6g} ends at a corner")
    return search.load(found.contact, found.integrals or search.integrals(found.contact))
