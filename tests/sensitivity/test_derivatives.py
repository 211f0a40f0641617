"""Derivatives of a solution are the limits of its differences, by every number of every kind."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sie

INSIDE = np.array([-0.83, -0.41, 0.13, 0.37, 0.71])  # half-widths from the centre
BAR = 1e-9
STEEL = sie.Elastic(200.0, 0.3)
PAIR = {"body": STEEL, "indenter": sie.Elastic(100.0, 0.2), "dundurs": 0.0, "normal_load": 20.0}
SLIP = {"friction": 0.4, "tangential_load": 3.0, "bulk_stress": 2.0}
X = np.linspace(-1.6, 1.6, 41)
TRACE = np.cosh(X) - 1.0 + 0.05 * np.sin(3.0 * X)


def scene(profile, **given):
    plain = {} if "body" in given else {"modulus": 1.0, "poisson": 0.3}
    load = {} if {"half_width", "normal_load"} & given.keys() else {"normal_load": 0.4}
    return sie.Scene(**{"profile": profile, **plain, **load, **given})


def limit(function, x, step):
    """The derivative by Richardson's extrapolation of central differences."""
    steps = step * 0.5 ** np.arange(4)
    row = [(np.asarray(function(x + h)) - np.asarray(function(x - h))) / (2.0 * h) for h in steps]
    for m in range(1, 4):
        row = [(4**m * fine - coarse) / (4**m - 1) for coarse, fine in pairwise(row)]
    return row[0]


def answers(solution, places, sheared):
    x = np.asarray(places)
    found = {
        "patches": solution.patches,
        "load": [solution.normal_load, solution.moment, solution.tilt],
        "pressure": solution.pressure(x),
        "stress": list(solution.stress(x, 0.3)),
    }
    return found | ({"shear": solution.shear(x), "stick": solution.stick} if sheared else {})


def assert_derivative(make, value, name, step=1e-3):
    """That by `name` is the limit of the differences of `make`, a scene as a function of it."""
    solution = sie.solve(make(value))
    x = solution.centre + solution.half_width * INSIDE
    sheared = bool(solution.scene.friction)
    exact = solution.derivative(name)
    load = exact.normal_load, exact.moment, exact.tilt
    stress = exact.stress(x, 0.3)
    found = {
        "patches": exact.patches,
        "load": load,
        "pressure": exact.pressure(x),
        "stress": [stress.xx, stress.yy, stress.xy, stress.zz],
        "shear": exact.shear(x),
        "stick": exact.stick,
    }
    scale = max(1.0, abs(solution.normal_load) / max(abs(value), 1e-2))
    for what in answers(solution, x, sheared):
        differences = limit(lambda v: answers(sie.solve(make(v)), x, sheared)[what], value, step)  # noqa: B023
        assert np.abs(np.asarray(found[what]) - differences).max(initial=0.0) < BAR * scale, what


def with_coefficient(k):
    def make(v):
        c = [0.0, 0.05, 1.0, 0.4, 0.6]
        c[k] = v
        return scene(sie.Polynomial(c))

    return make


def with_height(k, smoothing=0.0):
    def make(v):
        h = TRACE.copy()
        h[k] = v
        return scene(sie.Sampled(X, h, smoothing))

    return make


def two_radii(v):
    return scene(sie.Piecewise([-0.5, 0.25], [(0.5, 1.0), (0.0,), (-0.75, v)]))


def wavy(v):
    return scene(sie.FromFunction(lambda x: np.sinh(x) + x**2 / 4 + v * np.cos(x)))


def row(radius=1.0, rise=0.0):
    right = sie.Parabola(1.0).shifted(2.0).raised(rise)
    return sie.Row([sie.Parabola(radius), right, sie.Parabola(2.0).shifted(-2.3)])


def punches(half_flat):
    rounded = sie.RoundedFlat(half_flat, 1.0).shifted(2.0)
    return sie.Row([sie.Flat(0.3), rounded, sie.Flat(0.2).shifted(-1.0).raised(0.02)])


