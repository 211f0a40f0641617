"""The style of all pictures (sizes, colours, fonts, axes and units), and their files."""

from __future__ import annotations

import io
import math
import textwrap
import warnings
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

Array = NDArray[np.float64]
Patches = tuple[tuple[float, float], ...]

WIDTH, DPI = 3.35, 300  # inches, one column of a journal
POINTS = 1201  # of a curve
FEW = 6  # patches, of which every edge is marked
# Suffixes that need a TeX installation, or that no program opens.
NOT_OFFERED = {"pgf", "raw", "rgba"}
UNDATED: dict[str, dict[str, Any]] = {
    "svg": {"Date": None},
    "svgz": {"Date": None},
    "pdf": {"CreationDate": None},
}
# Type 42 fonts are what journals accept.
FILES: Any = {"pdf.fonttype": 42, "ps.fonttype": 42, "svg.hashsalt": "sie"}

# Fonts that come with Matplotlib; the later ones have the letters that the first lacks.
FAMILY = ["STIXGeneral", "DejaVu Serif", "DejaVu Sans"]
SIZE, SMALL = 8.0, 7.0
TITLE_COLUMNS = 16.5  # letters of a title in an inch
# Okabe and Ito (2008): distinct for the colour-blind, and in greyscale by their lightness. Opaque,
# as PostScript has no transparency.
BLUE, PALE_BLUE, VERMILLION, INK = "#0072B2", "#cfe4f0", "#D55E00", "#222222"
DASHED, DOTTED = (0, (5, 2.5)), (0, (1, 2))
HEADROOM = 1.22  # of a panel over the largest value that it shows: for the label
ROUND = [1, 2, 2.5, 5, 10]  # steps of ticks

DIGITS = 4
# A length in mm may be given in these; other units are preceded by a power of ten.
METRIC = ((1e-3, "m"), (1.0, "mm"), (1e3, "µm"), (1e6, "nm"))
READABLE = (0.1, 1e4)  # largest values that need no other unit


class Picture(Figure):
    """A figure of this package, which a notebook shows."""

    def __init__(self, height: float, width: float = WIDTH) -> None:
        super().__init__(figsize=(width, height), dpi=DPI, layout="constrained")

    def _repr_png_(self) -> bytes:
        return picture_bytes(self, "png")


class ShownAxes(Axes):
    """Axes of a figure of their own, which a notebook shows."""

    def _repr_png_(self) -> bytes:
        assert isinstance(self.figure, Picture)
        return self.figure._repr_png_()


def title_lines(title: str, width: float) -> list[str]:
    """The lines of a title over a picture of so many inches."""
    return textwrap.wrap(title, round(width * TITLE_COLUMNS))


def suffixes() -> tuple[str, ...]:
    """The file suffixes that `picture_bytes` can write."""
    return tuple(sorted(set(FigureCanvasBase.get_supported_filetypes()) - NOT_OFFERED))


def picture_bytes(figure: Figure, suffix: str) -> bytes:
    """The figure as a file of that suffix, without a date: the same picture is the same file."""
    stream = io.BytesIO()
    # For this file only; letters of a title that no font has are drawn as boxes
    with matplotlib.rc_context(FILES), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        figure.savefig(stream, format=suffix, dpi=DPI, metadata=UNDATED.get(suffix))
    return stream.getvalue()


def heading(figure: Figure, title: str) -> None:
    """The title over the panels, in as many lines as it needs, its $ as they are."""
    if title:
        text = "\n".join(title_lines(title, figure.get_figwidth()))
        figure.suptitle(text, fontproperties=font(), parse_math=False)


def curve(axes: Axes, x: Array, y: Array, color: str, width: float, **given: Any) -> None:
    """A line with round joints."""
    axes.plot(x, y, color=color, linewidth=width, solid_joinstyle="round", **given)


