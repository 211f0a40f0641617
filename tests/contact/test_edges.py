"""Where contact begins and ends, what it carries, and which edges are sharp."""

import numpy as np
import pytest
import strategies
from hypothesis import given

import sie
from oracles.normal_contact import mp
from validation.cases import CASES, SHARP_CASES, Case, exact, solved

PROMISE = 1e-13


@pytest.mark.slow(but=9)
@pytest.mark.parametrize("case", CASES, ids=str)
def test_edges_load_and_moment_agree_with_the_40_digit_reference(case: Case):
    solution, truth = solved(case), exact(case)
    contact = solution.normal.edges.contact
    assert abs(mp.mpf(contact.x1) + mp.mpf(contact.tail1) - truth.x1) <= PROMISE * truth.r
    assert abs(mp.mpf(contact.x2) + mp.mpf(contact.tail2) - truth.x2) <= PROMISE * truth.r
    assert abs(solution.normal_load - truth.P) <= PROMISE * truth.P
    assert abs(solution.moment - truth.M) <= PROMISE * truth.P * truth.r


@pytest.mark.parametrize("case", CASES, ids=str)
def test_an_edge_is_sharp_where_the_indenter_ends_and_only_there(case: Case):
    solution = solved(case)
    assert solution.sharp == case.sharp
    for edge, end, sharp in zip(solution.edges, case.profile.domain, case.sharp, strict=True):
        assert (edge == end) == sharp


def test_a_tilted_wedge_has_the_contact_of_its_two_flanks():
    """Flanks -α and β: the tip at sin φ0 = π/2 (α - β)/(α + β), P = E*/2 r (α + β) cos φ0."""
    left, right, P = 0.4, 0.6, 0.3
    solution = sie.solve(sie.Scene(profile=sie.Wedge(0.5), modulus=1.0, normal_load=P, tilt=0.1))
    tip = 0.5 * np.pi * (right - left) / (right + left)
    r = P / (0.5 * (left + right) * np.cos(tip))
    assert solution.half_width == pytest.approx(r, rel=PROMISE)
    assert solution.centre == pytest.approx(-r * np.sin(tip), rel=PROMISE)


def test_a_tilted_flat_lifts_off_at_the_moment_that_makes_one_edge_smooth():
    """p = (P + 2 M x/b²)/(π w): complete while |M| < P b/2, tilt = -4 M/(π E* b²)."""
    complete = sie.solve(
        sie.Scene(profile=sie.Flat(2.0), modulus=3.0, normal_load=1.0, moment=0.999)
    )
    assert complete.sharp == (True, True)
    assert complete.tilt == pytest.approx(-4 * 0.999 / (np.pi * 3.0 * 4.0), rel=PROMISE)
    lifted = complete.with_(moment=1.001)
    assert lifted.sharp == (False, True)
    assert lifted.half_width < 2.0


def test_a_half_width_is_met_to_the_last_digit():
    for profile in (
        sie.Parabola(1.0),
        sie.RoundedFlat(0.1, 1.0),
        sie.Piecewise((0.0,), ((0.0, 1.0), (0.0, 3.0))),
    ):
        assert sie.solve(
            sie.Scene(profile=profile, modulus=1.0, half_width=0.3)
        ).half_width == pytest.approx(0.3, rel=1e-15)


@pytest.mark.slow
@given(strategies.scenes())
def test_the_contact_grows_with_the_load(scene):
    light, heavy = sie.solve(scene), sie.solve(scene).with_(normal_load=1.25 * scene.normal_load)
    (a1, a2), (b1, b2) = light.edges, heavy.edges
    assert b1 <= a1
    assert a2 <= b2
    assert (a1 - b1) + (b2 - a2) > 0 or all(light.sharp)


@pytest.mark.parametrize("case", [c for c in SHARP_CASES if all(c.sharp)], ids=str)
def test_a_sharp_edge_is_square_root_singular_with_the_strength_that_the_load_leaves(case: Case):
    """p sqrt(distance) tends to a constant, the one of the reference."""
    solution, truth = solved(case), exact(case)
    for edge, inwards in zip(solution.edges, (1.0, -1.0), strict=True):
        d = 2.0**-20
        x = edge + inwards * d
        assert float(solution.pressure(x)) == pytest.approx(float(truth.pressure(x)), rel=1e-12)
        assert solution.pressure(edge) == np.inf
