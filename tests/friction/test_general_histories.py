"""P, Q, bulk stress and tilt together along a path: state functions, the ladder of tilted
contacts, steady cycles, and an incremental solution on a mesh.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

import sie
from oracles.kalker import Mesh
from oracles.load_history import history as on_a_mesh
from sie.contact import edges
from sie.io import scene_file

P0, f = np.pi / 4.0, 0.3
F, S = f * P0, 4.0 * f * P0 / np.pi
HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=P0, friction=f)
LOPSIDED = replace(HERTZ, profile=sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.125)))
# Points are (P/P0, Q/F, σ/S, tilt).
FALLING = [(1, 0, 0), (1, 0.4, 0.1), (0.7, 0.3, 0.3)]
IN_PHASE = [(1, 0, 0), (1.2, 0.55, 0.1), (0.9, -0.3, -0.1)]
OUT_OF_PHASE = [(1, 0.4, 0), (1, 0, 0.2), (1, -0.4, 0), (1, 0, -0.2), (1, 0.4, 0)]


def scaled(points):
    return [(P * P0, Q * F, sigma * S, *tilt) for P, Q, sigma, *tilt in points]


def followed(scene, points, parts=1):
    tilt = [point[3] for point in points] if len(points[0]) == 4 else ()
    path = sie.Path([point[:3] for point in scaled(points)], tilt=tilt)
    return sie.follow(scene, path.subdivided(parts))


def hertz_stick(level, tilt):
    """The contact of h' = x + tilt under level × P0, whose half-width is 1 under P0."""
    return -tilt - np.sqrt(level), -tilt + np.sqrt(level)


def inside(solution, n=21):
    """Points of the contact away from its edges, where q falls like a square root."""
    x1, x2 = solution.edges
    return 0.5 * (x1 + x2) + 0.49 * (x2 - x1) * np.linspace(-1.0, 1.0, n)


# -- state functions ------------------------------------------------------------------------------


def test_falling_load_leaves_the_stick_zone_of_the_end_loads_alone():
    """Reduced load P - Q/f, tilt -2τ/(f E*), although P fell on the way."""
    solution = followed(HERTZ, FALLING)[-1]
    assert solution.stick[0] == pytest.approx(hertz_stick(0.4, -0.15), abs=1e-14)
    x = np.linspace(-0.8, 0.8, 33)
    inner = np.sqrt(np.maximum(0.4 - (x - 0.15) ** 2, 0.0)) / 2.0
    q = f * (np.sqrt(np.maximum(0.7 - x * x, 0.0)) / 2.0 - inner)
    assert solution.shear(x) == pytest.approx(q, abs=1e-14)
    assert solution.check().ok


def test_the_energy_of_a_falling_load_is_that_of_the_slip_rate():
    """∫∫ f p (2/E*) f {(A/π) arccosh v ∓ B ρ sqrt(v² - 1)}, A = dP - dQ/f, B = -dτ/f."""
    A, B = (-0.3 + 0.1) * P0, -0.2 * S / 4.0 / f
    g, w = np.polynomial.legendre.leggauss(40)
    angle, weight = 0.5 * np.pi * 0.5 * (g + 1.0), 0.25 * np.pi * w
    lost = 0.0
    for t, share in zip(0.5 * (g + 1.0), 0.5 * w, strict=True):
        r = np.sqrt(1.0 - 0.3 * t)
        rho, m = np.sqrt(0.6 - 0.2 * t), 0.05 + 0.1 * t
        for side in (1.0, -1.0):
            length = r - side * m - rho
            from_edge = length * np.cos(angle) ** 2
            p = 0.5 * np.sqrt(from_edge * (2.0 * r - from_edge))
            v = 1.0 + length * np.sin(angle) ** 2 / rho
            dx = length * 2.0 * np.sin(angle) * np.cos(angle) * weight
            rate = -A / np.pi * np.arccosh(v) + side * B * rho * np.sqrt(v * v - 1.0)
            lost += share * 2.0 * f * f * float(dx @ (p * rate))
    _, before, after = followed(HERTZ, FALLING)
    assert after.energy_lost - before.energy_lost == pytest.approx(lost, rel=1e-11)


