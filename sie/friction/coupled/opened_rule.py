"""Quadrature for a contact with two stick zones: panels that shrink towards the ends of zones.

Places are counted from the old edge -b, and distances from an end of a zone are exact next to it. A
zone may be 1e-5 of the others, and the strip at x1 1e-9 of what was gained.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

Array = NDArray[np.float64]

NODES, RATIO = 14, 16.0  # of a panel; growth away from an end, in the logarithm of the distance
LOG_LENGTH = 3.0  # of such panels beside the contact: 4.5^-28
STRAIGHT = 1.5  # growth of a panel between two cuts, up to which it is straight
NEARER = 1e-6  # of a zone: cuts that are nearer to its end do not count
APART = 1e-7  # of the distance from the end: cuts that are nearer to others are these
FIRST = 1e-2  # of the shortest length beside the contact: the first panel
FAR, FAR_NODES = 3.0, 20  # of the larger edge: from there on panels are in 1/y
ON_STRIP, STRIP_NODES = 6, 14  # panels of the strip, which shrink towards x1; nodes


class Zone(NamedTuple):
    """Places in a zone by the distances from its ends, with weights."""

    left: Array
    right: Array
    weight: Array

    def places(self, lo: float, hi: float) -> Array:
        """The places between both ends."""
        return np.where(self.left < self.right, lo + self.left, hi - self.right)


def zone_rule(
    length: float,
    shrink: tuple[float, float],
    powers: tuple[float, float],
    cuts: Array,
    nodes: int = NODES,
) -> Zone:
    """A rule on [0, length] for functions with powers of the distance at both ends.

    The first panels are as long as `shrink`; cuts are counted from the left end.
    """
    half = 0.5 * length
    sides = []
    for side, (nearest, power) in enumerate(zip(shrink, powers, strict=True)):
        ends = _panel_ends(half, nearest, cuts if side == 0 else length - cuts)
        sides.append(_on_panels(ends, power, nodes))
    (left, mass), (right, others) = sides
    return Zone(
        np.append(left, length - right[::-1]),
        np.append(length - left, right[::-1]),
        np.append(mass, others[::-1]),
    )


def _panel_ends(half: float, nearest: float, cuts: Array) -> Array:
    """Ends of panels from 0 to half that shrink towards 0, with those cuts that are apart."""
    inner = cuts[(cuts > NEARER * half) & (cuts < half)]
    nearest = min(nearest, half, *inner)
    levels = max(0, math.ceil(math.log(half / nearest) / math.log(RATIO)))
    ends = np.append(0.0, half * RATIO ** -np.arange(levels, -1.0, -1.0))
    merged = np.sort(np.append(ends, inner))
    kept = [0.0]
    for end in merged[1:].tolist():
        if end - kept[-1] > APART * end:
            kept.append(end)
    kept[-1] = half
    return np.array(kept)


def _on_panels(ends: Array, power: float, nodes: int) -> tuple[Array, Array]:
    x, _, w = with_weight(nodes, 0.0, 0.0)
    size = np.diff(ends)[:, None]
    places, weights = ends[:-1, None] + size * x, size * w
    growth = np.log(ends[2:] / ends[1:-1])
    on_logs = np.flatnonzero(growth > math.log(STRAIGHT)) + 1
    log = growth[on_logs - 1, None]
    places[on_logs] = ends[on_logs, None] * np.exp(log * x)
    weights[on_logs] = places[on_logs] * log * w
    x, _, w = with_weight(nodes, 0.0, power)
    places[0], weights[0] = ends[1] * x, ends[1] * w
    return places.ravel(), weights.ravel()


def strip_rule(width: float, power: float) -> Zone:
    """A rule on the strip for functions with the power 2 `power` at x1 and -`power` at its end."""
    ends = np.append(0.0, width * RATIO ** -np.arange(ON_STRIP - 1.0, 0.0, -1.0))
    left, mass = _on_panels(ends, 2.0 * power, NODES)
    x, _, w = with_weight(STRIP_NODES, 0.0, -power)
    length = width - float(ends[-1])
    return Zone(
        np.append(left, width - length * x[::-1]),
        np.append(width - left, length * x[::-1]),
        np.append(mass, length * w[::-1]),
    )


def beside_rule(edges: tuple[float, float], shortest: tuple[float, float], power: float) -> Zone:
    """A rule beside the contact for functions with a power of the distance from both edges.

    `left` holds distances from the left edge, on its left, `right` those from the right one, on its
    right; the weights are in their order. The last FAR_NODES of each are far away, side by side.
    """
    far = FAR * max(abs(edges[0]), abs(edges[1]))
    part, _, w = with_weight(FAR_NODES, 0.0, 0.0)
    distant, mass = far / part, w * far / part**2
    sides, weights = [], []
    for side, nearest in zip((edges[0], -edges[1]), shortest, strict=True):
        first, last = FIRST * nearest, far + side
        x, _, v = with_weight(NODES, 0.0, power)
        y, u = first * x, first * v
        n = math.ceil(math.log(last / first) / LOG_LENGTH)
        x, _, v = with_weight(NODES, 0.0, 0.0)
        log = math.log(last / first) / n
        on_logs = first * np.exp(log * (np.arange(n)[:, None] + x).ravel())
        sides.append(np.concatenate((y, on_logs, distant + side)))
        weights.append(np.concatenate((u, on_logs * log * np.tile(v, n), mass)))
    return Zone(sides[0], sides[1], np.concatenate(weights))
