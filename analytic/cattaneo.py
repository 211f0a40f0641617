"""Cattaneo and Mindlin: partial slip of a parabola under a constant load P.

The tangential load rises, falls and rises again.

Similar bodies (beta = 0). The contact [-b, b] is that of Hertz; while Q < f P it sticks on [-c, c]
(Cattaneo 1938; Mindlin 1949; Johnson, Contact Mechanics, 1985, section 7.2),

    c = b sqrt(1 - Q/(fP)),      q = f p_b - f p_c,      p_c = (2P/(pi b²)) sqrt(c² - x²)

After Q_max has turned, q(Q) = q(Q_max) - 2 q((Q_max - Q)/2), and after Q_min, q(Q) = q(Q_min) + 2
q((Q - Q_min)/2), each q on the right that of a first loading. With r = Q/(fP), and B = 1 - (1-y²)
artanh(y)/y:

    slip        s  = (2fP/(pi E* b²)) (|x| sqrt(x² - c²) - c² arccosh(|x|/c)),   c < |x| < b
    shift       of the bodies beyond that of full stick: (fP/(pi E*)) [r + (1-r) ln(1-r)]
    energy      lost in a cycle between ±Q: (2f²P²/(pi E*)) [1 - m² + 2 m ln(m)], m = 1 - r
                which is (2f²P²/(pi E*)) r (2-r) B(r/(2-r))

A bulk tension sigma in the half-plane moves the stick zone to [e - c, e + c], e = pi sigma b²/(8fP)
(Nowell & Hills 1987). All of it is written without differences of what is nearly equal, for Q/(fP)
from 0 to 1.
"""

from typing import NamedTuple

import numpy as np

from analytic._core.arc_functions import B
from analytic._core.documentation import JOHNSON, documented
from analytic._core.numbers import Library, Number, as_result
from analytic._core.parameters import positive, positives, real, refuse
from analytic._core.piecewise import nothing, pick
from analytic._core.tangential_load import Traction, traction, turned, turned_twice

SOURCES = (
    "C. Cattaneo (1938) and R. D. Mindlin (1949)",
    f"{JOHNSON}, section 7.2",
)


