"""A rigid flat that slides, upright or tilted, over a dissimilar half-plane: q = f p.

Its sharp corners are at x = ±b.

With tan(pi eps) = -beta f, Y = (z-b)^(-1/2-eps) (z+b)^(-1/2+eps) and a tilt h',

    p  = cos(pi eps) (P/pi + A (x - 2 eps b)) (b-x)^(-1/2-eps) (b+x)^(-1/2+eps),      A = -E* h'/2
    Fp = E*/2 h' + (P/pi + A (z - 2 eps b)) Y(z)
    M  = 2 eps b P - pi E* b² (1 - 4 eps²) h'/4

solve E*/2 h' = (1/pi) PV∫ p(t)/(x-t) dt - beta f p, M = ∫ p x dx (for h' = 0 Hills, Nowell &
Sackfield, Mechanics of Elastic Contacts, 1993; Johnson 1985, section 2.8). Upright, the flat needs
the moment 2 eps b P: friction moves the pressure. `coupling` is beta f, positive when the shear on
the half-plane points to +x.
"""

import sys
from typing import NamedTuple

import numpy as np

from analytic._core.cut import in_plane, on_cut, seen_from
from analytic._core.documentation import HILLS, JOHNSON, documented
from analytic._core.edge_exponents import cosine, singular, singular_remainder, sliding_exponent
from analytic._core.numbers import Library, Number, as_result, cartesian, not_below_zero
from analytic._core.parameters import point, positive, positives, real, refuse
from analytic._core.piecewise import infinite, nothing, pick

SOURCES = (
    HILLS,
    f"{JOHNSON}, section 2.8",
)

# A moment that passes the limit of lift-off by no more than its own rounding is taken to be at the
# limit.
ROUNDING = 8 * sys.float_info.epsilon


@documented("the moment M, a force", *SOURCES)
def upright_moment(
    *, half_width: Number, normal_load: Number, coupling: Number, lib: Library = np
) -> Number:
    """The moment M = 2 eps b P = ∫ p x dx at which the flat does not tilt.

    >>> round(float(upright_moment(half_width=1.0, normal_load=2.0, coupling=-1.0)), 12)
    1.0
    """
    b, P = positives(lib, half_width=half_width, normal_load=normal_load)
    return as_result(2 * sliding_exponent(lib, real("coupling", coupling, lib)) * b * P)


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, normal_load: Number, coupling: Number, moment: Number = None,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The pressure p(x) of a complete contact, inf at its corners, and 0 outside.

    The shear is f times this.

    Without a `moment` the flat is upright. ValueError for moments that lift a corner off.

    >>> round(float(pressure(0.6, half_width=1.0, normal_load=np.pi, coupling=0.0)), 12)
    1.25
    """
    x, contact = real("x", x, lib), _contact_of(half_width, normal_load, coupling, moment, lib)
    return as_result(_pressure(lib, x, contact))


@documented("the rotation h', in radians", *SOURCES)
def tilt(
    *, half_width: Number, normal_load: Number, coupling: Number, moment: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The tilt h' of a complete contact under the moment M.

    h' = -4 (M - 2 eps b P)/(pi E* b² (1 - 4 eps²)).

    ValueError for moments that lift a corner off.

    >>> found = tilt(half_width=1.0, normal_load=np.pi, coupling=0.0, moment=np.pi / 4, modulus=1.0)
    >>> round(float(found), 12)
    -1.0
    """
    contact = _contact_of(half_width, normal_load, coupling, moment, lib)
    return as_result(-2 * contact.A / positive("modulus", modulus, lib))


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, normal_load: Number, coupling: Number, moment: Number = None,
    side: int = +1, lib: Library = np,
) -> Number:  # fmt: skip
    """The complex potential Fp(z) of the pressure, ~ P/(pi z) far away.

    The potential of the shear is f times this.

    Real z in the contact are on the cut: there `side` = +1 gives the limit from the body y > 0,
    E*/2 h' + (beta f - i) p, and -1 its conjugate. ValueError for moments that lift a corner off.

    >>> complex(potential(0.6, half_width=1.0, normal_load=np.pi, coupling=0.0)).imag
    -1.25
    """
    z = point(z, lib)
    contact = _contact_of(half_width, normal_load, coupling, moment, lib)
    cut = on_cut(lib, z, contact.b)
    return as_result(in_plane(lib, cut, side, _potential_on_cut, _potential, z, contact))


class _Contact(NamedTuple):
    b: Number
    k: Number  # beta f
    P: Number
    A: Number  # -E* h'/2
    right: Number  # the shares of the corners: P/pi + A (x - 2 eps b)
    left: Number  # = right (b+x)/b + left (b-x)/b


def _contact_of(
    half_width: Number, normal_load: Number, coupling: Number, moment: Number, lib: Library
) -> _Contact:
    b, P = positives(lib, half_width=half_width, normal_load=normal_load)
    k = real("coupling", coupling, lib)
    eps = sliding_exponent(lib, k)
    tilting = (
        0 * eps
        if moment is None
        else 2 * (real("moment", moment, lib) / b - 2 * eps * P) / (lib.pi * (1 - 4 * eps * eps))
    )
    right = (P / lib.pi + tilting * (1 - 2 * eps)) / 2
    left = (P / lib.pi - tilting * (1 + 2 * eps)) / 2
    _refuse_lifted(right, left, moment, P / lib.pi)
    return _Contact(b, k, P, tilting / b, not_below_zero(right), not_below_zero(left))


def _refuse_lifted(right: Number, left: Number, moment: Number, scale: Number) -> None:
    lifted = (right < -ROUNDING * scale) | (left < -ROUNDING * scale)
    refuse(
        lifted, "moment = {} lifts one corner off; give one nearer to upright_moment(...).", moment
    )


def _pressure(lib: Library, x: Number, contact: _Contact) -> Number:
    return pick(lib, abs(x) < contact.b, _pressure_inside, _pressure_not_inside, x, contact)


def _pressure_inside(lib: Library, x: Number, contact: _Contact) -> Number:
    b, eps, near, far = contact.b, sliding_exponent(lib, contact.k), contact.b - x, contact.b + x
    V = lib.sqrt(far) / lib.sqrt(near)
    return cosine(lib, contact.k) / b * (far / near) ** eps * (contact.right * V + contact.left / V)


def _pressure_not_inside(lib: Library, x: Number, contact: _Contact) -> Number:
    pressed = ((x == contact.b) & (contact.right > 0)) | ((x == -contact.b) & (contact.left > 0))
    return pick(lib, pressed, infinite, nothing, x)


def _potential(lib: Library, z: Number, contact: _Contact) -> Number:
    b, eps = contact.b, sliding_exponent(lib, contact.k)
    return contact.P / lib.pi * singular(lib, z, b, eps) + contact.A * singular_remainder(
        lib, z, b, eps
    )


def _potential_on_cut(lib: Library, z: Number, contact: _Contact, *, side: int) -> Number:
    p = _pressure(lib, z.real, contact)
    return cartesian(contact.k * p - contact.A, -seen_from(z, side) * p, lib)
