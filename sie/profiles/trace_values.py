"""Checks of the points and heights of a trace, and their repair by `mend`."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments

Array = NDArray[np.float64]
Smoothing = float | Literal["gcv"]

FEWEST = 4  # points of a cubic
SMALLEST_STEP = 1e-12  # of the trace's length
SHORTEST, LONGEST = 1e-100, 1e100  # of lengths and heights: beyond, their powers are no doubles


class Mended(NamedTuple):
    """The repairs that `mend` made to a trace.

    left_out    points without a value
    averaged    points that were averaged with others of the same x, to rounding
    sorted      whether x did not ascend
    """

    left_out: int = 0
    averaged: int = 0
    sorted: bool = False


def checked(x: ArrayLike, h: ArrayLike, mend: bool) -> tuple[Array, Array, Mended]:
    """Ascending points, their heights and what was mended. ValueError where they are no trace."""
    points, heights = _numbers("x", x), _numbers("h", h)
    if len(points) != len(heights):
        raise ValueError(
            f"{len(points)} values of x and {len(heights)} of h: give a height for each point"
        )
    missing = ~(np.isfinite(points) & np.isfinite(heights))
    mended = Mended()
    if mend:
        points, heights, averaged, in_disorder = _ascending(points[~missing], heights[~missing])
        mended = Mended(int(np.count_nonzero(missing)), averaged, in_disorder)
    elif missing.any():
        k = int(np.argmax(missing))
        raise ValueError(
            f"{np.count_nonzero(missing)} of {len(points)} points of the trace are not finite, "
            f"the first x[{k}] = {points[k]:g}, h[{k}] = {heights[k]:g}: "
            "leave them out, or give mend = True"
        )
    _refuse_disorder(points)
    if len(points) < FEWEST:
        raise ValueError(
            f"{len(points)} points are no trace: a cubic spline needs at least {FEWEST}"
        )
    _refuse_out_of_range(points, heights)
    return points, heights, mended


def _refuse_disorder(points: Array) -> None:
    wrong = np.flatnonzero(np.diff(points) <= 0.0)
    if not wrong.size:
        return
    k = int(wrong[0])
    after = points[k + 1]
    what = "is given twice" if points[k] == after else f"is followed by {after:.9g}"
    raise ValueError(
        f"x does not ascend at {len(wrong)} places, the first x[{k}] = {points[k]:.9g} {what}: "
        "mend = True sorts x and averages the heights of equal x"
    )


def _ascending(x: Array, h: Array) -> tuple[Array, Array, int, bool]:
    """(x sorted, h with equal x averaged, how many fewer, whether x was in disorder)."""
    order = np.argsort(x, kind="stable")
    x, h, in_disorder = x[order], h[order], bool((np.diff(order) < 0).any())
    closest = SMALLEST_STEP * (0.5 * x[-1:] - 0.5 * x[:1])
    first = np.append(True, np.diff(x) > closest)[: len(x)]
    count = np.diff(np.append(np.flatnonzero(first), len(x)))
    means = np.bincount(np.cumsum(first) - 1, h) / count
    return x[first], means, len(x) - len(count), in_disorder


def _refuse_out_of_range(points: Array, heights: Array) -> None:
    length = 0.5 * points[-1] - 0.5 * points[0]
    size = max(float(np.abs(points).max()), float(np.abs(heights).max()))
    least = float(np.diff(points).min())
    if size > LONGEST or length < SHORTEST:
        what = f"reaches {size:.3g}" if size > LONGEST else f"is {2.0 * length:.3g} long"
        raise ValueError(
            f"the trace {what}: choose a unit in which its length and its heights are between "
            f"{SHORTEST:g} and {LONGEST:g}"
        )
    if least < SMALLEST_STEP * length:
        k = int(np.argmin(np.diff(points)))
        raise ValueError(
            f"x[{k}] = {points[k]:.17g} and x[{k + 1}] = {points[k + 1]:.17g} differ by rounding: "
            "leave one of them out, or give mend = True, which averages them"
        )


def _numbers(name: str, values: Any) -> Array:
    arguments.refuse_masked(name, values)
    try:
        given = np.asarray(values)
        array = np.array(given, dtype=float) if given.dtype.kind in "biufO" else None
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None:
        raise ValueError(f"{name} is not a list of numbers: give an array of floats")
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}: give a list of numbers")
    return array + 0.0  # no -0.0: equal traces have equal hashes


def smoothing_of(smoothing: Any, longest: float) -> Smoothing:
    """0, λ > 0 up to the longest that bends the trace, or "gcv". ValueError for anything else."""
    if arguments.among(smoothing, ("gcv",)):
        return "gcv"
    if isinstance(smoothing, str):
        raise ValueError(
            f'smoothing = {smoothing!r} is not known: give 0, a number λ > 0, or "gcv"'
        )
    lam = arguments.not_negative("smoothing", smoothing)
    if lam > longest:
        raise ValueError(
            f"smoothing = {lam:g} leaves a straight line of the trace: give less than {longest:.3g}"
        )
    return lam


def scaled(x: Array, h: Array, factors: tuple[float, float]) -> tuple[Array, Array]:
    """x and h times their factors. ValueError where a product is no double."""
    with np.errstate(over="ignore"):
        products = factors[0] * x, factors[1] * h
    if (np.isinf(products) & np.isfinite((x, h))).any():
        raise ValueError(
            f"scale = {factors!r} takes the trace beyond the range of doubles: {arguments.REMEDY}"
        )
    return products
