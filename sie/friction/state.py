"""A state of stick and slip: contact, zones, the shear that is locked in; whether it may be."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.chord import Chord
from sie.numerics.graded_panels import OF_SERIES, Pieces, Rule
from sie.numerics.zones import Slips, united

Array = NDArray[np.float64]
Ends = tuple[tuple[float, float], ...]

SAME = 1e-11  # of the contact: marks that are closer are one
ALIKE = 1e-12  # of f P: shears that differ by less are one
KNOWN = 1e-10  # of the contact: next to marks q is known from there on
EXCEEDED = 1e-8  # of the largest f p: by so much |q| may exceed f p
OPPOSING = 1e-10  # of the largest slip: by so much it may oppose its direction
TURNS = -1e-7  # of the largest rate of slip: by so much it may oppose its direction


@dataclass(frozen=True, eq=False)
class Contact:
    """The contact under the loads at one moment.

    patches   ((x1, x2), ...), ascending; of a periodic contact those of one period
    limit     f p, a stress
    Q         the tangential load, force per length
    tau       a quarter of the bulk stress
    period    inf on the line
    """

    patches: Ends
    limit: Pieces
    Q: float
    tau: float
    period: float = np.inf

    @property
    def width(self) -> float:
        """From the first edge to the last one."""
        return self.patches[-1][1] - self.patches[0][0]

    @cached_property
    def peak(self) -> float:
        """The largest f p, about."""
        x = np.concatenate([np.linspace(a, b, 34)[1:-1] for a, b in self.patches])
        return float(self.limit(x).max())


@dataclass(frozen=True)
class Zones:
    """Stick zones, and the direction of slip on each part of the patches beside them."""

    stick: Ends
    signs: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class State:
    """Zones of stick and slip, and q.

    contact   the contact
    stick     the stick zones, ascending over all patches
    slip      the rest of the contact as (lo, hi, s), q = s f p; ascending
    shear     q, a stress; its marks are those of the state
    """

    contact: Contact
    stick: Ends
    slip: Slips
    shear: Pieces = field(repr=False)

    @property
    def marks(self) -> Array:
        """Where q is not smooth: edges, ends of zones now and before, corners of the profile."""
        return self.shear.marks

    @classmethod
    def untouched(cls, contact: Contact) -> State:
        """The state before anything was sheared: all sticks."""
        ends = intervals(contact.patches, contact.limit.marks, SAME * contact.width)
        return cls(contact, contact.patches, (), Pieces.fitted(ends, lambda rule: 0.0 * rule.lo))


def intervals(zones: Iterable[tuple[float, float]], marks: Array, same: float) -> Array:
    """Zones cut at the marks inside them, (n, 2)."""
    found = []
    for lo, hi in zones:
        inside = marks[(marks > lo + same) & (marks < hi - same)]
        kept = inside[np.diff(inside, prepend=-np.inf) > same]
        cuts = np.concatenate(([lo], kept, [hi]))
        found.append(np.stack((cuts[:-1], cuts[1:]), axis=1))
    return np.concatenate(found) if found else np.zeros((0, 2))


def overlaps(first: Ends, second: Ends) -> Ends:
    """The zones that lie in one zone of each of two sets."""
    pairs = ((max(a, c), min(b, d)) for a, b in first for c, d in second)
    return tuple((lo, hi) for lo, hi in pairs if lo < hi)


def alike(one: State, other: State) -> bool:
    """Whether two states of one contact have the same shear."""
    contact = one.contact
    marks = np.unique(np.concatenate((one.marks, other.marks)))
    rule = Rule.graded(intervals(contact.patches, marks, SAME * contact.width), OF_SERIES)
    apart = float(rule.weight @ np.abs(one.shear.on(rule) - other.shear.on(rule)))
    return apart <= ALIKE * float(rule.weight @ contact.limit.on(rule))


# -- whether a state is the answer -----------------------------------------------------------------


def refuse_inadmissible(before: State, state: State, stuck: Ends) -> None:
    """Raise ContactError where |q| > f p in stick, or slip opposes its direction.

    `stuck`: what stuck all along. The equations have roots that are no states: what is admissible
    is the answer.
    """
    excess = excess_in_stick(state)
    if excess > EXCEEDED:
        raise ContactError(f"|q| exceeds f p in stick by {excess:.1e} of its peak")
    opposing = opposing_slip(before, state, stuck)
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
    touched = united((*old.patches, *new.patches))
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
    zones = united((*old.patches, *new.patches))
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
