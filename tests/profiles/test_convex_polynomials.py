"""Which polynomials are known to be convex, and what is then not looked for."""

import pytest

import sie


def of_curvature(*coefficients):
    """The polynomial with h'' = Σ coefficients[k] x^k, in an upright position."""
    return sie.Polynomial((0.0, 0.0, *(a / (k * (k - 1)) for k, a in enumerate(coefficients, 2))))


@pytest.mark.parametrize("root", [-1.0, 0.5])
@pytest.mark.parametrize(("rest", "known"), [(1e-9, True), (-1e-9, False)])
def test_a_lopsided_polynomial_is_known_to_be_convex_up_to_a_double_root(root, rest, known):
    """h'' = (x - root)² + rest, whose odd term has the even one on either side to itself."""
    assert of_curvature(root**2 + rest, -2.0 * root, 1.0).convex is known


@pytest.mark.parametrize(("a", "known"), [(1.41, True), (1.6, False), (-1.6, False)])
def test_an_even_term_between_two_odd_ones_outweighs_each_by_a_half_of_itself_only(a, known):
    """h'' = 1 + a x + x² + a x³ + x⁴ is negative near |x| = 1 from |a| = 1.5 on."""
    assert of_curvature(1.0, a, 1.0, a, 1.0).convex is known


@pytest.mark.parametrize("curvature", [(1.0, 0.1), (0.0, 1e-3, 1.0), (1.0, 0.0, -1e-3)])
def test_an_odd_term_without_an_even_one_on_each_side_is_not_known_to_be_convex(curvature):
    assert not of_curvature(*curvature).convex


def test_a_polynomial_known_to_be_convex_is_solved_without_a_look_at_its_slope(monkeypatch):
    looked, rises = [], sie.frictionless.rises
    counted = lambda *given: looked.append(1) or rises(*given)  # noqa: E731
    monkeypatch.setattr(sie.frictionless, "rises", counted)
    for first, scenes in ((0.3, 0), (3.0, 1)):
        profile = of_curvature(1.0, first, 1.0)
        solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=0.3))
        assert solution.check().ok and len(looked) == scenes
