"""The stress on a grid of points, and files of it for other programs.

    .csv    4 comment lines (#), then  x,y,xx,yy,xy,zz,j2,mises  and one row per point, x fastest
    .npz    arrays x (nx), y (ny), xx, yy, xy, zz, j2, mises (ny, nx):  numpy.load(file)["j2"]
    .vti    VTK image data that ParaView opens: the tensor "stress" (XX YY ZZ XY YZ XZ) and the
            scalars "j2" and "mises"

The axes are those of the package: x along the surface, y the depth, 0 on the surface. What is
infinite, at a sharp edge, stays inf.
"""

from __future__ import annotations

import base64
import io
import re
import sys
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie import __version__
from sie.files import table_of_columns
from sie.problem.request import GRID
from sie.stress.half_plane import Stress

from .scene_file import SceneFile

if TYPE_CHECKING:
    from sie.solution import Solution

Array = NDArray[np.float64]

SUFFIXES = ("csv", "npz", "vti")
COMPONENTS = ("xx", "yy", "xy", "zz", "j2", "mises")
# The window: beside the contact and in depth, in half-widths.
BESIDE, DEPTH = 1.0, 2.0
# Characters that no XML text may contain, in whatever form (XML 1.0, production 2).
FORBIDDEN = "[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"


@dataclass(frozen=True, eq=False)
class Grid:
    """The stress of a solution at nx × ny points around the contact, in arrays (ny, nx)."""

    solution: Solution
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


def file_bytes(grid: Grid, suffix: str, file: SceneFile) -> bytes:
    """The grid as a file of one of SUFFIXES, with lines of comment on the scene and its units."""
    units, (x1, x2) = file.units, grid.solution.edges
    head = (
        f"{file.title or 'plane contact'} (sie {__version__})",
        repr(grid.solution.scene),
        f"lengths in {units.length}, stresses in {units.stress}, j2 in its square",
        f"contact from x1 = {x1!r} to x2 = {x2!r}",
    )
    return {"csv": _csv, "npz": _npz, "vti": _vti}[suffix](grid, tuple(map(_one_line, head)))


def _one_line(text: str) -> str:
    """The text without line ends, and without characters that UTF-8 or XML does not have."""
    return " ".join(re.sub(FORBIDDEN, "\ufffd", text).splitlines())


def _csv(grid: Grid, head: tuple[str, ...]) -> bytes:
    x, y = np.meshgrid(grid.x, grid.y)
    columns = {"x": x, "y": y} | {name: getattr(grid.stress, name) for name in COMPONENTS}
    return table_of_columns(head, {name: v.ravel() for name, v in columns.items()}).encode()


def _npz(grid: Grid, head: tuple[str, ...]) -> bytes:
    stream = io.BytesIO()
    values = {name: getattr(grid.stress, name) for name in COMPONENTS}
    np.savez(stream, x=grid.x, y=grid.y, about=np.array("\n".join(head)), **values)
    return stream.getvalue()


def _vti(grid: Grid, head: tuple[str, ...]) -> bytes:
    s = grid.stress
    zero = np.zeros_like(s.xx)
    tensor = np.stack((s.xx, s.yy, s.zz, s.xy, zero, zero), axis=-1)
    extent = f"0 {grid.nx - 1} 0 {grid.ny - 1} 0 0"
    spacing = " ".join(repr(float(v[1] - v[0])) for v in (grid.x, grid.y))
    order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
    # A comment has no two hyphens in a row, and none at its end.
    about = re.sub("-(?=-|$)", "- ", "; ".join(head))
    return f"""<?xml version="1.0"?>
<!-- {about} -->
<VTKFile type="ImageData" version="1.0" byte_order="{order}" header_type="UInt64">
  <ImageData WholeExtent="{extent}" Origin="{float(grid.x[0])!r} 0.0 0.0" Spacing="{spacing} 1.0">
    <Piece Extent="{extent}">
      <PointData Scalars="j2" Tensors="stress">
        {_data_array("stress", tensor, components=6)}
        {_data_array("j2", s.j2)}
        {_data_array("mises", s.mises)}
      </PointData>
    </Piece>
  </ImageData>
</VTKFile>
""".encode()


def _data_array(name: str, values: Array, components: int = 1) -> str:
    """VTK's inline binary format: the number of bytes as 64 bits, then the bytes, in base 64."""
    data = np.ascontiguousarray(values).tobytes()
    text = base64.b64encode(np.uint64(len(data)).tobytes() + data).decode()
    count = f' NumberOfComponents="{components}"' if components > 1 else ""
    return f'<DataArray type="Float64" Name="{name}"{count} format="binary">{text}</DataArray>'
