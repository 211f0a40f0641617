"""Steps of a load path that no layered memory covers, one state after the other.

The shear changes in closed form whatever strain is locked in, and the state at the end of a step
follows from that at its start (`receding_step`) as long as the ends of the stick zone recede. At
constant pressure they do so with slip s to the left and right where

    s1 (ΔQ + π ρ Δτ) > 0,      s2 (ΔQ - π ρ Δτ) > 0,      ρ the half-width of the stick zone.

An end whose slip has another sign now begins anew at the edge of contact. An end at which the sum
comes to 0 on the way, as ρ shrinks, advances from there on (`advancing_end`), and so does one that
stops while the pressure changes. Then all signs are tried. Where a second zone of slip opens inside
the stick zone, several zones stick (`several_sticks`); where an edge grows and sticks meanwhile, it
has to join the first one soon (`joined_zones`). `trial_step` tests what this rests on;
docs/derivations/marching.md has the equations.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from itertools import product

from sie.errors import ContactError
from sie.friction.loads import Loads
from sie.friction.memory import LoadMemory
from sie.friction.step_conditions import TESTED
from sie.numerics.root_finding import false_position
from sie.progress_bar import reported

from .advancing_end import EndAdvances, end_advances
from .growing_contact import Course, LoadChange, SmoothEdges, course
from .growing_edge import EdgeSticks, edge_sticks
from .joined_zones import Joined, joined
from .marched_step import Held, MarchedStep
from .moved_end import MovedEnd
from .receding_equations import NO_ZONE
from .receding_step import Receded
from .several_sticks import NONE, SeveralSticks, in_several_zones
from .slip_onset import Onset, onsets
from .stuck_contact import BothStick, both_stick
from .trial_step import (
    EXCEEDED,
    ISLAND,
    LOCATED,
    TRY,
    TURNS,
    GoesOn,
    Marchable,
    Signs,
    Trial,
    excess,
    narrowed,
)
from .turning_point import TurningPoint

MovedStep = EdgeSticks | BothStick | EndAdvances | Joined
Passed = tuple[MarchedStep, float, Onset | None]

MEETS = "slip stops at one edge of the contact, and the stick zone would meet a second one there"
MOST_PARTS = 200  # of a step
SETTLED = 1e-13  # of the half-width: so well the end of a zone that stops is known
# Parts of a step in which a second zone of slip may have joined the first one, how well that has to
# be known, and how well for a part that is longer than it takes.
SOON, KNOWN, WELL_KNOWN = tuple(5e-7 * 1.25**k for k in range(32)), 1e-8, 1e-9
AT_ONCE = 1e-9  # of a step: slip that begins so soon has begun before
STOPPED = 1e-9  # of it: an end so near to where it would stop does


@reported("step without layers")
def march(contacts: Marchable, held: Held, start: Loads, loads: Loads) -> TurningPoint:
    """The turning point after a step between two loads, from what it starts from.

    Raises ContactError where the step is not covered.
    """
    trial = Trial(contacts, held, start, loads)
    parts = _parts(trial)
    level = LoadMemory(contacts.level(loads))
    return TurningPoint(loads, level, straight=False, marched=parts)


def _parts(trial: Trial) -> tuple[MarchedStep, ...]:
    """The parts of a step, with one stick zone or else with several."""
    if trial.held.gaps:
        return (_in_several_zones(trial),)
    try:
        return at_constant_pressure(trial) if trial.constant else while_pressure_changes(trial)
    except ContactError as problem:
        try:
            return (_in_several_zones(trial),)
        except ContactError as other:
            if NO_ZONE in str(problem) and str(other) != NONE:
                raise ContactError(f"{other}: {TRY}") from None
        raise problem


def _in_several_zones(trial: Trial) -> SeveralSticks:
    found = in_several_zones(trial)
    if trial.constant:
        return found
    return replace(found, change=LoadChange(trial.contacts, trial.start, trial.end))


def at_constant_pressure(trial: Trial) -> tuple[MarchedStep, ...]:
    """The parts of a step: both ends recede until one stops, which then advances.

    When it arrives at the edge of contact, both recede again.
    """
    parts: list[MarchedStep] = []
    start, done = trial.start, 0.0
    while done < 1.0:
        now = parts[-1] if parts else None
        held = now.held if now else trial.held
        trial = replace(trial, held=held, start=start.towards(trial.end, done), begun=done)
        ways = _ways(trial)
        if ways is not None and not isinstance(now, Receded):
            trial = trial.with_signs(*ways)
            share = _stop(trial)
            parts.append(trial.passed(share))
        else:
            part = _travelled(trial)
            share = part.share
            parts.append(part)
        done = 1.0 if share == 1.0 else done + (1.0 - done) * share
        if len(parts) > MOST_PARTS:
            raise ContactError(f"the stick zone stops more than {MOST_PARTS} times at an edge")
    return tuple(parts)


def _travelled(trial: Trial) -> MovedStep:
    """The part of a step in which the stick zone travels, of the width 2 |dQ/(π dτ)|."""
    change = LoadChange(trial.contacts, trial.start, trial.end)
    dQ, dtau = change.rates.Q, change.rates.tau
    direction, rear = math.copysign(1.0, dQ) * math.copysign(1.0, dtau), math.copysign(1.0, dQ)
    signs = (rear, -rear) if direction > 0.0 else (-rear, rear)
    goes_on = trial.held.signs[0] == signs[0], trial.held.signs[1] == signs[1]
    if not goes_on[direction > 0.0]:
        raise trial.refusal(MEETS, 0.0)
    return _moving(trial.with_signs(signs, goes_on), course(change, 0.0), 0.0, direction)


def while_pressure_changes(trial: Trial) -> tuple[MarchedStep, ...]:
    """The parts of a step, each with slip, or none, at each edge until that changes."""
    change = LoadChange(trial.contacts, trial.start, trial.end)
    edges = SmoothEdges(change)
    parts: list[MarchedStep] = []
    ways, share = onsets(trial.held, change, trial.friction), 0.0
    while share < 1.0:
        trial = replace(trial, start=change.loads(share), begun=share)
        part, until, then = _passed(trial, edges, share, ways)
        if then and until - share <= AT_ONCE:
            # The rates say that the edge sticks, but for rounding.
            ways = tuple(then._replace(goes_on=way.goes_on) for way in ways)
        else:
            parts.append(part)
            held = part.held if then else replace(part.held, signs=(0.0, 0.0))
            trial = replace(trial, held=held)
            ways = (then,) if then else onsets(held, change, trial.friction)
        share = until
        if len(parts) > MOST_PARTS:
            raise ContactError(f"slip starts and stops at the edges more than {MOST_PARTS} times")
    return tuple(parts)


def _passed(trial: Trial, edges: SmoothEdges, share: float, ways: Iterable[Onset]) -> Passed:
    """The part of a step from a share on that passes all tests, its end, and what slips then.

    What slips is None where any way is to be tried, as nothing has slipped.
    """
    problems = []
    for way in ways:
        now = trial.with_signs(way.signs, way.goes_on)
        try:
            if all(way.signs) and not way.advances:
                return _receding(now, edges, share)
            part = (
                _joined(now, edges.at(share), way.joins)
                if way.joins
                else _moving(now, edges.at(share), share, way.advances)
            )
            return part, part.share, part.then
        except ContactError as problem:
            told = "share" in problem.reached
            problems.append(problem if told else trial.refusal(str(problem), 0.0))
    raise max(problems, key=lambda problem: float(problem.reached["share"]))


def _receding(trial: Trial, edges: SmoothEdges, share: float) -> Passed:
    """The part of a step in which both ends recede, until one of them does no longer.

    It stops, and then advances; or an edge of contact catches up with it, and slip turns there.
    Where nothing slipped on either side, it begins in any direction.
    """
    part, advances = trial.stop() or (1.0, 0.0)
    if part == 0.0:
        moved = _moving(trial, edges.at(share), share, advances)
        return moved, moved.share, moved.then
    then: Onset | None = Onset(trial.signs, (True, True), advances)
    try:
        passed = trial.passed(part)
    except ContactError:
        closed = None if advances else trial.closed()
        if closed is None:
            raise
        part, vanished = closed
        passed = trial.passed(part)
        then = None if all(vanished) else _turned(trial.signs, vanished)
    until = 1.0 if part == 1.0 else share + part * (1.0 - share)
    return replace(passed, change=edges.change, begun=share, share=until), until, then


def _turned(signs: Signs, vanished: tuple[bool, bool]) -> Onset:
    """Slip that turns on the side where its zone has vanished."""
    left, right = (-s if gone else s for s, gone in zip(signs, vanished, strict=True))
    return Onset((left, right), (not vanished[0], not vanished[1]))


def _moving(trial: Trial, edges: Course, share: float, advances: float) -> MovedStep:
    """The part of a step in which an end advances, an edge grows and sticks, or both do."""
    part: MovedStep
    if advances:
        part = end_advances(trial.held, edges, Onset(trial.signs, trial.goes_on, advances), share)
    elif any(trial.signs):
        goes_on = trial.goes_on[0 if trial.signs[0] else 1]
        part = edge_sticks(trial.held, edges, trial.signs, goes_on, share)
    else:
        part = both_stick(trial.held, edges, share)
    for tested in TESTED if part.share - share > AT_ONCE else ():
        at = share + tested * (part.share - share)
        said = _wrong(part.until(at), part)
        if said:
            _, at = narrowed(lambda at: bool(_wrong(part.until(at), part)), share, at)
            if isinstance(part, EdgeSticks) and said.startswith(ISLAND):
                return replace(part, joins=said).until(max(at - LOCATED, 0.5 * (share + at)))
            raise trial.refusal(said, (at - share) / (1.0 - share))
    if isinstance(part, EdgeSticks) and part.lost and part.share > share:
        return replace(part, joins=part.lost)
    if isinstance(part, MovedEnd) and part.lost:
        raise trial.refusal(part.lost, (part.share - share) / (1.0 - share))
    return part


def _joined(trial: Trial, edges: Course, problem: str) -> MovedStep:
    """The part of a step in which a second zone of slip joins the first one.

    It goes on to the end of the step where that is soon. `problem` is what is told if it does not.
    """
    begun = trial.begun
    left = edges.hi - begun

    def passed(length: float) -> Joined | None:
        with suppress(ContactError):
            part = joined(trial.held, edges, trial.signs, (begun, begun + length))
            if excess(part, part.stick)[1] <= EXCEEDED and part.slips_on:
                return part
        return None

    lengths = *(length for length in SOON if length < left), min(left, SOON[-1])
    first = next(filter(None, map(passed, lengths)), None)
    if first is None or first.error > KNOWN:
        raise trial.refusal(problem, 0.0)
    if left <= SOON[-1]:
        middle, end = passed(0.5 * (first.share - begun + left)), passed(left)
        if middle and end and end.error <= WELL_KNOWN:
            return end
    return first


def _wrong(state: MarchedStep, end: MarchedStep) -> str:
    """What is wrong with a state on the way, "" for nothing."""
    if excess(state, end.stick)[1] > EXCEEDED:
        advances = isinstance(state, EndAdvances)
        meanwhile = "an end of the stick zone advances" if advances else "an edge sticks and grows"
        return f"{ISLAND} while {meanwhile}"
    if isinstance(state, EndAdvances) and not state.slip_goes_on:
        return TURNS
    return ""


def _ways(trial: Trial) -> tuple[Signs, GoesOn] | None:
    """The signs of slip and which ends go on, where both recede; None where one advances."""
    held, (Q, tau) = trial.held, trial.shear(1.0)
    dQ, strain = Q - held.Q, math.pi * (tau - held.tau)
    for left, right in product((True, False), repeat=2):
        goes_on = left, right
        turn = (1.0 - STOPPED) * trial.first(goes_on).r * strain  # an end that stopped goes on
        signs = math.copysign(1.0, dQ + turn), math.copysign(1.0, dQ - turn)
        three = zip(signs, held.signs, goes_on, strict=True)
        if all((new == old) == goes for new, old, goes in three):
            return signs, goes_on
    return None


def _stop(trial: Trial) -> float:
    """The share of the step after which an end of the stick zone stops; 1 if none does."""
    held, (Q, tau) = trial.held, trial.shear(1.0)
    if trial.signs[0] == trial.signs[1] or held.Q == Q:
        return 1.0
    width = abs((Q - held.Q) / (math.pi * (tau - held.tau)))

    def wider(share: float) -> float:
        try:
            return trial.state(share).stick.r - width
        except ContactError:
            return -width

    def settled(low: float, high: float, value: float) -> bool:
        return abs(value) <= SETTLED * width

    last = wider(1.0)
    if last >= 0.0:
        return 1.0
    first = trial.first(trial.goes_on).r - width
    return false_position(wider, 0.0, 1.0, (first, last), settled)
