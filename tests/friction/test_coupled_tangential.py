"""Dissimilar bodies under P, then Q: equations (1) and (12) coupled, with a kept slip gradient."""

from __future__ import annotations

import itertools
import math
import re
from dataclasses import replace
from functools import partial

import mpmath
import numpy as np
import pytest
from scenes import dissimilar

import sie
from sie.certificate.coupled_check import gradient_of_slip
from sie.certificate.coupled_shear_check import sheared_certificate
from sie.friction.coupled import energy
from sie.friction.coupled.energy import CERTIFIED, START, Growth, _integral, _power
from sie.friction.coupled.functions import flat_functions
from sie.friction.coupled.gradient import SlipGradient
from sie.friction.coupled.sheared import ShearedContact
from sie.friction.coupled.sheared_contact import found_state, keeps_friction_law
from sie.friction.coupled.slip_rate import SlipRate
from sie.friction.coupled.tangential import TangentialSearch
from sie.friction.coupled.zones import Map, Zones
from sie.io import scene_file
from sie.numerics.elliptic import modulus_of

# (x1, e1, e2, x2) under a parabola, E* = 2, R = 1, P = π/2, by (β, f, Q/(f P)), to the digits that
# two formulations agree in: one with p_d on panels, and one with three moments.
REFERENCES = {
    (0.3, 0.3, 0.9): (-1.0519254056, -0.6097293963, -0.244163237, 0.9472096729),
    (0.3, 0.3, 0.3): (-1.0057559987, -0.8926580288, 0.158912098, 0.9647789599),
    (0.2, 0.3, 0.5): (-1.01532322015, -0.83988900820, 0.20122605354, 0.97285851730),
    (0.5, 0.5, 0.5): (-1.07217272827, -0.8194328666, -0.029391648, 0.89252781776),
}
PROFILES = {
    "wedge": sie.Wedge(0.1),
    "parabola": sie.Parabola(1.0),
    "power": sie.Power(2.5, 0.4),
    "rounded flat": sie.RoundedFlat(0.5, 1.0),
    "nearly flat": sie.RoundedFlat(20.0, 1.0),
    "function": sie.FromFunction(slope="sinh(x)"),
    "shifted": sie.Parabola(1.0).shifted(3.0),
    "kinked": sie.Piecewise((-2.0, -0.4, 0.4, 2.0), ((-0.8, 1.0), (0.0, 0.5), (0.8, 1.0))),
}


def scene(profile=None, beta=0.3, friction=0.3, part=0.5, load=1.0, **others):
    loads = {"normal_load": load, "tangential_load": part * friction * load}
    return dissimilar(profile, beta, friction, **loads, **others)


def solved(*args, **kwargs):
    return sie.solve(scene(*args, **kwargs))


def zones(solution):
    ((e1, e2),) = solution.stick
    x1, x2 = solution.edges
    return np.array([x1, e1, e2, x2])


# -- the edges -------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", REFERENCES)
def test_edges_of_contact_and_stick_agree_with_another_formulation(case):
    found = zones(solved(None, *case, load=0.5 * math.pi))
    assert found == pytest.approx(np.array(REFERENCES[case]), abs=6e-10)


@pytest.mark.parametrize("name", PROFILES)
def test_certificate_holds_for_every_profile(name):
    certificate = solved(PROFILES[name]).check()
    assert certificate.ok
    assert certificate.error < 1e-11
    assert certificate.shear.error < 1e-10


@pytest.mark.parametrize(
    ("beta", "friction", "part"),
    [(0.1, 0.6, 0.5), (0.07, 0.3, 0.2), (0.001, 0.3, 0.5), (0.5, 0.5, 0.99), (0.3, 0.3, 1e-3)],
)
def test_certificate_holds_from_narrow_slip_zones_to_incipient_sliding(beta, friction, part):
    certificate = solved(sie.RoundedFlat(0.5, 1.0), beta, friction, part).check()
    assert certificate.ok
    assert max(certificate.error, certificate.shear.equilibrium) < 1e-11


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
    wrong = sheared_certificate(right.coupled[1], replace(right.scene, dundurs=0.3001), 1e-13)
    assert not wrong.ok


