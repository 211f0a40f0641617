"""Profiles made of others: tilted, shifted, mirrored, raised and added ones.

The methods of `Profile` make them. Whatever is done in whatever order, the result is a sum of
profiles, each mirrored or not, then tilted, shifted and raised: h is

    Σ h_k(sign_k (x - shift_k)) + tilt_k (x - shift_k) + rise_k
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.arguments import with_middle_cut
from sie.inheritance import override

from .base import Profile, of_any_x
from .functions import PowerLaw
from .pieces import integral
from .slope import Slope

Array = NDArray[np.float64]
Pair = tuple[float, float]


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
        return joined(tuple((max(a, lo), min(b, hi)) for a, b in placed if a < hi and b > lo))

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


def joined(intervals: tuple[Pair, ...]) -> tuple[Pair, ...]:
    """The union of intervals, ascending."""
    found: list[Pair] = []
    for lo, hi in sorted(intervals):
        if found and lo <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], hi)
        else:
            found.append((lo, hi))
    return tuple(found)


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


def tilted(profile: Profile, slope: float) -> Profile:
    """h(x) + slope x."""
    first, *others = parts_of(profile)
    first = first._replace(tilt=first.tilt + slope, rise=first.rise + slope * first.shift)
    return _made((first, *others), _reach(profile))


def shifted(profile: Profile, dx: float) -> Profile:
    """h(x - dx). ValueError where doubles keep nothing of the domain."""
    lo, hi = _reach(profile)
    if not lo + dx < hi + dx:
        raise ValueError(
            f"shifted({dx:g}) leaves nothing of a profile on ({lo:g}, {hi:g}), "
            "doubles are farther apart there: shift it less"
        )
    parts = tuple(part._replace(shift=part.shift + dx) for part in parts_of(profile))
    return _made(parts, (lo + dx, hi + dx))


def mirrored(profile: Profile) -> Profile:
    """h(-x)."""
    lo, hi = _reach(profile)
    return _made(tuple(part.mirrored() for part in parts_of(profile)), (-hi, -lo))


def raised(profile: Profile, dz: float) -> Profile:
    """h(x) + dz."""
    first, *others = parts_of(profile)
    return _made((first._replace(rise=first.rise + dz), *others), _reach(profile))


def added(first: Profile, second: Profile) -> Profile:
    """The sum, on the intersection of both domains. ValueError where there is none."""
    one, other = _reach(first), _reach(second)
    lo, hi = max(one[0], other[0]), min(one[1], other[1])
    if not lo < hi:
        raise ValueError(
            f"profiles on {one} and {other} do not overlap: shift one of them before adding"
        )
    return Composite(parts_of(first) + parts_of(second), (lo, hi))


def _reach(profile: Profile) -> Pair:
    """The domain, to rounding."""
    return profile.reach if isinstance(profile, Composite) else profile.domain


def _made(parts: tuple[Placed, ...], reach: Pair) -> Profile:
    """The sum of parts; the profile itself where it is one that stands where it stood."""
    first = parts[0].profile
    return first if parts == (Placed(first),) else Composite(parts, reach)


def integrated(profile: Profile, x: Array) -> Array:
    """The height of a profile that has no formula, from x = 0 or the end nearest to it."""
    lo, hi = profile.domain
    return integral(profile.pieces, min(max(0.0, lo), hi), x)
