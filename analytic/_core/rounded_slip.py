"""Zones of partial slip under a rounded flat, from differences that keep their digits.

The mathematics and the notation are those of `cattaneo_rounded`.
"""

from typing import NamedTuple

from analytic import rounded_flat
from analytic._core.arc_functions import atan_excess
from analytic._core.numbers import Library, Number, bits, everywhere
from analytic._core.parameters import not_negative, positives
from analytic._core.piecewise import nothing, pick
from analytic._core.tangential_load import Traction, integral

MOST_STEPS = 60


class Contact(NamedTuple):
    a: Number
    rim: Number
    R: Number
    E: Number


class Zones(NamedTuple):
    stick: Number  # c - a
    slip: Number  # b - c


def contact_of(
    normal_load: Number, half_flat: Number, radius: Number, modulus: Number, lib: Library
) -> tuple[Number, Contact]:
    P, R, E = positives(lib, normal_load=normal_load, radius=radius, modulus=modulus)
    a = not_negative("half_flat", half_flat, lib)
    rim = rounded_flat.rim(normal_load=P, half_flat=a, radius=R, modulus=E, lib=lib)
    return P, Contact(a, rim, R, E)


def zones_of(lib: Library, P: Number, contact: Contact, used: Traction) -> Zones:
    return Zones(
        *(pick(lib, used.used > 0.5, part, other, P, contact, used) for part, other in _WAYS)
    )


def _stick_of_rest(lib: Library, P: Number, contact: Contact, used: Traction) -> Number:
    """c - a under the load P - Q/f."""
    return pick(lib, used.left > 0, _stick_of_load, _no_stick, P, contact, used)


def _stick_of_load(lib: Library, P: Number, contact: Contact, used: Traction) -> Number:
    return rounded_flat.rim(
        normal_load=P * used.left, half_flat=contact.a, radius=contact.R, modulus=contact.E, lib=lib
    )


def _no_stick(lib: Library, P: Number, contact: Contact, used: Traction) -> Number:
    return 0 * used.left * contact.rim


def _slip_of_rest(lib: Library, P: Number, contact: Contact, used: Traction) -> Number:
    return contact.rim - _stick_of_rest(lib, P, contact, used)


def _slip_of_load(lib: Library, P: Number, contact: Contact, used: Traction) -> Number:
    """b - c by Newton's method for the load that the slip zone has lost.

    That load is concave in b - c, so that the steps rise to the root.
    """
    a, rim = contact.a, contact.rim
    target = P * used.used / contact.E * contact.R
    width = target / ((a + rim) * _theta(lib, a, rim))
    for _ in range(MOST_STEPS):
        lost = load_between(lib, a, rim - width, width)
        step = (target - lost) / ((a + rim - width) * _theta(lib, a, rim - width))
        width = width + step
        # The error that is left is of the order of step².
        if everywhere(abs(step) <= 2.0 ** (-bits(lib) / 2) * width):
            break
    return width


def _stick_of_slip(lib: Library, P: Number, contact: Contact, used: Traction) -> Number:
    return contact.rim - _slip_of_load(lib, P, contact, used)


_WAYS = ((_stick_of_rest, _stick_of_slip), (_slip_of_rest, _slip_of_load))


def _theta(lib: Library, a: Number, rim: Number) -> Number:
    """arccos(a/(a + rim)), rim > 0."""
    return 2 * lib.atan(lib.sqrt(rim / (2 * a + rim)))


def load_between(lib: Library, a: Number, stick: Number, width: Number) -> Number:
    """R/E* (P(s_2) - P(s_1)), s_1 = a + stick, s_2 = s_1 + width."""
    return pick(lib, width > 0, _load_between_apart, nothing, width, a, stick)


def _load_between_apart(lib: Library, width: Number, a: Number, stick: Number) -> Number:
    upper = stick + width
    omega_1, omega_2 = lib.sqrt(stick * (2 * a + stick)), lib.sqrt(upper * (2 * a + upper))
    squares = width * (2 * a + stick + upper)
    growth = squares / (omega_1 + omega_2)
    apex = (a == 0) * (stick == 0) * 1  # where theta is pi/2, not arccos(0/0)
    theta_1 = _theta(lib, a, stick + apex)
    product, opposite = a * a + omega_1 * omega_2, a * growth
    y = opposite / (product + apex)
    arc = lib.atan(y)
    return (squares * theta_1 + omega_2 * growth * arc + opposite * _arc_excess(lib, y * y)) / 2


def _arc_excess(lib: Library, y2: Number) -> Number:
    """atan(y)/y - 1."""
    return pick(lib, y2 > 0, atan_excess, nothing, y2)


def slip_at(lib: Library, beyond: Number, stick: Number, a: Number) -> Number:
    """∫_c^x s theta arccosh(x/s) ds, beyond = x - c."""

    def integrand(left: Number, right: Number) -> Number:
        rim, rest = stick + beyond * left, beyond * right
        s = a + rim
        return s * _theta(lib, a, rim) * 2 * lib.asinh(lib.sqrt(rest / (2 * s)))

    return beyond * integral(lib, integrand)


def lost(lib: Library, x: Number, contact: Contact, zones: Zones) -> Number:
    """p_b - p_c at x >= 0."""
    shape = {"half_flat": contact.a, "radius": contact.R, "modulus": contact.E, "lib": lib}
    sticks = contact.a + zones.stick > 0  # the apex of a parabola that slides is no contact
    whole = rounded_flat.pressure(x, rim=contact.rim, **shape)
    stuck = sticks * rounded_flat.pressure(
        x, rim=zones.stick + (1 - sticks * 1) * contact.rim, **shape
    )
    near = ((contact.a - x) + contact.rim) - zones.slip
    return pick(
        lib,
        (2 * stuck > whole) & (near > 0),
        _lost_by_integral,
        _lost_by_difference,
        x,
        contact,
        zones,
        whole - stuck,
    )


def _lost_by_difference(
    lib: Library, x: Number, contact: Contact, zones: Zones, difference: Number
) -> Number:
    return difference


def _lost_by_integral(
    lib: Library, x: Number, contact: Contact, zones: Zones, difference: Number
) -> Number:
    """(E*/(pi R)) ∫ theta(sqrt(x² + u²)) du, which is smooth; s² - a² = (c² - a²) + (u² - u_c²)."""
    a, rim = contact.a, contact.rim
    near = (a - x) + rim
    u_b = lib.sqrt(near) * lib.sqrt(a + rim + x)
    u_c = lib.sqrt(near - zones.slip) * lib.sqrt(a + zones.stick + x)
    span = zones.slip * (2 * a + rim + zones.stick) / (u_b + u_c)
    least = zones.stick * (2 * a + zones.stick)

    def integrand(left: Number, right: Number) -> Number:
        step = span * left
        squares = least + step * (2 * u_c + step)
        return 2 * lib.atan(lib.sqrt(squares) / (a + lib.sqrt(a * a + squares)))

    return contact.E / contact.R / lib.pi * span * integral(lib, integrand)
