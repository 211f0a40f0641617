"""The question and how it is solved: index and side conditions, nodes, sizes, conditioning,
refusals.
"""

import mpmath
import numpy as np
import pytest
from cauchy_cases import counted, smooth_kernel

import sie
from sie.cauchy import formulation, kernel, solver, system
from sie.cauchy.system import System
from sie.numerics import jacobi
from sie.numerics.jacobi_weight import Weight

mp = mpmath.mp.clone()
mp.dps = 40
SINGULAR, BOUNDED = "singular", "bounded"
KINDS = [(SINGULAR, SINGULAR), (SINGULAR, BOUNDED), (BOUNDED, SINGULAR), (BOUNDED, BOUNDED)]


def index_of(pair):
    return 1 - pair.count(BOUNDED)


# -- index and side conditions ---------------------------------------------------------------------


@pytest.mark.parametrize("a", [0.0, 0.4, -2.0, 0.3j, 0.2 - 0.5j])
@pytest.mark.parametrize("ends", KINDS)
def test_the_index_counts_singular_less_bounded_ends(ends, a):
    equation = sie.CauchyEquation(
        (0.0, 1.0), 0.0, a=a, ends=ends, total=0.0 if index_of(ends) == 1 else None
    )
    assert equation.index == index_of(ends)
    ((left, right),) = equation.exponents
    assert left + right == pytest.approx(-equation.index, abs=1e-15)
    for exponent, kind in zip((left, right), ends, strict=True):
        assert (0 < exponent.real < 1) if kind == BOUNDED else (-1 < exponent.real < 0)


def test_constants_of_one_phase_have_real_exponents():
    """A complex multiple of an equation is the same equation; a complex weight equal to a real one
    would be mistaken for it in a cache.
    """
    phase = 0.8 + 0.05j
    turned = sie.CauchyEquation((0.0, 1.0), phase, a=phase, b=phase, ends=KINDS[1])
    plain = sie.CauchyEquation((0.0, 1.0), 1.0, a=1.0, b=1.0, ends=KINDS[1])
    assert turned.weights == plain.weights
    assert all(isinstance(e, float) for e in turned.exponents[0])
    assert turned.solve()(0.3) == pytest.approx(plain.solve()(0.3), rel=1e-15)


@pytest.mark.parametrize("first", KINDS)
@pytest.mark.parametrize("second", KINDS)
def test_several_intervals_add_their_indices_and_need_as_many_conditions(first, second):
    intervals, index = ((-1.0, 0.0), (1.0, 3.0)), index_of(first) + index_of(second)
    for given in range(3):
        conditions = {"total": 0.0} if given else {}
        conditions |= {"moment": 0.0} if given == 2 else {}
        if given == max(index, 0):
            assert (
                sie.CauchyEquation(intervals, 0.0, ends=(first, second), **conditions).index
                == index
            )
        else:
            with pytest.raises(
                ValueError,
                match=rf"index {index} needs {max(index, 0)} side condition\(s\), but {given} "
                rf"given",
            ):
                sie.CauchyEquation(intervals, 0.0, ends=(first, second), **conditions)


def test_a_free_function_needs_one_condition_more():
    with pytest.raises(
        ValueError,
        match=r"index 1 and 1 free function\(s\) needs 2 side condition\(s\), but 1 given",
    ):
        sie.CauchyEquation((-1.0, 1.0), 0.0, total=0.0, free=(1.0,))
    assert sie.CauchyEquation(
        (-1.0, 1.0), 0.0, total=0.0, moment=1.0, free=(1.0,)
    ).solve().moment == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize("k", [None, lambda x, t: 0.2 * np.cos(x * t)])
def test_all_conditions_are_met(k):
    """φ of two intervals with a free slope of g: total of one, total and moment of both."""
    intervals = ((-2.0, -0.5), (0.25, 1.0))
    density = sie.CauchyEquation(
        intervals, np.exp, k=k, total=(0.3, 1.1), moment=0.7, free=(lambda x: x,)
    ).solve()
    assert [part.resultant for part in density.parts] == pytest.approx([0.3, 1.1], rel=1e-13)
    assert density.moment == pytest.approx(0.7, rel=1e-13)
    assert density.residual < 1e-14
    assert len(density.constants) == 1


def test_only_the_ratio_of_the_constants_counts():
    """Neither a² nor b² is a double."""
    for size in (1e200, 1e-200, 1e-306):
        equation = sie.CauchyEquation(
            (0.0, 1.0), lambda x, size=size: size * np.exp(x), a=0.3 * size, b=size, total=0.0
        )
        plain = sie.CauchyEquation((0.0, 1.0), np.exp, a=0.3, total=0.0)
        assert equation.solve()(0.3) == pytest.approx(plain.solve()(0.3), rel=1e-13)


