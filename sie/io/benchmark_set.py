"""Twelve contacts with exact references, by which other codes are measured.

The folder `sie/benchmark_set` has a scene file for each case, and a README that describes the set.
A case is a folder: scene file, targets with their certificate, curves, stresses and displacements
on the sides of a box, an input deck of CalculiX that leads to the same state, a page, a picture,
and the hashes of all of these, computed when the set is asked for, with all digits of a double.

>>> case_names()[:3]
('bulk-stress-cycle', 'cattaneo', 'cattaneo-reversal')
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from dataclasses import replace
from importlib import resources
from typing import Any, NamedTuple

from sie import __version__
from sie.progress_bar import counted

from .answers import energy_of
from .calculix_deck import deck
from .export import csv_text, json_text
from .mesh_comparison import largest_shear
from .sample_points import peak
from .scene_file import SceneFile, parse

SET = resources.files("sie") / "benchmark_set"
BOX = 4.0  # half-widths of the box's sides from the contact's middle
PER_HALF_WIDTH = 20  # elements of the deck
PLACES = (0.0, 0.25, 0.5, 0.75, 0.9)  # of the half-width, from the centre of the last patch
ROUNDING = 1e-12  # half-widths
WITHOUT_FRICTION: dict[str, Any] = {"friction": 0.0, "sliding": 0, "tangential_load": 0.0}
WANT = ("edges", "pressure", "gap", "shear", "check", "stress", "yield", "tension")

# the solution of a scene file; of a path that of its last point
Solver = Callable[[SceneFile], Any]


def case_names() -> tuple[str, ...]:
    """The names of the cases, in the order of the alphabet."""
    return tuple(sorted(file.name[:-5] for file in SET.iterdir() if file.name.endswith(".toml")))


def benchmark_set(solved: Solver) -> dict[str, bytes]:
    """The content of every file of the set, by its path in the folder."""
    names = case_names()
    contents: dict[str, bytes] = {}
    rows = ["| case | what | files |", "| --- | --- | --- |"]
    for name in counted("cases", names, len(names)):
        case = case_files(name, solved)
        title = parse(case["scene.toml"], name).title
        hashes = [f"{hashlib.sha256(data).hexdigest()}  {file}\n" for file, data in case.items()]
        case["SHA256SUMS"] = "".join(hashes).encode()
        contents |= {f"{name}/{file}": data for file, data in case.items()}
        rows.append(f"| [{name}]({name}/README.md) | {title} | {len(case)} |")
    readme = (SET / "README.md").read_text(encoding="utf-8")
    index = "\n".join([*rows, "", f"Computed by plane-contact {__version__}.", ""])
    return contents | {"README.md": (readme + index).encode()}


def case_files(name: str, solved: Solver) -> dict[str, bytes]:
    """The content of the files of one case."""
    scene = (SET / f"{name}.toml").read_bytes()
    file = replace(parse(scene, f"{name}.toml"), want=WANT)
    states = _states(file, solved)
    solution = states[-1]
    curves, answer = csv_text(solution, file), json_text(solution, file)
    r = max(map(abs, solution.edges))
    side = min(BOX * r, 0.5 * file.scene.profile.period)
    boxes = {"body": (-side, side, 0.0, BOX * r), "indenter": (-side, side, -BOX * r, 0.0)}
    kinds = ("displacement", "traction")
    bounds = {
        f"{kind}-{body}.csv": solution.boundary_data(box=box, kind=kind, body=body).csv()
        for body, box in boxes.items()
        for kind in kinds
        if kind == "displacement" or solution.tractions_of(body) is not None
    }
    found = targets(solution) + _without_friction(solution)
    certificate = solution.check().error
    rows = [(t.name, repr(t.value), getattr(file.units, t.unit)) for t in found]
    table = [f'"{name}",{value},{unit},{certificate:.1e}' for name, value, unit in rows]
    texts = {
        "targets.csv": "\n".join(["name,value,unit,certificate", *table, ""]),
        "curves.csv": curves,
        "answer.json": answer,
        **bounds,
        "deck.inp": deck(states, PER_HALF_WIDTH),
        "README.md": _page(name, file.title, rows, certificate),
    }
    encoded = {"scene.toml": scene} | {key: text.encode() for key, text in texts.items()}
    return encoded | _picture(solution, file)


def _states(file: SceneFile, solved: Solver) -> list[Any]:
    """The states that a code has to lead through: bodies of one material press without friction."""
    solution, scene = solved(file), file.scene
    history = list(solution.history or [solution])
    if not scene.friction or scene.coupled:
        return history
    P = history[0].normal_load
    pressed = replace(scene, normal_load=P, half_width=None, bulk_stress=0.0, **WITHOUT_FRICTION)
    return [solved(replace(file, scene=pressed, load_path=None)), *history]


def _page(name: str, title: str, rows: list[tuple[str, str, str]], certificate: float) -> str:
    """The page of a case: what it is, its picture, its targets."""
    lines = (SET / f"{name}.toml").read_text(encoding="utf-8").splitlines()
    about = " ".join(line[2:] for line in lines[: lines.index("")])
    listed = "\n".join(f"| {name} | {value} | {unit} |" for name, value, unit in rows)
    return f"""# {title}

