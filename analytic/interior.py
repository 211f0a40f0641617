"""Stresses inside the half-plane y > 0 under a pressure p and, in full sliding, a shear q = f p.

With the potential F(z) = (1/pi) ∫ p(t)/(z-t) dt of the pressure, z = x + iy, all follows from F and
F' (Muskhelishvili 1953, § 93; Hills, Nowell & Sackfield 1993, ch. 3; Ciavarella, Hills & Monno
1998, eq. (21), with the bar read as conj(Phi(conj z))):

    pressure     s_xx = Im F + y Re F'        s_yy = Im F - y Re F'      s_xy = -y Im F'
    shear q = p  s_xx = -2 Re F + y Im F'     s_yy = -y Im F'            s_xy = Im F + y Re F'

The shear's s_xy is the pressure's s_xx, and its s_yy the pressure's s_xy, whatever the profile. On
the surface s_yy = -p, s_xy = -q. The potentials are free of cancellation at every depth, far away
too, and so are the stresses.

McEwen's form (1949; Johnson 1985, eq. 4.49) of the line contact is there as printed, with its
auxiliary lengths m and n.
"""

from typing import Any, NamedTuple

import numpy as np

from analytic import hertz as _hertz
from analytic import rounded_flat as _rounded_flat
from analytic._core.cut import root
from analytic._core.documentation import HILLS, MUSKHELISHVILI, documented
from analytic._core.numbers import Library, Number, as_result, cartesian, larger
from analytic._core.parameters import not_negative, positive, positives, real, refuse

SOURCES = (
    f"{MUSKHELISHVILI}, section 93",
    f"{HILLS}, chapter 3",
)


class Stresses(NamedTuple):
    """Components of the stress; tension is positive, y the depth."""

    xx: Number
    yy: Number
    xy: Number


@documented("the components xx, yy and xy of the stress", *SOURCES)
def hertz(
    x: Number, y: Number, *, half_width: Number, radius: Number, modulus: Number,
    friction: Number = 0, lib: Library = np,
) -> Stresses:  # fmt: skip
    """The stresses under a parabola, normal (friction = 0) or sliding, q = f p.

    The source is § 3.4 of Hills, Nowell & Sackfield (1993).

    ValueError for y < 0.

    >>> [round(float(s), 12) + 0 for s in hertz(0.0, 1.0, half_width=1.0, radius=1.0, modulus=2.0)]
    [-0.12132034356, -0.707106781187, 0.0]
    """
    parameters = {"half_width": half_width, "radius": radius, "modulus": modulus, "lib": lib}
    return _stresses(_hertz, parameters, x, y, friction)


@documented("the components xx, yy and xy of the stress", *SOURCES)
def rounded_flat(
    x: Number, y: Number, *, half_flat: Number, radius: Number, modulus: Number,
    half_width: Number = None, rim: Number = None, friction: Number = 0, lib: Library = np,
) -> Stresses:  # fmt: skip
    """The stresses under a flat with rounded edges, normal or sliding.

    The stresses follow from Fp and Fp' in closed form (see `rounded_flat`).

    >>> given = dict(half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0, friction=0.5)
    >>> [round(float(s), 12) for s in rounded_flat(0.9, 0.0, **given)]
    [-0.339463081416, -0.139463081416, -0.069731540708]
    """
    parameters = {
        "half_flat": half_flat,
        "radius": radius,
        "modulus": modulus,
        "half_width": half_width,
        "rim": rim,
        "lib": lib,
    }
    return _stresses(_rounded_flat, parameters, x, y, friction)


@documented("the components xx, yy and xy of the stress", *SOURCES)
def mcewen(
    x: Number, y: Number, *, half_width: Number, peak_pressure: Number, lib: Library = np
) -> Stresses:
    """The stresses under the frictionless line contact, as McEwen (1949) wrote them.

    The formulas are eq. 4.49 of Johnson (1985):

        s_xx = -(p0/b) [ m (1 + (y²+n²)/(m²+n²)) - 2y ]
        s_yy = -(p0/b) m (1 - (y²+n²)/(m²+n²))
        s_xy = -(p0/b) n (m²-y²)/(m²+n²)

    with n + im = sqrt(z² - b²), m > 0. At depth the terms of s_xx cancel like (y/b)²: for numbers
    use `hertz`. y > 0.

    >>> [round(float(s), 12) + 0 for s in mcewen(0.0, 1.0, half_width=1.0, peak_pressure=1.0)]
    [-0.12132034356, -0.707106781187, 0.0]
    """
    x, y = real("x", x, lib), positive("y", y, lib)
    b, p0 = positives(lib, half_width=half_width, peak_pressure=peak_pressure)
    w = root(lib, cartesian(x, y, lib), b)
    n, m = w.real, w.imag
    largest = larger(abs(n), larger(m, y, lib), lib)  # squares of far points are no doubles
    nn, mm, yy = (n / largest) ** 2, (m / largest) ** 2, (y / largest) ** 2
    share = (yy + nn) / (mm + nn)
    scale = p0 / b
    xy = -scale * (n * ((mm - yy) / (mm + nn)))
    return Stresses(
        as_result(-scale * (m * (1 + share) - 2 * y)),
        as_result(-scale * m * (1 - share)),
        as_result(xy),
    )


