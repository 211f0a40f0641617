"""Full sliding of dissimilar bodies: q = f p acts back on the pressure, and the edges' exponents leave 1/2.

    1/π PV∫ p(t)/(x - t) dt + tan(πε) p(x) = E*/2 H(x),        tan πε = -β f        (f with the sign of sliding)

With w(x) = (x - x1)^(1/2+ε) (x2 - x)^(1/2-ε), X(z) = (z - x1)^(1/2+ε) (z - x2)^(1/2-ε) and V(z) = X(z) ∫ H / (w (t - z)) dt

    p = E*/2 cos(πε)/π V,   V = cos(πε) (w PV∫ H/(w (t - x)) dt + π tan(πε) H) on the contact;       F(z) = -E*/2 cos(πε)/π V(z) elsewhere
    k1, k2 singular ends: + k1/2 ((x2-x)/(x-x1))^(1/2-ε) + k2/2 ((x-x1)/(x2-x))^(1/2+ε)

All is as for similar bodies (`panels`), with three things in the place of others: the functions of `lerch` for the logarithm of each
break, w for the root, and quadrature for dt/w. In τ = (t - x1)/(x2 - t) and its like ζ of z the kernel of a constant slope is
(ζ/τ)^(1/2+ε) dτ/(τ - ζ), a function of τ/ζ alone.

Galin, Contact Problems (1961); Hills, Nowell & Sackfield (1993) § 2.5; Muskhelishvili (1953) §§ 107-110 for the edges.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import NOTHING, Moments, rises, sizes
from sie.numerics import chebyshev, lerch
from sie.numerics.interval import EPS, Interval
from sie.profiles.power_law import Corner, PowerLaw
from sie.profiles.slope import Slope

from .many_panels_potential import Points
from .of_slope import PanelDensity
from .panels import Panels
from .piece_quadrature import Geometry, quadrature_order
from .potential import Plane

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Gauss-Legendre nodes for each e-fold of the distance from an edge, beyond those of a smooth integrand.
NODES_PER_FOLD = 3
SPARE = 6
SHORTEST = 1e-300  # half a length that may be divided by


class SlidingGeometry(Geometry):
    """Pieces in the contact with quadrature for dt/w: Gauss-Jacobi in the angle on a piece that ends at an edge, Gauss-Legendre in
    ln τ on others. The slope is broken at the middle of the contact, so that no piece comes near both edges."""

    def __init__(
        self, slope: Slope, contact: Interval, epsilon: float, keep_zero: bool = False
    ) -> None:
        lo, hi = slope.domain
        super().__init__(
            slope.split_at(contact.m) if lo < contact.m < hi else slope,
            contact,
            keep_zero=keep_zero,
        )
        self.epsilon = epsilon

    def nodes(self, n: int) -> tuple[Array, Array, Array, Array]:
        """Offsets t - lo, angles from the nearer edge, weights of dt/w, (K, N) with N >= n, and +1 where the left edge is the nearer."""
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
        """The piece between an edge and some point: the singular factor ψ^(∓2ε) of dt/w is in the rule's weights."""
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


@lru_cache(maxsize=64)
def edge_rule(n: int, power: float) -> tuple[Array, Array]:
    """∫_0^1 u^power f du, power > -1: nodes and weights."""
    from scipy.special import roots_jacobi  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

    s, w = roots_jacobi(n, 0.0, power)
    g, w = 0.5 * (1.0 + s), w * 2.0 ** (-1.0 - power)
    g.flags.writeable = w.flags.writeable = False
    return g, w


def sliding_moments(
    slope: Slope, contact: Interval, epsilon: float, keep_zero: bool = False
) -> Moments:
    """`moments` with dt/w for dφ, and C2 = ∫ H (1/2 - 2ε² - 2ε s - s²) dt/w, s = (t - m)/r."""
    g = SlidingGeometry(slope, contact, epsilon, keep_zero)
    if not len(g.k):
        return NOTHING
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        return _summed(g)


