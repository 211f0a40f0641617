"""Dissimilar bodies that slide or are bonded: potentials, limits, digits."""

import math

import numpy as np
import pytest
from closed_forms import EPS, call, coarse, short

from analytic import bonded_flat, sliding_flat, sliding_hertz, sliding_rounded_flat

COUPLINGS = [0.49, -1e-9, -0.3, 9.9]
either_way = pytest.mark.parametrize("k", COUPLINGS)
ROUNDED = {"normal_load": 0.3, "half_flat": 0.5, "radius": 2.0, "modulus": 3.0}
HERTZ = {"half_width": 1.0, "radius": 2.0, "modulus": 3.0}
FLAT = {"half_width": 1.0, "normal_load": 2.0}
BONDED = {"half_width": 1.0, "normal_load": 2.0, "shear_load": 0.7, "moment": -0.2}


@pytest.mark.parametrize(("k", "a"), [(0.49, 0.5), (-0.3, 20.0), (0.49, 0.0)])
def test_sliding_rounded_flat_is_the_inversion_of_its_slope(k: float, a: float) -> None:
    """The inversion integral with the edges, and the two conditions on the edges."""
    given = {**ROUNDED, "half_flat": a, "coupling": k}
    d1, d2 = sliding_rounded_flat.rims(**given, lib=coarse)
    x1, x2, eps = -a - d1, a + d2, -coarse.atan(k) / coarse.pi
    cosine, half = coarse.cos(coarse.pi * eps), coarse.mpf(1) / 2

    def rim(function, alpha, d, end):
        """∫ (d - r) function(t)/w dt, r the distance from the edge, by r = d u^(1/alpha)."""

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


@either_way
def test_the_half_width_of_the_sliding_parabola_is_that_of_its_load(k: float) -> None:
    P = sliding_hertz.load(**HERTZ, coupling=k)
    found = sliding_hertz.half_width(normal_load=P, radius=2.0, modulus=3.0, coupling=k)
    assert found == pytest.approx(1.0, rel=4 * EPS)


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


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("k", "a"), [(0.49, 0.5), (-0.49, 0.0)])
def test_sliding_rounded_flat_keeps_its_digits_everywhere(k: float, a: float) -> None:
    """The last points are where an edge's own rounding is 1e-14 of p."""
    given = {**ROUNDED, "half_flat": a, "coupling": k}
    d1, d2 = sliding_rounded_flat.rims(**given)
    beside = [-a, a, a - 1e-9, a + 1e-9, -a + 1e-5, -a - 1e-5]
    x = np.array([*np.linspace(-a - 0.99 * d1, a + 0.99 * d2, 5), *beside])
    exact = [float(sliding_rounded_flat.pressure(v, **given, lib=short)) for v in x]
    np.testing.assert_allclose(sliding_rounded_flat.pressure(x, **given), exact, rtol=1e-13, atol=0)


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
