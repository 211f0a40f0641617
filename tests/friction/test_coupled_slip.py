"""Dissimilar bodies pressed with friction: Spence's problem, equations (1) and (12) coupled."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import mpmath
import numpy as np
import pytest

import sie
from analytic import goodman
from oracles import spence
from sie.certificate.coupled_check import coupled_certificate
from sie.friction.coupled import flat as coupled_flat
from sie.friction.coupled.flat import flat_punch
from sie.friction.coupled.functions import FlatFunctions, flat_functions
from sie.friction.coupled.growth import power_law_moment
from sie.friction.coupled.half_potential import DEGREE, HalfPotential, Panels
from sie.friction.coupled.panels import graded
from sie.friction.coupled.profile import GrowthPanel, Superposition
from sie.friction.coupled.tables import interpolated
from sie.friction.coupled.traction import on_panels, resolved_panels
from sie.friction.coupled.zones import NODES, _from_others
from sie.numerics.gauss_jacobi import gauss_jacobi

# Half-width of the stick zone and b p(0)/P of a flat punch, and P R/(E* b²) M of a parabola, in 32
# digits of another formulation (mpmath) and by collocation of the printed equations on graded
# panels.
REFERENCES = {
    (0.1, 0.1): (0.70061786631, 0.32027597518, 0.31651145915),
    (0.2, 0.3): (0.913700055232, 0.325433464420, 0.30966325689),
    (0.3, 0.1): (0.0281849146283, 0.345244082252, 0.31234709218),
    (0.3, 0.3): (0.6457874123866, 0.3378744452057, 0.302604209509),
    (0.3, 0.5): (0.9246117565700, 0.3349212640270, 0.298476370441),
    (0.4, 0.4): (0.5937440281925, 0.3565693999850, 0.291189996706),
    (0.5, 0.2): (0.04084680342861, 0.4068002623182, 0.29932319304),
    (0.5, 0.5): (0.52190767492215, 0.38667072667918, 0.2776371136744),
    (0.5, 1.0): (0.8895859253767, 0.3739542976491, 0.26336097905),
}
PROFILES = {
    "flat": sie.Flat(1.0),
    "wedge": sie.Wedge(0.1),
    "parabola": sie.Parabola(1.0),
    "power": sie.Power(2.5, 0.4),
    "rounded flat": sie.RoundedFlat(0.5, 1.0),
    "polynomial": sie.Polynomial((0.0, 0.0, 0.5, 0.0, 0.2)),
    "function": sie.FromFunction(slope="sinh(x)"),
    "function without slope": sie.FromFunction(slope="0*x", domain=(-1.0, 1.0)),
    "shifted": sie.Parabola(1.0).shifted(3.0),
    "kinked": sie.Piecewise((-2.0, -0.4, 0.4, 2.0), ((-0.8, 1.0), (0.0, 0.5), (0.8, 1.0))),
}


def scene(profile=None, beta=0.3, friction=0.3, **loads):
    loads = loads or {"normal_load": 1.0}
    return sie.Scene(
        profile=profile or sie.Parabola(1.0), modulus=2.0, dundurs=beta, friction=friction, **loads
    )


def solved(*args, **kwargs):
    return sie.solve(scene(*args, **kwargs))


# -- the stick zone --------------------------------------------------------------------------------


@pytest.mark.parametrize("pair", REFERENCES)
def test_stick_zone_and_central_pressure_of_a_flat_agree_with_other_formulations(pair):
    c, p0, _ = REFERENCES[pair]
    solution = solved(sie.Flat(1.0), *pair)
    assert solution.stick[0][1] == pytest.approx(c, abs=2e-11)
    assert float(solution.pressure(0.0)) == pytest.approx(p0, rel=2e-11)


@pytest.mark.parametrize("pair", spence.SLIP_WIDTHS)
def test_slip_zone_is_as_narrow_as_in_forty_digits(pair):
    solution = solved(sie.Parabola(1.0), *pair)
    left, right = (width / solution.half_width for width in solution.slip_widths)
    assert left == right == pytest.approx(spence.SLIP_WIDTHS[pair], rel=1e-10)


@pytest.mark.parametrize("pair", REFERENCES)
def test_load_of_a_parabola_agrees_with_other_formulations(pair):
    b = solved(sie.Parabola(1.0), *pair, normal_load=1.0).half_width
    assert 4.0 * REFERENCES[pair][2] / (2.0 * b * b) == pytest.approx(1.0, abs=3e-11)


@pytest.mark.parametrize(
    ("half_flat", "load", "p0"),
    [(0.5, 0.6571914138786, 0.281558591415), (0.2, 1.240582008908, 0.651928485028)],
)
def test_rounded_flat_agrees_with_its_power_series_in_the_load(half_flat, load, p0):
    solution = solved(sie.RoundedFlat(half_flat, 1.0), half_width=1.0)
    assert solution.normal_load == pytest.approx(load, rel=1e-12)
    assert float(solution.pressure(0.0)) == pytest.approx(p0, rel=3e-12)


@pytest.mark.parametrize("name", PROFILES)
def test_stick_ratio_is_the_same_under_every_symmetric_convex_profile(name):
    solution = solved(PROFILES[name])
    ((lo, hi),) = solution.stick
    assert (hi - lo) / (2.0 * solution.half_width) == pytest.approx(0.6457874123866, abs=1e-12)


@pytest.mark.parametrize(
    ("beta", "friction"), [(1e-3, 1.5e-3), (1e-6, 1e-6), (1e-4, 3e-4), (2e-3, 5e-4)]
)
def test_small_constants_leave_goodmans_slip_zone(beta, friction):
    rest = goodman.slip_width(half_width=1.0, friction=friction, dundurs=beta)
    # The next term is of the order of the squares of both, times the logarithm of the slip zone's
    # width
    assert flat_punch(beta, friction).modulus.rest == pytest.approx(
        rest, rel=30.0 * max(beta, friction) ** 2 + 1e-14
    )


@pytest.mark.parametrize(("beta", "friction"), [("0.1", "0.1"), ("0.05", "0.2"), ("0.3", "0.1")])
def test_goodmans_zones_are_those_of_his_ratio_of_elliptic_integrals(beta, friction):
    context = mpmath.MPContext()
    context.dps = 40
    f, mismatch = context.mpf(friction), context.mpf(beta)
    given = {"half_width": 1, "friction": f, "dundurs": mismatch, "lib": context}
    c, rest = goodman.stick_half_width(**given), goodman.slip_width(**given)
    assert abs(c + rest - 1) < 1e-38
    assert abs(context.ellipk(c * c) / context.ellipk(1 - c * c) * mismatch / f - 1) < 1e-37
    floats = {"half_width": 1.0, "friction": float(friction), "dundurs": float(beta)}
    assert float(goodman.slip_width(**floats)) == pytest.approx(float(rest), rel=1e-13)


def test_slip_zone_narrows_as_friction_grows_and_widens_with_the_mismatch():
    rests = [
        [flat_punch(b, f).modulus.rest for f in (0.1, 0.5, 2.0, 10.0)] for b in (0.2, 0.3, 0.5)
    ]
    assert (np.diff(rests, axis=1) < 0.0).all()
    assert (np.diff(rests, axis=0) > 0.0).all()


def test_slip_zone_remains_under_any_friction_of_very_dissimilar_bodies():
    assert flat_punch(0.5, 1e9).modulus.rest == pytest.approx(
        flat_punch(0.5, 1e6).modulus.rest, rel=1e-4
    )
    assert flat_punch(0.5, 1e9).modulus.rest > 1e-3


@pytest.mark.parametrize("profile", [sie.Flat(1.0), sie.Parabola(1.0)])
def test_friction_far_above_one_is_certified_or_refused(profile):
    assert solved(profile, 0.5, 990.0).check().ok
    assert solved(profile, 0.05, 1e9).check().ok  # sticks all over
    with pytest.raises(sie.ContactError, match="give friction = 1000 or less"):
        _ = solved(profile, 0.5, 1010.0).edges


def test_exponents_of_large_friction_keep_their_digits():
    """Beside the edge p goes with the power -h, h = 1/2 - θ = arctan(1/(β f))/π."""
    flat = FlatFunctions(flat_punch(0.5, 1e9))
    assert flat.h == pytest.approx(2e-9 / math.pi, rel=1e-15)
    assert flat.sine == pytest.approx(2e-9, rel=1e-15)


def test_panels_end_where_doubles_do_not_tell_a_jump_from_the_end():
    (panels,) = resolved_panels(lambda y, _: 1.0 * (y < 1.0 - 1e-14), (1.0,), 0.5)
    assert np.isfinite(panels.series).all()


def test_panels_of_a_traction_end_at_its_rounding():
    places = []

    def rough(y, _):
        places.append(y.size)
        return np.sqrt(1.0 - y) * (1.0 + 1e-10 * np.sin(1e12 * y))

    (panels,) = resolved_panels(rough, (1.0,), 0.5)
    assert sum(places) < 1e4
    assert on_panels(panels, np.array([0.3])) == pytest.approx(math.sqrt(0.7), rel=1e-9)


@pytest.mark.parametrize(
    ("beta", "friction"),
    [(0.49, 0.01), (0.45, 10.0), (0.3, 0.3), (0.05, 0.5), (0.01, 0.1), (0.02, 0.9), (0.001, 10.0)],
)
def test_stick_zone_takes_few_eigenvalues(beta, friction, monkeypatch):
    calls = []
    solve = coupled_flat._at_ratio

    def counted(*args):
        calls.append(args)
        return solve(*args)

    monkeypatch.setattr(coupled_flat, "_at_ratio", counted)
    coupled_flat.flat_punch.__wrapped__(beta, friction)
    assert len(calls) <= 6


@pytest.mark.parametrize(("beta", "friction"), [(0.05, 1.5), (0.1, 4.0), (0.1, 2.0), (0.001, 10.0)])
def test_a_narrow_slip_zone_takes_few_systems_of_few_unknowns(beta, friction, monkeypatch):
    sizes = []
    solve = np.linalg.solve

    def counted(matrix, right):
        sizes.append(len(right))
        return solve(matrix, right)

    monkeypatch.setattr(np.linalg, "solve", counted)
    coupled_flat.flat_punch.__wrapped__(beta, friction)
    assert len(sizes) <= 14
    assert max(sizes) <= 130


def counted_places(monkeypatch, name):
    """The numbers of places at which an integral over P' is computed, as they come."""
    places = []
    integral = getattr(Superposition, name)

    def counted(self, x, b):
        places.append(len(x))
        return integral(self, x, b)

    monkeypatch.setattr(Superposition, name, counted)
    return places