def test_opposite_slip_under_a_falling_load_is_that_of_the_end_loads():
    path = followed(HERTZ, [(1, 0, 0), (0.8, 0.05, 0.5)])[-1]
    scene = sie.solve(path.scene)
    x = inside(scene, 31)
    assert path.stick == scene.stick
    assert path.shear(x) == pytest.approx(scene.shear(x), abs=1e-15)
    assert path.slip(x) == pytest.approx(scene.slip(x), abs=1e-15)
    assert path.energy_lost == pytest.approx(4.183032e-4, abs=5e-11)


@settings(max_examples=4)
@given(
    st.tuples(st.floats(0.6, 1.0), st.floats(0.1, 0.5), st.floats(-0.2, 0.2), st.floats(-0.1, 0.1)),
    st.sampled_from([HERTZ, LOPSIDED]),
)
# The left edge passes a zone of slip on the way, and slip turns there.
@example((0.975, 0.19, -0.2, 0.0), HERTZ)
def test_a_step_in_parts_ends_in_the_same_state(end, scene):
    points = [(1, 0, 0, 0), end]
    try:
        whole = followed(scene, points)[-1]
        parts = followed(scene, points, 2)[-1]
    except sie.ContactError:
        assume(False)
    x, (x1, x2) = inside(whole, 23), whole.history[0].edges
    assert parts.shear(x) == pytest.approx(whole.shear(x), abs=1e-13)
    x = x[(x > x1) & (x < x2)]  # a marched step tells no slip of points that came into contact
    assert parts.slip(x) == pytest.approx(whole.slip(x), abs=1e-12)
    assert parts.energy_lost == pytest.approx(whole.energy_lost, rel=1e-11, abs=1e-15)


# -- the ladder of tilted contacts ----------------------------------------------------------------


def test_out_of_phase_loads_run_through_a_diamond():
    history = followed(HERTZ, OUT_OF_PHASE)
    ends = [hertz_stick(0.6, 0.0), hertz_stick(0.8, 0.05)] * 2
    for solution, stick in zip(history, ends, strict=False):
        assert solution.stick[0] == pytest.approx(stick, abs=1e-13)
    x = np.linspace(-1.0, 1.0, 41)
    assert history[4].shear(x) == pytest.approx(history[0].shear(x), abs=1e-14)
    assert history[4].slip(x) == pytest.approx(history[0].slip(x), abs=1e-14)
    assert history[4].energy_lost == pytest.approx(1.1932322e-3, abs=5e-11)
    assert history[4].energy_lost - history[0].energy_lost == pytest.approx(
        9.545858e-4, abs=1.2e-10
    )


def test_the_energy_of_a_loop_out_of_phase_is_its_area():
    """∮Q dδ - 2/E* ∮(∫q x dx) dτ; each branch by Simpson's rule in an angle."""
    n = 81
    angle = np.linspace(0.0, np.pi, n)
    weight = np.where(np.arange(n) % 2, 4.0, 2.0)
    weight[[0, -1]] = 1.0
    area = 0.0
    corners = scaled(OUT_OF_PHASE)
    for k, (a, b) in enumerate(pairwise(corners)):
        share = 0.5 * (1.0 - np.cos(angle))
        branch = [tuple(np.add(a, t * np.subtract(b, a))) for t in share]
        states = sie.follow(HERTZ, sie.Path([*corners[:k], *branch]))[k:]
        rate = weight * 0.5 * np.sin(angle) * np.pi / (n - 1) / 3.0
        shift = np.array([s.shift for s in states])
        moment = np.array([s.shear.moment for s in states])
        area += states[-1].tangential_load * shift[-1] - states[0].tangential_load * shift[0]
        area -= (b[1] - a[1]) * float(rate @ shift)
        area -= 2.0 * 0.25 * (b[2] - a[2]) * float(rate @ moment)
    history = followed(HERTZ, OUT_OF_PHASE)
    assert area == pytest.approx(history[4].energy_lost - history[0].energy_lost, rel=1e-7)


def test_loads_in_phase_settle_after_two_turning_points():
    history = followed(HERTZ, IN_PHASE + IN_PHASE[1:] + IN_PHASE[1:])
    first, second, third, fourth, fifth, sixth = list(history)[1:]
    assert first.stick[0] == pytest.approx(hertz_stick(0.65, -0.05), abs=1e-13)
    assert second.stick[0] == pytest.approx(hertz_stick(0.6, -0.05), abs=1e-13)
    assert third.stick[0] == pytest.approx(hertz_stick(0.625, -0.05), abs=1e-13)
    x = np.linspace(-0.9, 0.9, 31)
    assert fifth.shear(x) == pytest.approx(third.shear(x), abs=1e-14)
    assert sixth.shear(x) == pytest.approx(fourth.shear(x), abs=1e-14)
    assert fourth.stick == second.stick and sixth.check().shear.ok


