"""Profiles are values, and say of themselves what is true."""

import copy
import pickle

import numpy as np
import pytest
import strategies
from faceted import Faceted
from hypothesis import given
from strategies import between, dyadic

import sie
from sie.io import scene_file
from sie.profiles import kinds

INF = float("inf")


def module_level_slope(x):
    return np.sinh(x)


EVERY_KIND = (
    *(scene_file.parse(scene_file.example(kind)).scene.profile for kind in kinds.KINDS),
    sie.Parabola(2.0),
    sie.RoundedFlat(0.5, 3.0),
    sie.Flat(1.5),
    sie.Wedge(0.25),
    sie.Power(2.5, 0.75),
    sie.Power(3, 0.75),
    sie.Polynomial((0.0, 0.125, 0.5, 0.0, 0.25)),
    sie.Piecewise((-0.5, 1.0), ((0.25, 0.5), (0.0,), (-2.0, 2.0))),
    sie.Piecewise((-1.0, 0.0, 0.5), ((0.0, 0.5), (0.0, 2.0))),
    sie.FromFunction("sinh(x) + x/3", domain=(-2.0, 3.0)),
    sie.FromFunction(module_level_slope, breaks=(0.5,), domain=(-2.0, 3.0)),
    Faceted(2.0, 0.125),
    sie.Row([sie.Flat(0.4).shifted(-0.6), sie.Wedge(0.5).shifted(0.9).raised(0.02)]).mirrored(),
    sie.Parabola(2.0).tilted(0.125),
    sie.RoundedFlat(0.5, 3.0).shifted(-0.25),
    sie.Piecewise((-1.0, 0.0, 0.5), ((0.0, 0.5), (0.0, 2.0))).mirrored(),
    sie.Wedge(0.25) + sie.Parabola(2.0),
    (sie.Wedge(0.25).shifted(0.5) + sie.Parabola(2.0).tilted(0.0625)).mirrored().shifted(0.25)
    + (sie.Power(4, 1.0) + sie.Flat(3.0)),
)
each = pytest.mark.parametrize("profile", EVERY_KIND, ids=repr)


def solved(profile):
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=1e-3))


@each
def test_a_profile_is_a_value_that_is_rebuilt_from_its_repr(profile):
    before = hash(profile), repr(profile)
    rebuilt = eval(repr(profile), vars(sie) | globals() | {"inf": INF})
    for twin in (rebuilt, copy.deepcopy(profile)):
        assert twin == profile
        assert (hash(twin), repr(twin)) == before
    with pytest.raises(AttributeError):
        profile.radius = 7.0
    solved(profile).check()
    assert (hash(profile), repr(profile)) == before


@each
def test_a_profile_and_its_solution_survive_pickling(profile):
    assert pickle.loads(pickle.dumps(profile)) == profile
    solution = solved(profile)
    value = float(solution.pressure(solution.centre + 0.1 * solution.half_width))
    assert solved(pickle.loads(pickle.dumps(profile))).edges == solution.edges
    again = pickle.loads(pickle.dumps(solution))
    assert again.scene == solution.scene
    assert vars(again).keys() == vars(solution).keys()
    assert float(again.pressure(solution.centre + 0.1 * solution.half_width)) == value


def test_profiles_of_different_kinds_or_numbers_are_different():
    for i, one in enumerate(EVERY_KIND):
        for other in EVERY_KIND[i + 1 :]:
            assert one != other


def inside(profile, n=41):
    lo, hi = (np.clip(e, -2.5, 2.5) for e in profile.domain)
    x = lo + (hi - lo) * (np.arange(n) + 0.5) / n
    return x[np.abs(x[:, None] - np.array([*profile.breaks, 1e9])).min(axis=1) > 1e-3]


@each
def test_the_slope_is_the_derivative_of_the_height(profile):
    x, d = inside(profile), 1e-4
    far, near = (profile.height(x + k * d) - profile.height(x - k * d) for k in (2, 1))
    difference = (8 * near - far) / (12 * d)
    assert profile.slope(x) == pytest.approx(difference, rel=1e-9, abs=1e-10)


