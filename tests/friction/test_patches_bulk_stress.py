"""Bulk stress and tilt that change with P and Q; a row of one is solved as patches are."""

import numpy as np
import pytest

import sie
from oracles.kalker_patches import PatchMesh
from oracles.load_history import history as on_a_mesh

ONE = sie.Parabola(1.0)
TWO = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
EVEN = sie.Row([sie.Parabola(1.0), sie.Parabola(1.0).shifted(4.0)])
F = 0.3
WAVES = sie.Periodic(sie.FromFunction("0.8*sin(x)"), 2.0 * np.pi)


def scene(profile, load=1.0):
    return sie.Scene(profile=profile, modulus=1.0, normal_load=load, friction=F)


def followed(profile, points, tilt=()):
    return sie.follow(scene(profile), sie.Path(points, tilt=tilt))


def both(answer):
    return answer(ONE), answer(sie.Row([ONE]))


@pytest.mark.slow(but=2)
@pytest.mark.parametrize(
    ("points", "tilt"),
    [
        ([(1.0, 0.0, 0.0), (1.3, 0.25, 0.02)], ()),
        ([(1.0, 0.2, 0.05), (0.8, 0.1, 0.02), (0.8, 0.2, 0.02)], ()),
        ([(1.0, 0.0, 0.0), (1.2, 0.2, 0.03), (0.9, -0.15, -0.02), (1.2, 0.2, 0.03)], ()),
        ([(1.0, 0.0), (1.3, 0.2), (0.9, -0.1)], (0.0, 0.02, -0.01)),
        ([(1.0, 0.1), (1.0, 0.0)], (0.0, 0.01)),
    ],
    ids=["growing", "bulk stress kept", "to and fro", "tilt", "tilt at constant load"],
)
def test_a_row_of_one_has_the_stick_zone_and_the_shear_of_its_profile(points, tilt):
    one, row = both(lambda profile: followed(profile, points, tilt)[-1])
    x = np.linspace(*one.edges, 21)[1:-1]
    assert np.array(row.stick) == pytest.approx(np.array(one.stick), abs=1e-12)
    assert row.shear(x) == pytest.approx(one.shear(x), abs=1e-12)
    assert row.slip(x) == pytest.approx(one.slip(x), abs=1e-12)
    assert row.energy_lost == pytest.approx(one.energy_lost, rel=1e-9, abs=1e-15)


@pytest.mark.parametrize(
    ("A", "B"),
    [
        ((1.0, 0.1, 0.01), (1.0, -0.1, -0.01)),
        ((1.2, 0.2, 0.03), (0.9, -0.15, -0.02)),
        ((1.0, 0.2, 0.05, 0.01), (1.1, -0.1, -0.05, -0.01)),
    ],
    ids=["constant load", "in phase", "tilt"],
)
def test_a_steady_cycle_of_a_row_of_one_is_that_of_its_profile(A, B):
    one, row = both(lambda profile: sie.steady_cycle(scene(profile), A, B))
    x = np.linspace(-0.75, 0.75, 9)
    assert np.array(row.stick) == pytest.approx(np.array(one.stick), abs=1e-12)
    assert row.shear_range(x) == pytest.approx(one.shear_range(x), abs=1e-12)
    assert row.slip_range(x) == pytest.approx(one.slip_range(x), abs=1e-12)


ON_A_MESH = {
    "bulk stress": (TWO, [(1.0, 0.2, 0.02, 0.0), (0.9, 0.02, -0.01, 0.0)]),
    "tilt": (TWO, [(1.0, 0.03, 0.0, 0.0), (1.25, 0.15, 0.0, 0.02)]),
    "P and Q": (TWO, [(0.2, 0.02, 0.0, 0.0), (0.4, 0.1, 0.0, 0.0), (0.32, -0.01, 0.0, 0.0)]),
    "period": (sie.Periodic(TWO, 6.0), [(1.0, 0.2, 0.0, 0.0), (1.0, -0.1, 0.0, 0.0)]),
}


@pytest.mark.slow
@pytest.mark.parametrize(("profile", "points"), ON_A_MESH.values(), ids=ON_A_MESH)
def test_patches_agree_with_a_mesh_that_knows_no_superposition(profile, points):
    """Of the first order in the elements: half of them leaves at least 1.6 times the error."""
    tilt = tuple(turn for *_, turn in points)
    history = followed(profile, [tuple(at[:3]) for at in points], tilt if any(tilt) else ())
    last, widest = history[-1], max(history, key=lambda state: state.contact_length).patches
    errors = []
    for n, increments in ((120, 6), (240, 12)):
        mesh = PatchMesh(tuple((a - 0.03, b + 0.03) for a, b in widest), n, 1.0, profile.period)
        found = on_a_mesh(mesh, profile.height, F, points, increments)[-1]
        peak = F * found.pressure.max()
        errors.append(np.abs(found.shear - last.shear(mesh.x)).mean() / peak)
    assert found.energy == pytest.approx(last.energy_lost, rel=1e-2)
    assert errors[1] < 2e-3 and errors[1] < errors[0] / 1.6


