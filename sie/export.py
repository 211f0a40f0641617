"""An answer as text: a summary to read, CSV and JSON for other programs, and files that are written whole or not at all.

    CSV    4 comment lines (#): title and version, scene, units, edges and load;  then  x,p,gap  and one row per point
           with shear also the columns q and slip
           pandas.read_csv(file, comment="#")      numpy.loadtxt(file, delimiter=",", skiprows=5)

    JSON   sie, title, units {length, force, stress, moment}, scene (the code that rebuilds it), modulus E*, dundurs β        always
           edges [x1, x2], sharp [.., ..], half_width, centre, normal_load, moment, tilt                                     always
           pressure {peak {p, x: [..]}, resultant, moment, x: [..], p: [..]}                                         if wanted
           gap {x: [..], gap: [..]}                                                                                  if wanted
           shear {stick [[lo, hi], ..], slipping [[lo, hi, sign of q], ..], resultant, moment, energy_lost if known, x: [..], q: [..],
                  slip: [..]}                                                                                        if wanted
           path [{normal_load, tangential_load, bulk_stress, stick, energy_lost}, ..]                       if the scene has one
           check {residual, force, moment, lowest_pressure, lowest_gap, abscissae, tol, tension, overlap, error, ok} if wanted
           stress {x, xx, yy, xy: [..]} on the surface                                                               if wanted
           yield {ratio P/(bk), load P/k, sqrt_j2, places [[x, y], ..], criterion};  tension {value, x}              if wanted

Floats are written as `repr` writes them, so that nothing is lost. JSON has no infinity: it is the string "Infinity" or "-Infinity", which
Python's float(), NumPy and JavaScript's Number() read as the number; in CSV it is inf.
"""

from __future__ import annotations

import json
import math
import os
import secrets
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import __version__
from .errors import ContactError
from .history import Followed
from .interval import EPS
from .plan import UNASKED
from .scenefile import SceneFile, Units
from .solution import Solution

Array = NDArray[np.float64]

POINTS = 401  # in the contact, unless told otherwise
# Points beside the contact, on each side, as a fraction of those in it, and how far out they reach, in half-widths.
BESIDE = 0.25
REACH = 0.6
# Peaks of the pressure: sampled, then narrowed this often among this many points. The last step is below the flat top that rounding leaves.
PER_BREAK = 4  # points for each break; where there are fewer, breaks are passed over
ZOOMS = 8
ZOOM_POINTS = 41
LESSER = 0.5  # of the largest pressure: below it a peak is not narrowed
SAME_PEAK = 1e-9  # relative: a symmetric pressure has its peak twice
SAME_PLACE = 1e-7  # of the half-width: where a smooth peak is, rounding of p does not tell closer
# A spike is cut out of a picture if it is so many times what 95 % of the contact stays below; the picture then ends a little above that.
SPIKE = 3.0
ABOVE_ORDINARY = 1.4
# Below this fraction of its scale a printed number is rounding, and 0 is what is meant.
NOTHING = 1e-13
COLUMNS, ROWS = 60, 8  # of the text picture


def wanted(file: SceneFile) -> tuple[str, ...]:
    """What a scene file asks for: the contact, if it does not say."""
    return file.want or UNASKED


# -- where to look at an answer ----------------------------------------------------------------------------------------


def inside(solution: Solution, points: int = POINTS) -> Array:
    """About `points` abscissae from x1 to x2, ascending, among them the edges and the breaks of the slope.

    Points gather at edges and breaks like Chebyshev's. Half of them are shared out by length (in the angle of the contact), half equally,
    so that a narrow rim has its own. Of very many breaks, as a trace has, none is a place of its own.
    """
    (x1, x2), r, m = solution.edges, solution.half_width, solution.centre
    ends = np.array([x1, *(b for b in _corners(solution, points) if x1 < b < x2), x2])
    angle = np.arccos(np.clip((m - ends) / r, -1.0, 1.0))
    share = 0.5 * np.diff(angle) / np.pi + 0.5 / (len(ends) - 1)
    parts = [lo + (hi - lo) * _gathered(round(points * s)) for lo, hi, s in zip(ends[:-1], ends[1:], share, strict=True)]
    return np.unique(np.concatenate([*parts, ends]))


