"""The picture of a contact, for one column of a journal: the pressure, and below it the gap before and after loading.

    upper panel     p(x) with its peak; where it is infinite or a spike far above the rest, the panel is cut and arrows say so
    lower panel     in the frame of the half-plane's deformed surface: the gap of the unloaded indenter that just touches, h(x) + tilt x
                    less its lowest value, and the gap under load, 0 in contact. Neither depends on the approach of the bodies, which
                    plane elasticity leaves undetermined: nothing in the panel is arbitrary.
    with shear      q(x) between the limits ± f p, the stick zones shaded; and after a path the loop of Q over the shift that slip allows,
                    a dot on each turning point

Dotted lines through both panels are the edges x1 and x2. Matplotlib is imported here and by the other pictures (`contours`, `overlay`), and
nothing imports these before one is asked for; `pyplot` is not used, and no global setting is changed.
"""

from __future__ import annotations

import io
import math
import textwrap
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.history import PathSolution, follow
from sie.io.sample_points import REACH, abscissae, ceiling, peak, summits
from sie.io.scene_file import UNITS, Units
from sie.problem.load_path import Path
from sie.solution import Solution

try:
    import matplotlib
    from matplotlib.axes import Axes
    from matplotlib.backend_bases import FigureCanvasBase
    from matplotlib.figure import Figure
    from matplotlib.font_manager import FontProperties
    from matplotlib.ticker import MaxNLocator
except ImportError:
    raise ImportError('a picture needs Matplotlib: pip install "plane-contact[plot]"') from None

Array = NDArray[np.float64]

WIDTH, HEIGHT = 3.4, 3.5  # inches, one column
DPI = 300
POINTS = 1201
# Suffixes that need a TeX installation, or that no program opens.
NOT_OFFERED = {"pgf", "raw", "rgba"}

# Fonts that come with Matplotlib; the others have the letters that the first lacks.
FAMILY = ["STIXGeneral", "DejaVu Serif", "DejaVu Sans"]
SIZE, SMALL = 8.0, 7.0
TITLE_COLUMNS = 56
# Okabe and Ito (2008): told apart by the colour-blind, and in greyscale by their lightness. Opaque: PostScript knows no transparency.
BLUE, PALE_BLUE, VERMILLION, INK = "#0072B2", "#cfe4f0", "#D55E00", "#222222"
INDENTER, HALF_PLANE = "#ececec", "#d4d4d4"
DASHED, DOTTED = (0, (5, 2.5)), (0, (1, 2))
ARROW = {
    "arrowstyle": "-|>",
    "color": BLUE,
    "linewidth": 0.9,
    "shrinkA": 0,
    "shrinkB": 0,
    "mutation_scale": 6,
}

HEADROOM = 1.22  # of the upper panel over the largest pressure it shows: for the label
LOOP_POINTS = 16  # from one turning point to the next; a power of two, so that steps to and fro meet the same loads
GROUND = 0.28  # thickness of the half-plane in the lower panel, relative to the height above it
DIGITS = 4
# A length in mm may be read in these; in other units a power of ten stands before the unit.
METRIC = ((1e-3, "m"), (1.0, "mm"), (1e3, "µm"), (1e6, "nm"))
READABLE = (0.1, 1e4)  # largest values that need no other unit


