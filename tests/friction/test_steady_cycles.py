"""Steady cycles of a history, and the contacts of an indenter that turns."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from history_cases import (
    HERTZ,
    IN_PHASE,
    LOPSIDED,
    OUT_OF_PHASE,
    P0,
    F,
    f,
    followed,
    hertz_stick,
    inside,
    scaled,
)

import sie


def test_out_of_phase_loads_run_through_a_diamond():
    history = followed(HERTZ, OUT_OF_PHASE)
    ends = [hertz_stick(0.6, 0.0), hertz_stick(0.8, 0.05)] * 2
    for solution, stick in zip(history, ends, strict=False):
        assert solution.stick[0] == pytest.approx(stick, abs=1e-13)
    x = np.linspace(-0.99, 0.99, 41)
    assert history[4].shear(x) == pytest.approx(history[0].shear(x), abs=1e-13)
    assert history[4].slip(x) == pytest.approx(history[0].slip(x), abs=1e-11)
    assert history[4].energy_lost == pytest.approx(1.1932322e-3, abs=5e-11)
    assert history[4].energy_lost - history[0].energy_lost == pytest.approx(
        9.545858e-4, abs=1.2e-10
    )


def test_loads_in_phase_settle_after_two_turning_points():
    history = followed(HERTZ, IN_PHASE + IN_PHASE[1:] + IN_PHASE[1:])
    first, second, third, fourth, fifth, sixth = list(history)[1:]
    assert first.stick[0] == pytest.approx(hertz_stick(0.65, -0.05), abs=1e-13)
    assert second.stick[0] == pytest.approx(hertz_stick(0.6, -0.05), abs=1e-13)
    assert third.stick[0] == pytest.approx(hertz_stick(0.625, -0.05), abs=1e-13)
    x = np.linspace(-0.9, 0.9, 31)
    assert fifth.shear(x) == pytest.approx(third.shear(x), abs=1e-14)
    assert sixth.shear(x) == pytest.approx(fourth.shear(x), abs=1e-14)
    assert fourth.stick[0] == pytest.approx(third.stick[0], abs=1e-13) and sixth.check().shear.ok


def test_an_edge_that_holds_up_the_slip_at_first_leaves_the_state_at_the_end_right():
    points = [(1, 0, 0), (1.3, 0.55, 0.2), (0.8, -0.3, -0.15), (1.3, 0.55, 0.2)]
    history = followed(HERTZ, points)
    ends = [hertz_stick(0.75, -0.1), hertz_stick(0.5, -0.075), hertz_stick(0.625, -0.0875)]
    for solution, stick in zip(list(history)[1:], ends, strict=True):
        assert solution.stick[0] == pytest.approx(stick, abs=1e-13)


@pytest.mark.slow
def test_a_trial_of_an_advancing_end_that_leaves_the_contact_gives_no_warning():
    points = [(1, 0, 0), (1.4031, 0.7101, 0.16746), (0.89323, -0.28385, -0.26637)]
    with suppress(sie.ContactError):  # the energy may depend on the way
        assert followed(HERTZ, points)[-1].energy_lost > 0.0


def test_a_layer_that_stuck_is_taken_off_before_slip_goes_on():
    """P up and down past where Q and σ were applied: as if it had not risen."""
    points = [(1, 0.3, 0.1), (1.1, 0.3, 0.1), (0.9, 0.3, 0.1)]
    around, straight = followed(HERTZ, points)[-1], followed(HERTZ, points[::2])[-1]
    x = inside(around)
    assert around.stick[0] == pytest.approx(straight.stick[0], abs=1e-13)
    assert around.shear(x) == pytest.approx(straight.shear(x), abs=1e-14)
    assert around.energy_lost == pytest.approx(straight.energy_lost, rel=1e-10)


def test_a_step_next_to_full_sliding_under_bulk_stress_leaves_a_narrow_stick_zone():
    """At Q = f P itself it depends on rounding whether the step is answered or refused."""
    history = followed(HERTZ, [(1, 0, 0), (0.9, 0.9 * (1.0 - 1e-4), 0.1), (1, -0.5, 0)])
    ((a, b),) = history[1].stick
    assert b - a < 0.1 and history[2].check().shear.ok
    assert history[2].stick[0] == pytest.approx(hertz_stick(0.25, -0.025), abs=1e-4)


def test_a_moment_along_the_path_is_the_tilt_that_carries_it():
    points = [(P0, 0.3 * F), (P0, -0.2 * F), (P0, 0.2 * F)]
    moments = [0.02, 0.04, 0.0]
    given_moment = sie.follow(LOPSIDED, sie.Path(points, moment=moments))
    tilts = [solution.tilt for solution in given_moment]
    given_tilt = sie.follow(LOPSIDED, sie.Path(points, tilt=tilts))
    for one, other, moment in zip(given_moment, given_tilt, moments, strict=True):
        assert one.moment == pytest.approx(moment, abs=1e-15)
        x = inside(other, 21)
        assert one.shear(x) == pytest.approx(other.shear(x), abs=1e-12)


STEADY = {
    "lopsided, all vary": (LOPSIDED, (1.2, 0.6, 0.15, -0.04), (0.9, -0.2, -0.1, 0.06),
                           (-0.75913821, 0.71742219), 8.81199143e-4),
    "mean bulk stress": (LOPSIDED, (1, 0.5, 0.3, 0), (1, -0.3, 0.3, 0),
                         (-0.77427281, 0.66151665), 8.04651659e-4),
    "tilt in phase": (HERTZ, (1, 0.5, 0, -0.1), (1, -0.5, 0, 0.1),
                      (-0.70710678, 0.70710678), 1.77372505e-3),
    "mean tangential load": (HERTZ, (1.1, 0.7, 0.3, 0), (0.9, 0.1, 0.1, 0),
                             (-0.78666003, 0.88666003), 4.41165813e-4),
    "in phase": (HERTZ, (1.2, 0.55, 0.1, 0), (0.9, -0.3, -0.1, 0),
                 (-0.74056942, 0.84056942), 3.76972722e-4 + 7.33594819e-4),
    "bulk stress alone": (HERTZ, (1, 0, 0.4, 0), (1, 0, 0, 0),
                          (-0.90256157, 0.90256157), (2.9255007e-4 - 1.6153839e-4) * 2.0 / 3.0),
}  # fmt: skip


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("case", sorted(STEADY, reverse=True))
def test_a_steady_cycle_has_the_stick_zone_and_energy_of_marching_and_of_a_mesh(case):
    """From a step by step solution of the rate problem, and in three digits from a mesh."""
    scene, A, B, stick, energy = STEADY[case]
    cycle = sie.steady_cycle(scene, *scaled([A, B]))
    assert cycle.stick[0] == pytest.approx(stick, abs=6e-9)
    assert cycle.energy == pytest.approx(energy, abs=1.2e-11)


def test_a_steady_cycle_is_that_of_the_path_that_settles():
    history = followed(HERTZ, IN_PHASE + IN_PHASE[1:] + IN_PHASE[1:2])
    cycle = sie.steady_cycle(HERTZ, *scaled(IN_PHASE[1:]))
    x = np.linspace(-0.94, 0.94, 41)
    A, B = history[3], history[4]
    assert cycle.shear_range(x) == pytest.approx(np.abs(A.shear(x) - B.shear(x)), abs=1e-12)
    assert cycle.slip_range(x) == pytest.approx(np.abs(B.tangential.slip_now(x)), abs=1e-12)
    followed_range = sie.Cycle([B, history[5]]).range(x, 0.1)
    steady_range = sie.Cycle(cycle).range(x, 0.1)
    for name in ("xx", "yy", "xy"):
        assert steady_range[name].range == pytest.approx(followed_range[name].range, abs=1e-12)


def test_a_cycle_that_sticks_dissipates_nothing():
    cycle = sie.steady_cycle(HERTZ, (1.3 * P0, 0.3 * F), (0.8 * P0, 0.2 * F))
    x = np.linspace(-1.2, 1.2, 9)
    larger, smaller = (
        sie.solve(replace(HERTZ, normal_load=k * P0)).pressure(x) for k in (1.3, 0.8)
    )
    assert cycle.energy == 0.0 and (cycle.slip_range(x) == 0.0).all()
    assert cycle.stick[0] == pytest.approx(hertz_stick(0.8, 0.0), abs=1e-14)
    assert cycle.shear_range(x) == pytest.approx(0.2 * f * (larger - smaller), abs=1e-15)


@pytest.mark.parametrize(("mean", "tension"), [(0.3, 0.0), (-0.2, 0.4)])
def test_means_of_shear_and_bulk_stress_do_not_change_a_steady_cycle(mean, tension):
    A, B = (1.1, 0.3, 0.1), (0.95, -0.3, -0.05)
    plain = sie.steady_cycle(HERTZ, *scaled([A, B]))
    moved = sie.steady_cycle(
        HERTZ, *scaled([(P, Q + mean, sigma + tension) for P, Q, sigma in (A, B)])
    )
    assert moved.stick[0] == pytest.approx(plain.stick[0], abs=1e-13)
    x = np.linspace(-0.9, 0.9, 31)
    assert moved.shear_range(x) == pytest.approx(plain.shear_range(x), abs=1e-13)
    assert moved.slip_range(x) == pytest.approx(plain.slip_range(x), abs=1e-13)


@pytest.mark.parametrize(
    ("A", "B", "said"),
    [
        ((1, 0.5), (1, 1.2), "^the cycle at B, .*exceeds f P"),
        ((1, -1.2), (1, 0.5), "^the cycle at A, .*exceeds f P"),
        ((1, 0.3, 0.3), (0.9, 0.28, -0.3), "^the cycle on the way to B, "),
    ],
)
def test_a_cycle_without_one_permanent_stick_zone_is_refused(A, B, said):
    with pytest.raises(sie.ContactError, match=said):
        sie.steady_cycle(HERTZ, *scaled([(*A, 0.0)[:3], (*B, 0.0)[:3]]))


@pytest.mark.parametrize("name", ["A", "B"])
@pytest.mark.parametrize(
    ("point", "said"),
    [
        ((1.0,), "{} = .*give"),
        ((1.0, np.nan, 0.0), "Q of {} is nan"),
        ((np.inf, 0.1, 0.0), "P of {} = inf"),
        ((1.0, 0.0, 1e200), "σ of {} = 1e.200"),
        ((1.0, 0.0, 0.0, np.inf), "tilt of {} = inf"),
        ((0.0, 0.0), "P of {} = 0 is not positive.*give P > 0"),
    ],
)
def test_an_invalid_point_of_a_cycle_is_refused_by_its_name(point, said, name):
    ends = {"A": (P0, 0.1), "B": (P0, -0.1)} | {name: point}
    with pytest.raises(ValueError, match="^" + said.format(name)):
        sie.steady_cycle(HERTZ, **ends)
