"""The loads of many scenes, and which of them the families answer."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments

from .families import Array, Contact


class Loads(NamedTuple):
    """Numbers of n scenes, (n,); P or b is None."""

    modulus: Array
    normal_load: Array | None
    half_width: Array | None
    tilt: Array
    friction: Array
    tangential_load: Array
    bulk_stress: Array

    @property
    def size(self) -> Array:
        """P or b, whichever is given."""
        size = self.half_width if self.normal_load is None else self.normal_load
        assert size is not None
        return size

    def of(self, which: Any) -> Loads:
        """Those of some scenes."""
        return self._replace(**{k: v[which] for k, v in self._asdict().items() if v is not None})


def slips(a: Loads) -> NDArray[np.bool_]:
    """Whether something slips."""
    return (a.friction > 0.0) & ((a.tangential_load != 0.0) | (a.bulk_stress != 0.0))


def sign(a: Loads) -> Array:
    """The direction of slip."""
    return np.where(a.tangential_load < 0.0, -1.0, 1.0)


def regular(a: Loads) -> NDArray[np.bool_]:
    """Whether the numbers are those of a scene; others are refused by `Scene` itself."""
    size = a.size
    good = np.isfinite(a.tilt) & np.isfinite(a.tangential_load) & np.isfinite(a.bulk_stress)
    good &= (a.modulus > 1.0 / arguments.LARGEST) & (a.modulus < arguments.LARGEST)
    good &= (size > 1.0 / arguments.LARGEST) & (size < arguments.LARGEST)
    return np.asarray(good & (a.friction >= 0.0) & (a.friction < math.inf))


def one_signed(a: Loads, found: Contact) -> NDArray[np.bool_]:
    """Whether nothing slips, or all slip has one sign and something sticks (`partial_slip`)."""
    Q, P = np.abs(a.tangential_load), 0.5 * a.modulus * found.T
    fits = (a.friction * P > Q) & (0.25 * math.pi * found.r * np.abs(a.bulk_stress) <= Q)
    return np.asarray(fits | ~slips(a) & ((a.friction > 0.0) | (Q == 0.0)))