def test_certificate_is_not_ok_for_another_load():
    right = solved()
    other = replace(right.scene, tangential_load=right.tangential_load * (1.0 + 1e-6))
    assert not sheared_certificate(right.coupled[1], other, 1e-13).ok


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
    assert found == pytest.approx(gradient_of_slip(state, y, beta), abs=1e-11)


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


# -- the state -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", PROFILES)
def test_shear_is_friction_times_pressure_in_slip_and_less_in_stick(name):
    solution = solved(PROFILES[name])
    x1, e1, e2, x2 = zones(solution)
    slip = np.append(x1 + (e1 - x1) * np.linspace(0.01, 0.99, 9), np.linspace(e2, x2, 11)[1:-1])
    assert solution.shear(slip) == pytest.approx(0.3 * solution.pressure(slip), rel=1e-12)
    stick = np.linspace(e1, e2, 32)[1:-1]
    assert (np.abs(solution.shear(stick)) < 0.3 * solution.pressure(stick)).all()


@pytest.mark.parametrize("name", ["wedge", "parabola", "rounded flat"])
def test_potentials_are_those_of_the_tractions(name):
    solution = solved(PROFILES[name])
    z = np.array([1e6 + 1e6j]) * solution.half_width
    for traction, load in (
        (solution.pressure, solution.normal_load),
        (solution.shear, solution.tangential_load),
    ):
        assert traction.resultant == load
        assert math.pi * traction.cauchy(z) * z == pytest.approx(np.array([load]), rel=1e-5)
        x = solution.half_width * np.array([-0.83, -0.31, 0.07, 0.55])
        assert traction.cauchy(x).imag == pytest.approx(-traction(x), abs=1e-12)
    beside = np.array([-1.3, 1.4]) * solution.half_width
    hilbert = solution.coupled[1].hilbert_outside(beside)
    assert solution.pressure.hilbert(beside) == pytest.approx(hilbert, abs=1e-12)


def test_moment_is_that_of_the_pressure():
    solution = solved(sie.RoundedFlat(0.5, 1.0).shifted(2.0))
    x1, x2 = solution.edges
    phi = (np.arange(4000) + 0.5) * math.pi / 4000
    r = 0.5 * (x2 - x1)
    x = 0.5 * (x1 + x2) + r * np.cos(phi)
    moment = (solution.pressure(x) * x * r * np.sin(phi)).sum() * math.pi / 4000
    assert solution.moment == pytest.approx(moment, rel=1e-6)
    assert solution.pressure.moment == solution.moment


def test_slip_beyond_that_of_the_normal_load_goes_with_the_load():
    before, after = solved(part=0.0), solved()
    _, e1, e2, x2 = zones(after)
    b = before.half_width
    stick, slip = (
        np.linspace(e1, e2, 9),
        np.append(np.linspace(-b, e1, 7)[:-1], np.linspace(e2, x2, 7)[1:]),
    )
    assert after.slip(stick) == pytest.approx(before.slip(stick), abs=1e-14)
    assert (after.slip(slip) > before.slip(slip)).all()
    assert after.slip(np.array([e1 - 1e-9, e2 + 1e-9])) == pytest.approx(
        before.slip(np.array([e1, e2])), abs=1e-9
    )


def test_energy_is_the_work_of_friction_on_the_slip():
    one, other = (solved(part=part) for part in (0.49, 0.51))
    lo, hi = max(one.edges[0], other.edges[0]), min(one.edges[1], other.edges[1])
    phi = (np.arange(1000) + 0.5) * math.pi / 1000
    x = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(phi)
    carried = 0.5 * 0.3 * (one.pressure(x) + other.pressure(x))
    work = carried * (other.slip(x) - one.slip(x)) * np.sin(phi)
    lost = other.energy_lost - one.energy_lost
    assert lost == pytest.approx(work.sum() * 0.5 * (hi - lo) * math.pi / 1000, rel=1e-3)


