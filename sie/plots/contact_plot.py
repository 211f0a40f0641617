"""The picture of a contact, for one column of a journal: the pressure, and the gap below it.

    upper panel     p(x) with its peak; where it is infinite or far above the rest, the panel is cut
                    and arrows say so
    lower panel     in the frame of the half-plane's deformed surface: the gap of the unloaded
                    indenter that just touches, h(x) + tilt x less its lowest value, and the gap
                    under load, 0 in contact; neither depends on the approach of the bodies, which
                    plane elasticity leaves undetermined
    with shear      q(x) between the limits ± f p, and the slip of the indenter, the stick zones
                    shaded in both; and after a path the loop of Q over the shift that slip allows,
                    with a dot on each turning point

Dotted lines through the panels are the edges x1 and x2, and those of the patches between them where
these are few. Matplotlib is imported by the modules of this folder, and they are imported when a
picture is asked for; `pyplot` is not used, and no global setting is changed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.io.answers import slip_of
from sie.io.beside_scene import UNITS, Units
from sie.io.sample_points import ABOVE_ORDINARY, abscissae, ceiling, full, peak, reach, summits
from sie.problem.load_path import Path

from . import style

Array = NDArray[np.float64]

HEIGHT = 1.75  # inches, of a panel
INDENTER, HALF_PLANE = "#ececec", "#d4d4d4"
ARROW = {
    "arrowstyle": "-|>",
    "color": style.BLUE,
    "linewidth": 0.9,
    "shrinkA": 0,
    "shrinkB": 0,
    "mutation_scale": 6,
}
PARTS, MOST = 24, 600  # of a step of a loop, joined by straight lines, and of all steps
GROUND = 0.28  # thickness of the half-plane in the lower panel, relative to the height above it


def picture(
    solution: Any, units: Units = UNITS, title: str = "", width: float = style.WIDTH
) -> style.Picture:
    """A Matplotlib figure of the pressure and the gap, and of shear and slip if there are any.

    `units` are labels, `width` is in inches. The figure is not registered with pyplot: save it with
    figure.savefig("contact.pdf"), or leave it as the last line of a notebook's cell.
    """
    view = _View(solution, units)
    sheared = solution.carries_shear
    loop = loop_along(solution.history) if solution.history is not None and sheared else None
    draw = [_draw_pressure, _draw_gap, *[_draw_shear] * sheared]
    draw += [_draw_slip] * (sheared and bool(view.slip.any()))
    count = len(draw) + (loop is not None)
    figure = style.Picture(HEIGHT * count, width)
    grid = figure.add_gridspec(count, 1, height_ratios=[1.2, *[1.0] * (count - 1)])
    upper = figure.add_subplot(grid[0])
    lower = [figure.add_subplot(grid[k], sharex=upper) for k in range(1, len(draw))]
    panels = [upper, *lower]
    for axes, drawn in zip(panels, draw, strict=True):
        drawn(axes, view)
    if loop is not None:
        below = figure.add_subplot(grid[-1])
        draw_loop(below, loop, units)
        style.plain(below)
    for axes in panels:
        _finish(axes, view)
    style.x_axis(panels[-1], view.length)
    for axes in panels[:-1]:
        axes.tick_params(labelbottom=False)
    figure.align_ylabels()
    style.heading(figure, title)
    return figure


def panel(solution: Any, what: str, axes: Axes, units: Units = UNITS) -> None:
    """One panel of the picture on given axes: pressure, gap, shear or slip."""
    view = _View(solution, units)
    PANELS[what](axes, view)
    _finish(axes, view)
    style.x_axis(axes, view.length)


def _finish(axes: Axes, view: _View) -> None:
    """The edges, the frame and the range of x of a panel."""
    if not full(view.solution):
        style.edge_lines(axes, view.solution.patches, view.factor, zorder=2.5)
    style.plain(axes)
    axes.set_xlim(*(end * view.factor for end in view.ends))


# -- the quantities ------------------------------------------------------------------------------


@dataclass(frozen=True)
class _View:
    """A solution at the sample points of the window.

    solution    what is drawn, lengths and stresses in the scene's units
    units       their names
    """

    solution: Any
    units: Units

    @cached_property
    def x(self) -> Array:
        return abscissae(self.solution, style.POINTS)

    @cached_property
    def inside(self) -> Array:
        """The sample points on the patches, with a nan between two, which interrupts a curve."""
        solution = self.solution
        zones = solution.stick if solution.carries_shear else ()
        x = np.unique(np.concatenate((self.x, np.ravel(zones))))
        parts = [x[(lo <= x) & (x <= hi)] for lo, hi in solution.patches]
        return np.concatenate([np.append(part, np.nan) for part in parts])[:-1]

    @cached_property
    def slip(self) -> Array:
        """The slip on `inside`; 0 where a path does not determine it, or nothing sticks."""
        x = self.inside
        slips = slip_of(self.solution, x) if self.solution.stick else {}
        return np.where(np.isfinite(x), slips.get("slip", 0.0 * x), 0.0)

    @cached_property
    def unloaded(self) -> Array:
        """The gap of the indenter that just touches, on x."""
        h = self.solution.scene.profile.height(self.x) + self.solution.tilt * self.x
        return h - h.min()

    @cached_property
    def loaded(self) -> Array:
        return self.solution.gap(self.x)

    @cached_property
    def shown(self) -> float:
        """The largest pressure to be drawn."""
        return ceiling(self.solution)

    @cached_property
    def shown_shear(self) -> float:
        """The largest |q| to be drawn: f times the pressure, of bonded bodies of q itself."""
        solution = self.solution
        if not solution.scene.bonded:
            return solution.scene.friction * self.shown
        q = np.abs(solution.shear(self.inside))
        return ABOVE_ORDINARY * float(np.quantile(q[np.isfinite(q)], 0.9)) or self.shown

    @cached_property
    def cut(self) -> list[float]:
        """The points where the pressure rises above it."""
        x, p = summits(self.solution)
        return list(x[p > self.shown * (1.0 + 1e-9)])

    @cached_property
    def highest(self) -> float:
        """The largest gap to be drawn, where there is an indenter.

        Of a flat punch it is P/E*, the scale of displacements.
        """
        largest = float(self.unloaded[np.isfinite(self.unloaded)].max())
        return largest or self.solution.normal_load / self.solution.scene.Estar

    @property
    def ends(self) -> tuple[float, float]:
        """The window along x."""
        (x1, x2), beside = self.solution.edges, reach(self.solution)
        return x1 - beside, x2 + beside

    @property
    def factor(self) -> float:
        """The factor from the scene's unit of length to that of the axis."""
        return style.scaled(self.solution.half_width, self.units.length)[0]

    @property
    def length(self) -> str:
        return style.scaled(self.solution.half_width, self.units.length)[1]


