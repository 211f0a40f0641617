"""Slip, gap, energy, limits and refusals of dissimilar bodies under P."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from pressed_cases import PROFILES, scene, solved

import sie
from sie.friction.coupled.flat import flat_punch
from sie.numerics.gauss_jacobi import gauss_jacobi

# -- slip, gap, energy -----------------------------------------------------------------------------


def test_slip_grows_with_the_load_in_slip_and_stays_in_stick():
    lighter, heavier = (solved(normal_load=P) for P in (1.0, 1.1))
    stuck = np.linspace(0.05, 0.95, 10) * lighter.stick[0][1]
    slipping = np.linspace(1.05, 1.4, 5) * lighter.stick[0][1]
    assert lighter.slip(stuck) == pytest.approx(heavier.slip(stuck), rel=1e-11)
    assert (heavier.slip(slipping) > lighter.slip(slipping)).all()


def test_slip_of_a_flat_is_the_integral_of_its_gradient():
    solution = solved(sie.Flat(1.0))
    x = np.linspace(0.7, 0.9, 5)
    step = 1e-5
    gradient = (solution.slip(x + step) - solution.slip(x - step)) / (2.0 * step)
    gamma = solution.shear.hilbert(x) + 0.3 * solution.pressure(x)
    assert gradient == pytest.approx(gamma, rel=1e-7)  # E*/2 = 1


@pytest.mark.parametrize("exponent", [1.2, 6.0, 10.0])
def test_certificate_holds_for_large_exponents(exponent):
    certificate = solved(sie.Power(exponent, 0.4)).check()
    assert certificate.ok
    assert max(certificate.residual, certificate.shear.residual) < 5e-12


@pytest.mark.parametrize(("load", "friction"), [(600.0, 0.05), (500.0, 0.05), (600.0, 0.06)])
def test_shear_of_little_friction_stays_within_it_up_to_the_ends_of_stick(load, friction):
    steel, titanium = sie.Elastic(210e3, 0.3), sie.Elastic(115e3, 0.32)
    solution = sie.solve(
        sie.Scene(
            profile=sie.RoundedFlat(1.0, 50.0),
            body=steel,
            indenter=titanium,
            friction=friction,
            normal_load=load,
        )
    )
    inside = solution.stick[0][1] - 10.0 ** np.arange(-11.0, -6.0)
    p = solution.pressure(inside)
    excess = np.abs(solution.shear(inside)) - friction * p
    assert excess.max() < 1e-11 * friction * p.max()
    assert solution.check().ok


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rounded flat", "kinked"])
def test_energy_grows_with_the_load_by_friction_on_the_slip_of_the_flat(name):
    x, w = gauss_jacobi(24, 0.0, 0.0)[::2]
    nodes, weights = gauss_jacobi(6, 0.0, 0.0)[::2]
    flat, rates = flat_punch(0.3, 0.3), []
    for P in 2.0 + 0.1 * nodes:
        state = solved(PROFILES[name], normal_load=P).coupled[1]
        b = state.half_width
        places = np.array([flat.c * b, *(y for y in state.marks if y > 1.000001 * flat.c * b)])
        lo, length = places[:-1, None], np.diff(places)[:, None]
        # Broken powers of the distances from both ends become smooth
        part = x**4 * (35.0 - 84.0 * x + 70.0 * x**2 - 20.0 * x**3)
        rest, dx = part[::-1], w * 140.0 * (x * (1.0 - x)) ** 3
        y, to_end = (lo + length * part).ravel(), (b - places[1:, None]) + length * rest
        p = state.rows(y, to_end.ravel())[0]
        g = flat.slip(y / b - flat.c, to_end.ravel() / b)
        rates.append(2.0 * 0.3 * float((length * dx).ravel() @ (p * g)))
    heavy, light = (solved(PROFILES[name], normal_load=P).energy_lost for P in (2.1, 2.0))
    assert heavy - light == pytest.approx(0.1 * float(weights @ np.array(rates)), rel=1e-8)


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


# -- symmetry, scale, limits -----------------------------------------------------------------------


def test_the_other_sign_of_beta_turns_shear_and_slip_alone():
    one, other = solved(beta=0.3), solved(beta=-0.3)
    x = np.linspace(-1.0, 1.0, 21) * one.half_width
    assert (one.pressure(x) == other.pressure(x)).all()
    assert (one.shear(x) == -other.shear(x)).all()
    assert (one.slip(x) == -other.slip(x)).all()
    assert one.energy_lost == other.energy_lost


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("length", "stress"), [(1e-6, 1e12), (1e3, 1e-9)])
def test_answer_is_free_of_units(length, stress):
    one = solved(sie.RoundedFlat(0.5, 1.0), normal_load=0.6)
    other = sie.solve(
        sie.Scene(
            profile=sie.RoundedFlat(0.5 * length, length),
            modulus=2.0 * stress,
            dundurs=0.3,
            friction=0.3,
            normal_load=0.6 * length * stress,
        )
    )
    x = np.linspace(0.01, 0.99, 9) * one.half_width
    assert other.half_width == pytest.approx(length * one.half_width, rel=1e-13)
    assert other.pressure(length * x) == pytest.approx(stress * one.pressure(x), rel=1e-11)
    assert other.shear(length * x) == pytest.approx(stress * one.shear(x), rel=1e-11)
    assert other.energy_lost == pytest.approx(length**2 * stress * one.energy_lost, rel=1e-10)


@pytest.mark.parametrize("name", ["flat", "parabola", "rounded flat"])
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


def test_rounded_flat_tends_to_a_parabola():
    parabola = solved(sie.Parabola(1.0), normal_load=0.5)
    nearly = solved(sie.RoundedFlat(1e-5, 1.0), normal_load=0.5)
    assert nearly.half_width == pytest.approx(parabola.half_width, rel=1e-4)


@pytest.mark.parametrize("exponent", [1.0, 2.0, 3.7, 6.0])
def test_loads_of_power_laws_are_those_of_similar_bodies_as_beta_vanishes(exponent):
    profile = sie.Wedge(0.4) if exponent == 1.0 else sie.Power(exponent, 0.4)
    one, other = (solved(profile, beta, 1e-7, half_width=1.0) for beta in (1e-7, 0.0))
    assert one.normal_load == pytest.approx(other.normal_load, rel=1e-12)


# -- values and refusals ---------------------------------------------------------------------------


def test_solution_of_two_bodies_answers_as_one_of_their_constants():
    steel, titanium = sie.Elastic(210e3, 0.3), sie.Elastic(110e3, 0.34)
    profile = sie.RoundedFlat(1.0, 50.0)
    pair = sie.Scene(
        profile=profile, body=titanium, indenter=steel, friction=0.3, normal_load=500.0
    )
    constants = sie.Scene(
        profile=profile, modulus=pair.Estar, dundurs=pair.beta, friction=0.3, normal_load=500.0
    )
    one, other = sie.solve(pair), sie.solve(constants)
    assert one.check().ok
    assert one.half_width == other.half_width and one.stick == other.stick


def test_solution_keeps_its_contact_only_while_nothing_of_it_changes():
    solution = solved()
    _ = solution.half_width
    assert solution.with_(bulk_stress=0.0).coupled is solution.coupled
    assert solution.with_(friction=0.4).stick != solution.stick
    similar = solution.with_(dundurs=0.0)
    assert similar.half_width != solution.half_width and similar.shear is sie.ZERO


def test_a_moment_is_refused_with_what_to_do():
    with pytest.raises(sie.ContactError, match="give a tilt in its place"):
        sie.solve(scene(normal_load=1.0, moment=0.01))


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        (sie.Row([sie.Parabola(1.0).shifted(x) for x in (-2.0, 2.0)]), "in 2 patches"),
        (sie.Periodic(sie.Parabola(1.0), 4.0), "give the profile without period"),
        (sie.Polynomial((0.0, 0.0, -0.5, 0.0, 0.5)), "patches"),
    ],
)
def test_contact_in_several_patches_is_refused(profile, words):
    scene = sie.Scene(profile=profile, modulus=2.0, dundurs=0.3, friction=0.3, normal_load=0.01)
    with pytest.raises(sie.ContactError, match=words):
        _ = sie.solve(scene).edges


def test_first_yield_without_poissons_ratio_is_refused_before_any_work():
    solution = sie.solve(
        sie.Scene(profile=sie.Wedge(0.1), modulus=2.0, dundurs=0.3, friction=0.3, normal_load=1.0)
    )
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


def test_a_path_of_dissimilar_bodies_is_refused():
    with pytest.raises(sie.ContactError, match="path of dissimilar bodies"):
        sie.follow(scene(), sie.Path([(1.0, 0.0), (0.5, 0.0)]))


def test_a_path_of_one_point_is_p_and_then_q():
    (only,) = sie.follow(scene(half_width=None, normal_load=1.0), sie.Path([(1.0, 0.1)]))
    expected = sie.solve(scene(half_width=None, normal_load=1.0, tangential_load=0.1))
    assert only.stick == expected.stick


def test_the_pressure_under_a_wedge_is_infinite_on_its_axis():
    assert float(solved(sie.Wedge(0.1)).pressure(0.0)) == math.inf


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


@pytest.mark.parametrize("changes", SURVIVING.values(), ids=SURVIVING)
def test_a_solution_of_dissimilar_bodies_survives_a_pickle(changes):
    solution = solved(normal_load=1.0, **changes)
    stress = solution.stress(0.1, 0.2).xx
    again = pickle.loads(pickle.dumps(solution))
    assert again.scene == solution.scene
    assert again.edges == solution.edges and again.stress(0.1, 0.2).xx == stress
