"""The stress in closed form, against the equations of elasticity and the solver."""

import numpy as np
import pytest

import sie
from analytic import interior, rounded_flat
from oracles.normal_contact import mp

X, Y = np.meshgrid([-2.0, -0.97, 0.0, 0.3, 1.0, 5.0], [1e-9, 1e-3, 0.2, 1.0, 4.0])
HERTZ = {"half_width": 1.0, "radius": 1.0, "modulus": 2.0}  # p0 = 1
PUNCH = {"half_flat": 0.5, "half_width": 1.0, "radius": 1.0, "modulus": 1.0}


def test_mcewens_form_is_the_line_contact():
    for ours, his in zip(
        interior.hertz(X, Y, **HERTZ),
        interior.mcewen(X, Y, half_width=1.0, peak_pressure=1.0),
        strict=True,
    ):
        assert ours == pytest.approx(his, abs=4e-15 * 16)


def test_the_chebyshev_form_of_the_punch_converges_to_the_closed_one_at_depth():
    b_n = rounded_flat.chebyshev_coefficients(40, **PUNCH)
    series = interior.chebyshev(X[-2:], Y[-2:], coefficients=b_n, half_width=1.0, friction=0.3)
    for ours, theirs in zip(
        interior.rounded_flat(X[-2:], Y[-2:], friction=0.3, **PUNCH), series, strict=True
    ):
        assert ours == pytest.approx(theirs, abs=1e-15)


@pytest.mark.parametrize("f", [0.0, 0.3, -0.7])
def test_the_solver_has_the_stresses_of_the_closed_form(f):
    cases = (
        (sie.Parabola(1.0), {**HERTZ, "modulus": 1.0}, interior.hertz),
        (sie.RoundedFlat(0.5, 1.0), PUNCH, interior.rounded_flat),
    )
    for profile, parameters, formula in cases:
        solution = sie.solve(
            sie.Scene(profile=profile, modulus=1.0, half_width=1.0, friction=abs(f))
        )
        solution = solution.with_(tangential_load=f * solution.normal_load)
        x, y = np.append(X.ravel(), [0.5, 0.2, -1.3]), np.append(Y.ravel(), [0.0, 0.0, 0.0])
        found = solution.stress(x, y)
        for ours, theirs in zip(
            (found.xx, found.yy, found.xy), formula(x, y, friction=f, **parameters), strict=True
        ):
            assert ours == pytest.approx(theirs, abs=1e-13)


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("at", [(0.3, 0.2), (-1.0, 0.01), (0.5, 3.0)])
def test_the_closed_forms_are_in_equilibrium_and_compatible_to_thirty_digits(at):
    parameters = {**{k: mp.mpf(v) for k, v in PUNCH.items()}, "friction": mp.mpf("0.3"), "lib": mp}
    x, y = map(mp.mpf, at)

    def along_x(name):
        return mp.diff(lambda t: getattr(interior.rounded_flat(t, y, **parameters), name), x)

    def along_y(name):
        return mp.diff(lambda t: getattr(interior.rounded_flat(x, t, **parameters), name), y)

    assert abs(along_x("xx") + along_y("xy")) < 1e-16
    assert abs(along_x("xy") + along_y("yy")) < 1e-16

    def total(s, t):
        stress = interior.rounded_flat(s, t, **parameters)
        return stress.xx + stress.yy

    assert abs(mp.diff(total, (x, y), (2, 0)) + mp.diff(total, (x, y), (0, 2))) < 1e-10


def test_hertz_yields_on_the_surface_where_the_formula_predicts():
    f, nu, x = 0.4, 0.3, np.linspace(-1.5, 1.5, 100001)
    j2 = interior.second_invariant(interior.hertz(x, 0.0, friction=f, **HERTZ), poisson=nu)
    P = np.pi / 2
    assert P / np.sqrt(j2.max()) == pytest.approx(
        interior.hertz_limit_on_surface(friction=f, poisson=nu), rel=1e-9
    )
    assert x[j2.argmax()] == pytest.approx(f / np.sqrt(1 + f * f), abs=1e-4)


@pytest.mark.parametrize(("y", "words"), [(-1.0, "above the surface"), (np.nan, "finite")])
def test_points_outside_the_body_are_refused(y, words):
    with pytest.raises(ValueError, match=words):
        interior.hertz(0.0, y, **HERTZ)
