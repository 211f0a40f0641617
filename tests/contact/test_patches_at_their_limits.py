"""Contact in several patches: concave corners, sharp edges, rough traces; length and gaps."""

import numpy as np
import pytest

import sie
from analytic import parabola_row

HEIGHTS = (
    (0.44, 0.63, 1.2, 0.002),
    (0.23, 4.1, 2.53, 0.008),
    (0.25, 1.18, 4.26, 0.019),
)
# Under a load at which all touches, but for the concave corners
ROUNDED = sie.Row([sie.RoundedFlat(a, R).shifted(x).raised(z) for a, R, x, z in HEIGHTS])


def solved(**asked):
    return sie.solve(sie.Scene(modulus=1.0, poisson=0.3, **asked))


def rough(n, period=True):
    rng = np.random.default_rng(5)
    k = np.arange(4, n // 8)
    x = np.arange(n + 1) / n
    h = (k**-1.3 * np.cos(2 * np.pi * np.outer(x, k) + rng.uniform(0, 6.28, len(k)))).sum(axis=1)
    trace = sie.Sampled(x, 0.01 * h / h.std())
    return sie.Periodic(trace, 1.0) if period else trace


# -- concave corners -------------------------------------------------------------------------------


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_parabolas_in_a_row_are_never_in_full_contact(gap):
    shape = {"radius": 1.0, "period": 1.0, "modulus": 1.0}
    half = 0.5 - 0.5 * gap
    load = float(parabola_row.mean_pressure(half_width=half, **shape))
    solution = solved(profile=sie.Periodic(sie.Parabola(1.0), 1.0), normal_load=load)
    assert 1.0 - solution.contact_length == pytest.approx(gap, rel=1e-6)
    assert solution.check().ok


@pytest.mark.parametrize("load", [3.0, 8.4])
def test_no_patch_covers_a_concave_corner(load):
    """Where the slope jumps down the pressure of a closed contact is -inf: the gap is narrow, but
    it is there, and a polynomial through the pressures at some nodes does not show it.
    """
    solution = solved(profile=ROUNDED, normal_load=load)
    lo, hi = solution.edges
    jumps = ((x, ROUNDED.slope(x + np.array([-1e-9, 1e-9]))) for x in ROUNDED.breaks)
    corners = [x for x, (below, above) in jumps if lo < x < hi and above < below - 1e-3]
    assert corners
    for corner in corners:
        assert not any(a < corner < b for a, b in solution.patches)
        near = corner + np.geomspace(1e-6, 1e-2, 9)[:, None] * np.array([-1.0, 1.0])
        assert solution.pressure(near).min() >= 0.0
    assert solution.check().ok


# -- the certificate -------------------------------------------------------------------------------


def test_sharp_edges_are_certified_where_doubles_round_the_place():
    """p at a double next to a corner is that of the double, not of the place that was meant."""
    flats = [sie.Flat(w).shifted(x) for w, x in ((0.42, 5.3), (0.116, 7.26))]
    certificate = solved(profile=sie.Row(flats), normal_load=4.1).check()
    assert certificate.ok
    assert certificate.residual < 1e-12 > certificate.force


@pytest.mark.parametrize("mean", [0.003, 0.02])
def test_a_rough_profile_is_certified_to_rounding(mean):
    certificate = solved(profile=rough(240), normal_load=mean).check()
    assert certificate.ok
    assert certificate.patches > 3
    assert certificate.measured_to < 1e-10


# -- loads, length, gaps ---------------------------------------------------------------------------


@pytest.mark.parametrize("mean", [0.003, 0.02])
def test_patch_loads_of_a_rough_profile_add_up(mean):
    solution = solved(profile=rough(240), normal_load=mean)
    assert sum(solution.patch_loads) == pytest.approx(mean, rel=1e-12)


def test_the_moment_is_that_of_the_pressure():
    row = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9)])
    level = solved(profile=row, normal_load=0.4)
    again = solved(profile=row, normal_load=0.4, moment=level.moment)
    assert again.tilt == pytest.approx(0.0, abs=1e-13)


@pytest.mark.parametrize("profile", [rough(120), sie.Periodic(sie.Parabola(1.0), 1.0)])
def test_length_and_gap_volume(profile):
    solution = solved(profile=profile, normal_load=0.01)
    lengths = [b - a for a, b in solution.patches]
    assert solution.contact_length == pytest.approx(sum(lengths), rel=1e-15)
    ends = [*(x for patch in solution.patches for x in patch), solution.patches[0][0] + 1.0]
    g, w = np.polynomial.legendre.leggauss(400)
    volume = 0.0
    for b, a in zip(ends[1::2], ends[2::2], strict=True):
        for side in (-1.0, 1.0):  # from the middle, where a row of parabolas has a ridge
            s = 0.25 * np.pi * (1.0 + g)
            x = 0.5 * (a + b) + side * 0.5 * (a - b) * np.cos(s)
            volume += float((solution.gap(x) * np.sin(s)) @ w) * 0.125 * np.pi * (a - b)
    assert solution.gap_volume == pytest.approx(volume, rel=1e-5)


def test_one_patch_on_the_line_has_no_gaps():
    solution = solved(profile=sie.Parabola(1.0), normal_load=0.1)
    assert solution.gap_volume == 0.0
    assert solution.contact_length == 2.0 * solution.half_width


# -- what is refused -------------------------------------------------------------------------------


def test_a_trace_whose_contact_reaches_its_end_may_be_repeated():
    with pytest.raises(sie.ContactError, match=r"sie\.Periodic\(trace, period\)"):
        _ = solved(profile=rough(120, period=False), normal_load=0.05).patches


@pytest.mark.parametrize("load", [0.003, 0.01])
def test_narrow_panels_beside_wide_ones_are_measured_as_exactly(load):
    """A patch ends anywhere between two points of a trace, and leaves a narrow panel there."""
    n, k = 1000, np.arange(1, 500)
    phase = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, len(k))
    amplitude = np.where(k >= 4, (np.maximum(k, 4) / 4.0) ** -1.3, 1.0)
    h = np.fft.irfft(np.concatenate(([0.0], amplitude * np.exp(1j * phase), [0.0])), n)
    x = np.linspace(-1.0, 1.0, n)
    ends = 0.5 * np.maximum(np.abs(x) - 0.9, 0.0) ** 2
    trace = sie.Sampled(x, h * (0.01 / h.std()) + ends)
    solution = sie.solve(sie.Scene(profile=trace, modulus=1.0, normal_load=load))
    assert len(solution.patches) > 5
    assert solution.check().residual <= 2e-12


def test_a_search_for_overlaps_of_too_many_parts_is_refused(monkeypatch):
    """It does not take all memory."""
    monkeypatch.setattr("sie.patches.gap.MOST", 0)
    wells = sie.Polynomial((0.0, 0.0, -1.0, 0.0, 0.5))
    with pytest.raises(sie.ContactError, match="change the load"):
        _ = sie.solve(sie.Scene(profile=wells, modulus=1.0, normal_load=0.1)).edges


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("load", [1e-249, 1e-120, 1e-60])
def test_patches_narrower_than_doubles_are_refused(load):
    row = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
    with pytest.raises(sie.LoadError, match=r"raise the load|change the load"):
        _ = solved(profile=row, normal_load=load, moment=0.0).patches


@pytest.mark.parametrize("load", [1e154, 1e160])
def test_a_load_whose_square_is_no_double_is_certified(load):
    valleys = sie.Polynomial((0.0, 0.0, -1.0, 0.0, 0.5))
    assert sie.solve(sie.Scene(profile=valleys, modulus=1.0, normal_load=load)).check().ok
