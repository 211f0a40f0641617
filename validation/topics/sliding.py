"""Sliding and bonded contacts of dissimilar bodies (Dundurs' β ≠ 0) against closed forms in 30
digits.

In full sliding q = f p, tan πε = -βf, and the edges' exponents are 1/2 ± ε: the parabola (Hills,
Nowell & Sackfield 1993), the sharp flat (Muskhelishvili 1953, § 114 a), the flat with rounded
edges. In full stick the pressure and the shear of a flat punch oscillate, p + iq ~ (b² - x²)^(-1/2)
exp(iη ln((b+x)/(b-x))), tanh πη = β. The closed forms share no code with the solver. Errors are
over the largest value at points within 0.99 of the half-width, potentials at depths from 1e-8 to
100 half-widths over themselves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

import sie
from analytic import bonded_flat, sliding_flat, sliding_hertz, sliding_rounded_flat
from oracles.principal_value import context
from validation.harness.measures import apart, largest, relative
from validation.harness.records import Claim, Curve, Doing, Record, Table

TITLE = "Dissimilar bodies: sliding, and full stick"
SECONDS = (2.0, 3.0)
TIMED = False
BAR = 1e-13
SPOILED = 1e-11
mp = context(30)
COUPLINGS = (1e-8, 1e-3, 0.1, 0.3, -0.3, 0.49)
QUICK = (0.1, -0.3, 0.49)
PLACES = np.array([-0.99, -0.72, -0.31, 0.07, 0.44, 0.81, 0.99])
DEPTHS = (1e-8, 1e-3, 0.1, 1.0, 100.0)
SHOWN = (0.0, 0.1, 0.3, 0.49)


@dataclass(frozen=True)
class Slider:
    """A profile with E* = 1 and a half-width or load; closed forms of x or z and of βf, the
    pressure in NumPy or mpmath.
    """

    name: str
    profile: sie.Profile
    loads: dict[str, Any]
    pressure: Callable[[Any, float, Any], Any]
    potential: Callable[[Any, float], Any] | None = None
    moment: Callable[[float], Any] | None = None

    def solve(self, coupling: float) -> sie.Solution:
        """βf = coupling with f = 2."""
        sliding: dict[str, Any] = {"dundurs": 0.5 * coupling, "friction": 2.0, "sliding": 1}
        return sie.solve(sie.Scene(profile=self.profile, modulus=1.0, **sliding, **self.loads))


def _closed_forms(module: ModuleType, given: dict[str, Any], moment: str = "moment") -> Any:
    """Pressure, potential and moment of a module of `analytic`, as a slider has them."""
    return (
        lambda x, k, lib: module.pressure(x, **given, coupling=k, lib=lib),
        lambda z, k: module.potential(z, **given, coupling=k, lib=mp),
        lambda k: getattr(module, moment)(**given, coupling=k, lib=mp),
    )


HERTZ: dict[str, Any] = {"half_width": 1.0, "radius": 1.0, "modulus": 1.0}
FLAT: dict[str, Any] = {"half_width": 1.0, "normal_load": 1.0}
PUNCH = {"normal_load": 0.3, "half_flat": 0.5, "radius": 1.0, "modulus": 1.0}
SLIDERS = (
    Slider(
        "parabola",
        sie.Parabola(1.0),
        {"half_width": 1.0},
        *_closed_forms(sliding_hertz, HERTZ),
    ),
    Slider(
        "flat",
        sie.Flat(1.0),
        {"normal_load": 1.0},
        *_closed_forms(sliding_flat, FLAT, moment="upright_moment"),
    ),
    Slider(
        "rounded flat",
        sie.RoundedFlat(0.5, 1.0),
        {"normal_load": 0.3},
        lambda x, k, lib: sliding_rounded_flat.pressure(x, **PUNCH, coupling=k, lib=lib),
        moment=lambda k: sliding_rounded_flat.moment(**PUNCH, coupling=k, lib=mp),
    ),
)


def compute(quick: bool) -> Iterator[Record]:
    rows, couplings = [], QUICK if quick else COUPLINGS
    for slider in SLIDERS:
        yield Doing(slider.name)
        found = [judged(slider, k) for k in couplings]
        yield from _claims(slider, found)
        rows += [(slider.name, k, *row) for k, row in zip(couplings, found, strict=True)]
        for k in SHOWN:
            yield from _drawn(slider, k)
    header = (
        "profile",
        "βf",
        "error of p / peak",
        "of the moment / P r",
        "of the potential",
        "certificate",
    )
    yield Table("Full sliding, E* = 1", header, rows)
    yield Doing("full stick")
    yield from full_stick(quick)


def judged(
    slider: Slider, coupling: float, factor: float = 1.0, truth: float | None = None
) -> tuple[float, float, float | None, float]:
    """Errors of pressure, moment and potential, and the certificate's estimate; `truth` is the βf
    of the closed form.
    """
    solution, k = slider.solve(coupling), mp.mpf(coupling if truth is None else truth)
    x = solution.centre + solution.half_width * PLACES
    p = apart(solution.pressure(x), [slider.pressure(mp.mpf(v), k, mp) for v in x.tolist()], factor)
    assert slider.moment is not None
    arm = solution.normal_load * solution.half_width
    moment = abs(float(mp.mpf(factor * solution.moment) - slider.moment(k))) / arm
    potential = None if slider.potential is None else _of_potential(slider, solution, k, factor)
    return p, moment, potential, solution.check().error


def _of_potential(slider: Slider, solution: sie.Solution, k: Any, factor: float) -> float:
    assert slider.potential is not None
    z = np.array([x + 1j * y for x in (-0.6, 0.3, 1.4) for y in DEPTHS])
    found = factor * solution.pressure.cauchy(z)
    return largest(
        apart([f], [slider.potential(mp.mpc(v), k)]) for f, v in zip(found, z.tolist(), strict=True)
    )


def _claims(
    slider: Slider, found: list[tuple[float, float, float | None, float]]
) -> Iterator[Claim]:
    right, by = slider.name, "both packages"
    wrong, named = judged(slider, 0.3, truth=-0.3), "the closed form with β of the other sign"
    for k, error in enumerate(("the pressure / peak", "the moment / P r")):
        name = f"sliding {right}: largest error of {error}"
        yield Claim(name, by, largest(f[k] or 0.0 for f in found), wrong[k] or 0.0, named, high=BAR)
    if found[0][2] is not None:
        spoiled = judged(slider, 0.3, 1.0 + SPOILED)[2] or 0.0
        yield Claim(
            f"sliding {right}: largest relative error of the potential, 1e-8 to 100 half-widths "
            f"deep",
            by,
            largest(f[2] or 0.0 for f in found),
            spoiled,
            f"potentials off by {SPOILED:.0e}",
            high=BAR,
        )


def _drawn(slider: Slider, k: float) -> Iterator[Curve]:
    solution = slider.solve(k)
    scale = solution.half_width / solution.normal_load
    inside = np.cos(np.linspace(np.pi, 0.0, 161)[1:-1])
    x = solution.centre + solution.half_width * inside
    if not any(solution.sharp):
        x = np.concatenate((solution.edges[:1], x, solution.edges[1:]))
    yield Curve(f"p: {slider.name}", f"βf = {k:g}", x, scale * solution.pressure(x))
    marks = solution.centre + solution.half_width * PLACES[1:-1]
    yield Curve(
        f"p: {slider.name} points", "", marks, scale * slider.pressure(marks, k, np), "points"
    )


# -- full stick -----------------------------------------------------------------------------------


def full_stick(quick: bool) -> Iterator[Record]:
    P, Q, M = 1.0, -0.4, 0.2
    betas = (0.3, -0.49) if quick else (1e-8, 0.1, 0.3, -0.49)
    yield Claim(
        "bonded flat: largest error of p + iq / largest value", "both packages",
        largest(_bonded(beta, P, Q, beta) for beta in betas),
        _bonded(0.3, P, Q, -0.3), "the closed form with β of the other sign", high=BAR,
    )  # fmt: skip
    tilts = {beta: sie.solve(_bonded_scene(beta, P, Q, moment=M)).tilt for beta in betas}
    yield Claim(
        "bonded flat: largest relative error of the tilt under a moment", "both packages",
        largest(relative(tilt, _exact_tilt(beta, Q, M)) for beta, tilt in tilts.items()),
        relative(tilts[0.3], _exact_tilt(0.3, Q, 0.2001)), "a moment off by 0.05 %", high=BAR,
    )  # fmt: skip
    solution = sie.solve(_bonded_scene(0.3, P, Q))
    x = np.cos(np.linspace(np.pi, 0.0, 201)[3:-3])
    yield Curve("bonded", "p b/P", x, solution.pressure(x) / P)
    yield Curve("bonded", "q b/P", x, solution.shear(x) / P, "dashed")
    exact = [_exact_traction(v, 0.3, P, Q) for v in PLACES[1:-1].tolist()]
    parts = [float(v.real) for v in exact] + [float(v.imag) for v in exact]
    yield Curve("bonded points", "", [*PLACES[1:-1], *PLACES[1:-1]], parts, "points")


def _exact_tilt(beta: float, Q: float, M: float) -> Any:
    given = {"half_width": 1.0, "modulus": 1.0, "lib": mp, "shear_load": Q}
    return bonded_flat.tilt(**given, dundurs=mp.mpf(beta), moment=mp.mpf(M))


def _bonded_scene(beta: float, P: float, Q: float, moment: float = 0.0) -> sie.Scene:
    """Free to tilt, as Q makes it do where β ≠ 0."""
    loads: dict[str, Any] = {
        "normal_load": P,
        "tangential_load": Q,
        "moment": moment,
        "friction": math.inf,
    }
    return sie.Scene(profile=sie.Flat(1.0), modulus=1.0, dundurs=beta, **loads)


def _exact_traction(x: float, beta: float, P: float, Q: float) -> Any:
    given = {
        "half_width": 1.0,
        "normal_load": P,
        "dundurs": mp.mpf(beta),
        "shear_load": mp.mpf(Q),
        "lib": mp,
    }
    return mp.mpc(bonded_flat.pressure(mp.mpf(x), **given), bonded_flat.shear(mp.mpf(x), **given))


def _bonded(beta: float, P: float, Q: float, truth: float) -> float:
    solution = sie.solve(_bonded_scene(beta, P, Q))
    found = np.asarray(solution.pressure(PLACES)) + 1j * np.asarray(solution.shear(PLACES))
    return apart(found, [_exact_traction(v, truth, P, Q) for v in PLACES.tolist()])


# -- drawing --------------------------------------------------------------------------------------
