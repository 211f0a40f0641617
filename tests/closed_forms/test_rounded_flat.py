"""The flat punch with rounded edges: pressure, load, half-width and series, against the paper."""

from typing import Any

import numpy as np
from closed_form_cases import EPS, UNIT, Rounded, deep, relative, rounded, tiny_to_one
from hypothesis import given
from hypothesis import strategies as st

from analytic import hertz, rounded_flat


def positions(contact: Rounded, part: float) -> Any:
    """Points where digits could be lost: the middle, the ends, their neighbourhoods."""
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


@given(st.floats(1e-12, 1.0))
def test_without_a_flat_the_rounded_flat_is_hertz(b: float) -> None:
    x = np.linspace(-1.1 * b, 1.1 * b, 21)
    near = rounded_flat.pressure(x, half_flat=0.0, half_width=b, **UNIT)
    np.testing.assert_allclose(near, hertz.pressure(x, half_width=b, **UNIT), rtol=8 * EPS, atol=0)


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
