"""What every solution of a Cauchy equation obeys, and manufactured ones: exponents, kernels,
intervals and poles drawn at random.

The reference (`oracles.manufactured`) is in 40 digits and uses no orthogonal polynomials.
"""

from typing import NamedTuple

import laws
import mpmath
import numpy as np
import pytest
import scipy.special
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import between

import sie
from oracles.manufactured import Manufactured, exact, exponents, mp, needed, right_hand_side
from validation.topics.collocation import parabola_in_sliding

PROMISE = 1e-13  # of the peak
KINDS = [(False, False), (True, False), (False, True), (True, True)]


def words(pair):
    return tuple("bounded" if bounded else "singular" for bounded in pair)


def number(value):
    z = complex(value)
    return z if z.imag else z.real


def equation_of(densities, a, b, ends, kernels=()):
    """The equation that `densities` solve, the total of each interval of index 1 given."""
    intervals = tuple((d.x1, d.x2) for d in densities)
    is_complex = any(isinstance(v, complex) for v in (a, b))

    def k(x, t):
        values = sum(c / (t - x - shift) for c, shift in kernels)
        return values if is_complex else values.real

    wanted, totals = sum(d.kappa for d in densities), []
    for d in densities:
        totals.append(number(d.total) if d.kappa == 1 and wanted > 0 else None)
        wanted -= totals[-1] is not None
    return sie.CauchyEquation(
        intervals, right_hand_side(densities, a, b, kernels), a=a, b=b, k=k if kernels else None,
        ends=[words(e) for e in ends],
        total=tuple(totals) if any(t is not None for t in totals) else None,
    )  # fmt: skip


def inside(d):
    return d.x1 + (d.x2 - d.x1) * np.array([0.01, 0.1, 0.33, 0.5, 0.77, 0.93, 0.99])


# -- the references themselves --------------------------------------------------------------------


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


# -- manufactured solutions -----------------------------------------------------------------------

reals = st.tuples(between(-3.0, 3.0), st.sampled_from([1.0, -1.0, 0.3]))
nearly_real = st.builds(complex, between(0.8, 1.2), between(-0.1, 0.1))
complexes = st.tuples(
    st.builds(complex, between(-0.8, 0.8), between(0.05, 0.6)),
    st.sampled_from([1.0, -1.0]) | nearly_real,
)
constants = reals | complexes


@st.composite
def densities(draw, a, b, ends, interval):
    """A polynomial of degree up to 5, and a pole as far from the interval as half its
    half-width.
    """
    polynomial = (*draw(st.lists(between(-1.0, 1.0), max_size=5)), 1.0)
    poles = ()
    if draw(st.booleans()):
        p, r = (
            complex(draw(between(-1.2, 1.2)), draw(between(0.5, 2.0))),
            complex(draw(between(0.1, 1.0)), draw(between(-1.0, 1.0))),
        )
        poles = ((p, r), (p.conjugate(), r.conjugate()))
    return Manufactured(*interval, *exponents(a, b, ends), polynomial, poles)


@st.composite
def problems(draw, intervals=1):
    """(densities, a, b, ends, kernels) with kernels as smooth as those of a layer of twice the
    half-width.
    """
    a, b = draw(constants)
    start, out, ends = draw(between(-2.0, 2.0)), [], []
    for _ in range(intervals):
        end = start + draw(between(0.3, 3.0))
        ends.append(draw(st.sampled_from(KINDS)))
        out.append(draw(densities(a, b, ends[-1], (start, end))))
        start = end + draw(between(0.05, 2.0))
    kernels, height = (), 2.0 * max(float(d.r) for d in out)
    if draw(st.booleans()):
        c, shift = (
            draw(between(-0.15, 0.15)),
            complex(draw(between(-1.0, 1.0)), height * draw(between(1.0, 2.0))),
        )
        kernels = (
            ((c, shift),)
            if isinstance(a, complex) or isinstance(b, complex)
            else ((c, shift), (c, shift.conjugate()))
        )
    return out, a, b, ends, kernels


def agrees(found, expected, tolerance, label):
    assert np.abs(np.subtract(found, expected)).max() <= tolerance * np.abs(expected).max(), label


