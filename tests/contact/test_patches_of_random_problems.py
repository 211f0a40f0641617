"""Kinds of random problems that once failed: patches longer than half a period, waves without end,
moments of light loads, concave corners that nearly close, rounding, searches that go astray.
"""

import numpy as np
import pytest
from rough_traces import rough_trace as trace

import sie
from analytic import two_parabolas
from sie.contact import normal
from sie.patches import newton, solver
from sie.patches.of_scene import problem_of
from sie.profiles.profile_pieces import of_profile
from sie.profiles.resolution import rounding_noise


def solved(**asked):
    return sie.solve(sie.Scene(modulus=1.0, **asked))


def waves(x):
    """The slope of a shallow bowl with waves, which have no end."""
    return x / 7.5 - 0.05 * np.sin(11.0 * x + 0.3) - 0.03 * np.sin(7.0 * x - 1.0)


def rounded_flats(*places):
    flats = [sie.RoundedFlat(a, R).shifted(x).raised(z) for a, R, x, z in places]
    return sie.Row(flats)


# -- accuracy --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("points", "load"), [(60, 5.0), (97, 5.0), (240, 20.0)])
def test_a_patch_longer_than_half_a_period_meets_the_equation(points, load):
    """The two halves of such a patch are nearer to each other than to their repetitions."""
    profile = sie.Periodic(trace(points, 4, size=0.001), 2.0 + 2.0 / points)
    assert solved(profile=profile, normal_load=load).check().residual < 1e-13


@pytest.mark.parametrize("seed", range(4))
def test_pressures_of_a_rough_trace_meet_the_equation_to_rounding(seed):
    profile = sie.Periodic(trace(200, seed), 2.01)
    certificate = solved(profile=profile, normal_load=0.05).check()
    assert certificate.residual < 2e-14


def test_pressures_of_waves_meet_the_equation_to_rounding():
    scene = sie.Scene(profile=sie.FromFunction(waves), modulus=1.0, normal_load=20.0)
    certificate = sie.solve(scene).in_patches.certificate(1e-13)
    assert certificate.residual < 1e-13


@pytest.mark.parametrize("load", [3.0, 20.0])
def test_the_gap_beside_waves_is_the_integral_of_its_slope(load):
    solution = solved(profile=sie.FromFunction(waves), normal_load=load)
    start = solution.edges[1] + 0.5
    x = start + 3.0 * solution.half_width * np.array([0.0, 0.5, 1.0])
    g, w = np.polynomial.legendre.leggauss(16)
    cuts = np.linspace(x[0], x[-1], 2001)
    t = cuts[:-1, None] + np.diff(cuts)[:, None] * 0.5 * (1.0 + g)
    opening = waves(t) + solution.tilt - 2.0 * solution.pressure.hilbert(t)
    parts = 0.5 * np.diff(cuts) * (opening @ w)
    rises = [parts[:1000].sum(), parts[1000:].sum()]
    assert np.diff(solution.gap(x)) == pytest.approx(rises, rel=1e-12)


@pytest.mark.parametrize("tilt", [-0.018, -0.1, 0.03])
def test_the_pressure_beside_a_sharp_edge_carries_the_load_to_rounding(tilt):
    """A move of the smooth edge depends on the charge of the sharp one."""
    row = sie.Row([sie.Flat(0.2).shifted(x) for x in (0.0, 1.5, 3.07)])
    certificate = solved(profile=row, normal_load=2.5e-4, tilt=tilt).check()
    assert certificate.force < 3e-14


@pytest.mark.slow(but=3)
@pytest.mark.parametrize("height", [0.0, 0.05, 0.1, 0.2])
@pytest.mark.parametrize("load", [10.0, 12.0, 14.0, 17.0, 20.0])
def test_two_parabolas_that_nearly_fill_their_period_meet_the_equation(load, height):
    """All places are as near to one edge of such a patch as to the other, to 1e-10 of it."""
    row = sie.Row([sie.Parabola(1.0), sie.Parabola(1.0).shifted(1.0).raised(height)])
    solution = solved(profile=sie.Periodic(row, 2.5), normal_load=load)
    assert len(solution.patches) == 1
    assert solution.check().ok


