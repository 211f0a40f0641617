"""A part of a load step in which stick zones only shrink: one finite step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from .equations import Equations, Zones
from .onset import End
from .state import Ends, State


@dataclass(frozen=True, eq=False)
class Part:
    """A finite part of a step: the states at its ends, and its shares of the step.

    known   what ends of stick zones do next, by their places, where an event decided it
    """

    before: State
    state: State
    begun: float
    until: float
    known: Mapping[float, End] = field(default_factory=dict)
    opened: tuple[float, float] | None = None
    longest: float = 1.0

    @property
    def stuck(self) -> Ends:
        """What stuck all along."""
        return self.state.stick

    @cached_property
    def equations(self) -> Equations:
        """Those that the state solves."""
        signs = tuple(s for *_, s in self.state.slip)
        return Equations(self.before, self.state.contact, Zones(self.state.stick, signs))