def _summed(g: SlidingGeometry) -> Moments:
    offset, angle, weight, sign = g.nodes(quadrature_order(g.slope.degree))
    H = g.slopes(offset)
    WH = weight * H
    near = 2.0 * np.sin(0.5 * angle) ** 2
    s, at_left = sign * (near - 1.0), sign > 0.0
    plus, minus = np.where(at_left, near, 2.0 - near), np.where(at_left, 2.0 - near, near)
    dJ = weight * _derivative(g, offset)
    JR, JL = float(np.vdot(dJ, plus)), float(np.vdot(dJ, minus))
    if not g.slope.continuous:
        jump = _jumps(g)
        JR, JL = JR + 2.0 * float(np.vdot(jump, g.left)), JL + 2.0 * float(np.vdot(jump, g.right))
    e = g.epsilon
    C2 = float(np.vdot(WH, 0.5 - 2.0 * e * e - 2.0 * e * s - s * s))
    positive, negative = np.maximum(WH, 0.0).sum(), -np.minimum(WH, 0.0).sum()
    return Moments(
        float(WH.sum()),
        float(np.vdot(WH, s)),
        C2,
        JR,
        JL,
        float(positive),
        float(negative),
        *sizes(g, weight, H),
    )


def _derivative(g: SlidingGeometry, offset: Array) -> Array:
    """H' at the nodes, from each piece's Chebyshev series: it steers Newton's steps only."""
    half = np.maximum(0.5 * g.length[:, None], SHORTEST)
    series = g.chebyshev_slope(max(g.slope.degree + 1, 2))
    series[np.abs(series[:, 1:]).sum(axis=1) <= 4.0 * EPS * np.abs(series[:, 0])] = (
        0.0  # rounding on a piece that short
    )
    derivative = np.polynomial.chebyshev.chebder(series, axis=1)
    s = offset / half - 1.0
    out: Array = (
        np.einsum("nkm,kn->km", chebyshev.polynomials(derivative.shape[1], s), derivative) / half
    )
    return out


def _jumps(g: SlidingGeometry) -> Array:
    """(2, K): H enters at lo and leaves at hi, over w there; an edge of the contact is not a jump."""
    series = g.chebyshev_slope(g.slope.degree + 1)
    jump = rises(np.stack((series @ (-1.0) ** np.arange(series.shape[1]), series.sum(axis=1))), g.k)
    w = g.left ** (0.5 + g.epsilon) * g.right ** (0.5 - g.epsilon)
    if g.cut_left:
        jump[0, 0], w[0, 0] = 0.0, 1.0
    if g.cut_right:
        jump[1, -1], w[1, -1] = 0.0, 1.0
    return jump / (2.0 * g.contact.r * w)


