"""Load-history memory: the direction in which each layer of a contact was last sheared.

Let the contact grow from nothing to its normal load P, layer by layer: the pressure is
p = ∫ (∂p/∂P') dP', and so is every shear traction that slip at the edges can leave behind,

    q = ∫_0^P κ(P') ∂p/∂P' dP',      Q = ∫_0^P κ dP',      |κ| <= f

because 1/π PV∫ ∂p/∂P'/(x - t) dt = 0 within the contact of P' (Mindlin & Deresiewicz 1953; Jäger
1998). A change of Q at constant P overwrites κ by ± f from the top (the edges) down, to the depth
that carries the change. This is Masing's rule, in which a larger change erases the smaller turning
points. A growing P adds a layer with κ = dQ/dP, which does not slip while |dQ/dP| <= f; a falling P
removes layers. Thickness is counted in Q: f dP'.

At constant P the same holds of any step that opens slip zones monotonically, also with a bulk
stress in proportion to Q: depth is then the amplitude of the step (Q, σ) that reaches it in a
contact that never slipped. The derivation uses only that the zones grow with the amplitude.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

from sie.errors import ContactError
from sie.numerics.interval import EPS
from sie.problem.load_path import Path
from sie.problem.scene import Scene

from .load_limit import refuse_sliding

# A layer below this fraction of the whole memory is what rounding left of one that was wiped out.
NOTHING = 8.0 * EPS
# of κ: layers go without slip where Q falls with P as they carried it, but for rounding
BALANCED = 1e-12
ROUNDED = 4.0 * EPS  # of f P: by so much a rise in proportion may exceed |dQ| = f dP
# of the largest bulk stress: what (Q, σ) may be off a straight line through the origin
PROPORTIONAL = 1e-12


# -- the steps of a path ---------------------------------------------------------------------------


@dataclass(frozen=True)
class TurningPoint:
    """A turning point of a path.

    loads     P, Q and σ
    memory    the layers there
    slips     the slip since the last turning point, in the order of time
    """

    loads: tuple[float, float, float]
    memory: LoadMemory
    slips: tuple[SlipEvent, ...] = ()

    @property
    def last(self) -> SlipEvent | None:
        """The slip at the end of the step; None if nothing slips in the present contact."""
        return self.slips[-1] if self.slips and self.slips[-1].layers[-1].lower > 0.0 else None


def direction(path: Path) -> tuple[float, float]:
    """(Q, σ) of one unit of amplitude: (1, 0) without bulk stress."""
    _, Q, sigma = max(path.points, key=lambda point: abs(point[2]))
    return (Q, sigma) if sigma else (1.0, 0.0)


def turning_points(scene: Scene, path: Path) -> tuple[TurningPoint, ...]:
    """The layers after each step of a path.

    Raises ContactError, with the step, where one is not covered.
    """
    unit, f = direction(path), scene.friction
    state = TurningPoint((0.0, 0.0, 0.0), LoadMemory(0.0))
    found = []
    for k, loads in enumerate(path.points):
        P, Q, _ = loads
        if f == 0.0 and Q != 0.0:
            raise ValueError(
                f"Q of point {k} = {Q:g} without friction: a frictionless contact carries none; "
                "give friction > 0"
            )
        try:
            refuse_sliding(f, P, Q)
            before = TurningPoint((P, 0.0, 0.0), LoadMemory(_size(f, P, unit))) if k == 0 else state
            state = _stepped(scene, before, loads, unit)
        except ContactError as problem:
            raise type(problem)(
                f"step {k} of the path, to (P, Q, σ) = {_shown(loads)}: {problem}", step=k
            ) from None
        found.append(state)
    return tuple(found)


def _shown(loads: tuple[float, float, float]) -> str:
    return f"({', '.join(f'{v:.6g}' for v in loads)})"


def _size(f: float, P: float, unit: tuple[float, float]) -> float:
    return f * P / abs(unit[0]) if unit[0] else math.inf


def _stepped(
    scene: Scene, before: TurningPoint, loads: tuple[float, float, float], unit: tuple[float, float]
) -> TurningPoint:
    (P0, Q0, sigma0), (P, Q, sigma), f = before.loads, loads, scene.friction
    if f == 0.0:
        return TurningPoint(loads, LoadMemory(0.0))
    amplitude = sigma / unit[1] if unit[1] else Q
    if abs(amplitude * unit[0] - Q) > PROPORTIONAL * max(abs(unit[0]), f * P * EPS):
        raise ContactError(
            f"(Q, σ) is not in proportion to ({unit[0]:.6g}, {unit[1]:.6g}), the path's largest "
            "bulk stress: the zones of slip of one direction do not contain those of the other; "
            "keep Q and σ in proportion, or leave σ out"
        )
    if P == P0:
        return _sheared(loads, before.memory, amplitude)
    if (Q0, sigma0) == (Q, sigma) == (0.0, 0.0) and before.memory.top is None:
        return TurningPoint(loads, LoadMemory(_size(f, P, unit)))  # nothing was ever sheared
    if unit[1]:
        raise ContactError(
            "P changes on a path with a bulk stress, after it or together with it: no "
            "superposition is exact then; "
            "reach P before Q and σ and keep it constant, or leave σ out"
        )
    if scene.moment is not None and not (scene.moment == 0.0 == scene.profile.axis):
        raise ContactError(
            "P changes at a given moment, which tilts the profile: its contacts are not nested; "
            "give tilt instead"
        )
    if P > P0:
        rise = f * (P - P0)
        k = (Q - Q0) / rise
        memory = replace(before.memory.raised(rise, min(max(k, -1.0), 1.0)), size=f * P)
        if abs(Q - Q0) <= rise + ROUNDED * f * P:
            return TurningPoint(loads, memory)
        sheared = _sheared(loads, memory, Q)
        return replace(sheared, slips=tuple(slip.while_raised(rise) for slip in sheared.slips))
    memory, slips = before.memory.lowered(f * (P0 - P), (Q - Q0) / (f * (P0 - P)))
    return TurningPoint(loads, replace(memory, size=f * P), slips)


def _sheared(
    loads: tuple[float, float, float], memory: LoadMemory, amplitude: float
) -> TurningPoint:
    step = amplitude - memory.total
    if abs(step) <= 4.0 * EPS * max(abs(amplitude), abs(memory.total)):
        return TurningPoint(loads, memory)
    new, done = memory.sheared(step)
    return TurningPoint(loads, new, (SlipEvent(math.copysign(1.0, step), done),) if done else ())


# -- the layers ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SlippedLayer:
    """A layer between two depths that slipped in a step; κ jumped there by `jump` > 0, times f.

    Depths are counted from P at the end of the step; `surface` says how deep P was when the front
    was at `upper` and at `lower`.
    """

    upper: float
    lower: float
    jump: float
    surface: tuple[float, float] = (0.0, 0.0)

    def moved(self, depth: float) -> SlippedLayer:
        """The same, counted from a surface that is so much higher."""
        start, end = self.surface
        return SlippedLayer(
            self.upper + depth, self.lower + depth, self.jump, (start + depth, end + depth)
        )


@dataclass(frozen=True)
class SlipEvent:
    """Slip in one direction: its sign, and the layers that it overwrote, from the top down."""

    sign: float
    layers: tuple[SlippedLayer, ...]

    def while_raised(self, thickness: float) -> SlipEvent:
        """The same slip if P rose by this thickness during it, and not before."""
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
        return SlipEvent(self.sign, tuple(found))


class Layer(NamedTuple):
    """A layer: thickness, κ/f, the layer below, and Q and depth of it with all below.

    Memories share the layers below.
    """

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
class LoadMemory:
    """Layers from the top down; below them κ = 0. `size` is all that can be overwritten: f P, or
    infinite.

    >>> LoadMemory(math.inf).sheared(3.0)[0].sheared(-2.0)[0].layers
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
        return f"<load memory of {self.size:g}: {self.layers}>"

    @property
    def total(self) -> float:
        """Q."""
        return self.top.total if self.top else 0.0

    @property
    def deepest(self) -> tuple[float, bool]:
        """The largest depth to which κ was overwritten, and whether that was more than once."""
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

    def sheared(self, step: float) -> tuple[LoadMemory, tuple[SlippedLayer, ...]]:
        """(new memory, overwritten layers) after Q changed by `step` at constant P."""
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
                done.append(SlippedLayer(depth, depth + taken, jump))
            if taken < thickness and layer:
                below = _laid(thickness - taken, k, below)
            layer = below
            depth += taken
            left = 0.0 if taken < thickness else max(left - jump * taken, 0.0)
            if left <= NOTHING * abs(step) or (layer is None and depth >= self.size):
                break
        return LoadMemory(self.size, _laid(depth, sign, layer) if depth else layer), tuple(done)

    def raised(self, thickness: float, k: float) -> LoadMemory:
        """The memory after P has risen, with a new layer on top."""
        nothing = k == 0.0 and (self.top is None or (self.top.k == 0.0 and self.top.below is None))
        return LoadMemory(self.size + thickness, None if nothing else _laid(thickness, k, self.top))

    def _thinned(self, thickness: float) -> LoadMemory:
        """P lowered, and Q by what the top carried: it is taken off."""
        layer, left = self.top, thickness
        while layer is not None and left > 0.0:
            t, k, below = layer[:3]
            layer = _laid(t - left, k, below) if t - left > NOTHING * self.size else below
            left -= min(t, left)
        return LoadMemory(self.size - thickness, layer)

    def lowered(self, thickness: float, rate: float) -> tuple[LoadMemory, tuple[SlipEvent, ...]]:
        """(new memory, slip in the order of time) after P fell while Q changed.

        `rate` is the change of Q for each unit of thickness.

        A layer is removed without slip where κ = -rate. Otherwise slip in the direction of
        rate + κ runs down from the edges, faster than the edges retreat. In a deeper layer it may
        be slower: where the edges catch up with it, all slipped zones have left the contact, and
        the same two cases hold for the layer below.
        """
        memory, gone = self, 0.0
        slips: list[SlipEvent] = []
        while thickness - gone > NOTHING * thickness:
            top, k = memory.top[:2] if memory.top else (math.inf, 0.0)
            if abs(rate + k) <= BALANCED * max(abs(rate), abs(k)):
                taken = min(top, thickness - gone)
                memory = memory._thinned(taken)
            else:
                sign = math.copysign(1.0, rate + k)
                memory, taken, done = memory._followed_down(
                    sign, 1.0 + sign * rate, thickness - gone
                )
                if done:
                    slips.append(SlipEvent(sign, tuple(o.moved(gone - thickness) for o in done)))
            gone += taken
        return memory, tuple(slips)

    def _followed_down(
        self, sign: float, pull: float, most: float
    ) -> tuple[LoadMemory, float, list[SlippedLayer]]:
        """Slip that P follows down: `pull` of Q for each unit of thickness taken off, until that is
        `most` or all that slipped has gone.
        """
        layer, depth, taken = self.top, 0.0, 0.0
        done: list[SlippedLayer] = []
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
            done.append(SlippedLayer(depth, depth + way, jump, (taken, taken + time)))
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
            LoadMemory(self.size - taken, _laid(left, sign, layer) if left > 0.0 else layer),
            taken,
            done,
        )
