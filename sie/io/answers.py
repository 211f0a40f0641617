"""The wanted quantities of a solution that text, CSV and JSON share."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.contact.small_strains import notes
from sie.errors import ContactError
from sie.problem.request import NEED_SHEAR, UNASKED, energy_costs
from sie.solution import Solution

from .scene_file import SceneFile

Array = NDArray[np.float64]

LOOKED_AT = 401  # points in the contact, for the steepest slope


def wanted(file: SceneFile) -> tuple[str, ...]:
    """The quantities that a scene file names; without any, those of the contact."""
    return file.want or UNASKED


def notes_of(solution: Solution, file: SceneFile) -> tuple[str, ...]:
    """The notes on strains that are not small, and on slip where a wanted quantity depends on it.

    If only the edges are wanted, the pressure is not computed, and its mean stands for it.
    """
    if NEED_SHEAR & set(wanted(file)):
        return solution.notes
    if set(wanted(file)) != {"edges"} or solution.scene.bonded:
        return solution.strain_notes
    slopes = solution.scene.profile.slope(np.linspace(*solution.edges, LOOKED_AT)) + solution.tilt
    return notes(slopes, solution.normal_load / (2.0 * solution.half_width) / solution.scene.Estar)


def slip_of(solution: Solution, x: Array) -> dict[str, Array]:
    """The slip at x; {} where it is not known.

    A path does not determine it for points that came into contact while the bodies slipped.
    """
    try:
        return {"slip": solution.slip(x)}
    except ContactError:
        return {}


def energy_of(solution: Solution) -> dict[str, float]:
    """The dissipated energy; {} where it is a sum over states, or not known (full sliding)."""
    if energy_costs(solution.scene):
        return {}
    try:
        return {"energy_lost": solution.energy_lost}
    except ContactError:
        return {}


def slipping(solution: Solution) -> tuple[tuple[float, float, float], ...]:
    """The zones that slip or have slipped, (lo, hi, sign of q)."""
    if solution.scene.epsilon:
        return ((*solution.edges, float(solution.scene.slides)),)
    if solution.scene.coupled:
        return solution.coupled[1].slip_zones
    if not solution.sheared:
        return ()
    x1, x2 = solution.edges
    # Not the zones that have left the contact.
    return tuple(z for z in solution.tangential.slipped if x1 <= z[0] and z[1] <= x2)