FLAT = sie.RoundedFlat(0.5, 1.0)
CASES = {
    "radius": (lambda v: scene(sie.Parabola(v)), 1.0, "profile.radius"),
    "flat": (lambda v: scene(sie.RoundedFlat(v, 1.0), tilt=0.05), 0.5, "profile.half_flat"),
    "tilt": (lambda v: scene(FLAT, tilt=v), 0.05, "tilt"),
    "moment": (lambda v: scene(FLAT, moment=v), 0.05, "moment"),
    "radius at a moment": (
        lambda v: scene(sie.RoundedFlat(0.5, v), moment=0.05), 1.0, "profile.radius"
    ),
    "modulus at a moment": (
        lambda v: sie.Scene(profile=FLAT, modulus=v, poisson=0.3, normal_load=0.4, moment=0.05),
        1.0,
        "modulus",
    ),
    "half-width": (lambda v: scene(FLAT, half_width=v, tilt=0.03), 1.0, "half_width"),
    "wedge": (lambda v: scene(sie.Wedge(v)), 0.3, "profile.slope"),
    "power": (lambda v: scene(sie.Power(2.5, v)), 0.5, "profile.coefficient"),
    "power, shifted": (
        lambda v: scene(sie.Power(1.3, v).shifted(0.3)), 0.5, "profile.coefficient"
    ),
    "exponent": (lambda v: scene(sie.Power(v, 0.5)), 2.5, "profile.exponent"),
    "corners": (lambda v: scene(sie.Flat(0.5), normal_load=v), 0.4, "normal_load"),
    "corners, tilt": (lambda v: scene(sie.Flat(0.5), tilt=v), 0.05, "tilt"),
    **{f"x^{k}": (with_coefficient(k), 0.4, f"profile.coefficients[{k}]") for k in (1, 3)},
    "piece": (two_radii, 3.0, "profile.pieces[2][1]"),
    "height": (with_height(18), TRACE[18], "profile.heights[18]"),
    "smoothed height": (with_height(18, 1e-4), TRACE[18], "profile.heights[18]"),
    "function": (wavy, 0.1, sie.FromFunction("cos(x)")),
    "placed": (
        lambda v: scene(sie.Parabola(v).shifted(0.3).tilted(0.1)), 1.0, "profile.radius"
    ),
    "sum": (
        lambda v: scene(sie.Parabola(1.0) + sie.Wedge(v).shifted(0.05)),
        0.2,
        "profile.parts[1].slope",
    ),
    "row, radius": (lambda v: scene(row(v), normal_load=1.0), 1.0, "profile.profiles[0].radius"),
    "valleys": (
        lambda v: scene(sie.Polynomial((0.0, 0.01, -0.5, 0.0, v)), normal_load=0.03),
        1.0,
        "profile.coefficients[4]",
    ),
    "sliding": (lambda v: scene(FLAT, friction=v, sliding=1), 0.4, "friction"),
    "partial slip, young": (
        lambda v: scene(FLAT, body=sie.Elastic(v, 0.3), normal_load=20.0, **SLIP), 200.0, "young"
    ),
    "partial slip, poisson": (
        lambda v: scene(FLAT, body=sie.Elastic(200.0, v), normal_load=20.0, **SLIP), 0.3, "poisson"
    ),
    **{
        f"partial slip, {name}": (
            lambda v, name=name: scene(FLAT, body=STEEL, normal_load=20.0, **{**SLIP, name: v}),
            value,
            name,
        )
        for name, value in SLIP.items()
    },
    "partial slip, radius": (
        lambda v: scene(sie.RoundedFlat(0.5, v), body=STEEL, normal_load=20.0, **SLIP),
        1.0,
        "profile.radius",
    ),
    "a pair": (
        lambda v: scene(FLAT, **SLIP, **{**PAIR, "body": sie.Elastic(v, 0.3)}), 200.0, "body.young"
    ),
    "row, rise": (
        lambda v: scene(row(1.0, v), normal_load=1.0), 0.01, "profile.profiles[1].rise"
    ),
    "row at a moment": (lambda v: scene(row(), normal_load=1.0, moment=v), -0.1, "moment"),
    "row of punches": (
        lambda v: scene(punches(v), normal_load=1.0), 0.4, "profile.profiles[1].half_flat"
    ),
    "row in partial slip": (
        lambda v: scene(row(v), normal_load=1.0, friction=0.4, tangential_load=0.1),
        1.0,
        "profile.profiles[0].radius",
    ),
}  # fmt: skip


