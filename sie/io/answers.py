"""What a scene file wants of a solution, where text, CSV and JSON give the same."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.contact.small_strains import notes
from sie.errors import ContactError
from sie.problem.request import NEED_SHEAR, UNASKED
from sie.solution import Solution

from .scene_file import SceneFile

Array = NDArray[np.float64]

LOOKED_AT = 401  # points in the contact, for the steepest slope


def wanted(file: SceneFile) -> tuple[str, ...]:
    """What a scene file asks for: the contact, if it does not say."""
    return file.want or UNASKED


def notes_of(solution: Solution, file: SceneFile) -> tuple[str, ...]:
    """The notes on strains that are not small, and on slip where a wanted quantity depends on it.

    Where nothing but the edges is wanted the pressure is not computed: its mean is looked at.
    """
    if NEED_SHEAR & set(wanted(file)):
        return solution.notes
    if set(wanted(file)) != {"edges"} or solution.scene.bonded:
        return solution.strain_notes
    slopes = solution.scene.profile.slope(np.linspace(*solution.edges, LOOKED_AT)) + solution.tilt
    return notes(slopes, solution.normal_load / (2.0 * solution.half_width) / solution.scene.Estar)


def slip_of(solution: Solution, x: Array) -> dict[str, Array]:
    """The slip at x; {} where a path does not determine it.

    It is not determined for points that came into contact while the bodies slipped.
    """
    try:
        return {"slip": solution.slip(x)}
    except ContactError:
        return {}


def energy_of(solution: Solution) -> dict[str, float]:
    """The dissipated energy; {} for dissimilar bodies in full sliding.

    They slipped in part before, and what they dissipated then is not known.
    """
    return {} if solution.scene.epsilon else {"energy_lost": solution.energy_lost}


def slipping(solution: Solution) -> tuple[tuple[float, float, float], ...]:
    """Where the bodies slip or have slipped, (lo, hi, sign of q)."""
    if solution.scene.epsilon:
        return ((*solution.edges, float(solution.scene.slides)),)
    if not solution.sheared:
        return ()
    x1, x2 = solution.edges
    return tuple(
        z for z in solution.tangential.slipped if x1 <= z[0] and z[1] <= x2
    )  # not what the contact has left
