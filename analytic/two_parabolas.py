"""Two equal parabolas of one piece, pressed on a half-plane.

Their apexes are at x = ±d, h = (|x| - d)²/(2R).

The contact is c1 < |x| < c2. In x² the problem is that of one patch, and the two conditions at its
edges turn out to be steps of the arithmetic-geometric mean of Gauss, a_(n+1) = (a_n + b_n)/2,
b_(n+1)² = a_n b_n, c_(n+1) = (a_n - b_n)/2, from a_0 = c2, b_0 = c1:

    d = agm(c2, c1),      P = (pi E*/(2R)) sum_n 2^(n-1) c_n²,  n >= 1
    p = (E* d/(3 pi R)) |x| sqrt((x² - c1²)(c2² - x²)) R_J(0, c1², c2², x²)

with Carlson's elliptic integral of the third kind. The first term, c_1 = (c2 - c1)/2, is Hertz
under P/2 on each parabola; the others are the effect of each patch on the other. The patches never
merge: c1 > 0 under any load, for h has a ridge at x = 0. (For the equations behind: Gladwell,
Contact Problems, 1980.)
"""

import numpy as np

from analytic._core.documentation import GLADWELL, documented
from analytic._core.elliptic import agm, means, ratio_D, third_kind
from analytic._core.numbers import Library, Number, as_result, bits, most, sign
from analytic._core.parameters import patch_ends, positive, positives, real, refuse, representable
from analytic._core.piecewise import nothing, pick

SOURCES = (GLADWELL,)

MOST_STEPS = 60
# ln(c2/c1) beyond which c1 is next to the least double.
FARTHEST = 600


@documented("the gap h, a length >= 0", *SOURCES)
def height(x: Number, *, distance: Number, radius: Number, lib: Library = np) -> Number:
    """The undeformed gap h = (|x| - d)²/(2R).

    >>> float(height(-3.0, distance=1.0, radius=4.0))
    0.5
    """
    x, d, R = (
        real("x", x, lib),
        positive("distance", distance, lib),
        positive("radius", radius, lib),
    )
    return representable("height", lambda x: (abs(x) - d) * ((abs(x) - d) / (2 * R)), x)


@documented("the slope h', a number", *SOURCES)
def slope(x: Number, *, distance: Number, radius: Number, lib: Library = np) -> Number:
    """The slope h' = sign(x) (|x| - d)/R.

    >>> float(slope(-3.0, distance=1.0, radius=4.0))
    -0.5
    """
    x = real("x", x, lib)
    return as_result(
        sign(x) * (abs(x) - positive("distance", distance, lib)) / positive("radius", radius, lib)
    )


@documented("the distance d, a length", *SOURCES)
def distance(*, inner: Number, outer: Number, lib: Library = np) -> Number:
    """The distance d = agm(c2, c1) of the apexes from the middle, for patches c1 < |x| < c2.

    >>> round(float(distance(inner=1.0, outer=2.0)), 12)
    1.456791031047
    """
    c1, c2 = patch_ends(inner, outer, lib)
    return as_result(agm(lib, c2, c1))


@documented("the normal load P per unit length, a force per length", *SOURCES)
def load(
    *, inner: Number, outer: Number, radius: Number, modulus: Number, lib: Library = np
) -> Number:
    """The load P = (pi E*/(2R)) (c_1² + 2 c_2² + 4 c_3² + ...) on both parabolas together.

    The sum has no cancellation.

    >>> round(float(load(inner=1.0, outer=2.0, radius=1.0, modulus=1.0) / np.pi), 12)
    0.126840027595
    """
    c1, c2 = patch_ends(inner, outer, lib)
    R, E = positives(lib, radius=radius, modulus=modulus)
    half = (c2 - c1) / 2
    return as_result(lib.pi / 2 * E * (half / R) * half * _gain(lib, half / c2, c1 / c2))


