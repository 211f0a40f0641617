"""The state that solved equations leave, and whether it may be: |q| <= f p, slip in its direction.

The equations have roots that are no states: what is admissible is the answer (`equations`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.chord import Chord
from sie.numerics.graded_panels import (
    OF_SERIES,
    Pieces,
    Rule,
)

from .equations import Equations
from .state import SAME, Ends, State, intervals, united

Array = NDArray[np.float64]
EXCEEDED = 1e-8  # of the largest f p: by so much |q| may exceed f p
KNOWN = 1e-10  # of the contact: next to marks q is known from there on
OPPOSING = 1e-10  # of the largest slip: by so much it may oppose its direction


def built(found: Equations) -> State:
    """The state of solved equations."""
    before, after = found.before, found.after
    same = SAME * after.width
    marks = np.unique(np.concatenate((before.marks, after.limit.marks, found.begins)))
    parts, values = [], []
    for lo, hi, s in found.slip:
        parts.append(Pieces.places(intervals([(lo, hi)], after.limit.marks, same)))
        values.append(s * after.limit.on(parts[-1]))
    for k, zone in enumerate(found.zones.stick):
        part = Pieces.places(intervals([zone], marks, same))
        near = np.minimum(part.from_lo, part.from_hi) <= KNOWN * after.width
        limit = np.where(near, after.limit.on(part), np.inf)
        q = before.shear.on(part) + found.in_stick(k, part)
        parts.append(part)
        values.append(np.minimum(np.maximum(q, -limit), limit))
    ends = np.concatenate([part.ends for part in parts])
    order, series = np.argsort(ends[:, 0]), Pieces.of_values(ends, np.concatenate(values))
    return State(after, found.zones.stick, found.slip, Pieces(ends[order], series[order]))


# -- whether it is the answer ----------------------------------------------------------------------


def refuse_inadmissible(found: Equations, state: State) -> None:
    """Raise ContactError where |q| > f p in stick, or slip opposes its direction."""
    excess = excess_in_stick(state)
    if excess > EXCEEDED:
        raise ContactError(f"|q| exceeds f p in stick by {excess:.1e} of its peak")
    opposing = opposing_slip(found.before, state, state.stick)
    if opposing > OPPOSING:
        raise ContactError(f"slip opposes its direction by {opposing:.1e} of the largest")


def excess_in_stick(state: State) -> float:
    """The largest |q| - f p in the stick zones over the peak of f p.

    Next to a mark |q| falls from f p like a root of the distance, and marks are rounded.
    """
    contact = state.contact
    ends = intervals(state.stick, state.marks, SAME * contact.width)
    places = Pieces.places(ends)
    known = np.minimum(places.from_lo, places.from_hi) > KNOWN * contact.width
    beyond = np.abs(state.shear.on(places)) - contact.limit.on(places)
    return float(beyond[known].max(initial=-1.0)) / contact.peak


PLACES = (1e-3, 0.1, 0.5, 0.9)  # shares of a part of a slip zone where slip is tested


def opposing_slip(before: State, state: State, stuck: Ends) -> float:
    """The largest slip against its direction over the largest slip.

    `stuck` are zones that stuck from one state to the other.
    """
    old, new = before.contact, state.contact
    same = SAME * new.width
    chord = Chord(new.period)
    marks = np.unique(np.concatenate((before.marks, state.marks)))
    tested, signs, nearest = [], [], []
    stick = np.array(stuck).ravel()
    for lo, hi, s in state.slip:
        cuts = np.append(intervals([(lo, hi)], marks, same), [])
        for a, b in cuts.reshape(-1, 2):
            places = [a + share * (b - a) for share in PLACES] + [a, b]
            tested += places
            signs += [s] * len(places)
            nearest += [stick[np.abs(stick - y).argmin()] for y in places]
    x, c, senses = np.array(tested), np.array(nearest), np.array(signs)
    inner = x[~np.isin(x, stick)]
    cuts = np.unique(np.concatenate((marks, inner)))
    touched = united(old.patches, new.patches)
    rule = Rule.graded(intervals(touched, cuts, same), OF_SERIES)
    change = rule.weight * (state.shear.on(rule) - before.shear.on(rule))
    slip = np.zeros(len(x))
    for j, (y, e) in enumerate(zip(x, c, strict=True)):
        if y != e:
            to_y, to_e = rule.apart_from(y), rule.apart_from(e)
            with np.errstate(divide="ignore"):
                log = chord.logarithm(to_y) - chord.logarithm(to_e)
            slip[j] = change @ np.where(np.isfinite(log), log, 0.0) / np.pi
            slip[j] -= (new.tau - old.tau) * (y - e)
    largest = float(np.abs(slip).max(initial=0.0))
    return float((-senses * slip).max(initial=0.0)) / largest if largest else 0.0


# -- how well states satisfy the equation ----------------------------------------------------------

MEASURED = np.sin(0.5 * np.pi * (np.arange(8) + 0.5) / 8) ** 2  # shares of a stick zone


def change_of_shear(before: State, state: State, stuck: Ends) -> float:
    """The largest |1/π PV∫ Δq/(x - t) dt - Δτ| at places that stuck from one state to another."""
    old, new = before.contact, state.contact
    chord, same = Chord(new.period), SAME * new.width
    x = np.array([lo + (hi - lo) * share for lo, hi in stuck for share in MEASURED])
    cuts = np.unique(np.concatenate((before.marks, state.marks, x)))
    zones = united(old.patches, new.patches)
    rule = Rule.graded(intervals(zones, cuts, same), OF_SERIES)
    change = state.shear.on(rule) - before.shear.on(rule)
    missed = 0.0
    for y in x[np.isin(x, rule.ends)]:
        here = float(state.shear(np.array([y]))[0] - before.shear(np.array([y]))[0])
        lo, hi = next(zone for zone in zones if zone[0] < y < zone[1])
        own = (rule.lo >= lo) & (rule.hi <= hi)
        apart = -rule.apart_from(y)
        kernel = chord.cosine(apart) / chord(apart)
        total = rule.weight @ ((change - np.where(own, here, 0.0)) * kernel)
        total += here * float(chord.logarithm(y - lo) - chord.logarithm(hi - y))
        missed = max(missed, abs(float(total) / np.pi - (new.tau - old.tau)))
    return missed
