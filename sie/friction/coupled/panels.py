"""Panels of intervals that shrink towards singularities at, or beyond, their ends."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

Array = NDArray[np.float64]

NODES = 16
LONGEST = 4.0  # of a panel of v: with NODES the error is (π/2 + 1.86)^-32
LONGER = 0.5  # of its depth in v: by how much a panel next to a singularity is longer
GROWTH = 2.0  # a panel's length over its distance from the singularity; with 12 nodes that is 1e-13
FAR = 1e300  # stands for no singularity
# Of the half-width: what is nearer to the place of first contact has the values there, as quotients
# of the half-width and that distance overflow
INNERMOST = 1e-280
APART = 1e17  # times its length, from an interval: there a singularity is none


def stretched(length: Any, before: Any, after: Any, grown: Array, left: Array) -> tuple[Any, ...]:
    """Places of an interval by v = ln((B + y)/(C + L - y)): y and L - y, and dy/dv.

    `grown` of v lies behind and `left` ahead. y and L - y are the distances from the ends.

    A function that is singular at y = -B and y = C + L, and nowhere else on the line beside the
    interval, is analytic in v for |Im v| < π.
    """
    ratio, rise, back = before / (after + length), np.expm1(grown), np.expm1(left)
    below = 1.0 + ratio * (1.0 + rise)
    to_end = after * back / (1.0 + after / (before + length) * (1.0 + back))
    rate = before * (1.0 + ratio) * (1.0 + rise) / (below * below)
    return before * rise / below, to_end, rate


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
    *,
    longest: float = LONGEST,
    near: Array | float = math.inf,
) -> tuple[NDArray[np.intp], Array, Array, Array]:
    """Rules for intervals that singularities lie `before` and `after`: whose, and rows of places.

    They are given by their distances from both ends, with weights of an integrand that has these
    powers there. In v of `stretched` panels are the longer the nearer they are to a singularity,
    as the integral over them is the smaller: to the first one from the distance `near` on, to the
    other one from the second panel on.
    """
    B, C = np.minimum(before, APART * length), np.minimum(after, APART * length)
    begin, end = np.log1p(length / B), np.log1p(length / C)
    growth = LONGER / longest
    even = begin - np.log1p(np.minimum(near, length) / B), np.minimum(end, longest)
    first, last = (
        part + np.log1p(growth * (whole - part)) / growth
        for part, whole in zip(even, (begin, end), strict=True)
    )
    least = 2 if powers[0] and powers[1] else 1
    count = np.maximum(np.ceil((first + last) / longest).astype(np.intp), least)
    owner = np.repeat(np.arange(len(count)), count)
    k = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    remaining = count[owner] - 1 - k
    kind = np.where(
        (k == 0) & ((remaining > 0) | (powers[1] == 0.0)), 0, np.where(remaining == 0, 2, 1)
    )
    u = first[owner] - ((first + last) / count)[owner] * np.array([k, k + 1.0])
    beyond = np.maximum(np.abs(u) - np.where(u > 0.0, even[0][owner], even[1][owner]), 0.0)
    depth = np.copysign(np.abs(u) - beyond + np.expm1(growth * beyond) / growth, u)
    start = np.where(k == 0, 0.0, begin[owner] - depth[0])[:, None]
    rest = np.where(remaining == 0, 0.0, end[owner] + depth[1])[:, None]
    size = (depth[0] - depth[1])[:, None]
    z, from_end, w = _rules(*powers)
    B, C, length = (column[owner][:, None] for column in (B, C, length))
    grown, left = start + size * z[kind], rest + size * from_end[kind]
    ahead, to_end, rate = stretched(length, B, C, grown, left)
    return owner, ahead, to_end, size * w[kind] * rate


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
