"""Partial slip of a flat with rounded edges under a constant load P.

The tangential load rises, falls and rises again.

Similar bodies (beta = 0). The corrective traction is the pressure of the same profile under the
load P - Q/f, so that the stick zone [-c, c] is the contact under that load and always covers the
flat, c > a (Ciavarella, Hills & Monno 1998, eqs 18 to 20; Ciavarella 1998; Jager 1998). With
theta(s) = arccos(a/s) and s from c to b

    Q/f = P(b) - P(c) = (E*/R) ∫ s theta ds
    q/f = p_b - p_c = (E*/(pi R)) ∫ s theta/sqrt(s² - x²) ds
    slip   s(x) = (2f/(pi R)) ∫_c^|x| s theta arccosh(|x|/s) ds
    energy lost in a cycle between ±Q:   W = (8f²/(pi E*)) ∫ (P(b) - P(s)) (P(s) - P(c)) ds/s

After Q_max has turned, q(Q) = q(Q_max) - 2 q((Q_max - Q)/2), and after Q_min, q(Q) = q(Q_min) + 2
q((Q - Q_min)/2). The differences of loads, with omega = sqrt(s² - a²), y = a (omega_2 -
omega_1)/(a² + omega_1 omega_2) = tan(theta_2 - theta_1),

    (2R/E*) (P_2 - P_1) = (s_2² - s_1²) theta_1 + omega_2 (omega_2 - omega_1) atan(y)
                          - (a² + omega_1 omega_2) (y - atan(y))

lose no digits, the last term being a third of the second or less; where p_b and p_c are nearly
equal their difference is integrated. Loads are given and not widths, since Q and f P must be known
exactly where they are nearly equal.
"""

import numpy as np

from analytic._core.documentation import CIAVARELLA, documented
from analytic._core.numbers import Library, Number, as_result
from analytic._core.parameters import not_negative, positive, real, refuse
from analytic._core.piecewise import nothing, pick
from analytic._core.rounded_slip import (
    Contact,
    contact_of,
    load_between,
    lost,
    slip_at,
    zones_of,
)
from analytic._core.tangential_load import Traction, integral, traction, turned, turned_twice

SOURCES = (f"{CIAVARELLA}, equations (18) to (20)",)

# A first loading counts once, every turn of the load twice: there and back.
TURNS = (1, -2, 2)


@documented("the ratio Q/(fP), a number from 0 to 1", *SOURCES)
def loading_ratio(
    *, half_flat: Number, half_width: Number, stick_half_width: Number, lib: Library = np
) -> Number:
    """The part Q/(fP) of the friction at which the stick zone has the half-width c.

    The formula is eq. 20 of Ciavarella, Hills & Monno (1998).

    ValueError unless a <= c <= b.

    >>> float(loading_ratio(half_flat=0.0, half_width=1.0, stick_half_width=0.5))
    0.75
    """
    a, b = not_negative("half_flat", half_flat, lib), positive("half_width", half_width, lib)
    c = not_negative("stick_half_width", stick_half_width, lib)
    message = (
        "stick_half_width = {} is not between half_flat = {} and half_width = {}; "
        "give a <= c <= b, a < b."
    )
    refuse((c < a) | (b < c) | (b <= a), message, c, a, b)
    whole = load_between(lib, a, 0 * a, b - a)
    return as_result(load_between(lib, a, c - a, b - c) / whole)


