"""The exact integrals inside the body: V(z) of `panels` together with its derivative, which costs no further logarithm.

With R(z) = sqrt(z - x1) sqrt(z - x2), H_k the slope of piece k continued to z, e its ends, w(e) = sqrt((e - x1)(x2 - e)):

    V   = Σ_k H_k (L_hi - L_lo) + R Q_k,     L_e = -i ln( (sqrt(e - x1) sqrt(z - x2) + i sqrt(x2 - e) sqrt(z - x1))² / (2r (z - e)) )
    L_e' = -w(e) / (R (z - e))
    V'  = Σ_k H_k' (L_hi - L_lo) + N / R,              N = Σ_k w(lo) D_lo - w(hi) D_hi + R² Q_k' + (z - m) Q_k  +  Σ_e w(e) [H]_e / (z - e)

where D_e = (H_k(z) - H_k(e)) / (z - e) is a polynomial and [H]_e the jump of the slope at a break: nothing cancels next to one. Derived
from `panels` by differentiation; H = (|t| - a)/R gives back Fp' of the rounded punch (Ciavarella, Hills & Monno 1998, after eq. (23)).
Beyond the reach of a piece, and far from the contact, quadrature as in `panels`.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.profiles.slope import JUMP, SEEN_JUMP

from .many_panels_potential import BatchedPlane, Points
from .panels import FAR_FIELD, Panels
from .piece_quadrature import quadrature_order

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Terms of the outer series: beyond FAR_FIELD widths |ρ| < 1/(2 FAR_FIELD + sqrt(4 FAR_FIELD² - 1)) = 0.172, and 0.172^22 is rounding.
TERMS = 23


def outer_series(series: Array, contact: Interval, z: Complex) -> tuple[Complex, Complex]:
    """Σ_{n>0} g_n ρ^n and its derivative, ρ = 1/(s + sqrt(s - 1) sqrt(s + 1)): 1/π∫p/(z - t) of p = sqrt(1 - s²) Σ g_{n+1} U_n(s).

    The other form of ρ, s - sqrt(s² - 1), cancels. As dρ/dz = -ρ/R, the derivative is -Σ n g_n ρ^n / R.
    """
    left, right = contact.from_left(z), -contact.from_right(z)
    root = np.sqrt(left) * np.sqrt(right)
    rho = 2.0 * contact.r / (left + right + 2.0 * root)
    F, steep = np.zeros_like(rho), np.zeros_like(rho)
    for n in range(len(series) - 1, 0, -1):
        F += series[n]
        F *= rho
        steep += n * series[n]
        steep *= rho
    return F, -steep / root


class Plane:
    """V and V' of the pieces in the upper half-plane."""

    def __init__(self, panels: Panels) -> None:
        self.panels = panels
        self.contact = panels.contact

    def __call__(self, z: Complex) -> tuple[Complex, Complex]:
        """(V, V') at z (1-d), Im z > 0."""
        far = np.abs(z - self.contact.m) > FAR_FIELD * 2.0 * self.contact.r
        if not far.any():
            return self._near(z) if z.size else (z.copy(), z.copy())
        V, dV = np.empty_like(z), np.empty_like(z)
        V[far], dV[far] = self.far(z[far])
        if not far.all():
            V[~far], dV[~far] = self._near(z[~far])
        return V, dV

    def far(self, z: Complex, constant: bool = True) -> tuple[Complex, Complex]:
        """Both far from the contact, where they fall like 1/z and 1/z² but for the constant -I0, which singular ends take away again."""
        F, dF = outer_series(self._moments, self.contact, z)
        return -np.pi * F - (self.panels.I0 if constant else 0.0), -np.pi * dF

    @cached_property
    def _moments(self) -> Array:
        """g_n = 2/π ∫ H T_n dφ over the contact: the Chebyshev coefficients of H there, however slowly they fall."""
        g = self.panels.geometry
        offset, angle, weight, sign = g.nodes(quadrature_order(self.panels.degree + TERMS))
        from_right = np.where(sign > 0.0, np.pi - angle, angle)  # T_n(cos ψ) = cos nψ
        WH = weight * g.slopes(offset)
        return np.array([(2.0 / np.pi) * np.vdot(WH, np.cos(n * from_right)) for n in range(TERMS)])

    # -- near the contact ----------------------------------------------------------------------------------------------

    @cached_property
    def _many(self) -> BatchedPlane:
        return BatchedPlane(self)

    def _near(self, z: Complex) -> tuple[Complex, Complex]:
        if self.panels.many:
            return self._many.near(z)
        every = self.points(z)
        V, dV, N = np.zeros_like(z), np.zeros_like(z), np.zeros_like(z)
        shared: dict[float, Complex] = {}
        reach = []
        for k in range(len(self._series)):
            s = self.panels._s(k, z)
            near = self._within(k, s)
            reach.append(near)
            if near is None:
                self._add_closed_form(k, s, every, (V, dV, N), shared)
                continue
            for at, add in (
                (np.flatnonzero(near), self._add_closed_form),
                (np.flatnonzero(~near), self._add_quadrature),
            ):
                if at.size:
                    part = (V[at], dV[at], N[at])
                    add(k, s[at], every.at(at), part, {})
                    V[at], dV[at], N[at] = part
        self._add_jumps(z, reach, N)
        N /= every.divisor
        dV += N
        return V, dV

    def points(self, z: Complex) -> Points:
        left, right = self.contact.from_left(z), -self.contact.from_right(z)
        root1, root2 = np.sqrt(left), np.sqrt(right)
        R = root1 * root2
        return Points(z, left, right, root1, root2, R, R, 0.5 * (left + right))

    def weight(self, end: tuple[Any, Any, Any]) -> Any:
        """w(e), or in sliding (e - x1)(x2 - e)/w(e)."""
        return 2.0 * self.contact.r * end[1] * end[2]

    def logarithm(self, end: tuple[Any, Any, Any], at: Points) -> Complex:
        return _logarithm(end, at)

    def _within(self, k: int, s: Complex) -> NDArray[np.bool_] | None:
        """Which points the closed form of piece k serves, None if all: a square inside its ellipse is tried first."""
        rho = float(self.panels.reach[k])
        square = 0.5 * (rho - 1.0 / rho) / math.sqrt(2.0)
        if max(s.real.max(), -s.real.min(), s.imag.max()) <= square:
            return None
        near: NDArray[np.bool_] = np.abs(s - 1.0) + np.abs(s + 1.0) <= rho + 1.0 / rho
        return None if near.all() else near

    def _add_closed_form(
        self,
        k: int,
        s: Complex,
        at: Points,
        to: tuple[Complex, Complex, Complex],
        shared: dict[float, Complex],
    ) -> None:
        H, dH, ends, Q, dQ = self._series[k]
        V, dV, N = to
        J0 = self._angle(k, at, shared)
        Q_here = chebyshev.evaluate_second_kind(Q, s)
        V += chebyshev.evaluate(H, s) * J0
        V += at.R * Q_here
        dV += chebyshev.evaluate_second_kind(dH, s) * J0
        N += at.mean * Q_here
        N += chebyshev.evaluate(ends, s) if len(ends) > 1 else ends[0]
        if len(dQ):
            N += at.left * at.right * chebyshev.evaluate_second_kind(dQ, s)

    def _add_quadrature(
        self,
        k: int,
        s: Complex,
        at: Points,
        to: tuple[Complex, Complex, Complex],
        shared: dict[float, Complex],
    ) -> None:
        """V = R S and V' = ((z - m) S + R² S')/R,  S = ∫H / (w (t - z)) dt."""
        V, _, N = to
        offset, WH = self.panels._far_rules[k]
        lo, tail, _ = self.panels._places[k]
        from_lo = (at.z - lo) - tail
        S, dS = np.zeros_like(from_lo), np.zeros_like(from_lo)
        for t, weight in zip(offset.tolist(), WH.tolist(), strict=True):
            pole = np.reciprocal(t - from_lo)
            S += weight * pole
            pole *= pole
            dS += weight * pole
        V += at.R * S
        N += at.mean * S + at.left * at.right * dS

    def _angle(self, k: int, at: Points, shared: dict[float, Complex]) -> Any:
        """L_hi - L_lo; at the edges they are 0 and π."""
        lo, hi = self._ends[k]

        def logarithm(e: tuple[float, float, float]) -> Complex:
            if e[0] not in shared:
                shared[e[0]] = self.logarithm(e, at)
            return shared[e[0]]

        J0: Any = logarithm(hi) if hi else 0.0
        return J0 - (logarithm(lo) if lo else np.pi / self.panels.cos)

    def _add_jumps(self, z: Complex, reach: list[Any], N: Complex) -> None:
        """w(e) [H]_e / (z - e): 0 where H is continuous, unless only one of its two pieces is treated in closed form there."""
        for e, w, before, after, H_before, H_after in self._breaks:
            near_before = None if before is None else reach[before]
            near_after = None if after is None else reach[after]
            if (before is None or near_before is None) and (after is None or near_after is None):
                jump: Any = H_after - H_before
                if jump == 0.0:
                    continue
            else:
                jump = H_after * (1.0 if near_after is None else near_after) - H_before * (
                    1.0 if near_before is None else near_before
                )
            N += w * jump / (z - e)

    # -- what depends on the pieces only -------------------------------------------------------------------------------

    @cached_property
    def _ends(self) -> list[tuple[Any, Any]]:
        """Of every piece (lo, hi): (e, sqrt((e - x1)/2r), sqrt((x2 - e)/2r)), or None at an edge of the contact."""
        g = self.panels.geometry
        rows = np.stack((g.ends, g.root_left, g.root_right), axis=-1).tolist()  # (2, K, 3)
        last = len(g.k) - 1
        los = [None if g.cut_left and k == 0 else tuple(e) for k, e in enumerate(rows[0])]
        his = [None if g.cut_right and k == last else tuple(e) for k, e in enumerate(rows[1])]
        return list(zip(los, his, strict=True))

    @cached_property
    def _series(self) -> list[tuple[Array, Array, Array, Array, Array]]:
        """Of every piece: H and the ends' polynomial in T_n(s), H', Q and Q' in U_n(s), each as short as it is."""
        p = self.panels
        rows = []
        for k, (lo, hi) in enumerate(self._ends):
            n, half = p.lengths[k], p.half_length[k]
            c, q = p.series[k, :n], p._continuation[k, : n - 1]
            ends = np.zeros(max(n - 1, 1))
            for end, sign in ((lo, -1.0), (hi, 1.0)):
                if end:
                    w = self.weight(end)
                    ends[: n - 1] -= sign * w / half * chebyshev.divided(c, sign)
            rows.append(
                (
                    c,
                    np.arange(1, n) * c[1:] / half,
                    ends,
                    q,
                    chebyshev.second_kind_derivative(q) / half,
                )
            )
        return rows

    @cached_property
    def kinks(self) -> tuple[tuple[float, float], ...]:
        """(break, +inf or -inf) where the derivative of the pressure is infinite: p' ~ -[H']/π ln|x - e|; -inf where p itself is."""
        p = self.panels
        steepness = {e: [0.0, 0.0] for e, *_ in self._breaks}
        for (lo, hi), (_, dH, *_) in zip(self._ends, self._series, strict=True):
            U = np.arange(1, len(dH) + 1)  # U_m(1) = m + 1
            if lo:
                steepness[lo[0]][1] = float(dH @ (U * (-1.0) ** (U - 1)))
            if hi:
                steepness[hi[0]][0] = float(dH @ U)
        steepest = max((abs(v) for pair in steepness.values() for v in pair), default=0.0)
        least = SEEN_JUMP if p.geometry.slope.functions else JUMP
        infinite = {e for e, _ in p.jumps}
        found = (
            (e, -math.inf if e in infinite else math.copysign(math.inf, b - a))
            for e, (a, b) in steepness.items()
        )
        return tuple(
            (e, s)
            for e, s in found
            if e in infinite or abs(steepness[e][1] - steepness[e][0]) > least * steepest
        )

    @cached_property
    def _breaks(self) -> list[tuple[float, float, int | None, int | None, float, float]]:
        """Of every break inside the contact: (e, w(e), the pieces before and after it, H there from both sides)."""
        p = self.panels
        signs = (-1.0) ** np.arange(p.degree + 1)
        entering, leaving = (p.series @ signs).tolist(), p.series.sum(axis=1).tolist()
        found: dict[float, list[Any]] = {}
        for k, (lo, hi) in enumerate(self._ends):
            for end, place, value in ((lo, 1, entering[k]), (hi, 0, leaving[k])):
                if end:
                    row = found.setdefault(end[0], [self.weight(end), None, None, 0.0, 0.0])
                    row[1 + place], row[3 + place] = k, value
        jumps = {e for e, _ in p.jumps}
        for e, row in found.items():
            if e not in jumps:  # equal but for rounding
                row[3] = row[4] = 0.5 * (row[3] + row[4]) if None not in row[1:3] else 0.0
        return [(e, *row) for e, row in found.items()]


def _logarithm(end: tuple[Any, Any, Any], at: Points) -> Complex:
    """L_e. The two terms of its argument do not cancel in the upper half-plane, and z - e is exact next to the break."""
    e, e_left, e_right = end
    argument = e_left * at.root2 + (1j * e_right) * at.root1
    argument *= argument
    argument /= at.z - e
    L = np.empty_like(argument)
    L.real = np.arctan2(argument.imag, argument.real)
    L.imag = -np.log(np.abs(argument))
    return L
