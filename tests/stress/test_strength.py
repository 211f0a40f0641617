"""Where the body yields first and where its surface is torn most."""

import numpy as np
import pytest
import strategies
from hypothesis import example, given
from hypothesis import strategies as st
from scenes import solved

import sie
from analytic import rounded_flat
from oracles.normal_contact import mp

NU = 0.3
UNIT = dict.fromkeys(("half_width", "radius", "modulus"), mp.one)


def punch(a, friction=0.0, **changes):
    profile = sie.RoundedFlat(a, 1.0) if a else sie.Parabola(1.0)
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=1.0, poisson=NU))
    return solution.with_(
        friction=friction, tangential_load=friction * solution.normal_load, **changes
    )


def exact_j2(a, friction):
    """J2(x, y) of the sliding rounded punch in closed form, an mpmath function; y may be 0."""
    f, kappa = mp.mpf(friction), 1 - 2 * mp.mpf(NU)
    arguments = {"half_flat": mp.mpf(a), **UNIT, "lib": mp}

    def j2(x, y):
        z = mp.mpc(x, y)
        F = rounded_flat.potential(z, **arguments)
        D = (
            y * mp.mpc(1, -f) * rounded_flat.potential_derivative(z, **arguments) if y else 0
        ) - f * F
        return abs(D) ** 2 + kappa**2 / 3 * (mp.im(F) - f * mp.re(F)) ** 2

    return j2


def polished(a, friction, x, y):
    """The stationary point of the exact J2 next to (x, y), to 25 digits."""
    j2, h = exact_j2(a, friction), mp.mpf(10) ** -12

    def along(function, t):
        return (
            8 * (function(t + h) - function(t - h)) - (function(t + 2 * h) - function(t - 2 * h))
        ) / (12 * h)

    how = {"tol": 1e-40, "verify": False}
    if y == 0.0:
        start = mp.mpf(x) - 1e-6, mp.mpf(x) + 1e-6
        x = mp.findroot(lambda x: along(lambda t: j2(t, 0), x), start, **how)
        return x, mp.zero, j2(x, 0)
    steep = lambda x, y: (along(lambda t: j2(t, y), x), along(lambda t: j2(x, t), y))  # noqa: E731
    x, y = mp.findroot(steep, (mp.mpf(x), mp.mpf(y)), **how)
    return x, y, j2(x, y)


@pytest.mark.slow(but=2)
@pytest.mark.parametrize(
    ("a", "f"),
    [
        (0.5, 0.0), (0.5, 0.3), (0.0, 0.0), (0.05, 0.0), (0.1, 0.1), (0.15, 0.0), (0.3, 0.2),
        (0.8, 0.05), (0.95, 0.0), (0.05, 0.3), (0.8, 0.5), (0.95, 0.4),
    ],
)  # fmt: skip
def test_the_elastic_limit_has_twelve_digits_and_its_place_eight(a, f):
    found = punch(a, f).elastic_limit()
    x, y, j2 = polished(a, f, found.x, found.y)
    P = rounded_flat.load(half_flat=mp.mpf(a), **UNIT, lib=mp)
    assert found.ratio == pytest.approx(float(P / mp.sqrt(j2)), rel=1e-12)
    assert abs(found.x - x) <= 1e-8 and abs(found.y - y) <= 1e-8


def test_hertz_yields_below_the_centre_and_in_sliding_on_the_surface_as_in_johnson():
    solution = punch(0.0)
    found = solution.elastic_limit()
    assert float(solution.pressure(0.0)) / found.stress == pytest.approx(
        3.10672722353653, rel=1e-14
    )
    assert found.y == pytest.approx(0.704291684588, abs=1e-12)
    for f in (0.3, 0.4, 0.5):
        sliding = punch(0.0, f).elastic_limit()
        assert sliding.ratio == pytest.approx(
            (np.pi / 2) / np.sqrt(f**2 + (1 - 2 * NU) ** 2 * (1 + f**2) / 3), rel=1e-13
        )
        assert sliding.x == pytest.approx(f / np.sqrt(1 + f**2), abs=1e-9)


