"""What the solutions of Cauchy equations obey; references are in 40 digits."""

from itertools import product

import numpy as np
import pytest
import scipy.special
from hypothesis import example, given
from hypothesis import strategies as st
from manufactured_problems import KINDS, PROMISE, agrees, constants, equation_of, problems, words
from strategies import between

import sie
from oracles.manufactured import Manufactured, exponents, mp

PLACES = [complex(s, y) for s in (-1.0, -0.4, 0.9, 1.0) for y in (1e-12, -1e-6, 1e-2, 0.5)]


PLACES += [1 + 1e-12, -1 - 1e-9, 1 + 1e-4j, 1.001, -1.3, 2.0, 5j, 40.0 + 1e-9j, 1e5j, -1e5]


@pytest.mark.parametrize(
    ("a", "ends"),
    [(0.0, KINDS[0]), (0.3, KINDS[1]), (-0.7, KINDS[3]), (0.4j, KINDS[0]), (0.2 + 0.3j, KINDS[2])],
)
def test_the_potential_is_that_of_40_digits_near_and_far(a, ends):
    """Relative to itself, from 1e-12 half-widths off the interval to 1e5 away."""
    poles = ((1.5, 0.3), (-0.2 + 0.8j, 0.1))
    d = Manufactured(-1.0, 3.0, *exponents(a, 1.0, ends), (1.0, -0.5, 0.25, 0.1), poles)
    density = equation_of([d], a, 1.0, [ends]).solve()
    z = 1.0 + 2.0 * np.array(PLACES)
    for where, found in zip(z.tolist(), density.cauchy(z), strict=True):
        expected = complex(d.cauchy(where))
        assert abs(found - expected) <= PROMISE * abs(expected), where


@pytest.mark.slow(but=3)
@pytest.mark.parametrize("gap", [1e-2, 1e-4])
@pytest.mark.parametrize("ends", [(3, 3, 3), (2, 1, 0), (0, 2, 1), (1, 2, 3)])
def test_the_potential_next_to_gaps_of_every_kind_is_that_of_40_digits(ends, gap):
    """Gaps between bounded ends, singular ones, one of each."""
    intervals, ends = ((-1.0, 0.0), (gap, 1.5), (1.5 + 2 * gap, 2.5)), [KINDS[k] for k in ends]
    manufactured = [
        Manufactured(*i, *exponents(0.0, 1.0, e), p)
        for i, e, p in zip(intervals, ends, ((1.0, -0.5), (0.3, 1.0, 0.2), (1.0, 0.4)), strict=True)
    ]
    density = equation_of(manufactured, 0.0, 1.0, ends).solve()
    beside = product((0.0, 1.5), (-2.0, 0.5, 1.3), (1e-6, -0.1, 3.0))
    z = [at + gap * complex(u, v) for at, u, v in beside]
    z += [0.7 + 0.2j, 0.3 - 1e-3j, 1e3j]
    for where, found, slope in zip(z, density.cauchy(z), density.cauchy_derivative(z), strict=True):
        parts = [complex(d.cauchy(where)) for d in manufactured]
        slopes = [complex(mp.diff(d.cauchy, mp.mpc(where))) for d in manufactured]
        assert abs(found - sum(parts)) <= 1e-11 * max(map(abs, parts)), where
        assert abs(slope - sum(slopes)) <= 1e-10 * max(map(abs, slopes)), where


@given(problems(), st.integers(0, 2**32 - 1))
def test_the_potential_jumps_by_the_density(problem, seed):
    """Plemelj: F(x ± i0) = H ∓ i φ, and side 0 is their mean; off the interval there is no side."""
    manufactured, a, b, ends, kernels = problem
    density = equation_of(manufactured, a, b, ends, kernels).solve()
    x1, x2 = density.interval
    x = np.random.default_rng(seed).uniform(x1, x2, 20)
    above, below, principal = (density.cauchy(x, side=side) for side in (1, -1, 0))
    size = np.abs(density(x)) + np.abs(principal)
    assert (np.abs(above - below + 2j * density(x)) <= PROMISE * size).all()
    assert (np.abs(above + below - 2 * principal) <= PROMISE * size).all()
    assert (np.abs(density.hilbert(x) - principal) <= PROMISE * size).all()
    beside = np.array([x1 - 0.3, x2 + 0.1])
    assert (density.cauchy(beside, side=1) == density.cauchy(beside, side=-1)).all()


def kernel(x, t):
    return 0.2 * np.exp(0.4 * x - 0.2 * t) * np.cos(x + 2.0 * t)


@given(constants, between(-1.0, 1.0), between(0.5, 2.0), st.sampled_from(KINDS[1:3]))
@example((1.5260179849842392, 0.3), 1.0, 1.5214466, KINDS[2])  # next to an eigenvalue
def test_the_adjoint_equation_has_the_adjoint_solution(ab, m, r, ends):
    """∫ ψ g = ∫ φ g'; where r is near that of an eigenvalue both have the error that they state."""
    a, b = ab
    interval = (m - r, m + r)
    phi = sie.CauchyEquation(
        interval, lambda x: 1.0 + 2.0 * x, a=a, b=b, k=kernel, ends=words(ends)
    ).solve()
    psi = sie.CauchyEquation(
        interval, lambda x: 3.0 - x, a=a, b=-b, k=lambda x, t: kernel(t, x), ends=words(ends[::-1])
    ).solve()  # fmt: skip
    left, right = psi.resultant + 2.0 * psi.moment, 3.0 * phi.resultant - phi.moment
    size = abs(psi.resultant) + 2.0 * abs(psi.moment) + 3.0 * abs(phi.resultant) + abs(phi.moment)
    assert abs(left - right) <= (PROMISE + phi.error + psi.error) * size


