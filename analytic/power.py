"""An indenter of power form pressed on a half-plane: h = C |x|^m, m >= 1.

With W_m = ∫_0^(pi/2) sin^m and xi = |x|/b (Shtaerman 1949; Johnson, Contact Mechanics, 1985,
section 5.3)

    P = E* C m b^m W_m,      p = (m P/(pi b)) J_m(xi)
    J_m(xi) = ∫_xi^1 s^(m-1) / sqrt(s² - xi²) ds,

which superposes the pressures of rigid flats of half-width b s, 0 < s < 1. J is hypergeometric;
three positive formulas give it to full relative accuracy for every m, from the centre to the edge:

    m > 3           (m-1) J_m = sqrt(1 - xi²) + (m-2) xi² J_(m-2), by parts
    xi² >= 1/2      J_m = k 2F1(1 - m/2, 1; 3/2; k²), k² = 1 - xi²
    xi² < 1/2       J_m = (xi/e)^(m-1) J_m(e) + sum_k c_k xi^(2k) ∫_(xi/e)^1 s^(m-2-2k) ds,
                    e² = 1/2, c_k = C(2k,k)/4^k

(the last by the binomial series of (1 - xi²/s²)^(-1/2) where s > xi/e). m = 1 is the wedge, m = 2
the parabola.
"""

import math
from functools import partial

import numpy as np

from analytic._core.documentation import JOHNSON, documented
from analytic._core.numbers import Library, Number, as_result, bits, fraction, sign
from analytic._core.parameters import positive, positives, real, representable
from analytic._core.piecewise import nothing, pick

SOURCES = (
    "I. Ya. Shtaerman, Contact Problem of the Theory of Elasticity (1949)",
    f"{JOHNSON}, section 5.3",
)

# xi² = e² at which the two series meet. Both gain one bit a term there.
MATCH_SQUARE = 1 / 2
# Every step of the recurrence takes 2 from the exponent.
LARGEST_EXPONENT = 1000


@documented("the gap h, a length >= 0", *SOURCES)
def height(x: Number, *, exponent: Number, coefficient: Number, lib: Library = np) -> Number:
    """The undeformed gap h = C |x|^m.

    >>> float(height(-2.0, exponent=3.0, coefficient=0.5))
    4.0
    """
    m, C = _shape(exponent, coefficient, lib)
    return representable("height", lambda x: C * abs(x) ** m, real("x", x, lib))


@documented("the slope h', a number", *SOURCES)
def slope(x: Number, *, exponent: Number, coefficient: Number, lib: Library = np) -> Number:
    """The slope h' = m C sign(x) |x|^(m-1).

    >>> float(slope(-2.0, exponent=3.0, coefficient=0.5))
    -6.0
    """
    m, C = _shape(exponent, coefficient, lib)
    return representable("slope", lambda x: sign(x) * m * C * abs(x) ** (m - 1), real("x", x, lib))


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, half_width: Number, exponent: Number, coefficient: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The contact pressure p = (m P/(pi b)) J_m(|x|/b), and 0 outside.

    The pressure is infinite only for m = 1 at x = 0.

    >>> round(float(pressure(0.6, half_width=1.0, exponent=2.0, coefficient=0.5, modulus=2.0)), 12)
    0.8
    """
    x, (b, E) = abs(real("x", x, lib)), positives(lib, half_width=half_width, modulus=modulus)
    m, C = _shape(exponent, coefficient, lib)
    scale = E * m * m * (C * b ** (m - 1)) * _wallis(lib, m) / lib.pi
    return as_result(scale * pick(lib, x < b, partial(_superposed, m), nothing, x, b))


@documented("the normal load P per unit length, a force per length", *SOURCES)
def load(
    *, half_width: Number, exponent: Number, coefficient: Number, modulus: Number, lib: Library = np
) -> Number:
    """The normal load P = E* C m b^m (sqrt(pi)/2) Gamma((m+1)/2)/Gamma(m/2+1) per unit length.

    >>> round(float(load(half_width=1.0, exponent=2.0, coefficient=0.5, modulus=1.0)), 12)
    0.785398163397
    """
    b, E = positives(lib, half_width=half_width, modulus=modulus)
    m, C = _shape(exponent, coefficient, lib)
    return as_result(E * m * (C * b ** (m - 1)) * b * _wallis(lib, m))


@documented("half the length of the contact, a length", *SOURCES)
def half_width(
    *, normal_load: Number, exponent: Number, coefficient: Number, modulus: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The half-width b: the inverse of `load`.

    >>> round(float(half_width(normal_load=np.pi, exponent=2.0, coefficient=0.5, modulus=1.0)), 12)
    2.0
    """
    P, E = positives(lib, normal_load=normal_load, modulus=modulus)
    m, C = _shape(exponent, coefficient, lib)
    return as_result((P / E / C / (m * _wallis(lib, m))) ** (1 / m))


