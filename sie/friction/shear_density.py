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
from sie.traction.base import Complex, Density, on_surface, refuse_side, shallow
from sie.traction.combination import Combination
from sie.traction.of_slope import SlopeDensity

from .slip_zones import SlipZone, SlipZones

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


@dataclass(frozen=True, eq=False)
class TwoSignedShear(Density):
    """The shear of two-signed slip: opposite directions left and right of the stick zone."""

    pressure: SlopeDensity
    formal: SlopeDensity
    friction: float
    zones: SlipZones
    resultant: float
    tau: float

    @property
    def interval(self) -> tuple[float, float]:
        return self.pressure.interval

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        return self.friction * self.zones.moment

    def __call__(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        flat = x.ravel()
        stick, drive = self.zones.stick, self.zones.drive
        inside = (stick.from_left(flat) > 0.0) & (stick.from_right(flat) > 0.0)
        q = np.empty(flat.shape)
        q[inside] = self.friction * self.zones.shear(flat[inside])
        sign = np.where(flat[~inside] > stick.m, drive.right, drive.left)
        q[~inside] = self.friction * sign * self.pressure(flat[~inside])
        return q.reshape(x.shape)

    def _side(self, right: bool) -> tuple[float, SlipZone, float]:
        """(signed f, the zone on the other side of z, the sign of its integral).

        The sign of f is that of slip next to z.
        """
        drive = self.zones.drive
        return (
            (self.friction * drive.right, self.zones.left, 1.0)
            if right
            else (self.friction * drive.left, self.zones.right, -1.0)
        )

    def hilbert(self, x: ArrayLike) -> Array:
        return self._on_line(self._hilbert, x)

    def _hilbert(self, flat: Array) -> Array:
        stick = self.zones.stick
        out = np.full(flat.shape, self.tau)
        for at, right in (
            (stick.from_left(flat) < 0.0, False),
            (stick.from_right(flat) < 0.0, True),
        ):
            if at.any():
                scale, other, sign = self._side(right)
                t = flat[at]
                far, near = (
                    (stick.from_left(t), -stick.from_right(t))
                    if right
                    else (stick.from_right(t), -stick.from_left(t))
                )
                pull = 2.0 * sign / np.pi * np.sqrt(far * near) * other.pull(far, stick.r)
                out[at] += scale * (self.pressure.hilbert(t) - self.formal.hilbert(t) + pull)
        return out

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        F: Complex = self._in_plane(lambda flat: self._cauchy(flat, side), z, side)
        return F

    def _cauchy(self, flat: Complex, side: int) -> Complex:
        F = np.empty(flat.shape, dtype=complex)
        real = flat.imag == 0.0
        x = flat.real[real]
        F[real] = on_surface(self._hilbert(x), self(x), side)
        lower = flat.imag < 0.0
        upper = np.where(lower, flat.conj(), flat)
        for at, right in (
            (~real & (flat.real <= self.zones.stick.m), False),
            (~real & (flat.real > self.zones.stick.m), True),
        ):
            if at.any():
                F[at] = self._off_axis(upper[at], right)
        F[lower] = F[lower].conj()
        return F

    @property
    def breaks(self) -> tuple[float, ...]:
        stick = self.zones.stick
        return tuple(sorted({*self.pressure.breaks, stick.x1, stick.x2}))

    @property
    def singular(self) -> tuple[float, ...]:
        stick = self.zones.stick
        return tuple(sorted({*self.pressure.singular, stick.x1, stick.x2}))

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        dF: Complex = self._in_plane(
            lambda flat: self._cauchy_derivative(flat, side), z, side, derivative=True
        )
        return dF

    def _cauchy_derivative(self, flat: Complex, side: int) -> Complex:
        contact = self.pressure.contact
        real, lower = flat.imag == 0.0, flat.imag < 0.0
        upper = np.where(lower, flat.conj(), flat)
        upper[real] += 1j * shallow(contact.r)
        dF = np.empty(flat.shape, dtype=complex)
        for at, right in (
            (flat.real <= self.zones.stick.m, False),
            (flat.real > self.zones.stick.m, True),
        ):
            if at.any():
                dF[at] = self._off_axis_derivative(upper[at], right)
        inside = (contact.from_left(flat.real) >= 0.0) & (contact.from_right(flat.real) >= 0.0)
        dF.imag[real] *= np.where(inside[real], float(side), 0.0)
        dF[lower] = dF[lower].conj()
        return dF

    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        z = arguments.complexes("z", z)
        flat = z.ravel()
        if not ((flat.imag > 0.0) & (np.abs(flat) <= self.horizon)).all():
            return self.cauchy(z, side), self.cauchy_derivative(z, side)
        refuse_side(side)
        F, dF = np.empty((2, *flat.shape), dtype=complex)
        for right in (False, True):
            at = (flat.real > self.zones.stick.m) == right
            if at.any():
                F[at], dF[at] = self._both_off_axis(flat[at], right)
        return F.reshape(z.shape), dF.reshape(z.shape)

    def _both_off_axis(self, z: Complex, right: bool) -> tuple[Complex, Complex]:
        """(F, F') off the axis: they share the tail, which costs most."""
        scale, _, sign = self._side(right)
        pull, steep = self._pull(z, right)
        (F, dF), (N, dN) = self.pressure.potentials(z), self.formal.potentials(z)
        return scale * (F - N + sign * pull) + self.tau, scale * (dF - dN + sign * steep)

    def _off_axis(self, z: Complex, right: bool) -> Complex:
        scale, _, sign = self._side(right)
        near: Complex = (
            self.pressure.cauchy(z) - self.formal.cauchy(z) + sign * self._pull(z, right)[0]
        )
        return scale * near + self.tau

    def _off_axis_derivative(self, z: Complex, right: bool) -> Complex:
        scale, _, sign = self._side(right)
        steep = self._pull(z, right)[1]
        near: Complex = (
            self.pressure.cauchy_derivative(z) - self.formal.cauchy_derivative(z) + sign * steep
        )
        return scale * near

    def _pull(self, z: Complex, right: bool) -> tuple[Complex, Complex]:
        """2 R(z)/π ∫_other side p/(|R| (z - t)) dt and its derivative.

        Lengths are in half-widths of the stick zone: a pressure over the square of a length may
        exceed all doubles.
        """
        _, other, _ = self._side(right)
        stick = self.zones.stick
        r = stick.r
        left = stick.from_left(z) / r
        right_ = -stick.from_right(z) / r
        from_stick = other.from_stick / r
        weight = other.force / r / np.sqrt(from_stick * (from_stick + 2.0))
        # z - t for t at the distance `from_stick` from the stick zone's end
        base, step = (left, 1.0) if right else (right_, -1.0)
        tail, falling = np.empty((2, *z.shape), dtype=complex)
        for start in range(0, len(z), ROWS):
            rows = slice(start, start + ROWS)
            inverse = np.reciprocal(base[rows, None] + step * from_stick)
            tail[rows] = inverse @ weight
            falling[rows] = -(inverse * inverse) @ weight
        root = 2.0 / np.pi * np.sqrt(left) * np.sqrt(right_)
        return root * tail, root * (0.5 * (1.0 / left + 1.0 / right_) * tail + falling) / r
