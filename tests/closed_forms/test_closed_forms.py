"""The closed forms: exact to the last digits, on every scale, and true to the integral equation
they solve.

References are computed here, at 50 digits or more, from other formulas than those of the package:
the paper's (32), quadrature of a positive integrand, differentiation. EPS is the rounding unit of a
double; the promise is 1e-13.
"""

import ast
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import analytic
from analytic import flat, hertz, power, rounded_flat, two_parabolas, wedge

EPS = float(np.finfo(float).eps)
UNIT = {"radius": 1.0, "modulus": 1.0}
INDENTERS = (rounded_flat, hertz, wedge, power, flat)

mp = mpmath.MPContext()  # references
mp.dps = 50
# References from formulas that cancel to the third power of a rim of 1e-12
deep = mpmath.MPContext()
deep.dps = 120
coarse = mpmath.MPContext()  # quadrature, where doubles are what is checked
coarse.dps = 20


class Rounded(NamedTuple):
    """A rounded flat's contact as a caller gives it, and the exact numbers it stands for."""

    given: dict[str, float]
    a: Any
    b: Any

    @property
    def rim(self) -> float:
        return float(self.b - self.a)


def with_half_width(a: float, b: float = 1.0) -> Rounded:
    return Rounded({"half_flat": a, "half_width": b}, deep.mpf(a), deep.mpf(b))


def with_rim(rim: float, a: float = 1.0) -> Rounded:
    return Rounded({"half_flat": a, "rim": rim}, deep.mpf(a), deep.mpf(a) + deep.mpf(rim))


tiny_to_one = st.floats(-12, -0.01).map(lambda e: 10.0**e)  # 1e-12 to 0.98
rounded = st.one_of(
    tiny_to_one.map(with_half_width),
    tiny_to_one.map(lambda d: with_half_width(1.0 - d)),
    tiny_to_one.map(with_rim),
)


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


def relative(value: Any, exact: Any) -> float:
    """The largest relative error, where 0 must be 0."""
    errors = [
        abs(v - e) / abs(e) if e else abs(v) for v, e in zip(np.atleast_1d(value).tolist(), exact)
    ]
    return float(max(errors))


# --- the rounded flat against its references
# ------------------------------------------------------------------------


@settings(max_examples=150, deadline=None)
@given(rounded, tiny_to_one)
def test_rounded_pressure_is_the_papers_formula_to_the_last_digits(
    contact: Rounded, part: float
) -> None:
    x = positions(contact, part)
    exact = [formula_32(v, contact.a, contact.b) for v in x]
    assert relative(rounded_flat.pressure(x, **contact.given, **UNIT), exact) <= 32 * EPS


@pytest.mark.parametrize("ratio", ["1e-9", "0.3", "0.9", "0.999999999999"])
@pytest.mark.parametrize("place", ["0", "0.4", "0.99", "1.0000001"])
def test_rounded_pressure_superposes_rigid_flats(ratio: str, place: str) -> None:
    a, b = mp.mpf(ratio), mp.one
    x = a * mp.mpf(place) if float(place) < 1 else (a + b) / 2
    start = max(x, a)

    def positive(t: Any) -> Any:
        beyond = (b - start) * t * t  # of s over its start, so that no difference cancels
        s = start + beyond
        angle = 2 * mp.atan(mp.sqrt((start - a + beyond) / (s + a)))
        return 2 * t * (b - start) * s * angle / mp.sqrt((start - x + beyond) * (s + x))

    exact = mp.quad(positive, [0, mp.mpf("0.001"), 1]) / mp.pi
    given = {"half_flat": a, "half_width": b, "radius": 1, "modulus": 1}
    assert abs(rounded_flat.pressure(x, **given, lib=mp) / exact - 1) < mp.mpf("1e-20")


@settings(max_examples=150, deadline=None)
@given(rounded)
def test_rounded_load_is_the_papers_formula_to_the_last_digits(contact: Rounded) -> None:
    assert (
        relative(rounded_flat.load(**contact.given, **UNIT), [formula_35(contact.a, contact.b)])
        <= 6 * EPS
    )


@settings(max_examples=60, deadline=None)
@given(rounded)
def test_rim_inverts_the_load_to_the_last_digits(contact: Rounded) -> None:
    P = rounded_flat.load(**contact.given, **UNIT)
    rim = rounded_flat.rim(normal_load=P, half_flat=contact.given["half_flat"], **UNIT)
    # A step of Newton's method at high precision gives the distance of the rim from the exact one
    # for this very load.
    b = contact.a + deep.mpf(float(rim))
    step = (formula_35(contact.a, b) - deep.mpf(float(P))) / (b * deep.acos(contact.a / b))
    assert abs(step / rim) <= 6 * EPS