def beside(solution: Solution, points: int = POINTS) -> tuple[Array, Array]:
    """Abscissae left and right of the contact, ascending, without the edges, out to REACH half-widths or the end of the indenter."""
    (x1, x2), (lo, hi), reach = solution.edges, solution.scene.profile.domain, REACH * solution.half_width
    left, right = max(x1 - reach, lo), min(x2 + reach, hi)
    t = np.linspace(0.0, 1.0, max(round(BESIDE * points), 2) + 1) ** 2
    x = np.unique(np.concatenate((x1 + (left - x1) * t, x2 + (right - x2) * t, _corners(solution, points))))
    return x[(x >= left) & (x < x1)], x[(x > x2) & (x <= right)]


def _corners(solution: Solution, points: int) -> tuple[float, ...]:
    breaks = solution.scene.profile.breaks
    return breaks if len(breaks) <= points // PER_BREAK else ()


def abscissae(solution: Solution, points: int = POINTS) -> Array:
    """Left of the contact, in it, and right of it."""
    left, right = beside(solution, points)
    return np.concatenate((left, inside(solution, points), right))


def _gathered(n: int) -> Array:
    """n + 1 points (at least 2) from 0 to 1, dense at both."""
    return np.asarray(np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, max(n, 1) + 1)) ** 2)


@dataclass(frozen=True)
class Summit:
    """A local maximum of the pressure; p is inf at a sharp edge or under a corner."""

    x: float
    p: float


def summits(solution: Solution) -> tuple[Summit, ...]:
    """The local maxima of the pressure, from left to right; lesser ones only as closely as they were sampled."""
    x = np.union1d(inside(solution), [solution.centre])
    p = solution.pressure(x)
    padded = np.concatenate(([-np.inf], p, [-np.inf]))
    top = np.flatnonzero((p > padded[:-2]) & (p >= padded[2:]))
    high = top[np.isfinite(p[top]) & (p[top] >= LESSER * p[np.isfinite(p)].max())]
    x[high], p[high] = _narrowed(solution, x[high], x[np.maximum(high - 1, 0)], x[np.minimum(high + 1, len(x) - 1)])
    return tuple(Summit(*found) for found in zip(x[top].tolist(), p[top].tolist(), strict=True))


def peak(solution: Solution) -> tuple[float, tuple[float, ...]]:
    """(largest pressure, where): at more than one x if the pressure is as large there."""
    found = summits(solution)
    largest = max(s.p for s in found)
    return largest, tuple(s.x for s in found if s.p == largest or s.p >= largest * (1.0 - SAME_PEAK))


def ceiling(solution: Solution) -> float:
    """The largest pressure that a picture should show: the peak, unless it is infinite or a spike over a small part of the contact."""
    x1, x2 = solution.edges
    p = solution.pressure(x1 + (x2 - x1) * (np.arange(400) + 0.5) / 400.0)
    ordinary = float(np.quantile(p, 0.95, method="lower"))
    largest, _ = peak(solution)
    return largest if largest <= SPIKE * ordinary else ABOVE_ORDINARY * ordinary


def _narrowed(solution: Solution, x: Array, lo: Array, hi: Array) -> tuple[Array, Array]:
    """(where, value) of the largest pressures in [lo, hi], from x on: moved only for a gain beyond rounding."""
    p, every = solution.pressure(x), np.arange(len(x))
    for _ in range(ZOOMS):
        near = np.linspace(lo, hi, ZOOM_POINTS, axis=1)
        values = solution.pressure(near)
        k = np.argmax(values, axis=1)
        gain = values[every, k] > p * (1.0 + 4.0 * EPS)
        x, p = np.where(gain, near[every, k], x), np.where(gain, values[every, k], p)
        step = (hi - lo) / (ZOOM_POINTS - 1)
        lo, hi = np.maximum(x - step, lo), np.minimum(x + step, hi)
    return x, p