@pytest.mark.parametrize(("beta", "friction"), [(0.18, 3.0), (0.003, 10.0), (0.1, 10.0)])
def test_a_thousand_pressures_beside_a_narrow_slip_zone_are_few_integrals(
    beta, friction, monkeypatch
):
    solution = solved(sie.RoundedFlat(0.5, 1.0), beta, friction, normal_load=0.95)
    places = counted_places(monkeypatch, "pressure")
    solution.pressure(np.linspace(-1.2, 1.2, 1001))
    assert sum(places) <= 120


@pytest.mark.parametrize("many", [1, 10, 100])
def test_no_more_integrals_than_places(many, monkeypatch):
    solution = solved(sie.RoundedFlat(0.5, 1.0))
    places = counted_places(monkeypatch, "pressure")
    solution.pressure(np.linspace(0.1, 0.9, many) * solution.half_width)
    assert sum(places) <= many


def test_interpolation_resolves_powers_of_the_distance_from_both_marks():
    y = np.linspace(0.0, 3.0, 4001)
    marks = np.array([0.0, 1.0, 3.0])

    def function(y):
        return np.abs(y - 1.0) ** 0.3 + (3.0 - y) ** 0.7 * np.cos(y) + np.abs(y) ** 1.2

    np.testing.assert_allclose(interpolated(function, marks, y), function(y), atol=3e-13)


