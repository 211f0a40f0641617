"""The contact of a rounded flat in units of its own: what `rounded_flat` scales by E*, R and b.

The mathematics and the notation are those of `rounded_flat`. Everything here takes the library
first, and a `Contact`.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from analytic._core.arc_functions import BITS_A_TERM, SMALL_SQUARE, A, B, artanh_excess, atan_excess
from analytic._core.cut import seen_from
from analytic._core.numbers import Library, Number, bits, cartesian, fraction, larger, sign, smaller
from analytic._core.parameters import not_negative, positive, refuse
from analytic._core.piecewise import nothing, pick, together


class Contact(NamedTuple):
    """The lengths of a contact, numbers or arrays that broadcast."""

    a: Number
    b: Number
    low: Number  # b + low = a + rim without rounding: what b has lost of a rim that was given
    rim: Number

    @property
    def tau2(self) -> Number:
        """tan²(theta/2)."""
        return self.rim / (self.b + self.a)

    @property
    def scale(self) -> Number:
        """2b/(b+a), the factor of lengths in the differences 1 - y²."""
        return 2 * (self.b / (self.b + self.a))


def contact_of(half_flat: Number, half_width: Number, rim: Number, lib: Library) -> Contact:
    """The contact that a caller describes. ValueError unless it is one, given in one way."""
    a = not_negative("half_flat", half_flat, lib)
    if (half_width is None) == (rim is None):
        which = "Neither" if rim is None else "Both"
        raise ValueError(
            f"{which} of half_width and rim (= half_width - half_flat) given; "
            "give exactly one of them."
        )
    if rim is None:
        b = positive("half_width", half_width, lib)
        _refuse_narrow(a, b)
        return Contact(a, b, 0 * b, b - a)
    d = not_negative("rim", rim, lib)
    b = positive("half_width", a + d, lib)
    part = b - a
    return Contact(a, b, (a - (b - part)) + (d - part), d)  # Knuth's exact sum


def _refuse_narrow(a: Number, b: Number) -> None:
    message = (
        "half_width = {} is less than half_flat = {}, but the contact covers the whole flat under "
        "any load; give half_width >= half_flat, or rim = half_width - half_flat in its place."
    )
    refuse(a > b, message, b, a)


def beyond(x: Number, a: Number) -> Number:
    """|x| - a outside the flat, 0 on it."""
    over = abs(x) - a
    return (over + abs(over)) / 2


def pressure(lib: Library, x: Number, contact: Contact) -> Number:
    """pi R/(E* b) p at x >= 0; beyond the edge T = 0 and so is p."""
    a, b, low, rim = contact
    near, far, tau2 = larger((b - x) + low, 0, lib), b + x, contact.tau2
    T2 = near / far
    # tau² : T² = for_tau : for_T, and their difference is 2 (x - a). (Without a rim all is 0; but
    # not 0/0.)
    for_tau, for_T = (rim / b + (rim == 0)) * far, (b + a) / b * near
    whole = larger(for_tau, for_T, lib)
    this_end = (smaller(for_tau, for_T, lib) / whole, abs(x - a) / whole * 2)
    other_end = (tau2 * T2, (x + a) / far * contact.scale)
    B_this, B_other = together(lib, B, this_end, other_end)
    sines = 2 * lib.sqrt(tau2) / (1 + tau2) * lib.sqrt(T2) / (1 + T2)
    # The last term is B under the flat, 2 - B on the rim.
    return sines * (2 * A(lib, tau2) + B_other + abs(2 * (x > a) - B_this))


def load_angle(lib: Library, contact: Contact) -> Number:
    """(theta - sin(theta) cos(theta))/2."""
    tau2 = contact.tau2
    return lib.sqrt(tau2) / (1 + tau2) * (A(lib, tau2) + 2 * tau2 / (1 + tau2))


def rim_angle(lib: Library, contact: Contact) -> Number:
    """theta = arccos(a/b)."""
    return 2 * lib.atan(lib.sqrt(contact.tau2))


def newton_step(lib: Library, a: Number, d: Number, length: Number) -> Number:
    """The change of log d that Newton's method asks for; length² = P R/E*."""
    b = a + d
    contact = Contact(a, b, 0 * b, d)
    angle = load_angle(lib, contact)
    excess = lib.log((b / length) * (b / length) * angle)
    return -excess * angle / (d / b * rim_angle(lib, contact))


