"""Where an edge lies on or beside a break of the slope: where h'' jumps, or h' itself.

The truth is `validation.topics.kinks`: the conditions of the edges in 100 digits, with exact
integrals of polynomial pieces.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sie
from sie.contact import edge_refinement, edges
from sie.contact.edges import Search
from validation.kinked_contacts import ASKED, KINDS, Shape, Trial, drawn, mp
from validation.topics import kinks

EPS = float(np.finfo(float).eps)


def straight(breaks, rows):
    """A profile of polynomial pieces in x, with its exact slope."""
    exact = tuple((mp.zero, tuple(map(mp.mpf, row))) for row in rows)
    return Shape(sie.Piecewise(breaks, rows), tuple(map(mp.mpf, breaks)), exact)


FLAT = Shape(
    sie.RoundedFlat(1.0, 1.0), (-mp.one, mp.one),
    ((-mp.one, (mp.zero, mp.one)), (mp.zero, (mp.zero,)), (mp.one, (mp.zero, mp.one)))
)  # fmt: skip
UNEQUAL = straight(
    [0.024680404604208395, 1.3439257285642596, 1.78238721606423],
    [
        [2.019152511639525, 0.1749794590662676], [2.019685402471703, 0.15338780201187047],
        [-1.209095426825833, 2.555887256164669], [-7.155678871675851, 5.895372269565693],
    ],
)  # fmt: skip
THIN_RIM = sie.Scene(
    profile=FLAT.profile, modulus=1.0, normal_load=0.04299531364007295, tilt=0.02583284228002516
)
STEEP = sie.Scene(
    profile=UNEQUAL.profile, modulus=1.0, normal_load=0.3357363415498418, tilt=-2.419532543582873
)


def test_an_edge_that_leaves_a_flat_base_beside_a_thin_rounded_edge_is_found():
    """Newton's steps there shrink by a third only."""
    found = kinks.outcome(Trial(FLAT, THIN_RIM, 1.0, 0.0))
    assert not found.refused
    assert max(found.edges, found.pressure) <= kinks.PROMISE


def test_an_edge_beside_a_kink_is_right_to_rounding():
    found = kinks.outcome(Trial(UNEQUAL, STEEP, UNEQUAL.profile.breaks[-1], 0.0))
    assert max(found.edges, found.pressure) <= kinks.PROMISE


def test_a_moment_is_met_where_tilting_moves_the_contact_across_a_straight_part_of_the_profile():
    """Newton's steps for the tilt run to and fro between both sides of it."""
    breaks = (-0.9414274571584791, 1.0774521785565838, 1.375368804641461, 1.3936751617452114)
    rows = (
        (-0.619583920921905, 0.375790832873566), (-0.8172227922082222, 0.1658555162610117),
        (-0.6385214048871684,),
        (-4.193920775974172, 2.5850516305798035), (-4.373284932726633, 2.7137503127948572),
    )  # fmt: skip
    moment = 0.0007652261035979348
    given = {
        "profile": sie.Piecewise(breaks, rows),
        "modulus": 0.6455188178465567,
        "normal_load": 0.0005699239351927894,
    }
    solution = sie.solve(sie.Scene(**given, moment=moment))
    assert solution.moment == pytest.approx(moment, rel=1e-13)
    assert solution.check().ok


def test_a_search_that_begins_far_from_its_tilt_is_not_barred_by_the_smaller_rounding_there():
    """Untilted, the slope is hundreds of times as large, and its rounding too: in units of that no
    contact came nearer, and the answer by several patches was wrong by 1e-5 of the peak.
    """
    found = kinks.outcome(drawn(1_774_421_137, "quadratic pieces, jumps of h'", "load, moment"))
    assert max(found.edges, found.pressure) <= kinks.PROMISE


