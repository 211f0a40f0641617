"""A profile that is a cubic spline: of a trace, open or closed."""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override

from .base import Profile, of_any_x
from .slope import Slope
from .splines import Spline

Array = NDArray[np.float64]


class SplineProfile(Profile):
    """A profile by its spline; nothing is known beyond the ends, which are no corners."""

    @property
    @abstractmethod
    def _spline(self) -> Spline:
        """The spline, computed once."""

    @cached_property
    def pieces(self) -> Slope:
        """H of the spline, a parabola between neighbouring points."""
        return self._spline.slope

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        return self._spline(x)

    @property
    @override
    def ends_are_corners(self) -> tuple[bool, bool]:
        return False, False