{about}

![The contact](picture.png)

Certified relative error of the pressure: {certificate:.1e} of its peak.

| target | value | unit |
| --- | --- | --- |
{listed}

    sie solve scene.toml            computes it anew
    ccx deck                        blocks of four half-widths with exact ends
    sie compare scene.toml deck.frd
"""


def _picture(solution: Any, file: SceneFile) -> dict[str, bytes]:
    """The picture, where Matplotlib is installed."""
    try:
        from sie.plots import contact_plot, style  # noqa: PLC0415 -- needs Matplotlib
    except ImportError:
        return {}
    figure = contact_plot.picture(solution, file.units, file.title)
    return {"picture.png": style.picture_bytes(figure, "png")}


# -- targets ---------------------------------------------------------------------------------------


class Target(NamedTuple):
    """A quantity, its exact value and its unit: length, force, stress, or moment and energy."""

    name: str
    value: float
    unit: str


def targets(solution: Any) -> list[Target]:
    """All that the scene determines; of a symmetric contact the places on x > 0."""
    (lo, hi), (height, places) = solution.patches[-1], peak(solution)
    found = [
        Target("x1, edge of the contact", lo, "length"),
        Target("x2, edge of the contact", hi, "length"),
        Target("P", solution.normal_load, "force"),
        Target("p_max", height, "stress"),
        Target("x of p_max", places[-1], "length"),
    ]
    for place in PLACES:
        x = _place(solution, 0.5 * (lo + hi) + 0.5 * place * (hi - lo))
        found.append(Target(f"p at x = {x!r}", float(solution.pressure(x)), "stress"))
    if solution.carries_shear:
        found += _of_shear(solution)
    moved = solution.displacement(solution.centre, 0.0)
    x, y = (_place(solution, v) for v in moved.zero)
    approach = Target(f"approach of (x, ±y) = ({x!r}, {y!r})", moved.approach, "length")
    found += [*_of_stress(solution), approach]
    return [t._replace(value=_place(solution, t.value)) if t.unit == "length" else t for t in found]


def _place(solution: Any, x: float) -> float:
    """The place, 0 where it is 0 to rounding."""
    return x if abs(x) > ROUNDING * solution.half_width else 0.0


def _of_shear(solution: Any) -> list[Target]:
    found = [Target("Q", solution.tangential_load, "force")]
    for lo, hi in solution.stick[-1:]:
        found += [Target("stick from", lo, "length"), Target("stick to", hi, "length")]
    q, x = largest_shear(solution)
    found += [Target("q_max", q, "stress"), Target("x of q_max", x, "length")]
    return found + [Target("energy lost", v, "moment") for v in energy_of(solution).values()]


def _of_stress(solution: Any) -> list[Target]:
    """The largest stresses of the body, and their places."""
    tension, yielding = solution.peak_tension(), solution.elastic_limit()
    x, y = yielding.places[-1]
    return [
        Target("sxx_max on the surface", tension.value, "stress"),
        Target("x of sxx_max", tension.x, "length"),
        Target("mises_max in the body", math.sqrt(3.0) * yielding.stress, "stress"),
        Target("x of mises_max", x, "length"),
        Target("y of mises_max, the depth", y, "length"),
    ]


def _without_friction(solution: Any) -> list[Target]:
    """The largest stresses of the same contact before it slides."""
    scene = solution.scene
    if not scene.slides or scene.beta:
        return []
    plain = _of_stress(solution.with_(**WITHOUT_FRICTION))
    return [t._replace(name=f"{t.name}, without friction") for t in plain]