@pytest.mark.parametrize(
    "ends",
    [
        np.array([["bounded"] * 2] * 2),
        ["bounded", ("bounded", "bounded")],
        [["bounded", "bounded"]] * 2,
    ],
)
def test_ends_may_be_words_pairs_or_arrays(ends):
    plain = sie.CauchyEquation([(-1, 1), (2, 3)], 1.0, ends="bounded", free=(1.0, lambda x: x))
    assert sie.CauchyEquation([(-1, 1), (2, 3)], 1.0, ends=ends, free=plain.free).ends == plain.ends


def test_free_numbers_may_be_an_array():
    assert sie.CauchyEquation(
        (-1, 1), 1.0, ends="bounded", free=np.ones(1)
    ).solve().constants == pytest.approx((-1.0,))


# -- nodes and weights -----------------------------------------------------------------------------


def recurrence(a, b, n):
    """A_k and B_k of the monic Jacobi polynomials, P_k+1 = (s - A_k) P_k - B_k P_k-1."""
    total = a + b
    A = [(b - a) / (total + 2)]
    B = [mp.zero, 4 * (1 + a) * (1 + b) / ((2 + total) ** 2 * (3 + total))]
    for k in range(1, n + 1):
        twice = 2 * k + total
        A.append((b - a) * total / (twice * (twice + 2)))
        if k > 1:
            B.append(4 * k * (k + a) * (k + b) * (k + total) / (twice**2 * (twice**2 - 1)))
    return A, B


def exact_rule(weight, nodes):
    """The Gauss rule in 40 digits, from guesses: Newton on the monic recurrence (Szegö 1939),
    Christoffel's weights.
    """
    n, total = len(nodes), mp.mpf(-weight.kappa)
    small = weight.alpha if abs(weight.alpha) <= abs(weight.beta) else weight.beta
    a = mp.mpmathify(small) if small is weight.alpha else total - mp.mpmathify(small)
    b = total - a
    A, B = recurrence(a, b, n)
    whole = mp.power(2, 1 + total) * mp.gamma(1 + a) * mp.gamma(1 + b) / mp.gamma(2 + total)
    for node in nodes:
        s = mp.mpmathify(node.item())
        for _ in range(2):
            before, p, norm, squares = mp.zero, mp.one, mp.one, mp.zero
            slope_before, slope = mp.zero, mp.zero
            for k in range(n):
                squares += p * p / norm
                x = s - A[k]
                slope_before, slope = slope, x * slope + p - B[k] * slope_before
                before, p = p, x * p - B[k] * before
                norm *= B[k + 1]
            s -= p / slope
        yield s, whole / squares


EXPONENTS = [
    (-0.3, 1), (-0.001, 1), (-0.999, 1), (-1e-9, 1), (-1 + 1e-9, 1), (0.4, 0), (0.999, 0),
    (-0.9999999, 0), (0.5, 0), (0.2, -1),
    (0.999, -1), (-0.5 + 0.1j, 1), (-0.5 - 1.3j, 1), (0.3 + 0.4j, 0), (0.2j, 0), (0.5 + 0.7j, -1),
    (0.99 + 0.01j, -1),
]  # fmt: skip


@pytest.mark.parametrize(("alpha", "kappa"), EXPONENTS)
@pytest.mark.parametrize("n", [1, 2, 23])
def test_nodes_and_weights_are_those_of_40_digits(alpha, kappa, n):
    weight = Weight(alpha, -kappa - alpha, kappa)
    nodes, weights = jacobi.gauss(weight, n)
    for s, w, (s_exact, w_exact) in zip(nodes, weights, exact_rule(weight, nodes), strict=True):
        assert abs(mp.mpmathify(s.item()) - s_exact) <= 1e-15
        assert abs(mp.mpmathify(w.item()) / w_exact - 1) <= 1e-14


@pytest.mark.parametrize(
    ("alpha", "kappa"), [(a, k) for a, k in EXPONENTS if min(1 + a.real, 1 - a.real, abs(a)) > 5e-3]
)
def test_the_coefficients_of_a_smooth_function_have_no_noise_beyond_rounding(alpha, kappa):
    """exp has 20 coefficients; with polynomials evaluated at nodes that were rounded first the
    others would be up to 1e-13.
    """
    s, A = jacobi.analysis(Weight(alpha, -kappa - alpha, kappa), 128)
    c = np.exp(s) @ A
    assert np.abs(c[30:]).max() <= 3e-16 * np.abs(np.exp(s)[:, None] * A).sum(axis=0).max()


