"""Two equal rigid flats of one piece, pressed on a half-plane.

They lie on a < |x| < b. There is no friction, or beta = 0.

Under a load P in the middle both press evenly, and the solution is elementary (Muskhelishvili 1953,
part V; Gladwell, Contact Problems, 1980). Under a moment M the piece rotates by h', and that the
flats keep their difference of height, ∫_-a^a (Fp - E*/2 h') dx = 0, brings in the complete elliptic
integrals of modulus k = a/b, D = (K - E)/k²:

    p  = [ P |x|/pi + sign(x) A (x² - a² D/K) ] / sqrt((x² - a²)(b² - x²)),      A = -E* h'/2
    M  = pi A [ (a² + b²)/2 - a² D/K ]
    Fp = (P/pi) z/S + A [ (z² - a² D/K)/S - 1 ],      S = sqrt(z² - a²) sqrt(z² - b²)

While |A| <= (P/pi) b/(b² - a² D/K) all four corners touch. For a -> 0 this is the one flat of
half-width b.
"""

import sys
from typing import NamedTuple

import numpy as np

from analytic._core.cut import in_plane, on_cut, root, seen_from
from analytic._core.documentation import GLADWELL, MUSKHELISHVILI, documented
from analytic._core.elliptic import ratio_D
from analytic._core.numbers import Library, Number, as_result, cartesian, sign
from analytic._core.parameters import patch_ends, point, positive, real, refuse
from analytic._core.piecewise import infinite, nothing, pick

SOURCES = (
    f"{MUSKHELISHVILI}, part V",
    GLADWELL,
)

# A moment that passes the limit of lift-off by no more than its own rounding is taken to be at the
# limit.
ROUNDING = 8 * sys.float_info.epsilon


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, inner: Number, outer: Number, normal_load: Number, moment: Number = 0,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The pressure p(x) under both flats, inf at their corners, and 0 elsewhere.

    ValueError for moments that lift a corner off.

    >>> round(float(pressure(-1.5, inner=1.0, outer=2.0, normal_load=np.pi)), 12)
    1.014185105674
    """
    x, contact = real("x", x, lib), _contact_of(inner, outer, normal_load, moment, lib)
    return as_result(_pressure(lib, x, contact))


@documented("the moment M, a force", *SOURCES)
def largest_moment(
    *, inner: Number, outer: Number, normal_load: Number, lib: Library = np
) -> Number:
    """The moment at which an outer corner is about to lift off.

    The moment is P b ((a² + b²)/2 - a² D/K)/(b² - a² D/K).

    >>> round(float(largest_moment(inner=1e-9, outer=2.0, normal_load=1.0)), 12)
    1.0
    """
    a, b = patch_ends(inner, outer, lib)
    return as_result(positive("normal_load", normal_load, lib) * _lever(*_shape(lib, a, b)) * b)


@documented("the rotation h', in radians", *SOURCES)
def tilt(
    *, inner: Number, outer: Number, normal_load: Number, moment: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The rotation h' = -2 A/E* under the moment M. ValueError for moments that lift a corner off.

    >>> found = tilt(inner=1e-9, outer=1.0, normal_load=np.pi, moment=np.pi / 4, modulus=1.0)
    >>> round(float(found), 12)
    -1.0
    """
    contact = _contact_of(inner, outer, normal_load, moment, lib)
    return as_result(-2 * contact.A / positive("modulus", modulus, lib))


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, inner: Number, outer: Number, normal_load: Number, moment: Number = 0,
    side: int = +1, lib: Library = np,
) -> Number:  # fmt: skip
    """The potential Fp(z) of the pressure, complex; ~ P/(pi z) far away.

    Real z under the flats are on a cut: there `side` = +1 gives the limit from the body y > 0, E*/2
    h' - i p, and -1 its conjugate. Between the flats it is real, E*/2 times the slope of the
    surface. ValueError as in `pressure`.

    >>> round(complex(potential(1.5, inner=1.0, outer=2.0, normal_load=np.pi)).imag, 12)
    -1.014185105674
    """
    z, contact = point(z, lib), _contact_of(inner, outer, normal_load, moment, lib)
    pressed = on_cut(lib, z, contact.b) & (abs(z.real) >= contact.a)
    return as_result(in_plane(lib, pressed, side, _potential_on_cut, _potential, z, contact))


class _Contact(NamedTuple):
    a: Number
    b: Number
    slant: Number  # P/pi
    A: Number  # -E* h'/2
    level: Number  # a² D/K


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
    a, b = patch_ends(inner, outer, lib)
    P, M = positive("normal_load", normal_load, lib), real("moment", moment, lib)
    k2, D_K = _shape(lib, a, b)
    lever, most = abs(M) / P / b, _lever(k2, D_K)
    message = "|moment| = {} exceeds largest_moment = {}: a corner lifts off; give a smaller one."
    refuse(lever > most * (1 + ROUNDING), message, abs(M) + 0 * lever, most * P * b)
    return _Contact(a, b, P / lib.pi, M / b / b / ((1 + k2) / 2 - k2 * D_K) / lib.pi, a * a * D_K)


def _pressure(lib: Library, x: Number, contact: _Contact) -> Number:
    r = abs(x)
    inside = (r > contact.a) & (r < contact.b)
    return pick(lib, inside, _pressure_inside, _pressure_not_inside, r, sign(x), contact)


def _pressure_inside(lib: Library, r: Number, s: Number, contact: _Contact) -> Number:
    a, b = contact.a, contact.b
    pressed = contact.slant * r + s * contact.A * (r * r - contact.level)
    roots = lib.sqrt(r - a) * lib.sqrt(r + a) * lib.sqrt(b - r)
    return (pressed + abs(pressed)) / 2 / roots / lib.sqrt(b + r)  # below zero by rounding only


def _pressure_not_inside(lib: Library, r: Number, s: Number, contact: _Contact) -> Number:
    # at lift-off the outer corner of one side has no load
    carried = (
        contact.slant * r + s * contact.A * (r * r - contact.level) > ROUNDING * contact.slant * r
    )
    return pick(lib, ((r == contact.a) | (r == contact.b)) & carried, infinite, nothing, r)


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
