"""|x|^m, upright and tilted, against integrals in mpmath."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sie
from analytic import power

EXPONENTS = (1.0001, 1.001, 1.02, 1.3, 1.5, 2.5, 3.0, 3.0 + 1e-9, 5.0 - 1e-12, 6.4, 7.0)
EXPONENTS += (31.0, 33.0, 59.99, 60.0)
NARROW = {"normal_load": None, "half_width": 0.3, "tilt": -0.1}
NEAR_ONE = (1.0001, 1.01, 1.02, 1.05, 1.1)
DIGITS = mp.MPContext()
DIGITS.dps = 40


def scene(m, **given):
    profile = sie.Power(m, 0.75)
    return sie.Scene(profile=profile, modulus=2.0, poisson=0.3, **{"normal_load": 0.3, **given})


def pressure_of_unit_width(m, x):
    """E* = 2, A = 3/4, b = 1."""
    shape = {"exponent": DIGITS.mpf(m), "coefficient": DIGITS.mpf(0.75), "modulus": DIGITS.mpf(2)}
    return power.pressure(DIGITS.mpf(x), **shape, half_width=DIGITS.one, lib=DIGITS)


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("m", EXPONENTS)
def test_the_pressure_keeps_13_digits_of_its_peak_and_of_itself_up_to_the_edge(m):
    pressure = sie.solve(scene(m, normal_load=None, half_width=1.0)).pressure
    x = np.array([0.0, 2.0**-40, -1e-3, 0.25, -0.5, 0.7071, 0.70711, 0.75, 0.9, 0.96875])
    exact = [pressure_of_unit_width(m, v) for v in x.tolist()]
    errors = [abs(p - truth) for p, truth in zip(pressure(x).tolist(), exact, strict=True)]
    assert max(errors) <= 1e-13 * max(exact)
    for x in (1.0 - 2.0**-k for k in (4, 10, 20, 35, 52)):
        for p in pressure([-x, x]).tolist():
            assert abs(p / pressure_of_unit_width(m, x) - 1) <= 1e-13


@given(
    m=st.floats(1.0, 60.0, exclude_min=True),
    load=st.floats(1e-3, 1e3),
    dx=st.sampled_from([0.0, 0.5, -3.0]),
)
def test_the_half_width_carries_the_load_it_was_found_from(m, load, dx):
    profile = sie.Power(m, 0.75).shifted(dx)
    given_load = sie.solve(sie.Scene(profile=profile, modulus=2.0, normal_load=load))
    b = given_load.half_width
    given_width = sie.solve(sie.Scene(profile=profile, modulus=2.0, half_width=b))
    assert given_width.normal_load == pytest.approx(load, rel=4e-16 * (m + 4.0))


def test_a_moment_about_another_axis_than_the_profiles_is_no_upright_contact():
    profile = sie.Power(2.5, 0.75).shifted(0.5)
    upright = sie.solve(sie.Scene(profile=profile, modulus=2.0, normal_load=0.3, moment=0.15))
    tilted = upright.with_(moment=0.0)
    assert upright.tilt == 0.0
    assert tilted.tilt > 0.0
    assert tilted.moment == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("m", NEAR_ONE)
@pytest.mark.parametrize("given", [{"tilt": 0.1}, {"moment": 0.02}, NARROW])
def test_a_tilted_power_next_to_a_wedge_is_right_on_its_axis(m, given):
    solution = sie.solve(scene(m, **given))
    truth = float(on_the_axis(m, *solution.edges))
    assert float(solution.pressure(0.0)) == pytest.approx(truth, rel=1e-13)


CUTS = (0, 0.5, 0.9, 0.99, 1)


def on_the_axis(m, x1, x2):
    """w(0)/π ∫ m A |t|^(m-2)/w dt with E* = 2, by |t| = L v^(1/(m-1)) on each side of length L."""
    m, x1, x2 = (DIGITS.mpf(v) for v in (m, x1, x2))
    total = DIGITS.zero
    for L, side in ((x2, 1), (-x1, -1)):
        slow = DIGITS.quad(lambda v, L=side * L: 1 / w(L * v ** (1 / (m - 1)), x1, x2), CUTS)
        total += L ** (m - 1) * slow
    return w(DIGITS.zero, x1, x2) / DIGITS.pi * m * DIGITS.mpf(0.75) / (m - 1) * total


def w(t, x1, x2):
    return DIGITS.sqrt((t - x1) * (x2 - t))


@pytest.mark.parametrize("dx", [-0.25, -0.2537, 3.0])
def test_a_tilted_power_next_to_a_wedge_far_from_x_0_is_answered(dx):
    profile = sie.Power(1.0002, 0.142).shifted(dx)
    tilted = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=0.086, tilt=0.136))
    assert tilted.check().force < 1e-9


@pytest.mark.parametrize("m", [*NEAR_ONE, 51.1, 60.0])
def test_every_exponent_has_all_answers_of_a_contact(m):
    solution = sie.solve(scene(m, friction=0.4, tangential_load=0.05))
    x = np.linspace(-1.0, 1.0, 41)
    for answer in (
        solution.gap,
        solution.shear,
        solution.slip,
        lambda x: solution.stress(x, 0.1).j2,
    ):
        assert np.isfinite(answer(x)).all()
    assert solution.check().ok


CUSPS = (1.002, 1.03, 1.1, 1.3, 1.5, 1.9)


def potentials_of_unit_width(m, y):
    """(F, F')/P at y from the axis, of flats F = dP/(π sqrt(y² - s²)), dP = m P s^(m-1) ds."""
    m, y = DIGITS.mpf(m), DIGITS.mpmathify(y)
    F = DIGITS.hyp2f1(0.5, m / 2, m / 2 + 1, 1 / y**2) / (DIGITS.pi * y)
    flat = 1 / (DIGITS.pi * DIGITS.sqrt(y - 1) * DIGITS.sqrt(y + 1))
    return F, ((m - 1) * F - m * flat) / y


@pytest.mark.slow(but=4)
@pytest.mark.parametrize("m", CUSPS)
@pytest.mark.parametrize("axis", [0.0, 0.35, -40.0])
def test_the_potential_of_a_cusp_is_right_at_every_depth_beneath_it(m, axis):
    profile = sie.Power(m, 0.75).shifted(axis)
    solution = sie.solve(sie.Scene(profile=profile, modulus=2.0, half_width=1.0))
    peak, load = solution.pressure(axis), solution.normal_load
    apart = np.log10(1e4 * np.spacing(abs(axis))) if axis else -15.0  # told to four digits
    for depth in 10.0 ** np.array([apart, -11, -9, -7, -4, -1, 0, 3, 6]):
        for across in (0.0, -0.7, 20.0):
            z = axis + across * depth + 1j * depth
            F, dF = potentials_of_unit_width(m, DIGITS.mpc(z.real - axis, depth))
            found = solution.pressure.potentials(z)
            assert abs(found[0] - complex(load * F)) <= 1e-13 * peak
            assert depth * abs(found[1] - complex(load * dF)) <= 1e-13 * peak


@pytest.mark.parametrize("axis", [0.0, 0.375])
def test_a_wedge_on_the_axis_of_a_cusp_keeps_its_infinite_pressure(axis):
    profile = (sie.Power(1.5, 0.3) + sie.Wedge(0.2)).shifted(axis)
    both = sie.solve(sie.Scene(profile=profile, modulus=2.0, half_width=1.0))
    alone = sie.solve(sie.Scene(profile=sie.Power(1.5, 0.3), modulus=2.0, half_width=1.0))
    assert both.pressure(axis) == np.inf
    for d in 2.0 ** np.array([-40, -36, -33, -31, -29, -10]):
        exact = alone.pressure(d) + 0.4 / np.pi * np.arccosh(1.0 / d)
        assert both.pressure(axis + d) == pytest.approx(exact, rel=1e-13)
        assert both.pressure.cauchy(axis + 1j * d).real == pytest.approx(0.0, abs=1e-13 * exact)


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("rise", [1e-6, 0.01, 0.7])
@pytest.mark.parametrize("place", [-0.3, 0.109375, 1e-3])
@pytest.mark.parametrize("m", [1.05, 1.5, 1.9, 2.5])
def test_a_wedge_beside_a_cusp_keeps_its_infinite_pressure(m, place, rise):
    profile = sie.Power(m, 2.7) + sie.Wedge(rise).shifted(place)
    solution = sie.solve(sie.Scene(profile=profile, modulus=2.0, poisson=0.3, half_width=1.0))
    assert solution.pressure(place) == np.inf
    assert solution.elastic_limit().load == 0.0


@pytest.mark.parametrize("m", [1.05, 1.5, 1.9])
def test_a_jump_of_curvature_beside_a_cusp_has_an_infinitely_steep_pressure(m):
    profile = sie.Power(m, 2.7) + sie.Piecewise((0.25,), ((0.0,), (-0.125, 0.5)))
    solution = sie.solve(sie.Scene(profile=profile, modulus=2.0, half_width=1.0))
    at, near, far = solution.pressure.cauchy_derivative([0.25, 0.25 + 1e-12, 0.25 + 1e-6]).imag
    assert np.isinf(at) and at * (near - far) > 0.0


@pytest.mark.parametrize("other", [sie.Power(2.3, 1.0), sie.Power(1.2, 0.1), sie.Power(2.8, 1.0)])
def test_powers_about_one_axis_add_up(other):
    cusp = sie.Power(1.4, 0.3)
    given = {"modulus": 2.0, "half_width": 1.0}
    solve = [sie.solve(sie.Scene(profile=p, **given)).pressure for p in (cusp + other, cusp, other)]
    x = np.array([0.0, *2.0 ** np.arange(-60.0, -1.0, 3.0)])
    both, one, two = (p(x) for p in solve)
    assert np.abs(both - one - two).max() <= 1e-13 * both.max()


@pytest.mark.parametrize("m", [1.02, 1.2, 1.7])
@pytest.mark.parametrize("other", [sie.Parabola(1.0), sie.Wedge(0.1)])
def test_beneath_the_axis_of_a_cusp_sliding_bodies_obey_their_law(m, other):
    """On the surface the potential is hilbert - i p, with hilbert + p tan πε = E*/2 h'."""
    profile = sie.Power(m, 0.75) + other
    given = {"friction": 0.5, "sliding": -1, "dundurs": 0.3}
    scene = sie.Scene(profile=profile, modulus=2.0, normal_load=0.5, **given)
    pressure = sie.solve(scene).pressure
    x = np.outer((-1.0, 1.0), 10.0 ** np.array([-15, -12, -9, -8, -3])).ravel()
    F = pressure.cauchy(x + 1e-290j)
    scale = np.abs(F)
    assert (np.abs(-F.imag - pressure(x)) <= 1e-13 * scale).all()
    law = F.real - F.imag * np.tan(np.pi * pressure.epsilon)
    assert (np.abs(law - profile.slope(x)) <= 1e-13 * scale).all()
    assert (np.abs(pressure.potentials(x + 1e-290j)[0] - F) <= 1e-13 * scale).all()
