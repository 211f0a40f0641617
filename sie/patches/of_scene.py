"""The problem of a scene: its profile, load, tilt or moment, in units of E*/2."""

from __future__ import annotations

import numpy as np

from sie.problem.scene import Scene

from .chord import Chord
from .newton import Given
from .pieces import of_profile
from .solver import Problem


def problem_of(scene: Scene, tol: float = 1e-15) -> Problem:
    profile, G = scene.profile, 0.5 * scene.Estar
    moment = None if scene.moment is None else scene.moment / G
    assert scene.normal_load is not None
    domain = profile.pieces.domain
    return Problem(
        pieces=lambda window: of_profile(profile, window, tol),
        slope=profile.pieces,
        height=profile.height,
        by_slope=bool(profile.pieces.functions),
        domain=domain,
        corners=profile.ends_are_corners,
        breaks=np.asarray(profile.breaks),
        chord=Chord(profile.period),
        given=Given(scene.normal_load / G, scene.tilt, moment),
    )
