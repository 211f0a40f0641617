"""Profiles whose parameters are arrays over n scenes, and the formulas of upright symmetric ones.

A family answers for T = P/G, G = E*/2, a length. Of an upright profile: T(r), r(T) and p(x; r)/G.

Those of a rounded flat (Steuerman 1939; Ciavarella, Hills & Monno 1998, eqs 32 and 35) are written
as sums of positive terms, in τ = sqrt((b - a)/(b + a)) and t = sqrt((b - |x|)/(b + |x|)), with

    A(y) = (1 + y²) atan(y)/y - 1,      B(y) = 1 - (1 - y²) artanh(y)/y

which are ~ 2y²/3: T = b²/R 2τ/(1 + τ²) (A(τ) + 2τ²/(1 + τ²)), and p/G is 4b/(πR) τ/(1 + τ²)
t/(1 + t²) times 2A(τ) + B(τt) + B(τ/t) on the flat; beside it the last term is 2 - B(t/τ).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from sie.contact.normal import normal_contact
from sie.contact.pressure import pressure as pressure_on
from sie.numerics.interval import EPS
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.shapes import Flat, Parabola, Power, RoundedFlat, Wedge

from .smooth import CLOSE, MOST_STEPS, Array, Contact, Integrals, Smooth, newton

Formula = Callable[..., Array]

TOL = 1e-13
THIN = 0.1  # angle of a rounded edge: below it a tilted punch loses digits in doubles
MOST_BREAKS = 8  # of a slope that may be smooth between them
SHORT, TERMS = 0.25, 12  # up to this argument a series of so many terms is right to rounding


class Family(NamedTuple):
    """One kind of profile, whose parameters are arrays (n,), under many loads.

    contact   the contacts under T, or of half-widths r, with a tilt: contact(size, tilt, of_width,
              *parameters); nan where there is no answer
    pressure  p/G at x (n, k) from the centre, inside: pressure(x, contact, tilt, *parameters), all
              as columns (n, 1)
    tilts     whether it answers under a tilt
    """

    contact: Callable[..., Contact]
    pressure: Formula
    tilts: bool = True


def upright(
    load: Formula, width: Formula, pressure: Formula, centre: Formula | None = None
) -> Family:
    """A symmetric profile by its formulas; `centre` is where a tilt moves it, None for nowhere."""

    def contact(size: Array, tilt: Array, of_width: bool, *parameters: Array) -> Contact:
        r = size if of_width else width(size, *parameters)
        T = load(size, *parameters) if of_width else size
        m = 0.0 * r if centre is None else centre(tilt, *parameters)
        return Contact(m, r, T, 0.0 * r)

    def inside(x: Array, found: Contact, _: Array, *parameters: Array) -> Array:
        return pressure(x, found.r, found.T, *parameters)

    return Family(contact, inside, centre is not None)


def _root(x: Array, r: Array) -> Array:
    return np.sqrt(np.maximum((r - x) * (r + x), 0.0))


HERTZ = upright(
    lambda r, R: 0.5 * math.pi * r * r / R,
    lambda T, R: np.sqrt(2.0 * T * R / math.pi),
    lambda x, r, T, R: _root(x, r) / R,
    lambda tilt, R: -tilt * R,
)
PUNCH = upright(
    lambda r, a: np.full_like(r, np.nan),
    lambda T, a: a + 0.0 * T,
    lambda x, r, T, a: T / (math.pi * _root(x, r)),
)
TIP = upright(
    lambda r, s: 2.0 * s * r,
    lambda T, s: 0.5 * T / s,
    lambda x, r, T, s: 2.0 * s / math.pi * np.arccosh(np.maximum(r / np.abs(x), 1.0)),
)


@lru_cache(maxsize=8)
def power(m: float) -> Family:
    """A |x|^m: all contacts of it are alike. The parameters are m, the same for all, and A."""
    scene = Scene(profile=Power(m, 1.0), modulus=2.0, half_width=1.0)
    normal = normal_contact(scene, TOL)
    factor, unit = normal.edges.normal_load, pressure_on(normal, scene, TOL)
    return upright(
        lambda r, _, A: factor * A * r**m,
        lambda T, _, A: (T / (factor * A)) ** (1.0 / m),
        lambda x, r, T, _, A: T / (factor * r) * unit(np.clip(x / r, -1.0, 1.0)),
    )


# -- the rounded flat ------------------------------------------------------------------------------


def _B(y: Array, sign: float = 1.0) -> Array:
    """B(y) = Σ 2 y^2n/(4n² - 1), n >= 1, without cancellation; -A(y) for the other sign of y²."""
    far = np.maximum(y, SHORT)
    angle = np.arctan(far) if sign < 0.0 else np.arctanh(np.minimum(far, 1.0 - 0.5 * EPS))
    out: Array = 1.0 - (1.0 - sign * far * far) * angle / far
    short = y < SHORT
    if short.any():
        t = sign * y[short] ** 2
        total = np.zeros_like(t)
        for n in range(TERMS, 0, -1):
            total = t * (2.0 / (4.0 * n * n - 1.0) + total)
        out[short] = total
    return out


def _A(y: Array) -> Array:
    return -_B(y, -1.0)


def _punch_load(d: Array, a: Array, R: Array) -> Array:
    """T of the rim d = b - a: b²/R 2τ/(1 + τ²) (A(τ) + 2τ²/(1 + τ²)), τ² = d/(2a + d)."""
    t, b = d / (2.0 * a + d), a + d
    root, share = np.sqrt(t), t / (1.0 + t)
    return b * b / R * 2.0 * root / (1.0 + t) * (_A(root) + 2.0 * share)


def punch_width(T: Array, a: Array, R: Array) -> Array:
    """b: Newton's method in ln(b - a), from where the limits of a small and a large rim join."""
    length = np.sqrt(2.0 * T * R)
    d = length / (math.sqrt(math.pi) + 2.0 * (a / length) ** (1.0 / 3.0))
    for _ in range(MOST_STEPS):
        found = _punch_load(d, a, R)
        rises = 4.0 * (a + d) / R * np.arctan(np.sqrt(d / (2.0 * a + d)))
        step = np.log(T / found) * found / (d * rises)
        d = d * np.exp(step)
        if np.abs(step).max(initial=0.0) < CLOSE:
            break
    return a + d


