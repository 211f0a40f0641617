"""The problem of a scene: its profile, load, tilt or moment, in units of E*/2."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from sie.numerics.chord import Chord
from sie.problem.scene import Scene
from sie.profiles.pieces import Pieces
from sie.profiles.profile_pieces import of_profile
from sie.profiles.slope import Slope

from .state import Effort, Given

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Problem:
    """The given profile and loads, in units of E*/2.

    pieces     window, cuts or None -> the slope, without tilt
    slope      H(x);  height: h(x);  by_slope: whether the slope is a function, and h costs more
    domain     where the indenter is known; corners: whether its ends are the indenter's own
    given      load or half-width, tilt or moment
    half_modulus    E*/2
    effort     what the search has taken so far
    """

    pieces: Callable[..., Pieces]
    slope: Slope
    height: Callable[[Array], Array]
    by_slope: bool
    domain: tuple[float, float]
    corners: tuple[bool, bool]
    breaks: Array
    chord: Chord
    given: Given
    half_modulus: float
    effort: Effort = field(default_factory=Effort)

    def tilted(self, tilt: float, window: tuple[float, float]) -> Callable[[Array], Array]:
        """The function h + tilt x on the window, up to a constant.

        A slope that is a function is resolved once for all heights.
        """
        if not self.by_slope:
            return lambda x: self.height(x) + tilt * x
        pieces = self.pieces(window)
        return lambda x: np.where(
            pieces.void[pieces.locate(x)],
            np.inf,
            pieces.rises(np.full(x.shape, window[0]), x) + tilt * x,
        )


def problem_of(scene: Scene, tol: float = 1e-15) -> Problem:
    profile, G = scene.profile, 0.5 * scene.Estar
    moment = None if scene.moment is None else scene.moment / G
    assert scene.normal_load is not None
    domain = profile.pieces.domain
    return Problem(
        pieces=lambda window, cuts=None: of_profile(profile, window, tol, cuts),
        slope=profile.pieces,
        height=profile.height,
        by_slope=bool(profile.pieces.functions),
        domain=domain,
        corners=profile.ends_are_corners,
        breaks=np.asarray(profile.breaks),
        chord=Chord(profile.period),
        given=Given(scene.normal_load / G, scene.tilt, moment),
        half_modulus=G,
    )
