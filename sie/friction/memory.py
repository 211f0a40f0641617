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
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

from sie.numerics.interval import EPS

# A layer below this fraction of the whole ladder is what rounding left of one that was wiped out.
NOTHING = 8.0 * EPS
BALANCED = (
    1e-12  # of κ: layers go without slip where Q falls with P as they carried it, but for rounding
)


@dataclass(frozen=True)
class Overwritten:
    """Between two depths κ jumped by this much (in units of f, positive): what slipped in a step, and in which layer.

    Depths are counted from P at the end of the step; `surface` says how deep P was when the front was at `upper` and at `lower`.
    """

    upper: float
    lower: float
    jump: float
    surface: tuple[float, float] = (0.0, 0.0)

    def moved(self, depth: float) -> Overwritten:
        """The same, counted from a surface that is so much higher."""
        start, end = self.surface
        return Overwritten(
            self.upper + depth, self.lower + depth, self.jump, (start + depth, end + depth)
        )


@dataclass(frozen=True)
class Slipped:
    """Slip in one direction: its sign, and what it overwrote on the way down."""

    sign: float
    layers: tuple[Overwritten, ...]

    def while_raised(self, thickness: float) -> Slipped:
        """The same slip if P did not come before but rose by this thickness along with it."""
        whole = math.fsum(o.jump * (o.lower - o.upper) for o in self.layers)
        used, found = 0.0, []
        for o in self.layers:
            before, used = used, used + o.jump * (o.lower - o.upper)
            found.append(
                replace(
                    o,
                    surface=(
                        thickness * (1.0 - before / whole),
                        thickness * (1.0 - min(used / whole, 1.0)),
                    ),
                )
            )
        return Slipped(self.sign, tuple(found))


class Layer(NamedTuple):
    """A layer of the ladder: thickness, κ/f, the layer below, and Q and depth of it with all below. Ladders share what is below."""

    thickness: float
    k: float
    below: Layer | None
    total: float
    depth: float


def _laid(thickness: float, k: float, below: Layer | None) -> Layer:
    """A layer on others; one with those of the same κ."""
    if below is not None and below.k == k:
        thickness, below = thickness + below.thickness, below.below
    total, depth = (below.total, below.depth) if below else (0.0, 0.0)
    return Layer(thickness, k, below, thickness * k + total, thickness + depth)


@dataclass(frozen=True, eq=False, repr=False)
class Ladder:
    """Layers from the top down; below them κ = 0. `size` is all that can be overwritten: f P, or infinite.

    >>> Ladder(math.inf).pulled(3.0)[0].pulled(-2.0)[0].layers
    ((1.0, -1.0), (2.0, 1.0))
    """

    size: float
    top: Layer | None = None

    @property
    def layers(self) -> tuple[tuple[float, float], ...]:
        """(thickness, κ/f) from the top down."""
        found, layer = [], self.top
        while layer is not None:
            found.append((layer.thickness, layer.k))
            layer = layer.below
        return tuple(found)

    def __repr__(self) -> str:
        return f"<ladder of {self.size:g}: {self.layers}>"

    @property
    def total(self) -> float:
        """Q."""
        return self.top.total if self.top else 0.0

    @property
    def deepest(self) -> tuple[float, bool]:
        """How far down κ was ever overwritten, and whether it was more than once."""
        return (
            (min(self.top.depth, self.size), self.top.below is not None)
            if self.top
            else (0.0, False)
        )

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
        layer = self.top
        done = []
        while left > 0.0:
            thickness, k, below = layer[:3] if layer else (self.size - depth, 0.0, None)
            jump = abs(sign - k)
            taken = left / jump if jump * thickness > left else thickness
            if 0.0 < thickness - taken <= NOTHING * (depth + taken):
                taken = thickness
            if jump and depth + taken > depth:  # not by rounding alone
                done.append(Overwritten(depth, depth + taken, jump))
            if taken < thickness and layer:
                below = _laid(thickness - taken, k, below)
            layer = below
            depth += taken
            left = 0.0 if taken < thickness else max(left - jump * taken, 0.0)
            if left <= NOTHING * abs(step) or (layer is None and depth >= self.size):
                break
        return Ladder(self.size, _laid(depth, sign, layer) if depth else layer), tuple(done)

    def thickened(self, thickness: float, k: float) -> Ladder:
        """P raised: a new layer on top."""
        nothing = k == 0.0 and (self.top is None or (self.top.k == 0.0 and self.top.below is None))
        return Ladder(self.size + thickness, None if nothing else _laid(thickness, k, self.top))

    def thinned(self, thickness: float) -> Ladder:
        """P lowered, and Q by what the top carried: it is taken off."""
        layer, left = self.top, thickness
        while layer is not None and left > 0.0:
            t, k, below = layer[:3]
            layer = _laid(t - left, k, below) if t - left > NOTHING * self.size else below
            left -= min(t, left)
        return Ladder(self.size - thickness, layer)

    def lowered(self, thickness: float, rate: float) -> tuple[Ladder, tuple[Slipped, ...]]:
        """P lowered while Q changes by `rate` for each unit of thickness: the new ladder, and what slipped, in the order of time.

        A layer goes as it came, without slip, where κ = -rate. Otherwise slip in the direction of rate + κ runs down from the edges, faster
        than the edges retreat. In a deeper layer it may be slower: where the edges catch up with it, all that slipped has left the contact,
        and the layer below decides anew.
        """
        ladder, gone = self, 0.0
        slips: list[Slipped] = []
        while thickness - gone > NOTHING * thickness:
            top, k = ladder.top[:2] if ladder.top else (math.inf, 0.0)
            if abs(rate + k) <= BALANCED * max(abs(rate), abs(k)):
                taken = min(top, thickness - gone)
                ladder = ladder.thinned(taken)
            else:
                sign = math.copysign(1.0, rate + k)
                ladder, taken, done = ladder._chased(sign, 1.0 + sign * rate, thickness - gone)
                if done:
                    slips.append(Slipped(sign, tuple(o.moved(gone - thickness) for o in done)))
            gone += taken
        return ladder, tuple(slips)

    def _chased(
        self, sign: float, pull: float, most: float
    ) -> tuple[Ladder, float, list[Overwritten]]:
        """Slip that P follows down: `pull` of Q for each unit of thickness taken off, until that is `most` or all that slipped has gone."""
        layer, depth, taken = self.top, 0.0, 0.0
        done: list[Overwritten] = []
        while taken < most and depth < self.size:
            thickness, k, below = layer[:3] if layer else (self.size - depth, 0.0, None)
            if k == sign:
                layer, depth = below, depth + thickness
                continue
            jump = abs(sign - k)
            speed = pull / jump  # of the front, where that of P is 1
            caught = (depth - taken) / (1.0 - speed) if speed < 1.0 else math.inf
            passed = thickness / speed
            time = min(passed, caught, most - taken)
            way = thickness if time == passed else min(time * speed, thickness)
            done.append(Overwritten(depth, depth + way, jump, (taken, taken + time)))
            depth, taken = depth + way, taken + time
            layer = (
                _laid(thickness - way, k, below)
                if layer and thickness - way > NOTHING * self.size
                else below
            )
            if time == caught:
                depth = taken
            if time != passed:
                break
        else:
            taken = most  # the bodies slide
        left = depth - taken
        return (
            Ladder(self.size - taken, _laid(left, sign, layer) if left > 0.0 else layer),
            taken,
            done,
        )