@given(problems())
def test_a_manufactured_density_is_found_with_at_most_twice_the_nodes_it_needs(problem):
    manufactured, a, b, ends, kernels = problem
    (d,) = manufactured
    density = equation_of(manufactured, a, b, ends, kernels).solve()
    x = inside(d)
    agrees(density(x), exact(d.value, x), PROMISE, "value")
    agrees(
        density.parts[0].resultant,
        complex(d.total),
        PROMISE * max(1.0, abs(peak_of(d) / complex(d.total))),
        "total",
    )
    size = np.abs(exact(d.value, x)).max()
    assert np.abs(density.cauchy(x, side=0) - exact(d.cauchy, x)).max() <= 4 * PROMISE * size
    assert density.n[0] <= 2 * max(
        needed([d], PROMISE)[0],
        needed([d], PROMISE, right_hand_side(manufactured, a, b, kernels))[0],
        4,
    )
    assert density.error <= PROMISE


def peak_of(d):
    x = inside(d)
    return float(np.abs(exact(d.value, x)).max()) * float(d.r)


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
    z = np.array(
        [d.x2 + 0.01j for d in manufactured]
        + [manufactured[0].x1 - 1e-6, manufactured[-1].x2 + 3.0 + 4.0j]
    )
    expected = np.array([complex(sum(d.cauchy(complex(v)) for d in manufactured)) for v in z])
    assert np.abs(density.cauchy(z) - expected).max() <= 10 * PROMISE * max(
        size, np.abs(expected).max()
    )


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-6])
@pytest.mark.parametrize(
    ("a", "ends"),
    [
        (0.0, KINDS[0]),
        (0.3, KINDS[0]),
        (0.2j, KINDS[0]),
        (0.3, KINDS[1]),
        (0.2, KINDS[3]),
        (0.0, KINDS[3]),
        (0.3, KINDS[2]),
    ],
)
def test_a_narrow_gap_between_intervals_keeps_10_digits(gap, a, ends):
    """Bounded ends at the gap, too, where the density is far below its peak: its coefficient there
    as well.
    """
    intervals, both = ((-1.0, 0.0), (gap, 1.5)), (ends, ends[::-1])
    manufactured = [
        Manufactured(*i, *exponents(a, 1.0, e), p)
        for i, e, p in zip(intervals, both, ((1.0, -0.5, 0.25), (1.0, 2.0)), strict=True)
    ]
    density = equation_of(manufactured, a, 1.0, both).solve()
    for d, part in zip(manufactured, density.parts, strict=True):
        x = np.concatenate((inside(d), d.x1 + (d.x2 - d.x1) * np.array([1e-6, 0.999])))
        agrees(density(x), exact(d.value, x), 1e-10, "value")
        agrees(
            np.divide(part.intensities, np.array(d.intensities, dtype=complex)),
            np.ones(2),
            1e-10,
            "intensities",
        )
    assert max(density.n) <= 128  # ln(1/gap) only


