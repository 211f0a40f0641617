"""What holds for all closed forms: both libraries, scaling, arrays, refusals."""

import inspect
import math
import re
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from closed_form_cases import EPS, HERTZ, POTENTIALS, UNIT, WEDGE
from closed_forms import call, every_call, of_every_call

import analytic
from analytic import flat, hertz, power, rounded_flat, two_parabolas, wedge


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


CALLS: list[tuple[Callable[..., Any], dict[str, Any]]] = [
    (rounded_flat.height, {"x": 0.7, "half_flat": 0.3, "radius": 2.0}),
    (rounded_flat.slope, {"x": -0.7, "half_flat": 0.3, "radius": 2.0}),
    *(
        (function, {**place, "half_flat": 0.3, "radius": 2.0, "modulus": 3.0, **width})
        for width in ({"half_width": 1.1}, {"rim": 1e-9}, {"rim": 40.0})
        for function, place in (
            (rounded_flat.pressure, {"x": 0.2}),
            (rounded_flat.pressure, {"x": 0.3000000005}),
            (rounded_flat.load, {}),
            (rounded_flat.potential, {"z": 0.4 + 0.2j}),
            (rounded_flat.potential, {"z": 0.3000000005}),
            (rounded_flat.potential, {"z": -7 + 0.2j}),
            (rounded_flat.potential_derivative, {"z": 0.4 + 0.2j}),
            (rounded_flat.potential_derivative, {"z": 0.2}),
        )
    ),
    (rounded_flat.half_width,
     {"normal_load": 0.7, "half_flat": 0.3, "radius": 2.0, "modulus": 3.0}),
    (rounded_flat.rim, {"normal_load": 1e-15, "half_flat": 0.3, "radius": 2.0, "modulus": 3.0}),
    (hertz.height, {"x": 0.7, "radius": 2.0}),
    (hertz.slope, {"x": 0.7, "radius": 2.0}),
    (hertz.pressure, {"x": 0.7, **HERTZ}),
    (hertz.load, HERTZ),
    (hertz.peak_pressure, HERTZ),
    (hertz.half_width, {"normal_load": 0.7, "radius": 2.0, "modulus": 3.0}),
    (hertz.potential, {"z": 0.4 + 0.2j, **HERTZ}),
    (hertz.potential, {"z": 0.4, **HERTZ}),
    (hertz.potential_derivative, {"z": -4 + 0.2j, **HERTZ}),
    (hertz.potential_derivative, {"z": -0.4, **HERTZ}),
    (wedge.height, {"x": 0.7, "slope": 0.2}),
    (wedge.pressure, {"x": 0.7, **WEDGE}),
    (wedge.load, WEDGE),
    (wedge.half_width, {"normal_load": 0.7, "slope": 0.2, "modulus": 3.0}),
    (wedge.potential, {"z": 0.4 + 0.2j, **WEDGE}),
    (wedge.potential, {"z": 0.4, **WEDGE}),
    (wedge.potential_derivative, {"z": 0.4 + 0.2j, **WEDGE}),
    (wedge.potential_derivative, {"z": 0.4, **WEDGE}),
    *(
        (function, {**place, "half_width": 1.1, "exponent": m, "coefficient": 0.2, "modulus": 3.0})
        for m in (1.5, 3.0, 6.2)
        for function, place in (
            (power.pressure, {"x": 0.2}),
            (power.pressure, {"x": 0.9}),
            (power.load, {}),
        )
    ),
    (power.half_width, {"normal_load": 0.7, "exponent": 2.5, "coefficient": 0.2, "modulus": 3.0}),
    (power.height, {"x": -0.7, "exponent": 2.5, "coefficient": 0.2}),
    (power.slope, {"x": -0.7, "exponent": 2.5, "coefficient": 0.2}),
    *(
        (function, {**place, "half_width": 1.1, "normal_load": 2.0, "moment": -0.3})
        for function, place in (
            (flat.pressure, {"x": 0.4}),
            (flat.potential, {"z": 0.4}),
            (flat.potential, {"z": 4 - 1j}),
            (flat.potential_derivative, {"z": 0.4}),
            (flat.potential_derivative, {"z": 4 - 1j}),
            (flat.tilt, {"modulus": 3.0}),
        )
    ),
    (flat.moment, {"half_width": 1.1, "normal_load": 2.0, "tilt": 0.2, "modulus": 3.0}),
    *(
        (function, {**place, "half_width": 1.1, "normal_load": 2.0, "moment": -1.3})
        for function, place in (
            (flat.partial_pressure, {"x": -0.4}),
            (flat.partial_potential, {"z": -0.4}),
            (flat.partial_tilt, {"modulus": 3.0}),
        )
    ),
    (flat.partial_moment, {"half_width": 1.1, "normal_load": 2.0, "tilt": 1.2, "modulus": 3.0}),
]  # fmt: skip


TestEveryCall = of_every_call(CALLS, precise=True)


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


# -- what their docstrings say ---------------------------------------------------------------------


PUBLIC = {
    f"{module}.{name}": function
    for module in analytic.__all__
    for name, function in vars(getattr(analytic, module)).items()
    if inspect.isfunction(function)
    and function.__module__ == f"analytic.{module}"
    and not name.startswith("_")
}


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
