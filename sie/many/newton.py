"""Newton's method for centre and half-width of many contacts, and punches under a tilt."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .families import CLOSE, MOST_STEPS, Array, Contact, Family, punch_width

THIN = 0.1  # angle of a rounded edge: below it a tilted punch loses digits in doubles


class Integrals(NamedTuple):
    """∫H dφ, ∫H s dφ, ∫H_s dφ, ∫H_s s dφ and ∫H (1 - s²) dφ, H_s the derivative by s."""

    I0: Array
    I1: Array
    J0: Array
    J1: Array
    C2: Array


def newton(
    integrals: Callable[[Array, Array], Integrals],
    start: tuple[Array, Array],
    size: Array,
    of_width: bool,
) -> Contact:
    """I0 = 0 and r I1 = T for m and ln r, or for m alone where r is given.

    The derivatives of I0 and of r I1 by m and r are J0/r, J1/r and J1, J0.
    """
    m, r = start
    for _ in range(MOST_STEPS):
        k = integrals(m, r)
        carried = r * k.I1
        lacks = 0.0 * r if of_width else np.log(size / carried)
        J1 = 0.0 * r if of_width else k.J1
        # J is indefinite where the slope does not rise; then nothing settles
        det = k.J0 * k.J0 - J1 * J1
        dm = -(k.I0 * k.J0 * r + J1 * carried * lacks) / det
        du = (k.J0 * k.I1 * lacks + J1 * k.I0) / det
        lost = ~np.isfinite(lacks + dm + du)
        m = m + np.where(lost, 0.0, np.clip(dm, -r, r))
        r = r * np.exp(np.where(lost, 0.0 if of_width else 1.0, np.clip(du, -3.0, 3.0)))
        left = np.where(lost, np.inf, np.maximum(np.abs(du), np.abs(dm) / r))
        if not (left > CLOSE).any():
            break
    k = integrals(m, r)
    r = np.where((left <= CLOSE) & np.isfinite(k.C2), r, np.nan)
    return Contact(m, r, r * k.I1 if of_width else size, -r * r * k.C2)


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