def test_interpolation_resolves_a_steep_power():
    y = np.linspace(0.0, 3.0, 4001)
    values = interpolated(lambda y: (y / 3.0) ** 60.0, np.array([0.0, 3.0]), y, 60.0)
    np.testing.assert_allclose(values, (y / 3.0) ** 60.0, atol=3e-13)


def test_the_half_width_takes_few_loads(monkeypatch):
    loads = []
    load = GrowthPanel.load_and_rate

    def counted(self, ahead):
        loads.append(ahead)
        return load(self, ahead)

    monkeypatch.setattr(GrowthPanel, "load_and_rate", counted)
    assert solved(sie.RoundedFlat(0.5, 1.0), normal_load=0.95).half_width > 0.0
    assert len(loads) <= 8


@pytest.mark.parametrize(("beta", "friction"), [(0.05, 0.5), (0.001, 10.0)])
@pytest.mark.parametrize("half_flat", [0.05, 0.5])
def test_load_of_a_rounded_flat_takes_few_panels_however_narrow_the_slip_zone(
    half_flat, beta, friction
):
    state = solved(sie.RoundedFlat(half_flat, 1.0), beta, friction).coupled[1]
    assert state.flat.rest < 1e-11
    assert len(state.growth) <= 8


@pytest.mark.parametrize("near", [1e-15, 1e-9, 1e-3, 10.0])
@pytest.mark.parametrize("power", [-0.5, 0.5])
def test_few_panels_integrate_a_power_of_the_distance_from_a_place_beside(near, power):
    one, far = np.array([1.0]), np.array([np.inf])
    whole = ((1.0 + near) ** (1.0 + power) - near ** (1.0 + power)) / (1.0 + power)
    _, ahead, _, weight = graded(one, near * one, far)
    assert float((weight * (near + ahead) ** power).sum()) == pytest.approx(whole, rel=2e-14)
    _, _, left, back = graded(one, far, near * one)
    assert float((back * (near + left) ** power).sum()) == pytest.approx(whole, rel=2e-14)
    assert max(len(weight), len(back)) <= 1 + math.log1p(1.0 / near) / 6.0


@pytest.mark.parametrize("name", ["rounded flat", "parabola", "kinked"])
@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.05, 0.5)])
def test_values_between_marks_are_those_of_the_integrals(name, beta, friction):
    state = solved(PROFILES[name], beta, friction).coupled[1]
    ends = np.array((0.0, *state.marks))
    part = 10.0 ** np.array([-5.5, -4.2, -3.1, -2.0, -0.9, -0.4])
    y = np.concatenate([ends[:-1, None] + np.diff(ends)[:, None] * np.append(part, 1.0 - part)])
    y = y.ravel()
    sums, whole = state.superposition, np.full(y.size, state.ahead)
    for function in (sums.pressure, sums.shear_deficit, sums.slip):
        direct = function(y, whole)
        assert state._of(function, y) == pytest.approx(direct, abs=1e-12 * np.abs(direct).max())


FULLY_STUCK = [(0.001, 10.0), (0.01, 0.3), (0.03, 1.0), (0.06, 3.0), (0.1, 5.0)]


@pytest.mark.parametrize(("beta", "friction"), FULLY_STUCK)
def test_tractions_in_full_stick_are_those_of_a_bonded_punch(beta, friction):
    t = np.linspace(0.05, 0.95, 10)
    eta = math.atanh(beta) / math.pi
    phase = eta * np.log((1.0 + t) / (1.0 - t))
    size = math.cosh(math.pi * eta) / math.pi / np.sqrt((1.0 - t) * (1.0 + t))
    solution = solved(sie.Flat(1.0), beta, friction)
    p, q = size * np.cos(phase), size * np.sin(phase)
    assert solution.pressure(t) == pytest.approx(p, rel=1e-11)
    assert solution.shear(t) == pytest.approx(q, abs=1e-11 * float(q.max()))


