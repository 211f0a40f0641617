"""Rows of indenters and periodic ones: values, the least of their heights, what is refused."""

import itertools
import math
import pickle

import numpy as np
import pytest

import sie
from sie import Flat, FromFunction, Parabola, Periodic, Polynomial, Row, Sampled, Wedge

TWO = Row([Parabola(1.0).shifted(-1.0), Parabola(0.5).shifted(0.9).raised(0.02)])
FLATS = Row([Flat(0.4).shifted(-0.6), Flat(0.55).shifted(0.85)])
MIXED = Row([Flat(0.4), FromFunction(np.sinh, domain=(-3, 3)).raised(0.01), Wedge(0.5).shifted(1)])
TRACE = Sampled(np.linspace(-1, 1, 41), np.cos(5 * np.linspace(-1, 1, 41)))
ROWS = [TWO, FLATS, MIXED, Row([TRACE, Parabola(1.0).shifted(0.2).raised(-0.9)]), Row([TWO, FLATS])]
WAVES = [Periodic(profile, 7.0) for profile in (Parabola(2.0), Flat(0.3), *ROWS[:4], TRACE)]
X = np.linspace(-3.4871, 3.4913, 1401)


@pytest.mark.parametrize("profile", WAVES[:2])
def test_a_periodic_profile_is_a_value_that_is_rebuilt_from_its_repr(profile):
    assert eval(repr(profile), vars(sie) | {}) == pickle.loads(pickle.dumps(profile)) == profile


@pytest.mark.parametrize("row", ROWS)
def test_a_row_is_as_high_as_its_lowest_profile(row):
    least = np.min([profile.height(X) for profile in row.profiles], axis=0)
    np.testing.assert_array_equal(row.height(X), least)


@pytest.mark.parametrize("row", ROWS)
def test_the_slope_of_a_row_is_that_of_its_lowest_profile(row):
    heights = np.array([profile.height(X) for profile in row.profiles])
    slopes = np.array([profile.slope(X) for profile in row.profiles])
    order = np.sort(heights, axis=0)
    clear = np.isfinite(order[0]) & (order[1] > order[0] + 1e-9)
    expected = slopes[np.argmin(heights, axis=0), np.arange(len(X))]
    away = clear & (np.abs(X[:, None] - np.array(row.breaks)).min(axis=1, initial=1.0) > 1e-9)
    np.testing.assert_allclose(row.slope(X)[away], expected[away], rtol=1e-13, atol=1e-15)


def test_places_without_an_indenter_are_walls():
    assert FLATS.walls == ((-0.19999999999999996, 0.29999999999999993),)
    assert FLATS.mirrored().walls == ((-0.29999999999999993, 0.19999999999999996),)
    assert Row([Flat(0.4), Parabola(1.0).raised(0.01)]).walls == ((-0.4, -0.4), (0.4, 0.4))


@pytest.mark.parametrize("wave", WAVES)
@pytest.mark.parametrize("turns", [-3, 1, 100])
def test_a_periodic_profile_repeats_itself(wave, turns):
    here, there = wave.height(X), wave.height(X + turns * 7.0)
    np.testing.assert_allclose(there, here, rtol=1e-11, atol=1e-11)


def test_an_unbounded_profile_is_repeated_as_the_lowest_of_all_its_copies():
    wave = Periodic(Parabola(2.0).shifted(3.0) + Polynomial((0.0, 0.1, 0.01)), 7.0)
    copies = np.min([wave.profile.height(X - 7.0 * turn) for turn in range(-3, 4)], axis=0)
    np.testing.assert_allclose(wave.height(X), copies, rtol=1e-12)


@pytest.mark.parametrize("profile", [Parabola(1.0), Flat(0.5), TRACE, FLATS.raised(0.2)])
@pytest.mark.parametrize("dz", [0.1, -2.0])
def test_raising_moves_a_profile_away(profile, dz):
    expected = profile.height(X) + dz
    np.testing.assert_allclose(profile.raised(dz).height(X), expected, rtol=1e-15, atol=1e-15)
    np.testing.assert_array_equal(profile.raised(dz).slope(X), profile.slope(X))


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: Row([]), "without profiles"),
        (lambda: Row([1.0]), "is not a profile"),
        (lambda: Row([WAVES[0]]), "periodic"),
        (lambda: Periodic(Flat(1.0), 1.5), "more than its period"),
        (lambda: Periodic(Flat(1.0), -1.0), "not positive"),
        (lambda: Periodic(WAVES[0], 2.0), "periodic already"),
        (lambda: WAVES[0].tilted(0.1), "leave it level"),
        (lambda: WAVES[0] + Parabola(1.0), "add profiles first"),
        (lambda: Polynomial((0, 0, 1)).raised(math.nan), "raised is nan"),
    ],
)
def test_what_is_no_row_is_refused(build, words):
    with pytest.raises(ValueError, match=words):
        build()


@pytest.mark.parametrize("seed", range(4))
def test_profiles_are_equally_high_where_they_cross(seed):
    rng = np.random.default_rng(seed)
    sizes = 10.0 ** rng.uniform(-0.7, 0.7, 8), rng.uniform(0.0, 8.0, 8), rng.uniform(0.0, 0.1, 8)
    row = Row([Parabola(R).shifted(x).raised(z) for R, x, z in np.array(sizes).T.tolist()])
    for (_, x, one), (_, _, other) in itertools.pairwise(row.lowest):
        z1, z2 = (float(row.profiles[k].height(x)) for k in (one, other))
        steep = np.ptp([float(row.profiles[k].slope(x)) for k in (one, other)])
        assert abs(z1 - z2) < 4.0 * (np.spacing(z1) + steep * np.spacing(abs(x)))