def _punch_pressure(x: Array, b: Array, T: Array, a: Array, R: Array) -> Array:
    """The pressure of Steuerman, as a sum of positive terms."""
    rim = np.sqrt((b - a) / (b + a))
    y = np.abs(x)
    t = np.sqrt(np.maximum(b - y, 0.0) / (b + y))
    inside = y <= a
    low, high = np.where(inside, rim, t), np.where(inside, t, rim)
    end = _B(low / np.maximum(high, EPS * EPS))
    end = np.where(inside, end, 2.0 - end)
    # doubles hold b to rounding, and b - a to less: the load makes up for it
    factor = 4.0 * b / (math.pi * R) * rim / (1.0 + rim * rim) * (T / _punch_load(b - a, a, R))
    return factor * t / (1.0 + t * t) * (2.0 * _A(rim) + _B(rim * t) + end)


ROUNDED = upright(lambda b, a, R: _punch_load(b - a, a, R), punch_width, _punch_pressure)


# -- rounded flats under a tilt: H = θ + ((x - a)⁺ - (-x - a)⁺)/R, by the angles of both arcs ------


def _angles(m: Array, r: Array, a: Array) -> tuple[Array, Array]:
    """Of the right arc and of the left one, from its edge; nan where it is not in contact."""
    return np.arccos((a - m) / r), np.arccos((a + m) / r)


def _of_punch(tilt: Array, m: Array, r: Array, a: Array, R: Array) -> Integrals:
    (u, v), s = _angles(m, r, a), r / R
    su, cu, sv, cv = np.sin(u), np.cos(u), np.sin(v), np.cos(v)
    gu, gv = 0.5 * (u - su * cu), 0.5 * (v - sv * cv)
    I0 = math.pi * tilt + s * (su - u * cu - sv + v * cv)
    C2 = 0.5 * math.pi * tilt + s * ((su**3 - sv**3) / 3.0 - cu * gu + cv * gv)
    return Integrals(I0, s * (gu + gv), s * (u + v), s * (su - sv), C2)


def _tilted(size: Array, tilt: Array, of_width: bool, a: Array, R: Array) -> Contact:
    r = size if of_width else punch_width(size, a, R)
    found = newton(lambda m, r: _of_punch(tilt, m, r, a, R), (0.0 * tilt, r), size, of_width)
    thin = np.minimum(*_angles(found.m, found.r, a)) < THIN
    return found._replace(r=np.where(thin, np.nan, found.r))


def _tilted_pressure(x: Array, found: Contact, _: Array, a: Array, R: Array) -> Array:
    m, r = found.m, found.r
    u, v = _angles(m, r, a)
    right, left = r - x, r + x
    total = (u + v) * np.sqrt(np.maximum(right * left, 0.0))
    for side, near, far in ((1.0, right, left), (-1.0, left, right)):
        # (x - e) ln((A + B)²/(2r |x - e|)), A² = (r + x)(r - e), B² = (r + e)(r - x)
        e = a - side * m
        A, B = np.sqrt(np.maximum(far * (r - e), 0.0)), np.sqrt(np.maximum(near * (r + e), 0.0))
        away = side * x - e
        apart = np.where(away == 0.0, 1.0, 2.0 * r * np.abs(away))
        total += away * np.log1p(2.0 * np.minimum(A, B) * (A + B) / apart)
    return np.asarray(total / (math.pi * R))


TILTED = Family(_tilted, _tilted_pressure)


# -- the families of a profile ---------------------------------------------------------------------

# Profiles with formulas, whose parameters may be arrays
SHAPES: dict[type, tuple[Family, ...]] = {
    Parabola: (HERTZ,), RoundedFlat: (ROUNDED, TILTED), Flat: (PUNCH,), Wedge: (TIP,), Power: (),
}  # fmt: skip


def families(profile: Any, names: tuple[str, ...]) -> tuple[Family | Smooth, ...]:
    """The families that answer for a profile, or for a slope with parameters of these names."""
    if not isinstance(profile, Profile):
        return (Smooth(profile, names),)
    if type(profile) in SHAPES:
        return SHAPES[type(profile)] or (power(profile.exponent),)  # type: ignore[attr-defined]
    inner = profile.pieces.breaks[1:-1]
    if profile.of_several or len(inner) > MOST_BREAKS:
        return ()
    breaks, known = tuple(map(float, inner)), (profile.domain, profile.convex)
    return (Smooth(profile.pieces, (), profile.axis, breaks, *known),)