@pytest.mark.parametrize(("beta", "friction"), FULLY_STUCK)
def test_tractions_of_a_parabola_in_full_stick_are_bonded_punches_superposed(beta, friction):
    """p + i q = 2 cosh(πη)/π ∫_x^1 s (s² - x²)^(-1/2) ((s + x)/(s - x))^(iη) ds, P = b = 1."""
    context = mpmath.MPContext()
    context.dps = 20
    eta = context.atanh(context.mpf(beta)) / context.pi

    def traction(x):
        end = context.acosh(1 / context.mpf(x))  # s = x cosh v, v = end exp(-y)

        def integrand(y):
            v = end * context.exp(-y)
            oscillating = context.expj(-2 * eta * context.log(context.tanh(v / 2)))
            return v * x * context.cosh(v) * oscillating

        total = context.quad(integrand, [0, 1, 4, 12, 30, 50])
        return complex(2 * context.cosh(context.pi * eta) / context.pi * total)

    solution, x = solved(sie.Parabola(1.0), beta, friction), np.array([0.02, 0.3, 0.7, 0.97])
    b, exact = solution.half_width, np.array([traction(t) for t in x.tolist()])
    p, q = (b / solution.normal_load * each(b * x) for each in (solution.pressure, solution.shear))
    assert p == pytest.approx(exact.real, abs=1e-12 * float(exact.real.max()))
    assert q == pytest.approx(exact.imag, abs=1e-11 * float(exact.imag.max()))


@pytest.mark.parametrize(("beta", "friction"), [(0.001, 0.5), (0.1, 10.0)])
def test_full_stick_is_said_where_the_slip_zone_is_narrower_than_rounding(beta, friction):
    solution = solved(sie.Flat(1.0), beta, friction)
    assert solution.stick == (solution.edges,)
    assert solution.slip_widths == (0.0, 0.0)
    assert solution.check().error <= 1e-11
    assert "slip: full stick" in str(solution.check())


NARROW = [(0.05, 0.6), (0.05, 0.5), (-0.05, 0.5), (0.02, 0.205), (0.005, 0.6)]


@pytest.mark.parametrize(("beta", "friction"), NARROW)
@pytest.mark.parametrize("profile", [sie.Flat(1.0), sie.Parabola(1.0), sie.RoundedFlat(0.5, 1.0)])
def test_potentials_beside_narrow_slip_zones_have_the_loads(profile, beta, friction):
    """1 - c/b from 1e-12 to what doubles cannot tell; π z F(z) is P far away."""
    solution = solved(profile, beta, friction)
    far, P = 1e8j * solution.half_width, solution.normal_load
    assert (math.pi * far * solution.pressure.cauchy(far)).real == pytest.approx(P, rel=1e-8)
    assert solution.shear.moment * beta > 0.0
    stress = solution.stress(0.0, [0.0, 0.1, 1.0])
    assert all(np.isfinite(part).all() for part in (stress.xx, stress.yy, stress.xy))
    assert not math.isnan(solution.peak_tension().value)


@pytest.mark.parametrize("beta", [0.1, 0.2, 0.3, 0.4, 0.5])
def test_stick_zones_of_any_smallness_under_a_flat_are_certified(beta):
    """Down to 2e-39 of the half-width, where 1 - x is 1 at both ends of the slip zone."""
    solution = solved(sie.Flat(1.0), beta, 0.01)
    c = solution.stick[0][1]
    x = c * np.array([0.5, 2.0])
    q = solution.shear(x) / solution.pressure(x) / 0.01
    assert q[0] == pytest.approx(1.0 / 3.0, abs=2e-3) and q[1] == 1.0
    assert solution.check().ok


@pytest.mark.parametrize("profile", [sie.Flat(1.0), sie.Parabola(1.0), sie.Wedge(0.1)])
def test_a_stick_zone_of_any_smallness_has_the_stress_of_what_sticks(profile):
    """In stick γ = 0 under a flat: the surface stress is -p (1 - 2 β) there, and q moves -2 β p."""
    solution = solved(profile, 0.5, 0.01)
    c = solution.stick[0][1]
    assert c < 1e-36 * solution.half_width
    if isinstance(profile, sie.Flat):
        x = np.array([0.0, 0.5 * c])
        p = solution.pressure(x)
        assert solution.shear.hilbert(x) == pytest.approx(-0.5 * p, rel=1e-3)
    stress = solution.stress(0.3 * solution.half_width, [0.0, 0.1])
    assert np.isfinite(stress.xx).all() and solution.energy_lost > 0.0


# -- the two equations -----------------------------------------------------------------------------


def tractions_of_a_flat(beta, friction):
    """p and q as functions of x and 1 - x."""
    flat = flat_functions(beta, friction)

    def values(function, x, rest):
        t, e = np.array([float(x)]), np.array([float(rest)])
        return float(function(t, e, np.abs(flat.rest - e))[0])

    def shear(x, rest):
        return friction * values(flat.pressure, x, rest) - values(flat.shear_deficit, x, rest)

    return lambda x, rest: values(flat.pressure, x, rest), shear, flat.c, flat.h


