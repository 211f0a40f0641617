"""Profiles as values: equal, hashable, picklable, printed as the code that rebuilds them.

A profile is the gap h(x) between the undeformed indenter and the flat surface, growing away from the contact. Each states its height and
its slope H = h' piece by piece (`slope.Slope`); the numerics see only the latter. Here: what all profiles can do, and what is made of other
profiles by tilting, shifting, mirroring and adding. The kinds themselves are in `indenters`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, wraps
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import checks
from .slope import Slope

Array = NDArray[np.float64]
Parity = Literal["even", "none"]


def of_any_x(height: Callable[[Any, Array], Array]) -> Callable[[Any, ArrayLike], Array]:
    """A height that is defined at finite x, everywhere: nan at nan, infinite far away as its slope says, inf where it overflows."""

    @wraps(height)
    def everywhere(profile: Profile, x: ArrayLike) -> Array:
        x = checks.reals("x", x)
        finite = np.isfinite(x)
        with np.errstate(over="ignore", invalid="ignore"):
            h = height(profile, np.where(finite, x, 0.0)[()])
            h = np.where(np.isnan(h), np.inf, h)  # the difference of two heights beyond all doubles
            if not finite.all():
                falls = profile.slope(x) * np.sign(x) < 0.0
                h = np.where(finite, h, np.where(np.isnan(x), x, np.where(falls, -np.inf, np.inf)))
        return h[()]

    return everywhere


class Profile(ABC):
    """An indenter. Lengths in any unit; slopes are pure numbers (radians, small)."""

    @property
    @abstractmethod
    def pieces(self) -> Slope:
        """H on its declared breaks (degrees of functions not yet resolved)."""

    @abstractmethod
    def height(self, x: ArrayLike) -> Array:
        """h(x), same shape as x; inf beyond the ends of the indenter."""

    @property
    def axis(self) -> float | None:
        """The x about which the profile is symmetric, None if it is not known to be."""
        return None

    @property
    def convex(self) -> bool:
        """Whether the profile is known to be convex: then p > 0 and gap > 0 follow and need not be checked."""
        return False

    def slope(self, x: ArrayLike) -> Array:
        """h'(x), same shape as x: the mean of both sides at a corner, -inf and inf beyond the ends of the indenter."""
        x = checks.reals("x", x)
        with np.errstate(over="ignore"):
            return np.where(np.isnan(x), x, self.pieces(x))[()]

    @property
    def breaks(self) -> tuple[float, ...]:
        """Where h or a derivative of it jumps, inside the domain."""
        return tuple(float(b) for b in self.pieces.breaks[1:-1])

    @property
    def domain(self) -> tuple[float, float]:
        return self.pieces.domain

    @property
    def ends_are_corners(self) -> tuple[bool, bool]:
        """Whether the ends of the domain are the indenter's own, where contact is sharp, and not just where knowledge of it ends."""
        return True, True

    @property
    def parity(self) -> Parity:
        """ "even" if h(-x) = h(x)."""
        return "even" if self.axis == 0.0 else "none"

    def tilted(self, slope: float) -> Profile:
        """h(x) + slope x."""
        slope = checks.finite("slope", slope)
        return self if slope == 0.0 else Tilted(self, slope)

    def shifted(self, dx: float) -> Profile:
        """h(x - dx)."""
        dx = checks.finite("dx", dx)
        return self if dx == 0.0 else Shifted(self, dx)

    def mirrored(self) -> Profile:
        """h(-x)."""
        return self if self.parity == "even" else Mirrored(self)

    def __add__(self, other: Profile) -> Profile:
        if not isinstance(other, Profile):
            return NotImplemented
        return Sum(self, other)


# -- what is made of other profiles ------------------------------------------------------------------------------------


class _Derived(Profile):
    def __repr__(self) -> str:
        return self._code()

    @abstractmethod
    def _code(self) -> str: ...


def _operand(profile: Profile) -> str:
    return f"({profile!r})" if isinstance(profile, Sum) else repr(profile)


@dataclass(frozen=True, repr=False)
class Tilted(_Derived):
    """h(x) + tilt x."""

    profile: Profile
    tilt: float

    @cached_property
    def pieces(self) -> Slope:
        return self.profile.pieces.tilted(self.tilt)

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        return self.profile.height(x) + self.tilt * checks.reals("x", x)

    @property
    def convex(self) -> bool:
        return self.profile.convex

    def tilted(self, slope: float) -> Profile:
        return self.profile.tilted(self.tilt + checks.finite("slope", slope))

    @property
    def ends_are_corners(self) -> tuple[bool, bool]:
        return self.profile.ends_are_corners

    def _code(self) -> str:
        return f"{_operand(self.profile)}.tilted({self.tilt!r})"


@dataclass(frozen=True, repr=False)
class Shifted(_Derived):
    """h(x - dx)."""

    profile: Profile
    dx: float

    @cached_property
    def pieces(self) -> Slope:
        return self.profile.pieces.shifted(self.dx)

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        return self.profile.height(checks.reals("x", x) - self.dx)

    @property
    def axis(self) -> float | None:
        return None if self.profile.axis is None else self.profile.axis + self.dx

    @property
    def convex(self) -> bool:
        return self.profile.convex

    def shifted(self, dx: float) -> Profile:
        return self.profile.shifted(self.dx + checks.finite("dx", dx))

    @property
    def ends_are_corners(self) -> tuple[bool, bool]:
        return self.profile.ends_are_corners

    def _code(self) -> str:
        return f"{_operand(self.profile)}.shifted({self.dx!r})"


@dataclass(frozen=True, repr=False)
class Mirrored(_Derived):
    """h(-x)."""

    profile: Profile

    @cached_property
    def pieces(self) -> Slope:
        return self.profile.pieces.mirrored()

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        return self.profile.height(-checks.reals("x", x))

    @property
    def axis(self) -> float | None:
        return None if self.profile.axis is None else -self.profile.axis

    @property
    def convex(self) -> bool:
        return self.profile.convex

    def mirrored(self) -> Profile:
        return self.profile

    @property
    def ends_are_corners(self) -> tuple[bool, bool]:
        return self.profile.ends_are_corners[::-1]

    def _code(self) -> str:
        return f"{_operand(self.profile)}.mirrored()"


@dataclass(frozen=True, repr=False)
class Sum(_Derived):
    """The sum of two profiles, on the intersection of their domains."""

    first: Profile
    second: Profile

    def __post_init__(self) -> None:
        _ = self.pieces  # refuses domains that do not overlap

    @cached_property
    def pieces(self) -> Slope:
        return self.first.pieces + self.second.pieces

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        return self.first.height(x) + self.second.height(x)

    @property
    def axis(self) -> float | None:
        return self.first.axis if self.first.axis == self.second.axis else None

    @property
    def convex(self) -> bool:
        return self.first.convex and self.second.convex

    @property
    def ends_are_corners(self) -> tuple[bool, bool]:
        """Those of the profile that ends first."""
        lo, hi = self.domain
        left, right = ([p.ends_are_corners[k] for p in (self.first, self.second) if p.domain[k] == end] for k, end in enumerate((lo, hi)))
        return all(left), all(right)

    def _code(self) -> str:
        return f"{self.first!r} + {_operand(self.second)}"
