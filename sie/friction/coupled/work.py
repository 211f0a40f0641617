"""The energy that slip dissipates in a step: ∫∫ f p |dg| dx, by the rates of states on the way."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.gauss_jacobi import gauss_jacobi

from .fields import Fields
from .search import settled
from .state import State
from .step import Loaded, _unknowns, _zones, candidates, slip_along

Array = NDArray[np.float64]

NODES = 10  # in the root of the way after a turn, and of the way where slip goes on
FEWER = 7  # nodes of a second rule, whose difference is the error that is stated
PROMISED = 1e-6  # of the energy of a step
ROUGH = 1e-9  # of P and f P: what the states on the way may miss


def work(previous: Loaded, after: Loaded) -> float:
    """E*/2 times the energy of the step that led to a state.

    Raises ContactError where a state on the way is missing, or two rules differ.
    """
    found, other = (_sum(previous, after, nodes) for nodes in (NODES, FEWER))
    if found is None or other is None:
        raise ContactError(
            "the energy of this step is a sum over states on the way, of which one was not found; "
            "give the step in two parts"
        )
    if abs(found - other) > PROMISED * found:
        raise ContactError(
            f"the energy of this step is known to {abs(found - other) / found:.1e} of itself only, "
            "as an end of the stick zone passes where an earlier one was: give the step in two "
            "parts, divided there"
        )
    return found


def _sum(previous: Loaded, after: Loaded, nodes: int) -> float | None:
    """The sum over so many states on the way; None where one is missing."""
    base = after.base or after.before
    if base is None or after is previous:
        return 0.0
    turned = base is previous
    t, _, weight = gauss_jacobi(nodes, 0.0, 0.0)
    way, part = (t * t, 2.0 * t * weight) if turned else (t, weight)
    known = after if turned else previous
    near = [(1.0 if turned else 0.0, _unknowns(known.state))]
    if not turned and after.base is None:
        near.append((1.0, _unknowns(after.state)))
    total, (dQ, strain) = 0.0, after.step
    for place, mass in sorted(zip(way.tolist(), part.tolist(), strict=True), reverse=turned):
        Q, tau = after.Q - (1.0 - place) * dQ, after.strain - (1.0 - place) * strain
        start = _zones(_ahead(near, place, turned), after.zones.signs)
        state = settled(base.asked(Q, tau), start, base.marks, ROUGH)
        if state is None:
            state = next(candidates(base, Q, tau, after.zones.signs), None)
        if state is None:
            return None
        near.append((place, _unknowns(state)))
        total += mass * power(state, dQ, strain)
    return total


def power(state: State, dQ: float, strain: float) -> float:
    """∫ f p |dg| dx of a rate."""
    rates = state.rates(dQ, strain)
    slip = slip_along(state, rates.at, rates.gamma - strain)
    p = Fields(state)(rates.at.x)[0]
    return float(rates.at.weight @ (state.question.friction * p * slip))


def _ahead(near: list[tuple[float, Array]], place: float, turned: bool) -> Array:
    """Unknowns by two known states: as powers of the way after a turn, else on a straight line."""
    if len(near) < 2:
        return near[-1][1]
    (a, u), (b, v) = sorted(near, key=lambda known: abs(known[0] - place))[:2]
    part = math.log(place / a) / math.log(b / a) if turned else (place - a) / (b - a)
    return u + part * (v - u)
