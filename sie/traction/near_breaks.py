"""V(x) next to a break where H is continuous, on the contact.

The two pieces that meet at a break e add to V

    (H_left(x) - H_right(x)) L_e(x),        L_e ~ ln|x - e|

and nothing at e. Of a function's two series the difference there is what these miss, and rounding,
which the logarithm multiplies by up to 36. Nearer than a distance d that is a small part of both
pieces, L_e keeps its value at that distance, and what this leaves out is taken of the divided
differences D = (H(x) - H(e))/(x - e), which are polynomials:

    (x - e)(D_left(x) - D_right(x)) ln(|x - e|/d)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .edge_functions import BreakFunction

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class ContinuousBreaks:
    """The breaks between neighbouring pieces, ascending; e, e_left, e_right and d are (B,).

    e           the break
    e_left      sqrt((e - x1)/2r)
    e_right     sqrt((x2 - e)/2r)
    d           the distance up to which a point is near; 0 where H jumps
    r           half-width of the contact
    series      Chebyshev series of the pieces, (B + 1, n)
    half        half-lengths of the pieces, (B + 1,)
    """

    e: Array
    e_left: Array
    e_right: Array
    d: Array
    r: float
    series: Array
    half: Array

    @cached_property
    def level(self) -> Array:
        """L_e at the distance d, but for a constant of the size 1 where ε is not 0."""
        near = self.d > 0.0
        level = np.zeros(len(near))
        level[near] = np.log(self.d[near]) - math.log(8.0 * self.r)
        level[near] -= 2.0 * np.log((self.e_left * self.e_right)[near])
        return level

    @cached_property
    def divided(self) -> list[tuple[Array, Array]]:
        """D in T_n(s), per unit of s, and the half-length: of the left and of the right piece."""
        return [
            (chebyshev.divided(self.series[pieces], end).T, self.half[pieces])
            for pieces, end in ((slice(-1), 1.0), (slice(1, None), -1.0))
        ]

    def near(self, x: Array) -> tuple[Index, Index]:
        """The indices of the ascending points x that are near a break, and of these breaks."""
        first, last = x.searchsorted(self.e - self.d), x.searchsorted(self.e + self.d, "right")
        count = np.where(self.d > 0.0, last - first, 0)
        which = np.repeat(np.arange(len(count)), count)
        if not which.size:
            return which, which
        start = np.cumsum(count) - count
        return first[which] + np.arange(len(which)) - start[which], which

    def levelled(
        self, function_of: BreakFunction, near: tuple[Index, Index], size: int
    ) -> BreakFunction:
        """The function of a break, with its level at those of `size` points that are near it."""
        e, level = np.full((2, size), np.nan)
        e[near[0]], level[near[0]] = self.e[near[1]], self.level[near[1]]

        def other(of: Any, of_left: Any, of_right: Any, at: Any) -> Any:
            L = function_of(of, of_left, of_right, at)
            here = e[at] == of
            L[here] = level[at][here]
            return L

        return other

    def left_out(self, function_of: BreakFunction, near: tuple[Index, Index], x: Array) -> Array:
        """(x - e)(D_left - D_right)(L_e - level) at the points near breaks."""
        i, k = near
        offset = x[i] - self.e[k]
        difference = np.zeros(len(k))
        for (D, half), end in zip(self.divided, (1.0, -1.0), strict=True):
            if len(D):
                in_s = offset / half[k]
                difference += end * in_s * chebyshev.evaluate(D[:, k], end + in_s)
        L = function_of(self.e[k], self.e_left[k], self.e_right[k], i)
        added: Array = difference * (L - self.level[k])
        return added
