"""Polynomial pieces of a slope about other origins."""

from fractions import Fraction

import numpy as np
from hypothesis import given
from strategies import between

from sie.numerics.interval import recentred


@given(between(0.1, 10.0), between(-50.0, 50.0), between(-50.0, 50.0))
def test_another_origin_takes_nothing_from_a_straight_piece(rise, level, place):
    """(c + t) + (d + u)(x - o) is the same at every x, with t and u what c and d leave out."""
    c, tails = np.array([[level, rise]]), np.array([[1e-17 * level, 1e-17 * rise]])
    moved, rest = recentred(c, tails, np.array([0.5]), np.array([place]))

    def at_zero(c, tails, origin):
        (level, rise), (t, u) = (map(Fraction, row[0].tolist()) for row in (c, tails))
        return level + t - (rise + u) * Fraction(origin)

    lost = at_zero(moved, rest, place) - at_zero(c, tails, 0.5)
    assert abs(lost) <= Fraction(2) ** -98 * 1000
