"""An answer for other programs: CSV and JSON.

    CSV    4 comment lines (#): title and version, scene, units, edges and load;  then  x,p,gap  and one row per point
           with shear also the columns q and slip
           pandas.read_csv(file, comment="#")      numpy.loadtxt(file, delimiter=",", skiprows=5)

    JSON   sie, title, units {length, force, stress, moment}, scene (the code that rebuilds it), modulus E*, dundurs β        always
           edges [x1, x2], sharp [.., ..], half_width, centre, normal_load, moment, tilt, notes [text, ..]                   always
           pressure {peak {p, x: [..]}, resultant, moment, x: [..], p: [..]}                                         if wanted
           gap {x: [..], gap: [..]}                                                                                  if wanted
           shear {stick [[lo, hi], ..], slipping [[lo, hi, sign of q], ..], resultant, moment, energy_lost if known, x: [..], q: [..],
                  slip: [..]}                                                                                        if wanted
           path [{normal_load, tangential_load, bulk_stress, stick, energy_lost}, ..]                       if the scene has one
           check {residual, force, moment, lowest_pressure, lowest_gap, abscissae, resolution, edges, tol, tension, overlap,
                  notes, error, ok}                                                                                  if wanted
           traces [{points, smoothing, averaged, separated, misfit, outliers [[x, off], ..],
                  gaps [{lo, hi, missing}, ..], mended {left_out, averaged, sorted}, tilt, aside,
                  pressure_error, inner_error, edge_errors [x1, x2]}, ..]          if check is wanted, of measured traces
           stress {x, xx, yy, xy: [..]} on the surface                                                               if wanted
           yield {ratio P/(bk), load P/k, sqrt_j2, places [[x, y], ..], criterion};  tension {value, x}              if wanted

Floats are written as `repr` writes them, so that nothing is lost. JSON has no infinity: it is the string "Infinity" or "-Infinity", which
Python's float(), NumPy and JavaScript's Number() read as the number; in CSV it is inf.
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie import __version__
from sie.contact.small_strains import notes
from sie.errors import ContactError
from sie.history import Followed
from sie.plan import UNASKED
from sie.solution import Solution

from .sample_points import POINTS, abscissae, beside, inside, peak
from .scene_file import SceneFile

Array = NDArray[np.float64]

NEED_SHEAR = {"shear", "stress", "yield", "tension", "check"}


def wanted(file: SceneFile) -> tuple[str, ...]:
    """What a scene file asks for: the contact, if it does not say."""
    return file.want or UNASKED


def csv_text(solution: Solution, file: SceneFile, points: int = POINTS) -> str:
    """x, pressure and gap, whatever is wanted, as the module's docstring describes."""
    x = abscissae(solution, points)
    units, (x1, x2) = file.units, solution.edges
    columns = {"x": x, "p": solution.pressure(x), "gap": solution.gap(x)}
    if solution.carries_shear:
        columns |= {"q": solution.shear(x)} | slip_of(solution, x)
    stresses, lengths = (
        " and ".join(name for name in columns if (name in "pq") is stress)
        for stress in (True, False)
    )
    head = (
        f"# {file.title or 'plane contact'} (sie {__version__})",
        f"# {solution.scene!r}",
        f"# {lengths} in {units.length}, {stresses} in {units.stress}, load in {units.force}",
        f"# contact from x1 = {x1!r} to x2 = {x2!r}, load {solution.normal_load!r}",
        ",".join(columns),
    )
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
        "units": {
            "length": units.length,
            "force": units.force,
            "stress": units.stress,
            "moment": units.moment,
        },
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
        "notes": list(notes_of(solution, file)),
    }
    sections = {"pressure": _pressure, "gap": _gap, "shear": _shear, "check": _check}
    sections |= {"stress": _stress, "yield": _yield, "tension": _tension}
    if isinstance(solution, Followed):
        out["path"] = turning_points(solution)
    if "check" in wanted(file) and (reports := solution.trace_reports()):
        out["traces"] = [report.as_dict() for report in reports]
    return out | {
        name: section(solution, points)
        for name, section in sections.items()
        if name in wanted(file)
    }


def notes_of(solution: Solution, file: SceneFile) -> tuple[str, ...]:
    """The notes on strains that are not small, and on slip where a wanted quantity depends on it.

    Where nothing but the edges is wanted the pressure is not computed: its mean is looked at.
    """
    if NEED_SHEAR & set(wanted(file)):
        return solution.notes
    if set(wanted(file)) != {"edges"} or solution.scene.bonded:
        return solution.strain_notes
    slopes = solution.scene.profile.slope(np.linspace(*solution.edges, POINTS)) + solution.tilt
    return notes(slopes, solution.normal_load / (2.0 * solution.half_width) / solution.scene.Estar)


def _pressure(solution: Solution, points: int) -> dict[str, Any]:
    p, x = solution.pressure, inside(solution, points)
    largest, where = peak(solution)
    return {
        "peak": {"p": largest, "x": list(where)},
        "resultant": p.resultant,
        "moment": p.moment,
        "x": x.tolist(),
        "p": p(x).tolist(),
    }


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
    if solution.scene.coupled:
        return solution.coupled[1].slip_zones
    if not solution.sheared:
        return ()
    x1, x2 = solution.edges
    return tuple(
        z for z in solution.tangential.slipped if x1 <= z[0] and z[1] <= x2
    )  # not what the contact has left


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


def turning_points(solution: Followed) -> list[dict[str, Any]]:
    """The loads of each point of a path, where the bodies stick there, and the energy lost on the way to it."""
    names = ("normal_load", "tangential_load", "bulk_stress")
    points = zip(solution.history.path.points, solution.history, strict=True)
    return [
        dict(zip(names, loads, strict=True))
        | (
            {"stick": [list(zone) for zone in at.stick], "energy_lost": at.energy_lost}
            if loads[0]
            else {"stick": [], "energy_lost": 0.0}
        )
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
    return {
        "ratio": found.ratio,
        "load": found.load,
        "sqrt_j2": found.stress,
        "places": places,
        "criterion": found.criterion,
    }


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
    return (
        ("Infinity" if value > 0.0 else "-Infinity")
        if isinstance(value, float) and math.isinf(value)
        else value
    )
