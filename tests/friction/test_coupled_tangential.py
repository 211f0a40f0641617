"""The zones of dissimilar bodies under P, then Q, and the slip gradient that is kept."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from sheared_cases import PROFILES, scene, solved, zones

import sie
from oracles import oblique_edges
from sie.certificate.coupled_check import Nodes, coupled_certificate
from sie.friction.coupled.functions import flat_functions
from sie.friction.coupled.gradient import SlipGradient
from sie.friction.coupled.zones import Map, Zones
from sie.io import scene_file
from sie.numerics.elliptic import modulus_of

# -- the edges -------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", oblique_edges.EDGES)
def test_edges_of_contact_and_stick_agree_with_another_program(case):
    found = zones(solved(None, *case, load=0.5 * math.pi))
    assert found == pytest.approx(np.array(oblique_edges.EDGES[case]), abs=1e-11)


@pytest.mark.parametrize(
    ("case", "near"),
    [
        ((0.3, 0.3, 0.9), (-1.052, -0.61, -0.244, 0.947)),
        ((0.5, 0.5, 0.5), (-1.072, -0.819, -0.029, 0.893)),
        ((0.1, 0.3, 0.2), (-1.002, -0.935, 0.779, 0.992)),
        ((0.25, 0.6, 0.8), (-1.078, -0.685, 0.008, 0.92)),
    ],
)
def test_another_program_finds_the_same_edges(case, near):
    *pair, part = case
    other = oblique_edges.edges(pair, (0.5 * math.pi, part), near)
    assert other == pytest.approx(zones(solved(None, *case, load=0.5 * math.pi)), abs=1e-11)
    assert other == pytest.approx(np.array(oblique_edges.EDGES.get(case, other)), abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", PROFILES)
def test_certificate_holds_for_every_profile(name):
    certificate = solved(PROFILES[name]).check()
    assert certificate.ok
    assert certificate.error < 1e-11
    assert certificate.shear.error < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize(
    ("beta", "friction", "part"),
    [(0.1, 0.6, 0.5), (0.07, 0.3, 0.2), (0.001, 0.3, 0.5), (0.5, 0.5, 0.99), (0.3, 0.3, 1e-3)],
)
def test_certificate_holds_from_narrow_slip_zones_to_incipient_sliding(beta, friction, part):
    certificate = solved(sie.RoundedFlat(0.5, 1.0), beta, friction, part).check()
    assert certificate.ok
    assert max(certificate.error, certificate.shear.equilibrium) < 1e-11


@pytest.mark.slow
@pytest.mark.parametrize(
    ("profile", "beta", "friction", "part"),
    [
        (sie.RoundedFlat(0.5, 1.0), -0.07, 0.3, 0.5),
        (sie.RoundedFlat(0.5, 1.0), -0.07, 0.3, 1e-3),
        (sie.RoundedFlat(0.2, 1.0), 0.13, 0.36, -0.026),
        (sie.RoundedFlat(0.393, 1.0), 0.057, 0.27, -3e-6),
        (sie.Parabola(1.0), 0.0015, 0.031, 8e-5),
        (sie.FromFunction(slope="sinh(x)"), 0.0022, 0.037, 2.5e-5),
        (sie.Power(4.0, 0.4), -0.024, 1.42, -6.4e-6),
    ],
)
def test_slip_gradient_is_kept_where_slip_zones_are_narrow(profile, beta, friction, part):
    certificate = solved(profile, beta, friction, part, load=0.3).check()
    assert certificate.ok
    assert certificate.shear.residual < 2e-10


def test_gradient_in_its_table_is_that_of_its_integrals_beside_a_kink():
    search = solved(sie.RoundedFlat(0.5, 1.0), -0.07, 0.3).tangential_search
    state = search.normal
    y = 0.5 + np.array([-7.5e-6, -5e-6, -1e-6, 1e-7, 1e-5, 1e-3])
    direct = SlipGradient(state.superposition, state.ahead)(y, search.H(y))
    assert search.gamma(y) == pytest.approx(direct, abs=1e-11 * search.limit / state.b)


@pytest.mark.parametrize("flat_base", [0.1, 0.31324513067413756, 0.4185286779378688, 0.7])
def test_slope_of_the_surface_is_finite_one_double_beside_the_contact(flat_base):
    state = solved(sie.RoundedFlat(flat_base, 1.0), -0.0023, 0.0408, 0.0).coupled[1]
    y = state.b * (1.0 + np.finfo(float).eps * np.arange(1.0, 9.0))
    H = state.hilbert_outside(y)
    assert np.isfinite(H).all()
    assert pytest.approx(float(state.half_modulus * (state.b - flat_base)), rel=1e-6) == H


def test_a_steel_punch_on_titanium_is_answered():
    pressed = scene_file.parse(scene_file.example("dissimilar")).scene
    punch = replace(pressed, friction=0.3, tangential_load=75.0)
    solution = sie.solve(punch)
    certificate, similar = (
        solution.check(),
        solution.with_(body=None, indenter=None, modulus=punch.Estar, dundurs=0.0),
    )
    assert certificate.ok and certificate.shear.ok
    # The mismatch shears outwards: Q slips more ahead of the stick zone, and less behind it
    assert solution.stick[0][1] < similar.stick[0][1]
    assert solution.stick[0][0] < similar.stick[0][0]


def test_certificate_is_not_ok_for_another_mismatch():
    right = solved()
    wrong = coupled_certificate(right.coupled[1], replace(right.scene, dundurs=0.3001), 1e-13)
    assert not wrong.ok


def test_certificate_is_as_strict_where_slip_zones_are_narrow():
    right = solved(None, 0.1, 1.0)
    pressed = sie.solve(replace(right.scene, tangential_load=0.0))
    assert pressed.slip_widths[1] < 1e-8
    certificate = right.check()
    assert certificate.ok and certificate.abscissae < 1e-12
    wrong = replace(right.scene, dundurs=0.1 * (1.0 + 1e-7))
    assert not coupled_certificate(right.coupled[1], wrong, 1e-13).ok


def test_rounding_of_a_narrow_rim_is_counted_in_the_stick_zone_too():
    right = solved(sie.RoundedFlat(1.0, 1.0), 0.2, 0.3, load=1e-8)
    certificate = right.check()
    assert certificate.ok and certificate.shear.abscissae < 1e-8
    wrong = replace(right.scene, dundurs=0.2 * (1.0 + 1e-6))
    assert not coupled_certificate(right.coupled[1], wrong, 1e-13).shear.ok


def test_certificate_is_not_ok_for_another_load():
    right = solved()
    other = replace(right.scene, tangential_load=right.tangential_load * (1.0 + 1e-6))
    assert not coupled_certificate(right.coupled[1], other, 1e-13).ok


# -- mirror images, scale and limits ---------------------------------------------------------------


@pytest.mark.parametrize(("beta", "part"), [(0.3, -0.5), (-0.3, 0.5), (-0.3, -0.5)])
def test_signs_of_the_load_and_of_the_mismatch_give_mirror_images(beta, part):
    one, other = solved(), solved(None, beta, 0.3, part)
    flip = math.copysign(1.0, beta * part)
    expected = zones(one) if flip > 0.0 else -zones(one)[::-1]
    assert zones(other) == pytest.approx(expected, rel=1e-13)
    x = np.linspace(*other.edges, 41)[1:-1]
    sign = math.copysign(1.0, part)
    assert other.pressure(x) == pytest.approx(one.pressure(flip * x), rel=1e-11)
    assert other.shear(x) == pytest.approx(sign * one.shear(flip * x), abs=1e-12)
    assert other.slip(x) == pytest.approx(sign * one.slip(flip * x), abs=1e-12)


def test_lengths_and_moduli_only_scale_the_answer():
    one = solved(sie.RoundedFlat(0.5, 1.0))
    small = sie.solve(
        replace(
            one.scene,
            profile=sie.RoundedFlat(0.5e-6, 1e-6),
            modulus=2e12,
            normal_load=1e6,
            tangential_load=one.tangential_load * 1e6,
        )
    )
    assert zones(small) * 1e6 == pytest.approx(zones(one), rel=1e-11)


@pytest.mark.parametrize("profile", [sie.Parabola(1.0), sie.RoundedFlat(0.5, 1.0)])
def test_zones_tend_to_cattaneos_in_proportion_to_the_mismatch(profile):
    alike = zones(solved(profile, beta=0.0))
    near, nearer = (np.abs(zones(solved(profile, b)) - alike).max() for b in (1e-3, 1e-4))
    assert near < 1e-2
    assert near / nearer == pytest.approx(10.0, rel=0.05)


def test_contact_tends_to_that_of_full_sliding():
    sliding = sie.solve(replace(scene(part=0.0), sliding=1))
    last = solved(part=1.0 - 1e-8)
    assert last.edges == pytest.approx(sliding.edges, abs=1e-7)
    assert np.ptp(last.stick) < 1e-3


def test_zones_leave_those_of_the_normal_load_like_the_root_of_a_small_load():
    c, b = solved(part=0.0).stick[0][1], solved(part=0.0).half_width
    grown = [(c - zones(solved(part=q))[2]) / math.sqrt(q) for q in (1e-2, 1e-3)]
    assert grown[0] == pytest.approx(grown[1], rel=0.05)
    assert np.abs(solved(part=1e-3).edges) == pytest.approx(b, rel=1e-3)


def test_full_stick_gives_way_to_a_load():
    solution = solved(None, 0.05, 0.8, 0.4)
    assert solved(None, 0.05, 0.8, 0.0).coupled[1].full_stick
    assert zones(solution)[1] > solution.edges[0] + 0.01
    assert solution.check().error < 1e-11


# -- the slip gradient of normal loading -----------------------------------------------------------


@pytest.mark.parametrize("name", ["wedge", "parabola", "rounded flat", "kinked"])
@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.5, 0.1)])
def test_slip_gradient_is_that_of_the_tractions(name, beta, friction):
    solution = solved(PROFILES[name], beta, friction, 0.0)
    state = solution.coupled[1]
    y = state.b * np.array([0.05, 0.37, 0.61, 0.93])
    gradient = SlipGradient(state.superposition, state.ahead)
    found = gradient(y, state.half_modulus * PROFILES[name].slope(y))
    nodes = Nodes(state.values)
    assert found == pytest.approx(nodes.gradient(nodes.at(y), beta), abs=1e-11)


def test_kept_slip_gradient_of_a_parabola_is_linear():
    state = solved(None, 0.3, 0.3, 0.0, load=0.5 * math.pi).coupled[1]
    y = state.c * np.linspace(0.1, 0.9, 5)
    gradient = SlipGradient(state.superposition, state.ahead)(y, y)
    assert gradient / y == pytest.approx(0.3961609253, rel=1e-9)


def test_slip_gradient_beside_a_flat_is_the_principal_value_of_its_shear():
    beta, friction, at = 0.3, 0.3, 1.5
    flat = flat_functions(beta, friction)
    context = mpmath.MPContext()
    context.dps = 15

    def shear(t, rest):
        place = tuple(np.array([float(v)]) for v in (t, rest, abs(flat.rest - rest)))
        return friction * float(flat.pressure(*place)[0]) - float(flat.shear_deficit(*place)[0])

    def integrand(t, rest):
        return shear(t, rest) * (1.0 / (at - t) - 1.0 / (at + t)) / context.pi

    start, power = 0.5 * (1.0 + flat.c), 1.0 / (1.0 - flat.h)

    def next_to_edge(u):  # smooth in u, as q ~ (1 - t)^-h
        rest = (1.0 - start) * u**power
        return integrand(1.0 - rest, rest) * power * (1.0 - start) * u ** (power - 1.0)

    parts = [
        context.quad(lambda t: integrand(t, 1.0 - t), ends)
        for ends in ([0.0, flat.c], [flat.c, start])
    ]
    E = float(sum(parts) + context.quad(next_to_edge, [0, 1]))
    one = np.array([1.0])
    D = float(flat.outside(one / at, one - one / at)[0]) / at
    J = float(flat._J(one * at, one - at, flat._S_in_stick)[0])
    assert friction * D - J == pytest.approx(E, abs=1e-9)


# -- the equations behind it -----------------------------------------------------------------------


@pytest.mark.parametrize("k", [1e-9, 0.3, 0.999])
def test_quarter_periods_of_a_modulus_are_mpmaths(k):
    rest = math.sqrt((1.0 - k) * (1.0 + k))
    found = modulus_of(k, rest)
    context = mpmath.MPContext()
    context.dps = 40
    square = context.mpf(k) ** 2
    K, K_complement = float(context.ellipk(square)), float(context.ellipk(1 - square))
    assert pytest.approx(K, rel=1e-14) == found.K
    assert found.K_complement == pytest.approx(K_complement, rel=1e-14)


def test_map_takes_the_four_edges_to_their_places():
    zones = Zones(-1.2, -0.9, 0.1, 0.7)
    m = Map(zones, 0.05)
    y = np.array([-1.0 / m.k, -1.0, 1.0, 1.0 / m.k])
    middle = 0.5 * (zones.e1 + zones.e2)
    assert middle + m.place(1.0 + y, 1.0 - y) == pytest.approx(np.array(zones), abs=1e-14)
