"""The loop of Q over the shift that slip allows, along a load path.

Each step is cut where slip starts or a front passes a corner of the memory, for there the curve has
a kink or a jump of its curvature. Between two cuts both coordinates are polynomials through points
that are solved, and the curve is drawn as Bézier curves with their tangents: it is smooth at any
zoom of a vector picture.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Curve
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.load_history.turning_point import TurningPoint
from sie.io.scene_file import Units
from sie.problem.load_path import Path
from sie.solution import Solution

from . import style

Array = NDArray[np.float64]
Followed = Callable[[Path], Sequence[Solution]]

POINTS = 12  # beyond the first of a piece between two cuts
MOST = 600  # of all pieces: of a longer path the turning points are joined
NARROW = 1e-6  # shares of a step that are nearer to each other are one cut


class Piece(NamedTuple):
    """Points (shift, Q) of a piece, and their derivatives in its parameter, from 0 to 1."""

    at: Array
    slope: Array
    parameter: Array


class Loop(NamedTuple):
    """The pieces of a loop, and its turning points, rows (shift, Q)."""

    pieces: tuple[Piece, ...]
    corners: Array


def loop_of(path: Path, states: Sequence[TurningPoint], along: Followed) -> Loop | None:
    """The loop of a path of several points with Q, None where the shift is not known.

    `states` are its turning points, and `along` follows another path of the same scene.
    """
    if len(path) < 2 or path.points[0][0] == 0.0 or not any(Q for _, Q, _ in path.points):
        return None
    try:
        return _loop(path, states, along)
    except ContactError:
        return None


def _loop(path: Path, states: Sequence[TurningPoint], along: Followed) -> Loop:
    rows = [(path.points[0][0], 0.0, 0.0, path.turns[0])]
    rows += [(*point, turn) for point, turn in zip(path.points, path.turns, strict=True)]
    rises = [0.0, *(b.memory.level - a.memory.level for a, b in pairwise(states))]
    cuts = [_cuts(state, rise) for state, rise in zip(states, rises, strict=True)]
    count = min(POINTS, MOST // sum(len(shares) for shares in cuts)) or 1
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(count + 1) / count)
    loads = rows[:1]
    for (start, end), shares in zip(pairwise(np.array(rows)), cuts, strict=True):
        for first, last in pairwise((0.0, *shares)):
            loads += [
                tuple(start + (first + (last - first) * t) * (end - start)) for t in nodes[1:]
            ]
    turns = {"tilt" if path.tilt else "moment": [row[3] for row in loads]}
    within = Path([row[:3] for row in loads], **turns if path.tilt or path.moment else {})
    at = np.array([(s.shift, Q) for s, (_, Q, _) in zip(along(within), within.points, strict=True)])
    ends = count * np.cumsum([len(shares) for shares in cuts])
    pieces = [at[k : k + count + 1] for k in range(0, len(at) - 1, count)]
    return Loop(tuple(Piece(piece, _slope(nodes, piece), nodes) for piece in pieces), at[ends])


def _cuts(state: TurningPoint, rise: complex) -> list[float]:
    """The shares of a step at which slip starts or a front passes a corner, and 1."""
    shares, carried = [1.0], 0.0
    layers = [o for event in state.slips for o in event.layers]
    whole = sum(o.jump * abs(o.lower - o.upper) for o in layers)
    for o in layers:
        carried += o.jump * abs(o.lower - o.upper)
        shares += [1.0 - (s / rise).real for s in o.surface] if rise else [carried / whole]
    cuts = [share for share in sorted(shares) if NARROW < share <= 1.0 - NARROW]
    return [a for a, b in pairwise((*cuts, 1.0)) if b - a > NARROW] + [1.0]


def _slope(nodes: Array, values: Array) -> Array:
    """The derivatives of the polynomials through values at Chebyshev's points."""
    series = np.polynomial.chebyshev.chebfit(2.0 * nodes - 1.0, values, len(nodes) - 1)
    derived = 2.0 * np.polynomial.chebyshev.chebder(series)
    return np.polynomial.chebyshev.chebval(2.0 * nodes - 1.0, derived).T


def draw(axes: Axes, loop: Loop, units: Units) -> None:
    """The loop, with a dot on each turning point, the last in another colour."""
    along, length = style.scaled(float(np.abs(loop.corners[:, 0]).max()) or 1.0, units.length)
    up, force = style.scaled(float(np.abs(loop.corners[:, 1]).max()), units.force)
    scale = np.array([along, up])
    style.zero_line(axes)
    axes.axvline(0.0, color=style.INK, linewidth=0.6, zorder=1)
    line: dict[str, Any] = {"fill": False, "edgecolor": style.BLUE, "linewidth": 1.2, "zorder": 3}
    axes.add_patch(PathPatch(_curve(loop, scale), joinstyle="round", **line))
    dots: dict[str, Any] = {"marker": "o", "linestyle": "none"}
    x, y = (loop.corners * scale).T
    axes.plot(x, y, color=style.BLUE, markersize=2.2, zorder=4, **dots)
    axes.plot(x[-1:], y[-1:], color=style.VERMILLION, markersize=3.0, zorder=5, **dots)
    axes.autoscale_view()
    axes.set_xlabel(f"shift of the indenter by slip ({length})", fontproperties=style.font())
    axes.set_ylabel(f"$Q$ ({force})", fontproperties=style.font())


def _curve(loop: Loop, scale: Array) -> Curve:
    """The pieces as cubic Bézier curves, one after the other."""
    points = [loop.pieces[0].at[0]]
    for at, slope, parameter in loop.pieces:
        third = np.diff(parameter)[:, None] / 3.0
        controls = at[:-1] + third * slope[:-1], at[1:] - third * slope[1:], at[1:]
        points += [point for row in zip(*controls, strict=True) for point in row]
    codes = [Curve.MOVETO] + [Curve.CURVE4] * (len(points) - 1)
    return Curve(np.array(points) * scale, codes)
