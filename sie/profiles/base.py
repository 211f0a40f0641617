"""Profiles as values: equal, hashable, picklable, printed as the code that rebuilds them.

A profile is the gap h(x) between the undeformed indenter and the flat surface, growing away from the contact. Each states its height and
its slope H = h' piece by piece (`slope.Slope`); the numerics see only the latter. Here: what all profiles can do, and what is made of other
profiles by tilting, shifting, mirroring and adding. The kinds themselves are in `indenters`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property, reduce, wraps
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments

from .power_law import PowerLaw
from .slope import Slope

Array = NDArray[np.float64]
Parity = Literal["even", "none"]


def of_any_x(height: Callable[[Any, Array], Array]) -> Callable[[Any, ArrayLike], Array]:
    """A height that is defined at finite x, everywhere: nan at nan, infinite far away as its slope says, inf where it overflows."""

    @wraps(height)
    def everywhere(profile: Profile, x: ArrayLike) -> Array:
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

    @property
    def power_law(self) -> PowerLaw | None:
        """h = A |x - c|^m where the profile is known to be nothing else."""
        return None

    def slope(self, x: ArrayLike) -> Array:
        """h'(x), same shape as x: the mean of both sides at a corner, -inf and inf beyond the ends of the indenter."""
        x = arguments.reals("x", x)
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
        slope = arguments.measure("tilted", slope)
        return self if slope == 0.0 else Tilted(self, slope)

    def shifted(self, dx: float) -> Profile:
        """h(x - dx)."""
        dx = arguments.measure("shifted", dx)
        return self if abs(dx) * arguments.LARGEST_COEFFICIENT < 1.0 else Shifted(self, dx)

    def mirrored(self) -> Profile:
        """h(-x)."""
        return self if self.parity == "even" else Mirrored(self)

    def raised(self, dz: float) -> Profile:
        """h(x) + dz: the height counts only among the indenters of a row."""
        dz = arguments.measure("raised", dz)
        return self if dz == 0.0 else Raised(self, dz)

    @property
    def period(self) -> float:
        """The distance after which the profile repeats itself, inf if it does not."""
        return float("inf")

    @property
    def walls(self) -> tuple[tuple[float, float], ...]:
        """Intervals (lo, hi) inside the domain without indenter; lo = hi where h jumps."""
        return ()

    def __add__(self, other: Profile) -> Profile:
        if not isinstance(other, Profile):
            return NotImplemented
        for profile in (self, other):
            if profile.period < float("inf"):
                raise ValueError(
                    f"{profile!r} is repeated: add profiles first, then repeat the sum"
                )
        return Sum(self, other)


# -- what is made of other profiles ------------------------------------------------------------------------------------


class Placed(NamedTuple):
    """h(sign (x - shift)) + tilt x + a constant, of a profile that is not made of others."""

    profile: Profile
    sign: float
    shift: float
    tilt: float