def test_power_of_narrow_slip_zones_is_the_work_of_friction_on_their_slip():
    step, part, f = 0.002, 1e-5, 0.3
    before, now, after = (solved(None, 0.01, f, part * (1.0 + k * step)) for k in (-1.0, 0.0, 1.0))
    states = growth(now)
    (x1, e1, e2, x2), work = now.coupled[1].trial.zones, 0.0
    assert e1 - x1 < 1e-4 * (x2 - x1)
    t, weight = np.polynomial.legendre.leggauss(40)
    phi = 0.5 * math.pi * (1.0 + t)
    for lo, hi in ((x1, e1), (e2, x2)):
        x = 0.5 * (lo + hi) - 0.5 * (hi - lo) * np.cos(phi)
        dx = 0.25 * math.pi * (hi - lo) * np.sin(phi) * weight
        work += dx @ (f * now.pressure(x) * (after.slip(x) - before.slip(x)))
    # With rules that do not resolve the slip zones it is off by 3e-3; differences in Q leave 2e-6
    assert _power(states.passed_state(states.end)) == pytest.approx(
        work / (after.tangential_load - before.tangential_load), rel=2e-5
    )


def test_energy_of_narrow_slip_zones_takes_few_states():
    profile = sie.Polynomial((0.0, 0.0, 0.5, 0.0, 0.3))
    states = growth(solved(profile, 0.0035, 5.06, 2e-5))
    total, error = _integral(states, START)
    assert states.states < 20 and error < 1e-8 * total


def test_energy_is_refused_where_states_below_the_least_load_count(monkeypatch):
    """The states give a sum, but not what the left slip zone changes: at most 3e-5 of it."""
    monkeypatch.setattr(energy, "UNSOLVED", 1e-5)
    solution = solved(sie.Polynomial((0.0, 0.0, 0.5, 0.0, 0.3)), 0.238, 0.106, 6.1e-5, 0.02)
    with pytest.raises(sie.ContactError, match="come into contact under the smallest"):
        _ = solution.energy_lost


def test_energy_asks_for_no_state_whose_contact_spreads_over_stick(monkeypatch):
    """Each takes a march of its own, and its zones have no power here."""

    def spreading(search, Q):
        pytest.fail(f"a march up to Q = {Q:.3g}")

    monkeypatch.setattr("sie.solution.spreading_state", spreading)
    solution = solved(beta=0.25, friction=2.0, part=0.6)
    with pytest.raises(sie.ContactError, match="sum over the states under smaller loads"):
        _ = solution.energy_lost


def trials_of(monkeypatch, function):
    """How many times the conditions on four edges are computed."""
    counted, trial = [], TangentialSearch.trial
    monkeypatch.setattr(
        TangentialSearch, "trial", lambda *args, **more: counted.append(0) or trial(*args, **more)
    )
    function()
    return len(counted)


def growth(solution):
    return Growth(solution.coupled[1], partial(found_state, solution.tangential_search))


def test_energy_finds_each_state_from_those_next_to_it(monkeypatch):
    profile = sie.RoundedFlat(1.0, 50.0)
    punch = solved(profile, beta=0.06, friction=0.1, part=0.5, load=0.01)
    alone = trials_of(monkeypatch, lambda: solved(profile, 0.06, 0.1, 0.4, 0.01).coupled)
    states = growth(punch)
    assert trials_of(monkeypatch, lambda: _integral(states, START)) < states.states * alone / 2


