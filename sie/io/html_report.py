"""Solutions and histories as a notebook shows them: a table, and a picture where there is one.

The units are the labels that scene files have by default; nothing is converted.
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterable
from html import escape
from typing import Any

from sie.errors import ContactError
from sie.paths.history import History
from sie.solution import Solution

from .report import edge_rows, peak_rows, shear_rows
from .scene_file import UNITS

WIDTH = "3.35in"
CELL = '<td style="text-align:left">{}</td>'
LABELS = f"in {UNITS.length}, {UNITS.force}, {UNITS.stress}, or other consistent units"
MANY = 20  # rows of points; of more the first and the last ones are shown
HEADS = {
    "normal_load": "P",
    "tangential_load": "Q",
    "bulk_stress": "σ",
    "energy_lost": "energy lost",
}


def html(solution: Solution) -> str:
    """The table and the picture; the sentence of the refusal for a scene without an answer."""
    return _shown(solution.scene, lambda: _of_solution(solution))


def history_html(history: History) -> str:
    """The turning points and the loop."""

    def content() -> str:
        return _points(history) + _picture(_loop, history)

    return _shown(history, content)


def _shown(owner: Any, content: Callable[[], str]) -> str:
    try:
        return f"<div>{content()}</div>"
    except ContactError as error:
        return f"<div>{escape(repr(owner))}<br>{escape(str(error))}</div>"


# -- tables ----------------------------------------------------------------------------------------


def _table(rows: Iterable[Iterable[str]]) -> str:
    lines = ("".join(CELL.format(escape(cell)) for cell in row) for row in rows)
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table><small>{LABELS}</small>"


def _points(history: History) -> str:
    """Numbered rows of the points: all of a few, else the first and the last ones."""
    count, half = len(history), MANY // 2
    numbers = range(count) if count <= MANY else [*range(half), *range(count - half, count)]
    rows = {k: history.row(k) for k in numbers}
    names = list(dict.fromkeys(name for values in rows.values() for name in values))
    cells = [[str(k), *(_cell(values.get(n, "")) for n in names)] for k, values in rows.items()]
    if count > MANY:
        cells.insert(half, [f"... {count - MANY} more", *[""] * len(names)])
    return _table([["point", *(HEADS.get(name, name) for name in names)], *cells])


def _cell(value: float | str | list[Any]) -> str:
    if isinstance(value, list):
        return "; ".join(f"{lo:.6g} to {hi:.6g}" for lo, hi in value) or "none"
    return value if isinstance(value, str) else f"{value + 0.0:.6g}"


def _of_solution(solution: Solution) -> str:
    check = solution.check()
    rows = [*edge_rows(solution, UNITS), *peak_rows(solution, UNITS)]
    rows += shear_rows(solution, UNITS) if solution.carries_shear else []
    rows.append(("certificate", f"{'met' if check.ok else 'NOT met'}: {check.error:.1e}"))
    return _table(rows) + _picture(_contact, solution)


# -- pictures --------------------------------------------------------------------------------------


def _contact(solution: Solution) -> Any:
    from sie.plots.contact_plot import picture  # noqa: PLC0415 -- a higher layer

    return picture(solution)


def _loop(history: History) -> Any:
    from sie.plots.loop_plot import loop_along  # noqa: PLC0415 -- a higher layer

    return history.plot() if loop_along(history) else None


def _picture(draw: Callable[[Any], Any], what: Any) -> str:
    """What draws itself in a notebook; nothing without Matplotlib, or where there is none."""
    try:
        drawn = draw(what)
    except ImportError:
        return ""
    if drawn is None:
        return ""
    data = base64.b64encode(drawn._repr_png_()).decode()
    return f'<br><img style="width:{WIDTH}" src="data:image/png;base64,{data}">'