def test_a_step_that_was_cut_short_does_not_end_the_search():
    sizes = [1e-3, 1e-4, 1e-9]
    assert newton._settled(sizes, True, np.False_)
    assert not newton._settled(sizes, False, np.False_)


@pytest.mark.parametrize("waves_", [1, 2, 3])
def test_a_spline_that_is_level_at_a_point_has_no_corner_there(waves_):
    """Its slope there is rounding, on either side another."""
    x = np.linspace(-1.0, 1.0, 24 * waves_ + 1)
    profile = sie.Sampled(x, 0.05 * np.cos(2.0 * waves_ * np.pi * x))
    assert not of_profile(profile, (-1.0, 1.0), 1e-15).never_closed.size


# -- the certificate -------------------------------------------------------------------------------


@pytest.mark.parametrize("distance", [30.0, 1e3, 1e4])
def test_light_contacts_far_from_the_origin_are_certified_to_the_rounding_of_x(distance):
    row = sie.Row([sie.Parabola(1.0), sie.Parabola(1.0).shifted(distance)])
    certificate = solved(profile=row, normal_load=1e-4).check()
    half_width = np.sqrt(4.0 * 0.5e-4 / np.pi)
    assert certificate.ok
    assert certificate.measured_to < 100.0 * np.spacing(distance) / half_width


@pytest.mark.parametrize("load", [1e-6, 1e-4])
@pytest.mark.parametrize("place", [5.3, 50.0])
def test_moments_about_a_distant_origin_are_certified_to_the_rounding_of_x(place, load):
    flats = rounded_flats((0.05, 0.3, place, 0.0), (0.05, 0.3, place + 3.0, 0.1))
    certificate = solved(profile=flats, normal_load=load, moment=(place + 0.01) * load).check()
    assert certificate.ok
    assert certificate.measured_to < 1e-6


@pytest.mark.parametrize("load", [1e-4, 0.02, 1.0])
def test_the_equation_is_measured_away_from_the_points_of_its_rule(load):
    """Beside one the difference of two pressures is rounding, and its quotient large."""
    scene = sie.Scene(profile=sie.Periodic(trace(60, 4), 2.05), modulus=1.0, normal_load=load)
    rule, places = sie.solve(scene).in_patches.pressure.rules
    x, at = np.sort(rule.points.x), places.points.x
    k = np.searchsorted(x, at)
    between = (at - x[k - 1]) / (x[k] - x[k - 1])
    assert between == pytest.approx(0.5, abs=0.1)


@pytest.mark.parametrize("gap", [1e-9, 1e-10, 5e-11, 2e-11, 1e-11, 1e-12, 1e-13])
@pytest.mark.parametrize("middle", [0.0, 5.0])
def test_a_concave_corner_that_nearly_closes_is_open_or_closed_without_tension(gap, middle):
    inner, outer, shape = 0.5 * gap, 0.5 * gap + 1.0, {"radius": 1.0, "modulus": 1.0}
    d = float(two_parabolas.distance(inner=inner, outer=outer))
    load = float(two_parabolas.load(inner=inner, outer=outer, **shape))
    row = sie.Row([sie.Parabola(1.0).shifted(middle + s * d) for s in (-1.0, 1.0)])
    solution = solved(profile=row, normal_load=load)
    assert solution.check().ok
    assert len(solution.patches) == 2 or gap < 1e-10
    assert solution.patches[-1][1] == pytest.approx(middle + outer, abs=1e-9)


def test_a_corner_that_closes_to_rounding_leaves_no_charge_in_the_measure():
    """A narrow parabola shows by 1e-5 under a wide one. At its corners p falls like 1e-4 ln x, is
    0.1 as near as doubles tell, and -inf where a distance from one is rounded to 0.
    """
    wide, narrow = sie.Parabola(1.3).shifted(0.064), sie.Parabola(0.7).shifted(0.049)
    row = sie.Row([wide.raised(3.7e-4), narrow.raised(5.5e-4)])
    measured = solved(profile=row, normal_load=0.05).check()
    assert measured.tension == ()
    assert measured.residual < 3e-13  # 5e-14 of rounding; 1.5e-12 if p is 0 there


