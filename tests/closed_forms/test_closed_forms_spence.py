"""Spence's stick zone and loads against other formulations, limits and the solver."""

import math

import mpmath
import numpy as np
import pytest

import sie
from analytic import bonded_flat, goodman, power, spence

# beta, f, c/b, b p(0)/P of the flat, M(2)
TABLE = [
    (0.1, 0.1, 0.70061786631, 0.32027597518, 0.31651145915),
    (0.2, 0.3, 0.913700055232, 0.325433464420, 0.30966325689),
    (0.3, 0.1, 0.0281849146283, 0.345244082252, 0.31234709218),
    (0.3, 0.3, 0.6457874123866, 0.3378744452057, 0.302604209509),
    (0.3, 0.5, 0.9246117565700, 0.3349212640270, 0.298476370441),
    (0.4, 0.4, 0.5937440281925, 0.3565693999850, 0.291189996706),
    (0.5, 0.2, 0.04084680342861, 0.4068002623182, 0.29932319304),
    (0.5, 0.5, 0.52190767492215, 0.38667072667918, 0.2776371136744),
    (0.5, 1.0, 0.8895859253767, 0.3739542976491, 0.26336097905),
]


@pytest.mark.slow(but=4)
@pytest.mark.parametrize(("beta", "f", "ratio", "pressure", "moment"), TABLE)
def test_stick_zone_pressure_and_load_are_those_of_the_table(beta, f, ratio, pressure, moment):
    given = {"friction": f, "dundurs": beta}
    found = spence.stick_half_width(half_width=2.0, **given)
    assert found == pytest.approx(2.0 * ratio, rel=1e-11)
    found = spence.flat_central_pressure(half_width=2.0, normal_load=3.0, **given)
    assert found == pytest.approx(1.5 * pressure, rel=2e-11)
    found = spence.load(half_width=1.0, coefficient=0.5, exponent=2.0, modulus=1.0, **given)
    assert found == pytest.approx(0.25 / moment, rel=2e-11)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 3.0, 6.0])
@pytest.mark.parametrize(("beta", "f"), [(0.1, 0.1), (0.3, 0.2), (0.2, 0.3)])
def test_the_solver_carries_the_load_of_the_power_law(beta, f, exponent):
    given = {"half_width": 1.0, "coefficient": 0.1, "exponent": exponent, "modulus": 2.0}
    expected = spence.load(**given, friction=f, dundurs=beta)
    profile = sie.Wedge(0.1) if exponent == 1.0 else sie.Power(exponent, 0.1)
    solution = sie.solve(
        sie.Scene(profile=profile, modulus=2.0, dundurs=beta, friction=f, half_width=1.0)
    )
    assert solution.normal_load == pytest.approx(expected, rel=1e-11)
    c = spence.stick_half_width(half_width=1.0, friction=f, dundurs=beta)
    assert solution.stick[0][1] == pytest.approx(c, rel=1e-11)


@pytest.mark.parametrize("quotient", [0.3, 1.0, 2.0])
def test_the_stick_zone_of_a_small_mismatch_is_that_of_goodman(quotient):
    def departure(beta):
        given = {"half_width": 1.0, "friction": quotient * beta, "dundurs": beta}
        return spence.stick_half_width(**given) / goodman.stick_half_width(**given) - 1.0

    assert abs(departure(1e-4)) < 1e-6
    assert departure(1e-3) == pytest.approx(100.0 * departure(1e-4), rel=1e-4)


def test_the_load_of_a_small_mismatch_is_that_without_friction():
    given = {"half_width": 1.0, "coefficient": 0.1, "exponent": 2.5, "modulus": 2.0}
    found = spence.load(**given, friction=1e-6, dundurs=1e-6)
    assert found == pytest.approx(power.load(**given), rel=1e-11)


def test_thin_slip_zones_keep_their_relative_accuracy():
    given = {"half_width": 1.0, "friction": 1.0, "dundurs": 0.1}
    found = spence.slip_width(**given)
    assert found == pytest.approx(1.76e-10, rel=3e-3)  # of three digits


@pytest.mark.slow
def test_a_context_of_more_digits_continues_the_double():
    context = mpmath.MPContext()
    context.dps = 20
    given = {"half_width": 1.0, "friction": 0.3, "dundurs": 0.3}
    precise = spence.stick_half_width(**given, lib=context)
    assert float(precise) == pytest.approx(spence.stick_half_width(**given), rel=1e-13)


def test_what_has_no_answer_is_refused():
    with pytest.raises(ValueError, match="one number of each"):
        spence.stick_half_width(half_width=1.0, friction=np.array([0.1, 0.2]), dundurs=0.1)
    with pytest.raises(ValueError, match="give friction nearer to dundurs"):
        spence.slip_width(half_width=1.0, friction=0.3, dundurs=1e-4)


@pytest.mark.parametrize("exponent", [1.0, 1.37, 2.0, 10.0])
def test_a_contact_that_sticks_all_over_carries_the_load_of_a_bonded_one(exponent):
    beta, friction = 0.05, 0.9
    given = {"half_width": 2.0, "friction": friction, "dundurs": beta}
    assert spence.stick_half_width(**given) == 2.0
    p = spence.flat_central_pressure(**given, normal_load=3.0)
    bonded = bonded_flat.pressure(0.0, half_width=2.0, normal_load=3.0, dundurs=beta)
    assert p == pytest.approx(bonded, rel=1e-14)
    law = {"coefficient": 0.5, "exponent": exponent, "modulus": 1.0}
    eta = mpmath.atanh(beta) / mpmath.pi
    M = mpmath.quad(
        lambda v: mpmath.cos(2 * eta * v) * mpmath.tanh(v) ** exponent / mpmath.sinh(v),
        [0, 0.1, 1, 3, 8, 30, 80],
    )
    expected = 0.5 * 2.0**exponent * math.pi / (2.0 * float(M))
    assert spence.load(**given, **law) == pytest.approx(expected, rel=1e-12)
