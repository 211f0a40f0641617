"""Zones that a step of Q and bulk stress leads to, about: the start of Newton's method.

The change of q on cells that are narrower towards the edges, as if bodies were alike and p were
known: with dq = s f p - q0 where cells slip, those that stick obey

    1/π ∫dq ln|x - t| dt = τ x + constant,

and slip goes along q. Cells change between stick and slip until both hold.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .search import Zones, zones_between

Array = NDArray[np.float64]

CELLS = 72
ROUNDS = 40
LEAST = 1e-9  # of a cell, and of what it carries


class Carried(NamedTuple):
    """Friction on cells.

    cuts        the ends of the cells, lengths
    limit       f p of each cell after the step
    before      q before the step
    """

    cuts: Array
    limit: Array
    before: Array


def cuts_between(x1: float, x2: float) -> Array:
    """Ends of cells on a contact."""
    angle = np.linspace(0.0, math.pi, CELLS + 1)
    cuts: Array = 0.5 * (x1 + x2) - 0.5 * (x2 - x1) * np.cos(angle)
    return cuts


def zones_on_cells(cells: Carried, dQ: float, strain: float) -> Zones | None:
    """The zones after changes of Q and the strain; None where no cell sticks."""
    signs, change = _signs(cells, dQ, strain)
    stuck = np.flatnonzero(signs == 0)
    if not stuck.size:
        return None
    signs[stuck[0] : stuck[-1]] = 0  # slip inside the stick zone is not solved
    stretches = _runs(signs)
    if len(stretches) == 1 and signs.any():
        return None  # a single cell that sticks was dropped
    ends = [float(cells.cuts[a]) for a, _, _ in stretches] + [float(cells.cuts[-1])]
    kinds = [sign for _, _, sign in stretches]
    if not kinds[0]:
        width, sign = _narrow(cells, change, 0)
        ends, kinds = [ends[0], ends[0] + width, *ends[1:]], [sign, *kinds]
    if not kinds[-1]:
        width, sign = _narrow(cells, change, -1)
        ends, kinds = [*ends[:-1], ends[-1] - width, ends[-1]], [*kinds, sign]
    return zones_between(np.array(ends), tuple(kinds))


def _signs(cells: Carried, dQ: float, strain: float) -> tuple[NDArray[np.intp], Array]:
    """The sign of slip on each cell, 0 where it sticks, and the change of q."""
    width, x = np.diff(cells.cuts), 0.5 * (cells.cuts[1:] + cells.cuts[:-1])
    lifts, n = _potentials(cells.cuts, x), len(x)
    signs, change = np.zeros(n, dtype=int), np.zeros(n)
    for _ in range(ROUNDS):
        sticks = signs == 0
        matrix, right = np.zeros((n + 1, n + 1)), np.zeros(n + 1)
        matrix[:n, :n] = np.where(sticks[:, None], lifts, np.eye(n))
        matrix[:n, n] = np.where(sticks, 1.0, 0.0)
        right[:n] = np.where(sticks, strain * x, signs * cells.limit - cells.before)
        matrix[n, :n], right[n] = width, dQ
        change, constant = np.split(np.linalg.solve(matrix, right), [n])
        slip, q = lifts @ change + constant - strain * x, cells.before + change
        beyond = sticks & (np.abs(q) > cells.limit)
        back = ~sticks & (signs * slip < 0.0)
        signs = np.where(beyond, np.sign(q).astype(int), np.where(back, 0, signs))
        if signs.all() or not (beyond.any() or back.any()):
            break
    return signs, change


def _narrow(cells: Carried, change: Array, cell: int) -> tuple[float, int]:
    """Width and sign of a slip zone within a cell at an edge, by the change if all of it sticks.

    That is c/√d at the distance d from the edge, f p is k √d, and slip ends at 2c/k.
    """
    sign = 1 if change[cell] > 0.0 else -1
    width = float(cells.cuts[1] - cells.cuts[0]) if cell == 0 else float(np.diff(cells.cuts)[-1])
    left = max(cells.limit[cell] - sign * cells.before[cell], LEAST * cells.limit[cell])
    part = 2.0 / 3.0 * abs(float(change[cell])) / left
    return width * min(max(part, LEAST), 0.5), sign


def _potentials(cuts: Array, x: Array) -> Array:
    """1/π ∫ln|x - t| dt over each cell."""
    d = x[:, None] - cuts[None, :]
    whole = d * np.log(np.abs(d)) - d
    potentials: Array = (whole[:, :-1] - whole[:, 1:]) / math.pi
    return potentials


def _runs(signs: NDArray[np.intp]) -> list[tuple[int, int, int]]:
    """(first, last + 1, sign) of cells of one kind, without single cells between equal ones."""
    signs = signs.copy()
    alone = (signs[1:-1] != signs[:-2]) & (signs[:-2] == signs[2:])
    signs[1:-1][alone] = signs[:-2][alone]
    starts = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist(), len(signs)]
    return [(a, b, int(signs[a])) for a, b in pairwise(starts)]
