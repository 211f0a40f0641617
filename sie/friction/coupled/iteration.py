"""Newton's method for the four edges of a contact in partial slip, by differences.

Derivatives are updated by Broyden's formula while a step gains much, and renewed otherwise; a step
is shortened until the edges keep their order and the conditions are missed by less.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS
from sie.progress_bar import step_done

Array = NDArray[np.float64]

SETTLED = 1e-12  # of the conditions, each over its size
STALLED = 1e-9  # such is the rounding of the conditions where zones are narrow
# For the derivatives, of a zone at least, and where it is so many roundings of the edges wide
DIFFERENCE, ROUNDINGS = 1e-6, 16.0
MOST_STEPS, IDLE = 40, 6  # and how many at most may not halve what is missed
KEPT = 0.2  # of each zone: what a step leaves of it at least
SHORTER, SHORTEST = 0.3, 1e-6  # parts of a step
GAINED, RENEWED = 0.1, 0.3  # of the error: what a step has to gain, and above what is renewed


class Missing(Protocol):
    """The defects of the conditions at given edges."""

    @property
    def edges(self) -> Array: ...

    @property
    def missed(self) -> Array: ...


class Steps(Protocol):
    """How far edges may move, and where a step takes them."""

    def room(self, edges: Array) -> Array:
        """How far each edge may move; not positive where edges are not allowed."""

    def ahead(self, edges: Array, step: Array) -> Array:
        """The edges after a step, which may be bent."""


T = TypeVar("T", bound=Missing)


class Root(NamedTuple, Generic[T]):
    """The trial that meets the conditions, and ∂(what is missed)/∂(edges) next to it."""

    trial: T
    slopes: Array | None


def iterated(
    trial: Callable[[Array], T],
    edges: Array,
    steps: Steps,
    slopes: Array | None = None,
    settled: float = SETTLED,
) -> Root[T] | None:
    """The trial that meets the conditions, None where none is reached.

    `slopes` may be those of a state close by.
    """
    if not (steps.room(edges) > 0.0).all():
        return None
    now, errors = trial(edges), [math.inf] * IDLE
    for _ in range(MOST_STEPS):
        step_done(0)
        errors.append(_error(now))
        if errors[-1] > 0.5 * errors[-IDLE]:
            break
        fresh = slopes is None
        used = _slopes(trial, now, steps) if slopes is None else slopes.copy()
        step = np.asarray(-np.linalg.solve(used, now.missed), dtype=float)
        moved = _moved(trial, now, step, steps)
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
                min(now, trial(last), key=_error) if (steps.room(last) > 0.0).all() else now, used
            )
    return Root(now, slopes) if _error(now) < STALLED else None


def _error(one: Missing) -> float:
    return float(np.abs(one.missed).max())


def _slopes(trial: Callable[[Array], Missing], now: Missing, steps: Steps) -> Array:
    """∂(what is missed)/∂(edges)."""
    slopes, near = np.empty((4, 4)), steps.room(now.edges)
    # Of a narrow zone a difference as short as rounding of the edges tells nothing
    step = near * np.maximum(DIFFERENCE, np.sqrt(ROUNDINGS * EPS * np.ptp(now.edges) / near))
    for k in range(4):
        other = now.edges
        other[k] += step[k]
        slopes[:, k] = (trial(other).missed - now.missed) / (other[k] - now.edges[k])
    return slopes


def _moved(trial: Callable[[Array], T], now: T, step: Array, steps: Steps) -> T | None:
    """The trial after as large a part of a step as is allowed and gains."""
    part = 1.0 if np.isfinite(step).all() else 0.0
    while part >= SHORTEST:
        new = steps.ahead(now.edges, part * step)
        if (np.diff(new) > KEPT * np.diff(now.edges)).all() and (steps.room(new) > 0.0).all():
            found = trial(new)
            if _error(found) < max((1.0 - GAINED * part) * _error(now), SETTLED):
                return found
        part *= SHORTER
    return None
