"""Corners of the profile in narrow slip zones of dissimilar bodies.

The next double after the corner may be as far as 1e-9 of the slip zone. Distances between such
doubles are exact, and nothing else may count.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import chebyshev

import sie
from sie.friction.coupled.flat import flat_punch

CORNER = 0.4
JUMPS = sie.Piecewise((-9.0, -0.4, 0.4, 9.0), ((-0.4, 2.0), (0.0, 1.0), (0.4, 2.0)))
WEDGES = sie.Piecewise((-9.0, -0.4, 0.0, 0.4, 9.0), ((-0.3,), (-0.1,), (0.1,), (0.3,)))


def contact_beyond(profile, beta, friction, part):
    """The contact whose edge is so many slip zones beyond the corner, and such a zone's width."""
    width = CORNER * flat_punch(beta, friction).modulus.rest
    scene = sie.Scene(
        profile=profile,
        modulus=2.0,
        dundurs=beta,
        friction=friction,
        half_width=CORNER + part * width,
    )
    return sie.solve(scene).coupled[1], width


def slope_beside(contact, x, width):
    """∫P' D(x/s) ds/s over s < x by the double exponential rule, on parts that shrink to x.

    P' goes with the power -0.81 of the distance from a corner under the largest β f: of 1e-100 of
    a part 1e-19 of the integral remains.
    """
    t = np.linspace(-5.0, 5.0, 201)
    part, rest = 1.0 / (1.0 + np.exp(-np.pi * np.sinh([t, -t])))
    dx = 0.05 * np.pi * np.cosh(t) * part * rest
    cuts = np.append(0.0, width * 10.0 ** np.arange(-4.0, 8.0))
    total = 0.0
    for panel in contact.growth:
        end = min(panel.hi, x) - panel.lo
        inside = np.concatenate((x - panel.lo - cuts, CORNER - panel.lo + cuts))
        ends = np.unique([0.0, *inside[(inside > 0.0) & (inside < end)], max(end, 0.0)])
        for lo, hi in pairwise(ends):
            ahead, left = lo + (hi - lo) * part, (x - panel.lo - hi) + (hi - lo) * rest
            D = contact.flat.outside((panel.lo + ahead) / x, left / x)
            total += float(D @ (panel(ahead) * (hi - lo) * dx))
    return total / x


@pytest.mark.parametrize("case", [(JUMPS, 0.3, 5.0, 0.9), (WEDGES, 0.1, 0.6, 0.5)])
@pytest.mark.parametrize("beyond", [0.03, 0.2, 0.83])
def test_surfaces_beside_a_contact_that_ends_next_to_a_corner_have_its_slope(case, beyond):
    contact, width = contact_beyond(*case)
    x = CORNER + beyond * (contact.b - CORNER)
    slope = case[0].slope(np.array([x]))[0]
    assert slope_beside(contact, x, width) == pytest.approx(slope, rel=1e-12)


@pytest.mark.parametrize(
    ("case", "place", "span"),
    [
        ((JUMPS, 0.3, 5.0, 0.9), 0.0178, 0.006),
        ((JUMPS, 0.3, 5.0, 0.5), -0.9985, 0.0004),
        ((WEDGES, 0.1, 0.6, 1e-3), -0.178, 0.01),
    ],
)
def test_tractions_next_to_a_corner_are_smooth_from_double_to_double(case, place, span):
    contact, width = contact_beyond(*case)
    y = CORNER + width * (place + span * np.linspace(0.0, 1.0, 40))
    t = 2.0 * (y - y[0]) / (y[-1] - y[0]) - 1.0
    for values in contact.pressure_and_shear(y):
        smooth = chebyshev.chebval(t, chebyshev.chebfit(t, values, 14))
        assert values == pytest.approx(smooth, rel=1e-12)
