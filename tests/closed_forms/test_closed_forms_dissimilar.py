"""Dissimilar bodies that slide or are bonded: true to their integral equations, in equilibrium, and
right in their limits.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from closed_forms import EPS, call, coarse, mp, of_every_call, principal_value, resultant, short

from analytic import (
    bonded_flat,
    flat,
    hertz,
    rounded_flat,
    sliding_flat,
    sliding_hertz,
    sliding_rounded_flat,
)

COUPLINGS = [0.49, -1e-9, -0.3, 9.9]
either_way = pytest.mark.parametrize("k", COUPLINGS)
ROUNDED = {"normal_load": 0.3, "half_flat": 0.5, "radius": 2.0, "modulus": 3.0}
HERTZ = {"half_width": 1.0, "radius": 2.0, "modulus": 3.0}
FLAT = {"half_width": 1.0, "normal_load": 2.0}
BONDED = {"half_width": 1.0, "normal_load": 2.0, "shear_load": 0.7, "moment": -0.2}


# --- the integral equations
# -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("k", [0.49, -0.3, 1.7])
@pytest.mark.parametrize("place", [-0.5, 0.3])
def test_sliding_hertz_solves_its_equation(k: float, place: float) -> None:
    edges = sliding_hertz.edges(half_width=1.0, coupling=k, lib=mp)

    def p(t):
        return sliding_hertz.pressure(t, **HERTZ, coupling=k, lib=mp)

    integral, x = principal_value(
        p, float(edges[0] + (edges[1] - edges[0]) * (1 + place) / 2), edges
    )
    assert abs(integral - k * p(x) - mp.mpf(3) / 2 * x / 2) < 1e-25


@pytest.mark.parametrize("k", [0.49, -0.3])
@pytest.mark.parametrize("moment", [None, -0.1])
def test_sliding_flat_solves_its_equation(k: float, moment: float | None) -> None:
    given = {**FLAT, "coupling": k, "moment": moment}

    def p(t):
        return sliding_flat.pressure(t, **given, lib=mp)

    integral, x = principal_value(p, 0.3, (-1, 1))
    tilt = sliding_flat.tilt(**given, modulus=3, lib=mp) if moment is not None else 0
    # 1e-30 from a corner sums to 1e-30^(1 - 2|eps|).
    assert abs(integral - k * p(x) - mp.mpf(3) / 2 * tilt) < 1e-16


@pytest.mark.parametrize(("beta", "x"), [(0.5, -0.7), (-0.3, 0.3)])
def test_bonded_flat_solves_both_equations(beta: float, x: float) -> None:
    given = {**BONDED, "dundurs": beta, "lib": mp}
    tilt = bonded_flat.tilt(
        half_width=1, dundurs=beta, shear_load=0.7, moment=-0.2, modulus=3, lib=mp
    )

    def traction(t):
        return mp.mpc(bonded_flat.pressure(t, **given), bonded_flat.shear(t, **given))

    integral, at = principal_value(traction, x, (-1, 1))
    p, q = bonded_flat.pressure(at, **given), bonded_flat.shear(at, **given)
    assert abs(integral.real - mp.mpf(beta) * q - mp.mpf(3) / 2 * tilt) < 1e-22  # eq. (1)
    assert abs(integral.imag + mp.mpf(beta) * p) < 1e-22  # eq. (12), g' = 0


def exponential_rule(lo: float, hi: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of the double exponential rule, graded to both ends."""
    t = np.arange(-56, 57) / 18
    e = np.exp(-np.pi * np.sinh(abs(t)))
    fraction = np.where(t < 0, e, 1) / (1 + e)
    return lo + (hi - lo) * fraction, (hi - lo) * np.pi / 18 * np.cosh(t) * e / (1 + e) ** 2


