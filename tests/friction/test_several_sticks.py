"""Steps that leave several stick zones: their equations, against a mesh, and in parts."""

from functools import cache

import numpy as np
import pytest

import sie
from oracles.kalker import Mesh
from oracles.load_history import history as on_a_mesh

P0, f = np.pi / 4.0, 0.3
F, S = f * P0, 4.0 * f * P0 / np.pi
HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=P0, friction=f)
# Points are (Q/F, σ/S). The gap goes on slipping at the end of an earlier stick zone; it is in an
# earlier zone of slip.
PATHS = {
    "at the end of an earlier zone": [(0.06, -0.36), (-0.31, 0.08)],
    "in an earlier zone of slip": [(-0.1, 0.36), (0.32, -0.41), (0.5, -0.17)],
}


def followed(points):
    return history_of(sie.Path([(P0, Q * F, sigma * S) for Q, sigma in points]))


@cache
def history_of(path):
    """Tests share what they only read."""
    return sie.follow(HERTZ, path)


@pytest.fixture(scope="module", params=PATHS)
def path(request):
    return PATHS[request.param]


@pytest.fixture(scope="module")
def end(path):
    solution = followed(path)[-1]
    assert len(solution.stick) == 2
    return solution


@pytest.mark.slow
def test_two_stick_zones_satisfy_their_equations(end):
    certificate = end.check()
    assert certificate.ok
    assert certificate.shear.residual <= 1e-11
    assert certificate.shear.equilibrium <= 1e-12
    assert certificate.shear.excess <= 1e-11


def test_no_point_of_one_stick_zone_moves_from_those_of_the_other(end):
    (_, lo), (hi, _) = end.stick
    middle, last = end.tangential.slip_now(np.array([0.5 * (lo + hi), hi - 1e-12]))
    assert middle != 0.0 and abs(last) <= 1e-10 * abs(middle)


@pytest.mark.slow
def test_a_path_to_two_stick_zones_in_parts_ends_in_the_same_state():
    path = PATHS["at the end of an earlier zone"]
    end = followed(path)[-1]
    between = np.mean(path[-2:], axis=0)
    cut = followed([*path[:-1], between, path[-1]])[-1]
    x = np.linspace(-0.99, 0.99, 101)
    assert np.array(cut.stick) == pytest.approx(np.array(end.stick), abs=1e-11)
    assert cut.shear(x) == pytest.approx(end.shear(x), abs=1e-11)
    assert cut.energy_lost == pytest.approx(end.energy_lost, rel=1e-10)


def test_a_mesh_has_the_same_two_stick_zones_and_energy(path, end):
    mesh = Mesh((-1.0, 1.0), 160, 1.0)
    points = [(P0, Q * F, sigma * S, 0.0) for Q, sigma in path]
    found = on_a_mesh(mesh, HERTZ.profile.height, f, points, 16)[-1]
    sticks = np.abs(found.shear) < f * found.pressure * (1.0 - 1e-9)
    turns = mesh.x[:-1][np.diff(sticks.astype(int)) != 0] + 0.5 * mesh.h
    assert turns == pytest.approx(np.ravel(end.stick), abs=1.5 * mesh.h)
    assert end.energy_lost == pytest.approx(found.energy, rel=5e-3)


@pytest.mark.slow
def test_one_stick_zone_is_left_after_a_larger_return():
    history = followed([*PATHS["at the end of an earlier zone"], (-0.6, 0.6)])
    assert [len(solution.stick) for solution in history] == [1, 2, 1]
    assert history[-1].check().ok


@pytest.mark.slow
def test_a_gap_opens_inside_the_stick_zone_and_joins_the_slip_beside_it():
    """Q held while σ is reversed: the gap opens behind an earlier end and takes over the zone."""
    start, turned = (0.4, 0.25), (0.4, -0.25)
    numbers = []
    for share in (0.45, 0.459, 0.463):
        on_the_way = tuple(a + share * (b - a) for a, b in zip(start, turned))
        numbers.append(len(followed([(0.4, 0.0), start, on_the_way])[-1].stick))
    assert numbers == [1, 2, 1]


@pytest.mark.slow
@pytest.mark.parametrize("P", [P0, 1.2 * P0], ids=("constant P", "P grows"))
def test_bulk_stress_that_leaves_no_stick_zone_on_the_grid_is_refused(P):
    path = sie.Path([(P0, 0.0, 0.0), (P, 0.5 * F, 30.0 * S)])
    with pytest.raises(sie.ContactError, match=r"^step 1 of the path"):
        sie.follow(HERTZ, path)


@pytest.mark.slow
def test_energy_is_refused_where_slip_turned_beside_several_stick_zones_and_the_state_is_not():
    turned = followed([(0.0, 0.0), (-0.72, 0.07), (-0.56, 0.79), (0.08, 0.08)])[-1]
    assert turned.check().ok
    with pytest.raises(sie.ContactError, match="turns on the way"):
        _ = turned.energy_lost
