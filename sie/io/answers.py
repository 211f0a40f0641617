"""The wanted quantities of a solution that text, CSV and JSON share."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sie.contact.small_strains import notes
from sie.errors import ContactError
from sie.problem.coverage import energy_costs
from sie.problem.request import NEED_SHEAR, UNASKED
from sie.profiles.placed_traces import traces_in

if TYPE_CHECKING:
    from sie.profiles.trace_units import Reading

    from .scene_file import SceneFile

Array = NDArray[np.float64]

LOOKED_AT = 401  # points in the contact, for the steepest slope


def wanted(file: SceneFile) -> tuple[str, ...]:
    """The quantities that a scene file names; without any, those of the contact."""
    return file.want or UNASKED


def readings_of(solution: Any) -> list[Reading]:
    """How the columns of each trace from a file were read: their units, and what is material."""
    readings = (placed.trace.reading for placed in traces_in(solution.scene.profile))
    return [reading for reading in readings if reading.file]


def notes_of(solution: Any, file: SceneFile) -> tuple[str, ...]:
    """The notes on what is neglected, and on slip where a wanted quantity depends on it.

    If only the edges are wanted, the pressure is not computed, and its mean stands for it.
    """
    asked, scene = set(wanted(file)), solution.scene
    if asked == {"edges"} and not scene.bonded:
        x1, x2 = solution.edges
        slopes = scene.profile.slope(np.linspace(x1, x2, LOOKED_AT)) + solution.tilt
        strains = notes(slopes, 0.5 * solution.normal_load / solution.half_width / scene.Estar)
    else:
        strains = solution.strain_notes
    slip = solution.slip_notes if NEED_SHEAR & asked else ()
    return *strains, *solution.coupling_notes, *_yield_notes(solution, file), *slip


def _yield_notes(solution: Any, file: SceneFile) -> tuple[str, ...]:
    """A sentence where the yield stress is exceeded at a point of a path, not between them."""
    strength, unit = file.fatigue.yield_stress, file.units.stress
    mises = max(map(_mises, solution.history or (solution,))) if strength else 0.0
    if mises <= strength:
        return ()
    reaches = f"reaches {mises:.4g} {unit}" if math.isfinite(mises) else "is infinite at an edge"
    return (
        f"note: the Mises stress {reaches}, above yield_stress = {strength:g} {unit}; "
        "beyond it elasticity is outside its range",
    )


def _mises(solution: Any) -> float:
    """The largest Mises stress in the body; 0 where it is not known."""
    with suppress(ContactError, ValueError):
        return math.sqrt(3.0) * solution.elastic_limit().stress
    return 0.0


def slip_of(solution: Any, x: Array) -> dict[str, Array]:
    """The slip at x; {} where it is not known.

    A path does not determine it for points that came into contact while the bodies slipped.
    """
    with suppress(ContactError):
        return {"slip": solution.slip(x)}
    return {}


def energy_of(solution: Any) -> dict[str, float]:
    """The dissipated energy; {} where it is a sum over states, or not known (full sliding)."""
    with suppress(ContactError):
        return {} if energy_costs(solution.scene) else {"energy_lost": solution.energy_lost}
    return {}


def slipping(solution: Any) -> tuple[tuple[float, float, float], ...]:
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
