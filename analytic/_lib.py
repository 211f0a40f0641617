"""One formula, two number systems: NumPy arrays or the scalars of an mpmath context.

Every function of this package takes `lib`: NumPy itself, or a context such as `mpmath.mp` or `mpmath.MPContext()`.
The two agree on the names `sqrt, cbrt, log, exp, expm1, sin, cos, atan, asin, asinh, pi, inf` (NumPy from 2.0 on), so
that a formula is written once. Here is the little in which they differ: how numbers come in, and how a formula that
holds only on part of the line is confined to that part.
"""

import math
import sys
from collections.abc import Callable, Hashable
from typing import Any, TypeAlias

import numpy as np

Number: TypeAlias = Any
"""A float, an array, or a number of the mpmath context in use."""

Library: TypeAlias = Any
"""NumPy, or an mpmath context."""

MEANING = {
    "radius": "the radius of the curved part, a length > 0",
    "modulus": "the plane contact modulus E*, a stress > 0",
    "half_flat": "half the length of the flat, a length >= 0",
    "half_width": "half the length of the contact, a length > 0",
    "rim": "half_width - half_flat, a length >= 0",
    "normal_load": "the load per unit length, pressing, > 0",
    "slope": "the flank's rise over run, > 0",
    "coefficient": "C in h = C |x|**exponent, > 0",
    "exponent": "the power in h = C |x|**exponent, >= 1",
    "moment": "the moment of the pressure about the middle of the flat, per unit length",
    "tilt": "the rotation h' of the flat, in radians",
    "coupling": "the product beta f of Dundurs' second constant and the coefficient of friction, negative for sliding towards -x",
    "dundurs": "Dundurs' second constant beta of the pair, between -1/2 and 1/2",
    "shear_load": "the shear load Q per unit length",
    "friction": "Coulomb's coefficient f > 0",
    "tangential_load": "the tangential load per unit length, between 0 and friction * normal_load",
    "largest_load": "the tangential load at which unloading began, between 0 and friction * normal_load",
    "least_load": "the tangential load at which reloading began, from -largest_load to largest_load",
    "bulk_stress": "the tension in the half-plane along its surface",
    "inner": "the distance from x = 0 to the near ends, a length > 0",
    "outer": "the distance from x = 0 to the far ends, a length > inner",
    "distance": "the distance d of each apex from x = 0, a length > 0",
    "wavelength": "the period, a length > 0",
    "amplitude": "half the height from trough to crest, a length > 0",
    "mean_pressure": "the load per unit area over one period, a stress > 0",
    "tension": "the remote tension across the crack, a stress",
    "half_length": "half the length of a crack, a length > 0",
    "period": "the distance from one to the next, a length > 0",
    "stick_half_width": "half the length of the stick zone, a length >= 0",
    "x": "a real position on the surface",
    "z": "a point x + iy of the plane",
    "y": "a depth below the surface, a length >= 0",
    "poisson": "Poisson's ratio",
    "peak_pressure": "the largest pressure of the line contact, > 0",
}


# Below this height over the cut, in units of the contact (and below the least normal float), quotients under- or
# overflow. The limit on the cut is then correct to all digits. (A context has no such bound.)
SHALLOW = 1e-290


# Of larger parameters, and of smaller ones, products leave the range of doubles. Loads and moments
# are products themselves, a coefficient is over a power of a length, `inner` enters by a logarithm.
LARGEST = 1e150
LARGEST_OF = {name: 1e250 for name in MEANING if name.endswith("_load")}
LARGEST_OF |= dict.fromkeys(("coefficient", "inner", "moment"), sys.float_info.max)
OTHER_UNITS = "where products are doubles (choose other units, or an mpmath context as lib)"
# Positions may be as far away as doubles go.
POSITIONS = ("x", "y", "z")


def bits(lib: Library) -> int:
    """Bits of the significand: the number that decides how many terms of a series are enough."""
    return 53 if lib is np else int(lib.prec)


def real(name: str, value: Number, lib: Library) -> Number:
    """`value` as float or array of float64, or as context number. ValueError unless it is real and finite."""
    try:
        number = _float64(value) if lib is np else lib.mpf(lib.convert(value))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} = {value!r} is not {_kind(lib)}; give {MEANING[name]}.") from None
    _accept(name, number, _finite(number, lib), "finite")
    if lib is np and name not in POSITIONS:
        largest = LARGEST_OF.get(name, LARGEST)
        _accept(name, number, abs(number) <= largest, f"at most {largest:g} in size, {OTHER_UNITS}")
    return number


def positive(name: str, value: Number, lib: Library) -> Number:
    """`value` as `real` returns it. ValueError unless it is positive."""
    number = real(name, value, lib)
    return _not_tiny(name, _accept(name, number, number > 0, "positive"), lib)


def not_negative(name: str, value: Number, lib: Library) -> Number:
    """`value` as `real` returns it. ValueError when it is negative."""
    number = real(name, value, lib)
    return _not_tiny(name, _accept(name, number, number >= 0, "zero or positive"), lib)


def _not_tiny(name: str, number: Number, lib: Library) -> Number:
    """0, or a number that is not too small for products; a context has no such bound."""
    if lib is not np or name in POSITIONS:
        return number
    least = 1.0 / LARGEST_OF.get(name, LARGEST)
    good = (number == 0) | (number >= least)
    return _accept(name, number, good, f"at least {least:g}, {OTHER_UNITS}")