def picture(solution: Solution, units: Units = UNITS, title: str = "") -> Figure:
    """A Matplotlib figure of the pressure and the gap, and of the shear if there is any.

    `units` are labels. The figure is not known to pyplot: save it with figure.savefig("contact.pdf"), or leave it as the last line of a
    notebook's cell.
    """
    view = _View(solution, units)
    sheared = solution.carries_shear and not solution.scene.bonded  # q between ± f p
    rows = [
        "pressure",
        "gap",
        *(["shear"] if sheared else []),
        *(["loop"] if _has_loop(solution) else []),
    ]
    figure = Figure(figsize=(WIDTH, HEIGHT * len(rows) / 2.0), dpi=DPI, layout="constrained")
    grid = figure.add_gridspec(
        len(rows), 1, height_ratios=[1.2 if name == "pressure" else 1.0 for name in rows]
    )
    upper = figure.add_subplot(grid[0])
    shared = [
        upper,
        *(figure.add_subplot(grid[k], sharex=upper) for k in range(1, 3 if sheared else 2)),
    ]
    lower = shared[-1]
    _draw_pressure(upper, view)
    _draw_gap(shared[1], view)
    if sheared:
        _draw_shear(lower, view)
    if _has_loop(solution):
        loop = figure.add_subplot(grid[-1])
        _draw_loop(loop, solution, units)
        _plain(loop)
    for axes in shared:
        for edge in solution.edges:
            axes.axvline(edge * view.factor, color=INK, linewidth=0.7, linestyle=DOTTED, zorder=2.5)
        _plain(axes)
    lower.set_xlim(view.left * view.factor, view.right * view.factor)
    lower.xaxis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 2, 2.5, 5, 10]))
    lower.set_xlabel(f"$x$ ({view.length})", fontproperties=_font())
    for axes in shared[:-1]:
        axes.tick_params(labelbottom=False)
    figure.align_ylabels()
    if title:
        figure.suptitle(
            textwrap.fill(title, TITLE_COLUMNS), fontproperties=_font(), parse_math=False
        )
    return figure


def suffixes() -> tuple[str, ...]:
    """The file suffixes that `picture_bytes` can write."""
    return tuple(sorted(set(FigureCanvasBase.get_supported_filetypes()) - NOT_OFFERED))


def picture_bytes(figure: Figure, suffix: str) -> bytes:
    """The figure as a file of the given suffix, without the time of day, so that the same picture is the same file."""
    stream = io.BytesIO()
    undated: dict[str, Any] = {
        "svg": {"Date": None},
        "svgz": {"Date": None},
        "pdf": {"CreationDate": None},
    }
    # Type 42 fonts are what journals accept; the settings hold for this file only.
    with matplotlib.rc_context({"pdf.fonttype": 42, "ps.fonttype": 42, "svg.hashsalt": "sie"}):
        figure.savefig(stream, format=suffix, dpi=DPI, metadata=undated.get(suffix))
    return stream.getvalue()


# -- what is drawn -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _View:
    """A solution on the abscissae of the window; lengths and pressures in the scene's units."""

    solution: Solution
    units: Units

    @cached_property
    def x(self) -> Array:
        return abscissae(self.solution, POINTS)

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
    def cut(self) -> list[float]:
        """Where the pressure rises above it."""
        return [s.x for s in summits(self.solution) if s.p > self.shown * (1.0 + 1e-9)]

    @cached_property
    def highest(self) -> float:
        """The largest gap to be drawn. A flat punch has none, but its picture needs a height: P/E* is the scale of displacements."""
        return float(self.unloaded.max()) or self.solution.normal_load / self.solution.scene.Estar

    @property
    def left(self) -> float:
        return self.solution.edges[0] - REACH * self.solution.half_width

    @property
    def right(self) -> float:
        return self.solution.edges[1] + REACH * self.solution.half_width

    @property
    def factor(self) -> float:
        """From the scene's unit of length to that of the axis."""
        return _scaled(self.solution.half_width, self.units.length)[0]

    @property
    def length(self) -> str:
        return _scaled(self.solution.half_width, self.units.length)[1]


