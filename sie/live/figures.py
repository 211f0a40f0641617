"""The four pictures of the page as Bokeh figures, empty: the page's script fills their sources."""

from __future__ import annotations

from typing import Any

import numpy as np

from .controls import ACROSS, BANDS, DOWN

TOOLS = "pan,wheel_zoom,box_zoom,reset,save"


def items() -> dict[str, Any]:
    """Each picture as what Bokeh's script embeds, by the name of its place on the page."""
    # Imported here: it takes a second, and only this page needs it.
    from bokeh.embed import json_item  # noqa: PLC0415

    pictures = {
        "pressure": _pressure(),
        "shear": _shear(),
        "stress": _stress(),
        "errors": _errors(),
    }
    return {name: json_item(figure) for name, figure in pictures.items()}


def _figure(title: str, x: str, y: str, **given: Any) -> Any:
    from bokeh.plotting import figure  # noqa: PLC0415

    drawn = figure(
        title=title,
        x_axis_label=x,
        y_axis_label=y,
        height=300,
        sizing_mode="stretch_width",
        tools=TOOLS,
        output_backend="canvas",
        **given,
    )
    drawn.toolbar.logo = None
    drawn.toolbar.autohide = True
    return drawn


def _source(name: str, **columns: list[Any]) -> Any:
    from bokeh.models import ColumnDataSource  # noqa: PLC0415

    return ColumnDataSource(columns, name=name)


def _pressure() -> Any:
    drawn = _figure("pressure", "x", "p", y_range=(0, 1))
    source = _source("contact", x=[], p=[], q=[], fp=[])
    drawn.varea("x", y1=0, y2="p", source=source, color="#4477aa", alpha=0.25)
    drawn.line("x", "p", source=source, color="#4477aa", line_width=2)
    return drawn


def _shear() -> Any:
    drawn = _figure("shear; bar: stick; dashed: ± f p", "x", "q", y_range=(-1, 1))
    source = _source("contact", x=[], p=[], q=[], fp=[], minus=[])
    for bound in ("fp", "minus"):
        drawn.line("x", bound, source=source, color="#999999", line_dash="dashed")
    drawn.line("x", "q", source=source, color="#ee6677", line_width=2)
    drawn.segment(
        x0="lo", x1="hi", y0=0, y1=0, color="#228833", line_width=6,
        source=_source("stick", lo=[], hi=[]),
    )  # fmt: skip
    return drawn


def _stress() -> Any:
    from bokeh.models import LinearColorMapper  # noqa: PLC0415
    from bokeh.palettes import viridis  # noqa: PLC0415

    drawn = _figure("Mises stress; ×: first yield", "x", "depth y", match_aspect=True)
    drawn.y_range.flipped = True
    blank = _source(
        "bands", bands=[np.zeros((DOWN, ACROSS), np.uint8)], x=[0], y=[0], dw=[1], dh=[1]
    )
    drawn.image(
        "bands", x="x", y="y", dw="dw", dh="dh",
source=blank,
        color_mapper=LinearColorMapper(palette=viridis(BANDS), low=0, high=BANDS - 1),
    )  # fmt: skip
    drawn.scatter(
        "x", "y", source=_source("weakest", x=[], y=[]), marker="x", size=12, color="white",
        line_width=3,
    )  # fmt: skip
    return drawn


def _errors() -> Any:
    drawn = _figure(
        "error of textbook collocation, n nodes", "n", "error of p / peak",
        x_axis_type="log", y_axis_type="log",
    )  # fmt: skip
    source = _source("errors", n=[], error=[], certificate=[])
    drawn.line("n", "error", source=source, color="#4477aa", line_width=2)
    drawn.scatter("n", "error", source=source, color="#4477aa", size=7)
    drawn.line(
        "n", "certificate", source=source, color="#228833", line_dash="dashed", line_width=2,
        legend_label="certificate of this answer",
    )  # fmt: skip
    drawn.legend.location = "center"
    return drawn
