"""A contact [x1, x2] whose edges are known beyond double precision.

Each edge is an unevaluated sum `x + tail` of two doubles, because the numerics need *distances*
from an edge to relative accuracy: the rounded edge of a nearly flat punch, b - a = 1e-12 a, has
only four digits left in the double nearest to b.

    t = m + r sin φ,     -π/2 <= φ <= π/2,     dt / w(t) = dφ,     w(t) = sqrt((t - x1)(x2 - t))
"""

from __future__ import annotations

from bisect import bisect_left
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

EPS = float(np.finfo(float).eps)
# A tail is kept where rounding the edge to a double would change its distance to the nearest break,
# or to the other edge, by more than this.
TAIL_MATTERS = 4.0 * EPS


def two_sum(a: Any, b: Any) -> tuple[Any, Any]:
    """a + b as the nearest double and the exact remainder (Knuth 1969)."""
    s = a + b
    c = s - a
    return s, (a - (s - c)) + (b - c)


SPLITTER = 2.0**27 + 1.0  # halves a double's digits


def two_product(a: Any, b: Any) -> tuple[Any, Any]:
    """a b as the nearest double and the exact remainder (Dekker 1971)."""
    p = a * b
    t = SPLITTER * a
    a1 = t - (t - a)
    t = SPLITTER * b
    b1 = t - (t - b)
    a2, b2 = a - a1, b - b1
    return p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2


def recentred(c: Array, tails: Array, old: Array, new: Array) -> tuple[Array, Array]:
    """Rows of polynomial coefficients (K, n) about new origins, by synthetic division (Horner).

    `tails` (K, 2) are what rounding took from c[:, :2], before and after. Both are exact where the
    origin stays, and on straight pieces.
    """
    c, (step, cut) = c.copy(), two_sum(new, -old)
    width = c.shape[1]
    if width > 1 and step.any():
        for j in range(width - 2, 0, -1):
            c[:, j] += step * c[:, j + 1]
        rise, rounded = two_product(step, c[:, 1])
        level, rest = two_sum(c[:, 0], rise)
        least = rounded + cut * c[:, 1] + step * tails[:, 1]
        c[:, 0], last = two_sum(level, (rest + tails[:, 0]) + least)
        tails = np.stack((last, tails[:, 1]), axis=1)
        for i in range(1, width - 1):
            for j in range(width - 2, i - 1, -1):
                c[:, j] += step * c[:, j + 1]
    return c, tails


class Interval(NamedTuple):
    """The contact [x1 + tail1, x2 + tail2]."""

    x1: float
    x2: float
    tail1: float = 0.0
    tail2: float = 0.0

    @property
    def r(self) -> float:
        """Half-width."""
        return 0.5 * ((self.x2 - self.x1) + (self.tail2 - self.tail1))

    @property
    def m(self) -> float:
        """Centre."""
        return 0.5 * ((self.x1 + self.x2) + (self.tail1 + self.tail2))

    # Distances from the edges; they take anything that subtracts (floats, arrays, complex arrays).
    def from_left(self, x: Any) -> Any:
        return (x - self.x1) - self.tail1 if self.tail1 else x - self.x1

    def from_right(self, x: Any) -> Any:
        return (self.x2 - x) + self.tail2 if self.tail2 else self.x2 - x

    def s(self, x: Any) -> Any:
        """(x - m) / r, in [-1, 1] on the contact."""
        return (self.from_left(x) - self.from_right(x)) / (2.0 * self.r)

    def moved(self, dx1: float, dx2: float) -> Interval:
        """The interval with its edges moved, without rounding."""
        x1, tail1 = two_sum(self.x1, dx1 + self.tail1)
        x2, tail2 = two_sum(self.x2, dx2 + self.tail2)
        return Interval(x1, x2, tail1, tail2)

    def mirrored(self) -> Interval:
        return Interval(-self.x2, -self.x1, -self.tail2, -self.tail1)

    def rounded(self, breaks: tuple[float, ...]) -> Interval:
        """The same without the tails where these change no distance to a break.

        The printed edges are then those that are used.
        """
        tails = [0.0, 0.0]
        for i, (x, tail) in enumerate(((self.x1, self.tail1), (self.x2, self.tail2))):
            if tail:
                k = bisect_left(breaks, x)
                nearest = min(
                    [
                        self.x2 - self.x1,
                        *(abs((x - b) + tail) for b in breaks[max(k - 1, 0) : k + 1]),
                    ]
                )
                if abs(tail) > TAIL_MATTERS * nearest:
                    tails[i] = tail
        return Interval(float(self.x1), float(self.x2), float(tails[0]), float(tails[1]))


def interval_about(centre: float, half_width: float) -> Interval:
    """[centre - half_width, centre + half_width] without rounding."""
    x1, tail1 = two_sum(centre, -half_width)
    x2, tail2 = two_sum(centre, half_width)
    return Interval(x1, x2, tail1, tail2)


def inner(contact: Interval, x: Array) -> Array:
    """The x that lie strictly inside the contact."""
    within: Array = x[(contact.from_left(x) > 0.0) & (contact.from_right(x) > 0.0)]
    return within


def angles(contact: Interval, x: Array) -> Array:
    """Angles ψ of ascending x from the right edge, x = m + r cos ψ, ascending."""
    psi: Array = 2.0 * np.arctan2(np.sqrt(contact.from_right(x)), np.sqrt(contact.from_left(x)))
    return psi[::-1]


def position(contact: Interval, angle: Array) -> Array:
    """x = m + r cos ψ, counted from the nearer edge."""
    right = (contact.x2 - 2.0 * contact.r * np.sin(0.5 * angle) ** 2) + contact.tail2
    left = (contact.x1 + 2.0 * contact.r * np.cos(0.5 * angle) ** 2) + contact.tail1
    return np.where(angle < 0.5 * np.pi, right, left)
