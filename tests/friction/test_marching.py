"""Steps that no layers answer: against closed forms and layers, by laws, and on a mesh."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import sie
from oracles.kalker import Mesh
from oracles.load_history import history as on_a_mesh
from sie.friction.load_history import marching
from sie.friction.load_history.advancing_end import EndAdvances
from sie.friction.load_history.joined_zones import joined
from sie.friction.load_history.load_steps import loads_of, turning_points
from sie.friction.load_history.receding_step import Receded
from sie.friction.load_history.slip_rates import SlipRates
from sie.history import History

P0, f = np.pi / 4.0, 0.3
F, S = f * P0, 4.0 * f * P0 / np.pi
HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=P0, friction=f)
LOPSIDED = replace(HERTZ, profile=sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.125)))
# Points are (P/P0, Q/F, σ/S, tilt).
MEAN_STRESS = [(1, 0, 0.3), (1, 0.5, 0.3), (1, -0.5, 0.3), (1, 0.5, 0.3)]
TURNED = [(1, 0.4, 0), (1, 0.4, 0.25), (1, 0.4, -0.25)]
TRAVELLING = [(1, 0, 0), (1, 0.5, 3)]
TO_THE_EDGE = [(1, 0, 0), (1, 0.67, 0.9)]
# An edge of contact grows and sticks: slip begins at the other one, or after both have stuck.
ONE_STICKS = [(1, 0, 0), (1.3, 0.5, 0.6)]
BOTH_STICK = [(1, 0, 0), (1.6, 0.2, 0.2), (1.9, 0.7, 0.5)]
# Slip begins at the left edge while slip in the other direction goes on at the right one.
FROM_THE_EDGE = [(1, 0, 0), (1, 0.356, -0.783), (1, -0.399, -0.602), (1, 0.525, 0.548)]
OPPOSITE = [(1, 0, 0), (0.8, 0.05, 0.5)]
# An end advances while the pressure changes: to the end of the step, until its zone of slip
# vanishes at an edge that grows, or that retreats, and at once from farther out.
ADVANCES = [(1, 0, 0), (1.17, 0.25, -0.485)]
UNTIL_STUCK = [(1, 0, 0), (1.07, -0.325, -0.42)]
UNTIL_TURNED = [(1, 0, 0), (1.2, -0.6, -0.4), (1.17, 0.15, 0.41)]
JUMPS = [(1, 0, 0, 0), (0.981, 0.565, -0.091, 0.01), (1.026, 0.563, 0.327, 0.024)]
JUMPS += [(0.953, 0.389, 0.396, -0.005)]
TOGETHER = [(1, 0, 0, 0), (1.2, 0.55, 0.1, -0.02), (0.9, -0.3, -0.1, 0.02), (1.2, 0.55, 0.1, -0.02)]
# Slip in two directions while the contact grows.
APART = [(1, 0, 0), (1.1, 0.05, 0.9)]


def followed(scene, points, parts=1):
    return history_of(scene, path_of(points).subdivided(parts))


@cache
def history_of(scene, path):
    """Tests share what they only read."""
    return sie.follow(scene, path)


def path_of(points):
    tilt = [point[3] for point in points] if len(points[0]) == 4 else ()
    return sie.Path([(P * P0, Q * F, sigma * S) for P, Q, sigma, *_ in points], tilt=tilt)


def all_marched(scene, points):
    """The same, every step but the first one marched."""

    def steps(scene, path, contacts):
        found = [turning_points(scene, path, contacts)[0]]
        for loads in loads_of(path)[1:]:
            found.append(contacts.march(found[-1], loads))
        return tuple(found)

    return History(scene, path_of(points), 1e-13, sie.history.ECONOMY, steps)


def inside(solution, n=41):
    """Points of the contact away from its edges, where q falls like a square root."""
    x1, x2 = solution.edges
    return 0.5 * (x1 + x2) + 0.49 * (x2 - x1) * np.linspace(-1.0, 1.0, n)


# -- closed forms and layers ----------------------------------------------------------------------

LAYERED = {
    "Q falls and rises": [(1, 0, 0), (1, 0.5, 0), (1, -0.4, 0), (1, 0.2, 0)],
    "all fall": [(1, 0.4, 0.1), (0.7, 0.3, 0.3)],
    "in phase": [(1, 0, 0), (1.2, 0.55, 0.1), (0.9, -0.3, -0.1)],
    "both directions": [(1, 0, 0), (1, 0, 0.6), (1, 0, -0.3)],
    "both directions, P falls": [(1, 0, 0), (0.8, 0.05, 0.5)],
    "in turn": [(1, 0.4, 0), (1, 0, 0.2), (1, -0.4, 0)],
    "all grow": [(1, 0, 0), (1.3, 0.7, 0.1)],
    "grows and sticks": [(1, 0.4, 0), (1.4, 0.6, 0), (1.4, 0.2, 0)],
    "held up": [(1, 0, 0), (1.3, 0.55, 0.2), (0.8, -0.3, -0.15)],
}


@pytest.mark.parametrize("case", LAYERED)
@pytest.mark.parametrize("scene", [HERTZ, LOPSIDED], ids=["Hertz", "lopsided"])
def test_marching_gives_what_layers_give(case, scene):
    by_layers, marched = followed(scene, LAYERED[case])[-1], all_marched(scene, LAYERED[case])[-1]
    x = inside(by_layers)
    assert marched.stick[0] == pytest.approx(by_layers.stick[0], abs=1e-11)
    assert marched.shear(x) == pytest.approx(by_layers.shear(x), abs=1e-12)
    assert marched.slip(x) == pytest.approx(by_layers.slip(x), abs=1e-11)
    assert marched.shift == pytest.approx(by_layers.shift, abs=1e-11)
    assert marched.check().ok


@pytest.mark.parametrize("case", ["Q falls and rises", "all fall", "both directions", "in turn"])
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


def test_slip_begins_at_a_growing_edge_where_the_rates_reach_friction():
    """Hertz: dQ + π r dτ = f dP at the left edge, which grows to r = 1.2 at this bulk stress."""
    Q, r = 0.1, 1.2
    sigma = (0.6 - Q) * F * 4.0 / (np.pi * r * S)
    points = [(1, 0, 0), (1.6, Q, sigma)]
    parts = followed(HERTZ, points).turning_points[1].marched
    assert parts[0].signs == (0.0, 0.0) and parts[1].signs == (1.0, 0.0)
    assert parts[0].stick.x1 == pytest.approx(-r, abs=1e-12)


def kinds(solution):
    parts = solution.history.turning_points[-1].marched
    return [type(part).__name__ for part in parts]


@pytest.mark.parametrize(
    ("scene", "points", "due"),
    [
        (LOPSIDED, ADVANCES, ["Receded", "EndAdvances"]),
        (HERTZ, UNTIL_STUCK, ["Receded", "EndAdvances", "EdgeSticks"]),
        (LOPSIDED, UNTIL_TURNED, ["Receded", "EndAdvances", "Receded"]),
        (LOPSIDED, JUMPS, ["EndAdvances"]),
    ],
)
def test_an_end_that_stops_while_the_pressure_changes_advances(scene, points, due):
    solution = followed(scene, points)[-1]
    assert kinds(solution) == due and solution.check().ok


def test_an_end_advances_by_as_much_as_its_equation_says():
    """A = π B ρ + 2 ∫ p' sqrt((x - c1)/(x - c2)) dx beyond c2, Hertz: p' = P'/(π sqrt(r² - x²))."""
    solution = followed(HERTZ, [(1, 0, 0), (1.03185, -0.147875, -0.1911)])[-1]
    part = solution.history.turning_points[-1].marched[-1]
    (P, Q, sigma), r, (c1, c2) = solution.history.path.points[-1], solution.edges[1], part.stick[:2]
    dP, dQ, dtau = P - P0, Q, 0.25 * sigma
    s = part.signs[0]
    angle = 0.5 * np.pi * (np.arange(40) + 0.5) / 40
    x = c2 + (r - c2) * np.sin(angle) ** 2
    # dx over the roots of x - c2 and r - x is twice the change of the angle.
    there = dP / np.pi * np.sqrt((x - c1) / (x + r)) * np.pi / 40
    B = -s * dtau / f
    due = np.pi * B * 0.5 * (c2 - c1) + 2.0 * there.sum()
    assert dP - s * dQ / f == pytest.approx(due, rel=1e-11)


