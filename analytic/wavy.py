"""A wavy surface of one wavelength pressed on a half-plane, with a contact on each crest.

h = D (1 - cos(2 pi x/lambda)).

With w = pi z/lambda and S = sin(pi a/lambda), the contacts are |x - n lambda| <= a (Westergaard
1939; Johnson, Contact Mechanics, 1985, section 13.2), and

    p  = (2 pi E* D/lambda) cos(pi x/lambda) sqrt(S² - sin²(pi x/lambda))
    mean pressure = (pi E* D/lambda) S²
    Fp = (2 pi E* D/lambda) cot(w) S²/(1 + sqrt(1 - S²/sin²(w)))

From the mean pressure pi E* D/lambda on the surfaces touch everywhere, p = mean pressure + (pi E*
D/lambda) cos(2 pi x/lambda). Fp(z) = (1/lambda) ∫ p(t) cot(pi (z-t)/lambda) dt over one period is
the potential: it sums 1/(pi (z-t)) over all contacts, and far from the surface it is - i mean
pressure.
"""

import numpy as np

from analytic._core.cut import in_plane, on_cut, seen_from
from analytic._core.documentation import JOHNSON, WESTERGAARD, documented
from analytic._core.numbers import Library, Number, as_result, cartesian, scaled
from analytic._core.parameters import point, positives, real, refuse
from analytic._core.periodic_sines import cotangent, in_period, one_minus_square, sine
from analytic._core.piecewise import nothing, pick

SOURCES = (
    WESTERGAARD,
    f"{JOHNSON}, section 13.2",
)


@documented("the gap h, a length >= 0", *SOURCES)
def height(x: Number, *, wavelength: Number, amplitude: Number, lib: Library = np) -> Number:
    """The undeformed gap h = D (1 - cos(2 pi x/lambda)), without cancellation at the crests.

    >>> float(height(1.0, wavelength=2.0, amplitude=0.25))
    0.5
    """
    L, D = positives(lib, wavelength=wavelength, amplitude=amplitude)
    s = sine(lib, in_period(lib, real("x", x, lib), L), L)
    return as_result(2 * D * s * s)


@documented("the slope h', a number", *SOURCES)
def slope(x: Number, *, wavelength: Number, amplitude: Number, lib: Library = np) -> Number:
    """The slope h' = (2 pi D/lambda) sin(2 pi x/lambda).

    >>> round(float(slope(0.5, wavelength=2.0, amplitude=1 / np.pi)), 12)
    1.0
    """
    L, D = positives(lib, wavelength=wavelength, amplitude=amplitude)
    x = in_period(lib, real("x", x, lib), L)
    return as_result(4 * lib.pi * (D / L) * sine(lib, x, L) * sine(lib, L / 2 - abs(x), L))


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, wavelength: Number, amplitude: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The pressure p(x) on contacts of half-width a <= lambda/2, and 0 between them.

    >>> found = pressure(4.0, half_width=0.5, wavelength=4.0, amplitude=1.0, modulus=2 / np.pi)
    >>> round(float(found), 12)
    0.382683432365
    """
    a, L, p1 = _contact(half_width, wavelength, amplitude, modulus, lib=lib)
    return as_result(2 * p1 * _pressure(lib, in_period(lib, real("x", x, lib), L), a, L))


@documented("the mean pressure, a stress", *SOURCES)
def mean_pressure(
    *, half_width: Number, wavelength: Number, amplitude: Number, modulus: Number, lib: Library = np
) -> Number:
    """The mean pressure at which the contacts have the half-width a.

    The mean pressure is (pi E* D/lambda) sin²(pi a/lambda).

    >>> found = mean_pressure(half_width=1.0, wavelength=4.0, amplitude=4 / np.pi, modulus=1.0)
    >>> round(float(found), 12)
    0.5
    """
    a, L, p1 = _contact(half_width, wavelength, amplitude, modulus, lib=lib)
    S = sine(lib, a, L)
    return as_result(p1 * S * S)


@documented("half the length of the contact, a length", *SOURCES)
def half_width(
    *, mean_pressure: Number, wavelength: Number, amplitude: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The half-width a of each contact under a mean pressure up to pi E* D/lambda.

    The function is the inverse of `mean_pressure`.

    a = (lambda/pi) atan sqrt(r/(1-r)), r the part of the pressure of complete contact. ValueError
    for larger pressures.

    >>> found = half_width(mean_pressure=0.5, wavelength=4.0, amplitude=4 / np.pi, modulus=1.0)
    >>> round(float(found), 12)
    1.0
    """
    L, p, whole = _closing(mean_pressure, wavelength, amplitude, modulus, lib=lib)
    message = (
        "mean_pressure = {} exceeds closing_pressure = {}: the surfaces touch everywhere; "
        "use complete_pressure."
    )
    refuse(p > whole, message, p, whole)
    return as_result(L / lib.pi * _arcsine(lib, lib.sqrt(p / whole), lib.sqrt((whole - p) / whole)))


