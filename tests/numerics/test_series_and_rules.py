"""Laws of the series, rules and sums that all of sie is made of, each against another formula."""

from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import chebyshev as numpy_chebyshev

from sie.numerics import chebyshev, graded_panels
from sie.numerics.cauchy_sums import KernelSums
from sie.numerics.elliptic import modulus_of_ratio
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.graded_rule import graded, on_panels
from sie.numerics.interval import Interval, recentred, two_product, two_sum

EPS = np.finfo(float).eps
RANDOM = np.random.default_rng(1)
SERIES = [RANDOM.standard_normal(n) for n in (1, 2, 3, 8, 33)]
s = np.linspace(-1.0, 1.0, 41)
numbers = st.floats(-1e100, 1e100).filter(lambda v: v == 0.0 or abs(v) > 1e-100)


@given(numbers, numbers)
def test_a_sum_and_a_product_of_doubles_keep_what_rounding_takes(a, b):
    for (nearest, rest), exact in (
        (two_sum(a, b), Fraction(a) + Fraction(b)),
        (two_product(a, b), Fraction(a) * Fraction(b)),
    ):
        assert Fraction(nearest) + Fraction(rest) == exact


@given(st.floats(-1.0, 1.0), st.floats(1e-12, 1.0), st.floats(-1e-9, 1e-9))
def test_a_moved_interval_keeps_the_distance_of_its_edges(x1, width, dx):
    moved = Interval(x1, x1 + width).moved(dx, dx)
    assert Fraction(moved.x1) + Fraction(moved.tail1) == Fraction(x1) + Fraction(dx)
    assert 2.0 * moved.r == pytest.approx((x1 + width) - x1, rel=4 * EPS)


def test_a_polynomial_about_another_origin_is_the_same():
    c, new = RANDOM.standard_normal((3, 4)), np.array([0.5, -2.0, 0.0])
    about, _ = recentred(c, np.zeros((3, 2)), np.zeros(3), new)
    for row, other, origin in zip(c, about, new, strict=True):
        values = np.polynomial.polynomial.polyval(s, row)
        moved = np.polynomial.polynomial.polyval(s - origin, other)
        assert moved == pytest.approx(values, abs=1e-13)


@pytest.mark.parametrize("c", SERIES, ids=len)
def test_a_series_is_that_of_its_values(c):
    values = chebyshev.evaluate(c, chebyshev.points(len(c)))
    assert chebyshev.transform(values) == pytest.approx(c, abs=1e-13)
    assert chebyshev.evaluate(c, s) == pytest.approx(numpy_chebyshev.chebval(s, c), abs=1e-13)


@pytest.mark.parametrize("c", SERIES, ids=len)
def test_the_derivative_of_an_antiderivative_is_the_series(c):
    rise = chebyshev.antiderivative(c)
    assert numpy_chebyshev.chebder(rise)[: len(c)] == pytest.approx(c, abs=1e-13)
    assert chebyshev.evaluate(rise, -1.0) == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("c", SERIES[1:], ids=len)
def test_divided_differences_keep_their_digits_where_points_meet(c):
    steep = numpy_chebyshev.chebval(s, numpy_chebyshev.chebder(c))
    scale = len(c) ** 2 * np.abs(c).sum()
    assert chebyshev.quotient(c, s, s) == pytest.approx(steep, abs=1e-14 * scale)
    t = s[::-1] + 0.01
    apart = (numpy_chebyshev.chebval(t, c) - numpy_chebyshev.chebval(s, c)) / (t - s)
    assert chebyshev.quotient(c, s, t) == pytest.approx(apart, abs=1e-12 * scale)
    for end in (-1.0, 1.0):
        beside = chebyshev.evaluate(chebyshev.divided(c, end), s)
        assert beside == pytest.approx(
            chebyshev.quotient(c, np.full(41, end), s), abs=1e-14 * scale
        )


@pytest.mark.parametrize("n", [1, 4, 9])
def test_the_derivative_of_a_series_of_the_second_kind(n):
    q, h = RANDOM.standard_normal(n + 1), 1e-6
    steep = chebyshev.evaluate_second_kind(chebyshev.second_kind_derivative(q), s) + 0.0 * s
    beside = [chebyshev.evaluate_second_kind(q, s + d) for d in (h, -h)]
    assert steep == pytest.approx((beside[0] - beside[1]) / (2.0 * h), abs=1e-6 * n**5)


