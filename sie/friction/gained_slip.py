"""The slip in a part of a step, from the potential of the change of shear, and what it shifts.

(E*/2) dΔg/dx = Re F - Δτ beside the stick zones, and D on strips. Beside a stick zone it is fitted
on panels and integrated from the end of the zone: an end that receded stuck all along, one that
gained a strip slipped by the integral of D before.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.graded_panels import OF_SERIES, Pieces, Rule
from sie.numerics.zones import united

from .potentials import Potential
from .state import SAME, Contact, Ends, State, intervals

Array = NDArray[np.float64]


@dataclass(eq=False)
class GainedSlip:
    """(E*/2) Δg from a place that stuck all along, or the rate of g, of a potential."""

    potential: Potential

    def at(self, x: Array) -> Array:
        total = np.zeros(x.shape)
        for lo, hi, pieces in [*self.beside, *self.strips]:
            inside = (x >= lo) & (x <= hi)
            total[inside] = pieces(x[inside])
        return total

    @property
    def slipped(self) -> list[tuple[float, float, float, Pieces]]:
        """Δg and the direction of slip where the surface slips, or did before it stuck.

        A strip behind an edge that grows and sticks never slipped.
        """
        slip = self.potential.slip
        senses = {e: s for lo, hi, s in slip for e in (lo, hi)}
        found = [(lo, hi, senses[lo], pieces) for lo, hi, pieces in self.beside]
        for lo, hi, pieces in self.strips:
            sense = senses.get(lo) or senses.get(hi)
            if sense:
                found.append((lo, hi, sense, pieces))
        return found

    def paired(self, density: Callable[[Rule], Array], contact: Contact) -> float:
        """∫ d s Δg dx of a density d on a contact, s the direction of slip."""
        total = 0.0
        for lo, hi, sense, pieces in self.slipped:
            marks = np.unique(np.concatenate((pieces.marks, contact.limit.marks)))
            rule = Rule.graded(intervals([(lo, hi)], marks, SAME * contact.width), OF_SERIES)
            total += sense * float(rule.weight @ (density(rule) * pieces.on(rule)))
        return total

    @cached_property
    def at_ends(self) -> dict[float, float]:
        """Δg at the ends of the stick zones."""
        found = dict.fromkeys(self.potential.stick.ravel().tolist(), 0.0)
        for lo, hi, pieces in self.strips:
            for e in (lo, hi):
                if e in found:
                    found[e] = float(pieces(np.array([e]))[0])
        return found

    @cached_property
    def strips(self) -> list[tuple[float, float, Pieces]]:
        """The integral of D over each strip, from its beginning."""
        return self.potential.slipped_strips

    @cached_property
    def beside(self) -> list[tuple[float, float, Pieces]]:
        """Δg on each slip zone."""
        now, found = self.potential, []
        for lo, hi, s in now.slip:
            ends = now.rule.ends
            ends = ends[(ends[:, 0] >= lo) & (ends[:, 1] <= hi)]
            if not ends.size:  # as short as marks are known
                continue
            places = Pieces.places(ends)
            whole = Pieces.integral(places, now.strain(places, s))
            if lo in self.at_ends:
                start = self.at_ends[lo]
            elif hi in self.at_ends:
                start = self.at_ends[hi] - whole.last
            else:
                start = self._across_gap(lo, hi, whole.last)
            whole.series[..., 0] += start
            found.append((lo, hi, whole))
        return found

    def _across_gap(self, lo: float, hi: float, across: float) -> float:
        """Δg at the left edge of a patch that slides as a whole, from the nearest stick zone."""
        ends = self.potential.stick.ravel()
        if (ends < lo).any():
            e = float(ends[ends < lo].max())
            return self.at_ends[e] + self._gained(e, lo)
        e = float(ends.min())
        return self.at_ends[e] - self._gained(hi, e) - across

    def _gained(self, lo: float, hi: float) -> float:
        """What Δg gains between places outside the stick zones."""
        now, total = self.potential, 0.0
        inside = now.sources[(now.sources[:, 0] >= lo) & (now.sources[:, 1] <= hi)]
        for a, b in pairwise(np.unique(np.append(inside, (lo, hi))).tolist()):
            places = Pieces.places(np.array([[a, b]]))
            sense = next((s for x1, x2, s in now.slip if x1 <= a and b <= x2), 0.0)
            total += Pieces.integral(places, now.strain(places, sense)).last
        return total


def drag(before: State, after: State, stuck: Ends) -> float:
    """π E*/2 times the shift of the indenter, but for a multiple of ΔQ that is always the same.

    It is -∫Δq ln|x_s - t| dt + π Δτ x_s, x_s in the longest of the zones that stuck all along.
    """
    old, new = before.contact, after.contact
    if not stuck:
        raise ContactError("no point stuck all along: how far slip shifts is not covered")
    lo, hi = max(stuck, key=lambda zone: zone[1] - zone[0])
    x_s = 0.5 * (lo + hi)
    marks = np.unique(np.concatenate((before.marks, after.marks, [x_s])))
    rule = Rule.graded(intervals(united((*old.patches, *new.patches)), marks, SAME * new.width))
    change = rule.weight * (after.shear.on(rule) - before.shear.on(rule))
    log = np.log(np.abs(rule.apart_from(x_s)))
    return float(-(change @ log) + math.pi * (new.tau - old.tau) * x_s)