def _shape(exponent: Number, coefficient: Number, lib: Library) -> tuple[Number, Number]:
    m = real("exponent", exponent, lib)
    if np.ndim(m) > 0 or not 1 <= m <= LARGEST_EXPONENT:
        raise ValueError(
            f"exponent = {exponent} is not a single number from 1 to {LARGEST_EXPONENT}; below 1 "
            "the indenter is a cusp pointing down, whose slope is infinite at its tip; each 2 "
            "above takes a step of a recurrence, and several exponents take a call each."
        )
    return as_result(m), positive("coefficient", coefficient, lib)


def _wallis(lib: Library, m: Number) -> Number:
    """W_m = ∫_0^(pi/2) sin^m = (sqrt(pi)/2) Gamma((m+1)/2)/Gamma(m/2+1).

    W_m = (m-1)/m W_(m-2) leads to it from 1 <= m <= 3.
    """
    gamma = math.gamma if lib is np else lib.gamma
    steps = _steps(m)
    least = m - 2 * steps
    total = lib.sqrt(lib.pi) / 2 * gamma((least + 1) / 2) / gamma(least / 2 + 1)
    for step in range(steps):
        total = total * (m - 2 * step - 1) / (m - 2 * step)
    return total


def _steps(m: Number) -> int:
    """How many times 2 is taken from m to reach 1 <= m <= 3, where the formulas start."""
    steps: int = max(0, math.ceil((m - 3) / 2))
    return steps


def _superposed(m: Number, lib: Library, x: Number, b: Number) -> Number:
    """J_m(x/b) for 0 <= x < b: from the exponent in (1, 3], or 1, upwards by steps of two."""
    steps = _steps(m)
    least = m - 2 * steps
    xi2, k2 = (x / b) * (x / b), (b - x) / b * ((b + x) / b)
    start, edge = partial(_near_centre, least), partial(_near_edge, least)
    total = pick(lib, xi2 < MATCH_SQUARE, start, edge, x / b, k2)
    for step in range(steps - 1, -1, -1):
        n = m - 2 * step
        total = (lib.sqrt(k2) + (n - 2) * xi2 * total) / (n - 1)
    return total


def _near_edge(m: Number, lib: Library, xi: Number, k2: Number) -> Number:
    """k 2F1(1 - m/2, 1; 3/2; k²), 1 <= m <= 3, k² <= 1/2."""
    total = 1 + 0 * k2
    for j in range(bits(lib) + 2, -1, -1):
        total = 1 + total * k2 * (2 - m + 2 * j) / (2 * j + 3)
    return lib.sqrt(k2) * total


def _near_centre(m: Number, lib: Library, xi: Number, k2: Number) -> Number:
    return pick(lib, xi > 0, partial(_beside_centre, m), partial(_at_centre, m), xi)


def _at_centre(m: Number, lib: Library, xi: Number) -> Number:
    return 1 / (m - 1) + 0 * xi if m > 1 else lib.inf


def _beside_centre(m: Number, lib: Library, xi: Number) -> Number:
    """The series in xi², from where the edge's series ends, 1 <= m <= 3, 0 < xi² < 1/2."""
    e2 = fraction(1, 2, lib)
    r = xi / lib.sqrt(e2)
    depth, tail = -lib.log(r), r ** (m - 1)
    # The terms k = 0 and k = 1 are (1 - r^q)/q with q near 0 for m near 1 and near 3.
    total = tail * _near_edge(m, lib, lib.sqrt(e2), e2) + _decay(lib, m - 1, depth)
    total = total + e2 / 2 * tail * _decay(lib, 3 - m, depth)
    power = r * r
    for k in range(2, bits(lib) + 2):
        power = power * r * r
        total = total + fraction(math.comb(2 * k, k), 8**k, lib) * (tail - power) / (2 * k + 1 - m)
    return total


def _decay(lib: Library, q: Number, depth: Number) -> Number:
    """∫_0^depth exp(-q t) dt."""
    return -lib.expm1(-q * depth) / q if q != 0 else depth
