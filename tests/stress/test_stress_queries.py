"""Invariants of the stress, what is computed when it is asked for, and bad questions."""

import tracemalloc

import numpy as np
import pytest
from stress_cases import PUNCH, STEEL, sliding

import sie


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_invariants_are_those_of_the_matrix_of_components(plane):
    body = sie.Elastic(210e3, 0.3, plane)
    solution = sliding(sie.Scene(profile=sie.RoundedFlat(1.0, 50.0), body=body, normal_load=500.0))
    s = solution.stress(np.array([0.0, 0.7, -1.2, 3.0]), np.array([0.0, 0.3, 0.1, 2.0]))
    for k in range(4):
        matrix = np.array([[s.xx[k], s.xy[k], 0.0], [s.xy[k], s.yy[k], 0.0], [0.0, 0.0, s.zz[k]]])
        deviator = matrix - np.trace(matrix) / 3.0 * np.eye(3)
        principal = np.linalg.eigvalsh(matrix)[::-1]
        assert s.j2[k] == pytest.approx(0.5 * (deviator**2).sum(), rel=1e-12)
        assert s.mises[k] == pytest.approx(np.sqrt(1.5 * (deviator**2).sum()), rel=1e-12)
        assert [p[k] for p in s.principal] == pytest.approx(principal, rel=1e-11, abs=1e-10)
        assert s.max_shear[k] == pytest.approx(0.5 * (principal[0] - principal[2]), rel=1e-11)


BONDED = sie.Scene(
    profile=sie.Flat(0.8), body=sie.Elastic(3.0, 0.2), indenter=sie.Elastic(40.0, 0.3),
    normal_load=2.0, friction=np.inf,
)  # fmt: skip
RUBBER = sie.Elastic(210e3, 0.5)
INFINITE = {
    "wedge": sie.solve(sie.Scene(profile=sie.Wedge(0.2), body=STEEL, normal_load=9.0)),
    "sharp edges": sie.solve(sie.Scene(profile=sie.Flat(1.0), body=STEEL, normal_load=9.0)),
    "wedge, sheared": sliding(sie.Scene(profile=sie.Wedge(0.2), body=STEEL, normal_load=9.0)),
    "incompressible": sliding(sie.Scene(profile=sie.Flat(1.0), body=RUBBER, normal_load=9.0)),
    "bonded": sie.solve(BONDED),
}


@pytest.mark.parametrize("solution", INFINITE.values(), ids=INFINITE)
def test_where_a_traction_is_infinite_nothing_is_nan(solution):
    s = solution.surface_stress(np.array([*solution.edges, 0.0]))
    for values in (*s, s.j2, s.mises, s.max_shear, *s.principal, *s.strain, *s.gradients):
        assert not np.isnan(values).any()


def test_a_million_points_hold_at_most_ten_arrays_of_that_size():
    solution = sliding(PUNCH)
    x, y = np.linspace(-2, 2, 1000), np.linspace(0, 3, 1000)[:, None]
    solution.stress(0.1, 0.1).mises  # noqa: B018
    tracemalloc.start()
    solution.stress(x, y).mises  # noqa: B018
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most <= 10 * 8e6


@pytest.mark.parametrize(
    ("x", "y", "words"),
    [
        (0.0, -0.1, "y = -0.1 is above the surface"),
        (np.nan, 0.1, "x = nan is not finite"),
        (0.0, np.inf, "y = inf"),
        ("a", 0.0, "x is not"),
    ],
)
def test_bad_points_are_refused(x, y, words):
    with pytest.raises(ValueError, match=words):
        sie.solve(PUNCH).stress(x, y)


def test_a_quantity_that_needs_an_elastic_constant_is_refused_without_it():
    s = sie.solve(sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, half_width=1.0)).stress(
        0.0, 0.5
    )
    assert np.isfinite(s.xx)
    with pytest.raises(ValueError, match="Poisson's ratio"):
        s.mises  # noqa: B018
    with pytest.raises(ValueError, match="elastic constants of the body"):
        s.strain  # noqa: B018


def test_the_stress_in_a_rigid_body_is_refused():
    scene = sie.Scene(profile=sie.Parabola(1.0), body=sie.RIGID, indenter=STEEL, half_width=0.1)
    with pytest.raises(sie.ContactError, match="rigid"):
        sie.solve(scene).stress(0.0, 0.1)
