"""Contexts, principal values, and laws that any function of `analytic` keeps."""

import math
from collections.abc import Callable, Sequence
from itertools import product
from typing import Any

import mpmath
import numpy as np
import pytest

EPS = float(np.finfo(float).eps)

coarse = mpmath.MPContext()  # quadrature to 30 digits ...
coarse.dps = 30
mp = mpmath.MPContext()  # ... of functions at 60, which tell points next to an end from the end
mp.dps = 60
short = mpmath.MPContext()  # for functions that are costly in many digits
short.dps = 25

Form = Callable[..., Any]
Given = dict[str, Any]
Call = tuple[Form, Given]

STRESS = {
    "pressure", "peak_pressure", "mean_pressure", "closing_pressure", "complete_pressure",
    "shear", "unloading_shear", "reloading_shear", "bulk_shear", "potential",
}  # fmt: skip
NUMBERS = {"tilt", "slope", "loading_ratio"}
MOMENTS = {"moment", "upright_moment", "largest_moment", "dissipation"}
LENGTHS = (
    "x", "z", "half_length", "half_flat", "half_width", "rim", "radius", "inner", "outer",
    "distance", "wavelength", "amplitude", "period", "stick_half_width",
)  # fmt: skip
LOADS = ("normal_load", "shear_load", "tangential_load", "largest_load", "least_load")
# Powers of length and stress
UNITS = {
    **dict.fromkeys(LENGTHS, (1, 0)),
    **dict.fromkeys(("modulus", "mean_pressure", "bulk_stress", "tension"), (0, 1)),
    **dict.fromkeys(LOADS, (1, 1)),
    "moment": (2, 1),
}