@pytest.mark.slow(but=len(CASES) - 4)
@pytest.mark.parametrize("case", CASES)
def test_a_derivative_is_the_limit_of_differences(case):
    assert_derivative(*CASES[case])


def test_a_periodic_contact_has_derivatives():
    make = lambda v: scene(sie.Periodic(sie.Parabola(v), 2.0), normal_load=0.2)  # noqa: E731
    exact = sie.solve(make(1.0)).derivative("profile.radius")
    found = limit(lambda v: sie.solve(make(v)).half_width, 1.0, 1e-2)
    assert abs(exact.half_width - found) < BAR


@given(
    st.floats(0.2, 3.0), st.floats(-0.3, 0.3), st.floats(0.1, 2.0), st.sampled_from((0, 1, 2, 3))
)
def test_of_random_polynomials_under_random_loads(bend, lean, load, k):
    c = [0.0, lean, 1.0, 0.2 * lean, bend]

    def make(v):
        return scene(sie.Polynomial([*c[: k + 1], v, *c[k + 2 :]]), normal_load=load)

    exact = sie.solve(make(c[k + 1])).derivative(f"profile.coefficients[{k + 1}]")
    found = limit(lambda v: sie.solve(make(v)).edges, c[k + 1], 1e-2)
    assert np.abs(np.array(exact.edges) - found).max() < BAR


def test_of_hertz_every_answer_follows_from_powers():
    solution = sie.solve(scene(sie.Parabola(2.0), normal_load=0.5))
    p, b = solution.pressure, solution.half_width
    by_load, by_modulus = solution.derivative("normal_load"), solution.derivative("modulus")
    assert by_load.half_width == pytest.approx(b, rel=1e-14)  # b/(2P)
    assert by_modulus.half_width == pytest.approx(-0.5 * b, rel=1e-14)
    assert by_load.peak_pressure == pytest.approx(float(p(0.0)), rel=1e-12)
    assert by_load.pressure(0.5 * b) == pytest.approx(1.0 / (math.pi * b * 0.75**0.5), rel=1e-13)
    assert by_load.pressure.resultant == pytest.approx(1.0, rel=1e-14)


SCENES = {
    "trace": lambda: scene(sie.Sampled(X, TRACE)),
    "tilted punch in sliding": lambda: scene(FLAT, tilt=0.15, friction=0.4, sliding=1),
    "punch in partial slip": lambda: scene(FLAT, body=STEEL, normal_load=20.0, **SLIP),
}


@pytest.mark.parametrize("quantity", ["peak_tension", "elastic_limit"])
@pytest.mark.parametrize("case", list(SCENES)[1:])
def test_a_peak_of_the_stress_has_the_derivative_of_its_value(case, quantity):
    solution = sie.solve(SCENES[case]())
    read = {"peak_tension": lambda s: s.peak_tension().value,
            "elastic_limit": lambda s: s.elastic_limit().load}[quantity]  # fmt: skip
    exact = solution.gradient(quantity)
    for name in ("normal_load", "friction"):
        value = getattr(solution.scene, name)
        found = limit(lambda v, name=name: read(solution.with_(**{name: v})), value, 2e-3 * value)
        assert abs(exact[name] - found) < 1e-8 * max(abs(found), 1.0), name