@either_way
def test_sliding_rounded_flat_solves_its_equation(k: float) -> None:
    given = {**ROUNDED, "coupling": k}
    x1, x2 = sliding_rounded_flat.edges(**given)
    for x in (x1 / 2 - 0.3, -0.2, 0.4, 0.5 + 0.3 * (x2 - 0.5)):
        px = sliding_rounded_flat.pressure(x, **given)
        total = px * math.log((x - x1) / (x2 - x))
        ends = sorted({x1, -0.5, x, 0.5, x2})
        for lo, hi in pairwise(ends):
            t, weight = exponential_rule(lo, hi)
            t, weight = t[(t != x) & (abs(t - x) > 1e-12)], weight[(t != x) & (abs(t - x) > 1e-12)]
            total += ((sliding_rounded_flat.pressure(t, **given) - px) / (x - t) * weight).sum()
        slope = rounded_flat.slope(x, half_flat=0.5, radius=2.0)
        # The error is that of points 1e-12 from the pole, where rounding is 1e-4.
        assert abs(total / np.pi - k * px - 1.5 * slope) < 3e-12


@pytest.mark.parametrize(("k", "a"), [(0.49, 0.5), (-0.3, 20.0), (0.49, 0.0)])
def test_sliding_rounded_flat_is_the_inversion_of_its_slope(k: float, a: float) -> None:
    """p from quadrature of the inversion integral with the edges, and the two conditions on the
    edges.
    """
    given = {**ROUNDED, "half_flat": a, "coupling": k}
    d1, d2 = sliding_rounded_flat.rims(**given, lib=coarse)
    x1, x2, eps = -a - d1, a + d2, -coarse.atan(k) / coarse.pi
    cosine, half = coarse.cos(coarse.pi * eps), coarse.mpf(1) / 2

    def rim(function, alpha, d, end):
        """∫ (d - r) function(t)/w dt over one rim, r the distance from its edge, by r = d
        u^(1/alpha).
        """

        def integrand(u):
            r = d * u ** (1 / alpha)
            return (
                function(end * (a + d - r)) * (d - r) * (x2 - x1 - r) ** -alpha * d**alpha / alpha
            )

        return coarse.quad(integrand, [0, half, 1])

    def weighted(function):
        """∫ R h' function(t)/w dt."""
        return rim(function, half + eps, d2, +1) - rim(function, half - eps, d1, -1)

    assert abs(weighted(lambda t: 1)) < 1e-18 * weighted(coarse.sign)
    load = cosine * 3 / 4 * weighted(lambda t: t)
    assert abs(load / coarse.mpf(0.3) - 1) < 1e-18
    if a:
        x = -a * coarse.mpf("0.3")
        w = (x2 - x) ** (half - eps) * (x - x1) ** (half + eps)
        p = cosine**2 * 3 / (4 * coarse.pi) * w * weighted(lambda t: 1 / (t - x))
        assert abs(sliding_rounded_flat.pressure(x, **given, lib=coarse) / p - 1) < 1e-18


# --- equilibrium
# ------------------------------------------------------------------------------------------


@either_way
def test_sliding_hertz_carries_its_load_and_moment(k: float) -> None:
    given = {**HERTZ, "coupling": k, "lib": mp}
    edges = sliding_hertz.edges(half_width=1, coupling=k, lib=mp)
    assert (
        abs(
            resultant(lambda t: sliding_hertz.pressure(t, **given), edges)
            / sliding_hertz.load(**given)
            - 1
        )
        < 1e-25
    )
    moment = resultant(lambda t: sliding_hertz.pressure(t, **given), edges, lambda t: t)
    assert abs(moment - sliding_hertz.moment(**given)) < 1e-25
    P = sliding_hertz.load(**HERTZ, coupling=k)
    assert sliding_hertz.half_width(
        normal_load=P, radius=2.0, modulus=3.0, coupling=k
    ) == pytest.approx(1.0, rel=4 * EPS)


@pytest.mark.parametrize("k", [0.49, -0.3])
@pytest.mark.parametrize("moment", [None, -0.1])
def test_sliding_flat_carries_its_load_and_moment(k: float, moment: float | None) -> None:
    wanted = (
        sliding_flat.upright_moment(**FLAT, coupling=k, lib=mp)
        if moment is None
        else mp.mpf(moment)
    )

    def p(t):
        return sliding_flat.pressure(t, **FLAT, coupling=k, moment=moment, lib=mp)

    # the power of the distance from a corner is up to -0.65: the rule stops 1e-30 short of it in
    # the angle
    assert abs(resultant(p, (-1, 1)) - 2) < 1e-16
    assert abs(resultant(p, (-1, 1), lambda t: t) - wanted) < 1e-16