def test_the_last_step_follows_a_break_so_close_that_newtons_leaves_a_twentieth():
    """The step is a fifth of the distance from the break; the pressure was off by 2e-11."""
    found = kinks.outcome(drawn(3281012, "quadratic pieces, jumps of h'", "half-width, tilt"))
    assert max(found.edges, found.pressure) <= kinks.PROMISE


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("kind", "asked"), ASKED, ids=lambda v: v.replace(" ", "-"))
@settings(max_examples=4)
@given(seed=st.integers(0, 2**32))
def test_no_edge_on_a_kink_is_refused_or_wrong(kind, asked, seed):
    found = kinks.outcome(drawn(seed, kind, asked))
    assert not found.refused
    assert found.edges <= kinks.PROMISE
    assert found.pressure <= kinks.PROMISE


@pytest.mark.slow
@given(seed=st.integers(0, 2**32), kind=st.sampled_from([*KINDS]), inside=st.booleans())
@settings(max_examples=30)
def test_the_search_ends_within_its_bound_at_the_rounding_of_its_residual(seed, kind, inside):
    """From a contact that is 20 % too narrow or too wide on both sides."""
    trial = drawn(seed, kind, "load, tilt")
    search = Search(trial.scene.profile.pieces.tilted(trial.scene.tilt), 0.5 * trial.scene.Estar)
    settled = sie.solve(trial.scene).normal.edges.contact
    target, evaluations = trial.scene.normal_load / search.half_modulus, []

    def evaluate(contact):
        evaluations.append(contact)
        return search.integrals(contact)

    newton = edge_refinement.Polish(search.slope, evaluate)
    off = (0.2 if inside else -0.2) * settled.r
    start = settled.moved(off, -off)
    first = search.integrals(start)
    _, k, done = newton.both(start, target, False, search.touch())
    # On a straight part there is no derivative.
    if trial.scene.profile.convex and min(first.JL, first.JR) > 0.0:
        assert done
    if done:
        rounding = newton.rounding(evaluations[-1], k, target)
        r = evaluations[-1].r
        assert abs(r * (k.I1 - k.I0) - target) <= rounding[0]
        assert abs(r * (k.I1 + k.I0) - target) <= rounding[1]
    assert len(evaluations) <= edge_refinement.MAX_POLISHING


@pytest.mark.slow
def test_the_rounding_of_a_residual_is_its_difference_from_exact_integrals():
    """Two-sided: within the rounding allowed for, and not below a hundredth of it everywhere."""
    shares = []
    for seed in range(40):
        trial = drawn(seed, "straight pieces", "load, tilt")
        slope = trial.scene.profile.pieces.tilted(trial.scene.tilt)
        contact = sie.solve(trial.scene).normal.edges.contact
        k = Search(slope, 1.0).integrals(contact)
        exact = trial.shape.contact(
            mp.mpf(contact.x1) + mp.mpf(contact.tail1),
            mp.mpf(contact.x2) + mp.mpf(contact.tail2),
            mp.mpf(trial.scene.tilt),
        )
        I0, I1 = exact.integral((1,), (0, 1))
        allowed = [
            (edge_refinement.ROUNDINGS * size, sign) for size, sign in ((k.size1, -1), (k.size2, 1))
        ]
        shares += [
            float(abs(k.I1 + sign * k.I0 - (I1 + sign * I0))) / most for most, sign in allowed
        ]
    assert max(shares) <= 1.0
    assert max(shares) >= 0.01


def test_a_contact_far_from_the_origin_keeps_its_half_width():
    """P = π E* r²/(4 R): the edges are doubles near 1e6, their distance is not."""
    E, R, P = 3.0, 2.0, 1e-6
    solution = sie.solve(sie.Scene(profile=sie.Parabola(R).shifted(1e6), modulus=E, normal_load=P))
    assert solution.normal.edges.contact.r == pytest.approx(
        np.sqrt(4 * P * R / (np.pi * E)), rel=1e-13
    )


def test_a_moment_given_is_met_as_well_as_the_tilt_that_has_it():
    """The edges under (P, tilt), asked again with P and the moment that these have."""
    for tilt in (0.02, -0.05, 0.11):
        tilted = sie.solve(
            sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.2, tilt=tilt)
        )
        turned = tilted.with_(moment=tilted.moment)
        assert turned.tilt == pytest.approx(tilt, rel=1e-13)
        assert turned.edges == pytest.approx(tilted.edges, rel=1e-13)


