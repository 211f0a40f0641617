"""Cauchy equations: index, side conditions, sizes, conditioning."""

import numpy as np
import pytest
from cauchy_cases import counted, smooth_kernel

import sie

SINGULAR, BOUNDED = "singular", "bounded"
KINDS = [(SINGULAR, SINGULAR), (SINGULAR, BOUNDED), (BOUNDED, SINGULAR), (BOUNDED, BOUNDED)]


def index_of(pair):
    return 1 - pair.count(BOUNDED)


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


@pytest.mark.parametrize("a", [0.0, 0.3, 0.2j])
@pytest.mark.parametrize("ends", KINDS)
def test_the_condition_number_of_a_smooth_kernel_is_small_and_does_not_grow(ends, a):
    total = 0.0 if index_of(ends) == 1 else None
    given = {"a": a, "k": smooth_kernel, "ends": ends, "total": total}
    equation = sie.CauchyEquation((-1.0, 1.0), 1.0, **given)
    conditions = [np.linalg.cond(equation.system(n)[0]) for n in (8, 32, 128)]
    assert max(conditions) < 6.0
    assert conditions[2] == pytest.approx(conditions[1], rel=1e-6)


SMOOTH_KERNELS = [
    lambda x, t: 0.3, smooth_kernel, lambda x, t: np.cos(5.0 * x * t),
    lambda x, t: 1.0 / (1.0 + (x - t) ** 2),
    lambda x, t: 0.2j * np.exp(x),
    # 0/0 at x = t, as a periodic row has it
    lambda x, t: (0.5 / np.tan(0.5 * (t - x)) - 1.0 / (t - x)) / np.pi,
]  # fmt: skip


@pytest.mark.parametrize("k", range(len(SMOOTH_KERNELS)))
@pytest.mark.parametrize("g", [1.0, lambda x: 1.0 / (x - 1.2)], ids=["short", "long"])
def test_all_calls_of_a_kernel_ask_for_about_twice_the_values_of_the_last(k, g):
    asked, _ = counted(SMOOTH_KERNELS[k], g=g)
    assert sum(asked) < 2.5 * asked[-1]


@pytest.mark.parametrize("height", [0.3, 0.1])
def test_a_narrow_kernel_takes_as_many_nodes_as_its_width_asks_for(height):
    asked, density = counted(lambda x, t: height / ((t - x) ** 2 + height**2) / np.pi)
    assert density.n[0] < 25 / height
    assert sum(asked) < 2.5 * asked[-1]


@pytest.mark.parametrize("a", [0.0, 0.2j])
def test_a_kernel_that_is_rough_in_t_only_is_detected(a):
    """As k does not depend on x, any n solves its own equation exactly: no residual shows it."""
    equation = sie.CauchyEquation(
        (-1.0, 1.0), 1.0, a=a, k=lambda x, t: np.cos(30.0 * t + 1.0), total=1.0
    )
    found, fine = equation.solve(), equation.solve(n=150)
    x = np.linspace(-0.9, 0.9, 7)
    assert found(x) == pytest.approx(fine(x), rel=1e-12)
    assert equation.solve(n=8).error > 1e-3
