"""The undeformed indenter: what the solver reads of a profile.

It is the gap h(x) between the indenter and the flat surface, which grows away from the contact. An
indenter states its slope H = h' piece by piece (`slope.Slope`), which is all that the solver uses,
and its height where it has a formula.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments

if TYPE_CHECKING:
    from .functions import PowerLaw
    from .slope import Slope

Array = NDArray[np.float64]
Parity = Literal["even", "none"]


def of_any_x(height: Callable[[Any, Array], Array]) -> Callable[[Any, ArrayLike], Array]:
    """Extend a height from finite x to all x.

    The result is nan at nan, inf where it overflows, and infinite at infinite x, with the sign that
    the slope has there.
    """

    @wraps(height)
    def everywhere(profile: Any, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        finite = np.isfinite(x)
        with np.errstate(over="ignore", invalid="ignore"):
            h = height(profile, np.where(finite, x, 0.0)[()])
            h = np.where(np.isnan(h), np.inf, h)  # the difference of two heights beyond all doubles
            if not finite.all():
                falls = profile.slope(x) * np.sign(x) < 0.0
                h = np.where(finite, h, np.where(np.isnan(x), x, np.where(falls, -np.inf, np.inf)))
        return h[()]

    return everywhere


class Indenter(ABC):
    """What a profile states of itself; `Profile` has the operations on it."""

    def _require_positive(self, *names: str, largest: float = arguments.LARGEST) -> None:
        """Replace fields of a profile that is being built by floats. ValueError unless > 0.

        An array stands for the profiles of many scenes (`sie.solve_many`).
        """
        for name in names:
            value = arguments.positives(name, getattr(self, name), largest)
            object.__setattr__(self, name, value)

    @property
    @abstractmethod
    def pieces(self) -> Slope:
        """The slope h', as `pieces` of another profile or a sum of them.

        Those of `Piecewise` are polynomials. Functions (`FromFunction`) are resolved when a contact
        is known.
        """

    @of_any_x
    def height(self, x: Array) -> Array:
        """The gap h(x) before loading.

        It is the integral of the slope from x = 0, or from the end of the indenter that is nearest
        to it, where the class has no formula.

        Parameters
        ----------
        x : array_like
            Positions on the surface, lengths.

        Returns
        -------
        ndarray or float
            Lengths, same shape as x; inf beyond the ends of the indenter, nan at nan.

        Raises
        ------
        ValueError
            If x is not made of real numbers.

        Examples
        --------
        >>> import sie
        >>> sie.Wedge(0.5).height([-1.0, 0.0, 4.0])
        array([0.5, 0. , 2. ])
        """
        from .pieces import integral  # noqa: PLC0415 -- needed by few profiles

        lo, hi = self.domain
        return integral(self.pieces, min(max(0.0, lo), hi), x)

    @property
    def axis(self) -> float | None:
        """The x about which h is symmetric, a length; None if it is not known to be symmetric."""
        return None

    @property
    def convex(self) -> bool:
        """Whether h is known to be convex. Then p > 0 and a gap > 0 follow and are not checked."""
        return False

    @property
    def power_law(self) -> PowerLaw | None:
        """The law h = A |x - c|^m of the profile, None if it is not known to have one."""
        return None

    def slope(self, x: ArrayLike) -> Array:
        """The slope h'(x).

        Parameters
        ----------
        x : array_like
            As of `height`.

        Returns
        -------
        ndarray or float
            Pure numbers, same shape as x. At a corner the mean of both sides; beyond the ends of
            the indenter -inf (left) and inf (right); nan at nan.

        Raises
        ------
        ValueError
            As of `height`.

        Examples
        --------
        >>> import sie
        >>> sie.Wedge(0.5).slope([-1.0, 0.0, 4.0])
        array([-0.5,  0. ,  0.5])
        """
        x = arguments.reals("x", x)
        with np.errstate(over="ignore"):
            return np.where(np.isnan(x), x, self.pieces(x))[()]

    @property
    def breaks(self) -> tuple[float, ...]:
        """The places inside the domain where h or a derivative of it jumps; ascending lengths."""
        return tuple(float(b) for b in self.pieces.breaks[1:-1])

    @property
    def domain(self) -> tuple[float, float]:
        """The ends of the indenter, lengths; infinite where it has none."""
        return self.pieces.domain

    @property
    def ends_are_corners(self) -> tuple[bool, bool]:
        """Whether an end of the domain is the indenter's own corner, where contact is sharp.

        The ends of a trace are no corners: the profile is not known beyond them.
        """
        return True, True

    @property
    def parity(self) -> Parity:
        """Whether h(-x) = h(x) is known: "even", else "none"."""
        return "even" if self.axis == 0.0 else "none"

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The parameters that are arrays, of many scenes at once (`sie.solve_many`)."""
        return ()

    @property
    def period(self) -> float:
        """The distance after which the profile repeats itself, inf if it does not."""
        return float("inf")

    @property
    def joint(self) -> str:
        """A sentence on the traces whose ends do not meet where they are repeated, or ""."""
        return ""

    @property
    def of_several(self) -> bool:
        """Whether it is a row of indenters, so that contact in several patches is asked for."""
        return self.period < float("inf")

    @property
    def walls(self) -> tuple[tuple[float, float], ...]:
        """Intervals (lo, hi) inside the domain without indenter; lo = hi where h jumps."""
        return ()
