"""The pieces of a slope in a contact, expanded for the evaluation of V(z) (`potential`).

On a piece of half-length l, with s = (t - mid)/l and H = Σ c_n T_n(s), the recurrence
J_{n+1} = 2 s J_n - J_{n-1} + 2 X μ_n / l of the integrals J_n = X ∫ T_n / (w (t - z)) dt gives the
part of V that the piece contributes in closed form,

    H(z) (L_hi - L_lo) + X(z) Q(z),       Q = Σ_m q_m U_m(s) / l,
    q_m = Σ_j c_{m+1+j} ν_j,     ν_0 = μ_0,  ν_j = 2 μ_j,     μ_n = ∫ T_n(s) / w dt over the piece

(Ciavarella, Hills & Monno 1998, eqs (26)-(31)). That is exact near the piece. Far from it H(z),
continued as a polynomial, grows and digits vanish: there the piece's Gauss rule for dt/w converges
geometrically. `reach` is the limit between the two, from the piece's own coefficients.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.cauchy_sums import SEPARATED, KernelSums
from sie.numerics.interval import EPS
from sie.profiles.functions import PowerLaw
from sie.profiles.slope import JUMP, SEEN_JUMP

from .piece_quadrature import Geometry, quadrature_order

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# The closed form may lose this factor against the piece's own size before quadrature takes over.
GROWTH = 64.0
# Beyond so many pieces a loop over them costs more than pairs of pieces and points.
MANY = 24
# Chebyshev coefficients below this fraction of the largest slope in the contact are rounding.
CHOP = 0.5 * EPS
TERMS = 23  # of `of_slope.outer_series` beyond FAR_FIELD, where |ρ|^22 <= 0.172^22 is rounding


class Series(NamedTuple):
    """The polynomials of `potential` on one piece, or on several as columns."""

    H: Array  # the slope, in T_n(s)
    dH: Array  # its derivative, in U_n(s)
    ends: Array  # v(lo) D_lo - v(hi) D_hi, in T_n(s)
    Q: Array  # in U_n(s)
    dQ: Array  # in U_n(s)


class Breaks(NamedTuple):
    """The ends (lo, hi) of the pieces as breaks of the slope; shapes (2, K) and (K,)."""

    e: Array
    v: Array  # the dual root there; 0 at an edge of the contact
    H: Array  # the slope on the piece
    jump: Array  # of the slope at hi, to a next piece that it meets
    meets_next: NDArray[np.bool_]  # whether that begins where this piece ends


class Panels:
    """The pieces of a slope in the contact; `I0` = ∫H/w dt, exactly 0 if both edges are smooth."""

    def __init__(self, geometry: Geometry, I0: float = 0.0) -> None:
        g = self.geometry = geometry
        self.contact, self.edge, self.I0 = g.contact, g.edge, I0
        self.half_length = 0.5 * g.length
        self.series = g.chebyshev_slope(g.slope.degree + 1)
        self.degree = self.series.shape[1] - 1
        if g.slope.functions:
            matters = np.abs(self.series) > CHOP * self.scale
            matters[:, 0] = True
            lengths = self.degree + 1 - matters[:, ::-1].argmax(axis=1)
            self.series[np.arange(self.degree + 1) >= lengths[:, None]] = 0.0
        self.many = len(g.k) > MANY

    @cached_property
    def scale(self) -> float:
        """The largest |H| on the pieces, about."""
        return float(np.abs(self.series).sum(axis=1).max(initial=0.0))

    # -- the closed form ---------------------------------------------------------------------------

    @cached_property
    def continuation(self) -> Array:
        """q_m / l of every piece (K, degree)."""
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
        """μ_n of every piece for n < degree: (degree, K)."""
        if self.degree <= 1:
            return self.geometry.totals[None]
        offset, _, weight, _ = self.geometry.nodes(quadrature_order(self.degree))
        s = offset / self.half_length[:, None] - 1.0
        means: Array = (chebyshev.polynomials(self.degree, s) * weight).sum(axis=-1)
        return means

    @cached_property
    def reach(self) -> Array:
        """Bernstein radius ρ of every piece up to which Σ|c_n| ρ^n <= GROWTH max|c|."""
        if self.degree <= 1:
            return np.full(len(self.series), 2.0 * GROWTH)  # a straight line loses half of ρ
        c = np.abs(self.series)
        # Even a constant loses like ρ: two logarithms that nearly cancel
        c[:, 1] = np.maximum(c[:, 1], c.max(axis=1))
        return chebyshev.reach(c, GROWTH)

    @cached_property
    def reach_in_s(self) -> Array:
        """The same on the line: the closed form serves |s| <= this."""
        out: Array = 0.5 * (self.reach + 1.0 / self.reach)
        return out

    @cached_property
    def serves_contact(self) -> bool:
        """Whether every closed form serves the whole contact."""
        g = self.geometry
        # the largest |s| on the contact
        farthest = 2.0 * self.contact.r * np.maximum(g.left[1], g.right[0]) / self.half_length - 1.0
        return all((farthest <= np.maximum(self.reach_in_s, 1.0)).tolist())

    def s(self, k: Any, z: Any) -> Any:
        """s(z) of the piece k, or of each of several pieces."""
        return self.from_lo(k, z) / self.half_length[k] - 1.0

    def from_lo(self, k: Any, z: Any) -> Any:
        """z less the left end of that piece."""
        if isinstance(k, int):
            lo, tail = self._starts[k]
            return (z - lo) - tail if tail else z - lo
        g = self.geometry
        return (z - g.ends[0][k]) - g.tails[0][k]

    @cached_property
    def _starts(self) -> list[tuple[float, float]]:
        g = self.geometry
        return list(zip(g.ends[0].tolist(), g.tails[0].tolist(), strict=True))

    @cached_property
    def ends(self) -> list[list[tuple[float, float, float]]]:
        """e, sqrt((e - x1)/2r) and sqrt((x2 - e)/2r) for lo and hi of every piece."""
        g = self.geometry
        rows = (g.ends.tolist(), g.root_left.tolist(), g.root_right.tolist())
        return [list(zip(*of_end, strict=True)) for of_end in zip(*rows, strict=True)]

    def slope_and_Q(self, k: Any) -> tuple[Array, Array]:
        """H and Q of one piece, or of several as columns."""
        return self.series.T[:, k], self.continuation.T[:, k]

    def polynomials(self, k: Any) -> Series:
        """All polynomials of one piece, or of several as columns."""
        if isinstance(k, int):
            return self._of_each[k]
        return Series(*(c[:, k] for c in self._polynomials))

    @cached_property
    def _polynomials(self) -> Series:
        n, half, v = self.degree + 1, self.half_length[:, None], self.breaks.v
        at_lo, at_hi = (self.series @ chebyshev.divided(np.eye(n), sign) for sign in (-1.0, 1.0))
        ends = (v[0][:, None] * at_lo - v[1][:, None] * at_hi) / half
        dH = np.arange(1, n) * self.series[:, 1:] / half
        if n == 1:
            ends, dQ = np.zeros((len(half), 1)), np.zeros((len(half), 0))
        else:
            dQ = self.continuation @ chebyshev.second_kind_derivative(np.eye(n - 1)) / half
        return Series(self.series.T, dH.T, ends.T, self.continuation.T, dQ.T)

    @cached_property
    def _of_each(self) -> list[Series]:
        columns = [np.ascontiguousarray(c.T) for c in self._polynomials]
        return [Series(*rows) for rows in zip(*columns, strict=True)]

    # -- the breaks --------------------------------------------------------------------------------

    @cached_property
    def _slope_at_ends(self) -> Array:
        """H on each piece at lo and hi: (2, K)."""
        signs = (-1.0) ** np.arange(self.degree + 1)
        return np.stack((self.series @ signs, self.series.sum(axis=1)))

    @cached_property
    def jumps(self) -> list[tuple[float, float]]:
        """(break, ±inf) inside the contact where H jumps: there the pressure is infinite."""
        slope, c = self.geometry.slope, self.contact
        # on its axis a power law is steep, but without a corner p is finite there
        steep = [f.shift for f in slope.functions if isinstance(f.function, PowerLaw)]
        return [
            (e, math.copysign(math.inf, rise))
            for e, rise in slope.jumps
            if c.from_left(e) > 0.0 < c.from_right(e)
            and not (e in steep and not slope.without_functions.corner(e)[0])
        ]

    @cached_property
    def breaks(self) -> Breaks:
        """The ends of the panels, with H and its jumps there."""
        g, last = self.geometry, len(self.series) - 1
        v = np.asarray(self.edge.dual_root(g.root_left, g.root_right))
        H = self._slope_at_ends.copy()
        if g.cut_left:
            H[0, 0] = v[0, 0] = 0.0
        if g.cut_right:
            H[1, last] = v[1, last] = 0.0
        meets_next = np.append(g.ends[1, :-1] == g.ends[0, 1:], False)
        meets = np.stack((np.roll(meets_next, 1), meets_next))
        jumps = np.isin(g.ends, [e for e, _ in self.jumps])
        H[~meets & ~jumps] = 0.0  # no slope to meet, and its own is rounding
        jump = np.where(meets_next & jumps[1], np.append(H[0, 1:], 0.0) - H[1], 0.0)
        return Breaks(g.ends, v, H, jump, meets_next)

    @cached_property
    def kinks(self) -> tuple[tuple[float, float], ...]:
        """(break, ±inf) where p' ~ -[H']/π ln|x - e| is infinite; -inf where p itself is."""
        g, dH = self.geometry, self._polynomials.dH
        n = np.arange(1.0, len(dH) + 1.0)  # U_m(±1) = (±1)^m (m + 1)
        inside = np.ones(g.ends.shape, dtype=bool)
        inside[0, :1], inside[1, -1:] = not g.cut_left, not g.cut_right
        e, which = np.unique(g.ends[inside], return_inverse=True)
        rises = np.stack(((n * (-1.0) ** (n - 1.0)) @ dH, -n @ dH))[inside]
        rise, bound = np.bincount(which, rises, len(e)), np.zeros(len(e))
        np.maximum.at(bound, which, np.broadcast_to(n @ np.abs(dH), inside.shape)[inside])
        infinite = np.isin(e, [at for at, _ in self.jumps])
        sign = np.where(infinite, -np.inf, np.copysign(np.inf, rise))
        found = infinite | (np.abs(rise) > (SEEN_JUMP if g.slope.functions else JUMP) * bound)
        return tuple(zip(e[found].tolist(), sign[found].tolist(), strict=True))

    # -- quadrature beyond the reach ---------------------------------------------------------------

    def rule(self, k: Any) -> tuple[Array, Array]:
        """Offsets from lo, and weights of dt/w times H, of one piece or of each of several."""
        if isinstance(k, int):
            return self._rules[k]
        offset, charge = self._rule_of_all
        return offset[k], charge[k]

    @cached_property
    def _rules(self) -> list[tuple[Array, Array]]:
        """The rule of every piece, of as many nodes as its reach needs."""
        orders = _order_beyond(self.reach_in_s).tolist()
        rules = {n: self.geometry.charges(n) for n in set(orders)}
        return [(rules[n][0][k], rules[n][1][k]) for k, n in enumerate(orders)]

    @cached_property
    def _rule_of_all(self) -> tuple[Array, Array]:
        """One rule for all of many pieces."""
        return self.geometry.charges(
            int(_order_beyond(np.minimum(self.reach_in_s, SEPARATED)).max())
        )

    @cached_property
    def sums(self) -> KernelSums:
        """The fast sums of that rule."""
        g = self.geometry
        return KernelSums(g.ends[0] + g.tails[0], g.length, *self._rule_of_all)

    @cached_property
    def far_series(self) -> Array:
        """2 ∫ H T_n /w dt over the contact, n < TERMS: π times the Chebyshev coefficients of H."""
        g = self.geometry
        offset, angle, weight, sign = g.nodes(quadrature_order(self.degree + TERMS))
        from_right = np.where(sign > 0.0, np.pi - angle, angle)  # T_n(cos ψ) = cos nψ
        WH = weight * g.slopes(offset)
        return np.array([2.0 * np.vdot(WH, np.cos(n * from_right)) for n in range(TERMS)])


def _order_beyond(reach_in_s: Array) -> Index:
    """Gauss-Legendre nodes, an even number, of a piece that is taken from |s| = reach on."""
    # at an edge the angle goes like the square root of the distance
    s = 2.0 * np.sqrt(0.5 * (reach_in_s + 1.0)) - 1.0
    decay = np.log(s + np.sqrt(s * s - 1.0))
    needed = np.ceil(math.log(GROWTH / EPS) / (2.0 * decay)) + 2
    order: Index = (2 * np.ceil(needed / 2)).astype(np.int64)
    return order