@pytest.mark.parametrize("quantity", ["half_width", "centre", "right_edge", "peak_pressure"])
def test_all_heights_of_a_trace_at_once_are_those_one_by_one(quantity):
    solution = sie.solve(SCENES["trace"]())
    together = solution.gradient(quantity)["profile.heights"]
    ks = (0, 9, 18, 27, 40)
    each = [solution.derivative(f"profile.heights[{k}]") for k in ks]
    values = [d.edges[1] if quantity == "right_edge" else getattr(d, quantity) for d in each]
    assert together[list(ks)] == pytest.approx(values, abs=1e-12 * np.abs(together).max())


def test_a_lift_of_the_whole_trace_changes_nothing():
    gradient = sie.solve(SCENES["trace"]()).gradient("half_width")["profile.heights"]
    assert abs(gradient.sum()) < 1e-12 * np.abs(gradient).sum()


def test_a_gradient_has_every_number_of_the_scene():
    solution = sie.solve(scene(FLAT, body=STEEL, normal_load=20.0, **SLIP))
    assert solution.gradient("half_width").keys() == {
        "normal_load", "tilt", "friction", "tangential_load", "bulk_stress", "young", "poisson",
        "profile.half_flat", "profile.radius",
    }  # fmt: skip


def test_what_has_no_derivative_is_left_out_and_what_does_not_change_is_zero():
    assert "tilt" not in sie.solve(scene(FLAT)).gradient("peak_pressure")
    rough = sie.solve(scene(FLAT, friction=0.4))
    assert rough.derivative("normal_load").shear(0.0) == 0.0


def test_uncertainties_add_up_as_squares_and_agree_with_monte_carlo():
    solution = sie.solve(scene(sie.Parabola(4.0), normal_load=1.0))
    deviations = {"profile.radius": 0.04, "normal_load": 0.01}
    found = solution.uncertainty(deviations)
    shares = found.shares("half_width")
    assert found.of("half_width") == pytest.approx(math.hypot(*shares.values()), rel=1e-15)
    drawn = np.random.default_rng(1).normal(size=(2, 400))
    widths = [math.sqrt(4.0 * (1.0 + 0.01 * u) * (4.0 + 0.04 * v) / math.pi) for u, v in drawn.T]
    assert found.of("half_width") == pytest.approx(np.std(widths), rel=0.15)


def test_noise_of_a_trace_is_one_number_for_all_heights():
    solution = sie.solve(SCENES["trace"]())
    gradient = solution.gradient("peak_pressure")["profile.heights"]
    found = solution.uncertainty({"profile.heights": 1e-4}).of("peak_pressure")
    assert found == pytest.approx(1e-4 * np.linalg.norm(gradient), rel=1e-14)


STEEPER = sie.Piecewise([-1.0, 1.0], [(-3.0, 1.0), (0.0, 1.0), (3.0, 1.0)])  # beyond x = ±1
NONE = [
    (scene(FLAT, friction=0.4), "tangential_load", "shear", "one-sided"),
    (scene(FLAT, friction=0.4, tangential_load=0.16), "normal_load", "stick", "one-sided"),
    (scene(FLAT), "tilt", "peak_pressure", "2 places"),
    (scene(STEEPER, normal_load=math.pi / 4.0), "normal_load", "edges", "corner of the profile"),
    (scene(sie.Flat(0.5)), "profile.half_width", "shear", "moving the corner"),
    (scene(FLAT, dundurs=0.2, friction=0.3), "normal_load", "shear", "dundurs = 0"),
    (scene(FLAT, friction=0.4, tangential_load=0.01, bulk_stress=0.5), "friction", "shear",
     "opposite directions"),
]  # fmt: skip


@pytest.mark.parametrize(("asked", "name", "answer", "words"), NONE)
def test_what_has_no_derivative_says_so(asked, name, answer, words):
    with pytest.raises(sie.ContactError, match=words):
        getattr(sie.solve(asked).derivative(name), answer)


def test_an_unknown_name_lists_those_that_are_known():
    solution = sie.solve(scene(FLAT))
    with pytest.raises(ValueError, match=r"profile\.half_flat"):
        solution.derivative("profile.halfflat")
    with pytest.raises(ValueError, match="peak_tension"):
        solution.gradient("peak_presure")
