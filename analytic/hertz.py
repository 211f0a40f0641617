"""A parabola pressed on a half-plane: h = x²/(2R), the line contact of Hertz.

    p = E*/(2R) sqrt(b² - x²),      P = pi E* b²/(4R),      Fp = E*/(2R) (z - sqrt(z² - b²))

(Johnson, Contact Mechanics, 1985, section 4.2(c)). Fp(z) = (1/pi) ∫ p(t)/(z-t) dt is the potential
of the pressure.
"""

import numpy as np

from analytic._core.cut import in_plane, on_cut, root, seen_from
from analytic._core.documentation import JOHNSON, documented
from analytic._core.numbers import Library, Number, as_result, cartesian, scaled, sign
from analytic._core.parameters import point, positive, positives, real, representable
from analytic._core.piecewise import pick

SOURCES = (f"{JOHNSON}, section 4.2(c)",)


@documented("the gap h, a length >= 0", *SOURCES)
def height(x: Number, *, radius: Number, lib: Library = np) -> Number:
    """The undeformed gap h = x²/(2R).

    >>> float(height(2.0, radius=4.0))
    0.5
    """
    x, R = real("x", x, lib), positive("radius", radius, lib)
    return representable("height", lambda x: x * (x / (2 * R)), x)


@documented("the slope h', a number", *SOURCES)
def slope(x: Number, *, radius: Number, lib: Library = np) -> Number:
    """The slope h' = x/R.

    >>> float(slope(2.0, radius=4.0))
    0.5
    """
    return as_result(real("x", x, lib) / positive("radius", radius, lib))


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, radius: Number, modulus: Number, lib: Library = np
) -> Number:
    """The contact pressure p = E*/(2R) sqrt(b² - x²), and 0 outside (Johnson 1985, eq. 4.44).

    >>> float(pressure(0.6, half_width=1.0, radius=1.0, modulus=2.0))
    0.8
    """
    x, b, R, E = real("x", x, lib), *_contact(half_width, radius, modulus, lib)
    return as_result(E / (2 * R) * _ellipse(lib, x, b))


@documented("the normal load P per unit length, a force per length", *SOURCES)
def load(*, half_width: Number, radius: Number, modulus: Number, lib: Library = np) -> Number:
    """The normal load P = pi E* b²/(4R) per unit length (Johnson 1985, eq. 4.43).

    >>> round(float(load(half_width=1.0, radius=1.0, modulus=1.0)), 12)
    0.785398163397
    """
    b, R, E = _contact(half_width, radius, modulus, lib)
    return as_result(lib.pi / 4 * E * (b / R) * b)


@documented("half the length of the contact, a length", *SOURCES)
def half_width(
    *, normal_load: Number, radius: Number, modulus: Number, lib: Library = np
) -> Number:
    """The half-width b = sqrt(4 P R/(pi E*)): the inverse of `load`.

    >>> float(half_width(normal_load=np.pi, radius=1.0, modulus=1.0))
    2.0
    """
    P, R, E = positives(lib, normal_load=normal_load, radius=radius, modulus=modulus)
    return as_result(2 * (lib.sqrt(P / E) * lib.sqrt(R)) / lib.sqrt(lib.pi))


@documented("the largest pressure, a stress", *SOURCES)
def peak_pressure(
    *, half_width: Number, radius: Number, modulus: Number, lib: Library = np
) -> Number:
    """The largest pressure, p(0) = E* b/(2R) (Johnson 1985, eq. 4.45).

    >>> float(peak_pressure(half_width=1.0, radius=1.0, modulus=2.0))
    1.0
    """
    b, R, E = _contact(half_width, radius, modulus, lib)
    return as_result(E * (b / (2 * R)))


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, radius: Number, modulus: Number, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The potential Fp = E* b/(2R) rho, rho = b/(z + sqrt(z² - b²)), complex; ~ P/(pi z) far away.

    Real z in the contact are on the cut: there `side` = +1 gives the limit from the body y > 0,
    E*/2 h' - i p, and -1 its conjugate.

    >>> complex(potential(0.6, half_width=1.0, radius=1.0, modulus=2.0))
    (0.6-0.8j)
    """
    z, (b, R, E) = point(z, lib), _contact(half_width, radius, modulus, lib)
    value = in_plane(lib, on_cut(lib, z, b), side, _potential_on_cut, _potential, z, b)
    return as_result(scaled(E / (2 * R), value, lib))


@documented("the derivative Fp', a complex stress per length", *SOURCES)
def potential_derivative(
    z: Number, *, half_width: Number, radius: Number, modulus: Number, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The derivative Fp' = E*/(2R) (1 - z/sqrt(z² - b²)) of the potential.

    On the contact it is E*/(2R) - i p' on the side +1.

    At |x| = b, where p' is infinite, so is the imaginary part.

    >>> complex(potential_derivative(0.8, half_width=1.0, radius=1.0, modulus=1.5).round(12))
    (0.75+1j)
    """
    z, (b, R, E) = point(z, lib), _contact(half_width, radius, modulus, lib)
    value = in_plane(lib, on_cut(lib, z, b), side, _derivative_on_cut, _derivative, z, b)
    return as_result(scaled(E / (2 * R), value, lib))


def _contact(
    half_width: Number, radius: Number, modulus: Number, lib: Library
) -> tuple[Number, Number, Number]:
    return positives(lib, half_width=half_width, radius=radius, modulus=modulus)


def _ellipse(lib: Library, x: Number, b: Number) -> Number:
    """sqrt(b² - x²), and 0 outside.

    The roots are taken one by one, lest the product of lengths overflow.
    """
    inside = abs(x) < b
    return lib.sqrt((b - x) * inside) * lib.sqrt((b + x) * inside)


def _potential(lib: Library, z: Number, b: Number) -> Number:
    return b * (b / (z + root(lib, z, b)))  # z - sqrt(z² - b²) would cancel far away


def _potential_on_cut(lib: Library, z: Number, b: Number, *, side: int) -> Number:
    return cartesian(z.real, -seen_from(z, side) * _ellipse(lib, z.real, b), lib)


def _derivative(lib: Library, z: Number, b: Number) -> Number:
    s = root(lib, z, b)
    return -(b / s) * (b / (z + s))


def _derivative_on_cut(lib: Library, z: Number, b: Number, *, side: int) -> Number:
    x = z.real
    steepness = pick(lib, abs(x) < b, _steepness, _infinite, x, b)
    return cartesian(1 + 0 * x, seen_from(z, side) * steepness, lib)


def _steepness(lib: Library, x: Number, b: Number) -> Number:
    return x / _ellipse(lib, x, b)


def _infinite(lib: Library, x: Number, b: Number) -> Number:
    return lib.inf * sign(x)
