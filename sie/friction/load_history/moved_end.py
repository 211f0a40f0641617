"""The state after an end of the stick zone receded while its other end moved."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from .end_motion import SAME
from .marched_step import MarchedStep
from .moving_zone import MovingZone, Panel


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
