"""The paper's charts as numbers: against closed forms, and its claims about them."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from analytic import interior, rounded_flat
from oracles.normal_contact import mp
from sie import charts


def limit(ratio, friction=0.0):
    return charts.punch(ratio, friction).elastic_limit().ratio


def test_the_yield_parameter_is_that_of_the_closed_form():
    x, y = np.meshgrid(np.linspace(-1.5, 1.5, 7), [0.0, 0.1, 1.0])
    for ratio, f in ((0.3, 0.0), (0.8, 0.3)):
        punch = {"half_flat": ratio, "half_width": 1.0, "radius": 1.0, "modulus": 1.0}
        j2 = interior.second_invariant(
            interior.rounded_flat(x, y, friction=f, **punch), poisson=0.3
        )
        assert charts.yield_parameter(ratio, f, x, y) == pytest.approx(
            np.sqrt(j2) / rounded_flat.load(**punch), rel=1e-11, abs=1e-13
        )


def test_the_punch_is_as_strong_as_hertz_at_054_and_strongest_at_027():
    """The paper says 0.55; these are those of the closed form in 30 digits."""
    hertz = limit(0.0)
    assert brentq(lambda a: limit(a) - hertz, 0.5, 0.6, xtol=1e-13) == pytest.approx(
        0.540206764905, abs=2e-12
    )
    strongest = minimize_scalar(
        lambda a: -limit(a), bounds=(0.2, 0.35), method="bounded", options={"xatol": 1e-9}
    )
    assert strongest.x == pytest.approx(0.268697910258, abs=1e-6)
    assert -strongest.fun / hertz == pytest.approx(1.0917, abs=5e-5)
    assert limit(0.9) / hertz == pytest.approx(0.5247, abs=5e-5)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.8])
def test_the_surface_tension_in_partial_slip_is_that_of_the_potential(ratio):
    """2f [E*(b - a)/(2R) - F_c(b)], F_c the potential of the stick zone's corrective traction."""
    parameters = {"half_flat": mp.mpf(ratio), "radius": 1, "modulus": 1, "lib": mp}
    stick = [c for c in (0.0, 0.2, 0.5, 0.9, 0.999) if c == 0.0 or c > ratio]
    P = rounded_flat.load(half_width=mp.one, **parameters)

    def corrective(c):
        return mp.re(rounded_flat.potential(mp.one, half_width=mp.mpf(c), **parameters)) if c else 0

    whole = mp.mpf(1 - ratio) / 2
    expected = [float(2 * mp.pi / P * (whole - corrective(c))) for c in stick]
    assert charts.surface_tension(ratio, stick) == pytest.approx(expected, rel=2e-12)
    assert charts.surface_tension(ratio, 1.0) == 0.0


@pytest.mark.parametrize("ratio", [-0.1, 1.0, np.nan])
def test_a_ratio_that_is_no_punch_is_refused(ratio):
    with pytest.raises(ValueError, match="ratio"):
        charts.punch(ratio)


def test_a_stick_zone_beyond_the_contact_is_refused():
    with pytest.raises(ValueError, match="outside"):
        charts.surface_tension(0.3, 1.1)