def coefficient(lib: Library, n: int, contact: Contact) -> Number:
    """R/(E* b) b_n."""
    overlap = load_angle(lib, contact) if n == 0 else _overlap(lib, n, contact)
    return 2 / lib.pi * overlap / (2 * n + 1)


def _overlap(lib: Library, n: int, contact: Contact) -> Number:
    """∫_0^theta sin(mt) sin(t) dt for m = 2n+1 > 1.

    It is [cos(theta) sin(m theta) - m sin(theta) cos(m theta)]/(m²-1).
    """
    short, long = partial(_overlap_short_flat, n), partial(_overlap_long_flat, n)
    return pick(lib, contact.a < contact.b / 2, short, long, contact)


def _overlap_short_flat(n: int, lib: Library, contact: Contact) -> Number:
    """By phi0 = pi/2 - theta, which is small where cos(m theta) would lose it."""
    m, phi0 = 2 * n + 1, lib.asin(contact.a / contact.b)
    terms = m * lib.cos(phi0) * lib.sin(m * phi0) - lib.sin(phi0) * lib.cos(m * phi0)
    return (-1) ** (n + 1) * terms / (4 * n * (n + 1))


def _overlap_long_flat(n: int, lib: Library, contact: Contact) -> Number:
    theta = rim_angle(lib, contact)
    return pick(
        lib,
        (2 * n + 2) * theta < 1,
        partial(_overlap_series, n),
        partial(_overlap_closed, n),
        theta,
    )


def _overlap_closed(n: int, lib: Library, theta: Number) -> Number:
    m = 2 * n + 1
    return (lib.cos(theta) * lib.sin(m * theta) - m * lib.sin(theta) * lib.cos(m * theta)) / (
        4 * n * (n + 1)
    )


