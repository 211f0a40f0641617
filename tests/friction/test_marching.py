"""Steps that no layers answer: against closed forms and layers."""

from dataclasses import replace

import numpy as np
import pytest
from history_cases import HERTZ, LOPSIDED, f
from marched_cases import (
    BOTH_STICK,
    MEAN_STRESS,
    TRAVELLING,
    all_marched,
    followed,
    inside,
)

# -- closed forms and layers -----------------------------------------------------------------------


LAYERED = {
    "Q falls and rises": [(1, 0, 0), (1, 0.5, 0), (1, -0.4, 0), (1, 0.2, 0)],
    "both directions": [(1, 0, 0), (1, 0, 0.6), (1, 0, -0.3)],
}


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("case", LAYERED)
@pytest.mark.parametrize("scene", [HERTZ, LOPSIDED], ids=["Hertz", "lopsided"])
def test_marching_gives_what_layers_give(case, scene):
    by_layers, marched = followed(scene, LAYERED[case])[-1], all_marched(scene, LAYERED[case])[-1]
    x = inside(by_layers)
    assert marched.stick[0] == pytest.approx(by_layers.stick[0], abs=1e-11)
    assert marched.shear(x) == pytest.approx(by_layers.shear(x), abs=1e-12)
    assert marched.slip(x) == pytest.approx(by_layers.slip(x), abs=1e-10)
    assert marched.shift == pytest.approx(by_layers.shift, abs=1e-10)
    assert marched.check().ok


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("case", LAYERED)
def test_the_energy_of_a_march_is_that_of_layers(case):
    by_layers, marched = (run(HERTZ, LAYERED[case])[-1] for run in (followed, all_marched))
    assert marched.energy_lost == pytest.approx(by_layers.energy_lost, rel=1e-8)


def test_a_cycle_under_a_mean_bulk_stress_settles_at_the_zone_of_its_range():
    """From the second turn on q swings as without σ: c² = 1 - |Q|/(f P), Mindlin's cycle."""
    history, alone = (
        followed(HERTZ, MEAN_STRESS),
        followed(HERTZ, [(*p[:2], 0) for p in MEAN_STRESS]),
    )
    assert history[3].stick[0] == pytest.approx((-np.sqrt(0.5), np.sqrt(0.5)), abs=1e-12)
    change, due = (h[3].energy_lost - h[2].energy_lost for h in (history, alone))
    assert change == pytest.approx(due, rel=1e-9)


def test_a_stick_zone_that_travels_has_the_width_of_its_rates():
    """2 |dQ/(π dτ)|, τ = σ/4."""
    solution = followed(HERTZ, TRAVELLING)[-1]
    (c1, c2), (_, Q, sigma) = solution.stick[0], solution.history.path.points[-1]
    assert c2 - c1 == pytest.approx(2.0 * Q / (np.pi * 0.25 * sigma), rel=1e-12)


def test_a_growing_contact_that_sticks_has_the_closed_form_of_its_layers():
    """Hertz, half-width r: q = (dQ/π - dτ x)/d(r²)·2 [sqrt(r² - x²) - sqrt(r0² - x²)]."""
    solution = followed(HERTZ, BOTH_STICK[:2])[-1]
    _, Q, sigma = solution.history.path.points[-1]
    x = np.array([-1.2, -1.001, -0.999, -0.4, 0.0, 0.7, 0.9999, 1.0001, 1.25])
    grown = np.sqrt(1.6 - x**2) - np.sqrt(np.maximum(1.0 - x**2, 0.0))
    due = (Q / np.pi - 0.25 * sigma * x) / 0.6 * 2.0 * grown
    assert solution.shear(x) == pytest.approx(due, abs=1e-13)
    assert solution.stick == (solution.edges,) and solution.energy_lost == 0.0


# -- laws ------------------------------------------------------------------------------------------


# Slip turns to a short zone at the left edge; an advancing end arrives at one.
SHORT = [(1, 0.602, 0.49), (1, 0.637, -0.13), (1, 0.7, -0.2)]


@pytest.mark.parametrize("scene", [HERTZ, LOPSIDED], ids=["Hertz", "lopsided"])
def test_shear_in_slip_is_friction_as_near_to_an_edge_as_an_end_is_known(scene):
    solution = followed(scene, SHORT)[-1]
    x1, x2 = solution.edges
    x = x1 + 0.5 * (x2 - x1) * np.geomspace(1.01e-8, 1e-6, 300)
    assert (x < solution.stick[0][0]).all()
    assert solution.shear(x) == pytest.approx(f * solution.pressure(x), abs=1e-11 * f)
    assert solution.check().ok


# A second zone of slip opens next to where slip in the step before has ended, some 1e-2 wide.
NEAR_A_MARK = [(1, 0, 0), (1, 0.637, 0.205), (1, 0.63, 0.435), (1, 0.693, 0.23)]
FROM_THE_RIGHT = [(P, -Q, sigma) for P, Q, sigma in NEAR_A_MARK]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "points"),
    [
        (LOPSIDED, NEAR_A_MARK),
        (replace(LOPSIDED, profile=LOPSIDED.profile.mirrored()), FROM_THE_RIGHT),
    ],
    ids=["as it is", "mirrored"],
)
def test_a_narrow_zone_of_slip_at_a_mark_is_seen(scene, points):
    """It is narrower than one place in thirty of the stick zone."""
    solution = followed(scene, points)[-1]
    (c1, b1), (a2, c2) = solution.stick
    assert 0.0 < a2 - b1 < 0.01 * (c2 - c1)
    assert solution.check().ok
