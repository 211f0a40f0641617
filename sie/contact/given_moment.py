"""Both edges and the tilt at once, where the moment is given in place of the tilt.

Whatever the contact, the tilt is the one that makes I0 vanish: both edges are smooth. What is left
is one equation for each number that is given (`edges`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from sie.errors import LoadError
from sie.numerics.interval import EPS, Interval, interval_about, two_sum
from sie.numerics.root_finding import Bracket, Place, logarithmic_root

from .edge_integrals import EdgeIntegrals, edge_integrals
from .edge_refinement import MAX_POLISHING, ROUNDINGS
from .edges import Found, Search
from .first_guess import first_guess
from .known_contact import PLACES, Edges

NEAR_CENTRE = 4.0  # half-widths from a centre an origin loses no digits
# The search for a centre: the first step over the half-width, and what the next are longer by.
FIRST_STEP, GROWTH = 2.0**-6, 1.5


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


def of_half_width(search: Search, r: float, moment: float) -> Edges | None:
    """The contact of half-width r with smooth edges that has the moment, and its tilt.

    Of several it is the one nearest to where the untilted profile touches; None if none was found.

    Whatever the centre m, the tilt -I0/π balances the slope. Then M = G r (m I1 - r (C2 -
    I0/2)) and dM/dm = G r (r (JR + JL)/4 + m (JR - JL)/2): one unknown. M need not grow with m,
    because P changes too.
    """
    (lo, hi), (z1, z2), scale = search.slope.domain, search.touch(), search.half_modulus * r
    most = r / (PLACES * EPS)
    low, high = max(lo + r, -most), min(hi - r, most)
    if not low < high:
        return None

    at = partial(_excess_of_moment, search, r, moment / scale)
    centre = min(max(0.5 * (z1 + z2), low), high)
    bracket = _first_change(lambda m: at((m, 0.0)), centre, (low, high), r)
    if bracket is None:
        return None
    m = bracket.middle()
    slope = math.copysign(1.0, at(bracket.high)[0])
    earlier = [math.inf, math.inf]
    for _ in range(MAX_POLISHING):
        excess, rise, contact, k = at(m)
        size = k.size1 + k.size2
        rounding = ROUNDINGS * ((abs(m[0]) + r) * size + abs(moment) / scale)
        missed = abs(excess) / rounding
        wanted = two_sum(m[0], m[1] - excess / rise) if rise * slope > 0.0 else (math.inf, 0.0)
        if missed > 1.0:
            bracket.cut(m, above=excess * slope < 0.0)
        place = bracket.place(wanted, missed > max(0.5 * earlier[-2], 1.0))
        if missed <= 1.0:  # the signs that bound it are rounding
            place = wanted if low < wanted[0] < high else m
        earlier.append(missed)
        if place == m or earlier[-2] <= 1.0:  # after one more step, if there is one
            break
        m = place
    if not (ROUNDINGS * size < k.I1 and rounding < abs(rise) * r):
        return None  # nothing but rounding carries the load, or determines the centre
    tilt = -k.I0 / math.pi
    k = k._replace(I0=0.0, C2=k.C2 - 0.5 * k.I0)
    return replace(search.finished(Found(contact, integrals=k), None, tilt), moment=moment)


def _excess_of_moment(
    search: Search, r: float, target: float, m: Place
) -> tuple[float, float, Interval, EdgeIntegrals]:
    """The excess of M/(G r) over its target at the centre m, its derivative, and the contact."""
    contact = interval_about(m[0], r).moved(m[1], m[1])
    # Far from x = 0 the slope is nearly constant, which carries nothing.
    level, slope = search.slope.less_level(m[0], NEAR_CENTRE * r)
    k, centre = replace(search, slope=slope).integrals(contact), contact.m
    search.evaluations += 1
    excess = centre * k.I1 - r * (k.C2 - 0.5 * k.I0) - target
    k = k._replace(I0=k.I0 + math.pi * level, C2=k.C2 + 0.5 * math.pi * level)
    return excess, 0.25 * r * (k.JR + k.JL) + 0.5 * centre * (k.JR - k.JL), contact, k


def _first_change(
    at: Callable[[float], tuple[float, float, Interval, EdgeIntegrals]],
    centre: float,
    bounds: tuple[float, float],
    r: float,
) -> Bracket | None:
    """Two places between which the excess changes its sign under load.

    They are found by growing steps to both sides.
    """
    last = {side: (centre, *at(centre)) for side in (-1.0, 1.0)}
    step = FIRST_STEP * r
    while last:
        for side in [*last]:
            place, excess, _, _, before = last[side]
            new = min(max(centre + side * step, bounds[0]), bounds[1])
            if new == place:
                del last[side]
                continue
            last[side] = new, *at(new)
            loaded = _pressing(before), _pressing(last[side][4])
            if excess * last[side][1] <= 0.0 and max(loaded) > 0.0 <= min(loaded):
                return Bracket((min(place, new), 0.0), (max(place, new), 0.0), (True, True))
        step *= GROWTH
    return None


def _pressing(k: EdgeIntegrals) -> float:
    """I1, the load over G r, if it is more than rounding."""
    return k.I1 if abs(k.I1) > ROUNDINGS * (k.size1 + k.size2) else 0.0
