"""Exact data on the boundary of a mesh: equilibrium, files that a deck includes, node sets."""

import csv
import re
import shutil
import subprocess

import numpy as np
import pytest

import sie
from sie.cli import main

STEEL = sie.Elastic(210e3, 0.3)
SCENES = {
    "rounded flat": {"profile": sie.RoundedFlat(1.0, 50.0), "moment": 60.0, "bulk_stress": 30.0},
    "two patches": {
        "profile": sie.Row([sie.Parabola(50.0).shifted(-0.5), sie.Parabola(40.0).shifted(0.5)])
    },
    "sharp edges": {"profile": sie.Flat(1.0), "tangential_load": 0.0, "friction": 0.0},
}
SOLVED = {
    name: sie.solve(
        sie.Scene(
            body=STEEL, normal_load=500.0, **{"friction": 0.3, "tangential_load": 80.0, **given}
        )
    )
    for name, given in SCENES.items()
}
EVERY = pytest.mark.parametrize("solution", SOLVED.values(), ids=SOLVED)
DECK = """** two elements
*NODE, NSET=ALL
1, -2., 0.
2,  0., 0.
3,  2., 0.
4, -2., -2.
5,  0., -2.
6,  2., -2.
*ELEMENT, TYPE=CPE4, ELSET=E
1, 4, 5, 2, 1
2, 5, 6, 3, 2
*NSET, NSET=BOTTOM, GENERATE
4, 6, 1
*Nset, nset=Outer
BOTTOM, 1,
3
"""
SCENE = """
profile = { kind = "parabola", radius = 50.0 }
body = { young = 210e3, poisson = 0.3 }
load = { normal_load = 500.0, tangential_load = 80.0, friction = 0.3 }
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(SCENE)
    (tmp_path / "deck.inp").write_text(DECK)
    return tmp_path


@EVERY
@pytest.mark.parametrize("body", ["body", "indenter"])
def test_the_forces_on_a_box_balance_the_loads_of_the_contact(solution, body):
    r = 4.0 * solution.half_width
    sign, box = (1.0, (-r, 1.1 * r, 0.0, r)) if body == "body" else (-1.0, (-r, 1.1 * r, -r, 0.0))
    data = solution.boundary_data(box=box, kind="traction", body=body)
    wanted = np.array([80.0 * bool(solution.scene.friction), 500.0, solution.moment])
    assert np.abs(np.array(data.resultant) + sign * wanted).max() < 2e-13 * 500.0


@EVERY
def test_a_closed_box_away_from_the_surface_is_in_equilibrium(solution):
    data = solution.boundary_data(box=(-3.0, 4.0, 0.5, 2.5), spacing=0.1, kind="traction")
    assert np.abs(data.resultant).max() < 1e-12 * 500.0
    assert data.values["t_y"] @ data.values["n_y"] != 0.0


def test_tractions_are_the_stress_times_the_outward_normal():
    solution = SOLVED["rounded flat"]
    data = solution.boundary_data(box=(-3.0, 4.0, 0.0, 2.5), spacing=0.5, kind="traction")
    s = solution.stress(data.x, data.y)
    n_x, n_y = data.values["n_x"], data.values["n_y"]
    assert np.array_equal(data.values["t_x"], s.xx * n_x + s.xy * n_y)
    assert np.array_equal(data.values["t_y"], s.xy * n_x + s.yy * n_y)
    assert set(map(tuple, np.column_stack((n_x, n_y)).tolist())) == {(-1, 0), (1, 0), (0, 1)}


def test_displacements_stand_once_at_a_corner_and_nowhere_on_the_surface_between():
    data = SOLVED["rounded flat"].boundary_data(box=(-3.0, 3.0, 0.0, 3.0), spacing=1.0)
    places = set(zip(data.x.tolist(), data.y.tolist(), strict=True))
    assert len(places) == len(data.x) == 13
    u = SOLVED["rounded flat"].displacement(data.x, data.y)
    assert np.array_equal(data.values["u_x"], u.x) and np.array_equal(data.values["u_y"], u.y)


def test_a_table_has_all_digits_and_keywords_have_y_upward(tmp_path):
    data = SOLVED["rounded flat"].boundary_data([(1.0, 2.0), (-1.0, 2.0)], labels=[7, 9])
    for name in ("ends.csv", "ends.inp"):
        data.write(tmp_path / name)
    lines = (tmp_path / "ends.csv").read_text().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert [float(row["u_y"]) for row in rows] == data.values["u_y"].tolist()
    cards = [line for line in (tmp_path / "ends.inp").read_text().splitlines() if line[:2] != "**"]
    assert cards[0] == "*BOUNDARY"
    assert [line.split(", ")[:3] for line in cards[1:]] == [
        [n, k, k] for n in ("7", "9") for k in ("1", "2")
    ]
    assert float(cards[2].split(", ")[3]) == pytest.approx(-data.values["u_y"][0], rel=1e-13)
    assert all(len(cell) <= 20 for line in cards[1:] for cell in re.split(", ?", line))
    with pytest.raises(ValueError, match=r"neither \.csv nor \.inp"):
        data.write(tmp_path / "ends.txt")


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({}, "neither of points and box"),
        ({"box": (0.0, 1.0, 0.0)}, "has 3 numbers"),
        ({"box": (1.0, 0.0, 0.0, 1.0)}, "is empty"),
        ({"box": (0.0, 1.0, 0.0, 1.0), "spacing": 1e-9}, "more than 1000000 points"),
        ({"box": (0.0, 1.0, 0.0, 1.0), "kind": "force"}, "give 'displacement' or 'traction'"),
        ({"box": (0.0, 1.0, -1.0, 1.0)}, "depths y >= 0"),
        ({"points": [1.0, 2.0]}, "rows"),
        ({"points": [(0, 0.5), (1, 1), (2, 2)], "kind": "traction"}, "on no side of the box"),
        ({"points": [(0, 1), (1, 1)], "labels": [1]}, "1 labels of 2 points"),
        ({"points": [(0, 1), (1, 1)], "labels": [1.5, 2.5]}, "labels"),
    ],
)
def test_what_has_no_answer_is_refused_before_any_work(asked, words):
    with pytest.raises(ValueError, match=words):
        SOLVED["rounded flat"].boundary_data(**asked)


def test_a_side_at_a_sharp_edge_has_infinite_tractions_there_but_finite_forces():
    data = SOLVED["sharp edges"].boundary_data(box=(-1.0, 1.0, 0.0, 1.0), kind="traction")
    assert not any(np.isnan(column).any() for column in data.values.values())
    np.testing.assert_allclose(data.resultant, (0.0, -500.0, 0.0), atol=5.0)


def test_a_rigid_body_has_displacements_and_no_tractions():
    scene = sie.Scene(profile=sie.Parabola(50.0), body=STEEL, indenter=sie.RIGID, normal_load=500.0)
    solution, box = sie.solve(scene), (-1.0, 1.0, -1.0, 0.0)
    moved = solution.boundary_data(box=box, body="indenter")
    assert np.ptp(moved.values["u_y"]) == 0.0 < moved.values["u_y"][0]
    with pytest.raises(ValueError, match="but no stress"):
        solution.boundary_data(box=box, body="indenter", kind="traction")


def test_the_command_gives_the_nodes_of_a_set_their_displacements(folder, capsys):
    command = ["export-boundary", "scene.toml", "--nodes", "deck.inp", "--set", "outer"]
    assert main([*command, "--csv", "ends.csv", "--zero", "0,-2"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line[:2] != "**"]
    assert lines[0] == "*BOUNDARY"
    labels = [int(line.split(",")[0]) for line in lines[1:]]
    assert labels == [1, 1, 3, 3, 4, 4, 5, 5, 6, 6]
    held = [float(line.split(",")[3]) for line in lines[7:9]]  # node 5
    assert held == pytest.approx([0.0, 0.0], abs=1e-16)
    assert (folder / "ends.csv").read_text().count("\n") == 5 + 5


def test_the_command_gives_nodal_forces(folder, capsys):
    command = ["export-boundary", "scene.toml", "--nodes", "deck.inp", "--kind", "traction"]
    assert main([*command, "--set", "OUTER"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line[:2] != "**"]
    forces = [(int(a), float(b)) for _, a, b in (line.split(",") for line in lines[1:])]
    assert sum(f for k, f in forces if k == 1) == pytest.approx(-80.0, abs=1e-9)
    assert sum(f for k, f in forces if k == 2) == pytest.approx(500.0, abs=1e-9)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("", "needs --nodes, --set"),
        ("--nodes deck.inp --set OUTR", 'did you mean "OUTER"'),
        ("--nodes deck.inp --set OUTER --body above", "is not in the indenter"),
        ("--nodes nothing.inp --set OUTER", "No such file"),
        ("--nodes deck.inp --set OUTER --csv deck.inp", "would overwrite the file of nodes"),
    ],
)
def test_the_command_refuses_in_one_sentence(folder, capsys, options, words):
    assert main(["export-boundary", "scene.toml", *options.split()]) == 2
    out, err = capsys.readouterr()
    assert out == "" and words in err and err.count("\n") == 1
    assert (folder / "deck.inp").read_text() == DECK


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_reads_the_lines(folder, capsys):
    command = ["export-boundary", "scene.toml", "--nodes", "deck.inp", "--set", "OUTER"]
    assert main(command) == 0
    (folder / "outer.inp").write_text(capsys.readouterr().out)
    more = "*MATERIAL,NAME=M\n*ELASTIC\n210e3,0.3\n*SOLID SECTION,ELSET=E,MATERIAL=M\n1.\n*STEP\n"
    more += "*STATIC\n*INCLUDE,INPUT=outer.inp\n*NODE FILE,OUTPUT=2D\nU\n*END STEP\n"
    (folder / "run.inp").write_text(DECK + more)
    done = subprocess.run(["ccx", "run"], cwd=folder, capture_output=True, text=True, check=False)
    assert "Job finished" in done.stdout and "*ERROR" not in done.stdout


def test_a_point_that_keeps_its_place_has_two_coordinates():
    scene = sie.Scene(profile=sie.Parabola(1.0), body=sie.Elastic(210e3, 0.3), normal_load=5.0)
    with pytest.raises(ValueError, match="has 3 numbers: give the point"):
        sie.solve(scene).displacement(0.0, 1.0, zero=(0.0, 1.0, 2.0))
