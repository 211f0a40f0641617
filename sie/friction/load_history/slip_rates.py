"""The rate of slip beside a stick zone [c1, c2], μ ± ρ, while the pressure changes.

With s the sign of slip on one side and v = |x - μ|/ρ, slip in the direction s alone is the layer
A = dP - s dQ/f, B = E*/2 dθ - s dτ/f of the stick zone,

    dΔg/dt = -2 s f/E* {A/π arccosh v ∓ B ρ sqrt(v² - 1)},           - on the right, + on the left.

Where the other side slips in the other direction, dp acts twice there. The bracket has less by

    4/π ∫ dp/dt artanh κ dη,      κ² = (v - 1)/(v + 1) d/(d + 2ρ),      d from its end to η.

With d = l sin²ψ, l the length of that side, the integrand is even and periodic in ψ, so that
midpoints have all digits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.slip_zones import SlipZone
from sie.numerics.interval import EPS, Interval
from sie.traction.of_slope import SlopeDensity

from .frozen_edge import FrozenEdge
from .growing_contact import Rates

Array = NDArray[np.float64]

FEWEST, MOST = 6, 400  # midpoints
BESIDE = 1e-12  # of the half-width: next to an end of the stick zone
TURNED = 1e-9  # of the fastest slip: what may seem to turn, which is rounding


class Ends(NamedTuple):
    """The edges of contact and the ends of the stick zone in it, at one time or more."""

    x1: Array
    c1: Array
    c2: Array
    x2: Array

    @classmethod
    def at(cls, stick: Interval, contact: Interval) -> Ends:
        """At one time."""
        return cls(*(np.array(x) for x in (contact.x1, stick.x1, stick.x2, contact.x2)))


@dataclass(frozen=True)
class SlipRates:
    """What drives slip: the rates of the loads, f, and the signs on the left and the right."""

    rates: Rates
    friction: float
    signs: tuple[float, float]

    def beside(self, side: int, distance: Array, ends: Ends) -> Array:
        """E*/2 dΔg/dt at distances from the left end, `side` 0, or from the right one."""
        f, s, (x1, c1, c2, x2) = self.friction, self.signs[side], ends
        centre, half, rho = 0.5 * (x1 + x2), 0.5 * (x2 - x1), 0.5 * (c2 - c1)
        strain = self.rates.strain(centre, half)
        load, turn = self.rates.P - s * self.rates.Q / f, strain - s * self.rates.tau / f
        v = distance / rho  # v - 1
        root = np.sqrt(v * (v + 2.0))
        rate = load / math.pi * np.log1p(v + root) + (1.0, -1.0)[side] * rho * turn * root
        if self.signs[0] != self.signs[1]:
            length = np.maximum((x2 - c2, c1 - x1)[side], 0.0)[..., None]
            sine, step = midpoints(length, 2.0 * rho[..., None])
            inner, from_edge = length * sine, length * (1.0 - sine)
            at = (1.0, -1.0)[side] * (half[..., None] - from_edge)
            # dp dη, with dη/sqrt(from_edge) = 2 sqrt(d) dψ
            dp = (self.rates.P / math.pi - strain[..., None] * at) * 2.0 * np.sqrt(inner)
            dp *= step / np.sqrt(2.0 * half[..., None] - from_edge)
            near = distance / (distance + 2.0 * rho)
            beyond = inner / (inner + 2.0 * rho[..., None])
            rate -= 4.0 / math.pi * (np.arctanh(np.sqrt(near[..., None] * beyond)) * dp).sum(-1)
        moved: Array = -s * f * rate
        return moved

    def in_zones(self, pressure: SlopeDensity, stick: Interval) -> list[tuple[SlipZone, Array]]:
        """The zones of slip, with the pressure, and dΔg/dt in them."""
        contact, found = pressure.contact, []
        marks, ends = np.array(pressure.breaks), Ends.at(stick, contact)
        for side, (outward, edge, end) in enumerate(
            ((-1.0, contact.x1, stick.x1), (1.0, contact.x2, stick.x2))
        ):
            frame = FrozenEdge(edge, outward, 2.0 * contact.r, pressure, marks)
            zone = frame.zone(outward * (edge - end))
            rate = self.beside(side, zone.from_stick, ends) / pressure.half_modulus
            found.append((zone, rate))
        return found

    def keep_direction(self, pressure: SlopeDensity, stick: Interval) -> bool:
        """Whether slip goes on in the direction of its zone, up to both edges."""
        found = self.in_zones(pressure, stick)
        rates = [s * g for (_, g), s in zip(found, self.signs, strict=True)]
        room = TURNED * max(float(np.abs(g).max(initial=0.0)) for g in rates)
        return all(float(g.min(initial=0.0)) >= -room for g in rates)

    def onwards(self, contact: Interval, stick: Interval) -> Array:
        """By how much slip goes on next to the left and the right end, which then recede."""
        ends, near = Ends.at(stick, contact), np.array(BESIDE * stick.r)
        return np.array([s * float(self.beside(k, near, ends)) for k, s in enumerate(self.signs)])

    def power(self, pressure: SlopeDensity, stick: Interval) -> float:
        """f ∫ p |dΔg/dt| dx."""
        found = self.in_zones(pressure, stick)
        return self.friction * sum(float(zone.force @ np.abs(g)) for zone, g in found)


def midpoints(length: Array, apart: Array) -> tuple[Array, float]:
    """sin² of midpoints of an angle from 0 to π/2, and their distance.

    They are as many as integrands over a zone of this length ask for that are singular so far
    from it.
    """
    ratios = apart / np.maximum(length, EPS * apart)
    ratio = float(np.fmin.reduce(ratios, axis=None, initial=1.0))  # nan where no zone was found
    growth = 4.0 * math.asinh(math.sqrt(max(ratio, EPS)))
    n = min(max(math.ceil(-math.log(0.1 * EPS) / growth), FEWEST), MOST)
    return np.sin(0.5 * math.pi * (np.arange(n) + 0.5) / n) ** 2, 0.5 * math.pi / n
