"""Load-history memory at constant P and tilt: in which direction each layer was last sheared.

A contact carries S = Q + i π r₀ τ, r₀ a length of the path, and S changes in one proportion. The
shear that slip leaves is then made of first loadings, equation (12) being linear: with q[d] that to
S = d,

    q = Σ κ_k (q[d_k] - q[d_k-1]),     S = Σ κ_k (d_k - d_k-1),     κ = ±1,

the layers k from the top down, between the depths d_k-1 and d_k. Slip of the sign s overwrites κ by
s from the top down; a change dS runs through layers of the jump 1 - s κ by the depth dS/(1 - s κ).
This is Masing's rule, in which a larger change erases the smaller turning points (Mindlin &
Deresiewicz 1953; docs/derivations/layered-memory.md).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from sie.numerics.interval import EPS

# A layer below this fraction of all that slipped is the rounding of one that was overwritten.
NOTHING = 8.0 * EPS
# of a step: what it may be off the direction of another one that is in proportion to it
PROPORTIONAL = 1e-12


class SlippedLayer(NamedTuple):
    """A layer between two depths that slipped in a step; κ jumped there by `jump` > 0."""

    upper: complex
    lower: complex
    jump: float


def simple(change: complex) -> complex:
    """The same, as a float where the imaginary part is 0."""
    return change if change.imag else change.real


def in_proportion(one: complex, other: complex) -> bool:
    """Whether two changes have one direction, or opposite ones."""
    ratio = one / other if other else complex(one)
    return abs(ratio.imag) <= PROPORTIONAL * abs(ratio)


@dataclass(frozen=True)
class LoadMemory:
    """The layers (thickness, κ) of a contact from the top down; below them κ = 0.

    >>> LoadMemory().changed(3.0, 1.0)[0].changed(2.0, -1.0)[0].layers
    ((1.0, -1.0), (2.0, 1.0))
    """

    layers: tuple[tuple[complex, float], ...] = ()

    @property
    def total(self) -> complex:
        """S."""
        return sum((thickness * k for thickness, k in reversed(self.layers)), 0.0)

    @property
    def depth(self) -> complex:
        """That of all layers."""
        return sum((thickness for thickness, _ in reversed(self.layers)), 0.0)

    @property
    def corners(self) -> tuple[tuple[complex, float], ...]:
        """(depth, κ above - κ below) wherever κ jumps, from the top down."""
        found: list[tuple[complex, float]] = []
        depth: complex = 0.0
        for (thickness, k), (_, after) in pairwise((*self.layers, (0.0, 0.0))):
            depth += thickness
            found.append((depth, k - after))
        return tuple(found)

    def changed(self, pull: complex, sign: float) -> tuple[LoadMemory, tuple[SlippedLayer, ...]]:
        """(new memory, the layers overwritten) after S has changed by sign × pull."""
        below, left = list(reversed(self.layers)), pull
        depth: complex = 0.0
        done: list[SlippedLayer] = []
        while abs(left) > NOTHING * abs(pull):
            thickness, k = below[-1] if below else (math.inf, 0.0)
            if k == sign:
                depth += thickness
                below.pop()
                continue
            jump = 1.0 - sign * k
            taken = left / jump
            passes = bool(below) and _passed(thickness, depth, taken)
            if passes:
                taken = thickness
                below.pop()
            elif below:
                below[-1] = thickness - taken, k
            left = left - jump * taken if passes else 0.0
            done.append(SlippedLayer(depth, depth + taken, jump))
            depth += taken
        if below and below[-1][1] == sign:
            depth += below.pop()[0]
        return LoadMemory(((depth, sign), *reversed(below))), tuple(done)


def _passed(thickness: complex, depth: complex, taken: complex) -> bool:
    """Whether a front reaches the corner below a layer."""
    towards = thickness.conjugate() / abs(thickness)  # a ratio to a tiny thickness would overflow
    ahead = abs(thickness) - (taken * towards).real
    return ahead <= NOTHING * abs(depth + taken)