# -- for other programs ------------------------------------------------------------------------------------------------


def csv_text(solution: Solution, file: SceneFile, points: int = POINTS) -> str:
    """x, pressure and gap, whatever is wanted, as the module's docstring describes."""
    x = abscissae(solution, points)
    units, (x1, x2) = file.units, solution.edges
    head: tuple[str, ...] = (
        f"# {file.title or 'plane contact'} (sie {__version__})",
        f"# {solution.scene!r}",
        f"# x and gap in {units.length}, p in {units.stress}, load in {units.force}",
        f"# contact from x1 = {x1!r} to x2 = {x2!r}, load {solution.normal_load!r}",
    )
    columns = {"x": x, "p": solution.pressure(x), "gap": solution.gap(x)}
    if solution.carries_shear:
        columns |= {"q": solution.shear(x)} | slip_of(solution, x)
    head = (*head, ",".join(columns))
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return "\n".join((*head, *(",".join(map(repr, row)) for row in rows))) + "\n"


def json_text(solution: Solution, file: SceneFile, points: int = POINTS) -> str:
    """Everything that the file wants, as the module's docstring describes."""
    return strict_json(as_dict(solution, file, points))


def strict_json(value: Any) -> str:
    """JSON with infinities as text."""
    return json.dumps(_finite(value), indent=2, allow_nan=False) + "\n"


def as_dict(solution: Solution, file: SceneFile, points: int = POINTS) -> dict[str, Any]:
    """What `json_text` writes, with infinities as floats."""
    units, scene = file.units, solution.scene
    out: dict[str, Any] = {
        "sie": __version__,
        "title": file.title,
        "units": {"length": units.length, "force": units.force, "stress": units.stress, "moment": units.moment},
        "scene": repr(scene),
        "modulus": scene.Estar,
        "dundurs": scene.beta,
        "edges": list(solution.edges),
        "sharp": list(solution.sharp),
        "half_width": solution.half_width,
        "centre": solution.centre,
        "normal_load": solution.normal_load,
        "moment": solution.moment,
        "tilt": solution.tilt,
    }
    sections = {"pressure": _pressure, "gap": _gap, "shear": _shear, "check": _check}
    sections |= {"stress": _stress, "yield": _yield, "tension": _tension}
    if isinstance(solution, Followed):
        out["path"] = _path(solution)
    return out | {name: section(solution, points) for name, section in sections.items() if name in wanted(file)}


def _pressure(solution: Solution, points: int) -> dict[str, Any]:
    p, x = solution.pressure, inside(solution, points)
    largest, where = peak(solution)
    return {"peak": {"p": largest, "x": list(where)}, "resultant": p.resultant, "moment": p.moment, "x": x.tolist(), "p": p(x).tolist()}


def _gap(solution: Solution, points: int) -> dict[str, Any]:
    left, right = beside(solution, points)
    x = np.concatenate((left, solution.edges, right))
    return {"x": x.tolist(), "gap": solution.gap(x).tolist()}


def slip_of(solution: Solution, x: Array) -> dict[str, Array]:
    """The slip at x, {} where a path leaves it open (points that came into contact while slipping)."""
    try:
        return {"slip": solution.slip(x)}
    except ContactError:
        return {}


def energy_of(solution: Solution) -> dict[str, float]:
    """The energy lost, {} where it is not known: dissimilar bodies that slide have slipped in part before."""
    return {} if solution.scene.epsilon else {"energy_lost": solution.energy_lost}


def slipping(solution: Solution) -> tuple[tuple[float, float, float], ...]:
    """Where the bodies slip or have slipped, (lo, hi, sign of q)."""
    if solution.scene.epsilon:
        return ((*solution.edges, float(solution.scene.slides)),)
    return tuple(solution.tangential.slipped) if solution.sheared else ()


