"""Edges on breaks of the slope, against conditions in 100 digits (validation.topics.kinks)."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import scene

import sie
from sie.contact import edges
from validation.kinked_contacts import ASKED, Shape, Trial, drawn, mp
from validation.topics import kinks


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
THIN_RIM = scene(FLAT.profile, normal_load=0.04299531364007295, tilt=0.02583284228002516)
STEEP = scene(UNEQUAL.profile, normal_load=0.3357363415498418, tilt=-2.419532543582873)


TINY = straight(
    [29.238249670088848],
    [[-0.04199447921947186, 0.0010454147804437085], [-0.05185657725793592, 0.0013828587081438938]],
)
NARROW = sie.Scene(
    profile=TINY.profile,
    modulus=0.8,
    normal_load=2.7856825138523804e-18 * 0.8 / 0.8093449815863573,
    tilt=0.011428380927743514,
)


JUMPS = "quadratic pieces, jumps of h'"
TRIALS = {
    # Newton's steps shrink by a third only.
    "off a flat base beside a thin rounded edge": Trial(FLAT, THIN_RIM, 1.0, 0.0),
    "beside a kink": Trial(UNEQUAL, STEEP, UNEQUAL.profile.breaks[-1], 0.0),
    # Untilted, the slope is hundreds of times as large, and its rounding too: in units of that no
    # contact came nearer.
    "far from the tilt where the search begins": drawn(1_774_421_137, JUMPS, "load, moment"),
    # The step of Newton's method is a fifth of the distance from the break.
    "where the last step ends near a break": drawn(3281012, JUMPS, "half-width, tilt"),
    # The pieces meet but for rounding; the left edge lies right of the middle of the first guess.
    "much narrower than the first guess": Trial(
        replace(TINY, jumps=frozenset(TINY.profile.breaks)), NARROW, 29.238249670088848, 0.0
    ),
}


@pytest.mark.parametrize("trial", TRIALS.values(), ids=TRIALS)
def test_an_edge_that_was_hard_to_find_is_right_to_rounding(trial):
    found = kinks.outcome(trial)
    assert not found.refused
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


every_kind = pytest.mark.parametrize(("kind", "asked"), ASKED, ids=lambda v: v.replace(" ", "-"))


@pytest.mark.slow(but=1)
@every_kind
@settings(max_examples=4)
@given(seed=st.integers(0, 2**32))
def test_no_edge_on_a_kink_is_wrong(kind, asked, seed):
    """One of some 500 is refused: its patches do not settle."""
    found = kinks.outcome(drawn(seed, kind, asked))
    assert found.edges <= kinks.PROMISE
    assert found.pressure <= kinks.PROMISE


@pytest.mark.slow(but=1)
@every_kind
def test_edges_on_kinks_are_not_refused(kind, asked):
    """6474 and 6491: steps of Newton's method that go to and fro over a kink by 1e-3 of a patch."""
    for seed in (0, 1, 2, 6474, 6491):
        assert not kinks.outcome(drawn(seed, kind, asked)).refused


def test_a_contact_far_from_the_origin_keeps_its_half_width():
    """P = π E* r²/(4 R): the edges are doubles near 1e6, their distance is not."""
    E, R, P = 3.0, 2.0, 1e-6
    solution = sie.solve(sie.Scene(profile=sie.Parabola(R).shifted(1e6), modulus=E, normal_load=P))
    assert solution.normal.edges.contact.r == pytest.approx(
        np.sqrt(4 * P * R / (np.pi * E)), rel=1e-13
    )


def test_a_half_width_under_a_large_tilt_lies_where_the_slope_has_risen_to_it():
    profile = sie.FromFunction(slope=lambda x: np.sign(x) * np.abs(x) ** 1.5, breaks=(0.0,))
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=1.0, tilt=-1e20))
    assert solution.centre == pytest.approx(1e20 ** (2 / 3), rel=1e-12)


BEYOND = [(sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6)), 1e200)]
BEYOND += [
    (profile, moment)
    for profile in (
        sie.Parabola(1.0), sie.RoundedFlat(0.5, 1.0), sie.Wedge(0.3), sie.Power(2.5, 0.75)
    )
    for moment in (-1e16, 1e100)
]  # fmt: skip


@pytest.mark.slow(but=7)
@pytest.mark.parametrize(("profile", "moment"), BEYOND)
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
