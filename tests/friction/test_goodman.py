"""Dissimilar bodies in Goodman's approximation: β q is left out of equation (1)."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from scenes import dissimilar

import sie
from analytic import goodman
from sie.io.scene_file import parse

SYMMETRIC = {
    "flat": sie.Flat(1.0),
    "parabola": sie.Parabola(1.0),
    "rounded flat": sie.RoundedFlat(0.5, 1.0),
    "power": sie.Power(2.5, 0.4),
    "wedge": sie.Wedge(0.1),
}


def solved(profile=None, beta=0.1, friction=0.1, **given):
    given = {"normal_load": 1.0, "coupling": "goodman"} | given
    return sie.solve(dissimilar(profile, beta, friction, **given))


@pytest.mark.parametrize("name", SYMMETRIC)
@pytest.mark.parametrize(("beta", "friction"), [(0.1, 0.1), (-0.3, 0.1), (0.07, 0.3)])
def test_stick_zone_of_a_symmetric_profile_is_that_of_the_elliptic_integrals(name, beta, friction):
    solution = solved(SYMMETRIC[name], beta, friction)
    b = solution.half_width
    c = goodman.stick_half_width(half_width=b, friction=friction, dundurs=abs(beta))
    assert solution.stick[0] == pytest.approx((-float(c), float(c)), rel=1e-13)


@pytest.mark.parametrize("name", SYMMETRIC)
def test_pressure_is_that_without_friction(name):
    x = np.linspace(-0.9, 0.9, 7)
    plain = sie.solve(sie.Scene(profile=SYMMETRIC[name], modulus=2.0, normal_load=1.0))
    assert solved(SYMMETRIC[name]).pressure(x) == pytest.approx(plain.pressure(x), rel=1e-12)


SKEW = sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.2))
CERTIFIED = [
    *((profile, 0.1, {}) for profile in SYMMETRIC.values()),
    *((SKEW, 0.3, given) for given in ({}, {"tangential_load": 0.02}, {"bulk_stress": -0.02})),
    *((None, 0.1, {"tangential_load": 0.1 * part})
      for part in (1e-6, 1e-4, 0.3, -0.7, 0.99, -0.99, 1.0 - 1e-6, 1.0 - 1e-9)),
]  # fmt: skip


@pytest.mark.parametrize(("profile", "friction", "given"), CERTIFIED)
def test_every_contact_is_certified_and_carries_its_loads(profile, friction, given):
    solution = solved(profile, 0.1, friction, **given)
    certificate = solution.check()
    assert certificate.ok
    assert max(certificate.shear.residual, certificate.shear.equilibrium) < 1e-10
    assert solution.shear.resultant == solution.tangential_load


def test_friction_of_a_small_mismatch_works_as_that_of_similar_bodies():
    loads = {"tangential_load": 0.15, "friction": 0.3}
    like, unlike = solved(beta=0.0, **loads), solved(beta=1e-7, **loads)
    x = np.linspace(-0.79, 0.79, 9)
    assert unlike.slip(x) == pytest.approx(like.slip(x), abs=1e-7)
    assert unlike.shift == pytest.approx(like.shift, rel=1e-6)
    assert unlike.energy_lost == pytest.approx(like.energy_lost, rel=1e-6)


def test_a_cycle_repeats_itself_once_the_slip_of_pressing_is_worn_off():
    path = sie.Path(((1.0, 0.0), *((1.0, Q) for Q in (0.06, -0.06, 0.06, -0.06, 0.06))))
    states = sie.follow(solved().scene, path)
    assert all(state.check().ok for state in states)
    assert states[1].stick[0] != pytest.approx(states[3].stick[0], abs=1e-2)
    assert states[5].stick[0] == pytest.approx(states[3].stick[0], abs=1e-11)


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("load", [0.0, 0.3])
def test_symmetric_trace_is_answered_as_the_profile_that_it_samples(load):
    x = np.linspace(-2.0, 2.0, 21)
    trace, smooth = (
        solved(profile, friction=0.4, normal_load=0.2, tangential_load=0.08 * load)
        for profile in (sie.Sampled(x, 0.5 * x * x), sie.Parabola(1.0))
    )
    assert trace.stick[0] == pytest.approx(smooth.stick[0], abs=1e-11)
    assert trace.check().ok


@pytest.mark.parametrize("part", [0.3, -0.99])
def test_a_tilted_parabola_is_the_upright_one_elsewhere_under_tangential_load(part):
    x = np.linspace(-0.7, 0.7, 9)
    tilted = solved(tangential_load=0.1 * part, tilt=0.05)
    upright = solved(tangential_load=0.1 * part)
    assert tilted.shear(x - 0.05) == pytest.approx(upright.shear(x), abs=1e-11)
    assert tilted.check().ok


DOUBLE_WELL = sie.Polynomial((0.0, 0.0, -0.5, 0.0, 1.0))


@pytest.mark.parametrize("load", [2.0, 50.0])
def test_patches_that_have_merged_are_refused(load):
    with pytest.raises(sie.ContactError, match=r"merged from several: .* convex profile"):
        _ = solved(DOUBLE_WELL, normal_load=load).stick


def test_the_load_to_the_left_mirrors_the_load_to_the_right():
    right, left = solved(tangential_load=0.03), solved(tangential_load=-0.03)
    x = np.linspace(-0.7, 0.7, 9)
    assert left.stick[0] == pytest.approx(tuple(-c for c in right.stick[0][::-1]), rel=1e-12)
    assert left.shear(x) == pytest.approx(-right.shear(-x), abs=1e-11)


@pytest.mark.parametrize(("beta", "friction"), [(0.1, 0.1), (0.07, 0.3), (0.3, 0.1)])
def test_shear_of_a_flat_is_that_of_the_closed_form(beta, friction):
    """Which is the ratio of elliptic integrals in the stick zone."""
    x = np.array([-0.9, -0.6, -0.02, 0.0, 0.3, 0.7, 0.99])
    solution = solved(sie.Flat(1.0), beta, friction)
    form = goodman.flat_shear(x, half_width=1.0, normal_load=1.0, friction=friction, dundurs=beta)
    assert solution.shear(x) == pytest.approx(form, rel=1e-12, abs=1e-15)
    c = solution.stick[0][1]
    ratio = mpmath.ellipf(mpmath.asin(0.02 / c), c * c) / mpmath.ellipk(c * c)
    expected = -friction * float(ratio) / (np.pi * np.sqrt(1.0 - 0.02**2))
    assert float(solution.shear(-0.02)) == pytest.approx(expected, rel=1e-11)


def test_answer_tends_to_the_coupled_one_quadratically():
    x = 0.4
    punch, errors = sie.RoundedFlat(0.5, 1.0), []
    for beta in (1e-2, 1e-3):
        q, full = (solved(punch, beta, beta, coupling=c).shear(x) for c in ("goodman", "full"))
        errors.append(float(q - full) / beta)
    assert abs(errors[0]) < 1e-3
    assert errors[1] == pytest.approx(0.01 * errors[0], rel=0.02)


def test_report_says_what_is_left_out():
    *_, note = solved().notes
    assert "β q is left out" in note and 'give coupling="full" to compare' in note
    assert solved().check().notes[-1] == note


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"tilt": 0.02, "profile": sie.Flat(1.0)}, "one edge of contact stays there: .* round"),
        ({"profile": sie.Flat(1.0), "tangential_load": 0.05}, "corner of the indenter .* round it"),
        ({"tangential_load": 0.2}, "slide"),
    ],
)
def test_what_is_not_solved_is_refused_with_a_remedy(given, words):
    with pytest.raises(sie.ContactError, match=f"(?s){words}"):
        _ = solved(**given).stick


def test_full_stick_has_no_approximation():
    with pytest.raises(ValueError, match=r"full stick .* leave coupling out"):
        solved(sie.Flat(1.0), friction=float("inf"))


def test_another_name_of_coupling_is_refused():
    with pytest.raises(ValueError, match="'full', or 'goodman'"):
        solved(coupling="spence")


def test_sliding_leaves_the_pressure_without_friction():
    solution = solved(sliding=1)
    plain = sie.solve(sie.Scene(profile=sie.Parabola(1.0), modulus=2.0, normal_load=1.0))
    assert solution.edges == plain.edges
    assert solution.shear(0.3) == pytest.approx(0.1 * plain.pressure(0.3), rel=1e-15)


def test_scene_file_takes_the_coupling():
    text = """
        [profile]
        kind = "parabola"
        radius = 1.0
        [pair]
        modulus = 2.0
        dundurs = 0.1
        coupling = "goodman"
        [load]
        normal_load = 1.0
        friction = 0.1
    """
    assert parse(text).scene == solved().scene


def test_plan_says_that_the_coupling_is_left_out():
    steps = {step.name: step for step in sie.plan(solved().scene, want="shear").steps}
    assert "Goodman" in steps["coupling"].reason
