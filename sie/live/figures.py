"""The five pictures of the page as Bokeh figures, empty: the page's script fills their sources.

A caption of HTML stands above each: it wraps on a narrow screen.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.embed import json_item
from bokeh.models import BasicTickFormatter, ColumnDataSource, LinearColorMapper
from bokeh.models.annotations.legends import ColorBar
from bokeh.palettes import viridis
from bokeh.plotting import figure

from .setting import NODES

TOOLS = "pan,wheel_zoom,box_zoom,reset,save"
PRESSURE, SHEAR, GHOST, YIELD = "#4477aa", "#ee6677", "#999999", "#ff2255"
HEIGHT = 300
DECIMALS = -5  # the smallest power of ten that an axis writes without an exponent


def items() -> dict[str, Any]:
    """Each picture as what Bokeh's script embeds, by the name of its place on the page."""
    drawn = {
        "punch": _punch,
        "pressure": _pressure,
        "shear": _shear,
        "stress": _stress,
        "errors": _errors,
    }
    return {name: json_item(draw()) for name, draw in drawn.items()}


def _figure(x: str, y: str, **given: Any) -> Any:
    drawn = figure(
        x_axis_label=x,
        y_axis_label=y,
        height=HEIGHT,
        sizing_mode="stretch_width",
        tools=TOOLS,
        active_drag=None,  # a finger on the picture scrolls the page
        output_backend="canvas",
        **given,
    )
    if "y_axis_type" not in given:
        drawn.yaxis.formatter = BasicTickFormatter(power_limit_low=DECIMALS)
    drawn.toolbar.logo = None
    drawn.toolbar.autohide = True
    return drawn


def _ranged(x: str, y: str) -> Any:
    return _figure(x, y, x_range=(0, 1), y_range=(0, 1))


def _source(name: str, *columns: str) -> Any:
    return ColumnDataSource({column: [] for column in columns}, name=name)


def _punch() -> Any:
    drawn = _ranged("x", "height")
    drawn.patch("x", "y", source=_source("body", "x", "y"), color="#66aadd", alpha=0.4)
    drawn.patch("x", "y", source=_source("punch", "x", "y"), color="#888888", alpha=0.6)
    drawn.multi_line(
        "xs", "ys", source=_source("zones", "xs", "ys", "color"), color="color", line_width=5
    )
    arrows = _source("arrows", "x0", "y0", "x1", "y1", "angle", "color", "label", "x", "y")
    drawn.segment("x0", "y0", "x1", "y1", source=arrows, color="color", line_width=3)
    drawn.scatter(
        "x1", "y1", source=arrows, marker="triangle", angle="angle", size=13, color="color"
    )
    drawn.text(
        "x", "y", text="label", source=arrows, text_color="color", x_offset=5, y_offset=-3,
        text_font_style="bold",
    )  # fmt: skip
    return drawn


def _pressure() -> Any:
    drawn = _ranged("x", "p")
    source = _source("contact", "x", "p")
    drawn.line("x", "p", source=_source("ghost", "x", "p"), color=GHOST, line_width=1.5)
    drawn.varea("x", y1=0, y2="p", source=source, color=PRESSURE, alpha=0.25)
    drawn.line("x", "p", source=source, color=PRESSURE, line_width=2)
    return drawn


def _shear() -> Any:
    drawn = _ranged("x", "q")
    source = _source("contact", "x", "q", "fp", "minus")
    drawn.line("x", "q", source=_source("ghost", "x", "q"), color=GHOST, line_width=1.5)
    for bound in ("fp", "minus"):
        drawn.line("x", bound, source=source, color=GHOST, line_dash="dashed")
    drawn.line("x", "q", source=source, color=SHEAR, line_width=2)
    drawn.segment(
        x0="lo", x1="hi", y0=0, y1=0, color="color", line_width=5,
        source=_source("bars", "lo", "hi", "color"),
    )  # fmt: skip
    return drawn


def _stress() -> Any:
    drawn = _ranged("x", "depth y")
    # The script puts a larger array of the same kind in place of this one.
    blank = ColumnDataSource(
        {"levels": [np.zeros((2, 2), np.uint8)], "x": [0], "y": [0], "dw": [0], "dh": [0]},
        name="levels",
    )
    colours = viridis(256)
    drawn.image(
        "levels", x="x", y="y", dw="dw", dh="dh", source=blank,
        color_mapper=LinearColorMapper(palette=colours, low=0, high=255),
    )  # fmt: skip
    scale = LinearColorMapper(palette=colours, low=0, high=1)
    ticks = BasicTickFormatter(power_limit_low=DECIMALS)
    bar = ColorBar(
        color_mapper=scale, formatter=ticks, width=12, padding=4, background_fill_alpha=0
    )
    drawn.add_layout(bar, "right")
    drawn.scatter(
        "x", "y", source=_source("weakest", "x", "y"), marker="x", size=14, color=YIELD,
        line_width=3,
    )  # fmt: skip
    return drawn


def _errors() -> Any:
    drawn = _figure(
        "n", "error of p over its peak", x_axis_type="log", y_axis_type="log", x_range=(3, 160),
        y_range=(1e-17, 1),
    )  # fmt: skip
    drawn.xaxis.ticker = list(NODES)
    drawn.yaxis.ticker.num_minor_ticks = 0
    source = _source("errors", "n", "error", "certificate")
    drawn.line("n", "error", source=source, color=PRESSURE, line_width=2)
    drawn.scatter("n", "error", source=source, color=PRESSURE, size=7)
    drawn.line("n", "certificate", source=source, color="#228833", line_dash="dashed", line_width=2)
    return drawn
