"""Newton's method for centre and half-width of many contacts, and punches under a tilt."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override

from .closed import CLOSE, MOST_STEPS, punch_width
from .families import Array, Contact, Family

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
    free: tuple[bool, bool],
) -> Contact:
    """I0 = 0 and r I1 = T for m and ln r; `free`: whether m, and whether r are sought.

    The derivatives of I0 and of r I1 by m and r are J0/r, J1/r and J1, J0.
    """
    m, r = start
    for _ in range(MOST_STEPS):
        k = integrals(m, r)
        carried = r * k.I1
        lacks = np.log(size / carried) if free[1] else 0.0 * r
        # J is indefinite where the slope does not rise; then nothing settles
        det = k.J0 * k.J0 - k.J1 * k.J1 if all(free) else k.J0 * k.J0
        dm = -(k.I0 * k.J0 * r + (k.J1 * carried * lacks if free[1] else 0.0)) / det
        du = (k.J0 * k.I1 * lacks + (k.J1 * k.I0 if free[0] else 0.0)) / det
        lost = ~np.isfinite(lacks + dm + du)
        du = np.where(lost, 1.0, np.clip(du, -3.0, 3.0)) if free[1] else 0.0 * r
        dm = np.where(lost, 0.0, np.clip(dm, -r, r)) if free[0] else 0.0 * r
        m, r = m + dm, r * np.exp(du)
        left = np.maximum(np.abs(du), np.abs(dm) / r)
        if not (left > CLOSE).any():
            break
    k = integrals(m, r)
    bad = ~(left <= CLOSE) | ~np.isfinite(k.C2)
    r = np.where(bad, np.nan, r)
    return Contact(m, r, size + 0.0 * r if free[1] else r * k.I1, -r * r * k.C2)


@dataclass(frozen=True)
class Tilted(Family):
    """Rounded flats under a tilt: H = θ + ((x - a)⁺ - (-x - a)⁺)/R, by the angles of both arcs."""

    a: Array
    R: Array

    @override
    def takes(self, tilt: Array, of_width: bool) -> NDArray[np.bool_]:
        return np.full(tilt.shape, not of_width)

    @override
    def contact(self, size: Array, tilt: Array, of_width: bool) -> Contact:
        start = 0.0 * tilt, punch_width(size, self.a, self.R)
        found = newton(lambda m, r: self._integrals(tilt, m, r), start, size, (True, True))
        thin = np.minimum(*self._angles(found.m, found.r)) < THIN
        return found._replace(r=np.where(thin, np.nan, found.r))

    def _angles(self, m: Array, r: Array) -> tuple[Array, Array]:
        """Of the right arc and of the left one, from its edge; nan where it is not in contact."""
        with np.errstate(invalid="ignore"):
            return np.arccos((self.a - m) / r), np.arccos((self.a + m) / r)

    def _integrals(self, tilt: Array, m: Array, r: Array) -> Integrals:
        (u, v), s = self._angles(m, r), r / self.R
        su, cu, sv, cv = np.sin(u), np.cos(u), np.sin(v), np.cos(v)
        gu, gv = 0.5 * (u - su * cu), 0.5 * (v - sv * cv)
        C2 = s * ((su**3 - sv**3) / 3.0 - cu * gu + cv * gv)
        return Integrals(
            math.pi * tilt + s * (su - u * cu - sv + v * cv),
            s * (gu + gv),
            s * (u + v),
            s * (su - sv),
            0.5 * math.pi * tilt + C2,
        )

    @override
    def pressure(self, contact: Contact, tilt: Array, x: Array) -> Array:
        m, r, a = contact.m[:, None], contact.r[:, None], self.a[:, None]
        u, v = (angle[:, None] for angle in self._angles(contact.m, contact.r))
        right, left = r - x, r + x
        total = (u + v) * np.sqrt(np.maximum(right * left, 0.0))
        for side, near, far in ((1.0, right, left), (-1.0, left, right)):
            # (x - e) ln((A + B)²/(2r |x - e|)), A² = (r + x)(r - e), B² = (r + e)(r - x)
            e = a - side * m
            A, B = np.sqrt(np.maximum(far * (r - e), 0.0)), np.sqrt(np.maximum(near * (r + e), 0.0))
            away = side * x - e
            apart = np.where(away == 0.0, 1.0, 2.0 * r * np.abs(away))
            total += away * np.log1p(2.0 * np.minimum(A, B) * (A + B) / apart)
        return np.asarray(total / (math.pi * self.R[:, None]))

    @override
    def part(self, which: Any) -> Tilted:
        return Tilted(self.a[which], self.R[which])
