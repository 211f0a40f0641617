"""A step of a load path, part by part: which states it passes through.

A part is a finite step where stick zones only shrink (`finite_step`): on the way every place slips
in one direction only. That is tested at some shares of it, by the rates, which depend on the zones
alone. An end that recedes no longer, and slip that turns, end a part.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.root_finding import false_position

from .cells import zones_on_cells
from .equations import Equations
from .finite_step import Part, balanced, newton, on_earlier_zones, solved
from .loading import LoadStep
from .onset import End, Motion, Onset, onset, set_out
from .rates import Rates
from .state import EXCEEDED, TURNS, Contact, State, Zones
from .strip_part import strip_part, with_receding_ends

Array = NDArray[np.float64]

ADVANCES, TURNED = "an end of a stick zone advances", "slip turns"
EXCESS = "|q| exceeds f p in stick"
STUCK = 1e-11  # of the loads: by so much equations may be missed where all sticks
SHARES = (np.arange(1, 9) / 8.0) ** 1.5  # of a part at which it is tested
SCALES = (1.0, 1e-2, 1e-3, 1e-4, 4e-6)  # of all of them, one after the other where they fail
SEEN = 1e-2  # of the contact: ends that move less are not seen well on cells
STOPS = -1e-7  # of the largest K: an end that recedes so little goes on
MOST_PARTS, SHORT, MOST_SHORT = 30, 1e-4, 5  # of a step; of them so short ones of it
MOST_MOMENTS = 400  # of a step at which states are asked for: some 20 seconds
FINE = 1e-2  # of a part: so well it is known where it ends, if by no event
STILL, STOPPED = 1e-13, 1e-8  # of the largest K


def course(before: State, step: LoadStep) -> tuple[Part, ...]:
    """The parts of a step from a state. Raises ContactError where one is not found."""
    parts: list[Part] = []
    done, state = 0.0, before
    while done < 1.0:
        with np.errstate(all="ignore"):  # what that leaves is not admissible
            part = _next_part(state, step, done, parts[-1] if parts else None)
        parts.append(part)
        state, done = part.state, part.until
        short = sum(part.until - part.begun < SHORT for part in parts)
        tried = len(step.known) > MOST_MOMENTS and done < 1.0
        if len(parts) > MOST_PARTS or short > MOST_SHORT or tried:
            raise _lost(done, f"{len(parts)} parts, {short} of them short")
    return tuple(parts)


def _next_part(state: State, step: LoadStep, begun: float, last: Part | None) -> Part:
    """The part from a share on.

    A finite step is tried first at the start of a step, unless something sticks anew there.
    """
    known, opened = (last.known, last.opened) if last else ({}, None)
    zones = onset(state, step.rates, step.friction, known)
    if opened:
        zones = zones.split(*opened)
    candidates = _candidates(state, step, begun, zones, last)
    likely = next(candidates)
    finite_first = begun == 0.0 and not likely.sticks_anew
    first = [None, likely] if finite_first else [likely, None]  # None: a finite step
    problems = []
    for now in chain(first, candidates):
        try:
            if now is None:
                return _without_what_slipped(finite_part(state, step, begun), likely)
            if now.sticks_anew:
                return strip_part(state, step, begun, now, last)
        except ContactError as problem:
            problems.append(str(problem))
    raise _lost(begun, "; ".join(problems))


def _candidates(
    state: State, step: LoadStep, begun: float, zones: Onset, last: Part | None
) -> Iterator[Onset]:
    """The zones of a part, the likely ones first.

    Ends that leap to where K = 0 may recede at once, as they mostly do where a stick zone is new;
    slip that begins at an edge may be left behind by it.
    """
    new = len(zones.zones) > len(state.stick) > 0
    if not new:
        yield zones
    receding = with_receding_ends(state, step, begun, zones, last)
    if new or receding != zones:
        yield receding
    if new and receding != zones:
        yield zones
    for j, end in enumerate(zones.ends):
        if end.motion is Motion.RECEDES and end.place in np.ravel(state.contact.patches):
            yield zones.moved(j, replace(end, motion=Motion.ADVANCES))


def _without_what_slipped(part: Part, zones: Onset) -> Part:
    """A finite part, if nothing sticks at its end that an advancing end passes.

    That slips until it sticks: in a finite part what sticks has stuck all along.
    """
    room = 1e-9 * part.state.contact.width
    for end in zones.ends:
        if end.motion is Motion.ADVANCES and any(
            a < end.place - room and end.place + room < b for a, b in part.state.stick
        ):
            raise ContactError(ADVANCES)
    return part


def _lost(share: float, reason: str) -> ContactError:
    """The refusal of a step that is followed up to a share of it only."""
    return ContactError(
        f"stick and slip are followed for {100.0 * share:.4g} % of the step only: there slip "
        "starts or stops next to where it has before; move this point of the path a little, or end "
        "the path before it",
        share=share,
        reason=reason,
    )


@dataclass(frozen=True)
class Verdict:
    """Whether zones at a share of a step pass; the equations, s K at their ends, and why not."""

    share: float
    equations: Equations | None
    margins: Array
    why: str = ""

    @property
    def solution(self) -> Equations:
        """The equations, where there are some."""
        assert self.equations is not None
        return self.equations


def finite_part(state: State, step: LoadStep, begun: float) -> Part:
    """A finite step from a share on, as long as it passes the tests."""
    if not (step.rates.Q or step.rates.tau or np.any(state.shear.series)):
        after = step.at(1.0)
        held = Equations(state, after, Zones(after.patches, ()))
        return Part(held, State.untouched(after), begun, 1.0)
    for scale in SCALES:
        shares = 1.0 - (1.0 - begun) * (1.0 - scale * SHARES)
        verdicts = _tested(state, step, begun, shares)
        good = _leading(verdicts)
        if good == len(shares) and shares[-1] == 1.0:
            with suppress(ContactError):
                ended = solved(state, step.at(1.0), verdicts[-1].solution.zones)
                return Part(ended, ended.state, begun, 1.0)
            good -= 1
        if good:
            break
    else:
        raise ContactError(verdicts[0].why)
    found, until = verdicts[good - 1], float(shares[-1])
    if good < len(shares):
        until = _end_of_part(state, step, found, verdicts[good])
    now = _verdict(state, step, until, found.solution.zones)
    found = found if now.equations is None else now
    ended = solved(state, step.at(found.share), found.solution.zones)
    return Part(ended, ended.state, begun, found.share, known=_stopped(found))


def _stopped(verdict: Verdict) -> dict[float, End]:
    """The ends with K = 0, which advance next."""
    equations = verdict.solution
    left = {lo: s for lo, _, s in equations.slip}
    right = {hi: s for _, hi, s in equations.slip}
    found: dict[float, End] = {}
    if not verdict.margins.size:  # all of the contact sticks
        return found
    for j, (e, margin) in enumerate(zip(equations.stick.ravel(), verdict.margins, strict=True)):
        place = float(e)
        sense = left.get(place) if j % 2 else right.get(place)
        if sense is not None and abs(margin) <= STOPPED:
            found[place] = End(place, sense, Motion.ADVANCES)
    return found


def _leading(verdicts: list[Verdict]) -> int:
    """How many pass, one after the other, with zones that shrink.

    One where no zones are found counts if later ones pass: zones open and join on the way.
    """
    passed, last = 0, None
    for k, now in enumerate(verdicts):
        if not now.why and (last is None or _within(now, last)):
            passed, last = k + 1, now
        elif not now.why or now.why in (ADVANCES, TURNED):  # a finite step does not go on
            break
    return passed


def _within(now: Verdict, last: Verdict) -> bool:
    """Whether zones lie in those before."""
    room = 1e-9 * now.solution.after.width
    return all(
        any(lo - room <= a and b <= hi + room for lo, hi in last.solution.zones.stick)
        for a, b in now.solution.zones.stick
    )


def _tested(state: State, step: LoadStep, begun: float, shares: Array) -> list[Verdict]:
    """The verdicts on zones at some shares, found from the last to the first.

    Where an end advances at the last one and at the first one, that at the first is enough.
    """
    last = _continued(
        state, step, float(shares[-1]), _as_they_set_out(state, step, float(shares[-1] - begun))
    )
    if last.why:
        for share in shares[[0, len(shares) // 2]].tolist():
            early = _continued(state, step, share, last.equations.zones if last.equations else None)
            if not early.why:
                break
            if early.why == last.why == ADVANCES:
                return [early]
        else:
            return [early]
    found = [last]
    for share in shares[-2::-1]:
        equations = found[-1].equations
        guess = equations.zones if equations is not None else None
        found.append(_continued(state, step, float(share), guess))
    return found[::-1]


def _continued(state: State, step: LoadStep, share: float, guess: Zones | None) -> Verdict:
    """The verdict from a guess; from cells where it fails for another reason than an end's way."""
    verdict = _verdict(state, step, share, guess)
    if verdict.why and verdict.why != ADVANCES and guess is not None:
        verdict = _verdict(state, step, share, None)
    return verdict