class Joint(NamedTuple):
    """φ = σ |X| P on both sides of a gap, X the product of (z - e)^±1/2 over all four ends: X P
    less its polynomial part at infinity is 1/π ∫ φ/(t - z) dt, so that g is minus that polynomial.
    Next to the gap φ grows or falls as that of a contact or a crack does.
    """

    ends: tuple[float, ...]
    bounded: tuple[bool, ...]
    P: tuple[float, ...] = (1.0, 0.3, 0.2)

    @property
    def halves(self):
        return [mp.mpf(1 if bounded else -1) / 2 for bounded in self.bounded]

    def at_infinity(self, power):
        """The coefficient of z^power."""
        top, series = (
            int(sum(self.halves)) + len(self.P) - 1,
            [mp.mpf(p) for p in reversed(self.P)] + [mp.mpf(0)] * 6,
        )
        for e, half in zip(self.ends, self.halves, strict=True):
            factor = [mp.binomial(half, k) * (-mp.mpf(e)) ** k for k in range(len(series))]
            series = [
                sum(series[j] * factor[k - j] for j in range(k + 1)) for k in range(len(series))
            ]
        return series[top - power] if power <= top else mp.mpf(0)

    def intensity(self, i):
        sign = self.bounded[i // 2 * 2 + 1] * 2 - 1
        if i < 2 and self.bounded[2] == self.bounded[3]:
            sign = -sign
        others = [
            abs(mp.mpf(self.ends[i]) - e) ** half
            for j, (e, half) in enumerate(zip(self.ends, self.halves, strict=True))
            if j != i
        ]
        return (
            sign
            * mp.fprod(others)
            * sum(p * mp.mpf(self.ends[i]) ** k for k, p in enumerate(self.P))
        )

    def solve(self):
        g = [float(-self.at_infinity(power)) for power in range(6)]
        pairs = [words(self.bounded[:2]), words(self.bounded[2:])]
        given = {
            name: float(-mp.pi * self.at_infinity(-1 - k))
            for k, name in enumerate(("total", "moment"))
        }
        index = 2 - sum(self.bounded)
        known = {name: value for k, (name, value) in enumerate(given.items()) if k < index}
        return sie.CauchyEquation(
            (self.ends[:2], self.ends[2:]), np.polynomial.Polynomial(g), ends=pairs, **known
        ).solve()


FOUR = [
    (True,) * 4,
    (False, True, True, False),
    (False,) * 4,
    (True, False, False, True),
    (False, False, True, False),
    (True, True, False, True),
]


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-6])
@pytest.mark.parametrize("bounded", FOUR)
def test_the_coefficients_at_a_gap_have_the_error_of_rounding_of_g_and_state_it(bounded, gap):
    """Between bounded ends φ is gap times its peak, and g is known to rounding: 70^1.5 roundings
    over the gap, 1e-7 for 1e-6.
    """
    joint = Joint((-1.0, 0.0, gap, 1.5), bounded)
    density = joint.solve()
    reach = 1e-13 / gap if bounded[1] and bounded[2] else 1e-12
    found, said = np.ravel(density.intensities), np.ravel(density.intensity_errors)
    for i, (value, error) in enumerate(zip(found, said, strict=True)):
        off = abs(value / float(joint.intensity(i)) - 1.0)
        assert off <= (reach if i in (1, 2) else 1e-12)
        assert off <= 4.0 * error
        assert error <= 10.0 * (reach if i in (1, 2) else 1e-12)


@pytest.mark.parametrize("at", [0.0, 0.3])
@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-6])
@pytest.mark.parametrize(
    ("a", "ends"),
    [(0.0, KINDS[0]), (0.3, KINDS[0]), (0.0, KINDS[3]), (0.3, KINDS[1]), (0.0, KINDS[2])],
)
def test_next_to_a_gap_the_error_is_no_less_than_a_third_of_the_true_one_and_no_absurd_one(
    a, ends, gap, at
):
    """The error is that of φ over its peak, singular ends divided out; where g varies across a gap,
    doubles x limit it.
    """
    intervals, both = ((at - 1.0, at), (at + gap, at + 1.5)), (ends, ends[::-1])
    manufactured = [
        Manufactured(*i, *exponents(a, 1.0, e), p)
        for i, e, p in zip(intervals, both, ((1.0, -0.5, 0.25), (1.0, 0.2)), strict=True)
    ]
    density = equation_of(manufactured, a, 1.0, both).solve()
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


@pytest.mark.parametrize("at", [0.3, -7.0])
@pytest.mark.parametrize(("a", "ends"), [(0.0, KINDS[0]), (0.3, KINDS[1]), (0.2, KINDS[3])])
def test_a_narrow_gap_far_from_zero_keeps_10_digits(at, a, ends):
    """There neighbouring doubles are 1e-10 gaps apart, and g, that varies across the gap, is no
    smoother: no reason to give up.
    """
    intervals, both = ((at - 1.0, at), (at + 1e-6, at + 1.5)), (ends, ends[::-1])
    manufactured = [
        Manufactured(*i, *exponents(a, 1.0, e), p)
        for i, e, p in zip(intervals, both, ((1.0, -0.5, 0.25), (1.0, 2.0)), strict=True)
    ]
    density = equation_of(manufactured, a, 1.0, both).solve()
    for d in manufactured:
        agrees(density(inside(d)), exact(d.value, inside(d)), 1e-10, "value")


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


# -- everywhere in the plane ----------------------------------------------------------------------

PLACES = [complex(s, y) for s in (-1.0, -0.4, 0.9, 1.0) for y in (1e-12, -1e-6, 1e-2, 0.5)]
PLACES += [1 + 1e-12, -1 - 1e-9, 1 + 1e-4j, 1.001, -1.3, 2.0, 5j, 40.0 + 1e-9j, 1e5j, -1e5]