@settings(max_examples=100, deadline=None)
@given(rounded)
def test_half_width_inverts_the_load(contact: Rounded) -> None:
    P = rounded_flat.load(**contact.given, **UNIT)
    b = rounded_flat.half_width(normal_load=P, half_flat=contact.given["half_flat"], **UNIT)
    assert relative(b, [contact.b]) <= 6 * EPS


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


@settings(max_examples=60, deadline=None)
@given(rounded)
def test_load_grows_with_the_half_width_by_the_angle_of_the_rim(contact: Rounded) -> None:
    a, b = (mp.convert(v) for v in (contact.a, contact.b))
    given = {"half_flat": a, "radius": 1, "modulus": 1, "lib": mp}
    growth = mp.diff(
        lambda d: rounded_flat.load(rim=d, **given), b - a, h=(b - a) * mp.mpf("1e-17")
    )
    assert abs(growth / (b * mp.acos(a / b)) - 1) < mp.mpf("1e-12")


@settings(max_examples=20, deadline=None)
@given(st.floats(1e-12, 1.0))
def test_without_a_flat_the_rounded_flat_is_hertz(b: float) -> None:
    x = np.linspace(-1.1 * b, 1.1 * b, 21)
    near = rounded_flat.pressure(x, half_flat=0.0, half_width=b, **UNIT)
    np.testing.assert_allclose(near, hertz.pressure(x, half_width=b, **UNIT), rtol=8 * EPS, atol=0)


@pytest.mark.parametrize("flat_part", [1e-12, 1e-9, 1e-6])
def test_a_vanishing_flat_takes_its_share_from_the_centre_of_hertz(flat_part: float) -> None:
    """p(0) = E*/(pi R) [b theta - a arccosh(b/a)] falls short of Hertz by a (1 + ln(2b/a)) E*/(pi
    R).
    """
    peak = hertz.peak_pressure(half_width=1.0, **UNIT)
    short = peak - rounded_flat.pressure(0.0, half_flat=flat_part, half_width=1.0, **UNIT)
    expected = flat_part * (1 + math.log(2 / flat_part)) / math.pi
    assert short == pytest.approx(expected, rel=2 * flat_part, abs=2 * EPS)


@pytest.mark.parametrize("rim", [1e-12, 1e-9, 1e-6])
def test_a_thin_rim_leaves_the_centre_pressure_of_a_rigid_flat(rim: float) -> None:
    """p(0) = P/(pi b) (1 + c rim/b + ...), with c = 2/5 from the superposition of rigid flats."""
    given = {"half_flat": 1.0, "rim": rim, **UNIT}
    ratio = rounded_flat.pressure(0.0, **given) * math.pi * (1 + rim) / rounded_flat.load(**given)
    assert ratio - 1 == pytest.approx(0.4 * rim, rel=10 * rim, abs=8 * EPS)


# --- the series
# ------------------------------------------------------------------------------------------


@settings(max_examples=60, deadline=None)
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


@pytest.mark.parametrize("ratio", ["0.2", "0.95"])
@pytest.mark.parametrize("n", [0, 1, 7])
def test_chebyshev_coefficients_are_integrals_of_the_pressure(ratio: str, n: int) -> None:
    given = {"half_flat": ratio, "half_width": 1, "radius": 1, "modulus": 1, "lib": coarse}

    def integrand(phi: Any) -> Any:
        return rounded_flat.pressure(coarse.sin(phi), **given) * coarse.cos((2 * n + 1) * phi)

    total = coarse.quad(integrand, [0, coarse.asin(ratio), coarse.pi / 2])
    exact = 4 / coarse.pi * (-1) ** n * total
    assert abs(rounded_flat.chebyshev_coefficients(n + 1, **given)[n] / exact - 1) < 1e-15


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


@settings(max_examples=60, deadline=None)
@given(rounded)
def test_first_chebyshev_coefficient_carries_the_load(contact: Rounded) -> None:
    b_0 = rounded_flat.chebyshev_coefficients(1, **contact.given, **UNIT)[0]
    P = rounded_flat.load(**contact.given, **UNIT)
    assert b_0 == pytest.approx(2 * P / (math.pi * float(contact.b)), rel=6 * EPS, abs=0)


# --- potentials
# ------------------------------------------------------------------------------------------


class Potential(NamedTuple):
    """An indenter with a potential: everything a law needs, with b = 1 and E* = 3."""

    name: str
    module: Any
    given: dict[str, Any]  # of the pressure and the potential
    load: float
    slope: Callable[[float], float]
    prefix: str = ""

    def pressure(self, x: Any, lib: Any = np) -> Any:
        return getattr(self.module, self.prefix + "pressure")(x, **self.given, lib=lib)

    def potential(self, z: Any, **options: Any) -> Any:
        return getattr(self.module, self.prefix + "potential")(z, **self.given, **options)


