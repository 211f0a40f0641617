"""Dissimilar bodies under P, then Q, on a grid: the printed equations (1) and (12), step by step.

It shares nothing with the solver that it checks. Tractions are constant on cells, β > 0 and Q > 0.
It begins with p and q of the normal load, held there. Then the left edge of contact moves outwards
by one cell in each step, as Q pushes it there, and with the constants a and c

    1/π ∫p ln|x - t| dt - β ∫_-∞^x q dt = E*/2 h + a        in contact, and in the next cell,
    E*/2 g = 1/π ∫q ln|x - t| dt + β ∫_-∞^x p dt - c,       ∫p dt = P.

The equation in the next cell, where p is 0, finds Q. In each step a cell sticks, and g stays as it
was, or slips with q = ± f p, or leaves the contact where p < 0; an active set finds which. A cell
has the g that it had before it was touched, so that nothing is assumed of what it keeps. The error
is of the first order in the cells.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]

MOST = 60  # trials of which cells stick


class Pressed(NamedTuple):
    """The state under the normal load, on cells that reach beyond the contact.

    ends        of the cells, ascending
    height      E*/2 h at their middles
    pressure    the mean of p on each cell, 0 beside the contact
    shear       that of q
    slips       1 where q = f p, -1 where q = -f p, else 0
    """

    ends: Array
    height: Array
    pressure: Array
    shear: Array
    slips: Array


class Sheared(NamedTuple):
    """The state after a step: Q, the ends of the contact, and where zones begin, with their signs.

    A sign is 0 in stick, and that of the slip elsewhere.
    """

    load: float
    contact: tuple[float, float]
    zones: tuple[tuple[int, float], ...]


def sheared(pressed: Pressed, beta: float, friction: float) -> Iterator[Sheared]:
    """The states as the left edge of contact moves outwards, until no cell sticks."""
    x, width = 0.5 * (pressed.ends[1:] + pressed.ends[:-1]), np.diff(pressed.ends)
    log, total = _logarithms(x, pressed.ends), _sums(width)
    load = float(width @ pressed.pressure)
    slip = log @ pressed.shear + beta * (total @ pressed.pressure)
    signs, touch = pressed.slips.copy(), pressed.pressure > 0.0
    for k in range(int(np.argmax(touch)) - 1, 0, -1):
        touch[k] = True
        for _ in range(MOST):
            c = np.flatnonzero(touch)
            m, rows = len(c), np.append(k - 1, c)
            stuck, slipping = np.flatnonzero(signs[c] == 0.0), np.flatnonzero(signs[c])
            if not len(stuck):
                return
            matrix, right = np.zeros((2 * m + 2, 2 * m + 2)), np.zeros(2 * m + 2)
            matrix[: m + 1, :m], right[: m + 1] = log[np.ix_(rows, c)], pressed.height[rows]
            matrix[: m + 1, m : 2 * m] = -beta * total[np.ix_(rows, c)]
            matrix[: m + 1, -2] = -1.0
            at = m + 1 + stuck
            matrix[at, :m] = beta * total[np.ix_(c[stuck], c)]
            matrix[at, m : 2 * m] = log[np.ix_(c[stuck], c)]
            matrix[at, -1], right[at] = -1.0, slip[c[stuck]]
            matrix[m + 1 + slipping, m + slipping] = 1.0
            matrix[m + 1 + slipping, slipping] = -friction * signs[c[slipping]]
            matrix[-1, :m], right[-1] = width[c], load
            found = np.linalg.solve(matrix, right)
            p, q = found[:m], found[m : 2 * m]
            now = log[:, c] @ q + beta * (total[:, c] @ p) - found[-1]
            new = np.where((signs[c] == 0.0) & (np.abs(q) > friction * p), np.sign(q), signs[c])
            new[(now - slip)[c] * signs[c] < 0.0] = 0.0
            left_behind = (p < 0.0) & (x[c] > 0.0)
            if (new == signs[c]).all() and not left_behind.any():
                break
            signs[c] = new
            touch[c[left_behind]] = False
        else:
            raise AssertionError("the active set does not settle")
        slip = now
        yield _state(pressed.ends, c, signs[c], float(width[c] @ q))


def _state(ends: Array, c: NDArray[np.intp], signs: Array, load: float) -> Sheared:
    """The state whose cells c in contact slip with these signs."""
    first = np.append(0, np.flatnonzero(np.diff(signs)) + 1)
    zones = tuple((int(signs[i]), float(ends[c[i]])) for i in first)
    return Sheared(load, (float(ends[c[0]]), float(ends[c[-1] + 1])), zones)


def _logarithms(x: Array, ends: Array) -> Array:
    """1/π ∫ln|x - t| dt over each cell."""

    def primitive(s: Array) -> Array:
        values: Array = s * np.log(np.abs(s)) - s
        return values

    integrals: Array = (
        primitive(x[:, None] - ends[:-1]) - primitive(x[:, None] - ends[1:])
    ) / np.pi
    return integrals


def _sums(width: Array) -> Array:
    """The integral up to the middle of each cell."""
    n = len(width)
    sums: Array = (np.tri(n, k=-1) + 0.5 * np.eye(n)) * width
    return sums
