"""One panel on axes that a user gives, or on axes of their own, which a notebook shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from sie.arguments import suggestion
from sie.io.beside_scene import Units
from sie.sweeps.result import labels

from . import contact_plot, stress_plot, style

Array = NDArray[np.float64]

HEIGHT = 2.2  # inches


def of_solution(solution: Any, axes: Axes | None, what: str, units: Any) -> Axes:
    """A panel of a solution. ValueError for what it has not, before anything is drawn."""
    kinds = (*contact_plot.PANELS, "stress")
    if what not in kinds:
        raise ValueError(f"what = {what!r} is not known: {suggestion(str(what), kinds)}")
    if what in ("shear", "slip") and not solution.carries_shear:
        raise ValueError(f"what = {what!r}: this contact carries no shear; draw its pressure")
    labels = _labels(units)
    axes = _axes(axes)
    if what == "stress":
        stress_plot.draw(axes, solution, labels)
    else:
        contact_plot.panel(solution, what, axes, labels)
    return axes


def of_history(history: Any, axes: Axes | None, units: Any) -> Axes:
    """The loop of Q over the shift along a path. ValueError where there is none."""
    labels, loop = _labels(units), contact_plot.loop_along(history)
    if loop is None:
        raise ValueError(
            "the path has no loop: give several points with a tangential load, and P > 0 at the "
            "first; where the slip of a point is not known, draw history[k].plot()"
        )
    axes = _axes(axes)
    contact_plot.draw_loop(axes, loop, labels)
    style.plain(axes)
    return axes


def of_cracks(
    depth: Array, lines: Sequence[tuple[Array, str, str]], axes: Axes | None, units: Any
) -> Axes:
    """Ranges of K against depth: (values, style of the line, label) of each line."""
    labels = _labels(units)
    axes = _axes(axes)
    for values, line, label in lines:
        axes.plot(depth, values, line, label=label)
    axes.set_xlabel(f"depth of the crack, {labels.length}")
    axes.set_ylabel(f"range of K, {labels.stress} √{labels.length}")
    axes.legend()
    style.plain(axes)
    return axes


def _axes(given: Axes | None) -> Axes:
    if given is None:
        figure = style.Picture(HEIGHT)
        return figure.add_subplot(axes_class=style.ShownAxes)
    if not isinstance(given, Axes) or given.name != "rectilinear":
        raise ValueError(
            f"ax = {given!r} is not an axes of Matplotlib with x and y: give one of "
            "plt.subplots(), or none"
        )
    return given


def _labels(units: Any) -> Units:
    return units if isinstance(units, Units) else Units(**labels(units))
