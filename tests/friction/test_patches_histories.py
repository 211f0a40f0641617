"""Friction on several patches and per period: one step, paths, cycles, energy.

The mesh solver does not use superposition.
"""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sie
from oracles.kalker_patches import PatchMesh
from sie.io.report import summary
from sie.io.scene_file import SceneFile
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


@cache
def pressed(scene):
    """The scene without shear; what is changed of Q shares its pressure."""
    solution = sie.solve(scene)
    _ = solution.normal
    return solution


def sheared(scene, fraction):
    return pressed(scene).with_(tangential_load=fraction * F * scene.normal_load)


def places(solution):
    return np.concatenate([np.linspace(a, b, 23)[1:-1] for a, b in solution.patches])


@pytest.mark.slow(but=2)
@each
def test_a_path_of_one_point_is_the_scene(scene):
    followed = at_constant_load(scene, 0.8)[0]
    alone = sheared(scene, 0.8)
    x = places(alone)
    assert followed.stick == alone.stick
    assert (followed.shear(x) == alone.shear(x)).all()
    assert (followed.slip(x) == alone.slip(x)).all()


@pytest.mark.parametrize("name", ["row", "period"])
def test_a_path_is_certified_also_where_nothing_is_sheared_yet(name):
    assert at_constant_load(SCENES[name], 0.0, 0.5)[0].check().ok


@pytest.mark.slow(but=2)
@each
def test_unloading_is_half_of_the_first_loading_twice(scene):
    """q = q(Q_max) - 2 q((Q_max - Q)/2), Mindlin & Deresiewicz 1953, and so is the slip."""
    loaded, unloaded = at_constant_load(scene, 0.9, 0.1)
    half = sheared(scene, 0.4)
    x = places(loaded)
    error = 1e-13 * loaded.pressure(x).max()
    assert unloaded.shear(x) == pytest.approx(loaded.shear(x) - 2.0 * half.shear(x), abs=error)
    assert unloaded.slip(x) == pytest.approx(loaded.slip(x) - 2.0 * half.slip(x), abs=1e-13)
    assert np.array(unloaded.stick) == pytest.approx(np.array(half.stick), abs=1e-13)


@pytest.mark.slow(but=3)
@each
def test_a_closed_loop_closes(scene):
    history = at_constant_load(scene, 0.8, -0.3, 0.5, -0.3, 0.8)
    first, last, x = history[0], history[4], places(history[0])
    assert np.array(last.stick) == pytest.approx(np.array(first.stick), abs=1e-13)
    assert last.shear(x) == pytest.approx(first.shear(x), abs=1e-13 * first.pressure(x).max())


@pytest.mark.slow(but=6)
@each
@pytest.mark.parametrize("part", [0.05, 0.7, 0.995])
def test_friction_obeys_its_laws_on_every_patch(scene, part):
    solution = sheared(scene, part)
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


@pytest.mark.slow
@settings(max_examples=4)
@given(st.sampled_from(["row", "wavy punch", "merged patches", "period"]), st.integers(0, 999))
def test_histories_agree_with_a_mesh_to_its_error(name, seed):
    """First order: a third of the element, less than half of the error of q.

    The error depends on where in an element a zone ends: three meshes of each size are averaged.
    """
    scene = SCENES[name]
    turns = np.random.default_rng(seed).uniform(0.2, 0.9, 3) * [1.0, -0.8, 0.6]
    history = at_constant_load(scene, *turns)
    errors = []
    for n in (130, 150, 170, 390, 450, 510):
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
    coarse, fine = np.array(errors).reshape(2, 3, -1).mean(axis=1)
    assert fine[::2].max() < 5e-3 and fine[1::2].max() < 5e-2
    assert fine[::2].sum() < 0.5 * coarse[::2].sum()


# -- energy ----------------------------------------------------------------------------------------


def oblique(P):
    """Loads that rise and fall together, with slip and without."""
    Q = F * P
    points = [
        (P, 0.6 * Q),
        (0.8 * P, 0.5 * Q),
        (0.9 * P, -0.3 * Q),
        (P, 0.8 * Q),
        (0.9 * P, 0.85 * Q),
    ]
    return sie.Path(points)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["row"])
def test_energy_of_a_path_is_that_of_the_path_cut_into_parts(name):
    scene = SCENES[name]
    path = oblique(scene.normal_load)
    lost = [point.energy_lost for point in sie.follow(scene, path)]
    parts = sie.follow(scene, path.subdivided(2))
    assert [point.energy_lost for point in parts][::2] == pytest.approx(lost, rel=1e-8)


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (SCENES["full contact"], "full contact is not followed"),
        (
            sie.Scene(modulus=1.0, profile=sie.Flat(1.0), normal_load=0.4, friction=F),
            r"sharp edges .* round its corners \(sie.RoundedFlat\)",
        ),
    ],
    ids=["full contact", "sharp edges"],
)
def test_contacts_that_layers_alone_answer_are_refused_where_the_normal_load_changes(scene, said):
    P = scene.normal_load
    with pytest.raises(sie.ContactError, match=said):
        sie.follow(scene, sie.Path([(P, 0.1 * F * P), (1.1 * P, 0.3 * F * P)]))


