"""Newton's method for the four edges of a contact in partial slip, by differences.

Derivatives are updated by Broyden's formula while a step gains much, and renewed otherwise; a step
is shortened until the edges keep their order and the conditions are missed by less.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SETTLED = 1e-12  # of the conditions, each over its size
STALLED = 1e-9  # such is the rounding of the conditions where zones are narrow
DIFFERENCE = 1e-6  # of a zone, for the derivatives
MOST_STEPS = 40
KEPT = 0.2  # of each zone: what a step leaves of it at least
SHORTEST = 1e-4  # part of a step
GAINED, RENEWED = 0.1, 0.3  # of the error: what a step has to gain, and above what is renewed


class Missing(Protocol):
    """The defects of the conditions at given edges."""

    @property
    def edges(self) -> Array: ...

    @property
    def missed(self) -> Array: ...


T = TypeVar("T", bound=Missing)


class Root(NamedTuple, Generic[T]):
    """The trial that meets the conditions, and ∂(what is missed)/∂(edges) next to it."""

    trial: T
    slopes: Array | None


def iterated(
    trial: Callable[[Array], T],
    edges: Array,
    room: Callable[[Array], Array],
    slopes: Array | None = None,
    settled: float = SETTLED,
) -> Root[T] | None:
    """The trial that meets the conditions, None where none is reached.

    `room` is how far each edge may move; it is not positive where edges are not allowed. `slopes`
    may be those of a state close by.
    """
    if not (room(edges) > 0.0).all():
        return None
    now = trial(edges)
    for _ in range(MOST_STEPS):
        fresh = slopes is None
        used = _slopes(trial, now, room) if slopes is None else slopes.copy()
        step = np.asarray(-np.linalg.solve(used, now.missed), dtype=float)
        moved = _moved(trial, now, step, room)
        if moved is None:
            if fresh:
                break
            slopes = None
            continue
        made = moved.edges - now.edges
        used += np.outer(moved.missed - now.missed - used @ made, made) / float(made @ made)
        slopes = used if _error(moved) <= RENEWED * _error(now) else None
        now = moved
        if _error(now) <= settled:
            if settled > SETTLED:
                return Root(now, used)
            # One step more: where q is much less than f p, Q is told by the last digits
            last = now.edges - np.asarray(np.linalg.solve(used, now.missed), dtype=float)
            return Root(
                min(now, trial(last), key=_error) if (room(last) > 0.0).all() else now, used
            )
    return Root(now, slopes) if _error(now) < STALLED else None


def _error(one: Missing) -> float:
    return float(np.abs(one.missed).max())


def _slopes(
    trial: Callable[[Array], Missing], now: Missing, room: Callable[[Array], Array]
) -> Array:
    """∂(what is missed)/∂(edges)."""
    slopes, step = np.empty((4, 4)), DIFFERENCE * room(now.edges)
    for k in range(4):
        other = now.edges
        other[k] += step[k]
        slopes[:, k] = (trial(other).missed - now.missed) / (other[k] - now.edges[k])
    return slopes


def _moved(
    trial: Callable[[Array], T], now: T, step: Array, room: Callable[[Array], Array]
) -> T | None:
    """The trial after as much of the step as is allowed and gains."""
    part = 1.0 if np.isfinite(step).all() else 0.0
    while part >= SHORTEST:
        new = now.edges + part * step
        if (np.diff(new) > KEPT * np.diff(now.edges)).all() and (room(new) > 0.0).all():
            found = trial(new)
            if _error(found) < max((1.0 - GAINED * part) * _error(now), SETTLED):
                return found
        part *= 0.5
    return None
