"""Files and pictures of the stress hold what the solution says."""

import csv
import io
import json

import numpy as np
import pytest

import sie
from sie.cli import main
from sie.io import scene_file
from sie.io.export import grid_csv
from sie.io.scene_file import SceneFile

STEEL = sie.Elastic(210e3, 0.3)
LOADS = {"normal_load": 500.0, "friction": 0.3, "tangential_load": 150.0}
SCENE = sie.Scene(profile=sie.RoundedFlat(1.0, 50.0), body=STEEL, **LOADS)


def test_the_csv_file_has_one_row_a_point():
    solution = sie.solve(SCENE)
    lines = grid_csv(solution, SceneFile(SCENE, "about"), 7, 5).split("\n", 4)
    assert lines[0].startswith("# about") and lines[4].startswith("x,y,xx,")
    rows = list(csv.DictReader(io.StringIO(lines[4])))
    assert len(rows) == 35
    for row in (rows[0], rows[17], rows[-1]):
        s = solution.stress(float(row["x"]), float(row["y"]))
        assert float(row["xx"]) == pytest.approx(float(s.xx), rel=1e-13)
        assert float(row["j2"]) == pytest.approx(float(s.j2), rel=1e-13)


def test_the_command_writes_the_field_and_the_contours(scene, tmp_path):
    words = ["--want", "stress", "--field", "field.csv", "--grid", "9x4", "--plot", "stress.png"]
    assert main(["solve", scene, *words]) == 0
    assert np.loadtxt(tmp_path / "field.csv", delimiter=",", skiprows=5).shape == (36, 8)
    assert (tmp_path / "stress.png").stat().st_size > 10_000


def test_the_json_text_holds_the_numbers_of_the_solution(scene, capsys):
    main(["solve", scene, "--want", "stress,yield,tension", "--json"])
    found, solution = json.loads(capsys.readouterr().out), sie.solve(scene_file.read(scene).scene)
    assert found["yield"]["ratio"] == solution.elastic_limit().ratio
    assert found["tension"]["value"] == solution.peak_tension().value == 0.0
    assert found["stress"]["xx"][200] == float(
        solution.surface_stress(found["stress"]["x"][200]).xx
    )


def test_the_picture_marks_the_contact_and_the_weakest_points():
    pytest.importorskip("matplotlib")
    from sie.plots.stress_plot import contours  # noqa: PLC0415

    for solution in (sie.solve(SCENE), sie.solve(SCENE).with_(tangential_load=0.0, friction=0.0)):
        axes = contours(solution).axes[0]
        lines = {line.get_label(): line for line in axes.lines}
        assert tuple(lines["contact"].get_xdata()) == solution.edges
        weakest = next(line for line in axes.lines if line.get_marker() == "x")
        assert list(zip(weakest.get_xdata(), weakest.get_ydata(), strict=True)) == list(
            solution.elastic_limit().places
        )
        assert axes.get_ylim()[0] > 0.0 > axes.get_ylim()[1]  # depth runs downwards