def test_an_edge_that_holds_up_the_slip_at_first_leaves_the_state_at_the_end_right():
    """P falls faster than the slip starts there."""
    points = [(1, 0, 0), (1.3, 0.55, 0.2), (0.8, -0.3, -0.15), (1.3, 0.55, 0.2)]
    history = followed(HERTZ, points)
    ends = [hertz_stick(0.75, -0.1), hertz_stick(0.5, -0.075), hertz_stick(0.625, -0.0875)]
    for solution, stick in zip(list(history)[1:], ends, strict=True):
        assert solution.stick[0] == pytest.approx(stick, abs=1e-13)


def test_a_front_that_is_held_up_is_that_of_the_step_in_parts():
    """At the cut it has not passed all that slipped on beside the old stick zone."""
    start, end = (1.3, 0.55, 0.2), (0.8, -0.3, -0.15)
    midway = tuple(a + 0.6 * (b - a) for a, b in zip(start, end, strict=True))
    whole, parts = (followed(HERTZ, [(1, 0, 0), start, *on, end])[-1] for on in ([], [midway]))
    assert parts.stick[0] == pytest.approx(whole.stick[0], abs=1e-9)
    assert parts.energy_lost == pytest.approx(whole.energy_lost, rel=1e-9)


def test_a_front_that_is_held_up_passes_slip_that_went_on_outside_the_old_stick_zone():
    """That slip has its end at 0.951; the stick zone before was [-0.732, 0.682]."""
    *_, solution = history = followed(HERTZ, [(1, 0, 0), (1.1, 0.6, -0.05), (0.9, 0.2, -0.25)])
    assert solution.stick[0] == pytest.approx(hertz_stick(0.8, -0.05), abs=1e-14)
    assert "layers" in history.plan.steps[2].reason


def test_a_trial_of_an_advancing_end_that_leaves_the_contact_gives_no_warning():
    points = [(1, 0, 0), (1.4031, 0.7101, 0.16746), (0.89323, -0.28385, -0.26637)]
    with pytest.raises(sie.ContactError, match="advance"):
        _ = followed(HERTZ, points)[-1].energy_lost


def test_a_nested_loop_leaves_no_memory():
    points = [(1, 0.6, 0.1), (0.95, -0.2, -0.05), (1.0, 0.1, 0.0), (0.95, -0.2, -0.05)]
    _, before, _, after = history = followed(LOPSIDED, points)
    x = inside(after, 31)
    assert after.stick[0] == pytest.approx(before.stick[0], abs=1e-12)
    assert after.shear(x) == pytest.approx(before.shear(x), abs=1e-13)
    layers = [len(history.turning_points[k].memory.layers) for k in (1, 2, 3)]
    assert layers[0] == layers[2] < layers[1]


def test_a_layer_that_stuck_is_taken_off_before_slip_goes_on():
    """P up and down past where Q and σ were applied: as if it had not risen."""
    points = [(1, 0.3, 0.1), (1.1, 0.3, 0.1), (0.9, 0.3, 0.1)]
    around, straight = followed(HERTZ, points)[-1], followed(HERTZ, points[::2])[-1]
    x = inside(around)
    assert around.stick[0] == pytest.approx(straight.stick[0], abs=1e-13)
    assert around.shear(x) == pytest.approx(straight.shear(x), abs=1e-14)
    assert around.energy_lost == pytest.approx(straight.energy_lost, rel=1e-10)


def test_full_sliding_under_bulk_stress_leaves_no_stick_zone():
    history = followed(HERTZ, [(1, 0, 0), (0.9, 0.9, 0.1), (1, -0.5, 0)])
    assert history[1].stick == () and history[2].check().shear.ok
    assert history[2].stick[0] == pytest.approx(hertz_stick(0.25, -0.025), abs=1e-12)


