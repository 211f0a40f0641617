"""Contact beside an event: a birth, a merger, an edge that turns sharp; what the certificate says.

The condition of the certificate is held against the edges of two loads that are next to each other.
"""

import numpy as np
import pytest

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


def test_full_contact_is_certified_with_a_knot_within_rounding_of_a_panel():
    """The knots 0.01 k and the even cuts of the period differ by rounding."""
    x = 0.01 * np.arange(240)
    trace = sie.Sampled(x, 1e-4 * np.cos(2.0 * np.pi * x / 2.4))
    scene = sie.Scene(profile=sie.Periodic(trace, 2.4), modulus=1.0, normal_load=2.4)
    certificate = sie.solve(scene).check()
    assert certificate.ok and certificate.error < 1e-13


def test_full_contact_that_is_about_to_end_is_said_to_be():
    """The lowest pressure of a wave, P less 2, changes by 1/δ of itself where P = 2 (1 + δ)."""
    certificate = solved(WAVE, 2.0 * (1.0 + 1e-7)).check()
    assert certificate.condition == pytest.approx(1e7, rel=0.1)
    assert "full contact" in certificate.notes[0]


def test_an_edge_just_before_the_end_of_the_indenter_is_smooth():
    (patch,) = solved(ENDING, 0.5 * np.pi * (1.0 - 1e-9)).patches
    assert patch == pytest.approx((-1.0 + 5e-10, 1.0 - 5e-10), abs=1e-14)


@pytest.mark.parametrize("load", [0.00082, 0.00084, 0.00087])
def test_the_corner_of_a_tilted_flat_is_touched_in_a_patch_that_is_narrow_by_orders(load):
    flats = ((0.49, 1.6796, 0.0101848), (0.179, 3.1852, 0.0035474), (0.186, 22.5, 0.0))
    row = sie.Row([sie.Flat(half).shifted(x).raised(z) for half, x, z in flats])
    solution = solved(row, load, tilt=0.0029733)
    assert len(solution.patches) == 2
    assert solution.check().ok


def test_patches_of_a_period_keep_their_place_where_two_gaps_are_as_wide():
    profile = sie.Periodic(PAIR.shifted(0.3), 4.0)
    loads = 1.7 * (1.0 + 1e-12 * np.arange(4))
    first, *others = (np.array(solved(profile, load).patches) for load in loads)
    assert all(patches == pytest.approx(first, abs=1e-9) for patches in others)