@pytest.mark.parametrize(
    ("a", "ends"),
    [(0.0, KINDS[0]), (0.3, KINDS[1]), (-0.7, KINDS[3]), (0.4j, KINDS[0]), (0.2 + 0.3j, KINDS[2])],
)
def test_the_potential_is_that_of_40_digits_near_and_far(a, ends):
    """Relative to itself, from 1e-12 half-widths off the interval to 1e5 away."""
    d = Manufactured(
        -1.0,
        3.0,
        *exponents(a, 1.0, ends),
        (1.0, -0.5, 0.25, 0.1),
        ((1.5, 0.3), (-0.2 + 0.8j, 0.1)),
    )
    density = equation_of([d], a, 1.0, [ends]).solve()
    z = 1.0 + 2.0 * np.array(PLACES)
    for where, found in zip(z.tolist(), density.cauchy(z), strict=True):
        expected = complex(d.cauchy(where))
        assert abs(found - expected) <= PROMISE * abs(expected), where


@pytest.mark.parametrize("a", [30.0, 1e3, -2e4, 2e3 - 1e3j])
@pytest.mark.parametrize("ends", KINDS)
def test_next_to_a_large_constant_density_and_potential_keep_their_digits(a, ends):
    """|a| >> |b| makes exponents of nearly 0 and ±1, and cosec πα so large that the terms of the
    potential cancel.
    """
    d = Manufactured(
        -1.0,
        3.0,
        *exponents(a, 1.0, ends),
        (1.0, -0.5, 0.25, 0.1),
        ((1.5, 0.3), (-0.2 + 0.8j, 0.1)),
    )
    density, x, z = (
        equation_of([d], a, 1.0, [ends]).solve(),
        inside(d),
        [1.1 + 0.3j, 2.9 - 1e-5j, 0.2 + 1e-9j, 5.0],
    )
    agrees(density(x), exact(d.value, x), PROMISE, "value")
    agrees(density.cauchy(x, side=0), exact(d.cauchy, x), PROMISE, "principal value")
    assert density.cauchy(z) == pytest.approx(exact(d.cauchy, z), rel=PROMISE)


def test_next_to_an_exponent_of_minus_one_a_density_is_as_accurate_as_it_states():
    """There all of φ stands at one end, and the exponent's distance from -1 has few digits."""
    for a in (1e6, 1e9, 1e12):
        d = Manufactured(-1.0, 3.0, *exponents(a, 1.0, (False, True)), (1.0, -0.5, 0.25, 0.1))
        equation, x = equation_of([d], a, 1.0, [KINDS[2]]), inside(d)
        with pytest.raises(
            sie.ContactError,
            match=r"exponent at a singular end is -1 but for .*make that end bounded",
        ) as caught:
            equation.solve(tol=1e-15)
        agrees(
            caught.value.reached["density"](x),
            exact(d.value, x),
            caught.value.reached["density"].error,
            "value",
        )


@pytest.mark.parametrize("gap", [0.4, 1e-3, 1e-6])
def test_the_potential_next_to_a_gap_is_that_of_40_digits(gap):
    """On graded intervals: in the gap, above it, at its ends, and far away."""
    manufactured = [
        Manufactured(-1.0, 0.0, -0.5, -0.5, (1.0, -0.5)),
        Manufactured(gap, 2.0, -0.5, -0.5, (0.3, 1.0, 0.2)),
    ]
    density = equation_of(manufactured, 0.0, 1.0, [KINDS[0]] * 2).solve()
    z = [
        gap * complex(u, v) for u in (-2.0, 0.001, 0.5, 0.99, 1.7) for v in (1e-12, -1e-3, 0.1, 3.0)
    ]
    z += [
        0.5 * gap,
        -1 - 1e-9,
        -0.5 + 1e-12j,
        1.0 - 1e-5j,
        2.0 + 1e-10j,
        0.3 + 0.2j,
        1.0 - 5.0j,
        1e4 + 1e4j,
    ]
    # The densities themselves are known so well next to the gap.
    size = 10 * PROMISE * max(1.0, 1e-3 / gap)
    for where, found in zip(z, density.cauchy(z), strict=True):
        expected = complex(sum(d.cauchy(where) for d in manufactured))
        assert abs(found - expected) <= size * abs(expected), where


