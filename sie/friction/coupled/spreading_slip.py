"""Slip on the strip at the left edge of a contact that spreads under Q, which goes against Q.

A place slips while the strip [x1, e0] covers it, from Q = 0 on or from when it is touched, and
keeps that slip. At s the rate of it is -2/E* ∫γ̇ from x to e0. With I(x) = ∫ from x to the right
over what Q added to γ, and T(s) the same over the whole strip, dT/ds = w ∫γ̇ from x1 to e0,

    E*/2 g = T(s') - I(x),

where s' is the state in which x was touched, or 0.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .integral import Integral, integral, towards_ends
from .panels import graded
from .spreading_history import SpreadingHistory

Array = NDArray[np.float64]

# Parts of s and of the strip: T and I are sums on panels that shrink to these, where γ̇ is infinite
# like d^(-1/2+θ) and γ is not; growth of those of T
NEAREST, RATIO = 1e-6, 3.0
AT_ONCE = 1e-25  # of the strip: γ̇ is a power of the distance from its ends


@dataclass(frozen=True, eq=False)
class StripSlip:
    """E*/2 times the slip on the strip and on what it left, in the frame.

    s           how far the contact has spread
    added       what Q added to γ
    ends        x1, e0, and the right end of all that the strip ever covered
    """

    history: SpreadingHistory
    s: float
    added: Callable[[Array], Array]
    ends: tuple[float, float, float]

    def __call__(self, u: Array) -> Array:
        """The slip at u >= x1, not positive."""
        b, last, slip = self.history.b, self.ends[2], np.zeros(len(u))
        reached, gained = u < last, u < -b
        slip[reached] = self._from_edge(u[reached]) - self._from_edge(np.array([last]))
        if gained.any():
            slip[gained] += self._whole(-b - u[gained])
        return slip

    @cached_property
    def _from_edge(self) -> Integral:
        """∫ from x1 of what Q added to γ."""
        marks = np.unique([*self.ends, -self.history.b])
        pairs = itertools.pairwise(marks.tolist())
        cuts = [towards_ends(lo, hi, marks, NEAREST) for lo, hi in pairs]
        return integral(self.added, np.unique(np.concatenate(cuts)))

    @cached_property
    def _whole(self) -> Integral:
        """T, of s."""
        ends = np.array([min(panel.hi, self.s) for panel in self.history.panels])
        levels = max(math.ceil(math.log(ends[0] / (NEAREST * self.s), RATIO)), 1)
        first = ends[0] * RATIO ** -np.arange(levels, 0.5, -1.0)
        cuts = np.unique(np.concatenate(([0.0], first, ends)))
        return integral(lambda s: np.array([self._rate(one) for one in s.tolist()]), cuts)

    def _rate(self, s: float) -> float:
        """w ∫γ̇ over the strip."""
        history, theta = self.history, self.history.rates.theta
        e2, e3 = history.zones(s)
        length = np.array([history.strip_width(s, e2, e3)])
        _, from_x1, _, mass = graded(
            length, AT_ONCE * length, AT_ONCE * length, (theta - 0.5, 0.5 - theta)
        )
        whole = history.b + history.c + s - e2, 2.0 * history.b + s - e3
        places = from_x1, *(v - from_x1 for v in whole)
        w = float(history.panel_of(s)(np.array([s]))[0][0])
        return w * float((history.gradient_rate(s, places, (e2, e3)) * mass).sum())
