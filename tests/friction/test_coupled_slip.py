"""The stick zone of dissimilar bodies under P: symmetric, convex profiles."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from pressed_cases import PROFILES, solved

import sie
from analytic import bonded_flat, goodman
from analytic import spence as closed
from oracles import spence
from sie.friction.coupled import flat as coupled_flat


def slip_width(beta, friction):
    return solved(sie.Flat(1.0), beta, friction).slip_widths[0]


PAIRS = [
    (0.1, 0.1), (0.2, 0.3), (0.3, 0.1), (0.3, 0.3), (0.3, 0.5), (0.4, 0.4), (0.5, 0.2), (0.5, 0.5),
    (0.5, 1.0),
]  # fmt: skip


@pytest.mark.parametrize("pair", PAIRS)
def test_stick_zone_pressure_and_loads_are_the_closed_forms_of_spence(pair):
    given = {"half_width": 1.0, "dundurs": pair[0], "friction": pair[1]}
    flat, parabola = solved(sie.Flat(1.0), *pair), solved(None, *pair, half_width=1.0)
    assert flat.stick[0][1] == pytest.approx(closed.stick_half_width(**given), abs=2e-11)
    p0 = closed.flat_central_pressure(**given, normal_load=1.0)
    assert float(flat.pressure(0.0)) == pytest.approx(p0, rel=2e-11)
    load = closed.load(**given, coefficient=0.5, exponent=2.0, modulus=2.0)
    assert parabola.normal_load == pytest.approx(load, rel=3e-11)


@pytest.mark.parametrize("pair", [pair for pair in spence.SLIP_WIDTHS if pair[0] * pair[1] < 1.5])
def test_slip_zone_is_as_narrow_as_in_forty_digits(pair):
    assert slip_width(*pair) == pytest.approx(spence.SLIP_WIDTHS[pair], rel=1e-10, abs=0.0)


def test_slip_zone_narrows_as_friction_grows_and_widens_with_the_mismatch():
    widths = [[slip_width(b, f) for f in (0.1, 0.5, 1.0, 2.0)] for b in (0.2, 0.3, 0.5)]
    assert (np.diff(widths, axis=1) < 0.0).all() and (np.diff(widths, axis=0) > 0.0).all()


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
    bound = 30.0 * max(beta, friction) ** 2 + 1e-11
    assert slip_width(beta, friction) == pytest.approx(rest, rel=bound)


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


@pytest.mark.parametrize("profile", [sie.Flat(1.0), sie.Parabola(1.0)])
def test_friction_far_above_one_is_certified_or_refused(profile):
    assert solved(profile, 0.5, 2.5).check().ok
    assert solved(profile, 0.05, 1e9).check().ok  # sticks all over
    with pytest.raises(sie.ContactError, match="give friction = 3 or less"):
        _ = solved(profile, 0.5, 3.1).edges


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
    assert max(sizes) <= 240


FULLY_STUCK = [(0.001, 10.0), (0.01, 0.3), (0.03, 1.0), (0.06, 3.0), (0.1, 5.0)]


@pytest.mark.parametrize(("beta", "friction"), FULLY_STUCK)
def test_tractions_in_full_stick_are_those_of_a_bonded_punch(beta, friction):
    solution, t = solved(sie.Flat(1.0), beta, friction), np.linspace(0.05, 0.95, 10)
    given = {"half_width": 1.0, "normal_load": 1.0, "dundurs": beta}
    p, q = (form(t, **given) for form in (bonded_flat.pressure, bonded_flat.shear))
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


@pytest.mark.slow(but=8)
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


def test_small_stick_zones_under_a_flat_are_certified_and_smaller_ones_refused():
    solution = solved(sie.Flat(1.0), 0.1, 0.01)
    c = solution.stick[0][1]
    assert c < 1e-6
    x = c * np.array([0.5, 2.0])
    p = solution.pressure(x)
    q = solution.shear(x) / p / 0.01
    assert q[0] == pytest.approx(1.0 / 3.0, abs=2e-3) and q[1] == 1.0
    # In stick γ = 0: q moves -2 β p along the surface there
    assert solution.shear.hilbert(x[0]) == pytest.approx(-0.1 * p[0], rel=1e-3)
    assert solution.check().ok and solution.energy_lost > 0.0
    with pytest.raises(sie.ContactError, match="raise friction"):
        _ = solved(sie.Flat(1.0), 0.2, 0.01).edges