class SlidingPanels(Panels):
    """V(z) of the module's docstring."""

    geometry: SlidingGeometry

    def __init__(self, geometry: SlidingGeometry, I0: float = 0.0) -> None:
        super().__init__(geometry, I0)
        self.at_left, self.at_right = (
            0.5 + geometry.epsilon,
            0.5 - geometry.epsilon,
        )  # the exponents of w
        self.cos = math.cos(math.pi * geometry.epsilon)

    def _means(self) -> Array:
        offset, _, weight, _ = self.geometry.nodes(quadrature_order(self.degree))
        s = offset / self.half_length[:, None] - 1.0
        means: Array = (chebyshev.polynomials(max(self.degree, 1), s) * weight).sum(axis=-1)
        return means

    def on_contact(self, x: Array) -> Array:
        """V, without the factor cos πε."""
        left, right = self.contact.from_left(x), self.contact.from_right(x)
        # What multiplies the logarithm of a mere kink vanishes there, and at a jump V is set below
        least = EPS if self.geometry.slope.continuous else 0.0

        def log_of(e: float, e_left: float, e_right: float, at: Any) -> Array:
            away, towards = e_left**2 * right[at], e_right**2 * left[at]  # their ratio is τ_e / ζ
            out = np.empty_like(away)
            inside = away <= towards
            for mask, near, far, power in (
                (inside, away, towards, self.at_right),
                (~inside, towards, away, self.at_left),
            ):
                y = np.maximum(np.abs((x[at] - e)[mask]) / far[mask], least)
                y[y == 0.0] = EPS  # V is set to infinity there
                y = np.minimum(y, 1.0)
                out[mask] = -lerch.log(power, np.where(y < 0.5, 1.0 - y, near[mask] / far[mask]), y)
            return out

        V: Array = self._combined(
            x, left**self.at_left * right**self.at_right, log_of, on_contact=True
        )[0]
        for e, infinite in self.jumps:
            V[x == e] = infinite
        return V

    def beside(self, x: Array) -> tuple[Array, Array]:
        """V(x) beside the contact as (first, second) with V = first - π/cos(πε) second; see `Panels.beside`."""
        on_right = bool(x[0] > self.contact.m)
        left, right = np.abs(self.contact.from_left(x)), np.abs(self.contact.from_right(x))
        R = left**self.at_left * right**self.at_right * (1.0 if on_right else -1.0)

        def log_of(e: float, e_left: float, e_right: float, at: Any) -> Array:
            ratio = (e_left / e_right) ** 2 * (right[at] / left[at])
            return (
                -lerch.arctan(self.at_right, ratio)
                if on_right
                else lerch.arctan(self.at_left, 1.0 / ratio)
            )

        return self._continued(x, R, log_of, on_right)

    def off_axis(self, z: NDArray[np.complex128]) -> NDArray[np.complex128]:
        from_left, from_right = self.contact.from_left(z), self.contact.from_right(z)

        def log_of(e: float, e_left: float, e_right: float, at: Any) -> NDArray[np.complex128]:
            return self.function_of_break(
                (e, e_left, e_right), z[at], from_left[at], from_right[at]
            )

        return self._in_the_plane(
            z, from_left**self.at_left * (-from_right) ** self.at_right, log_of
        )

    def function_of_break(
        self, end: tuple[Any, Any, Any], z: Complex, from_left: Complex, from_right: Complex
    ) -> Complex:
        """What stands for the logarithm of the break e in the upper half-plane, given (e, sqrt((e - x1)/2r), sqrt((x2 - e)/2r))."""
        e, e_left, e_right = end
        away, towards = e_left**2 * from_right, e_right**2 * from_left
        inside = np.abs(away) <= np.abs(towards)
        near, far = np.where(inside, away, towards), np.where(inside, towards, away)
        y = np.where(inside, 1.0, -1.0) * (z - e) / far
        out = np.empty_like(away)
        turn = np.exp(1j * np.pi * self.at_right)
        for mask, power in ((inside, self.at_right), (~inside, self.at_left)):
            out[mask] = -turn * lerch.log(power, near[mask] / far[mask], y[mask])
        out[inside] += np.pi / self.cos
        return out

    def _far_root(self, z: Any, z_m: Any) -> Any:
        return (self.contact.from_left(z) / z_m) ** self.at_left * (
            -self.contact.from_right(z) / z_m
        ) ** self.at_right


class SlidingPlane(Plane):
    """V and V' with the exponents of `SlidingPanels`."""

    panels: SlidingPanels

    def points(self, z: Complex) -> Points:
        left, right = self.contact.from_left(z), -self.contact.from_right(z)
        p = self.panels
        R = left**p.at_left * right**p.at_right
        return Points(
            z, left, right, left, right, R, left * right / R, p.at_left * right + p.at_right * left
        )

    def weight(self, end: tuple[Any, Any, Any]) -> Any:
        p = self.panels
        return 2.0 * self.contact.r * end[1] ** (2.0 * p.at_right) * end[2] ** (2.0 * p.at_left)

    def logarithm(self, end: tuple[Any, Any, Any], at: Points) -> Complex:
        return self.panels.function_of_break(end, at.z, at.left, -at.right)

    def far(self, z: Complex, constant: bool = True) -> tuple[Complex, Complex]:
        """With s = z - m, T = ∫H t/(w (t - s)) dt about the centre and ρ = X/s:  V = (T - I0) ρ."""
        p, r = self.panels, self.contact.r
        t, charge = p.far_field_rule
        s = z - self.contact.m
        T, dT = np.zeros_like(z), np.zeros_like(z)
        for row_t, row_w in zip(t, charge, strict=True):
            pole = np.reciprocal(row_t[:, None] - s)
            T += row_w @ pole
            dT += row_w @ (pole * pole)
        less = np.expm1(p.at_left * lerch.log1p(r / s) + p.at_right * lerch.log1p(-r / s))  # ρ - 1
        # Ratios, because the cube of a distance may exceed all doubles
        steep = (1.0 + less) * ((r - 2.0 * p.geometry.epsilon * s) / s) * (r / (s - r) / (s + r))
        V = T * (1.0 + less) - p.I0 * (less + 1.0 if constant else less)
        return V, dT * (1.0 + less) + (T - p.I0) * steep


