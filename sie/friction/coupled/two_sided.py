"""The tractions of dissimilar bodies under P, then Q, whose halves differ, with their potentials.

Both halves have the panels of `traction`, counted from a place in the stick zone: the
potential is that of the right half less the mirror image of that of the left one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.numerics.interval import Interval
from sie.traction.base import Complex, on_line

from .half_potential import HalfPotential, Panels
from .traction import OnHalves, joined_panels

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TwoSidedTraction(OnHalves):
    """A traction whose halves differ.

    values      its values in the contact
    resolved    computes the panels of what is right, and left, of a place
    split       that place in the contact
    load        its resultant
    marks       where it or a derivative is not smooth, ascending, with the edges
    contact     its edges
    first       ∫q x dx, where it is known
    sharp       whether it is infinite at the edges
    """

    values: Callable[[Array], Array] = field(repr=False)
    resolved: Callable[[], tuple[Panels, ...]] = field(repr=False)
    split: float
    load: float
    marks: tuple[float, ...]
    contact: Interval
    first: float | None = None
    sharp: bool = False

    @property
    def middle(self) -> float:
        return self.split

    @cached_property
    def halves(self) -> tuple[HalfPotential, HalfPotential]:
        right, left = self.resolved()
        return HalfPotential(right), HalfPotential(left)

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return self.load

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        if self.first is not None:
            return self.first
        (y, right), (w, left) = (half.quadrature for half in self.halves)
        return self.middle * self.load + float(right @ y - left @ w)

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.marks

    def __call__(self, x: ArrayLike) -> Array:
        def value(flat: Array) -> Array:
            inside = (flat >= self.contact.x1) & (flat <= self.contact.x2)
            out = np.zeros(flat.shape)
            out[inside] = self.values(flat[inside])
            return out + 0.0

        return on_line(value, x)

    def _on_surface(self, x: Array) -> Array:
        inside = (x >= self.contact.x1) & (x <= self.contact.x2)
        y, out = x - self.middle, np.zeros(len(x))
        for half, side in zip(self.halves, (1.0, -1.0), strict=True):
            own = inside & (side * y >= 0.0)
            out[own] = half.traction(side * y[own])
        return out

    def _potentials(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        right, left = self.halves
        F, dF = right(z, derivative)
        G, dG = (v.conj() for v in left(-z.conj(), derivative))
        return F - G, dF + dG


class Known(NamedTuple):
    """What is known of p and q beside their values.

    split       a place in the stick zone
    marks       where they or a derivative are not smooth, ascending, with the edges
    powers      of the distances from the left edge and from the right one
    loads       P and Q
    first       ∫p x dx
    """

    split: float
    marks: tuple[float, ...]
    powers: tuple[float, float]
    loads: tuple[float, float]
    first: float


def both_tractions(
    values: tuple[Callable[[Array], Array], ...],
    rows: Callable[[Array, Array], Array],
    known: Known,
) -> tuple[TwoSidedTraction, TwoSidedTraction]:
    """p and q, by their values, each alone and both as rows: they share their panels.

    The rows are those at places of known distances from the edge on their side.
    """
    split, marks, powers, loads, first = known
    contact = Interval(marks[0], marks[-1])

    def half(side: float, power: float) -> tuple[Panels, ...]:
        ends = sorted(side * (x - split) for x in marks if side * (x - split) > 0.0)
        return joined_panels(lambda y, rest: rows(split + side * y, rest), tuple(ends), power)

    @lru_cache(maxsize=1)
    def halves() -> tuple[tuple[Panels, ...], tuple[Panels, ...]]:
        return half(1.0, powers[1]), half(-1.0, powers[0])

    def panels(k: int) -> tuple[Panels, ...]:
        return tuple(half[k] for half in halves())

    p, q = (
        TwoSidedTraction(
            values[k],
            partial(panels, k),
            split,
            loads[k],
            marks,
            contact,
            (first, None)[k],
            min(powers) < 0.0,
        )
        for k in (0, 1)
    )
    return p, q
