"""A row of equal rigid flats, pressed on a half-plane at one height without friction.

Each period L holds one flat of half-width a.

With w = pi z/L and S = sin(pi a/L) (Westergaard 1939, whose row of cracks this is with the sign
changed)

    p  = mean pressure cos(pi x/L)/sqrt(S² - sin²(pi x/L))
    Fp = mean pressure cot(w)/sqrt(1 - S²/sin²(w))

Fp(z) = (1/L) ∫ p(t) cot(pi (z-t)/L) dt over one period is the potential: it sums 1/(pi (z-t)) over
all flats. The load on each is L times the mean pressure. For L >> a this is a single flat.
"""

import numpy as np

from analytic._core.cut import in_plane, on_cut, seen_from
from analytic._core.documentation import WESTERGAARD, documented
from analytic._core.numbers import Library, Number, as_result, cartesian, scaled
from analytic._core.parameters import point, positive, positives, real, refuse
from analytic._core.periodic_sines import cotangent, in_period, one_minus_square, sine
from analytic._core.piecewise import infinite, nothing, pick

SOURCES = (WESTERGAARD,)


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, period: Number, mean_pressure: Number, lib: Library = np
) -> Number:
    """The pressure p(x) under the flats, inf at their corners, and 0 between them.

    >>> round(float(pressure(8.0, half_width=1.0, period=4.0, mean_pressure=1.0)), 12)
    1.414213562373
    """
    a, L, p = _contact(half_width, period, mean_pressure, lib)
    return as_result(p * _pressure(lib, abs(in_period(lib, real("x", x, lib), L)), a, L))


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, period: Number, mean_pressure: Number, side: int = +1,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The complex potential Fp(z) of the row.

    The potential is - i mean pressure far above, and + i mean pressure far below the surface.

    Real z under the flats are on cuts: there `side` = +1 gives the limit from the body y > 0, - i
    p, and -1 its conjugate. Between the flats it is real, E*/2 times the slope of the surface.

    >>> round(complex(potential(0.0, half_width=1.0, period=4.0, mean_pressure=1.0)).imag, 12)
    -1.414213562373
    """
    z, (a, L, p) = point(z, lib), _contact(half_width, period, mean_pressure, lib)
    z = cartesian(in_period(lib, z.real, L), z.imag, lib)
    value = in_plane(lib, on_cut(lib, z, a), side, _potential_on_cut, _potential, z, a, L)
    return as_result(scaled(p, value, lib))


def _contact(
    half_width: Number, period: Number, mean_pressure: Number, lib: Library
) -> tuple[Number, Number, Number]:
    a, L = positives(lib, half_width=half_width, period=period)
    message = "half_width = {} is not less than period/2 = {}; give flats with gaps between them."
    refuse(2 * a >= L, message, a, L / 2)
    return a, L, positive("mean_pressure", mean_pressure, lib)


def _pressure(lib: Library, r: Number, a: Number, L: Number) -> Number:
    return pick(lib, r < a, _pressure_inside, _pressure_not_inside, r, a, L)


def _pressure_inside(lib: Library, r: Number, a: Number, L: Number) -> Number:
    total = a + r
    rest = (L / 2 - a) + (L / 2 - r)  # sin(pi (a+r)/L) is that of the shorter
    shorter = (total <= L / 2) * total + (total > L / 2) * rest
    return sine(lib, L / 2 - r, L) / lib.sqrt(sine(lib, a - r, L)) / lib.sqrt(sine(lib, shorter, L))


def _pressure_not_inside(lib: Library, r: Number, a: Number, L: Number) -> Number:
    return pick(lib, r == a, infinite, nothing, r)


def _potential(lib: Library, z: Number, a: Number, L: Number) -> Number:
    return cotangent(lib, z, L) / lib.sqrt(one_minus_square(lib, z, a, L))


def _potential_on_cut(lib: Library, z: Number, a: Number, L: Number, *, side: int) -> Number:
    return cartesian(0 * z.real, -seen_from(z, side) * _pressure(lib, abs(z.real), a, L), lib)
