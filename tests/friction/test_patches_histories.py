"""Friction on several patches and per period: one step, paths, cycles, energy.

The mesh solver does not use superposition.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sie
from oracles.kalker_patches import PatchMesh
from sie.numerics.zones import left_over

F = 0.5
TWO = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
WAVY = sie.FromFunction("x - 0.6*sin(12*x + 0.7)", domain=(-2.0, 2.0))
WAVES = sie.Periodic(
    sie.FromFunction("0.8*sin(x) + 1.05*sin(3*x + 0.5) + 0.84*sin(7*x + 1.1)"), 2.0 * np.pi
)
FLATS = sie.Row([sie.Flat(0.4).shifted(-0.6), sie.Flat(0.55).shifted(0.85)])
SCENES = {
    "row": sie.Scene(modulus=1.0, profile=TWO, normal_load=0.4, friction=F),
    "row under a moment": sie.Scene(
        modulus=1.0, profile=TWO, normal_load=0.4, moment=0.05, friction=F
    ),
    "wavy punch": sie.Scene(modulus=1.0, profile=WAVY, normal_load=0.228, friction=F),
    "merged patches": sie.Scene(modulus=1.0, profile=WAVY, normal_load=0.7, friction=F),
    "flats": sie.Scene(modulus=1.0, profile=FLATS, normal_load=0.6, friction=F),
    "period": sie.Scene(modulus=1.0, profile=WAVES, normal_load=3.0, friction=F),
    "full contact": sie.Scene(modulus=1.0, profile=WAVES, normal_load=60.0, friction=F),
}
each = pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())


def at_constant_load(scene, *fractions):
    P = scene.normal_load
    return sie.follow(scene, sie.Path([(P, k * F * P) for k in fractions]))


def places(solution):
    return np.concatenate([np.linspace(a, b, 23)[1:-1] for a, b in solution.patches])


@each
def test_a_path_of_one_point_is_the_scene(scene):
    followed = at_constant_load(scene, 0.8)[0]
    alone = sie.solve(followed.scene)
    x = places(alone)
    assert followed.stick == alone.stick
    assert (followed.shear(x) == alone.shear(x)).all()
    assert (followed.slip(x) == alone.slip(x)).all()


@each
def test_unloading_is_half_of_the_first_loading_twice(scene):
    """q = q(Q_max) - 2 q((Q_max - Q)/2), Mindlin & Deresiewicz 1953, and so is the slip."""
    loaded, unloaded = at_constant_load(scene, 0.9, 0.1)
    half = at_constant_load(scene, 0.4)[0]
    x = places(loaded)
    error = 1e-13 * loaded.pressure(x).max()
    assert unloaded.shear(x) == pytest.approx(loaded.shear(x) - 2.0 * half.shear(x), abs=error)
    assert unloaded.slip(x) == pytest.approx(loaded.slip(x) - 2.0 * half.slip(x), abs=1e-13)
    assert np.array(unloaded.stick) == pytest.approx(np.array(half.stick), abs=1e-13)


@each
def test_a_closed_loop_closes(scene):
    history = at_constant_load(scene, 0.8, -0.3, 0.5, -0.3, 0.8)
    first, last, x = history[0], history[4], places(history[0])
    assert np.array(last.stick) == pytest.approx(np.array(first.stick), abs=1e-13)
    assert last.shear(x) == pytest.approx(first.shear(x), abs=1e-13 * first.pressure(x).max())


@each
@pytest.mark.parametrize("part", [0.05, 0.7, 0.995])
def test_friction_obeys_its_laws_on_every_patch(scene, part):
    solution = at_constant_load(scene, part)[0]
    x, Q = places(solution), part * F * scene.normal_load
    p, q = solution.pressure(x), solution.shear(x)
    stuck = solution.slip(x) == 0.0
    assert left_over(solution.stick, solution.patches, scene.profile.period) == ()
    assert solution.shear.resultant == pytest.approx(Q, rel=1e-12)
    assert (solution.slip(x) >= 0.0).all()
    assert q[~stuck] == pytest.approx(F * p[~stuck], rel=1e-12)
    assert (q[stuck] <= F * p[stuck] * (1.0 + 1e-12)).all()


def test_patches_that_have_merged_stick_in_several_zones():
    solution = at_constant_load(SCENES["merged patches"], 0.95)[0]
    assert len(solution.patches) < len(solution.stick)


@settings(max_examples=6)
@given(st.sampled_from(["row", "wavy punch", "merged patches", "period"]), st.integers(0, 999))
def test_histories_agree_with_a_mesh_to_its_error(name, seed):
    """First order: a third of the element, less than half of the error of q."""
    scene = SCENES[name]
    turns = np.random.default_rng(seed).uniform(0.2, 0.9, 3) * [1.0, -0.8, 0.6]
    history = at_constant_load(scene, *turns)
    errors = []
    for n in (150, 450):
        mesh = PatchMesh(history[0].patches, n, 1.0, scene.profile.period)
        bound, q = F * history[0].pressure(mesh.x), np.zeros(len(mesh.x))
        slip, worst = np.zeros(len(mesh.x)), []
        for part, solution in zip(turns, history, strict=True):
            q, moved = mesh.step(q, bound, part * F * scene.normal_load, 0.0)
            slip += moved
            largest = np.abs(solution.slip(mesh.x)).max()
            worst.append(np.abs(q - solution.shear(mesh.x)).mean() / bound.max())
            worst.append(np.abs(slip - solution.slip(mesh.x)).max() / largest)
        errors.append(worst)
    coarse, fine = np.array(errors)
    assert fine[::2].max() < 5e-3 and fine[1::2].max() < 5e-2
    assert fine[::2].sum() < 0.5 * coarse[::2].sum()