@pytest.mark.parametrize("points", [FALLING, IN_PHASE, OUT_OF_PHASE[:2]])
def test_mirrored_loads_have_the_mirrored_answer(points):
    """(P, Q, σ, tilt) and (P, -Q, σ, -tilt) of the mirrored profile."""
    mirrored = replace(LOPSIDED, profile=LOPSIDED.profile.mirrored())
    here = followed(LOPSIDED, [(P, Q, 0.5 * s, 0.002 * k) for k, (P, Q, s) in enumerate(points)])
    there = followed(mirrored, [(P, -Q, 0.5 * s, -0.002 * k) for k, (P, Q, s) in enumerate(points)])
    for one, other in zip(here, there, strict=True):
        x = inside(one, 21)
        assert other.shear(-x) == pytest.approx(-one.shear(x), abs=1e-13)
        assert other.stick[0] == pytest.approx(tuple(-end for end in one.stick[0][::-1]), abs=1e-12)


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


# -- steady cycles --------------------------------------------------------------------------------

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


@pytest.mark.parametrize("case", STEADY)
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
    assert cycle.shear_range(x) == pytest.approx(np.abs(A.shear(x) - B.shear(x)), abs=1e-14)
    assert cycle.slip_range(x) == pytest.approx(np.abs(B.tangential.slip_now(x)), abs=1e-14)
    followed_range = sie.Cycle([B, history[5]]).range(x, 0.1)
    steady_range = sie.Cycle(cycle).range(x, 0.1)
    for name in ("xx", "yy", "xy"):
        assert steady_range[name].range == pytest.approx(followed_range[name].range, abs=1e-13)


def test_a_cycle_that_sticks_dissipates_nothing():
    cycle = sie.steady_cycle(HERTZ, (1.3 * P0, 0.3 * F), (0.8 * P0, 0.2 * F))
    x = np.linspace(-1.2, 1.2, 9)
    larger, smaller = (
        sie.solve(replace(HERTZ, normal_load=k * P0)).pressure(x) for k in (1.3, 0.8)
    )
    assert cycle.energy == 0.0 and (cycle.slip_range(x) == 0.0).all()
    assert cycle.stick[0] == pytest.approx(hertz_stick(0.8, 0.0), abs=1e-14)
    assert cycle.shear_range(x) == pytest.approx(0.2 * f * (larger - smaller), abs=1e-15)


@given(st.floats(-0.4, 0.4), st.floats(-0.5, 0.5))
@settings(max_examples=10)
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
        ((1, 0.3, 0.3), (0.9, 0.28, -0.3), "^the cycle on the way to B, .*does not recede at both"),
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
        (3.0, "{} = 3.0"),
        ((1.0, np.nan, 0.0), "Q of {} is nan"),
        ((np.inf, 0.1, 0.0), "P of {} = inf"),
        ((1.0, 0.0, 1e200), "σ of {} = 1e.200"),
        ((1.0, 0.0, 0.0, np.inf), "tilt of {} = inf"),
        ((0.0, 0.0), "P of {} = 0 is not positive.*give P > 0"),
        ((-1.0, 0.0), "P of {} = -1 is not positive.*give P > 0"),
    ],
)
def test_an_invalid_point_of_a_cycle_is_refused_by_its_name(point, said, name):
    ends = {"A": (P0, 0.1), "B": (P0, -0.1)} | {name: point}
    with pytest.raises(ValueError, match="^" + said.format(name)):
        sie.steady_cycle(HERTZ, **ends)


# -- refusals -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([(1, 0.3, 0), (1, 0.3, np.nan)], "σ of point 1 is nan"),
        ([(1, 0.3, 0), (0.2, 0.3, 0.1)], "step 1 .*exceeds f P"),
    ],
)
def test_a_step_that_is_not_covered_is_named(points, said):
    with pytest.raises((sie.ContactError, ValueError), match=said):
        followed(HERTZ, points)


def by_rows(points, folder):
    rows = ", ".join(str(list(row)) for row in points)
    return in_a_scene_file(f"path = [{rows}]", folder)


def by_columns(points, folder):
    lines = "".join(",".join(map(str, row)) + "\n" for row in points)
    (folder / "loads.csv").write_text("P,Q,sigma\n" + lines)
    return in_a_scene_file('path = "loads.csv"', folder)


def in_a_scene_file(loads, folder):
    body = "[body]\nyoung = 2.0\npoisson = 0.0\n"
    profile = '[profile]\nkind = "parabola"\nradius = 1.0\n'
    file = scene_file.parse(f"{profile}{body}[load]\nfriction = {f}\n{loads}\n", folder=folder)
    return sie.follow(file.scene, file.load_path)


