"""Both equations of dissimilar bodies under P hold, and an independent program agrees."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pressed_cases import PROFILES, solved

import sie
from sie.certificate.coupled_check import coupled_certificate


@pytest.mark.slow(but=12)
@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.07, 0.3), (0.5, 0.1)])
def test_certificate_holds_for_every_profile(name, beta, friction):
    certificate = solved(PROFILES[name], beta, friction).check()
    assert certificate.ok
    assert certificate.residual < 1e-10


@pytest.mark.slow(but=4)
@pytest.mark.parametrize("narrow", [0.03, 0.1, 0.3])
@pytest.mark.parametrize(("beta", "friction"), [(0.2, 0.3), (0.05, 0.5)])
def test_certificate_is_as_strict_in_a_narrow_strip_beside_a_flat_base(narrow, beta, friction):
    right = solved(sie.RoundedFlat(1.0, 1.0), beta, friction, half_width=1.0 + narrow)
    certificate = right.check()
    assert certificate.ok and certificate.residual < 1e-11 and certificate.abscissae < 1e-13
    other = replace(right.scene, dundurs=beta * (1.0 + 1e-7))
    assert not coupled_certificate(right.coupled[1], other, 1e-13).ok


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


def test_surface_stress_is_in_balance_with_the_tractions():
    solution = solved(sie.RoundedFlat(0.5, 1.0), poisson=0.3, normal_load=0.6)
    x = np.linspace(-0.95, 0.95, 11) * solution.half_width
    surface, below = solution.surface_stress(x), solution.stress(x, 1e-10)
    assert surface.yy == pytest.approx(-solution.pressure(x), abs=1e-12)
    assert surface.xy == pytest.approx(-solution.shear(x), abs=1e-12)
    assert below.xx == pytest.approx(surface.xx, abs=1e-6)