class Derived(Profile):
    """A profile made of others, to any depth: what is asked of it is found without recursion.

    Reach and axis are passed on from level to level when each is built: n levels are built in O(n).
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
        """What it is made of; of a sum its terms, none of which is a sum."""

    @property
    @abstractmethod
    def step(self) -> tuple[Any, ...]:
        """(kind, how many operands, further arguments): how it is made of them."""

    @cached_property
    def steps(self) -> tuple[Any, ...]:
        """The profiles that it is made of and how, in postfix order: equality, hash and pickle are those of this list."""
        found: list[Any] = []
        todo: list[Profile] = [self]
        while todo:
            node = todo.pop()
            found.append(node.step if isinstance(node, Derived) else node)
            todo += node.operands if isinstance(node, Derived) else ()
        return tuple(reversed(found))

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
        return "".join(reversed(text))

    @cached_property
    def _parts(self) -> tuple[tuple[Placed, ...], float]:
        """The profiles that add up to this one, each in its place and with its own tilt; and the tilt of sums of them."""
        found, tilt = [], 0.0
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
                found.append(part)
        return tuple(found), tilt

    @cached_property
    def pieces(self) -> Slope:
        parts, tilt = self._parts
        slopes = [
            (part.profile.pieces if part.sign > 0.0 else part.profile.pieces.mirrored())
            .tilted(part.tilt)
            .shifted(part.shift)
            for part in parts
        ]
        while (
            len(slopes) > 1
        ):  # in pairs: no break is merged more often than slopes can be halved in number
            pairs = [one + other for one, other in zip(slopes[::2], slopes[1::2], strict=False)]
            slopes = pairs + slopes[2 * len(pairs) :]
        return slopes[0].tilted(tilt)

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        total = np.zeros(np.shape(x))
        todo: list[tuple[Profile, Array]] = [(self, arguments.reals("x", x))]
        while todo:
            node, at = todo.pop()
            if isinstance(node, Raised):
                total = total + node.dz
            if isinstance(node, Tilted):
                total = total + node.tilt * at
            if isinstance(node, Derived):
                at = (
                    at - node.dx
                    if isinstance(node, Shifted)
                    else -at
                    if isinstance(node, Mirrored)
                    else at
                )
                todo += [(operand, at) for operand in node.operands]
            else:
                total = total + node.height(at)
        return total

    @property
    def placed(self) -> tuple[Placed, ...]:
        """The profiles that add up to this one, each in its place and with the tilt of all of them."""
        parts, tilt = self._parts
        return tuple(part._replace(tilt=part.tilt + tilt) for part in parts)

    @cached_property
    def power_law(self) -> PowerLaw | None:
        part, *others = self.placed
        law = part.profile.power_law if part.tilt == 0.0 and not others else None
        return law and replace(law, axis=part.sign * law.axis + part.shift)

    @cached_property
    def convex(self) -> bool:
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
        """Those of the profile that ends first."""
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
        return None

    def tilted(self, slope: float) -> Profile:
        return self.profile.tilted(self.tilt + arguments.measure("tilted", slope))


@dataclass(frozen=True, repr=False, eq=False)
class Shifted(_OfOne):
    """h(x - dx)."""

    dx: float

    @cached_property
    def reach(self) -> tuple[float, float]:
        lo, hi = _reach(self.profile)
        if not lo + self.dx < hi + self.dx:
            raise ValueError(
                f"shifted({self.dx:g}) leaves nothing of a profile on ({lo:g}, {hi:g}), doubles are farther apart there: shift it less"
            )
        return lo + self.dx, hi + self.dx

    @cached_property
    def axis(self) -> float | None:
        return None if self.profile.axis is None else self.profile.axis + self.dx

    def shifted(self, dx: float) -> Profile:
        return self.profile.shifted(self.dx + arguments.measure("shifted", dx))


@dataclass(frozen=True, repr=False, eq=False)
class Mirrored(_OfOne):
    """h(-x)."""

    @cached_property
    def reach(self) -> tuple[float, float]:
        lo, hi = _reach(self.profile)
        return -hi, -lo

    @cached_property
    def axis(self) -> float | None:
        return None if self.profile.axis is None else -self.profile.axis

    def mirrored(self) -> Profile:
        return self.profile


@dataclass(frozen=True, repr=False, eq=False)
class Raised(_OfOne):
    """h(x) + dz."""

    dz: float

    @property
    def parity(self) -> Parity:
        return self.profile.parity

    def raised(self, dz: float) -> Profile:
        return self.profile.raised(self.dz + arguments.measure("raised", dz))


@dataclass(frozen=True, repr=False, eq=False)
class Sum(Derived):
    """The sum of two profiles, on the intersection of their domains. A sum of sums is the sum of all their terms."""

    first: Profile
    second: Profile

    @cached_property
    def reach(self) -> tuple[float, float]:
        one, other = _reach(self.first), _reach(self.second)
        lo, hi = max(one[0], other[0]), min(one[1], other[1])
        if not lo < hi:
            raise ValueError(
                f"profiles on {one} and {other} do not overlap: shift one of them before adding"
            )
        return lo, hi

    @cached_property
    def axis(self) -> float | None:
        return self.first.axis if self.first.axis == self.second.axis else None

    @cached_property
    def terms(self) -> tuple[Profile, ...]:
        found: list[Profile] = []
        todo: list[Profile] = [self]
        while todo:
            node = todo.pop()
            if isinstance(node, Sum):
                todo += (node.second, node.first)
            else:
                found.append(node)
        return tuple(found)

    @property
    def operands(self) -> tuple[Profile, ...]:
        return self.terms

    @property
    def step(self) -> tuple[Any, ...]:
        return Sum, len(self.terms)
