"""The state after an end of the stick zone receded while its other end moved."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import Interval

from .end_motion import SAME
from .marched_step import MarchedStep
from .moving_zone import MovingZone, Panel
from .slip_rates import Ends, SlipRates

Array = NDArray[np.float64]

WORK_NODES = 10  # on each panel


@dataclass(frozen=True, eq=False)
class MovedEnd(MarchedStep):
    """The state after an end of the stick zone receded while its other end moved.

    zone     the stick zone in the direction of the other end
    panels   the time on the way of the end that recedes
    share    the share of the step at its end
    error    the error of the end of the way over its half-width, from fewer terms
    lost     why there is no way beyond its end, "" if there may be one
    """

    zone: MovingZone
    panels: tuple[Panel, ...]
    share: float
    error: float = 0.0
    lost: str = ""

    def _at_marks(self, marks: tuple[float, ...]) -> list[Panel]:
        """The panels that begin at a mark, where the end changes its speed."""
        near = SAME * self.before.pressure.contact.r
        return [
            panel
            for panel in self.panels[1:]
            if np.abs(self.zone.direction * panel.start - np.array(marks)).min() <= near
        ]

    @property
    def span(self) -> tuple[float, float]:
        return self.panels[0].time, self.share

    def until(self, share: float) -> Self:
        panels = [panel for panel in self.panels if panel.time < share]
        last = panels[-1]
        if last.until > share:
            panels[-1] = replace(last, last=float(last.root(np.array(share))))
        Q, tau = self.zone.course.shear(share)
        p = self.zone.course.pressure(share)
        return replace(self, pressure=p, Q=Q, tau=tau, panels=tuple(panels), share=share)

    # -- slip --------------------------------------------------------------------------------------

    @cached_property
    def rates(self) -> SlipRates:
        """The rates of slip, the time as a share of the step."""
        left, right = self.signs
        return SlipRates(self.zone.course.rates, self.friction, (left or right, right or left))

    def _ends(self, panel: Panel, w: Array) -> Ends:
        """The edges of contact and the ends of the stick zone at nodes of a panel."""
        zone, d, time = self.zone, self.zone.direction, panel.times(w)
        u = panel.start + panel.length * w**2
        ends = [d * x for x in (zone.far_edge(time), u, zone.ahead(panel, w), zone.edge(time))]
        return Ends(*(ends if d > 0.0 else ends[::-1]))

    @cached_property
    def work(self) -> float:
        """f ∫∫ p |dΔg| dx."""
        g, weight = chebyshev.gauss_legendre(WORK_NODES)
        total = 0.0
        for panel in self.panels:
            w = panel.last * g
            steps = 2.0 * panel.length * w * panel.last * weight * panel.pace(w)
            ends = self._ends(panel, w)
            for time, c1, c2, step in zip(panel.times(w).tolist(), ends.c1, ends.c2, steps):
                p = self.zone.course.pressure(time)
                stick = Interval(max(float(c1), p.contact.x1), min(float(c2), p.contact.x2))
                total += float(step) * self.rates.power(p, stick)
        return total
