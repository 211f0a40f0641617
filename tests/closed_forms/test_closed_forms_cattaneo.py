"""Partial slip of similar bodies: strain in stick, slip, energy, digits."""

import math

import numpy as np
import pytest
from closed_forms import EPS, call, coarse, mp, principal_value, resultant, short

from analytic import cattaneo, cattaneo_rounded, rounded_flat

HERTZ = {"half_width": 1.0, "normal_load": 2.0, "friction": 0.3}
ROUNDED = {"normal_load": 0.3, "half_flat": 0.5, "radius": 2.0, "modulus": 3.0, "friction": 0.3}
PARTS = [1e-14, 1e-5, 0.3, 0.5, 0.9, 1 - 1e-9, 1 - 1e-14]
deep = mp.clone()  # references that cancel
deep.dps = 90


def with_load(given: dict, part: float) -> dict:
    """The case with Q a part of f P."""
    return {**given, "tangential_load": part * given["friction"] * given["normal_load"]}


def exact_part(given: dict):
    return deep.mpf(given["tangential_load"]) / (
        deep.mpf(given["friction"]) * deep.mpf(given["normal_load"])
    )


@pytest.mark.parametrize("part", PARTS)
def test_hertz_keeps_its_digits_from_stick_to_sliding(part: float) -> None:
    given = with_load(HERTZ, part)
    r = exact_part(given)
    m, P, f = 1 - r, deep.mpf(2), deep.mpf(0.3)
    loads = {name: given[name] for name in ("normal_load", "friction", "tangential_load")} | {
        "modulus": 3.0
    }
    unit, c = f * P / (3 * deep.pi), deep.sqrt(m)
    exact = {
        cattaneo.stick_half_width(**given): c,
        cattaneo.slip_width(**given): 1 - c,
        cattaneo.excess_shift(**loads): unit * (r + m * deep.log(m)),
        cattaneo.dissipation(**loads): 2 * f * P * unit * (1 - m * m + 2 * m * deep.log(m)),
        cattaneo.shear(0.0, **given): 6 * unit * (1 - c),
        cattaneo.slip(1.0, **given, modulus=3.0): 2 * unit * (deep.sqrt(r) - m * deep.acosh(1 / c)),
    }
    for value, reference in exact.items():
        assert abs(value / reference - 1) < 8 * EPS


@pytest.mark.parametrize("part", [0.2, 0.8])
def test_where_hertz_sticks_nothing_stretches_and_where_it_slips_the_slip_follows(
    part: float,
) -> None:
    given = {**with_load(HERTZ, part), "lib": mp}
    c = cattaneo.stick_half_width(**given)
    for x in (-0.9 * float(c), (float(c) + 1) / 2):
        strain, at = principal_value(lambda t: cattaneo.shear(t, **given), x, (-1, -c, c, 1))
        slope = mp.diff(lambda t: cattaneo.slip(t, **given, modulus=3), at) if x > c else 0
        assert abs(strain - mp.mpf(3) / 2 * slope) < 1e-20


def test_bulk_tension_stretches_the_stick_zone_by_a_quarter_of_it() -> None:
    for sigma in (0.2, -0.2):
        given = {**with_load(HERTZ, 0.5), "bulk_stress": sigma, "lib": mp}
        zone = cattaneo.bulk_stick(**given)
        density = lambda t: cattaneo.bulk_shear(t, **given)  # noqa: B023, E731
        strain, _ = principal_value(density, 0.1, (-1, *zone, 1))
        assert abs(strain - mp.mpf(sigma) / 4) < 1e-20
        assert abs(resultant(density, (-1, *zone, 1)) - mp.mpf(0.5 * 0.3 * 2.0)) < 1e-25


