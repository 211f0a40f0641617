"""The stick zone of dissimilar bodies under P: symmetric, convex profiles."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from pressed_cases import PROFILES, solved

import sie
from analytic import goodman
from oracles import spence
from sie.friction.coupled import flat as coupled_flat
from sie.friction.coupled.flat import flat_punch

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

# -- the stick zone --------------------------------------------------------------------------------


@pytest.mark.parametrize("pair", REFERENCES)
def test_stick_zone_and_central_pressure_of_a_flat_agree_with_other_formulations(pair):
    c, p0, _ = REFERENCES[pair]
    solution = solved(sie.Flat(1.0), *pair)
    assert solution.stick[0][1] == pytest.approx(c, abs=2e-11)
    assert float(solution.pressure(0.0)) == pytest.approx(p0, rel=2e-11)


@pytest.mark.parametrize("pair", spence.SLIP_WIDTHS)
def test_slip_zone_is_as_narrow_as_in_forty_digits(pair):
    assert flat_punch(*pair).rest == pytest.approx(spence.SLIP_WIDTHS[pair], rel=1e-10)


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
    assert solved(profile, 0.5, 2.5).check().ok
    assert solved(profile, 0.05, 1e9).check().ok  # sticks all over
    with pytest.raises(sie.ContactError, match="give friction = 3 or less"):
        _ = solved(profile, 0.5, 3.1).edges


def test_exponents_of_large_friction_keep_their_digits():
    """Beside the edge p goes with the power -h, h = 1/2 - θ = arctan(1/(β f))/π."""
    assert flat_punch(0.5, 1e9).exponent == pytest.approx(2e-9 / math.pi, rel=1e-15)


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
    assert max(sizes) <= 240


@pytest.mark.parametrize(("beta", "friction"), [(0.05, 0.5), (0.001, 10.0)])
@pytest.mark.parametrize("half_flat", [0.05, 0.5])
def test_load_of_a_rounded_flat_takes_few_panels_however_narrow_the_slip_zone(
    half_flat, beta, friction
):
    state = solved(sie.RoundedFlat(half_flat, 1.0), beta, friction).coupled[1]
    assert state.flat.rest < 1e-11
    assert len(state.frozen.panels) <= 8


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
    q = solution.shear(x) / solution.pressure(x) / 0.01
    assert q[0] == pytest.approx(1.0 / 3.0, abs=2e-3) and q[1] == 1.0
    assert solution.check().ok
    with pytest.raises(sie.ContactError, match="raise friction"):
        _ = solved(sie.Flat(1.0), 0.2, 0.01).edges


@pytest.mark.parametrize("profile", [sie.Flat(1.0), sie.Parabola(1.0)])
def test_a_small_stick_zone_has_the_stress_of_what_sticks(profile):
    """In stick γ = 0 under a flat: the surface stress is -p (1 - 2 β) there, and q moves -2 β p."""
    solution = solved(profile, 0.1, 0.01)
    c = solution.stick[0][1]
    assert c < 1e-6 * solution.half_width
    if isinstance(profile, sie.Flat):
        x = np.array([0.0, 0.5 * c])
        p = solution.pressure(x)
        assert solution.shear.hilbert(x) == pytest.approx(-0.1 * p, rel=1e-3)
    stress = solution.stress(0.3 * solution.half_width, [0.0, 0.1])
    assert np.isfinite(stress.xx).all() and solution.energy_lost > 0.0
