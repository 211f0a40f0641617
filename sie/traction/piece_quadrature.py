"""The positions of the pieces of a slope in a contact, and the quadrature on each of them.

With sin²(ψ/2) = (x2 - x)/(2r), cos²(ψ/2) = (x - x1)/(2r), ψ the angle from the right edge, all
quantities of a piece [A, B] follow from the square roots of its ends' distances, without
differences of nearly equal numbers. So they have relative accuracy however thin a piece or a
rounded edge is:

    ψ_A - ψ_B = 2 atan2((B - A)/(2r (a d + b c)), b d + a c)
    a, b = sin ψ_A/2, cos ψ_A/2,      c, d = sin ψ_B/2, cos ψ_B/2
    t - A     = 2r sin((ψ_A - ψ)/2) sin((ψ_A + ψ)/2)

The rules for dt/w on the pieces go with it. `Geometry` has Gauss-Legendre in the angle, where w is
a square root at both edges. `SlidingGeometry` has, for the exponents 1/2 ± ε, Gauss-Jacobi in the
angle on a piece that ends at an edge, and Gauss-Legendre in ln τ, τ = (t - x1)/(x2 - t), on others.
"""

from __future__ import annotations

import math
from copy import copy
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override
from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import Interval
from sie.profiles.slope import SEEN_JUMP, Slope

from .edge_functions import Powers, SquareRoot

Array = NDArray[np.float64]

NARROW_ANGLE = 0.02
# Gauss-Legendre nodes for each e-fold of the distance from an edge, beyond those of a smooth
# integrand.
NODES_PER_FOLD = 3
SPARE = 6
LONG = 1e16  # a ratio of distances to which 1 adds nothing
FOLDS = 46.0  # e^-46 is nothing beside rounding
SHORTEST = 1e-300  # half a length that may be divided by


