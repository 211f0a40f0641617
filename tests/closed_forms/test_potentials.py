"""The potentials of all indenters: true to the integral equation, near and far."""

import math
from typing import Any

import numpy as np
import pytest
from closed_form_cases import (
    EPS,
    POTENTIALS,
    UNIT,
    Potential,
    Rounded,
    coarse,
    deep,
    mp,
    rounded,
    tiny_to_one,
)
from hypothesis import given
from hypothesis import strategies as st

from analytic import flat, rounded_flat

every_potential = pytest.mark.parametrize("case", POTENTIALS, ids=lambda case: case.name)
whole_potential = pytest.mark.parametrize(
    "case", [c for c in POTENTIALS if not c.prefix], ids=lambda case: case.name
)


def inside(case: Potential) -> Any:
    """Points of the contact, away from its ends and corners."""
    x = np.array([-0.9995, -0.83, -0.35, -0.01, 0.02, 0.45, 0.7, 0.99, 0.9997])
    return x[case.pressure(x) > 0]


@every_potential
def test_potential_jumps_by_the_pressure_and_its_mean_is_the_slope(case: Potential) -> None:
    x = inside(case)
    above, below = case.potential(x, side=+1), case.potential(x, side=-1)
    size = abs(above)
    assert (abs(above - below + 2j * case.pressure(x)) <= 4 * EPS * size).all()
    slopes = np.array([case.slope(v) for v in x])
    assert (abs((above + below) / 2 - 3.0 / 2 * slopes) <= 8 * EPS * size).all()


@every_potential
def test_potential_decays_like_the_load_over_z(case: Potential) -> None:
    z = 1e9 * np.exp(1j * np.linspace(0.0, 2 * np.pi, 13))
    assert abs(z * case.potential(z) * np.pi / case.load - 1).max() <= 1e-8
    far = z * 1e9
    assert abs(far * case.potential(far) * np.pi / case.load - 1).max() <= 16 * EPS


@pytest.mark.slow(but=1)
@every_potential
@pytest.mark.parametrize("z", [0.3 + 0.4j, 1.2 + 0j])
def test_potential_is_the_cauchy_integral_of_the_pressure(case: Potential, z: complex) -> None:
    breaks = {0.0, 1.0, case.given.get("half_flat", 0.0)}
    if case.prefix:
        breaks |= {abs(float(v)) for v in flat.partial_edges(**case.given)}
    angles = sorted(coarse.acos(v) for v in breaks)

    def integrand(angle: Any) -> Any:
        # The angle is taken from the ends, and x has the digits to hold it near the infinite
        # pressure of a corner.
        x = mp.cos(mp.convert(angle))
        right, left = case.pressure(x, lib=mp) / (z - x), case.pressure(-x, lib=mp) / (z + x)
        return coarse.convert(right + left) * coarse.sin(angle)

    total = coarse.quad(integrand, angles)
    assert abs(complex(total / mp.pi) - case.potential(z)) <= 1e-13 * abs(case.potential(z))


@whole_potential
@pytest.mark.parametrize(
    "z", [0.3 + 0.4j, -0.9 - 0.2j, 1.2, 1.24j, 1.592, -2.5 + 1j, 0.45 + 1e-6j, 30 - 5j]
)
def test_potential_derivative_is_the_derivative(case: Potential, z: complex) -> None:
    exact = mp.diff(lambda w: case.potential(w, lib=mp), mp.mpc(z), h=mp.mpf("1e-16"))
    value = case.module.potential_derivative(z, **case.given)
    assert abs(value - complex(exact)) <= 1e-13 * abs(value)


@whole_potential
@pytest.mark.parametrize("side", [+1, -1])
def test_potential_derivative_on_the_contact_is_the_limit_from_its_side(
    case: Potential, side: int
) -> None:
    x, depth = inside(case), 1e-14
    on_contact = case.module.potential_derivative(x, **case.given, side=side)
    beside = case.module.potential_derivative(x + 1j * side * depth, **case.given)
    scale = abs(on_contact).max()
    assert abs(on_contact - beside).max() <= 1e-10 * scale


def plain_potential(z: complex, contact: Rounded) -> tuple[Any, Any]:
    """Fp and Fp' of a rounded flat, E* = R = 1, by the formulas that cancel."""
    a, b, w = contact.a, contact.b, deep.mpc(z)
    v, tau = deep.sqrt(w + b) / deep.sqrt(w - b), deep.sqrt((b - a) / (b + a))
    right, left, theta = deep.atan(tau * v), deep.atan(tau / v), 2 * deep.atan(tau)
    root = deep.sqrt(w - b) * deep.sqrt(w + b)
    value, derivative = (
        (w - a) * right + (w + a) * left - theta * root,
        right + left - theta * w / root,
    )
    return value / deep.pi, derivative / deep.pi


@given(
    rounded,
    st.sampled_from([-1, 0, 1]),
    tiny_to_one,
    st.floats(0.01, 0.99),
    st.sampled_from([0.01, 1.0, 300.0]),
)
def test_rounded_potential_keeps_its_digits_near_and_far(
    contact: Rounded, end: int, distance: float, turn: float, scale: float
) -> None:
    z = end * float(contact.a) + scale * distance * complex(
        math.cos(math.pi * turn), math.sin(math.pi * turn)
    )
    exact, _ = plain_potential(z, contact)
    value = deep.mpc(complex(rounded_flat.potential(z, **contact.given, **UNIT)))
    assert float(abs(value - exact) / abs(exact)) <= 1e-13


@given(rounded, st.sampled_from([-1, 1]), tiny_to_one, st.floats(0.01, 0.99))
def test_rounded_potential_derivative_keeps_its_digits_near_the_rim(
    contact: Rounded, end: int, distance: float, turn: float
) -> None:
    """Near the rim; at z = 0, where Fp' vanishes, its digits are those of its size around."""
    a, d = float(contact.a), contact.rim
    z = end * a + d * distance * complex(math.cos(math.pi * turn), math.sin(math.pi * turn))
    _, exact = plain_potential(z, contact)
    value = deep.mpc(complex(rounded_flat.potential_derivative(z, **contact.given, **UNIT)))
    _, around = plain_potential(end * a + d * 0.5j, contact)
    assert float(abs(value - exact) / max(abs(exact), abs(around))) <= 1e-13
