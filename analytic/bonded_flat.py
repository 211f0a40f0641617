"""A rigid flat bonded to a dissimilar half-plane over |x| <= b, under P, Q and M.

Nothing slips: with g' = 0 and a rotation h' the two equations of dissimilar bodies are one for p +
iq,

    E*/2 h' = (1/pi) PV∫ (p + iq)(t)/(x-t) dt + i beta (p + iq)(x),

and with tanh(pi eta) = beta its solution is

    p + iq = cosh(pi eta) [ (P + iQ)/pi + A (x - 2 i eta b) ] (b² - x²)^(-1/2) exp(i phase)
    phase = eta ln((b+x)/(b-x))
    A = -E* h'/2 = 2 (M + 2 eta b Q)/(pi b² (1 + 4 eta²)),      M = ∫ p x dx

(for A = 0 Muskhelishvili 1953, part V; Johnson 1985, section 2.8). Under M = -2 eta b Q it does not
rotate. Towards the corners p and q oscillate, ever faster, between bounds that grow like (b -
|x|)^(-1/2): there the bond must carry tension, under P alone where tanh(pi/(4 eta)) b < |x|, which
is 2.5e-4 b from the corner for beta = 1/2.
"""

from typing import NamedTuple

import numpy as np

from analytic._core.cut import in_plane, on_cut, seen_from
from analytic._core.documentation import JOHNSON, MUSKHELISHVILI, documented
from analytic._core.edge_exponents import singular, singular_remainder
from analytic._core.numbers import Library, Number, as_result, cartesian, sign
from analytic._core.parameters import point, positive, positives, real, refuse
from analytic._core.piecewise import nothing, pick

SOURCES = (
    f"{MUSKHELISHVILI}, part V",
    f"{JOHNSON}, section 2.8",
)


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, normal_load: Number, dundurs: Number, shear_load: Number = 0,
    moment: Number = 0, lib: Library = np,
) -> Number:  # fmt: skip
    """The pressure p(x), negative where the bond pulls; inf at the corners, 0 outside.

    (At a corner p has no limit for beta ≠ 0, and inf stands for its growing bounds.)

    >>> round(float(pressure(0.6, half_width=1.0, normal_load=np.pi, dundurs=0.0)), 12)
    1.25
    """
    contact = _contact_of(half_width, normal_load, dundurs, shear_load, moment, lib=lib)
    return as_result(_pressure(lib, real("x", x, lib), contact))


