"""Partial slip of any profile: distance of the loads from sliding, integrals over slip zones."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from analytic._core.numbers import Library, Number, as_result, bits
from analytic._core.parameters import not_negative, positives, real, refuse

# Dekker's constant splits a double into two halves whose products are exact.
SPLITTER = 2.0**27 + 1
# The step of the double exponential rule times the bits it is good for.
STEP_TIMES_BITS = 3.3


# The loads of a cycle, in the order of time.
NAMES = ("largest_load", "least_load", "tangential_load")


class Traction(NamedTuple):
    """The part of the friction that a tangential load uses, and what is left.

    used = Q/(fP) and left = 1 - Q/(fP), each to all its digits.
    """

    used: Number
    left: Number


def traction(
    lib: Library,
    friction: Number,
    normal_load: Number,
    tangential_load: Number,
    name: str = "tangential_load",
) -> Traction:
    """The traction under 0 <= Q <= f P. ValueError for other loads."""
    f, P = positives(lib, friction=friction, normal_load=normal_load)
    Q = not_negative(name, tangential_load, lib)
    rest = _rest(f, P, Q) if lib is np else f * P - Q
    message = "{} exceeds friction * normal_load = {}: the bodies slide; give a smaller one."
    refuse(rest < 0, f"{name} = {message}", Q, f * P)
    return Traction(Q / P / f, rest / P / f)


def turned(
    lib: Library,
    friction: Number,
    normal_load: Number,
    largest_load: Number,
    tangential_load: Number,
) -> tuple[Traction, Traction]:
    """The tractions of Q_max and of (Q_max - Q)/2, after which the load is down to Q.

    ValueError unless |Q| <= Q_max.
    """
    top = traction(lib, friction, normal_load, largest_load, "largest_load")
    Q, most = (
        real("tangential_load", tangential_load, lib),
        not_negative("largest_load", largest_load, lib),
    )
    message = (
        "tangential_load = {} is not between ± largest_load = {}; give a load on the way back."
    )
    refuse(abs(Q) > most, message, Q, most)
    return top, traction(lib, friction, normal_load, (most - Q) / 2)


def turned_twice(
    lib: Library, friction: Number, normal_load: Number, loads: tuple[Number, Number, Number]
) -> tuple[Traction, Traction, Traction]:
    """The tractions of Q_max, (Q_max - Q_min)/2 and (Q - Q_min)/2 of the loads Q_max, Q_min and Q.

    ValueError unless -Q_max <= Q_min <= Q <= Q_max.
    """
    most, least, Q = (real(name, value, lib) for name, value in zip(NAMES, loads, strict=True))
    top, down = turned(lib, friction, normal_load, most, least)
    message = (
        "tangential_load = {} is not between least_load = {} and largest_load = {}; "
        "give one that is."
    )
    refuse((least > Q) | (most < Q), message, Q, least, most)
    return top, down, traction(lib, friction, normal_load, (Q - least) / 2)


def integral(lib: Library, integrand: Callable[[Number, Number], Number]) -> Number:
    """∫_0^1 of a function of s and 1 - s by the double exponential rule (Takahasi & Mori 1974).

    Accurate to all digits for functions that are analytic but for powers at the ends, or next to
    them.
    """
    digits = bits(lib)
    step = STEP_TIMES_BITS / digits
    last = int(float(np.arcsinh((digits + 4) * np.log(2) / np.pi)) / step) + 1
    total = None
    for k in range(-last, last + 1):
        t = k * step if lib is np else k * lib.mpf(step)
        e = lib.exp(lib.pi * lib.sinh(-abs(t)))
        small, large = e / (1 + e), 1 / (1 + e)
        left, right = (small, large) if k < 0 else (large, small)
        part = lib.cosh(t) * small * large * integrand(left, right)
        total = part if total is None else total + part
    return as_result(lib.pi * step * total)


def _rest(f: Number, P: Number, Q: Number) -> Number:
    """f P - Q, rounded once, also where it is a small difference.

    Dekker's product of the significands is exact.
    """
    (f, m), (P, n) = np.frexp(f), np.frexp(P)
    product = f * P
    f_high, P_high = (SPLITTER * v - (SPLITTER * v - v) for v in (f, P))
    f_low, P_low = f - f_high, P - P_high
    error = ((f_high * P_high - product) + f_high * P_low + f_low * P_high) + f_low * P_low
    return np.ldexp((product - np.ldexp(Q, -(m + n))) + error, m + n)
