"""Every remedy that a refusal offers makes a question that is answered."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from scenes import scene

import sie

PARABOLA, FLAT, WEDGE = sie.Parabola(1.0), sie.Flat(1.0), sie.Wedge(1.0)
STEEL, ALLOY = sie.Elastic(210e3, 0.3), sie.Elastic(115e3, 0.32)


def solved(scene):
    solution = sie.solve(scene)
    assert solution.check().ok
    return solution


def number(pattern, message):
    """The number that a message offers, exactly as it is printed."""
    return float(re.search(pattern + r"(-?[\d.]+(?:e[-+]?\d+)?)", message)[1])


# What is asked, words of the remedy, and what is asked when it is followed.
SCENES = {
    "give exactly one: load": ({"half_width": 1.5, "normal_load": 1.0}, "exactly one",
        {"normal_load": 1.0}),
    "give exactly one: width": ({"normal_load": ...}, "exactly one", {"half_width": 1.5}),
    "give body": ({"modulus": ...}, "give body = sie.Elastic", {"body": STEEL}),
    "or modulus": ({"modulus": ...}, "or modulus = E", {"modulus": 2.0}),
    "leave poisson out": ({"body": STEEL, "poisson": 0.3}, "leave it out", {"body": STEEL}),
    "leave dundurs out": ({"body": STEEL, "dundurs": 0.1}, "leave it out", {"body": STEEL}),
    "give dundurs 0": ({"body": STEEL, "dundurs": 0.1}, "or give 0", {"body": STEEL, "dundurs": 0}),
    "leave the indenter out": ({"modulus": 1.0, "indenter": STEEL}, "leave it out", {}),
    "give one of them young": ({"body": sie.RIGID}, "young and poisson",
        {"body": sie.RIGID, "indenter": STEEL}),
    "give tilt or moment": ({"tilt": 0.1, "moment": 0.1}, "give one", {"moment": 0.1}),
    "give friction": ({"tangential_load": 0.1}, "give friction > 0",
        {"tangential_load": 0.1, "friction": 0.2}),
    "give a finite friction": ({"profile": FLAT, "sliding": 1, "friction": math.inf}, "finite",
        {"profile": FLAT, "sliding": 1, "friction": 0.3}),
    "sliding, 0": ({"sliding": 1}, "leave it 0", {"sliding": 0}),
    "sliding, friction": ({"sliding": 1}, "give friction > 0", {"sliding": 1, "friction": 0.3}),
    "sliding, not Q": ({"sliding": 1, "tangential_load": 0.1, "friction": 0.3}, "follows",
        {"sliding": 1, "friction": 0.3}),
    "bonded, flat": ({"friction": math.inf}, "give a flat punch",
        {"profile": FLAT, "friction": math.inf}),
    "bonded, finite": ({"friction": math.inf}, "a finite friction", {"friction": 0.5}),
    "bonded, load": ({"profile": FLAT, "friction": math.inf, "half_width": 1.0}, "give normal_load",
        {"profile": FLAT, "friction": math.inf}),
    "sharp, load": ({"profile": FLAT, "half_width": 1.0}, "any load: give a normal_load",
        {"profile": FLAT}),
    "width on the flat, larger": ({"half_width": 0.5}, "give a larger half_width",
        {"half_width": 1.5}),
    "width on the flat, load": ({"half_width": 0.5}, "or a normal_load", {}),
    "width beyond the indenter": (
        {"profile": sie.Piecewise((-1.0, 1.0), ((0.0, 1.0),)), "half_width": 2.0}, "at most that",
        {"profile": sie.Piecewise((-1.0, 1.0), ((0.0, 1.0),)), "half_width": 0.9},
    ),
    "less moment": ({"profile": FLAT, "moment": 2.0}, "lower the moment",
        {"profile": FLAT, "moment": 0.4}),
    "less tilt": ({"profile": WEDGE, "tilt": 2.0}, "prescribe less tilt",
        {"profile": WEDGE, "tilt": 0.5}),
    "a profile that rises on both sides": (
        {"profile": sie.Polynomial((0.0, 0.0, 0.5, 1e-3))}, "rises on both sides",
        {"profile": sie.FromFunction("x + 3e-3*x*x", domain=(-9.0, 9.0))},
    ),
    **{f"narrower domain, {text}": (
        {"profile": sie.FromFunction(text, domain=(-1.0, 1.0)), "normal_load": 5.0}, "narrow",
        {"profile": sie.FromFunction(text, domain=(-0.999, 0.999)), "normal_load": 5.0},
    ) for text in ("arctanh(x)", "x/sqrt(1 - x*x)")},
    "give a domain": (
        {"profile": sie.FromFunction("x/(1 + x*x)"), "normal_load": 9.0}, "give a domain",
        {"profile": sie.FromFunction("x/(1 + x*x)", domain=(-3.0, 3.0)), "normal_load": 9.0},
    ),
    "other units": ({"modulus": 1e-200}, "choose other units",
        {"modulus": 1e-100, "normal_load": 1e-100}),
    "bumps, their load": (
        {"profile": sie.FromFunction("x - 1.5*sin(2*x)"), "half_width": 0.1}, "give normal_load",
        {"profile": sie.FromFunction("x - 1.5*sin(2*x)"), "normal_load": 0.05},
    ),
}  # fmt: skip


@pytest.mark.slow(but=27)
@pytest.mark.parametrize("name", SCENES)
def test_a_scene_that_follows_its_refusal_s_remedy_is_solved(name):
    asked, words, followed = SCENES[name]
    with pytest.raises((ValueError, sie.ContactError)) as refusal:
        _ = sie.solve(scene(**asked)).edges
    assert words in str(refusal.value)
    solved(scene(**followed))


DISSIMILAR = {"body": ALLOY, "indenter": STEEL, "friction": 0.4}
CORNER = {"profile": FLAT, "tangential_load": 0.1}
TILTED = {"profile": FLAT, "tilt": 0.01}
TURNED = {"profile": PARABOLA, "moment": 0.01}
DISSIMILAR_REMEDIES = {
    "dundurs at a corner": (CORNER, "give dundurs = 0", {"dundurs": 0.0}),
    "sliding": (CORNER, "sliding = ±1", {"sliding": 1, "tangential_load": 0.0}),
    "dundurs": (TILTED, "give dundurs = 0", {"dundurs": 0.0}),
    "friction": (TILTED, "set friction = 0", {"friction": 0.0}),
    "tilt": (TILTED, "change the tilt", {"tilt": 0.0}),
    "moment": (TURNED, "give a tilt", {"moment": None, "tilt": 0.01}),
}


@pytest.mark.parametrize("remedy", DISSIMILAR_REMEDIES)
def test_dissimilar_bodies_follow_each_remedy(remedy):
    given, words, changes = DISSIMILAR_REMEDIES[remedy]
    asked = scene(**DISSIMILAR, **given)
    with pytest.raises(sie.ContactError) as refusal:
        _ = sie.solve(asked).stick
    assert words in str(refusal.value)
    solved(replace(asked, **changes))


@pytest.mark.parametrize("Q", [0.5, 0.777, 0.31])
def test_a_load_raised_to_what_the_refusal_prints_carries_the_tangential_load(Q):
    asked = scene(PARABOLA, friction=0.3, tangential_load=Q)
    with pytest.raises(sie.LoadError, match="raise normal_load") as refusal:
        sie.solve(asked)
    solved(replace(asked, normal_load=1.01 * number("raise normal_load to ", str(refusal.value))))
    solved(replace(asked, tangential_load=0.999 * number("exceeds f P = ", str(refusal.value))))


def test_poisson_s_ratio_is_given_beside_the_modulus_or_with_the_body():
    without = sie.solve(scene())
    with pytest.raises(
        ValueError, match="give poisson beside modulus, or the body by young and poisson"
    ):
        _ = without.stress(0.0, 1.0).zz
    body = sie.Elastic(2.0 * (1.0 - 0.09), 0.3)  # E* = 1
    given = [sie.solve(scene(poisson=0.3)), sie.solve(scene(body=body))]
    values = [float(solution.stress(0.0, 1.0).zz) for solution in given]
    assert values[0] == pytest.approx(values[1], rel=1e-13)


def line(x):
    return 1.0 + x


BOUNDED = {"g": line, "ends": "bounded"}
# What is asked, words of the remedy, and what follows it.
EQUATIONS = {
    "as many conditions": ({}, "as many of total", {"total": 0.0}),
    "bounded or singular": ({}, "make other ends bounded", {"ends": ("singular", "bounded")}),
    "normal type": ({"a": 1j, "total": 0.0}, "not of normal type", {"a": 0.5j, "total": 0.0}),
    "free a constant": (BOUNDED, "free a constant", {**BOUNDED, "free": (1.0,)}),
    "a singular end": (BOUNDED, "let an end be", {**BOUNDED, "ends": ("bounded", "singular")}),
}


@pytest.mark.parametrize("name", EQUATIONS)
def test_an_equation_that_follows_its_refusal_s_remedy_is_solved(name):
    asked, words, followed = EQUATIONS[name]
    with pytest.raises((ValueError, sie.ContactError)) as refusal:
        sie.CauchyEquation((-1.0, 1.0), **({"g": 1.0} | asked)).solve()
    assert words in str(refusal.value)
    found = sie.CauchyEquation((-1.0, 1.0), **({"g": 1.0} | followed)).solve()
    assert np.isfinite(found(0.3))
    assert found.error <= 1e-13


# What is asked of a path, words of the remedy, and the path and the scene that follow it.
SHEARED = scene(PARABOLA, friction=0.4)
PATHS = {
    "raise the load": ([(1, 0.1), (1, 0.5)], "raise normal_load", [(1, 0.1), (1.3, 0.5)]),
    "a later point": ([(0, 0), (1, 0.1)], "ask for a later point", [(1, 0.1)]),
}


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("name", PATHS)
def test_a_path_that_follows_its_refusal_s_remedy_is_answered(name):
    asked, words, followed = PATHS[name]
    with pytest.raises(sie.ContactError) as refusal:
        answered(SHEARED, asked)
    assert words in str(refusal.value)
    answered(SHEARED, followed)


def answered(scene, points):
    for solution in sie.follow(scene, sie.Path(points)):
        assert solution.check().ok
        assert solution.shear.resultant == pytest.approx(solution.tangential_load, abs=1e-12)


def test_a_path_needs_friction_and_a_finite_one():
    with pytest.raises(ValueError, match="give friction > 0"):
        sie.follow(scene(PARABOLA), sie.Path([(1.0, 0.1)]))
    bonded = scene(FLAT, friction=math.inf)
    with pytest.raises(ValueError, match="give a finite friction, or solve the last point"):
        sie.follow(bonded, sie.Path([(1.0, 0.1)]))
    answered(replace(bonded, friction=0.4), [(1.0, 0.1)])
    solved(replace(bonded, normal_load=1.0, tangential_load=0.1))


HEIGHTS = [f"{x:.2f} {0.5 * x * x:.6f}" for x in np.linspace(-1.0, 1.0, 41)]
TRACES = {
    "mend passes over lines": ([*HEIGHTS, "1.05 nan"], {}, "mend = true passes over them", None,
                               {"mend": True}),
    "delete such lines": ([*HEIGHTS, "1.05 nan"], {}, "delete such lines", HEIGHTS, {}),
    "mend the file": ([*HEIGHTS, "1.05 oops"], {}, "mend the file", HEIGHTS, {}),
    "other columns": ([f"a{k} {row}" for k, row in enumerate(HEIGHTS)], {}, "choose other columns",
                      None, {"columns": (1, 2)}),
    "a number": (HEIGHTS, {"columns": (0, 2)}, "give numbers from 0 to 1", None,
                 {"columns": (0, 1)}),
    "skip fewer": (HEIGHTS, {"skip": 41}, "skip fewer lines", None, {"skip": 4}),
}  # fmt: skip


@pytest.mark.parametrize("name", TRACES)
def test_a_trace_that_follows_its_refusal_s_remedy_is_read_and_pressed(name, tmp_path):
    rows, given, words, mended, options = TRACES[name]
    path = tmp_path / "trace.txt"
    path.write_text("\n".join(rows))
    with pytest.raises(ValueError, match=re.escape(words)):
        sie.Sampled.read(path, **given)
    path.write_text("\n".join(mended or rows))
    solved(scene(sie.Sampled.read(path, **options), normal_load=0.05))
