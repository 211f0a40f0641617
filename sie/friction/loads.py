"""The loads of a contact at a point of a path."""

from __future__ import annotations

from typing import NamedTuple

FIRST = 1e-14  # of a step from nothing: after that the bodies touch


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

    def touching(self, end: Loads) -> Loads:
        """The same, or if nothing touches under them, those soon after it in a step to others."""
        return self if self.P else self.towards(end, FIRST)

    @property
    def normal(self) -> tuple[float, float]:
        """What the pressure depends on."""
        return self.P, self.turn

    def __str__(self) -> str:
        shown = ", ".join(f"{v:.6g}" for v in self[:3])
        return f"(P, Q, σ) = ({shown})" + (f" at {self.turn:.6g}" if self.turn else "")
