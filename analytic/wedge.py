"""A blunt wedge pressed on a half-plane: h = A |x|, with a small slope A.

    p = (E* A/pi) arccosh(b/|x|),      P = E* A b,      Fp = (E* A/pi) arcsin(b/z)

(Johnson, Contact Mechanics, 1985, section 5.2). The pressure is infinite, like a logarithm, at the
apex. Fp(z) = (1/pi) ∫ p(t)/(z-t) dt is the potential of the pressure: on the contact arcsin(b/x -
i0) = sign(x) pi/2 - i arccosh(b/|x|), so that Fp = E*/2 h' - i p, and far away Fp ~ E* A b/(pi z),
which together determine it.
"""

import numpy as np

from analytic._core.cut import in_plane, on_cut, root, seen_from
from analytic._core.documentation import JOHNSON, documented
from analytic._core.numbers import Library, Number, as_result, cartesian, scaled, sign
from analytic._core.parameters import point, positive, positives, real
from analytic._core.piecewise import infinite, pick

SOURCES = (f"{JOHNSON}, section 5.2",)


@documented("the gap h, a length >= 0", *SOURCES)
def height(x: Number, *, slope: Number, lib: Library = np) -> Number:
    """The undeformed gap h = A |x|.

    >>> float(height(-2.0, slope=0.25))
    0.5
    """
    return as_result(positive("slope", slope, lib) * abs(real("x", x, lib)))


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, slope: Number, modulus: Number, lib: Library = np
) -> Number:
    """The contact pressure p = (E* A/pi) arccosh(b/|x|), inf at x = 0, and 0 outside.

    The source is section 5.2 of Johnson (1985).

    >>> round(float(pressure(0.5, half_width=1.0, slope=0.1, modulus=10.0)), 12)
    0.419200718279
    """
    x, b, A, E = real("x", x, lib), *_contact(half_width, slope, modulus, lib)
    return as_result(E * A / lib.pi * _arccosh(lib, abs(x), b))


@documented("the normal load P per unit length, a force per length", *SOURCES)
def load(*, half_width: Number, slope: Number, modulus: Number, lib: Library = np) -> Number:
    """The normal load P = E* A b per unit length.

    >>> float(load(half_width=2.0, slope=0.1, modulus=10.0))
    2.0
    """
    b, A, E = _contact(half_width, slope, modulus, lib)
    return as_result(E * A * b)


@documented("half the length of the contact, a length", *SOURCES)
def half_width(*, normal_load: Number, slope: Number, modulus: Number, lib: Library = np) -> Number:
    """The half-width b = P/(E* A): the inverse of `load`.

    >>> float(half_width(normal_load=2.0, slope=0.1, modulus=10.0))
    2.0
    """
    P, A, E = positives(lib, normal_load=normal_load, slope=slope, modulus=modulus)
    return as_result(P / E / A)


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, slope: Number, modulus: Number, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The potential Fp = (E* A/pi) arcsin(b/z), complex; ~ P/(pi z) far away.

    Real z in the contact are on the cut: there `side` = +1 gives the limit from the body y > 0,
    E*/2 h' - i p, and -1 its conjugate. At z = 0 the imaginary part is infinite.

    >>> complex(potential(1.0, half_width=1.0, slope=0.1, modulus=10.0)).real
    0.5
    """
    z, (b, A, E) = point(z, lib), _contact(half_width, slope, modulus, lib)
    value = in_plane(lib, on_cut(lib, z, b), side, _potential_on_cut, _potential, z, b)
    return as_result(scaled(E * A / lib.pi, value, lib))


@documented("the derivative Fp', a complex stress per length", *SOURCES)
def potential_derivative(
    z: Number, *, half_width: Number, slope: Number, modulus: Number, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The derivative Fp' = -(E* A/pi) b/(z sqrt(z² - b²)); on the contact - i p' on the side +1.

    At |x| = b and x = 0, where p' is infinite, so is the imaginary part (at x = 0 it is the limit
    from x > 0).

    >>> found = potential_derivative(0.6, half_width=1.0, slope=0.1, modulus=np.pi * 10.0)
    >>> round(complex(found).imag, 12)
    2.083333333333
    """
    z, (b, A, E) = point(z, lib), _contact(half_width, slope, modulus, lib)
    value = in_plane(lib, on_cut(lib, z, b), side, _derivative_on_cut, _derivative, z, b)
    return as_result(scaled(E * (A / b) / lib.pi, value, lib))


def _contact(
    half_width: Number, slope: Number, modulus: Number, lib: Library
) -> tuple[Number, Number, Number]:
    return positives(lib, half_width=half_width, slope=slope, modulus=modulus)


def _arccosh(lib: Library, x: Number, b: Number) -> Number:
    """arccosh(b/x) at x >= 0, inf at 0, and 0 beyond b."""
    return pick(lib, x > 0, _arccosh_beside_apex, infinite, x, b)


def _arccosh_beside_apex(lib: Library, x: Number, b: Number) -> Number:
    """By arccosh(1+2s²) = 2 arsinh(s), which keeps the digits of b - x near the edge."""
    return 2 * lib.asinh(lib.sqrt((b - x) * (x < b)) / lib.sqrt(2 * x))


def _potential(lib: Library, z: Number, b: Number) -> Number:
    return lib.asin(b / z)


def _potential_on_cut(lib: Library, z: Number, b: Number, *, side: int) -> Number:
    x = z.real
    return cartesian(lib.pi / 2 * sign(x), -seen_from(z, side) * _arccosh(lib, abs(x), b), lib)


def _derivative(lib: Library, z: Number, b: Number) -> Number:
    return -(b / z) * (b / root(lib, z, b))


def _derivative_on_cut(lib: Library, z: Number, b: Number, *, side: int) -> Number:
    x = z.real
    steepness = pick(lib, (x != 0) & (abs(x) < b), _steepness, _infinite_steepness, x, b)
    return cartesian(0 * x, seen_from(z, side) * steepness, lib)


def _steepness(lib: Library, x: Number, b: Number) -> Number:
    """-pi b p'/(E* A)."""
    return (b / x) * (b / (lib.sqrt(b - x) * lib.sqrt(b + x)))


def _infinite_steepness(lib: Library, x: Number, b: Number) -> Number:
    return lib.inf * ((x >= 0) * 2 - 1)
