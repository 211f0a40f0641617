"""Cracks by their dislocation density, against textbooks: 1/π PV∫ φ(t)/(t - x) dt = p(x), ∫φ dx = 0
over each crack.

Next to a tip φ ~ K/sqrt(2π) (distance)^(-1/2), minus at a left tip, K the stress intensity factor
of the pressure p on the faces. Tada, Paris & Irwin, The Stress Analysis of Cracks Handbook (2000);
two collinear cracks: Willmore (1949); row: Koiter (1959).
"""

import mpmath
import numpy as np
import pytest
import scipy.special
from hypothesis import given
from strategies import between, log_between

import sie
from analytic import cracks

PROMISE = 1e-12  # of a stress intensity factor
mp = mpmath.mp.clone()
mp.dps = 40


def intensity_factors(density):
    """(left, right) of each crack."""
    return [
        (-np.sqrt(2.0 * np.pi) * left, np.sqrt(2.0 * np.pi) * right)
        for left, right in density.intensities
    ]


def slit(half_length, pressure, centre=0.0, **question):
    return sie.CauchyEquation(
        (centre - half_length, centre + half_length), pressure, total=0.0, **question
    ).solve()


@given(log_between(1e-8, 1e8), log_between(1e-8, 1e8))
def test_a_slit_under_uniform_pressure(a, p):
    density = slit(a, p)
    assert intensity_factors(density)[0] == pytest.approx([p * np.sqrt(np.pi * a)] * 2, rel=PROMISE)
    x = a * np.array([-0.99, 0.2, 0.7])
    assert density(x) == pytest.approx(p * x / np.sqrt((a - x) * (a + x)), rel=PROMISE)


@pytest.mark.parametrize("ligament", [1.0, 1e-2, 1e-4, 1e-6, 1e-8])
def test_two_collinear_cracks(ligament):
    """`ligament` relative to the length of a crack. The bar at 1e-6 is 1e-9."""
    a = 0.5 * ligament
    density = sie.CauchyEquation(((-1.0 - a, -a), (a, 1.0 + a)), 1.0, total=(0.0, 0.0)).solve()
    inner, outer = cracks.pair(inner=mp.mpf(a), outer=mp.mpf(1.0 + a), tension=1, lib=mp)
    (left_outer, left_inner), (right_inner, right_outer) = intensity_factors(density)
    assert [left_outer, right_outer] == pytest.approx([float(outer)] * 2, rel=PROMISE)
    assert [left_inner, right_inner] == pytest.approx([float(inner)] * 2, rel=PROMISE)
    assert max(density.n) <= 128


@given(between(0.02, 0.98))
def test_a_crack_in_a_periodic_row(fraction):
    """The others are a kernel, π/W cot(πu) - 1/(W u), u = (t - x)/W; K = p sqrt(W tan(πa/W))."""
    W = 2.5
    a = 0.5 * W * fraction

    def others(x, t):
        u = (t - x) / W
        return (scipy.special.digamma(1.0 - u) - scipy.special.digamma(1.0 + u)) / (np.pi * W)

    exact = np.sqrt(W * np.tan(0.5 * np.pi * fraction))
    assert intensity_factors(slit(a, 1.0, k=others))[0] == pytest.approx([exact] * 2, rel=PROMISE)
