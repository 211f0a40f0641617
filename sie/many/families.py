"""Families of contacts that are solved as arrays.

A family is a profile whose parameters are arrays over n scenes. It answers for T = P/G, G = E*/2,
a length: `contact` gives the centre m, the half-width r, T and the moment about m over G; scenes
that it does not answer are nan there. `pressure` gives p/G at places (n, k).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Contact(NamedTuple):
    """Contacts of n scenes: centre, half-width, T = P/G and the moment about the centre over G."""

    m: Array
    r: Array
    T: Array
    about: Array


class Family(ABC):
    """One kind of profile under many loads."""

    @abstractmethod
    def takes(self, tilt: Array, of_width: bool) -> NDArray[np.bool_]:
        """Which scenes the family may answer."""

    @abstractmethod
    def contact(self, size: Array, tilt: Array, of_width: bool) -> Contact:
        """The contacts under T, or of half-widths r."""

    @abstractmethod
    def pressure(self, contact: Contact, tilt: Array, x: Array) -> Array:
        """p/G at x (n, k) from the centre, inside the contact."""

    @abstractmethod
    def part(self, which: Any) -> Self:
        """The family of some of the scenes."""
