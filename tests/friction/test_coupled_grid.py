"""Dissimilar bodies pressed with friction, against the printed equations on a grid."""

from __future__ import annotations

import numpy as np
import pytest

import sie
from oracles import spence

CELLS = 32


def between_grids(coarse, fine, exact):
    """The error left after extrapolation to no cells, over the difference of both grids."""
    return abs(2.0 * fine - coarse - exact) / abs(fine - coarse)


def rise(half_flat, n):
    x = (np.arange(n + 1) + 0.5) / n
    return 0.5 * np.maximum(x - half_flat, 0.0) ** 2  # E*/2 = radius = 1


@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.5, 0.5), (0.3, 0.5)])
def test_stick_zone_of_a_flat_ends_within_two_cells_of_the_grids(beta, friction):
    scene = sie.Scene(
        profile=sie.Flat(1.0), modulus=2.0, dundurs=beta, friction=friction, normal_load=1.0
    )
    grid = spence.flat_punch(4 * CELLS, beta, friction)
    assert grid.stick_ratio == pytest.approx(sie.solve(scene).stick[0][1], abs=2.0 / (4 * CELLS))


@pytest.mark.parametrize("half_flat", [0.0, 0.5])
def test_load_of_the_grids_tends_to_that_of_the_contact(half_flat):
    profile = sie.RoundedFlat(half_flat, 1.0) if half_flat else sie.Parabola(1.0)
    exact = sie.solve(
        sie.Scene(profile=profile, modulus=2.0, dundurs=0.3, friction=0.3, half_width=1.0)
    )
    grids = [
        spence.growing_contact(rise(half_flat, n), n, 0.3, 0.3, max(1, round(half_flat * n)))
        for n in (CELLS, 2 * CELLS)
    ]
    assert between_grids(*(grid.load for grid in grids), exact.normal_load) < 0.2
    assert grids[1].stick_ratio == pytest.approx(
        exact.stick[0][1] / exact.half_width, abs=1.0 / CELLS
    )


def test_grids_tell_the_coupled_pressure_from_goodmans():
    loads = [spence.growing_contact(rise(0.0, n), n, 0.3, 0.3, 1).load for n in (CELLS, 2 * CELLS)]
    scene = sie.Scene(
        profile=sie.Parabola(1.0),
        modulus=2.0,
        dundurs=0.3,
        friction=0.3,
        half_width=1.0,
        coupling="goodman",
    )
    assert between_grids(*loads, sie.solve(scene).normal_load) > 1.0
