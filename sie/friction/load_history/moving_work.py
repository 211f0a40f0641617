"""Energy that a front of slip dissipates while the pressure changes.

With g the slip beside a stick zone that is a state of the loads, and p the pressure,

    W = ∫∫ f p d|g| dx = [∫ f p |g| dx] - ∫ dt ∫ f |g| dp/dt dx,
    dp/dt = [dP/dt - π (x - m) E*/2 dθ/dt]/(π w)

for edges that move or not: p vanishes where they move. Both integrals over x are those of a state
(`slip_state.Slipping`). The integrand of the one over time is smooth between two corners of the
memory, but for times at which an edge of contact that retreats has passed a whole zone of slip, so
that slip there goes the other way from then on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import pairwise

from sie.errors import ContactError
from sie.friction.slip_state import Slip, Slipping
from sie.friction.step_conditions import TESTED
from sie.numerics.halving import integral
from sie.numerics.interval import Interval
from sie.numerics.root_finding import false_position

# Of a step: so well it is known when slip turns. What that misses is of the third order, as the
# slip that is left then is of the second.
KNOWN = 1e-6


def work(state: Callable[[float], Slip], dP: float, strain: Callable[[Interval], float]) -> float:
    """∫∫ f p d|g| dx while the states follow each other from time 0 to 1.

    Meanwhile P changes by dP and E*/2 times the tilt at the rate `strain` of the contact.
    """
    whole = _held(state(1.0)) - _held(state(0.0))

    def rate(time: float) -> float:
        found = state(time)
        return found.integrals.work_of(dP, strain(found.contact)) if found.integrals else 0.0

    cuts = sorted({0.0, *_turns(state), 1.0})
    return whole - sum(integral(rate, abs(whole), part) for part in pairwise(cuts))


def _turns(state: Callable[[float], Slip]) -> Iterator[float]:
    """The times at which slip at an edge of contact turns."""
    seen = [(time, found) for time in TESTED if isinstance(found := state(time), Slipping)]
    for (before, earlier), (after, later) in pairwise(seen):
        for k in (0, 1):
            if earlier.signs[k] != later.signs[k]:
                yield _turn(state, k, before, after)


def _turn(state: Callable[[float], Slip], k: int, before: float, after: float) -> float:
    """The time between two others at which slip turns at the left edge, k = 0, or the right one."""

    def length(time: float) -> float:
        """The length of the zone of slip with its sign."""
        with suppress(ContactError):  # a zone so short is not found
            found = state(time)
            return found.signs[k] * found.lengths[k] if isinstance(found, Slipping) else 0.0
        return 0.0

    def settled(low: float, high: float, _: float) -> bool:
        return high - low <= KNOWN

    return false_position(length, before, after, (length(before), length(after)), settled)


def _held(state: Slip) -> float:
    return state.integrals.work if state.integrals else 0.0
