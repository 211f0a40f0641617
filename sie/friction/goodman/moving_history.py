"""The shear from a history in which the stick zone recedes at one end at a time.

The normal load grows in stages. In a stage the stick zone [u, a] advances at both ends, or recedes
at one of them and advances at the other one, and the rates are those of `receding_flat`. What is
right of the stick zone has slipped to the right last, with q = f p. So for a place that stuck with
σ = ±1 before

    q = σ f (p - V),      V = ∫ (1 - σ ρ) φ dP/r over stick + 2 ∫ φ dP/r over slip towards -σ,

the integrals over its history, φ and ρ f φ the pressure and the shear of the flat. V has no
difference of large numbers, and is 0 at an end that recedes. A stage whose stick zone recedes at
the right is mirrored.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.coupled.panels import totals
from sie.friction.coupled.tables import summed
from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import EPS

from .growth import Panel
from .receding_flat import Distances, RecedingFlat, Zone, ratio

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

NODES, LONGEST = 16, 2.0  # of a panel of v, r = r0 ± B sinh² v, and its length
NEAREST = 1e-14  # of the half-width, to a singularity: so far distances are known
SPEED = 2.0  # of an end, at most about, as a multiple of that of r
STEPS = 60  # of the search for the contact in which an end passes a place
LEAST = 1e-300  # of the square of a distance
SAME = 8.0 * EPS  # of the half-width: ends of a search that are one


@dataclass(frozen=True, eq=False)
class Stage:
    """A part of the growth, in mirrored coordinates where side is -1.

    flat        the rates
    panel       the panel of half-widths that it is a part of
    centre      centre of the contact at the panel's beginning, from that under the load
    lo, hi      half-widths at its ends
    side        -1 where it is mirrored
    series      1 + t1 as a series; () where the stick zone advances at both ends
    span        half-width up to which the series goes
    plain       whether it is a series in the half-width itself
    """

    flat: RecedingFlat
    panel: Panel
    centre: float
    lo: float
    hi: float
    side: float = 1.0
    series: Array = field(default_factory=lambda: np.zeros(0))
    span: float = math.inf
    plain: bool = False

    @property
    def recedes(self) -> bool:
        return bool(self.series.size)

    def middle(self, r: Array) -> Array:
        """The centre of the contact, in the stage's coordinates."""
        centre: Array = self.centre + self.panel.moved(np.zeros(1), r - self.panel.lo)
        return self.side * centre

    def place(self, r: Array) -> Array:
        """The series' variable, in which roots of distances from both ends are smooth."""
        part = np.clip((r - self.lo) / (self.span - self.lo), 0.0, 1.0)
        if self.plain:
            return 2.0 * part - 1.0
        place: Array = 4.0 / math.pi * np.arcsin(np.sqrt(part)) - 1.0
        return place

    def zone(self, r: Array) -> Zone:
        if not self.recedes:
            return self.flat.natural
        return self.flat.zone(summed(self.series, self.place(r)))

    def first_end(self, r: Array) -> Array:
        """u."""
        e = summed(self.series, self.place(r)) if self.recedes else self.flat.natural.e
        u: Array = self.middle(r) - r + r * e
        return u

    def second_end(self, r: Array) -> Array:
        """a."""
        a: Array = self.middle(r) + r - r * self.zone(r).right_slip
        return a

    def ends(self) -> Array:
        """Contact and stick zone at both ends of the stage: left, right, u and a as rows."""
        r = np.array([self.lo, self.hi])
        m = self.middle(r)
        return np.stack((m - r, m + r, self.first_end(r), self.second_end(r)))

    def since(self, r: Array, until: Array) -> Array:
        """u(until) - u(r), to relative accuracy where the stick zone recedes."""
        by = until - r
        moved = self.side * self.panel.moved(r - self.panel.lo, by)
        later, place = self.place(until), self.place(r)
        if self.plain:
            rise = chebyshev.quotient(self.series, place, later) * 2.0 * by / (self.span - self.lo)
            return moved - by * (1.0 - summed(self.series, later)) + r * rise
        # sin² A - sin² B = sin(A + B) sin(A - B)
        both = np.sin(0.25 * math.pi * (later + place + 2.0))
        apart = np.arcsin(np.clip(by / ((self.span - self.lo) * both), 0.0, 1.0))
        rise = chebyshev.quotient(self.series, place, later) * apart * (4.0 / math.pi)
        value: Array = moved - by * (1.0 - summed(self.series, later)) + r * rise
        return value