@pytest.mark.parametrize(
    ("profile", "beta", "friction"),
    [(sie.Parabola(1.0), 0.2, 0.5), (sie.RoundedFlat(0.5, 1.0), 0.1, 0.3)],
)
def test_energy_is_certified_where_the_edges_pass_kinks_and_next_to_sliding(
    profile, beta, friction
):
    states = growth(solved(profile, beta, friction, part=0.999))
    assert states.passed
    ends = np.unique([states.end, *states.passed, 0.02 * states.passed[-1]])
    t, weights = np.polynomial.legendre.leggauss(18)
    s = 0.5 * (1.0 + t)
    # Nodes crowd towards both ends like a cube
    part, slope = s**3 * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s)) ** 2
    total = 0.0
    for lo, hi in itertools.pairwise(ends):
        rates = [states.rate(lo + (hi - lo) * place) for place in part]
        total += 0.5 * (hi - lo) * (weights * slope) @ rates
    assert _integral(states, START)[0] == pytest.approx(total, rel=CERTIFIED)


@pytest.mark.parametrize("part", [0.05, 0.5, 0.99])
def test_energy_and_shift_tend_to_those_of_similar_bodies(part):
    similar, nearly = solved(beta=0.0, part=part), solved(beta=1e-5, part=part)
    assert nearly.energy_lost == pytest.approx(similar.energy_lost, rel=1e-5)
    assert nearly.shift == pytest.approx(similar.shift, rel=1e-6)


def test_rate_of_the_slip_gradient_is_its_change_with_the_load():
    before, now, after = (solved(part=part).coupled[1] for part in (0.499, 0.5, 0.501))
    (x1, e1, e2, x2) = now.trial.zones
    rate = SlipRate(now.trial.zones, 0.3, 0.3)
    part = np.linspace(0.1, 0.9, 9)
    for side, stick, edge in ((1.0, e2, x2), (-1.0, e1, x1)):
        x = stick + (edge - stick) * part
        change = (after._gain(x) - before._gain(x)) / (after.Q - before.Q)
        found = rate.gradient(side, abs(x - stick), abs(edge - x))
        assert found == pytest.approx(change, rel=2e-4)


def test_shift_is_the_same_from_the_other_end_of_the_stick_zone():
    """The slip gradient up to infinity from e1, minus that under P alone and a bonded contact's."""
    beta, solution = 0.3, solved(part=0.5)
    normal = solution.with_(tangential_load=0.0)
    ((e1, _),) = solution.stick

    def displacement(state):
        """E*/2 ∫(γ - Q/(π x)) dx from e1 on."""
        lo, hi = state.edges
        phi = (np.arange(10_000) + 0.5) * math.pi / 10_000
        x = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(phi)
        dx = 0.5 * (hi - lo) * np.sin(phi) * math.pi / 10_000
        own = -state.shear(x) * np.log(np.abs(x - e1)) / math.pi
        return float((own + beta * state.pressure(x) * (x > e1)) @ dx)

    eta = math.atanh(beta) / math.pi
    bonded = float(mpmath.re(mpmath.digamma(0.5 + 1j * eta)) - mpmath.digamma(0.5))
    bonded += math.log(0.5 * normal.half_width)
    gained = displacement(solution) - displacement(normal)
    gained += solution.tangential_load / math.pi * bonded
    assert solution.shift == pytest.approx(gained, rel=1e-3)


def test_energy_and_shift_are_those_of_the_mirrored_load():
    there, back = solved(part=0.4), solved(part=-0.4)
    assert there.energy_lost > there.with_(tangential_load=0.0).energy_lost > 0.0
    assert back.energy_lost == pytest.approx(there.energy_lost, rel=1e-12)
    assert back.shift == -there.shift


def test_gap_opens_as_the_profile_and_the_pressure_ask():
    solution = solved(sie.RoundedFlat(0.5, 1.0))
    x1, x2 = solution.edges
    for x in (x1 - 0.3, x2 + 0.2):
        step = 1e-5
        ends = solution.gap([x - step, x + step])
        slope = solution.scene.profile.slope([x]) - solution.pressure.hilbert([x])
        assert (ends[1] - ends[0]) / (2.0 * step) == pytest.approx(float(slope[0]), rel=1e-8)
    assert (solution.gap([x1, 0.0, x2]) == 0.0).all()
    assert (solution.gap([x1 - 1e-4, x2 + 1e-4]) > 0.0).all()


