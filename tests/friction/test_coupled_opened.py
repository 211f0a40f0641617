"""Dissimilar bodies under P, then Q, while a slip zone is open inside the stick zone."""

from __future__ import annotations

import contextlib
import itertools
import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import sie
from oracles.bonded_edge import missed
from sie.certificate.coupled_shear_check import (
    MARCHED,
    PROMISED,
    _promised,
    sheared_certificate,
)
from sie.friction.coupled import opened_march, opening
from sie.friction.coupled import spreading_march as first_march
from sie.friction.coupled.opened_contact import Opened, OpenedContact, opened_contact
from sie.friction.coupled.opened_gradient import GradientPanel, KeptGradient, between
from sie.friction.coupled.opened_march import OpenedMarch, OpenedPoint
from sie.friction.coupled.opened_rule import beside_rule, zone_rule
from sie.friction.coupled.sheared import ShearedContact
from sie.friction.coupled.sheared_contact import either, found_state
from sie.friction.coupled.spreading_contact import spreading_march
from sie.friction.coupled.spreading_zones import SpreadingPanel
from sie.friction.coupled.zones import Zones
from sie.numerics import chebyshev
from sie.problem.coverage import LargerLoad

MATERIAL = BETA, FRICTION = 0.3, 2.0
GAINED = 0.2  # half-widths
# (γ - γ at the old edge)/s^(1/2 + θ) for what was gained at s, a series in ln s from 1e-6 to 0.25
# half-widths, about as under the parabola, times a factor that one condition fixes
SERIES = (-4.8498, 0.8180, 0.2555, -0.2274, -0.0629, 0.0144, -0.0009, -0.0093, -0.0032)
RANGE = 1e-6, 0.25
GUESS = np.array([0.92, -0.34, -2.24, -4.01, 1.0])  # logarithms of the zones, and the factor


def scene(part: float) -> sie.Scene:
    return sie.Scene(
        profile=sie.Parabola(1.0),
        modulus=2.0,
        dundurs=BETA,
        friction=FRICTION,
        normal_load=1.0,
        tangential_load=part * FRICTION,
    )


@pytest.fixture(scope="module")
def search():
    return sie.solve(scene(0.5)).tangential_search


def march_with(search, factor):
    """A march with a γ that is given."""
    b, power = search.normal.b, 0.5 + search.theta
    cuts = b * np.geomspace(*RANGE, 6)
    at_edge, panels = float(search.gamma(np.array([b]))[0]), []
    for lo, hi in itertools.pairwise(cuts):
        nodes = math.log(lo) + 0.5 * math.log(hi / lo) * (1.0 + chebyshev.points(16))
        y = 2.0 * (nodes - math.log(cuts[0])) / math.log(cuts[-1] / cuts[0]) - 1.0
        shape = np.polynomial.chebyshev.chebval(y, SERIES)
        panels.append(
            GradientPanel(lo, hi, nodes, at_edge + factor * shape * np.exp(power * nodes))
        )
    start = OpenedPoint(0.1 * b, np.log([0.9, 0.77]), 0.0)
    sliding = partial(opening.bounded_sliding, search)
    return OpenedMarch(KeptGradient(search, tuple(panels)), start, np.zeros(2), sliding)


def state_of(search, values, **how):
    march = march_with(search, float(values[4]))
    return march, march.state(GAINED * search.normal.b, values[:4], **how)


@pytest.fixture(scope="module")
def contact(search):
    """The state for such a γ, by Newton's method."""
    values = GUESS
    for _ in range(6):
        now = state_of(search, values)[1].missed[:, 0]
        moved = [state_of(search, values + 1e-6 * unit)[1].missed[:, 0] for unit in np.eye(5)]
        values = values - np.linalg.solve((np.array(moved) - now).T / 1e-6, now)
    march, state = state_of(search, values, fine=True)
    assert np.abs(state.missed[:, 0]).max() < 1e-9
    b, zones, Q = search.normal.b, state.zones, float(state.load[0])
    edges = Zones(*(y - b for y in (zones.x1, zones.h2, zones.e2, zones.x2)))
    point = OpenedPoint(-zones.e0, values[:4], Q)
    return OpenedContact(search, Opened(edges), Q, 1.0, 1.0, march=march, point=point)


def test_zone_rule_integrates_powers_at_both_ends():
    power = -0.3
    rule = zone_rule(1.0, (1e-9, 1e-3), (power, power), np.array([0.2, 0.71]))
    exact = math.gamma(1.0 + power) ** 2 / math.gamma(2.0 + 2.0 * power)
    assert rule.weight @ (rule.left * rule.right) ** power == pytest.approx(exact, rel=1e-13)
    # And what varies next to an end over as short a distance as the first panel
    near = rule.weight @ (rule.left**power / (1e-9 + rule.left))
    # ∫_0^1 x^a/(d + x) dx = -π/sin(πa) d^a - Σ (-d)^n/(n - a)
    exact = -math.pi / math.sin(math.pi * power) * 1e-9**power + 1.0 / power
    assert near == pytest.approx(exact, rel=1e-8)


