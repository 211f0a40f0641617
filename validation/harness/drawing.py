"""Drawing, separate from computing: Matplotlib figures in one style, as SVG inside a page.

Figures have the width of a phone, so that their text is readable there.
"""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from validation.harness.records import Curve, Map

WIDTH, HEIGHT = 5.0, 3.7  # inches, as are all that follow
LETTER, LINE, MARGIN = 0.083, 0.22, 0.15  # of a letter, of a line of them, of what stays free
HEAD, FOOT = 0.28, 0.5  # of a title, of tick labels and a label
STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "validation",
    "font.family": "sans-serif",
    "font.size": 9.5,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "grid.linewidth": 0.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.0,
    "legend.fontsize": 8,
    "legend.frameon": False,
}
MARKERS = "osD^vP*X<>hp"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Figure:
    """A drawing with its caption: the quantity, the units and the origin of each curve."""

    name: str
    drawing: Any
    caption: str


@dataclass(frozen=True)
class Drawn:
    """A figure as an SVG element."""

    name: str
    element: str
    caption: str


def drawn(figure: Figure) -> Drawn:
    return Drawn(figure.name, svg(figure), figure.caption)


def axes(
    rows: int = 1, *, height: float = HEIGHT, head: float = HEAD, foot: float = FOOT
) -> tuple[Any, Any]:
    """A Matplotlib figure with `rows` panels one below the other, and its axes (one, or an array).

    `head` and `foot` are the room above and below each panel.
    """
    import matplotlib  # noqa: PLC0415 -- an extra: only the report needs it
    from matplotlib.figure import Figure as Drawing  # noqa: PLC0415

    with matplotlib.rc_context(STYLE):
        drawing = Drawing(figsize=(WIDTH, height * rows))
        whole = height * rows
        drawing.subplots_adjust(
            top=1 - head / whole, bottom=foot / whole, hspace=(head + foot) / (height - head - foot)
        )
        return drawing, drawing.subplots(rows)


def _margins(drawing: Any) -> None:
    """Room for the labels on both sides, by counting letters.

    Matplotlib's own layouts take half the time of a figure to measure them.
    """
    room = {"left": MARGIN, "right": MARGIN}
    for axis in (ax.yaxis for ax in drawing.axes):
        ticks = axis.get_major_formatter().format_ticks(axis.get_majorticklocs())
        label = LINE if axis.label.get_text() else 0.0
        side = axis.get_label_position()
        room[side] = max(room[side], LETTER * max(map(len, ticks)) + label + MARGIN)
    drawing.subplots_adjust(left=room["left"] / WIDTH, right=1.0 - room["right"] / WIDTH)


def labelled(ax: Any, x: str, y: str, title: str = "", log: str = "") -> None:
    """Axis labels with units, logarithmic axes ("x", "y", "xy"), grid and title."""
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    ax.set_title(title, fontsize=9.5, loc="left")
    ax.grid(visible=True, alpha=0.3, linewidth=0.5)
    ax.spines[["top", "right"]].set_visible(False)
    for name, axis in (("x", ax.xaxis), ("y", ax.yaxis)):
        if name in log:
            _decades(ax, name, axis)


def _decades(ax: Any, name: str, axis: Any) -> None:
    """A logarithmic axis with ticks at powers of ten, or at 1, 2, 5 of a few.

    The ticks are plain text, which costs a hundredth of Matplotlib's formulas.
    """
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator  # noqa: PLC0415

    (ax.set_xscale if name == "x" else ax.set_yscale)("log")
    low, high = axis.get_view_interval()
    axis.set_major_locator(
        LogLocator(
            subs=(1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,), numticks=7 if name == "x" else 9
        )
    )
    axis.set_major_formatter(FuncFormatter(tick))
    axis.set_minor_locator(NullLocator())


def tick(value: float, _: int = 0) -> str:
    """10⁻⁵ of 1e-5, 2·10⁻⁵ of 2e-5; 0.2, 1, 50 as they are."""
    if 0.01 <= value < 1000.0:
        return f"{value:g}"
    digits, exponent = f"{value:.0e}".split("e")
    power = "10" + str(int(exponent)).translate(SUPERSCRIPTS)
    return power if digits == "1" else f"{digits}·{power}"


def draw(
    ax: Any, curves: Sequence[Curve], *, colour: Any = None, floor: float | None = None
) -> None:
    """Draw each curve in its style; values below `floor`, zero included, are drawn on it."""
    for k, curve in enumerate(curves):
        y = np.array(curve.y, dtype=float)
        y = y if floor is None else np.maximum(y, floor)
        marker = MARKERS[k % len(MARKERS)]
        shape = {"line": "-", "points": marker, "both": f"{marker}-", "dashed": "--"}[curve.style]
        strong = curve.about.get("strong", False)
        ax.plot(
            curve.x, y, shape, label=curve.label or None, color=curve.about.get("colour", colour),
            mew=0.9, ms=7 if strong else 4,
            mfc=None if strong else "none", zorder=3 if strong else 2,
        )  # fmt: skip


def legend(ax: Any, **options: Any) -> None:
    ax.legend(fontsize=8, frameon=False, handlelength=1.6, **options)


def legend_above(ax: Any, columns: int) -> None:
    """The legend of many curves, above the axes, where it hides none.

    The `head` of the axes has room for its lines.
    """
    ax.legend(
        fontsize=8,
        frameon=False,
        handlelength=1.6,
        ncols=columns,
        loc="lower center",
        bbox_to_anchor=(0.4, 1.0),
    )


def heat(ax: Any, found: Map, *, low: float = -17, high: float = 0, label: str) -> None:
    """A map of decimal logarithms."""
    values = np.log10(np.maximum(np.array(found.values, dtype=float), 10.0**low))
    mesh = ax.pcolormesh(
        found.x,
        found.y,
        values,
        cmap="viridis",
        vmin=low,
        vmax=high,
        shading="nearest",
        rasterized=False,
    )
    bar = ax.figure.colorbar(mesh, ax=ax, label=label, pad=0.02)
    # Without this Matplotlib puts a bitmap into the page.
    bar.solids.set(rasterized=False, edgecolor="face")


def svg(figure: Figure) -> str:
    """The drawing as an <svg> element whose names no other figure on the page shares."""
    import matplotlib  # noqa: PLC0415
    from matplotlib.backends.backend_svg import FigureCanvasSVG  # noqa: PLC0415

    text = io.StringIO()
    with matplotlib.rc_context(STYLE):
        _margins(figure.drawing)
        canvas: Any = FigureCanvasSVG(figure.drawing)  # `savefig` would draw it twice again
        canvas.print_svg(
            text, metadata={"Date": None, "Creator": None, "Format": None, "Type": None}
        )
    element = text.getvalue()
    element = element[element.index("<svg") :]
    element = re.sub(r"<metadata>.*?</metadata>", "", element, flags=re.DOTALL)
    element = re.sub(r'(\bid="|url\(#|href="#)', rf"\g<1>{figure.name}-", element)
    element = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", element, count=1)
    return re.sub(
        r'(<svg[^>]*?) height="[^"]*"',
        lambda m: f'{m[1]} role="img" aria-label="{escape(figure.caption)}"',
        element,
        count=1,
    )
