"""Bad questions are refused when they are built, good ones without an answer when asked."""

import math
import pickle

import numpy as np
import pytest
from scenes import PUNCH, scene

import sie
import sie.patches.answer

NAN, INF = float("nan"), float("inf")
STEEL = sie.Elastic(210e3, 0.3)


def asked(scene):
    """The edges, and with them whatever the scene is refused for."""
    return sie.solve(scene).edges


POSITIVE = {
    "Parabola.radius": sie.Parabola,
    "RoundedFlat.half_flat": lambda v: sie.RoundedFlat(v, 1.0),
    "RoundedFlat.radius": lambda v: sie.RoundedFlat(1.0, v),
    "Flat.half_width": sie.Flat,
    "Wedge.slope": sie.Wedge,
    "Power.coefficient": lambda v: sie.Power(2.0, v),
    "Elastic.young": lambda v: sie.Elastic(v, 0.3),
    "Scene.modulus": lambda v: scene(modulus=v),
    "Scene.normal_load": lambda v: scene(normal_load=v),
    "Scene.half_width": lambda v: scene(half_width=v),
    "solve.tol": lambda v: sie.solve(scene(), tol=v),
}
FINITE = {
    "Power.exponent": lambda v: sie.Power(v, 1.0),
    "Elastic.poisson": lambda v: sie.Elastic(1.0, v),
    "Scene.tilt": lambda v: scene(tilt=v),
    "Scene.moment": lambda v: scene(moment=v),
    "Scene.tangential_load": lambda v: scene(tangential_load=v, friction=0.5),
    "Scene.bulk_stress": lambda v: scene(bulk_stress=v),
    "Scene.friction": lambda v: scene(friction=v),
    "Scene.dundurs": lambda v: scene(dundurs=v),
    "Scene.poisson": lambda v: scene(poisson=v),
    "tilted": PUNCH.tilted,
    "shifted": PUNCH.shifted,
    "Polynomial": lambda v: sie.Polynomial((0.0, 0.0, v)),
    "Piecewise.pieces": lambda v: sie.Piecewise((0.0,), ((0.0, 1.0), (0.0, v))),
    "FromFunction.breaks": lambda v: sie.FromFunction("x", breaks=(v,)),
}


@pytest.mark.parametrize("name", POSITIVE)
@pytest.mark.parametrize("value", [0.0, -0.0, -3.5, INF, -INF, NAN])
def test_a_value_that_is_not_positive_is_refused_and_named(name, value):
    with pytest.raises(ValueError, match=r"(?i)" + str(value).removesuffix(".0").removeprefix("-")):
        POSITIVE[name](value)


FINEST = 2.0 * np.finfo(float).eps


@pytest.mark.parametrize("value", [1e-30, 5e-324, np.nextafter(FINEST, 0.0), 1.0, 1e300])
def test_a_tolerance_below_rounding_or_not_below_one_is_refused(value):
    path = sie.Path([(1.0, 0.0)])
    equation = sie.CauchyEquation((-1.0, 1.0), 1.0, total=0.0)
    for ask in (
        lambda: sie.solve(scene(), tol=value),
        lambda: sie.follow(scene(), path, tol=value),
        lambda: equation.solve(tol=value),
    ):
        with pytest.raises(ValueError, match=rf"tol = {value:g}".replace("+", r"\+")):
            ask()


@pytest.mark.parametrize("name", FINITE)
@pytest.mark.parametrize("value", [INF, -INF, NAN])
def test_a_value_that_is_not_finite_is_refused_and_named(name, value):
    if (name, value) == ("Scene.friction", INF):
        pytest.skip("infinite friction is full stick")
    with pytest.raises(ValueError, match=r"(?i)nan|inf"):
        FINITE[name](value)


@pytest.mark.parametrize("name", [*POSITIVE, *FINITE])
@pytest.mark.parametrize(
    "value", ["7", None, True, [1.0, 2.0], 1 + 2j, object()], ids=lambda value: type(value).__name__
)
def test_a_value_that_is_no_number_is_refused(name, value):
    if value is None and name.startswith("Scene."):
        pytest.skip("None is how a scene spells what is not given")
    with pytest.raises(ValueError, match=r"\S"):
        (POSITIVE | FINITE)[name](value)


@pytest.mark.parametrize(
    "value", [7, np.float64(7), np.float32(7), np.int64(7), np.array(7.0)], ids=repr
)
def test_every_real_number_becomes_a_float(value):
    assert sie.Parabola(value) == sie.Parabola(7.0)
    assert type(sie.Parabola(value).radius) is float
    assert type(scene(normal_load=value).normal_load) is float