def test_rule_beside_a_contact_reaches_infinity():
    rule = beside_rule((-1.0, 0.5), (1e-10, 1.0), -0.3)
    n = len(rule.left)
    # ∫_0^∞ y^-a/(1 + y)^(2-a) dy = 1/(1 - a)
    for y, weight in ((rule.left, rule.weight[:n]), (rule.right, rule.weight[n:])):
        assert weight @ (y**-0.3 * (1.0 + y) ** -1.7) == pytest.approx(1.0 / 0.7, rel=1e-12)


def test_polynomials_between_nodes_are_exact_on_and_off_them():
    nodes, x = np.array([-1.0, 0.3, 0.8, 1.7]), np.array([0.3, 0.5, 2.0])
    rows = between(nodes, x)
    np.testing.assert_allclose(rows @ (nodes**3 - nodes), x**3 - x, atol=1e-14)


def test_gradient_goes_on_smoothly_beyond_a_panel_that_is_very_short(search):
    # The slip zone may open just where a panel of the march before ended
    def panel(lo, hi):
        nodes = math.log(lo) + 0.5 * math.log(hi / lo) * (1.0 + chebyshev.points(16))
        return GradientPanel(lo, hi, nodes, np.exp(0.6 * nodes))

    kept = KeptGradient(search, (panel(0.02, 0.06), panel(0.06, 0.06 * (1.0 + 1e-6))))
    s = 0.06 * np.array([1.01, 1.05, 1.1])
    assert kept.gained(s) == pytest.approx(s**0.6, rel=1e-3)


def test_panels_end_where_slip_enters_the_left_half(search):
    # γ under P alone has a kink at 0
    march, c = spreading_march(search), search.normal.c
    ways = np.log([[1.0, 1.0], [0.9 * c, 1.1 * c], [0.3 * c, 0.4 * c]])
    series = np.stack((ways.sum(axis=1), ways[:, 1] - ways[:, 0]), axis=1) / 2.0
    panel = SpreadingPanel(0.2, 0.3, series, False)
    assert panel(np.array([march._entry(panel)]))[1] == pytest.approx(c, rel=1e-12)


def test_both_equations_hold_with_the_gradient_that_was_given(contact):
    certificate = sheared_certificate(contact, replace(scene(0.5), tangential_load=contact.Q), 0.0)
    assert certificate.residual < 1e-12
    assert certificate.force < 1e-12
    assert certificate.shear.residual < 1e-11
    assert certificate.shear.equilibrium < 1e-12
    assert certificate.ok


def test_certificate_is_not_ok_with_another_gradient(contact):
    other = march_with(contact.search, 1.001)
    known = contact.known
    wrong = replace(contact, march=other)
    vars(wrong)["known"] = known
    certificate = sheared_certificate(wrong, replace(scene(0.5), tangential_load=contact.Q), 0.0)
    assert not certificate.ok


def test_what_is_known_from_a_march_is_promised_to_a_millionth_where_more_is_missed(contact):
    assert _promised(contact, 1e-9, PROMISED) == MARCHED
    assert _promised(contact, 1e-11, PROMISED) == PROMISED


def test_strip_of_old_slip_that_is_left_out_counts_as_doubt(contact):
    march = march_with(contact.search, 1.0)
    march.unseen = 3e-8
    assert replace(contact, march=march).doubt == 3e-8


def test_pressure_is_positive_beside_the_strip_that_is_left_out(contact):
    beside = contact.ends[0] + contact.known.zones.strip * np.geomspace(0.1, 1e5, 200)
    turned = replace(contact)
    vars(turned)["known"] = contact.known
    # p + i q turns with ln d: a strip that is wider shows it
    object.__setattr__(turned, "_stuck", lambda u, k: contact._stuck(u, k) - 1e-5)
    assert turned.frame_pressure(beside).min() == 0.0
    assert (contact.frame_pressure(beside)[20:] > 0.0).all()


def test_conditions_of_a_single_stick_zone_hold_with_the_gradient_in_the_slip_zone(contact):
    # By reciprocity, with p̂ and q̂ in closed form: neither p nor q occurs but in γ of [h1, h2]
    search, (x1, h1, h2, e2, x2) = contact.search, contact.ends
    b = search.normal.b

    def gamma(x):
        values = contact.march.kept(np.maximum(x + b, -contact.point.s))
        slips = (x > h1) & (x < h2)
        values[slips] += contact._gain(x[slips])
        return values

    marks = (-b, -search.normal.c, 0.0, h1, h2)
    known = (lambda x: x, gamma)
    loads = (1.0, contact.Q)
    assert np.abs(missed(MATERIAL, (x1, e2, x2), loads, known, marks)).max() < 1e-9
    off = missed(MATERIAL, (x1, e2 + 1e-4, x2), loads, known, marks)
    assert np.abs(off).max() > 1e-6


