"""Energy that a front of slip dissipates while the pressure changes.

With g the slip beside a stick zone that is a state of the loads, and p the pressure,

    W = ∫∫ f p d|g| dx = [∫ f p |g| dx] - ∫ dt ∫ f |g| dp/dt dx,
    dp/dt = [dP/dt - π (x - m) E*/2 dθ/dt]/(π w)

for edges that move or not: p vanishes where they move. Both integrals over x are those of a state
(`slip_state.Slipping`), and the one over time has a smooth integrand between two corners of the
memory.
"""

from __future__ import annotations

from collections.abc import Callable

from sie.friction.slip_state import Slip, Slipping
from sie.numerics.halving import integral
from sie.numerics.interval import Interval


def work(state: Callable[[float], Slip], dP: float, strain: Callable[[Interval], float]) -> float:
    """∫∫ f p d|g| dx while the states follow each other from time 0 to 1.

    Meanwhile P changes by dP and E*/2 times the tilt at the rate `strain` of the contact.
    """
    whole = _held(state(1.0)) - _held(state(0.0))

    def rate(time: float) -> float:
        found = state(time)
        return (
            found.integrals.work_of(dP, strain(found.contact))
            if isinstance(found, Slipping)
            else 0.0
        )

    return whole - integral(rate, abs(whole))


def _held(state: Slip) -> float:
    return state.integrals.work if isinstance(state, Slipping) else 0.0
