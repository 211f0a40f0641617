"""Where slip begins, goes on and stops at the beginning of a step in which the pressure changes.

The rates of p and q are in closed form, whatever strain is locked in (`receding_step`,
`stuck_contact`). An edge of contact that grows sticks if the rate of q at it is at most f times
that of p; beyond, slip begins there in the direction of q. An end of the stick zone beside which
slip goes on recedes if its coefficient has the sign of that slip, and jumps to the edge otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np

from .growing_contact import LoadChange, Rates
from .marched_step import Held

SLACK = 1e-11  # of the rates: what rounding leaves of equal ones
BESIDE = 1e-8  # of the contact: where q/p at an edge is seen
ROOM = 1e-9


class Onset(NamedTuple):
    """The signs of slip at the left and the right edge, 0 where it sticks, and what goes on.

    goes_on    whether each end of the stick zone goes on from where it was
    advances   1 if the right end advances, -1 if the left one does, 0 if none does
    joins      what is told of a second zone of slip that does not join the first one soon, "" if
               there is none
    """

    signs: tuple[float, float]
    goes_on: tuple[bool, bool]
    advances: float = 0.0
    joins: str = ""


def onsets(held: Held, change: LoadChange, friction: float) -> tuple[Onset, ...]:
    """How slip begins: what the rates say, and slip at both edges in any direction after it.

    The latter is for edges that retreat, at which slip may turn soon after the beginning.
    """
    contact, rates = held.pressure.contact, change.rates
    strain = float(rates.strain(np.array(contact.m), np.array(contact.r)))
    found = list(_consistent(held, rates, strain, friction))
    turn = math.pi * contact.r * strain
    if not found or min(rates.P - turn, rates.P + turn) <= 0.0:
        for left, right in product((1.0, -1.0), repeat=2):
            goes_on = left == held.signs[0], right == held.signs[1]
            if all((left, right) != onset.signs for onset in found):
                found.append(Onset((left, right), goes_on))
    return tuple(found)


def _consistent(held: Held, rates: Rates, strain: float, friction: float) -> Iterator[Onset]:
    """The onsets that agree with the rates which they bring about."""
    contact, stick = held.pressure.contact, held.stick
    inner = stick.x1 - contact.x1 > ROOM * contact.r, contact.x2 - stick.x2 > ROOM * contact.r
    may = [
        (True, False) if sign and room else (False,)
        for sign, room in zip(held.signs, inner, strict=True)
    ]
    for goes_on in product(*may):
        signs = tuple(s if goes else 0.0 for s, goes in zip(held.signs, goes_on, strict=True))
        zone = (
            stick.x1 if goes_on[0] else contact.x1,
            stick.x2 if goes_on[1] else contact.x2,
        )
        rho, slipping = 0.5 * (zone[1] - zone[0]), [s for s in signs if s]
        if len(set(slipping)) > 1:
            yield Onset((signs[0], signs[1]), (True, True))  # which `trial_step` judges
            continue
        s, found = (slipping or [0.0])[0], []
        for k, outward in enumerate((1.0, -1.0)):
            turn = outward * math.pi
            grown = rates.P + turn * contact.r * strain
            if s:
                load, bend = rates.P - s * rates.Q / friction, strain - s * rates.tau / friction
                layer = load + turn * rho * bend
                pull = s * friction * (grown - layer * math.sqrt(contact.r / rho))
            else:
                layer, pull = 0.0, rates.Q + turn * contact.r * rates.tau
            size = abs(rates.P) + (abs(rates.Q) + math.pi * contact.r * abs(rates.tau)) / friction
            if goes_on[k]:
                found.append(s if layer < SLACK * size else math.nan)
            else:
                found.append(_at_edge(held, k, (pull, friction * grown, friction), friction * size))
        if not any(math.isnan(sign) for sign in found):
            yield Onset((found[0], found[1]), (goes_on[0], goes_on[1]))


def _at_edge(held: Held, k: int, rates: tuple[float, float, float], size: float) -> float:
    """The sign of slip that begins at an edge, 0 if it sticks, nan if it cannot be so."""
    pull, grown, friction = rates
    if grown > SLACK * size:
        return 0.0 if abs(pull) <= grown + SLACK * size else math.copysign(1.0, pull)
    contact = held.pressure.contact
    beside = BESIDE * 2.0 * contact.r
    x = np.array([contact.x1 + beside if k == 0 else contact.x2 - beside])
    ratio = held.signs[k]
    if not ratio:
        bound = friction * float(held.pressure(x)[0])
        ratio = float(held.shear(x)[0]) / bound if bound > 0.0 else 0.0
    ahead = pull - ratio * grown
    sign = math.copysign(1.0, ahead)
    return math.nan if sign == held.signs[k] or abs(ahead) <= SLACK * size else sign