def test_one_stick_zone_does_not_slip_along_the_other(contact):
    inside, ahead = contact._gained
    slip = inside(inside.cuts) / float(np.abs(ahead(ahead.cuts)).max())
    assert abs(slip[-1]) < 1e-9
    assert slip.min() > -1e-9
    assert slip.max() > 1e-3
    assert contact.least_deficit > -1e-9


def test_slip_is_zero_where_surfaces_stick_that_came_into_contact(contact):
    (x1, h1), (h2, e2) = contact.stick
    assert contact.slip_zones == ((h1, h2, 1.0), (e2, contact.ends[4], 1.0))
    x = np.array([x1 + 1e-3, h1 - 1e-3])
    assert (contact.relative_slip(x) == 0.0).all()
    # What the normal load left stays
    old, normal = np.array([-0.2, 0.1]), contact.search.normal
    before = np.sign(old) * normal.slip(np.abs(old))
    np.testing.assert_allclose(contact.relative_slip(old), before, atol=1e-16)
    assert contact.relative_slip(np.array([-0.8]))[0] > 1e-4


def test_mirror_images_have_the_same_state(contact):
    other = replace(contact, sign=-1.0, flip=1.0)
    x = np.linspace(-0.9, 0.65, 9)
    (p, q), (one, two) = contact.tractions, other.tractions
    np.testing.assert_allclose(one(x), p(x), atol=1e-13)
    np.testing.assert_allclose(two(x), -q(x), atol=1e-12)
    turned = replace(contact, flip=-1.0)
    np.testing.assert_allclose(turned.tractions[0](-x), p(x), atol=1e-13)


def test_what_stays_stuck_at_the_end_of_the_march_is_the_zone_of_one_state(search):
    # x1, h1, h2, e2, x2 of the march with 8 points on a panel, where it is about to end
    x1, h1, *march = -1.062203889, -1.062197237, -0.685428998, -0.009636927, 0.590287797
    found = search.found(0.754473530322 * search.limit, arrived=True).edges
    assert found[1:] == pytest.approx(march, abs=2e-7)
    # One state errs by a sixth of what still sticks
    assert 0.1 < (x1 - found[0]) / (h1 - x1) < 0.2


@pytest.fixture(scope="module")
def coarse(search):
    """A march with few points from late on."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(first_march, "START", 1e-2)
        patch.setattr(first_march, "DECAYED", 1e-5)
        patch.setattr(opened_march, "POINTS", 4)
        patch.setattr(opening, "ALIKE", 1e-4)
        march = spreading_march(search)
        march.n = 5
        with contextlib.suppress(LargerLoad):
            march.marched(0.13 * search.limit)
        return opened_contact(search, 0.13 * search.limit, march)


def test_a_zone_opens_at_the_old_edge_and_grows_both_ways(coarse):
    # The finest march opens it at 0.124105 f P, where 0.0800257 b was gained
    start, b = coarse.march.start, coarse.search.normal.b
    assert start.s / b == pytest.approx(0.0800257, abs=1e-4)
    assert start.Q / coarse.search.limit == pytest.approx(0.124105, abs=2e-4)
    x1, h1, h2, e2, x2 = coarse.ends
    assert h1 < -b < h2
    assert (x1, e2, x2) == pytest.approx((-0.8342850, 0.6130983, 0.7206086), abs=1e-6)
    assert (h1, h2) == pytest.approx((-0.770315, -0.770150), abs=2e-5)


def test_loads_beyond_the_end_of_the_march_have_the_zones_of_one_state(search, monkeypatch):
    ended, Q = march_with(search, 1.0), 0.9 * search.limit
    ended.ended = True
    monkeypatch.setattr("sie.friction.coupled.opened_contact.marched", lambda *_: ended)
    state = opened_contact(search, Q, spreading_march(search))
    assert type(state) is ShearedContact
    assert (state.trial.edges == search.found(Q, arrived=True).edges).all()
    with pytest.raises(sie.ContactError, match="let the bodies slide"):
        search.found(Q)


def test_a_march_that_fails_is_refused_with_its_reason(search, monkeypatch):
    def fails(*_):
        raise sie.ContactError("the march ends")

    def beyond(*_):
        raise LargerLoad("a slip zone is open")

    monkeypatch.setattr("sie.friction.coupled.opened_contact.marched", fails)
    below = either(beyond, lambda search, Q: opened_contact(search, Q, spreading_march(search)))
    with pytest.raises(sie.ContactError, match="opens at the old edge, and the march ends"):
        found_state(search, 0.3 * search.limit, below)


def test_a_wide_strip_of_old_slip_is_refused_with_its_width(search, monkeypatch):
    march = spreading_march(search)
    monkeypatch.setattr(opening, "_opening", lambda *_: 0.06)
    monkeypatch.setattr(march.history, "zones", lambda s: (0.1, 0.05))
    monkeypatch.setattr(march.history, "strip_width", lambda *_: 1e-4)
    with pytest.raises(sie.ContactError, match=r"a zone of the width 0\.0001 next to the edge"):
        opening.opened_march(search, march)