@pytest.mark.parametrize("gap", [1e-2, 1e-4])
@pytest.mark.parametrize(
    "ends",
    [
        (KINDS[3],) * 3,
        (KINDS[2], KINDS[1], KINDS[0]),
        (KINDS[0], KINDS[2], KINDS[1]),
        (KINDS[1], KINDS[2], KINDS[3]),
    ],
)
def test_the_potential_next_to_gaps_of_every_kind_is_that_of_40_digits(ends, gap):
    """Gaps between bounded ends, singular ones, one of each; the factor by which φ is multiplied
    differs on both sides of an interval.
    """
    intervals = ((-1.0, 0.0), (gap, 1.5), (1.5 + 2 * gap, 2.5))
    manufactured = [
        Manufactured(*i, *exponents(0.0, 1.0, e), p)
        for i, e, p in zip(intervals, ends, ((1.0, -0.5), (0.3, 1.0, 0.2), (1.0, 0.4)), strict=True)
    ]
    density = equation_of(manufactured, 0.0, 1.0, ends).solve()
    z = [
        at + gap * complex(u, v)
        for at in (0.0, 1.5)
        for u in (-2.0, 0.5, 1.3)
        for v in (1e-6, -0.1, 3.0)
    ]
    z += [0.7 + 0.2j, 0.3 - 1e-3j, 1e3j]
    for where, found, slope in zip(z, density.cauchy(z), density.cauchy_derivative(z), strict=True):
        parts = [complex(d.cauchy(where)) for d in manufactured]
        slopes = [complex(mp.diff(d.cauchy, mp.mpc(where))) for d in manufactured]
        assert abs(found - sum(parts)) <= 1e-11 * max(map(abs, parts)), where
        assert abs(slope - sum(slopes)) <= 1e-10 * max(map(abs, slopes)), where


@given(problems(), st.integers(0, 2**32 - 1))
@settings(max_examples=15)
def test_the_potential_jumps_by_the_density(problem, seed):
    """Plemelj: F(x ± i0) = H ∓ i φ, and side 0 is their mean; off the interval there is no side."""
    manufactured, a, b, ends, kernels = problem
    density = equation_of(manufactured, a, b, ends, kernels).solve()
    x1, x2 = density.interval
    x = np.random.default_rng(seed).uniform(x1, x2, 20)
    above, below, principal = (density.cauchy(x, side=side) for side in (1, -1, 0))
    size = np.abs(density(x)) + np.abs(principal)
    assert (np.abs(above - below + 2j * density(x)) <= PROMISE * size).all()
    assert (np.abs(above + below - 2 * principal) <= PROMISE * size).all()
    assert (np.abs(density.hilbert(x) - principal) <= PROMISE * size).all()
    beside = np.array([x1 - 0.3, x2 + 0.1])
    assert (density.cauchy(beside, side=1) == density.cauchy(beside, side=-1)).all()


@pytest.mark.parametrize("gap", [None, 1e-3])
def test_the_potential_reaches_its_limit_continuously(gap):
    intervals = ((-1.0, 1.0),) if gap is None else ((-1.0, 0.0), (gap, 1.0))
    density = sie.CauchyEquation(intervals, np.exp, a=0.3, ends=("bounded", "singular")).solve()
    x = np.array([-0.9, -0.3, -0.01, 0.2, 0.9])
    for side in (1, -1):
        limit, off = density.cauchy(x, side=side), density.cauchy(x + 1e-13j * side)
        assert np.abs(off - limit).max() <= 1e-9 * np.abs(limit).max()


# -- laws of the operator -------------------------------------------------------------------------


def test_repeated_integrals_may_be_exchanged_by_the_formula_of_poincare_and_bertrand():
    """In Tricomi's form H(φ Hψ + ψ Hφ) = Hφ Hψ - φ ψ; the left side by a quadrature of its own."""
    phi = sie.CauchyEquation(
        (-1.0, 2.0), lambda x: np.exp(0.5 * x), ends="bounded", free=(1.0,)
    ).solve()
    psi = sie.CauchyEquation(
        (-1.0, 2.0), lambda x: 1.0 / (x - 3.0), ends="bounded", free=(1.0,)
    ).solve()

    def product(x):
        return phi(x) * psi.hilbert(x) + psi(x) * phi.hilbert(x)

    x = np.array([-0.6, 0.13, 1.4])
    expected = phi.hilbert(x) * psi.hilbert(x) - phi(x) * psi(x)
    found = [laws.principal_value(product, (-1.0, 2.0), v) for v in x]
    assert found == pytest.approx(expected, abs=1e-12 * np.abs(expected).max())


