"""The search for patches where it went astray: walls beside the window, the last gap of a period,
short patches behind a concave corner, moments that another indenter carries.
"""

from itertools import pairwise

import numpy as np
import pytest
from rough_traces import rough_trace as trace

import sie
from sie.patches.tension import _joined


def solved(**asked):
    return sie.solve(sie.Scene(modulus=1.0, **asked))


def by_integral(solution, x):
    """The gap up to a constant, from the pressure: h - (2/(π E*)) ∫ p ln|sin(π(x - t)/λ)| dt."""
    profile, period = solution.scene.profile, solution.scene.profile.period
    breaks = np.asarray(profile.breaks) + period * np.arange(-1.0, 2.0)[:, None]
    g, w = np.polynomial.legendre.leggauss(40)
    total = profile.height(x)
    for a, b in solution.patches:
        inner = breaks[(breaks > a) & (breaks < b)]
        cosine = (a + b - 2.0 * np.r_[a, inner, b]) / (b - a)
        angle = np.sort(np.arccos(np.clip(cosine, -1.0, 1.0)))
        for lo, hi in pairwise(angle):
            s = lo + 0.5 * (hi - lo) * (1.0 + g)
            t = 0.5 * (a + b) - 0.5 * (b - a) * np.cos(s)
            weight = 0.25 * (hi - lo) * (b - a) * w * np.sin(s) * solution.pressure(t)
            total = (
                total
                - 2.0 / np.pi * np.log(np.abs(np.sin(np.pi * (x[:, None] - t) / period))) @ weight
            )
    return total


@pytest.mark.slow(but=2)
@pytest.mark.parametrize(("seed", "load"), [(1, 0.002), (2, 0.02), (3, 0.1)])
def test_all_gaps_of_a_period_are_those_of_its_pressure(seed, load):
    """The last gap reaches into the next period, where 1/d has the other sign."""
    solution = solved(profile=sie.Periodic(trace(400, seed), 2.01), normal_load=load)
    ends = [*(x for patch in solution.patches for x in patch), solution.patches[0][0] + 2.01]
    b, a = np.array(ends[1::2]), np.array(ends[2::2])
    x = (b + (a - b) * np.array([0.2, 0.4, 0.6, 0.8])[:, None]).ravel()
    gap = solution.gap(x)
    x, gap = x[np.isfinite(gap)], gap[np.isfinite(gap)]
    difference = by_integral(solution, x) - gap
    assert np.ptp(difference) < 1e-5 * gap.max()


def test_a_trace_of_many_points_in_one_patch_per_period():
    solution = solved(profile=sie.Periodic(trace(60, 4, size=0.001), 2.05), normal_load=5.0)
    assert len(solution.patches) == 1
    assert solution.check().ok


@pytest.mark.parametrize("load", [1e-5, 1e-3, 0.1])
@pytest.mark.parametrize("distance", [5.7, 6.5])
def test_walls_that_the_contact_is_far_from_change_nothing(distance, load):
    """Functions are resolved on a window about the contact: the first indenter, which ends at
    x = 3, is not in it.
    """
    gentle = sie.FromFunction(lambda x: np.sinh(0.5 * x), domain=(-3.0, 3.0)).raised(2.0)
    lowest = sie.FromFunction(np.sinh, domain=(-3.0, 3.0)).shifted(distance)
    solution = solved(profile=sie.Row([gentle, lowest]), normal_load=load)
    alone = solved(profile=lowest, normal_load=load)
    assert solution.edges == pytest.approx(alone.edges, rel=1e-12)


def test_runs_of_tension_are_joined_to_their_hull():
    """Runs come in the order in which they may begin, not in that of their first places."""
    wide, inside = (0, 0.1, 0.5, 0.5, 0.9), (0, 0.2, 0.2, 0.4, 0.4)
    (tension,) = _joined([wide, inside])
    assert (tension.lo, tension.hi) == (0.2, 0.5)


@pytest.mark.parametrize(("distance", "load"), [(3.0, 0.1), (3.0, 1.0), (1.0, 1.0)])
def test_a_flat_in_a_bowl_is_at_its_own_height(distance, load):
    """h jumps at both ends of the flat, without room for a gap between the indenters."""
    flat = sie.Flat(0.3).shifted(distance)
    whole = solved(profile=sie.Row([sie.Parabola(1.0), flat]), normal_load=load)
    part = sie.FromFunction(lambda x: x, domain=(-1.5, distance - 0.4))
    apart = solved(profile=sie.Row([part, flat]), normal_load=load)
    assert np.array(whole.patches) == pytest.approx(np.array(apart.patches), rel=1e-10)
    assert whole.check().ok


def test_a_patch_missing_beyond_a_concave_corner_is_found_where_the_edge_beside_it_stalls():
    """Newton's method takes no edge over a corner: what overlaps beyond has to become a patch."""
    rng = np.random.default_rng([7, 8416])
    rng.uniform(-6, 2)
    n = int(rng.integers(2, 51))
    radii, x = 10 ** rng.uniform(-0.7, 0.7, n), np.cumsum(rng.uniform(0.2, 1.8, n))
    heights = rng.uniform(0, 0.1, n)
    parts = zip(radii.tolist(), x.tolist(), heights.tolist(), strict=True)
    row = sie.Row([sie.Parabola(r).shifted(at).raised(z) for r, at, z in parts])
    solution = sie.solve(sie.Scene(profile=row, modulus=1.0, normal_load=6.16))
    assert solution.check().ok


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("period", [None, 26.0])
def test_more_flats_than_are_searched_roughly_keep_their_edges(period):
    """Edges that stay where they are while their charges are found are no search that repeats."""
    flats = sie.Row([sie.Flat(0.2 + 0.02 * k).shifted(1.9 * k) for k in range(13)])
    profile = flats if period is None else sie.Periodic(flats, period)
    solution = sie.solve(sie.Scene(profile=profile, normal_load=0.05, modulus=1.0))
    assert len(solution.patches) == 13 and solution.check().ok