def test_gap_is_small_one_double_beside_the_contact():
    solution = solved(sie.Wedge(0.3), load=0.4)
    beside = np.nextafter(solution.edges, (-np.inf, np.inf))
    assert (np.abs(solution.gap(beside)) < 1e-14).all()


def test_surface_stress_is_in_balance_with_the_tractions():
    solution = solved(sie.RoundedFlat(0.5, 1.0), poisson=0.3)
    x = np.linspace(*solution.edges, 11)[1:-1]
    surface = solution.surface_stress(x)
    assert surface.yy == pytest.approx(-solution.pressure(x), abs=1e-12)
    assert surface.xy == pytest.approx(-solution.shear(x), abs=1e-12)


def test_largest_tension_is_at_the_trailing_edge():
    solution = solved(poisson=0.3)
    assert solution.peak_tension().x == pytest.approx(solution.edges[0], rel=1e-6)


# -- with other loads ------------------------------------------------------------------------------


def test_another_tangential_load_keeps_the_state_of_the_normal_load():
    one = solved()
    _ = one.edges
    other = one.with_(tangential_load=0.1)
    assert other.tangential_search is one.tangential_search
    assert zones(other) == pytest.approx(zones(sie.solve(other.scene)), rel=1e-12)


def test_full_load_slides():
    assert solved(part=1.0).stick == ()


def test_plan_names_the_stages_that_are_filled():
    planned = sie.plan(scene(), want=("edges", "pressure", "check"))
    solution = solved()
    _ = solution.edges, solution.pressure(0.0), solution.check()
    assert planned.stages <= set(vars(solution))


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        (sie.Flat(1.0), "corner of the indenter"),
        (sie.Piecewise((-0.3, 0.3), ((0.0, 1.0),)), "corner"),
    ],
)
def test_sharp_edges_are_refused_with_the_width_of_the_zone_that_is_missing(profile, words):
    with pytest.raises(sie.ContactError, match=words):
        _ = solved(profile).edges


@pytest.mark.parametrize(
    "profile", [sie.Flat(1.0), sie.Flat(0.1).shifted(3.0), sie.Piecewise((-1.0, 1.0), ((0.0,),))]
)
def test_a_sharp_flat_is_refused_before_anything_is_solved(profile):
    with pytest.raises(sie.ContactError, match="corner of the indenter"):
        solved(profile)


def refused(*args):
    with pytest.raises(sie.ContactError) as caught:
        _ = solved(*args).edges
    return str(caught.value)


def refused_zones(*args):
    """Why no zones depend on Q alone; what the contact gained may stick as it was touched."""
    solution = solved(*args)
    with pytest.raises(sie.ContactError) as caught:
        solution.tangential_search.found(abs(solution.scene.tangential_load))
    return str(caught.value)


def test_width_of_the_zone_that_is_missing_is_that_of_a_grid():
    # The printed equations on a mesh graded to the corner, as a quadratic program, Q = 0.4 f P
    named = re.search(r"about (\S+) half-widths", refused(sie.Flat(1.0), 0.45, 0.3, 0.4))
    assert float(named[1]) == pytest.approx(5.5e-5, rel=0.25)


def test_stick_of_what_came_into_contact_under_the_load_is_refused():
    with pytest.raises(sie.ContactError, match="came into contact under Q"):
        _ = solved(sie.Wedge(0.1), 0.3, 8.0, 0.5).edges