@pytest.mark.parametrize("a", [0.13, 0.15, 0.3, 0.7])
def test_both_of_two_tied_maxima_are_reported(a):
    """They are one, on the axis, up to a/b = 0.125."""
    (place,) = punch(0.125).elastic_limit().places
    assert abs(place[0]) <= 1e-8
    (left, depth), (right, other) = punch(a).elastic_limit().places
    assert left == pytest.approx(-right, abs=1e-8) and depth == pytest.approx(other, abs=1e-8)


@pytest.mark.slow
@given(
    strategies.scenes(sharp=False),
    strategies.between(0.0, 0.6),
    st.sampled_from(["mises", "tresca"]),
)
def test_no_point_of_a_fine_scan_exceeds_the_maximum(scene, friction, criterion):
    solution = sie.solve(scene)
    Q = friction * solution.normal_load
    solution = solution.with_(poisson=NU, friction=friction, tangential_load=Q)
    found = solution.elastic_limit(criterion)
    if np.isinf(found.stress):
        return
    (x1, x2), r = solution.edges, solution.half_width
    marks = np.array([x1, *(b for b in scene.profile.breaks if x1 < b < x2), x2])
    t = np.sin(0.5 * np.pi * np.linspace(0, 1, 61)) ** 2
    between = (marks[:-1, None] + np.diff(marks)[:, None] * t).ravel()
    x = np.unique(np.append(between, np.linspace(x1 - r, x2 + r, 201)))
    y = np.concatenate(([0.0], r * np.geomspace(1e-5, 3.0, 120)))[:, None]
    s = solution.stress(x, y)
    scan = np.sqrt(s.j2) if criterion == "mises" else s.max_shear
    assert scan[np.isfinite(scan)].max() <= found.stress * (1 + 1e-12)
    # An edge is known beyond its double, and next to it the stress changes like the root of the
    # distance.
    here = solution.stress(found.x + np.spacing(found.x) * np.arange(-4.0, 5.0), found.y)
    around = np.sqrt(here.j2) if criterion == "mises" else here.max_shear
    assert abs(around[4] - found.stress) <= 1e-9 * found.stress + np.ptp(
        around[np.isfinite(around)]
    )


@pytest.mark.parametrize("a", [0.0, 0.3, 0.95, 1 - 1e-9])
@pytest.mark.parametrize("f", [0.1, 0.5])
def test_the_largest_tension_is_at_the_trailing_edge(a, f):
    peak = punch(a, f).peak_tension()
    assert peak.value == pytest.approx(f * (1 - a), rel=1e-13)
    assert peak.x == pytest.approx(-1.0, abs=1e-15)
    assert punch(a, f).with_(
        tangential_load=-f * punch(a).normal_load
    ).peak_tension().x == pytest.approx(1.0, abs=1e-15)


def test_bulk_stress_adds_to_the_tension_and_is_all_there_is_without_friction():
    assert punch(0.3, 0.2, bulk_stress=0.5).peak_tension().value == pytest.approx(
        0.2 * 0.7 + 0.5, rel=1e-13
    )
    assert punch(0.3, bulk_stress=0.5).peak_tension().value == pytest.approx(0.5, rel=1e-12)


KINKS = sie.Piecewise(  # two columns of the search side by side are -inf
    (-np.inf, -0.15234375, 0.21875, 0.58203125, 1.45703125, 1.9375, 2.37890625, np.inf),
    ((0.29217529296875, 2.328125), (-0.0625, 0.0), (-0.0625, 0.0), (-0.0625, 0.0),
     (-1.2064971923828125, 0.78515625), (-8.782424926757812, 4.6953125),
     (-0.5677642822265625, 1.2421875)),
)  # fmt: skip
ROUGH = KINKS.mirrored() + sie.Power(1.5, 1.0000002302585358).shifted(0.109375)


