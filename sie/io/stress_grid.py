"""The stress on a grid of points, and a table of it for other programs.

Four comment lines (#), then x,y,xx,yy,xy,zz,j2,mises and one row per point, x fastest, which
ParaView turns into a structured grid. The axes are those of the package: x along the surface, y the
depth, 0 on the surface. What is infinite, at a sharp edge, stays inf.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sie import __version__
from sie.files import table_of_columns
from sie.problem.request import GRID

if TYPE_CHECKING:
    from sie.stress.half_plane import Stress

    from .scene_file import SceneFile

Array = NDArray[np.float64]

COMPONENTS = ("xx", "yy", "xy", "zz", "j2", "mises")
# The window: beside the contact and in depth, in half-widths.
BESIDE, DEPTH = 1.0, 2.0


@dataclass(frozen=True, eq=False)
class Grid:
    """The stress of a solution at nx × ny points around the contact, in arrays (ny, nx)."""

    solution: Any
    nx: int = GRID[0]
    ny: int = GRID[1]

    @cached_property
    def x(self) -> Array:
        """Positions along the surface, (nx,)."""
        (x1, x2), r = self.solution.edges, self.solution.half_width
        return np.linspace(x1 - BESIDE * r, x2 + BESIDE * r, self.nx)

    @cached_property
    def y(self) -> Array:
        """Depths, (ny,)."""
        return np.linspace(0.0, DEPTH * self.solution.half_width, self.ny)

    @cached_property
    def stress(self) -> Stress:
        """The stress at all points."""
        return self.solution.stress(self.x, self.y[:, None])

    def csv(self, file: SceneFile) -> str:
        """The grid as a table, with lines of comment on the scene of the file and its units."""
        units, (x1, x2) = file.units, self.solution.edges
        head = (
            f"{file.title or 'plane contact'} (sie {__version__})",
            repr(self.solution.scene),
            f"lengths in {units.length}, stresses in {units.stress}, j2 in its square",
            f"contact from x1 = {x1!r} to x2 = {x2!r}",
        )
        x, y = np.meshgrid(self.x, self.y)
        columns = {"x": x, "y": y} | {name: getattr(self.stress, name) for name in COMPONENTS}
        return table_of_columns(head, {name: v.ravel() for name, v in columns.items()})
