"""A flat with rounded edges pressed on a half-plane.

h = 0 for |x| <= a, and h = (|x| - a)²/(2R) beyond.

The contact is [-b, b] with b > a. With theta = arccos(a/b) and x = b sin(phi), a = b sin(phi0), the
classical solution (Steuerman 1939; Shtaerman 1949; Ciavarella, Hills & Monno 1998, eqs 32 and 35)
is

    p = E*/(2 pi R) { 2 theta b cos(phi) + x ln|sin(phi + phi0)/sin(phi - phi0)|
                      + a ln|tan((phi + phi0)/2) tan((phi - phi0)/2)| },
    P = E* b²/(2R) (theta - sin(theta) cos(theta)).

So written, terms of order one cancel to the order (b - a)^(3/2): at 1 - a/b = 1e-8 half the digits
are gone. Here the same expressions are written in

    tau = tan(theta/2) = sqrt((b-a)/(b+a)),   T = sqrt((b-|x|)/(b+|x|)),   v = sqrt(z+b)/sqrt(z-b),
    A(y) = (1+y²) atan(y)/y - 1,               B(y) = 1 - (1-y²) artanh(y)/y = -A(iy),

where A and B are positive, ~ 2y²/3, and every sum is one of positive terms:

    p  = E* b/(pi R) 2 tau T/((1+tau²)(1+T²)) { 2A(tau) + B(tau T) + end },
         end = B(tau/T) if |x| <= a, else 2 - B(T/tau)
    P  = E* b²/(2R) 2 tau/(1+tau²) { A(tau) + 2 tau²/(1+tau²) },         dP/db = E* b theta/R
    Fp = E* b/(pi R) 2 tau v/((v²-1)(1+tau²)) { A(tau v) + A(tau/v) - 2A(tau) }

Fp(z) = (1/pi) ∫ p(t)/(z-t) dt is the potential; its sum cancels for v -> 1, far from the contact,
where the Chebyshev series is used instead. The differences |x| - a and b - |x| are taken from the
lengths themselves, never from tau and T.

The lengths may be given as `half_flat` and `half_width`, or as `half_flat` and `rim` = b - a: a
thin rim is known to full relative accuracy only in the second form.

Measured against 120 digits, for 1e-12 <= a/b <= 1 - 1e-12: the relative error of p is below 5e-15,
that of P and of b - a below 1e-15, that of Fp below 2e-14.
"""

import math
from collections.abc import Callable
from numbers import Integral

import numpy as np

from analytic._core import rounded_contact as unit
from analytic._core.cut import in_plane, on_cut
from analytic._core.documentation import CIAVARELLA, documented
from analytic._core.numbers import Library, Number, as_result, bits, most, scaled, sign
from analytic._core.parameters import not_negative, point, positive, positives, real, representable

SOURCES = (f"{CIAVARELLA}, equations (32) and (35)",)

# b - a = length / (HERTZ + THIN_RIM (a/length)^(1/3)), length² = P R/E*, joins the two limits a ->
# 0 and b -> a; it is only where Newton's method starts.
HERTZ = math.sqrt(math.pi) / 2
THIN_RIM = (8 / 3) ** (2 / 3) / 2
MOST_STEPS = 60

Formulas = tuple[Callable[..., Number], Callable[..., Number]]


@documented("the gap h, a length >= 0", *SOURCES)
def height(x: Number, *, half_flat: Number, radius: Number, lib: Library = np) -> Number:
    """The undeformed gap h = (|x| - a)²/(2R) beyond the flat, 0 on it.

    >>> float(height(3.0, half_flat=1.0, radius=4.0))
    0.5
    """
    x, a = real("x", x, lib), not_negative("half_flat", half_flat, lib)
    R = positive("radius", radius, lib)

    def gap(x: Number) -> Number:
        over = unit.beyond(x, a)
        return over * (over / (2 * R))

    return representable("height", gap, x)


