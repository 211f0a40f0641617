"""Goodman's approximation under a growing normal load on a grid: the printed equations, in steps.

It shares nothing with the solver that it checks. Tractions are constant on cells, β > 0, and with
the constants a and c

    1/π ∫p ln|x - t| dt = E*/2 h + a               in contact,           ∫p dt = P,
    1/π ∫q ln|x - t| dt + β ∫_-∞^x p dt - c        as it was, in stick,  ∫q dt = 0,

and q = ± f p in slip. Active sets find which cells touch and which stick. The error is of the first
order in the cells and in the steps of the load.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]

MOST = 100  # trials of which cells touch, or stick


class Grown(NamedTuple):
    """Middles of the cells, p and q there, and the ends of the stick zone."""

    x: Array
    pressure: Array
    shear: Array
    stick: tuple[float, float]


def grown(ends: Array, height: Array, load: float, law: tuple[float, float], steps: int) -> Grown:
    """The state under a load that grew in equal steps; height is E*/2 h, law is β and f."""
    beta, friction = law
    x, width = 0.5 * (ends[1:] + ends[:-1]), float(ends[1] - ends[0])
    log = _logarithms(x, ends)
    total = width * (np.tri(len(x), k=-1) + 0.5 * np.eye(len(x)))
    p: Array = np.zeros(len(x))
    q, signs = np.zeros_like(p), np.zeros_like(p)
    for step in range(1, steps + 1):
        more = _pressed(log, height, load * step / steps, width)
        for _ in range(MOST):
            held = (more > 0.0) & (signs == 0.0)
            new = np.where(more > 0.0, signs * friction * more, 0.0)
            moved = log @ (new - q) + beta * total @ (more - p)
            # In the held cells q changes so that g stays but for c
            values, c = _solved(log, held, -moved, -width * float(new.sum()), width)
            new[held] += values
            change = log @ (new - q) + beta * total @ (more - p) + c
            over = held & (np.abs(new) > friction * more)
            back = (more > 0.0) & (signs * change < 0.0)
            if not (over | back).any():
                break
            signs = np.where(over, np.sign(new), np.where(back, 0.0, signs))
        signs = np.where(more > 0.0, signs, 0.0)
        p, q = more, new
    held = np.flatnonzero((p > 0.0) & (signs == 0.0))
    return Grown(x, p, q, (float(ends[held[0]]), float(ends[held[-1] + 1])))


def _pressed(log: Array, height: Array, load: float, width: float) -> Array:
    """p under a load."""
    touching = np.ones(len(height), bool)
    for _ in range(MOST):
        p = np.zeros(len(height))
        p[touching], a = _solved(log, touching, height, load, width)
        inside = np.where(touching, p > 0.0, height < log @ p + a)
        if (inside == touching).all():
            break
        touching = inside
    return p


def _solved(
    log: Array, own: NDArray[np.bool_], due: Array, force: float, width: float
) -> tuple[Array, float]:
    """Values on own cells with log @ values + constant = due there, and of this force."""
    count = int(own.sum())
    matrix = np.ones((count + 1, count + 1))
    matrix[:-1, :-1], matrix[-1, :-1], matrix[-1, -1] = log[np.ix_(own, own)], width, 0.0
    solution = np.linalg.solve(matrix, np.append(due[own], force))
    return solution[:-1], float(solution[-1])


def _logarithms(x: Array, ends: Array) -> Array:
    """1/π ∫ln|x - t| dt over cells."""
    s = np.subtract.outer(x, ends)
    antiderivative = s * np.log(np.abs(s)) - s
    values: Array = -np.diff(antiderivative, axis=1) / np.pi
    return values