def plain_load(a, s):
    """P R/E* by the paper's (35) in s = c or b."""
    theta = deep.acos(a / s)
    return s * s / 2 * (theta - deep.sin(theta) * deep.cos(theta))


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize(("a", "load"), [(0.0, 1.0), (1e-9, 1.0), (0.5, 1.0), (1.0, 1e-13)])
def test_stick_zone_of_the_rounded_flat_solves_the_papers_equation_20(
    part: float, a: float, load: float
) -> None:
    given = with_load(
        {"normal_load": load, "half_flat": a, "radius": 1.0, "modulus": 1.0, "friction": 0.25}, part
    )
    rim = deep.mpf(float(rounded_flat.rim(normal_load=load, half_flat=a, radius=1.0, modulus=1.0)))
    for _ in range(4):  # Newton's method, from 16 digits
        rim -= (plain_load(a, a + rim) - deep.mpf(load)) / ((a + rim) * deep.acos(a / (a + rim)))
    stick, slip = (
        deep.mpf(float(f(**given)))
        for f in (cattaneo_rounded.stick_rim, cattaneo_rounded.slip_width)
    )
    left = deep.mpf(load) * (1 - exact_part(given))
    for value, s in ((stick, a + stick), (slip, a + rim - slip)):
        # The error of s, by a step of Newton's method
        error = (plain_load(a, s) - left) / (s * deep.acos(a / s))
        assert abs(error / value) < 8 * EPS


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize(("a", "load"), [(0.5, 1.0), (1.0, 1e-13), (1e-9, 1.0)])
def test_shear_of_the_rounded_flat_is_the_difference_of_two_pressures_to_its_last_digits(
    part: float, a: float, load: float
) -> None:
    given = with_load(
        {"normal_load": load, "half_flat": a, "radius": 1.0, "modulus": 1.0, "friction": 0.25}, part
    )
    shape = {"half_flat": deep.mpf(a), "radius": 1, "modulus": 1, "lib": deep}
    rim = rounded_flat.rim(normal_load=load, **shape)
    stick = rounded_flat.rim(normal_load=deep.mpf(load) * (1 - exact_part(given)), **shape)
    x = np.array(
        [0.0, a / 2, a, a + 0.5 * float(stick), a - 0.1 * float(rim), a + 0.9 * float(stick)]
    )
    both = ([rounded_flat.pressure(v, rim=w, **shape) for v in x] for w in (rim, stick))
    exact = [(one - other) / 4 for one, other in zip(*both, strict=True)]
    found = cattaneo_rounded.shear(x, **given)
    assert max(float(abs(v / e - 1)) for v, e in zip(found.tolist(), exact)) < 1e-13


@pytest.mark.parametrize("part", [0.4, 0.9])
def test_slip_of_the_rounded_flat_follows_from_its_shear(part: float) -> None:
    """s' = (2/E*) (potential of the shear), of two normal contacts."""
    given = with_load(ROUNDED, part)
    shape = {"half_flat": 0.5, "radius": 2.0, "modulus": 3.0, "lib": short}
    rim = rounded_flat.rim(normal_load=0.3, **shape)
    stick = rounded_flat.rim(
        normal_load=short.mpf(0.3) * (1 - short.convert(exact_part(given))), **shape
    )

    def steepness(x):
        return (
            rounded_flat.slope(x, half_flat=0.5, radius=2.0, lib=short)
            - rounded_flat.potential(x, rim=stick, **shape).real * 2 / 3
        )

    start = short.mpf("0.5") + stick
    for share in ("0.2", "1"):
        x = start + (rim - stick) * short.mpf(share)
        exact = short.mpf(0.3) * short.quad(steepness, [start, x])
        # x lies in a rounded edge.
        assert abs(cattaneo_rounded.slip(float(x) * (1 - 2 * EPS), **given) / exact - 1) < 1e-12
        assert (
            abs(cattaneo_rounded.slip(x * (1 - short.mpf("1e-24")), **given, lib=short) / exact - 1)
            < 1e-20
        )


