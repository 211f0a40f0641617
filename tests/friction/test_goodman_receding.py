"""Goodman's approximation where the stick zone recedes at one end while the load grows."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

import sie
from sie.friction.goodman.proportion import Proportion
from sie.friction.goodman.receding_flat import Distances, ratio, receding_flat

RATIO = 0.75  # β/f


@lru_cache(maxsize=4)
def solved(part=0.0, load=0.1484, tilt=0.0734, **other):
    scene = {
        "profile": sie.Wedge(0.1153),
        "modulus": 2.0,
        "dundurs": 0.4775,
        "friction": 0.3421,
        "coupling": "goodman",
        "normal_load": load,
        "tilt": tilt,
        "tangential_load": part * other.get("friction", 0.3421) * load,
    }
    return sie.solve(sie.Scene(**(scene | other)))


def rates(part):
    """A receding flat, nodes of its stick zone, their weights, and q/f there."""
    flat = receding_flat(RATIO)
    zone = flat.zone(part * float(flat.natural.e[0]))
    t1, t2 = float(zone.e[0]) - 1.0, 1.0 - float(zone.right_slip[0])
    n = 2000
    turn = 0.5 * np.pi * (np.arange(n) + 0.5) / n
    t = t1 + (t2 - t1) * np.sin(turn) ** 2
    dt = (t2 - t1) * np.sin(2.0 * turn) * 0.5 * np.pi / n
    q = ratio(zone, Distances(1.0 + t, 1.0 - t, t - t1, t2 - t)) / (np.pi * np.sqrt(1 - t * t))
    return t1, t2, t, dt, q


@pytest.mark.parametrize("part", [0.9, 0.5, 0.01])
def test_rates_of_a_receding_flat_have_no_resultant(part):
    t1, t2, _, dt, q = rates(part)
    slip = (np.arccos(t2) - np.arccos(-t1)) / np.pi
    # The midpoint rule errs by 6e-7 at most, where the slip zone is narrow
    assert q @ dt + slip == pytest.approx(0.0, abs=2e-6)


@pytest.mark.parametrize("part", [0.9, 0.5, 0.01])
def test_rates_of_a_receding_flat_leave_the_slip_gradient_in_stick(part):
    t1, t2, t, dt, q = rates(part)
    turn = 0.5 * np.pi * np.array([500, 1000, 1700]) / len(t)
    x = t1 + (t2 - t1) * np.sin(turn) ** 2
    inner = (q * dt / (x[:, None] - t)).sum(axis=1) / np.pi
    # Beside the stick zone t = sin a, and p dt = da/π
    a, w = np.polynomial.legendre.leggauss(60)

    def beside(lo, hi):
        place = 0.5 * (lo + hi) + 0.5 * (hi - lo) * a
        return 0.5 * (hi - lo) / np.pi**2 * (w / (x[:, None] - np.sin(place))).sum(axis=1)

    edge = 0.5 * np.pi
    outer = beside(np.arcsin(t2), edge) - beside(-edge, np.arcsin(t1))
    pressure = 1.0 / (np.pi * np.sqrt(1.0 - x * x))
    assert inner + outer == pytest.approx(-RATIO * pressure, rel=1e-5)


def test_receding_end_and_shear_of_a_tilted_wedge_are_those_of_a_grid():
    solution = solved()
    (x1, x2), (c1, c2) = solution.edges, solution.stick[0]
    m, r = 0.5 * (x1 + x2), 0.5 * (x2 - x1)
    # 320 cells of the printed equations in 320 increments of the load: cells of 0.00625
    assert (c1 - m) / r == pytest.approx(-0.3875, abs=0.007)
    assert (c2 - m) / r == pytest.approx(0.79375, abs=0.007)


# A wedge, slopes that jump by 1 : 0.1, and slopes in x² of 1 : 0.05: dP/dr in proportion to r^s
UNEVEN = sie.Piecewise((-30.0, 0.0, 30.0), ((-0.2,), (0.02,)))
SQUARES = sie.Piecewise((-30.0, 0.0, 30.0), ((0.0, 0.0, -1.0), (0.0, 0.0, 0.05)))


@pytest.mark.parametrize("part", [0.0, -0.6, 0.999])
@pytest.mark.parametrize(
    "other",
    [
        {},
        {"profile": UNEVEN, "tilt": 0.0},
        {"profile": SQUARES, "tilt": 0.0},
        {"dundurs": 0.4, "friction": 0.02},
    ],
)
def test_certificate_holds_where_a_stick_zone_recedes_in_proportion(part, other):
    solution = solved(part, **other)
    shear = solution.check().shear
    assert "receded" in shear.kind
    assert shear.ok
    # 1e-13 at most is found, 1e-10 is promised
    assert shear.residual < 1e-11
    assert shear.equilibrium < 1e-11


@pytest.mark.parametrize("friction", [0.05, 0.5, 1.2])
def test_certificate_holds_under_a_tilted_flat_of_which_one_corner_touches(friction):
    solution = solved(profile=sie.Flat(1.0), tilt=0.2, dundurs=0.4, friction=friction)
    (x1, x2), (c1, c2) = solution.edges, solution.stick[0]
    assert x1 == -1.0
    assert x1 < c1 < c2 < x2 < 1.0
    shear = solution.check().shear
    assert shear.ok
    assert shear.residual < 1e-11
    # 1e-9 of the force where the slip zone at the corner is 3e-5 of the half-width
    assert shear.equilibrium < 1e-8


def test_receding_end_and_shear_at_a_corner_are_those_of_a_grid():
    given = {"dundurs": 0.3, "friction": 0.15, "load": 0.02, "tilt": -0.05}
    solution = solved(profile=sie.Flat(1.0), **given)
    (x1, x2), (c1, c2) = solution.edges, solution.stick[0]
    m, r = 0.5 * (x1 + x2), 0.5 * (x2 - x1)
    # 320 cells of the printed equations in 320 increments of the load, of the mean p 0.1
    assert (c1 - m) / r == pytest.approx(0.00625, abs=0.007)
    assert (c2 - m) / r == pytest.approx(0.8375, abs=0.007)
    q = solution.shear(m + r * np.array([-0.5, 0.0, 0.2])) * 0.2 * r / 0.02
    assert q == pytest.approx([-0.00551329, -0.0095494, -0.0104539], rel=4e-4)


def test_stick_zone_next_to_a_corner_of_a_tilted_flat_is_refused():
    with pytest.raises(sie.ContactError, match=r"nearer than 1e-07 of the half-width"):
        _ = solved(profile=sie.Flat(1.0), tilt=0.2, dundurs=0.04, friction=0.5).stick


@pytest.mark.parametrize("part", [0.0, -0.4])
def test_wedge_with_one_side_almost_parallel_to_the_body_is_solved(part):
    shear = solved(part, tilt=0.1153 * 0.99).check().shear
    assert shear.ok
    assert shear.residual < 1e-11


def test_certificate_fails_where_the_receding_end_is_wrong(monkeypatch):
    right = Proportion(receding_flat(0.4775 / 0.3421), 0.8, 0.0).advance
    monkeypatch.setattr(Proportion, "advance", right * 1.01)
    shear = solved(load=0.2).check().shear
    assert not shear.ok
    assert shear.residual > 1e-5


@pytest.mark.parametrize("ratio_", [0.5, 1.4, 20.0, 300.0])
@pytest.mark.parametrize("beyond", [0.3, 0.9, 1.0 - 1e-9])
def test_shear_from_both_ends_of_the_stick_zone_is_one(ratio_, beyond):
    flat = receding_flat(ratio_)
    k, rest = float(flat.natural.k[0]), float(flat.natural.e[0])
    growth = Proportion(flat, k + beyond * rest, 0.0)
    zone = growth.zone
    # q = f p less than the limit at t2 and more than that at t1: both differ by 2 f p in all
    first, second = growth.stick
    middle = 0.5 * (second - first)
    below, at_first = growth.lack(np.array([middle * (1 - 1e-12)]), np.array([middle]))
    above, at_second = growth.lack(np.array([middle]), np.array([middle * (1 - 1e-12)]))
    assert at_first[0] and not at_second[0]
    # p under a tilted wedge, of the mean C
    nu, place = growth.turn, first + middle
    t, off = place - nu, (1.0 - nu) * (1.0 + nu)
    root = np.sqrt(off * (1.0 - t) * (1.0 + t))
    p = np.log((1.0 + t * nu + root) / place) / (np.pi * np.sqrt(off))
    assert float(zone.e[0]) == pytest.approx(1.0 - growth.turn + first, rel=1e-12)
    assert below[0] + above[0] == pytest.approx(2.0 * p, rel=1e-9)


def test_a_tilt_to_the_other_side_mirrors_the_receding_stick_zone():
    right, left = solved(), solved(tilt=-0.0734)
    assert left.stick[0] == pytest.approx(tuple(-c for c in right.stick[0][::-1]), rel=1e-12)
    x = np.linspace(*right.edges, 41)[1:-1]
    assert left.shear(-x) == pytest.approx(-right.shear(x), abs=1e-12)


def test_a_rounded_tip_of_a_tilted_wedge_is_not_taken_as_in_proportion():
    # The curved part is a millionth of the contact
    tip = sie.Piecewise((-30.0, -1e-6, 1e-6, 30.0), ((-0.2,), (-0.09, 1.1e5), (0.02,)))
    with pytest.raises(sie.ContactError, match=r"recedes at one end is not found beyond"):
        _ = solved(profile=tip, tilt=0.0).stick


def test_slip_of_a_receding_stick_zone_is_refused():
    with pytest.raises(sie.ContactError, match=r"stick zone receded .* is not computed"):
        solved().slip(0.0)
