"""What holds for all closed forms: both libraries, scaling, arrays, refusals."""

import inspect
import math
import re
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from closed_form_cases import EPS, POTENTIALS, UNIT
from closed_forms import OfEveryCall, call, every_call

import analytic
from analytic import (
    bonded_flat,
    cattaneo,
    cattaneo_rounded,
    cracks,
    flat,
    flat_row,
    hertz,
    parabola_row,
    power,
    rounded_flat,
    sliding_flat,
    sliding_hertz,
    sliding_rounded_flat,
    two_flats,
    two_parabolas,
    wavy,
    wedge,
)


def test_pressure_is_zero_outside_and_infinite_only_at_corners_and_apex() -> None:
    for case in POTENTIALS:
        x = np.array([-2.0, -1.0 - 2 * EPS, -1.0, 0.0, 1.0, 1.0 + 2 * EPS, 1e300])
        p = case.pressure(x)
        assert (p >= 0).all()
        assert p[[0, 1, 5, 6]].tolist() == [0, 0, 0, 0]
        infinite = set(x[np.isinf(p)].tolist())
        if case.module is wedge:
            assert infinite == {0.0}
        elif case.module is flat:
            M = case.given["moment"]
            assert infinite == ({-1.0, 1.0} if abs(M) < 1 else {math.copysign(1.0, M)})
        else:
            assert infinite == set()


