"""The states of slip of a contact under tangential load: stick zones, slip zones, and the shear.

`partial_slip.slip` decides which of them a contact is in. What they have in common with a contact
that does not slip, and what a step of the load is, stands in `slip_state`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import edge_integrals
from sie.contact.gap import gap
from sie.contact.known_contact import Normal
from sie.numerics.interval import EPS, Interval, two_sum
from sie.profiles.lowest_points import lowest_points, raised
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.traction.base import Density
from sie.traction.combination import Combination
from sie.traction.of_slope import SlopeDensity

from .shear_density import OneSignedShear
from .slip_state import Slipping, Step
from .slip_zones import (
    Drive,
    EdgeFrame,
    SlipZones,
    slip_zones,
)

Array = NDArray[np.float64]

# Below this fraction of sliding the shear is not taken as a difference of two pressures, which are
# then nearly the same.
SHORT = 1e-2


@dataclass(frozen=True, eq=False)
class Sliding(Slipping):
    """Incipient sliding, |Q| = f P: the slip is that at which the stick zone vanishes.

    `unloaded` is the slope of that limit.
    """

    sign: float
    unloaded: Slope
    kind = "sliding"
    stick = ()

    @cached_property
    def shear(self) -> Density:
        return Combination(((self.sign * self.friction, self.pressure),))

    @property
    def signs(self) -> tuple[float, float]:
        return self.sign, self.sign

    @cached_property
    def _touch(self) -> tuple[float, float]:
        return lowest_points(self._resolved)

    @cached_property
    def _resolved(self) -> Slope:
        """The slope, resolved on the contact alone.

        A strain may move the lowest point of the whole profile out of the contact; then an edge
        slips last.
        """
        x1, x2 = self.contact.x1, self.contact.x2
        return refined(self.unloaded.within(x1, x2), x1, x2, EPS)

    @property
    def lengths(self) -> tuple[float, float]:
        (z1, z2), width = self._touch, 2.0 * self.contact.r
        return min(max(self.contact.from_left(z1), 0.0), width), min(
            max(self.contact.from_right(z2), 0.0), width
        )

    def _opening(self, distance: Array, frame: EdgeFrame) -> Array:
        edge, tail = (
            (self.contact.x2, self.contact.tail2)
            if frame.side > 0.0
            else (self.contact.x1, self.contact.tail1)
        )
        slope = self._resolved.shifted(-edge).shifted(-tail)
        z1, z2 = ((z - edge) - tail for z in self._touch)
        return raised(slope, (z1, z2), -frame.side * distance)


@dataclass(frozen=True, eq=False)
class OneSignedSlip(Slipping):
    """Slip in one direction at both edges: q = sign f (p - p̂).

    Only the edges of the reduced contact are known from the start.
    """

    sign: float
    found: Normal
    kind = "one sign"

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        inner, outer = self.found.edges.contact, self.contact
        return ((max(inner.x1, outer.x1), min(inner.x2, outer.x2)),)

    @property
    def stick_zone(self) -> Interval:
        return self.found.edges.contact

    @cached_property
    def short(self) -> SlipZones | None:
        """The zones by their own equations, where the difference of two pressures loses digits."""
        step, f = self.step, self.friction
        Q, tau, contact = step.Q, step.tau, self.contact
        small = 0.0 < abs(Q) < SHORT * f * step.normal_load and math.pi * contact.r * abs(
            tau
        ) <= abs(Q)
        if not small or any(step.normal.edges.sharp):
            return None
        drive = Drive(self.sign * Q / f, self.sign * math.pi * tau / f, 1.0, 1.0)
        return slip_zones(self.frames, contact, drive, _guess(step, self.sign))

    @cached_property
    def corrective(self) -> SlopeDensity:
        """p̂."""
        step, found = self.step, self.found
        if self.short is not None:
            found = replace(found, edges=replace(found.edges, contact=self.short.stick))
        return step.pressure_on(found)

    @property
    def _tilted(self) -> Slope:
        """The slope of the profile at the tilt of p̂."""
        return self.found.slope(self.step.scene.profile)

    @cached_property
    def shear(self) -> Density:
        return OneSignedShear(
            self.pressure, self.corrective, self.sign * self.friction, self.step.Q, self.short
        )

    @property
    def parts(self) -> tuple[float, tuple[tuple[float, Density], ...]]:
        if self.short is not None:
            return super().parts
        scale = self.sign * self.friction
        return scale, ((-scale, self.corrective),)

    @property
    def signs(self) -> tuple[float, float]:
        return self.sign, self.sign

    @property
    def condition(self) -> float:  # type: ignore[override]
        P, left = self.step.normal_load, self.found.edges.normal_load
        return max(P / left, 1.0)

    @property
    def advancing(self) -> bool:  # type: ignore[override]
        return _advancing(self, self.step, (self.contact.r, self.found.edges.contact.r))

    @cached_property
    def lengths(self) -> tuple[float, float]:
        if self.short is not None:
            return self.short.left.length, self.short.right.length
        outer, inner = self.contact, self.corrective.contact
        left = (inner.x1 - outer.x1) + (inner.tail1 - outer.tail1)
        right = (outer.x2 - inner.x2) + (outer.tail2 - inner.tail2)
        return max(left, 0.0), max(right, 0.0)

    def _opening(self, distance: Array, frame: EdgeFrame) -> Array:
        corrective, slope = in_frame(self.corrective, self._tilted, self.lengths, frame)
        return gap(-frame.side * distance, corrective, slope)


def _advancing(state: Slipping, step: Step, half_widths: tuple[float, float]) -> bool:
    """Whether the zones of slip grow while the stick zone shrinks between these half-widths.

    s2 (Q - π ρ τ) >= 0 <= s1 (Q + π ρ τ).
    """
    Q, tau = step.Q, step.tau
    return all(
        length == 0.0
        or all(sign * (Q - outward * math.pi * rho * tau) >= 0.0 for rho in half_widths)
        for length, sign, outward in zip(state.lengths, state.signs, (-1.0, 1.0), strict=True)
    )


def in_frame(
    density: SlopeDensity, slope: Slope, lengths: tuple[float, float], frame: EdgeFrame
) -> tuple[SlopeDensity, Slope]:
    """A density on the stick zone and its slope in the frame of an edge."""
    near = lengths[frame.side > 0.0]
    # From the width of the stick zone, which the other length may not resolve
    far, rest = two_sum(-near, -2.0 * density.contact.r)
    ends = Interval(far, -near, rest, 0.0) if frame.side > 0.0 else Interval(near, -far, 0.0, -rest)
    dx, tail = frame.origin
    return density.moved(ends, dx, tail), slope.shifted(dx).shifted(tail)


def _guess(step: Step, sign: float) -> tuple[float, float]:
    """Lengths of short zones: dd/dQ = (1 ± π r τ/Q) / (f G r J), J of the left or right edge."""
    contact, G, f = step.pressure.contact, step.pressure.half_modulus, step.scene.friction
    slope = refined(step.slope, contact.x1, contact.x2, EPS)
    k = edge_integrals(slope, contact)
    Q, strain = sign * step.Q, sign * math.pi * contact.r * step.tau
    tiny = EPS * abs(Q)
    return max(Q + strain, tiny) / (f * G * contact.r * k.JL), max(Q - strain, tiny) / (
        f * G * contact.r * k.JR
    )