def kernel(x, t):
    return 0.2 * np.exp(0.4 * x - 0.2 * t) * np.cos(x + 2.0 * t)


@given(constants, between(-1.0, 1.0), between(0.5, 2.0), st.sampled_from(KINDS[1:3]))
def test_the_adjoint_equation_has_the_adjoint_solution(ab, m, r, ends):
    """T φ = g and T' ψ = g', T' with -b, the kernel transposed and the other ends: then ∫ ψ g = ∫ φ
    g', as sums of total and moment.
    """
    a, b = ab
    interval = (m - r, m + r)
    phi = sie.CauchyEquation(
        interval, lambda x: 1.0 + 2.0 * x, a=a, b=b, k=kernel, ends=words(ends)
    ).solve()
    psi = sie.CauchyEquation(
        interval, lambda x: 3.0 - x, a=a, b=-b, k=lambda x, t: kernel(t, x), ends=words(ends[::-1])
    ).solve()  # fmt: skip
    left, right = psi.resultant + 2.0 * psi.moment, 3.0 * phi.resultant - phi.moment
    size = abs(psi.resultant) + 2.0 * abs(psi.moment) + 3.0 * abs(phi.resultant) + abs(phi.moment)
    assert abs(left - right) <= PROMISE * size


@pytest.mark.parametrize("scale", [1.0, -3.0, 1e-100, 1e100])
@pytest.mark.parametrize("intervals", [((-1.0, 1.0),), ((-1.0, 0.0), (2.0**-10, 0.75))])
def test_an_affine_map_of_the_lengths_changes_nothing_else(scale, intervals):
    """x -> scale x; a reflection turns b and the ends round."""
    ends, b = ("singular", "bounded"), 1.0

    def mapped(intervals, scale):
        moved = tuple(tuple(sorted((scale * x1, scale * x2))) for x1, x2 in intervals)
        turned = scale < 0
        return sie.CauchyEquation(
            moved[::-1] if turned else moved,
            lambda x: np.exp(x / scale), a=0.3, b=-b if turned else b,
            k=lambda x, t: kernel(x / scale, t / scale) / abs(scale),
            ends=ends[::-1] if turned else ends,
        ).solve()  # fmt: skip

    plain, scaled = mapped(intervals, 1.0), mapped(intervals, scale)
    x = np.concatenate([x1 + (x2 - x1) * np.array([0.1, 0.3, 0.6, 0.9]) for x1, x2 in intervals])
    agrees(scaled(scale * x), plain(x), PROMISE, "value")
    assert scaled.resultant / abs(scale) == pytest.approx(plain.resultant, rel=PROMISE)
    assert scaled.moment / scale / abs(scale) == pytest.approx(plain.moment, rel=PROMISE)
    z = np.array([0.3 + 0.01j, 2.0 - 3.0j])
    turned = scaled.cauchy(scale * z) * (1.0 if scale > 0 else -1.0)
    agrees(turned, plain.cauchy(z), PROMISE, "potential")


@pytest.mark.parametrize("shift", [0.5, -3.0])
def test_moved_along_the_axis_the_density_is_the_same(shift):
    def moved(by):
        return sie.CauchyEquation(
            (by, 2.0 + by), lambda x: np.exp(x - by), a=-0.4, total=1.0
        ).solve()

    x = np.linspace(0.125, 1.875, 9)
    agrees(moved(shift)(x + shift), moved(0.0)(x), PROMISE, "value")
    assert moved(shift).moment == pytest.approx(moved(0.0).moment + shift, rel=PROMISE)


@pytest.mark.parametrize("k", [None, kernel])
def test_the_residual_is_small_at_points_that_were_not_used(k):
    """The whole equation, from the density's own values and potential and a quadrature of the tests
    for the kernel.
    """
    a, b = 0.4, -0.8
    density = sie.CauchyEquation(
        (-1.0, 2.0), np.cos, a=a, b=b, k=k, ends="bounded", free=(1.0,)
    ).solve()
    x = np.array([-0.93, -0.2, 0.7, 1.9])
    right, left = density.parts[0].weight.alpha, density.parts[0].weight.beta
    s, weight = scipy.special.roots_jacobi(40, right, left)
    t = 0.5 + 1.5 * s
    smooth = (
        0.0
        if k is None
        else k(x[:, None], t) @ (1.5 * weight * density(t) / ((1 - s) ** right * (1 + s) ** left))
    )
    left_over = a * density(x) - b * density.hilbert(x) + smooth - np.cos(x) - density.constants[0]
    assert np.abs(left_over).max() <= PROMISE


