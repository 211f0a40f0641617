"""Loads beyond those under which all sticks that a contact gains as it spreads under Q.

From the load on under which f p - q is 0 at the old edge -b a slip zone is open there, inside the
stick zone (`opened_march`), until what sticks beside x1 is gone. Then the zones are those of
`tangential`, which depend on Q alone, whether or not they are found under smaller loads too.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.root_finding import false_position
from sie.problem.coverage import LargerLoad, refused_opened

from .opened_contact import Opened, OpenedContact
from .opened_gradient import GradientPanel, KeptGradient
from .opened_march import OpenedMarch, OpenedPoint
from .sheared import ShearedContact
from .spreading_contact import (
    GAINED,
    Spread,
    SpreadingContact,
    spreading_march,
    spreading_state,
    sticking_gain,
)
from .spreading_march import SpreadingMarch
from .spreading_zones import Places
from .tangential import TangentialSearch
from .zones import Zones

Array = NDArray[np.float64]

UNSEEN = 1e-9  # of what was gained: wider strips of old slip at the edge are refused
ON_PANEL = 16  # places of a panel at which γ is kept
ASIDE = 1e-4  # of s, for slopes at the opening
REACHED, TRIES = 3e-11, 6  # of Q, how near the march comes; times that its last panel is solved
ALIKE = 3e-9  # of the mean of f p: by how much γ on two panels may differ where they meet
PART = 0.5  # of a panel that is cut
CERTAIN = 1e-6  # of the mean of f p: what γ may err by


def state_below(search: TangentialSearch, Q: float) -> ShearedContact:
    """The state under Q > 0 with β > 0 below the zones that depend on Q alone, or beyond their end.

    Raises ContactError where none is certified.
    """
    march = spreading_march(search)
    try:
        return spreading_state(search, Q, march)
    except LargerLoad as error:
        reason = error
    try:
        return opened_state(search, march, Q)
    # Integrals whose zones are not finite fail in any of these ways
    except (ContactError, ArithmeticError, ValueError, IndexError, np.linalg.LinAlgError) as error:
        covered = isinstance(error, ContactError)
        why = str(error) if covered else "its zones are not found"
    raise refused_opened(search.beta * search.friction, (Q, search.limit), why) from reason


def opened_state(search: TangentialSearch, march: SpreadingMarch, Q: float) -> ShearedContact:
    """The state under Q, larger than the load under which the zone opens."""
    opened = opened_march(search, march)
    panel, points = _advanced(opened)
    while points[-1].Q < Q:
        opened.take(panel, points)
        if opened.closed:
            return ShearedContact(search, search.found(Q, arrived=True), Q, 1.0, 1.0)
        panel, points = _advanced(opened)
    for _ in range(TRIES):
        s = _reached(opened, points, Q)
        panel, points = opened.shortened(panel, points, s)
        if abs(points[-1].Q - Q) < REACHED * Q:
            break
    else:
        raise ContactError("the march does not settle at the load")
    opened.take(panel, points)
    zones, b = opened.zones(points[-1].s, points[-1].logs), search.normal.b
    edges = Zones(*(y - b for y in (zones.x1, zones.h2, zones.e2, zones.x2)))
    return OpenedContact(
        search,
        Opened(edges),  # type: ignore[arg-type]
        Q,
        1.0,
        1.0,
        march=opened,
        point=points[-1],
    )


def _advanced(march: OpenedMarch) -> tuple[GradientPanel, list[OpenedPoint]]:
    """One more panel, on which γ goes on like on the last one."""
    lo, hi = march.s, march.next_end()
    while True:
        try:
            panel, points = march.advanced(hi)
            if march.jump(panel) < ALIKE:
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
    normal, history = search.normal, march.history
    s = _opening(search, march)
    e2, e3 = history.zones(s)
    strip = history.strip_width(s, e2, e3)
    if strip > UNSEEN * s:
        raise ContactError(
            f"a zone of the width {strip:.2g} next to the edge keeps the slip of the normal load, "
            f"beside the {s:.3g} that the contact gained when a slip zone opened at the old edge"
        )
    x1 = -normal.b - s
    zones, Q = Zones(x1, x1, normal.c - e2, normal.b - e3), history.load(s)
    state = SpreadingContact(search, Spread(zones), Q, 1.0, 1.0, march=march, s=s)  # type: ignore[arg-type]
    panels = []
    for panel in history.panels:
        lo, hi = panel.lo, min(panel.hi, s)
        if lo < hi:
            nodes = math.log(lo) + 0.5 * math.log(hi / lo) * (1.0 + chebyshev.points(ON_PANEL))
            values = state.kept_gradient(normal.axis - normal.b - np.exp(nodes))
            panels.append(GradientPanel(lo, hi, nodes, values))
    logs = np.log(np.array([e2, e3]) / s)
    before = s * (1.0 - ASIDE)
    slopes = (logs - np.log(np.array(history.zones(before)) / before)) / math.log(s / before)
    return OpenedMarch(KeptGradient(search, tuple(panels)), OpenedPoint(s, logs, Q), slopes)


def _opening(search: TangentialSearch, march: SpreadingMarch) -> float:
    """s where f p - q is 0 at the old edge."""
    normal, history = search.normal, march.history
    b, c = normal.b, history.c

    def deficit(s: float) -> float:
        from_b, to_c, to_b, at = np.array([[0.0], [b + c], [2.0 * b], [s]])
        return float(history.inside(Places(from_b, to_c, to_b, at))[1, 0])

    if not history.panels or deficit(history.panels[-1].hi) > 0.0:
        try:
            march.marched(GAINED * sticking_gain(search, march) / march.expected(1.0))
        except LargerLoad:
            pass
        else:
            raise ContactError("no slip zone opens where it is expected")
    last = history.panels[-1]
    ends = deficit(last.lo), deficit(last.hi)
    return false_position(deficit, last.lo, last.hi, ends, lambda a, b, _: b - a < 1e-14 * a)