class Geometry:
    """The pieces of a slope in the contact, in angles from the nearer edge, to relative accuracy.

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
        last = int(b.searchsorted(contact.x2, side="right" if contact.tail2 > 0.0 else "left"))
        last = min(last, len(b) - 1)
        k = np.arange(first, last)
        if not keep_zero and slope.has_zero:
            k = k[~slope.is_zero[k]]
        self.slope, self.contact, self.k = slope, contact, k
        n = len(k)
        self.ends = ends = np.empty((2, n))  # of the pieces, lo and hi ...
        ends[0], ends[1] = b[k], b[k + 1]
        self.tails = np.zeros((2, n))  # ... and what their doubles miss
        # Distances (2, 2, K) of both ends from the left and the right edge, over the contact's
        # width: cos² and sin² of half the angle from the right edge. Only outer ends can be cut.
        width = 2.0 * contact.r
        distance = np.empty((2, 2, n))
        distance[0], distance[1] = contact.from_left(ends), contact.from_right(ends)
        length = ends[1] - ends[0]
        self.cut_left = self.cut_right = False
        if n and k[0] == first and ends[0, 0] <= floor:
            self.cut_left = lower is None
            ends[0, 0], self.tails[0, 0] = floor, floor_tail
            distance[:, 0, 0] = 0.0, width
            if lower is not None:
                distance[:, 0, 0] = contact.from_left(lower), contact.from_right(lower)
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
        """(angle of lo from the nearer edge, sign of that edge, angular length), each (K, 1).

        The sign is +1 if the nearer edge is the left one, else -1.
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
        part.k, part.length = self.k[chosen], self.length[chosen]
        for name in ("ends", "tails", "left", "right", "root_left", "root_right"):
            setattr(part, name, getattr(self, name)[:, chosen])
        part.cut_left = self.cut_left and bool(chosen[0])
        part.cut_right = self.cut_right and bool(chosen[-1])
        from_edge, sign, length = self.angles
        part.angles = (
            from_edge[chosen],
            sign[chosen] if isinstance(sign, np.ndarray) else sign,
            length[chosen],
        )
        return part

    def nodes(self, n: int) -> tuple[Array, Array, Array, Array | float]:
        """Gauss-Legendre nodes in φ on every piece.

        These are offsets t - lo, angles from the nearer edge and weights, all (K, n), and signs.
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
        lo, tail = self.ends[0][:, None], self.tails[0][:, None]
        H: Array = self.slope.value(self.k[:, None], lo, tail + offset)
        return H

    def weighted_derivative(self, offset: Array, weight: Array) -> Array:
        """H' times the weights at the nodes; where there are functions, of the pieces' series."""
        slope, lo, tail = self.slope, self.ends[0][:, None], self.tails[0][:, None]
        if not slope.functions:
            dH: Array = weight * slope.derivative.value(self.k[:, None], lo, tail + offset)
            return dH
        half = np.maximum(0.5 * self.length[:, None], SHORTEST)
        series = self.chebyshev_slope(max(slope.degree + 1, 2))
        rounded = np.abs(series[:, 1:]).sum(axis=1) <= SEEN_JUMP * np.abs(series[:, 0])
        series[rounded] = 0.0
        slopes = np.polynomial.chebyshev.chebder(series, axis=1)
        # H rises by what its values beside the ends say, resolved or not
        ulp = np.spacing(np.abs(self.ends))
        low, high = slope.value(self.k, self.ends, self.tails + ulp * [[1.0], [-1.0]])
        slopes[:, 0] += 0.5 * (high - low) - series[:, 1::2].sum(axis=1)
        T = chebyshev.polynomials(slopes.shape[1], offset / half - 1.0)
        return np.asarray(weight * np.einsum("nkm,kn->km", T, slopes) / half)

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


class SlidingGeometry(Geometry):
    """Pieces in the contact with quadrature for dt/w.

    It is Gauss-Jacobi in the angle on a piece that ends at an edge, Gauss-Legendre in ln τ on
    others. The slope is broken at the middle of the contact, so that no piece comes near both
    edges.
    """

    def __init__(
        self, slope: Slope, contact: Interval, epsilon: float, keep_zero: bool = False
    ) -> None:
        lo, hi = slope.domain
        broken = slope.split_at(contact.m) if lo < contact.m < hi else slope
        super().__init__(broken, contact, keep_zero=keep_zero)
        self.epsilon = epsilon

    @property
    @override
    def edge(self) -> Powers:
        return Powers(self.contact, self.epsilon)

    @property
    @override
    def totals(self) -> Array:
        _, _, weight, _ = self.nodes(quadrature_order(0))
        out: Array = weight.sum(axis=1)
        return out

    def nodes(self, n: int) -> tuple[Array, Array, Array, Array]:
        """Nodes and weights of dt/w on every piece, (K, N) with N >= n, and signs.

        The nodes are offsets t - lo and angles from the nearer edge. The sign is +1 where the left
        edge is the nearer. The nodes that a piece does not need have the weight 0.
        """
        folds, left = self._folds, self.left[0] + self.left[1] < 1.0
        # Nearer to an edge than that, what is left of dt/w is rounding of the piece
        interior = folds < FOLDS / (0.5 - abs(self.epsilon))
        n += SPARE
        most = n + math.ceil(NODES_PER_FOLD * float(folds[interior].max(initial=0.0)))
        offset, angle, weight = np.zeros((3, len(self.k), most))
        offset[interior], angle[interior], weight[interior] = self._between(
            interior, left[interior], most
        )
        for k in np.flatnonzero(~interior).tolist():
            offset[k, :n], angle[k, :n], weight[k, :n] = self._at_edge(k, bool(left[k]), n)
        return offset, angle, weight, np.where(left, 1.0, -1.0)[:, None]

    @property
    def _folds(self) -> Array:
        """ln τ_hi/τ_lo of every piece; infinite where it ends at an edge."""
        (a, c), (b, d) = self.root_left, self.root_right
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            rise = self.length / (2.0 * self.contact.r * (a * d) ** 2)
            # As a quotient it overflows where an end is the least double away from an edge
            long = 2.0 * (np.log(c / a) + np.log(b / d))
            folds: Array = np.where(rise < LONG, np.log1p(rise), long)
        folds[(a == 0.0) | (d == 0.0)] = np.inf
        return folds

    def _between(
        self, inner: NDArray[np.bool_], left: NDArray[np.bool_], n: int
    ) -> tuple[Array, Array, Array]:
        """The nodes on the pieces that end at no edge; `left` where the left one is the nearer.

        ln τ is counted from the end that is farther from the nearer edge. `near` and `other` are
        the distances from that edge and from the other one over the width, there and at the nodes.
        """
        (a, c), (b, d) = self.root_left[:, inner], self.root_right[:, inner]
        left, folds = left[:, None], self._folds[inner, None]
        g, w = chebyshev.gauss_legendre(n)
        near, other = (
            np.where(left, at_left[:, None], at_right[:, None]) ** 2
            for at_left, at_right in ((c, b), (d, a))
        )
        near = near * np.exp(-folds * np.where(left, g[::-1], g))
        near, other = near / (near + other), other / (near + other)
        from_left, from_right = np.where(left, near, other), np.where(left, other, near)
        offset = 2.0 * self.contact.r * (b**2)[:, None] * from_left * -np.expm1(-folds * g)
        weight = folds * w * from_left ** (0.5 - self.epsilon) * from_right ** (0.5 + self.epsilon)
        return offset, 2.0 * np.arcsin(np.sqrt(near)), weight

    def _at_edge(self, k: int, at_left: bool, n: int) -> tuple[Array, Array, Array]:
        """The nodes on the piece between an edge and some point.

        The singular factor ψ^(∓2ε) of dt/w is in the rule's weights.
        """
        sign = -2.0 * self.epsilon if at_left else 2.0 * self.epsilon
        g, _, w = gauss_jacobi(n, 0.0, sign)
        root_near, root_far = (
            (self.root_left[1, k], self.root_right[1, k])
            if at_left
            else (self.root_right[0, k], self.root_left[0, k])
        )
        whole = 2.0 * math.atan2(root_near, root_far)
        angle = whole * g
        # t - lo, from the left edge, or from lo towards the right edge, as products
        swept, other = (angle, 0.0 * angle) if at_left else (whole - angle, angle)
        offset = 2.0 * self.contact.r * np.sin(0.5 * swept) * np.sin(0.5 * swept + other)
        smooth = (np.tan(0.5 * angle) / g) ** sign if whole else 1.0
        return offset, angle, whole * w * smooth


def quadrature_order(degree: int) -> int:
    """Gauss-Legendre nodes for a polynomial slope of that degree on up to the whole contact.

    The number was measured to reach rounding.
    """
    return 13 + int(1.15 * degree)


def narrow_order(degree: int) -> int:
    """The number of nodes for that degree on a piece of at most NARROW_ANGLE.

    The angle there adds 1e-16 to the polynomial's own degree.
    """
    return 3 + degree // 2