@documented("the slope h', a number", *SOURCES)
def slope(x: Number, *, half_flat: Number, radius: Number, lib: Library = np) -> Number:
    """The slope h'(x) = sign(x) (|x| - a)/R beyond the flat, 0 on it.

    >>> float(slope(-3.0, half_flat=1.0, radius=4.0))
    -0.5
    """
    x, a = real("x", x, lib), not_negative("half_flat", half_flat, lib)
    return as_result(unit.beyond(x, a) / positive("radius", radius, lib) * sign(x))


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_flat: Number, radius: Number, modulus: Number, half_width: Number = None,
    rim: Number = None, lib: Library = np,
) -> Number:  # fmt: skip
    """The contact pressure p(x), and 0 outside the contact.

    The formula is eq. 32 of Ciavarella, Hills & Monno (1998).

    p is finite everywhere, with p' infinite at the ends of the flat and of the contact; the largest
    pressure lies outside the flat.

    >>> round(float(pressure(0.0, half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0)), 12)
    0.123732974194
    """
    x = real("x", x, lib)
    contact = unit.contact_of(half_flat, half_width, rim, lib)
    R, E = positives(lib, radius=radius, modulus=modulus)
    return as_result(E * (contact.b / R) / lib.pi * unit.pressure(lib, abs(x), contact))


@documented("the normal load P per unit length, a force per length", *SOURCES)
def load(
    *, half_flat: Number, radius: Number, modulus: Number, half_width: Number = None,
    rim: Number = None, lib: Library = np,
) -> Number:  # fmt: skip
    """The normal load P = E* b²/(2R) (theta - sin(theta) cos(theta)) per unit length.

    The difference is formed without cancellation.

    Ciavarella, Hills & Monno 1998, eq. (35).

    >>> round(float(load(half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0)), 12)
    0.307092424652
    """
    contact = unit.contact_of(half_flat, half_width, rim, lib)
    R, E = positives(lib, radius=radius, modulus=modulus)
    return as_result(E * (contact.b / R) * contact.b * unit.load_angle(lib, contact))


@documented("half the length of the contact, a length", *SOURCES)
def half_width(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, lib: Library = np
) -> Number:
    """The half-width b of the contact under the load P: the inverse of `load`.

    b - a has the full accuracy of `rim`, but a sum has only that of its larger term: for thin rims
    ask for `rim`.

    >>> found = half_width(normal_load=0.307092424652, half_flat=0.5, radius=1.0, modulus=1.0)
    >>> round(float(found), 11)
    1.0
    """
    a = not_negative("half_flat", half_flat, lib)
    return as_result(
        a + rim(normal_load=normal_load, half_flat=a, radius=radius, modulus=modulus, lib=lib)
    )


@documented("the length b - a", *SOURCES)
def rim(
    *, normal_load: Number, half_flat: Number, radius: Number, modulus: Number, lib: Library = np
) -> Number:
    """The length b - a on which the rounding touches at each end, under the load P.

    The length has full relative accuracy.

    Newton's method for log P against log(b - a), with dP/db = E* b theta/R. The graph is convex,
    its slope between 3/2 and 2, so that the method converges from any start.

    >>> round(float(rim(normal_load=0.307092424652, half_flat=0.5, radius=1.0, modulus=1.0)), 11)
    0.5
    """
    P, R, E = positives(lib, normal_load=normal_load, radius=radius, modulus=modulus)
    a = not_negative("half_flat", half_flat, lib)
    length = lib.sqrt(P / E) * lib.sqrt(R)  # P R/E* itself could overflow
    d = length / (HERTZ + THIN_RIM * lib.cbrt(a / length))
    for _ in range(MOST_STEPS):
        step = unit.newton_step(lib, a, d, length)
        d = d * lib.exp(step)
        # The error that is left is of the order of step².
        if most(step * step, lib) < 2.0 ** -bits(lib):
            break
    return as_result(d)