# -- laws -----------------------------------------------------------------------------------------

GROWING = [ONE_STICKS, BOTH_STICK]
ALL = [MEAN_STRESS, TURNED, TRAVELLING, TO_THE_EDGE, *GROWING, ADVANCES]


@pytest.mark.parametrize("points", GROWING)
def test_what_sticks_at_a_growing_edge_satisfies_its_equation_to_rounding(points):
    certificate = followed(HERTZ, points)[-1].check()
    assert certificate.shear.residual <= 1e-12 and certificate.shear.equilibrium <= 1e-13


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


@pytest.mark.parametrize("points", [*ALL, TOGETHER])
def test_a_marched_state_satisfies_its_equations(points):
    for solution in followed(HERTZ, points):
        certificate = solution.check()
        assert certificate.ok
        assert certificate.shear.residual <= 1e-10 and certificate.shear.equilibrium <= 1e-12


@pytest.mark.parametrize("points", ALL)
def test_a_marched_path_in_parts_ends_in_the_same_state(points):
    whole, parts = (followed(LOPSIDED, points, n)[-1] for n in (1, 2))
    x = inside(whole)
    assert parts.stick[0] == pytest.approx(whole.stick[0], abs=1e-9)
    assert parts.shear(x) == pytest.approx(whole.shear(x), abs=1e-10)
    x = inside(whole, 3)
    assert parts.slip(x) == pytest.approx(whole.slip(x), abs=1e-9)
    assert parts.shift == pytest.approx(whole.shift, abs=1e-9)
    assert parts.energy_lost == pytest.approx(whole.energy_lost, rel=1e-7)


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


