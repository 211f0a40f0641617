"""Dissimilar bodies pressed with friction under profiles that are not symmetric."""

from __future__ import annotations

import numpy as np
import pytest

import sie
from oracles import spence

SKEW = sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.02))
JUMPS = sie.Piecewise((-9.0, -0.4, 0.4, 9.0), ((-0.4, 2.0), (0.0, 1.0), (0.4, 2.0)))
UNEVEN = {
    "polynomial": (SKEW, 0.5),
    "tilted wedge": (sie.Wedge(0.3).tilted(0.1), 0.5),
    "wedge and parabola": (sie.Wedge(0.2).tilted(0.02) + sie.Parabola(1.0), 0.5),
    "flat base": (sie.Piecewise((-0.5, 0.4), ((0.5, 1.0), (0.0,), (-0.2, 0.5))), 0.2),
    "function": (sie.FromFunction("exp(x) - 1"), 0.5),
    "broken power": (sie.Power(1.5, 1.0) + SKEW, 0.2),
}


def scene(profile=SKEW, beta=0.3, friction=0.3, load=0.5, **changes):
    given = {"normal_load": load} if "half_width" not in changes else {}
    pair = {"modulus": 2.0, "poisson": 0.3, "dundurs": beta, "friction": friction}
    return sie.Scene(profile=profile, **pair, **(given | changes))


def solved(*args, **changes):
    return sie.solve(scene(*args, **changes))


CERTIFIED = [
    *((profile, 0.3, 0.3, {"load": load}) for profile, load in UNEVEN.values()),
    *((SKEW, *pair, {}) for pair in
      ((0.07, 0.3), (0.5, 0.5), (0.01, 1.0), (0.3, 5.0), (-0.3, 0.3))),
    # One edge hardly moves
    *((sie.Wedge(0.2), 0.13, 3.0, {"load": 0.012, "tilt": tilt}) for tilt in (0.08, -0.12, 0.15)),
]  # fmt: skip


@pytest.mark.slow(but=8)
@pytest.mark.parametrize(("profile", "beta", "friction", "given"), CERTIFIED)
def test_both_equations_hold_by_a_quadrature_that_the_solver_does_not_use(
    profile, beta, friction, given
):
    found = solved(profile, beta, friction, **given).check()
    assert found.ok
    assert max(found.residual, found.shear.residual) < 2e-12


def test_the_mirrored_profile_has_the_mirrored_contact():
    one, other = solved(), solved(SKEW.mirrored())
    assert other.edges == pytest.approx([-x for x in one.edges[::-1]], rel=1e-13)
    x = np.array([-0.5, -0.1, 0.2, 0.4])
    assert other.pressure(-x) == pytest.approx(one.pressure(x), rel=1e-12)
    assert other.shear(-x) == pytest.approx(-one.shear(x), abs=1e-13)
    assert other.moment == pytest.approx(-one.moment, rel=1e-12)


def test_tilt_of_the_scene_is_tilt_of_the_profile():
    one, other = solved(tilt=0.05), solved(SKEW.tilted(0.05))
    assert one.edges == other.edges and one.stick == other.stick
    assert one.tilt == 0.05 and one.check().ok
    assert one.gap(2.0) == pytest.approx(float(other.gap(2.0)), rel=1e-13)


def test_half_width_and_load_are_inverse_to_each_other():
    one = solved(load=0.5)
    other = solved(half_width=one.half_width)
    assert other.normal_load == pytest.approx(0.5, rel=1e-12)
    assert other.edges == pytest.approx(one.edges, rel=1e-12)


def test_stick_zone_keeps_its_part_of_the_contact_as_under_symmetric_profiles():
    solution = solved()
    ((lo, hi),), (x1, x2) = solution.stick, solution.edges
    assert (hi - lo) / (x2 - x1) == pytest.approx(0.6457874123866, abs=1e-12)
    assert lo + hi == pytest.approx(x1 + x2, abs=1e-14)


TIPS = pytest.mark.parametrize("profile", [sie.Wedge(0.3), sie.Wedge(0.3).tilted(0.1)], ids=repr)


@TIPS
def test_pressure_rises_like_the_logarithm_of_the_distance_towards_a_tip(profile):
    rising = solved(profile).pressure(10.0 ** np.array([-14.0, -16.0, -100.0, -200.0]))
    per_decade = np.diff(rising)[[0, 2]] / (2.0, 100.0)
    assert per_decade[1] == pytest.approx(per_decade[0], rel=1e-11)