@documented("the mean pressure, a stress", *SOURCES)
def closing_pressure(
    *, wavelength: Number, amplitude: Number, modulus: Number, lib: Library = np
) -> Number:
    """The least mean pressure pi E* D/lambda at which the surfaces touch everywhere.

    >>> round(float(closing_pressure(wavelength=1.0, amplitude=1 / np.pi, modulus=3.0)), 12)
    3.0
    """
    return as_result(_contact(1, wavelength, amplitude, modulus, lib=lib, bounded=False)[2])


@documented("the pressure p, a stress", *SOURCES)
def complete_pressure(
    x: Number, *, mean_pressure: Number, wavelength: Number, amplitude: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The pressure of surfaces that touch everywhere.

    The pressure is mean pressure + (pi E* D/lambda) cos(2 pi x/lambda).

    ValueError for mean pressures below `closing_pressure`.

    >>> found = complete_pressure(0.5, mean_pressure=4.0, wavelength=1.0, amplitude=1 / np.pi,
    ...                           modulus=3.0)
    >>> round(float(found), 12)
    1.0
    """
    L, p, whole = _closing(mean_pressure, wavelength, amplitude, modulus, lib=lib)
    message = (
        "mean_pressure = {} is less than closing_pressure = {}: the troughs are open; use pressure."
    )
    refuse(p < whole, message, p, whole)
    x = in_period(lib, real("x", x, lib), L)
    c = sine(lib, L / 2 - abs(x), L)  # cos(pi x/lambda)
    return as_result((p - whole) + 2 * whole * c * c)


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, wavelength: Number, amplitude: Number, modulus: Number,
    side: int = +1, lib: Library = np,
) -> Number:  # fmt: skip
    """The complex potential Fp(z) of the contacts.

    The potential is - i mean pressure far above, and + i mean pressure far below the surface.

    Real z in the contacts are on cuts: there `side` = +1 gives the limit from the body y > 0, E*/2
    h' - i p, and -1 its conjugate.

    >>> found = potential(1.0, half_width=1.0, wavelength=4.0, amplitude=2 / np.pi, modulus=1.0)
    >>> round(complex(found).real, 12)
    0.5
    """
    z = point(z, lib)
    a, L, p1 = _contact(half_width, wavelength, amplitude, modulus, lib=lib)
    z = cartesian(in_period(lib, z.real, L), z.imag, lib)
    value = in_plane(lib, on_cut(lib, z, a), side, _potential_on_cut, _potential, z, a, L)
    return as_result(scaled(p1, value, lib))


def _closing(
    mean_pressure: Number, wavelength: Number, amplitude: Number, modulus: Number, *, lib: Library
) -> tuple[Number, Number, Number]:
    """lambda, the mean pressure, and the one at which the surfaces touch everywhere."""
    L, p = positives(lib, wavelength=wavelength, mean_pressure=mean_pressure)
    return L, p, closing_pressure(wavelength=L, amplitude=amplitude, modulus=modulus, lib=lib)


def _contact(
    half_width: Number, wavelength: Number, amplitude: Number, modulus: Number, *, lib: Library,
    bounded: bool = True,
) -> tuple[Number, Number, Number]:  # fmt: skip
    """a, lambda and pi E* D/lambda."""
    a, L = positives(lib, half_width=half_width, wavelength=wavelength)
    D, E = positives(lib, amplitude=amplitude, modulus=modulus)
    if bounded:
        message = "half_width = {} exceeds wavelength/2 = {}; give the half-width of one contact."
        refuse(2 * a > L, message, a, L / 2)
    return a, L, lib.pi * E * (D / L)


def _arcsine(lib: Library, sine: Number, cosine: Number) -> Number:
    """The angle from 0 to pi/2, of both."""
    return 2 * lib.atan(sine / (1 + cosine))


def _pressure(lib: Library, x: Number, a: Number, L: Number) -> Number:
    """p/(2 pi E* D/lambda) for |x| <= lambda/2."""
    return pick(lib, abs(x) < a, _pressure_inside, nothing, abs(x), a, L)


def _pressure_inside(lib: Library, r: Number, a: Number, L: Number) -> Number:
    sum_of_both = pick(lib, a + r > L / 2, _sine_of_rest, _sine_of_sum, r, a, L)
    cosine = sine(lib, L / 2 - r, L)
    return cosine * lib.sqrt(sine(lib, a - r, L)) * lib.sqrt(sum_of_both)


def _sine_of_sum(lib: Library, r: Number, a: Number, L: Number) -> Number:
    return sine(lib, a + r, L)


def _sine_of_rest(lib: Library, r: Number, a: Number, L: Number) -> Number:
    return sine(lib, (L / 2 - a) + (L / 2 - r), L)


def _potential(lib: Library, z: Number, a: Number, L: Number) -> Number:
    """Fp/(pi E* D/lambda)."""
    S = sine(lib, a, L)
    return 2 * S * S * cotangent(lib, z, L) / (1 + lib.sqrt(one_minus_square(lib, z, a, L)))


def _potential_on_cut(lib: Library, z: Number, a: Number, L: Number, *, side: int) -> Number:
    x = z.real
    tilt = 2 * sine(lib, x, L) * sine(lib, L / 2 - abs(x), L)
    return cartesian(tilt, -seen_from(z, side) * 2 * _pressure(lib, x, a, L), lib)