@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.5, 0.2)])
@pytest.mark.parametrize("part", [0.3, 0.8])
def test_both_equations_hold_in_stick_by_mpmaths_quadrature(beta, friction, part):
    context = mpmath.MPContext()
    context.dps = 15
    p, q, c, h = tractions_of_a_flat(beta, friction)
    x, start, power = part * c, 0.5 * (1.0 + c), 1.0 / (1.0 - h)

    def principal(f, parity):
        at_x = f(x, 1.0 - x)

        def integrand(t, rest):
            return (f(t, rest) - at_x) / (x - t) + parity * f(t, rest) / (x + t)

        def next_to_edge(u):  # smooth in u, as f ~ (1 - t)^-h
            rest = (1.0 - start) * u**power
            return integrand(1.0 - rest, rest) * power * (1.0 - start) * u ** (power - 1.0)

        total = context.quad(next_to_edge, [0, 1])
        for a, b in ((0, x), (x, c), (c, start)):
            total += context.quad(lambda t: integrand(t, 1.0 - t), [a, b])
        return (total + at_x * context.log(x / (1.0 - x))) / context.pi

    assert abs(principal(p, 1.0) - beta * q(x, 1.0 - x)) < 1e-8 * p(x, 1.0 - x)
    assert abs(principal(q, -1.0) + beta * p(x, 1.0 - x)) < 1e-8 * p(x, 1.0 - x)


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.07, 0.3), (0.5, 0.1)])
def test_certificate_holds_for_every_profile(name, beta, friction):
    certificate = solved(PROFILES[name], beta, friction).check()
    assert certificate.ok
    assert certificate.residual < 1e-10


@pytest.mark.parametrize("name", ["flat", "parabola", "rounded flat"])
def test_certificate_is_not_ok_for_another_mismatch(name):
    right = solved(PROFILES[name])
    wrong = coupled_certificate(right.coupled[1], replace(right.scene, dundurs=0.3001), 1e-13)
    assert not wrong.ok


@pytest.mark.parametrize("name", PROFILES)
def test_shear_is_friction_times_pressure_in_slip_and_less_in_stick(name):
    solution = solved(PROFILES[name])
    hi, m = solution.stick[0][1], solution.centre
    slip = m + np.linspace(1.0001 * (hi - m), 0.999 * solution.half_width, 20)
    stick = m + np.linspace(0.001, 0.999, 30) * (hi - m)
    assert solution.shear(slip) == pytest.approx(0.3 * solution.pressure(slip), rel=1e-12)
    ratio = solution.shear(stick) / (0.3 * solution.pressure(stick))
    assert (ratio < 1.0).all() and (np.diff(ratio) > 0.0).all()


@pytest.mark.parametrize("name", ["flat", "wedge", "parabola", "rounded flat"])
def test_potentials_jump_by_the_traction_across_the_contact(name):
    solution = solved(PROFILES[name])
    x = solution.half_width * np.array([-0.93, -0.31, 0.05, 0.42, 0.77])
    depth = 1e-9 * solution.half_width
    for traction in (solution.pressure, solution.shear):
        above, below = traction.cauchy(x + 1j * depth), traction.cauchy(x - 1j * depth)
        jump = -(above - below).imag / 2.0
        assert jump == pytest.approx(traction(x), abs=1e-6 * float(traction(0.3 * x).max()))
        on_it = traction.cauchy(x)
        assert on_it.real == pytest.approx(traction.hilbert(x), abs=1e-12)
        assert on_it.imag == pytest.approx(-traction(x), abs=1e-12)


@pytest.mark.parametrize("name", ["flat", "parabola", "rounded flat"])
def test_potentials_are_those_of_a_plain_quadrature_far_from_the_surface(name):
    solution = solved(PROFILES[name])
    r = solution.half_width
    z = r * np.array([0.3 + 0.8j, -1.4 + 0.5j, 3.0j])
    phi = (np.arange(4000) + 0.5) * math.pi / 4000
    t, weight = r * np.cos(phi), r * np.sin(phi) * math.pi / 4000
    for traction in (solution.pressure, solution.shear):
        plain = (traction(t) * weight / (z[:, None] - t)).sum(axis=1) / math.pi
        assert np.abs(traction.cauchy(z) - plain).max() < 3e-4 / r
        step = 1e-4 * r
        difference = (traction.cauchy(z + step) - traction.cauchy(z - step)) / (2.0 * step)
        assert traction.cauchy_derivative(z) == pytest.approx(difference, rel=1e-6)


@pytest.mark.parametrize("depth", [1e-3, 1e-13, 1e-200])
def test_potential_of_a_constant_is_a_logarithm_however_near_a_node_of_its_rule(depth):
    series = np.zeros((2, DEGREE))
    series[0, 0] = 1.0
    half = HalfPotential(Panels(np.array([0.0, 1.0]), np.array([1.0, 2.0]), series, 0.5))
    z = np.append(half.quadrature[0][:DEGREE], [-0.3, 3.0]) + 1j * depth
    F, dF = half(z, derivative=True)
    np.testing.assert_allclose(F, np.log(z / (z - 1.0)) / math.pi, rtol=1e-14)
    np.testing.assert_allclose(dF, (1.0 / z - 1.0 / (z - 1.0)) / math.pi, rtol=1e-13)


