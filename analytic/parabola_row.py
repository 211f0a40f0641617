"""A row of equal parabolas of one piece, pressed on a half-plane without friction.

Each period L holds one, h = x²/(2R) for |x| <= L/2.

With the contacts |x - n L| <= a the pressure is that of rows of flats whose half-width s grows from
|x| to a, each under the increase of the mean pressure (Barber, Contact Mechanics, 2018, on rigid
punches superposed):

    mean pressure = (E* L/(2 pi R)) ln sec(pi a/L)
    p             = (E* L/(2 pi R)) arcosh(cos(pi x/L)/cos(pi a/L))
    Fp            = (E* L/(2 pi R)) (w - i arcosh(cos(w)/cos(pi a/L))),  w = pi z/L, |Re z| <= L/2

for ∫ tan(s) ds/sqrt(cos² x - cos² s) = arcosh(cos x/cos a)/cos x, s from x to a. The contacts never
meet: h has a ridge at x = ±L/2. For L >> a this is Hertz on one parabola.
"""

import numpy as np

from analytic._core.documentation import BARBER, WESTERGAARD, documented
from analytic._core.numbers import Library, Number, as_result
from analytic._core.parameters import positive, positives, real, refuse
from analytic._core.periodic_sines import in_period, sine
from analytic._core.piecewise import nothing, pick

SOURCES = (BARBER, WESTERGAARD)


@documented("the gap h, a length >= 0", *SOURCES)
def height(x: Number, *, radius: Number, period: Number, lib: Library = np) -> Number:
    """The undeformed gap h = x²/(2R), repeated.

    >>> float(height(5.0, radius=2.0, period=4.0))
    0.25
    """
    R, L = positives(lib, radius=radius, period=period)
    x = in_period(lib, real("x", x, lib), L)
    return as_result(x * (x / (2 * R)))


@documented("the slope h', a number", *SOURCES)
def slope(x: Number, *, radius: Number, period: Number, lib: Library = np) -> Number:
    """The slope h' = x/R, repeated.

    >>> float(slope(5.0, radius=2.0, period=4.0))
    0.5
    """
    R, L = positives(lib, radius=radius, period=period)
    return as_result(in_period(lib, real("x", x, lib), L) / R)


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, radius: Number, period: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The pressure p(x) on contacts of half-width a < L/2, and 0 between them.

    >>> found = pressure(4.0, half_width=1.0, radius=1.0, period=4.0, modulus=np.pi / 2)
    >>> round(float(found), 12)
    0.88137358702
    """
    a, L, scale = _contact(half_width, radius, period, modulus, lib)
    r = abs(in_period(lib, real("x", x, lib), L))
    return as_result(scale * pick(lib, r < a, _pressure_inside, nothing, r, a, L))


@documented("the mean pressure, a stress", *SOURCES)
def mean_pressure(
    *, half_width: Number, radius: Number, period: Number, modulus: Number, lib: Library = np
) -> Number:
    """The mean pressure (E* L/(2 pi R)) ln sec(pi a/L) at which the contacts have the half-width a.

    >>> found = mean_pressure(half_width=1.0, radius=1.0, period=4.0, modulus=np.pi)
    >>> round(float(found / np.log(2)), 12)
    1.0
    """
    a, L, scale = _contact(half_width, radius, period, modulus, lib)
    return as_result(scale * pick(lib, 4 * a <= L, _logarithm_near, _logarithm_far, a, L))


@documented("half the length of a contact, a length", *SOURCES)
def half_width(
    *, mean_pressure: Number, radius: Number, period: Number, modulus: Number, lib: Library = np
) -> Number:
    """The half-width a of each contact under a mean pressure p: the inverse of `mean_pressure`.

    a = (L/pi) arccos exp(-2 pi R p/(E* L)).

    >>> found = half_width(mean_pressure=np.log(2), radius=1.0, period=4.0, modulus=np.pi)
    >>> round(float(found), 12)
    1.0
    """
    p = positive("mean_pressure", mean_pressure, lib)
    L = positive("period", period, lib)
    ratio = p / _contact(L / 4, radius, L, modulus, lib)[2]
    # cos(pi a/L) = exp(-ratio), and the sine beside it without cancellation
    root = lib.sqrt(-lib.expm1(-2 * ratio))
    return as_result(2 * L / lib.pi * lib.atan(root / (1 + lib.exp(-ratio))))


def _contact(
    half_width: Number, radius: Number, period: Number, modulus: Number, lib: Library
) -> tuple[Number, Number, Number]:
    """a, L and E* L/(2 pi R)."""
    a, L = positives(lib, half_width=half_width, period=period)
    R, E = positives(lib, radius=radius, modulus=modulus)
    message = "half_width = {} is not less than period/2 = {}; give contacts that do not meet."
    refuse(2 * a >= L, message, a, L / 2)
    return a, L, E * (L / R) / (2 * lib.pi)


def _pressure_inside(lib: Library, r: Number, a: Number, L: Number) -> Number:
    """arcosh(1 + d), d = (cos(pi r/L) - cos(pi a/L))/cos(pi a/L) as a product."""
    d = 2 * sine(lib, (a - r) / 2, L) * sine(lib, (a + r) / 2, L) / sine(lib, L / 2 - a, L)
    return lib.log1p(d + lib.sqrt(d * (2 + d)))


def _logarithm_near(lib: Library, a: Number, L: Number) -> Number:
    """ln sec(pi a/L) where the cosine is next to 1."""
    s = sine(lib, a, L)
    return -lib.log1p(-s * s) / 2


def _logarithm_far(lib: Library, a: Number, L: Number) -> Number:
    return -lib.log(sine(lib, L / 2 - a, L))