def rounded_case(ratio: float) -> Potential:
    given = {"half_flat": ratio, "half_width": 1.0, "radius": 2.0, "modulus": 3.0}
    slope = lambda x: float(rounded_flat.slope(x, half_flat=ratio, radius=2.0))  # noqa: E731
    return Potential(
        f"rounded {ratio}", rounded_flat, given, float(rounded_flat.load(**given)), slope
    )


def flat_case(P: float, M: float) -> Potential:
    given = {"half_width": 1.0, "normal_load": P, "moment": M}
    prefix = "" if abs(M) <= P / 2 else "partial_"
    tilt = getattr(flat, prefix + "tilt")(**given, modulus=3.0)
    return Potential(f"flat {P} {M}", flat, given, P, lambda x: float(tilt), prefix)


HERTZ = {"half_width": 1.0, "radius": 2.0, "modulus": 3.0}
WEDGE = {"half_width": 1.0, "slope": 0.5, "modulus": 3.0}
POTENTIALS = [
    *(rounded_case(ratio) for ratio in (0.0, 1e-6, 0.4, 0.999)),
    Potential("hertz", hertz, HERTZ, float(hertz.load(**HERTZ)), lambda x: x / 2.0),
    Potential("wedge", wedge, WEDGE, float(wedge.load(**WEDGE)), lambda x: math.copysign(0.5, x)),
    *(flat_case(2.0, M) for M in (0.0, 0.7, -1.0)),
    *(flat_case(2.0, M) for M in (1.3, -1.8)),
]
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
@pytest.mark.parametrize("side", [+1, -1])
def test_potential_tends_to_its_side_of_the_contact(case: Potential, side: int) -> None:
    x, depth = inside(case), 1e-14
    step = abs(case.potential(x + 1j * side * depth) - case.potential(x, side=side))
    assert (step <= 1e-10 * abs(case.potential(x, side=side))).all()


@every_potential
def test_potential_decays_like_the_load_over_z(case: Potential) -> None:
    z = 1e9 * np.exp(1j * np.linspace(0.0, 2 * np.pi, 13))
    assert abs(z * case.potential(z) * np.pi / case.load - 1).max() <= 1e-8
    far = z * 1e9
    assert abs(far * case.potential(far) * np.pi / case.load - 1).max() <= 16 * EPS


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


@whole_potential
def test_potential_of_the_mirror_image_in_the_surface_is_conjugate(case: Potential) -> None:
    z = np.array([0.3 + 0.4j, -1.0 + 1e-8j, 5j, 0.999 + 1e-12j])
    for function in (case.module.potential, case.module.potential_derivative):
        value = function(z, **case.given)
        assert (abs(function(z.conj(), **case.given) - value.conj()) <= 4 * EPS * abs(value)).all()


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


@settings(max_examples=150, deadline=None)
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


@settings(max_examples=150, deadline=None)
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


@given(
    st.floats(0.001, 0.99),
    st.sampled_from([-1, 1]),
    st.sampled_from([5e-324, 1e-300, 1e-200, 1e-100]),
)
def test_potentials_next_to_the_surface_are_those_of_their_side(
    distance: float, half: int, depth: float
) -> None:
    x = half * distance
    for case in POTENTIALS:
        for side in (+1, -1):
            value, limit = (
                case.potential(complex(x, side * depth), side=-side),
                case.potential(x, side=side),
            )
            assert abs(value - limit) <= 16 * EPS * abs(limit)


@every_potential
def test_the_sign_of_a_floating_zero_means_nothing(case: Potential) -> None:
    for x in (-2.0, -0.3, 0.3, 2.0):
        assert case.potential(complex(x, -0.0)) == case.potential(complex(x, 0.0))


# --- the other indenters
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "m", [1.0, 1.0 + 1e-9, 1.2, 1.7, 2.0, 2.5, 3.0, 3.0 + 1e-10, 4.0, 7.3, 40.0]
)
def test_power_pressure_superposes_rigid_flats(m: float) -> None:
    x = np.array([1e-200, 1e-9, 0.3, 0.70710678, 0.7072, 0.99, 1 - 1e-13])
    found = power.pressure(x, half_width=1.0, exponent=m, coefficient=1.0, modulus=1.0)
    wallis = coarse.quad(lambda t: coarse.sin(t) ** m, [0, coarse.pi / 2])

    def exact(xi: float) -> Any:
        # s = xi cosh(t): the integrand is smooth, over hundreds of units of t
        end = coarse.acosh(1 / mp.mpf(xi))
        panels = coarse.linspace(0, end, 2 + int(end / 4))
        total = coarse.quad(
            lambda t: (xi * coarse.cosh(t)) ** (m - 1), panels, method="gauss-legendre"
        )
        return m * m * wallis / coarse.pi * total

    assert relative(found, [exact(xi) for xi in x.tolist()]) <= 20 * EPS


