"""Two equal rigid flats on a < |x| < b, made of one piece, pressed on a half-plane: no friction, or beta = 0.

Under a load P in the middle both press evenly, and the solution is elementary (Muskhelishvili 1953, part V; Gladwell,
Contact Problems, 1980). Under a moment M the piece rotates by h', and that the flats keep their difference of
height, ∫_-a^a (Fp - E*/2 h') dx = 0, brings in the complete elliptic integrals of modulus k = a/b, D = (K - E)/k²:

    p  = [ P |x|/pi + sign(x) A (x² - a² D/K) ] / sqrt((x² - a²)(b² - x²)),      A = -E* h'/2
    M  = pi A [ (a² + b²)/2 - a² D/K ]
    Fp = (P/pi) z/S + A [ (z² - a² D/K)/S - 1 ],      S = sqrt(z² - a²) sqrt(z² - b²)

While |A| <= (P/pi) b/(b² - a² D/K) all four corners touch. For a -> 0 this is the one flat of half-width b.
"""

import sys
from functools import partial
from typing import NamedTuple

import numpy as np

from analytic._agm import ratio_D
from analytic._lib import (
    Library,
    Number,
    as_result,
    cartesian,
    everywhere,
    first_where,
    on_cut,
    pick,
    point,
    positive,
    real,
    root,
    seen_from,
    side_of_cut,
    sign,
)

# A moment that passes the limit of lift-off by no more than its own rounding is taken to be at the limit.
ROUNDING = 8 * sys.float_info.epsilon


def pressure(
    x: Number,
    *,
    inner: Number,
    outer: Number,
    normal_load: Number,
    moment: Number = 0,
    lib: Library = np,
) -> Number:
    """The pressure p(x) under both flats, inf at their corners, and 0 elsewhere.

    `x` and the parameters broadcast. ValueError for input that has no meaning and for moments that lift a corner off.

    >>> round(float(pressure(-1.5, inner=1.0, outer=2.0, normal_load=np.pi)), 12)
    1.014185105674
    """
    x, contact = real("x", x, lib), _contact_of(inner, outer, normal_load, moment, lib)
    return as_result(_pressure(lib, x, contact))


def largest_moment(
    *, inner: Number, outer: Number, normal_load: Number, lib: Library = np
) -> Number:
    """The moment P b ((a² + b²)/2 - a² D/K)/(b² - a² D/K) at which an outer corner is about to lift off.

    >>> round(float(largest_moment(inner=1e-9, outer=2.0, normal_load=1.0)), 12)
    1.0
    """
    a, b = _ends(inner, outer, lib)
    return as_result(positive("normal_load", normal_load, lib) * _lever(*_shape(lib, a, b)) * b)


def tilt(
    *,
    inner: Number,
    outer: Number,
    normal_load: Number,
    moment: Number,
    modulus: Number,
    lib: Library = np,
) -> Number:
    """The rotation h' = -2 A/E* under the moment M. ValueError for moments that lift a corner off.

    >>> round(float(tilt(inner=1e-9, outer=1.0, normal_load=np.pi, moment=np.pi / 4, modulus=1.0)), 12)
    -1.0
    """
    contact = _contact_of(inner, outer, normal_load, moment, lib)
    return as_result(-2 * contact.A / positive("modulus", modulus, lib))


def potential(
    z: Number,
    *,
    inner: Number,
    outer: Number,
    normal_load: Number,
    moment: Number = 0,
    side: int = +1,
    lib: Library = np,
) -> Number:
    """The potential Fp(z) of the pressure, complex; ~ P/(pi z) far away.

    Real z under the flats are on a cut: there `side` = +1 gives the limit from the body y > 0, E*/2 h' - i p, and -1 its
    conjugate. Between the flats it is real, E*/2 times the slope of the surface. ValueError as in `pressure`.

    >>> round(complex(potential(1.5, inner=1.0, outer=2.0, normal_load=np.pi)).imag, 12)
    -1.014185105674
    """
    z, side, contact = (
        point(z, lib),
        side_of_cut(side),
        _contact_of(inner, outer, normal_load, moment, lib),
    )
    pressed = on_cut(lib, z, contact.b) & (abs(z.real) >= contact.a)
    return as_result(
        pick(lib, pressed, partial(_potential_on_cut, side=side), _potential, z, contact)
    )


