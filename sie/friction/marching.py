"""Steps of a load path that no layered memory covers, one state after the other.

The shear changes in closed form whatever strain is locked in, and the state at the end of a step
follows from that at its start (`receding_step`) as long as the ends of the stick zone recede. At
constant pressure they do so with slip s to the left and right where

    s1 (ΔQ + π ρ Δτ) > 0,      s2 (ΔQ - π ρ Δτ) > 0,      ρ the half-width of the stick zone.

An end whose slip has another sign now begins anew at the edge of contact. An end at which the sum
comes to 0 on the way, as ρ shrinks, advances from there on (`travelling_zone`). While the pressure
changes all signs are tried. Where a second zone of slip opens inside the stick zone, several zones
stick (`several_sticks`). `trial_step` tests what this rests on; docs/derivations/marching.md has
the equations.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from itertools import product

from sie.errors import ContactError
from sie.numerics.root_finding import false_position

from .marched_step import Held, MarchedStep
from .memory import LoadMemory
from .receding_step import Receded
from .several_sticks import in_several_zones
from .travelling_zone import Travelled, travelled
from .trial_step import EXCEEDED, ISLAND, GoesOn, Marchable, Signs, Trial, excess
from .turning_point import Loads, TurningPoint

MOST_PARTS = 200  # of a step, in which a stick zone travels by ρ
SETTLED = 1e-13  # of the half-width: so well the end of a zone that stops is known
STOPPED = 1e-9  # of it: an end so near to where it would stop does


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
        return (in_several_zones(trial),)
    try:
        return at_constant_pressure(trial) if trial.constant else (while_pressure_changes(trial),)
    except ContactError as problem:
        with suppress(ContactError):
            return (in_several_zones(trial),)
        raise problem


def at_constant_pressure(trial: Trial) -> tuple[MarchedStep, ...]:
    """The parts of a step: both ends recede until one stops, which then advances.

    When it arrives at the edge of contact, both recede again.
    """
    parts: list[MarchedStep] = []
    start, done = trial.start, 0.0
    while done < 1.0:
        now = parts[-1] if parts else None
        trial = replace(
            trial, held=now.held if now else trial.held, start=start.towards(trial.end, done)
        )
        travels = isinstance(now, Travelled) and not now.at_edge
        ways = None if travels else _ways(trial)
        if ways is not None and not isinstance(now, Receded):
            trial = trial.with_signs(*ways)
            share = _stop(trial)
            parts.append(trial.passed(share))
        else:
            part = travelled(trial.held, trial.held.pressure, trial.friction, trial.shear(1.0))
            share = part.share
            if excess(part, part.stick)[0] > EXCEEDED:
                raise trial.refusal(ISLAND, share)
            parts.append(part)
        done = 1.0 if share == 1.0 else done + (1.0 - done) * share
        if len(parts) > MOST_PARTS:
            raise ContactError(f"the stick zone travels by more than {MOST_PARTS} half-widths")
    return tuple(parts)


def while_pressure_changes(trial: Trial) -> Receded:
    """The state at the end of a step, with the signs of slip that pass all tests."""
    problems = []
    for signs in product((1.0, -1.0), repeat=2):
        goes_on = signs[0] == trial.held.signs[0], signs[1] == trial.held.signs[1]
        try:
            return trial.with_signs((signs[0], signs[1]), goes_on).passed(1.0)
        except ContactError as problem:
            problems.append(problem)
    raise max(problems, key=lambda problem: float(problem.reached["share"]))


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
