"""The footprint of an answer is the plan's, and every economy leaves the answer as it is."""

from contextlib import suppress

import laws
import numpy as np
import pytest
import strategies
from hypothesis import given
from scenes import scene

import sie

STAGES = {"bonded", "normal", "pressure", "rises", "tangential", "tractions", "certificate"}
CYLINDER = sie.Parabola(2.0)
SINH = {"slope": "sinh(x)", "domain": (-9.0, 9.0)}
FLATS = sie.Piecewise(
    (-3.0, -2.0, -0.5, 0.5, 1.0), ((1.0, 0.5), (-0.5,), (-0.5,), (0.0,), (0.0,), (-2.0, 2.0))
)


SCENES = {
    "convex": scene(),
    "tilted": scene(tilt=0.05),
    "moment": scene(moment=0.1),
    "cylinder": scene(CYLINDER, half_width=0.5),
    "function": scene(sie.FromFunction(**SINH)),
    "even function": scene(sie.FromFunction(**SINH, parity="even")),
    "flat": scene(sie.Flat(1.0)),
    "many flats": scene(FLATS, half_width=2.75),
    "partial slip": scene(friction=0.5, tangential_load=0.3),
    "full sliding": scene(friction=0.5, tangential_load=-0.5),
    "both signs": scene(CYLINDER, half_width=1.0, friction=0.5, bulk_stress=0.3),
    "rough, not sheared": scene(CYLINDER, half_width=1.0, friction=0.5),
    "dissimilar": scene(CYLINDER, body=sie.Elastic(1.0, 0.3), indenter=sie.RIGID, normal_load=0.5),
    "dissimilar, sliding": scene(dundurs=0.2, friction=0.5, sliding=1),
    "bonded": scene(sie.Flat(1.0), dundurs=0.2, friction=float("inf"), tangential_load=0.3),
}
ECONOMIES = ("symmetry", "transform", "zero panels", "convexity", "shear", "sliding")


def shear(solution):
    _ = solution.edges, solution.stick, solution.shear(0.1)
    with suppress(sie.ContactError):  # slip before dissimilar bodies slide is not known
        _ = solution.slip(0.1), solution.energy_lost


ASK = {
    "edges": lambda s: s.edges,
    "pressure": lambda s: s.pressure(0.1),
    "gap": lambda s: s.gap(9.0),
    "shear": shear,
    "energy": shear,
    "check": lambda s: s.check(),
    "stress": lambda s: s.stress(0.1, 0.2).xx,
    "tension": lambda s: s.peak_tension(),
}


def footprint(solution):
    return frozenset(STAGES & vars(solution).keys())


@pytest.mark.slow(but=15)
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("economy", [ECONOMIES, ()], ids=["economical", "wasteful"])
def test_the_footprint_is_the_plan(name, economy):
    for want, ask in ASK.items():
        solution = sie.solve(SCENES[name], economy=economy)
        assert footprint(solution) == frozenset()
        ask(solution)
        planned = sie.plan(SCENES[name], want=want, economy=economy).stages
        assert footprint(solution) == planned, want


ATTRIBUTES = ["half_width", "centre", "stick", "slip", "shift", "energy_lost"]
ATTRIBUTES += ["elastic_limit", "peak_tension"]


@pytest.mark.parametrize("want", ATTRIBUTES)
def test_an_attribute_of_a_solution_may_be_wanted_by_its_name(want):
    sheared = scene(poisson=0.3, friction=0.5, tangential_load=0.3)
    solution = sie.solve(sheared)
    answer = getattr(solution, want)
    if callable(answer):
        answer(0.1) if want == "slip" else answer()
    assert footprint(solution) == sie.plan(sheared, want=want).stages


def test_a_plan_prints_every_step_with_run_or_skip_and_a_reason():
    for asked in SCENES.values():
        for line in str(sie.plan(asked, want="check")).splitlines():
            assert line.startswith(("run ", "skip"))
            assert len(line.split(maxsplit=2)) == 3


def test_a_plan_gives_the_reason_why_the_shear_is_solved_for_or_not():
    said = {name: str(sie.plan(asked, want="shear")) for name, asked in SCENES.items()}
    assert "f = 0: there is no shear traction" in said["convex"]
    assert "Q = 0 and no bulk stress" in said["rough, not sheared"]
    assert "full sliding: q is f times the pressure, no second solve" in said["full sliding"]
    assert "none if nothing but the flat base sticks" in said["partial slip"]
    assert "one direction or two" in said["both signs"]


def test_a_plan_computes_nothing():
    calls = []
    profile = sie.FromFunction(lambda x: calls.append(1) or x, domain=(-1.0, 1.0))
    built = len(calls)
    sie.plan(sie.Scene(profile=profile, modulus=1.0, normal_load=0.1), want="check")
    sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=0.1))
    assert len(calls) == built


@pytest.mark.slow
@given(strategies.scenes())
def test_every_economy_leaves_the_answer_as_it_is(scene):
    thrifty = sie.solve(scene)
    (x1, x2), r, P = thrifty.edges, thrifty.half_width, scene.normal_load
    x = thrifty.centre + r * np.array([-0.9, -0.4, 0.07, 0.5, 0.95])
    x = x[np.abs(x[:, None] - np.array([*scene.profile.breaks, 9e9])).min(axis=1) > 1e-6 * r]
    peak = laws.peak(thrifty.pressure, thrifty.edges, scene.profile.breaks)
    far = 1 + abs(thrifty.centre) / r
    for without in (*ECONOMIES, None):
        economy = () if without is None else [e for e in ECONOMIES if e != without]
        wasteful = sie.solve(scene, economy=economy)
        assert wasteful.edges == pytest.approx((x1, x2), abs=1e-14 * r * far)
        assert wasteful.moment == pytest.approx(thrifty.moment, abs=1e-14 * P * r * far)
        assert wasteful.pressure(x) == pytest.approx(thrifty.pressure(x), abs=3e-14 * peak * far)


def test_with_keeps_the_stages_that_cannot_have_changed():
    solution = sie.solve(SCENES["dissimilar"])
    solution.check()
    kept = solution.with_(poisson=None, friction=0.0)
    assert footprint(kept) == footprint(solution)
    assert kept.normal is solution.normal
    assert kept.pressure is solution.pressure


@pytest.mark.parametrize(
    "changes",
    [
        {"normal_load": 2.0},
        {"half_width": 1.25},
        {"tilt": 0.03},
        {"moment": 0.05},
        {"modulus": 3.0},
        {"profile": sie.Parabola(1.0)},
    ],
)
def test_with_drops_the_stages_that_may_have_changed_and_solves_the_new_scene(changes):
    solution = sie.solve(SCENES["convex"])
    solution.check()
    changed = solution.with_(**changes)
    assert footprint(changed) == frozenset()
    for name, value in changes.items():
        assert getattr(changed.scene, name) == value
    fresh = sie.solve(changed.scene)
    assert changed.edges == fresh.edges
    assert changed.moment == fresh.moment


def test_a_given_load_replaces_a_half_width_and_a_moment_a_tilt():
    solution = sie.solve(SCENES["tilted"])
    assert solution.with_(half_width=1.5).scene.normal_load is None
    assert solution.with_(half_width=1.5).with_(normal_load=1.0).scene.half_width is None
    assert solution.with_(moment=0.1).scene.tilt == 0.0
    assert solution.with_(moment=0.1).with_(tilt=0.01).scene.moment is None