@pytest.mark.parametrize("m", [1.5, 2.0, 3.0, 6.0])
def test_power_pressure_at_the_centre_is_finite_and_known(m: float) -> None:
    given = {"half_width": 2.0, "exponent": m, "coefficient": 0.3, "modulus": 5.0}
    assert power.pressure(0.0, **given) == pytest.approx(
        m * power.load(**given) / (math.pi * 2.0 * (m - 1)), rel=8 * EPS
    )


def test_power_one_is_the_wedge() -> None:
    x = np.linspace(-1.2, 1.2, 49)
    found = power.pressure(x, half_width=1.0, exponent=1, coefficient=0.2, modulus=3.0)
    np.testing.assert_allclose(
        found, wedge.pressure(x, half_width=1.0, slope=0.2, modulus=3.0), rtol=12 * EPS, atol=0
    )


def test_power_two_is_the_parabola() -> None:
    x = np.linspace(-1.2, 1.2, 49)
    found = power.pressure(x, half_width=1.0, exponent=2, coefficient=0.25, modulus=3.0)
    np.testing.assert_allclose(
        found, hertz.pressure(x, half_width=1.0, radius=2.0, modulus=3.0), rtol=8 * EPS, atol=0
    )


class Loaded(NamedTuple):
    module: Any
    shape: dict[str, float]


LOADED = [
    Loaded(rounded_flat, {"half_flat": 0.3, "radius": 2.0}),
    Loaded(hertz, {"radius": 2.0}),
    Loaded(wedge, {"slope": 0.2}),
    Loaded(power, {"exponent": 1.6, "coefficient": 0.2}),
    Loaded(power, {"exponent": 5.0, "coefficient": 0.2}),
]
every_loaded = pytest.mark.parametrize("case", LOADED, ids=lambda case: case.module.__name__)


@every_loaded
def test_load_is_the_integral_of_the_pressure(case: Loaded) -> None:
    given = {**case.shape, "modulus": 3.0, "half_width": 1.0, "lib": coarse}
    kink = coarse.asin(case.shape.get("half_flat", 0.0))
    half = coarse.quad(
        lambda phi: case.module.pressure(coarse.sin(phi), **given) * coarse.cos(phi),
        [0, kink, coarse.pi / 2],
    )
    assert abs(2 * half / case.module.load(**given) - 1) < 1e-15


@every_loaded
def test_half_width_is_the_inverse_of_load(case: Loaded) -> None:
    b = np.logspace(-0.4, 6, 20)
    P = case.module.load(half_width=b, **case.shape, modulus=3.0)
    found = case.module.half_width(normal_load=P, **case.shape, modulus=3.0)
    np.testing.assert_allclose(found, b, rtol=8 * EPS, atol=0)


@pytest.mark.parametrize(
    "case", [c for c in LOADED if c.module is not wedge], ids=lambda case: case.module.__name__
)
def test_slope_is_the_derivative_of_the_height(case: Loaded) -> None:
    x, shape = mp.mpf("0.7"), {**case.shape, "lib": mp}
    for side in (+1, -1):
        exact = mp.diff(lambda t: case.module.height(t, **shape), side * x)
        assert abs(case.module.slope(side * x, **shape) - exact) < mp.mpf("1e-20")


@settings(deadline=None)
@given(st.floats(-1, 1), st.floats(0.1, 10.0))
def test_flat_pressure_carries_load_and_moment(part: float, b: float) -> None:
    """∫ p and ∫ p x by Gauss-Chebyshev quadrature, exact for p sqrt(b² - x²) linear."""
    P, M = 3.0, part * 3.0 * b / 2
    x = b * np.array([-math.sqrt(0.5), math.sqrt(0.5)])
    p = (
        flat.pressure(x, half_width=b, normal_load=P, moment=M)
        * np.sqrt(b * b - x * x)
        * math.pi
        / 2
    )
    assert p.sum() == pytest.approx(P, rel=8 * EPS)
    assert (p * x).sum() == pytest.approx(M, rel=0, abs=8 * EPS * P * b)


