"""The integrals over a contact that fix its edges.

They are sums of the pieces' rules for dt/w (`piece_quadrature`), exact to rounding, derivatives and
jumps included. The formulas have two forms: arrays for many pieces, plain floats for a few, where
the overhead of NumPy's calls would be most of the cost of a solve.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.traction.piece_quadrature import (
    NARROW_ANGLE,
    Geometry,
    SlidingGeometry,
    narrow_order,
    quadrature_order,
)

if TYPE_CHECKING:
    from sie.numerics.interval import Interval
    from sie.profiles.slope import Row, Slope

Array = NDArray[np.float64]

# Up to this angle of a piece a shorter rule reaches rounding.
NARROW = 0.5 * math.pi + 0.01
# So many narrow pieces are worth a pass of their own.
MANY = 24


class EdgeIntegrals(NamedTuple):
    """The integrals of H over the contact, with dt/w = dφ and s = (t - m)/r = sin φ where ε = 0.

    I0      ∫H dt/w = positive - negative
    I1      ∫H s dt/w
    C2      ∫H (1 - s² - 2ε s - 2ε²) dt/w
    JR, JL  ∫H' (1 + s) dt/w and ∫H' (1 - s) dt/w; apart, because one of them may be a tiny part of
            their sum
    size1   bounds ∫Σ|c_j y^j| (1 - s) dt/w, every term of H taken positively: rounding of
            K1 = I1 - I0 is relative to it
    size2   the same with 1 + s, for K2 = I1 + I0
    """

    I0: float
    I1: float
    C2: float
    JR: float
    JL: float
    positive: float
    negative: float
    size1: float
    size2: float

    def mirrored(self) -> EdgeIntegrals:
        """The integrals of h(-x) on the mirrored contact."""
        return EdgeIntegrals(
            -self.I0,
            self.I1,
            -self.C2,
            self.JL,
            self.JR,
            self.negative,
            self.positive,
            self.size2,
            self.size1,
        )

    def settled(self, before: Interval, after: Interval, target: float) -> EdgeIntegrals:
        """The integrals of the contact with smooth edges that carries target = P/G.

        The last small step leads to it from the contact where these were taken.

        That step adds p ~ (α + β (x - m)) / sqrt(r² - (x - m)²), which takes the tilt I0/π back:
        the moment about x = 0 becomes G (m target - r² C2) with the m, r and C2 from before.
        """
        moved = 0.5 * (
            (after.x1 - before.x1)
            + (after.x2 - before.x2)
            + (after.tail1 - before.tail1)
            + (after.tail2 - before.tail2)
        )
        C2 = (before.r**2 * self.C2 + moved * target) / after.r**2
        return self._replace(I0=0.0, I1=target / after.r, C2=C2)

    def balanced(self, r: float) -> EdgeIntegrals:
        """The integrals of the contact moved sideways until I0 = 0, for a small I0.

        To first order, with 2 dI0 = (JR + JL) dm, 2 dI1 = (JR - JL) dm and dC2 = I1/r dm.
        """
        rise = self.JR + self.JL
        I1 = self.I1 - self.I0 * (self.JR - self.JL) / rise
        return self._replace(I0=0.0, I1=I1, C2=self.C2 - 2.0 * self.I0 / rise * self.I1 / r)


NOTHING = EdgeIntegrals(*(0.0,) * 9)


def edge_integrals(
    slope: Slope,
    contact: Interval,
    lower: float | None = None,
    keep_zero: bool = False,
    epsilon: float = 0.0,
) -> EdgeIntegrals:
    """The integrals over the contact.

    With `lower` (the axis of a symmetric one) they are taken over the half right of it.
    """
    if not contact.r < math.inf:
        raise OverflowError("an edge of the contact is beyond all doubles")
    if slope.few and not keep_zero and not epsilon:
        found = _of_few(slope, contact, lower)
    else:
        # A search may try a contact of 1e-300: what overflows there is not rising
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            if not epsilon:
                found = _of_many(Geometry(slope, contact, lower, keep_zero))
            else:
                g = SlidingGeometry(slope, contact, epsilon, keep_zero)
                found = _summed(g, quadrature_order(g.slope.degree))
    return found if slope.continuous else _with_jumps(found, slope, contact, lower, epsilon)


def _with_jumps(
    found: EdgeIntegrals, slope: Slope, contact: Interval, lower: float | None, epsilon: float
) -> EdgeIntegrals:
    """JR and JL with what the jumps of H add, (1 ± s)/w of each; at `lower` half of one is in."""
    JR, JL = found.JR, found.JL
    for b, rise in slope.jumps:
        left, right = contact.from_left(b), contact.from_right(b)
        if left > 0.0 and right > 0.0 and (lower is None or b >= lower):
            steep = math.sqrt(left) / math.sqrt(right)
            added = (0.5 if b == lower else 1.0) * rise / contact.r * steep ** (-2.0 * epsilon)
            JR += added * steep
            JL += added / steep
    return found._replace(JR=JR, JL=JL)


# -- arrays ----------------------------------------------------------------------------------------


def _of_many(g: Geometry) -> EdgeIntegrals:
    order, narrow = quadrature_order(g.slope.degree), g.angles[2][:, 0] <= NARROW_ANGLE
    if g.slope.functions or np.count_nonzero(narrow) < MANY:
        return _summed(g, order)
    wide = NOTHING if narrow.all() else _summed(g.part(~narrow), order)
    short = _summed(g.part(narrow), narrow_order(g.slope.degree))
    return EdgeIntegrals(*map(float.__add__, wide, short))


def _summed(g: Geometry, order: int) -> EdgeIntegrals:
    if not len(g.k):
        return NOTHING
    offset, angle, weight, sign = g.nodes(order)
    H = g.slopes(offset)
    WH = weight * H
    # 1 + s from the left edge, 1 - s from the right one
    near = 2.0 * np.sin(0.5 * angle) ** 2
    s, left = sign * (near - 1.0), np.asarray(sign > 0.0)
    plus, minus = np.where(left, near, 2.0 - near), np.where(left, 2.0 - near, near)
    dJ = g.weighted_derivative(offset, weight)
    JR, JL = float(np.vdot(dJ, plus)), float(np.vdot(dJ, minus))
    e = g.edge.epsilon
    C2 = float(np.vdot(WH, plus * minus - 2.0 * e * (e + s) if e else plus * minus))
    positive, negative = _sum(np.maximum(WH, 0.0)), -_sum(np.minimum(WH, 0.0))
    I0, I1 = _sum(WH), float(np.vdot(WH, s))
    return EdgeIntegrals(I0, I1, C2, JR, JL, positive, negative, *_sizes(g, weight, H))


def _sizes(g: Geometry, weight: Array, H: Array) -> tuple[float, float]:
    """size1 and size2: of each piece its largest Σ|c_j y^j| and 1 -+ sin φ, times its angle."""
    slope = g.slope
    start = (g.ends[0] - slope.origins[g.k]) + g.tails[0]
    farthest = np.maximum(np.abs(start), np.abs(start + g.length))
    size = np.zeros(len(g.k))
    for c in np.abs(slope.coefficients[g.k]).T[::-1]:
        size = size * farthest + c
    if slope.functions:
        size += np.abs(H).max(axis=1)
    size *= weight.sum(axis=1)
    return 2.0 * float(size @ g.right[0]), 2.0 * float(size @ g.left[1])


def _sum(a: Array) -> float:
    return float(np.add.reduce(a, axis=None))


# -- plain floats ----------------------------------------------------------------------------------


class _Cut(NamedTuple):
    """One piece in the contact; see `Geometry`: roots of the distances of lo and hi, and angles."""

    base: float  # lo - origin
    length: float
    # lo from left, lo from right, hi from left, hi from right
    roots: tuple[float, float, float, float]
    from_edge: float
    sign: float
    angle: float


def _of_few(slope: Slope, contact: Interval, lower: float | None) -> EdgeIntegrals:
    width, degree, total = 2.0 * contact.r, slope.degree, None
    for row in slope.rows:
        cut = _cut(row, contact, lower, width)
        if cut is not None:
            more = _integrals(row.coefficients, cut, width, degree)
            total = tuple(map(float.__add__, total, more)) if total else more
    return EdgeIntegrals(*total) if total else NOTHING


def _cut(row: Row, contact: Interval, lower: float | None, width: float) -> _Cut | None:
    """The piece within the contact (right of `lower`), None if nothing of it is."""
    if lower is not None and row.hi <= lower:
        return None
    start, tail = row.lo, 0.0
    if lower is not None and start < lower:
        start = lower
    lo_left, lo_right = contact.from_left(start), contact.from_right(start)
    hi_left, hi_right = contact.from_left(row.hi), contact.from_right(row.hi)
    if hi_left <= 0.0 or lo_right <= 0.0 or row.hi <= start:
        return None
    length = row.hi - start
    at_left, at_right = lo_left <= 0.0, hi_right <= 0.0
    if at_left:
        start, tail, lo_left, lo_right, length = contact.x1, contact.tail1, 0.0, width, hi_left
    if at_right:
        hi_left, hi_right, length = width, 0.0, lo_right
    a = math.sqrt(lo_left / width)
    b = math.sqrt(lo_right / width)
    c = math.sqrt(hi_left / width)
    d = math.sqrt(hi_right / width)
    angle = 2.0 * math.atan2(length / (width * (b * c + a * d)), a * c + b * d)
    left = lo_left + hi_left < width
    from_edge = 2.0 * (math.atan2(a, b) if left else math.atan2(b, a))
    return _Cut(
        (start - row.origin) + tail, length, (a, b, c, d), from_edge, 1.0 if left else -1.0, angle
    )


def _integrals(c: tuple[float, ...], cut: _Cut, width: float, degree: int) -> tuple[float, ...]:
    I0 = I1 = C2 = J_near = J_far = positive = negative = 0.0
    base, from_edge, sign, angle = cut.base, cut.from_edge, cut.sign, cut.angle
    sin, short = math.sin, angle <= NARROW
    for g, weight in _rule(5 + degree + int(4.0 * angle) if short else quadrature_order(degree)):
        half_step = 0.5 * angle * g
        middle = from_edge + sign * half_step
        y = base + width * sin(half_step) * sin(middle)
        H, dH = c[0], 0.0
        for v in c[1:]:
            dH = dH * y + H
            H = H * y + v
        at = middle + sign * half_step
        # 1 + sin φ from the left edge, 1 - sin φ from the right one.
        near = 2.0 * sin(0.5 * at) ** 2
        cos_phi, sin_phi = sin(at), sign * (near - 1.0)
        w = angle * weight
        wH, wdH = w * H, w * dH
        I0 += wH
        I1 += wH * sin_phi
        C2 += wH * cos_phi * cos_phi
        J_near += wdH * near
        J_far += wdH * (2.0 - near)
        if wH > 0.0:
            positive += wH
        else:
            negative -= wH
    JR, JL = (J_near, J_far) if sign > 0.0 else (J_far, J_near)
    farthest, size = max(abs(base), abs(base + cut.length)), 0.0
    for v in c:
        size = size * farthest + abs(v)
    _, right_of_lo, left_of_hi, _ = cut.roots
    size1, size2 = (2.0 * angle * size * root * root for root in (right_of_lo, left_of_hi))
    return I0, I1, C2, JR, JL, positive, negative, size1, size2


@lru_cache(maxsize=32)
def _rule(n: int) -> tuple[tuple[float, float], ...]:
    g, w = chebyshev.gauss_legendre(n)
    return tuple(zip(g.tolist(), w.tolist(), strict=True))
