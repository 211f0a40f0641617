"""Goodman's approximation where the stick zone recedes and growth is not in proportion."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

import sie
from sie.certificate.shear_check import goodman_certificate
from sie.friction.goodman.history import lack
from sie.friction.goodman.receding_flat import receding_flat
from sie.friction.goodman.root_table import RootTable
from sie.friction.goodman.spells import receding
from sie.friction.goodman.zone_table import zone_table


@lru_cache(maxsize=8)
def solved(load=0.03, **other):
    """A tilted rounded flat: the stick zone recedes from a load of 0.0266 on."""
    scene = {
        "profile": sie.RoundedFlat(0.5, 1.0),
        "modulus": 2.0,
        "dundurs": 0.3,
        "friction": 0.25,
        "coupling": "goodman",
        "normal_load": load,
        "tilt": 0.05,
    }
    return sie.solve(sie.Scene(**(scene | other)))


@pytest.mark.parametrize("ratio", [0.75, 3.0])
def test_table_of_stick_zones_is_that_of_the_receding_flat(ratio):
    table, flat = zone_table(ratio), receding_flat(ratio)
    e = table.e0 * np.array([0.01, 0.1, 0.49, 0.51, 0.9, 0.999])
    right = [flat.zone(one).right_slip[0] for one in e.tolist()]
    assert table.zone(e, table.ratio(e)).right_slip == pytest.approx(right, rel=1e-12)


def test_receding_end_begins_with_a_quarter_of_the_way_of_the_advancing_one():
    spells = solved().tangential.before.spells
    first = next(spell for spell in spells if spell.side)
    r, m, end = (
        np.polynomial.chebyshev.chebval([-1.0, -0.9], c)
        for c in (first.series[0], first.series[1], first.receding)
    )
    way = (m - first.zones.k * r)[1] - end[0]
    # 0.05 of the part behind the onset the next term is about 1e-4
    assert (end[1] - end[0]) / way == pytest.approx(0.25, abs=1e-3)


def test_places_slip_as_the_receding_end_arrives_also_between_the_points_of_the_march():
    before = solved().tangential.before
    spells, peak = before.spells, before.step.pressure(np.array([sum(before.stick) / 2]))[0]
    n = next(i for i, spell in enumerate(spells) if spell.side)
    for i in range(n, len(spells)):
        part = (*spells[:i], spells[i].until(0.37))
        u = np.array([np.polynomial.chebyshev.chebval(0.37, spells[i].receding)])
        # 2e-9 at most; what a part that ends elsewhere adds cancels to it
        assert abs(lack(part, u, 1.0)[0]) < 1e-7 * peak


def test_both_integrals_over_the_history_make_the_pressure():
    before = solved().tangential.before
    lo, hi = before.stick
    x = lo + (hi - lo) * np.array([0.01, 0.2, 0.5, 0.8, 0.99])
    V, U = (lack(before.spells, x - before.touch, sign) for sign in (1.0, -1.0))
    twice = 2.0 * before.step.pressure(x)
    assert pytest.approx(twice, rel=1e-11) == V + U


def test_stick_zone_and_shear_are_those_of_a_grid():
    solution = solved(0.2)
    (c1, c2), cell = solution.stick[0], 1.8 / 320
    # 320 cells and increments of the load, beginning at -0.9; the shear there is of the first order
    assert (c1, c2) == pytest.approx((-0.5625, 0.320625), abs=1.1 * cell)
    q = lack(
        solution.tangential.before.spells, np.array([0.0]) - solution.tangential.before.touch, 1
    )
    p = solution.pressure(0.0)
    assert 0.25 * (q[0] - p) == pytest.approx(0.01118205, rel=2e-4)


def test_certificate_holds_under_Q_where_growth_is_not_in_proportion():
    shear = solved(tangential_load=0.6 * 0.25 * 0.03).check().shear
    assert "receded" in shear.kind
    assert shear.ok
    # 3e-13 is found
    assert shear.residual < 1e-11
    assert shear.equilibrium < 1e-11


def test_certificate_fails_where_the_receding_end_is_wrong():
    state = solved().tangential
    *spells, last = state.before.spells
    moved = last.receding + 1e-5 * np.array([1.0, 1.0, *np.zeros(len(last.receding) - 2)])
    spells.append(receding(last.course, last.zones, last.side, moved))
    wrong = replace(state, before=replace(state.before, spells=tuple(spells)))
    shear = goodman_certificate(wrong, 1e-13)
    assert not shear.ok
    assert max(shear.residual, shear.equilibrium) > 1e-6


def test_a_tilt_to_the_other_side_mirrors_the_march():
    right, left = solved(), solved(tilt=-0.05)
    assert left.stick[0] == pytest.approx(tuple(-c for c in right.stick[0][::-1]), rel=1e-10)


def test_a_narrow_stick_zone_is_not_marched():
    with pytest.raises(sie.ContactError, match=r"stick and slip zones of more than 1e-06"):
        _ = solved(friction=0.02).stick


def test_root_table_keeps_roots_of_distances_from_marks():
    marks = np.array([-1.0, 0.3, 2.0])

    def roots(x):
        return np.sqrt(x + 1.0) + np.abs(x - 0.3) ** 1.5

    x = np.linspace(-1.0, 2.0, 101)
    assert RootTable(roots, marks, 1e-13)(x) == pytest.approx(roots(x), abs=1e-12)