@pytest.mark.parametrize("beta", [0.5, -0.3])
def test_bonded_flat_carries_its_loads(beta: float) -> None:
    given = {**BONDED, "dundurs": beta, "lib": mp}
    assert abs(resultant(lambda t: bonded_flat.pressure(t, **given), (-1, 1)) - 2) < 1e-22
    assert abs(resultant(lambda t: bonded_flat.shear(t, **given), (-1, 1)) - mp.mpf(0.7)) < 1e-22
    assert (
        abs(
            resultant(lambda t: bonded_flat.pressure(t, **given), (-1, 1), lambda t: t)
            + mp.mpf(0.2)
        )
        < 1e-22
    )


@either_way
@pytest.mark.parametrize("a", [0.0, 0.5])
def test_sliding_rounded_flat_carries_its_load_and_moment(k: float, a: float) -> None:
    given = {**ROUNDED, "half_flat": a, "coupling": k}
    x1, x2 = sliding_rounded_flat.edges(**given)
    ends = [x1, -a, a, x2] if a else [x1, 0.0, x2]
    rules = [exponential_rule(lo, hi) for lo, hi in pairwise(ends)]
    t, weight = (np.concatenate(part) for part in zip(*rules))
    share = sliding_rounded_flat.pressure(t, **given) * weight
    assert share.sum() == pytest.approx(0.3, rel=1e-13)
    assert (share * t).sum() == pytest.approx(sliding_rounded_flat.moment(**given), abs=1e-13)


# --- potentials
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("z", [-1.2, 2.1 - 1j, -40 + 3j])
def test_potentials_are_cauchy_integrals(z: complex) -> None:
    k = -0.4
    edges = sliding_hertz.edges(half_width=1, coupling=k, lib=mp)
    cases = [
        (
            lambda t: sliding_hertz.pressure(t, **HERTZ, coupling=k, lib=mp),
            edges,
            sliding_hertz.potential(z, **HERTZ, coupling=k),
        ),
        (
            lambda t: sliding_flat.pressure(t, **FLAT, coupling=k, moment=0.3, lib=mp),
            (-1, 1),
            sliding_flat.potential(z, **FLAT, coupling=k, moment=0.3),
        ),
        (
            lambda t: mp.mpc(
                bonded_flat.pressure(t, **BONDED, dundurs=k, lib=mp),
                bonded_flat.shear(t, **BONDED, dundurs=k, lib=mp),
            ),
            (-1, 1),
            bonded_flat.potential(z, **BONDED, dundurs=k),
        ),
    ]
    for density, ends, value in cases:
        exact = resultant(density, ends, lambda t: 1 / (mp.mpc(z) - t)) / mp.pi
        assert abs(value - complex(exact)) <= 1e-13 * abs(value)


@pytest.mark.parametrize("side", [+1, -1])
@pytest.mark.parametrize("x", [-0.4, 0.3])
def test_potentials_tend_to_their_side_of_the_contact(side: int, x: float) -> None:
    z = mp.mpc(x, side * mp.mpf("1e-40"))
    for function, given in (
        (sliding_hertz.potential, {**HERTZ, "coupling": 0.3}),
        (sliding_flat.potential, {**FLAT, "coupling": 0.3, "moment": -0.4}),
        (bonded_flat.potential, {**BONDED, "dundurs": 0.3}),
    ):
        assert abs(function(x, **given, side=side, lib=mp) - function(z, **given, lib=mp)) < 1e-35


# --- limits and symmetry
# ------------------------------------------------------------------------------------------


