"""Power law, wedge, parabola and flat: pressure, load, half-width, tilt and moment."""

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from closed_form_cases import EPS, coarse, mp, relative
from hypothesis import given
from hypothesis import strategies as st

from analytic import flat, hertz, power, rounded_flat, wedge


@pytest.mark.slow(but=5)
@pytest.mark.parametrize(
    "m", [1.0, 1.0 + 1e-9, 1.2, 1.7, 2.0, 2.5, 3.0, 3.0 + 1e-10, 4.0, 7.3, 40.0]
)
def test_power_pressure_superposes_rigid_flats(m: float) -> None:
    x = np.array([1e-200, 1e-9, 0.3, 0.70710678, 0.7072, 0.99, 1 - 1e-13])
    found = power.pressure(x, half_width=1.0, exponent=m, coefficient=1.0, modulus=1.0)
    wallis = coarse.quad(lambda t: coarse.sin(t) ** m, [0, coarse.pi / 2])

    def exact(xi: float) -> Any:
        # s = xi cosh(t): the integrand is smooth, over hundreds of units of t
        end = coarse.acosh(1 / mp.mpf(xi))
        panels = coarse.linspace(0, end, 2 + int(end / 4))
        total = coarse.quad(
            lambda t: (xi * coarse.cosh(t)) ** (m - 1), panels, method="gauss-legendre"
        )
        return m * m * wallis / coarse.pi * total

    assert relative(found, [exact(xi) for xi in x.tolist()]) <= 20 * EPS


def test_powers_one_and_two_are_the_wedge_and_the_parabola() -> None:
    x, given = np.linspace(-1.2, 1.2, 49), {"half_width": 1.0, "modulus": 3.0}
    found = power.pressure(x, exponent=1, coefficient=0.2, **given)
    np.testing.assert_allclose(found, wedge.pressure(x, slope=0.2, **given), rtol=12 * EPS, atol=0)
    found = power.pressure(x, exponent=2, coefficient=0.25, **given)
    np.testing.assert_allclose(found, hertz.pressure(x, radius=2.0, **given), rtol=8 * EPS, atol=0)


class Loaded(NamedTuple):
    module: Any
    shape: dict[str, float]


LOADED = [
    Loaded(rounded_flat, {"half_flat": 0.3, "radius": 2.0}),
    Loaded(hertz, {"radius": 2.0}),
    Loaded(wedge, {"slope": 0.2}),
    Loaded(power, {"exponent": 1.6, "coefficient": 0.2}),
    Loaded(power, {"exponent": 5.0, "coefficient": 0.2}),
]
every_loaded = pytest.mark.parametrize("case", LOADED, ids=lambda case: case.module.__name__)


@pytest.mark.slow(but=3)
@every_loaded
def test_load_is_the_integral_of_the_pressure(case: Loaded) -> None:
    given = {**case.shape, "modulus": 3.0, "half_width": 1.0, "lib": coarse}
    kink = coarse.asin(case.shape.get("half_flat", 0.0))
    half = coarse.quad(
        lambda phi: case.module.pressure(coarse.sin(phi), **given) * coarse.cos(phi),
        [0, kink, coarse.pi / 2],
    )
    assert abs(2 * half / case.module.load(**given) - 1) < 1e-15


@every_loaded
def test_half_width_is_the_inverse_of_load(case: Loaded) -> None:
    b = np.logspace(-0.4, 6, 20)
    P = case.module.load(half_width=b, **case.shape, modulus=3.0)
    found = case.module.half_width(normal_load=P, **case.shape, modulus=3.0)
    np.testing.assert_allclose(found, b, rtol=8 * EPS, atol=0)


@pytest.mark.parametrize(
    "case", [c for c in LOADED if c.module is not wedge], ids=lambda case: case.module.__name__
)
def test_slope_is_the_derivative_of_the_height(case: Loaded) -> None:
    x, shape = mp.mpf("0.7"), {**case.shape, "lib": mp}
    for side in (+1, -1):
        exact = mp.diff(lambda t: case.module.height(t, **shape), side * x)
        assert abs(case.module.slope(side * x, **shape) - exact) < mp.mpf("1e-20")


@given(st.floats(-1, 1), st.floats(0.1, 10.0))
def test_flat_pressure_carries_load_and_moment(part: float, b: float) -> None:
    """∫ p and ∫ p x by Gauss-Chebyshev quadrature, exact for p sqrt(b² - x²) linear."""
    P, M = 3.0, part * 3.0 * b / 2
    x = b * np.array([-math.sqrt(0.5), math.sqrt(0.5)])
    p = flat.pressure(x, half_width=b, normal_load=P, moment=M)
    p *= np.sqrt(b * b - x * x) * math.pi / 2
    assert p.sum() == pytest.approx(P, rel=8 * EPS)
    assert (p * x).sum() == pytest.approx(M, rel=0, abs=8 * EPS * P * b)


@given(st.floats(0.5, 0.99), st.sampled_from([-1, 1]))
def test_partial_flat_pressure_carries_load_and_moment(part: float, sign: int) -> None:
    P, M, b = 3.0, sign * part * 3.0, 1.0
    given = {"half_width": b, "normal_load": P, "moment": M}
    lo, hi = flat.partial_edges(**given)
    middle, r, n = (lo + hi) / 2, (hi - lo) / 2, 6
    # p = P/(pi r) sqrt((1+u)/(1-u)), u towards the corner: Gauss nodes and weights of that weight
    u = np.cos((2 * np.arange(1, n + 1) - 1) * math.pi / (2 * n + 1))
    weights = 2 * math.pi / (2 * n + 1) * (1 + u)
    x = middle + sign * r * u
    share = flat.partial_pressure(x, **given) * np.sqrt((1 - u) / (1 + u)) * weights * r
    # near the far edge x itself is rounded: eps/(1+u) in the square of the pressure
    assert share.sum() == pytest.approx(P, rel=1e-13)
    assert (share * x).sum() == pytest.approx(M, rel=1e-13)


@given(st.floats(-1, 1))
def test_flat_tilt_and_moment_are_inverse(part: float) -> None:
    given = {"half_width": 2.0, "normal_load": 3.0, "modulus": 5.0}
    M = part * 3.0
    tilt = flat.tilt(**given, moment=M)
    assert tilt == pytest.approx(-4 * M / (math.pi * 5.0 * 4.0), rel=4 * EPS, abs=1e-300)
    assert flat.moment(**given, tilt=tilt) == pytest.approx(M, rel=4 * EPS, abs=1e-300)
    M = math.copysign(3.0 + 2.9 * abs(part), part)  # a corner lifts off
    tilt = flat.partial_tilt(**given, moment=M)
    assert tilt * M < 0
    assert flat.partial_moment(**given, tilt=tilt) == pytest.approx(M, rel=8 * EPS, abs=0)
