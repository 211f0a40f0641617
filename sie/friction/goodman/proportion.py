"""The shear of a contact that grows in proportion, where its stick zone recedes at one end.

The half-width is r, the centre m = ν r from the place of first touch, and dP/dr in proportion to
r^s: a tilted wedge has s = 0. All states are alike, and the stick zone is [t1, t2] in t = x/r - ν
under every load, x the distance from first touch. For k < ν the end t1 recedes, and the rates are
those of `receding_flat`, with φ the pressure of the flat and ρ φ f its shear. A place comes into
contact at t = 1 and passes t2, where it sticks, on its way to t1, where it slips to the other side.
As r = x/(t + ν), the shear is an integral over t: with w = (t + ν)^(-1-s) and C = (1 + s) P/r,

    q = -f (p - V),    V = C (t + ν)^s [∫_t^t2 (1 + ρ) φ w dt + 2 ∫_t2^1 φ w dt],

and V = 0 at t1 is the equation for t1, which lies between -ν and -k. Therefore

    V = -C (t + ν)^s ∫_t1^t (1 + ρ) φ w dt,    q = f (p - C (t + ν)^s ∫_t^t2 (1 - ρ) φ w dt).

The first form is exact next to t1, the second one next to t2.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.profiles.slope import Slope

from .growth import ContactTable
from .receding_flat import Distances, RecedingFlat, Zone, ratio

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# Points of a panel of v, d = B sinh² v, and its length: singularities lie 0.34 and more beyond it
POINTS, LONGEST = 24, 0.5
SAME = 1e-10  # of dm/dr and of dP/dr: what they may differ by from those in proportion
NOISE = 256.0 * EPS  # of the half-width: to so much the contacts of the table are known
LOOKS, FAINTEST = 24, 1e-6  # places on a panel, and half-widths that leave no trace
FARTHEST = 30  # ln of the distances of t1 from -ν and -k, over each other, at most
NARROWEST = 1e-7  # of the half-width: nearer to first touch force and slip have too few digits
SETTLED = 1e-14  # the error of that logarithm


class Rule(NamedTuple):
    """Panels of v from 0 on, of one length, and distances B sinh² v at their points."""

    scale: float
    size: float
    distance: Array
    rate: Array

    def antiderivative(self, values: Array) -> Array:
        """The integral from 0 on of a function of the distance: series of each panel, as rows."""
        rows = chebyshev.transform((values * self.rate).reshape(-1, POINTS))
        rows = 0.5 * self.size * chebyshev.antiderivative(rows)
        rows[1:, 0] += np.cumsum(rows.sum(axis=1))[:-1]
        return rows

    def at(self, series: Array, distance: Array) -> Array:
        """An antiderivative at distances."""
        v = np.arcsinh(np.sqrt(np.maximum(distance, 0.0) / self.scale)) / self.size
        k = np.clip(v.astype(np.intp), 0, len(series) - 1)
        values: Array = chebyshev.evaluate(series[k].T, np.clip(2.0 * (v - k) - 1.0, -1.0, 1.0))
        return values

    def integral(self, values: Array) -> float:
        return float(self.antiderivative(values)[-1].sum())


def rule(length: float, beyond: float) -> Rule:
    """A rule for roots of the distance, where the next singularity is so far behind."""
    scale = min(length, beyond)
    depth = math.asinh(math.sqrt(length / scale))
    count = math.ceil(depth / LONGEST)
    size = depth / count
    v = size * (np.arange(count)[:, None] + 0.5 * (1.0 + chebyshev.points(POINTS)))
    v = v.ravel()
    return Rule(scale, size, scale * np.sinh(v) ** 2, scale * np.sinh(2.0 * v))


@dataclass(frozen=True)
class Proportion:
    """Growth in proportion; mirrored where its centre moves to the left.

    flat    the rates
    turn    ν = |dm/dr|, more than k
    power   s
    """

    flat: RecedingFlat
    turn: float
    power: float

    @cached_property
    def advance(self) -> float:
        """t1 + ν: where V is 0 there."""
        from scipy.optimize import brentq  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

        most = self.turn - float(self.flat.natural.k[0])

        def lack(place: float) -> float:
            return self._lack(most / (1.0 + math.exp(-place)))

        # V < 0 next to t = -ν, where w is infinite, and > 0 next to -k, where 1 + ρ > 0
        outwards = 1.0 if lack(0.0) < 0.0 else -1.0
        for number in range(FARTHEST):
            near, far = outwards * number, outwards * (number + 1)
            if lack(far) * outwards >= 0.0:
                break
        else:
            raise self._too_near()
        place = float(brentq(lack, near, far, xtol=SETTLED, rtol=4.0 * EPS))
        advance = most / (1.0 + math.exp(-place))
        if advance < NARROWEST:
            raise self._too_near()
        return advance

    @staticmethod
    def _too_near() -> ContactError:
        return ContactError(
            f"an end of the stick zone is nearer than {NARROWEST:.0e} of the half-width to the "
            "place of first touch, or to where it would be in a contact that does not move aside, "
            "and its shear in Goodman's approximation is not told by doubles; reduce the friction, "
            "or give dundurs = 0 to neglect β"
        )

    @cached_property
    def zone(self) -> Zone:
        return self._zone(self.advance)

    def _zone(self, advance: float) -> Zone:
        return self.flat.zone(1.0 - self.turn + advance)

    def _lack(self, advance: float) -> float:
        """V at t1, over a positive number."""
        zone = self._zone(advance)
        stick = _Stick(zone, advance, self.power)
        slip = float(zone.right_slip[0])
        total = stick.near_first.integral(stick.of_first(lambda rho: 1.0 + rho))
        total += stick.near_second.integral(stick.of_second(lambda rho: 1.0 + rho))
        # On the slip zone, from both of its ends
        ahead = advance + stick.width
        near, far = rule(0.5 * slip, min(ahead, 2.0 - slip)), rule(0.5 * slip, math.inf)
        for one, past in ((near, near.distance), (far, slip - far.distance)):
            right = slip - past if one is near else one.distance
            phi = 1.0 / (math.pi * np.sqrt(right * (2.0 - right)))
            total += 2.0 * one.integral(phi * ((ahead + past) / advance) ** (-1.0 - self.power))
        return total

    @property
    def stick(self) -> tuple[float, float]:
        """t1 + ν and t2 + ν."""
        return self.advance, self.advance + self._stick.width

    @cached_property
    def _stick(self) -> _Stick:
        return _Stick(self.zone, self.advance, self.power)

    @cached_property
    def _series(self) -> tuple[Array, Array]:
        stick = self._stick
        return (
            stick.near_first.antiderivative(stick.of_first(lambda rho: 1.0 + rho)),
            stick.near_second.antiderivative(stick.of_second(lambda rho: 1.0 - rho)),
        )

    def lack(self, first: Array, second: Array) -> tuple[Array, Flags]:
        """What q differs by from a limit at distances from t1 and t2, over f P/r, and from which.

        q = -f p + lack where the flag is true, in the half next to t1, and f p - lack elsewhere.
        """
        stick, left = self._stick, first < second
        of_first = stick.near_first.at(self._series[0], np.minimum(first, 0.5 * stick.width))
        of_second = stick.near_second.at(self._series[1], np.minimum(second, 0.5 * stick.width))
        place = (self.advance + first) / self.advance
        scale = (1.0 + self.power) * place**self.power / self.advance
        values: Array = scale * np.where(left, -of_first, of_second)
        return values, left


class _Stick:
    """Rules for both halves of a stick zone, and what is integrated over them."""

    def __init__(self, zone: Zone, advance: float, power: float) -> None:
        self.zone, self.advance, self.power = zone, advance, power
        e, slip = float(zone.e[0]), float(zone.right_slip[0])
        self.e, self.slip, self.width = e, slip, 2.0 - e - slip
        self.near_first = rule(0.5 * self.width, min(e, advance))
        self.near_second = rule(0.5 * self.width, slip)

    def of_first(self, change: Callable[[Array], Array]) -> Array:
        d = self.near_first.distance
        return self._values(change, d, self.width - d)

    def of_second(self, change: Callable[[Array], Array]) -> Array:
        d = self.near_second.distance
        return self._values(change, self.width - d, d)

    def _values(self, change: Callable[[Array], Array], first: Array, second: Array) -> Array:
        """A function of ρ, times φ w, w being 1 at t1."""
        places = Distances(self.e + first, self.slip + second, first, second)
        phi = 1.0 / (math.pi * np.sqrt(places.left * places.right))
        w = (1.0 + first / self.advance) ** (-1.0 - self.power)
        values: Array = change(ratio(self.zone, places)) * phi * w
        return values


def in_proportion(table: ContactTable) -> tuple[float, float] | None:
    """dm/dr and s where contacts grow in proportion, None where they do not."""
    if table.start or table.corner_load or not table.panels:
        return None
    last = table.panels[-1]
    turn = (table.middle - table.first_centre) / table.end
    half = next(p for p in table.panels if p.hi >= 0.5 * table.end)
    most = float(last.load_rate(np.array([last.length]))[0])
    less = float(half.load_rate(np.array([0.5 * table.end - half.lo]))[0])
    if not (most > 0.0 and less > 0.0):
        return None
    power = math.log2(most / less)
    for panel in table.panels:
        ahead = panel.length * np.arange(1, LOOKS + 1) / LOOKS
        part = (panel.lo + ahead) / table.end
        within = SAME + NOISE / part
        same = np.abs(panel.turn(ahead) - turn) <= within
        same &= np.abs(panel.load_rate(ahead) / most - part**power) <= within * part**power
        if not (same | (part < FAINTEST)).all():
            return None
    return turn, power


def on_straight_pieces(
    table: ContactTable, slope: Slope, sharp: tuple[bool, bool]
) -> tuple[float, float] | None:
    """dm/dr and s = 0 where all of the contact is straight but for a bend at first touch.

    So it is under a tilted wedge, and under a tilted flat of which one edge stays at the corner
    that touched first: dm/dr is then ±1. None elsewhere.
    """
    # A contact that has reached both corners no longer grows
    if table.start or all(sharp) or slope.functions:
        return None
    lo, hi, near = table.middle - table.end, table.middle + table.end, NOISE * table.end
    inner = slope.breaks[(slope.breaks > lo + near) & (slope.breaks < hi - near)]
    first, last = np.searchsorted(slope.breaks, [lo + near, hi - near])
    bent = slope.coefficients[first - 1 : last, 1:].any()
    if bent or (np.abs(inner - table.first_centre) > near).any():
        return None
    turn = (table.middle - table.first_centre) / table.end
    if not table.cornered:
        return (turn, 0.0) if 1.0 - abs(turn) >= NARROWEST else None
    return (math.copysign(1.0, turn), 0.0) if abs(abs(turn) - 1.0) <= NOISE else None