@pytest.mark.parametrize("part", [0.05, 0.4, 0.9])
def test_energy_of_a_cycle_is_the_work_of_friction_on_the_slip(part: float) -> None:
    """W = 4 ∫ f p s dx; s from -Q to Q is twice that of a first loading to Q."""
    given = with_load(ROUNDED, part)
    shape = {name: given[name] for name in ("normal_load", "half_flat", "radius", "modulus")}
    rim, slip = rounded_flat.rim(**shape), cattaneo_rounded.slip_width(**given)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    u = (1 + nodes) / 2
    # both ends of the slip zone are of fractional powers: x = c + slip (3u² - 2u³)
    x = 0.5 + rim - slip + slip * u * u * (3 - 2 * u)
    p = rounded_flat.pressure(x, half_flat=0.5, rim=rim, radius=2.0, modulus=3.0)
    dx = slip * 6 * u * (1 - u) * weights / 2
    work = 8 * (0.3 * p * cattaneo_rounded.slip(x, **given) * dx).sum()
    assert cattaneo_rounded.dissipation(**given) == pytest.approx(work, rel=1e-9)


CYCLES = [(cattaneo, HERTZ, 0.6), (cattaneo_rounded, ROUNDED, 0.09)]


@pytest.mark.parametrize(("module", "given", "friction"), CYCLES, ids=["hertz", "rounded"])
def test_cycles_close_and_reverse(module, given, friction: float) -> None:
    top, x = 0.7 * friction, np.linspace(-1, 1, 21)
    loaded = module.shear(x, **given, tangential_load=top)
    turned = {**given, "largest_load": top}
    same = {"rtol": 1e-12, "atol": 1e-14 * abs(loaded).max()}
    np.testing.assert_allclose(
        module.unloading_shear(x, **turned, tangential_load=top), loaded, **same
    )
    np.testing.assert_allclose(
        module.unloading_shear(x, **turned, tangential_load=-top), -loaded, **same
    )
    for least in (-top, 0.1 * top):
        back = module.reloading_shear(x, **turned, least_load=least, tangential_load=top)
        np.testing.assert_allclose(back, loaded, **same)
        start = module.reloading_shear(x, **turned, least_load=least, tangential_load=least)
        np.testing.assert_allclose(
            start, module.unloading_shear(x, **turned, tangential_load=least), **same
        )


def test_bulk_tension_that_reverses_slip_is_refused() -> None:
    given = with_load(HERTZ, 0.5)
    limit = cattaneo.slip_width(**given) * 8 * 0.3 * 2.0 / math.pi  # e = pi sigma b²/(8fP)
    assert cattaneo.bulk_stick(**given, bulk_stress=limit * (1 - 4 * EPS))[1] == pytest.approx(1.0)
    with pytest.raises(ValueError, match=r"bulk_stress moves the stick zone .* slip reverses"):
        cattaneo.bulk_shear(0.0, **given, bulk_stress=-1.01 * limit)


CYCLE = {"x": 0.0, **HERTZ, "largest_load": 0.4}
REFUSED = [
    *((function, {"x": 0.0, **given, "tangential_load": Q}, words)
      for function, given in ((cattaneo.shear, HERTZ), (cattaneo_rounded.shear, ROUNDED))
      for Q, words in ((0.7, r"exceeds friction \* normal_load = .*slide"),
                       (-0.1, r"= -0\.1\d* is not zero or positive"))),
    (cattaneo.unloading_shear, {**CYCLE, "tangential_load": 0.5}, "not between ± largest_load"),
    (cattaneo.reloading_shear, {**CYCLE, "least_load": -0.1, "tangential_load": -0.2},
     r"= -0\.2\d* is not between least_load = -0\.1"),
    (cattaneo_rounded.loading_ratio,
     {"half_flat": 0.5, "half_width": 1.0, "stick_half_width": 0.2},
     r"stick_half_width = 0\.2\d* is not between half_flat = 0\.5"),
]  # fmt: skip


@pytest.mark.parametrize("lib", [np, coarse])
def test_loads_that_slide_or_are_out_of_order_are_refused(lib) -> None:
    for function, given, words in REFUSED:
        with pytest.raises(ValueError, match=words):
            call(function, given, lib=lib)
