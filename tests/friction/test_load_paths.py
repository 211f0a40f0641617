"""Load paths: what a cycle costs, moments, zones that retreat, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from path_cases import FP, HERTZ, PUNCH, E, F, P, at_constant_load

import sie


def test_a_thousand_steps_solve_the_edges_of_stick_zones_and_no_pressure():
    Q = 0.8 * np.sin(np.linspace(0.0, 2.0 * np.pi, 1001))[1:]
    punch = replace(PUNCH, profile=PUNCH.profile + sie.Parabola(10.0))
    history = at_constant_load(punch, *Q)
    assert not history._plain and not history._first_loadings
    zones = [solution.stick for solution in history]
    assert len(zones) == 1000 and len(history._plain) == 1
    states = [state for state in history._first_loadings.values() if state.stick]
    assert len(states) <= 1000
    assert not any("pressure" in vars(state.reduced) for state in states)


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
