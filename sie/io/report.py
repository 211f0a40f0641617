"""An answer to read: rounded to six digits, with a picture of the pressure in text."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from sie.arguments import WIDE, named_rows
from sie.problem.request import energy_costs

from .answers import energy_of, notes_of, readings_of, slipping, wanted
from .sample_points import SAME_PEAK, ceiling, full, peak, reach
from .scene_file import SceneFile, Units

if TYPE_CHECKING:
    from sie.paths.history import History
    from sie.solution import Solution

NONE: Mapping[str, Any] = {}
SAME_PLACE = 1e-7  # of the half-width: rounding of p leaves a smooth peak uncertain by as much
NOTHING = 1e-13  # of its scale: a smaller number is rounding, and is printed as 0
MANY_ZONES = 8  # so many zones of stick or slip are listed
HEIGHT, NARROWEST = 8, 20  # rows of the text picture, and its columns at least
Row = tuple[str, str]  # the name and the words of one quantity
BETWEEN = "  "  # what stands between the columns of a table


def summary(
    solution: Solution, file: SceneFile, more: Mapping[str, Any] = NONE, width: int = WIDE
) -> str:
    """All wanted quantities, section by section, with a picture of so many columns.

    `more` has the answers of `cycle_answer` and `crack_answer` by name.
    """
    scene = f"{solution.scene.profile!r}, E* = {solution.scene.Estar:.6g} {file.units.stress}"
    scene = textwrap.fill(scene, WIDE, break_long_words=False, break_on_hyphens=False)
    names = set(wanted(file))
    if "shear" in names and not energy_costs(solution.scene):
        names.discard("energy")  # it is printed with the shear
    parts: list[str] = []
    for name in (name for name in ROWS if name in names):
        parts.append(named_rows(*ROWS[name](solution, file.units)))
        if name == "pressure":
            parts.append(text_picture(solution, file.units, width))
        if name == "shear" and solution.history and solution.carries_shear:
            parts.append(_path_table(solution.history, file.units))
    if "check" in names:
        parts += map(str, (solution.check(), *solution.trace_reports()))
    if "cycle" in more:
        from .cycle_report import cycle_summary  # noqa: PLC0415

        parts.append(cycle_summary(more["cycle"], file))
    if "crack" in more:
        from .crack_answer import crack_summary  # noqa: PLC0415

        parts.append(crack_summary(more["crack"], file.units))
    printed = solution.check().notes if "check" in wanted(file) else ()
    notes = "\n".join(note for note in notes_of(solution, file) if note not in printed)
    readings = [textwrap.fill(f"trace {reading}", WIDE) for reading in readings_of(solution)]
    head = "\n".join(filter(None, [file.title, scene, *readings]))
    return "\n\n".join([head, *parts, *filter(None, [notes])])


def edge_rows(solution: Solution, units: Units) -> list[Row]:
    """Edges, width, load, moment and tilt."""
    r = solution.half_width
    x1, x2 = (
        f"{_number(x, r)} {units.length}, {'sharp' if s else 'smooth'}"
        for x, s in zip(solution.edges, solution.sharp, strict=True)
    )
    edges = f"x1 = {x1};  x2 = {x2}"
    return [
        ("edges", "none: all of the period is in contact" if full(solution) else edges),
        *_patches(solution, units),
        ("half-width", f"{_number(r)} {units.length}, centre at x = {_number(solution.centre, r)}"),
        *_loads(solution, units),
    ]


def _loads(solution: Solution, units: Units) -> tuple[Row, ...]:
    """Load, moment and tilt; of a contact that repeats, which keeps level, the load of a period."""
    r, P = solution.half_width, solution.normal_load
    if math.isfinite(solution.scene.profile.period):
        return (("normal load", f"{_number(P)} {units.force} for each period"),)
    return (
        ("normal load", f"{_number(P)} {units.force}"),
        ("moment", f"{_number(solution.moment, P * r)} {units.moment}, about x = 0"),
        ("tilt", _number(solution.tilt, P / (r * solution.scene.Estar))),
    )


def _patches(solution: Solution, units: Units) -> tuple[Row, ...]:
    """The number of patches, the length in contact, the largest share of the load, and the gaps."""
    patches, repeats = solution.patches, math.isfinite(solution.scene.profile.period)
    if len(patches) < 2 and not repeats:
        return ()
    loads = solution.patch_loads
    most = max(range(len(patches)), key=lambda k: loads[k])
    lo, hi = (_number(x, solution.half_width) for x in patches[most])
    length, period = solution.contact_length, solution.scene.profile.period
    whole = period if repeats else 2.0 * solution.half_width
    of_what = "of the period" if repeats else "from x1 to x2"
    share = 100.0 * loads[most] / solution.normal_load
    biggest = ("largest share", f"{share:.3g} % of the load on [{lo}, {hi}] {units.length}")
    return (
        ("patches", f"{len(patches)}{' in each period' * repeats}"),
        (
            "in contact",
            f"{_number(length)} {units.length}, {100.0 * length / whole:.3g} % {of_what}",
        ),
        *[biggest] * (len(patches) > 1),
        (
            "gap volume",
            f"{_number(solution.gap_volume)} {units.length}² "
            f"{'in each period' if repeats else 'between them'}",
        ),
    )


def peak_rows(solution: Solution, units: Units) -> list[Row]:
    """The peak pressure and the mean pressure."""
    largest, where = peak(solution)
    places = [_number(x, solution.half_width, SAME_PLACE) for x in where[:2]]
    places += [f"{len(where) - 2} more"] if len(where) > 2 else []
    value = f"{_number(largest)} {units.stress}" if math.isfinite(largest) else "infinite"
    mean = solution.normal_load / solution.contact_length
    return [
        ("peak pressure", f"{value} at x = {' and '.join(places)}"),
        ("mean pressure", f"{_number(mean)} {units.stress}"),
    ]


def gap_rows(solution: Solution, units: Units) -> list[Row]:
    """The gap half a half-width beyond each edge.

    It is taken in the middle of the way to the contact of the next period where that is nearer.
    """
    if full(solution):
        return [("gap", "none")]
    (x1, x2), step = solution.edges, min(0.5 * solution.half_width, reach(solution))
    x = np.array([x1 - step, x2 + step])
    values = (
        f"{_number(g)} {units.length}" if math.isfinite(g) else "no indenter"
        for g in solution.gap(x).tolist()
    )
    places = [f"{gap} at x = {_number(u)}" for gap, u in zip(values, x.tolist(), strict=True)]
    return [("gap", ";  ".join(places))]


def shear_rows(solution: Solution, units: Units) -> list[Row]:
    """Stick zones, slip zones and dissipated energy."""
    if not solution.carries_shear:
        return [("shear", "none")]
    scene, r = solution.scene, solution.half_width
    limit = (
        "; bonded" if scene.bonded else f"; f P = {_number(scene.friction * solution.normal_load)}"
    )
    rows = [("shear load", f"Q = {_number(solution.tangential_load)} {units.force}{limit}")]
    if scene.bulk_stress:
        rows.append(("bulk stress", f"{_number(scene.bulk_stress)} {units.stress}"))
    rows += _zones("stick", [(*zone, "") for zone in solution.stick], r, units.length)
    slipped = [
        (lo, hi, f"{_narrow(solution, lo, hi, units.length)}, q = {'+' if sign > 0.0 else '-'}f p")
        for lo, hi, sign in slipping(solution)
    ]
    rows += _zones("slip", slipped, r, units.length) if slipped else []
    rows += [
        ("energy lost", f"{_number(energy)} {units.moment}")
        for energy in energy_of(solution).values()
    ]
    return rows


def _narrow(solution: Solution, lo: float, hi: float, length: str) -> str:
    """The width of a slip zone whose ends look alike."""
    r, (x1, x2) = solution.half_width, solution.edges
    if _number(lo, r) != _number(hi, r):
        return ""
    left, right = solution.slip_widths
    width = left if lo == x1 else right if hi == x2 else hi - lo
    return f" ({width:.3g} {length} wide)"


def _zones(
    name: str, zones: Sequence[tuple[float, float, str]], r: float, length: str
) -> list[Row]:
    """A row for each zone, or one for all where they are many."""
    if len(zones) > MANY_ZONES:
        whole = _number(sum(hi - lo for lo, hi, _ in zones))
        return [(name, f"in {len(zones)} zones, together {whole} {length} long")]
    return [
        (name, f"from {_number(lo, r)} to {_number(hi, r)} {length}{more}")
        for lo, hi, more in zones
    ] or [(name, "none")]


def _path_table(history: History, units: Units) -> str:
    """The turning points, as wide as a terminal at most."""
    rows = history.rows()
    turned = [name for name in ("tilt", "moment") if name in rows[0]]
    head = ["P", "Q", "σ", *turned, "stick from", "to", f"energy ({units.moment})"]
    cells: list[list[float | str]] = []
    for point in rows:
        loads = [point[name] for name in ("normal_load", "tangential_load", "bulk_stress", *turned)]
        zones = point["stick"] or [("-", "-")]
        cells.append([*loads, *zones[0], point.get("energy_lost", "not known")])
        none = [""] * len(loads)
        cells += [[*none, *zone, ""] for zone in zones[1:MANY_ZONES]]
        if len(zones) > MANY_ZONES:
            cells.append([*none, f"and {len(zones) - MANY_ZONES}", "more", ""])
    return table(head, cells)


def table(head: Sequence[str], rows: Sequence[Sequence[float | str]]) -> str:
    """Columns aligned at the right, with as many digits as make them no wider than a terminal."""
    for digits in range(6, 1, -1):
        shown = [
            [v if isinstance(v, str) else f"{v + 0.0:.{digits}g}" for v in row] for row in rows
        ]
        widths = [max(map(len, column)) for column in zip(head, *shown, strict=True)]
        if sum(widths) + len(BETWEEN) * (len(head) - 1) <= WIDE:
            break
    lines = (
        BETWEEN.join(f"{v:>{w}}" for v, w in zip(row, widths, strict=True)).rstrip()
        for row in (head, *shown)
    )
    return "\n".join(lines)


def stress_rows(solution: Solution, units: Units) -> list[Row]:
    """The stress under the centre of the contact, on the surface and half a half-width below."""
    r, rows = solution.half_width, []
    for name, where, y in (
        ("stress", "on the surface", 0.0),
        ("", f"at a depth of {_number(0.5 * r)} {units.length}", 0.5 * r),
    ):
        s = solution.stress(solution.centre, y)
        parts = (
            f"{component} = {_number(float(value), solution.normal_load / r)}"
            for component, value in (("σ_xx", s.xx), ("σ_yy", s.yy), ("σ_xy", s.xy))
        )
        rows.append((name, f"{', '.join(parts)} {units.stress} at the centre, {where}"))
    return rows


def yield_rows(solution: Solution, units: Units) -> list[Row]:
    """The load at which the body yields first, and where."""
    limit, r = solution.elastic_limit(), solution.half_width
    if math.isinf(limit.stress):
        place = f"x = {_number(limit.x, r)} {units.length} on the surface"
        return [("elastic limit", f"0: the stress is infinite at {place}")]
    places = (
        f"x = {_number(x, r, SAME_PLACE)}, y = {_number(y)} {units.length}" for x, y in limit.places
    )
    ratio = f"P/(bk) = {_number(limit.ratio)} (von Mises)"
    stress = f"it yields if k < {_number(limit.stress)} {units.stress}"
    return [("elastic limit", f"{ratio}: {stress}"), ("weakest point", " and ".join(places))]


def tension_rows(solution: Solution, units: Units) -> list[Row]:
    """The largest tension on the surface, and where."""
    value, x = solution.peak_tension()
    if value == 0.0:
        return [("peak tension", "none: the surface is nowhere in tension")]
    size = (
        f"{_number(value, solution.normal_load / solution.half_width)} {units.stress}"
        if math.isfinite(value)
        else "infinite"
    )
    return [("peak tension", f"{size} at x = {_number(x, solution.half_width)} {units.length}")]


ROWS: dict[str, Callable[[Solution, Units], list[Row]]] = {
    "edges": edge_rows,
    "pressure": peak_rows,
    "gap": gap_rows,
    "shear": shear_rows,
    "energy": lambda solution, units: [
        ("energy lost", f"{_number(solution.energy_lost)} {units.moment}")
    ],
    "stress": stress_rows,
    "yield": yield_rows,
    "tension": tension_rows,
}


def text_picture(solution: Solution, units: Units, width: int = WIDE) -> str:
    """The pressure over the contact as columns of blocks; ↑ where it rises above the picture."""
    (x1, x2), top = solution.edges, ceiling(solution)
    margin = len(_number(top))
    columns = max(width - margin - len(" │"), NARROWEST)
    p = solution.pressure(x1 + (x2 - x1) * (np.arange(columns) + 0.5) / columns)
    eighths: list[int] = np.round(np.minimum(p / top, 1.0) * 8 * HEIGHT).astype(int).tolist()
    rows = [
        "".join(" ▁▂▃▄▅▆▇█"[min(max(e - 8 * level, 0), 8)] for e in eighths)
        for level in range(HEIGHT - 1, -1, -1)
    ]
    rows[0] = "".join(
        "↑" if cut else block
        for block, cut in zip(rows[0], p > top * (1.0 + SAME_PEAK), strict=True)
    )
    labels = [_number(top), *[""] * (HEIGHT - 1)]
    r = solution.half_width
    left, right = _number(x1, r), f"{_number(x2, r)} {units.length}"
    lines = [f"{label:>{margin}} │{row}" for label, row in zip(labels, rows, strict=True)]
    axis = [
        f"{0:>{margin}} └{'─' * columns}",
        f"{'':>{margin}}  {left}{right:>{columns - len(left)}}",
    ]
    return "\n".join([f"p in {units.stress}", *lines, *axis])


def _number(value: float, scale: float = 0.0, nothing: float = NOTHING) -> str:
    return f"{0.0 if abs(value) < nothing * scale else value:.6g}"