@pytest.mark.parametrize("nu", [-1.0, -1.5, 0.5000001, 1.0])
def test_a_poisson_ratio_that_no_stable_solid_has_is_refused(nu):
    with pytest.raises(ValueError, match=r"poisson"):
        sie.Elastic(1.0, nu)
    with pytest.raises(ValueError, match=r"poisson"):
        scene(poisson=nu)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"half_width": 0.25, "moment": 0.5}, r"both half_width = 0\.25 and moment = 0\.5.*give"),
        ({"modulus": 1.0, "body": STEEL}, "both.*body.*modulus"),
        ({"modulus": None, "body": 210e3}, "210000"),
        ({"modulus": None, "body": STEEL, "indenter": "steel"}, "steel"),
        ({"dundurs": 0.75}, r"0\.75"),
        ({"friction": -0.25}, r"-0\.25"),
        ({"sliding": 2, "friction": 0.1}, "sliding = 2"),
        ({"profile": 2.0}, r"2\.0.*profile"),
        ({"profile": "punch"}, "punch"),
    ],
)
def test_a_scene_that_makes_no_contact_problem_is_refused_with_a_sentence(changes, words):
    with pytest.raises(ValueError, match=rf"(?s){words}"):
        scene(**changes)


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: sie.Power(0.5, 1.0), r"0\.5"),
        (lambda: sie.Polynomial((0.0, 1.0)), r"1\.0"),
        (lambda: sie.Polynomial([0.0] * 3001 + [1.0]), "3001, more than 1000: give the slope as a"),
        (lambda: sie.Piecewise((0.0,), ([0.0, 1.0], [0.0] * 3001 + [1.0])), r"pieces\[1\] is 3001"),
        (lambda: scene(normal_load=10**400), "a whole number beyond the range of doubles"),
        (lambda: sie.Polynomial(()), "straight"),
        (lambda: sie.Piecewise((1.0, 0.0, 2.0), ((0.0,), (0.0, 1.0))), "1.*0"),
        (lambda: sie.Piecewise((0.0, 0.0), ((0.0,), (0.0,), (0.0,))), "0.*0"),
        (lambda: sie.Piecewise((0.0, 1.0, 2.0, 3.0), ((0.0, 1.0),)), "4.*1"),
        (lambda: sie.Piecewise((), ()), "0.*0"),
        (lambda: sie.Piecewise((0.0,), ((0.0, 1.0), ())), r"pieces\[1\]"),
        (lambda: sie.Piecewise((NAN,), ((0.0, 1.0), (0.0, 2.0))), "nan"),
        (lambda: sie.Piecewise((-INF, INF, INF), ((0.0, 1.0), (0.0, 2.0))), "inf"),
        (lambda: sie.Piecewise((-INF, 0.0, 1.0, INF, INF), ((0.0, 1.0),) * 4), "inf"),
        (lambda: sie.FromFunction(3.0), r"3\.0"),
        (lambda: sie.FromFunction(math.sinh), "called with an array .*NumPy's functions"),
        (lambda: sie.FromFunction(lambda x: x if x > 0.0 else 0.0), "an array .*truth value"),
        (lambda: sie.FromFunction("x", domain=(1.0, -1.0)), "1.*-1"),
        (lambda: sie.FromFunction("x", domain=(NAN, 1.0)), "nan"),
        (lambda: sie.FromFunction("x", domain=(1.0, 2.0, 3.0)), r"3\.0"),
        (lambda: sie.FromFunction("x", breaks=(5.0,), domain=(-1.0, 1.0)), "5"),
        (lambda: sie.FromFunction("x", parity="odd"), "odd"),
        (lambda: sie.FromFunction("x + 1", parity="even"), "even"),
        (lambda: sie.FromFunction("x", domain=(-1.0, 2.0), parity="even"), "even"),
        (lambda: sie.FromFunction("x", breaks=(0.5,), domain=(-1.0, 1.0), parity="even"), "even"),
        (lambda: sie.FromFunction(lambda x: x[:2]), "shape"),
        (lambda: sie.FromFunction(lambda x: x + 1j), "complex"),
        (lambda: sie.FromFunction(lambda x: [str(t) for t in x]), "type|float"),
        (lambda: sie.Elastic(1.0, 0.3, plane="bent"), "bent"),
    ],
)
def test_an_impossible_profile_or_body_is_refused_with_a_sentence(build, words):
    with pytest.raises(ValueError, match=rf"(?s){words}"):
        build()