class Reach(NamedTuple):
    """Half-widths between which places stick, and those at which the contrary slip begins and ends.

    Empty where the first is not below the second.
    """

    stick: tuple[Array, Array]
    slip: tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class MovingHistory:
    """The stages of a growth, ascending."""

    stages: tuple[Stage, ...]

    def lack(self, y: Array, side: float, end: Array | None = None) -> Array:
        """V for slip σ = `side`, at places y; up to the half-widths `end`, where u passes them."""
        total = np.zeros(len(y))
        for stage in self.stages:
            at = np.arange(len(y)) if end is None else np.flatnonzero(end > stage.lo)
            if not at.size:
                continue
            until = np.full(len(at), stage.hi) if end is None else np.minimum(end[at], stage.hi)
            passed = np.zeros(len(at), dtype=np.bool_) if end is None else end[at] <= stage.hi
            passed &= stage is self.stages[-1]
            total[at] += _stage_lack(stage, stage.side * y[at], stage.side * side, until, passed)
        return total

    @cached_property
    def final(self) -> tuple[float, float]:
        """The stick zone in the end."""
        return self.stick(self.stages[-1], self.stages[-1].hi)

    @staticmethod
    def stick(stage: Stage, half_width: float) -> tuple[float, float]:
        """The stick zone of a contact of a stage."""
        r = np.array([half_width])
        u, a = float(stage.first_end(r)[0]), float(stage.second_end(r)[0])
        return (u, a) if stage.side > 0.0 else (-a, -u)


def _stage_lack(stage: Stage, y: Array, side: float, until: Array, passed: Flags) -> Array:
    """V of one stage, y and side mirrored with it."""
    total = np.zeros(len(y))
    left, right = stage.ends()[:2, 1]
    held = np.flatnonzero((y > left) & (y < right))
    if held.size < len(y):
        if held.size:
            total[held] = _stage_lack(stage, y[held], side, until[held], passed[held])
        return total
    reach = _reach(stage, y, side, until, passed)

    def in_stick(r: Array, places: Distances) -> Array:
        rho = ratio(stage.zone(r), r, places)
        values: Array = (1.0 - side * rho) * _pressure(places)
        return values

    def in_slip(_: Array, places: Distances) -> Array:
        return 2.0 * _pressure(places)

    stick = _integral(stage, y, reach.stick, in_stick, passed & (reach.stick[1] == until))
    return stick + _integral(stage, y, reach.slip, in_slip, passed & (reach.slip[1] == until))


def _reach(stage: Stage, y: Array, side: float, until: Array, passed: Flags) -> Reach:
    """Where in the stage places stick, and where they slip towards -side."""
    lo = np.full(len(y), stage.lo)

    def crossing(curve: Callable[[Array], Array], rising: bool) -> Array:
        return _crossing(curve, y if rising else -y, lo, until, rising)

    right = crossing(lambda r: stage.middle(r) + r, True)
    ahead = crossing(stage.second_end, True)
    if stage.recedes:
        behind = np.where(passed, until, crossing(stage.first_end, True))
        stick = ahead, behind
        left = crossing(lambda r: stage.middle(r) - r, False)
        contrary = (right, ahead) if side < 0.0 else (np.maximum(left, behind), until)
    else:
        behind = crossing(stage.first_end, False)
        stick = np.maximum(ahead, behind), until
        left = crossing(lambda r: stage.middle(r) - r, False)
        contrary = (right, ahead) if side < 0.0 else (left, behind)
    return Reach(stick, contrary)


