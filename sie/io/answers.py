"""The wanted quantities of a solution that text, CSV and JSON share."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.contact.small_strains import notes
from sie.errors import ContactError
from sie.problem.request import NEED_SHEAR, UNASKED, energy_costs
from sie.profiles.placed_traces import traces_in
from sie.profiles.trace_units import Reading

from .scene_file import SceneFile

if TYPE_CHECKING:
    from sie.solution import Solution

Array = NDArray[np.float64]

LOOKED_AT = 401  # points in the contact, for the steepest slope


def wanted(file: SceneFile) -> tuple[str, ...]:
    """The quantities that a scene file names; without any, those of the contact."""
    return file.want or UNASKED


def readings_of(solution: Solution) -> list[Reading]:
    """How the columns of each trace from a file were read: their units, and what is material."""
    readings = (placed.trace.reading for placed in traces_in(solution.scene.profile))
    return [reading for reading in readings if reading.file]


def notes_of(solution: Solution, file: SceneFile) -> tuple[str, ...]:
    """The notes on what is neglected, and on slip where a wanted quantity depends on it.

    If only the edges are wanted, the pressure is not computed, and its mean stands for it.
    """
    asked = set(wanted(file))
    beyond = (*solution.coupling_notes, *yield_notes(solution, file))
    if NEED_SHEAR & asked:
        return *solution.strain_notes, *beyond, *solution.slip_notes
    if asked != {"edges"} or solution.scene.bonded:
        return *solution.strain_notes, *beyond
    slopes = solution.scene.profile.slope(np.linspace(*solution.edges, LOOKED_AT)) + solution.tilt
    mean = solution.normal_load / (2.0 * solution.half_width)
    return *notes(slopes, mean / solution.scene.Estar), *beyond


def yield_notes(solution: Solution, file: SceneFile) -> tuple[str, ...]:
    """A sentence where the yield stress is exceeded at a point of a path, not between them."""
    strength = file.fatigue.yield_stress
    if not strength:
        return ()
    path = getattr(solution, "history", (solution,))  # of a path, the solutions at its points
    mises = max(map(_mises, path))
    if mises <= strength:
        return ()
    unit = file.units.stress
    reaches = f"reaches {mises:.4g} {unit}" if math.isfinite(mises) else "is infinite at an edge"
    return (
        f"note: the Mises stress {reaches}, above yield_stress = {strength:g} {unit}; "
        "beyond it elasticity is outside its range",
    )


def _mises(solution: Solution) -> float:
    """The largest Mises stress in the body; 0 where it is not known."""
    try:
        return math.sqrt(3.0) * solution.elastic_limit().stress
    except (ContactError, ValueError):
        return 0.0


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
