"""An answer for other programs: CSV, JSON and grids of stress.

CSV has four comment lines (#), then x,p,gap and one row for each point; with shear also q and slip.
CSV of a load path has such rows for every turning point with P > 0, each after the number of the
point and its loads: point,P,Q,sigma, tilt or moment if the path has them, then x,p,gap,q,slip.
A cell of slip that is not known is empty.

JSON always holds

    sie, title, units {length, force, stress, moment}
    scene {profile, body, load, ..}, the tables of a scene file, which sie.Scene.from_dict reads (of
    a load path those of its last point), modulus E*, dundurs β
    edges [x1, x2], sharp [.., ..], half_width, centre, normal_load, moment, tilt, notes [text, ..]
    patches [[x1, x2], ..], patch_loads [number, ..], contact_length, gap_volume, where there are
    several patches, or of one period of a contact that repeats; and there the period

    readings [{file, units [of x, of h], length, scale, side}, ..] where traces were read from files

and, where they are wanted,

    pressure    {peak {p, x: [..]}, resultant, moment, x: [..], p: [..]}
    gap         {x: [..], gap: [..]}
    shear       {stick [[lo, hi], ..], slipping [[lo, hi, sign of q], ..], resultant, moment,
                 energy_lost if known, x: [..], q: [..], slip: [..]}
    energy      {energy_lost}; of dissimilar bodies under a tangential load only here, not in shear
    check       {residual, force, moment, lowest_pressure, lowest_gap, abscissae, resolution, edges,
                 tol, tension, overlap, notes, error, ok}
    stress      {x, xx, yy, xy: [..]} on the surface
    yield       {ratio P/(bk), load P/k, sqrt_j2, places [[x, y], ..], criterion}
    tension     {value, x}
    cycle       of load paths that come back to earlier loads: {from, to (points of the path),
                 states, energy if known, slip_amplitude, friction_work, ruiz {value, x},
                 surface {xx, yy, xy: {range, x, lowest, highest}}, swt if the body is known,
                 findley, fatemi_socie if [fatigue] has their constants: [{value, x, y, angle and
                 out_of_plane of the normal in degrees, amplitude, normal_stress}, ..]}, or {reason}
                 where one is infinite or not known
    crack       with [crack]: {x, depth, mode_1 and mode_2 (state by depth), range_1, range_2,
                 certificate, and with its constants threshold and arrest ("Infinity" for none)}
    path        of load paths: [{normal_load, tangential_load, bulk_stress, tilt or moment if the
                 path has them, stick, energy_lost if known}, ..]
    traces      with check, of measured traces: [{points, smoothing, misfit,
                 outliers [[x, off], ..], gaps [{lo, hi, missing}, ..],
                 mended {left_out, averaged, sorted}, tilt, pressure_error, edge_errors [x1, x2]},
                 ..]

A grid of stress has four comment lines (#), then x,y,xx,yy,xy,zz,j2,mises and one row for each
point, x fastest, which ParaView turns into a structured grid; y is the depth.

Floats are written as `repr` writes them, so that nothing is lost. JSON has no infinity: it is the
string "Infinity" or "-Infinity", which Python's float(), NumPy and JavaScript's Number() read as
the number; in CSV it is inf.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import __version__
from sie.files import table_of_columns
from sie.problem.request import GRID, POINTS
from sie.progress_bar import counted

from .answers import energy_of, notes_of, readings_of, slip_of, slipping, wanted
from .sample_points import abscissae, beside, inside, peak
from .scene_file import SceneFile
from .scene_tables import tables_of

if TYPE_CHECKING:
    from sie.stress.half_plane import Stress
    from sie.traction.base import Density


Array = NDArray[np.float64]

TRACTIONS = ("x", "p", "gap", "q", "slip")  # columns of CSV, those of ...
STRESSES, LENGTHS = ("p", "q"), ("x", "gap", "slip")
COMPONENTS = ("xx", "yy", "xy", "zz", "j2", "mises")
BESIDE, DEPTH = 1.0, 2.0  # what a grid shows beside the contact and in depth, in half-widths


def csv_text(solution: Any, file: SceneFile, points: int = POINTS) -> str:
    """x, pressure and gap, always, as the module's docstring describes; of a path at each point."""
    units, history = file.units, solution.history
    if history is None:
        (x1, x2), load = solution.edges, solution.normal_load
        where = f"contact from x1 = {x1!r} to x2 = {x2!r}, load {load!r}"
        columns, scene = _columns(solution, points), solution.scene
    else:
        where = f"{len(history)} points of a load path, sigma in {units.stress}"
        columns, scene = _along_path(history, points), history.scene
    stresses, lengths = (
        " and ".join(name for name in columns if name in kind) for kind in (STRESSES, LENGTHS)
    )
    head = (
        f"{file.title or 'plane contact'} (sie {__version__})",
        repr(scene),
        f"{lengths} in {units.length}, {stresses} in {units.stress}, load in {units.force}",
        where,
    )
    return table_of_columns(head, columns)


