"""A first guess of stick zones: a step of the shear on cells, constant on each.

    minimise ½ Δq·A Δq + Δτ Δq·x,    A q = -1/π ∫ q(t) ln|x - t| dt,    |q| <= f p,  ∫Δq = ΔQ

over all q at once, which is the state at the end of a step in which each point slips in one
direction only (Duvaut & Lions 1972). A primal-dual active set finds it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.interval import Interval

Array = NDArray[np.float64]
Values = Callable[[Array], Array]

CELLS = 160  # of equal angles: short ones at the edges
SHORTEST = 1e-13  # of the contact: shorter cells are few roundings wide, and their matrix singular
PARTS = 4  # of a cell beside the end of a zone, or beside a mark, in the next round
ROUNDS, UNUSED = 6, 2  # how often cells are cut, and how many of the first rounds are no guess
MOST = 60
BEYOND, OPPOSING = 1e-12, 1e-12  # of f p, and of the slip: less is rounding


class Guess(NamedTuple):
    """Stick zones (N, 2), and the signs of slip beside them, N + 1."""

    ends: Array
    signs: tuple[float, ...]


def guess(
    contact: Interval, shear: Values, bound: Values, loads: tuple[float, float], marks: Array
) -> Iterator[Guess]:
    """Ever better guesses, on cells that are shorter in each round.

    `shear` is q at the start, which is not smooth at `marks`; `bound` is f p at the end, `loads`
    are ΔQ and Δτ.
    """
    edges = cells(contact)
    inside = marks[(marks > edges[0]) & (marks < edges[-1])]
    for number in range(ROUNDS):
        edges = _apart(np.concatenate((edges, inside)))
        at, _ = stepped(edges, shear, bound, loads)
        if number >= UNUSED:
            yield _zones(edges, at)
        turns = np.flatnonzero(np.diff(at)) + 1
        near = np.concatenate((turns, np.searchsorted(edges, inside), [1, len(at) - 1]))
        cut = np.unique(np.clip(np.add.outer(near, (-2, -1, 0, 1)), 0, len(at) - 1))
        parts = np.arange(1, PARTS) / PARTS
        edges = np.append(edges, (edges[cut, None] + np.diff(edges)[cut, None] * parts).ravel())


def _apart(edges: Array) -> Array:
    """The ends of cells in ascending order, without cells of a few roundings."""
    edges = np.unique(edges)
    kept = np.diff(edges, prepend=-np.inf) > SHORTEST * (edges[-1] - edges[0])
    return edges[kept]


def _zones(edges: Array, at: Array) -> Guess:
    """The stick zones, from the direction in which each cell slips."""
    bars = np.diff((at == 0.0).astype(int), prepend=0, append=0)
    starts, stops = np.flatnonzero(bars == 1), np.flatnonzero(bars == -1)
    cuts = pairwise([0, *np.stack((starts, stops), axis=1).ravel().tolist(), len(at)])
    signs = [float(np.sign(at[a:b].sum())) for a, b in list(cuts)[::2]]
    return Guess(np.stack((edges[starts], edges[stops]), axis=1), tuple(signs))


def cells(contact: Interval) -> Array:
    """The ends of the cells of the first round."""
    ends: Array = contact.m - contact.r * np.cos(math.pi * np.arange(CELLS + 1) / CELLS)
    return ends


def stepped(
    edges: Array, shear: Values, bound: Values, loads: tuple[float, float]
) -> tuple[Array, Array]:
    """For each cell the direction of q where it slips, 0 where it sticks, and E*/2 times slip."""
    x, h = 0.5 * (edges[:-1] + edges[1:]), np.diff(edges)
    n, q, bound_at = len(x), shear(x), bound(x)
    s = edges - x[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        primitive = np.where(s == 0.0, 0.0, s * np.log(np.abs(s) / h.sum())) - s
    A = -np.diff(primitive, axis=1) / math.pi
    at = np.zeros(n)
    for _ in range(MOST):
        sticks = at == 0.0
        moved = np.where(sticks, 0.0, at * bound_at - q)
        m = int(sticks.sum())
        if not m:
            raise ContactError("no cell of the grid sticks, and nothing carries what is left of Q")
        K = np.zeros((m + 1, m + 1))
        K[:m, :m], K[:m, m], K[m, :m] = A[np.ix_(sticks, sticks)], -1.0, h[sticks]
        right = np.append(-loads[1] * x[sticks] - A[sticks] @ moved, loads[0] - h @ moved)
        found = np.linalg.solve(K, right)
        moved[sticks] = found[:m]
        new = q + moved
        slip = found[m] - A @ moved - loads[1] * x
        out = sticks & (np.abs(new) > bound_at * (1.0 + BEYOND))
        back = ~sticks & (at * slip < -OPPOSING * np.abs(slip).max())
        if not (out | back).any():
            return at, np.where(sticks, 0.0, slip)
        at = np.where(out, np.sign(new), np.where(back, 0.0, at))
    raise ContactError("stick and slip do not settle on a grid")
