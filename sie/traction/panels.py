"""The exact integrals over the pieces of a slope: V(z), of which pressure, potential and gap are values.

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
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.cauchy_sums import SEPARATED, KernelSums
from sie.numerics.interval import EPS
from sie.profiles.slope import JUMP, SEEN_JUMP

from .many_panels import Pieces, combined
from .piece_quadrature import Geometry, quadrature_order

Array = NDArray[np.float64]

# The closed form may lose this factor against the piece's own size before quadrature takes over.
GROWTH = 64.0
# Beyond this many widths from the centre the far field takes out the moment that vanishes.
FAR_FIELD = 1.5
FAR_FIELD_NODES = 22  # and half the degree: reach rounding there
# Beyond so many pieces a loop over them costs more than pairs of pieces and points.
MANY = 24
# Chebyshev coefficients below this fraction of the largest slope in the contact are rounding.
CHOP = 0.5 * EPS


class Panels:
    """The pieces expanded: V(z) on the contact, beside it, and in the complex plane."""

    cos = 1.0  # of πε, for the exponents 1/2 ± ε of the edges (`sliding`)

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
        self.many = len(g.k) > MANY

    @cached_property
    def scale(self) -> float:
        """The largest |H| on the pieces, about."""
        return float(np.abs(self.series).sum(axis=1).max(initial=0.0))

    @cached_property
    def _continuation(self) -> Array:
        """q_m / l of every piece (K, degree): the U-series that multiplies the root."""
        d = self.degree
        nu = self._means() / self.half_length  # (degree, K)
        if d <= 1:
            q: Array = self.series[:, 1:] * nu.T
            return q
        nu[1:] *= 2.0
        return np.stack(
            [(self.series[:, m + 1 :] * nu[: d - m].T).sum(axis=1) for m in range(d)], axis=1
        )

    def _means(self) -> Array:
        """μ_n = ∫ T_n(s)/w dt over every piece, n < degree: (degree, K)."""
        if self.degree <= 1:
            return self.geometry.angles[2].T  # μ_0 is the piece's angle
        offset, _, weight, _ = self.geometry.nodes(quadrature_order(self.degree))
        s = offset / self.half_length[:, None] - 1.0
        means: Array = (chebyshev.polynomials(self.degree, s) * weight).sum(axis=-1)
        return means

    @cached_property
    def reach(self) -> Array:
        """Bernstein parameter ρ of every piece up to which the closed form keeps its digits: Σ|c_n| ρ^n <= GROWTH max|c|."""
        if self.degree <= 1:
            return np.full(len(self.series), 2.0 * GROWTH)  # a straight line loses half of ρ
        c = np.abs(self.series)
        c[:, 1] = np.maximum(
            c[:, 1], c.max(axis=1)
        )  # even a constant loses like ρ: two logarithms that nearly cancel
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
        farthest = (
            2.0 * self.contact.r * np.maximum(g.left[1], g.right[0]) / self.half_length - 1.0
        )  # largest |s| on the contact
        serves: list[bool] = (farthest <= np.maximum(self._reach_in_s, 1.0)).tolist()
        return serves

    @cached_property
    def _far_rules(self) -> list[tuple[Array, Array]]:
        """Quadrature that serves beyond each piece's reach: (offsets from lo, weights times H), of as many nodes as the reach asks for."""
        orders = _order_beyond(self._reach_in_s).tolist()
        rules = {n: self._rule(n) for n in set(orders)}
        return [(rules[n][0][k], rules[n][1][k]) for k, n in enumerate(orders)]

    @cached_property
    def batched(self) -> Pieces:
        """The same for many pieces: one rule for all of them, and its fast sums."""
        reach = self._reach_in_s
        offset, WH = self._rule(int(_order_beyond(np.minimum(reach, SEPARATED)).max()))
        g = self.geometry
        sums = KernelSums(g.ends[0] + g.tails[0], g.length, offset, WH)
        return Pieces(
            g,
            self.half_length,
            self.series,
            self._continuation,
            self.reach,
            reach,
            offset,
            WH,
            sums,
        )

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
        entering, leaving = (
            self.series @ (-1.0) ** np.arange(self.degree + 1),
            self.series.sum(axis=1),
        )
        for k, (lo, hi) in enumerate(g.ends.T.tolist()):
            if not (g.cut_left and k == 0):
                at[lo] = at.get(lo, 0.0) + float(entering[k])
            if not (g.cut_right and k == len(self.series) - 1):
                at[hi] = at.get(hi, 0.0) - float(leaving[k])
        least = SEEN_JUMP if g.slope.functions else JUMP
        # of coefficients given about x = 0, rounding grows with the distance from there
        steepest = float(
            (np.abs(self.series[:, 1:]).sum(axis=1) / self.half_length).max(initial=0.0)
        )
        return [
            (e, float(np.copysign(np.inf, jump)))
            for e, jump in at.items()
            if abs(jump) > least * max(self.scale, abs(e) * steepest)
        ]

    # -- V, for 1-d arrays; real ones must ascend ----------------------------------------------------------------------

    def on_contact(self, x: Array) -> Array:
        """w(x) PV∫ H / (w (t - x)) dt for x inside the contact; infinite at a jump of H."""
        width = 2.0 * self.contact.r
        root_left, root_right = (
            np.sqrt(self.contact.from_left(x) / width),
            np.sqrt(self.contact.from_right(x) / width),
        )
        kinks_only = self.geometry.slope.continuous and not self.many

        def log_of(e: float, e_left: float, e_right: float, at: Any) -> Array:
            a, b = e_right * root_left[at], e_left * root_right[at]
            total = a + b
            y = (
                2.0 * np.minimum(a, b) / total
            )  # Λ = ln|1 - y|: small towards the edges, y -> 1 at the break
            if kinks_only:  # there Λ has a factor that vanishes, and its rounding with it
                kink: Array = np.log1p(-np.minimum(y, 1.0 - EPS))
                return kink
            near = np.flatnonzero(y > 0.75)
            y[near] = 0.0
            out: Array = np.log1p(-y)
            if near.size:
                scale = total[near]
                d = np.abs((x[at] - e)[near]) / (width * scale)
                scale[d == 0.0] = d[d == 0.0] = (
                    1.0  # at the break itself the logarithm has the factor 0, or the pressure is infinite
                )
                out[near] = np.log(d / scale)
            return out

        V: Array = self._combined(x, (width * root_left) * root_right, log_of, on_contact=True)[0]
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
                near_edge: Array = -2.0 * np.arctan2(
                    root_right[at] * e_left, root_left[at] * e_right
                )
                return near_edge
            far_edge: Array = 2.0 * np.arctan2(root_left[at] * e_right, root_right[at] * e_left)
            return far_edge

        return self._continued(x, R, log_of, on_right)

    def _continued(self, x: Array, R: Array, log_of: Any, on_right: bool) -> tuple[Array, Array]:
        """`beside`, from the root and the functions of the breaks."""
        V, *near = self._combined(x, R, log_of)
        continued = np.zeros_like(x)
        if self.geometry.cut_right if on_right else self.geometry.cut_left:
            k, at = (len(self.series) - 1, near[1]) if on_right else (0, near[0])
            continued[at] = self._slope(k, x[at])
        far = np.abs(x - self.contact.m) > FAR_FIELD * 2.0 * self.contact.r
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

        return self._in_the_plane(z, root1 * root2, log_of)

    def _in_the_plane(
        self, z: NDArray[np.complex128], R: NDArray[np.complex128], log_of: Any
    ) -> NDArray[np.complex128]:
        """`off_axis`, from the root and the functions of the breaks, which vanish at the right edge and are π/cos at the left one."""
        V: NDArray[np.complex128]
        V, near, _ = self._combined(z, R, log_of)
        if self.geometry.cut_left:
            V[near] -= np.pi / self.cos * self._slope(0, z[near])
        far = np.abs(z - self.contact.m) > FAR_FIELD * 2.0 * self.contact.r
        if far.any():
            V[far] = self._far_field(z[far])
        return V

    def _far_field(self, z: Any) -> Any:
        """V(z) with ∫H/w taken from the edges' condition, not from quadrature: for smooth edges V ~ 1/z keeps its digits."""
        z_m = z - self.contact.m
        if self.many:
            total, _, _ = self._far_field_sums.far(z)  # at the root of the tree: no pairs are left
            return (total - self.I0) * self._far_root(z, z_m)
        t_m, charge = self.far_field_rule
        total = np.zeros_like(z)
        for row_t, row_w in zip(t_m, charge, strict=True):
            total += row_w @ np.reciprocal(row_t[:, None] - z_m)
        return (total - self.I0) * self._far_root(z, z_m)

    def _far_root(self, z: Any, z_m: Any) -> Any:
        """R(z) / (z - m)."""
        return np.sqrt(self.contact.from_left(z) / z_m) * np.sqrt(-self.contact.from_right(z) / z_m)

    @cached_property
    def far_field_rule(self) -> tuple[Array, Array]:
        """t - m, and weight times H (t - m)."""
        offset, WH = self._rule(FAR_FIELD_NODES + self.degree // 2)
        t_m = ((self.geometry.ends[0] - self.contact.m) + self.geometry.tails[0])[:, None] + offset
        return t_m, WH * t_m

    @cached_property
    def _far_field_sums(self) -> KernelSums:
        g = self.geometry
        t_m, charge = self.far_field_rule
        start = (g.ends[0] - self.contact.m) + g.tails[0]
        return KernelSums(g.ends[0] + g.tails[0], g.length, t_m - start[:, None], charge)

    def _slope(self, k: int, z: Any) -> Any:
        """H of piece k, continued."""
        return chebyshev.evaluate(self.series[k, : self.lengths[k]], self._s(k, z))

    def _s(self, k: int, z: Any) -> Any:
        lo, tail, half_length = self._places[k]
        offset = (z - lo) - tail if tail else z - lo
        return offset / half_length - 1.0

    @cached_property
    def _places(self) -> list[tuple[float, float, float]]:
        """(lo, its tail, half-length) of every piece as plain floats."""
        return list(
            zip(
                self.geometry.ends[0].tolist(),
                self.geometry.tails[0].tolist(),
                self.half_length.tolist(),
                strict=True,
            )
        )

    def _regions(
        self, z: Any, serves: list[bool] | None = None
    ) -> list[tuple[Any, tuple[Any, ...]]]:
        """For every piece: the indices of z within reach of its closed form, and those beyond (slices of the ascending real ones)."""
        whole = (slice(None), ())
        if serves is not None and all(serves):
            return [whole] * len(serves)
        if np.iscomplexobj(z):
            return [self._split_plane(k, z) for k in range(len(self.series))]
        g = self.geometry
        middle, reach = (
            g.ends[0] + (g.tails[0] + self.half_length),
            self._reach_in_s * self.half_length,
        )
        first, last = z.searchsorted(middle - reach), z.searchsorted(middle + reach, side="right")
        return [
            (slice(i, j), (slice(0, i), slice(j, None)))
            for i, j in zip(first.tolist(), last.tolist(), strict=True)
        ]

    def _split_plane(self, k: int, z: NDArray[np.complex128]) -> tuple[Any, tuple[Any, ...]]:
        s = self._s(k, z)
        near = np.abs(s + np.sqrt(s - 1.0) * np.sqrt(s + 1.0)) <= self.reach[k]
        return np.flatnonzero(near), (np.flatnonzero(~near),)

    def _combined(
        self, z: Any, root: Any, log_of: Any, on_contact: bool = False
    ) -> tuple[Any, Any, Any]:
        """Σ over the pieces: closed form within reach, quadrature beyond. Edges contribute no logarithm: log_of takes interior breaks.

        With it, where the closed forms of the first and of the last piece were used.
        """
        g = self.geometry
        if self.many:
            return combined(self.batched, z, root, log_of)
        regions = self._regions(z, self._serves_contact if on_contact else None)
        V = np.zeros_like(root)
        last = len(regions) - 1
        ends, root_left, root_right = g.ends.tolist(), g.root_left.tolist(), g.root_right.tolist()
        for k, (near, beyond) in enumerate(regions):
            for far in beyond:
                if z[far].size:
                    V[far] += root[far] * self._quadrature(k, z[far])
            if not z[near].size:
                continue
            J0: Any = 0.0
            if not (g.cut_right and k == last):
                J0 = log_of(ends[1][k], root_left[1][k], root_right[1][k], near)
            if not (g.cut_left and k == 0):
                J0 = J0 - log_of(ends[0][k], root_left[0][k], root_right[0][k], near)
            s, n = self._s(k, z[near]), self.lengths[k]
            H = chebyshev.evaluate(self.series[k, :n], s)
            V[near] += H * J0 + root[near] * chebyshev.evaluate_second_kind(
                self._continuation[k, : n - 1], s
            )
        return (V, regions[0][0], regions[-1][0]) if regions else (V, (), ())

    def _quadrature(self, k: int, z: Any) -> Any:
        offset, WH = self._far_rules[k]
        lo, tail, _ = self._places[k]
        return WH @ np.reciprocal(offset[:, None] - ((z - lo) - tail))


def _order_beyond(reach_in_s: Array) -> NDArray[np.int64]:
    """Gauss-Legendre nodes, an even number, of a piece that is taken from |s| = reach on."""
    s = (
        2.0 * np.sqrt(0.5 * (reach_in_s + 1.0)) - 1.0
    )  # at an edge the angle goes like the square root of the distance
    decay = np.log(s + np.sqrt(s * s - 1.0))
    needed = np.ceil(math.log(GROWTH / EPS) / (2.0 * decay)) + 2
    order: NDArray[np.int64] = (2 * np.ceil(needed / 2)).astype(np.int64)
    return order
