"""Zones of contact or stick on several patches, as the conditions of a load step need them.

A change of level or shear, with its load and its tilt, acts on the patches like a flat punch. Its
pressure has a point charge y at every edge e, and beside the outermost patches its gap has

    g' = (1/π) T_i(x) Σ y_e ρ_i(e)/(x - e),     i the patch nearest to x.

Where all charges press, those on smaller patches inside do so too (`friction`). In a gap between
two patches g' then turns once, and g is 0 at both ends: g > 0. Beside the outermost patches a tilt
may turn it, and the smaller patches have the larger g.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sie.friction.step_conditions import SLACK, Zones
from sie.numerics.chord import Points
from sie.numerics.graded_rule import graded, on_panels

from .answer import SeveralPatches
from .dissipation import Untouched
from .measure import edge_ratio
from .newton import edge_charges, loaded

Array = NDArray[np.float64]

# Of the distance to the edge of contact, in a variable whose square that is: next to a patch
CUTS = np.append(np.append(0.0, graded(8)), 1.0)


@dataclass(frozen=True, eq=False)
class PatchZones(Zones):
    """Patches, and the length by which bulk stress and tilt are made forces."""

    found: SeveralPatches | Untouched
    arm: float

    @property
    def intervals(self) -> tuple[tuple[float, float], ...]:
        return self.found.patches

    def at_ends(self, change: complex) -> Array:
        if isinstance(self.found, Untouched):
            return np.array([change.real])
        return self.found.found.state.outward * self._charges(change)

    def opens(self, front: complex, contact: Zones) -> bool:
        pressed = self.at_ends(front)
        if pressed.min() < -SLACK * np.abs(pressed).max():
            return False
        if not front.imag or isinstance(self.found, Untouched):
            return True
        charges, edges = self._charges(front), (contact.intervals[0][0], contact.intervals[-1][1])
        return all(self._gap(charges, side, edge) >= 0.0 for side, edge in enumerate(edges))

    def _charges(self, change: complex) -> Array:
        assert isinstance(self.found, SeveralPatches)
        found = self.found.found
        changes = loaded(found.state, change.real)
        changes[-1] = change.imag / self.arm
        charges: Array = edge_charges(found.operator, moment=False).of(changes)[:-1, 0]
        return charges

    def _gap(self, charges: Array, side: int, edge: float) -> float:
        """π times the gap at an edge of contact, beside the first patch or the last one."""
        assert isinstance(self.found, SeveralPatches)
        o = self.found.found.operator
        patch, end = (0, o.patches.a[0]) if side == 0 else (o.patches.number - 1, o.patches.b[-1])
        if (edge - end) * (side - 0.5) <= 0.0:
            return 0.0
        s, ds = (v.ravel() for v in on_panels(CUTS))
        places = Points(np.full(s.shape, end), (edge - end) * s * s)
        T, _ = o.root(np.full(s.shape, patch), places)
        apart = places.anchor[:, None] - o.patches.edges + places.offset[:, None]
        slope = T * (charges * edge_ratio(o.patches, patch) / apart).sum(axis=1)
        return float((2.0 * (edge - end) * s * ds) @ slope)
