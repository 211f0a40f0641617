"""The density that solves a Cauchy equation, a Jacobi series times its weight on each interval.

    φ(x) ρ(x) = w(s) Σ c_n p_n(s),        x(s) affine or graded, ρ = dx/ds or another factor

(`interval_map`). It is exact everywhere in the plane. On a graded interval the Cauchy kernel is
that of s plus a smooth one. Where z is near, the first has a closed form and the second is
integrated by plain Gauss quadrature. Further out the quadrature serves both.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.inheritance import override
from sie.numerics import jacobi
from sie.numerics.interval import EPS
from sie.numerics.jacobi_weight import Weight
from sie.traction.base import Density, zero_or_nan

from .interval_map import Affine, Map

Array = NDArray[Any]

# Points of the plane evaluated at once: nodes times points are held.
CHUNK = 4096
# Imaginary part of v (`interval_map`) from which plain quadrature serves: the kernel's other poles
# are then as far from the near region.
HALFWAY = 0.5 * math.pi


@dataclass(frozen=True, eq=False)
class Part:
    """The density on one interval."""

    map: Map
    weight: Weight
    coefficients: Array
    errors: Array | float = 0.0  # estimated, of each coefficient

    def less_certain(self, errors: Array) -> Part:
        """The same part with these errors of coefficients added; some of these may be dropped."""
        return replace(self, errors=np.hypot(self.errors, errors[: len(self.coefficients)]))

    # -- value -------------------------------------------------------------------------------------

    def value(self, to_right: Array, to_left: Array) -> Array:
        """φ at points inside, given their distances from the ends.

        It is infinite at a singular end, with the sign of its coefficient.
        """
        right, left, rho = self.map.inverse(to_right, to_left)
        psi = jacobi.evaluate(self.weight, self.coefficients, 0.5 * (left - right))
        safe = self.weight(np.where(right > 0.0, right, 1.0), np.where(left > 0.0, left, 1.0))
        out: Array = safe * psi / rho
        for distance, exponent in ((right, self.weight.alpha), (left, self.weight.beta)):
            end = distance <= 0.0
            if end.any():
                out[end] = 0.0 if exponent.real >= 0.0 else jacobi.infinite(psi[end])
        return out

    @cached_property
    def intensities(self) -> tuple[Any, Any]:
        """lim φ(x) / (distance)^exponent at the left and the right end."""
        out, w = [], self.weight
        for right, left, exponent, other in (
            (2.0, 0.0, w.beta, w.alpha),
            (0.0, 2.0, w.alpha, w.beta),
        ):
            _, _, rho, rest = self.map.distances(np.array([right]), np.array([left]))
            psi = jacobi.evaluate(self.weight, self.coefficients, np.array([0.5 * (left - right)]))
            out.append((psi * 2.0**other * (rho * rest) ** -exponent / rho)[0].item())
        return out[0], out[1]

    @cached_property
    def intensity_errors(self) -> tuple[float, float]:
        """Estimated relative errors of the intensities; infinite where one vanishes by chance."""
        p = jacobi.polynomials(self.weight, len(self.coefficients), np.array([-1.0, 1.0]))
        values = np.abs(self.coefficients @ p)
        off = np.linalg.norm(np.abs(p.T) * self.errors, axis=1)
        left, right = (
            e / v if v > 0.0 else math.copysign(math.inf, e)
            for e, v in zip(off.tolist(), values.tolist(), strict=True)
        )
        return left, right

    # -- sums --------------------------------------------------------------------------------------

    @cached_property
    def nodes(self) -> tuple[Array, Array, Array, Array]:
        """(s, x - x1, φ ρ times weights of ds, φ times weights of dx) at the quadrature nodes.

        ∫ f φ dx is Σ f times the last.
        """
        n = self._quadrature_size
        s, A = jacobi.analysis(self.weight, n)
        _, to_left, _, rest = self.map.distances(1.0 - s, 1.0 + s)
        c = self.coefficients[:n]  # the other terms are orthogonal to all that n nodes resolve
        values = A[:, : len(c)] @ c
        return s, to_left, values, values * rest

    @property
    def _quadrature_size(self) -> int:
        """The number of nodes for the coefficients times a kernel with poles at HALFWAY."""
        n = len(self.coefficients)
        if isinstance(self.map, Affine):
            return n + 1
        height = HALFWAY / self.map.h
        return (n + math.ceil(math.log(1.0 / EPS) / math.asinh(height))) // 2 + 4

    @cached_property
    def resultant(self) -> Any:
        """∫ φ dx of this part."""
        if not self.map.is_even:
            return self.nodes[3].sum().item()
        return (self.coefficients[0] / jacobi.recurrence(self.weight, 1).first).item()

    @cached_property
    def moment(self) -> Any:
        """∫ φ x dx about x = 0."""
        if isinstance(self.map, Affine):
            c = self.coefficients[:2]
            about_left = (c @ np.array(jacobi.first_moment(self.weight))[: len(c)]).item()
            return self.map.x1 * self.resultant + self.map.r * about_left
        _, to_left, _, values = self.nodes
        return self.map.x1 * self.resultant + (to_left @ values).item()

    # -- Cauchy integrals --------------------------------------------------------------------------

    def cauchy_inside(self, to_right: Array, to_left: Array, side: int) -> Array:
        """1/π PV∫ φ/(x - t) dt inside (side 0), or the limit from one side."""
        right, left, rho = self.map.inverse(to_right, to_left)
        value, smooth = self.value(to_right, to_left), self._smooth(right, left)
        regular = jacobi.second(self.weight, self.coefficients, 0.5 * (left - right)) - smooth
        out: Array = regular / rho - jacobi.cut(self.weight, value, side)
        return out

    def cauchy_outside(self, z: Array) -> Array:
        """1/π ∫ φ/(z - t) dt off the interval."""
        to_left, to_right = z - self.map.x1, self.map.x2 - z
        if isinstance(self.map, Affine):
            right, left = -to_right / self.map.r, to_left / self.map.r
            return (
                jacobi.cauchy(self.weight, self.coefficients, 0.5 * (left + right), right, left)
                / self.map.r
            )
        near = self._near(to_right, to_left)
        out = np.empty(z.shape, dtype=complex)
        if near.any():
            right, left, rho = self.map.inverse(to_right[near], to_left[near])
            part = jacobi.cauchy(self.weight, self.coefficients, 0.5 * (left - right), -right, left)
            out[near] = (part - self._smooth(right, left)) / rho
        if not near.all():
            s, _, _, values = self.nodes
            from_right, from_left, *_ = self.map.distances(1.0 - s, 1.0 + s)
            far = ~near
            # From the nearer end, so that nothing cancels in a gap
            closer = np.abs(to_right[far]) < np.abs(to_left[far])
            distance = np.where(
                closer[:, None],
                from_right - to_right[far][:, None],
                to_left[far][:, None] - from_left,
            )
            out[far] = (1.0 / distance) @ values / np.pi
        return out

    @cached_property
    def steepness(self) -> Part:
        """(x2 - x)(x - x1) φ'(x), a density with the same weight, from which F' follows.

        With Q(z) = (x2 - z)(z - x1):  1/π ∫ Q(t) φ'(t)/(z - t) dt = Q(z) F'(z) - 1/π ∫ φ dt.
        """
        n = (
            len(self.coefficients) + 2
            if isinstance(self.map, Affine)
            else 2 * len(self.coefficients)
        )
        s, A = jacobi.analysis(self.weight, n)
        right, left = 1.0 - s, 1.0 + s
        to_right, to_left, rho, rest = self.map.distances(right, left)
        psi = jacobi.evaluate(self.weight, self.coefficients, s)
        slope = jacobi.derivative(self.weight, self.coefficients, s)
        of_weight = (self.weight.beta * right - self.weight.alpha * left) / (right * left)
        values = (
            to_right
            * to_left
            / (rho * rest)
            * (slope + psi * (of_weight - self.map.steepening(left)))
        )
        return Part(self.map, self.weight, values @ A)

    def _near(self, to_right: Array, to_left: Array) -> Array:
        """Points whose s is in the ellipse through HALFWAY; plain quadrature fails there."""
        assert not isinstance(self.map, Affine)
        poles = (to_right + self.map.behind == 0.0) | (to_left + self.map.before == 0.0)
        at = np.where(poles, 0.5 * self.map.length, to_left)
        right, left, _ = self.map.inverse(np.where(poles, 0.5 * self.map.length, to_right), at)
        s = 0.5 * (left - right)
        height = HALFWAY / self.map.h
        near: Array = jacobi.bernstein(s, -right, left) < height + math.sqrt(1.0 + height * height)
        return near & ~poles

    def _smooth(self, right: Array, left: Array) -> Array:
        """1/π ∫ of the smooth part of the kernel."""
        s, _, values, _ = self.nodes
        kernel = self.map.smooth(s, right, left)
        if kernel is None:
            return np.zeros_like(right)
        out: Array = kernel @ values / np.pi
        return out


@dataclass(frozen=True, eq=False)
class JacobiDensity(Density):
    """The solution φ of a `CauchyEquation`, real or complex; 0 outside its intervals.

    Attributes
    ----------
    parts : tuple of Part
        One for each interval: .resultant, .moment, .intensities, .weight, .coefficients, .value.
    intensities : tuple
        For each interval the coefficients K of φ ~ K (distance)^exponent at its two ends.
    intensity_errors : tuple
        Estimated relative errors of these; large where K is small next to φ, as at a bounded end
        next to a narrow gap.
    constants : tuple
        The multiples of the equation's free functions.
    n : tuple of int
        The number of nodes on each interval that the solver chose.
    error : float
        Estimated error of φ over its largest value on the interval (singular ends divided out):
        it follows from the last coefficients, the residual and rounding, which grows next to narrow
        gaps and near eigenvalues.
    residual : float
        Largest residual of the equation at points that were not used to solve it, over the largest
        term there.

    Notes
    -----
    `cauchy` and `hilbert` have the half-plane's sign, 1/π ∫ φ(t)/(z - t) dt; that of the equation's
    kernel 1/(t - x) is the opposite one.

    Next to a gap of δ lengths between bounded ends, φ is of the order of δ times its peak when g is
    of one size everywhere. As g is known to rounding only, so is φ, and K there to n^1.5 roundings
    over δ: six digits are lost by δ = 1e-6, and two more by n = 70 nodes.
    """

    parts: tuple[Part, ...]
    constants: tuple[Any, ...] = ()
    n: tuple[int, ...] = ()
    error: float = math.nan
    residual: float = math.nan
    resultant: Any = field(init=False)
    moment: Any = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "resultant", sum(part.resultant for part in self.parts))
        object.__setattr__(self, "moment", sum(part.moment for part in self.parts))

    @property
    def interval(self) -> tuple[float, float]:
        """The interval from the first end to the last."""
        return self.parts[0].map.x1, self.parts[-1].map.x2

    @property
    def intervals(self) -> tuple[tuple[float, float], ...]:
        """The ends (x1, x2) of each interval, lengths."""
        return tuple((part.map.x1, part.map.x2) for part in self.parts)

    @property
    def intensities(self) -> tuple[tuple[Any, Any], ...]:
        """The intensities at both ends of each interval."""
        return tuple(part.intensities for part in self.parts)

    @property
    def intensity_errors(self) -> tuple[tuple[float, float], ...]:
        """The estimated errors of `intensities`, in the same order."""
        return tuple(part.intensity_errors for part in self.parts)

    @property
    def _kind(self) -> Any:
        return np.result_type(
            *(part.coefficients for part in self.parts), *(part.weight.kind for part in self.parts)
        )

    def __call__(self, x: ArrayLike) -> Array:
        """φ(x), same shape as x; infinite at a singular end."""
        x = arguments.reals("x", x)
        out = zero_or_nan(x.astype(self._kind))
        for part in self.parts:
            to_right, to_left = part.map.x2 - x, x - part.map.x1
            inside = (to_right >= 0.0) & (to_left >= 0.0)
            if inside.any():
                out[inside] = part.value(to_right[inside], to_left[inside])
        return out

    @override
    def hilbert(self, x: ArrayLike) -> Array:
        F = self.cauchy(arguments.reals("x", x), side=0)
        return F if np.issubdtype(self._kind, np.complexfloating) else F.real

    @override
    def cauchy(self, z: ArrayLike, side: int = 1) -> Array:
        return self._summed(_cauchy, z, side)

    @override
    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Array:
        return self._summed(_cauchy_derivative, z, side)

    def _summed(
        self, of_part: Callable[[Part, Array, int], Array], z: ArrayLike, side: int
    ) -> Array:
        def total(flat: Array) -> Array:
            out = np.zeros_like(flat)
            for start in range(0, len(flat), CHUNK):
                at = slice(start, start + CHUNK)
                for part in self.parts:
                    out[at] += of_part(part, flat[at], side)
            return out

        values: Array = self._in_plane(total, z, side, derivative=of_part is _cauchy_derivative)
        return values


def _cauchy_derivative(part: Part, z: Array, side: int) -> Array:
    Q = (part.map.x2 - z) * (z - part.map.x1)
    end = Q == 0.0
    out = np.empty(z.shape, dtype=complex)
    out[~end] = (_cauchy(part.steepness, z[~end], side) + part.resultant / np.pi) / Q[~end]
    out[end] = np.inf
    return out


def _cauchy(part: Part, z: Array, side: int) -> Array:
    out = np.empty(z.shape, dtype=complex)
    to_right, to_left = part.map.x2 - z.real, z.real - part.map.x1
    on = (z.imag == 0.0) & (to_right >= 0.0) & (to_left >= 0.0)
    if on.any():
        out[on] = part.cauchy_inside(to_right[on], to_left[on], side)
    if not on.all():
        out[~on] = part.cauchy_outside(z[~on])
    return out
