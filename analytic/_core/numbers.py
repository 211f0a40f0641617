"""One formula, two number systems: NumPy arrays or the scalars of an mpmath context.

Every function of this package takes `lib`: NumPy itself, or a context such as `mpmath.mp` or
`mpmath.MPContext()`. The two agree on the names `sqrt, cbrt, log, exp, expm1, sin, cos, atan, asin,
asinh, pi, inf` (NumPy from 2.0 on), so that a formula is written once. Here is the little in which
they differ.
"""

from typing import Any, TypeAlias

import numpy as np

Number: TypeAlias = Any
"""A float, an array, or a number of the mpmath context in use."""

Library: TypeAlias = Any
"""NumPy, or an mpmath context."""


def bits(lib: Library) -> int:
    """Bits of the significand: the number that decides how many terms of a series are enough."""
    return 53 if lib is np else int(lib.prec)


def larger(first: Number, second: Number, lib: Library) -> Number:
    """The larger of two numbers, entry by entry."""
    return np.maximum(first, second) if lib is np else max(first, second)


def smaller(first: Number, second: Number, lib: Library) -> Number:
    """The smaller of two numbers, entry by entry."""
    return np.minimum(first, second) if lib is np else min(first, second)


def fraction(numerator: int, denominator: int, lib: Library) -> Number:
    """An exact quotient of integers, rounded once."""
    return numerator / denominator if lib is np else lib.mpf(numerator) / denominator


def cartesian(real_part: Number, imaginary_part: Number, lib: Library) -> Number:
    """x + iy without arithmetic: 1j * inf would be nan + inf j."""
    if lib is not np:
        return lib.mpc(real_part, imaginary_part)
    number = np.empty(np.broadcast_shapes(np.shape(real_part), np.shape(imaginary_part)), complex)
    number.real, number.imag = real_part, imaginary_part
    return number


def scaled(factor: Number, number: Number, lib: Library) -> Number:
    """A real factor times a complex number, part by part.

    NumPy's product would make nan of 1 * (0 + inf j).
    """
    return cartesian(factor * number.real, factor * number.imag, lib)


def sign(x: Number) -> Number:
    """-1, 0 or +1, as an integer."""
    return (x > 0) * 1 - (x < 0) * 1


def not_below_zero(number: Number) -> Number:
    """The number, or 0 where it is negative."""
    return (number + abs(number)) / 2


def everywhere(condition: Number) -> bool:
    """Whether a condition holds at every entry."""
    return bool(condition.all() if isinstance(condition, np.ndarray) else condition)


def first_where(condition: Number, *numbers: Number) -> tuple[Number, ...]:
    """The numbers at the first entry where the condition holds, for a message."""
    if not isinstance(condition, np.ndarray):
        return numbers
    return tuple(number[condition].flat[0] for number in np.broadcast_arrays(*numbers))


def most(number: Number, lib: Library) -> Number:
    """The largest entry of an array, or the number itself."""
    return np.max(number) if lib is np else number


def as_result(number: Number) -> Number:
    """A NumPy scalar in place of an array without dimensions or of a Python float."""
    if isinstance(number, float):
        return np.float64(number)
    return number[()] if isinstance(number, np.ndarray) else number
