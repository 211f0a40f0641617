"""Nothing is lost where formulas are known to cancel."""

import laws
import numpy as np
import pytest
from hypothesis import example, given
from strategies import between, log_between

import sie
from analytic import rounded_flat

PROMISE = 1e-13


def rim(solution):
    """b - a of a symmetric rounded flat, with what the double b has lost."""
    contact = solution.normal.edges.contact
    return (contact.x2 - solution.scene.profile.half_flat) + contact.tail2


def across(a, width):
    """Points of the flat and of the rounded edge, on its own scale too."""
    flat = a * np.array([0.0, -0.37, 0.81, 0.999])
    return np.concatenate(
        (flat, a + width * np.array([0.07, 0.5, 0.93]), -a - width * np.array([0.3]))
    )


# a/b = 1 - 10^-e and 10^-e: both ends of the promise
NEAR_FLAT = between(-12.0, -0.3).map(lambda e: 10.0**e)


@given(NEAR_FLAT, log_between(1e-3, 1e3), log_between(1e-3, 1e3))
@example(delta=1e-12, radius=1.0, modulus=1.0)
@example(delta=1e-8, radius=1.0, modulus=1.0)
def test_a_nearly_flat_punch_keeps_its_rounded_edge_and_pressure_given_the_load(
    delta, radius, modulus
):
    width = delta  # of the rounded edge, beside a flat of half-width 1
    shape = {"half_flat": 1.0, "radius": radius, "modulus": modulus, "rim": width}
    P = float(rounded_flat.load(**shape))
    profile = sie.RoundedFlat(1.0, radius)
    solution = sie.solve(sie.Scene(profile=profile, modulus=modulus, normal_load=P))
    assert rim(solution) == pytest.approx(width, rel=1e-12)
    x = across(1.0, width)
    expected = rounded_flat.pressure(x, **shape)
    # x on the rounded edge is a double: its distance to the corner has rounding errors
    noise = 4 * np.abs(rounded_flat.pressure(np.nextafter(x, 0), **shape) - expected)
    assert (np.abs(solution.pressure(x) - expected) <= 1e-12 * expected.max() + noise).all()
    assert solution.check().ok


SIZES = log_between(1e-3, 1e3)


@given(log_between(1e-12, 10.0**-0.01), SIZES, SIZES, SIZES)
@example(ratio=1e-12, width=1.0, radius=1.0, modulus=1.0)
def test_the_pressure_agrees_with_the_closed_form_of_the_rounded_punch(
    ratio, width, radius, modulus
):
    a = ratio * width
    rim_of_one = 1 - ratio
    on_flat, on_rim = (0.0, 0.5 * ratio, -0.99 * ratio), ratio + rim_of_one * np.array([0.1, 0.8])
    x = width * np.array([*on_flat, *on_rim, -1 + 1e-3 * rim_of_one, 1.1])
    common = {"half_flat": a, "radius": radius, "modulus": modulus}
    profile = sie.RoundedFlat(a, radius)
    given_width = sie.solve(sie.Scene(profile=profile, modulus=modulus, half_width=width))
    expected = rounded_flat.pressure(x, half_width=width, **common)
    bound = PROMISE * expected.max()
    assert given_width.pressure(x) == pytest.approx(expected, rel=PROMISE, abs=bound)
    P = float(rounded_flat.load(half_width=width, **common))
    assert given_width.normal_load == pytest.approx(P, rel=PROMISE)
    given_load = given_width.with_(normal_load=P)
    assert rim(given_load) == pytest.approx(width - a, rel=4 * PROMISE)
    assert given_load.pressure(x) == pytest.approx(expected, abs=bound)
    z = width * np.array([0.3 + 1e-9j, ratio + 1e-6j, 1.0 + 0.1j, 2.0, -1e6 + 1e3j])
    F = rounded_flat.potential(z, half_width=width, **common)
    assert given_width.pressure.cauchy(z) == pytest.approx(F, rel=2 * PROMISE)


@given(NEAR_FLAT, between(-0.3, 0.3))
def test_a_nearly_flat_punch_keeps_its_moment_under_tilt(delta, share):
    """A tilt that is a fraction of the slope of the rounded edge."""
    profile = sie.RoundedFlat(1.0, 1.0)
    solution = sie.solve(
        sie.Scene(profile=profile, modulus=1.0, normal_load=1.0, tilt=share * delta)
    )
    assert solution.check().ok
    assert solution.with_(moment=solution.moment).tilt == pytest.approx(
        solution.tilt, abs=4 * PROMISE
    )


ROUND = [sie.Parabola(1.0), sie.RoundedFlat(1.0, 1.0), sie.Wedge(0.5), sie.Power(2.5, 1.0)]
CORNER = sie.Piecewise((0.0,), ((0.0, 1.0), (0.0, 3.0)))


@pytest.mark.parametrize("tilt", [1e-300, 1e-30, 1e-16, 1e-6])
@pytest.mark.parametrize("profile", [*ROUND, sie.Flat(1.0)], ids=repr)
def test_a_tiny_tilt_changes_the_answer_by_a_tiny_amount(profile, tilt):
    upright = sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=0.1))
    tilted = upright.with_(tilt=tilt)
    assert tilted.half_width == pytest.approx(upright.half_width, rel=PROMISE + 4 * tilt)
    assert tilted.centre == pytest.approx(0.0, abs=PROMISE + 30 * tilt)
    assert tilted.check().ok


@pytest.mark.parametrize("load", [1e-100, 1e-30, 1e-12, 1e-6, 1e6, 1e30, 1e100])
@pytest.mark.parametrize("profile", [*ROUND, CORNER], ids=repr)
def test_any_load_keeps_equilibrium(profile, load):
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=load))
    rim_between_two_doubles = isinstance(profile, sie.RoundedFlat) and load < 1e-50
    assert solution.check().ok is not rim_between_two_doubles
    P, _ = laws.load_and_moment(solution.pressure, solution.edges, profile.breaks)
    rounding = laws.rounding_of_x(solution.pressure, solution.edges, profile.breaks) / load
    assert pytest.approx(load, rel=PROMISE + 4 * rounding) == P


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("n", [100, 10_000])
def test_many_pieces_keep_full_accuracy(n):
    """A parabola cut into pieces is still a parabola: p = E*/(2R) sqrt(b² - x²)."""
    breaks = np.linspace(-2.0, 2.0, n + 1)
    profile = sie.Piecewise(breaks, [(0.0, 1.0)] * n)
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=1.0))
    x = np.array([-0.9, -0.3, 1e-4, 0.77])
    assert solution.pressure(x) == pytest.approx(0.5 * np.sqrt(1 - x * x), rel=PROMISE)
    assert solution.normal_load == pytest.approx(np.pi / 4, rel=PROMISE)


def test_a_corner_far_from_the_origin_is_no_jump():
    """The slope at a break is rounded by ulps of the coefficients: no wedge may come of it."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        at, c, d = 1000.0 * rng.uniform(1, 10), *rng.uniform(1, 10, 2)
        profile = sie.Piecewise((at,), ((-c * at, c), (-d * at, d)))
        solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=1.0))
        assert np.isfinite(solution.pressure(at))
