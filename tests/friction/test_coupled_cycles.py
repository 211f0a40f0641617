"""Dissimilar bodies under P, then Q and bulk stress at constant P."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scenes import dissimilar
from scipy.special import digamma
from sheared_cases import PROFILES, scene, solved, zones

import sie
from oracles import oblique_edges

P = 0.5 * math.pi
STEEL, TITANIUM = sie.Elastic(210e3, 0.3), sie.Elastic(110e3, 0.34)


def followed(*parts, beta=0.3, friction=0.3, strain=0.0):
    """A parabola under P, then parts of f P, with a bulk stress in proportion."""
    pressed = dissimilar(None, beta, friction, normal_load=P)
    points = [(P, part * friction * P, 4.0 * strain * part) for part in parts]
    return sie.follow(pressed, sie.Path([(P, 0.0, 0.0), *points]))


@pytest.mark.parametrize("case", oblique_edges.EDGES)
def test_edges_of_contact_and_stick_agree_with_another_program(case):
    found = zones(solved(None, *case, load=P))
    assert found == pytest.approx(np.array(oblique_edges.EDGES[case]), abs=1e-11)


def test_another_program_finds_the_same_edges():
    beta, friction, part = 0.25, 0.6, 0.8
    other = oblique_edges.edges((beta, friction), (P, part), (-1.078, -0.685, 0.008, 0.92))
    assert other == pytest.approx(zones(solved(None, beta, friction, part, load=P)), abs=1e-11)


# Tangential load and bulk stress, and the zones of a prototype: γ of what sticks changes by the
# strain.
STRAINED = {
    (0.0, 0.2): (-0.992595693, -0.893837890, 0.893837890, 0.992595693),
    (0.0, -0.2): (-0.973597385, -0.302589824, 0.302589824, 0.973597385),
    (0.15 * P, -0.2): (-1.018785704, -0.889428347, -0.052684626, 0.957631460),
}


@pytest.mark.parametrize("loads", STRAINED)
def test_zones_under_a_bulk_stress_agree_with_another_program(loads):
    Q, sigma = loads
    solution = sie.solve(dissimilar(None, normal_load=P, tangential_load=Q, bulk_stress=sigma))
    assert zones(solution) == pytest.approx(STRAINED[loads], abs=1e-8)
    assert solution.check().ok and solution.shear.resultant == Q


# A prototype of other code, whose states agree to a cell with those of an incremental grid
REVERSED = {
    0.4: (-1.0132983321, -0.9974867883, 0.9387502091, 0.9690657215),
    0.0: (-0.9848064050, -0.8757203238, 0.8405886338, 0.9973968281),
    -0.5: (-0.9617850977, -0.1657215240, 0.6695820717, 1.0289310776),
}


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("part", REVERSED)
def test_zones_after_a_reversal_agree_with_another_program(part):
    history = followed(0.5, part)
    assert zones(history[2]) == pytest.approx(np.array(REVERSED[part]), abs=1e-9)
    assert history[2].check().ok


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("name", PROFILES)
def test_certificate_holds_for_every_profile(name):
    certificate = solved(PROFILES[name], load=0.3 if name == "uneven" else 1.0).check()
    assert certificate.ok
    assert max(certificate.error, certificate.shear.error) < 1e-10


@pytest.mark.parametrize(
    ("profile", "beta", "friction", "part"),
    [
        (None, 0.1, 1.0, 0.5),
        (None, 0.05, 0.8, 0.4),
        (None, 0.3, 2.0, 0.99),
        (sie.RoundedFlat(0.5, 1.0), 0.5, 0.5, 0.99),
        (sie.RoundedFlat(0.5, 1.0), 0.3, 0.3, 1e-3),
        (None, 0.1, 0.1, 1e-6),
        (None, 0.1, 0.1, 1.0 - 1e-6),
        (None, 0.1, 0.1, 1.0 - 1e-9),
    ],
)
def test_certificate_holds_from_narrow_slip_zones_to_incipient_sliding(
    profile, beta, friction, part
):
    assert solved(profile, beta, friction, part).check().ok


PAD = sie.Scene(
    profile=sie.Parabola(50.0), body=TITANIUM, indenter=STEEL, normal_load=100.0, friction=0.4
)


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(
    ("friction", "parts"),
    [(0.4, (0.5, 0.125, -0.5)), *((0.3, (part, -part, part)) for part in (0.5, 0.6, 0.667))],
)
def test_a_cycle_of_steel_on_titanium_is_certified_at_every_point(friction, parts):
    """Between marks of the way there, q is ± f p already: a stick zone may reach beyond them."""
    loads = [(100.0, 100.0 * friction * part) for part in (0.0, *parts)]
    history = sie.follow(replace(PAD, friction=friction), sie.Path(loads))
    assert all(point.energy_lost >= 0.0 and point.check().ok for point in history)


@pytest.mark.parametrize(("beta", "part"), [(0.3, -0.5), (-0.3, 0.5), (-0.3, -0.5)])
def test_signs_of_the_load_and_of_the_mismatch_give_mirror_images(beta, part):
    one, other = solved(), solved(None, beta, 0.3, part)
    flip = math.copysign(1.0, beta * part)
    expected = zones(one) if flip > 0.0 else -zones(one)[::-1]
    assert zones(other) == pytest.approx(expected, abs=1e-11)
    x = np.linspace(*other.edges, 41)[1:-1]
    sign = math.copysign(1.0, part)
    assert other.pressure(x) == pytest.approx(one.pressure(flip * x), rel=1e-10)
    assert other.shear(x) == pytest.approx(sign * one.shear(flip * x), abs=1e-11)
    assert other.slip(x) == pytest.approx(sign * one.slip(flip * x), abs=1e-11)


def test_zones_tend_to_cattaneos_in_proportion_to_the_mismatch():
    alike = zones(solved(None, beta=0.0))
    near, nearer = (np.abs(zones(solved(None, b)) - alike).max() for b in (4e-2, 2e-2))
    assert near / nearer == pytest.approx(2.0, rel=0.1)


def test_contact_tends_to_that_of_full_sliding():
    sliding = sie.solve(replace(scene(part=0.0), sliding=1))
    last = solved(part=1.0 - 1e-8)
    assert last.edges == pytest.approx(sliding.edges, abs=1e-7)
    assert np.ptp(last.stick) < 1e-3


def test_zones_leave_those_of_the_normal_load_like_the_root_of_a_small_load():
    c = solved(part=0.0).stick[0][1]
    grown = [(c - zones(solved(part=q))[2]) / math.sqrt(q) for q in (1e-2, 1e-3)]
    assert grown[0] == pytest.approx(grown[1], rel=0.05)


def test_a_tilted_parabola_is_a_parabola_about_another_axis():
    tilted, upright = sie.solve(replace(scene(), tilt=0.1)), solved()
    assert zones(tilted) == pytest.approx(zones(upright) - 0.1, abs=1e-11)
    assert tilted.tilt == 0.1 and tilted.check().ok
    assert tilted.gap(2.0) == pytest.approx(float(upright.gap(2.1)), rel=1e-9)


@pytest.mark.parametrize("name", ["parabola", "rounded flat"])
def test_potentials_are_those_of_the_tractions(name):
    solution = solved(PROFILES[name])
    z = np.array([1e6 + 1e6j]) * solution.half_width
    for traction, load in (
        (solution.pressure, solution.normal_load),
        (solution.shear, solution.tangential_load),
    ):
        assert traction.resultant == load
        assert math.pi * traction.cauchy(z) * z == pytest.approx(np.array([load]), rel=1e-5)
        x = solution.half_width * np.array([-0.83, -0.31, 0.07, 0.55])
        assert traction.cauchy(x).imag == pytest.approx(-traction(x), abs=1e-11)


def test_slip_beyond_that_of_the_normal_load_goes_with_the_load():
    before, after = solved(part=0.0), solved()
    _, e1, e2, x2 = zones(after)
    b = before.half_width
    stick = np.linspace(e1, e2, 9)
    slip = np.append(np.linspace(-b, e1, 7)[:-1], np.linspace(e2, x2, 7)[1:])
    assert after.slip(stick) == pytest.approx(before.slip(stick), abs=1e-13)
    assert (after.slip(slip) > before.slip(slip)).all()


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("name", ["parabola", "kinked"])
def test_energy_is_the_work_of_friction_on_the_slip(name):
    """Two ends pass kinks of the second profile before."""
    one, other = (solved(PROFILES[name], part=part) for part in (0.29, 0.31))
    lo, hi = max(one.edges[0], other.edges[0]), min(one.edges[1], other.edges[1])
    phi = (np.arange(1000) + 0.5) * math.pi / 1000
    x = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(phi)
    carried = 0.5 * 0.3 * (one.pressure(x) + other.pressure(x))
    work = carried * (other.slip(x) - one.slip(x)) * np.sin(phi)
    lost = other.energy_lost - one.energy_lost
    assert lost == pytest.approx(work.sum() * 0.5 * (hi - lo) * math.pi / 1000, rel=1e-3)


def test_slip_within_the_stick_zone_is_refused():
    history = [(P, 0.0, 0.0), (P, 0.15 * P, 0.0), (P, 0.15 * P, 0.2)]
    with pytest.raises(sie.ContactError, match="dundurs = 0"):
        sie.follow(dissimilar(None, normal_load=P), sie.Path(history))


# In the first one a load is passed at which loads turned, in the second one stick passes ends that
# it had before.
DIVIDED = {
    "a load": (0.3, 0.3, (0.2,), (0.1, 0.2)),
    "past a turn": (0.3, 0.3, (0.65, 0.15, 0.12, 0.66), (0.65, 0.15, 0.12, 0.65, 0.66)),
    "past earlier ends": (0.3, 0.3, (0.5, -0.5), (0.5, 0.1, -0.2, -0.4, -0.5)),
    "past a mark at once after a turn": (0.0575, 0.3, (0.6,), (0.3, 0.6)),
}


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("beta", "friction", "whole", "parts"), DIVIDED.values(), ids=DIVIDED)
def test_a_step_is_that_of_its_parts(beta, friction, whole, parts):
    one, other = (followed(*q, beta=beta, friction=friction)[-1] for q in (whole, parts))
    assert zones(one) == pytest.approx(zones(other), abs=1e-10)
    assert one.energy_lost == pytest.approx(other.energy_lost, rel=5e-7)


@pytest.mark.slow
def test_a_closed_loop_leaves_the_state_in_which_it_began():
    history = followed(0.5, -0.5, 0.5, -0.4, -0.5)
    assert zones(history[5]) == pytest.approx(zones(history[2]), abs=1e-9)
    assert np.abs(zones(history[3]) - zones(history[1])).max() > 0.1


@pytest.mark.slow
def test_the_steady_cycle_is_that_of_many_cycles():
    pressed = dissimilar(None, normal_load=P)
    Q = 0.15 * P
    steady = sie.steady_cycle(pressed, (P, Q, 0.0), (P, -Q, 0.0))
    history = followed(0.5, -0.5, 0.5, -0.5, 0.5)
    first, last = history[5].stick[0], history[4].stick[0]
    lo, hi = max(first[0], last[0]), min(first[1], last[1])
    assert steady.stick[0] == pytest.approx((lo, hi), abs=1e-8)
    assert steady.slip_range([0.5 * (lo + hi)]) == pytest.approx([0.0], abs=1e-10)


def test_plan_names_the_stages_that_are_filled():
    planned = sie.plan(scene(), want=("edges", "pressure", "check"))
    solution = solved()
    _ = solution.edges, solution.pressure(0.0), solution.check()
    assert planned.stages <= set(vars(solution))


@pytest.mark.parametrize(
    "profile", [sie.Flat(1.0), sie.Flat(0.1).shifted(3.0), sie.Piecewise((-1.0, 1.0), ((0.0,),))]
)
def test_a_sharp_flat_is_refused_before_anything_is_solved(profile):
    with pytest.raises(sie.ContactError, match="corner of the indenter"):
        solved(profile)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"normal_load": None, "half_width": 1.0}, "give normal_load"),
        ({"moment": 0.01}, "a moment that is held"),
    ],
)
def test_what_is_not_solved_is_refused_before_any_work(changes, words):
    with pytest.raises(sie.ContactError, match=words) as refusal:
        sie.solve(replace(scene(), **changes))
    assert len(str(refusal.value).split()) <= 40


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("beta", "friction", "part"), [(0.3, 2.0, 0.5), (0.36, 0.57, 1e-5)])
def test_a_load_under_which_gained_contact_sticks_is_refused(beta, friction, part):
    with pytest.raises(sie.ContactError, match="dundurs = 0") as refusal:
        _ = solved(None, beta, friction, part).edges
    assert len(str(refusal.value).split()) <= 40


def test_a_path_whose_normal_load_changes_is_refused_with_the_scene_that_is_answered():
    path = sie.Path([(1.0, 0.0), (1.0, 0.1), (0.9, 0.1)])
    with pytest.raises(sie.ContactError, match="hold P at its mean") as refusal:
        sie.follow(scene(part=0.0), path)
    assert len(str(refusal.value).split()) <= 40
    held = sie.Path([(1.0, 0.0), (1.0, 0.1), (1.0, 0.08)])
    assert sie.follow(scene(part=0.0), held)[2].check().ok


@pytest.mark.parametrize("part", [0.0, 0.3])
def test_the_gap_far_away_is_what_the_profile_rises(part):
    gaps = solved(None, 0.3, 0.3, part).gap(np.array([-1e300, -1e120, 1e120, 1e160]))
    assert gaps[1] == pytest.approx(0.5e240, rel=1e-12) == gaps[2]
    assert gaps[0] == gaps[3] == math.inf


def moved_by(solution, marks):
    """E*/2 times what a far point moves against x = 0 by p and q, less Q/π ln X."""
    cuts = np.unique([0.0, *solution.edges, *(m for m in marks if abs(m) < solution.edges[1])])
    total, (node, weight) = 0.0, np.polynomial.legendre.leggauss(30)
    for lo, hi in pairwise(cuts):
        for first, last in pairwise((0.0, 1e-3, 0.05, 0.5, 0.95, 1.0 - 1e-3, 1.0)):
            v = first + 0.5 * (last - first) * (1.0 + node)
            x, slope = lo + (hi - lo) * np.sin(0.5 * np.pi * v) ** 2, np.sin(np.pi * v)
            q, p = solution.shear(x), solution.pressure(x)
            density = solution.scene.beta * (x > 0.0) * p - q * np.log(np.abs(x)) / np.pi
            total += 0.25 * np.pi * (hi - lo) * (last - first) * float(weight @ (slope * density))
    return total


@pytest.mark.parametrize("parts", [(0.8,), (0.8, -0.3), (0.8, -0.8, 0.5)])
def test_the_shift_is_that_of_the_far_field_seen_from_a_place_that_stuck(parts):
    history = followed(*parts, beta=0.1, friction=0.5)
    pressed, last = history[0], history[-1]
    marks = [end for solution in history for zone in solution.stick for end in zone]
    eta = math.atanh(0.1) / math.pi
    bonded = math.log(0.5 * pressed.half_width) + (digamma(0.5 + 1j * eta) - digamma(0.5)).real
    moved = moved_by(last, marks) - moved_by(pressed, marks)
    expected = (moved + last.tangential_load / math.pi * bonded) / (0.5 * last.scene.Estar)
    assert last.shift == pytest.approx(expected, rel=1e-6)


def test_slip_is_continuous_where_places_have_left_the_contact_and_come_back():
    turns = [(100.0, 0.0, 0.0), (100.0, 24.0, 60.0), (100.0, -24.0, -60.0), (100.0, 24.0, 60.0)]
    _, _, narrow, last = sie.follow(PAD, sie.Path(turns))
    left, inner = last.edges[0], narrow.edges[0]
    assert left < inner  # the strip between has been apart
    slip = last.slip(np.linspace(left, 2.0 * inner - left, 41))
    steps = np.diff(slip)
    assert np.abs(steps).max() < 3.0 * np.abs(steps).mean()


@pytest.mark.slow
def test_points_where_the_normal_load_grows_and_then_the_tangential_one_are_those_of_scenes():
    path = sie.Path([(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, -0.15), (1.0, -0.2)])
    history = sie.follow(dissimilar(), path)
    assert [row["energy_lost"] for row in history.rows()] == sorted(
        row["energy_lost"] for row in history.rows()
    )
    for point, (P, Q, _) in list(zip(history, path.points, strict=True))[1:]:
        alone = sie.solve(dissimilar(normal_load=P, tangential_load=Q))
        assert point.edges == pytest.approx(alone.edges, rel=1e-12)
        assert point.stick[0] == pytest.approx(alone.stick[0], rel=1e-11)
        assert point.slip(0.3) == pytest.approx(float(alone.slip(0.3)), rel=1e-9, abs=1e-15)
        assert point.shear.resultant == Q and point.check().ok


def test_a_path_of_scenes_is_refused_before_any_work_where_all_slides():
    with pytest.raises(sie.LoadError, match="bodies slide"):
        sie.follow(dissimilar(), sie.Path([(1.0, 0.0), (1.0, 0.1), (1.0, 0.4)]))


def test_bodies_that_would_stick_where_they_did_not_touch_before_are_refused():
    """What an edge leaves and comes back to has no memory of its gap."""
    bodies = {"body": sie.Elastic(3e3, 0.38), "indenter": sie.Elastic(210e3, 0.30)}
    profile = sie.Polynomial((0.0, 0.0, 0.0184, -0.002, 0.0021))
    scene = sie.Scene(profile=profile, normal_load=100.0, friction=0.8, **bodies)
    with pytest.raises(sie.ContactError, match="contact that is gained sticks"):
        sie.follow(scene, sie.Path([(100.0, 0.0), (100.0, -48.0, 29.0), (100.0, 0.0)]))


@pytest.mark.slow
def test_a_cycle_of_bodies_of_small_beta_nearly_closes_and_is_found():
    bodies = {"body": sie.Elastic(5.0, 0.499), "indenter": sie.Elastic(210e3, 0.30)}
    scene = sie.Scene(profile=sie.Parabola(0.05), normal_load=100.0, friction=0.6, **bodies)
    history = sie.follow(scene, sie.Path([(100.0, 0.0), *[(100.0, -30.0), (100.0, 30.0)] * 2]))
    assert history[3].check().ok