@pytest.mark.parametrize("name", ["flat", "parabola", "rounded flat"])
def test_a_potential_at_many_points_is_that_at_each(name):
    density = solved(PROFILES[name], 0.07, 0.3).shear
    x, y = np.meshgrid(np.linspace(-2.0, 2.0, 41), np.geomspace(1e-3, 10.0, 25))
    z = (x + 1j * y).ravel()
    few = [density.potentials(part) for part in np.array_split(z, len(z) // 5)]
    many = density.potentials(z)
    for k, rounding in enumerate((1e-13, 1e-11)):
        one_by_one = np.concatenate([pair[k] for pair in few])
        assert many[k] == pytest.approx(one_by_one, abs=rounding * np.abs(one_by_one).max())


def test_a_potential_at_many_points_takes_one_rule_for_several_panels(monkeypatch):
    density = solved(PROFILES["parabola"], 0.07, 0.3).shear
    x, y = np.meshgrid(np.linspace(-2.0, 2.0, 41), np.linspace(0.02, 2.0, 41))
    terms = []
    sums = HalfPotential._of_few

    def counted(self, z, rule, *others):
        terms.append(len(z) * len(rule[0]))
        return sums(self, z, rule, *others)

    monkeypatch.setattr(HalfPotential, "_of_few", counted)
    density.cauchy(x + 1j * y)
    assert sum(terms) < 0.3 * 2 * x.size * density.panels.series.size


def test_potential_and_derivative_together_take_each_half_once(monkeypatch):
    density = solved(PROFILES["parabola"]).shear
    halves = []
    half = HalfPotential.__call__

    def counted(self, z, derivative):
        halves.append(derivative)
        return half(self, z, derivative)

    monkeypatch.setattr(HalfPotential, "__call__", counted)
    density.potentials(np.array([0.3 + 0.2j, 2.0 + 1.0j]))
    assert halves == [True, True]


@pytest.mark.parametrize("side", [1, -1, 0])
def test_potential_and_derivative_are_those_that_are_asked_for_alone(side):
    density = solved(PROFILES["parabola"]).shear
    z = np.array([[0.3 + 0.2j, -0.4], [2.0, 0.1 - 0.7j], [1e40 + 1j, complex(math.nan, 1.0)]])
    F, dF = density.potentials(z, side)
    np.testing.assert_array_equal(F, density.cauchy(z, side))
    np.testing.assert_array_equal(dF, density.cauchy_derivative(z, side))


def test_potential_far_away_is_the_load_over_the_distance():
    half = solved(sie.Parabola(1.0)).tractions.pressure._half
    z = np.array([1e8j, 1e99j, 1e120 + 1e120j])
    F, dF = half(z, derivative=True)
    np.testing.assert_allclose(F, 0.5 / (math.pi * z), rtol=1e-7)
    np.testing.assert_allclose(dF, -0.5 / (math.pi * z * z), rtol=1e-7)


@pytest.mark.parametrize("length", [1.0, 1e-40])
def test_a_value_from_the_other_nodes_of_a_panel_is_that_of_a_polynomial(length):
    x = gauss_jacobi(NODES, 0.0, 0.0).x
    others = x**3 - 2.0 * x
    weights = _from_others(length * x, 4)
    assert weights @ others == pytest.approx(others[4], rel=1e-12)


@pytest.mark.parametrize("pair", [(0.3, 0.3), (0.1, 1.0), (0.5, 10.0)])
def test_pressure_beside_c_takes_the_function_of_the_shear_to_rounding_of_pressures(pair):
    flat = flat_functions(*pair)
    t = np.linspace(flat.c, flat.middle, 5)
    e = np.linspace(flat.rest, flat.beyond, 5)
    apart = np.abs(flat.S_beside_c(t, e) - flat.S(t, e))
    assert (apart <= 1e-13 * flat.A(t, e)).all()


def test_surface_stress_is_in_balance_with_the_tractions():
    solution = solved(sie.RoundedFlat(0.5, 1.0), poisson=0.3, normal_load=0.6)
    x = np.linspace(-0.95, 0.95, 11) * solution.half_width
    surface, below = solution.surface_stress(x), solution.stress(x, 1e-10)
    assert surface.yy == pytest.approx(-solution.pressure(x), abs=1e-12)
    assert surface.xy == pytest.approx(-solution.shear(x), abs=1e-12)
    assert below.xx == pytest.approx(surface.xx, abs=1e-6)


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


@pytest.mark.parametrize("exponent", [10.0, 30.0, 170.0])
def test_certificate_holds_for_large_exponents(exponent):
    certificate = solved(sie.Power(exponent, 0.4)).check()
    assert certificate.ok
    assert max(certificate.residual, certificate.shear.residual) < 5e-12


def test_slip_of_a_power_law_scales_with_the_half_width():
    one, other = (solved(sie.Power(2.5, 0.4), half_width=b) for b in (1.0, 2.0))
    x = np.array([0.1, 0.5, 0.7, 0.95])
    assert other.slip(2.0 * x) == pytest.approx(2.0**2.5 * one.slip(x), rel=1e-11)


def test_energy_is_the_work_of_friction_on_the_slip_of_small_steps():
    loads = np.linspace(0.0, 1.0, 81)[1:]
    x = np.linspace(0.0, 1.0, 4001)[1:]
    slips, tractions = [np.zeros(len(x))], [np.zeros(len(x))]
    for P in loads:
        solution = solved(normal_load=P)
        inside = x <= solution.half_width
        g, q = np.zeros(len(x)), np.zeros(len(x))
        g[inside], q[inside] = solution.slip(x[inside]), solution.shear(x[inside])
        slips.append(g)
        tractions.append(q)
    work = sum(
        ((q0 + q1) * 0.5 * (g1 - g0)).sum()
        for g0, g1, q0, q1 in zip(slips, slips[1:], tractions, tractions[1:], strict=False)
    )
    assert solved().energy_lost == pytest.approx(2.0 * work * (x[1] - x[0]), rel=5e-3)


@pytest.mark.parametrize("name", ["rounded flat", "kinked"])
def test_energy_grows_with_the_load_by_friction_on_the_slip_of_the_flat(name):
    x, w = gauss_jacobi(24, 0.0, 0.0)[::2]
    nodes, weights = gauss_jacobi(6, 0.0, 0.0)[::2]
    flat, rates = flat_functions(0.3, 0.3), []
    for P in 2.0 + 0.1 * nodes:
        state = solved(PROFILES[name], normal_load=P).coupled[1]
        places = np.array([flat.c * state.b, *(y for y in state.marks if y > flat.c * state.b)])
        lo, length = places[:-1, None], np.diff(places)[:, None]
        # Broken powers of the distances from both ends become smooth
        part = x**4 * (35.0 - 84.0 * x + 70.0 * x**2 - 20.0 * x**3)
        rest, dx = part[::-1], w * 140.0 * (x * (1.0 - x)) ** 3
        y, to_end = (lo + length * part).ravel(), (state.b - places[1:, None]) + length * rest
        p = state.pressure(y, to_end.ravel())
        e = to_end.ravel() / state.b
        g = flat.slip(1.0 - e, e, y / state.b - flat.c)
        rates.append(2.0 * 0.3 * float((length * dx).ravel() @ (p * g)))
    heavy, light = (solved(PROFILES[name], normal_load=P).energy_lost for P in (2.1, 2.0))
    assert heavy - light == pytest.approx(0.1 * float(weights @ np.array(rates)), rel=1e-8)


@pytest.mark.parametrize("pair", [(0.45, 0.1), (0.3, 0.04), (0.3, 0.3), (0.1, 0.3)])
def test_slip_of_a_flat_is_smooth_where_two_expressions_of_it_meet(pair):
    flat = flat_functions(*pair)
    from_c = (flat.rest - flat.beyond) * np.exp(0.4 * np.linspace(-1.0, 1.0, 81))
    e = flat.rest - from_c
    g = flat.slip(1.0 - e, e, from_c)
    fitted = np.polynomial.chebyshev.chebvander(np.linspace(-1.0, 1.0, 81), 24)
    missed = g - fitted @ np.linalg.lstsq(fitted, g, rcond=None)[0]
    assert np.abs(missed).max() < 1e-12 * np.abs(g).max()


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


def test_rounded_flat_tends_to_a_parabola_and_to_a_flat():
    parabola = solved(sie.Parabola(1.0), normal_load=0.5)
    nearly = solved(sie.RoundedFlat(1e-5, 1.0), normal_load=0.5)
    assert nearly.half_width == pytest.approx(parabola.half_width, rel=1e-4)
    flat, sharp = solved(sie.Flat(1.0)), solved(sie.RoundedFlat(1.0, 1e-7))
    x = np.array([0.0, 0.3, 0.6, 0.8])
    assert sharp.pressure(x) == pytest.approx(flat.pressure(x), rel=1e-3)
    assert sharp.shear(x) == pytest.approx(flat.shear(x), abs=1e-3)


def test_moments_of_power_laws_are_those_of_similar_bodies_as_beta_vanishes():
    # If β = 0, P = E* A m b^m W with W = sqrt(π)/2 Γ((m+1)/2)/Γ(m/2+1), so that 2 m M W = 1
    flat = flat_functions(1e-7, 1e-7)
    for m in (1.0, 2.0, 3.7, 9.0):
        W = 0.5 * math.sqrt(math.pi) * math.gamma(0.5 * (m + 1.0)) / math.gamma(0.5 * m + 1.0)
        assert 2.0 * m * W * power_law_moment(flat, m) == pytest.approx(1.0, abs=1e-12)


# -- an independent program ------------------------------------------------------------------------


def flat_on_a_grid(beta, friction, n=120):
    """The printed equations (1) and (12) on n equal cells by an active set: stick half-width and
    pressures.
    """
    edges = np.linspace(-1.0, 1.0, n + 1)
    x = 0.5 * (edges[1:] + edges[:-1])
    # ∫ ln|x - t| dt over the cells: both equations integrated once are displacements
    d = x[:, None] - edges
    primitive = d * np.log(np.abs(d)) - d
    log = (primitive[:, :-1] - primitive[:, 1:]) / math.pi
    step = np.where(x[:, None] > x, 1.0, 0.0) + 0.5 * np.eye(n)
    step = step * (edges[1] - edges[0])
    half, width = n // 2, edges[1] - edges[0]
    for stuck in range(half, 0, -1):
        A, rhs = np.zeros((2 * n + 1, 2 * n + 1)), np.zeros(2 * n + 1)
        A[:n, :n], A[:n, n : 2 * n], A[:n, -1] = log, -beta * step, 1.0
        for k in range(n):
            if abs(k - (n - 1) / 2) < stuck:
                A[n + k, n : 2 * n], A[n + k, :n] = log[k], beta * (step[k] - 0.5 * width)
            else:
                A[n + k, n + k], A[n + k, k] = 1.0, -friction * np.sign(x[k])
        A[-1, :n], rhs[-1] = width, 1.0
        p, q = np.split(np.linalg.solve(A, rhs)[: 2 * n], 2)
        if (np.abs(q) <= friction * p * (1.0 + 1e-9)).all():
            break
    return stuck * width, x, p, q


def test_flat_agrees_with_an_active_set_on_a_grid():
    c, x, p, q = flat_on_a_grid(0.3, 0.3)
    solution = solved(sie.Flat(1.0))
    assert c == pytest.approx(solution.stick[0][1], abs=2.0 * 2.0 / 120)
    inner, cell = np.abs(x) < 0.5, 2.0 / 120  # a scheme of the first order
    assert p[inner] == pytest.approx(solution.pressure(x[inner]), rel=cell)
    assert q[inner] == pytest.approx(solution.shear(x[inner]), abs=cell * float(p.min()))


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


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"moment": 0.01}, "in place of the moment"),
        ({"bulk_stress": 0.01}, "bulk_stress"),
    ],
)
def test_what_is_not_solved_is_refused_with_what_to_do(changes, words):
    with pytest.raises(sie.ContactError, match=words):
        sie.solve(scene(normal_load=1.0, **changes))


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        (sie.Row([sie.Parabola(1.0).shifted(x) for x in (-2.0, 2.0)]), "in 2 patches"),
        (sie.Periodic(sie.Parabola(1.0), 4.0), "without its period"),
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