@pytest.mark.parametrize("n", [1, 2, 7, 40])
@pytest.mark.parametrize(("a", "b"), [(0.0, 0.0), (-0.5, -0.5), (0.5, -0.25), (-0.9, 3.0)])
def test_a_gauss_rule_is_exact_up_to_twice_its_nodes(n, a, b):
    rule = gauss_jacobi(n, a, b)
    assert rule.x + rule.rest == pytest.approx(np.ones(n), abs=4 * EPS)
    for k in {0, 1, n, 2 * n - 1}:
        exact = float(mp.beta(b + k + 1, a + 1))
        assert rule.weight @ rule.x**k == pytest.approx(exact, rel=1e-13)
    if a == b == 0.0:
        g, w = chebyshev.gauss_legendre(n)
        assert g == pytest.approx(rule.x, abs=1e-14)
        assert w == pytest.approx(rule.weight, rel=1e-12)


@pytest.mark.parametrize(
    ("f", "exact"), [(np.log, -1.0), (lambda x: x**-0.25, 4 / 3), (np.sqrt, 2 / 3)]
)
def test_graded_panels_integrate_what_is_singular_at_an_end(f, exact):
    x, weight = on_panels(np.concatenate(([0.0], graded(40), [1.0])))
    assert float((f(x) * weight).sum()) == pytest.approx(exact, rel=1e-14)


def test_a_function_with_roots_at_marks_is_its_series_and_its_integral():
    ends = np.array([[0.0, 1.0], [1.0, 4.0]])

    def root(rule):
        return np.sqrt(rule.from_lo * rule.from_hi)

    rule = graded_panels.Rule.graded(ends)
    assert rule.weight @ root(rule) == pytest.approx(np.pi / 8 * (1 + 9), rel=1e-14)
    pieces = graded_panels.Pieces.fitted(ends, root)
    assert pieces.on(rule) == pytest.approx(root(rule), abs=1e-13)
    places = graded_panels.Pieces.places(ends)
    integral = graded_panels.Pieces.integral(places, root(places))
    assert integral.last == pytest.approx(np.pi / 8 * (1 + 9), rel=1e-13)
    assert float(integral(np.array(0.5))) == pytest.approx(np.pi / 16, rel=1e-13)


@pytest.mark.parametrize("roots", [(False, False), (True, False), (False, True), (True, True)])
def test_a_principal_value_has_its_closed_form(roots):
    """Of 1 and (1 - x)/x and its mirror image, and of 1/sqrt(x (1 - x)), on [0, 1]."""
    rule = graded_panels.Rule.graded([[0.0, 1.0]])
    at = graded_panels.Rule.of([[0.0, 1.0]], graded_panels.gauss_shares((0.0, 0.5), 5))

    def density(x):
        to_lo, to_hi = (0.5 if both != any(roots) else -0.5 for both in roots)
        return x.from_lo**to_lo * x.from_hi**to_hi if any(roots) else np.ones_like(x.from_lo)

    exact = np.pi * (float(roots[0]) - float(roots[1])) + np.zeros(len(at.lo))
    exact = exact if any(roots) else np.log(at.from_lo / at.from_hi)
    given_at = density(rule), density(at)
    found = graded_panels.principal_value(rule, given_at, at, roots, lambda step: step)
    assert found == pytest.approx(exact, abs=1e-12 * np.abs(given_at[1]).max())


@pytest.mark.parametrize("rows", [1, 3, 4, 37])
def test_fast_sums_and_the_pairs_they_leave_are_all_of_the_sum(rows):
    lo = np.sort(RANDOM.uniform(-1.0, 1.0, rows))
    length = 0.5 * np.append(np.diff(lo), 0.1)
    offset, charge = length[:, None] * RANDOM.uniform(0.0, 1.0, (rows, 5)), np.ones((rows, 5))
    z = RANDOM.uniform(-2.0, 2.0, 50) + 1j * RANDOM.uniform(1e-3, 1.0, 50)
    total, steep, k, i = KernelSums(lo, length, offset, charge).far_pair(z)
    for power, fast in ((1, total), (2, steep)):
        poles = (charge / (lo[:, None] + offset - z[:, None, None]) ** power).sum(axis=2)
        left = np.zeros_like(z)
        np.add.at(left, i, poles[i, k])
        size = np.abs(poles).sum(axis=1).max()
        assert fast + left == pytest.approx(poles.sum(axis=1), abs=1e-13 * size)


@pytest.mark.parametrize("tau", [0.1, 0.3, 1.0, 20.0])
def test_the_modulus_of_a_ratio_of_quarter_periods_is_that_of_mpmath(tau):
    found = modulus_of_ratio(tau)
    with mp.workdps(40):
        k = mp.kfrom(q=mp.exp(-mp.pi * mp.mpf(tau)))
        exact = [float(v) for v in (k, mp.sqrt(1 - k**2), mp.ellipk(k**2))]
        rest = float(1 - k)
    assert found[:3] == pytest.approx(exact, rel=1e-13)
    assert found.rest == pytest.approx(rest, rel=1e-13)