@documented("the components xx, yy and xy of the stress", *SOURCES)
def chebyshev(
    x: Number, y: Number, *, coefficients: Number, half_width: Number, friction: Number = 0,
    lib: Library = np,
) -> Stresses:  # fmt: skip
    """The stresses at y > 0 of a pressure given by its Chebyshev coefficients.

    The pressure is p = sqrt(1 - (x/b)²) sum_n b_n U_2n(x/b) (Ciavarella, Hills & Monno 1998, eqs 22
    and 23):

        F = sum_n b_n rho^(2n+1),      rho = b/(z + sqrt(z² - b²))
        F' = -sum_n (2n+1) b_n rho^(2n+1) / sqrt(z² - b²)

    exact for a finite sum. For the rounded flat b_n ~ n^-2: what is cut off falls like |rho|^(2N),
    fast at depth only.

    >>> [round(float(s), 12) + 0 for s in chebyshev(0.0, 1.0, coefficients=[1.0], half_width=1.0)]
    [-0.12132034356, -0.707106781187, 0.0]
    """
    x, y, f = real("x", x, lib), positive("y", y, lib), real("friction", friction, lib)
    b = positive("half_width", half_width, lib)
    try:
        terms = [real("coefficients", term, lib) for term in coefficients]
    except TypeError:
        raise ValueError(
            f"coefficients = {coefficients!r} is not a list; give b_0, b_1, ..."
        ) from None
    z = cartesian(x, y, lib)
    w = root(lib, z, b)
    rho = b / (z + w)
    F, steep = 0 * rho, 0 * rho
    for n, term in reversed(list(enumerate(terms))):
        F = F * rho * rho + term
        steep = steep * rho * rho + (2 * n + 1) * term
    return _combined(F * rho, -steep * rho / w, y, f)


@documented("J2, a stress squared", *SOURCES)
def second_invariant(stress: Stresses, *, poisson: Number, lib: Library = np) -> Number:
    """The invariant J2 of the stress deviator in plane strain.

    J2 = ((s_xx - s_yy)/2)² + s_xy² + (1-2nu)²/3 ((s_xx + s_yy)/2)².

    >>> round(float(second_invariant(Stresses(-1.0, -1.0, 0.0), poisson=0.0)), 12)
    0.333333333333
    """
    nu = real("poisson", poisson, lib)
    xx, yy, xy = (real(name, getattr(stress, name, None), lib) for name in Stresses._fields)
    half_sum, half_difference = (xx + yy) / 2, (xx - yy) / 2
    return as_result(half_difference**2 + xy**2 + (1 - 2 * nu) ** 2 * half_sum**2 / 3)


@documented("the load P/(bk), a number", *SOURCES)
def hertz_limit_on_surface(*, friction: Number, poisson: Number, lib: Library = np) -> Number:
    """The load P/(bk) at which a sliding line contact yields on its surface.

    The load is (pi/2)/sqrt(f² + (1-2nu)²(1+f²)/3), and yield begins at x = b f/sqrt(1+f²).

    There J2 = p0² [f² + (1-2nu)²/3 (1+f²)] is the largest of the surface; for nu = 0.3 it is the
    largest of all from f = 0.27 or so.

    >>> round(float(hertz_limit_on_surface(friction=0.3, poisson=0.3)), 6)
    4.081253
    """
    f, nu = not_negative("friction", friction, lib), real("poisson", poisson, lib)
    return as_result(lib.pi / 2 / lib.sqrt(f * f + (1 - 2 * nu) ** 2 * (1 + f * f) / 3))


def _stresses(
    indenter: Any, parameters: dict[str, Number], x: Number, y: Number, f: Number
) -> Stresses:
    """Stresses from the potentials of a module of this package.

    On the surface they are without F', which is infinite at the edges.
    """
    lib = parameters["lib"]
    x, y, f = real("x", x, lib), _depth(y, lib), real("friction", f, lib)

    def below(x: Number, y: Number) -> Stresses:
        z = cartesian(x, y, lib)
        return _combined(
            indenter.potential(z, **parameters),
            indenter.potential_derivative(z, **parameters),
            y,
            f,
        )

    def surface(x: Number, y: Number) -> Stresses:
        F = indenter.potential(cartesian(x, y, lib), **parameters)
        return _combined(F, 0 * F, y, f)

    if lib is not np:
        return (below if y > 0 else surface)(x, y)
    x, y = np.broadcast_arrays(x, y)
    out, deep = np.empty((3, *x.shape)), y > 0
    for at, formula in ((deep, below), (~deep, surface)):
        if at.any():
            out[:, at] = formula(x[at], y[at])
    return Stresses(*(as_result(component) for component in out))


def _combined(F: Number, dF: Number, y: Number, f: Number) -> Stresses:
    normal_xx, normal_yy, normal_xy = F.imag + y * dF.real, F.imag - y * dF.real, -y * dF.imag
    return Stresses(
        normal_xx + f * (y * dF.imag - 2 * F.real),
        normal_yy + f * normal_xy,
        normal_xy + f * normal_xx,
    )


def _depth(y: Number, lib: Library) -> Number:
    number = real("y", y, lib)
    refuse(number < 0, "y = {} is above the surface; give depths y >= 0.", number)
    return number