def zero_line(axes: Axes, zorder: float = 1) -> None:
    """A thin line at zero."""
    axes.axhline(0.0, color=INK, linewidth=0.6, zorder=zorder)


def edge_lines(axes: Axes, patches: Patches, factor: float, zorder: float) -> None:
    """Dotted lines at the edges of the patches; of many patches, at the outermost two."""
    edges = np.ravel(patches)
    for edge in edges if len(patches) <= FEW else edges[[0, -1]]:
        axes.axvline(edge * factor, color=INK, linewidth=0.7, linestyle=DOTTED, zorder=zorder)


def opaque(color: str) -> dict[str, Any]:
    """The ground of a label that lines pass behind."""
    return {"facecolor": color, "edgecolor": "none", "pad": 0.8}


def legend(axes: Axes, columns: int, length: float = 2.0) -> None:
    """The legend above the panel, where no curve passes through it."""
    axes.legend(
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        borderaxespad=0.1,
        ncols=columns,
        prop=font(SMALL),
        frameon=False,
        handlelength=length,
    )


def x_axis(axes: Axes, length: str) -> None:
    """Ticks and label of the axis along the surface."""
    axes.xaxis.set_major_locator(MaxNLocator(nbins=8, steps=ROUND))
    named(axes, x=f"$x$ ({length})")


def named(axes: Axes, x: str = "", y: str = "") -> None:
    """The names of the axes."""
    if x:
        axes.set_xlabel(x, fontproperties=font())
    if y:
        axes.set_ylabel(y, fontproperties=font())


def word(axes: Axes, x: float, y: float, text: str, **given: Any) -> None:
    """A small word in a panel, in the middle of its place."""
    middle: dict[str, Any] = {"ha": "center", "va": "center", "fontproperties": font(SMALL)}
    axes.text(x, y, text, **(middle | given))


def plain(axes: Axes) -> None:
    """Thin axes on the left and at the bottom only."""
    axes.tick_params(
        labelsize=SMALL, labelfontfamily=FAMILY, width=0.6, length=2.5, direction="out"
    )
    for name, spine in axes.spines.items():
        spine.set_visible(name in ("left", "bottom"))
        spine.set_linewidth(0.6)
    axes.ticklabel_format(axis="x", useMathText=True)
    axes.xaxis.get_offset_text().set_fontproperties(font(SMALL))


def ticks(top: float) -> list[float]:
    """Round numbers from 0 up: there are no negative pressures and gaps."""
    ticks = MaxNLocator(nbins=4, steps=ROUND).tick_values(0.0, top)
    return [float(t) for t in ticks if 0.0 <= t <= top]


def font(size: float = SIZE) -> FontProperties:
    """The font of all text, formulas included."""
    return FontProperties(family=FAMILY, size=size, math_fontfamily="stix")


def quantity(value: float, scale: float, unit: str) -> str:
    """A value with its unit, to DIGITS significant digits of `scale`."""
    factor, name = scaled(scale, unit)
    decimals = max(DIGITS - 1 - math.floor(math.log10(scale * factor)), 0)
    number = f"{value * factor + 0.0:.{decimals}f}".replace("-", "−")
    return rf"{number} $\times$ {name}" if name.startswith("$") else f"{number} {name}"


def scaled(largest: float, unit: str) -> tuple[float, str]:
    """(factor, unit) in which a quantity up to `largest` has readable numbers.

    >>> scaled(0.02, "mm"), scaled(3e7, "MPa")
    ((1000.0, 'µm'), (1e-06, '$10^{6}$ MPa'))
    """
    low, high = READABLE
    for factor, name in ((1.0, unit), *(METRIC if unit == "mm" else ())):
        if low <= largest * factor < high:
            return factor, name.replace("$", r"\$")
    exponent = 3 * math.floor(math.log10(largest) / 3.0)
    return float(f"1e{-exponent}"), f"$10^{{{exponent}}}$ " + unit.replace("$", r"\$")