def in_python(points, folder):
    return sie.follow(HERTZ, sie.Path(points))


@pytest.mark.parametrize("door", [in_python, by_rows, by_columns])
@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([(P0, 0.1, 0.0), (0.0, 0.0, 0.0)], "P of point 1 = 0 .*must touch"),
        ([(P0, 0.1, 0.0), (P0, 0.0, 0.0), (-P0, 0.0, 0.0)], "P of point 2 = -0.78.*must touch"),
        ([(P0, 0.1, 0.0), (P0, 0.3, 0.0)], "step 1 .*exceeds f P"),
        ([(P0, 0.1, 0.1), (1.1 * P0, 0.1, 0.0), (0.3 * P0, -0.1, 0.0)], "step 2 .*exceeds f P"),
        ([(P0, 0.3, 0.0), (P0, 0.1, 0.0)], "step 0 .*exceeds f P"),
        ([(P0, 0.1, 0.0), (P0, np.nan, 0.0)], "Q of point 1 is nan|lacks a value in line 3"),
        ([(P0, 0.1, 0.0), (P0, 0.1, np.inf)], "σ of point 1 = inf|lacks a value in line 3"),
        ([(P0, 0.1, 0.0), (1e300, 0.1, 0.0)], "P of point 1 = 1e.300"),
        ([(P0, 0.1, 0.0), (1e-300, 0.0, 0.0)], "P of point 1 = 1e-300"),
    ],
)
def test_a_path_that_cannot_be_is_refused_with_its_step_before_any_work(
    points, said, door, tmp_path, monkeypatch
):
    def worked(*_):
        raise AssertionError("a contact was solved")

    monkeypatch.setattr(edges, "edge_integrals", worked)
    with pytest.raises((ValueError, sie.ContactError), match=said):
        door(points, tmp_path)


@pytest.mark.parametrize(
    ("turns", "said"),
    [
        ({"tilt": [0.1]}, "1 values of tilt for 2 points"),
        ({"tilt": [0.1, np.nan]}, "tilt of point 1 is nan"),
        ({"tilt": [0.0, 0.1], "moment": [0.0, 0.1]}, "both tilt and moment"),
        ({"moment": 3.0}, "moment = 3.0 is not"),
    ],
)
def test_turns_of_a_path_that_mean_nothing_are_refused(turns, said):
    with pytest.raises(ValueError, match=said):
        sie.Path([(1.0, 0.1), (1.0, 0.2)], **turns)


def test_a_path_with_tilt_is_a_value():
    path = sie.Path([(1.0, 0.1), (1.0, 0.2, 0.3)], tilt=[0.0, 0.1])
    assert eval(repr(path), {"Path": sie.Path}) == path and hash(path) == hash(path)
    assert path.subdivided(2).tilt == (0.0, 0.05, 0.1)
    with pytest.raises(ValueError, match="scene has a moment"):
        sie.follow(replace(HERTZ, moment=0.0), path)


# -- slip and shift while the contact changes ----------------------------------------------------

GROWING = [(1, 0, 0), (1.3, 0.7, 0.1)]


def slip_rate(x, share):
    """The rate of slip at x on GROWING, R = E* = 1: that of the gap of the reduced contact, whose
    load is P - Q/f and whose centre moves with the bulk stress; 0 before x touches.
    """
    level, centre = 1.0 + share * (0.3 - 0.7), 0.5 * 0.1 * share
    away, r = x - centre, np.sqrt(level)
    v = np.maximum(np.abs(away) / r, 1.0)
    load, turn = P0 * (0.7 - 0.3), -0.5 * 0.1
    rate = f * (2.0 / np.pi * load * np.arccosh(v) + turn * np.sign(away) * r * np.sqrt(v * v - 1))
    return np.where(np.abs(x) <= np.sqrt(1.0 + 0.3 * share), rate, 0.0)


