"""The flat punch with rounded edges: pressure, load, half-width and series, against the paper."""

import math
from typing import Any

import numpy as np
import pytest
from closed_form_cases import EPS, UNIT, Rounded, deep, relative, rounded, tiny_to_one
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from analytic import hertz, rounded_flat


def positions(contact: Rounded, part: float) -> Any:
    """Points where digits could be lost: the middle, the ends of flat and contact, and their
    neighbourhoods.
    """
    a, b, d = float(contact.a), float(contact.b), contact.rim
    beside = (np.nextafter(a, 0), np.nextafter(a, 2), np.nextafter(b, 0))
    return np.array(
        [0.0, a, b, b * part, a - d * part, a + d * part, b - d * part, a * (1 - part), *beside]
    )


def formula_32(x: float, a: Any, b: Any, ctx: Any = deep) -> Any:
    """p R/E* as Ciavarella, Hills & Monno (1998) print it, and its limit at x = a."""
    x = abs(ctx.mpf(x))
    if x >= b:
        return ctx.zero
    if x == a:
        return (ctx.sqrt(b * b - a * a) * ctx.acos(a / b) - a * ctx.log(b / a)) / ctx.pi
    phi, phi0 = ctx.asin(x / b), ctx.asin(a / b)
    logs = x * ctx.log(abs(ctx.sin(phi + phi0) / ctx.sin(phi - phi0)))
    logs += a * ctx.log(abs(ctx.tan((phi + phi0) / 2) * ctx.tan((phi - phi0) / 2)))
    return ((ctx.pi - 2 * phi0) * b * ctx.cos(phi) + logs) / (2 * ctx.pi)


def formula_35(a: Any, b: Any) -> Any:
    """P R/E*."""
    theta = deep.acos(a / b)
    return b * b / 2 * (theta - deep.sin(theta) * deep.cos(theta))


# -- the rounded flat against its references -------------------------------------------------------


@given(rounded, tiny_to_one)
def test_rounded_pressure_is_the_papers_formula_to_the_last_digits(
    contact: Rounded, part: float
) -> None:
    x = positions(contact, part)
    exact = [formula_32(v, contact.a, contact.b) for v in x]
    assert relative(rounded_flat.pressure(x, **contact.given, **UNIT), exact) <= 32 * EPS


@given(rounded)
def test_rounded_load_is_the_papers_formula_to_the_last_digits(contact: Rounded) -> None:
    assert (
        relative(rounded_flat.load(**contact.given, **UNIT), [formula_35(contact.a, contact.b)])
        <= 6 * EPS
    )


@given(rounded)
def test_rim_inverts_the_load_to_the_last_digits(contact: Rounded) -> None:
    P = rounded_flat.load(**contact.given, **UNIT)
    rim = rounded_flat.rim(normal_load=P, half_flat=contact.given["half_flat"], **UNIT)
    # A step of Newton's method at high precision gives the distance of the rim from the exact one
    # for this very load.
    b = contact.a + deep.mpf(float(rim))
    step = (formula_35(contact.a, b) - deep.mpf(float(P))) / (b * deep.acos(contact.a / b))
    assert abs(step / rim) <= 6 * EPS


# a/b, b p(0)/P, x_max/b, b p_max/P, P R/(E* b²), computed once at 30 digits from the paper's eqs
# (32) and (35)
KNOWN = [
    (0.0, 0.6366197723675813, 0.0, 0.6366197723675813, 0.7853981633974483),
    (0.3, 0.4573357544431418, 0.4710269302034481, 0.6166070102815080, 0.4899609561772077),
    (0.5, 0.4029177024929257, 0.6368926727158776, 0.6704531298135607, 0.3070924246521892),
    (0.8, 0.3464720794379783, 0.8593024589879636, 0.9583025103462031, 0.08175055439664219),
]


@pytest.mark.parametrize(("ratio", "centre", "place", "peak", "load"), KNOWN)
def test_known_values(ratio: float, centre: float, place: float, peak: float, load: float) -> None:
    given = {"half_flat": ratio, "half_width": 1.0, **UNIT}
    P = rounded_flat.load(**given)

    def steepness(x: float) -> float:
        return float(-rounded_flat.potential_derivative(x, **given).imag)

    x_max = brentq(steepness, ratio + 1e-9, 1 - 1e-9, xtol=1e-15) if ratio else 0.0
    found = [
        rounded_flat.pressure(0.0, **given) / P,
        x_max,
        rounded_flat.pressure(x_max, **given) / P,
        P,
    ]
    assert found == pytest.approx([centre, place, peak, load], rel=16 * EPS, abs=0)


@given(st.floats(1e-12, 1.0))
def test_without_a_flat_the_rounded_flat_is_hertz(b: float) -> None:
    x = np.linspace(-1.1 * b, 1.1 * b, 21)
    near = rounded_flat.pressure(x, half_flat=0.0, half_width=b, **UNIT)
    np.testing.assert_allclose(near, hertz.pressure(x, half_width=b, **UNIT), rtol=8 * EPS, atol=0)


@pytest.mark.parametrize("rim", [1e-12, 1e-9, 1e-6])
def test_a_thin_rim_leaves_the_centre_pressure_of_a_rigid_flat(rim: float) -> None:
    """p(0) = P/(pi b) (1 + c rim/b + ...), with c = 2/5 from the superposition of rigid flats."""
    given = {"half_flat": 1.0, "rim": rim, **UNIT}
    ratio = rounded_flat.pressure(0.0, **given) * math.pi * (1 + rim) / rounded_flat.load(**given)
    assert ratio - 1 == pytest.approx(0.4 * rim, rel=10 * rim, abs=8 * EPS)


# -- the series ------------------------------------------------------------------------------------


@given(rounded)
def test_chebyshev_coefficients_are_those_of_the_paper(contact: Rounded) -> None:
    b_n = rounded_flat.chebyshev_coefficients(50, **contact.given, **UNIT)
    theta, exact = deep.acos(contact.a / contact.b), []
    for n in range(50):
        first = deep.sin(2 * n * theta) / n if n else 2 * theta
        second = deep.sin(2 * (n + 1) * theta) / (n + 1)
        exact.append(contact.b / (2 * deep.pi * (2 * n + 1)) * (first - second))
    envelope = [max(abs(e) for e in exact[max(0, n - 1) : n + 2]) for n in range(50)]
    assert max(float(abs(v - e) / s) for v, e, s in zip(b_n.tolist(), exact, envelope)) <= 2e-13 / 2


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.95])
def test_chebyshev_series_sums_to_the_pressure(ratio: float) -> None:
    given = {"half_flat": ratio, "half_width": 2.0, **UNIT}
    phi = np.linspace(0.02, 1.5, 7)
    b_n = rounded_flat.chebyshev_coefficients(3000, **given)
    n = np.arange(3000)
    # sqrt(1-x²) U_2n(x) at x = sin(phi)
    total = (b_n * (-1.0) ** n * np.cos((2 * n + 1) * phi[:, None])).sum(axis=1)
    # b_n = O(n^-2) leaves O(N^-2) away from the kink, O(N^-1) next to it
    np.testing.assert_allclose(
        total, rounded_flat.pressure(2 * np.sin(phi), **given), atol=2e-6, rtol=0
    )