class _Contact(NamedTuple):
    a: Number
    b: Number
    slant: Number  # P/pi
    A: Number  # -E* h'/2
    level: Number  # a² D/K


def _ends(inner: Number, outer: Number, lib: Library) -> tuple[Number, Number]:
    a, b = positive("inner", inner, lib), positive("outer", outer, lib)
    if not everywhere(a < b):
        near, far = first_where(np.logical_not(a < b) if lib is np else True, a, b)
        raise ValueError(
            f"outer = {far} is not more than inner = {near}; give inner < outer, the ends of one patch."
        )
    return a, b


def _shape(lib: Library, a: Number, b: Number) -> tuple[Number, Number]:
    """k² and D/K."""
    k = a / b
    return k * k, ratio_D(lib, k, lib.sqrt((b - a) / b) * lib.sqrt((b + a) / b))


def _lever(k2: Number, D_K: Number) -> Number:
    """The largest M/(P b)."""
    return ((1 + k2) / 2 - k2 * D_K) / (1 - k2 * D_K)


def _contact_of(
    inner: Number, outer: Number, normal_load: Number, moment: Number, lib: Library
) -> _Contact:
    (a, b), P, M = (
        _ends(inner, outer, lib),
        positive("normal_load", normal_load, lib),
        real("moment", moment, lib),
    )
    k2, D_K = _shape(lib, a, b)
    lever, most = abs(M) / P / b, _lever(k2, D_K)
    lifted = lever > most * (1 + ROUNDING)
    if np.any(lifted):
        bad, limit = first_where(lifted, abs(M) + 0 * lever, most * P * b)
        raise ValueError(
            f"|moment| = {bad} exceeds largest_moment = {limit}: a corner lifts off; give a smaller one."
        )
    return _Contact(a, b, P / lib.pi, M / b / b / ((1 + k2) / 2 - k2 * D_K) / lib.pi, a * a * D_K)


def _pressure(lib: Library, x: Number, contact: _Contact) -> Number:
    r = abs(x)
    return pick(
        lib,
        (r > contact.a) & (r < contact.b),
        _pressure_inside,
        _pressure_not_inside,
        r,
        sign(x),
        contact,
    )


def _pressure_inside(lib: Library, r: Number, s: Number, contact: _Contact) -> Number:
    a, b = contact.a, contact.b
    pressed = contact.slant * r + s * contact.A * (r * r - contact.level)
    roots = lib.sqrt(r - a) * lib.sqrt(r + a) * lib.sqrt(b - r)
    return (pressed + abs(pressed)) / 2 / roots / lib.sqrt(b + r)  # below zero by rounding only


def _pressure_not_inside(lib: Library, r: Number, s: Number, contact: _Contact) -> Number:
    # at lift-off the outer corner of one side carries nothing
    carried = (
        contact.slant * r + s * contact.A * (r * r - contact.level) > ROUNDING * contact.slant * r
    )
    return pick(lib, ((r == contact.a) | (r == contact.b)) & carried, _infinite, _nothing, r)


def _infinite(lib: Library, *_: Number) -> Number:
    return lib.inf


def _nothing(lib: Library, r: Number) -> Number:
    return 0 * r


def _potential(lib: Library, z: Number, contact: _Contact) -> Number:
    return pick(lib, abs(z) > 2 * contact.b, _potential_far, _potential_near, z, contact)


def _potential_near(lib: Library, z: Number, contact: _Contact) -> Number:
    S = root(lib, z, contact.a) * root(lib, z, contact.b)
    return (contact.slant * z + contact.A * (z * z - contact.level - S)) / S


def _potential_far(lib: Library, z: Number, contact: _Contact) -> Number:
    """With S = z² s and z² (1 - s) = (a² + b² - a² b²/z²)/(1 + s)."""
    a, b = contact.a, contact.b
    s = lib.sqrt(1 - (a / z) * (a / z)) * lib.sqrt(1 - (b / z) * (b / z))
    rest = (a * a + b * b - (a * b / z) * (a * b / z)) / (1 + s) - contact.level
    return (contact.slant + contact.A * rest / z) / s / z


def _potential_on_cut(lib: Library, z: Number, contact: _Contact, *, side: int) -> Number:
    return cartesian(
        -contact.A + 0 * z.real, -seen_from(z, side) * _pressure(lib, z.real, contact), lib
    )