def gauss(lo, hi, n=60):
    """Nodes and weights from lo to hi, dense at both ends."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, weight = 0.5 * (1.0 + x), 0.5 * w
    return lo + (hi - lo) * t * t * (3.0 - 2.0 * t), (hi - lo) * 6.0 * t * (1.0 - t) * weight


def test_points_slip_from_when_they_touch():
    solution = followed(HERTZ, GROWING)[1]
    for x in (1.005, 1.05, 1.1, 1.14, -1.02, -1.13):
        share, weight = gauss((x * x - 1.0) / 0.3, 1.0)
        expected = float(weight @ slip_rate(x, share))
        assert solution.slip(x) == pytest.approx(expected, abs=1e-13)


def test_the_shift_is_the_mean_slip_under_a_flat_punch_on_the_contact_of_the_time():
    total = 0.0
    for share, weight in zip(*gauss(0.0, 1.0, 30), strict=True):
        a, r, centre = np.sqrt(1.0 + 0.3 * share), np.sqrt(1.0 - 0.4 * share), 0.05 * share
        for zone in (gauss(-a, centre - r), gauss(centre + r, a)):
            x, w = zone
            total += weight * float(w @ (slip_rate(x, share) / np.sqrt(a * a - x * x))) / np.pi
    assert followed(HERTZ, GROWING)[1].shift == pytest.approx(total, rel=1e-9)


@pytest.mark.parametrize("scene", [HERTZ, LOPSIDED], ids=["hertz", "lopsided"])
def test_the_loop_of_shear_over_shift_encloses_the_energy_while_the_normal_load_changes(scene):
    """∮Q dδ with dδ = dshift - 2/(π E*) ln r dQ, which the elastic compliance adds; by Simpson."""
    n = 41
    angle = np.linspace(0.0, np.pi, n)
    weight = np.where(np.arange(n) % 2, 4.0, 2.0) * 0.5 * np.sin(angle) * np.pi / (n - 1) / 3.0
    A, B = scaled([(1.2, 0.55, 0.0), (0.9, -0.3, 0.0)])
    corners, area = [A, B, A, B, A], 0.0
    for k in (2, 3):
        a, b = corners[k : k + 2]
        branch = [tuple(np.add(a, t * np.subtract(b, a))) for t in 0.5 * (1.0 - np.cos(angle))]
        states = sie.follow(scene, sie.Path([*corners[:k], *branch]))[k:]
        Q, shift, r = (
            np.array([getattr(s, name) for s in states])
            for name in ("tangential_load", "shift", "half_width")
        )
        elastic = -2.0 / np.pi * Q * np.log(r)
        area += Q[-1] * shift[-1] - Q[0] * shift[0]
        area += (b[1] - a[1]) * float(weight @ (elastic - shift))
    history = sie.follow(scene, sie.Path(corners))
    assert area == pytest.approx(history[4].energy_lost - history[2].energy_lost, rel=1e-5)


def test_the_slip_range_of_a_steady_cycle_holds_for_points_that_leave_the_contact():
    A, B = scaled([(1.2, 0.55, 0.0), (0.9, -0.3, 0.0)])
    steady = sie.steady_cycle(HERTZ, A, B)
    x = np.array([0.5, 0.9, 0.94, 0.95, 1.0, 1.05, 1.09, -0.95, -1.05])
    period = sie.follow(HERTZ, sie.Path([A, B, A, B, A]).subdivided(8))[16:]
    slip = np.array([solution.slip(x) for solution in period])
    assert steady.slip_range(x) == pytest.approx(slip.max(axis=0) - slip.min(axis=0), abs=1e-12)
    work = sie.Cycle(steady).friction_work(x)
    assert (work[1:] > 0.0).all() and steady.slip_range(1.2) == 0.0


def test_the_shift_while_a_front_passes_an_earlier_one_is_that_of_the_step_in_parts():
    shares = (0.0, 1.0, -1.0, 0.02, -0.25, 1.0)
    points = [(1.0 - 0.037 * t, 0.465 * t, -0.05 * t, 0.007 * t) for t in shares]
    whole, parts = followed(LOPSIDED, points), followed(LOPSIDED, points, 3)
    assert whole[-1].shift == pytest.approx(parts[-1].shift, rel=1e-10)


@pytest.mark.parametrize("moments", [(0.0, 0.02), (0.0, 0.0)], ids=["given", "none"])
def test_energy_and_shift_at_a_given_moment_are_those_of_the_tilts_that_carry_it(moments):
    """A path of so many straight parts in the tilt is off by their square: extrapolated."""
    points = scaled([(1, 0, 0), (1.2, 0.6, 0.05)])
    path = sie.Path(points, moment=moments)
    whole = sie.follow(replace(LOPSIDED, moment=0.0), path)
    found = []
    for n in (4, 8):
        parts = path.subdivided(n)
        tilts = [solution.tilt for solution in sie.follow(whole.scene, parts)]
        last = sie.follow(LOPSIDED, sie.Path(parts.points, tilt=tilts))[-1]
        found.append((last.energy_lost, last.shift))
    (coarse, fine), last = np.array(found), whole[-1]
    expected = (4.0 * fine - coarse) / 3.0
    assert (last.energy_lost, last.shift) == pytest.approx(tuple(expected), rel=1e-6)


def test_slip_is_the_same_with_the_path_in_parts():
    scene, points = LOPSIDED, [(1, 0, 0, 0), (1.2, 0.6, 0.1, 0.01)]
    whole, parts = (followed(scene, points, n)[-1] for n in (1, 4))
    x = np.linspace(*whole.edges, 41)
    assert parts.slip(x) == pytest.approx(whole.slip(x), abs=1e-13)
    assert parts.shift == pytest.approx(whole.shift, abs=1e-13)


# -- a mesh ---------------------------------------------------------------------------------------

GENERAL = {
    "falling": (HERTZ, FALLING),
    "opposite": (HERTZ, [(1, 0, 0), (0.8, 0.05, 0.5)]),
    "in phase": (HERTZ, IN_PHASE + IN_PHASE[1:]),
    "held up": (HERTZ, [(1, 0, 0), (1.3, 0.55, 0.2), (0.8, -0.3, -0.15), (1.3, 0.55, 0.2)]),
    "out of phase": (LOPSIDED, OUT_OF_PHASE),
    "tilt": (LOPSIDED, [(1, 0.5, 0.05, 0.02), (0.9, -0.3, 0, -0.03), (1, 0.4, 0.1, 0.02)]),
}


@pytest.mark.parametrize("case", GENERAL)
def test_a_history_agrees_with_a_mesh_to_its_error(case):
    """Mean error of q over f p0 on two meshes: half the element and increment, half the error."""
    scene, points = GENERAL[case]
    points = [(*point, 0.0)[:4] for point in points]
    history, errors = followed(scene, points), []
    for n, increments in ((100, 12), (200, 24)):
        mesh = Mesh((-1.4, 1.4), n, 1.0)
        found = on_a_mesh(mesh, scene.profile.height, f, scaled(points), increments)
        worst = 0.0
        for solution, state in zip(history, found, strict=True):
            worst = max(worst, float(np.abs(solution.shear(mesh.x) - state.shear).mean()))
        errors.append(worst / (0.5 * f))
    assert errors[1] < 0.75 * errors[0] < 3e-3


@pytest.mark.parametrize("case", ["falling", "opposite", "tilt"])
def test_the_energy_of_a_history_agrees_with_a_mesh_to_its_error(case):
    scene, points = GENERAL[case]
    points = [(*point, 0.0)[:4] for point in points]
    lost = followed(scene, points)[-1].energy_lost
    found = [
        on_a_mesh(Mesh((-1.4, 1.4), n, 1.0), scene.profile.height, f, scaled(points), steps)[-1]
        for n, steps in ((100, 12), (200, 24))
    ]
    errors = [abs(state.energy / lost - 1.0) for state in found]
    assert errors[1] < 0.75 * errors[0] < 1.5e-2


@pytest.mark.parametrize("case", ["growing", "reversed while it grows", "tilt"])
def test_the_slip_of_a_history_agrees_with_a_mesh_to_its_error(case):
    """Away from the edges of all turning points, where one element decides."""
    cases = {"growing": GROWING, "reversed while it grows": [(0.8, 0.55, 0), (1.3, -0.9, 0)]}
    scene, points = GENERAL[case] if case == "tilt" else (HERTZ, cases[case])
    points = [(*point, 0.0)[:4] for point in points]
    history, errors = followed(scene, points), []
    for n, increments in ((80, 10), (160, 40)):
        mesh = Mesh((-1.5, 1.5), n, 1.0)
        last = on_a_mesh(mesh, scene.profile.height, f, scaled(points), increments)[-1]
        away = [np.abs(mesh.x - edge) > 0.05 for state in history for edge in state.edges]
        x = mesh.x[np.all(away, axis=0)]
        exact, found = history[-1].slip(x), last.slip[np.all(away, axis=0)]
        errors.append(float(np.abs(found - exact).mean() / np.abs(exact).mean()))
    assert errors[1] < 0.75 * errors[0] and errors[1] < 0.03