@pytest.mark.parametrize(("beta", "friction", "load"), [(0.0864, 0.0696, 1.07), (0.033, 0.3, 0.29)])
def test_a_symmetric_trace_is_solved_whatever_the_rounding_of_its_axis(beta, friction, load):
    x = np.linspace(-3.0, 3.0, 61)
    loads = {"modulus": 2.0, "dundurs": beta, "friction": friction, "normal_load": load}
    trace, parabola = (
        sie.solve(sie.Scene(profile=profile, **loads))
        for profile in (sie.Sampled(x, 0.5 * x * x), sie.Parabola(1.0))
    )
    assert trace.stick[0] == pytest.approx(parabola.stick[0], rel=1e-9)


def test_a_path_of_dissimilar_bodies_is_refused():
    with pytest.raises(sie.ContactError, match="path of dissimilar bodies"):
        sie.follow(scene(), sie.Path([(1.0, 0.0), (0.5, 0.0)]))


def test_the_pressure_under_a_wedge_is_infinite_on_its_axis():
    assert float(solved(sie.Wedge(0.1)).pressure(0.0)) == math.inf


def test_the_plan_is_the_footprint():
    solution = solved()
    _ = solution.shear(0.1), solution.check()
    expected = sie.plan(solution.scene, want=("shear", "check")).stages
    stages = {"coupled", "normal", "pressure", "certificate", "tangential", "tractions"}
    assert set(vars(solution)) & stages == expected


