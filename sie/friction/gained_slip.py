"""The slip in a part of a step at its places, from the potential of the change of shear.

(E*/2) dΔg/dx = Re F - Δτ = T_k PV Ψ_k beside the stick zones, and D on strips. Beside a stick zone
it is fitted on panels and integrated from the end of the zone: an end that receded stuck all along,
one that gained a strip slipped by the integral of D before.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics.graded_panels import Pieces, Rule

from .equations import Equations, Gap
from .strips import StripEquations

Array = NDArray[np.float64]


@dataclass(eq=False)
class GainedSlip:
    """(E*/2) Δg from a place that stuck all along, where equations are solved."""

    equations: Equations

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
        slip = self.equations.slip
        senses = {e: s for lo, hi, s in slip for e in (lo, hi)}
        found = [(lo, hi, senses[lo], pieces) for lo, hi, pieces in self.beside]
        for lo, hi, pieces in self.strips:
            sense = senses.get(lo) or senses.get(hi)
            if sense:
                found.append((lo, hi, sense, pieces))
        return found

    @cached_property
    def at_ends(self) -> dict[float, float]:
        """Δg at the ends of the stick zones."""
        found = dict.fromkeys(self.equations.stick.ravel().tolist(), 0.0)
        for lo, hi, pieces in self.strips:
            for e in (lo, hi):
                if e in found:
                    found[e] = float(pieces(np.array([e]))[0])
        return found

    @cached_property
    def strips(self) -> list[tuple[float, float, Pieces]]:
        """The integral of D over each strip, from its beginning."""
        now, found = self.equations, []
        if not isinstance(now, StripEquations):
            return []
        for strip, c in zip(now.strips, now.series, strict=True):
            lo, hi = strip.reaches(float(now.stick.ravel()[strip.j]))
            places = Pieces.places(np.array([[lo, hi]]))
            whole = Pieces.integral(places, c @ strip.basis(places))
            if strip.outward < 0.0:
                whole.series[..., 0] -= whole.last
            found.append((lo, hi, whole))
        return found

    @cached_property
    def beside(self) -> list[tuple[float, float, Pieces]]:
        """Δg on each slip zone."""
        now, found = self.equations, []
        for lo, hi, s in now.slip:
            ends = now.rule.ends
            ends = ends[(ends[:, 0] >= lo) & (ends[:, 1] <= hi)]
            if not ends.size:  # as short as marks are known
                continue
            places = Pieces.places(ends)
            whole = Pieces.integral(places, self._strain(places, s))
            if lo in self.at_ends:
                start = self.at_ends[lo]
            elif hi in self.at_ends:
                start = self.at_ends[hi] - whole.last
            else:
                start = self._across_gap(lo, hi, whole.last)
            whole.series[..., 0] += start
            found.append((lo, hi, whole))
        return found

    def _strain(self, places: Rule, sense: float) -> Array:
        """Re F - Δτ at places in a slip zone."""
        now = self.equations
        middle = 0.5 * float(places.ends.min() + places.ends.max())
        k = int(np.abs(now.stick - middle).min(axis=1).argmin())
        root = now.chord(places.apart(now.centres[k])) * now.ratios(places.apart)
        change = sense * now.after.limit.on(places) - now.before.shear.on(places)
        found: Array = root * now.psi(k, places, change / root)
        return found

    def _across_gap(self, lo: float, hi: float, across: float) -> float:
        """Δg at the left edge of a patch that slides as a whole, from the nearest stick zone."""
        now, ends = self.equations, self.equations.stick.ravel()
        if (ends < lo).any():
            e = float(ends[ends < lo].max())
            return self.at_ends[e] + now.over(Gap(e, lo))
        e = float(ends.min())
        return self.at_ends[e] - now.over(Gap(hi, e)) - across
