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
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval
from sie.traction.of_slope import SlopeDensity

from .coupled_traction import Panels, resolved_panels
from .marched_step import FrozenEdge, Held, MarchedStep, places
from .panel_shear import SAME
from .slip_zones import Drive, SlipZone, SlipZones, excess

Array = NDArray[np.float64]
Side = tuple[float, float, float]

# Of a half-width, and of all that may slip: where the search begins, and how it goes on.
HALVINGS, FIRST, TRIED = (
    5,
    0.2,
    (0.98, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05, 0.02, 5e-3, 1e-3, 1e-4, 1e-6),
)
GUESSES = ((2, 5), (5, 30))  # how often for each zone, and how many halvings of its length
DIFFERENCE, MOST_STEPS, LEAST_SHARE = 1e-6, 30, 1e-3  # of Newton's method
SETTLED = 1e-11  # of the loads: what is missed where no step makes it smaller
TINY = 1e-300
NO_ZONE = "no stick zone inside the contact balances the loads"
# of the drive: a mark that misses its equation by less is the end of the stick zone
BALANCED = 1e-12
OF_SLIP = 1e-11  # of the steepest slip, to which its steepness is resolved


class Ends(NamedTuple):
    """How the ends of the stick zone recede, the left and the right one.

    signs      the signs of slip beside them
    goes_on    whether it goes on from where it was, at constant pressure, and not from the edge of
               contact
    """

    signs: tuple[float, float]
    goes_on: tuple[bool, bool] = (False, False)


@dataclass(frozen=True, eq=False)
class Receded(MarchedStep):
    """The state after a step in which both ends of the stick zone recede.

    found     the stick zone, and the zones in which q changed
    error     what the equations of the ends miss, over the loads
    """

    found: SlipZones
    error: float = 0.0

    @property
    def stick(self) -> Interval:
        return self.found.stick

    @property
    def reach(self) -> tuple[float, float]:
        return self.stick.x1, self.stick.x2

    def under(self, pressure: SlopeDensity, loads: tuple[float, float]) -> Receded:
        """The same under another pressure, Q and τ, with slip in the same directions."""
        return receded(self.before, pressure, self.friction, loads, Ends(self.signs))

    def power(self, rates: tuple[float, float, float, float]) -> float:
        """f ∫p |dΔg/dt| dx from dP/dt, dQ/dt, dτ/dt and E*/2 times that of the tilt.

        Slip in one direction s is the layer A = dP - s dQ/f, B = E*/2 dθ - s dτ/f of the stick zone

            dΔg/dt = -2 s f/E* {A/π arccosh v ∓ B ρ sqrt(v² - 1)};

        where it is opposite on the other side, dp acts twice there.
        """
        contact, f, rho, total = self.pressure.contact, self.friction, self.stick.r, 0.0
        dP, dQ, dtau, strain = rates
        zones = self._whole_zones
        for k, (zone, sign) in enumerate(zip(zones, self.signs, strict=True)):
            v = zone.from_stick / rho  # v - 1
            root = np.sqrt(v * (v + 2.0))
            load, turn = dP - sign * dQ / f, strain - sign * dtau / f
            rate = load / math.pi * np.log1p(v + root) + (1.0, -1.0)[k] * rho * turn * root
            if self.signs[0] != self.signs[1]:
                far = zones[1 - k]
                w = np.sqrt(far.from_edge * (2.0 * contact.r - far.from_edge))
                at = (-1.0, 1.0)[1 - k] * (contact.r - far.from_edge)
                dp = far.weight * (dP / math.pi - strain * at) / w
                near = zone.from_stick / (zone.from_stick + 2.0 * rho)
                beyond = far.from_stick / (far.from_stick + 2.0 * rho)
                rate -= 4.0 / math.pi * np.arctanh(np.sqrt(near[:, None] * beyond)) @ dp
            total -= f * float(zone.force @ rate)
        return f * total / self.pressure.half_modulus

    @property
    def _whole_zones(self) -> tuple[SlipZone, SlipZone]:
        """The zones of slip from the edges of contact, with the pressure."""
        contact, marks = self.pressure.contact, np.array([*self._places, *self.marks])
        left, right = (
            FrozenEdge(edge, side, 2.0 * contact.r, self.pressure, marks).zone(side * (edge - end))
            for side, edge, end in zip(
                (-1.0, 1.0), (contact.x1, contact.x2), self.reach, strict=True
            )
        )
        return left, right

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

        def steepness(distance: Array) -> Array:
            x = end + side * distance
            change = self.shear.hilbert(x) - self.before.shear.hilbert(x)
            steep: Array = side * (change - (self.tau - self.before.tau))
            return steep

        panels = resolved_panels((steepness,), (*inner, length), 0.0, OF_SLIP)[0]
        sums = chebyshev.antiderivative(panels.series).T
        whole = 0.5 * (panels.hi - panels.lo) * chebyshev.evaluate(sums, np.ones(len(panels.lo)))
        return side, end, panels, np.cumsum(whole) - whole