@pytest.mark.parametrize("scale", [1.0, -3.0, 1e-100, 1e100])
@pytest.mark.parametrize("intervals", [((-1.0, 1.0),), ((-1.0, 0.0), (2.0**-10, 0.75))])
def test_an_affine_map_of_the_lengths_changes_nothing_else(scale, intervals):
    """x -> scale x; a reflection turns b and the ends round."""
    ends, b = ("singular", "bounded"), 1.0

    def mapped(intervals, scale):
        moved = tuple(tuple(sorted((scale * x1, scale * x2))) for x1, x2 in intervals)
        turned = scale < 0
        return sie.CauchyEquation(
            moved[::-1] if turned else moved,
            lambda x: np.exp(x / scale), a=0.3, b=-b if turned else b,
            k=lambda x, t: kernel(x / scale, t / scale) / abs(scale),
            ends=ends[::-1] if turned else ends,
        ).solve()  # fmt: skip

    plain, scaled = mapped(intervals, 1.0), mapped(intervals, scale)
    x = np.concatenate([x1 + (x2 - x1) * np.array([0.1, 0.3, 0.6, 0.9]) for x1, x2 in intervals])
    agrees(scaled(scale * x), plain(x), PROMISE, "value")
    assert scaled.resultant / abs(scale) == pytest.approx(plain.resultant, rel=PROMISE)
    assert scaled.moment / scale / abs(scale) == pytest.approx(plain.moment, rel=PROMISE)
    z = np.array([0.3 + 0.01j, 2.0 - 3.0j])
    turned = scaled.cauchy(scale * z) * (1.0 if scale > 0 else -1.0)
    agrees(turned, plain.cauchy(z), PROMISE, "potential")


@pytest.mark.parametrize("k", [None, kernel])
def test_the_residual_is_small_at_points_that_were_not_used(k):
    """By the density's own values and potential, and a quadrature of the tests for the kernel."""
    a, b = 0.4, -0.8
    density = sie.CauchyEquation(
        (-1.0, 2.0), np.cos, a=a, b=b, k=k, ends="bounded", free=(1.0,)
    ).solve()
    x = np.array([-0.93, -0.2, 0.7, 1.9])
    right, left = density.parts[0].weight.alpha, density.parts[0].weight.beta
    s, weight = scipy.special.roots_jacobi(40, right, left)
    t = 0.5 + 1.5 * s
    values = 1.5 * weight * density(t) / ((1 - s) ** right * (1 + s) ** left)
    smooth = 0.0 if k is None else k(x[:, None], t) @ values
    left_over = a * density(x) - b * density.hilbert(x) + smooth - np.cos(x) - density.constants[0]
    assert np.abs(left_over).max() <= PROMISE


@pytest.mark.parametrize(("incidence", "camber"), [(0.1, 0.0), (0.03, 0.2)])
def test_the_thin_aerofoil_has_the_circulation_of_the_closed_form(incidence, camber):
    """1/2π PV∫ γ/(x - t) dt = incidence + camber x, γ(1) = 0 (Glauert 1926)."""
    sheet = sie.CauchyEquation(
        (-1.0, 1.0), lambda x: incidence + camber * x, b=-0.5, ends=("singular", "bounded")
    ).solve()
    x = np.linspace(-0.99, 0.99, 21)
    closed = 2.0 * incidence * np.sqrt((1 - x) / (1 + x)) + 2.0 * camber * np.sqrt(
        (1 - x) * (1 + x)
    )
    assert sheet(x) == pytest.approx(closed, rel=PROMISE)
    assert sheet.resultant == pytest.approx(2.0 * np.pi * (incidence + 0.5 * camber), rel=PROMISE)


def _ridge(x, t):
    return 0.1 / ((t - x) ** 2 + 0.01)


@pytest.mark.parametrize("k", [None, _ridge])
@pytest.mark.parametrize("multiple", [1.0, 0.3, -2.3])
def test_a_right_hand_side_made_of_free_functions_has_no_density(multiple, k):
    """g = -d u has the solution φ = 0, whatever rounding leaves of the sum."""

    def shape(x):
        return np.cos(3.0 * x) / 3.0

    asked = sie.CauchyEquation(
        (-1.0, 1.0), lambda x: multiple * shape(x), k=k, ends="bounded", free=(shape,)
    )
    density = asked.solve()
    np.testing.assert_array_equal(density([-0.6, 0.2]), 0.0)
    np.testing.assert_allclose(density.constants, -multiple, rtol=1e-13)
    assert density.error < 1e-14
    if k is None:
        return
    apart = sie.CauchyEquation(
        ((-1.0, 1.0), (2.0, 3.0)), 1.0, k=k, ends="bounded", free=(1.0, np.sin)
    )
    np.testing.assert_array_equal(apart.solve()([-0.6, 2.2]), 0.0)
