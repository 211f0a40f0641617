"""What a Cauchy equation refuses, and what it has no answer to."""

import math
import re

import numpy as np
import pytest
from cauchy_cases import smooth_kernel

import sie
from sie.cauchy import solver

ILL_POSED = [
    ({"interval": ((-1, 1), (0.5, 2))}, r"\(-1.0, 1.0\) and \(0.5, 2.0\) overlap.*give them apart"),
    ({"interval": ((-1, 1), (1, 2))}, r"touch: give them as one, \(-1, 2\)"),
    ({"interval": ((2, 3), (0, 1))}, "from left to right"),
    ({"interval": (1.0, -1.0)}, "x1 < x2"),
    ({"interval": (0.0, np.nan)}, "finite ends"),
    ({"interval": ()}, "give a pair"),
    ({"interval": None}, "give a pair"),
    ({"interval": (-1e308, 1e308)}, "more than the largest double"),
    ({"a": 1.0, "b": 0.009}, "but a perturbation of a Fredholm equation; give b of at least a/100"),
    ({"b": 0.0}, "b = 0.*Fredholm"),
    ({"b": 5e-324}, "b = 4.94066e-324 is below the least normal double"),
    ({"interval": 10**400}, "beyond the range of doubles"),
    ({"interval": np.ma.array([-1.0, 1.0], mask=[0, 1])}, "interval has masked entries"),
    ({"a": 1j}, r"a² \+ b² = 0"),
    ({"a": np.nan}, "a is nan"),
    ({"b": np.inf}, "b = inf"),
    ({"a": "1"}, "a = '1' is not a number"),
    ({"a": 2j}, "exponents are imaginary: make both ends bounded"),
    ({"ends": "singulr"}, "each end is 'singular', 'bounded' or 'finite'"),
    ({"ends": ("singular", "free")}, "each end is 'singular', 'bounded' or 'finite'"),
    ({"ends": ("singular",) * 3}, "given for 3 intervals, but there are 1"),
    ({"ends": (None, "bounded")}, "ends are given for 2 intervals"),
    ({"total": None}, r"index 1 needs 1 side condition\(s\), but 0 given"),
    (
        {"moment": 1.0},
        r"needs 1 side condition\(s\), but 2 given: give as many of total and moment, or make "
        r"other ends",
    ),
    ({"ends": "bounded"}, r"index -1 needs 0 side condition\(s\), but 1 given"),
    ({"total": (0.0, 1.0)}, "total is given for 2 intervals, but there are 1"),
    ({"total": np.nan}, "total is nan"),
    ({"total": "x"}, "total = 'x' is not a number"),
    ({"free": 1.0}, "free = 1.0: give a sequence"),
    ({"g": None}, "g = None is not a number"),
    ({"g": np.nan}, "g is nan"),
    ({"g": [1.0, 2.0]}, r"g = .* is an array: give a function of an array x, or a number"),
    ({"k": 5}, "k = 5 is not a function"),
]


@pytest.mark.parametrize(("change", "sentence"), ILL_POSED, ids=[str(c) for c, _ in ILL_POSED])
def test_an_ill_posed_equation_is_refused_when_it_is_built(change, sentence):
    with pytest.raises(ValueError, match=sentence):
        sie.CauchyEquation(**{"interval": (-1.0, 1.0), "g": 1.0, "total": 0.0} | change)


WRONG_FUNCTIONS = [
    ({"g": lambda x: np.ones(3)}, r"g returned shape \(3,\) for x of shape"),
    (
        {"g": lambda x: np.where(x > 0, np.nan, x)},
        "g returned nan at x = .*finite inside the intervals",
    ),
    ({"g": lambda x: np.log(-x)}, "g returned"),
    ({"g": lambda x: "a"}, "g returned values of type"),
    ({"g": math.cos}, "g fails when called with an array .*NumPy's functions"),
    ({"k": lambda x: x}, "k fails when called with 2 arrays .*: make it a function of 2 arrays"),
    ({"k": lambda x, t: t if x > t else x}, "k fails when called with 2 arrays .*truth value"),
    ({"k": lambda x, t: np.ones(3)}, r"k returned shape \(3,\) for x and t of shape"),
    (
        {"k": lambda x, t: np.sqrt(x - t)},
        "k returned nan at x = .*, t = .*: a regular kernel is finite",
    ),
    ({"free": (lambda x: x[:2],), "moment": 1.0}, r"free\[0\] returned shape \(2,\)"),
]


@pytest.mark.parametrize(
    ("change", "sentence"), WRONG_FUNCTIONS, ids=[s for _, s in WRONG_FUNCTIONS]
)
def test_a_function_that_returns_invalid_values_is_refused(change, sentence):
    equation = sie.CauchyEquation(**{"interval": (-1.0, 1.0), "g": 1.0, "total": 0.0} | change)
    with pytest.raises(ValueError, match=sentence):
        equation.solve()


