"""A flat with sharp corners at x = ±b, pressed on a half-plane, straight or tilted, h' = tilt.

While both corners touch (Muskhelishvili 1953, part V; Johnson, Contact Mechanics, 1985, section
2.8)

    p = (P + 2 M x/b²)/(pi sqrt(b² - x²)),      M = -pi E* b² tilt/4,      |M| <= P b/2
    Fp = [ P + (2M/b) rho ]/(pi sqrt(z² - b²)),      rho = b/(z + sqrt(z² - b²))

with M = ∫ p x dx. Beyond |M| = P b/2 the pressure would be negative at one corner: that end lifts
off, and the contact is the interval of length 2r from the other corner at x = s b, s = sign(M), on
which

    p = P/(pi r) sqrt((r + t)/(r - t)),   t = s x - (b - r)
    r = 2(b - |M|/P),      tilt = -2 s P/(pi E* r).

The functions of that contact carry the word `partial`. Fp(z) = (1/pi) ∫ p(t)/(z-t) dt is the
potential of the pressure.
"""

import sys
from typing import NamedTuple

import numpy as np

from analytic._core.cut import in_plane, on_cut, root, seen_from
from analytic._core.documentation import JOHNSON, MUSKHELISHVILI, documented
from analytic._core.numbers import (
    Library,
    Number,
    as_result,
    cartesian,
    not_below_zero,
    scaled,
    sign,
)
from analytic._core.parameters import point, positive, positives, real, refuse
from analytic._core.piecewise import infinite, nothing, pick

SOURCES = (
    f"{MUSKHELISHVILI}, part V",
    f"{JOHNSON}, section 2.8",
)

# A moment or tilt that passes the limit of lift-off by no more than its own rounding is taken to be
# at the limit.
ROUNDING = 8 * sys.float_info.epsilon


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, normal_load: Number, moment: Number = 0, lib: Library = np
) -> Number:
    """The pressure p = (P + 2Mx/b²)/(pi sqrt(b² - x²)) of a complete contact.

    The pressure is inf at the corners, and 0 outside.

    With |M| = P b/2 exactly p is 0, not infinite, at the corner about to lift. ValueError for |M| >
    P b/2.

    >>> round(float(pressure(0.6, half_width=1.0, normal_load=np.pi, moment=np.pi / 2)), 12)
    2.0
    """
    x, (b, corners) = real("x", x, lib), _complete(half_width, normal_load, moment, lib)
    return as_result(_pressure(lib, x, b, corners) / (lib.pi * b))


@documented("the rotation h', in radians", *SOURCES)
def tilt(
    *, half_width: Number, normal_load: Number, moment: Number, modulus: Number, lib: Library = np
) -> Number:
    """The tilt h' = -4M/(pi E* b²) of a complete contact under the moment M.

    ValueError for |M| > P b/2; then see `partial_tilt`.

    >>> round(float(tilt(half_width=1.0, normal_load=np.pi, moment=np.pi / 4, modulus=1.0)), 12)
    -1.0
    """
    b, _, M = _checked(half_width, normal_load, moment, lib)
    return as_result(-4 * (M / b) / b / positive("modulus", modulus, lib) / lib.pi)


