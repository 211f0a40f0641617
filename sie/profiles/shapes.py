"""The kinds of indenter.

Parabola  h = x²/(2R)          RoundedFlat  h = max(|x| - a, 0)²/(2R)      Flat  h = 0 for |x| <= a, nothing beyond
Wedge     h = slope |x|        Power        h = coefficient |x|^exponent   Polynomial  h = Σ c_k x^k
Piecewise, FromFunction: by their slope      Sampled (`sampled`): by a trace
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments

from .base import Parity, Profile, of_any_x
from .expression import Expression
from .power_law import PowerLaw, PowerSlope
from .resolution import integral
from .sampled import Sampled
from .slope import JUMP, FunctionTerm, Slope, Vectorised, polynomial_slope

Array = NDArray[np.float64]
INF = float("inf")
# Of polynomials: beyond it their powers overflow beside the contact; pieces are moved in rational arithmetic, in the square of the degree.
HIGHEST_DEGREE, HIGHEST_OF_PIECE = 1000, 200
NO_DIGITS = 1e3 * float(np.finfo(float).tiny)  # doubles below tiny have fewer digits than others


class _Convex(Profile):
    """Symmetric about x = 0 and convex."""

    @property
    def axis(self) -> float | None:
        return 0.0

    @property
    def convex(self) -> bool:
        return True


@dataclass(frozen=True)
class Parabola(_Convex):
    """h = x²/(2 radius): a cylinder.

    >>> Parabola(radius=2.0).height([0.0, 1.0])
    array([0.  , 0.25])
    """

    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", arguments.positive("radius", self.radius))

    @cached_property
    def pieces(self) -> Slope:
        return polynomial_slope((-INF, INF), (0.0,), ((0.0, 1.0 / self.radius),))

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        return 0.5 * x * (x / self.radius)


@dataclass(frozen=True)
class RoundedFlat(_Convex):
    """A flat base |x| <= half_flat whose edges are rounded by arcs of the given radius (as parabolas)."""

    half_flat: float
    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "half_flat", arguments.positive("half_flat", self.half_flat))
        object.__setattr__(self, "radius", arguments.positive("radius", self.radius))

    @cached_property
    def pieces(self) -> Slope:
        a, curvature = self.half_flat, 1.0 / self.radius
        return polynomial_slope(
            (-INF, -a, a, INF), (-a, 0.0, a), ((0.0, curvature), (0.0,), (0.0, curvature))
        )

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        rim = np.maximum(np.abs(arguments.reals("x", x)) - self.half_flat, 0.0)
        return 0.5 * rim * (rim / self.radius)


@dataclass(frozen=True)
class Flat(_Convex):
    """A flat punch with sharp corners at |x| = half_width: the pressure is square-root singular there."""

    half_width: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "half_width", arguments.positive("half_width", self.half_width))

    @cached_property
    def pieces(self) -> Slope:
        return polynomial_slope((-self.half_width, self.half_width), (0.0,), ((0.0,),))

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        return np.where(np.abs(x) <= self.half_width, 0.0, np.where(np.isnan(x), x, INF))


@dataclass(frozen=True, init=False, repr=False)
class Wedge(_Convex):
    """h = slope |x|: a blunt wedge; the pressure is logarithmically infinite under its tip."""

    rise: float

    def __init__(self, slope: float) -> None:
        object.__setattr__(self, "rise", arguments.positive("slope", slope))

    def __repr__(self) -> str:
        return f"Wedge(slope={self.rise!r})"

    @cached_property
    def pieces(self) -> Slope:
        return polynomial_slope((-INF, 0.0, INF), (0.0, 0.0), ((-self.rise,), (self.rise,)))

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        return self.rise * np.abs(arguments.reals("x", x))


@dataclass(frozen=True)
class Power(_Convex):
    """h = coefficient |x|^exponent, exponent >= 1 (1 is a wedge, 2 a parabola, large ones approach a flat punch)."""

    exponent: float
    coefficient: float

    def __post_init__(self) -> None:
        m = arguments.finite("exponent", self.exponent)
        if m < 1.0:
            raise ValueError(
                f"exponent = {m:g} is below 1: the profile would not be convex; give exponent >= 1"
            )
        object.__setattr__(self, "exponent", m)
        object.__setattr__(
            self,
            "coefficient",
            arguments.positive("coefficient", self.coefficient, arguments.LARGEST_COEFFICIENT),
        )

    @cached_property
    def pieces(self) -> Slope:
        m, A = self.exponent, self.coefficient
        if m.is_integer() and m <= 32:
            row = [0.0] * int(m - 1) + [m * A]
            if m % 2 == 0:
                return polynomial_slope((-INF, INF), (0.0,), (row,))
            return polynomial_slope((-INF, 0.0, INF), (0.0, 0.0), ([-c for c in row], row))
        smooth = polynomial_slope((-INF, 0.0, INF), (0.0, 0.0), ((0.0,), (0.0,)))
        return replace(smooth, functions=(FunctionTerm(PowerSlope(m, A)),))

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        return self.coefficient * np.abs(arguments.reals("x", x)) ** self.exponent

    @property
    def power_law(self) -> PowerLaw:
        return PowerLaw(self.exponent, self.coefficient)


def _coefficients(name: str, row: Any) -> tuple[float, ...]:
    given = arguments.listed(name, row, "the coefficients of h' there, low order first")
    largest = arguments.LARGEST_COEFFICIENT
    return tuple(arguments.measure(f"{name}[{j}]", c, largest) for j, c in enumerate(given))


def _refuse_high_degree(name: str, coefficients: Sequence[float], highest: int) -> None:
    if len(coefficients) > highest + 1:
        raise ValueError(
            f"the degree of {name} is {len(coefficients) - 1}, more than {highest}: give the slope as a function"
        )


def _with_digits(coefficient: float) -> float:
    """The coefficient, or 0 where it is so small that its products have no digits."""
    return coefficient if abs(coefficient) >= NO_DIGITS else 0.0


@dataclass(frozen=True)
class Polynomial(Profile):
    """h = Σ coefficients[k] x^k, low order first."""

    coefficients: tuple[float, ...]

    def __post_init__(self) -> None:
        given = arguments.listed(
            "coefficients", self.coefficients, "the coefficients of 1, x, x², ..."
        )
        largest = arguments.LARGEST_COEFFICIENT
        c = tuple(arguments.measure(f"coefficients[{k}]", v, largest) for k, v in enumerate(given))
        _refuse_high_degree("coefficients", c, HIGHEST_DEGREE)
        if not any(map(_with_digits, c[2:])):
            raise ValueError(
                f"coefficients = {c} describe a straight line: contact needs a curved profile, give a term of order 2 or more"
            )
        object.__setattr__(self, "coefficients", c)

    @cached_property
    def pieces(self) -> Slope:
        return polynomial_slope(
            (-INF, INF),
            (0.0,),
            ([k * _with_digits(c) for k, c in enumerate(self.coefficients)][1:],),
        )

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        return np.asarray(
            np.polynomial.polynomial.polyval(arguments.reals("x", x), self.coefficients),
            dtype=float,
        )

    @property
    def axis(self) -> float | None:
        return None if any(self.coefficients[1::2]) else 0.0

    @property
    def convex(self) -> bool:
        return not any(self.coefficients[3::2]) and min(self.coefficients[2::2], default=0.0) >= 0.0


@dataclass(frozen=True, init=False, repr=False)
class Piecewise(Profile):
    """h' on each piece as polynomial coefficients in x, low order first; h = 0 at x = 0 (or at the end nearest to it).

    `breaks` are the ends of the pieces, one more than there are pieces (the outer two may be infinite); or only the inner ones, one less
    than there are pieces, and the indenter has no end.
    """

    ends: tuple[float, ...]
    coefficients: tuple[tuple[float, ...], ...]

    def __init__(self, breaks: Sequence[float], pieces: Sequence[Sequence[float]]) -> None:
        given = arguments.listed("pieces", pieces, "the coefficients of h' on each piece")
        rows = tuple(_coefficients(f"pieces[{k}]", row) for k, row in enumerate(given))
        breaks = arguments.listed("breaks", breaks, "the ends of the pieces")
        ends = tuple(arguments.real(f"breaks[{k}]", b) for k, b in enumerate(breaks))
        if len(ends) == len(rows) - 1:
            ends = (-INF, *ends, INF)
        if not rows or len(ends) != len(rows) + 1:
            raise ValueError(
                f"{len(breaks)} breaks do not bound {len(rows)} pieces: give one break more than pieces, or one less (the inner ones)"
            )
        for k, end in enumerate(ends):
            if math.isfinite(end):
                arguments.measure(f"breaks[{k}]", end)
        for left, right in pairwise(ends):
            if not left < right:
                raise ValueError(
                    f"breaks {left:g}, {right:g} do not ascend: sort them and drop duplicates"
                )
        if any(np.isinf(b) for b in ends[1:-1]):
            raise ValueError("an inner break is infinite: only the first and the last may be")
        for k, row in enumerate(rows):
            _refuse_high_degree(f"pieces[{k}]", row, HIGHEST_OF_PIECE)
            if not row:
                raise ValueError(
                    f"pieces[{k}] is empty: give its one coefficient 0 for a flat piece"
                )
        object.__setattr__(self, "ends", ends)
        object.__setattr__(self, "coefficients", rows)

    def __repr__(self) -> str:
        return f"Piecewise(breaks={self.ends!r}, pieces={self.coefficients!r})"

    @cached_property
    def pieces(self) -> Slope:
        given = [tuple(map(_with_digits, row)) for row in self.coefficients]
        rows = [
            _well_placed(row, lo, hi)
            for row, lo, hi in zip(given, self.ends[:-1], self.ends[1:], strict=True)
        ]
        return polynomial_slope(self.ends, [o for o, _ in rows], [c for _, c in rows])

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        zero = min(max(0.0, self.ends[0]), self.ends[-1])
        lo, hi = np.minimum(x, zero), np.maximum(x, zero)
        h = np.zeros(x.shape)
        for row, left, right in zip(self.coefficients, self.ends[:-1], self.ends[1:], strict=True):
            integral = np.polynomial.polynomial.polyint(row)
            a, b = np.clip(lo, left, right), np.clip(hi, left, right)
            h += np.polynomial.polynomial.polyval(b, integral) - np.polynomial.polynomial.polyval(
                a, integral
            )
        h = np.where(x < zero, -h, h)
        return np.where((x < self.ends[0]) | (x > self.ends[-1]), INF, h)

    @cached_property
    def axis(self) -> float | None:
        mirrored = self.pieces.mirrored()
        same = np.array_equal(mirrored.breaks, self.pieces.breaks) and all(
            row == tuple(-c * (-1.0) ** j for j, c in enumerate(other))
            for row, other in zip(self.coefficients, self.coefficients[::-1], strict=True)
        )
        return 0.0 if same else None

    @cached_property
    def convex(self) -> bool:
        """Known only for slopes that are linear on each piece; others are checked by their answer."""
        s = self.pieces
        if s.coefficients.shape[1] > 2:
            return False
        rising = s.coefficients[:, 1:].min(initial=0.0) >= 0.0
        left, right = s.at_breaks
        rounding = JUMP * max(map(abs, left + right), default=0.0)
        return bool(rising) and all(b >= a - rounding for a, b in zip(left, right, strict=True))


def _well_placed(row: tuple[float, ...], lo: float, hi: float) -> tuple[float, tuple[float, ...]]:
    """(origin, coefficients) about the point where the slope is smallest: an end of the piece, x = 0 or the zero of a straight line.

    In exact arithmetic: what is left of the slope there is what the given coefficients mean, not rounding.
    """
    candidates = [0.0, *(end for end in (lo, hi) if math.isfinite(end))]
    if len(row) == 2 and row[1] != 0.0:
        candidates.append(min(max(-row[0] / row[1], lo), hi))
    moved = [
        (origin, _moved(row, origin))
        for origin in dict.fromkeys(candidates)
        if math.isfinite(origin)
    ]
    return min(moved, key=lambda pair: abs(pair[1][0]))


def _moved(row: tuple[float, ...], origin: float) -> tuple[float, ...]:
    """Coefficients about the origin, by synthetic division in rational arithmetic."""
    c = [Fraction(v) for v in row]
    for i in range(len(c) - 1):
        for j in range(len(c) - 2, i - 1, -1):
            c[j] += Fraction(origin) * c[j + 1]
    return tuple(float(v) for v in c)


@dataclass(frozen=True, init=False, repr=False)
class FromFunction(Profile):
    """An indenter given by its slope h'(x): any vectorised Python function, or an expression in x as text, like "sinh(x)".

    breaks   where h' or a derivative of it jumps or is not smooth; found by bisection where not declared, which takes longer
    domain   (lo, hi), the ends of the indenter, infinite by default; contact that reaches an end is sharp there
    parity   "even" if h(-x) = h(x): half the work

    h = 0 at x = 0, or at the end of the domain nearest to it. Raises ValueError if the function does not return finite real numbers of
    its argument's shape.

    A function is known by its values at some points. What resolves it is compared with it at 2584
    points of the contact that no function can know beforehand, and a jump, a kink, a cusp or a
    narrow feature that was not declared is found and resolved like one that was. Sampling cannot
    find what happens (a bump, a dent, two jumps, nan) on less than 5e-4 of the contact, but for
    one kink or jump beside an edge, down to 1e-12 of the contact from it; nor what is below 32 ulp
    of the largest slope or 8 times the roughness of the function's own rounding. The
    place of a jump is known to one ulp of x. Declare breaks around such places.
    """

    function: Vectorised
    declared: tuple[float, ...]
    ends: tuple[float, float]
    symmetric: bool

    def __init__(
        self,
        slope: Vectorised | str,
        breaks: Sequence[float] = (),
        domain: tuple[float, float] = (-INF, INF),
        parity: Parity = "none",
    ) -> None:
        function = Expression(slope) if isinstance(slope, str) else slope
        if not callable(function):
            raise ValueError(
                f"slope = {slope!r} is not a function: give a function of an array, or an expression in x as text"
            )
        pair = arguments.listed("domain", domain, "(lo, hi)")
        if len(pair) != 2:
            raise ValueError(f"domain = {domain!r} is not a pair: give (lo, hi)")
        lo, hi = (arguments.real("domain", end) for end in pair)
        if not lo < hi:
            raise ValueError(f"domain = ({lo:g}, {hi:g}) is empty: give lo < hi")
        for end in (lo, hi):
            if math.isfinite(end):
                arguments.measure("domain", end)
        if math.isfinite(hi - lo):
            arguments.positive("the length of the domain", hi - lo)
        given = arguments.listed("breaks", breaks, "the places where h' is not smooth")
        inner = tuple(sorted({arguments.measure("breaks", b) for b in given}))
        for b in inner:
            if not lo <= b <= hi:
                raise ValueError(
                    f"break {b:g} is outside the domain ({lo:g}, {hi:g}): leave it out or widen the domain"
                )
        if not arguments.among(parity, ("even", "none")):
            raise ValueError(f"parity = {parity!r} is neither 'even' nor 'none'")
        object.__setattr__(self, "function", function)
        object.__setattr__(self, "declared", tuple(b for b in inner if lo < b < hi))
        object.__setattr__(self, "ends", (lo, hi))
        object.__setattr__(self, "symmetric", parity == "even")
        self._try_out()

    def _try_out(self) -> None:
        """A call at a few points: shape, finiteness, and the parity if it was declared."""
        lo, hi = self.ends
        if not np.isfinite(lo + hi):
            lo, hi = (
                (lo, lo + 1.0)
                if np.isfinite(lo)
                else (hi - 1.0, hi)
                if np.isfinite(hi)
                else (-1.0, 1.0)
            )
        x = lo + (hi - lo) * np.array([0.13, 0.29, 0.5, 0.61, 0.83])
        with np.errstate(all="ignore"):
            values = arguments.real_values("slope", self.function, x)
            arguments.real_values("slope", self.function, x[:, None])
        if not np.isfinite(values).all():
            bad = int(np.argmin(np.isfinite(values)))
            raise ValueError(
                f"slope is {values[bad]} at x = {x[bad]:.6g}: it must be finite, narrow the domain"
            )
        if self.symmetric:
            if self.ends[0] != -self.ends[1] or set(self.declared) != {-b for b in self.declared}:
                raise ValueError(
                    f"parity 'even' with domain {self.ends} and breaks {self.declared}: make them symmetric about 0 or drop the parity"
                )
            if not np.allclose(
                np.asarray(self.function(-x)),
                -values,
                rtol=1e-12,
                atol=1e-12 * float(np.abs(values).max()),
            ):
                raise ValueError("parity 'even' but slope(-x) is not -slope(x): drop the parity")

    def __repr__(self) -> str:
        f = self.function
        name = repr(f.text) if isinstance(f, Expression) else getattr(f, "__qualname__", repr(f))
        parity = ", parity='even'" if self.symmetric else ""
        return f"FromFunction(slope={name}, breaks={self.declared!r}, domain={self.ends!r}{parity})"

    @cached_property
    def pieces(self) -> Slope:
        breaks = (self.ends[0], *self.declared, self.ends[1])
        flat = polynomial_slope(breaks, [0.0] * (len(breaks) - 1), [(0.0,)] * (len(breaks) - 1))
        return Slope(
            flat.breaks,
            flat.origins,
            flat.coefficients,
            flat.degrees,
            (FunctionTerm(self.function),),
        )

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        zero = min(max(0.0, self.ends[0]), self.ends[1])
        return integral(self.pieces, zero, arguments.reals("x", x))

    @property
    def axis(self) -> float | None:
        return 0.0 if self.symmetric else None


def profile_kinds() -> dict[str, Any]:
    """The kinds that a scene file can name."""
    return {
        "parabola": Parabola,
        "rounded-flat": RoundedFlat,
        "flat": Flat,
        "wedge": Wedge,
        "power": Power,
        "polynomial": Polynomial,
        "piecewise": Piecewise,
        "function": FromFunction,
        "sampled": Sampled,
    }