# -- size, cost, conditioning ----------------------------------------------------------------------


@pytest.mark.parametrize("a", [0.0, 0.3, 0.2j])
@pytest.mark.parametrize("ends", KINDS)
def test_the_condition_number_of_a_smooth_kernel_is_small_and_does_not_grow(ends, a):
    equation = sie.CauchyEquation(
        (-1.0, 1.0),
        1.0,
        a=a,
        k=smooth_kernel,
        ends=ends,
        total=0.0 if index_of(ends) == 1 else None,
    )
    conditions = [np.linalg.cond(equation.system(n)[0]) for n in (8, 32, 128)]
    assert max(conditions) < 6.0
    assert conditions[2] == pytest.approx(conditions[1], rel=1e-6)


def test_without_a_kernel_the_system_is_the_identity():
    matrix, _ = sie.CauchyEquation((-1.0, 2.0), np.exp, a=0.3, total=1.0).system(40)
    assert np.abs(matrix - np.eye(40)).max() < 1e-14


@pytest.mark.parametrize(("ends", "a"), [(KINDS[0], 0.0), (KINDS[1], 0.3), (KINDS[3], 0.2j)])
def test_the_transform_and_the_system_agree(ends, a):
    """The system is forced by a kernel that vanishes."""
    question = {
        "g": lambda x: np.exp(x) / (1.3 - x),
        "a": a,
        "ends": ends,
        "total": 0.2 if index_of(ends) == 1 else None,
    }
    question["free"] = (1.0,) if index_of(ends) == -1 else ()
    by_transform = sie.CauchyEquation((-1.0, 1.0), **question).solve()
    by_system = sie.CauchyEquation((-1.0, 1.0), k=lambda x, t: 0.0 * x * t, **question).solve()
    x = np.linspace(-0.99, 0.99, 41)
    assert np.abs(by_transform(x) - by_system(x)).max() <= 1e-14 * np.abs(by_system(x)).max()
    assert (
        np.abs(np.subtract(by_transform.constants, by_system.constants)).max(initial=0.0) <= 1e-14
    )


def wide_system():
    """A kernel as narrow as a thin layer's: g resolved by 1300 nodes, more than LAPACK gets."""
    return sie.CauchyEquation(
        (-1.0, 1.0), np.exp, k=lambda x, t: 0.02 / ((t - x) ** 2 + 0.02**2) / np.pi, total=0.0
    )


def test_the_iteration_for_large_systems_finds_what_elimination_finds():
    equation, n = wide_system(), system.DENSE + 100
    found = equation.solve(n=n).parts[0].coefficients
    matrix, rhs = equation.system(n)
    expected = np.linalg.solve(matrix, rhs)
    assert np.abs(found - expected[: len(found)]).max() <= 1e-13 * np.abs(expected).max()
    assert np.abs(expected[len(found) :]).max(initial=0.0) <= 1e-15 * np.abs(expected).max()


def test_the_iteration_serves_several_intervals_and_free_constants(monkeypatch):
    intervals = ((-1.0, 0.0), (0.001, 2.0))
    equation = sie.CauchyEquation(
        intervals, np.exp, k=smooth_kernel, a=0.3, ends=KINDS[1], total=1.0, free=(1.0,)
    )
    direct = equation.solve()
    monkeypatch.setattr(system, "DENSE", 0)
    iterated = equation.solve()
    assert iterated.n == direct.n
    x = np.array([-0.9, -0.01, -1e-4, 0.0012, 0.5, 1.99])
    assert np.abs(iterated(x) - direct(x)).max() <= 1e-12 * np.abs(direct(x)).max()
    assert iterated.constants == pytest.approx(direct.constants, rel=1e-12)


def test_the_iteration_takes_no_more_steps_for_more_unknowns():
    """Second kind: products with the matrix do not grow with n; each costs n²."""
    counts = []
    for n in (100, 200, 400):
        large = system.System(
            sie.CauchyEquation((-1.0, 1.0), np.exp, k=smooth_kernel, total=0.0).problem, (n,)
        )
        applied, calls = large.applied, []
        large.applied = lambda v, applied=applied, calls=calls: calls.append(1) or applied(v)
        large.by_gmres()
        counts.append(len(calls))
    assert max(counts) <= 2 * min(counts) < 30


