"""The flat punch in Goodman's approximation (`uncoupled`), where p = P/(π w), and its stick zone.

    K'(k)/K(k) = β/f      of the modulus k = c/b.

Goodman (1962), J. Appl. Mech. 29, 515; docs/derivations/goodman.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sie.numerics.elliptic import modulus_of_ratio

from .flat import NARROWEST_RATIO, FlatPunch, half_rule, squares
from .pieces import Places
from .state import State
from .uncoupled import Uncoupled

Array = NDArray[np.float64]

# beyond it c = 4 exp(-π K'/2K) is lost even beside a double's smallest lengths; c² is a double
WIDEST_RATIO = 200.0


@dataclass(frozen=True, eq=False)
class UncoupledFlat(Uncoupled):
    """The same under a flat punch, whose edges are corners."""

    def pressure(self, at: Places, sources: Places) -> Array:
        to_left, to_right = self._to_edges(at)
        values: Array = self.question.P / (math.pi * np.sqrt(to_left * to_right))
        return values


@dataclass(frozen=True, eq=False)
class GoodmanFlat(FlatPunch):
    """The flat punch in Goodman's approximation."""

    approximate = True

    @property
    def theta(self) -> float:
        return 0.0

    @property
    def exponent(self) -> float:
        return 0.5

    def state(self, b: float, load: float) -> State:
        return UncoupledFlat(*self.asked(b, load))


def goodman_flat(beta: float, friction: float) -> GoodmanFlat:
    """The flat punch for β > 0 and f > 0.

    Where the slip zone would be narrower than rounding, f is that which makes it so wide.
    """
    bonded = beta < NARROWEST_RATIO * friction
    friction = beta / NARROWEST_RATIO if bonded else friction
    modulus = modulus_of_ratio(min(beta / friction, WIDEST_RATIO))
    t, near, _ = half_rule()
    _, square = squares(modulus, t, near)
    return GoodmanFlat(beta, friction, bonded, modulus, 1.0 / (math.pi * np.sqrt(square)))
