"""An answer to read: rounded to six digits, with a picture of the pressure in text."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from sie.arguments import WIDE, named_rows
from sie.problem.coverage import energy_costs

from .answers import energy_of, notes_of, readings_of, slipping, wanted
from .sample_points import SAME_PEAK, ceiling, full, peak, reach

if TYPE_CHECKING:
    from .beside_scene import Units
    from .scene_file import SceneFile

NONE: Mapping[str, Any] = {}
NOTHING = 1e-12  # of its scale: a smaller number is rounding, and is printed as 0
MANY_ZONES = 8  # so many zones of stick or slip are listed
HEIGHT, NARROWEST = 8, 20  # rows of the text picture, and its columns at least
Row = tuple[str, str]  # the name and the words of one quantity
BETWEEN = "  "  # what stands between the columns of a table


def summary(
    solution: Any, file: SceneFile, more: Mapping[str, Any] = NONE, width: int = WIDE
) -> str:
    """All wanted quantities, section by section, with a picture of so many columns.

    `more` has the answers of `cycle_answer` by name.
    """
    scene = f"{solution.scene.profile!r}, E* = {solution.scene.Estar:.6g} {file.units.stress}"
    readings = [f"trace {reading}" for reading in readings_of(solution)]
    fill: dict[str, Any] = {"width": WIDE, "break_long_words": False, "break_on_hyphens": False}
    head = [textwrap.fill(scene, **fill), *(textwrap.fill(text, WIDE) for text in readings)]
    parts, names = ["\n".join(filter(None, [file.title, *head]))], set(wanted(file))
    if "shear" in names and not energy_costs(solution.scene):
        names.discard("energy")  # it is printed with the shear
    rows = Rows(solution, file.units)
    for name in (name for name in ROWS if name in names):
        parts.append(named_rows(*ROWS[name](rows)))
        if name == "pressure":
            parts.append(text_picture(solution, file.units, width))
        if name == "shear" and solution.history and solution.carries_shear:
            parts.append(_path_table(solution.history, file.units))
    printed: tuple[str, ...] = ()
    if "check" in names:
        parts += map(str, (solution.check(), *solution.trace_reports()))
        printed = solution.check().notes
    if "cycle" in more:
        from .cycle_answer import cycle_summary  # noqa: PLC0415

        parts.append(cycle_summary(more["cycle"], file))
    if "crack" in more:
        from .cycle_answer import crack_summary  # noqa: PLC0415

        parts.append(crack_summary(more["crack"], file.units))
    notes = "\n".join(note for note in notes_of(solution, file) if note not in printed)
    return "\n\n".join([*parts, *filter(None, [notes])])


@dataclass(frozen=True)
class Rows:
    """The rows of each quantity, in words with units."""

    solution: Any
    units: Units

    def edges(self) -> list[Row]:
        """Edges, patches, width, load, moment and tilt."""
        solution, units, r, P = self.solution, self.units, self._r, self.solution.normal_load
        x1, x2 = (
            f"{self._length(x, r)}, {'sharp' if sharp else 'smooth'}"
            for x, sharp in zip(solution.edges, solution.sharp, strict=True)
        )
        edges = f"x1 = {x1};  x2 = {x2}"
        load = f"{_number(P)} {units.force}"
        rows = [
            ("edges", "none: all of the period is in contact" if full(solution) else edges),
            *self._patches(),
            ("half-width", f"{self._length(r)}, centre at x = {_number(solution.centre, r)}"),
        ]
        if math.isfinite(solution.scene.profile.period):  # it keeps level
            return [*rows, ("normal load", f"{load} for each period")]
        return [
            *rows,
            ("normal load", load),
            ("moment", f"{_number(solution.moment, P * r)} {units.moment}, about x = 0"),
            ("tilt", _number(solution.tilt, P / (r * solution.scene.Estar))),
        ]

    def _patches(self) -> list[Row]:
        """The number of patches, the length in contact, the largest share of the load, the gaps."""
        solution, patches = self.solution, self.solution.patches
        period = solution.scene.profile.period
        repeats = math.isfinite(period)
        if len(patches) < 2 and not repeats:
            return []
        length, P = solution.contact_length, solution.normal_load
        part = 100.0 * length / (period if repeats else 2.0 * self._r)
        where = "of the period" if repeats else "from x1 to x2"
        rows = [
            ("patches", f"{len(patches)}{' in each period' * repeats}"),
            ("in contact", f"{self._length(length)}, {part:.3g} % {where}"),
        ]
        if len(patches) > 1:
            shares = zip(solution.patch_loads, patches, strict=True)
            load, (lo, hi) = max(shares, key=lambda share: share[0])
            place = f"[{_number(lo, self._r)}, {_number(hi, self._r)}] {self.units.length}"
            rows.append(("largest share", f"{100.0 * load / P:.3g} % of the load on {place}"))
        between = "in each period" if repeats else "between them"
        return [*rows, ("gap volume", f"{self._length(solution.gap_volume)}² {between}")]

    def pressure(self) -> list[Row]:
        """The peak pressure and the mean pressure."""
        largest, where = peak(self.solution)
        places = [_number(x, self._r) for x in where[:2]]
        places += [f"{len(where) - 2} more"] if len(where) > 2 else []
        mean = self.solution.normal_load / self.solution.contact_length
        return [
            ("peak pressure", f"{self._stress(largest)} at x = {' and '.join(places)}"),
            ("mean pressure", self._stress(mean)),
        ]

    def gap(self) -> list[Row]:
        """The gap half a half-width beyond each edge.

        It is taken in the middle of the way to the contact of the next period where that is nearer.
        """
        if full(self.solution):
            return [("gap", "none")]
        (x1, x2), step = self.solution.edges, min(0.5 * self._r, reach(self.solution))
        x = [x1 - step, x2 + step]
        gaps = zip(self.solution.gap(x).tolist(), x, strict=True)
        texts = [
            f"{self._length(g) if math.isfinite(g) else 'no indenter'} at x = {_number(u)}"
            for g, u in gaps
        ]
        return [("gap", ";  ".join(texts))]

    def shear(self) -> list[Row]:
        """Stick zones, slip zones and dissipated energy."""
        solution, scene, units = self.solution, self.solution.scene, self.units
        if not solution.carries_shear:
            return [("shear", "none")]
        limit = f"f P = {_number(scene.friction * solution.normal_load)}"
        limit = "bonded" if scene.bonded else limit
        rows = [("shear load", f"Q = {_number(solution.tangential_load)} {units.force}; {limit}")]
        if scene.bulk_stress:
            rows.append(("bulk stress", self._stress(scene.bulk_stress)))
        rows += self._zones("stick", [(*zone, "") for zone in solution.stick])
        slipped = [
            (lo, hi, f"{self._narrow(lo, hi)}, q = {'+' if sign > 0.0 else '-'}f p")
            for lo, hi, sign in slipping(solution)
        ]
        rows += self._zones("slip", slipped) if slipped else []
        return rows + self._energy(energy_of(solution))

    def _narrow(self, lo: float, hi: float) -> str:
        """The width of a slip zone whose ends look alike."""
        (x1, x2), (left, right) = self.solution.edges, self.solution.slip_widths
        if _number(lo, self._r) != _number(hi, self._r):
            return ""
        width = left if lo == x1 else right if hi == x2 else hi - lo
        return f" ({width:.3g} {self.units.length} wide)"

    def _zones(self, name: str, zones: Sequence[tuple[float, float, str]]) -> list[Row]:
        """A row for each zone, or one for all where they are many."""
        if len(zones) > MANY_ZONES:
            whole = self._length(sum(hi - lo for lo, hi, _ in zones))
            return [(name, f"in {len(zones)} zones, together {whole} long")]
        return [
            (name, f"from {_number(lo, self._r)} to {self._length(hi, self._r)}{more}")
            for lo, hi, more in zones
        ] or [(name, "none")]

    def energy(self) -> list[Row]:
        """The dissipated energy."""
        return self._energy({"energy_lost": self.solution.energy_lost})

    def _energy(self, known: Mapping[str, float]) -> list[Row]:
        return [("energy lost", f"{_number(v)} {self.units.moment}") for v in known.values()]

    def stress(self) -> list[Row]:
        """The stress under the centre, on the surface and half a half-width below."""
        r, scale, rows = self._r, self.solution.normal_load / self._r, []
        below = f"at a depth of {self._length(0.5 * r)}"
        for name, where, y in (("stress", "on the surface", 0.0), ("", below, 0.5 * r)):
            s = self.solution.stress(self.solution.centre, y)
            parts = (
                f"{component} = {_number(float(value), scale)}"
                for component, value in (("σ_xx", s.xx), ("σ_yy", s.yy), ("σ_xy", s.xy))
            )
            rows.append((name, f"{', '.join(parts)} {self.units.stress} at the centre, {where}"))
        return rows

    def yielding(self) -> list[Row]:
        """The load at which the body yields first, and where."""
        limit, r = self.solution.elastic_limit(), self._r
        if math.isinf(limit.stress):
            place = f"x = {self._length(limit.x, r)} on the surface"
            return [("elastic limit", f"0: the stress is infinite at {place}")]
        places = (f"x = {_number(x, r)}, y = {self._length(y)}" for x, y in limit.places)
        ratio = f"P/(bk) = {_number(limit.ratio)} (von Mises)"
        stress = f"it yields if k < {self._stress(limit.stress)}"
        return [("elastic limit", f"{ratio}: {stress}"), ("weakest point", " and ".join(places))]

    def tension(self) -> list[Row]:
        """The largest tension on the surface, and where."""
        value, x = self.solution.peak_tension()
        if value == 0.0:
            return [("peak tension", "none: the surface is nowhere in tension")]
        size = self._stress(value, self.solution.normal_load / self._r)
        return [("peak tension", f"{size} at x = {self._length(x, self._r)}")]

    @property
    def _r(self) -> float:
        return self.solution.half_width

    def _length(self, value: float, scale: float = 0.0) -> str:
        return f"{_number(value, scale)} {self.units.length}"

    def _stress(self, value: float, scale: float = 0.0) -> str:
        return "infinite" if math.isinf(value) else f"{_number(value, scale)} {self.units.stress}"


ROWS: dict[str, Callable[[Rows], list[Row]]] = {
    "edges": Rows.edges,
    "pressure": Rows.pressure,
    "gap": Rows.gap,
    "shear": Rows.shear,
    "energy": Rows.energy,
    "stress": Rows.stress,
    "yield": Rows.yielding,
    "tension": Rows.tension,
}


def _number(value: float, scale: float = 0.0) -> str:
    return f"{0.0 if abs(value) < NOTHING * scale else value:.6g}"


# -- tables and pictures ---------------------------------------------------------------------------


def _path_table(history: Any, units: Units) -> str:
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


def text_picture(solution: Any, units: Units, width: int = WIDE) -> str:
    """The pressure over the contact as columns of blocks; ↑ where it rises above the picture."""
    (x1, x2), r, top = solution.edges, solution.half_width, ceiling(solution)
    margin = len(_number(top))
    columns = max(width - margin - len(" │"), NARROWEST)
    p = solution.pressure(x1 + (x2 - x1) * (np.arange(columns) + 0.5) / columns)
    eighths: list[int] = np.round(np.minimum(p / top, 1.0) * 8 * HEIGHT).astype(int).tolist()
    rows = [
        "".join(" ▁▂▃▄▅▆▇█"[min(max(e - 8 * level, 0), 8)] for e in eighths)
        for level in range(HEIGHT - 1, -1, -1)
    ]
    cut = (p > top * (1.0 + SAME_PEAK)).tolist()
    rows[0] = "".join("↑" if c else block for block, c in zip(rows[0], cut, strict=True))
    labels = [_number(top), *[""] * (HEIGHT - 1)]
    lines = [f"{label:>{margin}} │{row}" for label, row in zip(labels, rows, strict=True)]
    left, right = _number(x1, r), f"{_number(x2, r)} {units.length}"
    axis = f"{0:>{margin}} └{'─' * columns}"
    return "\n".join(
        [
            f"p in {units.stress}",
            *lines,
            axis,
            f"{'':>{margin}}  {left}{right:>{columns - len(left)}}",
        ]
    )
