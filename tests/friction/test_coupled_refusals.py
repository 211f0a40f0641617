"""Certificates and refusals of dissimilar bodies under P, then Q."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from sheared_cases import scene, solved, trials_of, zones

import sie
from sie.certificate.coupled_check import coupled_certificate
from sie.friction.coupled import load_path
from sie.friction.coupled.iteration import next_to
from sie.friction.coupled.load_path import keeps_friction_law
from sie.friction.coupled.sheared import ShearedContact

# -- with other loads ------------------------------------------------------------------------------


def test_another_tangential_load_keeps_the_state_of_the_normal_load():
    one = solved()
    _ = one.edges
    other = one.with_(tangential_load=0.1)
    assert other.tangential_search is one.tangential_search
    assert zones(other) == pytest.approx(zones(sie.solve(other.scene)), rel=1e-12)


def test_full_load_slides():
    assert solved(part=1.0).stick == ()


def test_plan_names_the_stages_that_are_filled():
    planned = sie.plan(scene(), want=("edges", "pressure", "check"))
    solution = solved()
    _ = solution.edges, solution.pressure(0.0), solution.check()
    assert planned.stages <= set(vars(solution))


# -- certificates and refusals ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        (sie.Flat(1.0), "corner of the indenter"),
        (sie.Piecewise((-0.3, 0.3), ((0.0, 1.0),)), "corner"),
    ],
)
def test_sharp_edges_are_refused_with_the_width_of_the_zone_that_is_missing(profile, words):
    with pytest.raises(sie.ContactError, match=words):
        _ = solved(profile).edges


@pytest.mark.parametrize(
    "profile", [sie.Flat(1.0), sie.Flat(0.1).shifted(3.0), sie.Piecewise((-1.0, 1.0), ((0.0,),))]
)
def test_a_sharp_flat_is_refused_before_anything_is_solved(profile):
    with pytest.raises(sie.ContactError, match="corner of the indenter"):
        solved(profile)


def refused(*args):
    with pytest.raises(sie.ContactError) as caught:
        _ = solved(*args).edges
    return str(caught.value)


def test_width_of_the_zone_that_is_missing_is_that_of_a_grid():
    # The printed equations on a mesh graded to the corner, as a quadratic program, Q = 0.4 f P
    named = re.search(r"about (\S+) half-widths", refused(sie.Flat(1.0), 0.45, 0.3, 0.4))
    assert float(named[1]) == pytest.approx(5.5e-5, rel=0.25)


def test_the_width_of_a_zone_below_rounding_is_not_named():
    assert "half-widths" not in refused(sie.Flat(1.0), 0.057, 0.3, 0.4)
    assert "half-widths" not in refused(sie.Flat(1.0), 1e-3, 0.3, 0.4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("profile", "beta", "friction"),
    [
        (None, 0.36, 0.57),
        (None, 0.25, 2.0),
        (None, 0.49, 0.06),
        (sie.Polynomial((0, 0, 0.5, 0, 2.7)), 0.488, 0.059),
        (sie.RoundedFlat(0.5, 1.0), 0.34, 1.06),
        # The slip of the normal load goes on at the old edge under a small load
        (None, 0.409, 0.0227),
        (sie.FromFunction(slope="sinh(x)"), 0.39, 0.0118),
    ],
)
def test_refusal_of_a_small_load_names_the_least_that_is_certified(profile, beta, friction):
    message = refused(profile, beta, friction, 1e-5)
    assert "what the contact gains sticks" in message and len(message.split()) <= 40
    least = float(re.search(r"give \|Q\| from (\S+) up to f P", message)[1])
    followed = sie.solve(replace(scene(profile, beta, friction), tangential_load=least))
    assert followed.check().ok
    below = least - 0.01 * min(least, 30.0 * (friction - least))
    assert "what the contact gains sticks" in refused(profile, beta, friction, below / friction)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("profile", "beta", "friction"),
    [
        (None, 0.3, 2.0),
        (None, 0.2, 4.0),
        (None, 0.243, 3.77),
        (sie.Wedge(0.1), 0.3, 8.0),
        (sie.Polynomial((0, 0, 0.5, 0, 0.0211)), 0.276, 3.856),
    ],
)
def test_sliding_is_advised_where_zones_of_one_state_begin_late(profile, beta, friction):
    for part in (1e-5, 0.3, 0.75, 0.99):
        message = refused(profile, beta, friction, part)
        assert "let them slide (sliding = 1 or -1)" in message and len(message.split()) <= 40
    slides = replace(scene(profile, beta, friction), tangential_load=0.0, sliding=1)
    assert sie.solve(slides).check().ok


def test_certificate_is_not_ok_where_slip_would_oppose_the_load():
    search, Q = solved(None, 0.3, 2.0, 0.9).tangential_search, 1.0
    state = ShearedContact(search, next_to(search, search.start(Q), Q).trial, Q, 1.0, 1.0)
    assert search.least_slip(state.trial) < 0.0
    assert not coupled_certificate(state, scene(None, 0.3, 2.0, 0.5), 1e-13).ok


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("part", [1e-3, 0.5])
@pytest.mark.parametrize("edge", range(4))
def test_certificate_is_not_ok_with_an_edge_moved(edge, part):
    right = solved(part=part)
    search, edges = right.tangential_search, right.coupled[1].trial.edges
    edges[edge] += 1e-6
    wrong = replace(right.coupled[1], trial=search.trial(edges, right.tangential_load))
    assert not coupled_certificate(wrong, right.scene, 1e-13).ok


@pytest.mark.slow(but=2)
@pytest.mark.parametrize(
    ("profile", "beta", "friction", "part", "load"),
    [
        (None, -0.107, 0.0129, 0.43, 0.74),
        (sie.FromFunction(slope="sinh(x)"), -0.0404, 0.525, 3.4e-4, 0.2),
        (sie.FromFunction(slope="sinh(x)"), 0.00701, 9.9, -1.1e-6, 0.36),
        (sie.RoundedFlat(1.0, 1.0), 0.0553, 3.2, 2e-5, 0.25),
        (sie.RoundedFlat(1.0, 1.0), 0.0013, 8.5, -1.1e-6, 0.06),
        (sie.RoundedFlat(0.0017, 1.0), -0.0224, 5.18, 0.059, 0.8),
    ],
)
def test_certificate_holds_next_to_both_ends_of_the_loads(profile, beta, friction, part, load):
    assert solved(profile, beta, friction, part, load).check().ok


@pytest.mark.slow
@pytest.mark.parametrize("part", [0.0, 0.5])
def test_certificate_holds_where_hardly_anything_sticks_under_the_normal_load(part):
    assert solved(sie.RoundedFlat(0.5, 1.0), 0.3, 1e-3, part).check().ok


CORNERS = sie.Piecewise((-9.0, -0.4, 0.4, 9.0), ((-0.8, 1.0), (0.0, 0.5), (0.8, 1.0)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("profile", "beta", "friction", "part", "load"),
    [
        # An edge of the stick zone ends next to a corner
        (CORNERS, -0.2028, 0.045, -0.569, 0.2282),
        # Nodes of a rule next to a corner, or to the end of a stick zone, are few doubles apart
        (CORNERS, -0.00345, 0.0184, 0.459, 2.3),
        (CORNERS, -0.1516, 0.3515, -0.9998, 0.45),
        # Where stick is kept at a corner, p and q are evaluated a few doubles beside it
        (CORNERS, -0.03724, 0.06593, -2.839e-4, 0.13228),
        (CORNERS, 0.08146, 0.03331, 2.06e-4, 2.583),
        # The stick zone ends a few doubles beside a corner as this is passed by the edge
        (CORNERS, 0.002832, 0.07036, -8.023e-5, 0.201),
        # A corner comes into contact under Q
        (CORNERS, 0.11377, 0.72307, 0.30067, 0.12637),
        # Zones of 1e-8 half-widths
        (sie.Parabola(1.0), 0.0389, 4.2, -1.34e-6, 0.107),
        (sie.RoundedFlat(56.9, 1.0), -0.039, 0.867, -1.215e-3, 0.405),
        # No stick under P alone, where slip of full sliding passes zero more than once
        (sie.RoundedFlat(0.63, 1.0), 0.4878, 0.018, -0.7785, 0.3566),
    ],
)
def test_certificate_holds_next_to_corners_and_kinks(profile, beta, friction, part, load):
    assert solved(profile, beta, friction, part, load).check().ok


@pytest.mark.slow
@pytest.mark.parametrize(
    ("beta", "friction", "part", "load"),
    [
        (0.4872, 0.1839, -0.99, 0.1985),
        (0.06213, 0.2169, 0.86, 0.2881),
    ],
)
def test_zones_are_found_above_the_loads_under_which_an_edge_passes_a_corner(
    beta, friction, part, load
):
    solution = solved(CORNERS, beta, friction, part, load)
    assert solution.check().ok
    assert keeps_friction_law(solution.coupled[1])


@pytest.mark.slow
@pytest.mark.parametrize("part", [0.668, 0.845])
def test_a_corner_that_sticks_while_slip_begins_beside_it_is_refused(part):
    message = refused(CORNERS, 0.06213, 0.2169, part, 0.2881)
    assert "a corner of the profile sticks" in message and len(message.split()) <= 40
    assert "give a |Q| nearer to f P" in message
    assert solved(CORNERS, 0.06213, 0.2169, 0.95, 0.2881).check().ok


def test_sliding_is_advised_where_surfaces_beside_the_first_contact_are_the_last_to_slip():
    assert "let them slide" in refused(None, 0.43, 9.0, 0.9)


def test_zones_that_pass_a_corner_under_a_falling_load_exceed_friction_beside_it():
    right = solved(CORNERS, 0.06213, 0.2169, 0.86, 0.2881)
    search, Q = right.tangential_search, 0.865 * right.tangential_load / 0.86
    # Four edges that meet the same conditions as those of the load, with e1 beside the corner
    other = next_to(search, 0.4 * np.array([-1.020514, -0.9945276, 0.1317205, 1.0177226]), Q)
    assert not keeps_friction_law(ShearedContact(search, other.trial, Q, 1.0, 1.0))


@pytest.mark.parametrize(("beta", "friction"), [(0.36, 0.57), (0.3, 0.3)])
def test_a_small_load_is_refused_in_few_trials(monkeypatch, beta, friction):
    found = trials_of(monkeypatch, lambda: solved(None, beta, friction, 0.5).coupled)
    assert trials_of(monkeypatch, lambda: refused(None, beta, friction, 1e-5)) < 20 * found


def almost_flat(beta, friction, part, round_part, half_flat=1.0):
    """A rounded flat whose contact ends this part of its half-flat beyond the flat."""
    profile = sie.RoundedFlat(half_flat, 1.0)
    width = (1.0 + round_part) * half_flat
    constants = {"modulus": 2.0, "dundurs": beta, "friction": friction}
    pressed = sie.solve(sie.Scene(profile=profile, half_width=width, **constants))
    load = pressed.normal_load
    loads = {"normal_load": load, "tangential_load": part * friction * load}
    return sie.solve(sie.Scene(profile=profile, **loads, **constants))


def test_slip_gradient_beside_an_almost_flat_base_is_not_cut_down_to_rounding():
    # 180 panels; 625 while the pressure that they resolve was that on a wider contact, and twice
    # as many with every halving where rounding of that pressure was larger still
    search = almost_flat(beta=0.05, friction=0.07, part=0.3, round_part=3e-6).tangential_search
    assert len(search.gamma.lo) < 350


def test_zones_beside_an_almost_flat_base_are_found_from_incipient_sliding(monkeypatch):
    monkeypatch.setattr(load_path, "_unless_late", lambda search, now, Q: now)
    # The stick zone at 0.99 f P is seven times as wide as the rounded part of the contact.
    solution = almost_flat(0.27, 0.85, part=0.99, round_part=2.5e-4)
    certificate = solution.check()
    assert certificate.ok, str(certificate)
    e1, e2 = zones(solution)[1:3]
    assert e1 < -1.0 < e2


@pytest.mark.slow
@pytest.mark.parametrize("part", [0.3, 0.99])
def test_a_load_beside_an_almost_flat_base_is_refused_where_zones_begin_late(part):
    """Slip opposes Q up to 0.97 f P."""
    with pytest.raises(sie.ContactError, match="let them slide"):
        _ = almost_flat(0.27, 0.85, part=part, round_part=2.5e-4).edges


@pytest.mark.parametrize("part", [1e-6, 1e-3, 0.5])
def test_pressure_is_continuous_a_few_doubles_beside_the_stick_zone(part):
    solution = solved(sie.FromFunction(slope="sinh(x)"), 0.00701, 9.9, part, 0.36)
    for end in solution.stick[0]:
        beside = end + np.spacing(abs(end)) * np.arange(-3.0, 4.0)
        p = solution.pressure(beside)
        assert np.ptp(p) < 1e-5 * p.max()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"normal_load": None, "half_width": 1.0}, "give normal_load"),
        ({"moment": 0.01}, "a moment that is held"),
        ({"bulk_stress": 0.01}, "set bulk_stress = 0"),
    ],
)
def test_what_is_not_solved_is_refused_before_any_work(changes, words):
    with pytest.raises(sie.ContactError, match=words):
        sie.solve(replace(scene(), **changes))


STEEL, TITANIUM = sie.Elastic(210e3, 0.3), sie.Elastic(115e3, 0.32)
ROUGH = 2e-4 * np.cos(np.arange(201) ** 2)


@pytest.mark.parametrize(
    ("profile", "load", "remedy"),
    [
        (sie.Flat(1.0), {"tangential_load": 10.0}, "round it"),
        (sie.Parabola(50.0), {"bulk_stress": 10.0}, "set bulk_stress = 0"),
        (sie.Parabola(50.0), {"moment": 10.0}, "give a tilt"),
        (sie.Polynomial((0.0, 0.0, 0.05, 0.01, 0.002)), {"tangential_load": 10.0}, "friction = 0"),
        (sie.Sampled(X := np.linspace(-2, 2, 201), X**2 / 100 + ROUGH), {}, 'smoothing = "gcv"'),
    ],
)
def test_refusals_of_pairs_are_one_sentence_with_a_remedy(profile, load, remedy):
    pair = {"body": TITANIUM, "indenter": STEEL, "normal_load": 100.0, "friction": 0.5}
    with pytest.raises(sie.ContactError) as refusal:
        _ = sie.solve(sie.Scene(profile=profile, **pair, **load)).stick
    assert remedy in str(refusal.value) and "dundurs = 0" in str(refusal.value)
    assert len(str(refusal.value).split()) <= 40


def test_the_refusal_of_a_path_of_a_pair_is_one_sentence_with_a_remedy():
    scene = sie.Scene(
        profile=sie.Parabola(50.0), body=TITANIUM, indenter=STEEL, normal_load=1.0, friction=0.5
    )
    with pytest.raises(sie.ContactError, match="dundurs = 0") as refusal:
        _ = sie.follow(scene, sie.Path([(100.0, 10.0, 0.0), (100.0, -10.0, 0.0)]))[-1].edges
    assert len(str(refusal.value).split()) <= 40


def test_a_tilted_parabola_is_a_parabola_about_another_axis():
    tilted, upright = sie.solve(replace(scene(), tilt=0.1)), solved()
    assert zones(tilted) == pytest.approx(zones(upright) - 0.1, abs=1e-11)
    assert tilted.tilt == 0.1 and tilted.check().ok
    assert tilted.gap(2.0) == pytest.approx(float(upright.gap(2.1)), rel=1e-9)


def test_a_tangential_load_under_a_profile_that_is_not_symmetric_is_refused():
    with pytest.raises(sie.ContactError, match="set tangential_load = 0"):
        _ = solved(sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.02))).edges


def test_paths_are_refused_with_what_is_missing():
    path = sie.Path([(1.0, 0.1), (1.0, 0.0)])
    with pytest.raises(sie.ContactError, match="load P first, then Q"):
        sie.follow(scene(part=0.0), path)


def test_a_trace_of_a_parabola_has_no_corner_on_its_axis():
    """Its slope jumps there, but only as much as samples are rounded."""
    x = np.linspace(-3.0, 3.0, 61)
    assert solved(sie.Sampled(x, 0.5 * x * x), 0.3, 0.3, 0.3).tangential_search.corners == ()


@pytest.mark.parametrize("part", [0.0, 0.3])
def test_the_gap_far_away_is_what_the_profile_rises(part):
    solution = solved(None, 0.3, 0.3, part)
    with np.errstate(all="raise", under="ignore"):
        gaps = solution.gap(np.array([-1e300, -1e120, 1e120, 1e160]))
    assert gaps[1] == pytest.approx(0.5e240, rel=1e-12) == gaps[2]
    assert gaps[0] == gaps[3] == math.inf
