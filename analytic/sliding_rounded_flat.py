"""A flat with rounded edges that slides, upright, over a dissimilar half-plane: q = f p.

h = 0 for |x| <= a and (|x| - a)²/(2R) beyond. With tan(pi eps) = -beta f the contact is [-a - d1, a
+ d2], of length L = 2a + d1 + d2, and with w(t) = (x2-t)^(1/2-eps) (t-x1)^(1/2+eps) the bounded
solution of the equation of sliding,

    E*/2 h'(x) = (1/pi) PV∫ p(t)/(x-t) dt - beta f p(x),

    p = cos²(pi eps) E*/(2 pi) w(x) PV∫ h'/(w(t) (t-x)) dt + sin(pi eps) cos(pi eps) E*/2 h'(x)
    0 = ∫ h'/w dt,      P = cos(pi eps) E*/2 ∫ t h'/w dt
    M = cos(pi eps) E*/2 ∫ t² h'/w dt - P ((1/2-eps) x2 + (1/2+eps) x1)

(Hills, Nowell & Sackfield, Mechanics of Elastic Contacts, 1993, for the inversion.) The condition
says how the load divides the rims. All the integrals are incomplete beta functions; with V =
(x2-x)/(x-x1), V2 = (x2-a)/(a-x1), alpha = 1/2 + eps, and phi, A, B of `_core.beta_functions` the
rim on the right contributes to 2 pi R p/(E* cos²(pi eps))

    w V2^alpha/(alpha (1+V2)) [A + B(V2/V)]                                      for x <= a
    w V2^alpha/alpha phi(-V2) + (x-a) (V/V2)^(1-alpha)/(1-alpha) phi(V/V2)       for x >= a,

the last phi with 1 - alpha, and the rim on the left as in a mirror, with -eps. All terms are
positive. Since the two edges depend on each other, the functions are given the load, which
determines both. `coupling` is beta f, positive when the shear on the half-plane points to +x.
Without it all this is the rounded flat.
"""

from typing import NamedTuple

import numpy as np

from analytic import rounded_flat
from analytic._core.beta_functions import A, B, phi, rim_moment
from analytic._core.documentation import HILLS, documented
from analytic._core.edge_exponents import cosine, sliding_exponent
from analytic._core.numbers import Library, Number, as_result, bits, larger, most
from analytic._core.parameters import not_negative, positives, real, refuse
from analytic._core.piecewise import nothing, pick

SOURCES = (HILLS,)

MOST_STEPS = 60
# |beta f| up to which the series, in the part of the contact that one rim is, end in reasonable
# time. beta is at most 1/2.
MOST_COUPLING = 10


@documented("the lengths (d1, d2)", *SOURCES)
def rims(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, coupling: Number,
    lib: Library = np,
) -> tuple[Number, Number]:  # fmt: skip
    """The lengths (d1, d2) on which the rounding touches on the left and on the right.

    The lengths have full relative accuracy.

    Newton's method in the logarithms of the rims, from those without friction.

    >>> found = rims(normal_load=0.307092424652, half_flat=0.5, radius=1.0, modulus=1.0,
    ...              coupling=0.0)
    >>> tuple(round(float(d), 11) for d in found)
    (0.5, 0.5)
    """
    contact = _contact_of(normal_load, half_flat, radius, modulus, coupling, lib=lib)
    return as_result(contact.left), as_result(contact.right)


