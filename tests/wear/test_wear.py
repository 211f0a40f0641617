"""The limit of fretting wear and the modes of sliding wear, against closed forms and Galin."""

import math

import numpy as np
import pytest

import sie
from oracles.worn_parabola import worn_parabola

HERTZ = {"profile": sie.Parabola(1.0), "modulus": 1.0, "friction": 0.5}
LOAD = math.pi / 4.0  # of half-width 1


def of_parabola(ratio, **more):
    Q = ratio * 0.5 * LOAD
    return sie.wear_limit(sie.Scene(**HERTZ, normal_load=LOAD, tangential_load=Q), **more)


@pytest.mark.parametrize("ratio", [0.2, 0.6, 0.9])
def test_a_worn_cylinder_is_exact(ratio):
    worn, exact = of_parabola(ratio), worn_parabola(ratio)
    deepest = math.sqrt((1.0 + exact.stick**2) / 2.0)
    found = [worn.stick[1], 2.0 * worn.pressure(0.0), worn.worn[1]]
    found += [worn.depth(deepest), worn.volume]
    assert np.abs(np.array(found, float) / np.array(exact, float) - 1.0).max() <= 1e-12
    assert worn.worn[0] == pytest.approx(-worn.worn[1], rel=1e-14)
    assert worn.check().ok


PADS = {
    "rounded flat": {"profile": sie.RoundedFlat(1.0, 5.0)},
    "tilted": {"profile": sie.FromFunction("0.1*sinh(x)").shifted(0.3), "tilt": 0.01},
    "bulk stress": {"profile": sie.Power(4.0, 0.1), "bulk_stress": 0.02},
    "unsymmetric": {"profile": sie.Polynomial((0.0, 0.02, 0.1, 0.02, 0.03))},
}


@pytest.mark.parametrize("name", PADS)
def test_the_limit_of_any_profile_meets_its_conditions(name):
    scene = sie.Scene(
        **PADS[name], modulus=1.0, normal_load=0.3, friction=0.5, tangential_load=0.09
    )
    worn = sie.wear_limit(scene)
    assert worn.check().ok
    (c1, c2), (w1, w2) = worn.stick, worn.worn
    assert w1 < c1 < c2 < w2
    x = np.linspace(c1, c2, 9)
    assert (worn.depth(x) == 0.0).all()
    # At the ends of the stick zone q = f p for the load that it carries in full stick
    root = np.sqrt((x - c1) * (c2 - x))
    s = 1e-9 * (c2 - c1)
    for edge, side in ((c1, 1.0), (c2, -1.0)):
        p = float(worn.pressure(edge + side * s))
        m, r = 0.5 * (c1 + c2), 0.5 * (c2 - c1)
        reach = edge + side * s - m
        q = (0.09 / math.pi - scene.tau * reach) / math.sqrt(r * r - reach * reach)
        assert q / p == pytest.approx(0.5, rel=1e-3)
    assert root[4] > 0.0


def test_the_depth_of_a_tilted_pad_is_what_its_surface_overlaps():
    # gap' = h' + θ - 2/E* hilbert: integrated from the edge of the stick zone by a plain rule
    scene = sie.Scene(
        **PADS["tilted"], modulus=1.0, normal_load=0.3, friction=0.5, tangential_load=0.09
    )
    worn = sie.wear_limit(scene)
    c2, end = worn.stick[1], worn.worn[1]
    g, w = np.polynomial.legendre.leggauss(60)
    u = 0.5 * math.sqrt(end - c2) * (g + 1.0)  # x = c2 + u²
    x = c2 + u * u
    slope = scene.profile.slope(x) + scene.tilt - 2.0 * worn.pressure.hilbert(x)
    overlap = -float((slope * 2.0 * u * w).sum() * 0.5 * math.sqrt(end - c2))
    assert overlap == pytest.approx(0.0, abs=1e-9)
    assert float(worn.depth(0.5 * (c2 + end))) > 1e-3


def test_the_worn_trace_carries_the_load_on_the_stick_zone():
    worn = of_parabola(0.6)
    again = sie.solve(sie.Scene(profile=worn.profile, modulus=1.0, normal_load=LOAD))
    assert again.pressure(0.0) == pytest.approx(float(worn.pressure(0.0)), rel=1e-2)
    assert again.edges[1] == pytest.approx(worn.stick[1], rel=1e-2)


