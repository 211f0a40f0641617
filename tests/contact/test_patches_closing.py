"""Gaps that close to 1e-10 of a patch, on the line and per period, against closed forms."""

import mpmath
import numpy as np
import pytest

import sie
from analytic import flat_row, parabola_row, two_flats, two_parabolas

DIGITS = mpmath.MPContext()
DIGITS.dps = 40
GAPS = [1e-2, 1e-6, 1e-10]
INSIDE = np.array([1e-6, 1e-3, 0.1, 0.4, 0.7, 0.97, 1.0 - 1e-6])


def solved(**asked):
    return sie.solve(sie.Scene(modulus=1.0, **asked))


def exact(form, x, **asked):
    """A closed form at 40 digits."""
    known = {name: DIGITS.mpf(value) for name, value in asked.items()}
    return np.array([float(form(DIGITS.mpf(float(at)), **known, lib=DIGITS)) for at in x])


@pytest.mark.parametrize("gap", GAPS)
def test_two_flats_with_a_gap_that_closes(gap):
    row = sie.Row([sie.Flat(0.5).shifted(s * (0.5 * gap + 0.5)) for s in (-1.0, 1.0)])
    solution = solved(profile=row, normal_load=2.0)
    (a, b) = solution.patches[1]
    x = a + (b - a) * INSIDE
    expected = exact(two_flats.pressure, x, inner=a, outer=b, normal_load=2.0)
    assert solution.pressure(x) == pytest.approx(expected, rel=1e-13)
    assert solution.check().ok


@pytest.mark.parametrize("gap", GAPS)
def test_a_row_of_flats_with_a_gap_that_closes(gap):
    flat = sie.Flat(0.5 - 0.5 * gap).shifted(0.5)
    solution = solved(profile=sie.Periodic(flat, 1.0), normal_load=2.0)
    ((a, b),) = solution.patches
    x = a + (b - a) * INSIDE
    half, middle = (DIGITS.mpf(b) - DIGITS.mpf(a)) / 2, (DIGITS.mpf(b) + DIGITS.mpf(a)) / 2
    expected = [
        float(flat_row.pressure(v - middle, half_width=half, period=1, mean_pressure=2, lib=DIGITS))
        for v in map(DIGITS.mpf, x.tolist())
    ]
    assert solution.pressure(x) == pytest.approx(expected, rel=1e-13)
    assert solution.check().ok


@pytest.mark.parametrize("gap", GAPS)
def test_a_row_of_parabolas_with_a_gap_that_closes(gap):
    shape = {"radius": 1, "period": 1, "modulus": 1}
    load = float(parabola_row.mean_pressure(half_width=0.5 - 0.5 * gap, **shape))
    solution = solved(profile=sie.Periodic(sie.Parabola(1.0), 1.0), normal_load=load)
    half = parabola_row.half_width(mean_pressure=DIGITS.mpf(load), **shape, lib=DIGITS)
    ((a, b),) = solution.patches
    assert (a, b) == pytest.approx((-float(half), float(half)), abs=1e-13)
    x = float(half) * np.array([0.0, 0.3, 0.6, 0.9, 0.99])
    expected = exact(parabola_row.pressure, x, half_width=half, **shape)
    assert solution.pressure(x) == pytest.approx(expected, rel=1e-12)
    assert solution.check().ok


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("gap", GAPS)
def test_the_ridge_between_two_parabolas_that_close_in_stands_off_as_its_pressure_says(gap):
    """g(0) = h(0) - h(c) - 2/(πE*) ∫_c^b p ln(t²/(t² - c²)) dt, patches [c, b] and [-b, -c]."""
    shape = {"radius": 1.0, "modulus": 1.0}
    d = float(two_parabolas.distance(inner=0.5 * gap, outer=0.5 * gap + 1.0))
    load = float(two_parabolas.load(inner=0.5 * gap, outer=0.5 * gap + 1.0, **shape))
    row = sie.Row([sie.Parabola(1.0).shifted(s * d) for s in (-1.0, 1.0)])
    digits = mpmath.MPContext()
    digits.dps = 25
    c, b = two_parabolas.edges(
        normal_load=digits.mpf(load), distance=digits.mpf(d), radius=1, modulus=1, lib=digits
    )

    def work(t):
        p = two_parabolas.pressure(t, inner=c, outer=b, radius=1, modulus=1, lib=digits)
        return p * digits.log(t * t / ((t - c) * (t + c)))

    ends = [c, *(c * 10**k for k in range(1, 12) if c * 10**k < b), b]
    rise = c * (2 * digits.mpf(d) - c) / 2
    expected = float(rise - 2 / digits.pi * digits.quad(work, ends))
    (found,) = solved(profile=row, normal_load=load).gap([0.0])
    assert found == pytest.approx(expected, rel=1e-11)


# -- waves that close without a corner -------------------------------------------------------------


def two_harmonics(gap, second):
    """A wave A1 sin(2πx) + A2 sin(4πx) of the slope, and the load per E*/2 that leaves a gap.

    p/G = cos(πx) sqrt(S² - sin²(πx)) (α + β sin²(πx)), S = cos(π gap/2), for β = -8 A2 and
    α = 2 A1 - β (1 - S²)/2; the load is α S²/2 + β S⁴/8.
    """
    S2, beta = DIGITS.cos(DIGITS.pi * gap / 2) ** 2, -8 * DIGITS.mpf(second)
    alpha = 2 - beta * (1 - S2) / 2
    slope = sie.FromFunction(f"sin(2*pi*x) + {second}*sin(4*pi*x)")
    return sie.Periodic(slope, 1.0), float(alpha * S2 / 2 + beta * S2**2 / 8)


def quartic_wells(gap):
    """h = x⁴/4 - x²/2 on [-b, -a] and [a, b]: a² + b² = 2, P = π G (b² - a²)²/8."""
    return sie.FromFunction("x**3 - x", domain=(-3.0, 3.0)), np.pi * (1.0 - gap * gap / 4) ** 2 / 2


def resolved(solution):
    """The relative error of a gap that rounding of the load, and of the sums for it, leaves."""
    return 64.0 * np.finfo(float).eps * solution.check().condition


@pytest.mark.slow(but=4)
@pytest.mark.parametrize("second", [0.0, -0.0625, 0.0625])
@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-5, 1e-6])
def test_a_wave_under_a_load_closes_as_far_as_the_load_resolves(gap, second):
    profile, load = two_harmonics(gap, second)
    solution = sie.solve(sie.Scene(profile=profile, modulus=2.0, normal_load=load))
    half = 0.5 - 0.5 * gap
    assert solution.patches[0] == pytest.approx((-half, half), abs=gap * resolved(solution))
    assert solution.check().ok


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("gap", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5])
def test_two_wells_under_a_load_close_as_far_as_the_load_resolves(gap):
    profile, load = quartic_wells(gap)
    solution = sie.solve(sie.Scene(profile=profile, modulus=2.0, normal_load=load))
    (_, b), (a, _) = solution.patches
    assert a - b == pytest.approx(gap, rel=resolved(solution))
    assert solution.check().ok
