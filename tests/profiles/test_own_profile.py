"""A profile class of one's own, which states its slope alone."""

import numpy as np
import pytest
from faceted import Faceted

import sie


def test_a_height_that_a_class_does_not_state_is_the_integral_of_its_slope():
    """At the corners the polygon is the parabola, but for what its middle is higher."""
    x = np.array([-np.inf, -20.0, -0.5, -0.25, 0.0, 0.0625, 0.375, 12.5, np.nan])
    h = [np.inf, np.inf, 0.0625, 0.015625, 0.0, 0.001953125, 0.03515625, 39.0625, np.nan]
    assert Faceted(2.0, 0.125).height(x) == pytest.approx(h, rel=1e-14, nan_ok=True)


def test_short_facets_press_like_the_parabola_of_hertz():
    """b = sqrt(4 P R/(π E*)), and the difference falls faster than the length of a facet."""
    missed = []
    for facet in (0.05, 0.0125):
        scene = sie.Scene(profile=Faceted(1.0, facet), modulus=1.0, normal_load=np.pi / 16.0)
        solution = sie.solve(scene)
        assert solution.check().ok
        missed.append(abs(solution.half_width / 0.5 - 1.0))
    assert 0.0 < missed[0] < 0.05
    assert missed[1] < 0.25 * missed[0]
