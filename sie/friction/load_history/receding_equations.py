"""The equations of the lengths of both zones in which the shear changes, and their solution."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, product, starmap

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_zones import Drive, SlipZone, excess
from sie.numerics.interval import EPS, Interval
from sie.progress_bar import step_done
from sie.traction.of_slope import SlopeDensity

from .frozen_edge import FrozenEdge

Array = NDArray[np.float64]

ROUNDING = 64.0 * EPS  # of the loads: what steps may no longer make smaller
# Of a half-width, and of all that may slip: where the search begins, and how it goes on.
HALVINGS, FIRST, TRIED = (
    5,
    0.2,
    (0.98, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05, 0.02, 5e-3, 1e-3, *10.0 ** -np.arange(4, 19, 2)),
)
GUESSES = ((2, 5), (5, 30))  # how often for each zone, and how many halvings of its length
DIFFERENCE, MOST_STEPS, LEAST_SHARE, KEPT = 1e-6, 40, 1e-3, 0.05  # of Newton's method
SETTLED = 1e-11  # of the loads: what is missed where no step makes it smaller
ROUGHEST = 1e-2  # of the loads: what may be missed at most where places x are rounded
TINY = 1e-300
NO_ZONE = "no stick zone inside the contact balances the loads"
# of the drive: a mark that misses its equation by less is the end of the stick zone
BALANCED = 1e-12


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations of the lengths of both zones, relative to the loads.

    frames    the places from which the zones begin, on the left and the right
    outer     the interval between them
    drive     the changes of the loads
    least     by how much the edges of contact retreat from there, which is less than the lengths
    pressed   the change of the pressure, as a force
    bound     the pressure
    """

    frames: tuple[FrozenEdge, FrozenEdge]
    outer: Interval
    drive: Drive
    least: Array
    pressed: float
    bound: SlopeDensity

    def _known(self, lengths: Sequence[float] | Array) -> float:
        """How well places and tractions as doubles allow the equations to be fulfilled."""
        return max(
            frame.rounding(frame.zone(length), self.bound)
            for frame, length in zip(self.frames, lengths, strict=True)
        )

    @property
    def size(self) -> float:
        """What the changes of the loads are, as a force, at least the rounding of the load."""
        driven = abs(self.drive.load) + self.outer.r * abs(self.drive.strain) + self.pressed
        return max(driven, EPS * self.bound.resultant)

    def missed(self, lengths: Sequence[float] | Array) -> Array:
        """By what lengths fail them; infinite where they leave no stick zone."""
        if not self._leaves_stick(lengths):
            return np.full(2, np.inf)
        zones = [frame.zone(length) for frame, length in zip(self.frames, lengths, strict=True)]
        return np.array([self._missed(zones, k) for k in (0, 1)])

    def _leaves_stick(self, lengths: Sequence[float] | Array) -> bool:
        return bool(sum(lengths) < 2.0 * self.outer.r)

    def _missed(self, zones: Sequence[SlipZone], k: int) -> float:
        zone, other = zones[k], zones[1 - k]
        return excess(zone, other, self.outer.r, self.drive, k) / self.size

    def solution(self, guess: Array | None = None) -> tuple[float, float]:
        """The lengths. Raises ContactError where there are none, or Newton's method finds none."""
        if self.least.all() and np.abs(self.missed(self.least)).max() <= BALANCED:
            return float(self.least[0]), float(self.least[1])  # nothing slipped
        for first in chain((guess,), starmap(self._guess, GUESSES)):
            if first is None or not ((first > self.least).all() and self._leaves_stick(first)):
                continue
            lengths = self._by_newton(first)
            if lengths is not None:
                return float(lengths[0]), float(lengths[1])
        return self._closed()

    def _closed(self) -> tuple[float, float]:
        """The lengths where loads return to what they were, and a zone has vanished again.

        The shear is what it was too: the equations are fulfilled from one mark to the next.
        """
        places = [
            [least, *(d for d in frame.breaks.tolist() if d > least)]
            for frame, least in zip(self.frames, self.least.tolist(), strict=True)
        ]
        for lengths in product(*places):
            if np.abs(self.missed(lengths)).max() <= max(
                SETTLED, min(self._known(lengths), ROUGHEST)
            ):
                return lengths[0], lengths[1]
        raise ContactError(NO_ZONE)

    def _by_newton(self, lengths: Array) -> Array | None:
        """The lengths, with differences for derivatives; None where it does not converge.

        Derivatives are kept as long as a step with them makes what is missed much smaller.
        """
        missed, fresh = self.missed(lengths), False
        known = min(self._known(lengths), ROUGHEST)
        matrix = self._derivatives(lengths, missed, known)
        for _ in range(MOST_STEPS):
            step_done(0)
            size = float(np.abs(missed).max())
            if size <= EPS:
                break
            if not (np.isfinite(matrix).all() and abs(np.linalg.det(matrix)) > 0.0):
                break
            step = np.asarray(np.linalg.solve(matrix, -missed), dtype=np.float64)
            share = self._within(lengths, step)
            tried = self.missed(lengths + share * step)
            while fresh and share > LEAST_SHARE and not np.abs(tried).max() < size:
                share *= 0.5
                tried = self.missed(lengths + share * step)
            left = float(np.abs(tried).max())
            if left < size:
                lengths, missed = np.add(lengths, share * step), tried
            elif fresh or size <= ROUNDING:
                break
            fresh = not left < KEPT * size
            if fresh:
                known = min(self._known(lengths), ROUGHEST)
                matrix = self._derivatives(lengths, missed, known)
        # Where p falls a shorter zone may fulfil its equation too: it does not grow with its load.
        # Where all beyond the end slipped before, the derivative is rounding of 0.
        found = size <= max(SETTLED, known) and (np.diag(matrix) * lengths > -DIFFERENCE).all()
        return lengths if found else None

    def _derivatives(self, lengths: Array, missed: Array, known: float) -> Array:
        part = max(DIFFERENCE, math.sqrt(known) if known > SETTLED else 0.0)
        # Beyond a mark the equations have another slope.
        h = np.array(
            [
                0.5 * (f.breaks[f.breaks > d] - d).min(initial=2.0 * part * d)
                for f, d in zip(self.frames, lengths.tolist(), strict=True)
            ]
        )
        columns = [self.missed(lengths + h_k * unit) - missed for h_k, unit in zip(h, np.eye(2))]
        matrix: Array = np.array(columns).T / h
        return matrix

    def _within(self, lengths: Array, step: Array) -> float:
        """The share of a step that leaves both zones and the stick zone a width."""
        share = min(1.0, *(0.9 * (lengths - self.least) / np.maximum(-step, TINY)).tolist())
        left, grown = 2.0 * self.outer.r - lengths.sum(), float(step.sum())
        return share if grown <= left else min(share, 0.9 * left / grown)

    def _guess(self, sweeps: int, halvings: int) -> Array | None:
        """Lengths near the longest that fulfil the equations: where p falls, shorter ones may.

        None where a zone has none.
        """
        lengths = self.least + FIRST * (self.outer.r - self.least)
        for sweep, k in product(range(sweeps), (0, 1)):
            other = self.frames[1 - k].zone(lengths[1 - k])
            most = 2.0 * self.outer.r - other.length

            def short(length: float, k: int = k, other: SlipZone = other) -> bool:
                step_done(0)
                zones = [other, other]
                zones[k] = self.frames[k].zone(length)
                return self._missed(zones, k) < 0.0

            least = float(self.least[k])
            tried = [least + part * (most - least) for part in TRIED]
            first = next((n for n, length in enumerate(tried) if short(length)), len(tried))
            if sweep and first in {0, len(tried)}:
                return None
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