@documented("the moment M, a force", *SOURCES)
def moment(
    *, half_width: Number, normal_load: Number, tilt: Number, modulus: Number, lib: Library = np
) -> Number:
    """The moment M = -pi E* b² tilt/4 that holds a complete contact at the tilt h' = tilt.

    ValueError for |tilt| > 2P/(pi E* b); then see `partial_moment`.

    >>> round(float(moment(half_width=1.0, normal_load=np.pi, tilt=-1.0, modulus=1.0) / np.pi), 12)
    0.25
    """
    (b, E), angle = positives(lib, half_width=half_width, modulus=modulus), real("tilt", tilt, lib)
    M = -lib.pi / 4 * (E * b * angle) * b
    return as_result(_checked(b, normal_load, M, lib)[2])


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, normal_load: Number, moment: Number = 0, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The complex potential Fp = [P + (2M/b) rho]/(pi sqrt(z² - b²)) of a complete contact.

    Far away it is ~ P/(pi z).

    Real z in the contact are on the cut: there `side` = +1 gives the limit from the body y > 0,
    E*/2 h' - i p, and -1 its conjugate. ValueError for |M| > P b/2.

    >>> complex(potential(0.6, half_width=1.0, normal_load=np.pi)).imag
    -1.25
    """
    z, (b, corners) = point(z, lib), _complete(half_width, normal_load, moment, lib)
    value = in_plane(lib, on_cut(lib, z, b), side, _potential_on_cut, _potential, z, b, corners)
    return as_result(scaled(1 / (lib.pi * b), value, lib))


@documented("the derivative Fp', a complex stress per length", *SOURCES)
def potential_derivative(
    z: Number, *, half_width: Number, normal_load: Number, moment: Number = 0, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The derivative Fp' of the potential of a complete contact.

    On the contact it is - i p' on the side +1.

    At |x| = b, where p' is infinite, so is the imaginary part. ValueError for |M| > P b/2.

    >>> round(complex(potential_derivative(0.6, half_width=1.0, normal_load=np.pi)).imag, 12)
    -1.171875
    """
    z, (b, corners) = point(z, lib), _complete(half_width, normal_load, moment, lib)
    value = in_plane(lib, on_cut(lib, z, b), side, _derivative_on_cut, _derivative, z, b, corners)
    return as_result(scaled(1 / (lib.pi * b) / b, value, lib))


@documented("the ends (x1, x2) of the contact, lengths", *SOURCES)
def partial_edges(
    *, half_width: Number, normal_load: Number, moment: Number, lib: Library = np
) -> tuple[Number, Number]:
    """The ends (x1, x2) of the contact of a tilted flat that touches with one corner.

    One corner touches alone for P b/2 <= |M| < P b.

    ValueError for moments outside that range.

    >>> tuple(map(float, partial_edges(half_width=1.0, normal_load=1.0, moment=0.75)))
    (0.0, 1.0)
    """
    b, _, s, r = _one_corner(half_width, normal_load, moment, lib)
    return as_result(pick(lib, s > 0, _inner, _corner, b, r)), as_result(
        -pick(lib, s < 0, _inner, _corner, b, r)
    )


@documented("the pressure p, a stress", *SOURCES)
def partial_pressure(
    x: Number, *, half_width: Number, normal_load: Number, moment: Number, lib: Library = np
) -> Number:
    """The pressure p = P/(pi r) sqrt((r+t)/(r-t)) of a tilted flat that touches with one corner.

    At that corner the pressure is inf.

    t = s x - (b - r) is measured from the middle of the contact towards the corner. 0 outside.
    ValueError for moments outside P b/2 <= |M| < P b.

    >>> found = partial_pressure(0.5, half_width=1.0, normal_load=np.pi, moment=0.75 * np.pi)
    >>> round(float(found), 12)
    2.0
    """
    x, (b, P, s, r) = real("x", x, lib), _one_corner(half_width, normal_load, moment, lib)
    # Distances from the corner and from the smooth edge, the two roots of the pressure.
    from_corner = b - s * x
    from_edge = 2 * r - from_corner
    value = pick(
        lib, (from_corner >= 0) & (from_edge > 0), _one_sided, nothing, from_corner, from_edge
    )
    return as_result(P / lib.pi / r * value)