def test_similar_bodies_slide_as_they_stand() -> None:
    x = np.linspace(-1.1, 1.1, 23)
    near = {"rtol": 16 * EPS, "atol": 0}
    np.testing.assert_allclose(
        sliding_hertz.pressure(x, **HERTZ, coupling=0.0), hertz.pressure(x, **HERTZ), **near
    )
    np.testing.assert_allclose(
        sliding_flat.pressure(x, **FLAT, coupling=0.0, moment=0.3),
        flat.pressure(x, **FLAT, moment=0.3),
        **near,
    )
    np.testing.assert_allclose(
        bonded_flat.pressure(x, **FLAT, dundurs=0.0, moment=0.3),
        flat.pressure(x, **FLAT, moment=0.3),
        **near,
    )
    rim = rounded_flat.rim(**ROUNDED)
    inside = x * (0.5 + rim) * 0.9
    shape = {"half_flat": 0.5, "radius": 2.0, "modulus": 3.0}
    found = sliding_rounded_flat.pressure(inside, **ROUNDED, coupling=0.0)
    np.testing.assert_allclose(
        found, rounded_flat.pressure(inside, **shape, rim=rim), rtol=64 * EPS, atol=0
    )


@either_way
def test_the_mirror_image_slides_the_other_way(k: float) -> None:
    x = np.linspace(-0.7, 0.7, 15)
    for function, given in (
        (sliding_hertz.pressure, HERTZ),
        (sliding_flat.pressure, FLAT),
        (sliding_rounded_flat.pressure, ROUNDED),
    ):
        there, back = function(x, **given, coupling=k), function(-x, **given, coupling=-k)
        np.testing.assert_allclose(there, back, rtol=1e-13, atol=0)


@either_way
def test_without_a_flat_the_sliding_rounded_flat_is_the_sliding_parabola(k: float) -> None:
    given = {"normal_load": 0.3, "radius": 2.0, "modulus": 3.0, "coupling": k}
    w = sliding_hertz.half_width(**given)
    edges = sliding_hertz.edges(half_width=w, coupling=k)
    assert sliding_rounded_flat.edges(**given, half_flat=0.0) == pytest.approx(edges, rel=1e-14)
    x = np.linspace(edges[0], edges[1], 21)[1:-1]
    whole = sliding_hertz.pressure(x, half_width=w, radius=2.0, modulus=3.0, coupling=k)
    np.testing.assert_allclose(
        sliding_rounded_flat.pressure(x, **given, half_flat=0.0), whole, rtol=1e-13, atol=0
    )


@pytest.mark.parametrize("k", [0.49, -0.2])
@pytest.mark.parametrize("load", [1e-18, 1e-6])
def test_thin_rims_leave_the_sliding_flat(k: float, load: float) -> None:
    given = {"normal_load": load, "half_flat": 1.0, "radius": 1.0, "modulus": 1.0, "coupling": k}
    thickness = max(sliding_rounded_flat.rims(**given))
    flat_pressure = sliding_flat.pressure(0.3, half_width=1.0, normal_load=load, coupling=k)
    assert sliding_rounded_flat.pressure(0.3, **given) == pytest.approx(
        flat_pressure, rel=3 * thickness + 1e-13
    )


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("k", "a"), [(0.49, 0.5), (-0.49, 0.0)])
def test_sliding_rounded_flat_keeps_its_digits_everywhere(k: float, a: float) -> None:
    """Relative to the exact value on the whole contact: the last points are where an edge's own
    rounding is 1e-14 of it.
    """
    given = {**ROUNDED, "half_flat": a, "coupling": k}
    d1, d2 = sliding_rounded_flat.rims(**given)
    x = np.concatenate(
        [
            np.linspace(-a - 0.99 * d1, a + 0.99 * d2, 5),
            [-a, a, a - 1e-9, a + 1e-9, -a + 1e-5, -a - 1e-5],
        ]
    )
    exact = [float(sliding_rounded_flat.pressure(v, **given, lib=short)) for v in x]
    np.testing.assert_allclose(sliding_rounded_flat.pressure(x, **given), exact, rtol=1e-13, atol=0)


def test_thin_rims_keep_their_digits() -> None:
    """Rims of 1e-12 of the flat, at points next to them, against 60 digits."""
    given = {
        "normal_load": 1e-18,
        "half_flat": 1.0,
        "radius": 1.0,
        "modulus": 1.0,
        "coupling": 0.49,
    }
    d1, d2 = sliding_rounded_flat.rims(**given)
    x = np.array([1 - 10 * d2, 1 - d2, 1.0, -1.0, -1 + d1, 0.0])
    exact = [float(sliding_rounded_flat.pressure(v, **given, lib=short)) for v in x]
    np.testing.assert_allclose(sliding_rounded_flat.pressure(x, **given), exact, rtol=1e-13, atol=0)


