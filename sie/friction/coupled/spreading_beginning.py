"""The state under P alone, from which a contact spreads under Q over what sticks as it is touched.

Where P leaves full stick, its slip zones being narrower than 1e-15 of the contact, that state is
one with less friction, whose p and q are the same farther from the edge. r = f p - q is taken with
f itself, and the slip zones have a width on which nothing depends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .contact import CoupledContact
from .edge_rate import EdgeRates

Array = NDArray[np.float64]

NO_WIDTH = 1e-30  # half-widths: roundings of b are 1e-16


@dataclass(frozen=True, eq=False)
class Beginning:
    """The state under P alone, with the profile; β > 0 and Q > 0.

    normal      the state, in full stick perhaps with less friction
    friction    f
    slope       E*/2 h' on the right of the axis
    """

    normal: CoupledContact
    friction: float
    slope: Callable[[Array], Array]

    @cached_property
    def rates(self) -> EdgeRates:
        return EdgeRates(self.normal.flat.beta, self.friction)

    @property
    def rest(self) -> float:
        """The width of the slip zones; in full stick one that nothing depends on."""
        return max(self.normal.slip_width, NO_WIDTH * self.normal.b)

    def steepness(self, s: Array) -> Array:
        """H p - E*/2 h' at -b - s, positive."""
        y = self.normal.b + s
        values: Array = self.slope(y) - self.normal.hilbert_outside(y)
        return values

    def pressure(self, e3: Array) -> Array:
        """p at b - ε3."""
        return self.normal.pressure(self.normal.b - e3)

    def deficit(self, x: Array) -> Array:
        """f p - q at |x| < c."""
        normal = self.normal
        p, q = normal.pressure_and_shear(np.abs(x))
        values: Array = self.friction * p - normal.sign * np.sign(x) * q
        return values