@pytest.mark.slow
def test_energy_of_a_row_of_one_is_that_of_its_profile():
    row = sie.Scene(modulus=1.0, profile=sie.Row([TWO.profiles[0]]), normal_load=0.4, friction=F)
    one = sie.Scene(modulus=1.0, profile=TWO.profiles[0], normal_load=0.4, friction=F)
    lost = [[s.energy_lost for s in sie.follow(scene, oblique(0.4))] for scene in (row, one)]
    assert lost[0] == pytest.approx(lost[1], rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["row", "wavy punch"])
def test_normal_and_tangential_loads_that_change_together_agree_with_a_mesh(name):
    """In small steps; patches of the wavy punch appear on the way."""
    scene = SCENES[name]
    P = scene.normal_load
    points = [(0.5 * P, 0.3 * F * P), (P, 0.9 * F * P), (0.8 * P, -0.1 * F * P)]
    history = sie.follow(scene, sie.Path(points))
    loads = [points[0]]
    for start, end in pairwise(points):
        loads += [tuple(v) for v in np.linspace(start, end, 9)[1:]]
    mesh = PatchMesh(history[1].patches, 300, 1.0)
    p, q, lost = np.zeros(len(mesh.x)), np.zeros(len(mesh.x)), 0.0
    for load, Q in loads:
        p = mesh.pressure(scene.profile.height(mesh.x), load, p)
        bound = F * p
        q, moved = mesh.step(q, bound, Q, 0.0)
        lost += mesh.h * float(np.abs(q * moved).sum())
        if (load, Q) in points:
            exact = history[points.index((load, Q))]
            assert np.abs(q - exact.shear(mesh.x)).mean() < 2e-2 * bound.max()
    if name == "row":  # a patch of the wavy punch slides as a whole while P changes
        assert lost == pytest.approx(history[-1].energy_lost, rel=3e-2)


@pytest.mark.slow(but=5)
@each
def test_slip_at_incipient_sliding_is_the_limit_of_slip(scene):
    nearly, sliding = (sheared(scene, part) for part in (1 - 1e-7, 1.0))
    x = places(sliding)
    assert sliding.stick == ()
    assert sliding.slip(x) == pytest.approx(nearly.slip(x), abs=1e-5 * (1.0 + np.ptp(x)))
    assert sliding.energy_lost == pytest.approx(nearly.energy_lost, rel=1e-4, abs=1e-12)


# -- what is written of it -------------------------------------------------------------------------


def test_the_table_of_a_path_lists_the_stick_zones_of_every_patch():
    scene = SCENES["row"]
    path = sie.Path(((0.4, 0.0, 0.0), (0.4, 0.12, 0.0)))
    last = sie.follow(scene, path)[-1]
    report = summary(last, SceneFile(last.scene, load_path=path, want=("shear",)))
    table = report.split("energy lost")[-1]
    for lo, hi in last.stick:
        assert f"{lo:.6g}" in table and f"{hi:.6g}" in table


def test_many_zones_are_summed_in_a_report():
    teeth = sie.Row([sie.Parabola(1.0).shifted(float(k)) for k in range(10)])
    scene = sie.Scene(modulus=1.0, profile=teeth, normal_load=0.1, friction=F, tangential_load=0.02)
    solution = sie.solve(scene)
    report = summary(solution, SceneFile(scene, want=("shear",)))
    assert "in 10 zones, together" in report and "in 20 zones, together" in report


@pytest.mark.parametrize("profile", [TWO, WAVES], ids=["row", "period"])
def test_the_plan_of_several_patches_speaks_of_patches(profile):
    scene = sie.Scene(
        modulus=1.0, profile=profile, normal_load=0.4, friction=F, tangential_load=0.1
    )
    plan = str(sie.plan(scene, want="shear"))
    assert "on all patches" in plan
    assert "the patches under P - |Q|/f are the stick zones" in plan
    assert "both edges" not in plan and "DCT" not in plan and "cost nothing" not in plan


def test_a_cycle_of_bulk_stress_in_a_contact_that_repeats_is_refused_as_such():
    wave = sie.Periodic(sie.FromFunction(lambda x: 0.01 * np.sin(np.pi * x)), period=2.0)
    scene = sie.Scene(profile=wave, modulus=1.0, normal_load=1e-3, friction=0.5)
    with pytest.raises(sie.ContactError, match=r"meet every 2.* no periodic answer"):
        sie.steady_cycle(scene, (1e-3, 1e-4, 1e-4), (1e-3, -1e-4, 0.0))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["row"])
def test_a_steady_cycle_of_patches_is_that_of_the_path_that_settles(name):
    scene = SCENES[name]
    P, fP = scene.normal_load, scene.friction * scene.normal_load
    A, B = (P, 0.5 * fP), (0.85 * P, -0.3 * fP)
    steady, path = sie.steady_cycle(scene, A, B), sie.follow(scene, sie.Path([A, B, A, B, A]))
    assert steady.energy == pytest.approx(path[4].energy_lost - path[2].energy_lost, rel=1e-9)
    (x1, x2) = path[3].patches[0]
    x = np.linspace(x1, x2, 21)[1:-1]
    change = path[4].shear(x) - path[3].shear(x)
    assert steady.shear_range(x) == pytest.approx(np.abs(change), abs=1e-12)
    assert steady.slip_range(x) == pytest.approx(
        np.abs(path[4].slip(x) - path[3].slip(x)), abs=1e-12
    )
    held = np.array([0.5 * (lo + hi) for lo, hi in steady.stick])
    assert (steady.slip_range(held) == 0.0).all()
