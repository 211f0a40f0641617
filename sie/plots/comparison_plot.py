"""The picture of a mesh result over the exact one, with their difference below.

Points on a line are dots, the exact answer a curve through them. Points scattered in the body are
drawn where they are, coloured by the mesh's value and by the difference. Differences are parts of
the largest exact value. What is far from the contact is not drawn.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from sie.io.beside_scene import UNITS, Units
from sie.io.mesh_comparison import EXACT, Comparison
from sie.io.sample_points import abscissae, ceiling

from . import style

Array = NDArray[np.float64]

LABELS = {
    "p": "$p$",
    "q": "$q$",
    "sxx": r"$\sigma_{xx}$",
    "syy": r"$\sigma_{yy}$",
    "sxy": r"$\sigma_{xy}$",
    "szz": r"$\sigma_{zz}$",
    "mises": "Mises",
}
DIFFERENCE = "difference (%)"
# Areas of dots, in square points: of all together, and of one at least and at most.
INK_OF_ALL, SMALLEST, LARGEST = 8000.0, 0.5, 16.0
# What is drawn beside the contact on a line and in the body, and its depth, in half-widths.
BESIDE, BESIDE_IN_BODY, DEPTH = 0.5, 1.0, 2.0
TWO_COLUMNS = 7.0  # inches
COLOURED = 0.99  # of the points are within the scale of colours


def overlay(solution: Any, comparison: Comparison, units: Units = UNITS, title: str = "") -> Figure:
    """Two panels for each quantity near the contact. `units` are labels."""
    names = list(comparison.differences)
    columns = min(len(names), 2)
    rows = -(-len(names) // columns)
    size = (style.WIDTH if columns == 1 else TWO_COLUMNS, 0.5 + 2.5 * rows)
    figure = Figure(figsize=size, dpi=style.DPI, layout="constrained")
    ratios = (1.6, 1.0) * rows
    panels = figure.subplots(2 * rows, columns, squeeze=False, height_ratios=ratios)
    for k, name in enumerate(names):
        row, column = divmod(k, columns)
        pair = tuple(panels[2 * row : 2 * row + 2, column])
        _draw(figure, pair, solution, (comparison, name), units)
    for axes in panels[-2:, -1] if len(names) % columns else ():
        axes.set_axis_off()
    figure.align_ylabels()
    style.heading(figure, title)
    return figure


def _draw(
    figure: Figure,
    pair: tuple[Axes, Axes],
    solution: Any,
    compared: tuple[Comparison, str],
    units: Units,
) -> None:
    """The quantity of a comparison in the upper panel, its difference in the lower one."""
    comparison, name = compared
    factor, length = style.scaled(solution.half_width, units.length)
    both = _both(solution, comparison, name)
    scale, stress = style.scaled(both.largest, units.stress)
    label = f"{LABELS[name]} ({stress})"
    for axes in pair:
        style.plain(axes)
        axes.yaxis.set_major_locator(MaxNLocator(nbins=4))
    if comparison.mesh.scattered(name):
        shown = ((both.mesh * scale, label, "mesh"), (both.percent, DIFFERENCE, "mesh less exact"))
        for axes, (values, text, what) in zip(pair, shown, strict=True):
            places = (both.x * factor, both.y * factor)
            _draw_points(figure, axes, places, values, (text, what, name == "mises"))
            style.named(axes, y=f"$y$ ({length})")
    else:
        _draw_curves(pair, solution, name, both, (factor, scale))
        style.named(pair[0], y=label)
    pair[0].sharex(pair[1])
    pair[0].tick_params(labelbottom=False)
    style.x_axis(pair[1], length)


class _Both(NamedTuple):
    """A quantity at the points of the mesh; the difference is nan where it is infinite."""

    x: Array
    y: Array
    mesh: Array
    exact: Array
    percent: Array
    largest: float


def _both(solution: Any, comparison: Comparison, name: str) -> _Both:
    x, y, values = comparison.mesh.fields[name]
    (x1, x2), r = solution.edges, solution.half_width
    beside = BESIDE_IN_BODY if comparison.mesh.scattered(name) else BESIDE
    near = (x >= x1 - beside * r) & (x <= x2 + beside * r)
    if comparison.mesh.scattered(name):
        near &= y <= DEPTH * r
    near |= np.count_nonzero(near) < 2  # nothing near the contact: all of it
    x, y, values = x[near], y[near], values[near]
    exact = EXACT[name](solution, x, y)
    finite = np.isfinite(exact)
    largest = float(np.abs(exact[finite]).max()) or ceiling(solution)
    percent = np.where(finite, 100.0 * (values - np.where(finite, exact, 0.0)) / largest, np.nan)
    return _Both(x, y, values, exact, percent, largest)


def _draw_curves(
    panels: tuple[Axes, Axes],
    solution: Any,
    name: str,
    both: _Both,
    scales: tuple[float, float],
) -> None:
    """The exact curve, the mesh's dots and, below, the difference; dotted lines at the edges."""
    (upper, lower), (factor, scale) = panels, scales
    fine = np.unique(np.concatenate((abscissae(solution, style.POINTS), both.x)))
    fine = fine[(fine >= both.x[0]) & (fine <= both.x[-1])]
    bound = 2.0 * style.HEADROOM * both.largest
    exact = np.clip(EXACT[name](solution, fine, np.full_like(fine, both.y[0])), -bound, bound)
    style.curve(upper, fine * factor, exact * scale, style.BLUE, 1.0, zorder=2, label="exact")
    dots: dict[str, Any] = {"color": style.VERMILLION, "markersize": 1.8, "zorder": 3}
    upper.plot(both.x * factor, both.mesh * scale, "o", **dots, label="mesh")
    shown = np.concatenate((both.exact[np.isfinite(both.exact)], both.mesh))
    low, high = (style.HEADROOM * float(end) * scale for end in (shown.min(), shown.max()))
    upper.set_ylim(min(0.0, low), max(0.0, high) or None)
    style.legend(upper, columns=2)
    style.zero_line(lower)
    style.curve(lower, both.x * factor, both.percent, style.VERMILLION, 0.9, zorder=2)
    style.named(lower, y=DIFFERENCE)
    for axes in panels:
        style.edge_lines(axes, solution.patches, factor, zorder=0.5)


def _draw_points(
    figure: Figure,
    axes: Axes,
    at: tuple[Array, Array],
    values: Array,
    words: tuple[str, str, bool],
) -> None:
    """Points in the body, depth downwards. The colour is white at zero, or dark if none is less.

    `words` are the label of the colours, what is drawn, and whether values are never negative.
    """
    label, what, positive = words
    positive = positive and what == "mesh"
    bound = float(np.nanquantile(np.abs(values), COLOURED)) or 1.0
    size = float(np.clip(INK_OF_ALL / len(values), SMALLEST, LARGEST))
    low, colours = (0.0, "viridis") if positive else (-bound, "RdBu_r")
    drawn = axes.scatter(*at, c=values, s=size, vmin=low, vmax=bound, linewidths=0.0, cmap=colours)
    bar = figure.colorbar(drawn, ax=axes, pad=0.02, aspect=14)
    bar.set_label(label, fontproperties=style.font(style.SMALL))
    for text in bar.ax.get_yticklabels():
        text.set_fontproperties(style.font(style.SMALL))
    axes.set_title(what, loc="left", pad=2.0, fontproperties=style.font(style.SMALL))
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
