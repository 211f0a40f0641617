"""Load paths: Masing's memory, P and Q together, the cost of a cycle, and a mesh solver.

The mesh solver does not use superposition.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from path_cases import FP, HERTZ, LOPSIDED, PUNCH, E, F, P, at_constant_load, fields

import sie
from sie.friction.memory import LoadMemory

# -- constant P ------------------------------------------------------------------------------------


def test_a_path_of_one_point_is_the_scene():
    followed = at_constant_load(PUNCH, 0.8)[0]
    scene = sie.solve(followed.scene)
    x = np.linspace(-1.0, 1.0, 21)
    assert followed.stick == scene.stick
    assert (followed.shear(x) == scene.shear(x)).all()
    assert (followed.slip(x) == scene.slip(x)).all()
    assert followed.energy_lost == scene.energy_lost


@pytest.mark.parametrize("scene", [PUNCH, HERTZ, LOPSIDED], ids=["punch", "hertz", "lopsided"])
def test_unloading_is_half_of_the_first_loading_twice(scene):
    """From Q_max to Q: q = q(Q_max) - 2 q((Q_max - Q)/2), Mindlin & Deresiewicz 1953; slip
    likewise.
    """
    unloaded = at_constant_load(scene, 0.75, 0.25)[1]
    first, half = (
        sie.solve(sie.Scene(**fields(scene), tangential_load=k * FP)) for k in (0.75, 0.25)
    )
    x = np.linspace(*first.edges, 31)
    assert unloaded.stick == half.stick
    assert unloaded.shear(x) == pytest.approx(first.shear(x) - 2.0 * half.shear(x), abs=1e-15)
    assert unloaded.slip(x) == pytest.approx(first.slip(x) - 2.0 * half.slip(x), abs=1e-16)
    assert unloaded.energy_lost == pytest.approx(
        first.energy_lost + 2.0 * half.energy_lost, rel=1e-13
    )
    assert unloaded.check().ok


def test_a_closed_loop_closes_after_the_first_cycle_and_leaves_no_memory():
    first, _, small, back, again, down = at_constant_load(PUNCH, 0.8, -0.8, 0.4, -0.2, 0.8, -0.8)
    x = np.linspace(-1.0, 1.0, 41)
    assert again.stick == first.stick
    assert again.shear(x) == pytest.approx(first.shear(x), abs=1e-15)
    assert again.slip(x) == pytest.approx(first.slip(x), abs=1e-16)
    assert down.shear(x) == pytest.approx(-first.shear(x), abs=1e-15)
    assert first.stick[0][1] < small.stick[0][1] < back.stick[0][1]
    assert len(again.history.turning_points[4].memory.layers) == 1


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=12))
@example([-2.225073858507e-311, 0.87, -0.999])
def test_the_layers_carry_the_load_within_their_limits(targets):
    memory = LoadMemory()
    for target in targets:
        before, pull = memory, target - memory.total
        memory, done = memory.changed(abs(pull), np.sign(pull)) if pull else (memory, ())
        assert memory.total == pytest.approx(target, abs=1e-14)
        assert all(thickness > 0.0 and abs(k) <= 1.0 for thickness, k in memory.layers)
        assert sum(thickness for thickness, _ in memory.layers) <= 1.0 + 1e-15
        pulled = sum(o.jump * (o.lower - o.upper) for o in done)
        assert pulled == pytest.approx(abs(target - before.total), abs=1e-14)


def test_a_thousand_steps_cost_less_than_a_thousand_solves():
    """In evaluations of the edge integrals, which are most of a solve that has no closed form."""
    Q = 0.8 * np.sin(np.linspace(0.0, 2.0 * np.pi, 1001))[1:]
    punch = replace(PUNCH, profile=PUNCH.profile + sie.Parabola(10.0))
    history = at_constant_load(punch, *Q)
    zones = [solution.stick for solution in history]
    spent = sum(
        state.found.edges.evaluations
        for state in history._first_loadings.values()
        if hasattr(state, "found")
    )
    assert len(zones) == 1000 and len(history._plain) == 1
    assert spent < 0.6 * 1000 * sie.solve(punch).normal.edges.evaluations
    assert "pressure" in vars(history.plain(P))
    assert not any("corrective" in vars(state) for state in history._first_loadings.values())


def test_the_energy_of_a_path_takes_one_first_loading_for_each_depth():
    k = np.arange(50)
    history = at_constant_load(PUNCH, *(0.95 * (1.0 - k / 50) * (-1.0) ** k), 0.5, -0.5, 0.5)
    assert history.energy(52) > history.energy(51) > history.energy(50) > 0.0
    assert len(history._first_loadings) <= 53


def test_the_shear_of_many_turning_points_takes_the_pressure_of_the_contact_once():
    """Each corner is the difference of the same pressure and that of a smaller contact."""
    k = np.arange(100)
    history = at_constant_load(PUNCH, *(0.95 * (1.0 - k / 100) * (-1.0) ** k))
    shear, pressure = history[-1].shear, history.plain(P).slope_density
    corners = {id(part) for _, part in shear.bases}
    assert sum(part is pressure for _, part in shear.terms) == 1
    assert len(corners) <= len(history.turning_points[-1].memory.layers) + 1
    x = np.linspace(*history[-1].edges, 41)
    one_by_one = sum(weight * loading.shear(x) for weight, loading in history[-1].tangential._terms)
    assert shear(x) == pytest.approx(one_by_one, abs=1e-14)


def test_no_point_of_a_path_is_solved_before_it_is_read():
    history = at_constant_load(PUNCH, 0.5, -0.5, 0.2)
    assert len(history) == 3
    assert not history._plain
    _ = history[1].stick
    assert len(history._first_loadings) == 1


# -- refusals --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([(P, 0.1), (P, 0.3)], r"step 1 .*exceeds f P"),
    ],
)
def test_a_step_that_is_not_covered_is_named_before_work(points, said):
    with pytest.raises(sie.ContactError, match=said) as caught:
        sie.follow(PUNCH, sie.Path(points))
    assert "step" in caught.value.reached


def test_a_normal_load_that_grows_at_a_given_moment_locks_the_shear_in():
    """The contact rolls towards the origin as it grows, and contains the one before."""
    tilted = sie.Scene(profile=sie.Parabola(1.0), modulus=E, normal_load=P, friction=F, moment=0.01)
    first, second = sie.follow(tilted, sie.Path([(P, 0.05), (2 * P, 0.05)]))
    x = np.linspace(*second.edges, 21)
    assert second.stick == (second.edges,) and second.tilt != first.tilt
    assert second.shear(x) == pytest.approx(first.shear(x), abs=1e-13)
    assert second.energy_lost == first.energy_lost


RETREAT = (P, 0.6 * FP, 0.5)


@pytest.mark.slow
def test_zones_that_retreat_on_the_way_to_the_first_point_are_followed():
    """As from (P, 0, 0), and on from there; a scene has the state in total displacements."""
    first, then = sie.follow(HERTZ, sie.Path([RETREAT, (P, 0.0, 0.0)]))
    later = sie.follow(HERTZ, sie.Path([(P, 0.0, 0.0), RETREAT]))[1]
    scene = sie.solve(replace(HERTZ, tangential_load=RETREAT[1], bulk_stress=RETREAT[2]))
    x = np.linspace(*first.edges, 21)
    assert (first.shear(x) == later.shear(x)).all() and (first.slip(x) == later.slip(x)).all()
    assert first.energy_lost == later.energy_lost and first.slip_notes == ()
    assert first.check().ok and then.check().ok
    assert first.stick != scene.stick and "retreat" in scene.notes[-1]


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([], "no points"),
        (None, "points = None is not a list"),
        ([(0.0, 0.0), (0.0, 0.0)], "nothing ever touches"),
        ([(1.0,)], r"\(1\.0,\).*give \(P, Q\)"),
        ([(1.0, np.nan)], "Q of point 0 is nan"),
        ([(1.0, 0.0), (0.0, 0.0)], "P of point 1 = 0"),
        ([(-1.0, 0.0)], "P of point 0 = -1"),
        ([3.0], r"3\.0.*give \(P, Q\)"),
    ],
)
def test_an_invalid_path_is_refused(points, said):
    with pytest.raises(ValueError, match=said):
        sie.Path(points)


def test_a_path_without_friction_carries_no_tangential_load():
    plain = sie.Scene(profile=sie.Parabola(1.0), modulus=E, normal_load=P)
    with pytest.raises(ValueError, match=r"0\.1 without friction"):
        sie.follow(plain, sie.Path([(P, 0.1)]))
    assert sie.follow(plain, sie.Path([(P, 0.0), (2 * P, 0.0)]))[1].shear is sie.ZERO


def test_an_unloaded_beginning_has_no_solution():
    history = sie.follow(HERTZ, sie.Path([(0.0, 0.0), (P, 0.0)]))
    with pytest.raises(sie.LoadError, match="nothing touches"):
        _ = history[0].edges
    assert history[-1].edges == sie.solve(HERTZ).edges


def test_a_point_of_a_path_is_not_changed_into_another():
    with pytest.raises(ValueError, match="path"):
        at_constant_load(HERTZ, 0.5)[0].with_(tangential_load=0.1)