SMOOTH_KERNELS = [
    lambda x, t: 0.3, smooth_kernel, lambda x, t: np.cos(5.0 * x * t),
    lambda x, t: 1.0 / (1.0 + (x - t) ** 2),
    lambda x, t: 0.2j * np.exp(x),
    # 0/0 at x = t, as a periodic row has it
    lambda x, t: (0.5 / np.tan(0.5 * (t - x)) - 1.0 / (t - x)) / np.pi,
]  # fmt: skip


@pytest.mark.parametrize("k", range(len(SMOOTH_KERNELS)))
@pytest.mark.parametrize("g", [1.0, lambda x: 1.0 / (x - 1.2)], ids=["short", "long"])
def test_a_smooth_kernel_is_called_once_for_any_g(k, g):
    assert counted(SMOOTH_KERNELS[k], g=g)[0] == 1


@pytest.mark.parametrize(
    "intervals",
    [
        ((-1.0, 0.0), (0.01, 1.0)),
        ((-1.0, 0.0), (0.9, 2.0), (5.0, 5.5)),
        tuple((2.0 * i, 2.0 * i + 1.0) for i in range(20)),
    ],
)
def test_on_several_intervals_a_smooth_kernel_is_called_once(intervals):
    assert counted(lambda x, t: 0.1 * np.cos(0.3 * (x - t)), intervals, np.cos)[0] == 1


@pytest.mark.parametrize("height", [0.3, 0.1])
def test_a_narrow_kernel_is_called_twice(height):
    """The first grid's coefficients determine how fine the second must be."""
    count, density = counted(lambda x, t: height / ((t - x) ** 2 + height**2) / np.pi)
    assert count == 2
    assert density.n[0] < 25 / height


def test_a_kernel_without_a_short_series_is_called_once_for_each_size(monkeypatch):
    """A kink at x = t: after two grids in vain it is sampled at the nodes of every size that is
    tried.
    """
    tried, calls = [], []
    attempt = System.attempt
    monkeypatch.setattr(
        System, "attempt", lambda of, unknown: tried.append(of.sizes) or attempt(of, unknown)
    )
    monkeypatch.setattr(solver, "LARGEST", 200)

    def k(x, t):
        calls.append(x.shape)
        return 0.1 * np.abs(x - t)

    with pytest.raises(sie.ContactError, match="did not settle"):
        sie.CauchyEquation((-1.0, 1.0), 1.0, k=k, total=0.0).solve()
    assert len(calls) - 2 == len(tried) == len(set(tried)) > 5


@pytest.mark.parametrize(
    "k", [lambda x, t: np.cos(x * t) * np.exp(t), lambda x, t: 1.0 / ((x - t) ** 2 + 0.25)]
)
@pytest.mark.parametrize("tol", [1e-13, 1e-6])
def test_the_series_is_the_kernel_to_the_tolerance(k, tol):
    s, sigma = np.linspace(-1.0, 1.0, 101), np.linspace(-1.0, 1.0, 77)
    found = kernel.series(sie.CauchyEquation((0.0, 3.0), 1.0, k=k, total=0.0).problem, tol).at(
        [s], [sigma]
    )
    exact = k(1.5 + 1.5 * s[:, None], 1.5 + 1.5 * sigma)
    assert np.abs(found - exact).max() <= tol * np.abs(exact).max()


def test_a_series_that_agrees_on_its_grid_only_is_refused():
    """T_384 is T_0 at the 65 rows (aliases differ by multiples of 128), and differs between
    them.
    """
    problem = sie.CauchyEquation(
        (-1.0, 1.0), 1.0, k=lambda x, t: np.cos(384.0 * np.arccos(x)) + 0.0 * t, total=0.0
    ).problem
    assert kernel.series(problem, 1e-13) is None


def test_a_short_series_costs_few_nodes():
    assert sie.CauchyEquation((-1.0, 1.0), 1.0, total=0.0).solve().n == (formulation.SMALLEST,)


@pytest.mark.parametrize("a", [0.0, 0.2j])
def test_a_kernel_that_is_rough_in_t_only_is_detected(a):
    """The residual at the same nodes does not show it: k does not depend on x, so that any n solves
    its own equation exactly.
    """
    equation = sie.CauchyEquation(
        (-1.0, 1.0), 1.0, a=a, k=lambda x, t: np.cos(30.0 * t + 1.0), total=1.0
    )
    found, fine = equation.solve(), equation.solve(n=150)
    x = np.linspace(-0.9, 0.9, 7)
    assert found(x) == pytest.approx(fine(x), rel=1e-12)
    assert equation.solve(n=8).error > 1e-3
