"""The slip gradient that normal loading leaves in the contact of dissimilar bodies.

γ = E*/2 g' = 1/π PV∫q/(x - t) dt + β p is what a point that sticks keeps. With P'(s) = dP/ds and
the slip gradient γ̂(τ) of the flat punch under P = 1 on |t| < 1,

    γ(y) = ∫ P'(s) γ̂(y/s) ds/s,        a < s < min(b, y/c),

as γ̂ = 0 for τ < c. A point y < s slips before it is touched, s < y, too. On c < τ the shear is f p
beside a function that is regular there, so that (docs/derivations/coupled_slip.md)

    γ̂ = (1 - β²) cos(πθ) χ S/β  next to c,    β (1 + f²) φ - J  for τ < 1,    f D - J  for τ > 1,

and ∫_a^y P' D(y/s) ds/s = E*/2 h' by (1).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .load_rate import GrowthPanel
from .panels import graded, totals
from .profile import Kernel, Superposition
from .tables import Table

Array = NDArray[np.float64]


class SlipGradient:
    """γ at 0 <= y <= b, from E*/2 h' and P' up to origin + ahead."""

    def __init__(self, superposition: Superposition, ahead: float) -> None:
        self.flat, self.growth = superposition.flat, superposition.growth
        self.superposition, self.ahead = superposition, ahead

    def __call__(self, y: Array, H: Array) -> Array:
        """γ; H is E*/2 h' at y."""
        flat, origin = self.flat, self.growth[0].origin
        gamma = np.zeros(len(y))
        slipped = (y > flat.c * origin) & (y > 0.0)
        at = y[slipped]
        top = np.minimum(self.ahead, at / flat.c - origin)
        gamma[slipped] = flat.friction * H[slipped] - self._beside_shear(at, top)
        whole = np.full(len(at), self.ahead)
        gamma[slipped] += self.superposition._sum(self._kernels, at, whole, over_s=True)
        return gamma

    @cached_property
    def _kernels(self) -> tuple[Kernel, ...]:
        """γ̂ next to c, and its part that is infinite at τ = 1."""
        f, of = self.flat, self.superposition
        beside = (1.0 - f.beta**2) * f.sine / f.beta
        strength = f.beta * (1.0 + f.friction**2) * f.sine
        chi, S, Psi = f.weight, f.S, f.Psi
        return (
            of._near_edge(lambda t, e, d: strength * chi(t, e, d) * Psi(t, e), -f.h),
            of._beside_c(lambda t, e, d: beside * chi(t, e, d) * S(t, e), f.h),
        )

    @cached_property
    def _J(self) -> Table:
        """J(τ) τ as a function of c^(1/2)/τ from 0 to 1."""
        f = self.flat

        def J(part: Array, rest: Array) -> Array:
            values = f._J(f.middle / part, (f.beyond - rest) / part, f._S_in_stick)
            return values * f.middle / part

        # J is not smooth at τ = c and at τ = -1, the other edge
        return Table((0.0, 1.0), (1.0, 0.0), (f.middle, f.beyond / f.middle), J)

    def _beside_shear(self, y: Array, top: Array) -> Array:
        """∫P' J(y/s) ds/s up to y/c^(1/2) or origin + top."""
        total = np.zeros(len(y))
        for panel in self.growth:
            far = y / self.flat.middle - panel.origin
            end = np.minimum(np.minimum(far, top), panel.hi)
            k = np.flatnonzero(end > panel.lo)
            if k.size:
                total[k] += self._on_panel(panel, y[k], end[k], (far - end)[k])
        return total

    def _on_panel(self, panel: GrowthPanel, y: Array, end: Array, before: Array) -> Array:
        """The same on one panel up to `end`, which lies `before` y/c^(1/2)."""
        f, z = self.flat, panel.origin
        to_c = np.maximum(y * (f.beyond / f.c), (y / f.c - z) - end)
        kink = np.minimum(y + (z + panel.lo), panel.behind)
        owner, ahead, left, weight = graded(end - panel.lo, kink, to_c, (panel.at_start, 0.0))
        scale = (f.middle / y[owner])[:, None]
        # Next to its end J varies over distances as short as the slip zone: 1 - part would lose
        # their digits
        remaining = scale * (before[owner][:, None] + left)
        values = self._J(scale * ((z + panel.lo) + ahead), remaining) * panel(ahead) * weight
        return totals(owner, values, len(y)) / y
