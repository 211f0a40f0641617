"""Shear tractions in partial slip as densities, with their potentials up to the surface.

    one-signed slip    q = ± f (p - p̂),         Fq = ± f (Fp - Fp̂)

    two-signed slip    Fq(z) = s f [Fp(z) - N(z)] + τ ± 2 s f R(z)/π ∫ p(t)/(|R(t)| (z - t)) dt

Here slip has the sign s next to z and -s on the other side of the stick zone, N(z) is the formal
inversion of the slope on the stick zone, and the integral is over the slip zone on the other side
(+ where that is the left one). What is close to z is in closed form.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.traction.base import Complex, Density
from sie.traction.combination import Combination
from sie.traction.of_slope import SlopeDensity

from .slip_zones import SlipZones

Array = NDArray[np.float64]

ROWS = 4096  # points at a time


class PotentialsOfParts(Density):
    """A density that has values of its own and the potentials of a sum."""

    @property
    @abstractmethod
    def parts(self) -> Combination:
        """The sum."""

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self.parts.cauchy(z, side)

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        return self.parts.cauchy_derivative(z, side)

    def hilbert(self, x: ArrayLike) -> Array:
        return self.parts.hilbert(x)


@dataclass(frozen=True, eq=False)
class OneSignedShear(PotentialsOfParts):
    """q = scale (p - p̂), scale = ± f.

    In a stick zone that nearly fills the contact q follows from the slip zones (`SlipZones`).
    """

    pressure: SlopeDensity
    corrective: SlopeDensity
    scale: float
    resultant: float
    short: SlipZones | None = None

    @cached_property
    def parts(self) -> Combination:
        return Combination(((self.scale, self.pressure), (-self.scale, self.corrective)))

    @property
    def interval(self) -> tuple[float, float]:
        return self.pressure.interval

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        if self.short is not None:
            return self.scale * self.short.moment
        return self.parts.moment

    def __call__(self, x: ArrayLike) -> Array:
        if self.short is None:
            return self.parts(x)
        x = arguments.reals("x", x)
        flat = x.ravel()
        stick = self.short.stick
        inside = (stick.from_left(flat) > 0.0) & (stick.from_right(flat) > 0.0)
        q = np.empty(flat.shape)
        q[inside] = self.scale * self.short.shear(flat[inside])
        q[~inside] = self.scale * self.pressure(flat[~inside])
        return q.reshape(x.shape)

    @property
    def bases(self) -> tuple[tuple[float, Density], ...]:
        return self.parts.bases

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.parts.breaks

    @property
    def singular(self) -> tuple[float, ...]:
        return self.parts.singular

    @property
    def hilbert_at_edges(self) -> tuple[float, float]:
        return self.parts.hilbert_at_edges

    def strength(self, x: float) -> float:
        return self.parts.strength(x)
