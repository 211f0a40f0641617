"""JSON, CSV and reports of the command line equal what the library computes."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from command_scenes import KINDS, example, sentence

import sie
from sie.cli import main
from sie.io import report, sample_points, scene_file


def strict(text):
    """JSON without the NaN and Infinity that Python would accept."""
    return json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))


def rows_of(name):
    """The rows of a CSV file by the names of its columns."""
    lines = Path(name).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_printed_and_written_of_an_example_is_what_the_library_computes(
    kind, tmp_path, capsys
):
    """The JSON is strict, and equal to the last digit, as the CSV is; the answer is certified."""
    path, json_path, csv_path = example(kind, tmp_path), tmp_path / "out.json", tmp_path / "out.csv"
    outputs = ["--json", str(json_path), "--csv", str(csv_path), "--points", "50"]
    assert main(["solve", path, *outputs]) == 0
    out, err = capsys.readouterr()
    assert "\ncertified to " in out and "█" in out and err == ""
    file, found = scene_file.read(path), strict(json_path.read_text(encoding="utf-8"))
    solution = sie.solve(file.scene)
    assert tuple(found["edges"]) == solution.edges and tuple(found["sharp"]) == solution.sharp
    for name in ("half_width", "centre", "normal_load", "moment", "tilt"):
        assert found[name] == getattr(solution, name)
    pressure, gap = found["pressure"], found["gap"]
    np.testing.assert_array_equal(
        np.array(pressure["p"], dtype=float), solution.pressure(np.array(pressure["x"]))
    )
    np.testing.assert_array_equal(
        np.array(gap["gap"], dtype=float), solution.gap(np.array(gap["x"]))
    )
    assert float(pressure["peak"]["p"]) == max(map(float, [*pressure["p"], pressure["peak"]["p"]]))
    assert found["check"] == solution.check().as_dict() and found["check"]["ok"] is True
    assert sie.Scene.from_dict(found["scene"]) == solution.scene
    text = csv_path.read_text(encoding="utf-8").splitlines()
    assert [line.startswith("#") for line in text[:5]] == [True] * 4 + [False]
    assert file.title in text[0] and "mm" in text[2] and "MPa" in text[2]
    x, p, gap = (
        np.array([float(r[name]) for r in rows_of(csv_path)]) for name in ("x", "p", "gap")
    )
    np.testing.assert_array_equal(p, solution.pressure(x))
    np.testing.assert_array_equal(gap, solution.gap(x))
    assert (np.diff(x) > 0).all()
    # A break of a trace is no place of its own.
    breaks = file.scene.profile.breaks if kind != "sampled" else ()
    assert {*solution.edges, *(b for b in breaks if x[0] < b < x[-1])} <= set(x.tolist())


def test_the_shear_in_sliding_is_in_the_report_the_json_and_the_csv(tmp_path, monkeypatch, capsys):
    """Of dissimilar bodies: how far they slipped before they slid is not known."""
    monkeypatch.chdir(tmp_path)
    path = example("sliding", tmp_path)
    solution = sie.solve(scene_file.read(path).scene)
    assert main(["solve", path, "--want", "shear", "--csv", "out.csv"]) == 0
    assert "Q = 12 N/mm; f P = 12" in capsys.readouterr().out
    rows = rows_of("out.csv")
    assert [float(row["q"]) for row in rows] == pytest.approx(
        [0.6 * float(row["p"]) for row in rows], rel=1e-15
    )
    assert main(["solve", path, "--want", "shear", "--json"]) == 0
    shear = strict(capsys.readouterr().out)["shear"]
    assert shear["slipping"] == [[*solution.edges, 1.0]] and shear["stick"] == []
    assert shear["resultant"] == solution.shear.resultant and "energy_lost" not in shear


def test_the_shear_of_bonded_bodies_is_reported(tmp_path):
    flat = sie.Scene(
        profile=sie.Flat(2.0), modulus=500.0, dundurs=0.3, poisson=0.3, normal_load=20.0,
        friction=np.inf, tangential_load=3.0,
    )  # fmt: skip
    told = str(report.Rows(sie.solve(flat), scene_file.UNITS).shear())
    assert "Q = 3" in told and "bonded" in told and "inf" not in told


def test_json_and_csv_go_to_a_file_or_alone_to_standard_output(scene, tmp_path, capsys):
    main(["solve", scene, "--want", "check", "--json"])
    printed = capsys.readouterr().out
    assert strict(printed).keys() & {"check", "pressure", "gap"} == {"check"}
    main(["solve", scene, "--want", "check", "--json", "out.json"])
    assert (tmp_path / "out.json").read_text() == printed
    assert "wrote out.json" in capsys.readouterr().out
    main(["solve", scene, "--csv", "-"])
    assert capsys.readouterr().out.startswith("# Fretting pad")


def test_csv_points_resolve_a_rounded_edge_of_a_thousandth_of_the_contact():
    pad = sie.RoundedFlat(0.999, 20.0)
    solution = sie.solve(sie.Scene(profile=pad, body=sie.Elastic(210e3, 0.3), half_width=1.0))
    x = sample_points.inside(solution, 100)
    assert ((x >= 0.999) & (x <= 1.0)).sum() >= 10
    assert len(x) == pytest.approx(100, abs=10)


def test_shear_is_printed_and_written_with_its_zones(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = example("partial-slip", tmp_path)
    outputs = ["--csv", "out.csv", "--json", "out.json"]
    assert main(["solve", path, "--want", "shear", "check", *outputs]) == 0
    solution = sie.solve(scene_file.read(path).scene)
    out = capsys.readouterr().out
    assert (
        f"stick           from {solution.stick[0][0]:.6g} to {solution.stick[0][1]:.6g} mm" in out
    )
    assert "shear equation (12)" in out and "slip: one sign" in out
    found = json.loads(Path("out.json").read_text())
    assert found["shear"]["stick"] == [list(solution.stick[0])]
    assert found["shear"]["energy_lost"] == solution.energy_lost
    assert found["check"]["shear"]["ok"] is True
    rows = rows_of("out.csv")
    x = np.array([float(row["x"]) for row in rows])
    assert [float(row["q"]) for row in rows] == solution.shear(x).tolist()
    assert [float(row["slip"]) for row in rows] == solution.slip(x).tolist()


def test_a_path_is_followed_to_its_last_point_with_a_table_of_all(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = example("fretting-cycle", tmp_path)
    assert main(["solve", path, "--want", "shear", "--json", "out.json"]) == 0
    file = scene_file.read(path)
    history = sie.follow(file.scene, file.load_path)
    out = capsys.readouterr().out
    assert out.count("\n500 ") == len(history)
    found = json.loads(Path("out.json").read_text())
    assert [point["stick"] for point in found["path"]] == [
        [list(zone) for zone in s.stick] for s in history
    ]
    assert found["shear"]["resultant"] == pytest.approx(0.0, abs=1e-12)


RIG = """t,P (N/mm),Q (N/mm),sigma (MPa),tilt
0,500,0,0,0
1,600,250,60,1e-4
2,450,-100,-40,-1e-4
3,600,250,60,1e-4
"""


@pytest.fixture
def rig(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("rig.csv").write_text(RIG)
    before, _ = scene_file.example("fretting-cycle").split("path = [")
    Path("rig.toml").write_text(before + 'path = "rig.csv"\n')
    file = scene_file.read("rig.toml")
    return sie.follow(file.scene, file.load_path)


@pytest.mark.slow
def test_every_turning_point_is_written_with_its_tractions(rig, capsys):
    assert main(["solve", "rig.toml", "--csv", "all.csv", "--points", "20"]) == 0
    rows = rows_of("all.csv")
    for k, point in enumerate(rig):
        mine = [row for row in rows if row["point"] == str(k)]
        loads = [float(mine[0][name]) for name in ("P", "Q", "sigma", "tilt")]
        assert loads == [*rig.path.points[k], rig.path.tilt[k]]
        x = np.array([float(row["x"]) for row in mine])
        assert [float(row["p"]) for row in mine] == point.pressure(x).tolist()
        assert [float(row["q"]) for row in mine] == point.shear(x).tolist()


def test_a_path_that_is_not_covered_is_refused_by_plan_and_solve(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("bad.toml").write_text(
        scene_file.example("fretting-cycle").replace("[500.0, -50.0]", "[500.0, -400.0]")
    )
    for word in ("solve", "plan"):
        assert main([word, "bad.toml"]) == 2
        assert "step 3 of the path" in sentence(capsys)


WAVE = """
[profile]
kind = "function"
slope = "0.003*sin(pi*x)"
period = 2.0
[body]
young = 210e3
poisson = 0.3
[load]
normal_load = {load}
"""


def wave(load, tmp_path):
    path = tmp_path / "wave.toml"
    path.write_text(WAVE.format(load=load))
    return str(path)


def test_a_contact_that_repeats_is_reported_for_one_period(tmp_path, capsys):
    main(["solve", wave(100.0, tmp_path), "--want", "edges"])
    out = capsys.readouterr().out
    assert "patches         1 in each period" in out and "% of the period" in out
    assert "normal load     100 N/mm for each period" in out
    assert "moment" not in out and "tilt" not in out
    main(["solve", wave(100.0, tmp_path), "--json"])
    held = strict(capsys.readouterr().out)
    assert held["period"] == 2.0 and held["patches"] == [held["edges"]]
    assert held["patch_loads"] == pytest.approx([100.0]) and held["gap_volume"] > 0.0


def test_a_contact_without_edges_is_reported_without_edges(tmp_path, capsys):
    main(["solve", wave(4e3, tmp_path)])
    out = capsys.readouterr().out
    assert "edges           none: all of the period is in contact" in out
    assert "gap             none" in out