@settings(deadline=None)
@given(st.floats(0.5, 0.99), st.sampled_from([-1, 1]))
def test_partial_flat_pressure_carries_load_and_moment(part: float, sign: int) -> None:
    P, M, b = 3.0, sign * part * 3.0, 1.0
    given = {"half_width": b, "normal_load": P, "moment": M}
    lo, hi = flat.partial_edges(**given)
    middle, r, n = (lo + hi) / 2, (hi - lo) / 2, 6
    # p = P/(pi r) sqrt((1+u)/(1-u)), u towards the corner: Gauss nodes and weights of that weight
    u = np.cos((2 * np.arange(1, n + 1) - 1) * math.pi / (2 * n + 1))
    weights = 2 * math.pi / (2 * n + 1) * (1 + u)
    x = middle + sign * r * u
    share = flat.partial_pressure(x, **given) * np.sqrt((1 - u) / (1 + u)) * weights * r
    # near the far edge x itself is rounded: eps/(1+u) in the square of the pressure
    assert share.sum() == pytest.approx(P, rel=1e-13)
    assert (share * x).sum() == pytest.approx(M, rel=1e-13)


@settings(deadline=None)
@given(st.floats(-1, 1))
def test_flat_tilt_and_moment_are_inverse(part: float) -> None:
    given = {"half_width": 2.0, "normal_load": 3.0, "modulus": 5.0}
    M = part * 3.0
    tilt = flat.tilt(**given, moment=M)
    assert tilt == pytest.approx(-4 * M / (math.pi * 5.0 * 4.0), rel=4 * EPS, abs=1e-300)
    assert flat.moment(**given, tilt=tilt) == pytest.approx(M, rel=4 * EPS, abs=1e-300)


@settings(deadline=None)
@given(st.floats(0.5, 0.999), st.sampled_from([-1, 1]))
def test_partial_flat_tilt_and_moment_are_inverse(part: float, sign: int) -> None:
    given = {"half_width": 2.0, "normal_load": 3.0, "modulus": 5.0}
    M = sign * part * 6.0
    tilt = flat.partial_tilt(**given, moment=M)
    assert tilt * sign < 0
    assert flat.partial_moment(**given, tilt=tilt) == pytest.approx(M, rel=8 * EPS, abs=0)


@pytest.mark.parametrize("sign", [-1, 1])
def test_complete_and_partial_flat_meet_at_lift_off(sign: int) -> None:
    x, given = np.linspace(-1, 1, 9), {"half_width": 1.0, "normal_load": 2.0, "moment": sign * 1.0}
    np.testing.assert_allclose(
        flat.partial_pressure(x, **given), flat.pressure(x, **given), rtol=8 * EPS, atol=0
    )
    assert flat.partial_tilt(**given, modulus=3.0) == pytest.approx(
        flat.tilt(**given, modulus=3.0), rel=4 * EPS
    )


# --- what holds for all
# ------------------------------------------------------------------------------------------


def test_pressure_is_zero_outside_and_infinite_only_at_corners_and_apex() -> None:
    for case in POTENTIALS:
        x = np.array([-2.0, -1.0 - 2 * EPS, -1.0, 0.0, 1.0, 1.0 + 2 * EPS, 1e300])
        p = case.pressure(x)
        assert (p >= 0).all()
        assert p[[0, 1, 5, 6]].tolist() == [0, 0, 0, 0]
        infinite = set(x[np.isinf(p)].tolist())
        if case.module is wedge:
            assert infinite == {0.0}
        elif case.module is flat:
            M = case.given["moment"]
            assert infinite == ({-1.0, 1.0} if abs(M) < 1 else {math.copysign(1.0, M)})
        else:
            assert infinite == set()


@pytest.mark.parametrize("side", [+1, -1])
def test_at_its_apex_the_potential_of_a_wedge_has_no_slope_and_infinite_pressure(side: int) -> None:
    F = wedge.potential(0.0, **WEDGE, side=side)
    assert F.real == 0.0 and F.imag == -side * np.inf


@pytest.mark.parametrize("side", [+1, -1])
@pytest.mark.parametrize(("x", "beside"), [(0.0, 1e-200), (1.0, 1.0 - EPS), (-1.0, EPS - 1.0)])
def test_where_the_pressure_of_a_wedge_is_infinitely_steep_its_sign_is_that_next_to_it(
    x: float, beside: float, side: int
) -> None:
    steep = wedge.potential_derivative(x, **WEDGE, side=side).imag
    assert steep == np.inf * np.sign(wedge.potential_derivative(beside, **WEDGE, side=side).imag)


