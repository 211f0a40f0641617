"""The problem of a scene: its profile, load, tilt or moment, in units of E*/2."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from sie.numerics.chord import Chord
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.pieces import Pieces, of_profile
from sie.profiles.slope import Slope

from .start import Grid, grid_pressure
from .state import Effort, Given

Array = NDArray[np.float64]

TOLERANCE = 1e-15  # to which functions are resolved


@dataclass(frozen=True, eq=False)
class Problem:
    """A profile, the load, tilt or moment, and what the search has taken so far.

    `load` is P as it was given, which messages name.
    """

    profile: Profile
    given: Given
    load: float
    effort: Effort = field(default_factory=Effort)
    _known: dict[tuple[float, float], Pieces] = field(default_factory=dict)
    _grids: dict[tuple[float, tuple[float, float], int], Grid] = field(default_factory=dict)

    @property
    def slope(self) -> Slope:
        return self.profile.pieces

    @property
    def by_slope(self) -> bool:
        """Whether the slope is a function, and its height costs more."""
        return bool(self.slope.functions)

    @property
    def domain(self) -> tuple[float, float]:
        return self.slope.domain

    @property
    def chord(self) -> Chord:
        return Chord(self.profile.period)

    def pieces(self, window: tuple[float, float], cuts: Array | None = None) -> Pieces:
        """The slope without tilt, its functions resolved on a window between some cuts."""
        if cuts is not None:
            return of_profile(self.profile, window, TOLERANCE, cuts)
        if window not in self._known:
            self._known[window] = of_profile(self.profile, window, TOLERANCE)
        return self._known[window]

    def grid(self, tilt: float, window: tuple[float, float], cells: int) -> Grid:
        """The pressure on a grid of the window, at a tilt."""
        asked = tilt, window, cells
        if asked not in self._grids:
            height, load = self._tilted(tilt, window), self.given.load
            self._grids[asked] = grid_pressure(height, window, cells, load, self.chord.periodic)
        return self._grids[asked]

    def _tilted(self, tilt: float, window: tuple[float, float]) -> Callable[[Array], Array]:
        """The function h + tilt x on the window, up to a constant."""
        if not self.by_slope:
            return lambda x: self.profile.height(x) + tilt * x
        pieces = self.pieces(window)
        return lambda x: np.where(
            pieces.void[pieces.locate(x)],
            np.inf,
            pieces.rises(np.full(x.shape, window[0]), x) + tilt * x,
        )


def problem_of(scene: Scene) -> Problem:
    G = 0.5 * scene.Estar
    moment = None if scene.moment is None else scene.moment / G
    assert scene.normal_load is not None
    P = scene.normal_load
    return Problem(scene.profile, Given(P / G, scene.tilt, moment), P)
