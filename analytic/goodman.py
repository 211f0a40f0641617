"""Dissimilar bodies pressed with friction, as Goodman (1962) approximated them.

beta q is left out of the normal equation.

The pressure is that without friction, and the shear q, with q = ± f p where the bodies slip
outwards, obeys

    (1/pi) PV∫ q(t)/(x-t) dt + beta p(x) = 0          |x| < c

under a flat punch of half-width b. For P = pi, b = 1 and K(k) the complete elliptic integral of
modulus k that is

    f/beta = K(c/b)/K(sqrt(1 - c²/b²)),

the limit of Spence's problem for small beta and f. The ratio of the integrals is the logarithm of
the nome, -pi/ln q, so that c/b is explicit in theta functions (Whittaker & Watson 1927, §§ 21.1,
22.3), with q = exp(-pi beta/f):

    c/b = (theta2(q)/theta3(q))²,      sqrt(1 - c²/b²) = (theta4(q)/theta3(q))²;

for f > beta the two change places and q = exp(-pi f/beta). c/b is the same under every symmetric
convex indenter that is pressed by a growing load (Spence 1975).
"""

import numpy as np

from analytic import flat
from analytic._core.documentation import documented
from analytic._core.numbers import Library, Number, as_result, bits, fraction, sign, smaller
from analytic._core.parameters import positive, real

GOODMAN = "L. E. Goodman, Contact stress analysis of normally loaded rough spheres (1962)"
SPENCE = "D. A. Spence, The Hertz contact problem with finite friction (1975)"
SOURCES = (GOODMAN, SPENCE)


@documented("c, a length", *SOURCES)
def stick_half_width(
    *, half_width: Number, friction: Number, dundurs: Number, lib: Library = np
) -> Number:
    """The half-width of the stick zone, for dundurs > 0.

    >>> round(float(stick_half_width(half_width=1.0, friction=0.01, dundurs=0.01)), 12)
    0.707106781187
    """
    b, k, _ = _moduli(half_width, friction, dundurs, lib)
    return as_result(b * k)


@documented("b - c, a length", *SOURCES)
def slip_width(
    *, half_width: Number, friction: Number, dundurs: Number, lib: Library = np
) -> Number:
    """The width of either slip zone to relative accuracy, for dundurs > 0.

    >>> float(slip_width(half_width=1.0, friction=1.0, dundurs=0.1)) < 2e-13
    True
    """
    b, k, complement = _moduli(half_width, friction, dundurs, lib)
    return as_result(b * complement * complement / (1 + k))


@documented("q, a stress: positive on the right", *SOURCES)
def flat_shear(
    x: Number, *, half_width: Number, normal_load: Number, friction: Number, dundurs: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The shear under a flat punch, f p F(arcsin(x/c), c/b)/K(c/b) in stick and f p in slip.

    Zero beside the contact, and at the edges infinite like the pressure. Landen's transformation
    gives the ratio of the integrals; it maps φ to φ + atan(tan φ g/a) (Abramowitz & Stegun 1964, §
    17.6).

    >>> args = {"half_width": 1.0, "normal_load": 1.0, "friction": 0.1, "dundurs": 0.1}
    >>> round(float(flat_shear(0.7071067811865475, **args)), 9)
    0.045015816
    """
    b, k, complement = _moduli(half_width, friction, dundurs, lib)
    f, P = positive("friction", friction, lib), positive("normal_load", normal_load, lib)
    part = abs(real("x", x, lib)) / (b * k)
    angle, a, g, scale = lib.asin(smaller(part, 1, lib)), 1, complement, 1
    for _ in range(bits(lib).bit_length() + 8):
        turns = lib.floor(angle / lib.pi + fraction(1, 2, lib))
        angle = angle + lib.atan(g / a * lib.sin(angle) / lib.cos(angle)) + turns * lib.pi
        a, g, scale = (a + g) / 2, lib.sqrt(a * g), 2 * scale
    ratio = _choose(lib, part < 1, 2 * angle / (lib.pi * scale), 1)
    return as_result(sign(x) * f * ratio * flat.pressure(x, half_width=b, normal_load=P, lib=lib))


def _moduli(
    half_width: Number, friction: Number, dundurs: Number, lib: Library
) -> tuple[Number, Number, Number]:
    """b, c/b and sqrt(1 - c²/b²)."""
    b = positive("half_width", half_width, lib)
    f, beta = positive("friction", friction, lib), positive("dundurs", dundurs, lib)
    sticks = f > beta
    ratio = _choose(lib, sticks, f / beta, beta / f)
    q = lib.exp(-lib.pi * ratio)
    theta2, theta3, theta4 = 1 + 0 * q, 1 + 0 * q, 1 + 0 * q
    n = 1
    while n * n * 3.14 < 0.7 * bits(lib) + 1:  # q^(n²) <= exp(-pi n²)
        theta2, theta3 = theta2 + q ** (n * (n + 1)), theta3 + 2 * q ** (n * n)
        theta4 = theta4 + 2 * (-1) ** n * q ** (n * n)
        n += 1
    small = 4 * lib.exp(-lib.pi * ratio / 2) * (theta2 / theta3) ** 2
    large = (theta4 / theta3) ** 2
    return b, _choose(lib, sticks, large, small), _choose(lib, sticks, small, large)


def _choose(lib: Library, condition: Number, one: Number, other: Number) -> Number:
    if lib is np:
        return np.where(condition, one, other)
    return one if condition else other
