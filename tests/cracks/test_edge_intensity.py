"""The two intensities of an edge, against closed forms, load derivatives and the whole contact."""

import math

import pytest

import sie

LOAD, MODULUS, FRICTION = 0.3, 2.0, 0.4
PROFILES = [
    sie.Parabola(3.0),
    sie.RoundedFlat(1.0, 5.0),
    sie.Power(4.0, 0.1),
    sie.Wedge(0.1),
    sie.FromFunction("0.5*sinh(x)"),
]


def solved(profile, **more):
    scene = {"modulus": MODULUS, "normal_load": LOAD, "friction": FRICTION}
    return sie.solve(sie.Scene(profile=profile, **{**scene, **more}))


def test_the_edge_of_a_cylinder():
    s = solved(sie.Parabola(3.0))
    b, p0 = s.half_width, 2.0 * LOAD / (math.pi * s.half_width)
    for side in ("left", "right"):
        edge = s.edge_intensity(side)
        assert edge.normal == pytest.approx(p0 * math.sqrt(2.0 / b), rel=1e-12)
        # K_N sqrt(s) over p is 1/sqrt(1 - s/(2b))
        held = [2.0 * b * (1.0 - 1.0 / (1.0 + part) ** 2) for part in (0.01, 0.1)]
        assert edge.reach == pytest.approx(held, rel=1e-5)
        assert not edge.sharp and edge.tangential == 0.0 == edge.slip_length


def test_a_sharp_edge():
    edge = solved(sie.Flat(2.0), tangential_load=0.5 * FRICTION * LOAD).edge_intensity("left")
    assert edge.sharp and edge.slip_length == 0.0
    assert edge.normal == pytest.approx(LOAD / math.pi / 2.0, rel=1e-12)
    assert edge.tangential == pytest.approx(0.5 * FRICTION * edge.normal, rel=1e-12)


@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: type(p).__name__)
def test_the_normal_intensity_is_the_rate_of_the_load(profile):
    # dp = dP/(π sqrt(b² - x²)) as the edge moves: K_N = sqrt(2/b) P'(b)/π
    b, h = solved(profile).half_width, 1e-5
    ends = [
        sie.solve(sie.Scene(profile=profile, modulus=MODULUS, half_width=b * (1.0 + k * h)))
        for k in (-1.0, 1.0)
    ]
    rate = (ends[1].normal_load - ends[0].normal_load) / (2.0 * b * h)
    expected = math.sqrt(2.0 / b) * rate / math.pi
    assert solved(profile).edge_intensity("right").normal == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: type(p).__name__)
def test_the_slip_zone_of_the_edge_is_that_of_the_contact_as_it_becomes_short(profile):
    off = []
    for share in (1e-2, 1e-3):
        s = solved(profile, tangential_load=share * FRICTION * LOAD)
        off.append(abs(s.edge_intensity("left").slip_length / s.slip_widths[0] - 1.0))
    assert off[0] <= 5e-3
    assert off[1] <= 0.11 * off[0] or off[1] <= 1e-12


def test_cattaneo_in_closed_form():
    s = solved(sie.Parabola(3.0), tangential_load=0.2 * FRICTION * LOAD)
    d, b = s.edge_intensity("left").slip_length, s.half_width
    assert d == pytest.approx(0.1 * b, rel=1e-12)  # Q b/(2 f P)
    assert b * (1.0 - math.sqrt(0.8)) == pytest.approx(s.slip_widths[0], rel=1e-12)


def test_a_bulk_stress_pulls_the_edges_apart():
    s = solved(sie.Parabola(3.0), bulk_stress=1e-3)
    left, right = (s.edge_intensity(side).tangential for side in ("left", "right"))
    assert left == pytest.approx(1e-3 / 4.0 * math.sqrt(s.half_width / 2.0), rel=1e-12)
    assert right == -left


@pytest.mark.parametrize(
    ("profile", "more", "word"),
    [
        (sie.Parabola(3.0), {"dundurs": 0.2}, "other powers"),
        (sie.Row([sie.Parabola(1.0).shifted(x) for x in (-1.0, 1.0)]), {}, "2 patches"),
    ],
)
def test_edges_that_are_of_another_kind_are_refused(profile, more, word):
    with pytest.raises(sie.ContactError, match=word):
        solved(profile, **more).edge_intensity("left")
    with pytest.raises(ValueError, match="left"):
        solved(profile, **more).edge_intensity("trailing")
