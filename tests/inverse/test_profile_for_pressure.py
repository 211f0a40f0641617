"""The profile for a wanted pressure, solved again, has that pressure."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator
from scipy.special import beta

import sie

E = 2.0
S = np.linspace(-0.99, 0.99, 41)
ELLIPSE = np.pi / 2.0


def ellipse(x):
    return np.sqrt((1.0 - x) * (1.0 + x))


def solved(profile, load):
    return sie.solve(sie.Scene(profile=profile, modulus=E, normal_load=load))


@pytest.mark.parametrize(
    ("p", "load"),
    [
        (ellipse, ELLIPSE),
        (lambda x: np.sqrt(1.0 - x**8), 0.25 * beta(0.125, 1.5)),
        (lambda x: (2.0 + x) * ellipse(x), 2.0 * ELLIPSE),
    ],
    ids=["Hertz", "eighth power", "lopsided"],
)
def test_round_trip(p, load):
    found = solved(sie.profile_for_pressure(p, half_width=1.0, modulus=E), load)
    assert found.edges == pytest.approx((-1.0, 1.0), abs=1e-12)
    assert found.pressure(S) == pytest.approx(p(S), abs=1e-12)
    assert found.check().ok


def test_of_hertz_the_profile_is_a_parabola():
    pad = sie.profile_for_pressure(lambda x: 3.0 * ellipse(x - 4.0), domain=(3.0, 5.0), modulus=6.0)
    assert pad.slope(4.0 + S) == pytest.approx(S, abs=1e-12)


def test_of_an_even_pressure_it_is_lundbergs_roller():
    roller = sie.profile_for_pressure(lambda x: 0.0 * x + 0.5, half_width=1.0, modulus=E)
    assert roller.slope(S) == pytest.approx(
        np.log((1.0 + S) / (1.0 - S)) / (2.0 * np.pi), abs=1e-14
    )
    assert solved(roller, 1.0).pressure(S) == pytest.approx(0.5, abs=1e-11)


def test_a_table_is_met_at_its_points_and_joined_by_monotone_cubics_of_the_angle():
    angle = np.linspace(0.0, np.pi, 13)
    x = -np.cos(angle)
    p = (2.0 + x) * np.sin(angle)
    found = solved(sie.profile_for_pressure((x, p), modulus=E), _load_of_table(angle, p))
    assert found.edges == pytest.approx((-1.0, 1.0), abs=1e-11)
    assert found.pressure(x[1:-1]) == pytest.approx(p[1:-1], abs=1e-11)


def _load_of_table(angle, p):
    g, w = np.polynomial.legendre.leggauss(20)
    t = (angle[:-1] + 0.5 * np.diff(angle) * (1.0 + g[:, None])).T
    values = PchipInterpolator(angle, p)(t) * np.sin(t)
    return float((values @ w * 0.5 * np.diff(angle)).sum())


@pytest.mark.slow
def test_round_trip_of_two_patches():
    def p(x):
        right = 0.7 * np.sqrt(np.maximum((x - 2.0) * (3.0 - x), 0.0))
        return np.where(x < 1.5, np.sqrt(np.maximum((1.0 - x) * (1.0 + x), 0.0)), right)

    pads = sie.profile_for_pressure(p, domain=[(-1.0, 1.0), (2.0, 3.0)], modulus=E)
    found = solved(pads, ELLIPSE + 0.7 * np.pi / 8.0)
    x = np.concatenate((S, 2.5 + 0.5 * S))
    assert np.ravel(found.patches) == pytest.approx([-1.0, 1.0, 2.0, 3.0], abs=1e-12)
    assert found.pressure(x) == pytest.approx(p(x), abs=1e-12)


@pytest.mark.parametrize(
    ("p", "given", "what"),
    [
        (lambda x: x, {"half_width": 1.0}, "tension"),
        (ellipse, {}, "exactly one"),
        (ellipse, {"half_width": 1.0, "domain": (-1.0, 1.0)}, "exactly one"),
        (ellipse, {"domain": (1.0, -1.0)}, "no contact"),
        (1.0, {"half_width": 1.0}, "not a function"),
        (([0.0, 1.0], [1.0]), {}, "no table"),
        (([1.0, 0.0], [1.0, 1.0]), {}, "do not ascend"),
        ((S, S + 1.0), {"half_width": 1.0}, "from edge to edge"),
    ],
)
def test_what_is_no_pressure_is_refused(p, given, what):
    with pytest.raises(ValueError, match=what):
        sie.profile_for_pressure(p, modulus=E, **given)