# --- what holds for all
# ------------------------------------------------------------------------------------------

CALLS = [
    (sliding_hertz.edges, {"half_width": 1.1, "coupling": 0.3}),
    (sliding_hertz.pressure, {"x": 0.4, **HERTZ, "coupling": -0.49}),
    (sliding_hertz.load, {**HERTZ, "coupling": -0.49}),
    (sliding_hertz.moment, {**HERTZ, "coupling": -0.49}),
    (
        sliding_hertz.half_width,
        {"normal_load": 0.7, "radius": 2.0, "modulus": 3.0, "coupling": 0.3},
    ),
    *(
        (sliding_hertz.potential, {"z": z, **HERTZ, "coupling": 0.49})
        for z in (0.3, 0.3 + 0.1j, 1.4 - 2j, 300 + 5j)
    ),
    (sliding_flat.upright_moment, {**FLAT, "coupling": 0.3}),
    *(
        (sliding_flat.pressure, {"x": x, **FLAT, "coupling": 0.49, "moment": -0.2})
        for x in (0.0, -0.999, 0.7)
    ),
    (sliding_flat.tilt, {**FLAT, "coupling": 0.3, "moment": -0.2, "modulus": 3.0}),
    *(
        (sliding_flat.potential, {"z": z, **FLAT, "coupling": 0.49, "moment": -0.2})
        for z in (0.3, 0.3 + 0.1j, 1.4 - 2j, 300 + 5j)
    ),
    (bonded_flat.pressure, {"x": 0.4, **BONDED, "dundurs": 0.4}),
    (bonded_flat.shear, {"x": 0.999, **BONDED, "dundurs": -0.5}),
    (
        bonded_flat.tilt,
        {"half_width": 1.1, "dundurs": 0.3, "modulus": 3.0, "shear_load": 0.7, "moment": -0.2},
    ),
    *(
        (bonded_flat.potential, {"z": z, **BONDED, "dundurs": 0.4})
        for z in (0.3, 0.3 + 0.1j, 1.4 - 2j, 300 + 5j)
    ),
    (sliding_rounded_flat.rims, {**ROUNDED, "coupling": 0.49}),
    (sliding_rounded_flat.edges, {**ROUNDED, "coupling": -0.3}),
    (sliding_rounded_flat.moment, {**ROUNDED, "coupling": -0.3}),
    *(
        (sliding_rounded_flat.pressure, {"x": x, **ROUNDED, "coupling": 0.49})
        for x in (-0.6, -0.4, 0.0, 0.5, 0.52)
    ),
]
TestEveryCall = of_every_call(CALLS)


def test_pressure_is_infinite_at_sharp_corners_only_and_zero_outside() -> None:
    x = np.array([-2.0, -1.0, 1.0, 2.0])
    assert sliding_flat.pressure(x, **FLAT, coupling=0.3).tolist() == [0, math.inf, math.inf, 0]
    assert bonded_flat.pressure(x, **BONDED, dundurs=0.3).tolist() == [0, math.inf, math.inf, 0]
    assert bonded_flat.shear(x, **FLAT, dundurs=0.0).tolist() == [0, 0, 0, 0]
    assert sliding_hertz.pressure(x, **HERTZ, coupling=0.0).tolist() == [0, 0, 0, 0]
    assert (sliding_rounded_flat.pressure(x, **ROUNDED, coupling=0.3) == 0).all()


def test_invalid_arguments_are_refused() -> None:
    with pytest.raises(ValueError, match=r"moment = 3\.0 lifts one corner off; .*upright_moment"):
        sliding_flat.pressure(0.0, **FLAT, coupling=0.3, moment=3.0)
    with pytest.raises(ValueError, match=r"dundurs = 0\.6 .* give"):
        bonded_flat.tilt(half_width=1.0, dundurs=0.6, modulus=1.0)
    with pytest.raises(ValueError, match=r"coupling = -11\.0 is beyond ±10"):
        sliding_rounded_flat.rims(**ROUNDED, coupling=-11.0)
    assert call(sliding_flat.pressure, {"x": 0.0, **FLAT, "coupling": 0.3, "moment": 0.0}) > 0
