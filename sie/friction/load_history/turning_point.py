"""What is remembered at a turning point of a path."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from sie.friction.loads import Loads
from sie.friction.memory import LoadMemory, SlipEvent

if TYPE_CHECKING:
    from sie.friction.loading import LoadStep
    from sie.friction.part import Part
    from sie.friction.state import State
    from sie.friction.strip_part import StripPart


@dataclass(frozen=True)
class TurningPoint:
    """A turning point of a path.

    loads       the loads there
    memory      the layers there
    slips       the slip since the last turning point, in the order of time
    turned      whether slip has opposite signs at the two edges
    straight    whether S changed in one proportion, at constant P and tilt, since it was 0
    parts       the parts of the last step in the order of time, where no layers answer it
    step        that step
    why         why they do not
    """

    loads: Loads
    memory: LoadMemory
    slips: tuple[SlipEvent, ...] = ()
    turned: bool = False
    straight: bool = True
    parts: tuple[Part | StripPart, ...] = ()
    step: LoadStep | None = None
    why: str = ""

    @property
    def state(self) -> State:
        """The state after the last part."""
        return self.parts[-1].state

    @property
    def last(self) -> SlipEvent | None:
        """The slip at the end of the step; None if nothing slips in the present contact."""
        if not self.slips:
            return None
        lower = self.slips[-1].layers[-1].lower
        return self.slips[-1] if lower.real > 0.0 or lower.imag else None
