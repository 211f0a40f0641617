"""Tractions that are known between marks, with their potentials.

On each piece [l, r] between two marks a traction is tabulated in v = ln((x - l)/(r - x)), in which
it is smooth whatever its powers at the marks. With the pole of the kernel at v(z), the trapezoidal
rule of step h misses what the residue leaves,

    ∫f(t)/(z - t) dt = h Σ f(t_k) t_k'/(z - t_k) - π f(v(z)) (cot(π v(z)/h) + i),     Im z > 0,

up to e^(-2π²/h), f continued to v(z) by interpolation of the table. Of two sets of nodes that one
is summed whose nodes are farther from v(z).

Trefethen & Weideman (2014), SIAM Rev. 56, 385, § 5.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise, product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.numerics.interval import Interval
from sie.traction.base import Complex, Density, on_line, on_surface, reflected, shallow

from .fields import interpolated

Array = NDArray[np.float64]
Complexes = tuple[Complex, Complex]

FINE = 0.125  # step of the tables: every other node makes a rule
STEP = 2.0 * FINE
REACH = 80.0  # e-folds of the tables
NEAREST = 1e-16  # of the shorter piece: places next to a mark inside the contact are as far from it
EDGE = 38.0  # the same of what is integrated up to an edge where the traction is infinite
SEEN = 1.5  # Im v beyond which the pole is not seen
# places whose |Re v| is less than CORE see what is farther than CORE + BEYOND as a point force
CORE, BEYOND = 8.0, 19.0
TOGETHER = 2**16  # entries of a matrix that are computed at once
POINTS = 16  # of an interpolation
HALF = 10  # of a central difference that is exact to degree 20


class Rule(NamedTuple):
    """Nodes as distances from the left end of a piece, then from the right one, and f dt."""

    from_lo: Array
    from_hi: Array
    mass: Array


@dataclass(frozen=True, eq=False)
class Piece:
    """A traction between two marks, at equidistant v about 0.

    lo, hi      the marks
    length      their distance, which narrow pieces are known better by
    values      the traction
    """

    lo: float
    hi: float
    length: float
    values: Array = field(repr=False)

    @cached_property
    def slopes(self) -> Array:
        """df/dv in steps of the table."""
        padded, n = np.pad(self.values, HALF, mode="edge"), len(self.values)
        total = np.zeros(n)
        for j in range(1, HALF + 1):
            weight = -((-1.0) ** j) / j * math.comb(2 * HALF, HALF - j) / math.comb(2 * HALF, HALF)
            total += weight * (padded[HALF + j :][:n] - padded[HALF - j :][:n])
        return total

    @cached_property
    def rules(self) -> dict[tuple[bool, bool], Rule]:
        """By whether the odd nodes are meant, and whether the core alone is seen."""
        both = False, True
        return {(odd, core): self._rule(odd, core) for odd, core in product(both, both)}

    def _rule(self, odd: bool, core: bool) -> Rule:
        v = tabulated(len(self.values))[odd::2]
        e = np.exp(-np.abs(v))
        near = self.length * e / (1.0 + e)
        mass = STEP * near / (1.0 + e) * self.values[odd::2]
        near = np.where(core & (np.abs(v) > CORE + BEYOND), 0.0, near)
        (from_lo, left), (from_hi, right) = (
            _merged(near[own], mass[own]) for own in (v < 0.0, v >= 0.0)
        )
        return Rule(from_lo, from_hi, np.append(left, right))

    def potentials(self, z: Complex) -> Complexes:
        """∫f/(z - t) dt and its derivative, at Im z > 0."""
        from_lo, from_hi = z - self.lo, self.hi - z
        v = np.log(from_lo) - np.log(from_hi)
        place = v / FINE  # from the middle of the table, whose number is even
        odd, core = np.rint(place.real) % 2.0 == 0.0, np.abs(v.real) < CORE
        F, dF = np.empty_like(z), np.empty_like(z)
        for of_odd, of_core in self.rules:
            own = np.flatnonzero((odd == of_odd) & (core == of_core))
            rule, step = self.rules[of_odd, of_core], max(1, TOGETHER // len(self.values))
            for i in range(0, len(own), step):
                part = own[i : i + step]
                F[part], dF[part] = _summed(rule, from_lo[part], from_hi[part])
        seen = np.flatnonzero(v.imag < SEEN)
        rest, slope = self._of_pole(place[seen], odd[seen])
        F[seen] -= rest
        dF[seen] -= slope / FINE * (1.0 / from_lo[seen] + 1.0 / from_hi[seen])
        return F, dF

    def _of_pole(self, place: Any, odd: NDArray[np.bool_]) -> Complexes:
        """What the pole leaves of the sum, and its derivative with the place in the table."""
        middle = len(self.values) // 2
        inside = middle + np.clip(place.real, -middle, middle) + 1j * place.imag
        f, slope = interpolated(np.stack((self.values, self.slopes)), inside, POINTS)
        with np.errstate(over="ignore", invalid="ignore"):
            turn = np.exp(-1j * math.pi * (place - odd))
        cot = 2j / (1.0 - turn)
        of_cot = 2.0 * math.pi * turn / (1.0 - turn) ** 2
        return math.pi * f * cot, math.pi * (slope * cot + f * of_cot)


def _merged(near: Array, mass: Array) -> tuple[Array, Array]:
    """Nodes with those at the mark as one."""
    at, apart = near == 0.0, near > 0.0
    if not at.any():
        return near, mass
    return np.append(near[apart], 0.0), np.append(mass[apart], mass[at].sum())


def _summed(rule: Rule, from_lo: Complex, from_hi: Complex) -> Complexes:
    """Σ m/(z - t) and its derivative, in real arithmetic: complex division takes far longer."""
    x = np.concatenate(
        (from_lo.real[:, None] - rule.from_lo, rule.from_hi - from_hi.real[:, None]), axis=1
    )
    depth = from_lo.imag[:, None]
    size = np.maximum(np.abs(x).max(axis=1, keepdims=True), depth)  # whose square may overflow
    x, depth = x / size, depth / size
    inverse = 1.0 / ((x * x + depth * depth) * size)
    x *= inverse
    y = depth * inverse
    m = rule.mass
    return x @ m - 1j * (y @ m), (y * y - x * x) @ m + 2j * ((x * y) @ m)


@dataclass(frozen=True, eq=False)
class OnPieces(Density):
    """A traction that is smooth between marks.

    contact     its edges
    values      its values in the contact
    tables      computes its pieces, about a place
    resultant   ∫f dx
    middle      that place
    marks       where it is not smooth, ascending, with the edges
    sharp       whether it is infinite at the edges
    """

    contact: Interval
    values: Callable[[Array], Array] = field(repr=False)
    tables: Callable[[], list[Piece]] = field(repr=False)
    resultant: float
    middle: float
    marks: tuple[float, ...]
    sharp: bool = False

    @cached_property
    def pieces(self) -> list[Piece]:
        return self.tables()

    @property
    def interval(self) -> tuple[float, float]:
        return self.contact.x1, self.contact.x2

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.marks

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        total = self.middle * self.resultant
        for piece in self.pieces:
            from_lo, from_hi, mass = piece.rules[False, False]
            total += float(mass @ np.append(piece.lo + from_lo, piece.hi - from_hi))
        return total

    def __call__(self, x: ArrayLike) -> Array:
        def value(flat: Array) -> Array:
            inside = (flat >= self.contact.x1) & (flat <= self.contact.x2)
            out = np.zeros(flat.shape)
            out[inside] = self.values(flat[inside])
            return out + 0.0

        return on_line(value, x)

    def hilbert(self, x: ArrayLike) -> Array:
        def principal(flat: Array) -> Array:
            values: Array = self._raised(flat.astype(complex))[0].real
            if self.sharp:  # as for other sharp edges
                values[(flat == self.contact.x1) | (flat == self.contact.x2)] = 0.0
            return values

        return self._on_line(principal, x)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self.potentials(z, side)[0]

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        return self.potentials(z, side)[1]

    def potentials(self, z: ArrayLike, side: int = 1) -> Complexes:
        steep: list[Complex] = []

        def value(u: Complex) -> Complex:
            F, dF = self._raised(u)
            surface = u.imag == 0.0
            F[surface] = on_surface(F.real[surface], self(u.real[surface]), side)
            dF.imag[surface] *= side
            steep.append(dF)
            return F

        F = self._in_plane(value, z, side)
        return F, self._in_plane(lambda _: steep[0], z, side, True)

    def _raised(self, z: Complex) -> Complexes:
        """F and F' at z, for places on the surface a little above it."""
        raised = z - self.middle
        raised.imag[z.imag == 0.0] = shallow(self.contact.r)
        pairs = reflected(self._sums, raised)
        return pairs[:, 0], pairs[:, 1]

    def _sums(self, z: Complex) -> Complex:
        for one, other in pairwise(self.pieces):
            apart = NEAREST * min(one.length, other.length)
            z = np.where(np.abs(z - other.lo) < apart, other.lo + 1j * apart, z)
        total: Any = sum(np.stack(piece.potentials(z), axis=-1) for piece in self.pieces)
        return total / math.pi


def tabulated(places: int) -> Array:
    """The v of a table."""
    v: Array = FINE * np.arange(-(places // 2), places // 2 + 1, dtype=float)
    return v


def places(reach: float) -> int:
    """The number of places of a table."""
    return 4 * math.ceil(reach / STEP) + 1


def smooth_between(
    contact: Interval, values: Callable[[Array], Array], inner: list[float], load: float
) -> OnPieces:
    """A traction by its values, of which roots of the distance begin at inner marks and edges."""
    marks = (contact.x1, *sorted(inner), contact.x2)

    def tables() -> list[Piece]:
        v, pieces = tabulated(places(REACH)), []
        for lo, hi in pairwise(marks):
            near = (hi - lo) / (1.0 + np.exp(np.abs(v)))
            x = np.where(v < 0.0, lo + near, hi - near)
            pieces.append(Piece(lo - contact.m, hi - contact.m, hi - lo, values(x)))
        return pieces

    return OnPieces(contact, values, tables, load, contact.m, marks)
