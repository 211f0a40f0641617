"""Steps that no layers answer: against closed forms and layers, by laws, and on a mesh."""

from dataclasses import replace

import numpy as np
import pytest
from history_cases import HERTZ, LOPSIDED, P0, F, S, f
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from marched_cases import (
    ALL,
    BOTH_STICK,
    GROWING,
    MEAN_STRESS,
    TOGETHER,
    TRAVELLING,
    all_marched,
    followed,
    inside,
)

import sie

# Slip begins at the left edge while slip in the other direction goes on at the right one.
FROM_THE_EDGE = [(1, 0, 0), (1, 0.356, -0.783), (1, -0.399, -0.602), (1, 0.525, 0.548)]
UNTIL_TURNED = [(1, 0, 0), (1.2, -0.6, -0.4), (1.17, 0.15, 0.41)]
JUMPS = [(1, 0, 0, 0), (0.981, 0.565, -0.091, 0.01), (1.026, 0.563, 0.327, 0.024)]


JUMPS += [(0.953, 0.389, 0.396, -0.005)]

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


def test_loads_together_settle_in_the_steady_cycle():
    history = followed(LOPSIDED, TOGETHER)
    points = [(*loads[:3], turn) for loads, turn in zip(history.path.points, history.path.tilt)]
    cycle = sie.steady_cycle(LOPSIDED, points[1], points[2])
    x = np.linspace(-0.7, 0.7, 41)
    assert history[3].stick[0] == pytest.approx(cycle.stick[0], abs=1e-11)
    swing = np.abs(history[3].shear(x) - history[2].shear(x))
    assert swing == pytest.approx(cycle.shear_range(x), abs=1e-12)


def test_a_stick_zone_that_travels_has_the_width_of_its_rates():
    """2 |dQ/(π dτ)|, τ = σ/4."""
    solution = followed(HERTZ, TRAVELLING)[-1]
    (c1, c2), (_, Q, sigma) = solution.stick[0], solution.history.path.points[-1]
    assert c2 - c1 == pytest.approx(2.0 * Q / (np.pi * 0.25 * sigma), rel=1e-12)


@pytest.mark.slow
def test_slip_from_one_edge_while_it_goes_on_at_the_other_is_that_of_the_path_in_parts():
    whole, parts = (followed(LOPSIDED, FROM_THE_EDGE, n)[-1] for n in (1, 2))
    assert whole.check().ok
    assert parts.stick[0] == pytest.approx(whole.stick[0], abs=1e-10)
    assert parts.energy_lost == pytest.approx(whole.energy_lost, rel=1e-9)


def test_a_growing_contact_that_sticks_has_the_closed_form_of_its_layers():
    """Hertz, half-width r: q = (dQ/π - dτ x)/d(r²)·2 [sqrt(r² - x²) - sqrt(r0² - x²)]."""
    solution = followed(HERTZ, BOTH_STICK[:2])[-1]
    _, Q, sigma = solution.history.path.points[-1]
    x = np.array([-1.2, -1.001, -0.999, -0.4, 0.0, 0.7, 0.9999, 1.0001, 1.25])
    grown = np.sqrt(1.6 - x**2) - np.sqrt(np.maximum(1.0 - x**2, 0.0))
    due = (Q / np.pi - 0.25 * sigma * x) / 0.6 * 2.0 * grown
    assert solution.shear(x) == pytest.approx(due, abs=1e-13)
    assert solution.stick == (solution.edges,) and solution.energy_lost == 0.0


def kinds(solution):
    parts = solution.history.turning_points[-1].parts
    return [type(part).__name__ for part in parts]


# -- laws ------------------------------------------------------------------------------------------


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("points", GROWING)
def test_what_sticks_at_a_growing_edge_satisfies_its_equation_to_rounding(points):
    certificate = followed(HERTZ, points)[-1].check()
    assert certificate.shear.residual <= 1e-12 and certificate.shear.equilibrium <= 1e-11


