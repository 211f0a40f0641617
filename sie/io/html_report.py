"""A solution as a notebook shows it: a small table, and the picture where Matplotlib is installed.

The units are the labels that scene files have by default; nothing is converted.
"""

from __future__ import annotations

import base64
from html import escape
from typing import Any

from sie.errors import ContactError
from sie.messages import NAMES
from sie.solution import Solution

from .report import edges_summary, peak_summary, shear_summary
from .scene_file import UNITS

WIDTH = "3.35in"
CELL = '<tr><td style="text-align:left">{}</td><td style="text-align:left">{}</td></tr>'
LABELS = f"in {UNITS.length}, {UNITS.force}, {UNITS.stress}, or other consistent units"


def html(solution: Solution) -> str:
    """The table and the picture; the sentence of the refusal for a scene without an answer."""
    try:
        return f"<div>{_table(solution)}{_picture(solution)}</div>"
    except ContactError as error:
        return f"<div>{escape(repr(solution.scene))}<br>{escape(str(error))}</div>"


def _table(solution: Solution) -> str:
    sections = [edges_summary(solution, UNITS), peak_summary(solution, UNITS)]
    sections += [shear_summary(solution, UNITS)] if solution.carries_shear else []
    check = solution.check()
    sections.append(
        f"{'certificate':<{NAMES}}{'met' if check.ok else 'NOT met'}: {check.error:.1e}"
    )
    lines = "\n".join(section.partition("\n\n")[0] for section in sections).splitlines()
    rows = [CELL.format(escape(line[:NAMES].strip()), escape(line[NAMES:])) for line in lines]
    return f"<table>{''.join(rows)}</table><small>{LABELS}</small>"


def _picture(solution: Solution) -> str:
    try:
        from sie.plots.contact_plot import picture  # noqa: PLC0415 -- a higher layer
    except ImportError:
        return ""
    drawn: Any = picture(solution)  # whose figure draws itself in a notebook
    data = base64.b64encode(drawn._repr_png_()).decode()
    return f'<br><img style="width:{WIDTH}" src="data:image/png;base64,{data}">'
