"""The command line: what it prints and writes is what the library computes, and what it refuses
leaves no trace.
"""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command import run

import sie
from sie import cli as command
from sie import files, solution
from sie.certificate.result import Certificate
from sie.cli import main
from sie.io import report, sample_points, scene_file
from sie.problem.request import WANTS
from sie.profiles import kinds

KINDS = list(kinds.KINDS)


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """The name of a scene file in the current directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(scene_file.example("rounded-flat"))
    return "scene.toml"


@pytest.fixture
def solved(monkeypatch):
    """The solutions that the command line makes."""
    asked = []

    def solve(*args, **kwargs):
        asked.append(sie.solve(*args, **kwargs))
        return asked[-1]

    monkeypatch.setattr(command, "solve", solve)
    return asked


def example(kind, tmp_path):
    path = tmp_path / f"{kind}.toml"
    path.write_text(scene_file.example(kind))
    return str(path)


def sentence(capsys):
    """What standard error got: one line; and nothing on standard output."""
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("sie: ") and err.count("\n") == 1 and err.endswith("\n")
    return err


def strict(text):
    """JSON without the NaN and Infinity that Python would accept."""
    return json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))


# -- solve ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_each_example_is_solved_and_certified_from_the_command_line(kind, tmp_path, capsys):
    assert main(["solve", example(kind, tmp_path)]) == 0
    out, err = capsys.readouterr()
    assert "\ncertified to " in out and "█" in out and err == ""


def test_the_summary_says_edges_load_peak_and_certificate(scene, capsys):
    main(["solve", scene])
    out = capsys.readouterr().out
    solution = sie.solve(scene_file.read(scene).scene)
    assert f"x1 = {solution.edges[0]:.6g} mm, smooth" in out
    assert "normal load     500 N/mm" in out
    assert f"peak pressure   {sample_points.peak(solution)[0]:.6g} MPa at x = " in out
    assert str(solution.check()) in out


@pytest.mark.parametrize("width", [40, 80, 133])
def test_the_text_picture_is_the_pressure_column_by_column(width, scene):
    solution = sie.solve(scene_file.read(scene).scene)
    picture = report.text_picture(solution, scene_file.UNITS, width)
    rows = [line.split("│")[1] for line in picture.splitlines() if "│" in line]
    columns = len(rows[0])
    heights = np.array([sum(" ▁▂▃▄▅▆▇█".index(row[k]) for row in rows) for k in range(columns)])
    heights = heights / 8.0 / report.ROWS
    x = np.linspace(*solution.edges, 2 * columns + 1)[1::2]
    assert (
        np.abs(heights * sample_points.ceiling(solution) / solution.pressure(x) - 1.0).max() < 0.05
    )
    assert (heights == heights[::-1]).all()
    assert max(map(len, picture.splitlines())) == width


def test_sharp_edges_and_infinite_peaks_are_reported(tmp_path, capsys):
    main(["solve", example("flat", tmp_path)])
    out = capsys.readouterr().out
    assert (
        "x1 = -5 mm, sharp" in out
        and "peak pressure   infinite at x = -5 and 5" in out
        and "↑" in out
    )


def test_an_answer_without_a_good_certificate_is_printed_with_its_exit_code(
    scene, capsys, monkeypatch
):
    monkeypatch.setattr(Certificate, "ok", False)
    assert main(["solve", scene]) == 1
    out, err = capsys.readouterr()
    assert (
        "NOT certified" in out
        and err.startswith("sie: the certificate is not met")
        and err.count("\n") == 1
    )


@pytest.mark.parametrize("want", [want for want in WANTS if want != "cycle"])
def test_only_wanted_quantities_are_printed(want, scene, capsys):
    main(["solve", scene, "--want", want])
    out = capsys.readouterr().out
    marks = {
        "edges": "half-width", "pressure": "peak pressure", "gap": "\ngap", "shear": "\nshear",
        "check": "integral equation", "energy": "energy lost",
        "stress": "\nstress ", "yield": "elastic limit", "tension": "peak tension",
    }  # fmt: skip
    assert {name for name, mark in marks.items() if mark in out} == {want}


SHEARED_DISSIMILAR = """
[profile]
kind = "parabola"
radius = 1.0
[pair]
modulus = 2.0
dundurs = 0.2
[load]
normal_load = 1.0
friction = 0.3
tangential_load = 0.15
"""


@pytest.mark.parametrize("asked", [False, True])
def test_the_energy_of_dissimilar_bodies_under_q_is_answered_only_if_asked_for(
    asked, tmp_path, capsys, monkeypatch
):
    path, costs = tmp_path / "sheared.toml", []
    path.write_text(SHEARED_DISSIMILAR)
    monkeypatch.setattr(
        solution, "tangential_energy", lambda state, _: costs.append(state) or state.Q
    )
    more = ["--want", "shear", "energy"] if asked else []
    assert main(["solve", str(path), *more]) == 0
    assert len(costs) == asked == ("energy lost" in capsys.readouterr().out)
    main(["plan", str(path), *more])
    assert ("skip  energy" in capsys.readouterr().out) != asked


@pytest.mark.parametrize("name", ["scene.toml", "punch"])
@pytest.mark.parametrize(
    "before",
    [["--want", "edges"], ["--tol", "1e-9", "--want", "edges", "check"], ["--want", "edges,check"]],
)
@pytest.mark.parametrize("word", ["solve", "plan"])
def test_the_scene_may_follow_the_wanted_quantities(word, before, name, scene, capsys):
    if word == "plan":
        before = [option for option in before if option not in ("--tol", "1e-9")]
    Path(scene).rename(name)
    assert main([word, name, *before]) == 0
    expected = capsys.readouterr()
    assert main([word, *before, name]) == 0
    assert capsys.readouterr() == expected


def test_a_scene_from_standard_input_may_follow_the_wanted_quantities():
    assert run("solve", "--want", "edges", "-", input=scene_file.example("wedge")).returncode == 0


def test_wanting_the_edges_of_a_convex_profile_computes_no_pressure(scene, solved, capsys):
    main(["solve", scene, "--want", "edges"])
    assert "normal" in vars(solved[0]) and "pressure" not in vars(solved[0])
    main(["solve", scene, "--want", "edges", "--json"])
    assert "pressure" not in vars(solved[1])
    main(["solve", scene, "--want", "edges,gap"])
    assert "pressure" in vars(solved[2]) and "certificate" not in vars(solved[2])


def test_a_file_s_want_holds_unless_the_command_line_gives_another(scene, tmp_path, capsys):
    text = (tmp_path / scene).read_text()
    (tmp_path / scene).write_text('want = ["edges"]\n' + text)
    main(["solve", scene])
    assert "peak pressure" not in capsys.readouterr().out
    main(["solve", scene, "--want", "pressure"])
    assert "peak pressure" in capsys.readouterr().out


# -- JSON and CSV ---------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_json_is_strict_and_equals_the_library_to_the_last_digit(kind, tmp_path, capsys):
    path = example(kind, tmp_path)
    assert main(["solve", path, "--json"]) == 0
    found = strict(capsys.readouterr().out)
    solution = sie.solve(scene_file.read(path).scene)
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


def test_the_shear_in_sliding_is_in_the_report_the_json_and_the_csv(tmp_path, monkeypatch, capsys):
    """Dissimilar bodies: q = f p with their pressure, though how far they slipped before is not
    known.
    """
    monkeypatch.chdir(tmp_path)
    path = example("sliding", tmp_path)
    solution = sie.solve(scene_file.read(path).scene)
    assert main(["solve", path, "--want", "shear", "--csv", "out.csv"]) == 0
    assert "Q = 12 N/mm; f P = 12" in capsys.readouterr().out
    with open("out.csv", encoding="utf-8") as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
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
    told = report.shear_summary(sie.solve(flat), scene_file.UNITS)
    assert "Q = 3" in told and "bonded" in told and "inf" not in told


def test_an_infinite_pressure_is_a_string_that_reads_as_a_number(tmp_path, capsys):
    main(["solve", example("flat", tmp_path), "--json"])
    p = strict(capsys.readouterr().out)["pressure"]["p"]
    assert p[0] == p[-1] == "Infinity" and float(p[0]) == float("inf")


def test_json_holds_only_wanted_quantities(scene, capsys):
    main(["solve", scene, "--want", "check", "--json"])
    found = strict(capsys.readouterr().out)
    assert "check" in found and "pressure" not in found and "gap" not in found


def test_json_in_a_file_is_what_would_be_printed(scene, tmp_path, capsys):
    main(["solve", scene, "--json"])
    printed = capsys.readouterr().out
    main(["solve", scene, "--json", "out.json"])
    assert (tmp_path / "out.json").read_text() == printed
    assert "wrote out.json" in capsys.readouterr().out


@pytest.mark.parametrize("kind", KINDS)
def test_csv_reads_back_as_the_library_s_numbers(kind, tmp_path, capsys):
    path, out = example(kind, tmp_path), tmp_path / "out.csv"
    main(["solve", path, "--csv", str(out), "--points", "50"])
    file = scene_file.read(path)
    solution = sie.solve(file.scene)
    text = out.read_text(encoding="utf-8").splitlines()
    assert [line.startswith("#") for line in text[:5]] == [True] * 4 + [False]
    assert file.title in text[0] and "mm" in text[2] and "MPa" in text[2]
    rows = list(csv.DictReader(text[4:]))
    x, p, gap = (np.array([float(row[name]) for row in rows]) for name in ("x", "p", "gap"))
    np.testing.assert_array_equal(x, np.loadtxt(out, delimiter=",", skiprows=5)[:, 0])
    np.testing.assert_array_equal(p, solution.pressure(x))
    np.testing.assert_array_equal(gap, solution.gap(x))
    assert (np.diff(x) > 0).all()
    # A break of a trace is no place of its own.
    breaks = file.scene.profile.breaks if kind != "sampled" else ()
    assert {*solution.edges, *(b for b in breaks if x[0] < b < x[-1])} <= set(x.tolist())


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        ("parabola", "# x and gap in mm, p in MPa,"),
        ("partial-slip", "# x and gap and slip in mm, p and q in MPa,"),
    ],
)
def test_csv_names_the_unit_of_every_column(kind, says, tmp_path, capsys):
    main(["solve", example(kind, tmp_path), "--csv", "-", "--points", "20"])
    assert says in capsys.readouterr().out


def test_csv_points_resolve_a_rounded_edge_of_a_thousandth_of_the_contact():
    solution = sie.solve(
        sie.Scene(
            profile=sie.RoundedFlat(0.999, 20.0), body=sie.Elastic(210e3, 0.3), half_width=1.0
        )
    )
    x = sample_points.inside(solution, 100)
    assert ((x >= 0.999) & (x <= 1.0)).sum() >= 10
    assert len(x) == pytest.approx(100, abs=10)


def test_one_output_may_be_standard_output_and_is_then_alone_there(scene, capsys):
    main(["solve", scene, "--csv", "-"])
    assert capsys.readouterr().out.startswith("# Fretting pad")


# -- shear and load paths -------------------------------------------------------------------------


def test_shear_is_printed_and_written_with_its_zones(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = example("partial-slip", tmp_path)
    assert (
        main(["solve", path, "--want", "shear", "check", "--csv", "out.csv", "--json", "out.json"])
        == 0
    )
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
    rows = list(
        csv.DictReader(
            line for line in Path("out.csv").read_text().splitlines() if not line.startswith("#")
        )
    )
    x = np.array([float(row["x"]) for row in rows])
    assert [float(row["q"]) for row in rows] == solution.shear(x).tolist()
    assert [float(row["slip"]) for row in rows] == solution.slip(x).tolist()


def test_a_path_is_followed_to_its_last_point_with_a_table_of_all(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = example("fretting-cycle", tmp_path)
    assert main(["solve", path, "--want", "shear", "--json", "out.json"]) == 0
    file = scene_file.read(path)
    history = sie.follow(file.scene, sie.Path(file.path))
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


def test_the_turning_points_of_a_rig_are_a_table_with_its_tilts(rig, capsys):
    assert main(["solve", "rig.toml", "--want", "shear"]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()][-len(rig) - 1 :]
    assert rows[0][:4] == ["P", "Q", "σ", "tilt"]
    for row, point, loads in zip(rows[1:], rig, rig.path.points, strict=True):
        (stick,) = point.stick
        expected = (*loads, point.scene.tilt, *stick, point.energy_lost)
        assert [float(cell) for cell in row] == pytest.approx(expected, rel=1e-5, abs=1e-12)


def test_every_turning_point_is_written_with_its_tractions(rig, capsys):
    assert main(["solve", "rig.toml", "--csv", "all.csv", "--points", "20"]) == 0
    written = [line for line in Path("all.csv").read_text().splitlines() if line[0] != "#"]
    rows = list(csv.DictReader(written))
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


# -- plan and example -----------------------------------------------------------------------------


def test_a_plan_says_what_runs_what_is_skipped_and_why(scene, solved, capsys):
    assert main(["plan", scene, "--want", "edges"]) == 0
    out = capsys.readouterr().out
    assert out.split() == str(sie.plan(scene_file.read(scene).scene, ["edges"])).split()
    assert "skip  pressure      not asked for" in out and "run   edges " in out
    assert all(not {"normal", "pressure"} & set(vars(solution)) for solution in solved)


def test_a_plan_of_a_scene_that_is_not_covered_is_refused_like_its_solution(
    scene, tmp_path, capsys
):
    (tmp_path / scene).write_text(
        scene_file.example("rounded-flat") + "friction = 0.5\ntangential_load = 1e6\n"
    )
    assert main(["solve", scene]) == 2
    said = sentence(capsys)
    assert main(["plan", scene]) == 2
    assert sentence(capsys) == said


@pytest.mark.parametrize("kind", KINDS)
def test_an_example_is_printed_as_it_is(kind, capsys):
    assert main(["example", kind]) == 0
    assert capsys.readouterr().out == scene_file.example(kind)


def test_examples_are_listed_with_a_line_each(capsys):
    assert main(["example"]) == 0
    listed = capsys.readouterr().out.splitlines()[: len(KINDS)]
    assert [line.split()[0] for line in listed] == KINDS and all(
        len(line.split()) > 2 for line in listed
    )


# -- refusals -------------------------------------------------------------------------------------

BAD = {
    "no command": ([], "arguments are required"),
    "unknown command": (["slove", "scene.toml"], "did you mean solve?"),
    "a file for a command": (["scene.toml"], "like sie solve scene.toml"),
    "no scene": (["solve"], "give the scene file first"),
    "an option that swallows the scene": (
        ["solve", "--want", "scene.toml"],
        '"scene.toml" is not known',
    ),
    "no such scene": (["solve", "none.toml"], "does not exist"),
    "directory": (["solve", "."], "is a directory"),
    "a scene without a name": (["solve", ""], "the name of the scene file is empty"),
    "a mesh without a name": (
        ["compare", "scene.toml", ""],
        "the name of the mesh result is empty",
    ),
    "an output without a name": (["solve", "scene.toml", "--csv", ""], "after --csv is empty"),
    "a folder without a name": (["benchmark-set", ""], "the name of the directory is empty"),
    "unknown option": (["solve", "scene.toml", "--polt", "out.png"], "did you mean --plot?"),
    "unknown want": (["solve", "scene.toml", "--want", "edgse"], 'did you mean "edges"?'),
    "unknown want of a plan": (
        ["plan", "scene.toml", "--want", "presure"],
        'did you mean "pressure"?',
    ),
    "unknown example": (["example", "wegde"], 'did you mean "wedge"?'),
    "points": (["solve", "scene.toml", "--points", "many"], "many is not a whole number"),
    "too many points": (["solve", "scene.toml", "--points", "1000000000"], "from 2 to"),
    "tolerance": (["solve", "scene.toml", "--tol", "0"], "tol = 0 is not positive"),
    "tolerance below rounding": (["solve", "scene.toml", "--tol", "1e-30"], "is below 4.4e-16"),
    "tolerance nan": (["solve", "scene.toml", "--tol", "nan"], "tol is nan"),
    "a want that is empty": (["solve", "scene.toml", "--want", ""], "--want names nothing"),
    "a want of a comma": (["plan", "scene.toml", "--want", ","], "--want names nothing"),
    "tolerance inf": (["solve", "scene.toml", "--tol", "inf"], "tol = inf is infinite"),
    "tolerance of a comparison": (
        ["compare", "scene.toml", "fem.csv", "--tol", "inf"],
        "tol = inf is no positive number",
    ),
    "a height in words": (
        ["compare", "scene.toml", "fem.csv", "--surface", "top"],
        "top is not a height",
    ),
    "a height that is none": (
        ["compare", "scene.toml", "fem.csv", "--surface", "nan"],
        "nan is not a height",
    ),
    "an unknown body": (
        ["compare", "scene.toml", "fem.csv", "--body", "left"],
        "give below or above",
    ),
    "no suffix": (["solve", "scene.toml", "--plot", "picture"], ".png"),
    "unknown suffix": (["solve", "scene.toml", "--plot", "out.xyz"], ".svg"),
    "output is a directory": (["solve", "scene.toml", "--csv", "."], "is a directory"),
    "output in no directory": (["solve", "scene.toml", "--json", "none/out.json"], "no directory"),
    "output over the scene": (
        ["solve", "scene.toml", "--csv", "scene.toml"],
        "would overwrite the scene file",
    ),
    "two outputs in one place": (
        ["solve", "scene.toml", "--csv", "out", "--json", "./out"],
        "would overwrite what --csv writes",
    ),
    "two outputs to the terminal": (
        ["solve", "scene.toml", "--csv", "-", "--json"],
        "cannot both go to standard output",
    ),
}


@pytest.mark.parametrize(("argv", "said"), BAD.values(), ids=BAD)
def test_a_bad_request_is_one_sentence_and_exit_code_2(argv, said, scene, capsys):
    assert main(argv) == 2
    assert said in sentence(capsys)


BAD_SCENES = {
    "not TOML": "[load\n",
    "unknown key": scene_file.example("wedge") + "normal_laod = 1.0\n",
    "value": scene_file.example("wedge").replace("slope = 0.05", "slope = -0.05"),
    "load that no single contact carries": scene_file.example("flat").replace(
        "moment = 60.0", "moment = 600.0"
    ),
    "profile that falls outwards": scene_file.example("polynomial").replace(
        "0.010, 0.004, 0.001", "-0.010, 0.0, -0.001"
    ),
}


@pytest.mark.parametrize("text", BAD_SCENES.values(), ids=BAD_SCENES)
def test_a_refused_scene_leaves_the_outputs_of_the_last_one_alone(text, scene, tmp_path, capsys):
    (tmp_path / scene).write_text(text)
    outputs = [tmp_path / name for name in ("out.csv", "out.json", "out.png")]
    for path in outputs:
        path.write_text("as it was")
    assert (
        main(["solve", scene, "--csv", "out.csv", "--json", "out.json", "--plot", "out.png"]) == 2
    )
    sentence(capsys)
    assert [path.read_text() for path in outputs] == ["as it was"] * 3
    assert len(list(tmp_path.iterdir())) == 4


def test_a_disk_that_fills_up_leaves_every_file_as_it_was(scene, tmp_path, capsys, monkeypatch):
    (tmp_path / "out.csv").write_text("as it was")
    write = files._write_part

    def full(part, data, like):
        write(part, data[:100], like)
        if like.suffix == ".json":
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(files, "_write_part", full)
    assert main(["solve", scene, "--csv", "out.csv", "--json", "out.json"]) == 2
    assert "No space left on device" in sentence(capsys)
    assert (tmp_path / "out.csv").read_text() == "as it was"
    assert {path.name for path in tmp_path.iterdir()} == {"scene.toml", "out.csv"}


def test_a_written_file_keeps_its_permissions_and_a_link_stays_a_link(scene, tmp_path):
    (tmp_path / "real.csv").write_text("")
    (tmp_path / "real.csv").chmod(0o640)
    (tmp_path / "link.csv").symlink_to("real.csv")
    assert main(["solve", scene, "--csv", "link.csv"]) == 0
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "real.csv").stat().st_mode & 0o777 == 0o640 and (
        tmp_path / "real.csv"
    ).read_text().startswith("#")


@pytest.mark.skipif(sys.platform == "win32", reason="no device files")
def test_a_device_is_written_to_and_not_replaced(scene):
    assert main(["solve", scene, "--csv", "/dev/null"]) == 0
    assert Path("/dev/null").is_char_device()


def test_exhausted_memory_is_reported_in_a_sentence(scene, monkeypatch, capsys):
    def exhausted(*args, **kwargs):
        raise MemoryError

    monkeypatch.setattr(command, "solve", exhausted)
    assert main(["solve", scene]) == 2
    assert "memory" in sentence(capsys)


def test_an_interruption_is_exit_code_130(scene, monkeypatch, capsys):
    def interrupted(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "solve", interrupted)
    assert main(["solve", scene]) == 130
    assert capsys.readouterr() == ("", "")


# -- as a program ---------------------------------------------------------------------------------


def test_the_program_solves_a_scene_and_refuses_one(scene):
    good = run("solve", scene, "--want", "edges", "check")
    assert (good.returncode, good.stderr) == (0, "") and "\ncertified to " in good.stdout
    bad = run("solve", "none.toml")
    assert (
        (bad.returncode, bad.stdout) == (2, "")
        and bad.stderr.count("\n") == 1
        and "Traceback" not in bad.stderr
    )


def test_a_scene_may_come_from_standard_input():
    found = run("solve", "-", "--want", "edges", input=scene_file.example("wedge"))
    assert (found.returncode, found.stderr) == (0, "") and "half-width      1 mm" in found.stdout


def test_version_and_help_are_printed(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"sie {sie.__version__}\n"
    assert main(["solve", "--help"]) == 0
    assert "--plot FILE" in capsys.readouterr().out


def test_a_terminal_without_block_elements_gets_a_plainer_picture(scene, monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    monkeypatch.setenv("PYTHONUTF8", "0")
    found = run("solve", scene)
    assert (
        (found.returncode, found.stderr) == (0, "")
        and found.stdout.isascii()
        and "|###" in found.stdout
    )


@pytest.mark.skipif(sys.platform == "win32", reason="pipes break otherwise")
def test_a_pipe_closed_early_is_no_error(scene):
    read, write = os.pipe()
    os.close(read)
    found = subprocess.run(
        [sys.executable, "-m", "sie", "solve", scene],
        stdout=write,
        stderr=subprocess.PIPE,
        check=False,
    )
    os.close(write)
    assert (found.returncode, found.stderr) == (141, b"")


WITHOUT_MATPLOTLIB = """
import sys
sys.modules["matplotlib"] = None
from sie.cli import main
from sie.certificate.result import Certificate
assert main(["solve", "scene.toml", "--csv", "out.csv"]) == 0
assert not {"scipy", "mpmath"} & {name.split(".")[0] for name in sys.modules}
sys.exit(main(["solve", "scene.toml", "--plot", "out.png"]))
"""


def test_without_matplotlib_all_but_the_picture_works(scene, tmp_path):
    found = subprocess.run(
        [sys.executable, "-c", WITHOUT_MATPLOTLIB],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert found.returncode == 2
    assert found.stderr == 'sie: --plot needs Matplotlib: pip install "plane-contact[plot]"\n'
    assert (tmp_path / "out.csv").exists() and not (tmp_path / "out.png").exists()


def test_a_picture_is_written(scene, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    assert main(["solve", scene, "--plot", "out.PNG"]) == 0
    assert (tmp_path / "out.PNG").read_bytes().startswith(b"\x89PNG")
    assert capsys.readouterr().out.endswith("wrote out.PNG\n")


# -- several patches, and contacts that repeat ----------------------------------------

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


def test_the_row_of_the_examples_touches_in_several_patches(tmp_path, capsys):
    assert main(["solve", example("row", tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "patches         3\n" in out and "% of the load on [" in out


def wave(load, tmp_path):
    path = tmp_path / "wave.toml"
    path.write_text(WAVE.format(load=load))
    return str(path)


def test_the_report_of_a_contact_that_repeats_is_for_one_period(tmp_path, capsys):
    main(["solve", wave(100.0, tmp_path), "--want", "edges"])
    out = capsys.readouterr().out
    assert "patches         1 in each period" in out and "% of the period" in out
    assert "normal load     100 N/mm for each period" in out
    assert "moment" not in out and "tilt" not in out


def test_the_json_of_a_contact_that_repeats_names_its_period_and_patches(tmp_path, capsys):
    main(["solve", wave(100.0, tmp_path), "--json"])
    held = strict(capsys.readouterr().out)
    assert held["period"] == 2.0 and held["patches"] == [held["edges"]]
    assert held["patch_loads"] == pytest.approx([100.0]) and held["gap_volume"] > 0.0


def test_a_contact_without_edges_is_reported_without_edges(tmp_path, capsys):
    main(["solve", wave(4e3, tmp_path)])
    out = capsys.readouterr().out
    assert "edges           none: all of the period is in contact" in out
    assert "gap             none" in out


@pytest.mark.parametrize("load", [10.0, 100.0, 300.0])
def test_the_gap_beside_a_contact_that_repeats_is_reported_where_there_is_one(load, tmp_path):
    file = scene_file.read(wave(load, tmp_path))
    solution = sie.solve(file.scene)
    words = report.gap_summary(solution, file.units).replace(";", "").split()
    assert all(float(gap) > 0.0 for gap in (words[1], words[7]))