class SlidingDensity(PanelDensity):
    """The pressure in full sliding; `panels` are SlidingPanels."""

    panels: SlidingPanels

    @property
    def epsilon(self) -> float:
        """The edges' exponents are 1/2 ± epsilon."""
        return self.panels.geometry.epsilon

    def _by_pieces(self, x: Array) -> Array:
        return (self.panels.cos**2 / np.pi) * self.panels.on_contact(x)

    def _of_powers(self, laws: list[PowerLaw | Corner], y: Array, b: float) -> Array:
        """As H and p are conjugate, 1/π PV∫p/(x - t) + p tan πε = H is met with H sin πε cos πε."""
        slope = np.sum([law.slope_at(y) for law in laws], axis=0)
        cos, sin = self.panels.cos, math.sin(math.pi * self.epsilon)
        return cos * cos * super()._of_powers(laws, y, b) + sin * cos * slope

    def _potentials_of_powers(self, laws: list[PowerLaw | Corner], y: Complex, b: float) -> Complex:
        """The same: Re((1 + i tan πε) F) = H."""
        turn = self.panels.cos * np.exp(-1j * np.pi * self.epsilon)
        out: Complex = turn * super()._potentials_of_powers(laws, y, b)
        return out

    @cached_property
    def _plane(self) -> Plane:
        return SlidingPlane(self.panels)

    @property
    def _potential_scale(self) -> float:  # type: ignore[override]
        return -self.panels.cos / np.pi

    def _singular_pair(self, z: Complex, far: bool) -> Complex:
        left, right, r = self.contact.from_left(z), -self.contact.from_right(z), self.contact.r
        at_left, half = 0.5 + self.epsilon, 0.5 / self.panels.cos
        logarithm = lerch.log1p(2.0 * r / right) if far else np.log(left / right)
        power = np.expm1 if far else np.exp
        ends = self.k2 * power(at_left * logarithm) - self.k1 * power((at_left - 1.0) * logarithm)
        steep = self.k2 * at_left * np.exp(at_left * logarithm) - self.k1 * (
            at_left - 1.0
        ) * np.exp((at_left - 1.0) * logarithm)
        return np.array([half * ends, -2.0 * half * r * steep / (left * right)])

    def _hilbert_inside(self, x: Array) -> Array:
        # Where p is infinite so is this; only the slope's part is given there, as for similar bodies
        p = self(x)
        return self.half_modulus * self._slope(x) - math.tan(math.pi * self.epsilon) * np.where(
            np.isfinite(p), p, 0.0
        )

    def _beside(self, x: Array) -> tuple[Array, Array]:
        V, continued = self.panels.beside(x)
        return (self.panels.cos / np.pi) * V, continued

    def _edge(self, ratio: Array, on_left: bool) -> Array:
        out: Array = ratio ** (0.5 - self.epsilon if on_left else 0.5 + self.epsilon)
        return out

    def _singular_outside(self, left: Any, right: Any) -> Any:
        ratio = left / right if np.iscomplexobj(left) else np.abs(left / right)
        return (0.5 / self.panels.cos) * (
            self.k2 * ratio ** (0.5 + self.epsilon) - self.k1 * ratio ** (self.epsilon - 0.5)
        )
