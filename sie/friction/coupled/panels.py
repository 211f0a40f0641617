"""Panels of intervals that shrink towards singularities at, or beyond, their ends."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

from .tables import APART, stretched

Array = NDArray[np.float64]

NODES = 16
LONGEST = 4.0  # of a panel of v: with NODES the error is (π/2 + 1.86)^-32
GROWTH = 2.0  # a panel's length over its distance from the singularity; with 12 nodes that is 1e-13
FAR = 1e300  # stands for no singularity


@lru_cache(maxsize=64)
def _rules(at_start: float, at_end: float) -> tuple[Array, Array, Array]:
    """Rows of nodes, their distances from 1 and weights: at the start, between, at the end."""
    rules = with_weight(NODES, 0.0, at_start), with_weight(NODES, 0.0, 0.0)
    x, rest, w = (
        np.array(rows) for rows in zip(*rules, with_weight(NODES, at_end, 0.0), strict=True)
    )
    return x, rest, w


def graded(
    length: Array,
    before: Array,
    after: Array,
    powers: tuple[float, float] = (0.0, 0.0),
    longest: float = LONGEST,
) -> tuple[NDArray[np.intp], Array, Array, Array]:
    """Rules for intervals that singularities lie `before` and `after`: whose, and rows of places.

    They are given by their distances from both ends, with weights of an integrand that has these
    powers there. Panels are equally long in v of `stretched`.
    """
    B, C = np.minimum(before, APART * length), np.minimum(after, APART * length)
    whole = np.log1p(length / B) + np.log1p(length / C)
    least = 2 if powers[0] and powers[1] else 1
    count = np.maximum(np.ceil(whole / longest).astype(np.intp), least)
    owner = np.repeat(np.arange(len(count)), count)
    k = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    step = (whole / count)[owner][:, None]
    last = count[owner] - 1 - k
    kind = np.where((k == 0) & ((last > 0) | (powers[1] == 0.0)), 0, np.where(last == 0, 2, 1))
    z, rest, w = _rules(*powers)
    B, C, length = (column[owner][:, None] for column in (B, C, length))
    grown, left = step * (k[:, None] + z[kind]), step * (last[:, None] + rest[kind])
    ahead, to_end, rate = stretched(length, B, C, grown, left)
    weight = step * w[kind] * rate
    return owner, ahead, to_end, weight


def totals(owner: NDArray[np.intp], values: Array, n: int) -> Array:
    """The sums of rows of values that belong to each of n intervals."""
    total: Array = np.bincount(owner, values.sum(axis=1), minlength=n).astype(float)
    return total


def shrinking(length: Array, before: Array, after: Array) -> tuple[Array, ...]:
    """Panels of intervals, as arrays.

    These are the interval of each, its beginning, its length, what is left behind it, and the
    number of its rule: at the start, between, or at the end.

    From either end they grow in proportion to the distance from the singularity beyond it.
    """
    first = np.where(np.isinf(after), length, 0.5 * length)
    owner, k, start, size = geometric(first, before)
    backwards, j, behind, back = geometric(length - first, after)
    return (
        np.concatenate((owner, backwards)),
        np.concatenate((start, length[backwards] - behind - back)),
        np.concatenate((size, back)),
        np.concatenate((length[owner] - start - size, behind)),
        np.concatenate((np.minimum(k, 1), np.where(j == 0, 2, 1))),
    )


def geometric(length: Array, scale: Array) -> tuple[Any, ...]:
    """(owner, number, beginning, length) of panels that grow with the distance from -scale."""
    scale = np.minimum(scale, FAR)
    folds = np.log1p(length / scale)
    count = np.ceil(folds / math.log1p(GROWTH)).astype(np.intp)
    owner = np.repeat(np.arange(len(count)), count)
    k = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    ratio, scale = (folds / np.maximum(count, 1))[owner], scale[owner]
    start = scale * np.expm1(k * ratio)
    return owner, k, start, scale * np.expm1((k + 1) * ratio) - start