@documented("the potential Fp, a complex stress", *SOURCES)
def potential(
    z: Number, *, half_flat: Number, radius: Number, modulus: Number, half_width: Number = None,
    rim: Number = None, side: int = +1, lib: Library = np,
) -> Number:  # fmt: skip
    """The complex potential Fp(z) = (1/pi) ∫ p(t)/(z-t) dt, at any z = x + iy.

        Fp = E*/(pi R) [ (z-a) atan(tau v) + (z+a) atan(tau/v) - theta sqrt(z²-b²) ]
        Fp ~ P/(pi z) far away.

    Real z in the contact are on the cut: there `side` = +1 gives the limit from the body y > 0,
    E*/2 h' - i p, and -1 its conjugate. It is Muskhelishvili's function of the pressure (Hills,
    Nowell & Sackfield 1993, ch. 2) but for a constant.

    >>> complex(potential(0.9, half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0)).real
    0.2
    """
    contact = unit.contact_of(half_flat, half_width, rim, lib)
    R, E = positives(lib, radius=radius, modulus=modulus)
    value = _in_plane(lib, z, side, contact, (unit.potential_on_cut, unit.potential_off_cut))
    return as_result(scaled(E * (contact.b / R) / lib.pi, value, lib))


@documented("the derivative Fp', a complex stress per length", *SOURCES)
def potential_derivative(
    z: Number, *, half_flat: Number, radius: Number, modulus: Number, half_width: Number = None,
    rim: Number = None, side: int = +1, lib: Library = np,
) -> Number:  # fmt: skip
    """The derivative Fp'(z) = E*/(pi R) [ atan(tau v) + atan(tau/v) - theta z/sqrt(z²-b²) ].

    On the contact it is E*/2 h'' - i p' on the side +1, conjugate on the side -1. At |x| = a and
    |x| = b, where p' is infinite, so is the imaginary part (and h'' is the mean of its two values
    at |x| = a).

    >>> found = potential_derivative(0.9, half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0)
    >>> complex(found).real
    0.5
    """
    contact = unit.contact_of(half_flat, half_width, rim, lib)
    value = _in_plane(lib, z, side, contact, (unit.derivative_on_cut, unit.derivative_off_cut))
    R, E = positives(lib, radius=radius, modulus=modulus)
    return as_result(scaled(E / R / lib.pi, value, lib))


def _in_plane(
    lib: Library, z: Number, side: int, contact: unit.Contact, formulas: Formulas
) -> Number:
    """The first formula on the cut of the contact, the second off it."""
    z = point(z, lib)
    return in_plane(lib, on_cut(lib, z, contact.b, contact.low), side, *formulas, z, contact)


@documented("the coefficients b_n, stresses, with the index n first", *SOURCES)
def chebyshev_coefficients(
    count: int, *, half_flat: Number, radius: Number, modulus: Number, half_width: Number = None,
    rim: Number = None, lib: Library = np,
) -> Number:  # fmt: skip
    """The first `count` coefficients b_n of p(x), an array or a list.

    p(x) = sqrt(1 - (x/b)²) sum_n b_n U_2n(x/b).

    Ciavarella, Hills & Monno 1998, eq. (22). With these, Fp(z) = sum_n b_n rho^(2n+1), rho = b/(z +
    sqrt(z²-b²)), and

        b_n = E* b/(2 pi R (2n+1)) [ sin(2n theta)/n - sin(2(n+1) theta)/(n+1) ]
            = 2E* b/(pi R (2n+1)) ∫_0^theta sin((2n+1)t) sin(t) dt
        b_0 = 2P/(pi b),      b_n = O(n^-2).

    The error relative to the largest of the neighbours is some rounding units plus n of them in the
    phase 2n theta. Arrays of parameters broadcast behind the index n.

    >>> found = chebyshev_coefficients(2, half_flat=0.0, half_width=1.0, radius=1.0, modulus=1.0)
    >>> found.round(12) + 0
    array([0.5, 0. ])
    """
    if not isinstance(count, Integral) or count < 0:
        raise ValueError(f"count = {count} is not a number of coefficients; give an integer >= 0.")
    contact = unit.contact_of(half_flat, half_width, rim, lib)
    R, E = positives(lib, radius=radius, modulus=modulus)
    scale = E * (contact.b / R)
    b_n = [scale * unit.coefficient(lib, n, contact) for n in range(int(count))]
    return np.array(b_n) if lib is np else b_n
