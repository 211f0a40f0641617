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