@pytest.mark.parametrize("part", [1e-3, 2e-3, 5e-3])
@pytest.mark.parametrize("load", [0.02, 0.2])
def test_closed_corners_are_certified_to_the_rounding_of_their_place(part, load):
    """The narrow one of two parabolas shows over so much of its radius of about 0.25."""
    place, length, curvature = 0.04, 0.25 * part, 1.0 / 0.25 - 1.0 / 4.0
    touches = 0.5 * place**2 / (4.0 - 0.25)
    narrow = sie.Parabola(0.25).shifted(place).raised(touches - curvature * length**2 / 8.0)
    measured = solved(profile=sie.Row([sie.Parabola(4.0), narrow]), normal_load=load).check()
    assert measured.tension == () and measured.ok
    assert measured.measured_to < 1e-10


@pytest.mark.parametrize("load", [1e-4, 1e-6])
def test_a_flat_pressed_lightly_keeps_within_its_concave_corners(load):
    """Its edges are close to the kinks at the ends of its base, beside which h' is small."""
    row = rounded_flats(
        (0.13, 0.86, 1.32, 0.02), (0.45, 0.21, 2.76, 0.012), (0.38, 0.26, 4.4, 0.015)
    )
    solution = solved(profile=row, normal_load=load)
    assert solution.check().ok
    assert solution.patches[0] == pytest.approx((2.31, 3.21), abs=0.01)


# -- the search ------------------------------------------------------------------------------------


@pytest.mark.parametrize("load", [20.0, 75.0, 200.0])
def test_waves_without_end_are_answered(load):
    """One patch would be looked at out to 1000 half-widths, where no series resolves the waves."""
    solution = solved(profile=sie.FromFunction(waves), normal_load=load)
    assert solution.check().ok


@pytest.mark.slow
@pytest.mark.parametrize("lever", [-0.1, 0.0, 0.2])
def test_a_moment_between_two_waves_is_answered_by_both(lever):
    load = 1e-3
    solution = solved(profile=sie.FromFunction(waves), normal_load=load, moment=lever * load)
    assert len(solution.patches) == 2
    assert solution.check().ok


@pytest.mark.slow
@pytest.mark.parametrize("load", [1e-4, 1e-3])
def test_a_moment_that_jumps_from_wave_to_wave_ends_the_search_for_one_patch(load, monkeypatch):
    calls, original = [], normal._edges_at

    def counted(*args, **given):
        calls.append(1)
        return original(*args, **given)

    monkeypatch.setattr(normal, "_edges_at", counted)
    solution = solved(profile=sie.FromFunction(waves), normal_load=load, moment=-0.1 * load)
    assert len(solution.patches) == 2
    assert len(calls) < 30


@pytest.mark.parametrize("load", [1e-4, 1e-5, 1e-6])
def test_a_light_load_between_two_corners_touches_both(load):
    """The cells of a grid are wider than the contacts by far, and on no other than these two acts
    a pressure with the moment.
    """
    row = rounded_flats((0.43, 0.12, 1.4, 0.014), (0.4, 0.9, 9.6, 0.0014), (0.3, 4.9, 18.4, 0.013))
    solution = solved(profile=row, normal_load=load, moment=5.2 * load)
    assert len(solution.patches) == 2
    assert solution.check().ok


def test_noise_is_not_what_a_wave_does_between_close_points():
    assert rounding_noise(lambda x: np.sin(12.0 * x), -126.0, 126.0) < 1e-13


@pytest.mark.parametrize("moment", [{}, {"moment": 0.3}])
def test_a_load_under_which_no_search_settles_is_refused_by_its_name(moment, monkeypatch):
    calls = []

    def astray(*_):
        calls.append(1)
        raise sie.LoadError("stopped")

    monkeypatch.setattr(solver, "settled", astray)
    row = sie.Row([sie.Parabola(1.0), sie.Parabola(0.5).shifted(2.0).raised(0.1)])
    with pytest.raises(sie.LoadError, match=r"normal_load = 0\.6: .* change the load") as error:
        solver.contact(problem_of(sie.Scene(profile=row, modulus=2.0, normal_load=0.6, **moment)))
    assert ("or the moment" in str(error.value)) == bool(moment)
    assert len(calls) <= 3
