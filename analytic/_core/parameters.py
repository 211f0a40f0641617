"""The parameters of the closed forms: their meanings, and the refusal of those without meaning."""

import math
import sys
from collections.abc import Callable, Hashable

import numpy as np

from analytic._core.numbers import Library, Number, as_result, everywhere, first_where

MEANING = {
    "radius": "the radius of the curved part, a length > 0",
    "modulus": "the plane contact modulus E*, a stress > 0",
    "half_flat": "half the length of the flat, a length >= 0",
    "half_width": "half the length of the contact, a length > 0",
    "rim": "the difference half_width - half_flat, a length >= 0",
    "normal_load": "the load P per unit length of the contact, pressing, a force per length > 0",
    "slope": "the flank's rise over run, a number > 0",
    "coefficient": "C in h = C |x|**exponent, a length**(1 - exponent) > 0",
    "exponent": "the power in h = C |x|**exponent, one number >= 1",
    "moment": "the moment of the pressure about the middle of the flat, a force",
    "tilt": "the rotation h' of the flat, in radians",
    "coupling": (
        "the product beta f of Dundurs' second constant and the coefficient of friction, a number; "
        "negative for sliding towards -x"
    ),
    "dundurs": "Dundurs' second constant beta of the pair, a number between -1/2 and 1/2",
    "shear_load": "the shear load Q per unit length, a force per length",
    "friction": "Coulomb's coefficient f, a number > 0",
    "tangential_load": "the load Q along x, a force per length from 0 to friction * normal_load",
    "largest_load": "the tangential load where it turned first, from 0 to friction * normal_load",
    "least_load": "the tangential load where it turned again, from -largest_load to largest_load",
    "bulk_stress": "the tension in the half-plane along its surface, a stress",
    "inner": "the distance from x = 0 to the near ends, a length > 0",
    "outer": "the distance from x = 0 to the far ends, a length > inner",
    "distance": "the distance d of each apex from x = 0, a length > 0",
    "wavelength": "the period, a length > 0",
    "amplitude": "half the height from trough to crest, a length > 0",
    "mean_pressure": "the load over one period divided by the period, a stress > 0",
    "tension": "the remote tension across the crack, a stress",
    "half_length": "half the length of a crack, a length > 0",
    "period": "the distance from one to the next, a length > 0",
    "stick_half_width": "half the length of the stick zone, a length >= 0",
    "x": "the position on the surface, a length",
    "z": "the point x + iy of the plane, a complex length",
    "y": "a depth below the surface, a length >= 0",
    "poisson": "Poisson's ratio, a number",
    "coefficients": "the b_n, a list of stresses",
    "xx": "a component of a stress, as `Stresses` holds it",
    "yy": "a component of a stress, as `Stresses` holds it",
    "xy": "a component of a stress, as `Stresses` holds it",
    "peak_pressure": "the largest pressure of the line contact, a stress > 0",
}

# Products of larger parameters, and of smaller ones, leave the range of doubles. Loads and moments
# are products themselves, a coefficient is over a power of a length, `inner` enters by a logarithm.
LARGEST = 1e150
LARGEST_OF = {name: 1e250 for name in MEANING if name.endswith("_load")}
LARGEST_OF |= dict.fromkeys(("coefficient", "inner", "moment"), sys.float_info.max)
OTHER_UNITS = "where products are doubles (choose other units, or an mpmath context as lib)"
# Positions may have any size of a double.
POSITIONS = ("x", "y", "z")


def real(name: str, value: Number, lib: Library) -> Number:
    """`value` as float or array of float64, or as context number.

    ValueError unless it is real and finite.
    """
    if np.ma.is_masked(value):
        raise ValueError(f"{name} has masked entries; leave them out, or fill them.")
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


def positives(lib: Library, **values: Number) -> tuple[Number, ...]:
    """Several values as `positive` returns them, by name."""
    return tuple(positive(name, value, lib) for name, value in values.items())


def not_negative(name: str, value: Number, lib: Library) -> Number:
    """`value` as `real` returns it. ValueError when it is negative."""
    number = real(name, value, lib)
    return _not_tiny(name, _accept(name, number, number >= 0, "zero or positive"), lib)


def point(value: Number, lib: Library) -> Number:
    """z as complex array or context number. ValueError unless it is finite."""
    if np.ma.is_masked(value):
        raise ValueError("z has masked entries; leave them out, or fill them.")
    try:
        # Adding zero turns an imaginary part of -0.0 into +0.0. Without it z - b and z + b would
        # carry opposite signs of zero, and sqrt(z - b) sqrt(z + b) the wrong sign on x < -b.
        number = (
            np.asarray(value, dtype=complex)[()] + 0j if lib is np else lib.mpc(lib.convert(value))
        )
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"z = {value!r} is not {_kind(lib)}; give {MEANING['z']}.") from None
    return _accept("z", number, _finite(number, lib), "finite")


def representable(name: str, formula: Callable[[Number], Number], x: Number) -> Number:
    """formula(x), which grows with |x|. ValueError where it is more than the largest double."""
    with np.errstate(over="ignore"):
        try:
            value = formula(np.float64(x) if isinstance(x, float) else x)
        except OverflowError:  # of plain floats
            value = math.inf
    infinite = abs(value) == math.inf
    if everywhere(np.logical_not(infinite)):
        return as_result(value)
    far = first_where(np.asarray(infinite), np.asarray(x, dtype=object))[0]
    raise ValueError(f"the {name} at x = {far} is more than the largest double; give a smaller x.")


def side_of_cut(side: int) -> int:
    """+1 or -1. ValueError otherwise."""
    if not isinstance(side, Hashable) or side not in (1, -1):
        raise ValueError(
            f"side = {side!r} is neither +1 nor -1; give +1 for the body y > 0, -1 for its mirror "
            "image."
        )
    return int(side)


def patch_ends(inner: Number, outer: Number, lib: Library) -> tuple[Number, Number]:
    """The ends 0 < a < b of one of two patches or cracks. ValueError for others."""
    a, b = positives(lib, inner=inner, outer=outer)
    message = "outer = {} is not more than inner = {}; give inner < outer, the ends of one patch."
    refuse(a >= b, message, b, a)
    return a, b


def refuse(bad: Number, message: str, *numbers: Number) -> None:
    """ValueError where the condition holds, with the numbers at the first such entry."""
    if np.any(bad):
        raise ValueError(message.format(*first_where(bad, *numbers)))


def _not_tiny(name: str, number: Number, lib: Library) -> Number:
    """0, or a number that is not too small for products; a context has no such bound."""
    if lib is not np or name in POSITIONS:
        return number
    least = 1.0 / LARGEST_OF.get(name, LARGEST)
    good = (number == 0) | (number >= least)
    return _accept(name, number, good, f"at least {least:g}, {OTHER_UNITS}")


def _float64(value: Number) -> Number:
    if type(value) is float:
        return value
    array = np.asarray(value)
    # Strings, complex and other numbers: each must convert by itself
    if array.dtype.kind not in "fiu":
        array = array.astype(object)
    # Python's float, not NumPy's: that one is slow on the left of an array, and most parameters are
    # single numbers.
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
