"""What is remembered at a turning point of a path."""

from __future__ import annotations

from dataclasses import dataclass

from sie.friction.loads import Loads
from sie.friction.memory import LoadMemory, SlipEvent

from .marched_step import MarchedStep


@dataclass(frozen=True)
class TurningPoint:
    """A turning point of a path.

    loads       the loads there
    memory      the layers there
    slips       the slip since the last turning point, in the order of time
    turned      whether slip has opposite signs at the two edges
    straight    whether S changed in one proportion, at constant P and tilt, since it was 0
    marched     the parts of the last step in the order of time, where no layers answer it
    why         why they do not
    """

    loads: Loads
    memory: LoadMemory
    slips: tuple[SlipEvent, ...] = ()
    turned: bool = False
    straight: bool = True
    marched: tuple[MarchedStep, ...] = ()
    why: str = ""

    @property
    def last(self) -> SlipEvent | None:
        """The slip at the end of the step; None if nothing slips in the present contact."""
        if not self.slips:
            return None
        lower = self.slips[-1].layers[-1].lower
        return self.slips[-1] if lower.real > 0.0 or lower.imag else None
