"""Symmetric, convex indenters with a formula: parabola, rounded flat, flat, wedge and power law.

Each is symmetric about x = 0 and has h(0) = 0. Moved, tilted and added profiles are in `base`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.inheritance import override

from .base import Profile, function_slope
from .functions import PowerLaw
from .indenter import of_any_x
from .slope import Slope, polynomial_slope

Array = NDArray[np.float64]
INF = float("inf")


class _Convex(Profile):
    """A profile that is symmetric about x = 0 and convex."""

    @property
    def axis(self) -> float | None:
        return 0.0

    @property
    def convex(self) -> bool:
        return True

    @property
    @override
    def arrays(self) -> tuple[Array, ...]:
        return tuple(v for v in vars(self).values() if isinstance(v, np.ndarray))


@dataclass(frozen=True)
class Parabola(_Convex):
    """A cylinder, as a parabola: h = x²/(2 radius).

    Parameters
    ----------
    radius : float
        Radius of curvature, a length > 0.

    Raises
    ------
    ValueError
        If the radius is not a positive number between 1e-150 and 1e150.

    Notes
    -----
    The parabola stands for a circle as long as the contact is small against the radius. Under a
    load P the half-width is b = sqrt(4 P radius/(π E*)).

    References
    ----------
    H. Hertz (1882), J. reine angew. Math. 92. K. L. Johnson (1985), Contact Mechanics, eq. (4.43).

    Examples
    --------
    >>> Parabola(radius=2.0).height([0.0, 1.0])
    array([0.  , 0.25])
    """

    radius: float

    def __post_init__(self) -> None:
        self._require_positive("radius")

    @cached_property
    def pieces(self) -> Slope:
        """H = x/radius."""
        return polynomial_slope((-INF, INF), (0.0,), ((0.0, 1.0 / self.radius),))

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        return x * (x / (2.0 * self.radius))


@dataclass(frozen=True)
class RoundedFlat(_Convex):
    """A flat punch with rounded edges: h = max(|x| - half_flat, 0)²/(2 radius).

    Parameters
    ----------
    half_flat : float
        Half of the width of the flat base, a length > 0.
    radius : float
        Radius of the arcs beside the base (as parabolas), a length > 0.

    Raises
    ------
    ValueError
        If a parameter is not a positive number between 1e-150 and 1e150.

    References
    ----------
    M. Ciavarella, D. A. Hills & G. Monno (1998), Proc. IMechE C 212, eqs (26)-(32).

    Examples
    --------
    >>> RoundedFlat(half_flat=1.0, radius=50.0).height([0.5, 2.0])
    array([0.  , 0.01])
    """

    half_flat: float
    radius: float

    def __post_init__(self) -> None:
        self._require_positive("half_flat", "radius")

    @cached_property
    def pieces(self) -> Slope:
        """H = 0 on the base, ±(|x| - half_flat)/radius beside it."""
        a, curvature = self.half_flat, 1.0 / self.radius
        return polynomial_slope(
            (-INF, -a, a, INF), (-a, 0.0, a), ((0.0, curvature), (0.0,), (0.0, curvature))
        )

    @override
    def height(self, x: ArrayLike) -> Array:
        rim = np.maximum(np.abs(arguments.reals("x", x)) - self.half_flat, 0.0)
        with np.errstate(over="ignore"):  # the formula holds at every x, infinite ones included
            return np.asarray(rim * (rim * (0.5 / self.radius)))[()]


@dataclass(frozen=True)
class Flat(_Convex):
    """A flat punch with sharp corners: h = 0 for |x| <= half_width, and nothing beyond.

    Parameters
    ----------
    half_width : float
        Half of the width of the punch, a length > 0.

    Raises
    ------
    ValueError
        If the half-width is not a positive number between 1e-150 and 1e150.

    Notes
    -----
    The pressure is square-root singular at the corners: p = P/(π sqrt(half_width² - x²)).

    References
    ----------
    M. A. Sadowsky (1928), Z. angew. Math. Mech. 8. Johnson (1985), eq. (2.64).

    Examples
    --------
    >>> Flat(half_width=1.0).height([0.5, 2.0])
    array([ 0., inf])
    """

    half_width: float

    def __post_init__(self) -> None:
        self._require_positive("half_width")

    @cached_property
    def pieces(self) -> Slope:
        """H = 0 between the corners."""
        return polynomial_slope((-self.half_width, self.half_width), (0.0,), ((0.0,),))

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        return np.where(np.abs(x) <= self.half_width, 0.0, np.where(np.isnan(x), x, INF))


@dataclass(frozen=True, init=False, repr=False)
class Wedge(_Convex):
    """A blunt wedge: h = slope |x|.

    Parameters
    ----------
    slope : float
        Slope of the sides, > 0, a pure number that is small against 1.

    Raises
    ------
    ValueError
        If the slope is not a positive number.

    Notes
    -----
    The pressure is logarithmically infinite at the tip: p = (E* slope/π) arcosh(b/|x|).

    References
    ----------
    I. N. Sneddon (1951), Fourier Transforms, § 48. Johnson (1985), § 5.2.

    Examples
    --------
    >>> Wedge(slope=0.125).height([-1.0, 2.0])
    array([0.125, 0.25 ])
    """

    rise: float  # `slope` is a method

    def __init__(self, slope: float) -> None:
        object.__setattr__(self, "rise", arguments.positives("slope", slope))

    def __repr__(self) -> str:
        return f"Wedge(slope={self.rise!r})"

    @cached_property
    def pieces(self) -> Slope:
        """H = ±slope on the two sides of the tip."""
        return polynomial_slope((-INF, 0.0, INF), (0.0, 0.0), ((-self.rise,), (self.rise,)))

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        return self.rise * np.abs(x)


@dataclass(frozen=True)
class Power(_Convex):
    """A power law: h = coefficient |x|^exponent.

    Parameters
    ----------
    exponent : float
        At least 1, whole or not: 1 is a wedge, 2 a parabola; a large one approaches a flat punch.
    coefficient : float
        A length to the power 1 - exponent, > 0.

    Raises
    ------
    ValueError
        If the exponent is below 1 or a parameter is not a finite number in its range.

    References
    ----------
    I. A. Shtaerman (1939), Dokl. Akad. Nauk SSSR 25. J. Jäger (1998), Proc. IMechE C 212.

    Examples
    --------
    >>> Power(exponent=4.0, coefficient=0.5).height([0.0, 2.0])
    array([0., 8.])
    """

    exponent: float
    coefficient: float

    def __post_init__(self) -> None:
        m = arguments.finite("exponent", self.exponent)
        if m < 1.0:
            raise ValueError(
                f"exponent = {m:g} is below 1: the profile would not be convex; give exponent >= 1"
            )
        object.__setattr__(self, "exponent", m)
        self._require_positive("coefficient", largest=arguments.LARGEST_COEFFICIENT)

    @cached_property
    def pieces(self) -> Slope:
        """H = ±exponent coefficient |x|^(exponent - 1), polynomials if it can be."""
        m, A = self.exponent, self.coefficient
        if m.is_integer() and m <= 32:
            row = [0.0] * int(m - 1) + [m * A]
            if m % 2 == 0:
                return polynomial_slope((-INF, INF), (0.0,), (row,))
            return polynomial_slope((-INF, 0.0, INF), (0.0, 0.0), ([-c for c in row], row))
        return function_slope((-INF, 0.0, INF), PowerLaw(m, A))

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        return self.coefficient * np.abs(x) ** self.exponent

    @property
    @override
    def power_law(self) -> PowerLaw:
        return PowerLaw(self.exponent, self.coefficient)
