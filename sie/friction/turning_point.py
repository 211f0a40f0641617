"""The loads of a path, and what is remembered at a turning point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from .marched_step import MarchedStep
from .memory import LoadMemory, SlipEvent


class Loads(NamedTuple):
    """The loads of a contact: P, Q, σ, and what is added to the tilt or the moment of the scene."""

    P: float
    Q: float
    sigma: float
    turn: float = 0.0

    def towards(self, end: Loads, share: float) -> Loads:
        """The loads in a step to others, after this share of its time."""
        pairs = zip(self, end, strict=True)
        return Loads(*(a + share * (b - a) for a, b in pairs)) if share < 1.0 else end

    @property
    def normal(self) -> tuple[float, float]:
        """What the pressure depends on."""
        return self.P, self.turn

    def __str__(self) -> str:
        shown = ", ".join(f"{v:.6g}" for v in self[:3])
        return f"(P, Q, σ) = ({shown})" + (f" at {self.turn:.6g}" if self.turn else "")


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