def point(value: Number, lib: Library) -> Number:
    """z as complex array or context number. ValueError unless it is finite."""
    try:
        # Adding zero turns an imaginary part of -0.0 into +0.0. Without it z - b and z + b would carry opposite signs
        # of zero, and sqrt(z - b) sqrt(z + b) the wrong sign on x < -b.
        number = (
            np.asarray(value, dtype=complex)[()] + 0j if lib is np else lib.mpc(lib.convert(value))
        )
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"z = {value!r} is not {_kind(lib)}; give {MEANING['z']}.") from None
    return _accept("z", number, _finite(number, lib), "finite")


def larger(first: Number, second: Number, lib: Library) -> Number:
    """The larger of two numbers, entry by entry."""
    return np.maximum(first, second) if lib is np else max(first, second)


def smaller(first: Number, second: Number, lib: Library) -> Number:
    """The smaller of two numbers, entry by entry."""
    return np.minimum(first, second) if lib is np else min(first, second)


def side_of_cut(side: int) -> int:
    """+1 or -1. ValueError otherwise."""
    if not isinstance(side, Hashable) or side not in (1, -1):
        raise ValueError(
            f"side = {side!r} is neither +1 nor -1; give +1 for the body y > 0, -1 for its mirror image."
        )
    return int(side)


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
    """A real factor times a complex number, part by part: NumPy's product would make nan of 1 * (0 + inf j)."""
    return cartesian(factor * number.real, factor * number.imag, lib)


def sign(x: Number) -> Number:
    """-1, 0 or +1, as an integer."""
    return (x > 0) * 1 - (x < 0) * 1


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


def pick(
    lib: Library,
    where: Number,
    yes: Callable[..., Number],
    no: Callable[..., Number],
    *args: Number,
) -> Number:
    """`yes(lib, *args)` where the condition holds, `no(lib, *args)` elsewhere.

    Each formula sees only the points of its own domain, so that no nan or overflow arises that would have to be
    hidden. The condition and the arguments, numbers or named tuples of numbers, broadcast.
    """
    if lib is not np:
        return yes(lib, *args) if where else no(lib, *args)
    where = _broadcast(where, args)
    count = np.count_nonzero(where)
    if count == np.size(where):
        return yes(lib, *args)
    if count == 0:
        return no(lib, *args)
    here, there = np.flatnonzero(where), np.flatnonzero(~where)
    first = yes(lib, *(_at(here, where.shape, arg) for arg in args))
    second = no(lib, *(_at(there, where.shape, arg) for arg in args))
    result = np.empty(where.size, np.result_type(first, second))
    result[here], result[there] = first, second
    return result.reshape(where.shape)


def together(
    lib: Library, function: Callable[..., Number], *calls: tuple[Number, ...]
) -> tuple[Number, ...]:
    """`function(lib, *call)` for each call, in one pass over arrays, which costs less than several."""
    if lib is not np:
        return tuple(function(lib, *call) for call in calls)
    return tuple(function(lib, *(np.array(args) for args in zip(*calls, strict=True))))


def root(lib: Library, z: Number, b: Number) -> Number:
    """sqrt(z² - b²), cut along [-b, b] and ~ z far away, for z off the cut."""
    return lib.sqrt(z - b) * lib.sqrt(z + b)


def on_cut(lib: Library, z: Number, b: Number, low: Number = 0) -> Number:
    """Whether z is a real point of the contact, where the limit depends on the side, or in floats as good as one.

    The half-width is b + low, in case it has more digits than b.
    """
    height = larger(SHALLOW * b, sys.float_info.min, lib) if lib is np else 0
    return (abs(z.imag) <= height) & ((b - abs(z.real)) + low >= 0)


def seen_from(z: Number, side: int) -> Number:
    """The side of the cut that z is on, and `side` for real z."""
    own = sign(z.imag)
    return own + (own == 0) * side


def _broadcast(where: Number, args: tuple[Number, ...]) -> Number:
    shape, others = np.shape(where), _shapes(args)
    return (
        where
        if others <= {(), shape}
        else np.broadcast_to(where, np.broadcast_shapes(shape, *others))
    )


def _shapes(args: tuple[Number, ...]) -> set[tuple[int, ...]]:
    shapes: set[tuple[int, ...]] = set()
    for arg in args:
        shapes |= _shapes(arg) if isinstance(arg, tuple) else {np.shape(arg)}
    return shapes


def _at(indices: Number, shape: tuple[int, ...], arg: Number) -> Number:
    if isinstance(arg, tuple):
        return type(arg)(*(_at(indices, shape, leaf) for leaf in arg))
    if np.ndim(arg) == 0:
        return arg
    return (arg if arg.shape == shape else np.broadcast_to(arg, shape)).reshape(-1).take(indices)


def _float64(value: Number) -> Number:
    if type(value) is float:
        return value
    array = np.asarray(value)
    if (
        array.dtype.kind not in "fiu"
    ):  # strings, complex and other numbers: each must convert by itself
        array = array.astype(object)
    # Python's float, not NumPy's: that one is slow on the left of an array, and most parameters are single numbers.
    return array.astype(float, copy=False) if array.ndim else float(array)


def _finite(number: Number, lib: Library) -> Number:
    return math.isfinite(number) if type(number) is float else lib.isfinite(number)


def _accept(name: str, number: Number, good: Number, demand: str) -> Number:
    if everywhere(good):
        return number
    bad = ~good if isinstance(good, np.ndarray) else True
    raise ValueError(
        f"{name} = {first_where(bad, number)[0]} is not {demand}; give {MEANING[name]}."
    )


def _kind(lib: Library) -> str:
    return (
        "a number or an array of numbers"
        if lib is np
        else "a single number (an mpmath context takes one at a time)"
    )