def test_corners_of_a_slope_are_those_of_its_pieces():
    slope = UNEQUAL.profile.pieces
    for j, b in enumerate(UNEQUAL.breaks, start=1):
        left, right = UNEQUAL.rows[j - 1][1], UNEQUAL.rows[j][1]
        jump, kink = slope.corner(float(b))
        assert jump == pytest.approx(
            float(right[0] - left[0] + (right[1] - left[1]) * b), abs=64 * EPS
        )
        assert kink == pytest.approx(float(right[1] - left[1]), rel=4 * EPS)


def test_the_edges_move_with_the_load_by_their_integrals():
    """P/(G r J) per relative change of the load."""
    scene = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=2.0, normal_load=0.2, tilt=0.03)
    light, heavy = (
        sie.solve(scene).with_(normal_load=0.2 * (1.0 + change)).normal.edges.contact
        for change in (-1e-5, 1e-5)
    )
    contact = sie.solve(scene).normal.edges.contact
    k = Search(scene.profile.pieces.tilted(scene.tilt), 1.0).integrals(contact)
    moved = (light.x1 - heavy.x1) / 2e-5, (heavy.x2 - light.x2) / 2e-5
    assert 0.2 / (contact.r * k.JL) == pytest.approx(moved[0], rel=1e-4)
    assert 0.2 / (contact.r * k.JR) == pytest.approx(moved[1], rel=1e-4)


TINY = straight(
    [29.238249670088848],
    [[-0.04199447921947186, 0.0010454147804437085], [-0.05185657725793592, 0.0013828587081438938]],
)


def test_a_contact_much_narrower_than_the_first_guess_is_found_beside_a_kink():
    """The left edge lies right of the middle of the contact from which both edges are polished."""
    scene = sie.Scene(
        profile=TINY.profile,
        modulus=0.8,
        normal_load=2.7856825138523804e-18 * 0.8 / 0.8093449815863573,
        tilt=0.011428380927743514,
    )
    # The pieces meet but for rounding.
    meeting = replace(TINY, jumps=frozenset(TINY.profile.breaks))
    found = kinks.outcome(Trial(meeting, scene, 29.238249670088848, 0.0))
    assert not found.refused
    assert found.edges <= kinks.PROMISE


def test_a_half_width_under_a_large_tilt_lies_where_the_slope_has_risen_to_it():
    profile = sie.FromFunction(slope=lambda x: np.sign(x) * np.abs(x) ** 1.5, breaks=(0.0,))
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=1.0, tilt=-1e20))
    assert solution.centre == pytest.approx(1e20 ** (2 / 3), rel=1e-12)


@pytest.mark.slow(but=15)
@pytest.mark.parametrize("moment", [-1e16, 1e20, 1e100, -1e200])
@pytest.mark.parametrize(
    "profile", [sie.Parabola(1.0), sie.RoundedFlat(0.5, 1.0), sie.Wedge(0.3), sie.Power(2.5, 0.75)]
)
def test_a_load_beyond_where_doubles_show_the_slope_is_refused_at_once(
    profile, moment, monkeypatch
):
    evaluated, right = [], edges.edge_integrals
    monkeypatch.setattr(
        edges, "edge_integrals", lambda *asked, **how: evaluated.append(1) or right(*asked, **how)
    )
    with pytest.raises(sie.ContactError):
        _ = sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=0.3, moment=moment)).edges
    assert len(evaluated) <= 5000


def test_a_load_where_the_slope_of_a_polynomial_is_no_double_is_refused_at_once(monkeypatch):
    evaluated, right = [], edges.edge_integrals
    monkeypatch.setattr(
        edges, "edge_integrals", lambda *asked, **how: evaluated.append(1) or right(*asked, **how)
    )
    lopsided = sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6))
    with pytest.raises(sie.ContactError):
        _ = sie.solve(sie.Scene(profile=lopsided, modulus=1.0, normal_load=0.3, moment=1e200)).edges
    assert len(evaluated) <= 5000
