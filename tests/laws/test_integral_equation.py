"""E*/2 h' = 1/π PV∫ p(ξ)/(x - ξ) dξ in contact, the limit of F(z) = 1/π ∫ p(t)/(z - t) dt."""

from itertools import product

import laws
import numpy as np
import pytest
import strategies
from hypothesis import given
from hypothesis import strategies as st

import sie
from oracles import normal_contact
from oracles.normal_contact import mp
from validation.cases import CASES, Case, exact, points, solved

PROMISE = 1e-13  # of the peak


def interior(solution, seed, n=6, margin=0.02):
    """Random points off every grid, not closer than `margin` r to an edge or a break."""
    (x1, x2), r = solution.edges, solution.half_width
    marks = np.array([x1, x2, *solution.scene.profile.breaks])
    x = np.random.default_rng(seed).uniform(x1, x2, 200)
    return x[np.abs(x[:, None] - marks).min(axis=1) > margin * r][:n]


@given(strategies.scenes(), st.integers(0, 2**32 - 1))
def test_the_pressure_solves_the_integral_equation(scene, seed):
    solution = sie.solve(scene)
    breaks = scene.profile.breaks
    peak = laws.peak(solution.pressure, solution.edges, breaks)
    for x in interior(solution, seed):
        at = solution.pressure, solution.edges, x, breaks
        slope = 0.5 * scene.Estar * (scene.profile.slope(x) + solution.tilt)
        off = abs(laws.principal_value(*at) - slope)
        assert off <= PROMISE * peak + 4 * laws.rounding_of_principal_value(*at)


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_pressure_agrees_with_the_40_digit_reference(case: Case):
    solution, truth = solved(case), exact(case)
    x = points(case)
    expected = [truth.pressure(t) for t in x]
    peak = max(expected)
    for value, e in zip(solution.pressure(x), expected, strict=True):
        assert abs(mp.mpf(float(value)) - e) <= PROMISE * peak


def places(case: Case) -> list[complex]:
    """Off the axis next to the surface, breaks and edges; beside the contact; far away."""
    solution = solved(case)
    (x1, x2), r, m = solution.edges, solution.half_width, solution.centre
    about = (
        -0.83 + 1e-9j,
        0.11 + 1e-3j,
        0.37 + 0.6j,
        0.95 - 0.02j,
        1.3 + 0.01j,
        -1.2 - 1e-7j,
        0.2 + 9j,
    )
    z = [m + r * s for s in about]
    z += [complex(x2 + 1e-5 * r, 1e-5 * r), complex(x1 - 1e-3 * r, 1e-9 * r)]
    z += [complex(x2 + 0.01 * r), complex(x1 - 0.4 * r), complex(x2 + 30 * r)]
    z += [complex(b + 1e-6 * r, 1e-6 * r) for b in case.profile.breaks[:3]]
    return z


@pytest.mark.slow(but=12)
@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_potential_agrees_with_the_40_digit_reference(case: Case):
    """Relative to the peak near the contact, to itself beyond."""
    solution, truth = solved(case), exact(case)
    peak = laws.peak(solution.pressure, solution.edges, case.profile.breaks)
    z = places(case)
    for where, value in zip(z, solution.pressure.cauchy(z), strict=True):
        e = truth.potential(where)
        near = abs(where - solution.centre) < 4 * solution.half_width
        size = max(peak if near else 0.0, abs(complex(e)))
        assert abs(mp.mpmathify(complex(value)) - e) <= PROMISE * size, where


@given(strategies.scenes(), st.integers(0, 2**32 - 1), strategies.between(0.05, np.pi - 0.05))
def test_the_potential_is_the_integral_of_its_pressure(scene, seed, angle):
    solution = sie.solve(scene)
    breaks, r = scene.profile.breaks, solution.half_width
    t, weight = laws.rule(solution.edges, breaks)
    rounding = laws.rounding_of_x(solution.pressure, solution.edges, breaks) / scene.normal_load
    for distance in (1.5, 20.0):
        z = solution.centre + distance * r * np.exp(1j * angle * np.array([1.0, -1.0]))
        direct = (weight * solution.pressure(t) / (z[:, None] - t)).sum(axis=1) / np.pi
        assert solution.pressure.cauchy(z) == pytest.approx(direct, rel=PROMISE + 100 * rounding)


@pytest.mark.slow
@given(strategies.scenes(), st.integers(0, 2**32 - 1))
def test_the_potential_jumps_by_the_pressure_across_the_contact(scene, seed):
    """Plemelj: F(x ± i0) = E*/2 h' ∓ i p."""
    solution = sie.solve(scene)
    x = interior(solution, seed, 20, margin=0.0)
    p, slope = solution.pressure, 0.5 * scene.Estar * (scene.profile.slope(x) + solution.tilt)
    peak = laws.peak(p, solution.edges, scene.profile.breaks)
    above, below, principal = (p.cauchy(x, side=side) for side in (1, -1, 0))
    assert above.imag == pytest.approx(-p(x), abs=PROMISE * peak)
    assert above.real == pytest.approx(slope, abs=PROMISE * peak)
    assert below == pytest.approx(above.conj(), abs=PROMISE * peak)
    assert principal == pytest.approx(slope, abs=PROMISE * peak)


