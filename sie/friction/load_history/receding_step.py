"""The state after a step in which both ends of the stick zone recede, on any earlier shear.

Strain that is locked in drops out of the change of q. Beside the stick zone [c1, c2] it is
Δq = s f p - q0, and in it 1/π PV∫Δq/(x - t) dt = Δτ, with ∫Δq = ΔQ: the equations of `slip_zones`
for p - s q0/f, ΔQ and Δτ in place of p, Q and τ. They need q0 as a function of x, and nothing of
how it came about. Where an end goes on at constant p, Δq = 0 up to where it was. The slip is

    Δg = 2/E* ∫ [1/π PV∫Δq/(ξ - t) dt - Δτ] dξ      from the end of the stick zone.

The derivation is in docs/derivations/marching.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.coupled.half_potential import Panels
from sie.friction.coupled.traction import resolved_panels
from sie.friction.slip_zones import LEVELS, Drive, SlipZones, opening, slip_zone
from sie.numerics import chebyshev
from sie.numerics.halving import integral
from sie.numerics.interval import Interval
from sie.numerics.root_finding import false_position
from sie.traction.of_slope import SlopeDensity

from .frozen_edge import FrozenEdge
from .growing_contact import LoadChange
from .marched_step import Held, MarchedStep, places
from .panel_shear import SAME
from .receding_equations import NO_ZONE, Equations
from .slip_rates import SlipRates
from .stick_intervals import TINY, Zone, zone

Array = NDArray[np.float64]
Side = tuple[float, float, float]

OF_SLIP = 1e-11  # of the steepest slip, to which its steepness is resolved
SEEN = np.linspace(-0.9, 0.9, 10)  # of a contact: where it is seen how far its pressure changes
OPPOSING = 1e-8  # of the largest slip: what may be against the direction of its zone


class Ends(NamedTuple):
    """How the ends of the stick zone recede, the left and the right one.

    signs      the signs of slip beside them
    goes_on    whether it goes on from where it was, at constant pressure, and not from the edge of
               contact
    near       a stick zone near by, to begin the search with
    """

    signs: tuple[float, float]
    goes_on: tuple[bool, bool] = (False, False)
    near: Interval | None = None


@dataclass(frozen=True, eq=False)
class Receded(MarchedStep):
    """The state after a step in which both ends of the stick zone recede.

    found     the stick zone, and the zones in which q changed
    error     what the equations of the ends miss, over the loads
    change    the change of loads in the whole step, None at constant pressure
    begun     the share of the step at its start
    share     that at its end
    frames    the places from which the zones begin, on the left and the right
    """

    found: SlipZones
    error: float = 0.0
    change: LoadChange | None = None
    begun: float = 0.0
    share: float = 1.0
    frames: tuple[FrozenEdge, ...] = ()

    @property
    def stick(self) -> Interval:
        return self.found.stick

    @cached_property
    def work(self) -> float:
        return super().work if self.change is None else moving_work(self, self.change)

    @property
    def span(self) -> tuple[float, float]:
        return self.begun, self.share

    def until(self, share: float, near: Receded | None = None) -> Receded:
        change = self.change
        assert change is not None
        p, loads, stick = change.pressure(share), change.shear(share), (near or self).stick
        return receded(self.before, p, self.friction, loads, Ends(self.signs, near=stick))

    def in_stick(self, x: Array) -> Array:
        q: Array = self.before.shear(x) + self.friction * self.found.shear(x)
        return q

    def slip(self, x: Array) -> Array:
        out = np.zeros(x.shape)
        for side, end, panels, until in self._opening:
            distance = side * (x - end)
            beside = (distance > 0.0) & (distance <= panels.hi[-1])
            d = distance[beside]
            k = np.minimum(np.searchsorted(panels.hi, d), len(panels.hi) - 1)
            length = (panels.hi - panels.lo)[k]
            s = 2.0 * (d - panels.lo[k]) / length - 1.0
            grown = chebyshev.evaluate(chebyshev.antiderivative(panels.series[k]).T, s)
            out[beside] = (until[k] + 0.5 * length * grown) / self.pressure.half_modulus
        return out

    def slip_at_edge(self, k: int) -> float:
        found, edge = self.found, self.pressure.interval[k]
        signs, zones = (found.drive.left, found.drive.right), (found.left, found.right)
        length, other = zones[k].length, zones[1 - k]
        apart = abs(edge - (found.stick.x1, found.stick.x2)[k])
        if not self.signs[k] or abs(length - apart) > SAME * self.pressure.contact.r:
            return super().slip_at_edge(k)  # the zone whose shear changes does not end there
        frames = frames_beside(self.before, self.pressure, self.friction, self.signs)
        own, across = opening(frames[k].zone(length, at_edge=LEVELS), other, found.stick.r)
        moved = self.friction * (signs[k] * own + signs[1 - k] * across)
        return moved / self.pressure.half_modulus

    @cached_property
    def _in_zones(self) -> tuple[tuple[Zone, Array], ...]:
        """The zones of slip, and the slip in their directions at their places."""
        contact, marks = self.pressure.contact, np.array([*self._places, *self.marks])
        ends = [contact.x1, *(end for stick in self.sticks for end in stick), contact.x2]
        signs = self.signs[0], *(sign for _, _, sign in self.gaps), self.signs[1]
        zones = [
            (sign, zone(between, marks, self.pressure))
            for sign, between in zip(signs, zip(ends[::2], ends[1::2], strict=True), strict=True)
        ]
        return tuple((z, sign * self.slip(z.places)) for sign, z in zones)

    @property
    def largest(self) -> float:
        """The largest slip."""
        return max(float(np.abs(slip).max()) for _, slip in self._in_zones)

    @property
    def opposing(self) -> float:
        """The largest slip against the direction of its zone, over the largest slip."""
        return max(float(-slip.min()) for _, slip in self._in_zones) / max(self.largest, TINY)

    @property
    def _beside(self) -> tuple[Side, ...]:
        """The zones of slip: +1 to the right of a stick zone or -1, its end, and the far end."""
        old, new = self.before.pressure.contact, self.pressure.contact
        left, right = self.reach
        return (-1.0, left, min(old.x1, new.x1)), (1.0, right, max(old.x2, new.x2))

    @cached_property
    def _opening(self) -> tuple[tuple[float, float, Panels, Array], ...]:
        """The side and the end of the stick zone, E*/2 dΔg, and its integrals, for each zone.

        dΔg is on panels of the distance from the end, and has an integral up to each.
        """
        return tuple(self._on_one_side(*zone) for zone in self._beside)

    def _on_one_side(
        self, side: float, end: float, edge: float
    ) -> tuple[float, float, Panels, Array]:
        length = side * (edge - end)
        d = np.unique(side * (np.array([*self._places, *self.marks]) - end))
        apart = np.diff(d, prepend=0.0) > SAME * length
        inner = d[apart & (d > SAME * length) & (d < length * (1.0 - SAME))].tolist()
        steepness = self._steepness(side, end)
        resolved = max(OF_SLIP, self._rounding(side))
        ends = (*inner, length)
        panels = resolved_panels(lambda t, _: steepness(t), ends, 0.0, resolved)[0]
        sums = chebyshev.antiderivative(panels.series).T
        whole = 0.5 * (panels.hi - panels.lo) * chebyshev.evaluate(sums, np.ones(len(panels.lo)))
        return side, end, panels, np.cumsum(whole) - whole

    def _rounding(self, side: float) -> float:
        """What rounding leaves of Δq beside the stick zone, over its largest."""
        k = int(side > 0.0)
        zone_ = (self.found.left, self.found.right)[k]
        return self.frames[k].rounding(zone_, self.pressure)

    def _steepness(self, side: float, end: float) -> Callable[[Array], Array]:
        """E*/2 dΔg at distances from an end of the stick zone, without a difference of potentials.

        It is |R|/π of the integral of Δq/(|R| (x - ξ)), of which the far zone is subtracted.
        """
        k = int(side > 0.0)
        near, far = self.frames[k], (self.found.right, self.found.left)[k]
        length, rho = (self.found.left, self.found.right)[k].length, self.found.stick.r
        signs = self.found.drive.left, self.found.drive.right
        strength, opposite = (self.friction * signs[j] for j in (k, 1 - k))
        whole = slip_zone(near, length, LEVELS)
        over = whole.force / (whole.weight * np.sqrt(whole.from_stick + 2.0 * rho))
        each = whole.weight / np.sqrt(whole.from_stick)

        def steepness(t: Array) -> Array:
            inside = t < length
            own, rest = np.zeros(t.shape), np.maximum(length - t, TINY)[inside]
            own[inside] = near.pressure(rest) / np.sqrt(t[inside] + 2.0 * rho)
            apart = t[:, None] - whole.from_stick
            quotient = np.divide(
                over - own[:, None], apart, out=np.zeros(apart.shape), where=apart != 0.0
            )
            total = quotient @ each
            reached = np.sqrt(length) + np.sqrt(t[inside])
            total[inside] += own[inside] * np.log(reached * reached / rest) / np.sqrt(t[inside])
            total = strength * total - opposite * far.pull(t + 2.0 * rho, rho)
            steep: Array = np.sqrt(t * (t + 2.0 * rho)) / math.pi * total
            return steep

        return steepness


def frames_beside(
    before: Held,
    pressure: SlopeDensity,
    friction: float,
    signs: tuple[float, float],
    goes_on: tuple[bool, bool] = (False, False),
) -> tuple[FrozenEdge, FrozenEdge]:
    """The places from which the zones begin in which the shear changes, left and right."""
    old, new = before.pressure.contact, pressure.contact
    left = before.stick.x1 if goes_on[0] else min(old.x1, new.x1)
    right = before.stick.x2 if goes_on[1] else max(old.x2, new.x2)
    marks = np.array(places(before, pressure))

    def beside(place: float, side: float, sign: float) -> FrozenEdge:
        def free(x: Array) -> Array:
            p: Array = pressure(x) - (sign / friction) * before.shear(x)
            return p

        return FrozenEdge(place, side, right - left, free, marks)

    return beside(left, -1.0, signs[0]), beside(right, 1.0, signs[1])


def receded(
    before: Held,
    pressure: SlopeDensity,
    friction: float,
    loads: tuple[float, float],
    ends: Ends,
) -> Receded:
    """The state under a pressure and the loads Q and τ. Raises ContactError where there is none."""
    (signs, goes_on, near), (Q, tau) = ends, loads
    frames, new = frames_beside(before, pressure, friction, signs, goes_on), pressure.contact
    outer = Interval(frames[0].place, frames[1].place)
    drive = Drive((Q - before.Q) / friction, math.pi * (tau - before.tau) / friction, *signs)
    least = np.maximum([new.x1 - outer.x1, outer.x2 - new.x2], 0.0)
    x = outer.m + outer.r * SEEN
    pressed = outer.r * float(np.abs(pressure(x) - before.pressure(x)).max())
    equations = Equations(frames, outer, drive, least, pressed, pressure)
    guess = None if near is None else np.array([near.x1 - outer.x1, outer.x2 - near.x2])
    lengths = equations.at_marks(equations.solution(guess))
    zones = frames[0].zone(lengths[0]), frames[1].zone(lengths[1])
    found = SlipZones(outer.moved(lengths[0], -lengths[1]), *zones, drive)
    error = float(np.abs(equations.missed(lengths)).max())
    return Receded(before, pressure, friction, signs, Q, tau, found, error, frames=frames)


# -- energy while the pressure changes -------------------------------------------------------------

# How well it is known when an end of the stick zone passes a mark, of a step and of a half-width,
# and the shares of a step before and after which it does not matter.
SURE, EARLY, LATE = 1e-7, 1e-2, 1e-6
TRIED = 3  # states from which another one is searched for
CLOSE = 0.1  # of the time since a part of a step began: two states are no closer than this


def on_the_way(part: Receded) -> Callable[[float], Receded]:
    """The states on the way, each searched for from others that are known.

    The nearest one may be on the wrong side of a mark, or have a zone of slip so short that an edge
    of contact has passed it since. Where all are too far one between is found first.
    """
    known = {part.share: part}

    def state(share: float) -> Receded:
        if share in known:
            return known[share]
        near = sorted(known, key=lambda other: abs(other - share))[:TRIED]
        for other in near:
            with suppress(ContactError):
                known[share] = part.until(share, known[other])
                return known[share]
        if abs(share - near[0]) <= CLOSE * (share - part.begun):
            raise ContactError(NO_ZONE)
        state(0.5 * (share + near[0]))
        return state(share)

    return state


def moving_work(part: Receded, change: LoadChange) -> float:
    """f ∫∫ p |dΔg| dx.

    The ends of the stick zone change their speed at marks, beyond which power is a series in the
    root of time.
    """
    begun, end, state = part.begun, part.share, on_the_way(part)
    rates = SlipRates(change.rates, part.friction, part.signs)

    def power(share: float) -> float:
        now = state(share)
        return rates.power(now.pressure, now.stick)

    cuts = sorted({begun, end, *_passages(part, state)})
    scale, total = max(power(0.5 * (lo + hi)) for lo, hi in pairwise(cuts)), 0.0
    for lo, hi in pairwise(cuts):

        def rate(v: float, lo: float = lo, hi: float = hi) -> float:
            if lo == begun:
                return (hi - lo) * power(lo + (hi - lo) * v)
            return 2.0 * v * (hi - lo) * power(lo + (hi - lo) * v * v)

        total += integral(rate, scale)
    return total


def _passages(part: Receded, state: Callable[[float], Receded]) -> list[float]:
    """The shares of the step at which an end of the stick zone passes a mark."""
    whole = part.share - part.begun
    begun, end = part.begun + EARLY * whole, part.share - LATE * whole
    first, last = state(begun).stick, state(end).stick
    shares = []
    for k in (0, 1):
        lo, hi = sorted((first[k], last[k]))
        for mark in {m for m in places(part.before, part.pressure) if lo < m < hi}:

            def ahead(share: float, k: int = k, mark: float = mark) -> float:
                return state(share).stick[k] - mark

            def settled(a: float, b: float, value: float) -> bool:
                return b - a <= SURE or abs(value) <= SURE * part.stick.r

            values = ahead(begun), ahead(end)
            shares.append(false_position(ahead, begun, end, values, settled))
    return shares
