"""The memory of a contact that slips to and fro: which way each of its layers was last pulled.

Let the contact grow from nothing to its normal load P, layer by layer: the pressure is p = ∫ (∂p/∂P') dP', and so is every shear traction
that slip at the edges can leave behind,

    q = ∫_0^P κ(P') ∂p/∂P' dP',      Q = ∫_0^P κ dP',      |κ| <= f                      (Jäger 1998; Mindlin & Deresiewicz 1953)

because 1/π PV∫ ∂p/∂P'/(x - t) dt = 0 within the contact of P'. A change of Q at constant P overwrites κ by ± f from the top (the edges)
down, as deep as it takes: Masing's rule, with all its memory of turning points, and their wiping out. P that grows adds a layer with
κ = dQ/dP, which does not slip while |dQ/dP| <= f; P that falls takes layers away. Thickness is counted in Q: f dP'.

At constant P the same holds of any step that opens slip zones monotonically, with a bulk stress in proportion to Q too: depth is then the
amplitude of the step (Q, σ) that reaches it from the virgin state. Only that the zones grow with the amplitude is used.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from .interval import EPS

# A layer below this fraction of the whole ladder is what rounding left of one that was wiped out.
NOTHING = 8.0 * EPS


@dataclass(frozen=True)
class Overwritten:
    """Between two depths κ jumped by this much (in units of f, positive): what slipped in a step, and in which layer."""

    upper: float
    lower: float
    jump: float


@dataclass(frozen=True)
class Ladder:
    """Layers (thickness, κ/f) from the top down; below them κ = 0. `size` is all that can be overwritten: f P, or infinite.

    >>> Ladder(math.inf).pulled(3.0)[0].pulled(-2.0)[0].layers
    ((1.0, -1.0), (2.0, 1.0))
    """

    size: float
    layers: tuple[tuple[float, float], ...] = ()

    @property
    def total(self) -> float:
        """Q."""
        return math.fsum(t * k for t, k in self.layers)

    @property
    def corners(self) -> tuple[tuple[float, float], ...]:
        """(depth, κ above - κ below) wherever κ jumps, from the top down."""
        found, depth = [], 0.0
        for (thickness, k), (_, after) in pairwise((*self.layers, (0.0, 0.0))):
            depth += thickness
            found.append((min(depth, self.size), k - after))
        return tuple(found)

    def pulled(self, step: float) -> tuple[Ladder, tuple[Overwritten, ...]]:
        """Q changed by `step` at constant P: the new ladder, and what was overwritten."""
        sign, left, depth = math.copysign(1.0, step), abs(step), 0.0
        layers = list(self.layers)
        done = []
        while left > 0.0:
            thickness, k = layers.pop(0) if layers else (self.size - depth, 0.0)
            jump = abs(sign - k)
            taken = left / jump if jump * thickness > left else thickness
            if 0.0 < thickness - taken <= NOTHING * (depth + taken):
                taken = thickness
            if jump:
                done.append(Overwritten(depth, depth + taken, jump))
            if taken < thickness and (layers or k):
                layers.insert(0, (thickness - taken, k))
            depth += taken
            left = 0.0 if taken < thickness else max(left - jump * taken, 0.0)
            if left <= NOTHING * abs(step) or (not layers and depth >= self.size):
                break
        if layers and layers[0][1] == sign:
            depth += layers.pop(0)[0]
        return Ladder(self.size, ((depth, sign), *layers) if depth else tuple(layers)), tuple(done)

    def thickened(self, thickness: float, k: float) -> Ladder:
        """P raised: a new layer on top."""
        layers = self.layers
        if layers and layers[0][1] == k:
            thickness, layers, added = thickness + layers[0][0], layers[1:], thickness
        else:
            added = thickness
        if k == 0.0 and not layers:
            return Ladder(self.size + added)
        return Ladder(self.size + added, ((thickness, k), *layers))

    def thinned(self, thickness: float) -> tuple[Ladder, float]:
        """P lowered: the top taken off, and the Q that went with it."""
        layers, left, lost = list(self.layers), thickness, 0.0
        while layers and left > 0.0:
            t, k = layers.pop(0)
            taken = min(t, left)
            if t - taken > NOTHING * self.size:
                layers.insert(0, (t - taken, k))
            left -= taken
            lost += taken * k
        return Ladder(self.size - thickness, tuple(layers)), lost
