"""The pieces of a slope that lie in the contact, and the exact integrals over them.

Everything at β = 0 is one integral, here with the root in front so that it stays finite at the edges:

    V(z) = R(z) ∫ H(t) / (w(t) (t - z)) dt,     R(z) = sqrt(z - x1) sqrt(z - x2),     on the contact  w(x) PV∫ ...

On a piece of half-length l, with s = (t - mid)/l and H = Σ c_n T_n(s), the recurrence J_{n+1} = 2 s J_n - J_{n-1} + 2 R μ_n / l gives

    V = H(z) (L_hi - L_lo) + R(z) Σ_m q_m U_m(s) / l,     q_m = Σ_j c_{m+1+j} ν_j,     ν_0 = μ_0,  ν_j = 2 μ_j,
    μ_n = ∫ T_n(s) / w dt  over the piece (Gauss-Legendre in the angle φ),

where L_e is one logarithm for each break e (Ciavarella, Hills & Monno 1998, eqs (26)-(31)). That is exact near the piece. Far from it
H(z), continued as a polynomial, grows and digits vanish: there Gauss-Legendre quadrature in φ converges geometrically. `reach` says
where one hands over to the other, from the piece's own coefficients.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import chebyshev
from .interval import EPS, Interval
from .slope import Slope

Array = NDArray[np.float64]

# The closed form may lose this factor against the piece's own size before quadrature takes over.
GROWTH = 64.0
# A break carries a true jump of h' (and a logarithmic infinity of p) when the jump exceeds rounding by this factor.
JUMP = 256.0 * EPS
# Beyond this many half-widths from the centre the far field takes out the moment that vanishes.
FAR_FIELD = 1.5  # widths
FAR_FIELD_NODES = 22  # and half the degree: reach rounding there
TINY = float(np.finfo(float).tiny)
# Chebyshev coefficients below this fraction of the largest slope in the contact are rounding.
CHOP = 0.5 * EPS


class Moments(NamedTuple):
    """Integrals over the contact in the angle φ: I0 = ∫H, I1 = ∫H sin φ, C2 = ∫H cos²φ, J0 = ∫H', J1 = ∫H' sin φ."""

    I0: float
    I1: float
    C2: float
    J0: float
    J1: float
    positive: float  # the part of I0 from H > 0; I0 - positive is that from H < 0


def moments(slope: Slope, contact: Interval, lower: float | None = None, keep_zero: bool = False) -> Moments:
    """The integrals that fix the edges; with `lower` (the axis of a symmetric contact) of the half right of it, and only I1 and J0."""
    if slope.few and not keep_zero:
        return _moments_of_few(slope, contact, lower)
    return Geometry(slope, contact, lower, keep_zero).moments()


def _moments_of_few(slope: Slope, contact: Interval, lower: float | None) -> Moments:
    """`Geometry.moments` in plain floats: for a few pieces NumPy's call overhead would be most of the cost of a solve."""
    I0 = I1 = C2 = J0 = J1 = positive = 0.0
    sin, cos, sqrt, atan2 = math.sin, math.cos, math.sqrt, math.atan2
    width = 2.0 * contact.r
    for lo, hi, origin, c in slope.rows:
        start, tail = lo, 0.0
        if lower is not None and lo < lower:
            start = lower
        lo_left, lo_right = contact.from_left(start), contact.from_right(start)
        hi_left, hi_right = contact.from_left(hi), contact.from_right(hi)
        if hi_left <= 0.0 or lo_right <= 0.0 or hi <= start:
            continue
        cut_left, cut_right = lo_left <= 0.0, hi_right <= 0.0
        if cut_left:
            start, tail, lo_left, lo_right = contact.x1, contact.tail1, 0.0, width
        if cut_right:
            hi_left, hi_right = width, 0.0
        length = hi_left if cut_left else lo_right if cut_right else hi - start
        a, b, c_, d = sqrt(lo_left / width), sqrt(lo_right / width), sqrt(hi_left / width), sqrt(hi_right / width)
        angle = 2.0 * atan2(length / (width * (b * c_ + a * d)), a * c_ + b * d)
        sign = 1.0 if lo_left + hi_left < width else -1.0
        from_edge = 2.0 * (atan2(a, b) if sign > 0.0 else atan2(b, a))
        base = (start - origin) + tail
        for g, w in _short_rule(slope.degree, angle > 0.5 * math.pi + 0.01):
            half_step = 0.5 * angle * g
            middle = from_edge + sign * half_step
            y = base + width * sin(half_step) * sin(middle)
            H, dH = c[0], 0.0
            for v in c[1:]:
                dH = dH * y + H
                H = H * y + v
            at = middle + sign * half_step
            cos_phi, sin_phi = sin(at), -sign * cos(at)
            wH, wdH = angle * w * H, angle * w * dH
            I0 += wH
            I1 += wH * sin_phi
            C2 += wH * cos_phi * cos_phi
            J0 += wdH
            J1 += wdH * sin_phi
            if wH > 0.0:
                positive += wH
        if not slope.continuous:
            for y, cut, left, right, leaves in ((base, cut_left, a, b, 1.0), (base + length, cut_right, c_, d, -1.0)):
                if not cut:
                    H = c[0]
                    for v in c[1:]:
                        H = H * y + v
                    jump = leaves * H / (width * left * right)
                    J0 += jump
                    J1 += jump * (left * left - right * right)
    return Moments(I0, I1, C2, J0, J1, positive)


