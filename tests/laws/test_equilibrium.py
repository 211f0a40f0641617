"""∫p dx = P and ∫p x dx = M, by a quadrature of the tests' own."""

import laws
import numpy as np
import pytest
import strategies
from hypothesis import example, given
from hypothesis import strategies as st
from scenes import scene

import sie

PROMISE = 1e-13
SKEW = sie.Polynomial(
    (0.0, -1.401298464324817e-45, 1.876738192497544, -2.587110489760189, 2.06470087947402)
)


def defects(solution):
    """|∫p - P| / P and |∫p x - M| / (P r), with what rounding of the abscissae explains."""
    breaks = solution.scene.profile.breaks
    P, about_centre = laws.load_and_moment(solution.pressure, solution.edges, breaks)
    rounding = laws.rounding_of_x(solution.pressure, solution.edges, breaks) / solution.normal_load
    moment = about_centre + solution.normal_load * solution.centre - solution.moment
    return (
        abs(P / solution.normal_load - 1),
        abs(moment) / (solution.normal_load * solution.half_width),
        rounding,
    )


@given(strategies.scenes())
@example(
    scene(sie.Power(8.0, 5.54565460683982) + sie.Wedge(0.7253859731064591).shifted(0.39453125))
)
def test_the_pressure_carries_the_load_and_the_moment(asked):
    solution = sie.solve(asked)
    force, moment, rounding = defects(solution)
    assert force <= PROMISE + 4 * rounding
    assert moment <= PROMISE * (1 + abs(solution.centre) / solution.half_width) + 4 * rounding


@given(strategies.scenes(sharp=False), strategies.between(0.5, 2.0))
@example(scene(SKEW.shifted(0.47265625), tilt=0.046875), 0.5)
def test_a_half_width_given_is_in_equilibrium_too(asked, factor):
    narrow = sie.solve(asked).half_width
    solution = sie.solve(asked).with_(half_width=narrow * max(factor, 1.0))
    force, moment, rounding = defects(solution)
    assert force <= PROMISE + 4 * rounding
    assert moment <= PROMISE * (1 + abs(solution.centre) / solution.half_width) + 4 * rounding


@given(strategies.scenes(), strategies.between(-0.2, 0.2))
def test_a_moment_given_is_the_moment_of_the_pressure(asked, lever):
    """Unless a lever of 0.2 r tilts a wedge or a sharp punch beyond its slopes."""
    upright = sie.solve(asked)
    wanted = upright.moment + lever * asked.normal_load * upright.half_width
    solution = upright.with_(moment=wanted)
    try:
        found = solution.moment
    except sie.LoadError:
        return
    _, moment, rounding = defects(solution)
    reach = solution.half_width + abs(solution.centre)
    assert found == pytest.approx(wanted, abs=PROMISE * asked.normal_load * reach)
    assert moment <= PROMISE * (1 + abs(solution.centre) / solution.half_width) + 4 * rounding


@given(strategies.scenes())
def test_the_density_reports_the_load_and_the_moment_of_the_solution(asked):
    solution = sie.solve(asked)
    assert solution.pressure.resultant == solution.normal_load == asked.normal_load
    assert solution.pressure.moment == solution.moment
    assert solution.pressure.interval == solution.edges


@given(strategies.scenes(), st.integers(0, 2**32 - 1))
def test_the_pressure_is_positive_inside_zero_outside_and_never_nan(asked, seed):
    solution = sie.solve(asked)
    (x1, x2), r = solution.edges, solution.half_width
    inside = x1 + 2 * r * np.random.default_rng(seed).uniform(1e-6, 1 - 1e-6, 200)
    assert (solution.pressure(inside) > 0).all()
    beside = np.nextafter(x1, -np.inf) - 1e-15 * r, np.nextafter(x2, np.inf) + 1e-15 * r
    outside = [*beside, x1 - r, x2 + 1e6 * r, -np.inf, np.inf]
    assert (solution.pressure(outside) == 0).all()


def test_a_quadrature_of_the_tests_finds_a_load_that_is_wrong():
    solution = sie.solve(sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, half_width=1.0))
    P, _ = laws.load_and_moment(
        lambda x: solution.pressure(x) * (1 + 1e-12), solution.edges, (-0.5, 0.5)
    )
    assert abs(P / solution.normal_load - 1) == pytest.approx(1e-12, rel=0.1)