def _draw_pressure(axes: Axes, view: _View) -> None:
    (x1, x2), (scale, stress) = view.solution.edges, _scaled(view.shown, view.units.stress)
    x = view.x[(view.x >= x1) & (view.x <= x2)]
    # What rises above the panel is cut off by it, but an infinite value would not be drawn at all.
    p = np.minimum(view.solution.pressure(x), 4.0 * view.shown)
    top = HEADROOM * view.shown * scale
    axes.fill_between(x * view.factor, p * scale, color=PALE_BLUE, linewidth=0.0, zorder=2)
    axes.plot(
        x * view.factor,
        p * scale,
        color=BLUE,
        linewidth=1.2,
        solid_joinstyle="round",
        zorder=3,
        label="pressure",
    )
    axes.set_ylim(0.0, top)
    axes.set_yticks(_ticks(top))
    axes.set_ylabel(f"$p$ ({stress})", fontproperties=_font())
    _mark_peak(axes, view, scale)
    _label_peak(axes, view)
    _label_edges(axes, view)


def _draw_gap(axes: Axes, view: _View) -> None:
    scale, length = _scaled(view.highest, view.units.length)
    top = 1.08 * view.highest * scale
    axes.axhspan(-GROUND * top, 0.0, color=HALF_PLANE, linewidth=0.0, zorder=0)
    axes.axhline(0.0, color=INK, linewidth=0.6, zorder=2)
    axes.fill_between(
        view.x * view.factor,
        view.loaded * scale,
        2.0 * top,
        color=INDENTER,
        linewidth=0.0,
        zorder=0,
    )
    before = "$h(x)$, unloaded" if view.solution.tilt == 0.0 else "$h(x)$ + tilt, unloaded"
    _draw_surface(
        axes,
        view,
        view.unloaded * scale,
        color=INK,
        linewidth=0.8,
        linestyle=DASHED,
        zorder=4,
        label=before,
    )
    _draw_surface(
        axes,
        view,
        view.loaded * scale,
        color=VERMILLION,
        linewidth=1.3,
        zorder=3,
        label="under load",
    )
    axes.set_ylim(-GROUND * top, top)
    axes.set_yticks(_ticks(top))
    axes.set_ylabel(f"gap ({length})", fontproperties=_font())
    # Above the panel, where no curve can pass through it.
    place: dict[str, Any] = {
        "loc": "lower center",
        "bbox_to_anchor": (0.5, 1.0),
        "borderaxespad": 0.1,
    }
    axes.legend(**place, ncols=2, prop=_font(SMALL), frameon=False, handlelength=2.4)
    _name_bodies(axes, view)


def _draw_shear(axes: Axes, view: _View) -> None:
    """q between ± f p; where |q| would leave the panel (sharp edges) it is cut like the pressure."""
    solution, (x1, x2) = view.solution, view.solution.edges
    f, largest = solution.scene.friction, solution.scene.friction * view.shown
    scale, stress = _scaled(largest, view.units.stress)
    inner = [end for lo, hi in solution.stick for end in (lo, hi)]
    x = np.unique(np.concatenate((view.x[(view.x >= x1) & (view.x <= x2)], inner)))
    limit = np.minimum(f * solution.pressure(x), 4.0 * largest)
    q = np.clip(solution.shear(x), -4.0 * largest, 4.0 * largest)
    for k, (lo, hi) in enumerate(solution.stick):
        axes.axvspan(
            lo * view.factor,
            hi * view.factor,
            color=PALE_BLUE,
            linewidth=0.0,
            zorder=0,
            label="" if k else "stick",
        )
    both = bool(
        q.min() < -1e-9 * largest
    )  # below an axis that ends under 0 the other limit would show two stubs
    for sign, label in ((1.0, r"$\pm f p$" if both else "$f p$"), (-1.0, ""))[: 1 + both]:
        axes.plot(
            x * view.factor,
            sign * limit * scale,
            color=INK,
            linewidth=0.8,
            linestyle=DASHED,
            zorder=2,
            label=label,
        )
    axes.plot(
        x * view.factor,
        q * scale,
        color=VERMILLION,
        linewidth=1.3,
        solid_joinstyle="round",
        zorder=3,
        label="$q$",
    )
    axes.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
    top = HEADROOM * largest * scale
    axes.set_ylim(-top if both else min(-0.1 * top, 0.0), top)
    axes.set_ylabel(f"$q$ ({stress})", fontproperties=_font())
    place: dict[str, Any] = {
        "loc": "lower center",
        "bbox_to_anchor": (0.5, 1.0),
        "borderaxespad": 0.1,
    }
    axes.legend(**place, ncols=3, prop=_font(SMALL), frameon=False, handlelength=2.0)


