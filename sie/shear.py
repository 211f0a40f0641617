"""Shear tractions in partial slip as densities: with their potential, which is exact up to the surface.

    one sign     q = ± f (p - p̂),         Fq = ± f (Fp - Fp̂)
    two signs    slip of the sign s next to z and of -s on the other side of the stick zone, N(z) the formal inversion of the slope there:

        Fq(z) = s f [Fp(z) - N(z)] + τ ± 2 s f R(z)/π ∫_other side p(t)/(|R(t)| (z - t)) dt        (+ where the other side is the left one)

The integral is over the far zone: what is close to z is in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .density import Combination, Complex, Density, SlopeDensity
from .zones import Zone, Zones

Array = NDArray[np.float64]

ROWS = 4096  # points at a time


@dataclass(frozen=True, eq=False)
class OneSign(Density):
    """q = scale (p - p̂), scale = ± f; in a stick zone that nearly fills the contact from the slip zones' pull instead (`zones`)."""

    pressure: SlopeDensity
    corrective: SlopeDensity
    scale: float
    resultant: float
    thin: Zones | None = None

    @cached_property
    def _difference(self) -> Combination:
        return Combination(((self.scale, self.pressure), (-self.scale, self.corrective)))

    @property
    def interval(self) -> tuple[float, float]:
        return self.pressure.interval

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        if self.thin is not None:
            return self.scale * self.thin.moment
        return self._difference.moment

    def __call__(self, x: ArrayLike) -> Array:
        if self.thin is None:
            return self._difference(x)
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        stick = self.thin.stick
        inside = (stick.from_left(flat) > 0.0) & (stick.from_right(flat) > 0.0)
        q = np.empty(flat.shape)
        q[inside] = self.scale * self.thin.shear(flat[inside])
        q[~inside] = self.scale * self.pressure(flat[~inside])
        return q.reshape(x.shape)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._difference.cauchy(z, side)

    def hilbert(self, x: ArrayLike) -> Array:
        return self._difference.hilbert(x)

    def strength(self, x: float) -> float:
        return self._difference.strength(x)


@dataclass(frozen=True, eq=False)
class TwoSigns(Density):
    """Slip to one side on the left of the stick zone and to the other on its right."""

    pressure: SlopeDensity
    formal: SlopeDensity
    friction: float
    zones: Zones
    resultant: float
    tau: float

    @property
    def interval(self) -> tuple[float, float]:
        return self.pressure.interval

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        return self.friction * self.zones.moment

    def __call__(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        stick, drive = self.zones.stick, self.zones.drive
        inside = (stick.from_left(flat) > 0.0) & (stick.from_right(flat) > 0.0)
        q = np.empty(flat.shape)
        q[inside] = self.friction * self.zones.shear(flat[inside])
        sign = np.where(flat[~inside] > stick.m, drive.right, drive.left)
        q[~inside] = self.friction * sign * self.pressure(flat[~inside])
        return q.reshape(x.shape)

    def _side(self, right: bool) -> tuple[float, Zone, float]:
        """(f times the sign of slip next to z, the zone on the other side, the sign of its integral)."""
        drive = self.zones.drive
        return (self.friction * drive.right, self.zones.left, 1.0) if right else (self.friction * drive.left, self.zones.right, -1.0)

    def hilbert(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        flat, stick = x.ravel(), self.zones.stick
        out = np.full(flat.shape, self.tau)
        for at, right in ((stick.from_left(flat) < 0.0, False), (stick.from_right(flat) < 0.0, True)):
            if at.any():
                scale, other, sign = self._side(right)
                t = flat[at]
                far, near = (stick.from_left(t), -stick.from_right(t)) if right else (stick.from_right(t), -stick.from_left(t))
                pull = 2.0 * sign / np.pi * np.sqrt(far * near) * other.pull(far, stick.r)
                out[at] += scale * (self.pressure.hilbert(t) - self.formal.hilbert(t) + pull)
        return out.reshape(x.shape)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        z = np.asarray(z, dtype=complex)
        flat = z.ravel()
        F = np.empty(flat.shape, dtype=complex)
        real = flat.imag == 0.0
        x = flat.real[real]
        F[real] = self.hilbert(x) - 1j * side * self(x) if side else self.hilbert(x)
        lower = flat.imag < 0.0
        upper = np.where(lower, flat.conj(), flat)
        for at, right in ((~real & (flat.real <= self.zones.stick.m), False), (~real & (flat.real > self.zones.stick.m), True)):
            if at.any():
                F[at] = self._off_axis(upper[at], right)
        F[lower] = F[lower].conj()
        return F.reshape(z.shape)

    def _off_axis(self, z: Complex, right: bool) -> Complex:
        scale, other, sign = self._side(right)
        stick = self.zones.stick
        left, right_ = stick.from_left(z), -stick.from_right(z)
        weight = other.force / np.sqrt(other.inwards * (other.inwards + 2.0 * stick.r))
        # z - t for t at the distance `inwards` from the stick zone's end
        base, step = (left, 1.0) if right else (right_, -1.0)
        tail = np.empty(z.shape, dtype=complex)
        for start in range(0, len(z), ROWS):
            rows = slice(start, start + ROWS)
            tail[rows] = np.reciprocal(base[rows, None] + step * other.inwards) @ weight
        root = np.sqrt(left) * np.sqrt(right_)
        near: Complex = self.pressure.cauchy(z) - self.formal.cauchy(z) + 2.0 * sign / np.pi * root * tail
        return scale * near + self.tau
