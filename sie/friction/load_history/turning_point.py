"""What is remembered at a turning point of a path."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from sie.friction.loads import Loads
from sie.friction.memory import LoadMemory, SlippedLayer

if TYPE_CHECKING:
    from sie.friction.loading import LoadStep
    from sie.friction.part import Part
    from sie.friction.state import State
    from sie.friction.strip_part import StripPart


@dataclass(frozen=True)
class TurningPoint:
    """A turning point of a path.

    loads       the loads there
    memory      the layers there, where P and the tilt have not changed since S was 0
    sign        that of the slip since the last turning point
    slipped     the layers that it overwrote, from the top down
    turned      whether slip has opposite signs at the two edges
    parts       the parts of the last step in the order of time, where no layers answer it
    step        that step
    why         why they do not
    """

    loads: Loads
    memory: LoadMemory = field(default_factory=LoadMemory)
    sign: float = 1.0
    slipped: tuple[SlippedLayer, ...] = ()
    turned: bool = False
    parts: tuple[Part | StripPart, ...] = ()
    step: LoadStep | None = None
    why: str = ""

    @property
    def state(self) -> State:
        """The state after the last part."""
        return self.parts[-1].state
