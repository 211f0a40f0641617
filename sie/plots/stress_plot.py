"""The picture of the stress in the body: contours of √J2, and where it is largest.

Depth runs downwards. Above the surface a bar shows where the bodies touch, a thicker one where they
stick. A cross marks every place where √J2 is largest. Levels are tenths of the largest value, so
that pictures of different contacts can be compared.
"""

from __future__ import annotations

import math
import textwrap
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sie.io.scene_file import UNITS, Units
from sie.io.stress_grid import Grid
from sie.solution import Solution

from . import style

LEVELS = np.arange(1, 11) / 10.0
NX, NY = 321, 161
# Inches: width of the panel, height of its labels, and of a line of the title.
PANEL, LABELS, LINE = 2.38, 0.6, 0.2
BAR, STICK_BAR = 2.2, 4.5  # points
ABOVE = 0.14  # of the depth: room above the surface for the bars
COLOURS = "YlGnBu"


def contours(solution: Solution, units: Units = UNITS, title: str = "") -> Figure:
    """A Matplotlib figure of √J2 under the contact; save it with figure.savefig("stress.pdf")."""
    grid, weakest = Grid(solution, NX, NY), solution.elastic_limit()
    root = np.sqrt(grid.stress.j2)
    top = (
        weakest.stress
        if math.isfinite(weakest.stress)
        else float(np.quantile(root[np.isfinite(root)], 0.999))
    )
    factor, length = style.scaled(solution.half_width, units.length)
    x, y = grid.x * factor, grid.y * factor
    height = PANEL * float((1.0 + ABOVE) * y[-1] / (x[-1] - x[0])) + LABELS
    height += LINE * len(textwrap.wrap(title, style.TITLE_COLUMNS))
    figure = Figure(figsize=(style.WIDTH, height), dpi=style.DPI, layout="constrained")
    axes = figure.subplots()
    filled = axes.contourf(x, y, np.minimum(root, top) / top, levels=[0.0, *LEVELS], cmap=COLOURS)
    axes.contour(
        x, y, np.minimum(root, top) / top, levels=LEVELS[:-1], colors=style.INK, linewidths=0.35
    )
    _mark(axes, solution, factor, float(y[-1]))
    cross: dict[str, Any] = {"color": style.VERMILLION, "markersize": 5.0, "markeredgewidth": 1.3}
    axes.plot(*(np.array(weakest.places).T * factor), "x", **cross, clip_on=False, zorder=6)
    axes.set_xlabel(f"$x$ ({length})", fontproperties=style.font())
    axes.set_ylabel(f"depth $y$ ({length})", fontproperties=style.font())
    axes.set_aspect("equal")
    style.plain(axes)
    bar = figure.colorbar(
        filled, ax=axes, shrink=0.8, pad=0.02, ticks=[0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    )
    bar.ax.tick_params(labelsize=style.SMALL, labelfontfamily=style.FAMILY, width=0.6, length=2.5)
    bar.set_label(
        rf"$\sqrt{{J_2}}$ / {style.quantity(top, top, units.stress)}",
        fontproperties=style.font(style.SMALL),
    )
    axes.set_title(_caption(weakest.ratio), fontproperties=style.font(style.SMALL), loc="left")
    style.heading(figure, title)
    return figure


def _caption(ratio: float) -> str:
    return (
        rf"first yield at $P/(bk)$ = {ratio:.4g} ($\times$)"
        if ratio > 0.0
        else "yields under any load at a sharp edge"
    )


def _mark(axes: Any, solution: Solution, factor: float, depth: float) -> None:
    """The surface, and above it the patches of contact and where they stick."""
    level = -0.4 * ABOVE * depth
    axes.axhline(0.0, color=style.INK, linewidth=0.6)
    bars = [(patch, style.INK, BAR, "contact") for patch in solution.patches]
    bars += [
        (zone, style.VERMILLION, STICK_BAR, "stick") for zone in getattr(solution, "stick", ())
    ]
    for ends, color, width, label in bars:
        bar: dict[str, Any] = {"color": color, "linewidth": width, "solid_capstyle": "butt"}
        axes.plot(np.array(ends) * factor, [level] * 2, **bar, label=label)
    axes.set_ylim(depth, -ABOVE * depth)
