"""A traction on a contact: its value, resultant, moment and Cauchy integral.

    p(x)                                                       0 outside the contact, inf where it is infinite
    hilbert(x)    =  1/π PV∫ p(t)/(x - t) dt                   on the whole surface
    cauchy(z)     =  1/π ∫ p(t)/(z - t) dt                     the potential Fp of the half-plane; at x ± i0: hilbert ∓ i p (Plemelj)
    cauchy_derivative(z) = Fp'(z);  potentials(z) = both, which share their logarithms

Those whose slope is known are in `slope_density`, sums in `superposition`, solutions of Cauchy equations in `jacobi_density`.
(Muskhelishvili, Singular Integral Equations, 1953, §§ 16-17.)
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# The derivative on the surface is its value at this depth, in half-widths: closed forms keep all digits there, and 1/depth is finite.
# However small the contact, that depth is no underflow: at a depth of 0 the side of the surface would be lost.
SHALLOW, SHALLOWEST = 1e-290, 1e-300


def shallow(half_width: float) -> float:
    """A depth that no value but 1/depth can tell from the surface."""
    return max(SHALLOW * half_width, SHALLOWEST)


def on_axis(z: ArrayLike, side: int) -> tuple[Complex, NDArray[np.bool_]]:
    """(z as a complex array, which of its flattened entries are real)."""
    if side not in (-1, 0, 1):
        raise ValueError(f"side = {side!r} is not -1, 0 or 1: +1 is the limit from the body (y > 0), -1 from the other side")
    points = np.asarray(z, dtype=complex)
    return points, points.ravel().imag == 0.0


def reflected(function: Callable[[Complex], Any], z: Complex) -> Any:
    """function(z) of a function known for Im z > 0 that has conjugate values at conjugate points."""
    lower = z.imag < 0.0
    if not lower.any():
        return function(z)
    values = function(np.where(lower, z.conj(), z))
    values.imag[lower] *= -1.0
    return values


def in_order(function: Callable[[Array], Any], x: Array) -> Any:
    """function(x) for a function that wants x ascending and returns one array or several of its shape."""
    if x.size < 2 or (x[1:] >= x[:-1]).all():
        return function(x)
    order = np.argsort(x, kind="stable")
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    values = function(x[order])
    return tuple(v[back] for v in values) if isinstance(values, tuple) else values[back]


def refuse_side(side: int) -> None:
    if side not in (-1, 0, 1):
        raise ValueError(f"side = {side!r} is not -1, 0 or 1: +1 is the limit from the body (y > 0), -1 from the other side")


class Density(ABC):
    """A traction p(x) on the surface, in units of stress; x and z in units of length.

    Attributes: `interval` (the two edges), `resultant` = ∫p dx, `moment` = ∫p x dx about x = 0.
    """

    resultant: float
    moment: float

    @property
    @abstractmethod
    def interval(self) -> tuple[float, float]: ...
    @abstractmethod
    def __call__(self, x: ArrayLike) -> Array:
        """p(x), same shape as x."""

    @abstractmethod
    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        """F(z) = 1/π ∫ p(t)/(z - t) dt, same shape as z.

        `side` says where a real z inside the contact is approached from: +1 the body (y > 0), -1 the other half-plane, 0 the
        principal value. Elsewhere it has no effect.
        """

    @abstractmethod
    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        """F'(z), same shape as z; in the contact, at x + i0, that is hilbert' - i p'. Infinite at an edge and where p' is."""

    @abstractmethod
    def hilbert(self, x: ArrayLike) -> Array:
        """1/π PV∫ p(t)/(x - t) dt at real x, same shape as x."""

    def strength(self, x: float) -> float:
        """Where the density is infinite: the factor of that infinity, 0 elsewhere. It adds up when densities of one profile do."""
        return 0.0

    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        """(F, F') at z: what a stress needs, at the cost of little more than F where a form shares their logarithms."""
        return self.cauchy(z, side), self.cauchy_derivative(z, side)

    @property
    def bases(self) -> tuple[tuple[float, Density], ...]:
        """(factor, density) whose sum this is: potentials are computed once for each density, however often it occurs."""
        return ((1.0, self),)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Where p or its derivatives are not smooth: the edges and what lies between them, ascending."""
        return self.interval

    @property
    def hilbert_at_edges(self) -> tuple[float, float]:
        """The limits of `hilbert` at both edges, from inside: where it peaks, and rounding of an edge would show."""
        left, right = self.hilbert(np.array(self.interval)).tolist()
        return left, right


@dataclass(frozen=True)
class Zero(Density):
    """No traction."""

    resultant: float = 0.0
    moment: float = 0.0

    @property
    def interval(self) -> tuple[float, float]:
        return 0.0, 0.0

    def __call__(self, x: ArrayLike) -> Array:
        return np.zeros(np.shape(x))

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return np.zeros(np.shape(z), dtype=complex)

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        return np.zeros(np.shape(z), dtype=complex)

    @property
    def bases(self) -> tuple[tuple[float, Density], ...]:
        return ()

    @property
    def breaks(self) -> tuple[float, ...]:
        return ()

    def hilbert(self, x: ArrayLike) -> Array:
        return np.zeros(np.shape(x))


ZERO = Zero()
