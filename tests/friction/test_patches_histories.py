"""Friction at constant normal load, on one patch, several ones and per period."""

from functools import cache

import numpy as np
import pytest
from path_cases import HERTZ, LOPSIDED, PUNCH

import sie
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


def scene_of(profile, load, **more):
    return sie.Scene(profile=profile, modulus=1.0, normal_load=load, friction=F, **more)


SCENES = {
    "row": scene_of(TWO, 0.4),
    "row under a moment": scene_of(TWO, 0.4, moment=0.05),
    "wavy punch": scene_of(WAVY, 0.228),
    "merged patches": scene_of(WAVY, 0.7),
    "flats": scene_of(FLATS, 0.6),
    "period": scene_of(WAVES, 3.0),
    "full contact": scene_of(WAVES, 60.0),
}
each = pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
# The laws of memory, for one patch too
EVERY = {"punch": PUNCH, "Hertz": HERTZ, "lopsided": LOPSIDED, **SCENES}
of_every = pytest.mark.parametrize("scene", EVERY.values(), ids=EVERY)


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


@pytest.mark.slow(but=5)
@of_every
def test_a_path_of_one_point_is_the_scene(scene):
    followed = at_constant_load(scene, 0.8)[0]
    alone = sheared(scene, 0.8)
    x = places(alone)
    assert followed.stick == alone.stick and followed.energy_lost == alone.energy_lost
    assert (followed.shear(x) == alone.shear(x)).all()
    assert (followed.slip(x) == alone.slip(x)).all()


@pytest.mark.parametrize("name", ["row", "period"])
def test_a_path_is_certified_also_where_nothing_is_sheared_yet(name):
    assert at_constant_load(SCENES[name], 0.0, 0.5)[0].check().ok


@pytest.mark.slow(but=5)
@of_every
def test_unloading_is_half_of_the_first_loading_twice(scene):
    """q = q(Q_max) - 2 q((Q_max - Q)/2), Mindlin & Deresiewicz 1953, and so is the slip."""
    loaded, unloaded = at_constant_load(scene, 0.9, 0.1)
    half = sheared(scene, 0.4)
    x = places(loaded)
    error = 1e-13 * loaded.pressure(x).max()
    assert unloaded.shear(x) == pytest.approx(loaded.shear(x) - 2.0 * half.shear(x), abs=error)
    assert unloaded.slip(x) == pytest.approx(loaded.slip(x) - 2.0 * half.slip(x), abs=1e-13)
    assert np.array(unloaded.stick) == pytest.approx(np.array(half.stick), abs=1e-13)
    lost = loaded.energy_lost + 2.0 * half.energy_lost
    assert unloaded.energy_lost == pytest.approx(lost, rel=1e-12)


@pytest.mark.slow(but=5)
@of_every
def test_a_closed_loop_closes_and_is_reversed_with_its_loads(scene):
    history = at_constant_load(scene, 0.8, -0.3, 0.5, -0.3, 0.8, -0.8)
    first, *_, last, reversed_ = history
    x = places(first)
    error = 1e-13 * first.pressure(x).max()
    assert np.array(last.stick) == pytest.approx(np.array(first.stick), abs=1e-13)
    assert last.shear(x) == pytest.approx(first.shear(x), abs=error)
    assert last.slip(x) == pytest.approx(first.slip(x), abs=1e-12)
    assert reversed_.shear(x) == pytest.approx(-first.shear(x), abs=error)


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


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (SCENES["full contact"], "full contact is not followed"),
        (scene_of(sie.Flat(1.0), 0.4), r"sharp edges .* round its corners \(sie.RoundedFlat\)"),
    ],
    ids=["full contact", "sharp edges"],
)
def test_contacts_that_layers_alone_answer_are_refused_where_the_normal_load_changes(scene, said):
    P = scene.normal_load
    with pytest.raises(sie.ContactError, match=said):
        sie.follow(scene, sie.Path([(P, 0.1 * F * P), (1.1 * P, 0.3 * F * P)]))


@pytest.mark.slow(but=5)
@each
def test_slip_at_incipient_sliding_is_the_limit_of_slip(scene):
    nearly, sliding = (sheared(scene, part) for part in (1 - 1e-7, 1.0))
    x = places(sliding)
    assert sliding.stick == ()
    assert sliding.slip(x) == pytest.approx(nearly.slip(x), abs=1e-5 * (1.0 + np.ptp(x)))
    assert sliding.energy_lost == pytest.approx(nearly.energy_lost, rel=1e-4, abs=1e-12)


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
    scene = scene_of(teeth, 0.1, tangential_load=0.02)
    solution = sie.solve(scene)
    report = summary(solution, SceneFile(scene, want=("shear",)))
    assert "in 10 zones, together" in report and "in 20 zones, together" in report


@pytest.mark.parametrize("profile", [TWO, WAVES], ids=["row", "period"])
def test_the_plan_of_several_patches_speaks_of_patches(profile):
    scene = scene_of(profile, 0.4, tangential_load=0.1)
    plan = str(sie.plan(scene, want="shear"))
    assert "on all patches" in plan
    assert "the patches under P - |Q|/f are the stick zones" in plan
    assert "both edges" not in plan and "DCT" not in plan and "cost nothing" not in plan