@each
def test_height_and_slope_keep_the_shape_of_their_argument(profile):
    for shape in ((), (1,), (3, 2), (0,)):
        x = np.full(shape, 0.3)
        assert np.shape(profile.height(x)) == np.shape(profile.slope(x)) == shape
    assert np.shape(profile.height([0.1, 0.2])) == (2,)


@each
def test_the_height_is_infinite_beyond_the_ends_and_finite_inside(profile):
    lo, hi = profile.domain
    assert np.isfinite(profile.height(inside(profile))).all()
    for end, outwards in ((lo, -1.0), (hi, 1.0)):
        if np.isfinite(end):
            assert profile.height(end + outwards * 1e-9) == INF
            assert profile.slope(end + outwards * 1e-9) == outwards * INF
            assert np.isfinite(profile.height(end))


@each
def test_breaks_ascend_inside_the_domain(profile):
    lo, hi = profile.domain
    assert list(profile.breaks) == sorted(set(profile.breaks))
    assert all(lo < b < hi for b in profile.breaks)


@given(strategies.profiles())
def test_between_breaks_a_profile_has_no_corner(profile):
    """The slope's second difference goes like the square of the step; at a corner like the step."""
    x, d = inside(profile, 23), 1e-4
    x = x[np.abs(x[:, None] - np.array([*profile.breaks, 1e9])).min(axis=1) > 1e-2]

    def bend(step):
        return np.abs(profile.slope(x + step) - 2 * profile.slope(x) + profile.slope(x - step))

    rounding = 1e-14 * (1 + np.abs(profile.slope(x)).max(initial=0.0))
    assert (bend(0.1 * d) <= 0.03 * bend(d) + rounding).all()


@given(strategies.profiles(), dyadic(-1, 1), dyadic(-1, 1))
def test_tilted_shifted_mirrored_and_sums_have_the_heights_of_their_formulas(profile, slope, dx):
    x = inside(profile)
    h = profile.height
    assert profile.tilted(slope).height(x) == pytest.approx(h(x) + slope * x, rel=1e-13, abs=1e-13)
    assert profile.tilted(slope).slope(x) == pytest.approx(
        profile.slope(x) + slope, rel=1e-13, abs=1e-13
    )
    moved = profile.shifted(dx)
    assert moved.height(x) == pytest.approx(h(x - dx), rel=1e-12, abs=1e-12)
    assert moved.domain == tuple(e + dx for e in profile.domain)
    assert profile.mirrored().height(x) == pytest.approx(h(-x), rel=1e-13, abs=1e-13)
    assert profile.mirrored().slope(x) == pytest.approx(-profile.slope(-x), rel=1e-12, abs=1e-12)
    both = profile + sie.Parabola(2.0).shifted(dx)
    assert both.height(x) == pytest.approx(
        h(x) + sie.Parabola(2.0).shifted(dx).height(x), rel=1e-12, abs=1e-12
    )
    assert both.slope(x) == pytest.approx(
        profile.slope(x) + sie.Parabola(2.0).shifted(dx).slope(x), rel=1e-12, abs=1e-12
    )


def test_the_sum_of_profiles_has_the_common_domain_if_there_is_one():
    both = sie.Flat(1.0).shifted(0.5) + sie.FromFunction("x", domain=(-1.0, 1.0))
    assert both.domain == (-0.5, 1.0)
    with pytest.raises(ValueError, match=r"do not overlap.*shift one of them"):
        sie.Flat(1.0) + sie.Flat(1.0).shifted(3.0)
    with pytest.raises(ValueError, match="shift it less"):
        sie.Flat(1.0).shifted(1e20)


def chain(terms):
    """A sum of moved profiles, which is moved after each is added."""
    total = sie.Wedge(0.25) + sie.Flat(3.0)
    for k in range(terms):
        total = (total.tilted(1e-4) + sie.Wedge(1e-6).shifted(1e-4 * k)).mirrored()
    return total