@pytest.mark.parametrize(
    ("profile", "beta", "friction"),
    [
        (None, 0.36, 0.57),
        (None, 0.25, 2.0),
        (None, 0.49, 0.06),
        (sie.Polynomial((0, 0, 0.5, 0, 2.7)), 0.488, 0.059),
        (sie.RoundedFlat(0.5, 1.0), 0.34, 1.06),
        # The slip of the normal load goes on at the old edge under a small load
        (None, 0.409, 0.0227),
        (sie.FromFunction(slope="sinh(x)"), 0.39, 0.0118),
    ],
)
def test_refusal_of_a_small_load_names_the_least_that_is_certified(profile, beta, friction):
    message, words = refused_zones(profile, beta, friction, 1e-5), "came into contact under Q"
    least = float(re.search(r"as far as \|Q\| = (\S+) = ", message)[1]) / friction
    beside = 0.01 * min(least, 30.0 * (1.0 - least))
    assert words in message
    assert solved(profile, beta, friction, least + beside).check().ok
    assert words in refused_zones(profile, beta, friction, least - beside)


@pytest.mark.parametrize(
    ("profile", "beta", "friction"),
    [
        (None, 0.3, 2.0),
        (None, 0.2, 4.0),
        (None, 0.243, 3.77),
        (sie.Polynomial((0, 0, 0.5, 0, 0.0211)), 0.276, 3.856),
    ],
)
def test_loads_of_any_size_are_refused_where_zones_of_one_state_begin_late(profile, beta, friction):
    for part in (1e-5, 0.3, 0.75, 0.99):
        assert "let the bodies slide" in refused(profile, beta, friction, part)


def test_certificate_is_not_ok_where_slip_would_oppose_the_load():
    search, Q = solved(None, 0.3, 2.0, 0.9).tangential_search, 1.0
    state = ShearedContact(search, search._newton(search.start(Q), Q), Q, 1.0, 1.0)
    assert search.least_slip(state.trial) < 0.0
    assert not sheared_certificate(state, scene(None, 0.3, 2.0, 0.5), 1e-13).ok


@pytest.mark.parametrize("part", [1e-3, 0.5])
@pytest.mark.parametrize("edge", range(4))
def test_certificate_is_not_ok_with_an_edge_moved(edge, part):
    right = solved(part=part)
    search, edges = right.tangential_search, right.coupled[1].trial.edges
    edges[edge] += 1e-6
    wrong = replace(right.coupled[1], trial=search.trial(edges, right.tangential_load))
    assert not sheared_certificate(wrong, right.scene, 1e-13).ok


def test_sliding_is_advised_where_surfaces_beside_the_first_contact_are_the_last_to_slip():
    assert "let the bodies slide" in refused(None, 0.43, 9.0, 0.9)


@pytest.mark.parametrize(
    ("profile", "beta", "friction", "part", "load"),
    [
        (None, -0.107, 0.0129, 0.43, 0.74),
        (sie.FromFunction(slope="sinh(x)"), -0.0404, 0.525, 3.4e-4, 0.2),
        (sie.FromFunction(slope="sinh(x)"), 0.00701, 9.9, -1.1e-6, 0.36),
        (sie.RoundedFlat(1.0, 1.0), 0.0553, 3.2, 2e-5, 0.25),
        (sie.RoundedFlat(1.0, 1.0), 0.0013, 8.5, -1.1e-6, 0.06),
        (sie.RoundedFlat(0.0017, 1.0), -0.0224, 5.18, 0.059, 0.8),
    ],
)
def test_certificate_holds_next_to_both_ends_of_the_loads(profile, beta, friction, part, load):
    assert solved(profile, beta, friction, part, load).check().ok


@pytest.mark.parametrize("part", [0.0, 0.5])
def test_certificate_holds_where_hardly_anything_sticks_under_the_normal_load(part):
    assert solved(sie.RoundedFlat(0.5, 1.0), 0.3, 1e-3, part).check().ok


CORNERS = sie.Piecewise((-9.0, -0.4, 0.4, 9.0), ((-0.8, 1.0), (0.0, 0.5), (0.8, 1.0)))


