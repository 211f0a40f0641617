"""The place at one depth where a quantity of a cycle is largest.

The quantity may have kinks, roots and logarithms at the edges and breaks of the tractions of each
state, the marks. Columns are dense towards every mark, and the marks are among them: next to a mark
a quantity varies with the logarithm of the distance. The highest columns are then narrowed down
between their neighbours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import step_done

from .half_plane import Tractions
from .scan_columns import thinned

Array = NDArray[np.float64]

# Distances of columns from a mark in half-widths, and the ratio of neighbouring ones.
FARTHEST, NEAREST, RATIO = 30.0, 1e-9, 1.6
# Columns at a depth are no nearer to each other than this part of it.
SPACING = 0.05
# Marks beyond this number, of a trace, are thinned to MANY in the contact.
MANY = 200
# The columns that are narrowed down, and how high they are, relative to the highest one.
MOST_TOPS, HIGH = 8, 0.85
# Rounds of narrowing, each among so many points. After EARLY rounds only columns go on whose values
# are NEAR the highest one, relative to it.
ROUNDS, POINTS, EARLY, NEAR = 14, 7, 4, 1e-3


def columns(tractions: Sequence[Tractions], y: float) -> Array:
    """Positions at a depth, ascending, among which a quantity of these states is sought."""
    marks = np.unique(np.concatenate([t.marks for t in tractions]))
    r = 0.5 * (marks[-1] - marks[0])
    if len(marks) > MANY:
        edges = [x for t in tractions for x in t.pressure.interval]
        marks = np.unique(np.concatenate((thinned(marks, 2.0 * r / MANY), edges)))
    steps = int(np.ceil(np.log(FARTHEST / NEAREST) / np.log(RATIO)))
    distance = r * FARTHEST * RATIO ** -np.arange(steps, dtype=float)
    gap = np.diff(marks)
    right = _within(marks, np.append(gap, np.inf), distance)
    left = _within(-marks, np.append(np.inf, gap), distance)
    x = np.unique(np.concatenate((marks, right, -left, 0.5 * (marks[1:] + marks[:-1]))))
    return thinned(x, SPACING * y) if y else x


def _within(marks: Array, gap: Array, distance: Array) -> Array:
    """The positions at these distances from each mark that are nearer to it than to the next."""
    return (marks[:, None] + distance)[distance < 0.5 * gap[:, None]]


def largest(
    x: Array, values: Array, quantity: Callable[[Array], Array], rounds: int = ROUNDS
) -> tuple[float, float]:
    """The position near these columns where a quantity with these values is largest, and its value.

    Few rounds are for a quantity that is dear.
    """
    padded = np.concatenate(([-np.inf], values, [-np.inf]))
    top = np.flatnonzero((values >= padded[:-2]) & (values >= padded[2:]))
    best = values.max()
    top = top[values[top] >= best - (1.0 - HIGH) * abs(best)]
    top = top[np.argsort(-values[top], kind="stable")][: MOST_TOPS if rounds == ROUNDS else 1]
    lo, at, hi = x[np.maximum(top - 1, 0)], x[top], x[np.minimum(top + 1, len(x) - 1)]
    value = np.asarray(quantity(at))
    for turn in range(rounds):
        step_done(0)
        near = np.linspace(lo, hi, POINTS, axis=1)
        values = np.asarray(quantity(near.ravel())).reshape(near.shape)
        best_at = (np.arange(len(near)), values.argmax(axis=1))
        better = values[best_at] > value
        at = np.where(better, near[best_at], at)
        value = np.where(better, values[best_at], value)
        step = (hi - lo) / (POINTS - 1)
        lo, hi = np.maximum(at - step, lo), np.minimum(at + step, hi)
        if turn >= EARLY:
            kept = value >= value.max() - NEAR * abs(value.max())
            at, value, lo, hi = at[kept], value[kept], lo[kept], hi[kept]
    first = int(value.argmax())
    return float(at[first]), float(value[first])
