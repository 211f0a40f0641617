"""A traction on a contact: its value, resultant, moment and Cauchy potential.

    p(x)                    0 outside the contact, inf where it is infinite
    hilbert(x)              1/π PV∫ p(t)/(x - t) dt on the whole surface
    cauchy(z)               1/π ∫ p(t)/(z - t) dt, the potential F of the half-plane
    cauchy_derivative(z)    F'(z);  potentials(z) is both, which share their logarithms

At x ± i0 the potential is hilbert ∓ i p (Plemelj). Tractions whose slope is known are in
`of_slope`, sums in `combination`, solutions of Cauchy equations in `sie.cauchy.density`.

Reference: Muskhelishvili, Singular Integral Equations (1953), §§ 16-17.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.numerics.interval import Interval

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# The derivative on the surface is its value at this depth, in half-widths: closed forms keep all
# digits there, and 1/depth is finite. However small the contact, that depth is no underflow: at a
# depth of 0 the side of the surface would be lost.
SHALLOW, SHALLOWEST = 1e-290, 1e-300
# Sizes of a traction at which it is a point force to all digits, and squares are no overflow yet.
FAR_AWAY, LARGEST = 1e100, 1e308


def shallow(half_width: float) -> float:
    """A depth at which all values but 1/depth equal those on the surface."""
    return max(SHALLOW * half_width, SHALLOWEST)


def on_line(function: Callable[[Array], Array], x: ArrayLike) -> Array:
    """function(x) in the shape of x, for a function of finite x (1-d).

    It is 0 where x is infinite, and nan where x is nan.
    """
    x = arguments.reals("x", x)
    flat = x.ravel()
    out, finite = zero_or_nan(flat), np.isfinite(flat)
    out[finite] = function(flat[finite])
    values: Array = out.reshape(x.shape)
    return values


def zero_or_nan(z: Any) -> Any:
    """The value of a traction and its integrals where it does not act: 0, but nan at nan.

    Points infinitely far away are included.
    """
    nan = complex(np.nan, np.nan) if np.iscomplexobj(z) else np.nan
    return np.where(np.isnan(z), nan, 0.0)


def on_surface(hilbert: Array, p: Array, side: int) -> Complex:
    """F at real x by Plemelj's formula, hilbert - i side p, part by part: p may be infinite."""
    F = np.empty(hilbert.shape, dtype=complex)
    F.real, F.imag = hilbert, -side * p if side else 0.0
    return F


def reflected(function: Callable[[Complex], Any], z: Complex) -> Any:
    """function(z) of a function known for Im z > 0, with conjugate values at conjugate points."""
    lower = z.imag < 0.0
    if not lower.any():
        return function(z)
    values = function(np.where(lower, z.conj(), z))
    values.imag[lower] *= -1.0
    return values


def in_order(function: Callable[[Array], Any], x: Array) -> Any:
    """function(x) for any x, by a function of ascending x.

    The function returns one array or several of the shape of x.
    """
    if x.size < 2 or (x[1:] >= x[:-1]).all():
        return function(x)
    order = np.argsort(x, kind="stable")
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    values = function(x[order])
    return tuple(v[back] for v in values) if isinstance(values, tuple) else values[back]


def refuse_side(side: int) -> None:
    """Raises ValueError unless side is -1, 0 or 1."""
    if not arguments.among(side, (-1, 0, 1)):
        raise ValueError(
            f"side = {side!r} is not -1, 0 or 1: +1 is the limit from the body (y > 0), -1 from "
            "the other side"
        )


