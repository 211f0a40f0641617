"""A shear traction that is known by its values, with its potentials."""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.friction.coupled.half_potential import HalfPotential
from sie.friction.coupled.traction import OnHalves, resolved_panels
from sie.numerics.interval import Interval
from sie.traction.base import Complex, on_line

Array = NDArray[np.float64]

SAME = 1e-13  # of the contact: marks that are nearer to each other are one
# of a shear at a smooth edge: its power of the distance
AT_EDGE = 0.5
# of the largest f p, at these parts of the half-width: of a shear below it rounding would be seen,
# which is some 1e-14 of f p
FAINT, SEEN = 1e-4, np.linspace(-0.9, 0.9, 10)
SHORT = 2e-9  # of the contact: panels at marks, less than what an end of a stick zone is known to


class PanelShear(OnHalves):
    """A shear traction as Chebyshev series on panels, which are halved towards its marks.

    Parameters
    ----------
    contact : Interval
        The contact, whose edges are smooth.
    values : callable
        q at places (1-d) in the contact.
    marks : collection of float
        Places where q is not smooth.
    load : float
        Its resultant, force per length.
    limit : callable
        f p at places in the contact: q is a difference of tractions as large as that.
    """

    def __init__(
        self,
        contact: Interval,
        values: Callable[[Array], Array],
        marks: Collection[float],
        load: float,
        limit: Callable[[Array], Array],
    ) -> None:
        self.contact, self.resultant, self._values = contact, load, values
        self._least = FAINT * float(limit(contact.m + contact.r * SEEN).max())
        width = 2.0 * contact.r
        kept = [0.0]
        for y in sorted(contact.from_left(x) for x in marks):
            if y - kept[-1] > SAME * width < width - y:
                kept.append(y)
        self._ends = (*kept[1:], width)

    @property
    def middle(self) -> float:
        return self.contact.x1

    @cached_property
    def _half(self) -> HalfPotential:
        def from_left(y: Array, _: Array) -> Array:
            return self._values(np.minimum(self.contact.x1 + y, self.contact.x2))

        panels = resolved_panels(from_left, self._ends, AT_EDGE, short=SHORT, least=self._least)
        return HalfPotential(panels[0])

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        y, force = self._half.quadrature
        return float(force @ (self.contact.x1 + y))

    @property
    def breaks(self) -> tuple[float, ...]:
        inner = (self.contact.x1 + y for y in self._ends[:-1])
        return self.contact.x1, *inner, self.contact.x2

    def __call__(self, x: ArrayLike) -> Array:
        def value(flat: Array) -> Array:
            inside = (flat >= self.contact.x1) & (flat <= self.contact.x2)
            q = np.zeros(flat.shape)
            q[inside] = self._half.traction(flat[inside] - self.contact.x1)
            return q

        return on_line(value, x)

    def _potentials(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        return self._half(z, derivative)
