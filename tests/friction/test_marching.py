"""Steps that no layers answer, against closed forms and laws."""

from dataclasses import replace

import numpy as np
import pytest
from history_cases import HERTZ, LOPSIDED, MEAN_STRESS, f, followed

TRAVELLING = [(1, 0, 0), (1, 0.5, 3)]


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


@pytest.mark.slow
@pytest.mark.parametrize("sign", [1, -1], ids=["as it is", "mirrored"])
def test_a_narrow_zone_of_slip_at_a_mark_is_seen(sign):
    """It is narrower than one place in thirty of the stick zone."""
    profile = LOPSIDED.profile if sign > 0 else LOPSIDED.profile.mirrored()
    points = [(P, sign * Q, sigma) for P, Q, sigma in NEAR_A_MARK]
    solution = followed(replace(LOPSIDED, profile=profile), points)[-1]
    (c1, b1), (a2, c2) = solution.stick
    assert 0.0 < a2 - b1 < 0.01 * (c2 - c1)
    assert solution.check().ok