def _overlap_series(n: int, lib: Library, theta: Number) -> Number:
    """The overlap in powers of theta, for (2n+2) theta < 1.

    The differences in the coefficients are of integers, hence exact.
    """
    total = 0 * theta
    for k in range(bits(lib) // 6 + 3, 0, -1):  # 1/(2k+1)! falls by more than six bits a term
        difference = (2 * n + 2) ** (2 * k) - (2 * n) ** (2 * k)
        total = fraction(difference, 2 * math.factorial(2 * k + 1), lib) - total * theta * theta
    return total * theta * theta * theta


def _distances(lib: Library, z: Number, contact: Contact) -> tuple[Number, Number, Number]:
    """z - b, z + b and sqrt(z² - b²) for z off the cut."""
    right, left = (z - contact.b) - contact.low, (z + contact.b) + contact.low
    return right, left, lib.sqrt(right) * lib.sqrt(left)


def _rho(lib: Library, z: Number, contact: Contact) -> Number:
    return contact.b / (z + _distances(lib, z, contact)[2])


def _is_far(rho: Number) -> Number:
    return abs(rho) * abs(rho) < SMALL_SQUARE


def _odd_series(lib: Library, rho: Number, contact: Contact, weight: int) -> Number:
    """R/(E* b) sum_n (2n+1)^weight b_n rho^(2n+1) for |rho|² < SMALL_SQUARE."""
    total, rho2 = 0 * rho, rho * rho
    for n in range(bits(lib) // BITS_A_TERM + 3, -1, -1):
        total = total * rho2 + (2 * n + 1) ** weight * coefficient(lib, n, contact)
    return total * rho


def _end_terms(
    term: Callable[..., Number], lib: Library, z: Number, contact: Contact
) -> tuple[Number, Number]:
    """`term` of y = i tau v and of y = i tau/v, with 1 - y² from z - a and from z + a."""
    right, left, _ = _distances(lib, z, contact)
    tau2, scale, a = contact.tau2, contact.scale, contact.a
    at_right = term(lib, -tau2 * (left / right), scale * ((z - a) / right))
    at_left = term(lib, -tau2 * (right / left), scale * ((z + a) / left))
    return at_right, at_left


def potential_on_cut(lib: Library, z: Number, contact: Contact, *, side: int) -> Number:
    """pi R/(E* b) Fp for real z in the contact."""
    x = z.real
    tilt = lib.pi / 2 * (beyond(x, contact.a) / contact.b) * sign(x)
    return cartesian(tilt, -seen_from(z, side) * pressure(lib, abs(x), contact), lib)


def potential_off_cut(lib: Library, z: Number, contact: Contact) -> Number:
    """pi R/(E* b) Fp elsewhere."""
    rho = _rho(lib, z, contact)
    return pick(lib, _is_far(rho), _potential_far, _potential_near, z, rho, contact)


def _potential_near(lib: Library, z: Number, rho: Number, contact: Contact) -> Number:
    tau2, root = contact.tau2, _distances(lib, z, contact)[2]
    at_right, at_left = _end_terms(B, lib, z, contact)
    return -root / contact.b * lib.sqrt(tau2) / (1 + tau2) * (at_right + at_left + 2 * A(lib, tau2))


def _potential_far(lib: Library, z: Number, rho: Number, contact: Contact) -> Number:
    return lib.pi * _odd_series(lib, rho, contact, weight=0)


def derivative_on_cut(lib: Library, z: Number, contact: Contact, *, side: int) -> Number:
    """pi R/E* Fp' for real z in the contact."""
    x, a = abs(z.real), contact.a
    curvature = lib.pi / 4 * (((x > a) | (a == 0)) * 1 + (x >= a) * 1)
    steepness = pick(lib, (x == 0) | (contact.rim == 0), nothing, _pressure_slope, x, contact)
    return cartesian(curvature, -seen_from(z, side) * sign(z.real) * steepness, lib)


def derivative_off_cut(lib: Library, z: Number, contact: Contact) -> Number:
    """pi R/E* Fp' elsewhere."""
    rho = _rho(lib, z, contact)
    return pick(lib, _is_far(rho), _derivative_far, _derivative_near, z, rho, contact)


def _derivative_near(lib: Library, z: Number, rho: Number, contact: Contact) -> Number:
    right, left, _ = _distances(lib, z, contact)
    v, middle = lib.sqrt(left) / lib.sqrt(right), atan_excess(lib, contact.tau2)
    at_right, at_left = _end_terms(artanh_excess, lib, z, contact)
    return lib.sqrt(contact.tau2) * (v * (at_right - middle) + (at_left - middle) / v)


def _derivative_far(lib: Library, z: Number, rho: Number, contact: Contact) -> Number:
    root = _distances(lib, z, contact)[2]
    return -lib.pi * (contact.b / root) * _odd_series(lib, rho, contact, weight=1)


def _pressure_slope(lib: Library, x: Number, contact: Contact) -> Number:
    """pi R/E* p' at x > 0."""
    near = (contact.b - x) + contact.low
    return pick(
        lib, (near <= 0) | (x == contact.a), _infinite_slope, _finite_slope, x, near, contact
    )


def _infinite_slope(lib: Library, x: Number, near: Number, contact: Contact) -> Number:
    """+inf at the end of the flat, where p' ~ -ln|x - a|, -inf at the end of the contact."""
    return lib.inf * (2 * (near > 0) - 1)


def _finite_slope(lib: Library, x: Number, near: Number, contact: Contact) -> Number:
    a, far, tau2, scale = contact.a, contact.b + x, contact.tau2, contact.scale
    T2, middle = near / far, atan_excess(lib, tau2)
    T = lib.sqrt(T2)
    this_end = artanh_excess(lib, tau2 / T2, scale * (abs(a - x) / near)) - middle
    other_end = artanh_excess(lib, tau2 * T2, scale * ((a + x) / far)) - middle
    return lib.sqrt(tau2) * (this_end / T - T * other_end)