def _as_they_set_out(state: State, step: LoadStep, length: float) -> Zones | None:
    """The zones after a part so short that no cell shows it; None after a longer one."""
    zones = onset(state, step.rates, step.friction)
    moved = length * set_out(state, zones, step.rates, step.friction)
    ends = np.array(zones.stick).ravel() + moved
    if zones.sticks_anew or not 0.0 < np.abs(moved).max() <= SEEN * state.contact.width:
        return None
    return Zones(tuple((float(a), float(b)) for a, b in ends.reshape(-1, 2)), zones.signs.signs)


def _verdict(state: State, step: LoadStep, share: float, guess: Zones | None) -> Verdict:
    """Zones at a share, and whether they go on as they have to."""
    after = step.at(share)
    held = Equations(state, after, Zones(after.patches, ()))
    if balanced(held, STUCK):
        return Verdict(share, held, np.zeros(0), "" if held.excess <= EXCEEDED else EXCESS)
    try:
        guesses = (guess,) if guess is not None else zones_on_cells(state, after)
    except ContactError as problem:
        return Verdict(share, None, np.zeros(0), str(problem))
    first = None
    for zones in guesses:
        try:
            found = newton(state, after, clipped(zones, state.contact, after))
        except ContactError as problem:
            now = Verdict(share, None, np.zeros(0), str(problem))
        else:
            now = _judged(found, step, share)
        if not now.why:
            return now
        first = first or now
    if share == 1.0:  # a point of the path, at which loads may come back to what they were
        for zones in guesses:
            for found in on_earlier_zones(state, after, zones):
                now = _judged(found, step, share)
                if not now.why:
                    return now
    assert first is not None
    return first


