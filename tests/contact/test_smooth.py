"""A slope that is one Chebyshev series in the contact, against the search by pieces."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sie
from sie.problem.request import ECONOMY

INF = float("inf")
BY_PIECES = ECONOMY - {"transform"}
SLOPES = {
    "sinh": np.sinh,
    "cubic": lambda x: x + x**3 / 5,
    "lopsided": lambda x: np.expm1(0.7 * x) + 0.2 * x,
    "beside": lambda x: (x - 2.0) + (x - 2.0) ** 3,
    "square root": lambda x: x / np.sqrt(1.0 + 0.2 * x * x),
    "fifth": lambda x: x**5 + 1e-3 * x,
}


def pair(profile, **given):
    scene = sie.Scene(profile=profile, modulus=2.0, **given)
    return sie.solve(scene), sie.solve(scene, economy=BY_PIECES)


def agree(one, other):
    x = np.linspace(*other.edges, 103)[1:-1]
    p = other.pressure(x)
    farthest = other.half_width + abs(other.centre)
    assert one.edges == pytest.approx(other.edges, abs=2e-14 * farthest)
    assert np.abs(one.pressure(x) - p).max() <= 2e-13 * p.max()
    assert one.normal_load == pytest.approx(other.normal_load, rel=1e-13)
    assert one.moment == pytest.approx(other.moment, abs=1e-13 * other.normal_load * farthest)


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("name", SLOPES)
@pytest.mark.parametrize("domain", [(-INF, INF), (-30.0, 30.0), (-6.0, 5.0)])
@given(size=st.floats(-2.0, 0.7), by_load=st.booleans(), tilt=st.sampled_from([0.0, 0.1, -0.3]))
def test_the_series_finds_what_the_pieces_find(name, domain, size, by_load, tilt):
    profile = sie.FromFunction(SLOPES[name], domain=domain)
    asked = {"normal_load": 10.0**size} if by_load else {"half_width": 10.0 ** min(size, 0.0)}
    one, other = pair(profile, tilt=tilt, **asked)
    try:
        _ = other.edges
    except sie.ContactError as error:
        with pytest.raises(type(error)):
            _ = one.edges
        return
    agree(one, other)


@pytest.mark.parametrize("given", [{"normal_load": 1.0}, {"half_width": 1.5}])
def test_an_even_slope_keeps_its_contact_symmetric_to_the_last_bit(given):
    solution = sie.solve(
        sie.Scene(profile=sie.FromFunction(np.sinh, parity="even"), modulus=2.0, **given)
    )
    assert solution.normal.symmetric
    assert solution.edges[0] == -solution.edges[1]
    assert solution.moment == 0.0


def test_a_series_is_certified():
    for name, slope in SLOPES.items():
        solution = sie.solve(
            sie.Scene(profile=sie.FromFunction(slope), modulus=2.0, normal_load=0.7)
        )
        assert solution.normal.series is not None, name
        assert solution.check().ok, name


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(
    ("slope", "domain"),
    [
        (lambda x: x + 1e-3 * np.sign(x - 0.2), (-3.0, 3.0)),  # a jump
        (lambda x: x + 0.1 * np.abs(x - 0.2), (-3.0, 3.0)),  # a kink
        (lambda x: x + 0.3 * np.sin(6.0 * x), (-3.0, 3.0)),  # a slope that falls
        (np.sinh, (-1.0, 0.5)),  # a contact that reaches an end
    ],
)
def test_a_contact_that_is_not_smooth_is_left_to_the_pieces(slope, domain):
    solution = sie.solve(
        sie.Scene(profile=sie.FromFunction(slope, domain=domain), modulus=2.0, normal_load=4.0)
    )
    assert solution.normal.series is None
    assert solution.check().force < 1e-12


def test_the_rounding_of_a_slope_is_no_reason_to_refuse_its_series():
    slope = lambda x: np.exp(0.05 * x) - 1.0  # noqa: E731
    solution = sie.solve(sie.Scene(profile=sie.FromFunction(slope), modulus=2.0, half_width=0.02))
    assert solution.normal.series is not None
    assert solution.check().error < 1e-12
