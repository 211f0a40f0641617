"""Files and pictures of the stress hold what the solution says, and what cannot be written is
refused before work.
"""

import base64
import csv
import io
import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import sie
from sie.cli import main
from sie.io import scene_file
from sie.io.scene_file import SceneFile
from sie.io.stress_grid import Grid, file_bytes

STEEL = sie.Elastic(210e3, 0.3)
SCENE = sie.Scene(
    profile=sie.RoundedFlat(1.0, 50.0),
    body=STEEL,
    normal_load=500.0,
    friction=0.3,
    tangential_load=150.0,
)


@pytest.fixture(scope="module")
def grid():
    return Grid(sie.solve(SCENE), 7, 5)


def test_the_csv_file_has_one_row_a_point(grid):
    lines = file_bytes(grid, "csv", SceneFile(SCENE, "about")).decode().split("\n", 4)
    assert lines[0].startswith("# about") and lines[4].startswith("x,y,xx,")
    rows = list(csv.DictReader(io.StringIO(lines[4])))
    assert len(rows) == 35
    for row in (rows[0], rows[17], rows[-1]):
        s = grid.solution.stress(float(row["x"]), float(row["y"]))
        assert float(row["xx"]) == pytest.approx(float(s.xx), rel=1e-13)
        assert float(row["j2"]) == pytest.approx(float(s.j2), rel=1e-13)


def test_the_npz_file_has_the_arrays(grid):
    data = np.load(io.BytesIO(file_bytes(grid, "npz", SceneFile(SCENE))))
    assert data["xx"].shape == (5, 7)
    assert (data["x"] == grid.x).all() and (data["j2"] == grid.stress.j2).all()


def test_the_vti_file_decodes_to_the_arrays(grid):
    image = ET.fromstring(file_bytes(grid, "vti", SceneFile(SCENE)))[0]
    assert image.get("WholeExtent") == "0 6 0 4 0 0"
    arrays = {a.get("Name"): a for a in image.iter("DataArray")}
    for name, expected in (("j2", grid.stress.j2), ("mises", grid.stress.mises)):
        data = base64.b64decode(arrays[name].text)
        assert np.frombuffer(data[:8], np.uint64)[0] == len(data) - 8
        assert (np.frombuffer(data[8:]) == expected.ravel()).all()
    tensor = np.frombuffer(base64.b64decode(arrays["stress"].text)[8:]).reshape(5, 7, 6)
    assert (tensor[..., 0] == grid.stress.xx).all() and (tensor[..., 3] == grid.stress.xy).all()
    origin, spacing = (
        np.array(image.get(name).split(), dtype=float) for name in ("Origin", "Spacing")
    )
    assert origin[:2] + spacing[:2] * (6, 4) == pytest.approx((grid.x[-1], grid.y[-1]))


TITLES = ["a---b", "]]>", "<!-- & -->", "\x00\x08\x7f\ud800\uffff", "a\nb\u2028c", ""]


@pytest.mark.parametrize("title", TITLES)
def test_with_any_title_the_vti_file_is_xml_and_the_csv_file_has_its_rows(title, grid):
    image = ET.fromstring(file_bytes(grid, "vti", SceneFile(SCENE, title)))
    assert len(list(image.iter("DataArray"))) == 3
    lines = file_bytes(grid, "csv", SceneFile(SCENE, title)).decode("utf-8").split("\n")
    assert lines[0].startswith("# ") and lines[4].startswith("x,y,") and len(lines) == 5 + 35 + 1


def test_the_command_writes_the_field_and_the_contours(scene, tmp_path):
    words = ["--want", "stress", "--field", "field.npz", "--grid", "9x4", "--plot", "stress.png"]
    assert main(["solve", scene, *words]) == 0
    assert np.load(tmp_path / "field.npz")["xx"].shape == (4, 9)
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
