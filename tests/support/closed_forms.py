"""What the tests of the closed forms share: contexts, principal values, and laws that any function
of `analytic` keeps.
"""

import math
from collections.abc import Callable, Sequence
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
long = mpmath.MPContext()  # and to tell whether those digits are right
long.dps = 40

Form = Callable[..., Any]
Given = dict[str, Any]
Call = tuple[Form, Given]

STRESS = {
    "pressure",
    "shear",
    "potential",
    "mean_pressure",
    "closing_pressure",
    "complete_pressure",
}
STRESS |= {"unloading_shear", "reloading_shear", "bulk_shear"}
NUMBERS = {"tilt", "slope", "loading_ratio"}
MOMENTS = {"moment", "upright_moment", "largest_moment", "dissipation"}
UNITS = dict.fromkeys(
    (
        "half_length",
        "x",
        "z",
        "half_flat",
        "half_width",
        "radius",
        "inner",
        "outer",
        "distance",
        "wavelength",
        "amplitude",
    ),
    (1, 0),
)
UNITS |= dict.fromkeys(("period", "stick_half_width"), (1, 0)) | dict.fromkeys(
    ("modulus", "mean_pressure", "bulk_stress", "tension"), (0, 1)
)
UNITS |= dict.fromkeys(
    ("normal_load", "shear_load", "tangential_load", "largest_load", "least_load"), (1, 1)
) | {"moment": (2, 1)}


def every_call(calls: Sequence[Call]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(
        ("function", "given"), calls, ids=[f"{f.__module__[9:]}.{f.__name__}" for f, _ in calls]
    )


def call(function: Form, given: Given, **options: Any) -> Any:
    """The value, a pair as an array or list, of the call with its position first, as users write
    it.
    """
    rest = {name: value for name, value in given.items() if name not in ("x", "z")}
    return function(*(given[name] for name in ("x", "z") if name in given), **rest, **options)


def several(value: Any) -> list[Any]:
    return list(value) if isinstance(value, tuple) else [value]


def numpy_agrees_with_mpmath(function: Form, given: Given, bound: float = 1e-13) -> None:
    for value, exact in zip(
        several(call(function, given)), several(call(function, given, lib=short)), strict=True
    ):
        assert abs(complex(value) - complex(exact)) <= bound * abs(complex(exact))


def context_gives_its_digits(function: Form, given: Given) -> None:
    before = mpmath.mp.dps
    for value, exact in zip(
        several(call(function, given, lib=short)),
        several(call(function, given, lib=long)),
        strict=True,
    ):
        assert abs(long.convert(value) - exact) <= long.mpf("1e-22") * abs(exact)
    assert mpmath.mp.dps == before


def arrays_broadcast(function: Form, given: Given) -> None:
    grown = {
        name: np.full((3, 1) if i % 2 else 4, value)
        for i, (name, value) in enumerate(given.items())
    }
    expected = np.shape(np.broadcast_arrays(*grown.values())[0])
    for grid, one in zip(
        several(call(function, grown)), several(call(function, given)), strict=True
    ):
        assert grid.shape == expected
        np.testing.assert_allclose(grid, one, rtol=64 * EPS, atol=0)
        assert np.ndim(one) == 0


def scales(function: Form, given: Given, length: float, stress: float) -> None:
    """Length and stress are powers of 2, or positions next to an end would be rounded."""
    scaled = {
        name: value * length ** UNITS.get(name, (0, 0))[0] * stress ** UNITS.get(name, (0, 0))[1]
        for name, value in given.items()
    }
    kind = function.__name__
    by = {
        **dict.fromkeys(STRESS, stress),
        **dict.fromkeys(NUMBERS, 1.0),
        **dict.fromkeys(MOMENTS, stress * length * length),
    }
    by |= {
        "load": stress * length,
        "pair": stress * math.sqrt(length),
        "row": stress * math.sqrt(length),
    }
    for value, one in zip(
        several(call(function, scaled)), several(call(function, given)), strict=True
    ):
        assert abs(value - one * by.get(kind, length)) <= 1000 * EPS * abs(
            one * by.get(kind, length)
        )


def bad_numbers_are_refused(function: Form, given: Given) -> None:
    for name in given:
        for bad in (math.nan, math.inf, "one"):
            for lib in (np, short):
                with pytest.raises(ValueError, match=rf"{name} = .*; "):
                    call(function, {**given, name: bad}, lib=lib)


def of_every_call(calls: Sequence[Call]) -> type:
    """The tests that every closed form passes, as a class for pytest to collect."""
    each_call = every_call(calls)

    class OfEveryCall:
        @each_call
        def test_numpy_and_mpmath_agree(self, function: Form, given: Given) -> None:
            numpy_agrees_with_mpmath(function, given)

        @each_call
        def test_a_context_gives_all_its_digits(self, function: Form, given: Given) -> None:
            context_gives_its_digits(function, given)

        @each_call
        def test_arrays_broadcast(self, function: Form, given: Given) -> None:
            arrays_broadcast(function, given)

        @each_call
        @pytest.mark.parametrize(
            ("length", "stress"), [(2.0**-300, 2.0**330), (2.0**300, 2.0**-330)]
        )
        def test_results_scale_with_lengths_and_moduli(
            self, function: Form, given: Given, length: float, stress: float
        ) -> None:
            scales(function, given, length, stress)

        @each_call
        def test_bad_numbers_are_refused(self, function: Form, given: Given) -> None:
            bad_numbers_are_refused(function, given)

    return OfEveryCall


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
    """∫ density(t) weight(t) dt from the first to the last of `breaks`, 30 digits, by the same
    angle.
    """
    lo, hi = mp.convert(breaks[0]), mp.convert(breaks[-1])
    m, r = (lo + hi) / 2, (hi - lo) / 2

    def integrand(angle: Any) -> Any:
        cosine, sine = mp.cos_sin(mp.convert(angle))
        t = m + r * cosine
        value = density(t)
        return coarse.zero if mp.isinf(value) else coarse.convert(value * weight(t) * r * sine)

    inner = [coarse.convert(mp.acos((mp.convert(v) - m) / r)) for v in breaks[1:-1]]
    return coarse.quad(integrand, sorted({coarse.zero, *inner, +coarse.pi}))