@documented("the length c - a", *SOURCES)
def stick_rim(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, friction: Number,
    tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The length c - a on which each rounding sticks, to full relative accuracy; 0 at Q = f P.

    >>> given = dict(normal_load=1.0, half_flat=0.5, radius=1.0, modulus=1.0, friction=0.5)
    >>> from analytic import rounded_flat
    >>> whole = rounded_flat.rim(normal_load=0.5, half_flat=0.5, radius=1.0, modulus=1.0)
    >>> round(float(stick_rim(**given, tangential_load=0.25) / whole), 12)
    1.0
    """
    used = traction(lib, friction, normal_load, tangential_load)
    contact = contact_of(normal_load, half_flat, radius, modulus, lib)
    return as_result(zones_of(lib, *contact, used).stick)


@documented("the length of a slip zone", *SOURCES)
def slip_width(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, friction: Number,
    tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The length b - c of each slip zone, to full relative accuracy.

    >>> given = dict(normal_load=np.pi / 4, half_flat=0.0, radius=1.0, modulus=1.0, friction=1.0)
    >>> round(float(slip_width(**given, tangential_load=3 * np.pi / 16)), 12)
    0.5
    """
    contact = contact_of(normal_load, half_flat, radius, modulus, lib)
    used = traction(lib, friction, normal_load, tangential_load)
    return as_result(zones_of(lib, *contact, used).slip)


@documented("the shear q, a stress", *SOURCES)
def shear(
    x: Number, *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number,
    friction: Number, tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) while Q rises from 0: f p in the slip zones, f (p_b - p_c) in the stick zone.

    ValueError for Q > f P.

    >>> given = dict(normal_load=np.pi / 4, half_flat=0.0, radius=1.0, modulus=1.0, friction=1.0)
    >>> round(float(shear(0.0, **given, tangential_load=3 * np.pi / 16)), 12)
    0.25
    """
    used = (traction(lib, friction, normal_load, tangential_load),)
    P, contact = contact_of(normal_load, half_flat, radius, modulus, lib)
    return _shear(x, P, contact, friction, used, lib=lib)


@documented("the shear q, a stress", *SOURCES)
def unloading_shear(
    x: Number, *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number,
    friction: Number, largest_load: Number, tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) when Q has fallen from Q_max to Q >= -Q_max.

    ValueError for loads out of order.

    >>> given = dict(normal_load=np.pi / 4, half_flat=0.0, radius=1.0, modulus=1.0, friction=1.0)
    >>> found = unloading_shear(0.0, **given, largest_load=3 * np.pi / 16,
    ...                         tangential_load=-3 * np.pi / 16)
    >>> round(float(found), 12)
    -0.25
    """
    used = turned(lib, friction, normal_load, largest_load, tangential_load)
    P, contact = contact_of(normal_load, half_flat, radius, modulus, lib)
    return _shear(x, P, contact, friction, used, lib=lib)


@documented("the shear q, a stress", *SOURCES)
def reloading_shear(
    x: Number, *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number,
    friction: Number, largest_load: Number, least_load: Number, tangential_load: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The shear q(x) when Q, after a fall from Q_max to Q_min, has risen again.

    Q_min >= -Q_max, and Q <= Q_max.

    ValueError for loads out of order.

    >>> given = dict(normal_load=np.pi / 4, half_flat=0.0, radius=1.0, modulus=1.0, friction=1.0)
    >>> loads = dict(largest_load=3 * np.pi / 16, least_load=0.1, tangential_load=3 * np.pi / 16)
    >>> round(float(reloading_shear(0.0, **given, **loads)), 12)
    0.25
    """
    used = turned_twice(lib, friction, normal_load, (largest_load, least_load, tangential_load))
    P, contact = contact_of(normal_load, half_flat, radius, modulus, lib)
    return _shear(x, P, contact, friction, used, lib=lib)


@documented("the slip s, a length >= 0", *SOURCES)
def slip(
    x: Number, *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number,
    friction: Number, tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The slip s(x) >= 0 of the indenter over the half-plane towards +x while Q rose from 0.

    0 where they stick, and, by agreement, where they do not touch. ValueError for Q > f P.

    >>> given = dict(normal_load=np.pi / 4, half_flat=0.0, radius=1.0, modulus=1.0, friction=1.0)
    >>> round(float(slip(1.0, **given, tangential_load=np.pi / 4)), 12)
    0.5
    """
    x, f = real("x", x, lib), positive("friction", friction, lib)
    P, contact = contact_of(normal_load, half_flat, radius, modulus, lib)
    zones = zones_of(lib, P, contact, traction(lib, friction, normal_load, tangential_load))
    near = (contact.a - abs(x)) + contact.rim
    beyond = zones.slip - near
    slips = (near >= 0) & (beyond > 0)
    value = pick(lib, slips, slip_at, nothing, beyond, zones.stick, contact.a)
    return as_result(2 * f / contact.R / lib.pi * value)


@documented("the energy per cycle and unit length of the line contact, a force", *SOURCES)
def dissipation(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, friction: Number,
    tangential_load: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The energy W lost in each cycle between Q and -Q, per unit length.

    ValueError for Q > f P.

    >>> given = dict(normal_load=np.pi, half_flat=0.0, radius=1.0, modulus=2.0, friction=1.0)
    >>> round(float(dissipation(**given, tangential_load=np.pi) / np.pi), 12)
    1.0
    """
    P, contact = contact_of(normal_load, half_flat, radius, modulus, lib)
    f, b = positive("friction", friction, lib), contact.a + contact.rim
    zones = zones_of(lib, P, contact, traction(lib, friction, normal_load, tangential_load))
    a, stick, width = contact.a / b, zones.stick / b, zones.slip / b  # lest their powers overflow

    def integrand(left: Number, right: Number) -> Number:
        to_edge = load_between(lib, a, stick + width * left, width * right)
        return to_edge * load_between(lib, a, stick, width * left) / (a + stick + width * left)

    scale = 8 * f * f / lib.pi * (contact.E * (b / contact.R) * b) * (b / contact.R) * b
    return as_result(scale * width * integral(lib, integrand))


def _shear(
    x: Number, P: Number, contact: Contact, f: Number, loads: tuple[Traction, ...], *, lib: Library
) -> Number:
    """The sum of the shears of first loadings, the later ones with the weight of a turn."""
    x, f = abs(real("x", x, lib)), positive("friction", f, lib)
    total = 0
    for used, weight in zip(loads, TURNS, strict=False):
        total = total + weight * lost(lib, x, contact, zones_of(lib, P, contact, used))
    return as_result(f * total)