@pytest.mark.parametrize(
    "function", [lambda x: np.where(x > 0.7, np.nan, x), lambda x: np.where(x > 0.7, np.inf, x)]
)
def test_a_slope_that_is_not_finite_is_refused_with_its_place(function):
    with pytest.raises(ValueError, match=r"nan|inf"):
        asked(scene(profile=sie.FromFunction(function, domain=(-1.0, 1.0)), normal_load=5.0))


def test_solve_and_with_refuse_unknown_names():
    solution = sie.solve(scene())
    with pytest.raises(ValueError, match="42"):
        sie.solve(42)
    with pytest.raises(ValueError, match="loads"):
        solution.with_(loads=3.0)
    with pytest.raises(ValueError, match="-3"):
        solution.with_(normal_load=-3.0)
    with pytest.raises(ValueError, match="magic"):
        sie.solve(scene(), economy=("magic",))
    with pytest.raises(ValueError, match="magic"):
        sie.plan(scene(), want="magic")


def wave(height, number, shift=0.0):
    """A parabola with a wave on it, as a function that is not known to be symmetric."""
    return sie.Parabola(1.0).shifted(shift) + sie.FromFunction(
        lambda x: height * np.sin(number * (x - shift)), breaks=()
    )


@pytest.mark.slow(but=4)
@pytest.mark.parametrize("shift", [0.0, 0.3, -1.7])
@pytest.mark.parametrize(
    ("height", "number", "load"), [(0.8, 8, 1), (0.5, 11, 0.5), (0.3, 30, 0.5)]
)
def test_waves_pressed_flat_are_one_contact_wherever_the_profile_lies(height, number, load, shift):
    solved = sie.solve(sie.Scene(profile=wave(height, number, shift), modulus=1, normal_load=load))
    assert solved.normal_load == load and solved.centre == pytest.approx(shift, abs=1e-12)
    assert solved.pressure.resultant == pytest.approx(load, rel=1e-12)


@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_sliding_dissimilar_bodies_that_lift_off_in_between_are_refused_with_the_place(shift):
    """Patches of them are not solved: one patch would need tension between two valleys."""
    wells = sie.Polynomial((0.0, 0.0, -0.25, 0.0, 0.25)).shifted(shift)
    given = {"profile": wells, "modulus": 1.0, "friction": 0.3, "sliding": 1, "normal_load": 0.19}
    with pytest.raises(sie.InequalityError, match=r"x in \[.*dundurs = 0") as caught:
        _ = sie.solve(sie.Scene(**given, dundurs=0.2)).edges
    ((lo, hi),) = caught.value.reached["tension"]
    assert lo < shift < hi
    assert len(sie.solve(sie.Scene(**given)).patches) == 2


def test_a_contact_error_survives_a_process_pool():
    with pytest.raises(sie.LoadError) as caught:
        asked(scene(profile=sie.Flat(1.0), normal_load=1.0, moment=2.0))
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is sie.LoadError
    assert str(again) == str(caught.value)
    assert again.reached == caught.value.reached


def test_noise_is_distinguished_from_a_profile():
    rng = np.random.default_rng(0)
    noisy = sie.FromFunction(lambda x: x + 1e-3 * rng.normal(size=np.shape(x)), domain=(-1.0, 1.0))
    with pytest.raises(sie.ResolutionError, match="settle"):
        asked(scene(profile=noisy, normal_load=0.1))


def test_a_corner_that_points_into_the_indenter_is_no_contact_of_a_half_width():
    """p is -inf there, on a part that may be too short for doubles."""
    concave = sie.Piecewise((-0.3, 0.0, 0.3), ((0.0, 1.0), (0.1, 1.0), (-0.1, 1.0), (0.0, 1.0)))
    with pytest.raises(sie.LoadError, match=r"not that of one patch.* give normal_load"):
        _ = sie.solve(sie.Scene(profile=concave, modulus=1.0, half_width=0.5)).edges