@given(strategies.scenes(sharp=False), st.floats(0.05, 0.6))
@example(sie.Scene(profile=ROUGH, modulus=1.0, normal_load=1.0), 0.1463934967311738)
def test_no_point_of_the_surface_has_more_tension(scene, friction):
    solution = sie.solve(scene)
    solution = solution.with_(friction=friction, tangential_load=friction * solution.normal_load)
    peak = solution.peak_tension()
    (x1, x2), r = solution.edges, solution.half_width
    x = np.linspace(x1 - r, x2 + r, 4001)
    xx = solution.surface_stress(x).xx
    assert xx.max() <= peak.value + 1e-13 * abs(peak.value)


def test_a_sharp_edge_has_infinite_tension_and_yields_at_once():
    flat = sie.solve(sie.Scene(profile=sie.Flat(1.0), modulus=1.0, poisson=NU, normal_load=1.0))
    sliding = flat.with_(friction=0.3, tangential_load=0.3)
    assert sliding.peak_tension() == sie.Peak(np.inf, -1.0)
    assert sliding.elastic_limit().load == 0.0
    assert flat.elastic_limit().places == ((-1.0, 0.0), (1.0, 0.0))


def test_an_unknown_criterion_is_refused():
    with pytest.raises(ValueError, match=r'"rankine".*"mises" or "tresca"'):
        punch(0.3).elastic_limit("rankine")


@pytest.mark.slow(but=4)
@pytest.mark.parametrize("length", [1e-100, 1e100])
@pytest.mark.parametrize("modulus", [1e-100, 1e100])
@pytest.mark.parametrize("criterion", ["mises", "tresca"])
def test_no_unit_of_length_or_stress_changes_the_elastic_limit(length, modulus, criterion):
    """The slope of the stress at the surface needs a side of it, however small the contact."""

    def limit(length, modulus):
        P = 0.01 * modulus * length
        profile = sie.RoundedFlat(length, 50.0 * length)
        loads = {"normal_load": P, "friction": 0.3, "tangential_load": 0.2 * P}
        return solved(profile, modulus=modulus, poisson=NU, **loads).elastic_limit(criterion)

    here, there = limit(1.0, 1.0), limit(length, modulus)
    assert there.ratio == pytest.approx(
        here.ratio, rel=1e-13
    ) and there.x / length == pytest.approx(here.x, rel=1e-8)


RUBBER = sie.Elastic(young=3.0, poisson=0.5)


def test_an_incompressible_body_under_a_corner_has_no_limit_and_one_of_0499_yields_at_once():
    scene = sie.Scene(profile=sie.Wedge(0.1), body=RUBBER, normal_load=0.2)
    with pytest.raises(sie.ContactError, match=r"round the corner, or give poisson = 0\.499"):
        sie.solve(scene).elastic_limit()
    body = sie.Elastic(3.0, 0.499)
    assert (
        sie.solve(sie.Scene(profile=sie.Wedge(0.1), body=body, normal_load=0.2))
        .elastic_limit()
        .load
        == 0.0
    )


def around(solution, x, criterion="mises"):
    """The largest measured stress around x, in all directions, 1e-9 to 1 half-widths away."""
    radius = solution.half_width * np.geomspace(1e-9, 1.0, 400)[:, None]
    angle = np.linspace(1e-2, np.pi - 1e-2, 91)
    stress = solution.stress(x + radius * np.cos(angle), radius * np.sin(angle))
    return float((np.sqrt(stress.j2) if criterion == "mises" else stress.max_shear).max())


@pytest.mark.slow
def test_next_to_the_end_of_a_stick_zone_no_depth_is_worse():
    profile = sie.Piecewise((-0.25, 0.125), ((0.25, 1.0), (0.5, 2.0), (0.375, 3.0)))
    loads = {"normal_load": 0.02, "tangential_load": -0.005, "bulk_stress": -0.3}
    solution = solved(profile, poisson=0.2, friction=0.35, **loads)
    found = solution.elastic_limit()
    for x in (
        *solution.edges,
        *solution.stick[0],
        *(b for b in profile.breaks if solution.edges[0] < b < solution.edges[1]),
    ):
        assert around(solution, x) <= found.stress * (1 + 1e-12)
