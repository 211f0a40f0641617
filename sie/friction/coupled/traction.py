"""The tractions of coupled partial slip, with their potentials.

Values come from the state itself; the potential from Chebyshev series on panels of half the
contact, cut in two until they resolve the traction, the last one times (1 - x/b)^α with the
exponent α of the edge. With T_n on a panel and s = 2 (t - lo)/(hi - lo) - 1

    K_n(z) = ∫_-1^1 T_n(s)/(z - s) ds:  K_0 = ln((z+1)/(z-1)),
    K_{n+1} = 2 z K_n - K_{n-1} - 2 ∫T_n ds

near the panel and Gauss-Legendre far from it; at the edge K_0 is Lerch's function (`lerch`). p is
even and q odd: F(z) = I(z) ∓ I(-z), I that of the right half.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.numerics import chebyshev, lerch
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import Interval
from sie.traction.base import Complex, Density, on_line, on_surface, reflected, shallow

Array = NDArray[np.float64]

DEGREE = 16
RESOLVED = 2e-14  # of the largest traction: the last coefficients of a panel
FAINT = 1e-15  # of the largest traction times b: what a short panel may miss
# Tails below ROUGH that a cut leaves above SAME of what they were are rounding
ROUGH, SAME = 1e-8, 0.8
LEAST = 1e-300  # of a panel, to an edge where the traction may be infinite
NEAR = 3.0  # the Bernstein ellipse inside which the recurrence replaces Gauss-Legendre
TOGETHER = 2**16  # entries of a matrix that are computed at once
DISTANT = 1e100  # half-widths: beyond it squares overflow


class Panels(NamedTuple):
    """Panels of 0 <= y <= b, ascending: ends, series (n, DEGREE), and an exponent.

    The exponent is that of the last panel at b.
    """

    lo: Array
    hi: Array
    series: Array
    power: float


class OnHalves(Density):
    """A traction with panels on both sides of a place `middle` of the contact."""

    contact: Interval

    @property
    def middle(self) -> float:
        raise NotImplementedError

    @property
    def sharp(self) -> bool:
        """Whether the traction is infinite at the edges."""
        return False

    def _potentials(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        """(F, F') at z - middle, Im z > 0 (F' is 0 where it is not asked for)."""
        raise NotImplementedError

    @property
    def interval(self) -> tuple[float, float]:
        return self.contact.x1, self.contact.x2

    def hilbert(self, x: ArrayLike) -> Array:
        def principal(flat: Array) -> Array:
            z = (flat - self.middle) + 1j * shallow(self.contact.r)
            values: Array = self._potentials(np.asarray(z, dtype=complex), derivative=False)[0].real
            if self.sharp:  # as for other sharp edges
                values[(flat == self.contact.x1) | (flat == self.contact.x2)] = 0.0
            return values

        return self._on_line(principal, x)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._at(z, side, derivative=False)

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._at(z, side, derivative=True)

    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        return self._at(z, side, derivative=False), self._at(z, side, derivative=True)

    def _at(self, z: ArrayLike, side: int, derivative: bool) -> Complex:
        def potential(flat: Complex) -> Complex:
            real = flat.imag == 0.0
            raised = flat - self.middle
            raised.imag[real] = shallow(self.contact.r)
            values: Complex = reflected(
                lambda u: self._potentials(u, derivative)[int(derivative)], raised
            )
            if real.any():
                if derivative:
                    values.imag[real] *= side
                else:
                    x = flat.real[real]
                    values[real] = on_surface(values.real[real], self._on_surface(x), side)
            return values

        return self._in_plane(potential, z, side, derivative)

    def _on_surface(self, x: Array) -> Array:
        """The traction at x, as the potential has it."""
        return self(x)

    def _potential(self, z: Any) -> Complex:
        return self._potentials(z, derivative=False)[0]

    def _derivative(self, z: Any) -> Complex:
        return self._potentials(z, derivative=True)[1]


@dataclass(frozen=True, eq=False)
class CoupledTraction(OnHalves):
    """A traction on axis ± b, even or odd about the axis.

    values      its values at 0 <= y <= b
    resolved    computes the panels of the right half
    parity      1 or -1
    load        its resultant
    marks       y where it or a derivative is not smooth, ascending up to b
    contact     axis ± b
    """

    values: Callable[[Array], Array] = field(repr=False)
    resolved: Callable[[], Panels] = field(repr=False)
    parity: float
    load: float
    marks: tuple[float, ...]
    contact: Interval

    @cached_property
    def panels(self) -> Panels:
        return self.resolved()

    @property
    def middle(self) -> float:
        return self.contact.m

    @property
    def sharp(self) -> bool:
        return self.panels.power < 0.0

    @cached_property
    def _half(self) -> HalfPotential:
        return HalfPotential(self.panels)

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return self.load

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        if self.parity > 0.0:
            return self.contact.m * self.load
        x, w = self._half.quadrature
        return 2.0 * float(w @ x)

    @property
    def breaks(self) -> tuple[float, ...]:
        m = self.contact.m
        inner = {m - y for y in self.marks[:-1]} | {m + y for y in self.marks[:-1]}
        return tuple(sorted(inner | set(self.interval)))

    def __call__(self, x: ArrayLike) -> Array:
        def value(flat: Array) -> Array:
            y = np.abs(flat - self.contact.m)
            y[(flat == self.contact.x1) | (flat == self.contact.x2)] = self.marks[-1]
            inside = (flat >= self.contact.x1) & (flat <= self.contact.x2)
            out = np.zeros(flat.shape)
            out[inside] = self.values(np.minimum(y[inside], self.marks[-1]))
            return np.where(flat < self.contact.m, self.parity * out, out) + 0.0

        return on_line(value, x)

    def _potentials(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        F, dF = self._half(z, derivative)
        G, dG = (v.conj() for v in self._half(-z.conj(), derivative))
        return F - self.parity * G, dF + self.parity * dG


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

    def __call__(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        """Both; the derivative is 0 where it is not asked for."""
        p = self.panels
        middle, half = 0.5 * (p.lo + p.hi), 0.5 * (p.hi - p.lo)
        near = np.abs(z[:, None] - middle) <= 0.5 * (NEAR + 1.0 / NEAR) * half
        F, dF = np.empty_like(z), np.zeros_like(z)
        step = max(1, TOGETHER // p.series.size)
        for i in range(0, len(z), step):
            part = slice(i, i + step)
            F[part], dF[part] = self._of_far_panels(z[part], near[part], derivative)
        for k in np.flatnonzero(near.any(axis=0)).tolist():
            own = np.flatnonzero(near[:, k])
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                if k == len(p.lo) - 1:
                    value, slope = _edge_panel(p.series[k], p.power, z[own], p.lo[k], p.hi[k])
                else:
                    value, slope = _inner_panel(p.series[k], z[own], p.lo[k], p.hi[k])
            F[own] += value
            if derivative:
                dF[own] += slope
        return F / math.pi, dF / math.pi

    def _of_far_panels(
        self, z: Complex, near: NDArray[np.bool_], derivative: bool
    ) -> tuple[Complex, Complex | float]:
        """The integrals by the rule of all panels that are not near, in real arithmetic.

        Complex division takes several times as long.
        """
        (y, mass), b = self.quadrature, self.panels.hi[-1]
        if np.abs(z).max(initial=0.0) > DISTANT * b:
            inverse = 1.0 / (z[:, None] - y)
            inverse.reshape(*near.shape, DEGREE)[near] = 0.0
            return inverse @ mass, -(inverse * inverse) @ mass
        x, depth = (z.real[:, None] - y) / b, z.imag / b
        square = x * x
        square += (depth * depth)[:, None]
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


def _inner_panel(c: Array, z: Complex, lo: float, hi: float) -> tuple[Complex, Complex]:
    """∫ Σ c_n T_n/(z - t) dt and its derivative."""
    half = 0.5 * (hi - lo)
    below, above = z - lo, z - hi
    s = 0.5 * (below + above) / half
    K, dK = np.log(below / above), half * (1.0 / below - 1.0 / above)
    value, slope = _recurred(c, s, (K, dK), 4.0 * _moments(0.0))
    return value, slope / half


def _edge_panel(
    c: Array, power: float, z: Complex, lo: float, hi: float
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
    signs = (-1.0) ** np.arange(DEGREE)
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


def on_panels(panels: Panels, y: Array) -> Array:
    """The values of the series at 0 <= y <= b."""
    k = np.clip(np.searchsorted(panels.lo, y, side="right") - 1, 0, len(panels.lo) - 1)
    length = (panels.hi - panels.lo)[k]
    s = 2.0 * (y - panels.lo[k]) / length - 1.0
    c = panels.series[k].T
    high, higher = c[-1], np.zeros_like(s)
    for a in c[-2:0:-1]:
        high, higher = a + 2.0 * s * high - higher, high
    values: Array = c[0] + s * high - higher
    last = k == len(panels.lo) - 1
    part = np.maximum((panels.hi[-1] - y[last]) / length[last], LEAST)
    values[last] *= part**panels.power
    return values


def resolved_panels(
    values: tuple[Callable[[Array], Array], ...],
    marks: tuple[float, ...],
    power: float,
    resolved: float = RESOLVED,
) -> tuple[Panels, ...]:
    """Panels of several functions of 0 < y < b that are smooth between the marks, b the last."""
    b = marks[-1]
    part = 0.5 * (1.0 + chebyshev.points(DEGREE))
    ends = (0.0, *marks)
    open_ = [(lo, hi, math.inf) for lo, hi in itertools.pairwise(ends) if hi > lo]
    done: list[tuple[float, float, Array]] = []
    largest = np.zeros(len(values))
    while open_:
        lo, hi, before = (np.array(column) for column in zip(*open_, strict=True))
        y = lo[:, None] + (hi - lo)[:, None] * part
        f = np.stack([v(y.ravel()).reshape(y.shape) for v in values])
        largest = np.maximum(largest, np.abs(f[..., 1:-1]).max(axis=(1, 2), initial=0.0))
        if hi[-1] == b:
            f[:, -1] /= ((b - y[-1]) / (b - lo[-1])) ** power
        series = chebyshev.transform(f)
        tail = np.abs(series[..., -2:]).max(axis=2) / np.maximum(largest, LEAST)[:, None]
        settled = ((tail <= resolved) | (tail * (hi - lo) <= FAINT * b)).all(axis=0)
        tail = tail.max(axis=0)
        settled |= (tail < ROUGH) & (tail > SAME * before)
        done += [(lo[k], hi[k], series[:, k]) for k in np.flatnonzero(settled)]
        open_ = []
        for k in np.flatnonzero(~settled).tolist():
            middle = 0.5 * (lo[k] + hi[k])
            open_ += [(lo[k], middle, tail[k]), (middle, hi[k], tail[k])]
    done.sort(key=lambda panel: panel[0])
    lo, hi = (np.array([panel[j] for panel in done]) for j in (0, 1))
    series = np.stack([panel[2] for panel in done], axis=1)
    return tuple(Panels(lo, hi, s, power) for s in series)