def _draw_pressure(axes: Axes, view: _View) -> None:
    x, (scale, stress) = view.inside, style.scaled(view.shown, view.units.stress)
    # What rises above the panel is cut off by it, but an infinite value would not be drawn at all.
    p = np.minimum(view.solution.pressure(x), 4.0 * view.shown)
    top = style.HEADROOM * view.shown * scale
    axes.fill_between(x * view.factor, p * scale, color=style.PALE_BLUE, linewidth=0.0, zorder=2)
    width = 1.2 if len(view.solution.patches) <= style.FEW else 0.5
    style.curve(axes, x * view.factor, p * scale, style.BLUE, width, zorder=3, label="pressure")
    axes.set_ylim(0.0, top)
    axes.set_yticks(style.ticks(top))
    style.named(axes, y=f"$p$ ({stress})")
    _mark_peak(axes, view, scale)
    _label_peak(axes, view)
    if not full(view.solution):
        _label_edges(axes, view)


def _draw_gap(axes: Axes, view: _View) -> None:
    scale, length = style.scaled(view.highest, view.units.length)
    top = 1.08 * view.highest * scale
    axes.axhspan(-GROUND * top, 0.0, color=HALF_PLANE, linewidth=0.0, zorder=0)
    style.zero_line(axes, zorder=2)
    filled: dict[str, Any] = {"color": INDENTER, "linewidth": 0.0, "zorder": 0}
    axes.fill_between(view.x * view.factor, view.loaded * scale, 2.0 * top, **filled)
    before = "$h(x)$, unloaded" if view.solution.tilt == 0.0 else "$h(x)$ + tilt, unloaded"
    dashed: dict[str, Any] = {"linestyle": style.DASHED, "zorder": 4, "label": before}
    _draw_surface(axes, view, view.unloaded * scale, style.INK, 0.8, **dashed)
    under = {"zorder": 3, "label": "under load"}
    _draw_surface(axes, view, view.loaded * scale, style.VERMILLION, 1.3, **under)
    axes.set_ylim(-GROUND * top, top)
    axes.set_yticks(style.ticks(top))
    style.named(axes, y=f"gap ({length})")
    style.legend(axes, columns=2, length=2.4)


