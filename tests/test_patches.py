"""Contact in several patches: edges, loads and pressures against values of thirty digits, and closed forms."""

import numpy as np
import pytest

import sie
from sie.patches.of_scene import problem_of
from sie.patches.solver import contact

TWO = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
ROUNDED = sie.Row(
    [sie.RoundedFlat(0.4, 1.0).shifted(-1.2), sie.RoundedFlat(0.25, 2.0).shifted(1.0).raised(0.01)]
)
FLATS = sie.Row([sie.Flat(0.4).shifted(-0.6), sie.Flat(0.55).shifted(0.85)])


def wavy(x):
    return x - 0.6 * np.sin(12.0 * x + 0.7)


def harmonics(x):
    return 0.8 * np.sin(x) + 1.05 * np.sin(3.0 * x + 0.5) + 0.84 * np.sin(7.0 * x + 1.1)


# Edges by Newton's method on the integral equation in 30 digits, by two different routes.
REFERENCES = {
    "two parabolas": (
        {"profile": TWO, "normal_load": 0.4},
        (-1.58325986638602757, -0.53524903797441766, 0.603485211237481694, 1.269847059573996219),
    ),
    "two parabolas under a moment": (
        {"profile": TWO, "normal_load": 0.4, "moment": 0.05},
        (-1.45864941190000681, -0.54334310800098487, 0.587826018451422709, 1.345480218825823384),
    ),
    "wavy punch": (
        {"profile": sie.FromFunction(wavy, domain=(-2.0, 2.0)), "normal_load": 0.228},
        (
            -0.43237913911396203,
            -0.12219005194204682,
            0.001890506233437465,
            0.352657113232932,
            0.6302796532851106,
            0.6890729844189019,
        ),
    ),
    "two rounded flats": (
        {"profile": ROUNDED, "normal_load": 0.6},
        (-2.20774455378010643, -0.43224940895161958, 0.215084495070883301, 2.198435239858398718),
    ),
    "three harmonics": (
        {"profile": sie.Periodic(sie.FromFunction(harmonics), 2.0 * np.pi), "normal_load": 3.0},
        (
            -2.787302433508856,
            -1.7014107978420885,
            -1.221104816631071,
            0.9822849637598969,
            1.312094138295231,
            2.4838367704880184,
        ),
    ),
}


def found(**given):
    return contact(problem_of(sie.Scene(modulus=1.0, **given)))


@pytest.mark.parametrize("name", REFERENCES)
def test_the_edges_of_all_patches(name):
    given, expected = REFERENCES[name]
    edges = found(**given).state.patches.edges
    period = given["profile"].period
    if period < np.inf:
        edges = np.sort(edges - period * np.round((edges - np.mean(expected)) / period))
    narrowest = np.diff(expected)[::2].min()
    np.testing.assert_allclose(edges, expected, rtol=0.0, atol=2e-13 * narrowest)


def test_the_tilt_under_a_moment():
    tilt = found(**REFERENCES["two parabolas under a moment"][0]).state.tilt
    assert abs(tilt / -0.07597308212919692 - 1.0) < 1e-13
