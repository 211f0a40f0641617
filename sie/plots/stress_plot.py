"""The picture of the stress in the body: contours of √J2, and where it is largest.

Depth runs downwards. Above the surface a bar shows where the bodies touch, a thicker one where they
stick. A cross marks every place where √J2 is largest. The levels are quantiles of the field, so
that a narrow peak has bands of its own beside the field around it; their colours are evenly spaced.
"""

from __future__ import annotations

import math
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from sie.io.beside_scene import UNITS, Units
from sie.io.export import BESIDE, DEPTH, grid

from . import style

Array = NDArray[np.float64]

# The parts of the window that are below each level: finer towards the peak.
BELOW = (0.15, 0.35, 0.55, 0.7, 0.82, 0.9, 0.95, 0.98, 0.993)
NX, NY = 321, 161
# The panel's part of the width; inches: height of its labels, and of a line of the title.
PANEL, LABELS, LINE = 0.7, 0.6, 0.2
BAR, STICK_BAR = 2.2, 4.5  # points
ABOVE = 0.14  # of the depth: room above the surface for the bars
COLOURS, PALEST = "YlGnBu", 0.08


def contours(
    solution: Any, units: Units = UNITS, title: str = "", width: float = style.WIDTH
) -> Figure:
    """A Matplotlib figure of √J2 under the contact; save it with figure.savefig("stress.pdf")."""
    shape = (1.0 + ABOVE) * 0.5 * DEPTH / (1.0 + BESIDE)  # of a contact of any width
    height = PANEL * width * shape + LABELS + LINE * len(style.title_lines(title, width))
    figure = style.Picture(height, width)
    draw(figure.subplots(), solution, units)
    style.heading(figure, title)
    return figure


def draw(axes: Axes, solution: Any, units: Units) -> None:
    """The contours on given axes, with a scale of colours beside them."""
    found, weakest = grid(solution, NX, NY), solution.elastic_limit()
    root = np.sqrt(found.stress.j2)
    top = (
        weakest.stress
        if math.isfinite(weakest.stress)
        else float(np.quantile(root[np.isfinite(root)], 0.999))
    )
    factor, length = style.scaled(solution.half_width, units.length)
    x, y, shares = found.x * factor, found.y * factor, np.minimum(root, top) / top
    levels = _levels(shares)
    colours = matplotlib.colormaps[COLOURS](np.linspace(PALEST, 1.0, len(levels) - 1))
    filled = axes.contourf(x, y, shares, levels=levels, colors=colours)
    axes.contour(x, y, shares, levels=levels[1:-1], colors=style.INK, linewidths=0.35)
    _mark(axes, solution, factor, float(y[-1]))
    cross: dict[str, Any] = {"color": style.VERMILLION, "markersize": 5.0, "markeredgewidth": 1.3}
    axes.plot(*(np.array(weakest.places).T * factor), "x", **cross, clip_on=False, zorder=6)
    style.named(axes, f"$x$ ({length})", f"depth $y$ ({length})")
    axes.set_aspect("equal")
    style.plain(axes)
    assert axes.figure is not None
    bar = axes.figure.colorbar(filled, ax=axes, shrink=0.8, pad=0.02, ticks=levels)
    bar.ax.tick_params(labelsize=style.SMALL, labelfontfamily=style.FAMILY, width=0.6, length=2.5)
    bar.set_label(
        rf"$\sqrt{{J_2}}$ / {style.quantity(top, top, units.stress)}",
        fontproperties=style.font(style.SMALL),
    )
    axes.set_title(_caption(weakest.ratio), fontproperties=style.font(style.SMALL), loc="left")


def _levels(shares: Array) -> Array:
    """Levels from 0 to 1 at quantiles of the field, to two digits."""
    inner = np.quantile(shares[np.isfinite(shares)], BELOW)
    rounded = {float(f"{level:.2g}") for level in inner.tolist()}
    return np.array([0.0, *sorted(level for level in rounded if 0.0 < level < 1.0), 1.0])


def _caption(ratio: float) -> str:
    return (
        rf"first yield at $P/(bk)$ = {ratio:.4g} ($\times$)"
        if ratio > 0.0
        else "yields under any load at a sharp edge"
    )


def _mark(axes: Any, solution: Any, factor: float, depth: float) -> None:
    """The surface, and above it the patches of contact and where they stick."""
    level = -0.4 * ABOVE * depth
    axes.axhline(0.0, color=style.INK, linewidth=0.6)
    bars = [(patch, style.INK, BAR, "contact") for patch in solution.patches]
    bars += [
        (zone, style.VERMILLION, STICK_BAR, "stick") for zone in getattr(solution, "stick", ())
    ]
    named: set[str] = set()
    for ends, color, width, label in bars:
        bar: dict[str, Any] = {"color": color, "linewidth": width, "solid_capstyle": "butt"}
        shown = "" if label in named else label
        named.add(label)
        axes.plot(np.array(ends) * factor, [level] * 2, **bar, label=shown)
    axes.set_ylim(depth, -ABOVE * depth)
    axes.legend(loc="lower right", prop=style.font(style.SMALL), handlelength=1.5, fancybox=False)
