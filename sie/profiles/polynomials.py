"""Indenters given by polynomial coefficients, of the height or of the slope on each piece."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from sie import arguments
from sie.arguments import abridged
from sie.inheritance import override

from .base import Profile
from .indenter import of_any_x
from .slope import Slope, polynomial_slope

Array = NDArray[np.float64]
INF = float("inf")
# Above the first degree, powers overflow beside the contact. Pieces are moved in rational
# arithmetic, whose time grows with the square of the degree.
HIGHEST_DEGREE, HIGHEST_OF_PIECE = 1000, 200
NO_DIGITS = 1e3 * float(np.finfo(float).tiny)  # doubles below tiny have fewer digits than others


@dataclass(frozen=True, repr=False)
class Polynomial(Profile):
    """A polynomial: h = Σ coefficients[k] x^k.

    Parameters
    ----------
    coefficients : sequence of float
        Low order first, coefficients[k] as a length to the power 1 - k; at most 1001 of them, and
        one that is not zero among those of order 2 and higher.

    Raises
    ------
    ValueError
        If the polynomial is a straight line, its degree is above 1000 or a coefficient is no
        finite number.

    Notes
    -----
    The profile may be lopsided or not convex. That the contact is one patch, with p >= 0 in it
    and a gap >= 0 beside it, is verified when it is solved.

    Examples
    --------
    >>> Polynomial((0.0, 0.0, 0.5, 0.25)).slope([1.0, 2.0])
    array([1.75, 5.  ])
    """

    coefficients: tuple[float, ...]

    def __repr__(self) -> str:
        return f"Polynomial(coefficients=({abridged(self.coefficients)}))"

    def __post_init__(self) -> None:
        c = _coefficients(
            "coefficients", self.coefficients, HIGHEST_DEGREE, "the coefficients of 1, x, x², ..."
        )
        if not any(map(_with_digits, c[2:])):
            raise ValueError(
                f"coefficients = {c} describe a straight line: contact needs a curved profile, "
                "give a term of order 2 or more"
            )
        object.__setattr__(self, "coefficients", c)

    @cached_property
    def pieces(self) -> Slope:
        """H, one polynomial on the whole line."""
        row = [k * _with_digits(c) for k, c in enumerate(self.coefficients)][1:]
        return polynomial_slope((-INF, INF), (0.0,), (row,))

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        return np.asarray(polynomial.polyval(x, self.coefficients), dtype=float)

    @property
    @override
    def axis(self) -> float | None:
        return None if any(self.coefficients[1::2]) else 0.0


@dataclass(frozen=True, init=False, repr=False)
class Piecewise(Profile):
    """A profile by its slope, a polynomial on each piece: h' = Σ pieces[k][j] x^j on piece k.

    Parameters
    ----------
    breaks : sequence of float
        Ends of the pieces, ascending lengths: one more than there are pieces, of which the outer
        two may be infinite; or the inner ones only, one fewer than there are pieces, and the
        indenter has no end.
    pieces : sequence of sequences of float
        Coefficients of h' in x on each piece, low order first, at most 201 of them; pieces[k][j]
        as a length to the power -j.

    Raises
    ------
    ValueError
        If the breaks do not ascend or do not fit the number of pieces, a piece is empty, or a
        value is no finite number in its range.

    Notes
    -----
    h is continuous, and 0 at x = 0 or at the end of the indenter that is nearest to it. A jump of
    the slope is a corner: the pressure is logarithmically infinite under it.

    Examples
    --------
    >>> worn = Piecewise(breaks=[-1.0, 2.0], pieces=[[0.5, 0.5], [0.0], [-0.5, 0.25]])
    >>> worn.slope([-2.0, 0.0, 4.0])
    array([-0.5,  0. ,  0.5])
    """

    ends: tuple[float, ...]
    coefficients: tuple[tuple[float, ...], ...]

    def __init__(self, breaks: Sequence[float], pieces: Sequence[Sequence[float]]) -> None:
        what = "the coefficients of h' there, low order first"
        given = arguments.listed("pieces", pieces, "the coefficients of h' on each piece")
        rows = tuple(
            _coefficients(f"pieces[{k}]", row, HIGHEST_OF_PIECE, what)
            for k, row in enumerate(given)
        )
        breaks = arguments.listed("breaks", breaks, "the ends of the pieces")
        object.__setattr__(self, "ends", _ends(breaks, len(rows)))
        object.__setattr__(self, "coefficients", rows)
        for k, row in enumerate(rows):
            if not row:
                raise ValueError(
                    f"pieces[{k}] is empty: give its one coefficient 0 for a flat piece"
                )

    def __repr__(self) -> str:
        comma = "," * (len(self.coefficients) == 1)
        pieces = f"({abridged(self.coefficients)}{comma})"
        return f"Piecewise(breaks=({abridged(self.ends)}), pieces={pieces})"

    @cached_property
    def pieces(self) -> Slope:
        """H, a polynomial on each piece."""
        given = [tuple(map(_with_digits, row)) for row in self.coefficients]
        rows = [
            _well_placed(row, lo, hi)
            for row, (lo, hi) in zip(given, pairwise(self.ends), strict=True)
        ]
        c = [[float(v) for v in row] for _, row in rows]
        tails = np.array(
            [(float(exact[0] - Fraction(row[0])), 0.0) for (_, exact), row in zip(rows, c)]
        )
        return polynomial_slope(self.ends, [o for o, _ in rows], c, tails)

    @cached_property
    def axis(self) -> float | None:
        """0 if breaks and coefficients are symmetric about x = 0, otherwise None."""
        mirrored = self.pieces.mirrored()
        same = np.array_equal(mirrored.breaks, self.pieces.breaks) and all(
            row == tuple(-c * (-1.0) ** j for j, c in enumerate(other))
            for row, other in zip(self.coefficients, self.coefficients[::-1], strict=True)
        )
        return 0.0 if same else None


def _coefficients(name: str, values: Sequence[float], highest: int, what: str) -> tuple[float, ...]:
    """The coefficients of a polynomial whose degree is at most `highest`; `what` names them."""
    largest = arguments.LARGEST_COEFFICIENT
    c = tuple(
        arguments.measure(f"{name}[{k}]", v, largest)
        for k, v in enumerate(arguments.listed(name, values, what))
    )
    if len(c) > highest + 1:
        raise ValueError(
            f"the degree of {name} is {len(c) - 1}, more than {highest}: "
            "give the slope as a function"
        )
    return c


def _with_digits(coefficient: float) -> float:
    """The coefficient, or 0 where it is so small that its products have no digits."""
    return coefficient if abs(coefficient) >= NO_DIGITS else 0.0


def _ends(breaks: Sequence[float], count: int) -> tuple[float, ...]:
    """The ends of `count` pieces, ascending; only the outer two may be infinite."""
    ends = tuple(arguments.real(f"breaks[{k}]", b) for k, b in enumerate(breaks))
    if len(ends) == count - 1:
        ends = (-INF, *ends, INF)
    if not count or len(ends) != count + 1:
        raise ValueError(
            f"{len(breaks)} breaks do not bound {count} pieces: "
            "give one break more than pieces, or one less (the inner ones)"
        )
    for k, end in enumerate(ends):
        if math.isfinite(end):
            arguments.measure(f"breaks[{k}]", end)
    for left, right in pairwise(ends):
        if not left < right:
            raise ValueError(
                f"breaks {left:g}, {right:g} do not ascend: sort them and drop duplicates"
            )
    return ends


def _well_placed(row: tuple[float, ...], lo: float, hi: float) -> tuple[float, list[Fraction]]:
    """(origin, coefficients about it), where the slope at the origin is smallest.

    The origin is an end of the piece, x = 0 or the zero of a straight line. The arithmetic is
    exact: the slope at the origin follows from the given coefficients without rounding.
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


def _moved(row: tuple[float, ...], origin: float) -> list[Fraction]:
    """Coefficients about the origin, by synthetic division in rational arithmetic."""
    c = [Fraction(v) for v in row]
    for i in range(len(c) - 1):
        for j in range(len(c) - 2, i - 1, -1):
            c[j] += Fraction(origin) * c[j + 1]
    return c
