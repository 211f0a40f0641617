"""The functions of the two edges in V(z): the root w and one function L_e for each break e.

With the exponents 1/2 + ε of the left edge and 1/2 - ε of the right one,

    w(x) = (x - x1)^(1/2+ε) (x2 - x)^(1/2-ε),      X(z) = (z - x1)^(1/2+ε) (z - x2)^(1/2-ε)
    L_e(z) = -X(z) ∫_e^x2 dt / (w(t) (t - z))

so that a constant slope on the piece [a, b] contributes L_b - L_a to V(z). L is 0 at the right edge
and π/cos πε at the left one. `SquareRoot` is the case ε = 0 of similar bodies, where L_e is a
logarithm; `Powers` is full sliding of dissimilar bodies, where L_e is Lerch's function (`lerch`):
with τ = (t - x1)/(x2 - t) and its like ζ of z the kernel is (ζ/τ)^(1/2+ε) dτ/(τ - ζ), a function of
τ/ζ alone.

A break is given as e, sqrt((e - x1)/2r), sqrt((x2 - e)/2r), floats or arrays. On the line w or
±|X| stands for X, and a function for L that differs from it by a constant, the same for all breaks
and edges.

References: Ciavarella, Hills & Monno (1998), eqs (26)-(31); Galin, Contact Problems (1961); Hills,
Nowell & Sackfield (1993) § 2.5; Muskhelishvili (1953) §§ 107-110.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override
from sie.numerics import lerch
from sie.numerics.interval import EPS, Interval

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# L_e from e, sqrt((e - x1)/2r), sqrt((x2 - e)/2r), at the points with the last indices
BreakFunction = Callable[[Any, Any, Any, Any], Any]


class Points(NamedTuple):
    """Points of the upper half-plane, and the functions of the edges there for V and V'."""

    z: Complex
    left: Complex  # z - x1
    right: Complex  # z - x2
    X: Complex
    divisor: Complex  # (z - x1) (z - x2) / X
    mean: Complex  # X' times the divisor: z - m where ε = 0

    def at(self, where: Any) -> Points:
        """Some of the points."""
        return Points(*(values[where] for values in self))


class SquareRoot:
    """Both exponents are 1/2."""

    epsilon = 0.0
    cos = 1.0  # of πε

    def __init__(self, contact: Interval) -> None:
        self.contact = contact

    def on_contact(self, x: Array, kinks_only: bool) -> tuple[Array, BreakFunction]:
        """(w, L_e) inside the contact; `kinks_only` where H is continuous and all pieces near."""
        width = 2.0 * self.contact.r
        root_left = np.sqrt(self.contact.from_left(x) / width)
        root_right = np.sqrt(self.contact.from_right(x) / width)

        def function_of(e: Any, e_left: Any, e_right: Any, at: Any) -> Array:
            a, b = e_right * root_left[at], e_left * root_right[at]
            total = a + b
            # L = ln|1 - y| is small towards the edges; y -> 1 at the break
            y = 2.0 * np.minimum(a, b) / total
            if kinks_only:  # there L has a factor that vanishes, and its rounding with it
                kink: Array = np.log1p(-np.minimum(y, 1.0 - EPS))
                return kink
            near = np.flatnonzero(y > 0.75)
            y[near] = 0.0
            out: Array = np.log1p(-y)
            if near.size:
                scale = total[near]
                d = np.abs((x[at] - e)[near]) / (width * scale)
                # At the break itself L has the factor 0, or the pressure is infinite
                scale[d == 0.0] = d[d == 0.0] = 1.0
                out[near] = np.log(d / scale)
            return out

        return (width * root_left) * root_right, function_of

    def beside(self, x: Array, on_right: bool) -> tuple[Array, BreakFunction]:
        """(±|X|, L_e) beside the contact."""
        width = 2.0 * self.contact.r
        root_left = np.sqrt(np.abs(self.contact.from_left(x)) / width)
        root_right = np.sqrt(np.abs(self.contact.from_right(x)) / width)

        def function_of(e: Any, e_left: Any, e_right: Any, at: Any) -> Array:
            a, b = root_right[at] * e_left, root_left[at] * e_right
            L: Array = -2.0 * np.arctan2(a, b) if on_right else 2.0 * np.arctan2(b, a)
            return L

        return width * root_left * root_right * (1.0 if on_right else -1.0), function_of

    def upper(self, z: Complex) -> tuple[Points, BreakFunction]:
        """(the points, L_e) where Im z > 0."""
        left, right = self.contact.from_left(z), -self.contact.from_right(z)
        root1, root2 = np.sqrt(left), np.sqrt(right)
        X = root1 * root2

        def function_of(e: Any, e_left: Any, e_right: Any, at: Any) -> Complex:
            # The two terms do not cancel where Im z > 0, and z - e is exact next to the break
            argument = e_left * root2[at] + (1j * e_right) * root1[at]
            argument *= argument
            argument /= z[at] - e
            L = np.empty_like(argument)
            L.real = np.arctan2(argument.imag, argument.real)
            L.imag = -np.log(np.abs(argument))
            return L

        return Points(z, left, right, X, X, 0.5 * (left + right)), function_of

    def root(self, e_left: Any, e_right: Any) -> Any:
        """w(e)."""
        return 2.0 * self.contact.r * e_left * e_right

    def dual_root(self, e_left: Any, e_right: Any) -> Any:
        """v(e) = (e - x1)(x2 - e)/w(e), here w(e) itself."""
        return self.root(e_left, e_right)

    def quotient(self, z: Any) -> tuple[Any, Any]:
        """X(z) over sqrt(z - x1) sqrt(z - x2), less 1; and its derivative."""
        return 0.0, 0.0


