"""`sie benchmark-set`: the references are those of closed forms in 30 digits; all files or none."""

import csv
import hashlib
import json
import re
import shutil
import subprocess

import mpmath
import pytest

import sie
from analytic import cattaneo, hertz, two_parabolas
from sie.cli import main
from sie.io import benchmark_set as module
from sie.io import scene_file
from sie.io.mesh_comparison import compare
from sie.io.mesh_result import read_mesh

CASES = module.case_names()


def solved(file):
    return sie.follow(file.scene, file.load_path)[-1] if file.load_path else sie.solve(file.scene)


mp = mpmath.mp.clone()
mp.dps = 30

P, Q, F = mp.mpf(500), mp.mpf(100), mp.mpf(3) / 10
ONE_BODY = mp.mpf(210000) / (1 - mp.mpf(9) / 100)  # E* on a rigid body; of two it is half of that
CYLINDER = {"radius": mp.mpf(50), "modulus": ONE_BODY / 2}
FEET = {"normal_load": P, "distance": mp.mpf(1) / 2, **CYLINDER}
SHEARED = {"normal_load": P, "tangential_load": Q, "friction": F}
EPS = 1e-14


@pytest.fixture(scope="module")
def texts():
    """The files of three cases with closed forms, by their paths."""
    names = ("cattaneo", "spence", "two-parabolas")
    return {
        f"{name}/{file}": data.decode(errors="replace")
        for name in names
        for file, data in module.case_files(name, solved).items()
    }


def columns(text):
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def numbers(texts, case):
    return json.loads(texts[f"{case}/answer.json"]), columns(texts[f"{case}/curves.csv"])


def agrees(table, name, exact, edges):
    """At a distance d from an edge the last digit of the edge is seen as sqrt(b/d) digits."""
    peak = max(table[name])
    for x, value in zip(map(mp.mpf, table["x"]), table[name], strict=True):
        distance = min(abs(abs(x) - edge) for edge in edges) / edges[-1]
        assert mp.sqrt(distance) * abs(value - exact(x)) < EPS * peak


def test_the_set_has_twelve_cases():
    assert len(CASES) == 12
    assert {"hertz", "westergaard", "spence", "sliding-dissimilar", "tilted-rounded-flat"} < {
        *CASES
    }


@pytest.mark.parametrize("case", ["cattaneo", "spence"])
def test_the_targets_are_the_certified_answer_to_the_input_in_all_digits(texts, case):
    file = scene_file.parse(texts[f"{case}/scene.toml"])
    answer, _ = numbers(texts, case)
    solution = sie.solve(file.scene)
    assert sie.Scene.from_dict(answer["scene"]) == file.scene
    assert answer["check"]["ok"]
    assert answer["units"] == {"length": "mm", "force": "N/mm", "stress": "MPa", "moment": "N"}
    assert answer["scene"]["body"] == {"young": 210e3, "poisson": 0.3}
    rows = list(csv.DictReader(texts[f"{case}/targets.csv"].splitlines()))
    targets = {row["name"]: float(row["value"]) for row in rows}
    assert targets["x2, edge of the contact"] == solution.edges[1]
    assert targets["P"] == solution.normal_load
    assert all(row["value"] == repr(float(row["value"])) for row in rows)
    assert all(float(row["certificate"]) < 1e-11 for row in rows)
    approach = next(value for name, value in targets.items() if name.startswith("approach"))
    assert approach == solution.displacement(0.0, 0.0).approach
    for row in rows:
        assert f"| {row['name']} | {row['value']} | {row['unit']} |" in texts[f"{case}/README.md"]


