"""Displacements and the boundary of a mesh: exact data for finite-element codes.

A half-plane has no end and a mesh has one. Where the ends of the mesh have the displacements of the
half-plane, a block of four half-widths has the answer of the half-plane as its limit. The study
runs CalculiX where it is installed; the error is the root mean square over the points of the lower
block, over the peak. The control has the ends of a contact under a tenth more load.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

import sie
from sie.io.calculix_deck import deck
from sie.io.mesh_comparison import EXACT, compare
from sie.io.mesh_result import read_mesh
from validation.harness.measures import largest
from validation.harness.records import Claim, Doing, Record, Table, checked

TITLE = "Reference data: displacements, and the ends of a mesh"
SECONDS = (15.0, 60.0)
TIMED = False
STEEL = sie.Elastic(young=210e3, poisson=0.3)
# A shallow punch: a mesh follows the slope of the real body, which the half-plane neglects.
PUNCH = sie.Scene(profile=sie.RoundedFlat(0.4, 2000.0), body=STEEL, half_width=1.0)
SHEARED = sie.Scene(
    profile=sie.RoundedFlat(0.4, 2000.0),
    body=STEEL,
    normal_load=22.86558,
    friction=0.3,
    tangential_load=3.43,
    bulk_stress=0.5,
)
STRESSES = ("sxx", "syy", "sxy", "szz")
BAR = {False: 1e-2, True: 3e-2}  # of the peak, on the finest mesh of a run, whole or quick


def compute(quick: bool) -> Iterator[Record]:
    yield Doing("the box around a contact")
    yield checked(
        unbalanced, (-4.0, 4.0, 0.0, 4.0), (-4.0, 4.0, 0.5, 4.0),
        what="forces on a box of four half-widths, with Q, P and M: largest lack / P",
        by="this project: equilibrium", named="a box that does not reach the surface", high=1e-14,
    )  # fmt: skip
    yield checked(
        apart, SHEARED, replace(SHEARED, tangential_load=3.5),
        what="displacements of both surfaces less gap and slip: largest / displacement",
        by="this project: definition of gap and slip", named="the gap and slip of another Q",
        high=1e-13,
    )  # fmt: skip
    if shutil.which("ccx") is None:
        yield Table("CalculiX is not installed", ("study",), [("not run",)])
        return
    rows = []
    counts = (10, 20) if quick else (20, 40, 80)
    for count in counts:
        yield Doing(f"CalculiX, {count} elements in the half-width")
        rows.append((count, *errors(PUNCH, count).values()))
    wrong = largest(errors(PUNCH, counts[0], 1.1).values())
    head = ("elements in the half-width", *STRESSES)
    yield Table("Error of the stresses with exact ends / peak", head, rows)
    yield Claim(
        f"stresses of the mesh with {counts[-1]} elements in the half-width: largest error / peak",
        "this project: exact ends", largest(rows[-1][1:]), wrong,
        "the ends of a tenth more load", high=BAR[quick],
    )  # fmt: skip


def unbalanced(box: tuple[float, float, float, float]) -> float:
    """The largest of the sums of forces and moments, with those of the contact, over P."""
    solution = sie.solve(SHEARED)
    found = solution.boundary_data(box=box, kind="traction", spacing=0.25).resultant
    loads = SHEARED.tangential_load, solution.normal_load, solution.moment
    return float(np.abs(np.add(found, loads)).max() / solution.normal_load)


def apart(scene: sie.Scene) -> float:
    """Displacements of the surfaces of SHEARED less the gap and slip of a scene."""
    solution, other = sie.solve(SHEARED), sie.solve(scene)
    x1, x2 = solution.edges
    x = np.linspace(x1, x2, 203)[1:-1]
    body, indenter = (solution.displacement(x, 0.0 * x, name) for name in ("body", "indenter"))
    normal = body.y - indenter.y - other.gap(x) + scene.profile.height(x)
    along = indenter.x - body.x - other.slip(x)
    return float(np.abs([normal, along]).max() / np.abs(body.y).max())


def errors(scene: sie.Scene, count: int, loaded: float = 1.0) -> dict[str, float]:
    """Of each stress in a mesh whose ends are those of so many times the load."""
    solution = sie.solve(scene)
    load = loaded * solution.normal_load
    ends = sie.solve(replace(scene, half_width=None, normal_load=load))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "punch.inp"
        file.write_text(deck([ends], count), encoding="utf-8")
        subprocess.run(["ccx", "punch"], cwd=folder, capture_output=True, check=True)
        mesh = compare(solution, read_mesh(file.with_suffix(".frd")), 1.0).mesh
    found = {}
    for name in STRESSES:
        x, y, values = mesh.fields[name]
        exact = EXACT[name](solution, x, y)
        found[name] = float(np.sqrt(np.mean((values - exact) ** 2)) / np.abs(exact).max())
    return found
