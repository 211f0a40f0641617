"""How a stick zone begins to recede out of proportion in Goodman's approximation."""

from __future__ import annotations

import math

import numpy as np
import pytest

import sie
from oracles.goodman_grid import grown
from sie.friction.goodman.history import lack
from sie.friction.goodman.march import march
from sie.friction.goodman.zone_table import zone_table


def solved(profile, load, friction=0.25):
    return sie.solve(
        sie.Scene(
            profile=profile,
            modulus=2.0,
            dundurs=0.3,
            friction=friction,
            coupling="goodman",
            normal_load=load,
        )
    )


def test_stick_zone_recedes_as_an_edge_passes_a_jump_of_the_slope():
    # The right edge of a parabola stays where the slope jumps: dm/dr jumps from 0 to -1, dP/dr by
    # two. With w = ∓ dm/dr - k before and after, λ² w'/(w P'/P) + 2 λ = 1
    bent = sie.Piecewise((-30.0, 0.3, 30.0), ((0.0, 0.2), (0.1, 0.5)))
    spells = solved(bent, 0.032).tangential.before.spells
    n = next(i for i, spell in enumerate(spells) if spell.side)
    spell, k = spells[n], spells[n].zones.k
    r, m, end = (
        np.polynomial.chebyshev.chebval([-1.0, -0.9], c)
        for c in (spell.series[0], spell.series[1], spell.receding)
    )
    way = (m + k * r)[1] - end[0]
    kappa = 0.5 * (1.0 - k) / k
    # 2e-8 is found on a way of 8e-9, which is known to 1e-8
    expected = 1.0 / (1.0 + math.sqrt(1.0 + kappa))
    assert (end[1] - end[0]) / way == pytest.approx(expected, rel=3e-6)
    for i in range(n, len(spells)):
        part = (*spells[:i], spells[i].until(0.37))
        u = np.array([np.polynomial.chebyshev.chebval(0.37, spells[i].receding)])
        # 1e-11 where the pressure is 0.06
        assert abs(lack(part, u, -1.0)[0]) < 1e-10


def test_both_ends_that_recede_at_once_are_refused():
    # The left edge passes a jump of the slope, and then the right one
    bent = sie.Piecewise((-30.0, -0.3, 0.38, 30.0), ((-0.146, 0.2), (0.0, 0.155), (0.176, 0.8)))
    with pytest.raises(sie.ContactError, match=r"both ends of the stick zone recede at once from"):
        _ = solved(bent, 0.07, 0.29).stick


def test_a_march_from_first_touch_is_the_growth_in_proportion():
    # Two unlike parabolas grow in proportion all along, and are solved without a march
    state = solved(sie.Piecewise((-30.0, 0.0, 30.0), ((0.0, 0.2), (0.0, 0.3))), 0.1, 0.1).tangential
    spells = march(state.table, zone_table(3.0))
    stick = tuple(state.table.first_centre + end for end in spells[-1].ends[1, 2:])
    # 1e-13 is found
    assert stick == pytest.approx(state.normal_stick, abs=1e-11)
    x = np.linspace(*stick, 5)[1:-1]
    shear = 0.1 * (lack(spells, x, 1.0) - state.step.pressure(x))
    assert shear == pytest.approx(state.before(x), abs=1e-11)


def test_stick_zone_behind_a_jump_of_the_slope_is_that_of_a_grid():
    bent = sie.Piecewise((-30.0, 0.3, 30.0), ((0.0, 0.2), (0.1, 0.5)))
    ends = np.linspace(-0.37, 0.32, 121)
    x = 0.5 * (ends[1:] + ends[:-1])
    height = np.array([bent.height(place) for place in x.tolist()])
    grid = grown(ends, height, 0.04, (0.3, 0.25), 80)
    solution = solved(bent, 0.04)
    # 0.7 of a cell is found; on twice as many cells 0.3 of one
    assert grid.stick == pytest.approx(solution.stick[0], abs=1.1 * (ends[1] - ends[0]))
    # 1.4e-3 is found, and on twice as many cells 2e-4
    q = np.interp([-0.15, 0.1], grid.x, grid.shear)
    assert q == pytest.approx(solution.shear(np.array([-0.15, 0.1])), rel=3e-3)