def test_a_sum_of_hundreds_of_terms_is_a_value_that_solves():
    profile = chain(300)
    again = pickle.loads(pickle.dumps(profile))
    assert again == profile == copy.deepcopy(profile)
    assert (hash(again), repr(again)) == (hash(profile), repr(profile))
    assert profile != profile.tilted(0.5)
    assert np.isfinite(profile.height(0.3))
    assert profile.ends_are_corners == (True, True)
    assert solved(again).edges == solved(profile).edges


def test_sums_are_the_same_however_they_are_bracketed():
    a, b, c = sie.Parabola(1.0), sie.Wedge(0.5), sie.Flat(2.0)
    assert (a + b) + c == a + (b + c)
    assert hash((a + b) + c) == hash(a + (b + c))


@each
def test_even_parity_is_declared_only_where_it_is_true(profile):
    if profile.parity == "even":
        x = inside(profile)
        assert profile.height(-x) == pytest.approx(profile.height(x), rel=1e-14, abs=1e-15)
        assert profile.domain[0] == -profile.domain[1]
    else:
        assert profile.parity == "none"


@pytest.mark.parametrize(
    "profile",
    [sie.Parabola(1.0), sie.RoundedFlat(1.0, 1.0), sie.Flat(1.0), sie.Wedge(1.0),
     sie.Power(2.5, 1.0), sie.Polynomial((0, 0, 1)),
                sie.Piecewise((-1.0, 1.0), ((1.0, 1.0), (0.0,), (-1.0, 1.0))),
                sie.Wedge(1.0) + sie.Parabola(1.0)], ids=repr,
)  # fmt: skip
def test_symmetric_profiles_are_known_to_be_even(profile):
    assert profile.parity == "even"
    assert profile.shifted(0.5).parity == "none"
    assert profile.tilted(0.5).parity == "none"
    assert profile.mirrored() == profile


@given(strategies.profiles(), between(-1.5, 1.5), between(-1.5, 1.5))
def test_a_profile_known_to_be_convex_is_convex(profile, one, other):
    if profile.convex and one != other:
        low, high = min(one, other), max(one, other)
        assert profile.slope(high) >= profile.slope(low) - 1e-12 * (1 + abs(profile.slope(high)))


@pytest.mark.parametrize(
    "profile",
    [sie.Polynomial((0, 0, 1, 0, -0.1)), sie.Piecewise((0.0,), ((0.0, 1.0), (-0.1, 1.0))),
     sie.Piecewise((-1.0, 1.0), ((0.0, 1.0), (-1.5, -0.5), (-3.0, 1.0))),
     sie.FromFunction("x - sin(x)")],
    ids=repr,
)  # fmt: skip
def test_a_profile_not_known_to_be_convex_is_not_marked_convex(profile):
    assert not profile.convex


def test_heights_are_measured_from_the_nearest_point_to_zero():
    assert sie.Piecewise((1.0, 2.0), ((0.0, 1.0),)).height(1.0) == 0.0
    assert sie.FromFunction("x", domain=(1.0, 2.0)).height(2.0) == pytest.approx(1.5)
    assert sie.FromFunction("x").height(0.0) == 0.0


def test_a_height_that_a_class_does_not_state_is_the_integral_of_its_slope():
    """At the corners the polygon is the parabola, but for what its middle is higher."""
    x = np.array([-np.inf, -20.0, -0.5, -0.25, 0.0, 0.0625, 0.375, 12.5, np.nan])
    h = [np.inf, np.inf, 0.0625, 0.015625, 0.0, 0.001953125, 0.03515625, 39.0625, np.nan]
    assert Faceted(2.0, 0.125).height(x) == pytest.approx(h, rel=1e-14, nan_ok=True)


def test_short_facets_press_like_the_parabola_of_hertz():
    """b = sqrt(4 P R/(π E*)), and the difference falls faster than the length of a facet."""
    missed = []
    for facet in (0.05, 0.0125):
        scene = sie.Scene(profile=Faceted(1.0, facet), modulus=1.0, normal_load=np.pi / 16.0)
        solution = sie.solve(scene)
        assert solution.check().ok
        missed.append(abs(solution.half_width / 0.5 - 1.0))
    assert 0.0 < missed[0] < 0.05
    assert missed[1] < 0.25 * missed[0]
