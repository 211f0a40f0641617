"""A step of the tangential load, and what every state of stick and slip answers."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.contact.known_contact import Normal
from sie.numerics.interval import Interval
from sie.problem.scene import Scene
from sie.profiles.slope import Slope
from sie.traction.base import ZERO, Density
from sie.traction.of_slope import SlopeDensity

from .slip_zones import EdgeFrame, SlipZone, edge_frame, slip_zone

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Step:
    """A contact's pressure and slope, and the loads Q and τ that are applied to it at constant P.

    Friction needs the normal problem only as two functions, whoever solves it:

    contact_under    the contact of the same profile under a load and a tilt
    pressure_on      the pressure on such a contact
    """

    scene: Scene
    normal: Normal
    pressure: SlopeDensity
    Q: float
    tau: float
    tol: float
    economy: Collection[str]
    contact_under: Callable[[float, float], Normal]
    pressure_on: Callable[[Normal], SlopeDensity]

    @property
    def slope(self) -> Slope:
        return self.normal.slope(self.scene.profile)

    @property
    def normal_load(self) -> float:
        return self.normal.edges.normal_load


class Slip(ABC):
    """A state of stick and slip.

    kind         name of the state
    contact      the contact
    friction     f
    stick        stick zones (lo, hi)
    shear        shear traction q
    slip(x)      relative slip
    advancing    whether the slip zones grow along the whole step
    condition    relative error of the load on the stick zone over one of P or Q
    promised     error of q that is promised at best, over its peak
    """

    kind: str
    contact: Interval
    friction: float
    stick: tuple[tuple[float, float], ...]
    advancing: bool = True
    condition: float = 1.0
    promised: float = 0.0

    @property
    @abstractmethod
    def shear(self) -> Density: ...

    @property
    def parts(self) -> tuple[float, tuple[tuple[float, Density], ...]]:
        """q as a multiple of the pressure and the other densities, each times a factor."""
        return 0.0, ((1.0, self.shear),)

    @property
    def contacts(self) -> tuple[Any, ...]:
        """The contacts in several patches, beside that of the pressure, that make up the shear."""
        return ()

    @abstractmethod
    def slip(self, x: Array) -> Array:
        """Displacement of the indenter relative to the body at x (1-d).

        It is 0 in stick zones and outside the contact.
        """

    @property
    @abstractmethod
    def shift(self) -> float:
        """The shift of the indenter beyond that of a contact that does not slip.

        It is ∫ slip / (π sqrt((x - x1)(x2 - x))) dx.
        """

    @property
    def energy(self) -> float:
        """The dissipated energy ∫ f p |slip| dx at constant P."""
        return 0.0

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        """The zones that slipped since the last turning point as (lo, hi, sign of q).

        They are in the order of time; |q| = f p in those in contact.

        Where slip turned while P fell, the zones of the first direction lie beside the contact,
        which has left them.
        """
        return ()

    @property
    def untouched(self) -> tuple[float, float]:
        """The zone that never slipped."""
        return self.stick[0] if self.stick else (0.0, 0.0)

    @property
    def stick_zone(self) -> Interval:
        """The stick zone, which of a corner may reach beyond the contact; its centre if none."""
        middle = self.contact.m
        return Interval(*self.stick[0]) if self.stick else Interval(middle, middle)

    @property
    def levels(self) -> tuple[float, ...]:
        """Further kinks of q: the ends of earlier stick zones."""
        return ()

    def slip_now(self, x: Array) -> Array:
        """The slip since the last turning point."""
        return self.slip(x)


@dataclass(frozen=True, eq=False)
class NoSlip(Slip):
    """Nothing slips and nothing is sheared."""

    contact: Interval
    friction: float
    kind = "stick"

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        return ((self.contact.x1, self.contact.x2),) if self.friction else ()

    @property
    def shear(self) -> Density:
        return ZERO

    def slip(self, x: Array) -> Array:
        return np.zeros(x.shape)

    @property
    def shift(self) -> float:
        return 0.0


class IntegralsOfSlip(NamedTuple):
    """Integrals of slip over the zones at both edges, with dμ = dx/(π w).

    work     ∫f p |slip| dx
    shift    ∫slip dμ: what slip adds to the shift of the indenter
    """

    work: float
    shift: float

    @classmethod
    def over(
        cls, parts: Iterable[tuple[SlipZone, float, Array]], friction: float, half: float
    ) -> IntegralsOfSlip:
        """`parts`: zones, the sign of slip, and |slip|."""
        work = shift = 0.0
        for zone, sign, slip in parts:
            from_other_edge = (2.0 * half - zone.length) + zone.from_stick
            moved = zone.weight * slip / np.sqrt(zone.from_edge * from_other_edge) / math.pi
            work += friction * float(zone.force @ slip)
            shift += sign * float(moved.sum())
        return cls(work, shift)


@dataclass(frozen=True, eq=False)
class Slipping(Slip):
    """The common part of the states with slip: slip is sign f opening(x) on each side.

    It is integrated over the zones in the frames of the edges.
    """

    pressure: SlopeDensity
    slope: Slope
    friction: float
    step: Step

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self.pressure.contact

    @property
    @abstractmethod
    def signs(self) -> tuple[float, float]:
        """Signs of slip at the left and the right edge."""

    @property
    @abstractmethod
    def lengths(self) -> tuple[float, float]: ...

    @abstractmethod
    def _opening(self, distance: Array, frame: EdgeFrame) -> Array:
        """|slip|/f at these distances from the edge."""

    @cached_property
    def frames(self) -> tuple[EdgeFrame, EdgeFrame]:
        return edge_frames(self.pressure, self.slope)

    def slip(self, x: Array) -> Array:
        out = np.zeros(x.shape)
        if not x.size:
            return out
        from_edge = self.contact.from_left(x), self.contact.from_right(x)
        nearer_left = from_edge[0] - self.lengths[0] < from_edge[1] - self.lengths[1]
        for r, distance, sign, side in zip(
            self.frames, from_edge, self.signs, (nearer_left, ~nearer_left), strict=True
        ):
            at = side & (distance >= 0.0)
            if at.any():
                out[at] = sign * self.friction * self._opening(distance[at], r)
        return out

    @property
    def zones(self) -> tuple[SlipZone, SlipZone]:
        left, right = (
            slip_zone(r, length) for r, length in zip(self.frames, self.lengths, strict=True)
        )
        return left, right

    @cached_property
    def integrals(self) -> IntegralsOfSlip:
        """Integrals over the zones."""
        f, frames = self.friction, zip(self.frames, self.zones, self.signs, strict=True)
        parts = [
            (z, sign, f * self._opening(z.from_edge, r)) for r, z, sign in frames if z.length > 0.0
        ]
        return IntegralsOfSlip.over(parts, f, self.contact.r)

    @property
    def energy(self) -> float:
        return self.integrals.work

    @property
    def shift(self) -> float:
        return self.integrals.shift

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        (x1, x2), (left, right) = self.pressure.interval, self.signs
        if not self.stick:
            return ((x1, x2, left),)
        (c1, c2), (lengths) = self.stick[0], self.lengths
        both = ((x1, c1, left), (c2, x2, right))
        return tuple(z for z, length in zip(both, lengths, strict=True) if length > 0.0)


def edge_frames(density: SlopeDensity, slope: Slope) -> tuple[EdgeFrame, EdgeFrame]:
    return edge_frame(density, slope, -1.0), edge_frame(density, slope, 1.0)