@documented("the edges (c1, c2) of the patch on x > 0, lengths", *SOURCES)
def edges(
    *, normal_load: Number, distance: Number, radius: Number, modulus: Number, lib: Library = np
) -> tuple[Number, Number]:
    """The edges (c1, c2) of the patch on x > 0 under the load P.

    The function is the inverse of `distance` and `load`.

    Newton's method for ln P against ln t, t = ln(c2/c1), with dP/dt = (pi E*/(2R)) c2² k² (D/K) (1
    - D/K), k² = 1 - (c1/c2)². ValueError for loads beyond about 1e5 E* d²/R, at which c1 leaves the
    range of doubles.

    >>> P = load(inner=1.0, outer=2.0, radius=1.0, modulus=1.0)
    >>> found = edges(normal_load=P, distance=distance(inner=1.0, outer=2.0), radius=1.0,
    ...               modulus=1.0)
    >>> tuple(round(float(c), 12) for c in found)
    (1.0, 2.0)
    """
    P, d = positives(lib, normal_load=normal_load, distance=distance)
    R, E = positives(lib, radius=radius, modulus=modulus)
    # The half-width of each without its neighbour
    length = lib.sqrt(2 * (P / E) / lib.pi) * lib.sqrt(R)
    t = 2 * length / d
    for _ in range(MOST_STEPS):
        _refuse_far(t, length / d)
        step = _newton_step(lib, t, length / d)
        t = t * lib.exp(step)
        if most(step * step, lib) < 2.0 ** -bits(lib):
            break
    c2 = d / agm(lib, 1 + 0 * t, lib.exp(-t))
    return as_result(c2 * lib.exp(-t)), as_result(c2)


@documented("the pressure p, a stress", *SOURCES)
def pressure(
    x: Number, *, inner: Number, outer: Number, radius: Number, modulus: Number, lib: Library = np
) -> Number:
    """The pressure p(x) on both patches c1 < |x| < c2, and 0 elsewhere.

    >>> round(float(pressure(1.5, inner=1.0, outer=2.0, radius=1.0, modulus=1.0)), 12)
    0.253652979653
    """
    r, (c1, c2) = abs(real("x", x, lib)), patch_ends(inner, outer, lib)
    R, E = positives(lib, radius=radius, modulus=modulus)
    return as_result(
        E / R / lib.pi * pick(lib, (r > c1) & (r < c2), _pressure_inside, nothing, r, c1, c2)
    )


def _gain(lib: Library, c: Number, kc: Number) -> Number:
    """1 + 2 (c_2/c_1)² + 4 (c_3/c_1)² + ..., for c2 = 1: c = c_1 = (1-k')/2."""
    total, weight = 0 * c, 1
    for _, c_n in means(lib, (1 + kc) / 2, lib.sqrt(kc), c):
        total = total + weight * (c_n / c) * (c_n / c)
        weight = 2 * weight
    return total


def _newton_step(lib: Library, t: Number, length: Number) -> Number:
    """The change of ln t; `length` in units of d, with P = (pi E*/(2R)) length²."""
    kc, c = lib.exp(-t), -lib.expm1(-t) / 2
    k2 = -lib.expm1(-2 * t)
    D_K = ratio_D(lib, lib.sqrt(k2), kc)
    load = c * c * _gain(lib, c, kc)  # over c2²
    c2 = 1 / agm(lib, 1 + 0 * kc, kc)
    excess = 2 * lib.log(c2 / length) + lib.log(load)
    return -excess * load / (t * k2 * D_K * (1 - D_K))


def _refuse_far(t: Number, length: Number) -> None:
    message = "normal_load = {} E* d²/R leaves c1/c2 < exp(-{}); give a smaller load."
    far = np.logical_not(t < FARTHEST)  # a step out of the range of doubles leaves a nan
    refuse(far, message, length * length * np.pi / 2, FARTHEST)


def _pressure_inside(lib: Library, r: Number, c1: Number, c2: Number) -> Number:
    """pi R/E* p, with R_J(0, c1², c2², x²) = 3 cel(c1/c2, x²/c2², 0, 1)/c2³."""
    roots = (
        lib.sqrt((r - c1) / c2)
        * lib.sqrt((c2 - r) / c2)
        * lib.sqrt((r + c1) / c2)
        * lib.sqrt((c2 + r) / c2)
    )
    return agm(lib, c2, c1) * (r / c2) * roots * third_kind(lib, c1 / c2, (r / c2) * (r / c2))
