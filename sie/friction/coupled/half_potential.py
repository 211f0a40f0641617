"""The potential of a traction on one half of a contact, from panels of Chebyshev series.

With T_n on a panel and s = 2 (t - lo)/(hi - lo) - 1

    K_n(z) = ∫_-1^1 T_n(s)/(z - s) ds:  K_0 = ln((z+1)/(z-1)),
    K_{n+1} = 2 z K_n - K_{n-1} - 2 ∫T_n ds

near the panel and Gauss-Legendre far from it; at the edge K_0 is Lerch's function (`lerch`). Of
several panels that are farther still only the moments count: one rule serves them all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev, lerch
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.traction.base import Complex

Array = NDArray[np.float64]

DEGREE = 16
NEAR = 3.0  # the Bernstein ellipse inside which the recurrence replaces Gauss-Legendre
# Beyond BEYOND half-lengths a rule of MERGED nodes replaces many panels: 4.5^-28; up to FEW panels,
# and SMALL products of points and panels, are integrated one by one
MERGED, BEYOND, FEW, SMALL = 28, 2.4, 4, 1000
TOGETHER = 2**15  # entries of a matrix that are computed at once
DISTANT = 1e100  # half-widths: beyond it squares overflow


class Panels(NamedTuple):
    """Panels of 0 <= y <= b, ascending: ends, series (n, DEGREE), and an exponent.

    The exponent is that of the last panel at b.
    """

    lo: Array
    hi: Array
    series: Array
    power: float


@dataclass(frozen=True, eq=False)
class HalfPotential:
    """1/π ∫_0^b f(t)/(z - t) dt and its derivative, at Im z > 0, from panels of f."""

    panels: Panels

    def traction(self, y: Array) -> Array:
        """f at 0 <= y <= b."""
        lo, hi, series, power = self.panels
        y = np.minimum(y, hi[-1])
        k = np.minimum(np.searchsorted(hi, y), len(hi) - 1)
        part = (y - lo[k]) / (hi - lo)[k]
        values: Array = chebyshev.evaluate(series.T[:, k], 2.0 * part - 1.0)
        return values * np.where(k == len(hi) - 1, 1.0 - part, 1.0) ** power

    @cached_property
    def quadrature(self) -> tuple[Array, Array]:
        """y and f dy of the far rule."""
        p = self.panels
        x, _, w = gauss_jacobi(DEGREE, 0.0, 0.0)
        half = (p.hi - p.lo)[:, None]
        y, mass = p.lo[:, None] + half * x, half * w * (p.series @ _polynomials(x))
        x, _, w = gauss_jacobi(DEGREE, p.power, 0.0)
        y[-1] = p.lo[-1] + half[-1] * x
        mass[-1] = half[-1] * w * (p.series[-1] @ _polynomials(x))
        return y.ravel(), mass.ravel()

    @cached_property
    def _clusters(self) -> dict[tuple[int, int], tuple[float, float, Array, Array]]:
        """Middles, half-lengths and rules of panels from one number up to another.

        All panels are halved again and again. The masses on the nodes of a rule have the moments
        of the traction, which far away is all that counts.
        """
        p, (y, mass) = self.panels, self.quadrature
        todo, clusters = [(0, len(p.lo))], {}
        nodes, charges = chebyshev.points(MERGED), chebyshev.charges(MERGED)
        while todo:
            first, last = todo.pop()
            half, own = 0.5 * (p.hi[last - 1] - p.lo[first]), slice(first * DEGREE, last * DEGREE)
            middle = p.lo[first] + half
            moments = chebyshev.polynomials(MERGED, (y[own] - middle) / half) @ mass[own]
            clusters[first, last] = middle, half, middle + half * nodes, moments @ charges
            if last - first > FEW:
                k = (first + last) // 2
                todo += [(first, k), (k, last)]
        return clusters

    def __call__(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        """Both; the derivative is 0 where it is not asked for."""
        F, dF = np.zeros_like(z), np.zeros_like(z)
        (y, mass), p = self.quadrature, self.panels
        todo, beside = [(np.arange(len(z)), 0, len(p.lo))], []
        while todo:
            own, first, last = todo.pop()
            if len(own) * (last - first) > SMALL and last - first > FEW:
                middle, half, *rule = self._clusters[first, last]
                far = np.abs(z[own] - middle) > BEYOND * half
                k, near = (first + last) // 2, own[~far]
                todo += [(near, first, k), (near, k, last)] if len(near) else []
                own, without = own[far], None
            else:
                lo, hi = p.lo[first:last], p.hi[first:last]
                reach = 0.25 * (NEAR + 1.0 / NEAR) * (hi - lo)
                without = np.abs(z[own][:, None] - 0.5 * (lo + hi)) <= reach
                rows, columns = np.nonzero(without)
                beside.append((own[rows], first + columns))
                part = slice(first * DEGREE, last * DEGREE)
                rule = [y[part], mass[part]]
            value, slope = self._of_masses(z[own], (rule[0], rule[1]), derivative, without)
            F[own] += value
            dF[own] += slope
        if beside:
            points, panels = (np.concatenate(column) for column in zip(*beside, strict=True))
            self._add_near(z, (points, panels), F, dF if derivative else np.zeros_like(z))
        return F / math.pi, dF / math.pi

    def _add_near(
        self, z: Complex, pairs: tuple[NDArray[np.intp], NDArray[np.intp]], F: Complex, dF: Complex
    ) -> None:
        """Adds both integrals over panels to the points that are near."""
        p, (own, k) = self.panels, pairs
        edge = k == len(p.lo) - 1
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            for function, chosen in ((_inner_panel, ~edge), (_edge_panel, edge)):
                i, j = own[chosen], k[chosen]
                if len(i):
                    value, slope = function(p.series[j].T, p.power, z[i], p.lo[j], p.hi[j])
                    np.add.at(F, i, value)
                    np.add.at(dF, i, slope)

    def _of_masses(
        self,
        z: Complex,
        rule: tuple[Array, Array],
        derivative: bool,
        near: NDArray[np.bool_] | None,
    ) -> tuple[Complex, Complex]:
        """Both sums over a rule, without the panels that are near; some of z at a time."""
        F, dF = np.empty_like(z), np.zeros_like(z)
        step = max(1, TOGETHER // len(rule[0]))
        for i in range(0, len(z), step):
            part = slice(i, i + step)
            without = None if near is None else near[part]
            F[part], dF[part] = self._of_few(z[part], rule, derivative, without)
        return F, dF

    def _of_few(
        self,
        z: Complex,
        rule: tuple[Array, Array],
        derivative: bool,
        near: NDArray[np.bool_] | None,
    ) -> tuple[Complex, Complex | float]:
        """The same in real arithmetic: complex division takes several times as long."""
        (y, mass), b = rule, self.panels.hi[-1]
        if np.abs(z).max(initial=0.0) > DISTANT * b:
            inverse = 1.0 / (z[:, None] - y)
            if near is not None:
                inverse.reshape(*near.shape, DEGREE)[near] = 0.0
            return inverse @ mass, -(inverse * inverse) @ mass
        x, depth = (z.real[:, None] - y) / b, z.imag / b
        square = x * x
        square += (depth * depth)[:, None]
        if near is not None:
            square.reshape(*near.shape, DEGREE)[near] = np.inf
        inverse = np.divide(1.0, square, out=square)
        x *= inverse
        sums = inverse @ mass
        F = (x @ mass - 1j * depth * sums) / b
        if not derivative:
            return F, 0.0
        x *= inverse
        inverse *= inverse
        across = depth * (inverse @ mass) + 1j * (x @ mass)
        return F, (2.0 * depth * across - sums) / b**2


def _inner_panel(
    c: Array, _power: float, z: Complex, lo: Array, hi: Array
) -> tuple[Complex, Complex]:
    """∫ Σ c_n T_n/(z - t) dt and its derivative, for each z on a panel of its own."""
    half = 0.5 * (hi - lo)
    below, above = z - lo, z - hi
    s = 0.5 * (below + above) / half
    K, dK = np.log(below / above), half * (1.0 / below - 1.0 / above)
    value, slope = _recurred(c, s, (K, dK), 4.0 * _moments(0.0))
    return value, slope / half


def _edge_panel(
    c: Array, power: float, z: Complex, lo: Array, hi: Array
) -> tuple[Complex, Complex]:
    """The same for ((hi - t)/(hi - lo))^power Σ c_n T_n.

    u = (hi - t)/(hi - lo), and ζ is that of z.
    """
    length = hi - lo
    zeta = (hi - z) / length
    K = _lerch_integral(power, zeta, (z - lo) / length)
    # ζ K' = power K - 1/(ζ - 1)
    dK = (power * K + length / (z - lo)) / zeta
    # In s = 1 - 2u: 1/(z - t) = -1/(length (u - ζ)·(-1)), and T_n(s) = (-1)^n T_n(2u - 1)
    signs = (-1.0) ** np.arange(DEGREE)[:, None]
    value, slope = _recurred(c * signs, 2.0 * zeta - 1.0, (K, 0.5 * dK), 4.0 * _moments(power))
    return -value, slope / (0.5 * length)


def _recurred(
    c: Array, s: Complex, start: tuple[Complex, Complex], moments: Array
) -> tuple[Complex, Complex]:
    """Σ c_n K_n and Σ c_n K_n' by the recurrence of K_n.

    K_{n+1} = 2 s K_n - K_{n-1} - moments_n, K_1 = s K_0 - moments_0/2.
    """
    K, dK = before, dbefore = start
    now, dnow = s * K - 0.5 * moments[0], K + s * dK
    value, slope = c[0] * before + c[1] * now, c[0] * dbefore + c[1] * dnow
    for n in range(2, DEGREE):
        before, now, dbefore, dnow = (
            now,
            2.0 * s * now - before - moments[n - 1],
            dnow,
            2.0 * now + 2.0 * s * dnow - dbefore,
        )
        value = value + c[n] * now
        slope = slope + c[n] * dnow
    return value, slope


@lru_cache(maxsize=64)
def _moments(power: float) -> Array:
    """∫_0^1 u^power T_n(2u - 1) du."""
    x, _, w = gauss_jacobi(DEGREE, 0.0, power)
    moments: Array = _polynomials(x) @ w
    return moments


def _polynomials(x: Array) -> Array:
    return chebyshev.polynomials(DEGREE, 2.0 * x - 1.0)


def _lerch_integral(power: float, zeta: Complex, rest: Complex) -> Complex:
    """∫_0^1 u^power/(ζ - u) du for Im ζ < 0, rest = 1 - ζ; -1 < power < 1."""
    a = power + 1.0 if power < 0.0 else power
    out = np.empty_like(zeta)
    far = np.abs(zeta) >= 1.0
    r = 1.0 / zeta[far]
    out[far] = zeta[far] ** (a - 1.0) * lerch.log(a, r, -rest[far] * r)
    near, own = ~far, zeta[~far]
    out[near] = own ** (a - 1.0) * lerch.log(1.0 - a, own, rest[near])
    out[near] -= math.pi / math.sin(math.pi * a) * (-own) ** (a - 1.0)
    return out if power < 0.0 else zeta * out - 1.0 / a