class Powers(SquareRoot):
    """The exponents are 1/2 + ε at the left edge and 1/2 - ε at the right one."""

    def __init__(self, contact: Interval, epsilon: float) -> None:
        super().__init__(contact)
        self.epsilon, self.cos = epsilon, math.cos(math.pi * epsilon)
        self.at_left, self.at_right = 0.5 + epsilon, 0.5 - epsilon

    @override
    def on_contact(self, x: Array, kinks_only: bool) -> tuple[Array, BreakFunction]:
        left, right = self.contact.from_left(x), self.contact.from_right(x)
        least = EPS if kinks_only else 0.0

        def function_of(e: Any, e_left: Any, e_right: Any, at: Any) -> Array:
            away, towards = e_left**2 * right[at], e_right**2 * left[at]  # their ratio is τ_e / ζ
            out = np.empty_like(away)
            inside = away <= towards
            for mask, near, far, power in (
                (inside, away, towards, self.at_right),
                (~inside, towards, away, self.at_left),
            ):
                y = np.maximum(np.abs((x[at] - e)[mask]) / far[mask], least)
                y[y == 0.0] = EPS  # at the break itself, as in `SquareRoot`
                y = np.minimum(y, 1.0)
                out[mask] = -lerch.log(power, np.where(y < 0.5, 1.0 - y, near[mask] / far[mask]), y)
            return out

        return left**self.at_left * right**self.at_right, function_of

    @override
    def beside(self, x: Array, on_right: bool) -> tuple[Array, BreakFunction]:
        left, right = np.abs(self.contact.from_left(x)), np.abs(self.contact.from_right(x))

        def function_of(e: Any, e_left: Any, e_right: Any, at: Any) -> Array:
            ratio = (e_left / e_right) ** 2 * (right[at] / left[at])
            if on_right:
                return -lerch.arctan(self.at_right, ratio)
            return lerch.arctan(self.at_left, 1.0 / ratio)

        X = left**self.at_left * right**self.at_right
        return X * (1.0 if on_right else -1.0), function_of

    @override
    def upper(self, z: Complex) -> tuple[Points, BreakFunction]:
        left, right = self.contact.from_left(z), -self.contact.from_right(z)
        X = left**self.at_left * right**self.at_right

        def function_of(e: Any, e_left: Any, e_right: Any, at: Any) -> Complex:
            away, towards = e_left**2 * -right[at], e_right**2 * left[at]
            inside = np.abs(away) <= np.abs(towards)
            near, far = np.where(inside, away, towards), np.where(inside, towards, away)
            y = np.where(inside, 1.0, -1.0) * (z[at] - e) / far
            out = np.empty_like(away)
            turn = np.exp(1j * np.pi * self.at_right)
            for mask, power in ((inside, self.at_right), (~inside, self.at_left)):
                out[mask] = -turn * lerch.log(power, near[mask] / far[mask], y[mask])
            out[inside] += np.pi / self.cos
            return out

        mean = self.at_left * right + self.at_right * left
        return Points(z, left, right, X, left * right / X, mean), function_of

    @override
    def root(self, e_left: Any, e_right: Any) -> Any:
        return (
            2.0 * self.contact.r * e_left ** (2.0 * self.at_left) * e_right ** (2.0 * self.at_right)
        )

    @override
    def dual_root(self, e_left: Any, e_right: Any) -> Any:
        return (
            2.0 * self.contact.r * e_left ** (2.0 * self.at_right) * e_right ** (2.0 * self.at_left)
        )

    @override
    def quotient(self, z: Any) -> tuple[Any, Any]:
        left, right, r = self.contact.from_left(z), -self.contact.from_right(z), self.contact.r
        less = np.expm1(self.epsilon * lerch.log1p(2.0 * r / right))
        return less, (1.0 + less) * ((-2.0 * self.epsilon * r / left) / right)
