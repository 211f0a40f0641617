"""Profiles made of others: tilted, shifted, mirrored, raised and added ones.

The methods of `Profile` make them.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, fields, replace
from functools import cached_property, reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.arguments import with_middle_cut
from sie.inheritance import override

from .base import Parity, Profile, of_any_x
from .power_law import PowerLaw
from .profile_pieces import integral
from .slope import Slope

Array = NDArray[np.float64]


class Placed(NamedTuple):
    """h(sign (x - shift)) + tilt x + a constant, of a profile that is not made of others."""

    profile: Profile
    sign: float
    shift: float
    tilt: float


class Derived(Profile):
    """A profile made of others, to any depth.

    No method is recursive, so that Python's stack does not limit the depth. Each level takes
    `reach` and `axis` from the level below when it is built: O(n) for n levels.
    """

    def __post_init__(self) -> None:
        _ = self.reach, self.axis

    @property
    @abstractmethod
    def reach(self) -> tuple[float, float]:
        """The domain, to rounding. Raises ValueError where nothing is left of it."""

    @property
    @abstractmethod
    def operands(self) -> tuple[Profile, ...]:
        """The profiles that it is made of; for a sum its terms, none of which is a sum."""

    @property
    @abstractmethod
    def step(self) -> tuple[Any, ...]:
        """(kind, number of operands, further arguments): the way it is made of them."""

    @cached_property
    def steps(self) -> tuple[Any, ...]:
        """The profiles that it is made of and how, in postfix order.

        Equality, hash and pickle are those of this tuple.
        """
        steps: list[Any] = []
        todo: list[Profile] = [self]
        while todo:
            node = todo.pop()
            steps.append(node.step if isinstance(node, Derived) else node)
            todo += node.operands if isinstance(node, Derived) else ()
        return tuple(reversed(steps))

    def with_part(self, old: Profile, new: Profile) -> Profile:
        """The same profile with `new` wherever it is made of `old`, which is not made of others."""
        return _assembled(tuple(new if step is old else step for step in self.steps))

    def __eq__(self, other: object) -> bool:
        return self.steps == other.steps if isinstance(other, Derived) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.steps)

    def __reduce__(self) -> tuple[Any, ...]:
        return _assembled, (self.steps,)

    def __repr__(self) -> str:
        text: list[str] = []
        todo: list[Profile | str] = [self]
        while todo:  # from the end of the text to its beginning
            item = todo.pop()
            if isinstance(item, Sum):
                todo += [part for term in item.terms for part in (" + ", term)][1:]
            elif isinstance(item, Derived):
                (operand,), (kind, _, *arguments) = item.operands, item.step
                todo += ["(", operand, ")"] if isinstance(operand, Sum) else [operand]
                todo.append(f".{kind.__name__.lower()}({', '.join(map(repr, arguments))})")
            else:
                text.append(item if isinstance(item, str) else repr(item))
        return with_middle_cut("".join(reversed(text)))

    @cached_property
    def _parts(self) -> tuple[tuple[Placed, ...], float]:
        """The placed profiles that add up to this one, each with its own tilt; the tilt of sums."""
        parts, tilt = [], 0.0
        todo: list[Placed] = [Placed(self, 1.0, 0.0, 0.0)]
        while todo:
            part = todo.pop()
            node, sign, shift, own = part
            if isinstance(node, Tilted):
                todo.append(Placed(node.profile, sign, shift, own + sign * node.tilt))
            elif isinstance(node, Shifted):
                todo.append(Placed(node.profile, sign, shift + sign * node.dx, own))
            elif isinstance(node, Mirrored):
                todo.append(Placed(node.profile, -sign, shift, own))
            elif isinstance(node, Raised):
                todo.append(Placed(node.profile, sign, shift, own))
            elif isinstance(node, Sum):
                tilt += own
                todo += [Placed(term, sign, shift, 0.0) for term in reversed(node.terms)]
            else:
                parts.append(part)
        return tuple(parts), tilt

    @cached_property
    def pieces(self) -> Slope:
        """H on its declared breaks, the sum of the slopes of all parts."""
        parts, tilt = self._parts
        slopes = [
            (part.profile.pieces if part.sign > 0.0 else part.profile.pieces.mirrored())
            .tilted(part.tilt)
            .shifted(part.shift)
            for part in parts
        ]
        while len(slopes) > 1:  # in pairs, so that no break is merged more than log2 n times
            pairs = [one + other for one, other in zip(slopes[::2], slopes[1::2], strict=False)]
            slopes = pairs + slopes[2 * len(pairs) :]
        return slopes[0].tilted(tilt)

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        total = np.zeros(np.shape(x))
        todo: list[tuple[Profile, Array]] = [(self, x)]
        while todo:
            node, u = todo.pop()
            if isinstance(node, Raised):
                total = total + node.dz
            if isinstance(node, Tilted):
                total = total + node.tilt * u
            if isinstance(node, Shifted):
                u = u - node.dx
            elif isinstance(node, Mirrored):
                u = -u
            if isinstance(node, Derived):
                todo += [(operand, u) for operand in node.operands]
            else:
                total = total + node.height(u)
        return total

    @property
    def placed(self) -> tuple[Placed, ...]:
        """The profiles that add up to this one, placed, each with the tilt of all of them."""
        parts, tilt = self._parts
        return tuple(part._replace(tilt=part.tilt + tilt) for part in parts)

    @cached_property
    def power_law(self) -> PowerLaw | None:
        """The law of the part, placed; None for several parts or a tilted one."""
        part, *others = self.placed
        law = part.profile.power_law if part.tilt == 0.0 and not others else None
        return law and replace(law, axis=part.sign * law.axis + part.shift)

    @cached_property
    def convex(self) -> bool:
        """Whether all parts are known to be convex; then h is."""
        return all(part.profile.convex for part in self._parts[0])

    @cached_property
    def walls(self) -> tuple[tuple[float, float], ...]:
        """Those of the profiles that add up to this one."""
        lo, hi = self.domain
        placed = [
            sorted((part.sign * one + part.shift, part.sign * other + part.shift))
            for part in self._parts[0]
            for one, other in part.profile.walls
        ]
        return joined(tuple((max(a, lo), min(b, hi)) for a, b in placed if a < hi and b > lo))

    @cached_property
    def ends_are_corners(self) -> tuple[bool, bool]:
        """Whether each end is a corner of the profile whose domain ends there."""
        corners = [True, True]
        for profile, sign, shift, _ in self._parts[0]:
            ends = zip(profile.domain, profile.ends_are_corners, strict=True)
            for end, is_corner in ends:
                here = sign * end + shift
                for k in (0, 1):
                    corners[k] &= is_corner or here != self.domain[k]
        return corners[0], corners[1]


def joined(intervals: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    """The union of intervals, ascending."""
    found: list[tuple[float, float]] = []
    for lo, hi in sorted(intervals):
        if found and lo <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], hi)
        else:
            found.append((lo, hi))
    return tuple(found)


def _reach(profile: Profile) -> tuple[float, float]:
    return profile.reach if isinstance(profile, Derived) else profile.domain


def _assembled(steps: tuple[Any, ...]) -> Profile:
    """The profile that `Derived.steps` lists."""
    made: list[Profile] = []
    for step in steps:
        if isinstance(step, Profile):
            made.append(step)
            continue
        kind, count, *arguments = step
        operands = made[-count:]
        made[-count:] = [reduce(Sum, operands) if kind is Sum else kind(*operands, *arguments)]
    return made.pop()


@dataclass(frozen=True, repr=False, eq=False)
class _OfOne(Derived):
    profile: Profile

    @cached_property
    def reach(self) -> tuple[float, float]:
        return _reach(self.profile)

    @cached_property
    def axis(self) -> float | None:
        return self.profile.axis

    @property
    def operands(self) -> tuple[Profile, ...]:
        return (self.profile,)

    @property
    def step(self) -> tuple[Any, ...]:
        return type(self), 1, *(getattr(self, f.name) for f in fields(self)[1:])


@dataclass(frozen=True, repr=False, eq=False)
class Tilted(_OfOne):
    """h(x) + tilt x."""

    tilt: float

    @cached_property
    def axis(self) -> float | None:
        """None: a tilted profile is not known to be symmetric."""
        return None

    @override
    def tilted(self, slope: float) -> Profile:
        return self.profile.tilted(self.tilt + arguments.measure("tilted", slope))


@dataclass(frozen=True, repr=False, eq=False)
class Shifted(_OfOne):
    """h(x - dx)."""

    dx: float

    @cached_property
    def reach(self) -> tuple[float, float]:
        """The domain, to rounding. ValueError where doubles keep nothing of it."""
        lo, hi = _reach(self.profile)
        if not lo + self.dx < hi + self.dx:
            raise ValueError(
                f"shifted({self.dx:g}) leaves nothing of a profile on ({lo:g}, {hi:g}), "
                "doubles are farther apart there: shift it less"
            )
        return lo + self.dx, hi + self.dx

    @cached_property
    def axis(self) -> float | None:
        """The axis of the given profile, moved by dx."""
        return None if self.profile.axis is None else self.profile.axis + self.dx

    @override
    def shifted(self, dx: float) -> Profile:
        return self.profile.shifted(self.dx + arguments.measure("shifted", dx))


@dataclass(frozen=True, repr=False, eq=False)
class Mirrored(_OfOne):
    """h(-x)."""

    @cached_property
    def reach(self) -> tuple[float, float]:
        """The domain, to rounding."""
        lo, hi = _reach(self.profile)
        return -hi, -lo

    @cached_property
    def axis(self) -> float | None:
        """The axis of the given profile, mirrored at x = 0."""
        return None if self.profile.axis is None else -self.profile.axis

    @override
    def mirrored(self) -> Profile:
        return self.profile


@dataclass(frozen=True, repr=False, eq=False)
class Raised(_OfOne):
    """h(x) + dz."""

    dz: float

    @property
    @override
    def parity(self) -> Parity:
        return self.profile.parity

    @override
    def raised(self, dz: float) -> Profile:
        return self.profile.raised(self.dz + arguments.measure("raised", dz))


@dataclass(frozen=True, repr=False, eq=False)
class Sum(Derived):
    """The sum of two profiles, on the intersection of their domains; sums of sums are flattened."""

    first: Profile
    second: Profile

    @cached_property
    def reach(self) -> tuple[float, float]:
        """The intersection of both domains. ValueError where there is none."""
        one, other = _reach(self.first), _reach(self.second)
        lo, hi = max(one[0], other[0]), min(one[1], other[1])
        if not lo < hi:
            raise ValueError(
                f"profiles on {one} and {other} do not overlap: shift one of them before adding"
            )
        return lo, hi

    @cached_property
    def axis(self) -> float | None:
        """The axis that both profiles have, None if they have none in common."""
        return self.first.axis if self.first.axis == self.second.axis else None

    @cached_property
    def terms(self) -> tuple[Profile, ...]:
        """The profiles that are added, none of which is a sum."""
        terms: list[Profile] = []
        todo: list[Profile] = [self]
        while todo:
            node = todo.pop()
            if isinstance(node, Sum):
                todo += (node.second, node.first)
            else:
                terms.append(node)
        return tuple(terms)

    @property
    @override
    def operands(self) -> tuple[Profile, ...]:
        return self.terms

    @property
    @override
    def step(self) -> tuple[Any, ...]:
        return Sum, len(self.terms)


def integrated(profile: Profile, x: Array) -> Array:
    """The height of a profile that has no formula, from x = 0 or the end nearest to it."""
    lo, hi = profile.domain
    return integral(profile.pieces, min(max(0.0, lo), hi), x)
