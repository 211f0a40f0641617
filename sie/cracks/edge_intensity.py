"""The edge of a contact in two numbers, as models of dovetails reduce it.

With s the distance from the edge into the contact

    p ~ K_N sqrt(s)      at a smooth edge,      K_N/sqrt(s)   at a sharp one
    q ~ K_T/sqrt(s)      if all of the contact sticks:  q = [Q/π ± τ (s - r)]/sqrt(s (2r - s))

A smooth edge cannot hold q: next to it q = f K_N (sqrt(s) - sqrt(s - d)), and the slip zone of this
asymptote is d = 2 |K_T|/(f K_N). A sharp edge sticks while |K_T| < f K_N.

Hills, Dini & Sackfield: e.g. Andresen, Hills & Vázquez, J. Strain Anal. 57 (2022),
10.1177/03093247221089548; arXiv 2103.15647.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval
from sie.traction.base import Density

Array = NDArray[np.float64]

# Distances at which p is extrapolated to the edge, of that from the edge to the next break; an
# error of their cube is left.
NEAR = 1e-5 * np.array([1.0, 2.0, 4.0])
LEAST = 64.0  # the same in spacings of doubles
PARTS = (0.01, 0.1)  # errors of the asymptote whose distances are given
SCANNED = 2000


@dataclass(frozen=True)
class EdgeIntensity:
    """What the stress next to an edge of contact depends on.

    Parameters
    ----------
    normal : float
        K_N: stress over root of length at a smooth edge, times it at a sharp one.
    tangential : float
        K_T of the same loads in full stick, stress times root of length, positive as q is.
    slip_length : float
        Width d of the slip zone of the asymptote, length; at a sharp edge 0 if it sticks, otherwise
        inf.
    reach : (float, float)
        Distances from the edge up to which both asymptotes hold to 1 and to 10 %.
    sharp : bool
        Whether the edge is a corner of the indenter.

    Notes
    -----
    Under loads that change at constant P, K_T of the change is the difference of two of these.

    References
    ----------
    Andresen, Hills & Vázquez, J. Strain Anal. Eng. Des. 57 (2022), 10.1177/03093247221089548.
    """

    normal: float
    tangential: float
    slip_length: float
    reach: tuple[float, float]
    sharp: bool


def edge_intensity(
    pressure: Density, sharp: bool, on_left: bool, loads: tuple[float, float], friction: float
) -> EdgeIntensity:
    """The intensities at the left or the right edge, from the pressure and the loads Q and τ."""
    contact = getattr(pressure, "contact", Interval(*pressure.interval))
    (Q, tau), r = loads, contact.r
    pull = tau if on_left else -tau
    K_T = (Q / math.pi + pull * r) / math.sqrt(2.0 * r)

    def scaled_pressure(s: Array) -> tuple[Array, Array]:
        """The distances that doubles of x have from the edge, and p over the power of them."""
        x = contact.x1 + s if on_left else contact.x2 - s
        s = contact.from_left(x) if on_left else contact.from_right(x)
        return s, pressure(x) * (np.sqrt(s) if sharp else 1.0 / np.sqrt(s))

    edge = contact.x1 if on_left else contact.x2
    apart = [abs(x - edge) for x in pressure.breaks if abs(x - edge) > 0.0]
    s, near = scaled_pressure(NEAR * max(min(apart), LEAST / NEAR[0] * np.spacing(abs(edge))))
    K_N = float(np.polyfit(s / s[0], near, 2)[-1])  # the parabola through them at 0
    s, other = scaled_pressure(np.geomspace(NEAR[0], 2.0, SCANNED)[:-1] * r)
    off = np.abs(K_N / np.where(other > 0.0, other, math.inf) - 1.0)
    if K_T:
        of_stick = (Q / math.pi + pull * (r - s)) / np.sqrt(2.0 * r - s)
        off = np.maximum(off, np.abs(K_T / np.where(of_stick, of_stick, math.inf) - 1.0))
    if sharp:
        slips = 0.0 if abs(K_T) <= friction * K_N else math.inf
    else:
        slips = 2.0 * abs(K_T) / (friction * K_N) if friction else math.inf * bool(K_T)
    one, ten = (_reach(s, off, part) for part in PARTS)
    return EdgeIntensity(K_N, K_T, slips, (one, ten), sharp)


def _reach(s: Array, off: Array, part: float) -> float:
    """The distance at which the asymptote is off by a part first, between two of those scanned."""
    beyond = np.flatnonzero(off > part)
    if not beyond.size or beyond[0] == 0:
        return float(s[-1 if not beyond.size else 0])
    around = slice(beyond[0] - 1, beyond[0] + 1)
    return float(np.interp(part, off[around], s[around]))