def _judged(found: Equations, step: LoadStep, share: float) -> Verdict:
    """The verdict on zones by the rates."""
    rates = Rates.where(found, step.rates, step.friction)
    margins = rates.signed_K.ravel() / max(np.abs(rates.K).max(), 1e-300)
    why = ""
    if not (margins >= STOPS).all():
        why = ADVANCES
    elif rates.turning < TURNS:
        why = TURNED
    elif found.excess > EXCEEDED:
        why = EXCESS
    return Verdict(share, found, margins, why)


def clipped(zones: Zones, old: Contact, new: Contact) -> Zones:
    """Zones inside the patches, at the start and at the end."""
    out = []
    for a, b in zones.stick:
        lo, hi = a, b
        for patches in (old.patches, new.patches):
            x1, x2 = max(patches, key=lambda p: min(p[1], b) - max(p[0], a))
            room = 1e-4 * (x2 - x1)
            lo, hi = max(lo, x1 + room), min(hi, x2 - room)
        if lo >= hi:
            raise ContactError("a stick zone lies outside the contact")
        out.append((lo, hi))
    return Zones(tuple(out), zones.signs)


def _end_of_part(state: State, step: LoadStep, good: Verdict, bad: Verdict) -> float:
    """The share at which a part ends that passes at one share and fails at another."""
    while bad.share - good.share > FINE * bad.share:
        with suppress(ContactError):
            return _stop(state, step, good, bad)
        middle = 0.5 * (good.share + bad.share)
        now = _verdict(state, step, middle, good.solution.zones)
        if now.why or not _within(now, good):
            bad = now
        else:
            good = now
    return good.share


def _stop(state: State, step: LoadStep, good: Verdict, bad: Verdict) -> float:
    """The share at which an end recedes no longer. Raises ContactError where that is not known."""
    alike = bad.equations is not None and bad.solution.zones.signs == good.solution.zones.signs
    alike = alike and len(bad.margins) == len(good.margins) > 0
    k = int(bad.margins.argmin()) if alike else -1
    if k < 0 or not bad.margins[k] < 0.0 < good.margins[k]:
        raise ContactError("no end of a stick zone stops")

    def rate(share: float) -> float:
        found = _verdict(state, step, share, good.solution.zones)
        if len(found.margins) != len(good.margins):
            raise ContactError(found.why)
        return float(found.margins[k])

    def settled(lo: float, hi: float, value: float) -> bool:
        return hi - lo < 1e-13 or abs(value) < STILL

    ends = float(good.margins[k]), float(bad.margins[k])
    return float(false_position(rate, good.share, bad.share, ends, settled))
