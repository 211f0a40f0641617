"""The command that compares a mesh result; remedies of its refusals are followed."""

import json
from pathlib import Path

import numpy as np
import pytest

import sie
from sie.cli import main
from sie.io import scene_file
from sie.io.mesh_result import read_mesh

SCENE = """
[profile]
kind = "rounded-flat"
half_flat = 0.5
radius = 10.0
[body]
young = 1e4
poisson = 0.3
[load]
normal_load = 100.0
friction = 0.4
tangential_load = 20.0
"""
SOLUTION = sie.solve(scene_file.parse(SCENE).scene)
X = np.linspace(*SOLUTION.edges, 101)
P, Q = SOLUTION.pressure(X), SOLUTION.shear(X)


@pytest.fixture
def run(tmp_path, capsys):
    """(exit code, output, errors) of the comparison with columns."""
    scene, file = tmp_path / "scene.toml", tmp_path / "fem.csv"
    scene.write_text(SCENE)

    def run(columns, *options):
        rows = np.stack([np.ravel(c) for c in columns.values()], axis=1)
        np.savetxt(file, rows, delimiter=",", header=",".join(columns), comments="")
        return main(["compare", str(scene), str(file), *options]), *capsys.readouterr()

    return run


def test_a_mesh_result_passes_or_fails_by_its_l2_error(run):
    columns = {"x": X, "CPRESS": 1.02 * P, "CSHEAR1": Q}
    assert run(columns, "--tol", "0.03")[0] == 0
    code, printed, _ = run(columns, "--tol", "0.01")
    assert code == 1
    assert "EXCEEDS" in printed and "l2     2.000e-02" in printed


def test_columns_that_are_not_compared_are_named(run, tmp_path):
    columns = {"x": X, "p": P, "tangential": Q}
    assert "not compared: the columns tangential of" in run(columns)[1]
    assert json.loads(run(columns, "--json")[1])["not_compared"] == ["tangential"]
    assert "not compared" not in run({"x": X, "p": P})[1]
    bare = tmp_path / "bare.csv"
    np.savetxt(bare, np.column_stack(list(columns.values())), delimiter=",")
    assert read_mesh(bare).others == ("2",)


INNER = X[1:-1]
PRESSED = SOLUTION.pressure(INNER)


def written(x=INNER, p=PRESSED, header="x,p", **columns):
    rows = np.column_stack([x, *columns.values(), p])
    lines = [header, *(",".join(map(repr, row)) for row in rows.tolist())]
    return "\n".join(lines) + "\n"


HALVES = np.concatenate((np.zeros(len(INNER)), np.full(len(INNER), -0.1), np.full(len(INNER), 0.1)))
BOTH_SIDES = written(np.tile(INNER, 3), np.tile(PRESSED, 3), "x,y,p", y=HALVES)
ONE_SIDE = written(np.tile(INNER, 2), np.tile(PRESSED, 2), "x,y,p", y=HALVES[: 2 * len(INNER)])
# What is refused, what the refusal offers, and the file in which that was done.
REFUSED = {
    "a header without a quantity": (
        written(header="x,result"), "say which hold x and p or q", written()
    ),
    "a header that nearly has one": (
        written(header="x,presure"), 'is "presure" meant as "pressure"?',
        written(header="x,pressure"),
    ),
    "a mark for what is missing": (
        written(p=np.where(INNER[5] == INNER, 1e300, PRESSED)), "delete such lines",
        written(np.delete(INNER, 5), np.delete(PRESSED, 5)),
    ),
    "points on both sides": (BOTH_SIDES, "leave the other out", ONE_SIDE),
    "one point": (
        written(INNER[:1], PRESSED[:1]), "needs at least two", written(INNER[::98], PRESSED[::98]),
    ),
    "no point on the surface": (
        written(header="x,y,p", y=np.linspace(0.2, 0.3, len(INNER))), "on the surface, y = 0",
        written(header="x,y,p", y=np.zeros(len(INNER))),
    ),
    "another unit of length": (written(1000.0 * INNER + 5.0), "the units of length", written()),
}  # fmt: skip


def compared(text):
    Path("mesh.csv").write_text(text)
    return main(["compare", "scene.toml", "mesh.csv", "--json", "found.json"])


@pytest.mark.parametrize("case", REFUSED)
def test_what_a_refused_comparison_offers_is_answered(case, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(SCENE)
    refused, remedy, followed = REFUSED[case]
    assert compared(refused) == 2
    assert remedy in capsys.readouterr().err
    assert not Path("found.json").exists()
    assert compared(followed) == 0
    assert json.loads(Path("found.json").read_text())["differences"]["p"]["l2"] <= 1e-12
