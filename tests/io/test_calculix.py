"""A real run of CalculiX (Debian's calculix-ccx) comes near the exact contact, and nearer on a
finer mesh. Finer meshes and the stress in the blocks are studied in docs/how-to/punch_study.py.
"""

import re
import runpy
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

import sie
from sie.io.mesh_comparison import compare
from sie.io.mesh_result import read_mesh

PUNCH_DECK = Path(__file__).parents[2] / "docs" / "how-to" / "punch_deck.py"
GUIDE = PUNCH_DECK.with_name("verify-a-mesh.md")
PUNCH = sie.Scene(
    profile=sie.RoundedFlat(half_flat=0.4, radius=20.0),
    body=sie.Elastic(young=210e3, poisson=0.3),
    normal_load=2286.558,
)
pytestmark = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX is not installed: apt install calculix-ccx"
)


def ran(scene, per_half_width, folder):
    """The results of CalculiX, with `per_half_width` elements in half the contact."""
    script = runpy.run_path(str(PUNCH_DECK))
    file = folder / f"punch-{per_half_width}.inp"
    file.write_text(script["deck"](scene, per_half_width))
    return script["run"](file)


def typed(row):
    """The errors that the guide gives for 10, 20, 40 and 80 elements in the half-width."""
    line = re.search(rf"^\| {row} \|(.*)\|$", GUIDE.read_text(encoding="utf-8"), re.MULTILINE)
    return [float(cell) for cell in line[1].split("|")]


@pytest.mark.slow
def test_a_mesh_comes_near_the_exact_pressure_and_nearer_if_it_is_finer(tmp_path):
    errors = []
    for count in (10, 20):
        found = compare(sie.solve(PUNCH), read_mesh(ran(PUNCH, count, tmp_path)), 1e-2)
        errors.append(found.differences["p"].l2)
    assert errors[1] < 0.03
    assert errors[1] < 0.6 * errors[0]
    assert errors == pytest.approx(typed("p, without friction")[:2], rel=0.1)


@pytest.mark.slow
def test_a_mesh_comes_near_the_exact_contact_with_friction(tmp_path):
    scene = replace(PUNCH, friction=0.3, tangential_load=343.0)
    results = ran(scene, 10, tmp_path)
    at_nodes = compare(sie.solve(scene), read_mesh(results), 1e-2)
    assert at_nodes.differences["p"].l2 < 0.06
    assert at_nodes.differences["q"].l2 < 0.12
    assert abs(at_nodes.differences["q"].resultant) < 0.05
    for name, symbol in (("p", "p"), ("q", "q"), ("sxx", "σ_xx"), ("syy", "σ_yy")):
        found = typed(f"{symbol}, friction 0.3")[0]
        assert at_nodes.differences[name].l2 == pytest.approx(found, rel=0.1)