# -- contacts in closed form ----------------------------------------------------------------------


@pytest.mark.parametrize("strength", [-0.3, -0.05, 0.0, 0.2, 0.3])
def test_the_sliding_parabola_has_the_pressure_of_the_closed_form(strength):
    pressure, x, closed = parabola_in_sliding(strength, 101)
    epsilon = np.arctan(-strength) / np.pi
    assert pressure(x) == pytest.approx(closed, rel=PROMISE)
    assert pressure.resultant == pytest.approx(np.pi * (0.25 - epsilon**2), rel=PROMISE)


@pytest.mark.parametrize("strength", [-0.3, 0.0, 0.2])
def test_the_sliding_flat_punch_has_the_pressure_of_the_closed_form(strength):
    epsilon = np.arctan(-strength) / np.pi
    pressure = sie.CauchyEquation((-2.0, 2.0), 0.0, a=-strength, b=-1.0, total=3.0).solve()
    x = np.linspace(-1.99, 1.99, 41)
    closed = (
        3.0
        * np.cos(np.pi * epsilon)
        / np.pi
        * (2.0 - x) ** (-0.5 - epsilon)
        * (2.0 + x) ** (-0.5 + epsilon)
    )
    assert pressure(x) == pytest.approx(closed, rel=PROMISE)


@pytest.mark.parametrize("beta", [-0.4, 0.1, 0.3])
def test_the_bonded_flat_punch_oscillates_as_in_closed_form(beta):
    """p + iq under P + iQ: 1/π PV∫ φ/(x - t) dt + iβ φ = 0 (Muskhelishvili 1953, § 114)."""
    load, eta = 2.0 + 0.7j, np.arctanh(beta) / np.pi
    traction = sie.CauchyEquation((-1.5, 1.5), 0.0, a=1j * beta, b=-1.0, total=load).solve()
    x = np.linspace(-1.4999, 1.4999, 51)
    closed = (
        load
        / np.pi
        * np.cosh(np.pi * eta)
        / np.sqrt((1.5 - x) * (1.5 + x))
        * np.exp(1j * eta * np.log((1.5 + x) / (1.5 - x)))
    )
    agrees(traction(x) / np.abs(closed), closed / np.abs(closed), PROMISE, "p + iq")


@pytest.mark.parametrize(("incidence", "camber"), [(0.1, 0.0), (0.03, 0.2)])
def test_the_thin_aerofoil_has_the_circulation_of_the_closed_form(incidence, camber):
    """1/2π PV∫ γ/(x - t) dt = U (incidence + camber x), Kutta's condition at the trailing edge x =
    1 (Glauert 1926); U = 1.
    """
    sheet = sie.CauchyEquation(
        (-1.0, 1.0), lambda x: incidence + camber * x, b=-0.5, ends=("singular", "bounded")
    ).solve()
    x = np.linspace(-0.99, 0.99, 21)
    closed = 2.0 * incidence * np.sqrt((1 - x) / (1 + x)) + 2.0 * camber * np.sqrt(
        (1 - x) * (1 + x)
    )
    assert sheet(x) == pytest.approx(closed, rel=PROMISE)
    assert sheet.resultant == pytest.approx(2.0 * np.pi * (incidence + 0.5 * camber), rel=PROMISE)


def test_the_constant_that_a_bounded_solution_needs_is_found():
    """Both ends bounded and g = x²: ∫ (x² + d)/sqrt(1 - x²) dx = 0, d = -1/2."""
    density = sie.CauchyEquation((-1.0, 1.0), lambda x: x * x, ends="bounded", free=(1.0,)).solve()
    assert density.constants == pytest.approx((-0.5,), rel=1e-15)
    x = np.linspace(-0.9, 0.9, 7)
    assert density(x) == pytest.approx(-x * np.sqrt(1 - x * x), abs=1e-15)