@pytest.mark.slow
@pytest.mark.parametrize(
    ("profile", "A", "B"),
    [(EVEN, (1.0, 0.1, 0.01), (1.0, -0.1, -0.01)), (TWO, (0.4, 0.06, 0.0), (0.34, -0.036, 0.0))],
    ids=["bulk stress", "P and Q"],
)
def test_a_steady_cycle_of_two_patches_is_that_of_the_path_that_settles(profile, A, B):
    steady, path = sie.steady_cycle(scene(profile), A, B), followed(profile, [A, B, A, B, A])
    x = np.concatenate([np.linspace(*patch, 12)[1:-1] for patch in path[3].patches])
    change, slip = (
        np.abs(f(4) - f(3)) for f in (lambda k: path[k].shear(x), lambda k: path[k].slip(x))
    )
    assert steady.energy == pytest.approx(path[4].energy_lost - path[2].energy_lost, rel=1e-9)
    assert steady.shear_range(x) == pytest.approx(change, abs=1e-12)
    assert steady.slip_range(x) == pytest.approx(slip, abs=1e-12)
    held = np.array([0.5 * (lo + hi) for lo, hi in steady.stick])
    assert (steady.slip_range(held) == 0.0).all()


def test_the_shear_that_comes_and_goes_without_slip_is_that_of_flats_superposed():
    """On a parabola dP = π G r dr and dq = (dQ/π - x dτ)/w leave (k - π G x dτ/dP) w."""
    (P, Q, sigma), (P0, Q0, sigma0) = A, B = (1.5, 0.1, 0.0), (0.5, 0.0, 0.1)
    cycle, x, G = sie.steady_cycle(scene(ONE), A, B), np.linspace(-1.3, 1.3, 9), 0.5
    w, w0 = (np.sqrt(np.maximum(2.0 * load / (np.pi * G) - x * x, 0.0)) for load in (P, P0))
    k, tau = (Q - Q0) / (P - P0), 0.25 * (sigma - sigma0) / (P - P0)
    assert cycle.shear_change(x) == pytest.approx(G * (k - np.pi * tau * x) * (w - w0), abs=1e-14)
    assert cycle.energy == 0.0


@pytest.mark.parametrize(
    ("profile", "Q", "words"),
    [
        (WAVES, -0.1, "meet every 6.28319, .* no periodic answer"),
        (EVEN, 0.1, "the cycle on the way to B"),
    ],
)
def test_a_cycle_that_is_not_solved_on_several_patches_is_refused(profile, Q, words):
    with pytest.raises(sie.ContactError, match=words):
        sie.steady_cycle(scene(profile), (1.0, 0.1, 0.1), (1.0, Q, -0.1))


def test_a_normal_load_that_grows_with_the_bulk_stress_slips_to_either_side_on_two_patches():
    last = followed(EVEN, [(1.0, 0.0, 0.0), (1.1, 0.0, 0.2)])[-1]
    assert len(last.stick) == 2 and last.check().ok
    assert {s for *_, s in last.tangential.slipped} == {-1.0, 1.0}


@pytest.mark.slow
def test_energy_is_refused_where_a_patch_slides_as_a_whole_while_all_loads_change():
    path = sie.Path([(0.4, 0.0, 0.0), (0.41, 0.1225, 0.0005)])
    last = sie.follow(scene(TWO, 0.4), path)[-1]
    assert len(last.stick) == 1
    with pytest.raises(sie.ContactError, match=r"slide as a whole, .* the energy lost"):
        _ = last.energy_lost


def test_patches_that_have_merged_between_dissimilar_bodies_are_refused_as_such():
    profile = sie.Polynomial([0.0, 0.0, -0.01, 0.0, 0.01])
    pair = {"body": sie.Elastic(70e3, 0.3), "indenter": sie.Elastic(200e3, 0.3)}
    asked = sie.Scene(profile=profile, normal_load=5000.0, friction=F, **pair)
    with pytest.raises(sie.ContactError, match=r"in one patch, merged from several: .* convex"):
        _ = sie.solve(asked).edges
