"""Bracketed roots: each method finds a known root to its promise, in a bounded number of steps."""

import math

import numpy as np
import pytest

from sie.numerics import root_finding
from sie.numerics.root_finding import (
    Bracket,
    false_position,
    false_positions,
    increasing_root,
    logarithmic_root,
)

EPS = np.finfo(float).eps
INCREASING = {
    "line": (lambda u: u - 0.3, 0.3),
    "power": (lambda u: u**7 - 0.3**7, 0.3),
    "root": (lambda u: math.sqrt(u) - math.sqrt(0.3), 0.3),
    "steep": (lambda u: math.atan(1e9 * (u - 0.3)), 0.3),
    "jump": (lambda u: math.copysign(1.0, u - 0.3), 0.3),
    "near zero": (lambda u: math.log(u / 1e-100), 1e-100),
}


def counted(function):
    def count(u):
        count.calls += 1
        return function(u)

    count.calls = 0
    return count


@pytest.mark.parametrize("name", INCREASING)
def test_false_position_halves_its_bracket_down_to_rounding(name):
    function, root = INCREASING[name]
    count = counted(function)
    ends = function(1e-120), function(1.0)
    found = false_position(count, 1e-120, 1.0, ends, lambda *_: False)
    assert found == pytest.approx(root, rel=8 * EPS, abs=0.0)
    assert count.calls <= 2 * (450 if root < 1e-9 else 60)  # two steps for each halving


def test_false_position_ends_at_its_criterion():
    function, root = INCREASING["power"]
    found = false_position(
        function, 0.1, 1.0, (function(0.1), function(1.0)), lambda a, b, f: abs(f) < 1e-6
    )
    assert abs(function(found)) < 1e-6
    assert found != root


def test_false_positions_find_the_roots_of_all_brackets_in_which_a_function_falls():
    lo, hi = np.array([2.0, 5.0, 8.0, 14.0]), np.array([4.0, 7.0, 10.0, 17.0])  # of the sine
    found = false_positions(np.sin, lo, hi)
    assert found == pytest.approx(
        [math.pi, 3 * math.pi, 5 * math.pi], rel=root_finding.STEP_SETTLED
    )


@pytest.mark.parametrize("name", INCREASING)
@pytest.mark.parametrize("guess", [1e-3, 0.29, 0.9])
def test_an_increasing_function_s_root_is_found_from_any_guess(name, guess):
    function, root = INCREASING[name]
    assert increasing_root(function, guess, 1.0) == pytest.approx(root, rel=64 * EPS, abs=0.0)


@pytest.mark.parametrize("power", [0.1, 1.0, 7.0])
@pytest.mark.parametrize("guess", [1e-30, 1.0, 1e30])
def test_the_root_of_a_power_law_takes_three_steps(power, guess):
    count = counted(lambda u: (u**power, power * u**power))
    found = logarithmic_root(count, 2.0, guess, math.inf, lambda *_: AssertionError())
    assert found == pytest.approx(2.0 ** (1.0 / power), rel=root_finding.ROUGH**2)
    # one for the power, and those that the longest step takes to cross so many decades
    assert count.calls <= 3 + abs(math.log(guess)) / root_finding.MAX_LOG_STEP


def test_a_value_that_is_never_reached_is_an_error_with_the_best_value():
    def hill(u):
        return u / (1.0 + u * u), u * (1.0 - u * u) / (1.0 + u * u) ** 2

    def error(u, value):
        return ValueError(u, value)

    with pytest.raises(ValueError) as caught:
        logarithmic_root(hill, 0.6, 1e-3, 100.0, error)
    assert caught.value.args == pytest.approx((1.0, 0.5), rel=1e-3)


def test_a_bracket_gives_its_middle_for_a_place_out_of_bounds():
    bracket = Bracket((1.0, 0.0), (3.0, 0.0))
    assert bracket.place((5.0, 0.0), slow=False) == (2.0, 0.0)
    bracket.cut((1.5, 0.0), above=True)
    assert bracket.place((2.9, 0.0), slow=True) == (2.9, 0.0)  # only one bound is confirmed
    bracket.cut((2.5, 0.0), above=False)
    assert bracket.place((2.4, 0.0), slow=True) == (2.0, 0.0)