@documented("the rotation h', in radians", *SOURCES)
def partial_tilt(
    *, half_width: Number, normal_load: Number, moment: Number, modulus: Number, lib: Library = np
) -> Number:
    """The tilt h' = -2 s P/(pi E* r) of a flat that touches with one corner, P b/2 <= |M| < P b.

    >>> found = partial_tilt(half_width=1.0, normal_load=np.pi, moment=0.75 * np.pi, modulus=1.0)
    >>> round(float(found), 12)
    -4.0
    """
    _, P, s, r = _one_corner(half_width, normal_load, moment, lib)
    return as_result(-2 * s * (P / r) / positive("modulus", modulus, lib) / lib.pi)


@documented("the moment M, a force", *SOURCES)
def partial_moment(
    *, half_width: Number, normal_load: Number, tilt: Number, modulus: Number, lib: Library = np
) -> Number:
    """The moment that holds a flat on one corner at the tilt h' = tilt.

    The moment is M = s P (b - r/2), r = 2P/(pi E* |tilt|).

    ValueError for |tilt| < 2P/(pi E* b), at which both corners touch.

    >>> found = partial_moment(half_width=1.0, normal_load=np.pi, tilt=-4.0, modulus=1.0)
    >>> round(float(found / np.pi), 12)
    0.75
    """
    b, P, E = positives(lib, half_width=half_width, normal_load=normal_load, modulus=modulus)
    angle = real("tilt", tilt, lib)
    least = 2 * (P / E / b) / lib.pi
    remedy = (
        "|tilt| = {} is less than 2P/(pi E* b) = {}: both corners touch; "
        "use moment, or a larger tilt."
    )
    refuse(abs(angle) * (1 + ROUNDING) < least, remedy, abs(angle), least)
    return as_result(-sign(angle) * P * (b - P / E / lib.pi / abs(angle)))


