"""Newton's method for the four edges of a contact in partial slip, by differences.

Derivatives are updated by Broyden's formula while a step gains much, and renewed otherwise; a step
is shortened until the edges keep their order and the conditions are missed by less.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.interval import EPS
from sie.progress_bar import step_done

from .tangential import TangentialSearch, Trial

Array = NDArray[np.float64]

SETTLED = 1e-12  # of the conditions, each over its size
STALLED = 1e-9  # such is the rounding of the conditions where zones are narrow
# For the derivatives, of a zone at least, and where it is so many roundings of the edges wide
DIFFERENCE, ROUNDINGS = 1e-6, 16.0
MOST_STEPS, IDLE = 40, 6  # and how many at most may not halve what is missed
KEPT = 0.2  # of each zone: what a step leaves of it at least
SHORTER, SHORTEST = 0.3, 1e-6  # parts of a step
GAINED, RENEWED = 0.1, 0.3  # of the error: what a step has to gain, and above what is renewed


class Root(NamedTuple):
    """The trial that meets the conditions, and ∂(what is missed)/∂(edges) next to it."""

    trial: Trial
    slopes: Array | None


def next_to(
    search: TangentialSearch,
    edges: Array,
    Q: float,
    slopes: Array | None = None,
    settled: float = SETTLED,
) -> Root | None:
    """The state under Q next to these edges; None where none is reached.

    `slopes` may be those of a state close by.
    """
    try:
        # Edges that are tried may lie so near to each other that nothing is finite
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            return _iterated(search, edges, Q, slopes, settled)
    except (ArithmeticError, np.linalg.LinAlgError, ContactError):
        return None


def _iterated(
    search: TangentialSearch, edges: Array, Q: float, slopes: Array | None, settled: float
) -> Root | None:
    if not (search.room(edges) > 0.0).all():
        return None
    now, errors = search.trial(edges, Q), [math.inf] * IDLE
    for _ in range(MOST_STEPS):
        step_done(0)
        errors.append(_error(now))
        if errors[-1] > 0.5 * errors[-IDLE]:
            break
        fresh = slopes is None
        used = _slopes(search, now, Q) if slopes is None else slopes.copy()
        step = np.asarray(-np.linalg.solve(used, now.missed), dtype=float)
        moved = _moved(search, now, step, Q)
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
            return Root(now if settled > SETTLED else _refined(search, now, used, Q), used)
    return Root(now, slopes) if _error(now) < STALLED else None


def _refined(search: TangentialSearch, now: Trial, slopes: Array, Q: float) -> Trial:
    """One step more: where q is much less than f p, Q is told by the last digits."""
    last = now.edges - np.asarray(np.linalg.solve(slopes, now.missed), dtype=float)
    allowed = (search.room(last) > 0.0).all()
    return min(now, search.trial(last, Q), key=_error) if allowed else now


def _error(one: Trial) -> float:
    return float(np.abs(one.missed).max())


def _slopes(search: TangentialSearch, now: Trial, Q: float) -> Array:
    """∂(what is missed)/∂(edges)."""
    slopes, near = np.empty((4, 4)), search.room(now.edges)
    # Of a narrow zone a difference as short as rounding of the edges tells nothing
    step = near * np.maximum(DIFFERENCE, np.sqrt(ROUNDINGS * EPS * np.ptp(now.edges) / near))
    for k in range(4):
        other = now.edges
        other[k] += step[k]
        slopes[:, k] = (search.trial(other, Q).missed - now.missed) / (other[k] - now.edges[k])
    return slopes


def _moved(search: TangentialSearch, now: Trial, step: Array, Q: float) -> Trial | None:
    """The trial after as large a part of a step as is allowed and gains."""
    part = 1.0 if np.isfinite(step).all() else 0.0
    while part >= SHORTEST:
        new = search.ahead(now.edges, part * step)
        if (np.diff(new) > KEPT * np.diff(now.edges)).all() and (search.room(new) > 0.0).all():
            found = search.trial(new, Q)
            if _error(found) < max((1.0 - GAINED * part) * _error(now), SETTLED):
                return found
        part *= SHORTER
    return None