def _draw_shear(axes: Axes, view: _View) -> None:
    """q between ± f p; where |q| leaves the panel (sharp edges) it is cut like the pressure.

    In full stick there are no limits.
    """
    solution, x, largest = view.solution, view.inside, view.shown_shear
    scale, stress = style.scaled(largest, view.units.stress)
    q = np.clip(solution.shear(x), -4.0 * largest, 4.0 * largest)
    _shade_stick(axes, view)
    # Below an axis that ends under 0 the other limit would show two stubs.
    both = bool(np.nanmin(q) < -1e-9 * largest)
    limits = ((1.0, r"$\pm f p$" if both else "$f p$"), (-1.0, ""))[: 1 + both]
    for sign, label in () if solution.scene.bonded else limits:
        limit = np.minimum(solution.scene.friction * solution.pressure(x), 4.0 * largest)
        # over q, which runs along them where the bodies slip
        dashed: dict[str, Any] = {"linestyle": style.DASHED, "zorder": 4, "label": label}
        style.curve(axes, x * view.factor, sign * limit * scale, style.INK, 0.8, **dashed)
    style.curve(axes, x * view.factor, q * scale, style.VERMILLION, 1.3, zorder=3, label="$q$")
    style.zero_line(axes)
    top = style.HEADROOM * largest * scale
    axes.set_ylim(-top if both else min(-0.1 * top, 0.0), top)
    style.named(axes, y=f"$q$ ({stress})")
    style.legend(axes, columns=3)


def _draw_slip(axes: Axes, view: _View) -> None:
    scale, length = style.scaled(float(np.abs(view.slip).max()), view.units.length)
    _shade_stick(axes, view)
    style.zero_line(axes)
    slip = np.where(np.isfinite(view.inside), view.slip, np.nan) * scale
    style.curve(axes, view.inside * view.factor, slip, style.BLUE, 1.3, zorder=3, label="slip")
    style.named(axes, y=f"slip ({length})")


def _shade_stick(axes: Axes, view: _View) -> None:
    for k, zone in enumerate(view.solution.stick):
        ends = np.array(zone) * view.factor
        label = "" if k else "stick"
        axes.axvspan(*ends, color=style.PALE_BLUE, linewidth=0.0, zorder=0, label=label)


PANELS: dict[str, Callable[[Axes, _View], None]] = {
    "pressure": _draw_pressure,
    "gap": _draw_gap,
    "shear": _draw_shear,
    "slip": _draw_slip,
}


