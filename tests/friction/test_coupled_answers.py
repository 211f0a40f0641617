"""Slip, gap, energy, limits and refusals of dissimilar bodies under P."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from pressed_cases import PROFILES, solved
from scenes import dissimilar

import sie

STEEL, TITANIUM = sie.Elastic(210e3, 0.3), sie.Elastic(115e3, 0.32)


def test_slip_grows_with_the_load_in_slip_and_stays_in_stick():
    lighter, heavier = (solved(normal_load=P) for P in (1.0, 1.1))
    stuck = np.linspace(0.05, 0.95, 10) * lighter.stick[0][1]
    slipping = np.linspace(1.05, 1.4, 5) * lighter.stick[0][1]
    assert lighter.slip(stuck) == pytest.approx(heavier.slip(stuck), rel=1e-11)
    assert (heavier.slip(slipping) > lighter.slip(slipping)).all()


EITHER = pytest.mark.parametrize("coupling", ["full", "goodman"])


@EITHER
def test_slip_of_a_flat_is_the_integral_of_its_gradient(coupling):
    solution = solved(sie.Flat(1.0), normal_load=1.0, coupling=coupling)
    x = np.linspace(0.7, 0.9, 5)
    step = 1e-5
    gradient = (solution.slip(x + step) - solution.slip(x - step)) / (2.0 * step)
    gamma = solution.shear.hilbert(x) + 0.3 * solution.pressure(x)
    assert gradient == pytest.approx(gamma, rel=1e-7)  # E*/2 = 1


@pytest.mark.parametrize(("load", "friction"), [(600.0, 0.05), (500.0, 0.05), (600.0, 0.06)])
def test_shear_of_little_friction_stays_within_it_up_to_the_ends_of_stick(load, friction):
    pad = {"profile": sie.RoundedFlat(1.0, 50.0), "body": STEEL, "indenter": TITANIUM}
    solution = sie.solve(sie.Scene(**pad, friction=friction, normal_load=load))
    inside = solution.stick[0][1] - 10.0 ** np.arange(-11.0, -6.0)
    p = solution.pressure(inside)
    excess = np.abs(solution.shear(inside)) - friction * p
    assert excess.max() < 1e-11 * friction * p.max()
    assert solution.check().ok


@pytest.mark.parametrize("name", ["wedge", "parabola", "rounded flat", "polynomial"])
def test_gap_opens_beside_the_contact_as_its_slope_says(name):
    solution = solved(PROFILES[name])
    b = solution.half_width
    x = b * np.array([1.0, 1.3, 2.0, 4.0])
    gap = solution.gap(x)
    assert gap[0] == 0.0 and (np.diff(gap) > 0.0).all()
    step = 1e-5 * b
    slope = (solution.gap(x[1:] + step) - solution.gap(x[1:] - step)) / (2.0 * step)
    equation = PROFILES[name].slope(x[1:]) - solution.pressure.hilbert(x[1:])  # E*/2 = 1
    assert slope == pytest.approx(equation, rel=1e-7)


@EITHER
def test_energy_of_a_power_law_is_the_work_of_friction_on_its_self_similar_slip(coupling):
    """q dg/dP is a function of x/b, and b ~ sqrt P under a parabola: E ~ P² (2/E*)."""
    one, more, less, twice = (
        solved(beta=0.1, friction=0.1, normal_load=P, coupling=coupling)
        for P in (1.0, 1.0001, 0.9999, 2.0)
    )
    assert twice.energy_lost == pytest.approx(4.0 * one.energy_lost, rel=1e-9)
    angle = np.pi * (np.arange(300) + 0.5) / 600
    x = one.half_width * np.cos(angle) * (1 - 1e-3)
    weight = 2.0 * one.half_width * np.sin(angle) * np.pi / 600
    work = weight @ (0.1 * one.pressure(x) * (more.slip(x) - less.slip(x)))
    assert work / 2e-4 == pytest.approx(2.0 * one.energy_lost, rel=5e-3)


@EITHER
def test_the_other_sign_of_beta_turns_shear_and_slip_alone(coupling):
    one, other = (solved(beta=b, normal_load=1.0, coupling=coupling) for b in (0.3, -0.3))
    x = np.linspace(-1.0, 1.0, 21) * one.half_width
    assert (one.pressure(x) == other.pressure(x)).all()
    assert (one.shear(x) == -other.shear(x)).all()
    assert (one.slip(x) == -other.slip(x)).all()
    assert one.energy_lost == other.energy_lost


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("length", "stress"), [(1e-6, 1e12), (1e3, 1e-9)])
def test_answer_is_free_of_units(length, stress):
    one = solved(sie.RoundedFlat(0.5, 1.0), normal_load=0.6)
    sizes = {"modulus": 2.0 * stress, "normal_load": 0.6 * length * stress}
    other = one.with_(profile=sie.RoundedFlat(0.5 * length, length), **sizes)
    x = np.linspace(0.01, 0.99, 9) * one.half_width
    assert other.half_width == pytest.approx(length * one.half_width, rel=1e-13)
    assert other.pressure(length * x) == pytest.approx(stress * one.pressure(x), rel=1e-11)
    assert other.shear(length * x) == pytest.approx(stress * one.shear(x), rel=1e-11)
    assert other.energy_lost == pytest.approx(length**2 * stress * one.energy_lost, rel=1e-10)


@pytest.mark.parametrize("name", ["flat", "parabola", "rounded flat", "power"])
def test_pressure_tends_to_that_of_similar_bodies_quadratically(name):
    x = 0.4
    similar = sie.solve(sie.Scene(profile=PROFILES[name], modulus=2.0, normal_load=0.7))
    errors = [
        float(solved(PROFILES[name], beta, beta, normal_load=0.7).pressure(x) - similar.pressure(x))
        for beta in (1e-2, 1e-3)
    ]
    assert abs(errors[0]) < 1e-3 and errors[1] == pytest.approx(0.01 * errors[0], rel=1e-2)


def test_beta_below_rounding_is_that_of_similar_bodies():
    solution = solved(beta=1e-13)
    assert solution.shear is sie.ZERO and solution.check().shear is None


def test_solution_of_two_bodies_answers_as_one_of_their_constants():
    given = {"profile": sie.RoundedFlat(1.0, 50.0), "friction": 0.3, "normal_load": 500.0}
    pair = sie.Scene(**given, body=TITANIUM, indenter=STEEL)
    one, other = (
        sie.solve(s) for s in (pair, sie.Scene(**given, modulus=pair.Estar, dundurs=pair.beta))
    )
    assert one.check().ok
    assert one.half_width == other.half_width and one.stick == other.stick


def test_solution_keeps_its_contact_only_while_nothing_of_it_changes():
    solution = solved()
    _ = solution.half_width
    assert solution.with_(bulk_stress=0.0).coupled is solution.coupled
    assert solution.with_(friction=0.4).stick != solution.stick
    similar = solution.with_(dundurs=0.0)
    assert similar.half_width != solution.half_width and similar.shear is sie.ZERO


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        (sie.Row([sie.Parabola(1.0).shifted(x) for x in (-2.0, 2.0)]), "in 2 patches"),
        (sie.Periodic(sie.Parabola(1.0), 4.0), "give the profile without period"),
        (sie.Polynomial((0.0, 0.0, -0.5, 0.0, 0.5)), r"2 patches: .* grows .* dundurs = 0"),
    ],
)
@EITHER
def test_contact_in_several_patches_is_refused(profile, words, coupling):
    with pytest.raises(sie.ContactError, match=words):
        _ = solved(profile, normal_load=0.01, coupling=coupling).edges


def test_first_yield_without_poissons_ratio_is_refused_before_any_work():
    solution = solved(sie.Wedge(0.1))
    with pytest.raises(ValueError, match="give poisson"):
        solution.elastic_limit()
    assert "pressed" not in vars(solution)


def test_a_trace_is_refused_and_a_polynomial_through_it_is_solved():
    x = np.linspace(-1.5, 1.5, 41)
    h = 0.5 * x * x + 0.1 * x**3 + 0.1 * x**4
    with pytest.raises(sie.ContactError, match=r"fit a sie\.Polynomial to it"):
        _ = solved(sie.Sampled(x, h), normal_load=1.0).edges
    fitted = np.polynomial.Polynomial.fit(x, h, 4).convert().coef
    solution = solved(sie.Polynomial(tuple(fitted)), normal_load=1.0)
    assert solution.check().ok and 0.5 < solution.half_width < 1.5


def test_a_path_of_one_point_is_p_and_then_q():
    (only,) = sie.follow(dissimilar(), sie.Path([(1.0, 0.1)]))
    expected = solved(normal_load=1.0, tangential_load=0.1)
    assert only.stick == expected.stick


def test_surface_stress_where_a_parabola_touched_first_is_that_beside_it():
    solution = solved()
    beside = solution.stress(1e-9, 0.0).xx
    assert solution.stress(0.0, 0.0).xx == pytest.approx(float(beside), rel=1e-7)


SURVIVING = {
    "pressed": {},
    "Goodman's": {"coupling": "goodman"},
    "tilted": {"tilt": 0.01},
    "sheared": {"tangential_load": 0.05},
}


def test_a_point_of_a_path_survives_a_pickle_with_what_was_before_it():
    scene = sie.Scene(
        profile=sie.Parabola(1.0), modulus=1.0, dundurs=0.2, friction=0.5, normal_load=1.0
    )
    point = sie.follow(scene, sie.Path([(1.0, 0.3), (1.0, -0.1)]))[1]
    again = pickle.loads(pickle.dumps(point))
    assert again.stick == point.stick != scene_alone(scene, -0.1).stick
    assert again.history[0].stick == point.history[0].stick


def scene_alone(scene, Q):
    return sie.solve(scene).with_(tangential_load=Q)


@pytest.mark.parametrize("changes", SURVIVING.values(), ids=SURVIVING)
def test_a_solution_of_dissimilar_bodies_survives_a_pickle(changes):
    solution = solved(normal_load=1.0, **changes)
    stress = solution.stress(0.1, 0.2).xx
    again = pickle.loads(pickle.dumps(solution))
    assert again.scene == solution.scene
    assert again.edges == solution.edges and again.stress(0.1, 0.2).xx == stress
