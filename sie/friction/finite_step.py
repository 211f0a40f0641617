"""The state at the end of a step in which stick zones only shrink: the equations solved.

Newton's method finds the ends from a guess. Where loads come back to what they were, ends lie on
marks of the shear, which are tried.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.zones import left_over

from .equations import Equations
from .state import SAME, Contact, Ends, State, Zones, overlaps, refuse_inadmissible

if TYPE_CHECKING:
    from .onset import End
    from .strips import Panel

Array = NDArray[np.float64]
STEPS = 40  # of Newton's method
PINNED_STEPS = 8  # of it with one end on a mark
SLOW, FAR = 14, 1e-2  # after so many one that is so long, of the contact, finds nothing
SETTLED = 2e-14  # of the contact: a step so short is the last
GOOD = 1e-9  # and one so short is good enough if later ones do not shorten ...
GOOD_OF_ZONE = 1e-3  # ... and it is so short a part of the narrowest stick zone
INSIDE = 1e-9  # of what is between the bounds of an end: a guess is as far from them
CLOSEST = 0.9  # of the distance to its neighbour: an end moves so far at most in a step
SHARES = (1.0, 0.5, 0.25, 0.1)  # of a step of Newton's method that are tried
JUST_INSIDE = 1e-3  # of a stick zone: so far inside a mark an end is tried
FLAT, AMONG_ALL = 1e-4, 1e-3  # charge of an end, of what is released: moving it changes nothing
NOTHING = 1e-8  # of the largest f p: nothing is released
CLOSE = 1e-7  # of the contact: so close to a mark an end may be on it
ON_MARK, ON_MARK_AT_LEAST = 1e-13, 3e-10  # of the loads: by so much equations may be missed there
NARROWEST = 1e-12  # of the contact: a stick zone


@dataclass(frozen=True, eq=False)
class Part:
    """A part of a step: its end, and its shares of the step.

    equations      those that the state at its end solves
    state          that state
    begun, until   shares of the step
    panel          the moments of a part on which something came to stick; None: a finite step
    known          what ends of stick zones do next, by their places, where an event decided it
    opened         place and direction of slip that begins in stick
    longest        the next part may be so long, of the step
    """

    equations: Equations
    state: State
    begun: float
    until: float
    panel: Panel | None = None
    known: Mapping[float, End] = field(default_factory=dict)
    opened: tuple[float, float] | None = None
    longest: float = 1.0

    @property
    def before(self) -> State:
        """The state at the start."""
        return self.equations.before

    @property
    def stuck(self) -> Ends:
        """What stuck all along."""
        stick = self.state.stick
        return stick if self.panel is None else overlaps(self.before.stick, stick)


def solved(before: State, after: Contact, guess: Zones) -> Equations:
    """The equations at the end, whose zones Newton's method finds from a guess.

    Raises ContactError where it finds none, or one that is not admissible.
    """
    found = Equations(before, after, guess)
    if guess.signs and not balanced(found, ON_MARK_AT_LEAST):
        found = newton(before, after, guess)
    try:
        refuse_inadmissible(before, found.state, found.state.stick)
    except ContactError:
        found = on_marks(found, ON_MARK_AT_LEAST)  # the history is known to so much
        refuse_inadmissible(before, found.state, found.state.stick)
    return found


def newton(before: State, after: Contact, guess: Zones) -> Equations:
    """The equations with the zones that solve them."""
    if not guess.stick:
        raise ContactError("the bodies slide as a whole")
    shrinking, anywhere = (_bounds(before, after, guess, on) for on in (True, False))
    found = _within_bounds(before, after, guess, shrinking)
    if found is None and (anywhere != shrinking).any():
        found = _within_bounds(before, after, guess, anywhere)
    if found is None:
        raise ContactError("no stick zones inside the contact balance the loads")
    return found


def _within_bounds(before: State, after: Contact, guess: Zones, bounds: Array) -> Equations | None:
    """The equations with the zones that solve them, each end between two bounds."""
    ends = np.array(guess.stick).ravel()
    room = INSIDE * (bounds[:, 1] - bounds[:, 0])
    ends = np.clip(ends, bounds[:, 0] + room, bounds[:, 1] - room)
    if not (np.diff(ends) > 0.0).all():
        return None
    stick = tuple((float(a), float(b)) for a, b in ends.reshape(-1, 2))
    now = Equations(before, after, Zones(stick, guess.signs), rough=True)
    found, settled = _iterated(now, bounds)
    for outward in (False, True):
        if settled:
            break
        now = _beyond_flat(found, outward)
        if now is not found:
            found, settled = _iterated(now, bounds)
    return replace(on_marks(found, ON_MARK), rough=False) if settled else None


def _iterated(now: Equations, bounds: Array) -> tuple[Equations, bool]:
    """The equations after Newton's method, and whether they are solved.

    It ends where an end moves nothing: a derivative there says nothing.
    """
    last, width = math.inf, now.after.width
    for number in range(STEPS):
        if _flat(now).any():
            return now, balanced(now, ON_MARK)
        with np.errstate(all="ignore"):
            scale = np.abs(now.derivatives).max(axis=1)
            matrix, right = now.derivatives / scale[:, None], -now.residual / scale
        if not (np.isfinite(matrix).all() and np.isfinite(right).all()):
            break
        step = np.linalg.lstsq(matrix, right, rcond=1e-14)[0]
        longest = float(np.abs(step).max())
        good = min(GOOD * width, GOOD_OF_ZONE * float(np.diff(now.stick, axis=1).min()))
        if longest <= SETTLED * width or last <= longest <= good:
            return now, True
        if number >= SLOW and longest > FAR * width:
            break
        last = longest
        for share in SHARES:
            moved = _moved(now, share * step, bounds)
            if (np.diff(moved) < NARROWEST * width).any():
                return now, False
            trial = _with_ends(now, moved)
            left = np.linalg.lstsq(matrix, -trial.residual / scale, rcond=1e-14)[0]
            if _flat(trial).any() and not balanced(trial, ON_MARK):
                continue
            if np.abs(left).max() <= (1.0 - 0.25 * share) * longest:
                break
        now = trial
    return now, False


def _beyond_flat(now: Equations, outward: bool) -> Equations:
    """The same with ends that move nothing put beyond the next mark of the shear.

    Between the marks all that slips has slipped before.
    """
    ends, marks = now.stick.ravel().copy(), now.before.marks
    for j in np.flatnonzero(_flat(now)):
        other = ends[j - 1] if j % 2 else ends[j + 1]
        upwards = (j % 2 == 1) == outward
        beyond = marks[marks > ends[j]] if upwards else marks[marks < ends[j]][::-1]
        if beyond.size and (beyond[0] - other) * (ends[j] - other) > 0.0:
            away = beyond[1] - beyond[0] if outward and beyond.size > 1 else other - beyond[0]
            ends[j] = beyond[0] + JUST_INSIDE * away
    return now if (ends == now.stick.ravel()).all() else _with_ends(now, ends)


def _flat(now: Equations) -> NDArray[np.bool_]:
    """Which ends can be moved without a change of anything.

    Their charge is compared with what is released beside them; with all that is, where nothing is.
    """
    rule, peak, width = now.rule, now.after.peak, now.after.width
    whole = float(np.abs(now.change).max(initial=0.0))
    found = np.zeros(now.stick.size, dtype=bool)
    for j, (e, kappa) in enumerate(zip(now.stick.ravel(), now.charge_of_ends, strict=True)):
        beside = (rule.hi == e) if j % 2 == 0 else (rule.lo == e)
        if beside.any():
            length = float((rule.hi - rule.lo)[beside][0])
            released = float(np.abs(now.change[beside]).max())
            if released > NOTHING * peak:
                found[j] = abs(kappa) * (length * width) ** 0.5 <= FLAT * released
            else:
                found[j] = abs(kappa) * width <= AMONG_ALL * whole
    return found


def on_marks(found: Equations, missed: float) -> Equations:
    """The same with ends on marks of the shear at the start, where that solves the equations too.

    Where loads come back to what they were, no end between two marks is better than another: what
    did not slip in the step is taken. `missed`: by how much equations may be missed, of the loads.
    """
    width, marks = found.after.width, found.before.marks
    flat = _flat(found)
    for j in range(len(flat)):
        e = float(found.stick.ravel()[j])
        room = CLOSE * width
        outward = marks[marks >= e - room] if j % 2 else marks[marks <= e + room][::-1]
        if not (flat[j] or (outward.size and abs(outward[0] - e) <= room)):
            continue
        for mark in outward:
            ends = found.stick.ravel().copy()
            ends[j] = mark
            moved = _with_ends(found, ends) if (np.diff(ends) > 0.0).all() else None
            if moved is None or not balanced(moved, missed):
                break
            found = moved
    return found


def on_earlier_zones(before: State, after: Contact, guess: Zones) -> Iterator[Equations]:
    """Equations that are solved with one end of the stick zone on a mark, inner marks first.

    Where loads come back to what they were, all that lies between two marks has come back too: any
    end between them solves the equations, and Newton's method finds none.
    """
    if len(guess.stick) != 1:
        return
    for j in (0, 1):
        other = 1 - j
        marks = before.marks if j else before.marks[::-1]
        for mark in marks:
            ends = np.array(guess.stick[0])
            ends[j] = mark
            now = Equations(before, after, guess, rough=True)
            for _ in range(PINNED_STEPS):
                if not after.patches[0][0] < ends[0] < ends[1] < after.patches[-1][1]:
                    break
                now = _with_ends(now, ends)
                if balanced(now, ON_MARK_AT_LEAST):
                    yield replace(now, rough=False)
                    break
                slope = now.derivatives[:, other]
                ends = ends.copy()
                ends[other] -= float(slope @ now.residual / (slope @ slope))


def _with_ends(found: Equations, ends: Array) -> Equations:
    stick = tuple((float(a), float(b)) for a, b in ends.reshape(-1, 2))
    return replace(found, zones=Zones(stick, found.zones.signs))


def balanced(found: Equations, missed: float) -> bool:
    """Whether zones solve the equations."""
    try:
        stress = np.abs(found.charges).sum(axis=1).max() + found.after.peak
        size = np.full(found.residual.shape, stress * found.after.width + abs(found.after.Q))
        size[: len(found.stick)] = stress
        return bool((np.abs(found.residual) <= missed * size).all())
    except ContactError:  # a zone of slip that has vanished
        return False


def _moved(now: Equations, step: Array, bounds: Array) -> Array:
    """The ends after a step of Newton's method, which keeps zones apart and inside their bounds."""
    ends = now.stick.ravel()
    out = ends.copy()
    for j, (e, move) in enumerate(zip(ends, step, strict=True)):
        lo, hi = bounds[j]
        if j:
            lo = max(lo, 0.5 * (ends[j - 1] + e))
        if j + 1 < len(ends):
            hi = min(hi, 0.5 * (ends[j + 1] + e))
        room = CLOSEST * ((hi - e) if move > 0.0 else (e - lo))
        out[j] = e + math.copysign(min(abs(move), max(room, 0.0)), move)
    return out


def _bounds(before: State, after: Contact, zones: Zones, goes_on: bool) -> Array:
    """The places between which each end lies.

    They lie in the patches at the start and at the end. Where slip goes on beside an earlier stick
    zone, in the direction that it had there, that zone only shrinks; it may also have stopped at
    once, and begun again at a retreating edge.
    """
    ends = np.array(zones.stick).ravel()
    out = np.empty((len(ends), 2))
    beside, old = left_over(after.patches, zones.stick), {e for zone in before.stick for e in zone}
    for j, e in enumerate(ends):
        inside = []
        for patches in (before.contact.patches, after.patches):
            inside.append(next((p for p in patches if p[0] <= e <= p[1]), (e, e)))
        lo, hi = max(a for a, _ in inside), min(b for _, b in inside)
        sign = {zone[j % 2 == 0]: s for zone, s in zip(beside, zones.signs, strict=False)}.get(e)
        for a, b, s in before.slip if goes_on else ():
            if (b if j % 2 == 0 else a) not in old:
                continue
            if s == sign and a - after.width * SAME <= e <= b + after.width * SAME:
                lo, hi = (max(lo, b), hi) if j % 2 == 0 else (lo, min(hi, a))
        out[j] = lo, hi
    return out