@given(strategies.scenes(), st.integers(0, 2**32 - 1))
def test_the_potential_reaches_its_limit_at_the_surface_continuously(scene, seed):
    """The difference is the depth times the derivative, and rounding."""
    solution = sie.solve(scene)
    r = solution.half_width
    beside = (
        solution.edges[1] + r * np.array([0.1, 1.0]),
        solution.edges[0] - r * np.array([0.1, 3.0]),
    )
    x = np.concatenate((interior(solution, seed, 8), *beside))
    peak = laws.peak(solution.pressure, solution.edges, scene.profile.breaks)
    F = solution.pressure.cauchy
    derivative = np.abs(F(x + 1e-5j * r) - F(x)) / 1e-5
    for side in (1, -1):
        surface = F(x, side=side)
        for depth in (1e-6, 1e-9, 1e-12, 1e-15):
            assert (
                np.abs(F(x + side * 1j * depth * r) - surface)
                <= 2 * depth * derivative + 4 * PROMISE * peak
            ).all()


@pytest.mark.parametrize("case", CASES, ids=str)
def test_far_away_the_potential_is_that_of_a_line_load_to_full_relative_accuracy(case: Case):
    """π z F(z) = P + M/z + ..., about the centre."""
    solution = solved(case)
    P, r = solution.normal_load, solution.half_width
    M = solution.moment - solution.centre * P
    t, weight = laws.rule(solution.edges, case.profile.breaks)
    second = float((weight * solution.pressure(t) * (t - solution.centre) ** 2).sum())
    for k, angle in product((1e4, 1e6), (0.0, 1e-9, 0.3, np.pi)):
        direction = complex(np.cos(angle), 0.0 if angle in (0.0, np.pi) else np.sin(angle))
        z = solution.centre + k * r * direction
        s = z - solution.centre
        expected = (P + M / s + second / s**2) / (np.pi * s)
        assert complex(solution.pressure.cauchy(z)) == pytest.approx(
            expected, rel=2 * PROMISE + 2 * k**-3
        )


SAMPLED = (
    "rounded-P=0.2",
    "rounded-P=0.2-tilt=0.05",
    "corners-r=1.125",
    "eight-P=0.9",
    "flat-P=1-tilt=1.5",
    "cut-P=0.6",
)
GAP_CASES = [case for case in CASES if str(case) in SAMPLED]


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("case", GAP_CASES, ids=str)
def test_the_gap_agrees_with_the_40_digit_reference(case: Case):
    solution, truth = solved(case), exact(case)
    (x1, x2), r = solution.edges, solution.half_width
    lo, hi = case.profile.domain
    for x in (x2 + 0.01 * r, x2 + 1.3 * r, x1 - 0.4 * r):
        if lo <= x <= hi:
            assert float(solution.gap(x)) == pytest.approx(float(truth.gap(x)), rel=1e-11)


@given(strategies.scenes())
def test_the_gap_is_zero_in_contact_positive_outside_and_infinite_beyond_the_indenter(scene):
    solution = sie.solve(scene)
    (x1, x2), r = solution.edges, solution.half_width
    lo, hi = scene.profile.domain
    assert (solution.gap(x1 + 2 * r * np.linspace(1e-9, 1 - 1e-9, 33)) == 0).all()
    outside = np.concatenate(
        (x2 + r * np.array([1e-3, 0.1, 1.0]), x1 - r * np.array([1e-3, 0.1, 1.0]))
    )
    gap = solution.gap(outside)
    beyond = (outside < lo) | (outside > hi)
    assert (gap[beyond] == np.inf).all()
    assert (gap[~beyond] > 0).all()
    assert np.isfinite(gap[~beyond]).all()


@given(strategies.scenes(), st.integers(0, 2**32 - 1))
def test_the_slope_of_the_gap_is_that_of_the_profile_less_that_of_the_surface(scene, seed):
    """gap' = h' - 2/E* F, by differences of the gap."""
    solution = sie.solve(scene)
    (x1, x2), r = solution.edges, solution.half_width
    d = r * np.random.default_rng(seed).uniform(0.3, 2.0, 4)
    x = np.concatenate((x2 + d, x1 - d))
    lo, hi = scene.profile.domain
    step = 1e-4 * r
    marks = np.array([*scene.profile.breaks, lo, hi])
    x = x[(x > lo) & (x < hi) & (np.abs(x[:, None] - marks).min(axis=1) > 2 * step)]
    slope = scene.profile.slope(x) + solution.tilt - 2 / scene.Estar * solution.pressure.hilbert(x)
    difference = (solution.gap(x + step) - solution.gap(x - step)) / (2 * step)
    assert difference == pytest.approx(slope, rel=1e-5, abs=1e-6)


def test_the_reference_reproduces_the_closed_form_of_the_rounded_punch():
    """p(0) = E*/(πR) [bθ - a arccosh(b/a)], P = E*b²/(2R) (θ - sin θ cos θ), and one F."""
    a, b = mp.mpf(1) / 2, mp.mpf(1)
    pieces = normal_contact.Pieces(
        (-mp.inf, -a, a, mp.inf), (lambda t: t + a, lambda t: 0 * t, lambda t: t - a)
    )
    contact = normal_contact.contact(pieces, 1.0, (-1.0, 1.0), half_width=1.0, symmetric=True)
    theta = mp.acos(a / b)
    assert abs(contact.P - (theta - mp.sin(theta) * mp.cos(theta)) / 2) < mp.mpf(10) ** -30
    assert abs(contact.pressure(0) - (b * theta - a * mp.acosh(b / a)) / mp.pi) < mp.mpf(10) ** -30
    z = mp.mpc("0.4", "1e-7")
    v, tau, S = mp.sqrt((z + b) / (z - b)), mp.tan(theta / 2), mp.sqrt(z - b) * mp.sqrt(z + b)
    F = ((z - a) * mp.atan(tau * v) + (z + a) * mp.atan(tau / v) - theta * S) / mp.pi
    assert abs(contact.potential(z) - F) < mp.mpf(10) ** -30