@pytest.mark.slow
def test_a_moment_along_a_path_is_the_tilt_that_it_causes():
    """In each of short parts the tilt that follows from the moment is nearly linear."""
    scene = replace(LOPSIDED, moment=0.0)
    loads = [(P0, 0.0, 0.0), (1.5 * P0, 0.3 * F, 0.35 * S)]
    by_moment = sie.follow(scene, sie.Path(loads, moment=[0.0, 0.03 * P0]).subdivided(6))
    tilts = [solution.tilt for solution in by_moment]
    by_tilt = sie.follow(LOPSIDED, sie.Path(by_moment.path.points, tilt=tilts))
    whole = sie.follow(scene, sie.Path(loads, moment=[0.0, 0.03 * P0]))[-1]
    x = inside(whole)
    assert whole.shear(x) == pytest.approx(by_moment[-1].shear(x), abs=1e-12)
    assert whole.shear(x) == pytest.approx(by_tilt[-1].shear(x), abs=3e-4 * f)
    assert whole.energy_lost == pytest.approx(by_moment[-1].energy_lost, rel=1e-9)


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("points", [*ALL, TOGETHER])
def test_a_marched_state_satisfies_its_equations(points):
    for solution in followed(HERTZ, points):
        certificate = solution.check()
        assert certificate.ok
        assert certificate.shear.residual <= 1e-10 and certificate.shear.equilibrium <= 1e-11


@pytest.mark.slow
@pytest.mark.parametrize("points", ALL)
def test_a_marched_path_in_parts_ends_in_the_same_state(points):
    whole, parts = (followed(LOPSIDED, points, n)[-1] for n in (1, 2))
    x = inside(whole)
    assert parts.stick[0] == pytest.approx(whole.stick[0], abs=1e-9)
    assert parts.shear(x) == pytest.approx(whole.shear(x), abs=1e-9)
    x = inside(whole, 3)
    assert parts.slip(x) == pytest.approx(whole.slip(x), abs=1e-9)
    assert parts.shift == pytest.approx(whole.shift, abs=1e-9)
    assert parts.energy_lost == pytest.approx(whole.energy_lost, rel=1e-7)


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("points", ALL)
def test_a_marched_path_of_mirrored_loads_has_the_mirrored_answer(points):
    mirrored = replace(LOPSIDED, profile=LOPSIDED.profile.mirrored())
    here = followed(LOPSIDED, points)[-1]
    there = followed(mirrored, [(P, -Q, sigma) for P, Q, sigma in points])[-1]
    x = inside(here)
    assert there.stick[0] == pytest.approx(tuple(-c for c in here.stick[0][::-1]), abs=1e-9)
    assert there.shear(-x) == pytest.approx(-here.shear(x), abs=1e-10)
    assert there.energy_lost == pytest.approx(here.energy_lost, rel=1e-8)


PERCENT = st.integers(-100, 100)


@pytest.mark.slow
@settings(max_examples=6, deadline=None)
@given(
    st.lists(
        st.tuples(st.just(1.0), PERCENT.map(lambda k: 0.007 * k), PERCENT.map(lambda k: 0.005 * k)),
        min_size=2,
        max_size=3,
    )
)
def test_a_random_path_keeps_to_friction_and_balance(points):
    try:
        solution = followed(LOPSIDED, [(1, 0, 0), *points])[-1]
    except sie.ContactError:
        assume(False)
    x = inside(solution, 101)
    bound = f * solution.pressure(x)
    assert (np.abs(solution.shear(x)) <= bound + 1e-9).all()
    assert solution.check().ok


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


@pytest.mark.slow
def test_the_energy_of_a_closed_march_is_the_area_of_its_loop():
    """∮Q dδ at constant σ, by Gauss' rule in an angle on one branch, which the other mirrors."""
    node, weight = np.polynomial.legendre.leggauss(5)
    swing = 0.5 * np.sin(0.5 * np.pi * node)
    branch = [MEAN_STRESS[2], *((1, Q, 0.3) for Q in swing), MEAN_STRESS[3]]
    states = followed(HERTZ, [*MEAN_STRESS[:2], *branch])[2:]
    shift = np.array([state.shift for state in states])
    dQ = F * 0.25 * np.pi * np.cos(0.5 * np.pi * node) * weight
    area = 0.5 * F * (shift[0] + shift[-1]) - float(dQ @ shift[1:-1])
    lost = states[-1].energy_lost - states[0].energy_lost
    assert area == pytest.approx(lost, rel=1e-3)
