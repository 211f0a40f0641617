"""Growth of a contact under its load, and the energy that slip in its layers dissipates.

Let [m - r, m + r] be the contact of a profile at one tilt under the load y. A layer dy of the
pressure is dy/(π sqrt(r² - (x - m)²)), and where κ jumps there by j (`memory`) the slip beside the
contact grows by 2 f j dy/(π E*) arccosh(|x - m|/r). That function is the Green's function of what
lies beside an interval: integrated over the layer of a larger contact of half-width R, in which the
interval lies anywhere, it gives ln(R/r) (Ransford 1995, Potential Theory in the Complex Plane, §
5.1). Hence a front of slip that runs down from the level Y to the level L, while the load is P(y)
when it passes y, dissipates

    W = 2 f² j/(π E*) ∫_L^Y dy ∫_y^P(y) (P(y) - η) d ln r(η)  =  2 f² j/(π E*) ∫ v(η) d ln r(η)

for every profile, symmetric or not: only its half-width counts. With P linear in y, v is a
quadratic polynomial between the levels L, Y, P(L) and P(Y), and not negative: nothing cancels. At
constant P, from Y = P down, v = (P - η)(η - L).

d ln r/d ln y is a series on panels (`growth_panels`). A wide front that crosses the many breaks of
a trace costs too many of them. There v is integrated by parts, which leaves S = ∫ln r dy and T =
∫S dy at the four levels, and these are known from the contact under one load
(`Dissipation._potentials`).
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Collection, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.contact.convexity import rises
from sie.contact.edges import Found
from sie.contact.known_contact import Normal
from sie.contact.pressure import pressure
from sie.errors import LoadError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.problem.scene import Scene
from sie.traction.piece_quadrature import Geometry

from .contact_growth import ContactGrowth
from .growth_panels import FEW, LOWEST, GrowthPanels
from .memory import SlippedLayer
from .slip_state import Slip, Slipping

Array = NDArray[np.float64]

MANY = 24  # a profile of so many breaks is a trace
SAME = 16.0 * EPS  # loads that differ by more than rounding
WIDE = 0.03  # of the load: in a thinner front its potentials would cancel
HEIGHTS = 16  # nodes in the angle for the mean of a height over each piece
THIN = 8.0 * EPS  # of the load: panels reach at least so far below it, however thin a front is
NODES = 16  # on each part of a panel
ROWS = 20_000  # parts of panels at a time


def dissipated(state: Slip) -> float:
    """The energy that a first loading dissipated, ∫|q| |slip| dx at constant P."""
    if not isinstance(state, Slipping):
        return state.energy
    step = state.step
    one_patch = step.scene.profile.convex or rises(step.slope, step.pressure.interval)
    if step.tau or not one_patch:
        return state.integrals.work  # a smaller load need not touch in one patch
    heat = Dissipation(step.scene, step.normal, step.tol, step.economy)
    fronts = [SlippedLayer(0.0, abs(step.Q), 1.0)]
    return float(heat.of_fronts([step.normal_load], fronts, state.friction)[0])


class Dissipation:
    """The energy dissipated by slip fronts in the contacts of a profile at one tilt, ∫v d ln r."""

    def __init__(self, scene: Scene, normal: Normal, tol: float, economy: Collection[str]) -> None:
        self.contacts = ContactGrowth(scene, normal, economy)
        self._scene, self._tol = scene, tol
        self._tilt, self._unit = normal.edges.tilt, normal.edges.contact.r
        self.top = normal.edges.normal_load
        self._of_load: dict[float, tuple[float, float]] = {}
        self._growth = GrowthPanels(self.contacts)

    @property
    def evaluations(self) -> int:
        """The number of evaluations of a contact's edge integrals."""
        return self.contacts.search.evaluations

    # -- energy ------------------------------------------------------------------------------------

    def of_fronts(
        self, loads: Sequence[float], fronts: Sequence[SlippedLayer], friction: float
    ) -> Array:
        """The energy that each front dissipated, for a jump of 1: 2 f²/(π E*) ∫v d ln r.

        Depths are counted in Q from each load down. LoadError where the load is
        nothing next to the largest one.
        """
        rows = [
            (P, *(-d.real / friction for d in (o.lower, o.upper, *o.surface[::-1])))
            for P, o in zip(loads, fronts, strict=True)
        ]
        for P, _, _, *surface in rows:
            if P + max(surface) <= LOWEST * self.top:
                raise LoadError(
                    f"energy is lost under P = {P:.6g}, less than {LOWEST:g} of the path's largest "
                    f"load, {self.top:.6g}: follow the points of small loads as a path of their own"
                )
        apart = [self._crosses_many_breaks(*row) for row in rows]
        rest = iter(
            self._by_panels(
                [row for row, many in zip(rows, apart, strict=True) if not many]
            ).tolist()
        )
        G = self.contacts.search.half_modulus
        found = [
            self._from_potentials(*row) / G if many else next(rest)
            for row, many in zip(rows, apart, strict=True)
        ]
        return friction * friction / math.pi * np.array(found)

    def _by_panels(self, rows: list[tuple[float, ...]]) -> Array:
        """2/E* ∫v d ln r for rows of P and, counted from it, L, Y, P(L), P(Y)."""
        ends: list[tuple[float, float, int]] = []
        spans = [(min(P + L, P * (1.0 - THIN)), P + max(surface)) for P, L, _, *surface in rows]
        for together in _merged(spans):
            self._growth.cover(*together)
        cuts = self._growth.cuts()
        for k, (P, L, Y, at_L, at_Y) in enumerate(rows):
            highest = max(at_L, at_Y)
            marks = {L, highest, *(m for m in (Y, at_L, at_Y) if L < m < highest)}
            marks |= {
                c - P
                for c in cuts[bisect_right(cuts, P + L) : bisect_left(cuts, P + highest)]
                if L < c - P < highest
            }
            ascending = sorted(marks)
            ends += [(a, b, k) for a, b in pairwise(ascending)]
        total = np.zeros(len(rows))
        given = np.array(rows).reshape(-1, 5)
        for start in range(0, len(ends), ROWS):
            lo, hi, owner = (
                np.array(column) for column in zip(*ends[start : start + ROWS], strict=True)
            )
            np.add.at(total, owner, self._integrals(lo, hi, given[owner].T[..., None]))
        return total

    def _integrals(self, lo: Array, hi: Array, given: Array) -> Array:
        """2/E* ∫v d ln r from lo to hi, counted from P."""
        P, L, Y, at_L, at_Y = given
        g, w = chebyshev.gauss_legendre(NODES)
        panels, k = self._growth.panels, self._growth.at(P[:, 0] + 0.5 * (lo + hi))
        # In the root of the distance from a break's level, by ratios alone: a front may be thinner
        # than y is known
        base, kinked = (
            np.array([getattr(p, name) for p in panels])[k] for name in ("lo", "kinked")
        )
        near, far = (np.sqrt(np.maximum(P[:, 0] + end - base, 0.0)) for end in (lo, hi))
        c = np.where(kinked & (far > 0.0), near / np.where(far > 0.0, far, 1.0), 1.0)[:, None]
        share, weight = (
            g * (2.0 * c + (1.0 - c) * g) / (1.0 + c),
            2.0 * w * (c + (1.0 - c) * g) / (1.0 + c),
        )
        y = lo[:, None] + (hi - lo)[:, None] * share
        rise = (at_L - at_Y) / np.where(Y > L, Y - L, np.inf)  # of P for the front's way down
        # The place of the front when P = y
        passed = Y + (at_Y - y) / np.where(rise == 0.0, np.nan, rise)
        upper = np.minimum(np.minimum(y, Y), np.where(rise > 0.0, passed, np.inf))
        lower = np.maximum(L, np.where(rise < 0.0, passed, -np.inf))
        middle = 0.5 * (upper + lower)
        level = np.maximum(P + y, panels[0].lo)
        # v in its two factors: loads of 1e160 have no square
        first = np.maximum(upper - lower, 0.0) / level
        second = (at_Y + rise * (Y - middle) - y) / self.contacts.search.half_modulus
        out: Array = (hi - lo) * (weight * first * second * self._growth.rate(k, level)).sum(axis=1)
        return out

    # -- across many breaks ------------------------------------------------------------------------

    def _crosses_many_breaks(self, P: float, L: float, Y: float, at_L: float, at_Y: float) -> bool:
        """Whether a panel for each break that the front of a trace crosses costs too much.

        Two potentials then cost less, and lose no digits.
        """
        if len(self.contacts.breaks) <= MANY or self.contacts.search.slope.functions:
            return False
        highest, change = max(at_L, at_Y), abs(at_L - at_Y)
        thin = highest - L < WIDE * (P + highest) or 0.0 < change < WIDE * (Y - L)
        return (
            not thin and len(self.contacts.passed(max(P + L, LOWEST * self.top), P + highest)) > FEW
        )

    def _from_potentials(self, P: float, L: float, Y: float, at_L: float, at_Y: float) -> float:
        """∫v d ln r from S = ∫ln r dy and T = ∫S dy at the four levels."""
        (S_L, T_L), (S_Y, T_Y), (S_at_L, T_at_L), (_, T_at_Y) = (
            self._potentials(P + level) for level in (L, Y, at_L, at_Y)
        )
        rise = (at_L - at_Y) / (Y - L)
        of_load = (T_at_L - T_at_Y) / rise if rise else S_at_L * (Y - L)
        return of_load - (2.0 + rise) * (T_Y - T_L) - (at_Y - Y) * S_Y + (at_L - L) * S_L

    def _potentials(self, y: float) -> tuple[float, float]:
        """S = y ln r - π G <h> and T = (y S - π G ∫p h dx)/2.

        <h> is the mean of the height above the lowest point in the angle φ.

        Because δ - h is the potential of p in the contact, and the mean of a potential over a
        contact is its Robin constant.
        """
        if y not in self._of_load:
            self._of_load[y] = self._measured(y) if y > LOWEST * self.top else (0.0, 0.0)
        return self._of_load[y]

    def _measured(self, y: float) -> tuple[float, float]:
        (contact, sharp, _), search, scene = (
            self.contacts.contact(y),
            self.contacts.search,
            self._scene,
        )
        edges = search.finished(Found(contact, sharp), y, self._tilt)
        p = pressure(Normal(edges, search.axis is not None), scene, self._tol)
        geometry = Geometry(search.slope, edges.contact, keep_zero=True)
        offset, angle, weight, _ = geometry.nodes(HEIGHTS)
        x = (geometry.ends[0] + geometry.tails[0])[:, None] + offset
        z = 0.5 * sum(self.contacts.touch)
        h = (scene.profile.height(x) + self._tilt * x) - float(
            scene.profile.height(z) + self._tilt * z
        )
        G, r = search.half_modulus, edges.contact.r
        mean = float((weight * h).sum()) / math.pi
        work = float((weight * h * p(x) * r * np.sin(angle)).sum())
        S = y * math.log(r / self._unit) - math.pi * G * mean
        return S, 0.5 * (y * S - math.pi * G * work)


def _merged(ranges: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The union of ranges, as those that do not meet.

    Small steps of a path ask for short ranges, each of which would be a panel.
    """
    out: list[tuple[float, float]] = []
    for lo, hi in sorted(ranges):
        if out and lo <= out[-1][1] * (1.0 + SAME):
            out[-1] = out[-1][0], max(hi, out[-1][1])
        else:
            out.append((lo, hi))
    return out