CALLS: list[tuple[Callable[..., Any], dict[str, Any]]] = [
    (rounded_flat.height, {"x": 0.7, "half_flat": 0.3, "radius": 2.0}),
    (rounded_flat.slope, {"x": -0.7, "half_flat": 0.3, "radius": 2.0}),
    *(
        (function, {**place, "half_flat": 0.3, "radius": 2.0, "modulus": 3.0, **width})
        for width in ({"half_width": 1.1}, {"rim": 1e-9}, {"rim": 40.0})
        for function, place in (
            (rounded_flat.pressure, {"x": 0.2}),
            (rounded_flat.pressure, {"x": 0.3000000005}),
            (rounded_flat.load, {}),
            (rounded_flat.potential, {"z": 0.4 + 0.2j}),
            (rounded_flat.potential, {"z": 0.3000000005}),
            (rounded_flat.potential, {"z": -7 + 0.2j}),
            (rounded_flat.potential_derivative, {"z": 0.4 + 0.2j}),
            (rounded_flat.potential_derivative, {"z": 0.2}),
        )
    ),
    (
        rounded_flat.half_width,
        {"normal_load": 0.7, "half_flat": 0.3, "radius": 2.0, "modulus": 3.0},
    ),
    (rounded_flat.rim, {"normal_load": 1e-15, "half_flat": 0.3, "radius": 2.0, "modulus": 3.0}),
    (hertz.height, {"x": 0.7, "radius": 2.0}),
    (hertz.slope, {"x": 0.7, "radius": 2.0}),
    (hertz.pressure, {"x": 0.7, **HERTZ}),
    (hertz.load, HERTZ),
    (hertz.peak_pressure, HERTZ),
    (hertz.half_width, {"normal_load": 0.7, "radius": 2.0, "modulus": 3.0}),
    (hertz.potential, {"z": 0.4 + 0.2j, **HERTZ}),
    (hertz.potential, {"z": 0.4, **HERTZ}),
    (hertz.potential_derivative, {"z": -4 + 0.2j, **HERTZ}),
    (hertz.potential_derivative, {"z": -0.4, **HERTZ}),
    (wedge.height, {"x": 0.7, "slope": 0.2}),
    (wedge.pressure, {"x": 0.7, **WEDGE}),
    (wedge.load, WEDGE),
    (wedge.half_width, {"normal_load": 0.7, "slope": 0.2, "modulus": 3.0}),
    (wedge.potential, {"z": 0.4 + 0.2j, **WEDGE}),
    (wedge.potential, {"z": 0.4, **WEDGE}),
    (wedge.potential_derivative, {"z": 0.4 + 0.2j, **WEDGE}),
    (wedge.potential_derivative, {"z": 0.4, **WEDGE}),
    *(
        (function, {**place, "half_width": 1.1, "exponent": m, "coefficient": 0.2, "modulus": 3.0})
        for m in (1.5, 3.0, 6.2)
        for function, place in (
            (power.pressure, {"x": 0.2}),
            (power.pressure, {"x": 0.9}),
            (power.load, {}),
        )
    ),
    (power.half_width, {"normal_load": 0.7, "exponent": 2.5, "coefficient": 0.2, "modulus": 3.0}),
    (power.height, {"x": -0.7, "exponent": 2.5, "coefficient": 0.2}),
    (power.slope, {"x": -0.7, "exponent": 2.5, "coefficient": 0.2}),
    *(
        (function, {**place, "half_width": 1.1, "normal_load": 2.0, "moment": -0.3})
        for function, place in (
            (flat.pressure, {"x": 0.4}),
            (flat.potential, {"z": 0.4}),
            (flat.potential, {"z": 4 - 1j}),
            (flat.potential_derivative, {"z": 0.4}),
            (flat.potential_derivative, {"z": 4 - 1j}),
            (flat.tilt, {"modulus": 3.0}),
        )
    ),
    (flat.moment, {"half_width": 1.1, "normal_load": 2.0, "tilt": 0.2, "modulus": 3.0}),
    *(
        (function, {**place, "half_width": 1.1, "normal_load": 2.0, "moment": -1.3})
        for function, place in (
            (flat.partial_pressure, {"x": -0.4}),
            (flat.partial_potential, {"z": -0.4}),
            (flat.partial_tilt, {"modulus": 3.0}),
        )
    ),
    (flat.partial_moment, {"half_width": 1.1, "normal_load": 2.0, "tilt": 1.2, "modulus": 3.0}),
]


def over_calls(calls: list[tuple[Callable[..., Any], dict[str, Any]]]) -> Any:
    return pytest.mark.parametrize(
        ("function", "given"), calls, ids=[f"{f.__module__[9:]}.{f.__name__}" for f, _ in calls]
    )


every_call = over_calls(CALLS)

LENGTHS = ("x", "z", "half_flat", "half_width", "rim", "radius")


def positional(function: Callable[..., Any], given: dict[str, Any], **options: Any) -> Any:
    """The call with its position first, as users write it."""
    rest = {name: value for name, value in given.items() if name not in ("x", "z")}
    return function(*(given[name] for name in ("x", "z") if name in given), **rest, **options)


