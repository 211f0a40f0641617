"""The picture of a mesh result over the exact one: of each quantity both, and below them their difference.

Points on a line are dots, the exact answer a curve through them. Points scattered in the body are drawn where they are, coloured by the
mesh's value and by the difference. Differences are parts of the largest exact value.
"""

from __future__ import annotations

import textwrap
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from sie.io.mesh_comparison import QUANTITIES, Comparison
from sie.io.sample_points import abscissae, ceiling
from sie.io.scene_file import UNITS, Units
from sie.solution import Solution

from .contact_plot import (
    BLUE,
    DOTTED,
    DPI,
    HEADROOM,
    INK,
    POINTS,
    SMALL,
    TITLE_COLUMNS,
    VERMILLION,
    WIDTH,
    _font,
    _plain,
    _scaled,
)

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
INK_OF_ALL, SMALLEST, LARGEST = (
    8000.0,
    0.5,
    16.0,
)  # square points: of all dots together, and of one at least and at most


def overlay(
    solution: Solution, comparison: Comparison, units: Units = UNITS, title: str = ""
) -> Figure:
    """Two panels for each quantity of the comparison. `units` are labels."""
    names = list(comparison.differences)
    figure = Figure(figsize=(WIDTH, 0.5 + 2.5 * len(names)), dpi=DPI, layout="constrained")
    panels = figure.subplots(2 * len(names), 1, sharex=True, height_ratios=(1.6, 1.0) * len(names))
    factor, length = _scaled(solution.half_width, units.length)
    for name, upper, lower in zip(names, panels[::2], panels[1::2], strict=True):
        found = _both(solution, comparison, name)
        scale, stress = _scaled(found.largest, units.stress)
        label = f"{LABELS[name]} ({stress})"
        if comparison.mesh.scattered(name):
            for axes, values, text in (
                (upper, found.mesh * scale, label),
                (lower, found.percent, DIFFERENCE),
            ):
                _draw_points(figure, axes, (found.x * factor, found.y * factor), values, text)
                axes.set_ylabel(f"$y$ ({length})", fontproperties=_font())
        else:
            _draw_curves((upper, lower), solution, name, found, (factor, scale))
            upper.set_ylabel(label, fontproperties=_font())
        for axes in (upper, lower):
            _plain(axes)
            axes.yaxis.set_major_locator(MaxNLocator(nbins=4))
    panels[-1].set_xlabel(f"$x$ ({length})", fontproperties=_font())
    panels[-1].xaxis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 2, 2.5, 5, 10]))
    figure.align_ylabels()
    if title:
        figure.suptitle(
            textwrap.fill(title, TITLE_COLUMNS), fontproperties=_font(), parse_math=False
        )
    return figure


class _Both(NamedTuple):
    """A quantity at the points of the mesh; the difference is nan where the exact value is infinite."""

    x: Array
    y: Array
    mesh: Array
    exact: Array
    percent: Array
    largest: float


def _both(solution: Solution, comparison: Comparison, name: str) -> _Both:
    x, y, values = comparison.mesh.points(name)
    exact = QUANTITIES[name](solution, x, y)
    finite = np.isfinite(exact)
    largest = float(np.abs(exact[finite]).max()) or ceiling(solution)
    percent = np.where(finite, 100.0 * (values - np.where(finite, exact, 0.0)) / largest, np.nan)
    return _Both(x, y, values, exact, percent, largest)


def _draw_curves(
    panels: tuple[Axes, Axes],
    solution: Solution,
    name: str,
    found: _Both,
    scales: tuple[float, float],
) -> None:
    """The exact curve, the mesh's dots on it, and below the difference; dotted lines at the edges."""
    (upper, lower), (factor, scale) = panels, scales
    fine = np.unique(np.concatenate((abscissae(solution, POINTS), found.x)))
    fine = fine[(fine >= found.x[0]) & (fine <= found.x[-1])]
    curve, bound = (
        QUANTITIES[name](solution, fine, np.full_like(fine, found.y[0])),
        2.0 * HEADROOM * found.largest,
    )
    upper.plot(
        fine * factor,
        np.clip(curve, -bound, bound) * scale,
        color=BLUE,
        linewidth=1.0,
        zorder=2,
        label="exact",
    )
    upper.plot(
        found.x * factor,
        found.mesh * scale,
        "o",
        color=VERMILLION,
        markersize=1.8,
        zorder=3,
        label="mesh",
    )
    finite = found.exact[np.isfinite(found.exact)]
    low, high = (HEADROOM * float(end) * scale for end in (finite.min(), finite.max()))
    upper.set_ylim(min(0.0, low), max(0.0, high) or None)
    upper.legend(
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        borderaxespad=0.1,
        ncols=2,
        prop=_font(SMALL),
        frameon=False,
    )
    lower.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
    lower.plot(found.x * factor, found.percent, color=VERMILLION, linewidth=0.9, zorder=2)
    lower.set_ylabel(DIFFERENCE, fontproperties=_font())
    for axes in panels:
        for edge in solution.edges:
            axes.axvline(edge * factor, color=INK, linewidth=0.7, linestyle=DOTTED, zorder=0.5)


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
    bar.set_label(label, fontproperties=_font(SMALL))
    for text in bar.ax.get_yticklabels():
        text.set_fontproperties(_font(SMALL))
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