def receded(
    before: Held,
    pressure: SlopeDensity,
    friction: float,
    loads: tuple[float, float],
    ends: Ends,
) -> Receded:
    """The state under a pressure and the loads Q and τ. Raises ContactError where there is none."""
    (signs, goes_on), (Q, tau) = ends, loads
    old, new = before.pressure.contact, pressure.contact
    left = before.stick.x1 if goes_on[0] else min(old.x1, new.x1)
    right = before.stick.x2 if goes_on[1] else max(old.x2, new.x2)
    outer, marks = Interval(left, right), np.array(places(before, pressure))

    def beside(place: float, side: float, sign: float) -> FrozenEdge:
        def free(x: Array) -> Array:
            p: Array = pressure(x) - (sign / friction) * before.shear(x)
            return p

        return FrozenEdge(place, side, 2.0 * outer.r, free, marks)

    frames = beside(left, -1.0, signs[0]), beside(right, 1.0, signs[1])
    drive = Drive((Q - before.Q) / friction, math.pi * (tau - before.tau) / friction, *signs)
    equations = Equations(frames, outer, drive)
    lengths = equations.at_marks(equations.solution())
    zones = frames[0].zone(lengths[0]), frames[1].zone(lengths[1])
    found = SlipZones(outer.moved(lengths[0], -lengths[1]), *zones, drive)
    error = float(np.abs(equations.missed(lengths)).max())
    return Receded(before, pressure, friction, signs, Q, tau, found, error)


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations of the lengths of both zones, relative to the loads."""

    frames: tuple[FrozenEdge, FrozenEdge]
    outer: Interval
    drive: Drive

    def missed(self, lengths: Sequence[float] | Array) -> Array:
        """By what lengths fail them; infinite where they leave no stick zone."""
        if not sum(lengths) < 2.0 * self.outer.r:
            return np.full(2, np.inf)
        zones = [frame.zone(length) for frame, length in zip(self.frames, lengths, strict=True)]
        return np.array([self._missed(zones, k) for k in (0, 1)])

    def _missed(self, zones: Sequence[SlipZone], k: int) -> float:
        zone, other = zones[k], zones[1 - k]
        size = abs(self.drive.load) + self.outer.r * abs(self.drive.strain)
        return excess(zone, other, self.outer.r, self.drive, k) / size

    def solution(self) -> tuple[float, float]:
        """The lengths. Raises ContactError where there are none, or Newton's method finds none."""
        for sweeps, halvings in GUESSES:
            lengths = self._by_newton(self._guess(sweeps, halvings))
            if lengths is not None:
                return float(lengths[0]), float(lengths[1])
        raise ContactError(NO_ZONE)

    def _by_newton(self, lengths: Array) -> Array | None:
        """The lengths, with differences for derivatives; None where it does not converge."""
        missed = self.missed(lengths)
        for _ in range(MOST_STEPS):
            size = float(np.abs(missed).max())
            matrix = self._derivatives(lengths, missed)
            if size <= EPS:
                break
            if not (np.isfinite(matrix).all() and abs(np.linalg.det(matrix)) > 0.0):
                break
            step = np.asarray(np.linalg.solve(matrix, -missed), dtype=np.float64)
            share = self._within(lengths, step)
            while share > LEAST_SHARE:
                tried = self.missed(lengths + share * step)
                if np.abs(tried).max() < size:
                    break
                share *= 0.5
            else:
                break
            lengths, missed = np.add(lengths, share * step), tried
        # Where p falls a shorter zone may fulfil its equation too: it does not grow with its load.
        # Where all beyond the end slipped before, the derivative is rounding of 0.
        found = size <= SETTLED and (np.diag(matrix) * lengths > -DIFFERENCE).all()
        return lengths if found else None

    def _derivatives(self, lengths: Array, missed: Array) -> Array:
        h = DIFFERENCE * lengths
        columns = [self.missed(lengths + h * unit) - missed for unit in np.eye(2)]
        matrix: Array = np.array(columns).T / h
        return matrix

    def _within(self, lengths: Array, step: Array) -> float:
        """The share of a step that leaves both zones and the stick zone a width."""
        share = min(1.0, *(0.9 * lengths / np.maximum(-step, TINY)).tolist())
        left, grown = 2.0 * self.outer.r - lengths.sum(), float(step.sum())
        return share if grown <= left else min(share, 0.9 * left / grown)

    def _guess(self, sweeps: int, halvings: int) -> Array:
        """Lengths near the longest that fulfil the equations: where p falls, shorter ones may."""
        lengths = np.full(2, FIRST * self.outer.r)
        for sweep, k in product(range(sweeps), (0, 1)):
            other = self.frames[1 - k].zone(lengths[1 - k])
            most = 2.0 * self.outer.r - other.length

            def short(length: float, k: int = k, other: SlipZone = other) -> bool:
                zones = [other, other]
                zones[k] = self.frames[k].zone(length)
                return self._missed(zones, k) < 0.0

            tried = [part * most for part in TRIED]
            first = next((n for n, length in enumerate(tried) if short(length)), len(tried))
            if sweep and first in {0, len(tried)}:
                raise ContactError(NO_ZONE)
            first = min(first, len(tried) - 1)
            low, high = tried[first], tried[first - 1] if first else most
            for _ in range(halvings):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if short(middle) else (low, middle)
            lengths[k] = 0.5 * (low + high)
        return lengths

    def at_marks(self, lengths: tuple[float, float]) -> tuple[float, float]:
        """The lengths, shortened to the next mark where the loads are balanced there too.

        What is beyond it had slipped already.
        """
        shorter = list(lengths)
        for k, frame in enumerate(self.frames):
            nearer = frame.breaks[frame.breaks < lengths[k]]
            if nearer.size:
                shorter[k] = float(nearer[-1])
                if abs(self.missed(shorter)[k]) > BALANCED:
                    shorter[k] = lengths[k]
        return shorter[0], shorter[1]
