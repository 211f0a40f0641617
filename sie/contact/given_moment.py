"""Both edges and the tilt at once, where the moment is given in place of the tilt.

Whatever the contact, the tilt is the one that makes I0 vanish: both edges are smooth. What is left
is one equation for each number that is given (`edges`).
"""

from __future__ import annotations

import math
from dataclasses import replace

from sie.errors import LoadError
from sie.numerics.interval import Interval, interval_about
from sie.numerics.root_finding import logarithmic_root

from .edge_integrals import EdgeIntegrals, edge_integrals
from .edge_refinement import ROUNDINGS
from .edges import Found, Search
from .first_guess import first_guess
from .known_contact import Edges


def under_load(search: Search, load: float, moment: float) -> Edges | None:
    """The contact and the tilt where both edges are smooth.

    None if none was found, or an edge is at the end of the indenter.
    """
    target, lever = load / search.half_modulus, moment / load
    lo, hi = search.slope.domain

    def carried(r: float) -> tuple[float, float]:
        k = search.integrals(interval_about(lever, r))
        rounding = ROUNDINGS * (k.size1 + k.size2)
        # A straight part of the profile carries nothing
        return (r * k.I1, 0.5 * r * r * (k.JR + k.JL)) if rounding < k.I1 else (0.0, 0.0)

    lost = LoadError(
        f"the moment {moment:.6g} puts the load at x = M/P = {lever:.6g}, where rounding of "
        "the slope is more than the load shows: "
        "lower the moment, or move the profile to where the load acts (shifted)"
    )
    if not math.isfinite(float(search.slope(lever))):
        raise lost
    limit = min(lever - lo, hi - lever)
    try:
        r = logarithmic_root(
            carried, target, first_guess(search.slope, lever, target), limit, search.too_much(load)
        )
    except LoadError:
        return None
    guess = interval_about(lever, r)
    if not sum(search.polish.rounding(guess, search.integrals(guess), target)) <= target:
        raise lost
    return near(search, guess, load, moment)


def near(search: Search, guess: Interval, load: float, moment: float) -> Edges | None:
    """The same from a contact that is near; None where steps from there find none."""

    def tilted(contact: Interval, tilt: float) -> EdgeIntegrals:
        search.evaluations += 1
        return edge_integrals(search.slope.tilted(tilt), contact, keep_zero=search.keep_zero)

    found = search.polish.balanced(guess, load / search.half_modulus, moment / load, tilted)
    if found is None:
        return None
    contact, k, tilt = found
    return replace(search.finished(Found(contact, integrals=k), load, tilt), moment=moment)