def test_an_end_that_has_arrived_at_an_edge_leaves_no_zone_of_slip_there():
    part = next(p for p in parts_of(followed(HERTZ, UNTIL_STUCK)[-1]) if isinstance(p, EndAdvances))
    assert 0.0 in (
        part.stick.x1 - part.pressure.contact.x1,
        part.pressure.contact.x2 - part.stick.x2,
    )


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


# -- loads in phase -------------------------------------------------------------------------------

IN_PHASE = [(1, 0, 0), (0.73, 0.28, -0.112), (1, 0, 0), (0.73, 0.28, -0.112)]


def test_loads_that_return_in_phase_bring_back_the_shear_that_they_left():
    """An edge that grew and stuck slips as it retreats, until it is where it was."""
    first, grown, again = followed(HERTZ, IN_PHASE)[1:]
    x = inside(first)
    assert grown.history.turning_points[2].marched and grown.history.turning_points[3].marched
    assert again.shear(x) == pytest.approx(first.shear(x), abs=1e-9 * f)


def test_a_mesh_tends_to_the_shear_of_loads_in_phase():
    """Twice the elements and increments, half the error."""
    states, errors = followed(HERTZ, IN_PHASE), []
    given = [(P * P0, Q * F, sigma * S, 0.0) for P, Q, sigma in IN_PHASE]
    for n in (60, 120):
        mesh = Mesh((-1.2, 1.2), n, 1.0)
        found = on_a_mesh(mesh, HERTZ.profile.height, f, given, n // 6)
        pairs = zip(states[1:], found[1:], strict=True)
        errors.append(max(np.abs(a.shear(mesh.x) - b.shear).mean() for a, b in pairs))
    assert errors[1] < 0.7 * errors[0] < 0.7 * 0.02 * f


RETURNS = [(1, 0, 0), (1.15, 0.135, 0.08), (1.015, 0.0135, 0.008), (1.15, 0.135, 0.08)]
RETURNS_UNDER_MEAN = [(1, 0, 0), (1.45, 0.44, 0.35), (1, 0.1, 0.06), (1.45, 0.44, 0.35)]


def parts_of(solution):
    """The parts of the step to a point of a path that was marched to."""
    return solution.history.turning_points[solution.index].marched


def test_a_second_zone_of_slip_joins_the_first_one_as_loads_return_in_phase():
    state = followed(HERTZ, RETURNS)[-1]
    before, after = parts_of(state)
    mark = state.history[1].stick[0][0]
    assert before.stick.x1 < mark - 0.01 and after.share == 1.0
    assert after.stick.x1 == pytest.approx(mark, abs=1e-5) and after.slips_on
    assert state.check().ok


@pytest.mark.parametrize("earlier", [1e-6, 1e-5])
def test_zones_that_join_leave_the_same_state_from_whenever_it_is_sought(earlier):
    before, after = parts_of(followed(HERTZ, RETURNS)[-1])
    begun = before.share - earlier
    again = joined(before.until(begun).held, after.change, after.signs, (begun, after.share))
    x = np.linspace(*after.kept_in(after.before.pressure.contact)[0], 43)[1:-1]
    assert again.stick.x1 == pytest.approx(after.stick.x1, abs=1e-9)
    assert again.shear(x) == pytest.approx(after.shear(x), abs=1e-9 * f)


def test_a_mesh_tends_to_the_shear_after_two_zones_of_slip_have_joined(monkeypatch):
    """For so long a part only the force of what came into contact is known well."""
    monkeypatch.setattr(marching, "SOON", (0.01,))
    monkeypatch.setattr(marching, "KNOWN", 1e-6)
    state = sie.follow(HERTZ, path_of(RETURNS_UNDER_MEAN))[-1]
    assert [type(part).__name__ for part in parts_of(state)] == ["EdgeSticks", "Joined"]
    given, errors = [(P * P0, Q * F, s * S, 0.0) for P, Q, s in RETURNS_UNDER_MEAN], []
    for n in (60, 120):
        mesh = Mesh((-1.25, 1.25), n, 1.0)
        found = on_a_mesh(mesh, HERTZ.profile.height, f, given, n // 6)[-1]
        errors.append(np.abs(state.shear(mesh.x) - found.shear).mean())
    assert errors[1] < 0.6 * errors[0] < 0.6 * 0.02 * f


CAUGHT_UP = [(1, 0, 0), (1.34, -0.34, 0.16), (0.66, 0.34, -0.16)]


@pytest.fixture(scope="module")
def caught_up():
    """The end of the stick zone recedes on the left, and the edge of contact faster."""
    return followed(HERTZ, CAUGHT_UP)[-1]


def test_slip_turns_where_an_edge_of_contact_catches_up_with_its_zone(caught_up):
    before, after = caught_up.history.turning_points[2].marched
    assert before.signs == (-1.0, 1.0) and after.signs == (1.0, 1.0)
    assert 0.0 < before.stick.x1 - before.pressure.contact.x1 < 1e-5
    assert caught_up.check().ok


def test_a_mesh_tends_to_the_energy_where_an_edge_catches_up_with_a_slip_zone(caught_up):
    """Twice the elements and increments, less than half the error."""
    errors = []
    given = [(P * P0, Q * F, sigma * S, 0.0) for P, Q, sigma in CAUGHT_UP]
    for n in (60, 120):
        mesh = Mesh((-1.3, 1.3), n, 1.0)
        found = on_a_mesh(mesh, HERTZ.profile.height, f, given, n // 6)[-1]
        assert np.abs(caught_up.shear(mesh.x) - found.shear).mean() < 1e-3 * f
        errors.append(abs(found.energy - caught_up.energy_lost))
    assert errors[1] < 0.5 * errors[0] < 0.5 * 0.05 * caught_up.energy_lost


# Loads that stick until they are back at the start (P 1), and slip beyond.
DETOUR = [(1, 0, 0), (1.2, 0.1, 0.05), (0.9, -0.05, -0.025)]


def test_a_detour_that_sticks_costs_no_energy_and_few_states(monkeypatch):
    """The rest of the way slips as the straight way does, which layers answer."""
    states, power = [], SlipRates.power

    def counted(self, pressure, stick):
        states.append(stick)
        return power(self, pressure, stick)

    monkeypatch.setattr(SlipRates, "power", counted)
    detour, straight = (sie.follow(HERTZ, path_of(p)) for p in (DETOUR, DETOUR[::2]))
    assert detour.turning_points[2].marched and not straight.turning_points[1].marched
    assert detour[-1].energy_lost == pytest.approx(straight[-1].energy_lost, rel=1e-9)
    assert len(states) < 300


def test_an_end_next_to_the_mark_where_loads_return_balances_them_to_rounding():
    """What the equations miss there has another slope beyond the mark."""
    profile = sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6))
    scene = sie.Scene(profile=profile, modulus=2.0, normal_load=0.375, friction=0.5, tilt=0.02)
    most, least = (0.3491272, -0.0438307, -0.1277112), (0.3724127, -0.00438307, -0.01277112)
    path = sie.Path([(0.375, 0, 0), most, least, most])
    part = sie.follow(scene, path).turning_points[-1].marched[-1]
    assert max(part.until(part.share - rest).error for rest in (1e-7, 2.2e-8)) < 1e-13


# -- a mesh ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("points", [*ALL, TOGETHER])
def test_a_mesh_comes_near_the_marched_shear_and_energy(points):
    """To the first order of its elements and increments."""
    states, mesh = followed(LOPSIDED, points), Mesh((-1.25, 1.25), 80, 1.0)
    loads = [(*point, 0.0)[:4] for point in points]
    given = [(P * P0, Q * F, sigma * S, tilt) for P, Q, sigma, tilt in loads]
    found = on_a_mesh(mesh, LOPSIDED.profile.height, f, given, 16)
    for state, true in zip(states, found, strict=True):
        assert np.abs(state.shear(mesh.x) - true.shear).mean() <= 0.006 * 0.5 * f
    assert states[-1].energy_lost == pytest.approx(found[-1].energy, rel=0.02)


@pytest.mark.parametrize("points", [OPPOSITE, UNTIL_STUCK], ids=["two directions", "an end stops"])
def test_a_mesh_tends_to_the_slip_of_new_points_and_the_shift(points):
    """Twice the elements and increments, about half the error."""
    state, given = followed(HERTZ, points)[-1], [(*at, 0.0) for at in path_of(points).points]
    errors = []
    for n in (60, 120):
        mesh = Mesh((-1.3, 1.3), n, 1.0)
        found = on_a_mesh(mesh, HERTZ.profile.height, f, given, n // 10)[-1]
        touching = found.pressure > 0.0
        slip = state.slip(mesh.x[touching])
        off = np.abs(slip - found.slip[touching]).mean() / np.abs(slip).max()
        errors.append((off, abs(found.shift / state.shift - 1.0)))
    (slip, shift), (finer_slip, finer_shift) = errors
    assert finer_slip < 0.7 * slip < 0.7 * 0.02
    assert finer_shift < 0.7 * shift < 0.7 * 0.05


@pytest.mark.parametrize(
    ("run", "points"),
    [(followed, TOGETHER), (all_marched, APART)],
    ids=["one direction", "two directions"],
)
def test_the_slip_at_an_edge_is_the_integral_over_the_zone_of_slip(run, points):
    part = run(LOPSIDED, points).turning_points[-1].marched[-1]
    for state in (part.until(0.01), part.until(0.9)):
        along = state.slip(np.array(state.pressure.interval))
        assert [state.slip_at_edge(k) for k in (0, 1)] == pytest.approx(along, rel=1e-10)


def test_no_zone_of_slip_on_the_way_is_opened_for_points_that_come_into_contact(monkeypatch):
    history = followed(LOPSIDED, TOGETHER)
    opened, on_one_side = [], Receded._on_one_side
    monkeypatch.setattr(Receded, "_on_one_side", lambda *at: opened.append(at) or on_one_side(*at))
    (_, x2), (_, wider) = history[2].edges, history[3].edges
    history[3].slip(x2 + (wider - x2) * np.linspace(0.1, 0.9, 5))
    assert {part for part, *_ in opened} <= {
        part for point in history.turning_points for part in point.marched
    }


# -- what is told ---------------------------------------------------------------------------------


def test_the_certificate_says_that_a_state_was_marched_and_how_well_its_ends_are_known():
    told = str(followed(HERTZ, TURNED)[1].check())
    assert "marched, as slip turns at one edge" in told and "of its half-width" in told


def test_a_path_says_which_steps_are_marched():
    plan = str(followed(HERTZ, TURNED[:2]).plan)
    assert "layers" in plan.splitlines()[0] and "marched: slip turns" in plan.splitlines()[1]
    plan = str(followed(HERTZ, BOTH_STICK[:2]).plan)
    assert "marched: the contact grows and sticks" in plan


def test_a_second_zone_of_slip_is_refused_with_the_loads_at_which_it_opens():
    with pytest.raises(sie.ContactError, match=r"step 2 .*second zone of slip opens") as refused:
        followed(HERTZ, [*TRAVELLING, (1, -0.5, -3)])
    assert 0.0 < refused.value.reached["share"] < 0.01 and refused.value.reached["step"] == 2


def test_a_second_zone_of_slip_that_does_not_join_the_first_one_soon_is_refused():
    with pytest.raises(sie.ContactError, match=r"second zone .* an edge sticks and grows") as told:
        followed(HERTZ, RETURNS_UNDER_MEAN)
    assert told.value.reached["step"] == 3 and 0.9 < told.value.reached["share"] < 1.0


def test_the_loads_at_which_a_second_zone_opens_are_told_to_a_millionth_of_the_step():
    """Up to there one zone sticks, and beyond it two do."""
    points = [(1, -0.29, 0.13), (1, 0.04, -0.17), (1, -0.24, 0.37), (1, 0.32, -0.26)]
    with pytest.raises(sie.ContactError, match="second zone of slip opens") as refused:
        followed(HERTZ, points)
    share, (start, end) = refused.value.reached["share"], np.array(points[-2:])
    for further, zones in ((-1e-6, 1), (1e-6, 2)):
        at = tuple(start + (share + further) * (end - start))
        assert len(followed(HERTZ, [*points[:-1], at])[-1].stick) == zones
