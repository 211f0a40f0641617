"""Profiles as values: equal, hashable, picklable, printed as the code that rebuilds them.

A profile is the gap h(x) between the undeformed indenter and the flat surface; it grows away from
the contact. A profile states its height, and its slope H = h' piece by piece (`slope.Slope`), which
is all that the solver uses. The kinds of profile are listed in `kinds`.

This module holds what all profiles can do, and the profiles that are tilted, shifted, mirrored or
added. Both are here because they refer to each other: `Profile.tilted` makes a `Tilted`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property, reduce, wraps
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.inheritance import override

from .power_law import PowerLaw
from .slope import Slope

Array = NDArray[np.float64]
Parity = Literal["even", "none"]


def of_any_x(height: Callable[[Any, Array], Array]) -> Callable[[Any, ArrayLike], Array]:
    """Extend a height from finite x to all x.

    The result is nan at nan, inf where it overflows, and infinite at infinite x, with the sign that
    the slope has there.
    """

    @wraps(height)
    def everywhere(profile: Profile, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        with np.errstate(over="ignore", invalid="ignore"):
            if _all_finite(x) and _all_finite(h := height(profile, x[()])):
                return h
            finite = np.isfinite(x)
            h = height(profile, np.where(finite, x, 0.0)[()])
            h = np.where(np.isnan(h), np.inf, h)  # the difference of two heights beyond all doubles
            if not finite.all():
                falls = profile.slope(x) * np.sign(x) < 0.0
                h = np.where(finite, h, np.where(np.isnan(x), x, np.where(falls, -np.inf, np.inf)))
        return h[()]

    return everywhere


def _all_finite(a: Array) -> bool:
    """Whether the sum of squares is a double, in one call: then every number is."""
    return math.isfinite(np.vdot(a, a))


class Profile(ABC):
    """The undeformed indenter: its gap h(x) to the flat surface.

    A new kind of profile derives from this class and defines `pieces` and `height`; CONTRIBUTING.md
    says how. Lengths have any unit. Slopes are pure numbers, small against 1.

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

    def _require_positive(self, *names: str, largest: float = arguments.LARGEST) -> None:
        """Replace fields of a profile that is being built by floats. ValueError unless > 0."""
        for name in names:
            value = arguments.positive(name, getattr(self, name), largest)
            object.__setattr__(self, name, value)

    @property
    @abstractmethod
    def pieces(self) -> Slope:
        """H on its declared breaks; functions are resolved when a contact is known."""

    @abstractmethod
    def height(self, x: ArrayLike) -> Array:
        """The gap h(x) before loading.

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
        return self if slope == 0.0 else Tilted(self, slope)

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
        return self if abs(dx) * arguments.LARGEST_COEFFICIENT < 1.0 else Shifted(self, dx)

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
        return self if self.parity == "even" else Mirrored(self)

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
        """The profile h(x) + other.h(x), on the intersection of both domains."""
        if not isinstance(other, Profile):
            return NotImplemented
        for profile in (self, other):
            if profile.period < float("inf"):
                raise ValueError(
                    f"{profile!r} is repeated: add profiles first, then repeat the sum"
                )
        return Sum(self, other)


# -- profiles made of others ---------------------------------------------------------------------


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
        return "".join(reversed(text))

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