def test_a_held_approach_loses_load_and_keeps_the_gap_at_its_datum():
    worn, datum = of_parabola(0.6, hold="approach", datum=10.0), 10.0
    scene = sie.Scene(**HERTZ, normal_load=LOAD, tangential_load=0.3 * LOAD)
    assert 0.5 * LOAD < worn.normal_load < LOAD
    assert worn.pressure.resultant == pytest.approx(worn.normal_load, rel=1e-14)
    before = float(sie.solve(scene).gap(datum))
    # the gap of the worn contact there, by ∫ gap' dx from the stick zone
    c2 = worn.stick[1]
    g, w = np.polynomial.legendre.leggauss(200)
    top = math.acosh(datum / c2)
    t = 0.5 * top * (g + 1.0)
    x = c2 * np.cosh(t)
    slope = x - 2.0 * worn.pressure.hilbert(x)
    after = float((slope * c2 * np.sinh(t) * w).sum() * 0.5 * top)
    assert after == pytest.approx(before, rel=1e-10)


def test_a_sharp_edge_that_sticks_does_not_wear():
    scene = sie.Scene(
        profile=sie.Flat(1.0), tilt=0.2, modulus=1.0, normal_load=0.3, friction=0.5,
        tangential_load=0.05,
    )  # fmt: skip
    worn = sie.wear_limit(scene)
    assert worn.worn[0] == worn.stick[0] == -1.0 and worn.worn[1] > worn.stick[1]
    assert worn.check().ok
    level = sie.Scene(
        profile=sie.Flat(1.0), modulus=1.0, normal_load=0.3, friction=0.5, tangential_load=0.05
    )
    with pytest.raises(sie.ContactError, match="nothing slips"):
        sie.wear_limit(level)


REFUSED = [
    ({"tangential_load": 0.0}, {}, ValueError, "nothing wears"),
    ({"sliding": 1}, {}, sie.ContactError, "sie.wear_modes"),
    ({"dundurs": 0.2, "tangential_load": 0.1}, {}, sie.ContactError, "dundurs = 0"),
    ({"tangential_load": 0.1}, {"hold": "shape"}, ValueError, "not known"),
    ({"tangential_load": 0.1}, {"hold": "approach"}, ValueError, "go together"),
    ({"tangential_load": 0.1}, {"hold": "approach", "datum": 0.5}, ValueError, "in the contact"),
    ({"tangential_load": 0.01, "bulk_stress": 1.0}, {}, sie.ContactError, "two ways"),
]


@pytest.mark.parametrize(("loads", "more", "error", "word"), REFUSED)
def test_what_has_no_limit_is_refused(loads, more, error, word):
    scene = sie.Scene(**HERTZ, normal_load=LOAD, **loads)
    with pytest.raises(error, match=word):
        sie.wear_limit(scene, **more)


def test_the_eigenvalues_of_galin():
    expected = [1.56600511, 0.90972723, 0.61295835, 0.47394407, 0.38034020]
    assert np.abs(sie.wear_modes().eigenvalues[:5] - expected).max() <= 1e-8


def test_a_mode_solves_its_equation():
    mode = sie.wear_modes(2.0).mode(2)
    g, w = np.polynomial.legendre.leggauss(80)

    def potential(x):
        """∫ ln(1/|x - t|) φ dt over (-2, 2), by squares of the distance on either side."""
        total = 0.0
        for end in (-2.0, 2.0):
            v = 0.5 * (g + 1.0)
            t = x + (end - x) * v**4
            total += ((-np.log(np.abs(t - x)) * mode(t)) * 4.0 * v**3 * 0.5 * w).sum() * abs(
                end - x
            )
        return total

    x = np.array([-1.7, -0.4, 0.3, 1.1])
    left = np.array([potential(at) for at in x]) - 2.0 * sie.wear_modes().eigenvalues[2] * mode(x)
    # the series of 240 terms of what has (a - x) ln(a - x) at its ends is right to 1e-6 or 2e-6
    assert np.ptp(left) <= 5e-6 * np.abs(mode(x)).max()


def test_the_pressure_of_a_flat_punch_becomes_even_and_keeps_its_load():
    flat = sie.solve(sie.Scene(profile=sie.Flat(2.0), modulus=1.0, normal_load=3.0)).pressure
    modes = sie.wear_modes(2.0)
    for T in (0.1, 2.0):
        p = modes.pressure(flat, T).integ()
        assert p(2.0) - p(-2.0) == pytest.approx(3.0, rel=1e-9)
    assert modes.pressure(flat, 60.0)(0.3) == pytest.approx(0.75, rel=1e-6)
    # of an even pressure the slowest mode is the second: the first is odd
    late = [modes.pressure(flat, T)(0.0) - 0.75 for T in (20.0, 22.0)]
    assert math.log(late[0] / late[1]) == pytest.approx(2.0 / modes.lengths[1], rel=1e-3)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: sie.wear_modes(0.0), "half_width"),
        (lambda: sie.wear_modes().mode(20), "no mode"),
        (lambda: sie.wear_modes().pressure(lambda x: x, -1.0), "time"),
    ],
)
def test_modes_of_nothing_are_refused(call, word):
    with pytest.raises(ValueError, match=word):
        call()