@lru_cache(maxsize=16)
def _short_rule(degree: int, wide: bool) -> tuple[tuple[float, float], ...]:
    """Gauss-Legendre as pairs of floats; a quarter of the circle needs fewer nodes than a half."""
    g, w = chebyshev.gauss_legendre(quadrature_order(degree) if wide else 9 + degree)
    return tuple(zip(g.tolist(), w.tolist(), strict=True))


class Geometry:
    """Where the pieces of a slope lie in the contact, in angles measured from the nearer edge, to relative accuracy.

    Only the first and the last piece can be cut by an edge. Building one costs a few microseconds: the search for the edges builds many.
    """

    def __init__(self, slope: Slope, contact: Interval, lower: float | None = None, keep_zero: bool = False) -> None:
        """`lower` cuts off all that is left of it (the axis of a symmetric contact)."""
        b = slope.breaks
        floor, floor_tail = (contact.x1, contact.tail1) if lower is None else (lower, 0.0)
        first = max(int(b.searchsorted(floor, side="left" if floor_tail < 0.0 else "right")) - 1, 0)
        last = min(int(b.searchsorted(contact.x2, side="right" if contact.tail2 > 0.0 else "left")), len(b) - 1)
        k = np.arange(first, last)
        if not keep_zero and slope.has_zero:
            k = k[~slope.is_zero[k]]
        self.slope, self.contact, self.k = slope, contact, k
        n = len(k)
        self.ends = ends = np.empty((2, n))  # of the pieces, lo and hi ...
        ends[0], ends[1] = b[k], b[k + 1]
        self.tails = np.zeros((2, n))  # ... and what their doubles miss
        # Distances of both ends from the left and the right edge (2, 2, K), over the contact's width: cos² and sin² of half the angle
        # from the right edge. Only the outer two ends can be cut by an edge or by `lower`.
        width = 2.0 * contact.r
        distance = np.empty((2, 2, n))
        distance[0], distance[1] = contact.from_left(ends), contact.from_right(ends)
        length = ends[1] - ends[0]
        self.cut_left = self.cut_right = False
        if n and k[0] == first and ends[0, 0] <= floor:
            self.cut_left = lower is None
            ends[0, 0], self.tails[0, 0] = floor, floor_tail
            distance[:, 0, 0] = (0.0, width) if lower is None else (contact.from_left(lower), contact.from_right(lower))
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
        """(angle of lo from the nearer edge, +1 if that edge is the left one else -1, angular length), each (K, 1)."""
        (a, c), (b, d) = self.root_left, self.root_right
        angle = 2.0 * np.arctan2(self.length / (2.0 * self.contact.r * (b * c + a * d)), a * c + b * d)
        if self._all_right:
            return 2.0 * np.arctan2(b, a)[:, None], -1.0, angle[:, None]
        left = self.left[0] + self.left[1] < 1.0
        from_edge = np.arctan2(np.where(left, a, b), np.where(left, b, a))
        return 2.0 * from_edge[:, None], np.where(left, 1.0, -1.0)[:, None], angle[:, None]

    def nodes(self, n: int) -> tuple[Array, Array, Array, Array | float]:
        """Gauss-Legendre in φ on every piece: offsets t - lo, angles from the nearer edge, weights, all (K, n), and signs."""
        g, w = chebyshev.gauss_legendre(n)
        from_edge, sign, length = self.angles
        half_step = (0.5 * length) * g
        middle = from_edge + sign * half_step
        # t - lo = r (sin φ - sin φ_lo) as a product: no cancellation, however thin the piece
        offset = (2.0 * self.contact.r) * np.sin(half_step) * np.sin(middle)
        return offset, middle + sign * half_step, length * w, sign

    def slopes(self, offset: Array) -> Array:
        """H at lo + offset, (K, n)."""
        return self.slope.local(self.k, self.ends[0], self.tails[0], offset)

    def moments(self) -> Moments:
        """The integrals over the pieces, with J0 and J1 exact too: jumps of H at breaks included."""
        if not len(self.k):
            return Moments(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        slope = self.slope
        offset, angle, weight, sign = self.nodes(quadrature_order(slope.degree))
        H = self.slopes(offset)
        WH = weight * H
        cos_phi, sin_phi = np.sin(angle), -sign * np.cos(angle)
        dJ = weight * slope.local_derivative(self.k, self.ends[0], self.tails[0], offset)
        if slope.functions:
            dJ = dJ + self._derivative(H - slope.without_functions.local(self.k, self.ends[0], self.tails[0], offset)) / (self.contact.r * cos_phi)
        J0, J1 = _sum(dJ), float(np.vdot(dJ, sin_phi))
        if not slope.continuous:
            jump = self._jumps(H)
            J0, J1 = J0 + _sum(jump), J1 + float(np.vdot(jump, self.left - self.right))
        I1 = float(np.vdot(WH, sin_phi))
        if self._all_right:  # half of a symmetric contact: what the symmetry makes zero is not needed
            return Moments(0.0, I1, 0.0, J0, 0.0, 0.0)
        return Moments(_sum(WH), I1, float(np.vdot(WH, cos_phi * cos_phi)), J0, J1, _sum(np.maximum(WH, 0.0)))

    def _derivative(self, values: Array) -> Array:
        """Weights times dH/dφ of a function, from the quadrature's own interpolant."""
        n = values.shape[1]
        out: Array = chebyshev.gauss_legendre(n)[1] * (values @ chebyshev.differentiation(n)[0].T)
        return out

    def _jumps(self, H: Array) -> Array:
        """(2, K): H enters at lo and leaves at hi, over r cos φ there; an edge of the contact is not a jump."""
        jump: Array = chebyshev.differentiation(H.shape[1])[1] @ H.T
        jump[1] *= -1.0
        if self.cut_left:
            jump[0, 0] = 0.0
        if self.cut_right:
            jump[1, -1] = 0.0
        return jump / (2.0 * self.contact.r * np.maximum(self.root_left * self.root_right, TINY))

    def chebyshev_slope(self, n: int) -> Array:
        """Chebyshev coefficients of H on every piece, from n points: (K, n)."""
        offset = (0.5 * self.length)[:, None] * (1.0 + chebyshev.points(n))
        return chebyshev.transform(self.slopes(offset))


def _sum(a: Array) -> float:
    return float(np.add.reduce(a, axis=None))


def quadrature_order(degree: int) -> int:
    """Gauss-Legendre nodes for a polynomial slope of that degree on up to the whole contact, measured to reach rounding."""
    return 13 + int(1.15 * degree)


class Panels:
    """The pieces expanded: V(z) on the contact, beside it, and in the complex plane."""

    def __init__(self, geometry: Geometry, I0: float = 0.0) -> None:
        """`I0` = ∫H/w dt over the contact, exactly 0 where both edges are smooth."""
        g = self.geometry = geometry
        self.contact, self.I0 = g.contact, I0
        self.half_length = 0.5 * g.length
        self.series = g.chebyshev_slope(g.slope.degree + 1)
        self.degree = self.series.shape[1] - 1
        self.lengths = [self.degree + 1] * len(g.k)
        if g.slope.functions:
            matters = np.abs(self.series) > CHOP * self.scale
            matters[:, 0] = True
            lengths = self.degree + 1 - matters[:, ::-1].argmax(axis=1)
            self.series[np.arange(self.degree + 1) >= lengths[:, None]] = 0.0
            self.lengths = lengths.tolist()

    @cached_property
    def scale(self) -> float:
        """The largest |H| on the pieces, about."""
        return float(np.abs(self.series).sum(axis=1).max(initial=0.0))

    @cached_property
    def _continuation(self) -> Array:
        """q_m / l of every piece (K, degree): the U-series that multiplies the root."""
        d = self.degree
        if d <= 1:
            q: Array = self.series[:, 1:] * (self.geometry.angles[2] / self.half_length[:, None])  # μ_0 is the piece's angle
            return q
        offset, _, weight, _ = self.geometry.nodes(quadrature_order(d))
        s = offset / self.half_length[:, None] - 1.0
        nu = (chebyshev.polynomials(d, s) * weight).sum(axis=-1)  # (degree, K)
        nu[1:] *= 2.0
        nu /= self.half_length
        return np.stack([(self.series[:, m + 1 :] * nu[: d - m].T).sum(axis=1) for m in range(d)], axis=1)

    @cached_property
    def reach(self) -> Array:
        """Bernstein parameter ρ of every piece up to which the closed form keeps its digits: Σ|c_n| ρ^n <= GROWTH max|c|."""
        if self.degree <= 1:
            return np.full(len(self.series), GROWTH - 1.0)
        c = np.abs(self.series)
        c[:, 1] = np.maximum(c[:, 1], c.max(axis=1))  # even a constant loses like ρ: two logarithms that nearly cancel
        return chebyshev.reach(c, GROWTH)

    @cached_property
    def _reach_in_s(self) -> Array:
        """The same on the real axis: the closed form serves |s| <= this."""
        out: Array = 0.5 * (self.reach + 1.0 / self.reach)
        return out

    @cached_property
    def _serves_contact(self) -> list[bool]:
        """Pieces whose closed form serves the whole contact."""
        g = self.geometry
        farthest = 2.0 * self.contact.r * np.maximum(g.left[1], g.right[0]) / self.half_length - 1.0  # largest |s| on the contact
        serves: list[bool] = (farthest <= np.maximum(self._reach_in_s, 1.0)).tolist()
        return serves

    @cached_property
    def _far_rule(self) -> tuple[Array, Array]:
        """Quadrature that serves beyond the reach: offsets from lo, and weights times H, (K, n)."""
        s = float(self._reach_in_s.min(initial=GROWTH))
        s = 2.0 * math.sqrt(0.5 * (s + 1.0)) - 1.0  # at an edge the angle goes like the square root of the distance
        decay = math.log(s + math.sqrt(s * s - 1.0))
        return self._rule(math.ceil(math.log(GROWTH / EPS) / (2.0 * decay)) + 2)

    def _rule(self, n: int) -> tuple[Array, Array]:
        offset, _, weight, _ = self.geometry.nodes(n)
        return offset, weight * self.geometry.slopes(offset)

    @cached_property
    def jumps(self) -> list[tuple[float, float]]:
        """(break, +inf or -inf) where h' jumps inside the contact: the pressure has a logarithmic infinity there."""
        g = self.geometry
        if g.slope.continuous:
            return []
        at: dict[float, float] = {}
        entering, leaving = self.series @ (-1.0) ** np.arange(self.degree + 1), self.series.sum(axis=1)
        for k, (lo, hi) in enumerate(g.ends.T.tolist()):
            if not (g.cut_left and k == 0):
                at[lo] = at.get(lo, 0.0) + float(entering[k])
            if not (g.cut_right and k == len(self.series) - 1):
                at[hi] = at.get(hi, 0.0) - float(leaving[k])
        return [(e, float(np.copysign(np.inf, jump))) for e, jump in at.items() if abs(jump) > JUMP * self.scale]

    # -- V, for 1-d arrays; real ones must ascend ----------------------------------------------------------------------

    def on_contact(self, x: Array) -> Array:
        """w(x) PV∫ H / (w (t - x)) dt for x inside the contact; infinite at a jump of H."""
        width = 2.0 * self.contact.r
        root_left, root_right = np.sqrt(self.contact.from_left(x) / width), np.sqrt(self.contact.from_right(x) / width)
        kinks_only = self.geometry.slope.continuous

        def log_of(e: float, e_left: float, e_right: float, at: Any) -> Array:
            a, b = e_right * root_left[at], e_left * root_right[at]
            total = a + b
            y = 2.0 * np.minimum(a, b) / total  # Λ = ln|1 - y|: small towards the edges, y -> 1 at the break
            if kinks_only:  # there Λ has a factor that vanishes, and its rounding with it
                kink: Array = np.log1p(-np.minimum(y, 1.0 - EPS))
                return kink
            near = np.flatnonzero(y > 0.75)
            y[near] = 0.0
            out: Array = np.log1p(-y)
            if near.size:
                scale = total[near]
                d = np.abs(x[at][near] - e) / (width * scale)
                scale[d == 0.0] = d[d == 0.0] = 1.0  # at the break itself the logarithm has the factor 0, or the pressure is infinite
                out[near] = np.log(d / scale)
            return out

        V: Array = self._combined(x, (width * root_left) * root_right, log_of, self._regions(x, self._serves_contact))
        for e, infinite in self.jumps:
            V[x == e] = infinite
        return V

    def beside(self, x: Array) -> tuple[Array, Array]:
        """V(x) beside the contact, all x on one side, as (first, second) with V = first - π second.

        The second is the slope of the piece at that edge, continued as a polynomial (0 where that piece is treated by quadrature). The
        first vanishes like the root of the distance, to relative accuracy, and so does the slope of the gap.
        """
        width = 2.0 * self.contact.r
        on_right = bool(x[0] > self.contact.m)
        root_left = np.sqrt(np.abs(self.contact.from_left(x)) / width)
        root_right = np.sqrt(np.abs(self.contact.from_right(x)) / width)
        R = width * root_left * root_right * (1.0 if on_right else -1.0)

        def log_of(e: float, e_left: float, e_right: float, at: Any) -> Array:
            if on_right:
                near_edge: Array = -2.0 * np.arctan2(root_right[at] * e_left, root_left[at] * e_right)
                return near_edge
            far_edge: Array = 2.0 * np.arctan2(root_left[at] * e_right, root_right[at] * e_left)
            return far_edge

        regions = self._regions(x)
        V = self._combined(x, R, log_of, regions)
        continued = np.zeros_like(x)
        if self.geometry.cut_right if on_right else self.geometry.cut_left:
            k = len(regions) - 1 if on_right else 0
            near = regions[k][0]
            continued[near] = self._slope(k, x[near])
        far = np.abs(x - self.contact.m) > FAR_FIELD * width
        if far.any():
            V[far], continued[far] = self._far_field(x[far]), 0.0
        return V, continued

    def off_axis(self, z: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """V(z) in the upper half-plane, Im z > 0."""
        root1, root2 = np.sqrt(self.contact.from_left(z)), np.sqrt(-self.contact.from_right(z))
        q = root2 / root1

        def log_of(e: float, e_left: float, e_right: float, at: Any) -> NDArray[np.complex128]:
            # 2 atan(τ/q) = -i ln((q + iτ)/(q - iτ)); q² + τ² is proportional to z - e: no cancellation next to the break
            tau = e_right / e_left
            product = (z[at] - e) / (root1[at] * root1[at]) / (e_left * e_left)
            out: NDArray[np.complex128] = -1j * np.log((q[at] + 1j * tau) ** 2 / product)
            return out

        regions = self._regions(z)
        V: NDArray[np.complex128] = self._combined(z, root1 * root2, log_of, regions)
        if self.geometry.cut_left:
            near = regions[0][0]
            V[near] -= np.pi * self._slope(0, z[near])
        far = np.abs(z - self.contact.m) > FAR_FIELD * 2.0 * self.contact.r
        if far.any():
            V[far] = self._far_field(z[far])
        return V

    def _far_field(self, z: Any) -> Any:
        """V(z) with ∫H/w taken from the edges' condition, not from quadrature: for smooth edges V ~ 1/z keeps its digits."""
        offset, WH = self._far_field_rule
        c = self.contact
        t_m = ((self.geometry.ends[0] - c.m) + self.geometry.tails[0])[:, None] + offset
        z_m = z - c.m
        total = np.zeros_like(z)
        for row_t, row_w in zip(t_m, WH * t_m, strict=True):
            total += row_w @ np.reciprocal(row_t[:, None] - z_m)
        root = np.sqrt(c.from_left(z) / z_m) * np.sqrt(-c.from_right(z) / z_m)  # R(z) / (z - m)
        return (total - self.I0) * root

    @cached_property
    def _far_field_rule(self) -> tuple[Array, Array]:
        return self._rule(FAR_FIELD_NODES + self.degree // 2)

    def _slope(self, k: int, z: Any) -> Any:
        """H of piece k, continued."""
        return chebyshev.evaluate(self.series[k, : self.lengths[k]], self._s(k, z))

    def _s(self, k: int, z: Any) -> Any:
        g = self.geometry
        return ((z - g.ends[0, k]) - g.tails[0, k]) / self.half_length[k] - 1.0

    def _regions(self, z: Any, serves: list[bool] | None = None) -> list[tuple[Any, tuple[Any, ...]]]:
        """For every piece: the indices of z within reach of its closed form, and those beyond (slices of the ascending real ones)."""
        whole = (slice(None), ())
        if serves is not None and all(serves):
            return [whole] * len(serves)
        if np.iscomplexobj(z):
            return [self._split_plane(k, z) for k in range(len(self.series))]
        g = self.geometry
        middle, reach = g.ends[0] + (g.tails[0] + self.half_length), self._reach_in_s * self.half_length
        first, last = z.searchsorted(middle - reach), z.searchsorted(middle + reach, side="right")
        return [(slice(i, j), (slice(0, i), slice(j, None))) for i, j in zip(first.tolist(), last.tolist(), strict=True)]

    def _split_plane(self, k: int, z: NDArray[np.complex128]) -> tuple[Any, tuple[Any, ...]]:
        s = self._s(k, z)
        near = np.abs(s + np.sqrt(s - 1.0) * np.sqrt(s + 1.0)) <= self.reach[k]
        return np.flatnonzero(near), (np.flatnonzero(~near),)

    def _combined(self, z: Any, root: Any, log_of: Any, regions: list[tuple[Any, tuple[Any, ...]]]) -> Any:
        """Σ over the pieces: closed form within reach, quadrature beyond. Edges contribute no logarithm: log_of takes interior breaks."""
        g = self.geometry
        V = np.zeros_like(root)
        last = len(regions) - 1
        for k, (near, beyond) in enumerate(regions):
            for far in beyond:
                if z[far].size:
                    V[far] += root[far] * self._quadrature(k, z[far])
            if not z[near].size:
                continue
            J0: Any = 0.0
            if not (g.cut_right and k == last):
                J0 = log_of(g.ends[1, k], g.root_left[1, k], g.root_right[1, k], near)
            if not (g.cut_left and k == 0):
                J0 = J0 - log_of(g.ends[0, k], g.root_left[0, k], g.root_right[0, k], near)
            s, n = self._s(k, z[near]), self.lengths[k]
            H = chebyshev.evaluate(self.series[k, :n], s)
            V[near] += H * J0 + root[near] * chebyshev.evaluate_second_kind(self._continuation[k, : n - 1], s)
        return V

    def _quadrature(self, k: int, z: Any) -> Any:
        g = self.geometry
        offset, WH = self._far_rule
        return WH[k] @ np.reciprocal(offset[k][:, None] - ((z - g.ends[0, k]) - g.tails[0, k]))
