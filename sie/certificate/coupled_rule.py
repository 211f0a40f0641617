"""The rule on which the certificate of coupled partial slip measures p and q, and integrals by it.

Gauss rules on panels that shrink towards every mark, where a traction is not smooth. Many marks
are kinks of a sampled profile, most of them weak: panels shrink towards these as far as the last
Legendre coefficients of p and q tell. Next to the edge places are known by their distance from it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from sie.friction.coupled.contact import FEW, CoupledContact
from sie.numerics.gauss_jacobi import with_weight

Array = NDArray[np.float64]

NODES = 14
NEAREST = 1e-12  # the first panel next to a mark, in parts of the way to the next mark
IN_STRIP = 1e-4  # and of a strip that is narrower than the flat base
RATIO = 4.0  # growth of the panels away from a mark
EDGE_LEVELS, LAST = 8, 28  # at the edge: panels towards it, and nodes of the last
THIN = 1e-8  # of the contact beyond a flat base: so narrow zones are left out, if no edge is sharp
# Of the largest p times half the way to the next mark: what the last coefficients on a panel at a
# mark carry at most, as no point of the residual is nearer than a fifth of that
RESOLVED = 1e-13


class Values(NamedTuple):
    """Nodes y and b - y, weights, and p and q there; how far before b the LAST of them begin."""

    edge: float
    y: Array
    rest: Array
    weight: Array
    p: Array
    q: Array


def values_on_panels(state: CoupledContact) -> Values:
    """Values on panels between the marks; next to the edge by the distance from it."""
    marks = distinct_marks(state)
    widths = np.diff((0.0, *marks))
    if len(marks) > 1:
        widths[-1] = to_edge(state, marks[-2]) if state.growth else state.flat.rest * state.b
    beyond = np.append(np.cumsum(widths[:0:-1])[::-1], 0.0)
    parts, between = [], []
    nearest = min(NEAREST, 0.1 * state.flat.rest)
    if state.narrow:
        nearest = min(nearest, IN_STRIP * state.ahead / state.b)
    powers = [*(0.0 for _ in marks[1:]), state.edge_power]
    for lo, width, after, power in zip((0.0, *marks), widths, beyond, powers, strict=False):
        if len(marks) > FEW and 0.0 < lo < marks[-2]:
            between.append((lo, width, after))
            continue
        first = min(nearest, NEAREST * lo / float(width)) if lo else nearest
        ahead, behind, weight = _panels(float(width), power, first)
        parts.append((lo + ahead, after + behind, weight))
    y, rest, weight = (np.concatenate(column) for column in zip(*parts, strict=True))
    known = _known(state, y, rest, weight)
    if between:
        known = np.hstack((_resolved(state, np.array(between), float(known[3].max())), known))
    start = 0.5 * float(widths[-1]) * RATIO ** -(EDGE_LEVELS - 1.0)
    return Values(start, *known)


def _known(state: CoupledContact, y: Array, rest: Array, weight: Array) -> Array:
    """Rows of y, b - y, weights, p and q."""
    y = np.minimum(y, state.b)
    return np.vstack((y, rest, weight, state.pressure_and_shear(y, rest)))


def _resolved(state: CoupledContact, between: Array, peak: float) -> Array:
    """Values between many marks, on panels that shrink towards those where p or q needs it.

    Given are the first mark, the distance to the second one and that from there to the edge.
    """
    x, _, w = with_weight(NODES, 0.0, 0.0)
    last = legendre.legvander(2.0 * x - 1.0, NODES - 1)[:, -2:]
    last *= w[:, None] * (2.0 * np.arange(NODES - 2, NODES) + 1.0)
    lo, width, after = between.T
    place, from_edge = np.append(lo, lo + width), np.append(after + width, after)
    way, half = np.repeat((1.0, -1.0), len(lo)), 0.5 * np.append(width, width)
    side = np.arange(len(place))
    start, end = np.zeros(len(side)), half
    kept = []
    while len(side):
        length = end - start
        ahead = way[side, None] * (start[:, None] + length[:, None] * x)
        y, rest = place[side, None] + ahead, from_edge[side, None] - ahead
        known = _known(state, y.ravel(), rest.ravel(), (length[:, None] * w).ravel())
        tail = np.abs(known[3:].reshape(2, -1, NODES) @ last).max(axis=(0, 2))
        again = (start == 0.0) & (end > NEAREST * half[side])
        again &= tail * length > RESOLVED * peak * half[side]
        kept.append(known.reshape(5, -1, NODES)[:, ~again].reshape(5, -1))
        side, cut = np.repeat(side[again], 2), end[again] / RATIO
        start, end = np.ravel([0.0 * cut, cut], "F"), np.ravel([cut, end[again]], "F")
    return np.hstack(kept)


def distinct_marks(state: CoupledContact) -> tuple[float, ...]:
    """The marks of the tractions, without edges of zones of stick or slip that are too narrow."""
    flat = state.flat
    if min(flat.rest, flat.c) * state.b > THIN * state.ahead or not state.growth:
        return state.marks
    places = {y for y in (*state.kinks, state.flat_base) if 0.0 < y < state.b}
    return (*sorted(places), state.b)


def _panels(width: float, power: float, nearest: float) -> tuple[Array, Array, Array]:
    """Distances from both ends and weights, on panels that shrink towards both ends.

    There are LAST nodes at an end with a power.
    """
    half, at_edge = 0.5 * width, power != 0.0
    levels = math.ceil(math.log(1.0 / nearest) / math.log(RATIO))
    near = half * np.append(0.0, RATIO ** -np.arange(levels, -0.5, -1.0))
    x, _, w = with_weight(NODES, 0.0, 0.0)
    length = np.diff(near)[:, None]
    side, weight = (near[:-1, None] + length * x).ravel(), (length * w).ravel()
    other, beside = side, weight
    if at_edge:
        start = half * RATIO ** -(EDGE_LEVELS - 1.0)
        kept = side > start
        x, _, w = with_weight(LAST, 0.0, power)
        other = np.append(side[kept], start * x[::-1])
        beside = np.append(weight[kept], start * w[::-1])
    return (
        np.append(side, width - other),
        np.append(width - side, other),
        np.append(weight, beside),
    )


def to_edge(state: CoupledContact, x: Any) -> Any:
    """b - x, to full relative accuracy beside a flat base."""
    return state.ahead - (x - state.flat_base) if state.growth else state.b - x


def principal_value(
    values: Values, state: CoupledContact, x: Array, at_x: Array, parity: float
) -> Array:
    """1/π PV∫f/(x - t) dt over the whole contact, f = p (parity 1) or q (-1)."""
    f = values.p if parity > 0.0 else values.q
    y, w = values.y, values.weight
    subtracted = np.where(np.arange(len(y)) < len(y) - LAST, at_x[:, None], 0.0)
    edge = to_edge(state, x)
    apart = np.where(values.rest < y, values.rest - edge[:, None], x[:, None] - y)
    apart[apart == 0.0] = np.inf
    own = ((f - subtracted) / apart) @ w
    own += at_x * np.log(x / (edge - values.edge))
    mirrored = (parity * f / (x[:, None] + y)) @ w
    total: Array = (own + mirrored) / math.pi
    return total