class Density(ABC):
    """A traction p(x) on the surface.

    Far away it is 0, and so are its integrals; at nan all are nan. All stresses have one unit, and
    all lengths.

    Attributes
    ----------
    interval : tuple of float
        The two edges, as lengths.
    resultant : float
        ∫p dx, a force per unit length.
    moment : float
        ∫p x dx about x = 0.

    References
    ----------
    Muskhelishvili, Singular Integral Equations (1953), §§ 16-17.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(2.0), modulus=1.0, normal_load=0.1)
    >>> p = sie.solve(scene).pressure
    >>> round(p.resultant, 12), p([-9.0, 9.0]).tolist()
    (0.1, [0.0, 0.0])
    """

    resultant: float
    moment: float

    @property
    @abstractmethod
    def interval(self) -> tuple[float, float]:
        """The two edges."""

    @abstractmethod
    def __call__(self, x: ArrayLike) -> Array:
        """The traction p(x).

        Parameters
        ----------
        x : array_like
            Places on the surface, lengths of any shape.

        Returns
        -------
        ndarray
            Stresses, of the shape of `x`: 0 outside the contact, inf where p is infinite.

        Raises
        ------
        ValueError
            If `x` is not made of real numbers.
        """

    @abstractmethod
    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        """The Cauchy potential F(z) = 1/π ∫ p(t)/(z - t) dt.

        Parameters
        ----------
        z : array_like
            Places x + i y, lengths of any shape.
        side : {1, -1, 0}
            Where a real z inside the contact is approached from: the body (y > 0), the other
            half-plane, or neither (the principal value). Elsewhere it has no effect.

        Returns
        -------
        ndarray of complex
            Stresses, of the shape of `z`. On the contact F(x ± i0) = hilbert(x) ∓ i p(x).

        Raises
        ------
        ValueError
            If `z` is not made of numbers, or `side` is another value.
        """

    @abstractmethod
    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        """The derivative F'(z) of the Cauchy potential.

        Parameters
        ----------
        z : array_like
            Places x + i y, as of `cauchy`.
        side : {1, -1, 0}
            As of `cauchy`.

        Returns
        -------
        ndarray of complex
            Stresses over lengths, of the shape of `z`. On the contact F'(x + i0) =
            hilbert'(x) - i p'(x). It is infinite at an edge, and where p' is.

        Raises
        ------
        ValueError
            As of `cauchy`.
        """

    @abstractmethod
    def hilbert(self, x: ArrayLike) -> Array:
        """The principal value 1/π PV∫ p(t)/(x - t) dt on the surface.

        Parameters
        ----------
        x : array_like
            Places on the surface, as of the traction itself.

        Returns
        -------
        ndarray
            Stresses, of the shape of `x`.

        Raises
        ------
        ValueError
            As of the traction itself.
        """

    # The evaluation within a form: on 1-d arrays of places that are not so far away that their
    # squares overflow. There F is that of a force.

    def _on_line(self, function: Callable[[Array], Array], x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        values: Array = self._everywhere(function, x.ravel(), self._of_force).reshape(x.shape)
        return values

    def _in_plane(
        self,
        function: Callable[[Complex], Complex],
        z: ArrayLike,
        side: int,
        derivative: bool = False,
    ) -> Complex:
        refuse_side(side)
        z = arguments.complexes("z", z)
        values: Complex = self._everywhere(
            function, z.ravel(), self._steepness_of_force if derivative else self._of_force
        ).reshape(z.shape)
        return values

    def _everywhere(
        self, function: Callable[[Any], Any], z: Any, tail: Callable[[Any], Any]
    ) -> Any:
        near = np.abs(z) <= self.horizon
        if near.all():
            return function(z)
        values = function(z[near])
        out = zero_or_nan(z).astype(values.dtype)
        far = ~near & np.isfinite(z)
        out[near], out[far] = values, tail(z[far])
        return out

    @cached_property
    def horizon(self) -> float:
        """The distance from x = 0 beyond which a traction acts as a point force, to all digits."""
        lo, hi = self.interval
        size = max(abs(lo), abs(hi), hi - lo)
        return min(FAR_AWAY * size, LARGEST) if math.isfinite(abs(self.resultant)) else LARGEST

    def _of_force(self, z: Any) -> Any:
        return (self.resultant / math.pi) / z

    def _steepness_of_force(self, z: Any) -> Any:
        return -self._of_force(z) / z

    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        """The Cauchy potential and its derivative, at little more than the cost of the first.

        Parameters
        ----------
        z : array_like
            Places x + i y, lengths of any shape.
        side : {1, -1, 0}
            As of `cauchy`.

        Returns
        -------
        F, dF : ndarray of complex
            As `cauchy` and `cauchy_derivative` return them.

        Raises
        ------
        ValueError
            As of `cauchy`.
        """
        return self.cauchy(z, side), self.cauchy_derivative(z, side)

    @property
    def bases(self) -> tuple[tuple[float, Density], ...]:
        """Pairs (factor, density) whose sum this is.

        The potentials of each density are computed once, however often it occurs.
        """
        return ((1.0, self),)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The places where p or its derivatives are not smooth, ascending, with the edges."""
        return self.interval

    @property
    def singular(self) -> tuple[float, ...]:
        """The breaks at which the slope of the density is, or may be, infinite."""
        return self.breaks

    @property
    def hilbert_at_edges(self) -> tuple[float, float]:
        """The limits of `hilbert` at both edges, from inside.

        It has its peaks there, where rounding of an edge would change its values.
        """
        left, right = self.hilbert(np.array(self.interval)).tolist()
        return left, right


class InContact(NamedTuple):
    """p and q between the edges of a contact.

    contact     the edges
    marks       places where p or q is not smooth, with the edges, ascending
    rows        p and q (2, n) at places x (n,) at distances (n,) from the nearer edge
    origin      the place that x is counted from
    exact       whether these distances count, and not those of the rounded x
    """

    contact: Interval
    marks: tuple[float, ...]
    rows: Callable[[Array, Array], Array]
    origin: float = 0.0
    exact: bool = False