def _crossing(
    curve: Callable[[Array], Array], y: Array, lo: Array, hi: Array, rising: bool
) -> Array:
    """r in [lo, hi] at which a curve reaches the places y: its ends where it does so not between.

    lo where it was there before, hi where it comes later. A falling curve is turned, y with it.
    """
    turn = 1.0 if rising else -1.0
    at_lo, at_hi = turn * curve(lo) - y, turn * curve(hi) - y
    out = np.where(at_lo >= 0.0, lo, hi)
    inside = np.flatnonzero((at_lo < 0.0) & (at_hi > 0.0))
    if not inside.size:
        return out
    a, b, fa, fb, y = lo[inside], hi[inside], at_lo[inside], at_hi[inside], y[inside]
    r = b
    for _ in range(STEPS):
        # Ridders' method
        middle = 0.5 * (a + b)
        f = turn * curve(middle) - y
        root = np.sqrt(np.maximum(f * f - fa * fb, LEAST))
        before, r = r, np.clip(middle - (middle - a) * f / root, a, b)
        g = turn * curve(r) - y
        for at, value in ((middle, f), (r, g)):
            low, high = (value < 0.0) & (at > a), (value >= 0.0) & (at < b)
            a, fa = np.where(low, at, a), np.where(low, value, fa)
            b, fb = np.where(high, at, b), np.where(high, value, fb)
        if ((np.abs(r - before) <= SAME * r) | (b - a <= SAME * b) | (g == 0.0)).all():
            break
    out[inside] = r
    return out


def _distances(stage: Stage, y: Array, r: Array, u: Array | None = None) -> Distances:
    """Of places y in contacts r; u is their distance from the first end, where it is known."""
    m = stage.middle(r)
    zone = stage.zone(r)
    left, right = y - (m - r), m + r - y
    first = left - r * zone.e if u is None else u
    return Distances(left, right, first, right - r * zone.right_slip)


def _pressure(places: Distances) -> Array:
    p: Array = 1.0 / (math.pi * np.sqrt(places.left * places.right))
    return p


def _integral(
    stage: Stage,
    y: Array,
    ends: tuple[Array, Array],
    integrand: Callable[[Array, Distances], Array],
    singular: Flags,
) -> Array:
    """∫ integrand dP between half-widths, graded towards the singularities beyond both of them.

    singular where u is at the place in the end.
    """
    total = np.zeros(len(y))
    own = np.flatnonzero(ends[1] - ends[0] > SAME * stage.hi)
    if not own.size:
        return total
    lo, hi, x = ends[0][own], ends[1][own], y[own]
    half = 0.5 * (hi - lo)
    since = lo - stage.panel.begin
    behind = np.minimum(_room(stage, x, lo), np.where(since > 0.0, since, np.inf))
    ahead = _room(stage, x, hi)
    singular = singular[own]
    ahead[singular] = np.inf
    for start, length, free in ((lo, half, behind), (hi, -half, ahead)):
        room = np.clip(free, NEAREST * stage.hi, np.abs(half))
        depth = np.arcsinh(np.sqrt(half / room))
        count = np.ceil(depth / LONGEST).astype(np.intp)
        row = np.repeat(np.arange(len(own)), count)
        number = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
        nodes, _, w = gauss_jacobi(NODES, 0.0, 0.0)
        size = (depth / count)[row][:, None]
        v = size * (number[:, None] + nodes)
        scale = room[row][:, None]
        r = start[row][:, None] + np.copysign(scale * np.sinh(v) ** 2, length[row][:, None])
        mass = scale * np.sinh(2.0 * v) * size * w
        flat_r, flat_x = r.ravel(), np.repeat(x[row], NODES)
        places = _distances(stage, flat_x, flat_r)
        if singular.any():
            here = np.repeat(singular[row], NODES)
            target = np.repeat(hi[row], NODES)[here]
            first = places.first.copy()
            first[here] = np.abs(stage.since(flat_r[here], target))
            places = places._replace(first=first)
        places = Distances(*(np.maximum(d, NEAREST**2 * stage.hi) for d in places))
        values = integrand(flat_r, places) * stage.panel.load_rate(flat_r - stage.panel.lo)
        total[own] += totals(row, values.reshape(r.shape) * mass, len(own))
    return total


def _room(stage: Stage, y: Array, r: Array) -> Array:
    """How far r may go until an end reaches y, but for those that are there."""
    away = np.abs(np.stack(_distances(stage, y, r)))
    away[away <= 64.0 * EPS * stage.hi] = np.inf
    room: Array = away.min(axis=0) / SPEED
    return room
