"""Whether a profile is convex: then its contact is one patch, and all of it is `edges`.

For h' that rises all over the indenter, p > 0 in the one contact [x1, x2] with smooth or sharp
edges, and the gap beside it is positive: the solution is the only one. Polynomials are judged by
their derivative on each piece, functions from place to place (`profiles.look`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.profiles import look
from sie.profiles.lowest_points import finite_ends
from sie.profiles.slope import JUMP, Slope

Array = NDArray[np.float64]

PER_DEGREE = 16  # places on a piece, for each degree of the slope beyond the second


def rises(slope: Slope, window: tuple[float, float]) -> bool:
    """Whether h' rises on the whole indenter; functions are looked at closely in the window."""
    if not slope.functions:
        return _pieces_rise(slope)
    left, right = look.beside(window, slope)
    return rises_at(np.concatenate((left, look.across(slope, window), right)), slope)


def rises_beside(contact: tuple[float, float], slope: Slope) -> bool:
    """Whether h' rises on both sides of a contact in which it does."""
    return rises_at(np.concatenate(look.beside(contact, slope)), slope)


def rises_at(x: Array, slope: Slope) -> bool:
    """Whether h' rises from each of the ascending places to the next."""
    return not look.falls(look.values(slope, x)).any()


def turns_away(slope: Slope, contact: tuple[float, float]) -> bool:
    """Whether h' jumps down inside a contact: p is -inf there, on a part too short for doubles."""
    if slope.continuous:
        return False
    inside = (b for b in slope.break_points if contact[0] < b < contact[1])
    return any(slope.corner(b)[0] < 0.0 for b in inside)


def may_have_merged(slope: Slope, contact: tuple[float, float]) -> bool:
    """Whether h' falls between parts of a contact on which it rises: these may have touched apart.

    As one patch grows from the first touch on, h' falls at most towards its edges.
    """
    falling = look.falls(look.values(slope, look.across(slope, contact)))
    rising = np.flatnonzero(~falling)
    return bool(rising.size) and bool(falling[rising[0] : rising[-1]].any())


def _pieces_rise(slope: Slope) -> bool:
    """The same of polynomials; h'' of the second degree is lowest at an end of its piece."""
    ends, k = finite_ends(slope), np.arange(len(slope.origins))
    length, degree = np.diff(ends, axis=1), slope.coefficients.shape[1] - 1
    inner = chebyshev.points(PER_DEGREE * degree) if degree > 2 else np.zeros(0)
    s = 0.5 * (1.0 + np.concatenate(([-1.0], inner, [1.0])))
    at = k[:, None], ends[:, :1], length * s
    H, rise = slope.value(*at), slope.derivative.value(*at) * length
    size = np.abs(H).max(axis=1, keepdims=True)
    # coefficients that are given about x = 0 are rounded there
    steep = np.abs(rise / length).max(axis=1)
    far = np.abs(ends[1:, 0]) * np.maximum(steep[1:], steep[:-1])
    jump = H[1:, 0] - H[:-1, -1] + JUMP * np.maximum(size.max(), far)
    return bool((rise >= -look.ROUNDING * size).all() and (jump >= 0.0).all())
