"""From the pressure on a grid to a start of Newton's method."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.chord import Chord
from sie.profiles.pieces import Pieces

from .of_scene import Problem
from .repairs import apart, bounded, one_period
from .start import FEW, Grid, Patch, patches_on
from .state import State

Array = NDArray[np.float64]


def start_of(grid: Grid, pieces: Pieces, problem: Problem, tilt: float) -> State:
    """The patches on a grid, those of a few cells as parabolas under their load."""
    patches = patches_on(grid)
    rivals = Rivals(
        np.array([p.load for p in patches]),
        np.array([p.centre for p in patches]),
        problem.chord,
        tilt,
        grid.dx,
    )
    ends = [
        _small(n, patch, rivals, pieces) or (patch.a, patch.b) for n, patch in enumerate(patches)
    ]
    a, b = apart(ends)
    if problem.chord.periodic:
        a, b = one_period(a, b, problem.chord.period)
    return bounded(a, b, pieces, problem.chord, tilt)


class Rivals(NamedTuple):
    """Loads and centres of all patches on a grid of cells dx: what presses beside a small one."""

    loads: Array
    centres: Array
    chord: Chord
    tilt: float
    dx: float


def _small(n: int, patch: Patch, all_: Rivals, pieces: Pieces) -> tuple[float, float] | None:
    """The edges of patch n of a few cells; None if the grid resolves them better."""
    if patch.cells >= FEW:
        return None
    x, half = patch.centre, 0.5 * all_.dx * patch.cells
    others = np.arange(len(all_.loads)) != n
    loads, centres, chord = all_.loads[others], all_.centres[others], all_.chord
    for _ in range(8):
        d = chord.apart(x - centres)
        k = int(pieces.locate(x))
        pull = float((loads * chord.cosine(x - centres) / d).sum()) / np.pi
        steepness = float(pieces.curvature(k, x)) + float((loads / d**2).sum()) / np.pi
        if not steepness > 0.0:
            return None
        step = (pull - float(pieces.value(k, x, 0.0)) - all_.tilt) / steepness
        if abs(x + step - patch.centre) > half + all_.dx:
            break
        x += step
    curvature = float(pieces.curvature(int(pieces.locate(x)), x))
    if not curvature > 0.0:
        return None
    r = np.sqrt(2.0 * patch.load / (np.pi * curvature))
    return (x - r, x + r) if r < half + all_.dx else None