@TIPS
@pytest.mark.parametrize("distance", [5e-324, 1e-310, 1e-300])
def test_tractions_and_slip_are_finite_at_any_distance_from_a_tip(profile, distance):
    solution, x = solved(profile), np.array([-distance, distance])
    values = np.array([solution.pressure(x), solution.shear(x), solution.slip(x)])
    assert np.isfinite(values).all()
    assert (values[0] > solution.pressure(np.sign(x) * 1e-200)).all()


def test_the_body_yields_first_where_no_other_place_is_stressed_more():
    solution = solved()
    yielding = solution.elastic_limit()
    x, y = np.linspace(-0.6, 0.6, 13), np.geomspace(1e-3, 1.0, 8)[:, None]
    assert (solution.stress(x, y).j2 <= yielding.j2).all()


def on_a_grid(state, n):
    """The printed equations increment by increment, between the edges of the state's growth."""
    s = state.half_width * np.linspace(0.0, 1.0, n + 1)[1:]
    middles = [state.frozen.middle(one) for one in s]
    edges = np.array([(m - one, m + one) for m, one in zip(middles, s, strict=True)])
    last = 2.0 * edges[-1] - edges[-2]  # of the outermost cells, where p is 0
    ends = (last[0], *edges[::-1, 0], state.frozen.middle(0.0), *edges[:, 1], last[1])
    return spence.followed_contact(SKEW.height, np.array(ends), (0.3, 0.3))  # E*/2 = 1


def test_a_grid_with_the_same_edges_finds_the_load_and_no_shear_load():
    solution = solved()
    state = solution.coupled[1].pressed
    errors = []
    for n in (20, 40):
        grid = on_a_grid(state, n)
        P, Q = grid.loads
        errors.append(abs(P / 0.5 - 1.0))
        assert abs(Q) < 1e-3 * P
        width = 2.0 * state.half_width / len(grid.x)
        ((lo, hi),) = solution.stick
        sticking = grid.x[grid.sticks]
        assert sticking[0] == pytest.approx(lo, abs=2.0 * width)
        assert sticking[-1] == pytest.approx(hi, abs=2.0 * width)
    assert errors[1] < 0.6 * errors[0] < 0.03


@pytest.mark.slow(but=7)
@pytest.mark.parametrize(
    ("profile", "changes", "words"),
    [
        (SKEW, {"friction": 0.1}, "from P = 0.0139"),
        (sie.Flat(1.0), {"tilt": 0.05}, "touches first at x = -1"),
        (sie.Flat(0.5) + SKEW, {}, "reaches a corner of the indenter at x = -0.5"),
        (JUMPS, {}, "reaches a corner of the indenter at x = 0.4"),
        (SKEW, {"moment": 0.1}, "give a tilt in its place"),
        (SKEW, {"moment": 0.0}, "give a tilt in its place"),
        (sie.Parabola(1.0).shifted(0.5), {"moment": 0.0}, "give a tilt"),
        (sie.RoundedFlat(0.5, 1.0), {"tilt": 0.05}, "to the right 0.646 times as fast"),
        (sie.Wedge(0.3), {"tilt": 0.25}, "would not grow steadily"),
    ],
)
def test_what_is_not_solved_is_refused_with_the_reason(profile, changes, words):
    with pytest.raises(sie.ContactError, match=words):
        _ = solved(profile, **changes).edges


@pytest.mark.parametrize("friction", [0.1, 0.05, 0.03])
def test_a_contact_is_solved_up_to_the_load_that_a_refusal_names(friction):
    with pytest.raises(sie.ContactError, match="from P = ") as refusal:
        _ = solved(friction=friction).edges
    load = float(str(refusal.value).split("P = ")[1].split(" ")[0])
    assert solved(friction=friction, load=0.99 * load).check().ok
    with pytest.raises(sie.ContactError, match="from P = "):
        _ = solved(friction=friction, load=1.02 * load).edges


def test_a_light_load_on_a_wide_base_is_told_from_one_on_a_symmetric_profile():
    sides = sie.RoundedFlat(0.5, 1.0) + sie.RoundedFlat(0.5, 2.0).shifted(0.1)
    assert solved(sides, load=1e-4).check().ok
