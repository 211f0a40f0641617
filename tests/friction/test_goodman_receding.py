"""Goodman's approximation where the stick zone recedes at one end while the load grows."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

import sie
from sie.friction.goodman import march
from sie.friction.goodman.receding_flat import Distances, ratio, receding_flat

RATIO = 0.75  # β/f


@lru_cache(maxsize=4)
def solved(part=0.0, load=0.1484, tilt=0.0734):
    return sie.solve(
        sie.Scene(
            profile=sie.Wedge(0.1153),
            modulus=2.0,
            dundurs=0.4775,
            friction=0.3421,
            coupling="goodman",
            normal_load=load,
            tilt=tilt,
            tangential_load=part * 0.3421 * load,
        )
    )


def rates(part):
    """A receding flat, nodes of its stick zone, their weights, and q/f there."""
    flat = receding_flat(RATIO)
    zone = flat.zone(part * flat.natural.e)
    t1, t2 = float(zone.e[0]) - 1.0, 1.0 - float(zone.right_slip[0])
    n = 2000
    turn = 0.5 * np.pi * (np.arange(n) + 0.5) / n
    t = t1 + (t2 - t1) * np.sin(turn) ** 2
    dt = (t2 - t1) * np.sin(2.0 * turn) * 0.5 * np.pi / n
    q = ratio(zone, 1.0, Distances(1.0 + t, 1.0 - t, t - t1, t2 - t)) / (np.pi * np.sqrt(1 - t * t))
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


@pytest.mark.parametrize("part", [0.0, -0.6])
def test_certificate_holds_where_the_stick_zone_of_a_tilted_wedge_recedes(part):
    shear = solved(part).check().shear
    assert shear.ok
    assert shear.residual < 1e-9
    assert shear.equilibrium < 1e-9


def test_a_tilt_to_the_other_side_mirrors_the_receding_stick_zone():
    right, left = solved(), solved(tilt=-0.0734)
    assert left.stick[0] == pytest.approx(tuple(-c for c in right.stick[0][::-1]), rel=1e-7)


def test_a_stick_zone_that_is_not_followed_to_the_end_is_refused_with_the_half_width(monkeypatch):
    monkeypatch.setattr(march, "MOST", 0)
    monkeypatch.setattr(march, "MISSED", 0.0)
    monkeypatch.setattr(march, "ROUGH", 0.0)
    with pytest.raises(sie.ContactError, match=r"followed up to a half-width of .* reduce the"):
        _ = solved(load=0.1).stick


def test_slip_of_a_receding_stick_zone_is_refused():
    with pytest.raises(sie.ContactError, match=r"stick zone receded .* is not computed"):
        solved().slip(0.0)
