"""Quadrature for dt/w over the pieces of a slope where the exponents of w are 1/2 ± ε.

Next to an edge Gauss-Jacobi in the angle, elsewhere Gauss-Legendre in ln τ, τ = (t - x1)/(x2 - t).
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval
from sie.profiles.slope import Slope

from .edge_functions import Powers
from .piece_quadrature import Geometry, quadrature_order

Array = NDArray[np.float64]

# Gauss-Legendre nodes for each e-fold of the distance from an edge, beyond those of a smooth
# integrand.
NODES_PER_FOLD = 3
SPARE = 6
SHORTEST = 1e-300  # half a length that may be divided by


class SlidingGeometry(Geometry):
    """Pieces in the contact with quadrature for dt/w: Gauss-Jacobi in the angle on a piece that
    ends at an edge, Gauss-Legendre in ln τ on others. The slope is broken at the middle of the
    contact, so that no piece comes near both edges."""

    def __init__(
        self, slope: Slope, contact: Interval, epsilon: float, keep_zero: bool = False
    ) -> None:
        lo, hi = slope.domain
        broken = slope.split_at(contact.m) if lo < contact.m < hi else slope
        super().__init__(broken, contact, keep_zero=keep_zero)
        self.epsilon = epsilon

    @property
    def edge(self) -> Powers:
        return Powers(self.contact, self.epsilon)

    @property
    def totals(self) -> Array:
        _, _, weight, _ = self.nodes(quadrature_order(0))
        out: Array = weight.sum(axis=1)
        return out

    def nodes(self, n: int) -> tuple[Array, Array, Array, Array]:
        """Offsets t - lo, angles from the nearer edge, weights of dt/w, (K, N) with N >= n, and +1
        where the left edge is the nearer.
        """
        a, b, d = self.root_left[0], self.root_right[0], self.root_right[1]
        width = 2.0 * self.contact.r
        with np.errstate(divide="ignore", over="ignore"):
            folds = np.log1p(self.length / (width * (a * d) ** 2))  # ln τ_hi / τ_lo
        interior = np.isfinite(folds)
        n += SPARE + math.ceil(NODES_PER_FOLD * float(folds[interior].max(initial=0.0)))
        left = self.left[0] + self.left[1] < 1.0
        offset, angle, weight = np.empty((3, len(self.k), n))
        g, w = chebyshev.gauss_legendre(n)
        u = folds[interior, None] * g
        from_left = (
            (a[interior] ** 2)[:, None]
            * np.exp(u)
            / ((b[interior] ** 2)[:, None] + (a[interior] ** 2)[:, None] * np.exp(u))
        )
        from_right = (b[interior] ** 2)[:, None] / (
            (b[interior] ** 2)[:, None] + (a[interior] ** 2)[:, None] * np.exp(u)
        )
        offset[interior] = width * (a[interior] ** 2)[:, None] * np.expm1(u) * from_right
        angle[interior] = 2.0 * np.arcsin(
            np.sqrt(np.where(left[interior, None], from_left, from_right))
        )
        weight[interior] = (
            folds[interior, None]
            * w
            * from_left ** (0.5 - self.epsilon)
            * from_right ** (0.5 + self.epsilon)
        )
        for k in np.flatnonzero(~interior).tolist():
            offset[k], angle[k], weight[k] = self._at_edge(k, n)
        return offset, angle, weight, np.where(left, 1.0, -1.0)[:, None]

    def _at_edge(self, k: int, n: int) -> tuple[Array, Array, Array]:
        """The piece between an edge and some point: the singular factor ψ^(∓2ε) of dt/w is in the
        rule's weights.
        """
        at_left = self.cut_left and k == 0
        sign = -2.0 * self.epsilon if at_left else 2.0 * self.epsilon
        g, w = edge_rule(n, sign)
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
        smooth = (np.tan(0.5 * angle) / g) ** sign
        return offset, angle, whole * w * smooth

    def weighted_derivative(self, offset: Array, angle: Array, weight: Array, H: Array) -> Array:
        """The same from each piece's Chebyshev series: it steers Newton's steps only."""
        half = np.maximum(0.5 * self.length[:, None], SHORTEST)
        series = self.chebyshev_slope(max(self.slope.degree + 1, 2))
        # rounding on a piece that short
        straight = np.abs(series[:, 1:]).sum(axis=1) <= 4.0 * EPS * np.abs(series[:, 0])
        series[straight] = 0.0
        slopes = np.polynomial.chebyshev.chebder(series, axis=1)
        T = chebyshev.polynomials(slopes.shape[1], offset / half - 1.0)
        dH: Array = weight * np.einsum("nkm,kn->km", T, slopes) / half
        return dH


@lru_cache(maxsize=64)
def edge_rule(n: int, power: float) -> tuple[Array, Array]:
    """∫_0^1 u^power f du, power > -1: nodes and weights."""
    from scipy.special import roots_jacobi  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

    s, w = roots_jacobi(n, 0.0, power)
    g, w = 0.5 * (1.0 + s), w * 2.0 ** (-1.0 - power)
    g.flags.writeable = w.flags.writeable = False
    return g, w
