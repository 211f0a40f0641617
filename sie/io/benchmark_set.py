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
from dataclasses import replace
from importlib import resources
from typing import Any

from sie import __version__
from sie.paths.history import follow
from sie.progress_bar import counted
from sie.solution import Solution, solve

from .calculix_deck import deck
from .export import csv_text, json_text
from .scene_file import SceneFile, Units, parse
from .targets import Target, of_stress, targets

SET = resources.files("sie") / "benchmark_set"
BOX = 4.0  # half-widths of the box's sides from the contact's middle
PER_HALF_WIDTH = 20  # elements of the deck
WANT = ("edges", "pressure", "gap", "shear", "check", "stress", "yield", "tension")


def case_names() -> tuple[str, ...]:
    """The names of the cases, in the order of the alphabet."""
    return tuple(sorted(file.name[:-5] for file in SET.iterdir() if file.name.endswith(".toml")))


def benchmark_set() -> dict[str, bytes]:
    """The content of every file of the set, by its path in the folder."""
    names = case_names()
    contents: dict[str, bytes] = {}
    rows = ["| case | what | files |", "| --- | --- | --- |"]
    for name in counted("cases", names, len(names)):
        case = case_files(name)
        title = parse(case["scene.toml"], name).title
        hashes = [f"{hashlib.sha256(data).hexdigest()}  {file}\n" for file, data in case.items()]
        case["SHA256SUMS"] = "".join(hashes).encode()
        contents |= {f"{name}/{file}": data for file, data in case.items()}
        rows.append(f"| [{name}]({name}/README.md) | {title} | {len(case)} |")
    readme = (SET / "README.md").read_text(encoding="utf-8")
    index = "\n".join([*rows, "", f"Computed by plane-contact {__version__}.", ""])
    return contents | {"README.md": (readme + index).encode()}


def case_files(name: str) -> dict[str, bytes]:
    """The content of the files of one case."""
    scene = (SET / f"{name}.toml").read_bytes()
    file = replace(parse(scene, f"{name}.toml"), want=WANT)
    states = _states(file)
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
    texts = {
        "targets.csv": _table(found, certificate, file.units),
        "curves.csv": curves,
        "answer.json": answer,
        **bounds,
        "deck.inp": deck(states, PER_HALF_WIDTH),
        "README.md": _page(name, file, found, certificate),
    }
    encoded = {"scene.toml": scene} | {key: text.encode() for key, text in texts.items()}
    return encoded | _picture(solution, file)


def _states(file: SceneFile) -> list[Solution]:
    """The states that a code has to lead through: bodies of one material press without friction."""
    scene = file.scene
    history = list(follow(scene, file.load_path)) if file.load_path else [solve(scene)]
    if not scene.friction or scene.coupled:
        return history
    plain = replace(
        scene,
        friction=0.0,
        tangential_load=0.0,
        bulk_stress=0.0,
        sliding=0,
        normal_load=history[0].normal_load,
        half_width=None,
    )
    return [solve(plain), *history]


def _without_friction(solution: Solution) -> list[Target]:
    """The largest stresses of the same contact before it slides."""
    scene = solution.scene
    if not scene.slides or scene.beta:
        return []
    plain = solve(replace(scene, friction=0.0, sliding=0, tangential_load=0.0))
    return [t._replace(name=f"{t.name}, without friction") for t in of_stress(plain)]


def _table(found: list[Target], certificate: float, units: Units) -> str:
    rows = [f'"{t.name}",{t.value!r},{getattr(units, t.unit)},{certificate:.1e}' for t in found]
    return "\n".join(["name,value,unit,certificate", *rows, ""])


def _page(name: str, file: SceneFile, found: list[Target], certificate: float) -> str:
    """The page of a case: what it is, its picture, its targets."""
    lines = (SET / f"{name}.toml").read_text(encoding="utf-8").splitlines()
    about = " ".join(line[2:] for line in lines[: lines.index("")])
    rows = [f"| {t.name} | {t.value!r} | {getattr(file.units, t.unit)} |" for t in found]
    return "\n".join(
        [
            f"# {file.title}",
            "",
            about,
            "",
            "![The contact](picture.png)",
            "",
            f"Certified relative error of the pressure: {certificate:.1e} of its peak.",
            "",
            "| target | value | unit |",
            "| --- | --- | --- |",
            *rows,
            "",
            "    sie solve scene.toml            computes it anew",
            "    ccx deck                        blocks of four half-widths with exact ends",
            "    sie compare scene.toml deck.frd",
            "",
        ]
    )


def _picture(solution: Solution, file: SceneFile) -> dict[str, bytes]:
    """The picture, where Matplotlib is installed."""
    try:
        from sie.plots import contact_plot, style  # noqa: PLC0415 -- needs Matplotlib
    except ImportError:
        return {}
    figure: Any = contact_plot.picture(solution, file.units, file.title)
    return {"picture.png": style.picture_bytes(figure, "png")}