def _has_loop(solution: Solution) -> bool:
    """Whether there is a path of more than one point at constant P, over which something slips."""
    if not isinstance(solution, PathSolution) or len(solution.history) < 2 or not solution.sheared:
        return False
    loads = solution.history.path.points
    return len({P for P, _, _ in loads}) == 1 and any(Q != 0.0 for _, Q, _ in loads)


def _draw_loop(axes: Axes, solution: Solution, units: Units) -> None:
    assert isinstance(solution, PathSolution)
    history = solution.history
    path = Path([(history.path.points[0][0], 0.0, 0.0), *history.path.points]).subdivided(
        LOOP_POINTS
    )
    shift = np.array(
        [point.shift for point in follow(history.scene, path, history.tol, history.economy)]
    )
    Q = np.array(path.points)[:, 1]
    (along, length), (up, force) = (
        _scaled(float(np.abs(shift).max()) or 1.0, units.length),
        _scaled(float(np.abs(Q).max()), units.force),
    )
    axes.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
    axes.axvline(0.0, color=INK, linewidth=0.6, zorder=1)
    axes.plot(shift * along, Q * up, color=BLUE, linewidth=1.2, solid_joinstyle="round", zorder=3)
    dots = slice(LOOP_POINTS, None, LOOP_POINTS)
    axes.plot(shift[dots] * along, Q[dots] * up, "o", color=BLUE, markersize=2.2, zorder=4)
    axes.plot(shift[-1:] * along, Q[-1:] * up, "o", color=VERMILLION, markersize=3.0, zorder=5)
    axes.set_xlabel(f"shift of the indenter by slip ({length})", fontproperties=_font())
    axes.set_ylabel(f"$Q$ ({force})", fontproperties=_font())


def _draw_surface(axes: Axes, view: _View, y: Array, **style: Any) -> None:
    """The indenter's surface, with a vertical side where the indenter ends inside the window."""
    lo, hi = view.solution.scene.profile.domain
    x, wall = view.x, [4.0 * view.highest * _scaled(view.highest, view.units.length)[0]]
    corners = view.solution.scene.profile.ends_are_corners  # a trace just ends
    if view.left < lo and corners[0]:
        x, y = np.concatenate((x[:1], x)), np.concatenate((wall, y))
    if view.right > hi and corners[1]:
        x, y = np.concatenate((x, x[-1:])), np.concatenate((y, wall))
    axes.plot(x * view.factor, y, solid_joinstyle="round", **style)


# -- labels ------------------------------------------------------------------------------------------------------------


def _mark_peak(axes: Axes, view: _View, scale: float) -> None:
    """Dots on the peak, or arrows where the panel cuts the pressure."""
    frame = axes.get_xaxis_transform()
    for x in view.cut:
        axes.annotate(
            "", (x * view.factor, 1.0), (x * view.factor, 0.87), xycoords=frame, arrowprops=ARROW
        )
    if not view.cut:
        largest, where = peak(view.solution)
        axes.plot(
            np.array(where) * view.factor,
            np.full(len(where), largest * scale),
            "o",
            color=BLUE,
            markersize=2.2,
            zorder=4,
        )