def _along_path(history: Any, points: int) -> dict[str, Array]:
    """The tractions, the gap and the slip at every turning point of a load path with P > 0."""
    turned = [name for name in ("tilt", "moment") if getattr(history.path, name)]
    names = ("P", "Q", "sigma", *turned)
    both = zip(history.turning_points, history, strict=True)
    tables = []
    for k, (state, solution) in enumerate(counted("turning points", both, len(history))):
        if state.loads.P:
            columns = _columns(solution, points)
            count = len(columns["x"])
            loads = zip(names, state.loads, strict=False)
            table = {name: np.full(count, value) for name, value in (("point", k), *loads)}
            found = {"q": np.zeros(count), "slip": np.full(count, np.nan)} | columns
            tables.append(table | {name: found[name] for name in TRACTIONS})
    return {name: np.concatenate([table[name] for table in tables]) for name in tables[0]}


def _columns(solution: Any, points: int) -> dict[str, Array]:
    x = abscissae(solution, points)
    columns = {"x": x, "p": solution.pressure(x), "gap": solution.gap(x)}
    if solution.carries_shear:
        columns |= {"q": solution.shear(x)} | slip_of(solution, x)
    return columns


def json_text(
    solution: Any,
    file: SceneFile,
    points: int = POINTS,
    more: Mapping[str, Any] | None = None,
) -> str:
    """All wanted quantities, as the module's docstring describes."""
    return strict_json(as_dict(solution, file, points, more))


def strict_json(value: Any) -> str:
    """JSON with infinities as text."""
    return json.dumps(_finite(value), indent=2, allow_nan=False) + "\n"