# What is asked of a module, x and z at each of several places. Every function is called with those
# of its parameters that a question gives, where it gives all that the function requires.
ROUND = {"radius": 2.0, "modulus": 3.0}
PLACES = {"x": (0.2, 0.9), "z": (0.4, 0.4 + 0.2j, -4 + 0.2j)}
ON_RIM = {"half_flat": 0.3, **ROUND, "x": (0.2, 0.3000000005), "z": (0.2, 0.3000000005, -7 + 0.2j)}
UPRIGHT = {"half_width": 1.1, "normal_load": 2.0, "modulus": 3.0}
CORNERS = {**UPRIGHT, "x": (0.0, -0.999, 0.7), "z": (0.3, 0.3 + 0.1j, 300 + 5j)}
PRECISE = [
    *((rounded_flat, "", {**ON_RIM, **width})
      for width in ({"half_width": 1.1}, {"rim": 1e-9}, {"rim": 40.0}, {"normal_load": 0.7})),
    (hertz, "", {"half_width": 1.0, "normal_load": 0.7, **ROUND, **PLACES}),
    (wedge, "", {"half_width": 1.0, "normal_load": 0.7, "slope": 0.2, "modulus": 3.0, **PLACES}),
    *((power, "", {**UPRIGHT, "exponent": m, "coefficient": 0.2, **PLACES})
      for m in (1.5, 3.0, 6.2)),
    (flat, "", {**UPRIGHT, "moment": -0.3, **PLACES}),
    (flat, "moment", {**UPRIGHT, "tilt": 0.2}),
    (flat, "partial_", {**UPRIGHT, "moment": -1.3, "x": (-0.4,), "z": (-0.4,)}),
    (flat, "partial_moment", {**UPRIGHT, "tilt": 1.2}),
]  # fmt: skip
RUBBED = {"normal_load": 2.0, "friction": 0.3, "tangential_load": 0.35, "modulus": 3.0}
RETURNED = {"half_width": 1.0, "normal_load": 2.0, "friction": 0.3, "largest_load": 0.4}
RIM = {"normal_load": 0.3, "half_flat": 0.5, **ROUND, "friction": 0.3}
TWO = {"inner": 1.0, "outer": 2.0, "x": (1.0001, -1.5, 1.999)}
REPEATED = {"half_width": 0.6, "x": (0.1, -6.4, 0.5999), "z": (0.3, 0.9, -1.4 - 2j, 0.3 + 200j)}
OTHERS = [
    (cattaneo, "", {"half_width": 1.0, **RUBBED, "bulk_stress": 0.1, "x": (0.1, -0.9)}),
    (cattaneo, "unloading_", {**RETURNED, "tangential_load": 0.2, "x": (0.1,)}),
    (cattaneo, "reloading_",
     {**RETURNED, "least_load": -0.1, "tangential_load": 0.2, "x": (0.1,)}),
    *((cattaneo_rounded, "", {**RIM, "tangential_load": Q, "x": (0.1, -0.5, 0.52)})
      for Q in (0.05, 1e-9)),
    (cattaneo_rounded, "unloading_",
     {**RIM, "largest_load": 0.06, "tangential_load": 0.02, "x": (0.1,)}),
    (cattaneo_rounded, "reloading_",
     {**RIM, "largest_load": 0.06, "least_load": -0.01, "tangential_load": 0.02, "x": (0.1,)}),
    (cattaneo_rounded, "loading_",
     {"half_flat": 0.5, "half_width": 1.0, "stick_half_width": 0.7}),
    (sliding_hertz, "",
     {"half_width": 1.1, "normal_load": 0.7, **ROUND, "coupling": -0.49, **PLACES}),
    (sliding_flat, "", {**CORNERS, "coupling": 0.49, "moment": -0.2}),
    *((bonded_flat, "", {**CORNERS, "dundurs": beta, "shear_load": 0.7, "moment": -0.2})
      for beta in (0.4, -0.5)),
    (sliding_rounded_flat, "", {**RIM, "coupling": 0.49, "x": (-0.6, -0.4, 0.0, 0.5, 0.52)}),
    (two_flats, "",
     {**TWO, "normal_load": 3.0, "moment": -2.0, "modulus": 3.0, "z": (0.3, 1.2, 3e5 + 5j)}),
    *((two_parabolas, "", {**TWO, **ROUND, "distance": 1.5, "normal_load": P})
      for P in (1e-12, 1.0, 20.0)),
    (wavy, "", {**REPEATED, "wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0}),
    (wavy, "half_", {"mean_pressure": 0.7, "wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0}),
    (wavy, "complete_",
     {"mean_pressure": 7.0, "wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0, "x": (0.3,)}),
    (flat_row, "", {**REPEATED, "period": 2.0, "mean_pressure": 5.0}),
    *((parabola_row, "",
       {**REPEATED, "half_width": a, "mean_pressure": 0.7, "radius": 3.0, "period": 2.0,
        "modulus": 5.0, "x": (0.1, -6.4)})
      for a in (0.2, 0.99)),
    (cracks, "",
     {"inner": 0.1, "outer": 2.0, "half_length": 0.4, "period": 1.0, "tension": -3.0}),
]  # fmt: skip
PUBLIC = {
    f"{module}.{name}": function
    for module in analytic.__all__
    for name, function in vars(getattr(analytic, module)).items()
    if inspect.isfunction(function)
    and function.__module__ == f"analytic.{module}"
    and not name.startswith("_")
}


def calls(questions: list[Any]) -> list[tuple[Callable[..., Any], dict[str, Any]]]:
    """The functions of the modules that begin with a prefix, each with what it is asked."""
    found = []
    for module, prefix, given in questions:
        for name, function in PUBLIC.items():
            parameters = inspect.signature(function).parameters
            asked = {key: value for key, value in given.items() if key in parameters}
            required = {k for k, v in parameters.items() if v.default is v.empty}
            of_others = not prefix and name.split(".")[1].startswith(("partial_",))
            begins = name.startswith(f"{module.__name__.split('.')[1]}.{prefix}")
            listed = name == "flat.partial_edges"  # its edges are a list and no arrays
            if not begins or of_others or listed or not required <= asked.keys():
                continue
            if "rim" in parameters and not {"rim", "half_width"} & asked.keys():
                continue
            place = next((key for key in ("x", "z") if key in asked), None)
            places = [{place: value} for value in asked[place]] if place else [{}]
            found += [(function, {**at, **{k: v for k, v in asked.items() if k != place}})
                      for at in places]  # fmt: skip
    return found


CALLS, MORE = calls(PRECISE), calls(OTHERS)


@every_call(CALLS)
class TestEveryCall(OfEveryCall):
    near, of_arrays, of_scales = 1e-14, 8, 200
    digits, more, last = 50, 120, "1e-46"
    bad = (*OfEveryCall.bad, -math.inf, 0.0, -1.0, None, 1j)


@every_call(MORE)
class TestEveryOtherCall(OfEveryCall):
    pass


def test_every_closed_form_is_called():
    """Those of Spence and Goodman take one number of each, those of the interior have many."""
    apart = {"spence", "goodman", "interior"}
    called = {f"{f.__module__[9:]}.{f.__name__}" for f, _ in [*CALLS, *MORE]}
    left = {name for name in PUBLIC if name.split(".")[0] not in apart} - called
    assert left <= {"rounded_flat.chebyshev_coefficients", "flat.partial_edges"}


EXTREMES = [1e-300, 1e-200, 1e-151, 1e151, 1e200, 1e300]


@every_call(CALLS)
def test_a_parameter_of_any_size_is_answered_in_numbers_or_refused_with_a_remedy(
    function: Callable[..., Any], given: dict[str, Any]
) -> None:
    for name in given.keys() - {"x", "z"}:
        for size in EXTREMES:
            value = value_or_refusal(function, {**given, name: size})
            assert "; " in value if isinstance(value, str) else not np.isnan(value)


def value_or_refusal(function: Callable[..., Any], given: dict[str, Any]) -> Any:
    try:
        return call(function, given)
    except ValueError as refusal:
        return str(refusal)


REFUSED = {
    "exponent = 1000000.0 is not a single number from 1 to 1000": (
        power.load, {"half_width": 1.0, "exponent": 1e6, "coefficient": 1.0, "modulus": 1.0}
    ),
    "rim = -1.0 is not zero or positive; give ": (
        rounded_flat.load, {"half_flat": 0.5, "rim": -1.0, **UNIT}
    ),
    "exactly one": (rounded_flat.load, {"half_flat": 0.5, **UNIT}),
    "half_width = 0.5 is less than half_flat = 1.0": (
        rounded_flat.load, {"half_flat": 1.0, "half_width": 0.5, **UNIT}
    ),
    "radius = -2.0": (
        hertz.load, {"half_width": 1.0, "radius": np.array([1.0, -2.0, -3.0]), "modulus": 1.0}
    ),
    "x has masked entries": (
        hertz.height, {"x": np.ma.array([0.1, 0.2], mask=[0, 1]), "radius": 1.0}
    ),
}  # fmt: skip


@pytest.mark.parametrize("said", REFUSED)
def test_a_parameter_without_a_meaning_is_refused_with_its_value(said: str) -> None:
    function, given = REFUSED[said]
    with pytest.raises(ValueError, match=re.escape(said)):
        function(**given)


@pytest.mark.parametrize("side", [0, 2, 0.5, None, np.array([1, -1]), np.array([])])
def test_a_side_is_plus_or_minus_one(side: Any) -> None:
    for case in POTENTIALS:
        with pytest.raises(ValueError, match="side = "):
            case.potential(0.3, side=side)


def test_a_moment_that_lifts_a_corner_is_refused_with_its_numbers() -> None:
    given = {"half_width": 1.0, "normal_load": 2.0}
    with pytest.raises(ValueError, match=r"1\.05.* exceeds half_width/2 = 0\.5.*partial_pressure"):
        flat.pressure(0.0, **given, moment=2.1)
    with pytest.raises(ValueError, match="lifts off"):
        flat.moment(**given, tilt=9.0, modulus=1.0)
    with pytest.raises(ValueError, match="both corners touch"):
        flat.partial_pressure(0.0, **given, moment=0.9)
    with pytest.raises(ValueError, match="both corners touch"):
        flat.partial_moment(**given, tilt=0.1, modulus=1.0)
    with pytest.raises(ValueError, match="tip over"):
        flat.partial_tilt(**given, moment=-2.0, modulus=1.0)


HEIGHTS = {
    "hertz": lambda x: hertz.height(x, radius=1.0),
    "power": lambda x: power.height(x, exponent=2.0, coefficient=1.0),
    "slope of power": lambda x: power.slope(x, exponent=3.0, coefficient=1.0),
    "rounded_flat": lambda x: rounded_flat.height(x, half_flat=1.0, radius=1.0),
    "two_parabolas": lambda x: two_parabolas.height(x, distance=1.0, radius=1.0),
}


@pytest.mark.parametrize("name", HEIGHTS)
@pytest.mark.parametrize("x", [1e300, np.array([0.0, 1e300])], ids=["number", "array"])
def test_a_height_beyond_doubles_is_refused_with_its_place(name, x):
    with pytest.raises(ValueError, match=r"x = 1e\+300 is more than the largest double"):
        HEIGHTS[name](x)


def test_a_docstring_names_every_parameter_with_its_meaning():
    for name, function in PUBLIC.items():
        described = re.findall(r"^(\w+) : .+\n    [A-Z]", inspect.getdoc(function), re.MULTILINE)
        assert described == list(inspect.signature(function).parameters), name


def test_a_docstring_has_the_sections_of_numpydoc_in_their_order():
    for name, function in PUBLIC.items():
        lines = inspect.getdoc(function).splitlines()
        sections = [word for word, rule in pairwise(lines) if rule and not rule.strip("-")]
        expected = ["Parameters", "Returns", "Raises", "References", "Examples"]
        assert [word for word in sections if word != "Notes"] == expected, name