def _shear(solution: Solution, points: int) -> dict[str, Any]:
    x, q = inside(solution, points), solution.shear
    return (
        {
            "stick": [list(zone) for zone in solution.stick],
            "slipping": [list(zone) for zone in slipping(solution)],
            "resultant": q.resultant,
            "moment": q.moment,
            "x": x.tolist(),
            "q": q(x).tolist(),
        }
        | energy_of(solution)
        | {name: values.tolist() for name, values in slip_of(solution, x).items()}
    )


def _path(solution: Followed) -> list[dict[str, Any]]:
    names = ("normal_load", "tangential_load", "bulk_stress")
    points = zip(solution.history.path.points, solution.history, strict=True)
    return [
        dict(zip(names, loads, strict=True))
        | ({"stick": [list(zone) for zone in at.stick], "energy_lost": at.energy_lost} if loads[0] else {"stick": [], "energy_lost": 0.0})
        for loads, at in points
    ]


def _check(solution: Solution, _points: int) -> dict[str, Any]:
    return solution.check().as_dict()


def _stress(solution: Solution, points: int) -> dict[str, Any]:
    x = abscissae(solution, points)
    s = solution.surface_stress(x)
    return {"x": x.tolist(), "xx": s.xx.tolist(), "yy": s.yy.tolist(), "xy": s.xy.tolist()}


def _yield(solution: Solution, _points: int) -> dict[str, Any]:
    found = solution.elastic_limit()
    places = [list(place) for place in found.places]
    return {"ratio": found.ratio, "load": found.load, "sqrt_j2": found.stress, "places": places, "criterion": found.criterion}


def _tension(solution: Solution, _points: int) -> dict[str, Any]:
    return solution.peak_tension()._asdict()


