"""The stress on a grid of points, and a table of it for other programs.

Four comment lines (#), then x,y,xx,yy,xy,zz,j2,mises and one row per point, x fastest, which
ParaView turns into a structured grid. The axes are those of the package: x along the surface, y the
depth, 0 on the surface. What is infinite, at a sharp edge, stays inf.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

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


class Grid(NamedTuple):
    """Positions (nx,), depths (ny,), and the stress there in arrays (ny, nx)."""

    x: Array
    y: Array
    stress: Stress


def grid(solution: Any, nx: int = GRID[0], ny: int = GRID[1]) -> Grid:
    """The stress of a solution around the contact."""
    (x1, x2), r = solution.edges, solution.half_width
    x, y = np.linspace(x1 - BESIDE * r, x2 + BESIDE * r, nx), np.linspace(0.0, DEPTH * r, ny)
    return Grid(x, y, solution.stress(x, y[:, None]))


def grid_csv(solution: Any, file: SceneFile, nx: int, ny: int) -> str:
    """The grid as a table, with lines of comment on the scene of the file and its units."""
    units, (x1, x2), found = file.units, solution.edges, grid(solution, nx, ny)
    head = (
        f"{file.title or 'plane contact'} (sie {__version__})",
        repr(solution.scene),
        f"lengths in {units.length}, stresses in {units.stress}, j2 in its square",
        f"contact from x1 = {x1!r} to x2 = {x2!r}",
    )
    x, y = np.meshgrid(found.x, found.y)
    columns = {"x": x, "y": y} | {name: getattr(found.stress, name) for name in COMPONENTS}
    return table_of_columns(head, {name: v.ravel() for name, v in columns.items()})
