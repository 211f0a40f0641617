"""A parabola that slides over a dissimilar half-plane: h = x²/(2R), q = f p everywhere.

The shear lifts the surface, and the equation of the pressure becomes one of the second kind,

    E*/2 h'(x) = (1/pi) PV∫ p(t)/(x-t) dt - beta f p(x).

With tan(pi eps) = -beta f the contact is [-w (1-2 eps), w (1+2 eps)], w half its length, and on it

    p = E* cos(pi eps)/(2R) (w (1+2 eps) - x)^(1/2-eps) (w (1-2 eps) + x)^(1/2+eps)
    P = pi E* w² (1/4 - eps²)/R,      M = 8/3 eps w P,      Fp = E*/(2R) [ z - X(z) ]

(Hills, Nowell & Sackfield, Mechanics of Elastic Contacts, 1993; Johnson 1985, section 8.2).
`coupling` is beta f, positive when the shear on the half-plane points to +x, negative when it
points to -x. Without it all this is Hertz.
"""

import numpy as np

from analytic._core.cut import in_plane, on_cut, seen_from
from analytic._core.documentation import HILLS, JOHNSON, documented
from analytic._core.edge_exponents import (
    bounded_remainder,
    bounded_weight,
    cosine,
    sliding_exponent,
)
from analytic._core.numbers import Library, Number, as_result, cartesian, scaled
from analytic._core.parameters import point, positive, positives, real
from analytic._core.piecewise import nothing, pick

SOURCES = (
    HILLS,
    f"{JOHNSON}, section 8.2",
)


@documented("the ends (x1, x2) of the contact, lengths", *SOURCES)
def edges(*, half_width: Number, coupling: Number, lib: Library = np) -> tuple[Number, Number]:
    """The ends (x1, x2) = (-w (1-2 eps), w (1+2 eps)) of the contact of length 2w.

    >>> tuple(map(float, edges(half_width=1.0, coupling=0.0)))
    (-1.0, 1.0)
    """
    w = positive("half_width", half_width, lib)
    eps = sliding_exponent(lib, real("coupling", coupling, lib))
    return as_result(-w * (1 - 2 * eps)), as_result(w * (1 + 2 * eps))


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, radius: Number, modulus: Number, coupling: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The contact pressure p(x), and 0 outside. The shear is f times this.

    >>> round(float(pressure(0.6, half_width=1.0, radius=1.0, modulus=2.0, coupling=0.0)), 12)
    0.8
    """
    x, k = real("x", x, lib), real("coupling", coupling, lib)
    w, R, E = positives(lib, half_width=half_width, radius=radius, modulus=modulus)
    return as_result(E / (2 * R) * _pressure(lib, x, w, k))


@documented("the normal load P per unit length, a force per length", *SOURCES)
def load(
    *, half_width: Number, radius: Number, modulus: Number, coupling: Number, lib: Library = np
) -> Number:
    """The normal load P = pi E* w² (1/4 - eps²)/R per unit length.

    The load is less than that of Hertz on the same length.

    >>> round(float(load(half_width=1.0, radius=1.0, modulus=1.0, coupling=0.0)), 12)
    0.785398163397
    """
    w, R, E = positives(lib, half_width=half_width, radius=radius, modulus=modulus)
    eps = sliding_exponent(lib, real("coupling", coupling, lib))
    return as_result(lib.pi * E * (w / R) * w * _stiffening(eps))


@documented("half the length of the contact, a length", *SOURCES)
def half_width(
    *, normal_load: Number, radius: Number, modulus: Number, coupling: Number, lib: Library = np
) -> Number:
    """Half the length of the contact, w = sqrt(P R/(pi E* (1/4 - eps²))): the inverse of `load`.

    >>> round(float(half_width(normal_load=np.pi, radius=1.0, modulus=1.0, coupling=0.0)), 12)
    2.0
    """
    P, R, E = positives(lib, normal_load=normal_load, radius=radius, modulus=modulus)
    eps = sliding_exponent(lib, real("coupling", coupling, lib))
    return as_result(lib.sqrt(P / E) * lib.sqrt(R) / lib.sqrt(lib.pi * _stiffening(eps)))


@documented("the moment M, a force", *SOURCES)
def moment(
    *, half_width: Number, radius: Number, modulus: Number, coupling: Number, lib: Library = np
) -> Number:
    """The moment M = ∫ p x dx = 8/3 eps w P of the pressure about the apex of the parabola.

    >>> float(moment(half_width=1.0, radius=1.0, modulus=1.0, coupling=0.0) + 0)
    0.0
    """
    P = load(half_width=half_width, radius=radius, modulus=modulus, coupling=coupling, lib=lib)
    w, eps = (
        positive("half_width", half_width, lib),
        sliding_exponent(lib, real("coupling", coupling, lib)),
    )
    return as_result(8 * P * w * eps / 3)


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, radius: Number, modulus: Number, coupling: Number,
    side: int = +1, lib: Library = np,
) -> Number:  # fmt: skip
    """The complex potential Fp = E*/(2R) [z - X(z)], ~ P/(pi z) far away.

    The potential of the shear is f times this.

    Real z in the contact are on the cut: there `side` = +1 gives the limit from the body y > 0,
    E*/2 h' + (beta f - i) p, and -1 its conjugate.

    >>> complex(potential(0.6, half_width=1.0, radius=1.0, modulus=2.0, coupling=0.0)).real
    0.6
    """
    z, k = point(z, lib), real("coupling", coupling, lib)
    w, R, E = positives(lib, half_width=half_width, radius=radius, modulus=modulus)
    from_middle = z - 2 * sliding_exponent(lib, k) * w
    value = in_plane(lib, on_cut(lib, from_middle, w), side, _potential_on_cut, _potential, z, w, k)
    return as_result(scaled(E / (2 * R), value, lib))


def _stiffening(eps: Number) -> Number:
    """1/4 - eps²."""
    return (1 - 2 * eps) * (1 + 2 * eps) / 4


def _pressure(lib: Library, x: Number, w: Number, k: Number) -> Number:
    """2R/E* p."""
    shift = 2 * w * sliding_exponent(lib, k)
    near, far = (w - x) + shift, (w + x) - shift
    return pick(lib, (near > 0) & (far > 0), _pressure_inside, nothing, near, far, k)


def _pressure_inside(lib: Library, near: Number, far: Number, k: Number) -> Number:
    return cosine(lib, k) * bounded_weight(lib, near, far, sliding_exponent(lib, k))


def _potential(lib: Library, z: Number, w: Number, k: Number) -> Number:
    eps = sliding_exponent(lib, k)
    return bounded_remainder(lib, z - 2 * eps * w, w, eps)


def _potential_on_cut(lib: Library, z: Number, w: Number, k: Number, *, side: int) -> Number:
    p = _pressure(lib, z.real, w, k)
    return cartesian(z.real + k * p, -seen_from(z, side) * p, lib)