@pytest.mark.slow
def test_the_whole_set_is_certified_and_its_hashes_are_those_of_its_files():
    contents = module.benchmark_set(solved)
    for case in CASES:
        files_of = {p: d for p, d in contents.items() if p.startswith(f"{case}/")}
        sums = files_of.pop(f"{case}/SHA256SUMS").decode()
        assert sums == "".join(
            f"{hashlib.sha256(data).hexdigest()}  {path.partition('/')[2]}\n"
            for path, data in files_of.items()
        )
        assert json.loads(contents[f"{case}/answer.json"])["check"]["ok"]
        assert f"({case}/README.md)" in contents["README.md"].decode()


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
@pytest.mark.parametrize("case", ["hertz", "westergaard", "tilted-rounded-flat", "cattaneo"])
def test_calculix_runs_the_deck_as_it_is_and_comes_near(case, tmp_path):
    for file, data in module.case_files(case, solved).items():
        (tmp_path / file).write_bytes(data)
    subprocess.run(["ccx", "deck"], cwd=tmp_path, capture_output=True, check=True)
    scene = scene_file.read(tmp_path / "scene.toml").scene
    found = compare(sie.solve(scene), read_mesh(tmp_path / "deck.frd"), 1e-2)
    assert {peak.name for peak in found.peaks} >= {"p_max", "mises_max"}
    for peak in found.peaks:
        if peak.name in ("p_max", "mises_max"):
            assert abs(peak.error) < 0.02
    assert re.search(r"this mesh: p to \d\.\d%.*, peak stress to \d\.\d%", str(found))


B = hertz.half_width(normal_load=P, **CYLINDER, lib=mp)
STICK = cattaneo.stick_half_width(half_width=B, **SHEARED, lib=mp)
INNER, OUTER = two_parabolas.edges(**FEET, lib=mp)
PATCH = {"inner": INNER, "outer": OUTER, **CYLINDER}
# The column, its closed form, and the places beside which it has fewer digits, the edge last.
FORMS = {
    ("cattaneo", "p"): (lambda x: hertz.pressure(x, half_width=B, **CYLINDER, lib=mp), [B]),
    ("cattaneo", "q"): (lambda x: cattaneo.shear(x, half_width=B, **SHEARED, lib=mp), [STICK, B]),
    ("two-parabolas", "p"): (
        lambda x: two_parabolas.pressure(x, **PATCH, lib=mp), [INNER, OUTER]
    ),
}  # fmt: skip


@pytest.mark.parametrize(("case", "column"), FORMS)
def test_edges_and_tractions_are_those_of_the_closed_form(texts, case, column):
    answer, table = numbers(texts, case)
    form, places = FORMS[case, column]
    assert answer["edges"][1] == pytest.approx(float(places[-1]), rel=EPS)
    agrees(table, column, form, places)


def test_the_stick_zone_and_the_peak_are_those_of_cattaneo_and_hertz(texts):
    answer, _ = numbers(texts, "cattaneo")
    assert answer["shear"]["stick"][0][1] == pytest.approx(float(STICK), rel=EPS)
    peak = hertz.peak_pressure(half_width=B, **CYLINDER, lib=mp)
    assert answer["pressure"]["peak"]["p"] == pytest.approx(float(peak), rel=EPS)


@pytest.fixture
def short(monkeypatch):
    """A set of two files, in place of the computed one."""
    contents = {"README.md": "µ".encode(), "hertz/curves.csv": b"x,p\n"}
    monkeypatch.setattr(module, "benchmark_set", lambda _: contents)


@pytest.mark.usefixtures("short")
@pytest.mark.parametrize("there", [False, True], ids=["new", "empty"])
def test_the_command_writes_the_set_into_a_new_or_an_empty_directory(tmp_path, capsys, there):
    folder = tmp_path / "set"
    if there:
        folder.mkdir()
    assert main(["benchmark-set", str(folder)]) == 0
    paths = [path for path in folder.rglob("*") if path.is_file()]
    found = {str(path.relative_to(folder)): path.read_text(encoding="utf-8") for path in paths}
    assert found == {"README.md": "µ", "hertz/curves.csv": "x,p\n"}
    assert capsys.readouterr().out.startswith("wrote 2 files")


@pytest.mark.usefixtures("short")
@pytest.mark.parametrize("name", ["full", "file", "nowhere/set", "file/set"])
def test_any_other_place_is_refused_and_stays_as_it_is(tmp_path, capsys, name):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes").touch()
    (tmp_path / "file").touch()
    before = sorted(tmp_path.rglob("*"))
    assert main(["benchmark-set", str(tmp_path / name)]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("sie: ") and err.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before