@documented("the shear q, a stress", *SOURCES)
def shear(
    x: Number, *, half_width: Number, normal_load: Number, dundurs: Number, shear_load: Number = 0,
    moment: Number = 0, lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) on the half-plane, inf at the corners as the pressure is, 0 outside.

    The resultant is ∫ q dx = Q.

    >>> round(float(shear(0.6, half_width=1.0, normal_load=1.0, dundurs=0.0, shear_load=np.pi)), 12)
    1.25
    """
    contact = _contact_of(half_width, normal_load, dundurs, shear_load, moment, lib=lib)
    return as_result(_shear(lib, real("x", x, lib), contact))


@documented("the rotation h', in radians", *SOURCES)
def tilt(
    *, half_width: Number, dundurs: Number, modulus: Number, shear_load: Number = 0,
    moment: Number = 0, lib: Library = np,
) -> Number:  # fmt: skip
    """The rotation h' = -4 (M + 2 eta b Q)/(pi E* b² (1 + 4 eta²)) of the flat.

    The normal load does not rotate it.

    >>> round(float(tilt(half_width=1.0, dundurs=0.0, modulus=1.0, moment=np.pi / 4)), 12)
    -1.0
    """
    contact = _contact_of(half_width, 1, dundurs, shear_load, moment, lib=lib)
    return as_result(-2 * contact.A / positive("modulus", modulus, lib))


@documented("the potential Fp + i Fq, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_width: Number, normal_load: Number, dundurs: Number, shear_load: Number = 0,
    moment: Number = 0, side: int = +1, lib: Library = np,
) -> Number:  # fmt: skip
    """The potential Fp + i Fq = (1/pi) ∫ (p + iq)(t)/(z-t) dt, complex; ~ (P + iQ)/(pi z) far away.

    Fp(z) alone is the mean of this at z and of its conjugate at the conjugate of z. Real z in the
    contact are on the cut: there it is E*/2 h' - i (beta ± 1) (p + iq), ± the `side`.

    >>> complex(potential(0.6, half_width=1.0, normal_load=np.pi, dundurs=0.0)).imag
    -1.25
    """
    z = point(z, lib)
    contact = _contact_of(half_width, normal_load, dundurs, shear_load, moment, lib=lib)
    cut = on_cut(lib, z, contact.b)
    return as_result(in_plane(lib, cut, side, _potential_on_cut, _potential, z, contact))


class _Contact(NamedTuple):
    b: Number
    beta: Number
    eta: Number
    P: Number
    Q: Number
    A: Number


def _contact_of(
    half_width: Number, normal_load: Number, dundurs: Number, shear_load: Number, moment: Number, *,
    lib: Library,
) -> _Contact:  # fmt: skip
    b, P = positives(lib, half_width=half_width, normal_load=normal_load)
    Q, M = real("shear_load", shear_load, lib), real("moment", moment, lib)
    beta = real("dundurs", dundurs, lib)
    message = "dundurs = {} is beyond 1/2, which no pair of bodies reaches; give |beta| <= 1/2."
    refuse(abs(beta) > 0.5, message, beta)
    eta = lib.atanh(beta) / lib.pi
    A = 2 * (M / b + 2 * eta * Q) / (lib.pi * b * (1 + 4 * eta * eta))
    return _Contact(b, beta, eta, P, Q, A)


def _normal_and_shear(lib: Library, x: Number, contact: _Contact) -> tuple[Number, Number, Number]:
    """(envelope, p at zero phase, q at zero phase).

    With the phase, p + iq = envelope (u + iv) exp(i phase).
    """
    b, eta = contact.b, contact.eta
    cosh = 1 / (lib.sqrt(1 - contact.beta) * lib.sqrt(1 + contact.beta))
    envelope = cosh / (lib.sqrt(b - x) * lib.sqrt(b + x))
    return (
        envelope,
        contact.P / lib.pi + contact.A * x,
        contact.Q / lib.pi - 2 * eta * b * contact.A,
    )


def _phase(lib: Library, x: Number, contact: _Contact) -> Number:
    return contact.eta * lib.log((contact.b + x) / (contact.b - x))


def _pressure(lib: Library, x: Number, contact: _Contact) -> Number:
    return pick(lib, abs(x) < contact.b, _pressure_inside, _pressure_not_inside, x, contact)


def _shear(lib: Library, x: Number, contact: _Contact) -> Number:
    return pick(lib, abs(x) < contact.b, _shear_inside, _shear_not_inside, x, contact)


def _pressure_inside(lib: Library, x: Number, contact: _Contact) -> Number:
    phase, (envelope, u, v) = _phase(lib, x, contact), _normal_and_shear(lib, x, contact)
    return envelope * (u * lib.cos(phase) - v * lib.sin(phase))


def _shear_inside(lib: Library, x: Number, contact: _Contact) -> Number:
    phase, (envelope, u, v) = _phase(lib, x, contact), _normal_and_shear(lib, x, contact)
    return envelope * (u * lib.sin(phase) + v * lib.cos(phase))


def _pressure_not_inside(lib: Library, x: Number, contact: _Contact) -> Number:
    return pick(lib, abs(x) == contact.b, _pressure_at_corner, nothing, x, contact)


def _shear_not_inside(lib: Library, x: Number, contact: _Contact) -> Number:
    return pick(lib, abs(x) == contact.b, _shear_at_corner, nothing, x, contact)


def _pressure_at_corner(lib: Library, x: Number, contact: _Contact) -> Number:
    return _infinite(lib, contact.eta, contact.P / lib.pi + contact.A * x)


def _shear_at_corner(lib: Library, x: Number, contact: _Contact) -> Number:
    return _infinite(lib, contact.eta, contact.Q + 0 * x)


def _infinite(lib: Library, eta: Number, amplitude: Number) -> Number:
    """inf, or without oscillation inf with the sign of the amplitude, and 0 without either."""
    return pick(lib, (eta == 0) & (amplitude == 0), nothing, _signed_infinity, amplitude, eta)


def _signed_infinity(lib: Library, amplitude: Number, eta: Number) -> Number:
    oscillates = (eta != 0) * 1
    return lib.inf * (oscillates + (1 - oscillates) * sign(amplitude))


def _exponent(lib: Library, contact: _Contact) -> Number:
    """i eta, in the place of eps."""
    return cartesian(0 * contact.eta, contact.eta, lib)


def _potential(lib: Library, z: Number, contact: _Contact) -> Number:
    eps, resultant = _exponent(lib, contact), cartesian(contact.P, contact.Q, lib) / lib.pi
    return resultant * singular(lib, z, contact.b, eps) + contact.A * singular_remainder(
        lib, z, contact.b, eps
    )


def _potential_on_cut(lib: Library, z: Number, contact: _Contact, *, side: int) -> Number:
    x, factor = z.real, contact.beta + seen_from(z, side)
    p, q = _pressure(lib, x, contact), _shear(lib, x, contact)
    return cartesian(factor * q - contact.A, -factor * p, lib)
