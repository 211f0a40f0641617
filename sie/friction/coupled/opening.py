"""Loads beyond those under which all sticks that a contact gains as it spreads under Q.

From the load on under which f p - q is 0 at the old edge -b a slip zone is open there, inside the
stick zone (`opened_march`), until what sticks beside x1 is gone. Then the zones are those of
`tangential`, which depend on Q alone, whether or not they are found under smaller loads too.
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import edge_integrals
from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.numerics.root_finding import false_position
from sie.problem.coverage import LargerLoad
from sie.traction.on_panels import SlidingDensity
from sie.traction.panels import Panels
from sie.traction.piece_quadrature import SlidingGeometry

from .gradient import SlipGradient
from .opened_gradient import GradientPanel, KeptGradient
from .opened_march import OpenedMarch, OpenedPoint
from .spreading_march import SpreadingMarch
from .spreading_zones import Places
from .tangential import TangentialSearch

Array = NDArray[np.float64]

FAR = 40.0  # times the length on which what is touched sticks: a zone has opened before
# Of what was gained: wider strips of old slip at the edge are refused; narrower ones are left out,
# which changes the state by about as much
UNSEEN = 1e-7
ON_PANEL = 16  # places of a panel at which γ is kept
ASIDE = 1e-4  # of s, for slopes at the opening
REACHED, TRIES = 3e-11, 6  # of Q, how near the march comes; times that its last panel is solved
# Of the mean of f p: by how much γ on two panels may differ where they meet; what it does to the
# state falls with what sticks beside the edge, and its rounding grows
ALIKE, FADING = 3e-9, -0.5
PART = 0.5  # of a panel that is cut


def marched(search: TangentialSearch, march: SpreadingMarch, Q: float) -> OpenedMarch:
    """The march to the load Q, larger than that under which the zone opens, or until it ended."""
    opened = opened_march(search, march)
    if opened.start.Q >= Q:
        raise ContactError(f"it opens above the load, under |Q| = {opened.start.Q:.6g}")
    panel, points = _advanced(opened)
    while points[-1].Q < Q:
        opened.take(panel, points)
        if opened.closed or opened.ends_before(Q):
            opened.ended = True
            return opened
        panel, points = _advanced(opened)
    # Next to the opening the points of a longer panel tell little of the zone
    panel, points = opened.advanced(_reached(opened, points, Q))
    for _ in range(TRIES):
        panel, points = opened.shortened(panel, points, _reached(opened, points, Q))
        if abs(points[-1].Q - Q) < REACHED * Q:
            opened.take(panel, points)
            return opened
    raise ContactError("the march does not settle at the load")


def _advanced(march: OpenedMarch) -> tuple[GradientPanel, list[OpenedPoint]]:
    """One more panel, on which γ goes on like on the last one."""
    lo, hi = march.s, march.next_end()
    while True:
        try:
            panel, points = march.advanced(hi)
            if march.jump(panel) < ALIKE * march.stuck**FADING:
                return panel, points
            why = "γ is not resolved"
        except ContactError as error:
            why = str(error)
        if hi - lo < ASIDE * lo:
            raise ContactError(why)
        hi = lo + PART * (hi - lo)


def _reached(march: OpenedMarch, points: list[OpenedPoint], Q: float) -> float:
    """s under Q, by a polynomial through the loads of the points."""
    at, loads = np.array([p.s for p in points]), np.array([p.Q for p in points])
    before = march.last
    at, loads = np.append(before.s, at), np.append(before.Q, loads)
    slope = float(np.diff(loads[-2:])[0] / np.diff(at[-2:])[0])
    if abs(loads[-1] - Q) < 1e-6 * Q:
        return float(at[-1] + (Q - loads[-1]) / slope)
    y = (at - at[0]) / (at[-1] - at[0])
    c = np.polynomial.polynomial.polyfit(y, loads, len(y) - 1)

    def missed(part: float) -> float:
        return float(np.polynomial.polynomial.polyval(part, c)) - Q

    ends = missed(0.0), missed(1.0)
    part = false_position(missed, 0.0, 1.0, ends, lambda a, b, _: b - a < 1e-15)
    return float(at[0] + part * (at[-1] - at[0]))


# -- the opening -----------------------------------------------------------------------------------


def opened_march(search: TangentialSearch, march: SpreadingMarch) -> OpenedMarch:
    """The march from where the zone opens on; ContactError where it is not reached."""
    history = march.history
    s = _opening(search, march)
    e2, e3 = history.zones(s)
    strip = history.strip_width(s, e2, e3)
    if strip > UNSEEN * s:
        raise ContactError(
            f"a zone of the width {strip:.2g} next to the edge keeps the slip of the normal load, "
            f"beside the {s:.3g} that the contact gained when a slip zone opened at the old edge"
        )
    panels = []
    for panel in history.panels:
        lo, hi = panel.lo, min(panel.hi, s)
        if lo < hi:
            nodes = math.log(lo) + 0.5 * math.log(hi / lo) * (1.0 + chebyshev.points(ON_PANEL))
            panels.append(GradientPanel(lo, hi, nodes, _touched(march, np.exp(nodes), s)))
    logs = np.log(np.array([e2, e3]) / s)
    before = s * (1.0 - ASIDE)
    slopes = (logs - np.log(np.array(history.zones(before)) / before)) / math.log(s / before)
    start = OpenedPoint(s, logs, history.load(s))
    kept = KeptGradient(search, tuple(panels))
    opened = OpenedMarch(kept, start, slopes, partial(bounded_sliding, search))
    opened.unseen = strip / s
    return opened


def _touched(march: SpreadingMarch, s: Array, now: float) -> Array:
    """γ with which places stick that were touched at s, when the edge has advanced by `now`."""
    normal, history = march.normal, march.history
    b, c, y = normal.b, history.c, normal.b + s
    zones = np.array([history.zones(one) for one in s.tolist()])
    places = Places(-s, c + y, b + y, np.full(len(s), now))
    before = SlipGradient(normal.superposition, normal.ahead).beside(y, normal.hilbert_outside(y))
    added = history.beside(history.at("x1", s, zones[:, 0], zones[:, 1])).imag
    values: Array = before + added + history.inside(places)[2]
    return values


def _opening(search: TangentialSearch, march: SpreadingMarch) -> float:
    """s where f p - q is 0 at the old edge."""
    normal, history = search.normal, march.history
    b, c = normal.b, history.c

    def deficit(s: float) -> float:
        from_b, to_c, to_b, at = np.array([[0.0], [b + c], [2.0 * b], [s]])
        return float(history.inside(Places(from_b, to_c, to_b, at))[1, 0])

    if not history.panels or deficit(history.panels[-1].hi) > 0.0:
        try:
            far = FAR * b * march.beginning.rates.sticking / march.expected(1.0)
            _ = march.onward(far) if history.panels else march.marched(far)
        except LargerLoad:
            pass
        else:
            raise ContactError("no slip zone opens where it is expected")
    last = history.panels[-1]
    ends = deficit(last.lo), deficit(last.hi)
    return false_position(deficit, last.lo, last.hi, ends, lambda a, b, _: b - a < 1e-14 * a)


# -- full sliding ----------------------------------------------------------------------------------


class BoundedSliding(NamedTuple):
    """p of full sliding that is finite at the left edge: its regular part, and the rest."""

    density: SlidingDensity
    k2: float
    resultant: float

    def regular(self, x: Array) -> Array:
        """p without its infinite end."""
        values: Array = self.density(x)
        return values


def bounded_sliding(search: TangentialSearch, contact: Interval) -> BoundedSliding:
    """p of full sliding that is finite at the left edge, infinite at the right one."""
    slope, epsilon, half = search.resolved_slope, -search.theta, search.normal.half_modulus
    I = edge_integrals(slope, contact, None, False, epsilon)
    cos, r = math.cos(math.pi * epsilon), contact.r
    difference = 2.0 * half * cos * cos * I.I0 / math.pi
    # k1 = 0, k2 = -difference
    load = half * cos * r * (I.I1 + 2.0 * epsilon * I.I0)
    load -= 0.5 * math.pi * r / cos * (1.0 + 2.0 * epsilon) * difference
    panels = Panels(SlidingGeometry(slope, contact, epsilon), I.I0)
    regular = SlidingDensity(contact, half, 0.0, 0.0, load, 0.0, panels)
    return BoundedSliding(regular, -difference, load)