@pytest.mark.parametrize(
    ("profile", "beta", "friction", "part", "load"),
    [
        # An edge of the stick zone ends next to a corner
        (CORNERS, -0.2028, 0.045, -0.569, 0.2282),
        # Nodes of a rule next to a corner, or to the end of a stick zone, are few doubles apart
        (CORNERS, -0.00345, 0.0184, 0.459, 2.3),
        (CORNERS, -0.1516, 0.3515, -0.9998, 0.45),
        # Where stick is kept at a corner, p and q are evaluated a few doubles beside it
        (CORNERS, -0.03724, 0.06593, -2.839e-4, 0.13228),
        (CORNERS, 0.08146, 0.03331, 2.06e-4, 2.583),
        # The stick zone ends a few doubles beside a corner as this is passed by the edge
        (CORNERS, 0.002832, 0.07036, -8.023e-5, 0.201),
        # A corner comes into contact under Q
        (CORNERS, 0.11377, 0.72307, 0.30067, 0.12637),
        # Zones of 1e-8 half-widths
        (sie.Parabola(1.0), 0.0389, 4.2, -1.34e-6, 0.107),
        (sie.RoundedFlat(56.9, 1.0), -0.039, 0.867, -1.215e-3, 0.405),
        # No stick under P alone, where slip of full sliding passes zero more than once
        (sie.RoundedFlat(0.63, 1.0), 0.4878, 0.018, -0.7785, 0.3566),
    ],
)
def test_certificate_holds_next_to_corners_and_kinks(profile, beta, friction, part, load):
    assert solved(profile, beta, friction, part, load).check().ok


@pytest.mark.parametrize(
    ("beta", "friction", "part", "load"),
    [
        # The stick zone is to end next to a corner, which larger loads have passed
        (0.06213, 0.2169, 0.668, 0.2881),
        # The last place to stick in sliding is far from a corner next to which slip turns
        (0.4872, 0.1839, -0.99, 0.1985),
    ],
)
def test_zones_are_found_on_both_sides_of_the_loads_under_which_an_edge_passes_a_corner(
    beta, friction, part, load
):
    solution = solved(CORNERS, beta, friction, part, load)
    assert solution.check().ok
    assert keeps_friction_law(solution.coupled[1])


def test_a_corner_that_sticks_while_slip_begins_beside_it_is_refused():
    assert "two stick zones" in refused(CORNERS, 0.06213, 0.2169, 0.845, 0.2881)


def test_zones_that_pass_a_corner_under_a_falling_load_exceed_friction_beside_it():
    right = solved(CORNERS, 0.06213, 0.2169, 0.86, 0.2881)
    search, Q = right.tangential_search, 0.865 * right.tangential_load / 0.86
    # Four edges that meet the same conditions as those of the load, with e1 beside the corner
    other = search.next_to(0.4 * np.array([-1.020514, -0.9945276, 0.1317205, 1.0177226]), Q)
    assert not keeps_friction_law(ShearedContact(search, other.trial, Q, 1.0, 1.0))


@pytest.mark.parametrize(("beta", "friction"), [(0.36, 0.57), (0.3, 0.3)])
def test_a_small_load_is_refused_in_few_trials(monkeypatch, beta, friction):
    found = trials_of(monkeypatch, lambda: solved(None, beta, friction, 0.5).coupled)
    assert trials_of(monkeypatch, lambda: refused_zones(None, beta, friction, 1e-5)) < 20 * found


def almost_flat(beta, friction, part, round_part, half_flat=1.0):
    """A rounded flat whose contact ends this part of its half-flat beyond the flat."""
    profile = sie.RoundedFlat(half_flat, 1.0)
    width = (1.0 + round_part) * half_flat
    constants = {"modulus": 2.0, "dundurs": beta, "friction": friction}
    pressed = sie.solve(sie.Scene(profile=profile, half_width=width, **constants))
    load = pressed.normal_load
    loads = {"normal_load": load, "tangential_load": part * friction * load}
    return sie.solve(sie.Scene(profile=profile, **loads, **constants))