@documented("the ends (x1, x2) of the contact, lengths", *SOURCES)
def edges(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, coupling: Number,
    lib: Library = np,
) -> tuple[Number, Number]:  # fmt: skip
    """The ends (x1, x2) = (-a - d1, a + d2) of the contact under the load P.

    >>> found = edges(normal_load=0.307092424652, half_flat=0.5, radius=1.0, modulus=1.0,
    ...               coupling=0.0)
    >>> tuple(round(float(x), 11) for x in found)
    (-1.0, 1.0)
    """
    contact = _contact_of(normal_load, half_flat, radius, modulus, coupling, lib=lib)
    return as_result(-contact.a - contact.left), as_result(contact.a + contact.right)


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number,
    coupling: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The contact pressure p(x) under the load P, and 0 outside. The shear is f times this.

    >>> given = dict(normal_load=0.307092424652189, half_flat=0.5, radius=1.0, modulus=1.0,
    ...              coupling=0.0)
    >>> round(float(pressure(0.0, **given)), 12)
    0.123732974194
    """
    x, (E, R) = real("x", x, lib), positives(lib, modulus=modulus, radius=radius)
    contact = _contact_of(normal_load, half_flat, radius, modulus, coupling, lib=lib)
    near, far = (contact.a - x) + contact.right, (contact.a + x) + contact.left
    value = pick(lib, (near > 0) & (far > 0), _pressure_inside, nothing, x, near, far, contact)
    return as_result(E / R * value / (2 * lib.pi))


@documented("the moment M, a force", *SOURCES)
def moment(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, coupling: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The moment M = ∫ p x dx about the middle of the flat, at which it stays upright.

    >>> found = moment(normal_load=1.0, half_flat=0.5, radius=1.0, modulus=1.0, coupling=0.0)
    >>> round(float(found), 12) + 0.0
    0.0
    """
    E, R = positives(lib, modulus=modulus, radius=radius)
    contact = _contact_of(normal_load, half_flat, radius, modulus, coupling, lib=lib)
    return as_result(E / R * _moment(lib, contact) / 2)


class _Contact(NamedTuple):
    """The lengths of a contact and beta f."""

    a: Number
    left: Number
    right: Number
    k: Number


class _Rim(NamedTuple):
    """Moments of one rim, and how their logarithms change with those of the rims."""

    first: Number  # D = ∫ (|t|-a)/w dt
    second: Number  # ∫ (|t|-a)²/w dt
    first_by: tuple[Number, Number]  # dD/d ln(own rim), dD/d ln(other rim)
    second_by: tuple[Number, Number]


def _contact_of(
    normal_load: Number, half_flat: Number, radius: Number, modulus: Number, coupling: Number, *,
    lib: Library,
) -> _Contact:  # fmt: skip
    P, R, E = positives(lib, normal_load=normal_load, radius=radius, modulus=modulus)
    a, k = not_negative("half_flat", half_flat, lib), real("coupling", coupling, lib)
    message = "coupling = {} is beyond ±{}, where the series end too late; give a smaller |beta f|."
    refuse(abs(k) > MOST_COUPLING, message, k, MOST_COUPLING)
    target = 2 * (P / E) * R / cosine(lib, k)
    start = rounded_flat.rim(normal_load=P, half_flat=a, radius=R, modulus=E, lib=lib) + 0 * k
    contact = _Contact(a, start, start, k)
    for _ in range(MOST_STEPS):
        left, right = _newton_step(lib, contact, target)
        contact = _Contact(a, contact.left * lib.exp(left), contact.right * lib.exp(right), k)
        # The error that is left is of the order of step².
        if most(larger(left * left, right * right, lib), lib) < 2.0 ** -bits(lib):
            break
    return contact


def _newton_step(lib: Library, contact: _Contact, target: Number) -> tuple[Number, Number]:
    """The changes of ln d1 and ln d2 for ln(D1/D2) = 0 and ln(load/target) = 0."""
    eps, a = sliding_exponent(lib, contact.k), contact.a
    left = _rim(lib, (1 - 2 * eps) / 2, contact.left, contact.right, a)
    right = _rim(lib, (1 + 2 * eps) / 2, contact.right, contact.left, a)
    uneven = lib.log(left.first / right.first)
    uneven_by_left = left.first_by[0] / left.first - right.first_by[1] / right.first
    uneven_by_right = left.first_by[1] / left.first - right.first_by[0] / right.first
    load = a * (left.first + right.first) + left.second + right.second
    short = lib.log(load / target)
    short_by_left = (
        a * (left.first_by[0] + right.first_by[1]) + left.second_by[0] + right.second_by[1]
    ) / load
    short_by_right = (
        a * (left.first_by[1] + right.first_by[0]) + left.second_by[1] + right.second_by[0]
    ) / load
    determinant = uneven_by_left * short_by_right - uneven_by_right * short_by_left
    by_left = (uneven * short_by_right - uneven_by_right * short) / determinant
    by_right = (uneven_by_left * short - uneven * short_by_left) / determinant
    return -by_left, -by_right


