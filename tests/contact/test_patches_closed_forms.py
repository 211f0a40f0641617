"""Several patches against closed forms, from narrow patches to gaps of 1e-10 of a patch."""

import mpmath
import numpy as np
import pytest
from scenes import solved

import sie
from analytic import flat_row, parabola_row, two_flats, two_parabolas, wavy

DIGITS = mpmath.MPContext()
DIGITS.dps = 40
GAPS = [1e-2, 1e-6, 1e-10]
AT_CORNERS = np.array([1e-6, 1e-3, 0.1, 0.4, 0.7, 0.97, 1.0 - 1e-6])
INSIDE = np.array([0.02, 0.3, 0.5, 0.6, 0.85, 0.97])


# Each form: profile, load, the exact last patch (None: corners of flats), and p(x, a, b) there.


def pair_of_parabolas(gap, radius=1.0):
    """Two that touch on a unit length each, `gap` apart."""
    shape, ends = {"radius": radius, "modulus": 1}, {"inner": 0.5 * gap, "outer": 0.5 * gap + 1.0}
    d = float(two_parabolas.distance(**ends))
    load = float(two_parabolas.load(**ends, **shape))
    row = sie.Row([sie.Parabola(radius).shifted(s * d) for s in (-1.0, 1.0)])
    edges = two_parabolas.edges(
        normal_load=DIGITS.mpf(load), distance=DIGITS.mpf(d), **shape, lib=DIGITS
    )
    p = lambda x, a, b: two_parabolas.pressure(x, inner=a, outer=b, **shape, lib=DIGITS)  # noqa: E731
    return row, load, edges, p


def pair_of_flats(gap):
    row = sie.Row([sie.Flat(0.5).shifted(s * (0.5 * gap + 0.5)) for s in (-1.0, 1.0)])
    p = lambda x, a, b: two_flats.pressure(x, inner=a, outer=b, normal_load=2, lib=DIGITS)  # noqa: E731
    return row, 2.0, None, p


def row_of_flats(gap):
    flat = sie.Periodic(sie.Flat(0.5 - 0.5 * gap).shifted(0.5), 1.0)
    shape = {"period": 1, "mean_pressure": 2, "lib": DIGITS}
    p = lambda x, a, b: flat_row.pressure(x - (a + b) / 2, half_width=(b - a) / 2, **shape)  # noqa: E731
    return flat, 2.0, None, p


def row_of_parabolas(gap, radius=1.0):
    shape = {"radius": radius, "period": 1, "modulus": 1}
    load = float(parabola_row.mean_pressure(half_width=0.5 - 0.5 * gap, **shape))
    half = parabola_row.half_width(mean_pressure=DIGITS.mpf(load), **shape, lib=DIGITS)
    p = lambda x, a, b: parabola_row.pressure(x, half_width=b, **shape, lib=DIGITS)  # noqa: E731
    return sie.Periodic(sie.Parabola(radius), 1.0), load, (-half, half), p


def wave(gap):
    shape = {"wavelength": 1, "amplitude": 0.5, "modulus": 1}
    half = DIGITS.mpf(0.5 - 0.5 * gap)
    load = float(wavy.mean_pressure(half_width=half, **shape, lib=DIGITS))
    profile = sie.FromFunction(lambda x: np.pi * np.sin(2.0 * np.pi * x))
    p = lambda x, a, b: wavy.pressure(x, half_width=b, **shape, lib=DIGITS)  # noqa: E731
    return sie.Periodic(profile, 1.0), load, (-half, half), p


PAIRS = [pair_of_parabolas, pair_of_flats]
ROWS = [row_of_flats, row_of_parabolas]
CASES = [
    *((form, gap) for form in PAIRS for gap in (6.0, 0.7, 0.1, *GAPS)),
    *((form, gap) for form in ROWS for gap in (0.98, 0.6, 0.1, *GAPS)),
    *((wave, gap) for gap in (0.98, 0.7, 0.3, 0.02)),
]


@pytest.mark.parametrize(("form", "gap"), CASES)
def test_edges_and_pressure_of_a_closed_form(form, gap):
    """Corners of flats are doubles, and p is exact up to them."""
    profile, load, edges, pressure = form(gap)
    solution = solved(profile=profile, normal_load=load)
    a, b = solution.patches[-1]
    accuracy = {wave: 1e-11, row_of_parabolas: 1e-12, pair_of_parabolas: 1e-12}.get(form, 1e-13)
    if edges:
        assert (a, b) == pytest.approx([float(e) for e in edges], abs=1e-13)
        a, b = map(float, edges)
    a_, b_ = edges or (DIGITS.mpf(a), DIGITS.mpf(b))
    x = a + (b - a) * (INSIDE if edges else AT_CORNERS)
    expected = [float(pressure(DIGITS.mpf(v), a_, b_)) for v in x.tolist()]
    assert solution.pressure(x) == pytest.approx(expected, rel=accuracy)
    assert solution.check().ok


@pytest.mark.parametrize("part", [0.02, 0.4, 0.95])
def test_potential_and_derivative_of_a_wave(part):
    """The derivative beside that of the closed form by Cauchy's formula on a circle."""
    profile, load, (_, half), _ = wave(1.0 - part)
    shape = {"wavelength": 1.0, "amplitude": 0.5, "modulus": 1.0, "half_width": float(half)}
    pressure = solved(profile=profile, normal_load=load).pressure
    z = np.array([0.1 + 0.2j, 0.4 + 0.01j, 0.3 + 1.0j, 0.3 + 0.4j, -0.45 + 0.1j])
    assert pressure.cauchy(z) == pytest.approx(wavy.potential(z, **shape), rel=1e-11)
    z = z[[0, 3, 4]]
    turn = np.exp(2j * np.pi * np.arange(48) / 48)
    circle = z[:, None] + 0.4 * z.imag[:, None] * turn
    values = wavy.potential(circle.ravel(), **shape).reshape(circle.shape)
    exact = (values * turn.conj()).mean(axis=1) / (0.4 * z.imag)
    assert pressure.cauchy_derivative(z) == pytest.approx(exact, rel=1e-10)


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
