"""The loop of Q over the shift that slip allows, along a load path."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.io.scene_file import Units
from sie.problem.load_path import Path

from . import style

Array = NDArray[np.float64]

PARTS = 24  # of a step, which are solved and joined by straight lines ...
MOST = 600  # ... and of all steps


class Loop(NamedTuple):
    """The points of a loop, and among them its turning points, rows (shift, Q)."""

    points: Array
    corners: Array


def loop_along(history: Any) -> Loop | None:
    """The loop of a path of several points with Q, None where the shift is not known."""
    path = history.path
    if len(path) < 2 or path.points[0][0] == 0.0 or not any(Q for _, Q, _ in path.points):
        return None
    start = (path.points[0][0], 0.0, 0.0)
    from_start = Path(
        [start, *path.points], path.tilt[:1] + path.tilt, path.moment[:1] + path.moment
    )
    parts = max(min(PARTS, MOST // len(path)), 1)
    along = from_start.subdivided(parts)
    try:
        states = type(history)(history.scene, along, history.tol, history.economy)
        shifts = [state.shift for state in states]
    except ContactError:
        return None
    points = np.array([(shift, Q) for shift, (_, Q, _) in zip(shifts, along.points, strict=True)])
    return Loop(points, points[parts::parts])


def draw(axes: Axes, loop: Loop, units: Units) -> None:
    """The loop, with a dot on each turning point, the last in another colour."""
    along, length = style.scaled(float(np.abs(loop.corners[:, 0]).max()) or 1.0, units.length)
    up, force = style.scaled(float(np.abs(loop.corners[:, 1]).max()), units.force)
    style.zero_line(axes)
    axes.axvline(0.0, color=style.INK, linewidth=0.6, zorder=1)
    x, y = (loop.points * (along, up)).T
    style.curve(axes, x, y, style.BLUE, 1.2, zorder=3)
    dots: dict[str, Any] = {"marker": "o", "linestyle": "none"}
    x, y = (loop.corners * (along, up)).T
    axes.plot(x, y, color=style.BLUE, markersize=2.2, zorder=4, **dots)
    axes.plot(x[-1:], y[-1:], color=style.VERMILLION, markersize=3.0, zorder=5, **dots)
    style.named(axes, f"shift of the indenter by slip ({length})", f"$Q$ ({force})")
