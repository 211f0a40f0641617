"""The equations (24) to (35) of the paper's appendix, each side to 50 digits.

The left-hand sides are principal values by quadrature in mpmath. Beside the right-hand sides stand
the forms that our copy of the paper prints where they differ, the closed forms of `analytic`, and
the answers of `sie` for profiles whose pressure is that integral: the rounded punch for (24), (25)
and (32), and for (29) and (31) a single step of the slope, whose pressure is E*/2 ln|...|.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

import sie
from analytic import rounded_flat
from oracles.principal_value import GUARD, context, integral, principal_value

DIGITS = 50
mp = context(DIGITS + GUARD)
few = context(12)


@dataclass(frozen=True)
class Setting:
    """One punch and one point: a, b, R and x as exact doubles; `spoiled` changes φ0 of the
    right-hand sides.
    """

    a: float
    b: float
    x: float
    R: float
    spoiled: Any = 0

    @cached_property
    def phi(self) -> Any:
        return mp.asin(mp.mpf(self.x) / self.b)

    @cached_property
    def phi0(self) -> Any:
        return mp.asin(mp.mpf(self.a) / self.b) * (1 + self.spoiled)

    @cached_property
    def xi(self) -> tuple[Any, Any]:
        """ξ and ξ0 of x and a, (28)."""
        return mp.tan(self.phi / 2), mp.tan(self.phi0 / 2)

    @cached_property
    def punch(self) -> dict[str, float]:
        return {"half_flat": self.a, "half_width": self.b, "radius": self.R, "modulus": 1.0}

    @cached_property
    def angles(self) -> dict[str, tuple[Any, Any]]:
        """The two ends of the rounded edge: the limits of the left-hand sides, never spoiled."""
        phi0 = mp.asin(mp.mpf(self.a) / self.b)
        return {"left": (-mp.pi / 2, -phi0), "right": (phi0, mp.pi / 2)}

    def over_rim(self, f: Callable[[Any], Any], side: str) -> Any:
        """PV∫ f(t) dt / (sqrt(b² - t²) (t - x)) over one rounded edge."""
        b, x = mp.mpf(self.b), mp.mpf(self.x)
        return principal_value(
            mp,
            lambda angle: f(b * mp.sin(angle)) / (b * mp.sin(angle) - x),
            self.phi,
            *self.angles[side],
        )

    @cached_property
    def cauchy(self) -> dict[str, Any]:
        return {side: self.over_rim(lambda t: mp.one, side) for side in self.angles}

    @cached_property
    def root(self) -> Any:
        return mp.sqrt((mp.mpf(self.b) - self.x) * (mp.mpf(self.b) + self.x))

    @cached_property
    def pressure(self) -> Any:
        """(24) with the sign of a pressure, E* = 1."""
        a = mp.mpf(self.a)
        both = self.over_rim(lambda t: a + t, "left") + self.over_rim(lambda t: t - a, "right")
        return self.root * both / (2 * mp.pi * self.R)


@dataclass(frozen=True)
class Equation:
    """`left` by quadrature, `right` as it should read, `printed` as our copy prints it where that
    differs.

    `numpy` and `exact` are the closed forms of `analytic`, `solver` the answer of `sie`; None where
    the equation is not one of theirs.
    """

    name: str
    says: str
    left: Callable[[Setting], Any]
    right: Callable[[Setting], Any]
    printed: Callable[[Setting], Any] | None = None
    erratum: str = ""
    closed: Callable[[Setting, Any], Any] | None = None
    solver: Callable[[Setting], Any] | None = None


def _logarithm(s: Setting, side: str) -> Any:
    """The right-hand sides of (31) without 1/(b cos φ)."""
    sin, cos = mp.sin, mp.cos
    if side == "left":
        return mp.log(abs(sin((s.phi + s.phi0) / 2) / cos((s.phi - s.phi0) / 2)))
    return mp.log(abs(cos((s.phi + s.phi0) / 2) / sin((s.phi - s.phi0) / 2)))


def _rational(s: Setting) -> Any:
    """(29) for the right rounded edge: ξ1 = ξ0, ξ2 = 1."""
    xi, one = s.xi[0], s.xi[1]
    return (
        (1 + xi**2)
        / (s.b * (1 - xi**2))
        * mp.log(abs((xi - 1) * (1 - xi * one) / ((xi - one) * (1 - xi))))
    )


def _substituted(s: Setting, kernel: Callable[[Any, Any], Any]) -> Any:
    """∫ kernel(τ, ξ) dτ over the right rounded edge, a principal value."""
    xi, start = s.xi
    return principal_value(mp, lambda t: kernel(t, xi), xi, start, mp.one)


def _closed_32(s: Setting) -> Any:
    sin, cos, tan, phi, phi0 = mp.sin, mp.cos, mp.tan, s.phi, s.phi0
    inside = (mp.pi - 2 * phi0) * cos(phi) / sin(phi0) + sin(phi) / sin(phi0) * mp.log(
        abs(sin(phi + phi0) / sin(phi - phi0))
    )
    return (
        (inside + mp.log(abs(tan((phi + phi0) / 2) * tan((phi - phi0) / 2))))
        * s.a
        / (2 * mp.pi * s.R)
    )


def _load_34(s: Setting, scale: Any) -> Any:
    sin, phi0 = mp.sin, s.phi0
    right = integral(mp, lambda f: (sin(f) - sin(phi0)) * sin(f), phi0, mp.pi / 2)
    left = integral(mp, lambda f: (sin(phi0) + sin(f)) * sin(f), -mp.pi / 2, -phi0)
    return scale * (left + right) / (2 * s.R)


def _load_33(s: Setting) -> Any:
    a, b = mp.mpf(s.a), mp.mpf(s.b)

    def over(lo: Any, hi: Any, sign: int) -> Any:
        return integral(mp, lambda f: (b * mp.sin(f) - sign * a) * b * mp.sin(f), lo, hi)

    return (over(*s.angles["left"], -1) + over(*s.angles["right"], 1)) / (2 * s.R)


def _load_35(s: Setting) -> Any:
    phi0 = s.phi0
    return (
        mp.mpf(s.a) ** 2 * ((mp.pi - 2 * phi0) / (2 * mp.sin(phi0) ** 2) - mp.cot(phi0)) / (2 * s.R)
    )


def _split(s: Setting) -> Any:
    """(25): x added and subtracted."""
    a, x = mp.mpf(s.a), mp.mpf(s.x)
    both = (a + x) * s.cauchy["left"] + (x - a) * s.cauchy["right"] + 2 * (mp.pi / 2 - s.phi0)
    return s.root * both / (2 * mp.pi * s.R)


def _misprinted_root(s: Setting) -> Any:
    """∫ dt / sqrt((b² - t²)(t - x)), the root over all: complex where t < x. A few digits show that
    it is another number.
    """
    b, x = few.mpf(s.b), few.mpf(s.x)
    lo, hi = (few.mpf(angle) for angle in s.angles["right"])
    cut = min(max(few.mpf(s.phi), lo), hi)
    parts = [(p, q) for p, q in ((lo, cut), (cut, hi)) if q > p]
    return mp.mpmathify(
        sum(few.quad(lambda f: 1 / few.sqrt(few.mpc(b * few.sin(f) - x)), [p, q]) for p, q in parts)
    )


def _punch(s: Setting) -> float:
    scene = sie.Scene(profile=sie.RoundedFlat(s.a, s.R), modulus=1.0, half_width=s.b)
    return float(sie.solve(scene).pressure(s.x))


def _step(s: Setting) -> float:
    """A slope that steps up at x = a only, upright in [-b, b]: its pressure is E*/2 w(x) times the
    second of (31).
    """
    share = np.arccos(s.a / s.b) / np.pi
    solution = sie.solve(
        sie.Scene(
            profile=sie.Piecewise((s.a,), ((-share,), (1.0 - share,))), modulus=2.0, half_width=s.b
        )
    )
    return float(solution.pressure(s.x)) * np.pi / np.sqrt((s.b - s.x) * (s.b + s.x))


def _load(s: Setting) -> float:
    return float(
        sie.solve(
            sie.Scene(profile=sie.RoundedFlat(s.a, s.R), modulus=1.0, half_width=s.b)
        ).normal_load
    )


def _of_punch(s: Setting, lib: Any) -> Any:
    return rounded_flat.pressure(s.x, **s.punch, lib=lib)


def _load_of_punch(s: Setting, lib: Any) -> Any:
    return rounded_flat.load(**s.punch, lib=lib)


def _half_angle(s: Setting) -> Any:
    return mp.pi / 2 - s.phi0


EQUATIONS = (
    Equation("(24)", "the pressure as a principal value = (32)", lambda s: s.pressure, _closed_32,
             closed=_of_punch, solver=_punch),
    Equation("(25)", "the same, x added and subtracted", lambda s: s.pressure, _split,
             closed=_of_punch, solver=_punch),
    Equation(
        "after (25)", "∫_a^b dt/sqrt(b²-t²) = π/2 - φ0",
        lambda s: integral(mp, lambda f: mp.one, *s.angles["left"]), _half_angle,
        lambda s: -_half_angle(s),
        "printed ∫_b^a, which has the other sign: the limits are ∫_a^b",
    ),
    Equation(
        "(26)", "t = 2τb/(1+τ²) makes the integrand rational",
        lambda s: s.cauchy["right"],
        lambda s: (1 + s.xi[0] ** 2) / s.b
        * _substituted(s, lambda t, xi: 1 / ((t - xi) * (1 - t * xi))),
        _misprinted_root,
        "printed with the root over (b²-t²)(t-x); it covers b²-t² only, and the integral is a "
        "principal value",
    ),
    Equation(
        "(27)", "partial fractions",
        lambda s: s.cauchy["right"],
        lambda s: (1 + s.xi[0] ** 2) / (s.b * (1 - s.xi[0] ** 2))
        * _substituted(s, lambda t, xi: 1 / (t - xi) - xi / (t * xi - 1)),
    ),
    Equation(
        "(28)", "x1 = 2 ξ1 b/(1+ξ1²), at a", lambda s: mp.mpf(s.a),
        lambda s: 2 * s.xi[1] * s.b / (1 + s.xi[1] ** 2),
    ),
    Equation(
        "(29)", "the principal value is one logarithm", lambda s: s.cauchy["right"], _rational,
        _misprinted_root,
        "printed with the root over (b²-t²)(t-x), and without the bar of the principal value",
        solver=_step,
    ),
    Equation("(30)", "ξ = tan φ0/2 at x = a", lambda s: mp.tan(s.angles["right"][0] / 2),
             lambda s: s.xi[1]),
    Equation(
        "(31) left", "of [-b, -a]", lambda s: s.cauchy["left"],
        lambda s: _logarithm(s, "left") / (s.b * mp.cos(s.phi)),
        solver=lambda s: -_step(Setting(s.a, s.b, -s.x, s.R)),
    ),
    Equation(
        "(31) right", "of [a, b]", lambda s: s.cauchy["right"],
        lambda s: _logarithm(s, "right") / (s.b * mp.cos(s.phi)), _misprinted_root,
        "printed with the root over (b²-t²)(t-x), and without the bar of the principal value",
        solver=_step,
    ),
    Equation("(32)", "the pressure in closed form", lambda s: s.pressure, _closed_32,
             closed=_of_punch, solver=_punch),
    Equation("(33)", "the load as an integral of the slope = (35)", _load_33, _load_35,
             closed=_load_of_punch, solver=_load),
    Equation(
        "(34)", "the same in t = b sin φ", _load_33, lambda s: _load_34(s, mp.mpf(s.b) ** 2),
        lambda s: _load_34(s, mp.one),
        "printed without the factor b² that (33) and (35) have", closed=_load_of_punch,
        solver=_load,
    ),
    Equation("(35)", "the load in closed form", _load_33, _load_35, closed=_load_of_punch,
             solver=_load),
)  # fmt: skip