SHEARED = sie.solve(scene(profile=sie.Parabola(1.0), friction=0.4, tangential_load=0.1))
CYCLE = sie.Cycle(sie.follow(SHEARED.scene, sie.Path([(1.0, 0.2), (1.0, -0.2)])))
LOADED = sie.Path([(1.0, 0.0)])
RAGGED = [[0.1], [0.2, 0.3]]
# Wherever a caller gives a list, a name or an object: (the call, its name in the message).
GIVEN = {
    "polynomial": (sie.Polynomial, "coefficients"),
    "breaks of pieces": (lambda v: sie.Piecewise(v, ((0.0, 1.0),)), "breaks"),
    "pieces": (lambda v: sie.Piecewise((-1.0, 1.0), v), "pieces"),
    "breaks of a function": (lambda v: sie.FromFunction("x", breaks=v), "breaks"),
    "domain": (lambda v: sie.FromFunction("x", domain=v), "domain"),
    "parity": (lambda v: sie.FromFunction("x", parity=v), "parity"),
    "columns": (lambda v: sie.Sampled.read("trace.csv", columns=v), "columns"),
    "smoothing": (lambda v: sie.Sampled(range(5), range(5), smoothing=v), "smoothing"),
    "friction": (lambda v: scene(friction=v), "friction"),
    "sliding": (lambda v: scene(sliding=v), "sliding"),
    "economy": (lambda v: sie.solve(scene(), economy=v), "economy"),
    "a scene to plan": (sie.plan, "scene"),
    "a scene to follow": (lambda v: sie.follow(v, sie.Path([(1.0, 0.1)])), "scene"),
    "economy of a path": (lambda v: sie.follow(scene(), LOADED, economy=v), "economy"),
    "points": (sie.Path, "point"),
    "want of a plan": (lambda v: sie.plan(scene(), want=v), "want"),
    "want of a sweep": (lambda v: sie.sweep(scene(), over={"normal_load": [1.0]}, want=v), "want"),
    "over": (lambda v: sie.sweep(scene(), over=v), "over"),
    "chunk": (lambda v: sie.sweep(scene(), over={"normal_load": [1.0]}, chunk=v), "chunk"),
    "states": (sie.Cycle, "state|solution"),
    "term": (sie.superposed, "factor"),
    "factor": (lambda v: sie.scaled(v, SHEARED.pressure), "factor"),
    "side": (lambda v: SHEARED.pressure.cauchy(0.1, v), "side"),
    "criterion": (SHEARED.elastic_limit, "criterion"),
}
VALUES = {
    "a number": 7.5,
    "a complex number": 1j,
    "an object": object(),
    "bytes": b"ab",
    "an array with nan": np.array([0.3, np.nan]),
    "an empty array": np.array([]),
    "rows of unequal length": RAGGED,
    "a list of lists": [[[0.1]]],
}
MEANINGFUL = {
    "a number": ("friction", "smoothing", "factor"),
    "an empty array": ("breaks of pieces", "breaks of a function", "economy", "economy of a path"),
}
REFUSED = [(n, v) for n in GIVEN for v in VALUES if n not in MEANINGFUL.get(v, ())]


@pytest.mark.parametrize(("name", "value"), REFUSED)
def test_an_argument_of_the_wrong_type_is_refused_by_its_name(name, value):
    ask, named = GIVEN[name]
    with pytest.raises(ValueError, match=named) as refusal:
        ask(VALUES[value])
    assert "truth value" not in str(refusal.value)


QUERIES = {
    "pressure": SHEARED.pressure,
    "shear": SHEARED.shear,
    "slip": SHEARED.slip,
    "gap": SHEARED.gap,
    "stress": SHEARED.surface_stress,
    "potential": SHEARED.pressure.cauchy,
    "height": SHEARED.scene.profile.height,
    "slope": SHEARED.scene.profile.slope,
    "slip range": CYCLE.slip_range,
    "friction work": CYCLE.friction_work,
    "a range": lambda x: CYCLE.range(x, 0.5),
}


@pytest.mark.parametrize("name", QUERIES)
def test_positions_in_rows_of_unequal_length_are_refused_by_their_name(name):
    with pytest.raises(ValueError, match=r"[xyz] is not an array of"):
        QUERIES[name](RAGGED)


@pytest.mark.parametrize("x", [5e-324, -5e-324, 1e-310])
def test_the_height_of_a_function_is_taken_at_the_smallest_doubles(x):
    assert sie.FromFunction("sinh(x)").height(x) == pytest.approx(0.0, abs=1e-300)


@pytest.mark.parametrize("given", [{"normal_load": 1.0}, {"half_width": 0.5}])
@pytest.mark.parametrize("bodies", [{}, {"dundurs": 0.3, "friction": 0.3}])
def test_no_patches_are_sought_under_a_profile_without_lowest_point(monkeypatch, given, bodies):
    sought = []
    monkeypatch.setattr(sie.patches.answer, "several_patches", sought.append)
    scene = sie.Scene(profile=sie.Polynomial((0.0, 0.0, 0.5, 1e-3)), modulus=2.0, **given, **bodies)
    with pytest.raises(sie.LoadError, match="falls without bound to the left"):
        _ = sie.solve(scene).edges
    assert not sought