def every_call(calls: Sequence[Call]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(
        ("function", "given"), calls, ids=[f"{f.__module__[9:]}.{f.__name__}" for f, _ in calls]
    )


def call(function: Form, given: Given, **options: Any) -> Any:
    """The value of the call with its position first, as users write it."""
    rest = {name: value for name, value in given.items() if name not in ("x", "z")}
    return function(*(given[name] for name in ("x", "z") if name in given), **rest, **options)


def several(value: Any) -> list[Any]:
    return list(value) if isinstance(value, tuple) else [value]


def is_good(name: str, value: Any) -> bool:
    """Whether a value that is bad as a modulus has a meaning under this name."""
    if name in ("x", "z", "moment", "tilt", "half_flat", "rim") and value in (0, -1):
        return True  # or, below zero, is refused by a test of its own
    return (name == "z" and value == 1j) or (name in ("half_width", "rim") and value is None)


def pairs(one: Any, other: Any) -> Any:
    return zip(several(one), several(other), strict=True)


def digits(number: int) -> Any:
    context = mpmath.MPContext()
    context.dps = number
    return context


class OfEveryCall:
    """What every closed form passes; a subclass is parametrised by `every_call`.

    Those of one contact and no friction are held to more digits, and refuse more.
    """

    near, of_arrays, of_scales = 1e-13, 64, 1000
    digits, more, last = 25, 40, "1e-22"
    bad: tuple[Any, ...] = (math.nan, math.inf, "one")

    def test_numpy_and_mpmath_agree(self, function: Form, given: Given) -> None:
        exact = call(function, given, lib=digits(self.digits))
        for value, right in pairs(call(function, given), exact):
            assert abs(complex(value) - complex(right)) <= self.near * abs(complex(right))

    def test_a_context_gives_all_its_digits(self, function: Form, given: Given) -> None:
        before, many = mpmath.mp.dps, digits(self.more)
        found, exact = (call(function, given, lib=lib) for lib in (digits(self.digits), many))
        for value, right in pairs(found, exact):
            assert abs(many.convert(value) - right) <= many.mpf(self.last) * abs(right)
        assert mpmath.mp.dps == before

    def test_arrays_broadcast(self, function: Form, given: Given) -> None:
        grown = {
            name: np.full((3, 1) if i % 2 else 4, value)
            for i, (name, value) in enumerate(given.items())
            if name != "exponent"
        }
        expected = np.shape(np.broadcast_arrays(*grown.values())[0])
        for grid, one in pairs(call(function, given | grown), call(function, given)):
            assert np.shape(grid) == expected and np.ndim(one) == 0
            np.testing.assert_allclose(grid, one, rtol=self.of_arrays * EPS, atol=0)

    @pytest.mark.parametrize(("length", "stress"), [(2.0**-300, 2.0**330), (2.0**300, 2.0**-330)])
    def test_results_scale_with_lengths_and_moduli(
        self, function: Form, given: Given, length: float, stress: float
    ) -> None:
        """Powers of 2, or positions next to an end would be rounded."""
        exponent = given.get("exponent", 1.0)
        if exponent > 3:
            return  # the coefficient leaves the doubles
        units = UNITS | {"coefficient": (1.0 - exponent, 0)}
        scaled = {}
        for name, value in given.items():
            of_length, of_stress = units.get(name, (0, 0))
            scaled[name] = value * length**of_length * stress**of_stress
        by = {
            **dict.fromkeys(STRESS, stress),
            **dict.fromkeys(NUMBERS, 1.0),
            **dict.fromkeys(MOMENTS, stress * length * length),
            **dict.fromkeys(("pair", "row"), stress * math.sqrt(length)),
            "load": stress * length,
            "potential_derivative": stress / length,
        }.get(function.__name__.removeprefix("partial_"), length)
        for value, one in pairs(call(function, scaled), call(function, given)):
            assert abs(value - one * by) <= self.of_scales * EPS * abs(one * by)

    def test_bad_numbers_are_refused(self, function: Form, given: Given) -> None:
        for name, bad, lib in product(given, self.bad, (np, digits(self.digits))):
            if not is_good(name, bad):
                with pytest.raises(ValueError, match=rf"{name} = .*; "):
                    call(function, {**given, name: bad}, lib=lib)


def principal_value(density: Callable[[Any], Any], x: float, breaks: Sequence[Any]) -> Any:
    """(1/pi) PV∫ density(t)/(x-t) dt from the first to the last of `breaks`, 30 digits, by t = m +
    r cos(angle).

    PV∫ dt/((x-t) sqrt(r² - (t-m)²)) = 0 takes the pole away, and the angle the square roots at the
    ends.
    """
    lo, hi = mp.convert(breaks[0]), mp.convert(breaks[-1])
    m, r = (lo + hi) / 2, (hi - lo) / 2
    at_pole = mp.acos((mp.convert(x) - m) / r)
    pole = m + r * mp.cos(coarse.convert(at_pole))
    known = density(pole) * r * mp.sin(coarse.convert(at_pole))

    def integrand(angle: Any) -> Any:
        cosine, sine = mp.cos_sin(mp.convert(angle))
        t = m + r * cosine
        value = density(t)
        # Closer to the pole or to a corner than 30 digits resolve
        if t == pole or mp.isinf(value):
            return coarse.zero
        return coarse.convert((value * r * sine - known) / (pole - t))

    inner = [coarse.convert(mp.acos((mp.convert(v) - m) / r)) for v in breaks[1:-1]]
    angles = sorted({coarse.zero, *inner, coarse.convert(at_pole), +coarse.pi})
    return coarse.quad(integrand, angles) / coarse.pi, pole


def resultant(
    density: Callable[[Any], Any], breaks: Sequence[Any], weight: Callable[[Any], Any] = lambda t: 1
) -> Any:
    """∫ density(t) weight(t) dt over `breaks`, 30 digits, by the same angle."""
    lo, hi = mp.convert(breaks[0]), mp.convert(breaks[-1])
    m, r = (lo + hi) / 2, (hi - lo) / 2

    def integrand(angle: Any) -> Any:
        cosine, sine = mp.cos_sin(mp.convert(angle))
        t = m + r * cosine
        value = density(t)
        return coarse.zero if mp.isinf(value) else coarse.convert(value * weight(t) * r * sine)

    inner = [coarse.convert(mp.acos((mp.convert(v) - m) / r)) for v in breaks[1:-1]]
    return coarse.quad(integrand, sorted({coarse.zero, *inner, +coarse.pi}))
