"""The command line: what it prints is what the library computes."""

import io
import subprocess
import sys

import numpy as np
import pytest
from command_scenes import KINDS, example

import sie
from sie.certificate.result import Certificate
from sie.cli import main
from sie.io import report, sample_points, scene_file
from sie.problem.request import WANTS


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
    heights = heights / 8.0 / report.HEIGHT
    x = np.linspace(*solution.edges, 2 * columns + 1)[1::2]
    heights_of_p = solution.pressure(x) / sample_points.ceiling(solution)
    assert np.abs(heights / heights_of_p - 1.0).max() < 0.05
    assert (heights == heights[::-1]).all()
    assert max(map(len, picture.splitlines())) == width


def test_sharp_edges_and_infinite_peaks_are_reported(tmp_path, capsys):
    main(["solve", example("flat", tmp_path)])
    out = capsys.readouterr().out
    assert "x1 = -5 mm, sharp" in out and "infinite at x = -5 and 5" in out and "↑" in out


def test_an_answer_without_a_good_certificate_is_printed_with_its_exit_code(
    scene, capsys, monkeypatch
):
    monkeypatch.setattr(Certificate, "ok", False)
    assert main(["solve", scene]) == 1
    out, err = capsys.readouterr()
    assert "NOT certified" in out and err.count("\n") == 1
    assert err.startswith("sie: the certificate is not met")


@pytest.mark.parametrize("want", [want for want in WANTS if want not in {"cycle", "crack"}])
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


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("more", [[], ["--want", "shear", "energy"]], ids=["not asked", "asked"])
def test_the_energy_of_dissimilar_bodies_under_q_is_answered_only_if_asked_for(
    more, tmp_path, capsys
):
    path = tmp_path / "sheared.toml"
    path.write_text(SHEARED_DISSIMILAR)
    assert main(["solve", str(path), *more]) == 0
    assert ("energy lost" in capsys.readouterr().out) == bool(more)
    main(["plan", str(path), *more])
    assert ("skip  energy" in capsys.readouterr().out) != bool(more)


def test_a_file_s_want_holds_unless_the_command_line_gives_another(scene, tmp_path, capsys):
    text = (tmp_path / scene).read_text()
    (tmp_path / scene).write_text('want = ["edges"]\n' + text)
    main(["solve", scene])
    assert "peak pressure" not in capsys.readouterr().out
    main(["solve", scene, "--want", "pressure"])
    assert "peak pressure" in capsys.readouterr().out


def test_a_plan_says_what_runs_what_is_skipped_and_why(scene, capsys):
    assert main(["plan", scene, "--want", "edges"]) == 0
    out = capsys.readouterr().out
    assert out.split() == str(sie.plan(scene_file.read(scene).scene, ["edges"])).split()
    assert "skip pressure not asked for" in " ".join(out.split()) and "run   edges " in out


@pytest.mark.parametrize("kind", KINDS)
def test_an_example_is_listed_with_a_line_and_printed_as_it_is(kind, capsys):
    main(["example"])
    listed = capsys.readouterr().out.splitlines()
    assert any(len(line.split()) > 2 and line.split()[0] == kind for line in listed)
    assert main(["example", kind]) == 0
    assert capsys.readouterr().out == scene_file.example(kind)


def test_a_scene_may_come_from_standard_input(monkeypatch, capsys):
    text = scene_file.example("wedge").encode()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text)))
    assert main(["solve", "-", "--want", "edges"]) == 0
    out, err = capsys.readouterr()
    assert err == "" and "half-width      1 mm" in out


def test_version_and_help_are_printed(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"sie {sie.__version__}\n"
    assert main(["solve", "--help"]) == 0
    assert "--plot FILE" in capsys.readouterr().out


WITHOUT_MATPLOTLIB = """
import sys
sys.modules["matplotlib"] = None
from sie.cli import main
from sie.certificate.result import Certificate
assert main(["solve", "scene.toml", "--csv", "out.csv"]) == 0
assert not {"scipy", "mpmath"} & {name.split(".")[0] for name in sys.modules}
sys.exit(main(["solve", "scene.toml", "--plot", "out.png"]))
"""


@pytest.mark.slow
def test_without_matplotlib_all_but_the_picture_works(scene, tmp_path):
    command = [sys.executable, "-c", WITHOUT_MATPLOTLIB]
    found = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
    assert found.returncode == 2
    assert found.stderr == 'sie: --plot needs Matplotlib: pip install "plane-contact[plot]"\n'
    assert (tmp_path / "out.csv").exists() and not (tmp_path / "out.png").exists()
