"""Where the pieces of a slope lie in a contact: in angles, to relative accuracy however thin a
piece or a rim is.

With sin²(ψ/2) = (x2 - x)/(2r), cos²(ψ/2) = (x - x1)/(2r), ψ the angle from the right edge, all that
is needed of a piece [A, B] comes from the square roots of its ends' distances, without differences
of nearly equal numbers:

    ψ_A - ψ_B = 2 atan2( (B - A)/(2r (sin ψ_A/2 cos ψ_B/2 + cos ψ_A/2 sin ψ_B/2)),  cos ψ_A/2 cos
    ψ_B/2 + sin ψ_A/2 sin ψ_B/2 )
    t - A     = 2r sin((ψ_A - ψ)/2) sin((ψ_A + ψ)/2)
"""

from __future__ import annotations

from copy import copy
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.profiles.slope import SEEN_JUMP, Slope

from .edge_functions import SquareRoot

Array = NDArray[np.float64]

NARROW_ANGLE = 0.02


class Geometry:
    """Where the pieces of a slope lie in the contact, in angles measured from the nearer edge, to
    relative accuracy.

    Only the first and the last piece can be cut by an edge. Building one costs a few microseconds:
    the search for the edges builds many.
    """

    def __init__(
        self, slope: Slope, contact: Interval, lower: float | None = None, keep_zero: bool = False
    ) -> None:
        """`lower` cuts off all that is left of it (the axis of a symmetric contact)."""
        b = slope.breaks
        floor, floor_tail = (contact.x1, contact.tail1) if lower is None else (lower, 0.0)
        first = max(int(b.searchsorted(floor, side="left" if floor_tail < 0.0 else "right")) - 1, 0)
        last = min(
            int(b.searchsorted(contact.x2, side="right" if contact.tail2 > 0.0 else "left")),
            len(b) - 1,
        )
        k = np.arange(first, last)
        if not keep_zero and slope.has_zero:
            k = k[~slope.is_zero[k]]
        self.slope, self.contact, self.k = slope, contact, k
        n = len(k)
        self.ends = ends = np.empty((2, n))  # of the pieces, lo and hi ...
        ends[0], ends[1] = b[k], b[k + 1]
        self.tails = np.zeros((2, n))  # ... and what their doubles miss
        # Distances of both ends from the left and the right edge (2, 2, K), over the contact's
        # width: cos² and sin² of half the angle from the right edge. Only the outer two ends can be
        # cut by an edge or by `lower`.
        width = 2.0 * contact.r
        distance = np.empty((2, 2, n))
        distance[0], distance[1] = contact.from_left(ends), contact.from_right(ends)
        length = ends[1] - ends[0]
        self.cut_left = self.cut_right = False
        if n and k[0] == first and ends[0, 0] <= floor:
            self.cut_left = lower is None
            ends[0, 0], self.tails[0, 0] = floor, floor_tail
            distance[:, 0, 0] = (
                (0.0, width)
                if lower is None
                else (contact.from_left(lower), contact.from_right(lower))
            )
            length[0] = distance[0, 1, 0] - distance[0, 0, 0]
        if n and k[-1] == last - 1 and ends[1, -1] >= contact.x2:
            self.cut_right = True
            ends[1, -1], self.tails[1, -1] = contact.x2, contact.tail2
            distance[:, 1, -1] = (width, 0.0)
            length[-1] = distance[1, 0, -1]
        self.length = length
        distance /= width
        self.left, self.right = distance
        self.root_left, self.root_right = np.sqrt(distance)
        self._all_right = lower is not None

    @cached_property
    def angles(self) -> tuple[Array, Array | float, Array]:
        """(angle of lo from the nearer edge, +1 if that edge is the left one else -1, angular
        length), each (K, 1).
        """
        (a, c), (b, d) = self.root_left, self.root_right
        angle = 2.0 * np.arctan2(
            self.length / (2.0 * self.contact.r * (b * c + a * d)), a * c + b * d
        )
        if self._all_right:
            return 2.0 * np.arctan2(b, a)[:, None], -1.0, angle[:, None]
        left = self.left[0] + self.left[1] < 1.0
        from_edge = np.arctan2(np.where(left, a, b), np.where(left, b, a))
        return 2.0 * from_edge[:, None], np.where(left, 1.0, -1.0)[:, None], angle[:, None]

    def part(self, chosen: NDArray[np.bool_]) -> Geometry:
        """Some of the pieces; quadrature only."""
        part = copy(self)
        part.k = self.k[chosen]
        part.ends, part.tails, part.length = (
            self.ends[:, chosen],
            self.tails[:, chosen],
            self.length[chosen],
        )
        part.left, part.right = self.left[:, chosen], self.right[:, chosen]
        part.root_left, part.root_right = self.root_left[:, chosen], self.root_right[:, chosen]
        part.cut_left, part.cut_right = (
            self.cut_left and bool(chosen[0]),
            self.cut_right and bool(chosen[-1]),
        )
        from_edge, sign, length = self.angles
        part.angles = (
            from_edge[chosen],
            sign[chosen] if isinstance(sign, np.ndarray) else sign,
            length[chosen],
        )
        return part

    def nodes(self, n: int) -> tuple[Array, Array, Array, Array | float]:
        """Gauss-Legendre in φ on every piece: offsets t - lo, angles from the nearer edge, weights,
        all (K, n), and signs.
        """
        g, w = chebyshev.gauss_legendre(n)
        from_edge, sign, length = self.angles
        half_step = (0.5 * length) * g
        middle = from_edge + sign * half_step
        # t - lo = r (sin φ - sin φ_lo) as a product: no cancellation, however thin the piece
        offset = (2.0 * self.contact.r) * np.sin(half_step) * np.sin(middle)
        return offset, middle + sign * half_step, length * w, sign

    @property
    def edge(self) -> SquareRoot:
        """The functions of the edges."""
        return SquareRoot(self.contact)

    @property
    def totals(self) -> Array:
        """∫ dt/w over every piece."""
        _, _, length = self.angles
        out: Array = length[:, 0]
        return out

    def charges(self, n: int) -> tuple[Array, Array]:
        """Offsets t - lo of n nodes, or more, and weights times H there."""
        offset, _, weight, _ = self.nodes(n)
        return offset, weight * self.slopes(offset)

    def slopes(self, offset: Array) -> Array:
        """H at lo + offset, (K, n)."""
        return self.slope.local(self.k, self.ends[0], self.tails[0], offset)

    def weighted_derivative(self, offset: Array, angle: Array, weight: Array, H: Array) -> Array:
        """H' times the weights at the nodes, which are at these angles from the nearer edge."""
        slope, lo, tail = self.slope, self.ends[0], self.tails[0]
        dH: Array = weight * slope.local_derivative(self.k, lo, tail, offset)
        if not slope.functions:
            return dH
        # H' dφ = dH / (r cos φ), with dH from the interpolant at the nodes
        functions = H - slope.without_functions.local(self.k, lo, tail, offset)
        functions[np.ptp(functions, axis=1) <= SEEN_JUMP * np.abs(H).max(axis=1)] = 0.0
        n = H.shape[1]
        steep = chebyshev.gauss_legendre(n)[1] * (functions @ chebyshev.differentiation(n)[0].T)
        return dH + steep / (self.contact.r * np.sin(angle))

    def chebyshev_slope(self, n: int) -> Array:
        """Chebyshev coefficients of H on every piece, from n points: (K, n)."""
        if n == 2 == self.slope.coefficients.shape[1] and not self.slope.functions:
            half = 0.5 * self.length
            return np.stack(
                (self.slopes(half[:, None])[:, 0], half * self.slope.coefficients[self.k, 1]),
                axis=1,
            )
        offset = (0.5 * self.length)[:, None] * (1.0 + chebyshev.points(n))
        return chebyshev.transform(self.slopes(offset))


def quadrature_order(degree: int) -> int:
    """Gauss-Legendre nodes for a polynomial slope of that degree on up to the whole contact,
    measured to reach rounding.
    """
    return 13 + int(1.15 * degree)


def narrow_order(degree: int) -> int:
    """The same on a piece of at most NARROW_ANGLE, where the angle adds 1e-16 to the polynomial's
    own degree.
    """
    return 3 + degree // 2