def as_dict(
    solution: Any,
    file: SceneFile,
    points: int = POINTS,
    more: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """The content of `json_text`, with infinities as floats; `more` as of `summary`."""
    units, scene, asked = file.units, solution.scene, wanted(file)
    out: dict[str, Any] = {
        "sie": __version__,
        "title": file.title,
        "units": {**vars(units), "moment": units.moment},
        "scene": tables_of(scene),
        "modulus": scene.Estar,
        "dundurs": scene.beta,
        "edges": list(solution.edges),
        "sharp": list(solution.sharp),
        **_patches(solution),
        **{name: getattr(solution, name) for name in NUMBERS},
        "notes": list(notes_of(solution, file)),
    }
    if readings := readings_of(solution):
        out["readings"] = [reading._asdict() for reading in readings]
    out |= more or {}
    if solution.history is not None:
        out["path"] = solution.history.rows()
    if "check" in asked and (reports := solution.trace_reports()):
        out["traces"] = [report.as_dict() for report in reports]
    return out | {name: of(solution, points) for name, of in SECTIONS.items() if name in asked}


def _patches(solution: Any) -> dict[str, Any]:
    """The patches, their loads, length and gaps, where there are several or the contact repeats."""
    period = solution.scene.profile.period
    if len(solution.patches) < 2 and math.isinf(period):
        return {}
    return {
        "patches": [list(patch) for patch in solution.patches],
        "patch_loads": list(solution.patch_loads),
        "contact_length": solution.contact_length,
        "gap_volume": solution.gap_volume,
    } | ({"period": period} if math.isfinite(period) else {})


NUMBERS = ("half_width", "centre", "normal_load", "moment", "tilt")


def _lists(**columns: Array) -> dict[str, Any]:
    return {name: values.tolist() for name, values in columns.items()}


def _totals(density: Density) -> dict[str, float]:
    return {"resultant": density.resultant, "moment": density.moment}


def _pressure(solution: Any, points: int) -> dict[str, Any]:
    p, x, (largest, where) = solution.pressure, inside(solution, points), peak(solution)
    return {"peak": {"p": largest, "x": list(where)}, **_totals(p), **_lists(x=x, p=p(x))}


def _gap(solution: Any, points: int) -> dict[str, Any]:
    left, right = beside(solution, points)
    x = np.concatenate((left, solution.edges, right))
    return _lists(x=x, gap=solution.gap(x))


def _shear(solution: Any, points: int) -> dict[str, Any]:
    x, q = inside(solution, points), solution.shear
    zones = {"stick": solution.stick, "slipping": slipping(solution)}
    return {
        **{name: [list(zone) for zone in found] for name, found in zones.items()},
        **_totals(q),
        **_lists(x=x, q=q(x)),
        **energy_of(solution),
        **_lists(**slip_of(solution, x)),
    }


def _stress(solution: Any, points: int) -> dict[str, Any]:
    x = abscissae(solution, points)
    s = solution.surface_stress(x)
    return _lists(x=x, xx=s.xx, yy=s.yy, xy=s.xy)


def _yield(solution: Any, _points: int) -> dict[str, Any]:
    limit = solution.elastic_limit()
    return {
        "ratio": limit.ratio,
        "load": limit.load,
        "sqrt_j2": limit.stress,
        "places": [list(place) for place in limit.places],
        "criterion": limit.criterion,
    }


SECTIONS: dict[str, Callable[[Any, int], dict[str, Any]]] = {
    "pressure": _pressure,
    "gap": _gap,
    "shear": _shear,
    "check": lambda solution, _: solution.check().as_dict(),
    "energy": lambda solution, _: {"energy_lost": solution.energy_lost},
    "stress": _stress,
    "yield": _yield,
    "tension": lambda solution, _: solution.peak_tension()._asdict(),
}


def _finite(value: Any) -> Any:
    """The same with infinities as text and NumPy's scalars as Python's."""
    if isinstance(value, dict):
        return {key: _finite(v) for key, v in value.items()}
    if isinstance(value, list):
        return [_finite(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and math.isinf(value):
        return "Infinity" if value > 0.0 else "-Infinity"
    return value


# -- grids ----------------------------------------------------------------------------------------


class Grid(NamedTuple):
    """Positions (nx,), depths (ny,), and the stress there in arrays (ny, nx)."""

    x: Array
    y: Array
    stress: Stress


def grid(solution: Any, nx: int = GRID[0], ny: int = GRID[1]) -> Grid:
    """The stress of a solution around the contact."""
    (x1, x2), r = solution.edges, solution.half_width
    x, y = np.linspace(x1 - BESIDE * r, x2 + BESIDE * r, nx), np.linspace(0.0, DEPTH * r, ny)
    return Grid(x, y, solution.stress(x, y[:, None]))


def grid_csv(solution: Any, file: SceneFile, nx: int, ny: int) -> str:
    """The grid as a table, with lines of comment on the scene of the file and its units."""
    units, (x1, x2), found = file.units, solution.edges, grid(solution, nx, ny)
    head = (
        f"{file.title or 'plane contact'} (sie {__version__})",
        repr(solution.scene),
        f"lengths in {units.length}, stresses in {units.stress}, j2 in its square",
        f"contact from x1 = {x1!r} to x2 = {x2!r}",
    )
    x, y = np.meshgrid(found.x, found.y)
    columns = {"x": x, "y": y} | {name: getattr(found.stress, name) for name in COMPONENTS}
    return table_of_columns(head, {name: v.ravel() for name, v in columns.items()})