def test_a_scene_of_dissimilar_bodies_survives_a_pickle():
    assert pickle.loads(pickle.dumps(scene())) == scene()


@pytest.mark.parametrize("changes", [{}, {"coupling": "goodman"}, {"tilt": 0.01}])
def test_a_solution_of_dissimilar_bodies_survives_a_pickle(changes):
    solution = solved(normal_load=1.0, **changes)
    stress = solution.stress(0.1, 0.2).xx
    again = pickle.loads(pickle.dumps(solution))
    assert again.edges == solution.edges and again.stress(0.1, 0.2).xx == stress


def test_a_point_of_a_path_of_dissimilar_bodies_survives_a_pickle():
    path = sie.Path(((0.0, 0.0), (1.0, 0.05)))
    solution = sie.follow(scene(half_width=None, normal_load=1.0), path)[-1]
    stress = solution.stress(0.1, 0.2).xx
    again = pickle.loads(pickle.dumps(solution))
    assert again.edges == solution.edges and again.stress(0.1, 0.2).xx == stress


def test_surface_stress_where_a_parabola_touched_first_is_that_beside_it():
    solution = solved()
    beside = solution.stress(1e-9, 0.0).xx
    assert solution.stress(0.0, 0.0).xx == pytest.approx(float(beside), rel=1e-7)


def test_slip_next_to_the_edge_takes_an_integral_over_the_contact_at_nodes_of_one_table_only(
    monkeypatch,
):
    places, one = [], FlatFunctions._J

    def counted(self, t, e, S):
        places.append(len(t))
        return one(self, t, e, S)

    flat = FlatFunctions(flat_punch(0.3, 0.02))
    assert flat._S_in_stick.size  # which takes it too
    monkeypatch.setattr(FlatFunctions, "_J", counted)
    regular, _ = flat.slip_near_edge
    assert sum(places) == regular.series.size
