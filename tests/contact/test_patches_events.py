"""Contact beside an event: a birth, a merger, an edge that turns sharp; lengths and gaps."""

import numpy as np
import pytest
from traces import rough_trace

import sie
from analytic import parabola_row

WELLS = sie.FromFunction("x**3 - x", domain=(-3.0, 3.0))  # merges at P = π/2 for E* = 2
WAVE = sie.Periodic(sie.FromFunction("2*sin(2*pi*x)"), 1.0)  # full at P = 2 for E* = 2
# What a parabola h = x²/2 leaves of its height beside a contact of half-width 1, h less the gap,
# is all that a second one stands off whose first touch is under the same load, π/2 for E* = 2.
BESIDE = np.linspace(1.8, 2.3, 400001)
RISE = 0.5 * (BESIDE**2 - BESIDE * np.sqrt(BESIDE**2 - 1.0) + np.arccosh(BESIDE))
RAISED = float((RISE - (BESIDE - 2.0) ** 2 / 0.6).max())
PAIR = sie.Row([sie.Parabola(1.0), sie.Parabola(0.3).shifted(2.0).raised(RAISED)])
ENDING = sie.Row(
    [sie.FromFunction("x", domain=(-1.0, 1.0)), sie.Parabola(0.5).shifted(9.0).raised(9.0)]
)


def solved(profile, load, **asked):
    return sie.solve(sie.Scene(profile=profile, modulus=2.0, normal_load=load, **asked))


def narrower(patches, period):
    """The half-width, or the shorter gap beside it, of each edge."""
    gaps = np.append(patches[1:, 0], patches[0, 0] + period) - patches[:, 1]
    beside = np.stack((np.append(gaps[-1], gaps[:-1]), gaps), axis=1)
    return np.minimum(0.5 * np.diff(patches, axis=1), beside)


def measured(solution, change=1e-12):
    """The largest change of an edge over its patch or gap, per change of the load, both ways."""
    patches, period = np.array(solution.patches), solution.scene.profile.period
    moved = [
        np.abs(np.array(solved(solution.scene.profile, load).patches) - patches)
        for load in solution.normal_load * (1.0 + change * np.array([-1.0, 1.0]))
    ]
    return float((np.maximum(*moved) / narrower(patches, period)).max()) / change


def parabolas(gap):
    shape = {"radius": 1.0, "period": 1.0, "modulus": 2.0}
    return float(parabola_row.mean_pressure(half_width=0.5 - 0.5 * gap, **shape))


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(
    ("profile", "load"),
    [
        *((WELLS, 0.5 * np.pi * (1.0 - 0.25 * gap * gap) ** 2) for gap in (1e-1, 1e-3, 1e-4)),
        *((WAVE, 2.0 * np.cos(0.5 * np.pi * gap) ** 2) for gap in (1e-1, 1e-3, 1e-5)),
        *((PAIR, 0.5 * np.pi * (1.0 + after)) for after in (1e-2, 1e-4, 1e-6)),
        *((sie.Periodic(PAIR, 6.0), load) for load in (1.0, 2.0)),
        *((sie.Periodic(sie.Parabola(1.0), 1.0), parabolas(gap)) for gap in (1e-2, 1e-4)),
        *((ENDING, 0.5 * np.pi * (1.0 - before)) for before in (1e-3, 1e-9)),
    ],
)
def test_the_condition_is_what_the_load_changes(profile, load):
    solution = solved(profile, load)
    condition = solution.in_patches.certificate(1e-13).condition
    assert 0.1 * condition < measured(solution) < 10.0 * condition


def test_full_contact_that_is_about_to_end_is_said_to_be():
    """The lowest pressure of a wave, P less 2, changes by 1/δ of itself where P = 2 (1 + δ)."""
    certificate = solved(WAVE, 2.0 * (1.0 + 1e-7)).check()
    assert certificate.condition == pytest.approx(1e7, rel=0.1)
    assert "full contact" in certificate.notes[0]


def test_an_edge_just_before_the_end_of_the_indenter_is_smooth():
    (patch,) = solved(ENDING, 0.5 * np.pi * (1.0 - 1e-9)).patches
    assert patch == pytest.approx((-1.0 + 5e-10, 1.0 - 5e-10), abs=1e-14)


def test_patches_of_a_period_keep_their_place_where_two_gaps_are_as_wide():
    profile = sie.Periodic(PAIR.shifted(0.3), 4.0)
    loads = 1.7 * (1.0 + 1e-12 * np.arange(4))
    first, *others = (np.array(solved(profile, load).patches) for load in loads)
    assert all(patches == pytest.approx(first, abs=1e-9) for patches in others)


HARMONICS = sie.FromFunction("0.8*sin(x) + 1.05*sin(3*x + 0.5) + 0.84*sin(7*x + 1.1)")


@pytest.mark.parametrize(
    ("profile", "load"),
    [(sie.Periodic(HARMONICS, 2.0 * np.pi), 6.0), (sie.Periodic(sie.Parabola(1.0), 1.0), 0.02)],
)
def test_length_and_gap_volume(profile, load):
    solution = solved(profile, load)
    lengths = [b - a for a, b in solution.patches]
    assert solution.contact_length == pytest.approx(sum(lengths), rel=1e-15)
    following = solution.patches[0][0] + profile.period
    ends = [*(x for patch in solution.patches for x in patch), following]
    g, w = np.polynomial.legendre.leggauss(400)
    volume = 0.0
    for b, a in zip(ends[1::2], ends[2::2], strict=True):
        for side in (-1.0, 1.0):  # from the middle, where a row of parabolas has a ridge
            s = 0.25 * np.pi * (1.0 + g)
            x = 0.5 * (a + b) + side * 0.5 * (a - b) * np.cos(s)
            volume += float((solution.gap(x) * np.sin(s)) @ w) * 0.125 * np.pi * (a - b)
    assert solution.gap_volume == pytest.approx(volume, rel=1e-5)


def test_one_patch_on_the_line_has_no_gaps():
    solution = solved(sie.Parabola(1.0), 0.1)
    assert solution.gap_volume == 0.0
    assert solution.contact_length == 2.0 * solution.half_width


def test_a_trace_whose_contact_reaches_its_end_may_be_repeated():
    with pytest.raises(sie.ContactError, match=r"sie\.Periodic\(trace, period\)"):
        _ = solved(rough_trace(120, 5), 0.1).patches


def test_a_search_for_overlaps_of_too_many_parts_is_refused(monkeypatch):
    monkeypatch.setattr("sie.patches.gap.MOST", 0)
    with pytest.raises(sie.ContactError, match="change the load"):
        _ = solved(sie.Polynomial((0.0, 0.0, -1.0, 0.0, 0.5)), 0.2).edges


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("load", [1e-249, 1e-120, 1e-60])
def test_patches_narrower_than_doubles_are_refused(load):
    row = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
    with pytest.raises(sie.LoadError, match=r"raise the load|change the load"):
        _ = solved(row, load, moment=0.0).patches