@pytest.mark.parametrize(
    ("bad", "said"),
    [
        ({"tol": 0.0}, "tol"),
        ({"tol": np.nan}, "tol"),
        ({"tol": "x"}, "tol"),
        ({"n": 1}, "give an integer >= 2"),
        ({"n": 2.5}, "give an integer >= 2"),
    ],
)
def test_a_wrong_tolerance_or_size_is_refused(bad, said):
    with pytest.raises(ValueError, match=said):
        sie.CauchyEquation((-1.0, 1.0), 1.0, total=0.0).solve(**bad)


@pytest.mark.parametrize("k", [None, lambda x, t: 0.0 * x * t])
def test_an_inconsistent_right_hand_side_is_refused_and_measured(k):
    """∫ g/sqrt(1 - x²) dx must vanish; g = x + 1e-3 misses it by the constant 1e-3."""
    with pytest.raises(
        sie.ContactError, match=r"not consistent.*constant of 1\.0e-03 times g; free a constant"
    ) as caught:
        sie.CauchyEquation((-1.0, 1.0), lambda x: x + 1e-3, k=k, ends="bounded").solve()
    x = np.array([-0.6, 0.8])
    # without the constant: the density of g = x
    assert caught.value.reached["density"](x) == pytest.approx(-np.sqrt(1 - x * x), rel=1e-13)


def test_conditions_that_depend_on_each_other_are_refused():
    with pytest.raises(sie.ContactError, match="homogeneous form has a solution"):
        sie.CauchyEquation(
            (-1.0, 1.0), 0.0, ends="bounded", total=1.0, moment=0.0, free=(1.0, 1.0, 1.0)
        ).solve()


def noisy(x):
    """exp with noise of 1e-9 that depends on every digit of x."""
    return np.exp(x) + 1e-9 * np.sin(1e9 * x)


@pytest.mark.parametrize("k", [None, smooth_kernel])
@pytest.mark.parametrize(("g", "error"), [(noisy, 1e-7), (np.abs, 1e-2)])
def test_a_density_that_does_not_settle_is_refused_with_the_best_one(g, error, k, monkeypatch):
    monkeypatch.setattr(solver, "LARGEST", 400)
    equation = sie.CauchyEquation((-1.0, 1.0), g, k=k, total=0.0)
    with pytest.raises(
        sie.ContactError, match=r"did not settle to tol = 1\.0e-13.*raise tol"
    ) as caught:
        equation.solve()
    best = caught.value.reached["density"]
    assert 1e-13 < best.error < error
    x = np.linspace(-0.95, 0.95, 39)
    reference = sie.CauchyEquation((-1.0, 1.0), np.exp if g is noisy else g, k=k, total=0.0).solve(
        n=60 if g is noisy else 700
    )
    assert np.abs(best(x) - reference(x)).max() <= error * np.abs(reference(x)).max()
    assert equation.solve(tol=10.0 * best.error).error <= 10.0 * best.error


ROUGH = {
    "log": lambda x, t: np.log(np.abs(x - t)),
    "kink": lambda x, t: np.abs(x - t),
    "root": lambda x, t: np.abs(x - t) ** -0.5,
    "jump": lambda x, t: np.sign(x - t),
}


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("k", ROUGH.values(), ids=ROUGH)
def test_a_kernel_with_a_kink_or_a_weak_singularity_is_refused_with_a_tolerance_that_is_met(k):
    equation = sie.CauchyEquation((-1.0, 1.0), 1.0, k=k, total=0.0)
    with pytest.raises(sie.ContactError, match=r"did not settle.*FromFunction") as caught:
        equation.solve()
    tol = float(re.search(r"raise tol to ([\d.e-]+)", str(caught.value))[1])
    assert equation.solve(tol).error <= tol


def test_infinite_and_vanishing_ends_are_told_apart():
    """Of φ = 1/(π sqrt(1 - x²)), 0 and sqrt(1 - x²); none of it is nan."""
    x = np.array([-1.0, 1.0])
    punch = sie.CauchyEquation((-1.0, 1.0), 0.0, total=1.0).solve()
    assert (punch(x) == np.inf).all()
    assert (punch.cauchy(x, side=-1).imag == np.inf).all()
    assert (sie.CauchyEquation((-1.0, 1.0), 0.0, total=0.0).solve()(x) == 0.0).all()
    assert (sie.CauchyEquation((-1.0, 1.0), lambda x: x, ends="bounded").solve()(x) == 0.0).all()
    shear = sie.CauchyEquation((-1.0, 1.0), 0.0, a=0.3j, total=1j).solve()
    assert np.isinf(shear(x)).all()
    almost = sie.CauchyEquation(
        (-1.0, 1.0), 1.0, a=1e2, ends="bounded", free=(lambda x: x,)
    ).solve()
    assert (almost(x) == 0.0).all() and np.isfinite(almost.cauchy(x)).all()
    for side in (-1, 0, 1):
        assert not np.isnan(shear.cauchy(x, side=side)).any()