def test_slip_gradient_beside_an_almost_flat_base_is_not_cut_down_to_rounding():
    # 180 panels; 625 while the pressure that they resolve was that on a wider contact, and twice
    # as many with every halving where rounding of that pressure was larger still
    search = almost_flat(beta=0.05, friction=0.07, part=0.3, round_part=3e-6).tangential_search
    assert len(search.gamma.lo) < 350


def test_zones_beside_an_almost_flat_base_are_found_from_incipient_sliding():
    # The stick zone at 0.99 f P is seven times as wide as the rounded part of the contact.
    solution = almost_flat(0.27, 0.85, part=0.99, round_part=2.5e-4)
    certificate = solution.check()
    assert certificate.ok, str(certificate)
    e1, e2 = zones(solution)[1:3]
    assert e1 < -1.0 < e2


def test_refusal_of_a_small_load_beside_an_almost_flat_base_names_the_least():
    with pytest.raises(sie.ContactError, match=r"stick or slip back .* = 0\.97\d* f P.*larger"):
        _ = almost_flat(0.27, 0.85, part=0.3, round_part=2.5e-4).edges


@pytest.mark.parametrize("part", [1e-6, 1e-3, 0.5])
def test_pressure_is_continuous_a_few_doubles_beside_the_stick_zone(part):
    solution = solved(sie.FromFunction(slope="sinh(x)"), 0.00701, 9.9, part, 0.36)
    for end in solution.stick[0]:
        beside = end + np.spacing(abs(end)) * np.arange(-3.0, 4.0)
        p = solution.pressure(beside)
        assert np.ptp(p) < 1e-5 * p.max()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"normal_load": None, "half_width": 1.0}, "give normal_load"),
        ({"moment": 0.01}, "a moment that is held"),
        ({"bulk_stress": 0.01}, "strain of the body"),
    ],
)
def test_what_is_not_solved_is_refused_before_any_work(changes, words):
    with pytest.raises(sie.ContactError, match=words):
        sie.solve(replace(scene(), **changes))


def test_a_tilted_parabola_is_a_parabola_about_another_axis():
    tilted, upright = sie.solve(replace(scene(), tilt=0.1)), solved()
    assert zones(tilted) == pytest.approx(zones(upright) - 0.1, abs=1e-11)
    assert tilted.tilt == 0.1 and tilted.check().ok
    assert tilted.gap(2.0) == pytest.approx(float(upright.gap(2.1)), rel=1e-9)


def test_a_tangential_load_under_a_profile_that_is_not_symmetric_is_refused():
    with pytest.raises(sie.ContactError, match="set tangential_load = 0"):
        _ = solved(sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.02))).edges


def test_paths_are_refused_with_what_is_missing():
    path = sie.Path([(1.0, 0.1), (1.0, 0.0)])
    with pytest.raises(sie.ContactError, match="unloading of P or a reversal of Q"):
        sie.follow(scene(part=0.0), path)


def test_a_trace_of_a_parabola_has_no_corner_on_its_axis():
    """Its slope jumps there, but only as much as samples are rounded."""
    x = np.linspace(-3.0, 3.0, 61)
    assert solved(sie.Sampled(x, 0.5 * x * x), 0.3, 0.3, 0.3).tangential_search.corners == ()


@pytest.mark.parametrize("part", [0.0, 0.3])
def test_the_gap_far_away_is_what_the_profile_rises(part):
    solution = solved(None, 0.3, 0.3, part)
    with np.errstate(all="raise", under="ignore"):
        gaps = solution.gap(np.array([-1e300, -1e120, 1e120, 1e160]))
    assert gaps[1] == pytest.approx(0.5e240, rel=1e-12) == gaps[2]
    assert gaps[0] == gaps[3] == math.inf