@documented("the potential Fp, a complex stress", *SOURCES)
def partial_potential(
    z: Number, *, half_width: Number, normal_load: Number, moment: Number, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The potential Fp of a tilted flat that touches with one corner, complex; ~ P/(pi z) far away.

    It is that of a complete contact of half-width r about its own middle, with the moment s P r/2.
    `side` as in `potential`. ValueError for moments outside P b/2 <= |M| < P b.

    >>> found = partial_potential(0.5, half_width=1.0, normal_load=np.pi, moment=0.75 * np.pi)
    >>> round(complex(found).real, 12)
    -2.0
    """
    z, (b, P, s, r) = point(z, lib), _one_corner(half_width, normal_load, moment, lib)
    return potential(
        z - s * (b - r), half_width=r, normal_load=P, moment=s * P * r / 2, side=side, lib=lib
    )


class _Corners(NamedTuple):
    """The shares P/2 ± M/b of the load that belong to the corners.

    In them p is a sum of positive terms.
    """

    right: Number
    left: Number


def _pressed(
    half_width: Number, normal_load: Number, moment: Number, lib: Library
) -> tuple[tuple[Number, Number, Number], Number]:
    """(b, P, M) and the lever |M|/P of the load."""
    b, P = positives(lib, half_width=half_width, normal_load=normal_load)
    M = real("moment", moment, lib)
    return (b, P, M), abs(M) / P


def _checked(
    half_width: Number, normal_load: Number, moment: Number, lib: Library
) -> tuple[Number, Number, Number]:
    (b, P, M), lever = _pressed(half_width, normal_load, moment, lib)
    remedy = (
        "|M|/P = {} exceeds half_width/2 = {}: one corner lifts off; "
        "use partial_pressure, ..., or a smaller M."
    )
    refuse(lever > b / 2 * (1 + ROUNDING), remedy, lever, b / 2)
    return b, P, M


def _complete(
    half_width: Number, normal_load: Number, moment: Number, lib: Library
) -> tuple[Number, "_Corners"]:
    """b and the corners' shares of the load."""
    b, P, M = _checked(half_width, normal_load, moment, lib)
    return b, _Corners(not_below_zero(P / 2 + M / b), not_below_zero(P / 2 - M / b))


def _one_corner(
    half_width: Number, normal_load: Number, moment: Number, lib: Library
) -> tuple[Number, Number, Number, Number]:
    """b, P, the sign s of the corner that touches, and the contact's half-width r."""
    (b, P, M), lever = _pressed(half_width, normal_load, moment, lib)
    few = (
        "|M|/P = {} is less than half_width/2 = {}: both corners touch; "
        "use pressure, ..., or a larger M."
    )
    refuse(lever * (1 + ROUNDING) < b / 2, few, lever, b / 2)
    many = (
        "|M|/P = {} is not less than half_width = {}: the flat would tip over its corner; "
        "use a smaller M."
    )
    refuse(lever >= b, many, lever, b)
    return b, P, sign(M), b - not_below_zero(2 * lever - b)


def _inner(lib: Library, b: Number, r: Number) -> Number:
    return b - 2 * r


def _corner(lib: Library, b: Number, r: Number) -> Number:
    return -b


def _pressure(lib: Library, x: Number, b: Number, corners: _Corners) -> Number:
    """pi b p."""
    return pick(lib, abs(x) < b, _pressure_inside, _pressure_not_inside, x, b, corners)


def _pressure_inside(lib: Library, x: Number, b: Number, corners: _Corners) -> Number:
    V = lib.sqrt(b + x) / lib.sqrt(b - x)
    return corners.right * V + corners.left / V


def _pressure_not_inside(lib: Library, x: Number, b: Number, corners: _Corners) -> Number:
    pressed = ((x == b) & (corners.right > 0)) | ((x == -b) & (corners.left > 0))
    return pick(lib, pressed, infinite, nothing, x, b, corners)


def _one_sided(lib: Library, from_corner: Number, from_edge: Number) -> Number:
    return pick(lib, from_corner > 0, _one_sided_inside, infinite, from_corner, from_edge)


def _one_sided_inside(lib: Library, from_corner: Number, from_edge: Number) -> Number:
    return lib.sqrt(from_edge) / lib.sqrt(from_corner)


def _potential(lib: Library, z: Number, b: Number, corners: _Corners) -> Number:
    """pi b Fp as right (v - 1) + left (1 - 1/v).

    v - 1 = rho (v + 1) has no cancellation far away.
    """
    v = lib.sqrt(z + b) / lib.sqrt(z - b)
    return b / (z + root(lib, z, b)) * (corners.right * (1 + v) + corners.left * (1 + 1 / v))


def _potential_on_cut(
    lib: Library, z: Number, b: Number, corners: _Corners, *, side: int
) -> Number:
    x = z.real
    return cartesian(
        corners.left - corners.right + 0 * x,
        -seen_from(z, side) * _pressure(lib, x, b, corners),
        lib,
    )


def _derivative(lib: Library, z: Number, b: Number, corners: _Corners) -> Number:
    """pi b² Fp'."""
    v, s = lib.sqrt(z + b) / lib.sqrt(z - b), b / root(lib, z, b)
    return -s * s * (corners.right * v + corners.left / v)


def _derivative_on_cut(
    lib: Library, z: Number, b: Number, corners: _Corners, *, side: int
) -> Number:
    x = z.real
    steepness = pick(lib, abs(x) < b, _steepness, _infinite_steepness, x, b, corners)
    return cartesian(0 * x, -seen_from(z, side) * steepness, lib)


def _steepness(lib: Library, x: Number, b: Number, corners: _Corners) -> Number:
    """pi b² p'."""
    V = lib.sqrt(b + x) / lib.sqrt(b - x)
    return (b / (b - x)) * (b / (b + x)) * (corners.right * V - corners.left / V)


def _infinite_steepness(lib: Library, x: Number, b: Number, corners: _Corners) -> Number:
    """±inf, the infinite p' towards a corner, where p rises to infinity.

    If that corner is about to lift, p falls to 0 like a square root.
    """
    rises = ((x > 0) & (corners.right > 0)) | ((x < 0) & (corners.left == 0))
    return lib.inf * (2 * rises - 1)