def _draw_surface(
    axes: Axes, view: _View, y: Array, color: str, width: float, **given: Any
) -> None:
    """The indenter's surface, with a vertical side where the indenter ends inside the window."""
    lo, hi = view.solution.scene.profile.domain
    x, wall = view.x, [4.0 * view.highest * style.scaled(view.highest, view.units.length)[0]]
    corners = view.solution.scene.profile.ends_are_corners  # the end of a trace has no side
    if view.ends[0] < lo and corners[0]:
        x, y = np.concatenate((x[:1], x)), np.concatenate((wall, y))
    if view.ends[1] > hi and corners[1]:
        x, y = np.concatenate((x, x[-1:])), np.concatenate((y, wall))
    style.curve(axes, x * view.factor, y, color, width, **given)


# -- labels --------------------------------------------------------------------------------------


def _mark_peak(axes: Axes, view: _View, scale: float) -> None:
    """Dots on the peak, or arrows where the panel cuts the pressure."""
    frame = axes.get_xaxis_transform()
    for x in view.cut:
        axes.annotate(
            "", (x * view.factor, 1.0), (x * view.factor, 0.87), xycoords=frame, arrowprops=ARROW
        )
    if not view.cut:
        largest, where = peak(view.solution)
        dots: dict[str, Any] = {"color": style.BLUE, "markersize": 2.2, "zorder": 4}
        height = np.full(len(where), largest * scale)
        axes.plot(np.array(where) * view.factor, height, "o", **dots)


def _label_peak(axes: Axes, view: _View) -> None:
    """The value of the peak above it, towards the middle of the panel, or beside an arrow."""
    largest, where = peak(view.solution)
    text = r"$p \to \infty$"
    if math.isfinite(largest):
        value = style.quantity(largest, largest, view.units.stress)
        text = rf"$p_{{\mathrm{{max}}}}$ = {value}"
    place = (0.5 * (min(where) + max(where)) - view.ends[0]) / np.ptp(view.ends)
    beside = 0.03 if view.cut and len(where) == 1 else 0.0
    left, right = (0.6, 0.6) if beside else (0.35, 0.65)
    side = "left" if place < left else "right" if place > right else "center"
    shift = {"left": beside, "right": -beside, "center": 0.0}[side]
    frame: dict[str, Any] = {"transform": axes.transAxes, "bbox": style.opaque("white")}
    style.word(axes, place + shift, 0.97, text, ha=side, va="top", color=style.BLUE, **frame)


def _label_edges(axes: Axes, view: _View) -> None:
    frame = axes.get_xaxis_transform()
    for name, edge in zip(("x_1", "x_2"), view.solution.edges, strict=True):
        text = f"${name}$ = {style.quantity(edge, view.solution.half_width, view.units.length)}"
        style.word(axes, edge * view.factor, 1.02, text, va="bottom", transform=frame)


# -- the loop of a path ----------------------------------------------------------------------------


class Loop(NamedTuple):
    """The points of a loop, and among them its turning points, rows (shift, Q)."""

    points: Array
    corners: Array


def loop_along(history: Any) -> Loop | None:
    """The loop of a history of several points with Q, None where the shift is not known."""
    path = history.path
    if len(path) < 2 or path.points[0][0] == 0.0 or not any(Q for _, Q, _ in path.points):
        return None
    points = [(path.points[0][0], 0.0, 0.0), *path.points]
    parts = max(min(PARTS, MOST // len(path)), 1)
    along = Path(points, path.tilt[:1] + path.tilt, path.moment[:1] + path.moment)
    along = along.subdivided(parts)
    try:
        states = type(history)(history.scene, along, history.tol, history.economy)
        shifts = [state.shift for state in states]
    except ContactError:
        return None
    rows = np.array([(shift, Q) for shift, (_, Q, _) in zip(shifts, along.points, strict=True)])
    return Loop(rows, rows[parts::parts])


def draw_loop(axes: Axes, loop: Loop, units: Units) -> None:
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
