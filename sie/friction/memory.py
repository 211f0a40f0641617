"""Load-history memory: the direction in which each layer of a contact was last sheared.

A contact has a level Λ = f P + i π r₀ f E*/2 θ (θ its tilt, r₀ a length of the path), and carries
S = Q + i π r₀ τ. The shear that slip leaves is made of pressures p[Λ] of one profile,

    q = f Σ κ_k (p[Λ_k] - p[Λ_k+1]),     S = Σ κ_k (Λ_k - Λ_k+1),     |κ| <= 1,

in nested contacts, of which that of Λ_0 is the present one: equation (12) is linear, and p[Λ] has
the resultant Re Λ/f and the strain of the profile tilted by θ. A layer is the part between two
contacts, Λ_k - Λ_k+1 its thickness. Below the last one κ = 0.

Slip of the sign s at both edges overwrites κ by s from the top down. While Λ rises by dΛ and S by
dS the front carries s dS - dΛ through layers of the jump 1 - s κ. This is Masing's rule, in which a
larger change erases the smaller turning points, for P, Q, bulk stress and tilt together (Mindlin &
Deresiewicz 1953; Jäger 1998; docs/derivations/layered-memory.md). A contact that grows with
dS = κ dΛ, |κ| <= 1, gets a layer without slip; one that shrinks loses layers.

At constant P and tilt the same holds where slip has opposite directions at the two edges, for S in
proportion: depth is then the amplitude of the step that reaches it in a contact that never slipped.
`load_step` tests what this rests on: nested contacts, and fronts that only run inwards.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from sie.numerics.interval import EPS

# A layer below this fraction of all that slipped is the rounding of one that was overwritten.
NOTHING = 8.0 * EPS
# of κ: layers go without slip where Q falls with P as they carried it, but for rounding
BALANCED = 1e-12
ROUNDED = 4.0 * EPS  # of f P: by so much a rise in proportion may exceed |dQ| = f dP
# of a step: what it may be off the direction of another one that is in proportion to it
PROPORTIONAL = 1e-12

# Whether the contact at the first depth lies within that at the second; both are depths below the
# level from which the step starts.
Within = Callable[[complex, complex], bool]


class SlippedLayer(NamedTuple):
    """A layer between two depths that slipped in a step; κ jumped there by `jump` > 0.

    Depths are counted from the level at the end of the step; `surface` is how deep the contact's
    level was when the front was at `upper` and at `lower`.
    """

    upper: complex
    lower: complex
    jump: float
    surface: tuple[complex, complex] = (0.0, 0.0)

    def moved(self, depth: complex) -> SlippedLayer:
        """The same, counted from a surface that is so much higher."""
        if not depth:
            return self
        start, end = self.surface
        return SlippedLayer(
            self.upper + depth, self.lower + depth, self.jump, (start + depth, end + depth)
        )


class SlipEvent(NamedTuple):
    """Slip in one direction: its sign, and the layers that it overwrote, from the top down.

    `timed` is False where the front passed a corner with one end before the other: then `surface`
    is not where the contact's level was.
    """

    sign: float
    layers: tuple[SlippedLayer, ...]
    timed: bool = True

    def moved(self, depth: complex) -> SlipEvent:
        """The same, counted from a surface that is so much higher."""
        if not depth:
            return self
        return self._replace(layers=tuple(o.moved(depth) for o in self.layers))


class Layer(NamedTuple):
    """A layer: thickness, κ, the layer below, and S and depth of it with all below.

    Memories share the layers below.
    """

    thickness: complex
    k: float
    below: Layer | None
    total: complex
    depth: complex


def _laid(thickness: complex, k: float, below: Layer | None) -> Layer:
    """A layer on others; one with those of the same κ."""
    if below is not None and below.k == k:
        thickness, below = thickness + below.thickness, below.below
    total, depth = (below.total, below.depth) if below else (0.0, 0.0)
    return Layer(thickness, k, below, thickness * k + total, thickness + depth)


def simple(change: complex) -> complex:
    """The same, as a float where the imaginary part is 0."""
    return change if change.imag else change.real


def in_proportion(one: complex, other: complex) -> bool:
    """Whether two changes have one direction, or opposite ones."""
    ratio = one / other if other else complex(one)
    return abs(ratio.imag) <= PROPORTIONAL * abs(ratio)


@dataclass(frozen=True, eq=False, repr=False)
class LoadMemory:
    """The level of a contact, and its layers from the top down; below them κ = 0.

    >>> LoadMemory(9.0).changed(0.0, 3.0)[0].changed(0.0, -2.0)[0].layers
    ((1.0, -1.0), (2.0, 1.0))
    """

    level: complex
    top: Layer | None = None

    @property
    def layers(self) -> tuple[tuple[complex, float], ...]:
        """(thickness, κ) from the top down."""
        found, layer = [], self.top
        while layer is not None:
            found.append((layer.thickness, layer.k))
            layer = layer.below
        return tuple(found)

    def __repr__(self) -> str:
        return f"<load memory of {self.level:g}: {self.layers}>"

    @property
    def total(self) -> complex:
        """S."""
        return self.top.total if self.top else 0.0

    @property
    def deepest(self) -> tuple[complex, bool]:
        """The largest depth to which κ was overwritten, and whether that was more than once."""
        return (self.top.depth, self.top.below is not None) if self.top else (0.0, False)

    @property
    def corners(self) -> tuple[tuple[complex, float], ...]:
        """(depth, κ above - κ below) wherever κ jumps, from the top down."""
        found: list[tuple[complex, float]] = []
        depth: complex = 0.0
        for (thickness, k), (_, after) in pairwise((*self.layers, (0.0, 0.0))):
            depth += thickness
            found.append((depth, k - after))
        return tuple(found)

    def changed(
        self, rise: complex, shear: complex, sign: float = 0.0, within: Within | None = None
    ) -> tuple[LoadMemory, tuple[SlipEvent, ...]]:
        """(new memory, slip in the order of time) after changes of Λ and S in proportion to time.

        `sign` is that of slip; where it is 0, both changes are real, and the sign follows. Without
        `within` all layers are in proportion to the step.

        Where P falls a layer is removed without slip if κ = dS/dΛ. Otherwise slip in the direction
        of dS - κ dΛ runs down from the edges, faster than the edges retreat. In a deeper layer it
        may be slower: where the edges catch up with it, all slipped zones have left the contact,
        and the same two cases hold for the layer below.
        """
        if sign and not rise:
            memory, _, event = self._followed(sign, 0.0, shear, within)
            return memory, (event,) if event.layers else ()
        memory, left = self, 1.0
        slips: list[SlipEvent] = []
        while left > NOTHING:
            k = memory.top.k if memory.top else 0.0
            moves, pulls = left * rise, left * shear
            direction, taken = sign or math.copysign(1.0, shear.real), 1.0
            sticks = abs(pulls) <= moves.real + ROUNDED * (memory.level + moves).real
            if not sign and moves.real > 0.0 and sticks:
                k = min(max(pulls.real / moves.real, -1.0), 1.0)
                return memory.raised(moves, k), tuple(slips)
            if not sign and rise.real < 0.0:
                excess = (shear - k * rise).real
                if abs(excess) <= BALANCED * max(abs(shear), abs(k * rise)):
                    top = memory.top.thickness.real if memory.top else math.inf
                    taken = min(top / -moves.real, 1.0)
                    memory = memory._thinned(-moves.real * taken)
                    left *= 1.0 - taken
                    continue
                direction = math.copysign(1.0, excess)
            memory, taken, event = memory._followed(direction, moves, pulls, within)
            left *= 1.0 - taken
            if event.layers:
                slips.append(event.moved(left * rise))
        return memory, tuple(slips)

    def raised(self, thickness: complex, k: float) -> LoadMemory:
        """The memory after P has risen, with a new layer on top."""
        nothing = k == 0.0 and (self.top is None or (self.top.k == 0.0 and self.top.below is None))
        return LoadMemory(
            self.level + thickness, None if nothing else _laid(thickness, k, self.top)
        )

    def _thinned(self, thickness: float) -> LoadMemory:
        """P lowered, and Q by what the top carried: it is taken off."""
        layer, left = self.top, thickness
        while layer is not None and left > 0.0:
            t, k, below = layer[:3]
            rest = (t - left).real
            layer = _laid(t - left, k, below) if rest > NOTHING * abs(self.level) else below
            left -= min(t.real, left)
        return LoadMemory(self.level - thickness, layer)

    def _followed(
        self, sign: float, rise: complex, shear: complex, within: Within | None
    ) -> tuple[LoadMemory, float, SlipEvent]:
        """Slip of this sign until the end of the step, or until the edges catch up with it.

        (new memory, part of the step, slip), depths counted from the level then.
        """
        pull = sign * shear - rise  # what the front carries in the whole step
        layer, left, timed = self.top, pull, True
        depth: complex = 0.0
        done: list[SlippedLayer] = []
        time = caught = 0.0
        while time < 1.0:
            thickness, k, below = layer[:3] if layer else (math.inf, 0.0, None)
            if layer and k == sign:
                layer, depth = below, depth + thickness
                continue
            jump = 1.0 - sign * k
            taken, start = left / jump, time
            passes, in_time = _passed(layer, depth, taken, within)
            timed = timed and in_time
            if passes:
                taken = thickness
                left -= jump * thickness
            ended = not passes or abs(left) <= NOTHING * abs(pull)
            time = 1.0 if ended else 1.0 - abs(left / pull)
            caught = _caught(depth + rise * start, pull / jump, -rise, start) if rise else math.inf
            if caught < time:
                passes, time = False, caught
                taken = min(((caught - start) * pull / jump).real, taken.real)
            surface = (-rise * start, -rise * time) if rise else (0.0, 0.0)
            done.append(SlippedLayer(depth, depth + taken, jump, surface))
            depth += taken
            rest = thickness - taken
            if layer and (passes or (rise and abs(rest) <= NOTHING * abs(self.level))):
                layer = below
            elif layer:
                layer = _laid(rest, k, below)
            if time == caught:
                depth = -rise * time
                break
        raised = rise * time if rise else 0.0
        on_top = depth + raised
        top = _laid(on_top, sign, layer) if on_top else layer
        moved = tuple([o.moved(raised) for o in done if o.lower != o.upper])
        return LoadMemory(self.level + raised, top), time, SlipEvent(sign, moved, timed)


def _passed(
    layer: Layer | None, depth: complex, taken: complex, within: Within | None
) -> tuple[bool, bool]:
    """Whether a front passes the corner below a layer, and whether both its ends do so at once."""
    if layer is None:
        return False, True
    thickness = layer.thickness
    if within is not None and not in_proportion(taken, thickness):
        passes = within(depth + taken, depth + thickness)
        return passes, not passes
    ahead = (1.0 - (taken / thickness).real) * abs(thickness)
    return ahead <= NOTHING * abs(depth + taken), True


def _caught(ahead: complex, speed: complex, fall: complex, start: float) -> float:
    """When the edges catch up with a front that is so far ahead at a time; inf if they do not."""
    if fall.real <= 0.0 or ahead.imag or speed.imag or fall.imag or speed.real >= fall.real:
        return math.inf
    return start + ahead.real / (fall.real - speed.real)
