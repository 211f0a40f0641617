"""The picture of a mesh result over the exact one, with their difference below.

Points on a line are dots, the exact answer a curve through them. Points scattered in the body are
drawn where they are, coloured by the mesh's value and by the difference. Differences are parts of
the largest exact value.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from sie.io.mesh_difference import EXACT, Comparison
from sie.io.sample_points import abscissae, ceiling
from sie.io.scene_file import UNITS, Units
from sie.solution import Solution

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


def overlay(
    solution: Solution, comparison: Comparison, units: Units = UNITS, title: str = ""
) -> Figure:
    """Two panels for each quantity of the comparison. `units` are labels."""
    names = list(comparison.differences)
    figure = Figure(
        figsize=(style.WIDTH, 0.5 + 2.5 * len(names)), dpi=style.DPI, layout="constrained"
    )
    panels = figure.subplots(2 * len(names), 1, sharex=True, height_ratios=(1.6, 1.0) * len(names))
    factor, length = style.scaled(solution.half_width, units.length)
    for name, upper, lower in zip(names, panels[::2], panels[1::2], strict=True):
        both = _both(solution, comparison, name)
        scale, stress = style.scaled(both.largest, units.stress)
        label = f"{LABELS[name]} ({stress})"
        if comparison.mesh.scattered(name):
            for axes, values, text in (
                (upper, both.mesh * scale, label),
                (lower, both.percent, DIFFERENCE),
            ):
                _draw_points(figure, axes, (both.x * factor, both.y * factor), values, text)
                axes.set_ylabel(f"$y$ ({length})", fontproperties=style.font())
        else:
            _draw_curves((upper, lower), solution, name, both, (factor, scale))
            upper.set_ylabel(label, fontproperties=style.font())
        for axes in (upper, lower):
            style.plain(axes)
            axes.yaxis.set_major_locator(MaxNLocator(nbins=4))
    style.x_axis(panels[-1], length)
    figure.align_ylabels()
    style.heading(figure, title)
    return figure


class _Both(NamedTuple):
    """A quantity at the points of the mesh; the difference is nan where it is infinite."""

    x: Array
    y: Array
    mesh: Array
    exact: Array
    percent: Array
    largest: float


def _both(solution: Solution, comparison: Comparison, name: str) -> _Both:
    x, y, values = comparison.mesh.points(name)
    exact = EXACT[name](solution, x, y)
    finite = np.isfinite(exact)
    largest = float(np.abs(exact[finite]).max()) or ceiling(solution)
    percent = np.where(finite, 100.0 * (values - np.where(finite, exact, 0.0)) / largest, np.nan)
    return _Both(x, y, values, exact, percent, largest)


def _draw_curves(
    panels: tuple[Axes, Axes],
    solution: Solution,
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
    dots: dict[str, Any] = {
        "color": style.VERMILLION,
        "markersize": 1.8,
        "zorder": 3,
        "label": "mesh",
    }
    upper.plot(both.x * factor, both.mesh * scale, "o", **dots)
    finite = both.exact[np.isfinite(both.exact)]
    low, high = (style.HEADROOM * float(end) * scale for end in (finite.min(), finite.max()))
    upper.set_ylim(min(0.0, low), max(0.0, high) or None)
    style.legend(upper, columns=2)
    style.zero_line(lower)
    style.curve(lower, both.x * factor, both.percent, style.VERMILLION, 0.9, zorder=2)
    lower.set_ylabel(DIFFERENCE, fontproperties=style.font())
    for axes in panels:
        style.edge_lines(axes, solution.patches, factor, zorder=0.5)


def _draw_points(
    figure: Figure, axes: Axes, at: tuple[Array, Array], values: Array, label: str
) -> None:
    """Points in the body, depth downwards, with a scale of colours that is white at zero."""
    bound = float(np.nanmax(np.abs(values))) or 1.0
    size = float(np.clip(INK_OF_ALL / len(values), SMALLEST, LARGEST))
    drawn = axes.scatter(
        *at, c=values, s=size, cmap="RdBu_r", vmin=-bound, vmax=bound, linewidths=0.0
    )
    bar = figure.colorbar(drawn, ax=axes, pad=0.02, aspect=14)
    bar.set_label(label, fontproperties=style.font(style.SMALL))
    for text in bar.ax.get_yticklabels():
        text.set_fontproperties(style.font(style.SMALL))
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