@documented("half the length of the stick zone, a length", *SOURCES)
def stick_half_width(
    *, half_width: Number, normal_load: Number, friction: Number, tangential_load: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The half-width c = b sqrt(1 - Q/(fP)) of the stick zone; 0 at Q = fP.

    >>> float(stick_half_width(half_width=1.0, normal_load=4.0, friction=0.5, tangential_load=1.5))
    0.5
    """
    b = positive("half_width", half_width, lib)
    return as_result(b * lib.sqrt(traction(lib, friction, normal_load, tangential_load).left))


@documented("the length of a slip zone", *SOURCES)
def slip_width(
    *, half_width: Number, normal_load: Number, friction: Number, tangential_load: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The length b - c of each slip zone, to full relative accuracy.

    >>> args = {"half_width": 1.0, "normal_load": 4.0, "friction": 0.5}
    >>> float(slip_width(**args, tangential_load=2.0**-70)) == 2.0**-72
    True
    """
    b = positive("half_width", half_width, lib)
    return as_result(_slip_width(lib, b, traction(lib, friction, normal_load, tangential_load)))


@documented("the shear q, a stress", *SOURCES)
def shear(
    x: Number, *, half_width: Number, normal_load: Number, friction: Number,
    tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) while Q rises from 0: f p in the slip zones, f (p_b - p_c) in the stick zone.

    ValueError for Q > f P.

    >>> found = shear(0.0, half_width=1.0, normal_load=np.pi, friction=0.5,
    ...               tangential_load=0.375 * np.pi)
    >>> round(float(found), 12)
    0.5
    """
    x, b, scale = _traction_of_hertz(x, half_width, normal_load, friction, lib)
    used = traction(lib, friction, normal_load, tangential_load)
    return as_result(scale * _ellipses(lib, x, b, used))


@documented("the shear q, a stress", *SOURCES)
def unloading_shear(
    x: Number, *, half_width: Number, normal_load: Number, friction: Number, largest_load: Number,
    tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) when Q has fallen from Q_max to Q >= -Q_max.

    ValueError for loads out of order.

    >>> given = dict(half_width=1.0, normal_load=np.pi, friction=0.5, largest_load=0.375 * np.pi)
    >>> round(float(unloading_shear(0.0, **given, tangential_load=-0.375 * np.pi)), 12)
    -0.5
    """
    x, b, scale = _traction_of_hertz(x, half_width, normal_load, friction, lib)
    top, down = turned(lib, friction, normal_load, largest_load, tangential_load)
    return as_result(scale * (_ellipses(lib, x, b, top) - 2 * _ellipses(lib, x, b, down)))


@documented("the shear q, a stress", *SOURCES)
def reloading_shear(
    x: Number, *, half_width: Number, normal_load: Number, friction: Number, largest_load: Number,
    least_load: Number, tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) when Q, after a fall from Q_max to Q_min, has risen again.

    Q_min >= -Q_max, and Q <= Q_max.

    ValueError for loads out of order.

    >>> given = dict(half_width=1.0, normal_load=np.pi, friction=0.5, largest_load=0.375 * np.pi,
    ...              least_load=-0.5)
    >>> round(float(reloading_shear(0.0, **given, tangential_load=0.375 * np.pi)), 12)
    0.5
    """
    x, b, scale = _traction_of_hertz(x, half_width, normal_load, friction, lib)
    loads = (largest_load, least_load, tangential_load)
    first, down, up = (
        _ellipses(lib, x, b, used) for used in turned_twice(lib, friction, normal_load, loads)
    )
    return as_result(scale * (first - 2 * down + 2 * up))


@documented("the slip s, a length >= 0", *SOURCES)
def slip(
    x: Number, *, half_width: Number, normal_load: Number, friction: Number,
    tangential_load: Number, modulus: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The slip s(x) >= 0 of the indenter over the half-plane towards +x while Q rose from 0.

    s' = sign(x) (4fP/(pi E* b²)) sqrt(x² - c²), s = 0 where they stick, and, by agreement, where
    they do not touch. ValueError for Q > f P.

    >>> found = slip(1.0, half_width=1.0, normal_load=np.pi, friction=0.5,
    ...              tangential_load=0.5 * np.pi, modulus=2.0)
    >>> round(float(found), 12)
    0.5
    """
    x, b, scale = _traction_of_hertz(x, half_width, normal_load, friction, lib)
    used = traction(lib, friction, normal_load, tangential_load)
    beyond = _slip_width(lib, b, used) - (b - abs(x))
    value = pick(
        lib, (beyond > 0) & (abs(x) <= b), _slip, nothing, abs(x), beyond, b * lib.sqrt(used.left)
    )
    return as_result(scale / positive("modulus", modulus, lib) * value)


@documented("the shift, a length", *SOURCES)
def excess_shift(
    *, normal_load: Number, friction: Number, tangential_load: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """How much farther than without slip the bodies shift.

    The difference is (fP/(pi E*)) [r + (1-r) ln(1-r)], r = Q/(fP).

    The shift itself depends on the bodies' depth, as the approach does: only this part is the
    contact's own. It is (2/(pi E*)) ∫ ln(b/c) dQ. ValueError for Q > f P.

    >>> found = excess_shift(normal_load=np.pi, friction=1.0, tangential_load=np.pi, modulus=2.0)
    >>> round(float(found), 12)
    0.5
    """
    used, left = traction(lib, friction, normal_load, tangential_load)
    P, f, E = positives(lib, normal_load=normal_load, friction=friction, modulus=modulus)
    y = used / (1 + left)
    return as_result(f * (P / E) / lib.pi * used * (1 + left) / 2 * (y + _B(lib, used, left)))


@documented("the energy per cycle and unit length of the line contact, a force", *SOURCES)
def dissipation(
    *, normal_load: Number, friction: Number, tangential_load: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The energy lost per unit length in each cycle of the load between Q and -Q.

    The energy is (2f²P²/(pi E*)) [1 - m² + 2 m ln(m)], m = 1 - Q/(fP).

    ValueError for Q > f P.

    >>> found = dissipation(normal_load=np.pi, friction=1.0, tangential_load=np.pi, modulus=2.0)
    >>> round(float(found / np.pi), 12)
    1.0
    """
    used, left = traction(lib, friction, normal_load, tangential_load)
    P, f, E = positives(lib, normal_load=normal_load, friction=friction, modulus=modulus)
    return as_result(2 * f * P * (f * P / E) / lib.pi * used * (1 + left) * _B(lib, used, left))


@documented("the ends of the stick zone, lengths", *SOURCES)
def bulk_stick(
    *, half_width: Number, normal_load: Number, friction: Number, tangential_load: Number,
    bulk_stress: Number, lib: Library = np,
) -> tuple[Number, Number]:  # fmt: skip
    """The stick zone [e - c, e + c] when a bulk tension sigma in the half-plane rises with Q.

    The centre is e = pi sigma b²/(8fP).

    Nowell & Hills 1987. ValueError for Q > f P, and where |e| > b - c: there the bulk stress
    reverses the slip at one edge, and the stick zone has no closed form.

    >>> given = dict(half_width=1.0, normal_load=np.pi, friction=0.5, tangential_load=0.375 * np.pi,
    ...              bulk_stress=0.4)
    >>> tuple(round(float(x), 12) for x in bulk_stick(**given))
    (-0.4, 0.6)
    """
    b, used, e = _moved(half_width, normal_load, friction, tangential_load, bulk_stress, lib=lib)
    c = b * lib.sqrt(used.left)
    return as_result(e - c), as_result(e + c)


@documented("the shear q, a stress", *SOURCES)
def bulk_shear(
    x: Number, *, half_width: Number, normal_load: Number, friction: Number,
    tangential_load: Number, bulk_stress: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) under Q and a bulk tension sigma that rises with it.

    In the stick zone (1/pi) PV∫ q(t)/(x-t) dt = sigma/4.

    ValueError as in `bulk_stick`.

    >>> given = dict(half_width=1.0, normal_load=np.pi, friction=0.5, tangential_load=0.375 * np.pi)
    >>> bool(bulk_shear(0.3, **given, bulk_stress=0.0) == shear(0.3, **given))
    True
    """
    b, used, e = _moved(half_width, normal_load, friction, tangential_load, bulk_stress, lib=lib)
    x, _, scale = _traction_of_hertz(x, half_width, normal_load, friction, lib)
    turned_to = (1 - 2 * (e < 0)) * x  # the mirror image has e > 0
    return as_result(scale * _shifted_ellipses(lib, turned_to, b, used, abs(e)))


def _traction_of_hertz(
    x: Number, half_width: Number, normal_load: Number, friction: Number, lib: Library
) -> tuple[Number, ...]:
    """x, b, and 2fP/(pi b²), what f p is times sqrt(b² - x²)."""
    b, P, f = positives(lib, half_width=half_width, normal_load=normal_load, friction=friction)
    return real("x", x, lib), b, 2 * f * (P / b) / b / lib.pi


def _moved(
    half_width: Number, normal_load: Number, friction: Number, tangential_load: Number,
    bulk_stress: Number, *, lib: Library,
) -> tuple[Number, Traction, Number]:  # fmt: skip
    """b, the traction, and e."""
    b, P, f = positives(lib, half_width=half_width, normal_load=normal_load, friction=friction)
    used = traction(lib, friction, normal_load, tangential_load)
    e = lib.pi / 8 * (real("bulk_stress", bulk_stress, lib) * b / P) * (b / f)
    room = _slip_width(lib, b, used)
    message = (
        "bulk_stress moves the stick zone by {}, more than the slip zones' {}: slip reverses at "
        "one edge; give a smaller bulk_stress or a larger tangential_load."
    )
    refuse(abs(e) > room, message, abs(e) + 0 * room, room)
    return b, used, e


def _slip_width(lib: Library, b: Number, used: Traction) -> Number:
    return b * used.used / (1 + lib.sqrt(used.left))


def _ellipses(lib: Library, x: Number, b: Number, used: Traction) -> Number:
    """sqrt(b² - x²) - sqrt(c² - x²), each 0 outside its zone."""
    return _shifted_ellipses(lib, x, b, used, 0 * b)


def _shifted_ellipses(lib: Library, x: Number, b: Number, used: Traction, e: Number) -> Number:
    """sqrt(b² - x²) - sqrt(c² - (x-e)²), each 0 outside its zone, for e >= 0."""
    room = _slip_width(lib, b, used)
    stick = _Stick((b - x) - (room - e), (b + x) - (room + e), room, e)
    return pick(lib, (stick.right > 0) & (stick.left > 0), _in_stick, _in_slip, x, b, stick)


class _Stick(NamedTuple):
    """Distances from the ends of the stick zone, b - c, and how far the zone has moved."""

    right: Number
    left: Number
    room: Number
    e: Number


def _in_stick(lib: Library, x: Number, b: Number, stick: _Stick) -> Number:
    """By b² - x² - (c² - (x-e)²) = (b-c-e)(b+c+e) + 2e (e+c-x)."""
    right, left, room, e = stick
    roots = lib.sqrt(b - x) * lib.sqrt(b + x) + lib.sqrt(right) * lib.sqrt(left)
    return ((room - e) * (2 * b - room + e) + 2 * e * right) / roots


def _in_slip(lib: Library, x: Number, b: Number, *_: Number) -> Number:
    inside = abs(x) < b
    return lib.sqrt((b - x) * inside) * lib.sqrt((b + x) * inside)


def _slip(lib: Library, r: Number, beyond: Number, c: Number) -> Number:
    """r sqrt(r² - c²) - c² arccosh(r/c), as a sum of positive terms.

    It is (r+c)² t (t² + B(t) c/(r+c)), t² = (r-c)/(r+c).
    """
    t2 = beyond / (r + c)
    part = c / (r + c)
    return (r + c) * lib.sqrt(t2) * (r + c) * (t2 + part * B(lib, t2, 2 * part))


def _B(lib: Library, used: Number, left: Number) -> Number:
    """B(r/(2-r)), r = used."""
    y = used / (1 + left)
    return B(lib, y * y, 4 * left / ((1 + left) * (1 + left)))
