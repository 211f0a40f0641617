"""What a march with a slip zone inside the stick zone asks of the state under P alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval

Array = NDArray[np.float64]


class Search(Protocol):
    """The search of `tangential`, as far as it is asked."""

    @property
    def normal(self) -> Any:
        """The state under P alone, with b, c and the load."""

    @property
    def gamma(self) -> Any:
        """γ there, a function with `cuts` between which it is smooth."""

    @property
    def beta(self) -> float:
        """Dundurs' β."""

    @property
    def friction(self) -> float:
        """The coefficient f."""

    @property
    def theta(self) -> float:
        """θ, tan πθ = β f."""

    @property
    def stress(self) -> float:
        """The mean of f p under P alone."""

    def H(self, x: Array) -> Array:
        """E*/2 h'."""


class Sliding(Protocol):
    """p in full sliding of a contact, finite at its left edge.

    The strength is that of its infinite end.
    """

    @property
    def k2(self) -> float:
        """The strength."""

    @property
    def resultant(self) -> float:
        """The load."""

    def regular(self, x: Array) -> Array:
        """p without its infinite end."""


SlidingOf = Callable[[Interval], Sliding]  # computes it for a contact
