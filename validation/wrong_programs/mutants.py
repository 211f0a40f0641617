"""Wrong programs by name, each with its checker: errors from 1 to 1e-12 of the pressure.

Some are formulas with a term wrong in place of the pressure; the others are this package itself
with one of its parts replaced while it solves. The certificate catches answers that do not satisfy
the equations. A wrong input (a constant, the sign of β) satisfies wrong equations perfectly, and
only a closed form that shares no code shows the error.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from typing import Any
from unittest.mock import PropertyMock, patch

import numpy as np

import sie
from analytic import hertz, rounded_flat, sliding_hertz
from sie.contact import pressure
from sie.traction import potential
from validation.harness.measures import largest
from validation.rivals import solvers
from validation.wrong_programs.parts import PARTS
from validation.wrong_programs.pressures import (
    PUNCH,
    SKEW,
    SMOOTH,
    closed_form,
    gauss_chebyshev,
    root,
    with_pressure,
)

BAR = 1e-13  # the measure of a right program is below it, that of a wrong one above
X = np.array([-0.9, -0.42, 0.03, 0.31, 0.77])


@dataclass(frozen=True)
class Mutant:
    """`number(wrong)` is what the checker measures, of the wrong program or of the right one."""

    name: str
    says: str
    checker: str
    number: Callable[[bool], float]


# -- formulas with a term wrong -------------------------------------------------------------------


def stand_in(
    name: str, says: str, scene: sie.Scene, values: Callable[[], Any], **claims: Any
) -> Mutant:
    """A solution with another pressure, for the certificate."""

    def number(wrong: bool) -> float:
        if not wrong:
            return sie.solve(scene).check().error
        with np.errstate(all="ignore"):
            return with_pressure(scene, values(), **claims).check().error

    return Mutant(name, says, "certificate", number)


def _scaled(factor: float) -> Callable[[], Any]:
    return lambda: lambda x: factor * sie.solve(PUNCH).pressure(x)


def _half_panel() -> Any:
    """Half of the right rounded edge is left out of the integral."""
    slope = PUNCH.profile.slope
    return lambda x: solvers.gauss_chebyshev(
        lambda t: np.where(t > 0.75, 0.0, slope(t)), -1.0, 1.0, 400, np.clip(x, -1.0, 1.0)
    )


def _transposed() -> Any:
    solution = sie.solve(SKEW)
    return lambda x: solution.pressure(2 * solution.centre - x)


STAND_INS = (
    stand_in("flipped logarithm", "second logarithm of (32) with the other sign", PUNCH,
             lambda: lambda x: closed_form(x, second=-1.0)),
    stand_in("dropped logarithm", "second logarithm of (32) left out", PUNCH,
             lambda: lambda x: closed_form(x, second=0.0)),
    stand_in("logarithm off by 1e-11", "its factor 1 + 1e-11", PUNCH,
             lambda: lambda x: closed_form(x, second=1 + 1e-11)),
    stand_in("edge off by 1e-12", "the pressure of a wider contact", PUNCH,
             lambda: lambda x: closed_form(x, b=1 + 1e-12)),
    stand_in("unscaled load", "pressure of twice the load", PUNCH, _scaled(2.0)),
    stand_in("scaled by 1 + 1e-12", "load off in the twelfth digit", PUNCH, _scaled(1 + 1e-12)),
    stand_in(
        "wrong weight", "sqrt(b² - x²) in place of its inverse and back: p (1 - x²)", PUNCH,
        lambda: lambda x: sie.solve(PUNCH).pressure(x) * (1 - np.minimum(x * x, 1)),
    ),
    stand_in(
        "homogeneous solution", "1.5e-13/w added, which the residual of (1) does not show", PUNCH,
        lambda: lambda x: sie.solve(PUNCH).pressure(x) + 1e-13 * 1.5 / root(x),
    ),
    stand_in("half panel", "half of the right arc left out of the integral", PUNCH, _half_panel),
    stand_in("transposed map", "s for -s: the mirror image of the pressure", SKEW, _transposed),
    stand_in("centre off by 1e-12", "the pressure shifted", SKEW,
             lambda: lambda x: sie.solve(SKEW).pressure(x - 1e-12)),
    stand_in("shifted node", "one of 40 Gauss-Chebyshev nodes moved by 1e-10", SMOOTH,
             lambda: gauss_chebyshev(SMOOTH, shift=-1e-10)),
    stand_in("too few nodes", "8 nodes", SMOOTH, lambda: gauss_chebyshev(SMOOTH, n=8, at=0)),
    stand_in("wrong nodes", "off by 1e-10 of their spacing", SMOOTH,
             lambda: gauss_chebyshev(SMOOTH, half=1e-10)),
)  # fmt: skip


# -- this package, with a part replaced -----------------------------------------------------------


def replaced(
    name: str, says: str, part: Callable[[], AbstractContextManager[Any]], scene: sie.Scene,
    truth: Callable[[Any], Any] | None = None
) -> Mutant:  # fmt: skip
    """The package solves with a part replaced; its certificate or a closed form must show it.

    The closed form is that of `analytic` at points of the contact.
    """

    def number(wrong: bool) -> float:
        with part() if wrong else nullcontext(), np.errstate(all="ignore"):
            solution = sie.solve(scene)
            try:
                x = solution.centre + solution.half_width * X
                p = solution.pressure(x)
            except sie.ContactError:
                return float("inf")  # the program itself refuses
            if truth is None:
                return solution.check().error
        exact = truth(x)
        return float(np.abs(p - exact).max() / exact.max())

    return Mutant(name, says, "certificate" if truth is None else "closed form", number)


def _times(
    target: Any, name: str, change: Callable[[Any], Any]
) -> Callable[[], AbstractContextManager[Any]]:
    """`target.name` returns something else."""
    right = getattr(target, name)
    return lambda: patch.object(target, name, lambda *args, **given: change(right(*args, **given)))


def _property(name: str, change: Callable[[Any], Any]) -> Callable[[], AbstractContextManager[Any]]:
    get = getattr(sie.Scene, name).fget

    class Changed(PropertyMock):
        def __get__(self, instance: Any, owner: Any = None) -> Any:
            return change(get(instance))

    return lambda: patch.object(sie.Scene, name, new_callable=Changed)


HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=0.3)
GIVEN_LOAD = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.3)
SLIDING = sie.Scene(
    profile=sie.Parabola(1.0), modulus=1.0, dundurs=0.15, friction=2.0, sliding=1, half_width=1.0
)
SLIDING_RIM = sie.Scene(
    profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, dundurs=0.15, friction=2.0, sliding=1,
    half_width=1.0,
)  # fmt: skip
FLAT = sie.Scene(profile=sie.Flat(1.0), modulus=1.0, normal_load=1.0, tilt=0.125)


def _sliding_hertz(x: Any) -> Any:
    return sliding_hertz.pressure(x, half_width=1.0, radius=1.0, modulus=1.0, coupling=0.3)


def _hertz(x: Any) -> Any:
    return hertz.pressure(
        x,
        radius=1.0,
        modulus=1.0,
        half_width=float(hertz.half_width(normal_load=0.3, radius=1.0, modulus=1.0)),
    )


def _rounded(x: Any) -> Any:
    punch = {"half_flat": 0.5, "radius": 1.0, "modulus": 1.0}
    return rounded_flat.pressure(x, **punch, rim=rounded_flat.rim(normal_load=0.3, **punch))


def _off_by(share: float) -> Callable[[Any], Any]:
    return lambda values: values * (1 + share)


def _second_coefficient_off(density: Any) -> Any:
    return replace(
        density, series=density.series * (1 + 1e-10 * (np.arange(len(density.series)) == 1))
    )


REPLACED = (
    replaced("sign of β", "the edges' exponents the wrong way round",
             _property("epsilon", lambda e: -e), SLIDING, _sliding_hertz),
    replaced("β forgotten", "sliding of dissimilar bodies solved as similar",
             _property("epsilon", lambda e: 0.0), SLIDING, _sliding_hertz),
    replaced("E* of one body", "the modulus twice as large", _property("Estar", lambda E: 2 * E),
             HERTZ, _hertz),
    replaced("E* off by 1e-11", "the modulus off in the eleventh digit",
             _property("Estar", _off_by(1e-11)), GIVEN_LOAD, _rounded),
    replaced("panels off by 1e-11", "V of the contact",
             _times(potential, "on_contact", _off_by(1e-11)), GIVEN_LOAD),
    replaced("one Chebyshev coefficient", "the second of the transform off by 1e-10",
             _times(pressure, "TransformDensity", _second_coefficient_off), SMOOTH),
    replaced("frictional panels off by 1e-11", "V of the sliding contact",
             _times(potential, "on_contact", _off_by(1e-11)), SLIDING_RIM),
)  # fmt: skip


def _shear(name: str, says: str, right: dict[str, Any], wrong: dict[str, Any]) -> Mutant:
    """The shear of another load in place of the right one, judged by the certificate of the
    shear.
    """
    common: dict[str, Any] = {
        "profile": sie.RoundedFlat(0.5, 1.0),
        "modulus": 1.0,
        "normal_load": 0.3,
        "friction": 0.5,
    }

    def number(is_wrong: bool) -> float:
        solution = sie.solve(sie.Scene(**common, **right))
        if is_wrong:
            solution.__dict__["tangential"] = sie.solve(sie.Scene(**common, **wrong)).tangential
        shear = solution.check().shear
        assert shear is not None
        return largest((shear.residual, abs(shear.equilibrium), shear.excess, -shear.opposing))

    return Mutant(name, says, "certificate of the shear", number)


SHEARS = (
    _shear("shear of the other direction", "q for -q", {"tangential_load": 0.09},
           {"tangential_load": -0.09}),
    _shear("sign of the bulk stress", "the stick zone moved the wrong way",
           {"tangential_load": 0.09, "bulk_stress": 0.002},
           {"tangential_load": 0.09, "bulk_stress": -0.002}),
    _shear("stick zone of another load", "Q off by 1e-9", {"tangential_load": 0.09},
           {"tangential_load": 0.09 * (1 + 1e-9)}),
)  # fmt: skip

OF_PARTS = tuple(Mutant(name, says, "closed form", measure) for name, says, measure in PARTS)
MUTANTS = (*STAND_INS, *REPLACED, *SHEARS, *OF_PARTS)
