"""Paths followed part by part: loads in phase, a mesh beside them, and what is said about them."""

import numpy as np
import pytest
from history_cases import HERTZ, LOPSIDED, P0, F, S, f
from marched_cases import (
    ALL,
    TOGETHER,
    TURNED,
    followed,
    inside,
    path_of,
)

import sie
from oracles.kalker import Mesh
from oracles.load_history import history as on_a_mesh

OPPOSITE = [(1, 0, 0), (0.8, 0.05, 0.5)]

# -- loads in phase --------------------------------------------------------------------------------


IN_PHASE = [(1, 0, 0), (0.73, 0.28, -0.112), (1, 0, 0), (0.73, 0.28, -0.112)]


@pytest.mark.slow
def test_loads_that_return_in_phase_bring_back_the_shear_that_they_left():
    """An edge that grew and stuck slips as it retreats, until it is where it was."""
    first, grown, again = followed(HERTZ, IN_PHASE)[1:]
    x = inside(first)
    assert grown.history.turning_points[2].parts and grown.history.turning_points[3].parts
    assert again.shear(x) == pytest.approx(first.shear(x), abs=1e-9 * f)


def test_a_mesh_tends_to_the_shear_of_loads_in_phase():
    """Twice the elements and increments, half the error."""
    states, errors = followed(HERTZ, IN_PHASE), []
    given = [(P * P0, Q * F, sigma * S, 0.0) for P, Q, sigma in IN_PHASE]
    for n in (60, 120):
        mesh = Mesh((-1.2, 1.2), n, 1.0)
        found = on_a_mesh(mesh, HERTZ.profile.height, f, given, n // 6)
        pairs = zip(states[1:], found[1:], strict=True)
        errors.append(max(np.abs(a.shear(mesh.x) - b.shear).mean() for a, b in pairs))
    assert errors[1] < 0.7 * errors[0] < 0.7 * 0.02 * f


RETURNS = [(1, 0, 0), (1.15, 0.135, 0.08), (1.015, 0.0135, 0.008), (1.15, 0.135, 0.08)]


@pytest.mark.slow
def test_a_return_on_which_zones_of_slip_join_at_its_end_is_refused_but_answered_up_to_there():
    with pytest.raises(sie.ContactError, match=r"step 3 .* 100 % of the step only") as told:
        followed(HERTZ, RETURNS)
    share, (start, end) = told.value.reached["share"], np.array(RETURNS[-2:])
    before = tuple(start + 0.999 * share * (end - start))
    assert share > 0.9999 and followed(HERTZ, [*RETURNS[:-1], before])[-1].check().ok


CAUGHT_UP = [(1, 0, 0), (1.34, -0.34, 0.16), (0.66, 0.34, -0.16)]


@pytest.fixture(scope="module")
def caught_up():
    """The end of the stick zone recedes on the left, and the edge of contact faster."""
    return followed(HERTZ, CAUGHT_UP)[-1]


@pytest.mark.slow
def test_slip_turns_where_an_edge_of_contact_catches_up_with_its_zone(caught_up):
    before, after = (point.tangential.slipped for point in caught_up.history[1:])
    assert [s for *_, s in before] == [-1.0] and [s for *_, s in after] == [1.0, 1.0]
    assert caught_up.check().ok


@pytest.mark.slow
def test_a_mesh_tends_to_the_energy_where_an_edge_catches_up_with_a_slip_zone(caught_up):
    """Twice the elements and increments, less than half the error."""
    errors = []
    given = [(P * P0, Q * F, sigma * S, 0.0) for P, Q, sigma in CAUGHT_UP]
    for n in (60, 120):
        mesh = Mesh((-1.3, 1.3), n, 1.0)
        found = on_a_mesh(mesh, HERTZ.profile.height, f, given, n // 6)[-1]
        assert np.abs(caught_up.shear(mesh.x) - found.shear).mean() < 1e-3 * f
        errors.append(abs(found.energy - caught_up.energy_lost))
    assert errors[1] < 0.5 * errors[0] < 0.5 * 0.05 * caught_up.energy_lost


@pytest.mark.slow
def test_loads_that_return_to_where_slip_ended_are_balanced_to_rounding():
    profile = sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6))
    scene = sie.Scene(profile=profile, modulus=2.0, normal_load=0.375, friction=0.5, tilt=0.02)
    most, least = (0.3491272, -0.0438307, -0.1277112), (0.3724127, -0.00438307, -0.01277112)
    path = sie.Path([(0.375, 0, 0), most, least, most])
    certificate = sie.follow(scene, path)[-1].check()
    assert certificate.ok and certificate.shear.equilibrium < 1e-11


# -- a mesh ----------------------------------------------------------------------------------------


@pytest.mark.slow(but=7)
@pytest.mark.parametrize("points", [*ALL, TOGETHER])
def test_a_mesh_comes_near_the_marched_shear_and_energy(points):
    """To the first order of its elements and increments."""
    states, mesh = followed(LOPSIDED, points), Mesh((-1.25, 1.25), 80, 1.0)
    loads = [(*point, 0.0)[:4] for point in points]
    given = [(P * P0, Q * F, sigma * S, tilt) for P, Q, sigma, tilt in loads]
    found = on_a_mesh(mesh, LOPSIDED.profile.height, f, given, 16)
    for state, true in zip(states, found, strict=True):
        assert np.abs(state.shear(mesh.x) - true.shear).mean() <= 0.006 * 0.5 * f
    assert states[-1].energy_lost == pytest.approx(found[-1].energy, rel=0.02)


def test_a_mesh_tends_to_the_slip_of_new_points_and_the_shift():
    """Twice the elements and increments, about half the error."""
    state, given = followed(HERTZ, OPPOSITE)[-1], [(*at, 0.0) for at in path_of(OPPOSITE).points]
    errors = []
    for n in (60, 120):
        mesh = Mesh((-1.3, 1.3), n, 1.0)
        found = on_a_mesh(mesh, HERTZ.profile.height, f, given, n // 10)[-1]
        touching = found.pressure > 0.0
        slip = state.slip(mesh.x[touching])
        off = np.abs(slip - found.slip[touching]).mean() / np.abs(slip).max()
        errors.append((off, abs(found.shift / state.shift - 1.0)))
    (slip, shift), (finer_slip, finer_shift) = errors
    assert finer_slip < 0.7 * slip < 0.7 * 0.02
    assert finer_shift < 0.7 * shift < 0.7 * 0.05


# -- what is told ----------------------------------------------------------------------------------


def test_certificate_and_plan_say_which_steps_are_followed_part_by_part():
    history = followed(HERTZ, TURNED[:2])
    layers, parts = str(history.plan).splitlines()[:2]
    assert "layers" in layers and "part by part: Q and bulk stress change in" in parts
    assert "followed part by part, as Q and bulk stress change in" in str(history[1].check())
