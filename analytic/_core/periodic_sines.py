"""Sines of pi z/L and their quotients, at any distance from the axis.

They serve functions that repeat with the period L.
"""

from typing import Any

import numpy as np

from analytic._core.numbers import Library, Number, cartesian
from analytic._core.piecewise import pick


def in_period(lib: Library, x: Number, L: Number) -> Number:
    """x less the multiple of L next to it, without rounding."""
    if lib is not np:
        return x - L * lib.nint(x / L)
    rest: Any = np.fmod(x, L)  # exact
    # -L, 0 or L is subtracted: exact too, as the rest is at least half of it
    return rest - L * np.rint(rest / L)


def sine(lib: Library, x: Number, L: Number) -> Number:
    """sin(pi x/L)."""
    return lib.sin(lib.pi * (x / L))


def cotangent(lib: Library, z: Number, L: Number) -> Number:
    """cot(pi z/L), i (q+1)/(q-1) with q = exp(2 pi i z/L) of y >= 0, which cannot overflow."""
    up, flip = _above(lib, z)
    less = _q_minus_one(lib, up, L)
    return _back(lib, _times_i((2 + less) / less, lib), flip)


def one_minus_square(lib: Library, z: Number, a: Number, L: Number) -> Number:
    """1 - sin²(pi a/L)/sin²(pi z/L), from the distances to ±a.

    It is sin(pi (z-a)/L) sin(pi (z+a)/L)/sin²(pi z/L).
    """
    up, flip = _above(lib, z)
    whole = _q_minus_one(lib, up, L)
    return _back(
        lib, (_q_minus_one(lib, up - a, L) / whole) * (_q_minus_one(lib, up + a, L) / whole), flip
    )


def _above(lib: Library, z: Number) -> tuple[Number, Number]:
    flip = 1 - 2 * (z.imag < 0)
    return cartesian(z.real, abs(z.imag), lib), flip


def _back(lib: Library, number: Number, flip: Number) -> Number:
    return cartesian(number.real, flip * number.imag, lib)


def _times_i(number: Number, lib: Library) -> Number:
    return cartesian(-number.imag, number.real, lib)


def _q_minus_one(lib: Library, z: Number, L: Number) -> Number:
    """exp(2 pi i z/L) - 1 for y >= 0."""
    return pick(lib, z.imag > 40 * L, _minus_one, _expm1, z, L)


def _expm1(lib: Library, z: Number, L: Number) -> Number:
    angle = 2 * lib.pi / L
    return lib.expm1(cartesian(-angle * z.imag, angle * z.real, lib))


def _minus_one(lib: Library, z: Number, L: Number) -> Number:
    return -1 + 0 * z
