"""Cycles on the command line."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import sie
from sie.cli import main
from sie.io import scene_file
from sie.io.export import as_dict
from sie.io.report import summary

CYCLE = """
[profile]
kind = "parabola"
radius = 100.0
[body]
young = 115e3
poisson = 0.32
[load]
friction = 0.5
columns = ["P", "Q", "sigma"]
path = [[50.0, 0.0, 0.0], [50.0, 20.0, 10.0], [50.0, -10.0, -5.0], [50.0, 20.0, 10.0]]
"""
MATERIAL = """
[fatigue]
findley_k = 0.3
shear_limit = 100.0
fatemi_socie_k = 0.5
yield_stress = 900.0
depth = [0.02]
parts = 1
"""


@pytest.fixture
def solve(tmp_path, monkeypatch, capsys):
    """A function that solves a scene for its cycle: status, what was printed, and JSON."""
    monkeypatch.chdir(tmp_path)

    def run(text, *more):
        Path("cycle.toml").write_text(text)
        status = main(["solve", "cycle.toml", "--want", "cycle", *more])
        return status, *capsys.readouterr()

    return run


@pytest.fixture(scope="module")
def cycle():
    file = scene_file.parse(CYCLE)
    return sie.Cycle(sie.follow(file.scene, file.load_path)[1:])


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("want", ["edges", "shear", "check"])
def test_an_exceeded_yield_stress_is_a_note_of_the_report_and_of_json(want):
    """The largest Mises stress over the path is found on a grid, too."""
    scene = f'want = ["{want}"]\n{CYCLE}[fatigue]\nfatemi_socie_k = 0.5\nyield_stress = '
    file = scene_file.parse(scene + "1.0")
    path = sie.follow(file.scene, file.load_path)
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, 201), np.linspace(0.0, 1.0, 51))
    largest = max(float(np.nanmax(point.stress(x, y).mises)) for point in path)
    for strength, exceeded in ((0.98 * largest, True), (1.02 * largest, False)):
        file = scene_file.parse(scene + repr(strength))
        said = " ".join(summary(path[-1], file).split())
        assert ("above yield_stress" in said) == exceeded
        notes = as_dict(path[-1], file)["notes"]
        assert any("above yield_stress" in note for note in notes) == exceeded


def test_a_scene_without_a_path_notes_an_exceeded_yield_stress_too():
    still = CYCLE[: CYCLE.index("columns")] + "normal_load = 50.0\n"
    file = scene_file.parse(still + "[fatigue]\nfatemi_socie_k = 0.5\nyield_stress = 1.0\n")
    assert "above yield_stress" in as_dict(sie.solve(file.scene), file)["notes"][0]


@pytest.mark.slow
def test_json_has_slip_energy_stresses_and_parameters_of_the_last_cycle(solve, cycle):
    status, out, _ = solve(CYCLE + MATERIAL, "--json")
    found = json.loads(out)["cycle"]
    assert (status, found["from"], found["to"], found["states"]) == (0, 1, 3, 3)
    first, _, last = cycle.states
    assert found["energy"] == pytest.approx(last.energy_lost - first.energy_lost, rel=1e-12)
    x = np.linspace(*first.edges, 401)
    for name, values in {
        "slip_amplitude": cycle.slip_range(x).amplitude,
        "friction_work": cycle.friction_work(x),
        "ruiz": cycle.ruiz(x),
    }.items():
        value = found[name]["value"]
        assert values.max() <= value * (1.0 + 1e-9) and value < values.max() * 1.05
    xx = found["surface"]["xx"]
    assert xx["range"] == pytest.approx(cycle.range(xx["x"], 0.0)["xx"].range, rel=1e-12)
    assert xx["range"] == pytest.approx(xx["highest"] - xx["lowest"], rel=1e-12)
    for name, worst in {
        "swt": cycle.swt(),
        "findley": cycle.findley(k=0.3),
        "fatemi_socie": cycle.fatemi_socie(k=0.5, yield_stress=900.0),
    }.items():
        surface, below = found[name]
        assert surface["value"] == pytest.approx(worst.value, rel=1e-9)
        assert math.radians(surface["angle"]) == pytest.approx(worst.angle, abs=1e-5)
        assert (surface["y"], below["y"]) == (0.0, 0.02)


def test_steps_are_divided_unless_parts_is_one(solve):
    pair = CYCLE.replace("[body]\nyoung = 115e3\npoisson = 0.32", "[pair]\nmodulus = 64e3")
    _, out, _ = solve(pair + "[fatigue]\nparts = 3\n", "--json")
    assert json.loads(out)["cycle"]["states"] == 7


def test_of_loads_that_do_not_change_the_report_names_what_is_missing_and_no_place(solve):
    still = CYCLE[: CYCLE.index("columns")] + "path = [[50.0, 10.0], [50.0, 10.0]]\n"
    status, out, _ = solve(still + MATERIAL)
    lines = {line[:16].strip(): line[16:] for line in out.splitlines() if line[:1].isalpha()}
    assert status == 0
    assert lines["slip amplitude"] == lines["Ruiz' κ1"] == lines["Ruiz' κ2"] == "0"
    assert lines["range of σ_xx"] == "0: it does not change"
    assert "no plane is in tension while its strain" in lines["SWT"]
    assert lines["Fatemi-Socie"].startswith("0 on the surface: no shear changes")
    assert lines["Findley"].endswith("°")


def test_a_sharp_edge_is_answered_by_depth(solve):
    flat = CYCLE.replace('"parabola"\nradius = 100.0', '"flat"\nhalf_width = 1.0')
    flat = flat.replace('columns = ["P", "Q", "sigma"]\n', "").replace(", 10.0]", "]")
    flat = flat.replace(", 0.0]", "]").replace(", -5.0]", "]")
    status, out, _ = solve(flat + MATERIAL, "--json")
    surface, below = json.loads(out)["cycle"]["swt"]
    assert status == 0 and "infinite at x = " in surface["reason"] and below["value"] > 0.0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (CYCLE.replace(", [50.0, 20.0, 10.0]]", "]"), "does not come back to the loads (50, -10"),
        (CYCLE[: CYCLE.index("columns")] + "normal_load = 50.0\n", "give [load] path"),
        (CYCLE + "[fatigue]\nyield_stress = 900.0\n", "give fatemi_socie_k"),
        (CYCLE + "[fatigue]\nshear_limit = 900.0\n", "give findley_k"),
        (CYCLE + "[fatigue]\nfindley_k = -0.3\n", "[fatigue] findley_k = -0.3"),
        (CYCLE + "[fatigue]\ndepth = [0.1, 0.0]\n", "[fatigue] depth[1] = 0"),
        (CYCLE + "[fatigue]\nparts = 0\n", "parts = 0 is not a number from 1 to 100"),
        (CYCLE + "[fatigue]\nfindley = 0.3\n", 'did you mean "findley_k"'),
    ],
)
def test_a_cycle_that_cannot_be_answered_is_refused_in_a_sentence(text, said, solve):
    status, out, err = solve(text, "--csv", "out.csv")
    assert (status, out, err.count("\n")) == (2, "", 1) and said in err
    assert not Path("out.csv").exists()
