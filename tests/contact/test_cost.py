"""What an answer costs, in counts that no machine changes."""

from contextlib import contextmanager
from unittest.mock import patch

import numpy as np
import pytest

import sie
from sie.contact import normal, pressure
from sie.numerics import chebyshev
from sie.patches import answer, newton
from sie.traction.of_slope import SlopeDensity

PUNCH = sie.RoundedFlat(0.5, 1.0)
SINH = sie.FromFunction(np.sinh, domain=(-30.0, 30.0), parity="even")
X = np.linspace(-0.4, 0.4, 1001)
# The most transforms: one a step, and one more for each size of a series that is tried.
SMOOTH = (
    (SINH, {"normal_load": None, "half_width": 1.5}, 2),
    (SINH, {"normal_load": 1.0}, 8),
    (sie.FromFunction(np.sinh), {"normal_load": 1.0}, 8),
    (sie.FromFunction(np.sinh, domain=(-3.0, 3.0)), {"normal_load": 1.0, "tilt": 0.1}, 8),
    (sie.FromFunction("x + x**3/5 + 0.1*x**2"), {"normal_load": None, "half_width": 0.7}, 6),
)


@contextmanager
def counted(module, name):
    """How often a function of a module is called."""
    function, calls = getattr(module, name), []

    def counting(*args, **given):
        calls.append(1)
        return function(*args, **given)

    with patch.object(module, name, counting):
        yield calls


def scene(profile, **given):
    return sie.Scene(profile=profile, modulus=1.0, poisson=0.3, **{"normal_load": 0.3, **given})


@pytest.mark.parametrize(
    ("profile", "most"),
    [
        *((sie.RoundedFlat(a, 1.0), 1) for a in (1e-9, 0.5, 1e6)),
        (sie.Parabola(1.0).shifted(0.3), 1),
        (sie.Wedge(0.3), 2),
        (sie.Polynomial((0.0, 0.0, 0.0, 0.0, 1.0)), 2),
    ],
)
def test_the_edges_of_a_symmetric_profile_take_a_few_evaluations(profile, most):
    assert sie.solve(scene(profile)).normal.edges.evaluations <= most


def test_patches_are_sought_where_the_slope_of_a_function_falls():
    convex, wavy = (
        sie.FromFunction(np.sinh, domain=(-3.0, 3.0)),
        sie.FromFunction("x + 0.3*sin(6*x)", domain=(-3.0, 3.0)),
    )
    for profile, number in ((convex, 0), (wavy, 1)):
        with counted(answer, "several_patches") as searches:
            assert sie.solve(scene(profile, normal_load=2.0)).half_width > 0.0
        assert len(searches) == number


def test_the_grid_shows_all_indenters_of_a_long_row():
    row = sie.Row([sie.Parabola(1.0).shifted(3.0 * k) for k in range(100)])
    with counted(newton, "solve") as searches:
        assert len(sie.solve(scene(row, normal_load=10.0)).patches) == 100
    assert len(searches) == 1


@pytest.mark.parametrize(("profile", "given", "most"), SMOOTH)
def test_a_smooth_function_takes_one_transform_a_step_and_no_pieces(profile, given, most):
    with (
        counted(normal, "refined") as searched,
        counted(pressure, "refined") as resolved,
        counted(chebyshev, "transform") as transforms,
    ):
        _ = sie.solve(scene(profile, **given)).pressure(X)
    assert not searched and not resolved
    assert len(transforms) <= most


def places_for_a_certificate(turns):
    """The number of points where the certificate after so many turning points needs tractions."""
    path = sie.Path([(0.3, 0.14 * (1.0 - k / turns) * (-1.0) ** k) for k in range(turns)])
    solved = sie.follow(scene(PUNCH, friction=0.5), path)[-1]
    _, value, places = solved.shear, SlopeDensity.__call__, []

    def counting(density, x):
        places.append(np.size(x))
        return value(density, x)

    with patch.object(SlopeDensity, "__call__", counting):
        solved.check()
    return sum(places)


def test_the_certificate_of_a_long_path_is_linear_in_its_turning_points():
    assert places_for_a_certificate(80) <= 3 * places_for_a_certificate(40)


def calls_for(jumps):
    """How often a slope with so many undeclared jumps, one of them at x = 0, is called."""
    places, calls = np.linspace(-0.3, 0.3, jumps), []

    def slope(x):
        calls.append(1)
        return x + 0.01 * np.sign(x[..., None] - places).sum(axis=-1)

    assert sie.solve(scene(sie.FromFunction(slope))).half_width > 0.0
    return len(calls)


@pytest.mark.slow
def test_jumps_are_looked_for_all_at_once():
    assert calls_for(41) <= 2 * calls_for(5)
