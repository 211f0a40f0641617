"""Manufactured solutions of Cauchy equations; references are in 40 digits."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from manufactured_problems import KINDS, PROMISE, agrees, equation_of, inside, problems

import sie
from oracles.manufactured import Manufactured, exact, exponents, mp, needed, right_hand_side


@pytest.mark.parametrize(("a", "ends"), [(0.3, KINDS[3]), (0.2 + 0.3j, KINDS[1]), (-0.4, KINDS[2])])
def test_the_manufactured_integrals_agree_with_quadrature(a, ends):
    mp = mpmath.mp.clone()
    mp.dps = 30
    d = Manufactured(
        -1.0, 3.0, *exponents(a, 1.0, ends), (1.0, -0.5, 0.25), ((1.5, 0.3), (-0.2 + 1j, 0.1j))
    )
    z = mp.mpc(0.3, 0.9)
    for kernel, closed in (
        (lambda x: 1 / (mp.pi * (z - x)), d.cauchy(z)),
        (lambda x: 1, d.total),
        (lambda x: x, d.moment),
    ):
        integral = mp.quad(
            lambda s, kernel=kernel: d.value(d.m + d.r * s) * kernel(d.m + d.r * s) * d.r,
            [-1, 0, 1],
        )
        # The error is that of tanh-sinh towards an end with an exponent of -0.6.
        assert abs(integral - closed) < mp.mpf(10) ** -14


@pytest.mark.slow
@given(problems())
def test_a_manufactured_density_is_found_with_few_more_nodes_than_it_needs(problem):
    manufactured, a, b, ends, kernels = problem
    (d,) = manufactured
    density = equation_of(manufactured, a, b, ends, kernels).solve()
    x = inside(d)
    agrees(density(x), exact(d.value, x), PROMISE, "value")
    total = complex(d.total)
    bound = PROMISE * max(1.0, abs(peak_of(d) / total))
    agrees(density.parts[0].resultant, total, bound, "total")
    size = np.abs(exact(d.value, x)).max()
    assert np.abs(density.cauchy(x, side=0) - exact(d.cauchy, x)).max() <= 4 * PROMISE * size
    g = right_hand_side(manufactured, a, b, kernels)
    assert density.n[0] <= nodes_for(d, g)
    assert density.error <= PROMISE


def nodes_for(d, g):
    """Twice as many as f and g need, or the size after that: sizes grow by 1.45."""
    enough, tenth = (max(needed([d], t)[0], needed([d], t, g)[0]) for t in (PROMISE, 0.1 * PROMISE))
    return max(2 * max(enough, 4), 1.45 * (tenth + 3) + 1)


def peak_of(d):
    x = inside(d)
    return float(np.abs(exact(d.value, x)).max()) * float(d.r)


@pytest.mark.slow
@settings(max_examples=15)
@given(problems(intervals=2))
def test_manufactured_densities_on_two_intervals_are_found(problem):
    manufactured, a, b, ends, kernels = problem
    if all(d.kappa == -1 for d in manufactured):
        # Bounded everywhere, with a kernel whose rounding is an inconsistency: the law of
        # consistency has its own test
        kernels = ()
    density = equation_of(manufactured, a, b, ends, kernels).solve()
    size = max(np.abs(exact(d.value, inside(d))).max() for d in manufactured)
    for d in manufactured:
        assert np.abs(density(inside(d)) - exact(d.value, inside(d))).max() <= 10 * PROMISE * size
    beside = manufactured[0].x1 - 1e-6
    z = np.array([beside, manufactured[-1].x2 + 3.0 + 4.0j] + [d.x2 + 0.01j for d in manufactured])
    expected = np.array([complex(sum(d.cauchy(complex(v)) for d in manufactured)) for v in z])
    bound = np.full(len(z), 10 * PROMISE * max(size, np.abs(expected).max()))
    bound[0] += PROMISE * reach(manufactured[0], beside)
    assert (np.abs(density.cauchy(z) - expected) <= bound).all()


def reach(d, z):
    """|W(z)/sin πα| max |f|: next to an end F is W(z) f(z)/sin πα. f, known to its peak, may vanish
    there by chance while W is large, and F has fewer digits then.
    """
    peak = max(abs(d.f(s)) for s in np.linspace(-1.0, 1.0, 21).tolist())
    return float(abs(d.W((mp.mpf(z) - d.m) / d.r) / mp.sinpi(d.alpha)) * peak)


@pytest.mark.slow(but=12)
@pytest.mark.parametrize("at", [0.0, 0.3])
@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-6])
@pytest.mark.parametrize(
    ("a", "ends"), [(0.2j, KINDS[0]), *((a, ends) for a in (0.0, 0.3) for ends in KINDS)]
)
def test_next_to_a_narrow_gap_ten_digits_are_kept_and_the_error_is_stated(a, ends, gap, at):
    """At bounded ends too, where φ is far below its peak; the error to a factor of three."""
    intervals, both = ((at - 1.0, at), (at + gap, at + 1.5)), (ends, ends[::-1])
    manufactured = [
        Manufactured(*i, *exponents(a, 1.0, e), p)
        for i, e, p in zip(intervals, both, ((1.0, -0.5, 0.25), (1.0, 2.0)), strict=True)
    ]
    density = equation_of(manufactured, a, 1.0, both).solve()
    for d, part in zip(manufactured, density.parts, strict=True):
        agrees(density(inside(d)), exact(d.value, inside(d)), 1e-10, "value")
        if at == 0.0:
            x = d.x1 + (d.x2 - d.x1) * np.array([1e-6, 0.999])
            agrees(density(x), exact(d.value, x), 1e-10, "value")
            ratio = np.divide(part.intensities, np.array(d.intensities, dtype=complex))
            agrees(ratio, np.ones(2), 1e-10, "intensities")
    assert max(density.n) <= 128  # ln(1/gap) only
    true = max(weighted_error(d, part) for d, part in zip(manufactured, density.parts, strict=True))
    assert true <= 3.0 * density.error
    assert density.error <= 50.0 * max(true, 1e-15)


def weighted_error(d, part):
    s = np.cos(np.pi * (np.arange(50) + 0.5) / 50)
    right, left, *_ = part.map.distances(1.0 - s, 1.0 + s)
    norm = (1.0 - s) ** (0.25 - 0.5 * part.weight.alpha) * (1.0 + s) ** (
        0.25 - 0.5 * part.weight.beta
    )
    expected = np.array(
        [complex(d.value_at(*pair)) for pair in zip(right.tolist(), left.tolist(), strict=True)]
    )
    return (np.abs(part.value(right, left) - expected) * norm).max() / (
        np.abs(expected) * norm
    ).max()


@pytest.mark.parametrize("offset", [1e3, 1e6])
@pytest.mark.parametrize("k", [None, lambda x, t: 0.1 * np.cos(x - t)])
def test_far_from_zero_the_density_has_the_error_of_its_positions_and_states_it(offset, k):
    """A double at x is x EPS off; of g and k, smooth over a length of 1, as much is unknown."""

    def moved(by):
        return sie.CauchyEquation((by, 1.0 + by), lambda x: np.exp(x - by), k=k, total=1.0).solve()

    x = np.linspace(0.125, 0.875, 9)  # exact doubles, also with the offset
    far = moved(offset)
    agrees(far(x + offset), moved(0.0)(x), 4.0 * offset * 2.2e-16, "value")
    assert 0.01 * offset * 2.2e-16 <= far.error <= 100.0 * offset * 2.2e-16


@pytest.mark.parametrize("distance", [1.0, 1e-4, 1e-8])
def test_near_an_eigenvalue_the_density_has_the_error_of_rounding_and_states_it(distance):
    """k = c t has φ = A x/sqrt(1 - x²), A (1 + π/2 c) = 1; no residual shows the error of A."""
    c = -2.0 / np.pi * (1.0 - distance)
    density = sie.CauchyEquation(
        (-1.0, 1.0), 1.0, k=lambda x, t: c * t + 0.0 * x, total=0.0
    ).solve()
    amplitude = float(1 / (1 + mp.pi / 2 * mp.mpf(c)))
    x = np.array([-0.9, -0.3, 0.2, 0.7])
    agrees(density(x), amplitude * x / np.sqrt((1.0 - x) * (1.0 + x)), 3.0 * density.error, "value")
    assert 2.2e-16 / distance <= density.error <= 50.0 * 2.2e-16 / distance