def _finite(value: Any) -> Any:
    """The same with infinities as text and NumPy's scalars as Python's."""
    if isinstance(value, dict):
        return {key: _finite(v) for key, v in value.items()}
    if isinstance(value, list):
        return [_finite(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    return ("Infinity" if value > 0.0 else "-Infinity") if isinstance(value, float) and math.isinf(value) else value


# -- to read -----------------------------------------------------------------------------------------------------------


def summary(solution: Solution, file: SceneFile) -> str:
    """What the file wants, for the eye: rounded to six digits, with a picture of the pressure in text."""
    sections = {
        "edges": edges_summary,
        "pressure": pressure_summary,
        "gap": gap_summary,
        "shear": shear_summary,
        "stress": stress_summary,
        "yield": yield_summary,
        "tension": tension_summary,
        "check": check_summary,
    }
    scene = f"{solution.scene.profile!r}, E* = {solution.scene.Estar:.6g} {file.units.stress}"
    parts = [section(solution, file.units) for name, section in sections.items() if name in wanted(file)]
    return "\n\n".join([f"{file.title}\n{scene}" if file.title else scene, *parts])


def edges_summary(solution: Solution, units: Units) -> str:
    r, P = solution.half_width, solution.normal_load
    x1, x2 = (f"{_number(x, r)} {units.length}, {'sharp' if s else 'smooth'}" for x, s in zip(solution.edges, solution.sharp, strict=True))
    return _rows(
        ("edges", f"x1 = {x1};  x2 = {x2}"),
        ("half-width", f"{_number(r)} {units.length}, centre at x = {_number(solution.centre, r)}"),
        ("normal load", f"{_number(P)} {units.force}"),
        ("moment", f"{_number(solution.moment, P * r)} {units.moment}, about x = 0"),
        ("tilt", _number(solution.tilt, P / (r * solution.scene.Estar))),
    )


def pressure_summary(solution: Solution, units: Units) -> str:
    largest, where = peak(solution)
    places = [_number(x, solution.half_width, SAME_PLACE) for x in where[:2]]
    places += [f"{len(where) - 2} more"] if len(where) > 2 else []
    value = f"{_number(largest)} {units.stress}" if math.isfinite(largest) else "infinite"
    mean = solution.normal_load / (2.0 * solution.half_width)
    rows = _rows(("peak pressure", f"{value} at x = {' and '.join(places)}"), ("mean pressure", f"{_number(mean)} {units.stress}"))
    return f"{rows}\n\n{text_picture(solution, units)}"


def gap_summary(solution: Solution, units: Units) -> str:
    """The gap half a half-width beyond each edge."""
    (x1, x2), r = solution.edges, solution.half_width
    x = np.array([x1 - 0.5 * r, x2 + 0.5 * r])
    values = (f"{_number(g)} {units.length}" if math.isfinite(g) else "no indenter" for g in solution.gap(x).tolist())
    return _rows(("gap", ";  ".join(f"{value} at x = {_number(at)}" for value, at in zip(values, x.tolist(), strict=True))))


def shear_summary(solution: Solution, units: Units) -> str:
    """Stick and slip zones, shear and what it costs; a table of the turning points of a path."""
    if not solution.carries_shear:
        return _rows(("shear", "none"))
    scene, r = solution.scene, solution.half_width
    limit = "; bonded" if scene.bonded else f"; f P = {_number(scene.friction * solution.normal_load)}"
    rows = [("shear load", f"Q = {_number(solution.tangential_load)} {units.force}{limit}")]
    rows += [("bulk stress", f"{_number(scene.bulk_stress)} {units.stress}")] if scene.bulk_stress else []
    rows += [("stick", f"from {_number(lo, r)} to {_number(hi, r)} {units.length}") for lo, hi in solution.stick] or [("stick", "none")]
    for lo, hi, sign in slipping(solution):
        rows.append(("slip", f"from {_number(lo, r)} to {_number(hi, r)} {units.length}, q = {'+' if sign > 0.0 else '-'}f p"))
    rows += [("energy lost", f"{_number(energy)} {units.moment}") for energy in energy_of(solution).values()]
    table = [_path_table(solution, units)] if isinstance(solution, Followed) else []
    return "\n\n".join([_rows(*rows), *table])


def _path_table(solution: Followed, units: Units) -> str:
    head = ("P", "Q", "σ", "stick from", "to", f"energy lost / ({units.moment})")
    lines = ["".join(f"{name:>14}" for name in head[:-1]) + f"   {head[-1]}"]
    for point in _path(solution):
        lo, hi = point["stick"][0] if point["stick"] else ("-", "-")
        cells = (point["normal_load"], point["tangential_load"], point["bulk_stress"], lo, hi)
        shown = "".join(f"{c:>14}" if isinstance(c, str) else f"{_number(c):>14}" for c in cells)
        lines.append(f"{shown}   {_number(point['energy_lost'])}")
    return "\n".join(lines)


def stress_summary(solution: Solution, units: Units) -> str:
    """The stress under the centre of the contact, on the surface and half a half-width below."""
    r = solution.half_width
    lines: list[tuple[str, str]] = []
    for where, y in (("on the surface", 0.0), (f"at a depth of {_number(0.5 * r)} {units.length}", 0.5 * r)):
        s = solution.stress(solution.centre, y)
        scale = solution.normal_load / r
        parts = (f"{name} = {_number(float(v), scale)}" for name, v in (("σ_xx", s.xx), ("σ_yy", s.yy), ("σ_xy", s.xy)))
        lines.append(("stress" if not lines else "", f"{', '.join(parts)} {units.stress} at the centre, {where}"))
    return _rows(*lines)


def yield_summary(solution: Solution, units: Units) -> str:
    found, r = solution.elastic_limit(), solution.half_width
    if math.isinf(found.stress):
        return _rows(("elastic limit", f"0: the stress is infinite at x = {_number(found.x, r)} {units.length} on the surface"))
    places = (f"x = {_number(x, r, SAME_PLACE)}, y = {_number(y)} {units.length}" for x, y in found.places)
    return _rows(
        (
            "elastic limit",
            f"P/(bk) = {_number(found.ratio)} (von Mises): this contact yields if k < {_number(found.stress)} {units.stress}",
        ),
        ("weakest point", " and ".join(places)),
    )


def tension_summary(solution: Solution, units: Units) -> str:
    value, x = solution.peak_tension()
    size = f"{_number(value, solution.normal_load / solution.half_width)} {units.stress}" if math.isfinite(value) else "infinite"
    return _rows(("peak tension", f"{size} at x = {_number(x, solution.half_width)} {units.length}"))


def check_summary(solution: Solution, _units: Units) -> str:
    return str(solution.check())


def text_picture(solution: Solution, units: Units) -> str:
    """The pressure over the contact as columns of blocks; ↑ where it rises above the picture."""
    (x1, x2), top = solution.edges, ceiling(solution)
    p = solution.pressure(x1 + (x2 - x1) * (np.arange(COLUMNS) + 0.5) / COLUMNS)
    eighths: list[int] = np.round(np.minimum(p / top, 1.0) * 8 * ROWS).astype(int).tolist()
    rows = ["".join(" ▁▂▃▄▅▆▇█"[min(max(e - 8 * level, 0), 8)] for e in eighths) for level in range(ROWS - 1, -1, -1)]
    rows[0] = "".join("↑" if cut else block for block, cut in zip(rows[0], p > top * (1.0 + SAME_PEAK), strict=True))
    labels = [_number(top), *[""] * (ROWS - 1)]
    margin = len(labels[0])
    left, right = _number(x1, solution.half_width), f"{_number(x2, solution.half_width)} {units.length}"
    lines = [f"{label:>{margin}} │{row}" for label, row in zip(labels, rows, strict=True)]
    axis = [f"{0:>{margin}} └{'─' * COLUMNS}", f"{'':>{margin}}  {left}{right:>{COLUMNS - len(left)}}"]
    return "\n".join([f"p in {units.stress}", *lines, *axis])


def _number(value: float, scale: float = 0.0, nothing: float = NOTHING) -> str:
    return f"{0.0 if abs(value) < nothing * scale else value:.6g}"


def _rows(*rows: tuple[str, str]) -> str:
    return "\n".join(f"{name:<15} {text}" for name, text in rows)


# -- files -------------------------------------------------------------------------------------------------------------


def writable(path: str | Path) -> Path:
    """The path, if a file can be written there; ValueError, with the remedy, if not. Nothing is written."""
    path = Path(path)
    if path.is_dir():
        raise ValueError(f"{path} is a directory: give the name of a file in it")
    parent = path.resolve().parent
    if not parent.is_dir():
        raise ValueError(f"{path} cannot be written, there is no directory {parent}: create it first")
    touched = ([path] if path.exists() else []) + ([] if _is_device(path) else [parent])
    if not all(os.access(place, os.W_OK) for place in touched):
        raise ValueError(f"{path} cannot be written, permission is denied: choose another place")
    return path


def write_files(contents: Mapping[Path, bytes]) -> None:
    """Write all files. Each is first written beside its place, then moved there, so that none is ever seen half written.

    A device or a pipe cannot be replaced and is written to as it is. Raises OSError; what was there before is then still there.
    """
    parts: dict[Path, Path] = {}
    try:
        for path, data in contents.items():
            if _is_device(path):
                path.write_bytes(data)
            else:
                place = path.resolve()  # a link stays a link
                parts[place] = place.with_name(f".{secrets.token_hex(8)}.part")
                _write_part(parts[place], data, like=place)
        for place, part in parts.items():
            os.replace(part, place)
    except OSError as problem:
        raise OSError(f"{' and '.join(map(str, contents))} not written: {problem.strerror}") from None
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)


def _write_part(part: Path, data: bytes, like: Path) -> None:
    with open(part, "xb") as stream:
        stream.write(data)
    if like.exists():
        shutil.copymode(like, part)


def _is_device(path: Path) -> bool:
    return path.exists() and not path.is_file()