@every_call
def test_numpy_and_mpmath_agree(function: Callable[..., Any], given: dict[str, Any]) -> None:
    exact = complex(positional(function, given, lib=mp))
    assert abs(complex(positional(function, given)) - exact) <= 1e-14 * abs(exact)


@every_call
def test_a_context_gives_all_its_digits_and_leaves_the_global_one_alone(
    function: Callable[..., Any], given: dict[str, Any]
) -> None:
    before = mpmath.mp.dps
    value, exact = positional(function, given, lib=mp), positional(function, given, lib=deep)
    assert mpmath.mp.dps == before
    assert abs(deep.convert(value) - exact) <= deep.mpf("1e-46") * abs(exact)


@every_call
def test_arrays_broadcast(function: Callable[..., Any], given: dict[str, Any]) -> None:
    scalars = {name: value for name, value in given.items() if name != "exponent"}
    grown = {
        name: np.full((3, 1) if i % 2 else 4, value)
        for i, (name, value) in enumerate(scalars.items())
    }
    grid = positional(function, {**given, **grown})
    expected = np.shape(np.broadcast_arrays(*grown.values())[0])
    assert np.shape(grid) == expected
    np.testing.assert_allclose(grid, positional(function, given), rtol=8 * EPS, atol=0)
    assert np.ndim(positional(function, given)) == 0


@pytest.mark.parametrize("length", [1e-100, 1e100])
@pytest.mark.parametrize("stress", [1e-100, 1e100])
# Beyond these exponents C itself is out of a double's range.
@over_calls([call for call in CALLS if call[1].get("exponent", 1) <= 3])
def test_results_scale_with_lengths_and_moduli(
    function: Callable[..., Any], given: dict[str, Any], length: float, stress: float
) -> None:
    m = given.get("exponent", 1.0)
    unit = dict.fromkeys(LENGTHS, length) | {"modulus": stress, "normal_load": stress * length}
    unit |= {"moment": stress * length * length, "coefficient": length ** (1 - m)}
    value = positional(
        function, {name: number * unit.get(name, 1.0) for name, number in given.items()}
    )
    kind = function.__name__.removeprefix("partial_")
    by = {
        "pressure": stress,
        "peak_pressure": stress,
        "potential": stress,
        "potential_derivative": stress / length,
    }
    by |= {"load": stress * length, "moment": stress * length * length, "slope": 1.0, "tilt": 1.0}
    expected = positional(function, given) * by.get(kind, length)
    assert abs(value - expected) <= 200 * EPS * abs(expected) + sensitivity(given, expected)


def sensitivity(given: dict[str, Any], expected: Any) -> float:
    """What the rounding of scaled positions costs next to a thin rim, where x - a and b - x are
    known to eps a only.
    """
    return (
        float(20 * EPS * given["half_flat"] / given["rim"] * abs(expected))
        if "rim" in given
        else 0.0
    )


BAD_VALUES = [math.nan, math.inf, -math.inf, 0.0, -1.0, "one", None, 1j]


@every_call
@pytest.mark.parametrize("lib", [np, mp], ids=["numpy", "mpmath"])
def test_bad_numbers_are_refused_by_name_and_with_a_remedy(
    function: Callable[..., Any], given: dict[str, Any], lib: Any
) -> None:
    for name in given:
        for bad in BAD_VALUES:
            if not is_good(name, bad):
                with pytest.raises(ValueError, match=rf"{name} = .*; "):
                    positional(function, {**given, name: bad}, lib=lib)


def is_good(name: str, value: Any) -> bool:
    """Whether a value that is bad as a modulus has a meaning under this name."""
    if name in ("x", "z", "moment", "tilt", "half_flat", "rim") and value in (0, -1):
        return True  # or, below zero, is refused by a test of its own
    return (name == "z" and value == 1j) or (name in ("half_width", "rim") and value is None)


EXTREMES = [1e-300, 1e-200, 1e-151, 1e151, 1e200, 1e300]


@every_call
def test_a_parameter_of_any_size_is_answered_in_numbers_or_refused_with_a_remedy(
    function: Callable[..., Any], given: dict[str, Any]
) -> None:
    for name in given.keys() - {"x", "z"}:
        for size in EXTREMES:
            value = value_or_refusal(function, {**given, name: size})
            assert "; " in value if isinstance(value, str) else not np.isnan(value)


def value_or_refusal(function: Callable[..., Any], given: dict[str, Any]) -> Any:
    try:
        return positional(function, given)
    except ValueError as refusal:
        return str(refusal)


