"""Profiles as values: equal, hashable, picklable, printed as the code that rebuilds them.

The kinds of profile are listed in `kinds`. Profiles are tilted, shifted, mirrored, raised and added
to others. Whatever is done in whatever order, the result is a sum of profiles, each mirrored or
not, then tilted, shifted and raised: h is

    Σ h_k(sign_k (x - shift_k)) + tilt_k (x - shift_k) + rise_k
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.arguments import with_middle_cut
from sie.inheritance import override
from sie.numerics.zones import united

from .functions import FunctionTerm, PowerLaw, Vectorised
from .indenter import Indenter, of_any_x
from .slope import Slope

Array = NDArray[np.float64]
Pair = tuple[float, float]


class Profile(Indenter):
    """The undeformed indenter: its gap h(x) to the flat surface.

    A profile of one's own derives from this class and states `pieces`
    (docs/how-to/own-profile.md). Lengths have any unit. Slopes are pure numbers, small against 1.

    Notes
    -----
    The pressure p and the contact [x1, x2] follow from the slope H = h':

        E*/2 H(x) = 1/π PV∫ p(t)/(x - t) dt,    x1 < x < x2

    Examples
    --------
    >>> import sie
    >>> worn = sie.RoundedFlat(1.0, 50.0).tilted(1e-3) + sie.Parabola(1e4)
    >>> worn.breaks
    (-1.0, 1.0)
    """

    def tilted(self, slope: float) -> Profile:
        """The profile h(x) + slope x.

        Parameters
        ----------
        slope : float
            The tilt, a pure number, small against 1.

        Returns
        -------
        Profile
            The same indenter, tilted.

        Raises
        ------
        ValueError
            If the tilt is no finite number, or larger than 1e150.

        Examples
        --------
        >>> import sie
        >>> sie.Parabola(1.0).tilted(0.5).slope([-0.5, 0.0])
        array([0. , 0.5])
        """
        slope = arguments.measure("tilted", slope)
        if slope == 0.0:
            return self
        first, *others = parts_of(self)
        first = first._replace(tilt=first.tilt + slope, rise=first.rise + slope * first.shift)
        return _made((first, *others), _reach(self))

    def shifted(self, dx: float) -> Profile:
        """The profile h(x - dx).

        Parameters
        ----------
        dx : float
            The shift towards +x, a length.

        Returns
        -------
        Profile
            The same indenter at another place.

        Raises
        ------
        ValueError
            If dx is no finite number, or so large that nothing of the domain is left in doubles.

        Examples
        --------
        >>> import sie
        >>> sie.Parabola(1.0).shifted(2.0).axis
        2.0
        """
        dx = arguments.measure("shifted", dx)
        if abs(dx) * arguments.LARGEST_COEFFICIENT < 1.0:
            return self
        lo, hi = _reach(self)
        if not lo + dx < hi + dx:
            raise ValueError(
                f"shifted({dx:g}) leaves nothing of a profile on ({lo:g}, {hi:g}), "
                "doubles are farther apart there: shift it less"
            )
        parts = tuple(part._replace(shift=part.shift + dx) for part in parts_of(self))
        return _made(parts, (lo + dx, hi + dx))

    def mirrored(self) -> Profile:
        """The profile h(-x).

        Returns
        -------
        Profile
            The profile itself if it is known to be even.

        Examples
        --------
        >>> import sie
        >>> sie.Parabola(1.0).shifted(2.0).mirrored().axis
        -2.0
        """
        if self.parity == "even":
            return self
        lo, hi = _reach(self)
        return _made(tuple(part.mirrored() for part in parts_of(self)), (-hi, -lo))

    def raised(self, dz: float) -> Profile:
        """The profile h(x) + dz. The height matters only among the indenters of a row.

        Parameters
        ----------
        dz : float
            The rise away from the surface, a length.

        Returns
        -------
        Profile
            The same indenter, farther from the surface.

        Raises
        ------
        ValueError
            If dz is no finite number, or larger than 1e150.

        Examples
        --------
        >>> import sie
        >>> sie.Parabola(1.0).raised(0.5).height([0.0, 1.0])
        array([0.5, 1. ])
        """
        dz = arguments.measure("raised", dz)
        if dz == 0.0:
            return self
        first, *others = parts_of(self)
        return _made((first._replace(rise=first.rise + dz), *others), _reach(self))

    def __add__(self, other: Profile) -> Profile:
        """The profile h(x) + other.h(x), on the intersection of both domains."""
        if not isinstance(other, Profile):
            return NotImplemented
        for profile in (self, other):
            if profile.period < float("inf"):
                raise ValueError(
                    f"{profile!r} is repeated: add profiles first, then repeat the sum"
                )
        one, two = _reach(self), _reach(other)
        lo, hi = max(one[0], two[0]), min(one[1], two[1])
        if not lo < hi:
            raise ValueError(
                f"profiles on {one} and {two} do not overlap: shift one of them before adding"
            )
        return Composite(parts_of(self) + parts_of(other), (lo, hi))


class Placed(NamedTuple):
    """The part h(sign (x - shift)) + tilt (x - shift) + rise of a profile."""

    profile: Profile
    sign: float = 1.0
    tilt: float = 0.0
    shift: float = 0.0
    rise: float = 0.0

    def __str__(self) -> str:
        """The code that makes it."""
        names = zip(("tilted", "shifted", "raised"), self[2:], strict=True)
        calls = [f".{name}({value!r})" for name, value in names if value]
        mirrored = ".mirrored()" if self.sign < 0.0 else ""
        return f"{self.profile!r}{mirrored}{''.join(calls)}"

    @property
    def axis(self) -> float | None:
        """The x about which it is symmetric, None if it is not known to be."""
        axis = self.profile.axis
        return None if axis is None or self.tilt else self.sign * axis + self.shift

    @property
    def slope(self) -> Slope:
        """H, on its breaks."""
        slope = self.profile.pieces if self.sign > 0.0 else self.profile.pieces.mirrored()
        return slope.tilted(self.tilt).shifted(self.shift)

    def height(self, x: Array) -> Array:
        """h at finite x."""
        u = x - self.shift
        return self.profile.height(self.sign * u) + self.tilt * u + self.rise

    def mirrored(self) -> Placed:
        """The part at -x; a profile that is even is left as it is."""
        sign = self.sign if self.profile.axis == 0.0 else -self.sign
        return Placed(self.profile, sign, -self.tilt, -self.shift, self.rise)


@dataclass(frozen=True, repr=False)
class Composite(Profile):
    """The sum of placed profiles, none of which is made of others, on their common domain."""

    parts: tuple[Placed, ...]
    reach: Pair = field(compare=False)

    def __repr__(self) -> str:
        return with_middle_cut(" + ".join(map(str, self.parts)))

    @cached_property
    def pieces(self) -> Slope:
        """H on its declared breaks, the sum of the slopes of all parts."""
        slopes = [part.slope for part in self.parts]
        while len(slopes) > 1:  # in pairs, so that no break is merged more than log2 n times
            pairs = [one + other for one, other in zip(slopes[::2], slopes[1::2], strict=False)]
            slopes = pairs + slopes[2 * len(pairs) :]
        return slopes[0]

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        total = np.zeros(np.shape(x))
        for part in self.parts:
            total = total + part.height(x)
        return total

    @cached_property
    def axis(self) -> float | None:
        """The axis that all parts have, None if they have none in common."""
        axes = {part.axis for part in self.parts}
        return axes.pop() if len(axes) == 1 else None

    @property
    @override
    def power_law(self) -> PowerLaw | None:
        """The law of the part, placed; None for several parts or a tilted one."""
        part, *others = self.parts
        law = part.profile.power_law if part.tilt == 0.0 and not others else None
        return law and replace(law, axis=part.sign * law.axis + part.shift)

    @property
    @override
    def of_several(self) -> bool:
        return any(part.profile.of_several for part in self.parts)

    @cached_property
    def convex(self) -> bool:
        """Whether all parts are known to be convex; then h is."""
        return all(part.profile.convex for part in self.parts)

    @cached_property
    def walls(self) -> tuple[Pair, ...]:
        """Those of the profiles that add up to this one."""
        lo, hi = self.domain
        placed = [
            sorted((part.sign * one + part.shift, part.sign * other + part.shift))
            for part in self.parts
            for one, other in part.profile.walls
        ]
        return united([(max(a, lo), min(b, hi)) for a, b in placed if a < hi and b > lo])

    @cached_property
    def ends_are_corners(self) -> tuple[bool, bool]:
        """Whether each end is a corner of the profile whose domain ends there."""
        corners = [True, True]
        for part in self.parts:
            ends = zip(part.profile.domain, part.profile.ends_are_corners, strict=True)
            for end, is_corner in ends:
                here = part.sign * end + part.shift
                for k in (0, 1):
                    corners[k] &= is_corner or here != self.domain[k]
        return corners[0], corners[1]


def parts_of(profile: Profile) -> tuple[Placed, ...]:
    """The placed profiles that add up to a profile."""
    return profile.parts if isinstance(profile, Composite) else (Placed(profile),)


def total_tilt(profile: Profile) -> float:
    """The tilt of all parts together."""
    return sum(part.tilt for part in parts_of(profile))


def with_part(profile: Profile, old: Profile, new: Profile) -> Profile:
    """The profile with another wherever it is made of `old`."""
    parts = (p._replace(profile=new) if p.profile is old else p for p in parts_of(profile))
    return _made(tuple(parts), _reach(profile))


def _reach(profile: Profile) -> Pair:
    """The domain, to rounding."""
    return profile.reach if isinstance(profile, Composite) else profile.domain


def _made(parts: tuple[Placed, ...], reach: Pair) -> Profile:
    """The sum of parts; the profile itself where it is one that stands where it stood."""
    first = parts[0].profile
    return first if parts == (Placed(first),) else Composite(parts, reach)


def function_slope(breaks: Sequence[float], function: Vectorised) -> Slope:
    """The slope that is a function on its breaks."""
    none = np.zeros(len(breaks) - 1)
    return Slope(np.asarray(breaks, dtype=float), none, none[:, None], (FunctionTerm(function),))
