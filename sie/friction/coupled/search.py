"""Newton's method for the ends of the zones.

Unknown are the left edge and the logarithms of the widths, which stay positive.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .pieces import Pieces
from .state import Question, State

Array = NDArray[np.float64]

SETTLED, ACCEPTED = 1e-12, 1e-11  # of P and f P: what the conditions may miss
MOST_STEPS, HALVINGS = 25, 6
DIFFERENCE = 1e-6  # of the widths, for derivatives
FOLDS = 1.0  # by which a step may change a width
STALE = 0.4  # of what was missed: a slower step asks for new derivatives


class Zones(NamedTuple):
    """Ends of zones by the left edge and widths, their signs, and marks inside them."""

    left: float
    widths: tuple[float, ...]
    signs: tuple[int, ...]

    @property
    def ends(self) -> Array:
        """The ends, ascending."""
        return self.left + np.append(0.0, np.cumsum(self.widths))

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones."""
        ends = self.ends.tolist()
        return tuple((ends[k], ends[k + 1]) for k, sign in enumerate(self.signs) if not sign)

    @property
    def slip(self) -> tuple[tuple[float, float, int], ...]:
        """(lo, hi, sign of q) of the slip zones."""
        ends = self.ends.tolist()
        return tuple((ends[k], ends[k + 1], sign) for k, sign in enumerate(self.signs) if sign)


def zones_between(ends: Array, signs: tuple[int, ...]) -> Zones:
    """Zones from their ends."""
    return Zones(float(ends[0]), tuple(np.diff(ends).tolist()), signs)


def settled(
    question: Question, start: Zones, marks: tuple[float, ...], accepted: float = ACCEPTED
) -> State | None:
    """The state next to zones that miss its conditions, or None."""
    unit = 0.5 * float(sum(start.widths))

    def trial(u: Array) -> State:
        widths = tuple(np.exp(u[1:]).tolist())
        return State(
            Pieces(unit * u[0], widths, start.signs, marks, question.slope.kinks, question.theta),
            question,
        )

    u = np.append(start.left / unit, np.log(start.widths))
    state = trial(u)
    missed, slopes, fresh = state.missed, None, False
    for _ in range(MOST_STEPS):
        size = float(np.abs(missed).max())
        if not math.isfinite(size):
            return None
        if size <= SETTLED:
            return state
        if slopes is None:
            slopes, fresh = _slopes(trial, u, missed), True
        step = np.linalg.lstsq(slopes, -missed, rcond=None)[0]
        step *= min(1.0, FOLDS / float(np.abs(step).max()))
        after, new = _shortened(trial, u, step, size)
        gained = float(np.abs(after.missed).max()) if after is not None else math.inf
        if after is None or gained >= size:
            if fresh:
                return state if size <= accepted else None
            slopes = None
            continue
        change = after.missed - missed
        u_step = new - u
        u, state = new, after
        if gained > STALE * size:
            slopes = None
        else:  # Broyden's update
            slopes = slopes + np.outer(change - slopes @ u_step, u_step) / float(u_step @ u_step)
        fresh, missed = False, after.missed
    return state if float(np.abs(missed).max()) <= accepted else None


def _slopes(trial, u: Array, missed: Array) -> Array:
    columns = []
    for k in range(len(u)):
        other = u.copy()
        other[k] += DIFFERENCE * (min(math.exp(u[1]), 1.0) if k == 0 else 1.0)
        columns.append((trial(other).missed - missed) / (other[k] - u[k]))
    return np.stack(columns, axis=1)


def _shortened(trial, u: Array, step: Array, size: float) -> tuple[State | None, Array]:
    """The state after a step that is halved until less is missed."""
    for _ in range(HALVINGS):
        state = trial(u + step)
        found = float(np.abs(state.missed).max())
        if found < size:
            return state, u + step
        step = 0.5 * step
    return None, u