def _rim(lib: Library, alpha: Number, own: Number, other: Number, a: Number) -> _Rim:
    length = 2 * a + own + other
    values, changes = [], []
    for n in (1, 2):
        value, curving = rim_moment(lib, n, alpha, own, length)
        values.append(value)
        with_length = -(alpha + curving) / length
        changes.append(
            (value * (n + alpha + curving + with_length * own), value * with_length * other)
        )
    return _Rim(values[0], values[1], changes[0], changes[1])


def _moment(lib: Library, contact: _Contact) -> Number:
    """2R/E* M, by t² = a² + 2a u + u², u = |t| - a, and the equal first moments."""
    a, left, right, k = contact
    eps, length = sliding_exponent(lib, k), 2 * a + left + right
    on_left, on_right = (
        [rim_moment(lib, n, alpha, rim, length)[0] for n in (1, 2, 3)]
        for alpha, rim in (((1 - 2 * eps) / 2, left), ((1 + 2 * eps) / 2, right))
    )
    middle = (right - left) / 2 - eps * length
    load = a * (on_left[0] + on_right[0]) + on_left[1] + on_right[1]
    return cosine(lib, k) * (
        2 * a * (on_right[1] - on_left[1]) + (on_right[2] - on_left[2]) - middle * load
    )


def _pressure_inside(
    lib: Library, x: Number, near: Number, far: Number, contact: _Contact
) -> Number:
    """2 pi R/E* p."""
    eps, c = sliding_exponent(lib, contact.k), cosine(lib, contact.k)
    a, left, right, _ = contact
    from_right = _from_rim(lib, (1 + 2 * eps) / 2, _View(a - x, near, far, right, left, a))
    from_left = _from_rim(lib, (1 - 2 * eps) / 2, _View(a + x, far, near, left, right, a))
    return c * c * (from_right + from_left)


class _View(NamedTuple):
    """Lengths measured from one rim."""

    inside: Number  # from the end of the flat, inwards
    near: Number  # from its edge
    far: Number  # from the other edge
    rim: Number
    other: Number
    a: Number

    @property
    def rest(self) -> Number:
        """From the end of the flat to the other edge."""
        return 2 * self.a + self.other

    @property
    def length(self) -> Number:
        """From edge to edge."""
        return 2 * self.a + self.rim + self.other


def _from_rim(lib: Library, alpha: Number, view: _View) -> Number:
    """What one rim contributes."""
    return pick(lib, view.inside >= 0, _under_flat, _on_rim, alpha, view)


def _of_flat(lib: Library, alpha: Number, view: _View) -> Number:
    """w V2^alpha/(alpha (1+V2))."""
    return (
        view.near
        * ((view.far / view.near) * (view.rim / view.rest)) ** alpha
        / alpha
        * (view.rest / view.length)
    )


def _under_flat(lib: Library, alpha: Number, view: _View) -> Number:
    y = (view.rim / view.near) * (view.far / view.rest)
    c = (view.inside / view.near) * (view.length / view.rest)
    return _of_flat(lib, alpha, view) * (
        A(lib, alpha, view.rim / view.length) + B(lib, alpha, y, c)
    )


def _on_rim(lib: Library, alpha: Number, view: _View) -> Number:
    y = (view.near / view.rim) * (view.rest / view.far)
    c = (-view.inside / view.rim) * (view.length / view.far)
    on_rim = -view.inside * y ** (1 - alpha) / (1 - alpha) * phi(lib, 1 - alpha, y, c)
    return _of_flat(lib, alpha, view) * (1 + A(lib, alpha, view.rim / view.length)) + on_rim
