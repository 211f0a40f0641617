"""Integrals over the history of places: what the shear lacks of the limits.

With φ the pressure of the flat and ρ φ f its shear in the rates of each time, ρ = ±1 in slip,

    V = ∫ (1 + ρ) φ dP,    U = ∫ (1 - ρ) φ dP,    q = f (V - p) = f (p - U),

over all loads under which the place was in contact. A place comes into contact as an edge arrives
there, sticks as an end of the stick zone does, and slips again as an end recedes from it. Between
these the integrand is smooth, and has roots of the distances from them. Each part is halved, and
from its ends on y = d, d = B sinh² w makes roots smooth; B is less than the distance of the next
singularity, as the ends of contact and stick zone move by no more than their largest speeds.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.coupled.panels import totals
from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import EPS

from .receding_flat import Distances
from .spells import Spell

Array = NDArray[np.float64]
Whole = NDArray[np.intp]

NODES, LONGEST = 16, 1.0  # of a panel of w, and its length
FAR, FEW = 1.0, 10  # of its length: no singularity so near to a part asks for so many nodes alone
LEAST, MOST = 1e-15, 1e3  # of y, for B
NONE = -1
NOWHERE = 1e-18  # a distance, as good as none
NEWTONS, SETTLED = 60, 4.0 * EPS
LEFT, RIGHT, LOW, HIGH = range(4)  # the edges and the ends of the stick zone, in `Spell.curves`
INWARDS = np.array([1.0, -1.0, 1.0, -1.0])


class Parts(NamedTuple):
    """Parts of a spell, as arrays.

    owner           number of the place
    start, length   in y, backwards where it is negative
    event           which curve is at the place at the start, NONE where none is
    stuck           whether the place sticks
    """

    owner: Whole
    start: Array
    length: Array
    event: Whole
    stuck: NDArray[np.bool_]

    def of(self, which: NDArray[Any]) -> Parts:
        """These of the parts, by flags or numbers."""
        return Parts(*(column[which] for column in self))


class Nodes(NamedTuple):
    """Nodes y of parts, how far they are from their starts, and `Spell.values` there."""

    y: Array
    by: Array
    values: Array


def lack(spells: tuple[Spell, ...], x: Array, sign: float) -> Array:
    """V for sign = 1 and U for sign = -1 at x, counted from the place of first touch."""
    total = np.zeros(x.shape)
    for spell in spells:
        total += lack_in(spell, x, np.ones(x.shape), sign)
    return total


def lack_in(spell: Spell, x: Array, until: Array, sign: float, arriving: int = NONE) -> Array:
    """What one spell adds until y, as many as x; the curve `arriving` is at x then."""
    parts = _parts(spell, x, until, sign, arriving)
    behind = _behind(spell, x, parts)
    few = behind >= FAR * np.abs(parts.length)
    few &= parts.event == NONE
    values = _integral(spell, x, parts.of(few), np.zeros(0), sign)
    return values + _integral(spell, x, parts.of(~few), behind[~few], sign)


def _parts(spell: Spell, x: Array, until: Array, sign: float, arriving: int) -> Parts:
    """Halves of the parts between events in which the integrand is not 0."""
    cuts, events = [np.full(len(x), -1.0)], [np.full(len(x), NONE)]
    ends = spell.ends[1][:, None] if (until == 1.0).all() else spell.values(until, 4)
    for j, curve in enumerate(spell.curves):
        event, place = np.full(len(x), NONE), np.full(len(x), -1.0)
        if j == arriving:
            event[:], place = j, until
        else:
            before, after = spell.ends[0, j] - x, ends[j] - x
            passed = before * after < 0.0
            if passed.any():
                rising = bool(after[passed][0] > 0.0)
                place[passed] = _passing(curve, x[passed], until[passed], rising)
                event[passed] = j
        cuts.append(place)
        events.append(event)
    last = np.full(len(x), NONE) if arriving == NONE else np.full(len(x), arriving)
    cut, event = np.array([*cuts, until]), np.array([*events, last])
    order = np.argsort(cut, axis=0, kind="stable")
    cut, event = np.take_along_axis(cut, order, 0), np.take_along_axis(event, order, 0)
    length = np.diff(cut, axis=0)
    number, owner = np.nonzero(length > LEAST)
    a, b = cut[number, owner], cut[number + 1, owner]
    at_a, at_b = event[number, owner], event[number + 1, owner]
    left, right, low, high = spell.values(0.5 * (a + b), 4)
    at = x[owner]
    stuck = (at > low) & (at < high)
    full = (at >= high) if sign > 0.0 else (at <= low)
    own = (at > left) & (at < right) & (stuck | full)
    half = 0.5 * (b - a)[own]
    return Parts(
        np.tile(owner[own], 2),
        np.append(a[own], b[own]),
        np.append(half, -half),
        np.append(at_a[own], at_b[own]),
        np.tile(stuck[own], 2),
    )


def _passing(curve: Array, x: Array, until: Array, rising: bool) -> Array:
    """y at which a curve that rises or falls passes x."""
    sign = 1.0 if rising else -1.0
    rate: Array = np.polynomial.chebyshev.chebder(curve).astype(float)
    size = float(np.abs(curve).sum())
    lo, hi = np.full(x.shape, -1.0), until.copy()
    y = 0.5 * (lo + hi)
    for _ in range(NEWTONS):
        missed = sign * (chebyshev.evaluate(curve, y) - x)
        lo, hi = np.where(missed < 0.0, y, lo), np.where(missed < 0.0, hi, y)
        speed = sign * chebyshev.evaluate(rate, y)
        with np.errstate(divide="ignore", invalid="ignore"):
            moved = y - missed / speed
        moved = np.where((moved >= lo) & (moved <= hi), moved, 0.5 * (lo + hi))
        # Rounding of the curve moves y by so much
        settled = np.abs(moved - y) * np.abs(speed) <= SETTLED * (np.abs(speed) + size)
        y = moved
        if settled.all():
            break
    return y


def _behind(spell: Spell, x: Array, parts: Parts) -> Array:
    """B for each part: no other singularity lies so near to its start."""
    places = spell.values(parts.start, 4)
    away = np.abs(places - x[parts.owner]) / np.maximum(spell.speeds, 1e-300)[:, None]
    here = np.flatnonzero(parts.event != NONE)
    away[parts.event[here], here] = np.inf
    # Where a course begins or ends the curves have kinks
    for distance in (1.0 + parts.start, 1.0 - parts.start):
        away = np.vstack((away, np.where(distance > 0.0, distance, np.inf)))
    nearest: Array = np.clip(away.min(axis=0), LEAST, MOST)
    return nearest


def _integral(spell: Spell, x: Array, parts: Parts, behind: Array, sign: float) -> Array:
    """∫ (1 ± ρ) φ dP over parts, by few nodes where no B are given."""
    if not len(parts.owner):
        return np.zeros(len(x))
    if len(behind):
        depth = np.arcsinh(np.sqrt(np.abs(parts.length) / behind))
        count = np.ceil(depth / LONGEST).astype(np.intp)
        row = np.repeat(np.arange(len(count)), count)
        number = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
        nodes, _, w = gauss_jacobi(NODES, 0.0, 0.0)
        size = (depth / count)[row][:, None]
        v, scale = size * (number[:, None] + nodes), behind[row][:, None]
        by, mass = scale * np.sinh(v) ** 2, scale * np.sinh(2.0 * v) * size * w
    else:
        nodes, _, w = gauss_jacobi(FEW, 0.0, 0.0)
        row = np.arange(len(parts.owner))
        size = np.abs(parts.length)[:, None]
        by, mass = size * nodes, size * w
    by = np.copysign(by, parts.length[row][:, None])
    parts = parts.of(np.repeat(row, by.shape[1]))
    y = parts.start + by.ravel()
    values = spell.values(y)
    r, rate = values[4:6]
    places = _distances(spell, x[parts.owner], Nodes(y, by.ravel(), values), parts)
    phi = 1.0 / (math.pi * np.sqrt(np.maximum(places.left * places.right, 1e-300)))
    change, stuck = np.full(len(y), 2.0), parts.stuck
    at = Distances(*(c[stuck] for c in places))
    change[stuck] = 1.0 + sign * spell.shear(values[:, stuck], at)
    rate = change * phi * rate / r
    values = totals(row, rate.reshape(by.shape) * mass, len(behind) or by.shape[0])
    owner = parts.owner.reshape(by.shape)[:, 0]
    first = np.unique(row, return_index=True)[1]
    return np.bincount(owner[first], values, minlength=len(x)).astype(float)


def _distances(spell: Spell, x: Array, nodes: Nodes, parts: Parts) -> Distances:
    """Distances of places from the edges and from the ends of the stick zone, over r."""
    columns = []
    for j, curve in enumerate(spell.curves):
        distance = INWARDS[j] * (x - nodes.values[j])
        own = parts.event == j
        if own.any():
            rate = chebyshev.quotient(curve, parts.start[own], nodes.y[own])
            distance[own] = -INWARDS[j] * rate * nodes.by[own]
        columns.append(np.maximum(distance, NOWHERE) / nodes.values[4])
    return Distances(*columns)
