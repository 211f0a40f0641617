"""The command that compares a mesh result: its exit code, what it prints and what it refuses."""

import json

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


@pytest.mark.slow
def test_stresses_in_the_body_are_compared_whichever_way_y_points(run):
    x, y = np.meshgrid(np.linspace(-1.0, 1.2, 12), np.linspace(0.0, 1.0, 7))
    s = SOLUTION.stress(x, y)
    names = "sxx", "syy", "sxy", "szz", "mises"
    values = s.xx, s.yy, s.xy, s.zz, s.mises
    down = {"x": x, "y": y} | dict(zip(names, values, strict=True))
    up = {"x": x, "y": -y, "S-S11": s.xx, "S-S22": s.yy, "S-S12": -s.xy, "S-S33": s.zz}
    for columns in (down, up):
        code, printed, _ = run(columns, "--tol", "1e-12")
        assert code == 0, printed
    assert run(down | {"sxy": -s.xy}, "--tol", "1e-2")[0] == 1


def test_columns_that_are_not_compared_are_named(run, tmp_path):
    columns = {"x": X, "p": P, "tangential": Q}
    assert "not compared: the columns tangential of" in run(columns)[1]
    assert json.loads(run(columns, "--json")[1])["not_compared"] == ["tangential"]
    assert "not compared" not in run({"x": X, "p": P})[1]
    bare = tmp_path / "bare.csv"
    np.savetxt(bare, np.column_stack(list(columns.values())), delimiter=",")
    assert read_mesh(bare).others == ("2",)


@pytest.mark.parametrize(("factor", "asks"), [(1e6, "units of load"), (1.3, "")])
def test_other_units_are_suspected_from_a_factor_of_them_only(factor, asks, run):
    code, printed, _ = run({"x": X, "p": factor * P, "q": Q})
    assert code == 1
    assert ("factor" in printed) == bool(asks)
    assert asks in printed
    noise = np.random.default_rng(0).normal(size=X.shape)
    assert "factor" not in run({"x": X, "p": noise})[1]