def _label_peak(axes: Axes, view: _View) -> None:
    """The peak in words, in the headroom above it: towards the middle of the panel, and beside the arrow if there is one."""
    largest, where = peak(view.solution)
    text = (
        rf"$p_{{\max}}$ = {_quantity(largest, largest, view.units.stress)}"
        if math.isfinite(largest)
        else r"$p \to \infty$"
    )
    place = (0.5 * (min(where) + max(where)) - view.left) / (view.right - view.left)
    beside = 0.03 if view.cut and len(where) == 1 else 0.0
    side = (
        "left"
        if place < (0.6 if beside else 0.35)
        else "right"
        if place > (0.6 if beside else 0.65)
        else "center"
    )
    shift = {"left": beside, "right": -beside, "center": 0.0}[side]
    axes.text(
        place + shift,
        0.97,
        text,
        transform=axes.transAxes,
        ha=side,
        va="top",
        color=BLUE,
        fontproperties=_font(SMALL),
    )


def _label_edges(axes: Axes, view: _View) -> None:
    frame = axes.get_xaxis_transform()
    for name, edge in zip(("x_1", "x_2"), view.solution.edges, strict=True):
        text = f"${name}$ = {_quantity(edge, view.solution.half_width, view.units.length)}"
        axes.text(
            edge * view.factor,
            1.02,
            text,
            transform=frame,
            ha="center",
            va="bottom",
            fontproperties=_font(SMALL),
        )


def _name_bodies(axes: Axes, view: _View) -> None:
    """The indenter's name stands where the unloaded surface leaves most room."""
    bottom, top = axes.get_ylim()
    centre = view.solution.centre
    places = centre + view.solution.half_width * np.array([0.0, -0.6, 0.6])
    freest = places[int(np.argmin(np.interp(places, view.x, view.unloaded)))]
    for text, x, y in (("half-plane", centre, 0.5 * bottom), ("indenter", freest, 0.72 * top)):
        axes.text(
            x * view.factor,
            y,
            text,
            ha="center",
            va="center",
            color=INK,
            style="italic",
            fontproperties=_font(SMALL),
            zorder=5,
        )


# -- axes --------------------------------------------------------------------------------------------------------------


def _plain(axes: Axes) -> None:
    """Thin lines, none where nothing is read off."""
    axes.tick_params(
        labelsize=SMALL, labelfontfamily=FAMILY, width=0.6, length=2.5, direction="out"
    )
    for name, spine in axes.spines.items():
        spine.set_visible(name in ("left", "bottom"))
        spine.set_linewidth(0.6)
    axes.ticklabel_format(axis="x", useMathText=True)
    axes.xaxis.get_offset_text().set_fontproperties(_font(SMALL))


def _ticks(top: float) -> list[float]:
    """Round numbers from 0 up: there are no negative pressures and gaps."""
    ticks = MaxNLocator(nbins=4, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, top)
    return [float(t) for t in ticks if 0.0 <= t <= top]


def _font(size: float = SIZE) -> FontProperties:
    return FontProperties(family=FAMILY, size=size, math_fontfamily="stix")


def _quantity(value: float, scale: float, unit: str) -> str:
    """A value with its unit, to DIGITS significant digits of `scale`."""
    factor, name = _scaled(scale, unit)
    decimals = max(DIGITS - 1 - math.floor(math.log10(scale * factor)), 0)
    number = f"{value * factor + 0.0:.{decimals}f}".replace("-", "−")
    return rf"{number} $\times$ {name}" if name.startswith("$") else f"{number} {name}"


def _scaled(largest: float, unit: str) -> tuple[float, str]:
    """(factor, unit) in which a quantity up to `largest` has readable numbers.

    >>> _scaled(0.02, "mm"), _scaled(3e7, "MPa")
    ((1000.0, 'µm'), (1e-06, '$10^{6}$ MPa'))
    """
    low, high = READABLE
    for factor, name in ((1.0, unit), *(METRIC if unit == "mm" else ())):
        if low <= largest * factor < high:
            return factor, name.replace("$", r"\$")
    exponent = 3 * math.floor(math.log10(largest) / 3.0)
    return float(f"1e{-exponent}"), f"$10^{{{exponent}}}$ " + unit.replace("$", r"\$")
