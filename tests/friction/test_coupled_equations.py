"""Both equations of dissimilar bodies under P hold, and an independent program agrees."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pressed_cases import PROFILES, solved

import sie
from sie.certificate.coupled_check import coupled_certificate
from sie.friction.coupled.traction import smooth_between
from sie.numerics.interval import Interval

# -- the two equations -----------------------------------------------------------------------------


@pytest.mark.slow(but=12)
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


@pytest.mark.parametrize("depth", [1e-3, 1e-13, 1e-200])
@pytest.mark.parametrize("marks", [[], [0.3], [-0.2, 0.3]])
def test_potential_of_a_half_ellipse_is_the_closed_form_at_any_depth(depth, marks):
    half_ellipse = smooth_between(
        Interval(-1.0, 1.0), lambda x: np.sqrt(1.0 - x * x), marks, 0.5 * math.pi
    )
    z = np.array([-1.7, -0.6, 0.3, 0.9, 1.4]) + 1j * depth
    root = np.sqrt(z - 1.0) * np.sqrt(z + 1.0)
    F, dF = half_ellipse.potentials(z)
    np.testing.assert_allclose(F, z - root, rtol=1e-12)
    np.testing.assert_allclose(dF[[0, 1, 3, 4]], (1.0 - z / root)[[0, 1, 3, 4]], rtol=1e-11)


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


@pytest.mark.parametrize("side", [1, -1, 0])
def test_potential_and_derivative_are_those_that_are_asked_for_alone(side):
    density = solved(PROFILES["parabola"]).shear
    z = np.array([[0.3 + 0.2j, -0.4], [2.0, 0.1 - 0.7j], [1e40 + 1j, complex(math.nan, 1.0)]])
    F, dF = density.potentials(z, side)
    np.testing.assert_array_equal(F, density.cauchy(z, side))
    np.testing.assert_array_equal(dF, density.cauchy_derivative(z, side))


def test_potential_far_away_is_the_load_over_the_distance():
    pressure = solved(sie.Parabola(1.0)).pressure
    z = np.array([1e8j, 1e99j, 1e120 + 1e120j])
    F, dF = pressure.potentials(z)
    np.testing.assert_allclose(F, 1.0 / (math.pi * z), rtol=1e-7)
    np.testing.assert_allclose(dF, -1.0 / (math.pi * z * z), rtol=1e-7)


def test_surface_stress_is_in_balance_with_the_tractions():
    solution = solved(sie.RoundedFlat(0.5, 1.0), poisson=0.3, normal_load=0.6)
    x = np.linspace(-0.95, 0.95, 11) * solution.half_width
    surface, below = solution.surface_stress(x), solution.stress(x, 1e-10)
    assert surface.yy == pytest.approx(-solution.pressure(x), abs=1e-12)
    assert surface.xy == pytest.approx(-solution.shear(x), abs=1e-12)
    assert below.xx == pytest.approx(surface.xx, abs=1e-6)