@pytest.mark.parametrize("function", [power.load, power.half_width])
def test_an_exponent_that_needs_endless_steps_is_refused(function: Callable[..., Any]) -> None:
    given = {"half_width": 1.0} if function is power.load else {"normal_load": 1.0}
    with pytest.raises(
        ValueError, match=r"exponent = 1000000\.0 is not a single number from 1 to 1000"
    ):
        function(**given, exponent=1e6, coefficient=1.0, modulus=1.0)


@pytest.mark.parametrize("name", ["half_flat", "rim"])
def test_lengths_that_may_vanish_are_refused_below_zero(name: str) -> None:
    with pytest.raises(ValueError, match=rf"{name} = -1\.0 is not zero or positive; give "):
        rounded_flat.load(**{"half_flat": 0.5, "rim": 0.5, **UNIT, name: -1.0})


@pytest.mark.parametrize("widths", [{}, {"half_width": 1.0, "rim": 0.5}])
def test_exactly_one_of_half_width_and_rim_is_required(widths: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="exactly one"):
        rounded_flat.load(half_flat=0.5, **widths, **UNIT)


@pytest.mark.parametrize("lib", [np, mp])
def test_a_contact_shorter_than_the_flat_is_refused(lib: Any) -> None:
    with pytest.raises(ValueError, match=r"half_width = 0\.5 is less than half_flat = 1\.0.*rim"):
        rounded_flat.load(half_flat=1.0, half_width=0.5, radius=1, modulus=1, lib=lib)


def test_the_first_bad_entry_of_an_array_is_named() -> None:
    with pytest.raises(ValueError, match=r"radius = -2\.0"):
        hertz.load(half_width=1.0, radius=np.array([1.0, -2.0, -3.0]), modulus=1.0)


@pytest.mark.parametrize("side", [0, 2, 0.5, None, np.array([1, -1]), np.array([])])
def test_a_side_is_plus_or_minus_one(side: Any) -> None:
    for case in POTENTIALS:
        with pytest.raises(ValueError, match="side = "):
            case.potential(0.3, side=side)


def test_a_moment_that_lifts_a_corner_is_refused_with_its_numbers() -> None:
    given = {"half_width": 1.0, "normal_load": 2.0}
    with pytest.raises(ValueError, match=r"1\.05.* exceeds half_width/2 = 0\.5.*partial_pressure"):
        flat.pressure(0.0, **given, moment=2.1)
    with pytest.raises(ValueError, match="lifts off"):
        flat.moment(**given, tilt=9.0, modulus=1.0)
    with pytest.raises(ValueError, match="both corners touch"):
        flat.partial_pressure(0.0, **given, moment=0.9)
    with pytest.raises(ValueError, match="both corners touch"):
        flat.partial_moment(**given, tilt=0.1, modulus=1.0)
    with pytest.raises(ValueError, match="tip over"):
        flat.partial_tilt(**given, moment=-2.0, modulus=1.0)


def test_an_unloaded_flat_has_no_pressure() -> None:
    given = {"half_flat": 1.0, "rim": 0.0, **UNIT}
    x = np.array([0.0, 0.5, 1.0, 2.0])
    assert rounded_flat.load(**given) == 0
    assert rounded_flat.pressure(x, **given).tolist() == [0.0] * 4
    assert rounded_flat.potential(x, **given).tolist() == [0.0] * 4


def test_the_closed_forms_import_nothing_but_numpy_and_themselves() -> None:
    """No solver, which they are to check, and no mpmath, whose contexts the caller brings."""
    allowed = set(sys.stdlib_module_names) | {"numpy", "analytic"}
    for path in Path(analytic.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [str(node.module)] if isinstance(node, ast.ImportFrom) else []
            assert {name.split(".")[0] for name in names} <= allowed, path


HEIGHTS = {
    "hertz": lambda x: hertz.height(x, radius=1.0),
    "power": lambda x: power.height(x, exponent=2.0, coefficient=1.0),
    "slope of power": lambda x: power.slope(x, exponent=3.0, coefficient=1.0),
    "rounded_flat": lambda x: rounded_flat.height(x, half_flat=1.0, radius=1.0),
    "two_parabolas": lambda x: two_parabolas.height(x, distance=1.0, radius=1.0),
}


@pytest.mark.parametrize("name", HEIGHTS)
@pytest.mark.parametrize("x", [1e300, np.array([0.0, 1e300])], ids=["number", "array"])
def test_a_height_beyond_doubles_is_refused_with_its_place(name, x):
    with pytest.raises(ValueError, match=r"x = 1e\+300 is more than the largest double"):
        HEIGHTS[name](x)


def test_masked_entries_are_refused():
    with pytest.raises(ValueError, match="x has masked entries"):
        hertz.height(np.ma.array([0.1, 0.2], mask=[0, 1]), radius=1.0)
