"""`sie benchmark-set`: the references are those of closed forms in 30 digits; all files or none."""

import csv
import json

import mpmath
import pytest

import sie
from analytic import cattaneo, hertz, rounded_flat, spence, two_parabolas
from sie import files
from sie.cli import main
from sie.io import benchmark_set as module
from sie.io import export, scene_file

CASES = ("cattaneo", "hertz", "rounded-flat", "spence", "two-parabolas")
mp = mpmath.mp.clone()
mp.dps = 30

P, Q, F = mp.mpf(500), mp.mpf(100), mp.mpf(3) / 10
ONE_BODY = mp.mpf(210000) / (1 - mp.mpf(9) / 100)  # E* on a rigid body; of two it is half of that
CYLINDER = {"radius": mp.mpf(50), "modulus": ONE_BODY / 2}
PUNCH = {"half_flat": mp.mpf(1), **CYLINDER}
FEET = {"normal_load": P, "distance": mp.mpf(1) / 2, **CYLINDER}
SHEARED = {"normal_load": P, "tangential_load": Q, "friction": F}
# c/b, by `analytic.spence` in a context of 25 digits: too slow for a test
STICK_OF_SPENCE = 0.689086556525865868839616
EPS = 1e-14


@pytest.fixture(scope="module")
def texts():
    return module.benchmark_set({"csv": export.csv_text, "json": export.json_text})


def columns(text):
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def numbers(texts, case):
    return json.loads(texts[f"{case}.json"]), columns(texts[f"{case}.csv"])


def agrees(table, name, exact, edges):
    """At a distance d from an edge the last digit of the edge is seen as sqrt(b/d) digits."""
    peak = max(table[name])
    for x, value in zip(map(mp.mpf, table["x"]), table[name], strict=True):
        distance = min(abs(abs(x) - edge) for edge in edges) / edges[-1]
        assert mp.sqrt(distance) * abs(value - exact(x)) < EPS * peak


# -- what the files hold --------------------------------------------------------------------------


def test_each_case_has_its_input_and_its_references(texts):
    endings = (".toml", ".csv", ".json")
    assert set(texts) == {"README.md", *(case + ending for case in CASES for ending in endings)}


@pytest.mark.parametrize("case", CASES)
def test_the_references_are_the_certified_answer_to_the_input_in_all_digits(texts, case):
    scene = scene_file.parse(texts[f"{case}.toml"]).scene
    answer, _ = numbers(texts, case)
    assert sie.Scene.from_dict(answer["scene"]) == scene
    assert tuple(answer["edges"]) == sie.solve(scene).edges
    assert answer["check"]["ok"]
    assert answer["units"] == {"length": "mm", "force": "N/mm", "stress": "MPa", "moment": "N"}
    assert answer["scene"]["body"] == {"young": 210e3, "poisson": 0.3}
    lines = [line for line in texts[f"{case}.csv"].splitlines() if not line.startswith("#")]
    cells = [cell for line in lines[1:] for cell in line.split(",")]
    assert cells == [repr(float(cell)) for cell in cells]
    edge = f"| {case} | edge of the contact, mm | {answer['edges'][1]!r} |"
    assert edge in texts["README.md"]


# -- against closed forms in 30 digits ------------------------------------------------------------


B = hertz.half_width(normal_load=P, **CYLINDER, lib=mp)
STICK = cattaneo.stick_half_width(half_width=B, **SHEARED, lib=mp)
RIM = rounded_flat.rim(normal_load=P, **PUNCH, lib=mp)
INNER, OUTER = two_parabolas.edges(**FEET, lib=mp)
PATCH = {"inner": INNER, "outer": OUTER, **CYLINDER}
# The column, its closed form, and the places beside which it has fewer digits, the edge last.
FORMS = {
    ("hertz", "p"): (lambda x: hertz.pressure(x, half_width=B, **CYLINDER, lib=mp), [B]),
    ("cattaneo", "p"): (lambda x: hertz.pressure(x, half_width=B, **CYLINDER, lib=mp), [B]),
    ("cattaneo", "q"): (lambda x: cattaneo.shear(x, half_width=B, **SHEARED, lib=mp), [STICK, B]),
    ("rounded-flat", "p"): (
        lambda x: rounded_flat.pressure(x, rim=RIM, **PUNCH, lib=mp), [1 + RIM]
    ),
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


def test_the_stick_zone_and_the_load_are_those_of_spence(texts):
    answer, _ = numbers(texts, "spence")
    b, c = answer["edges"][1], answer["shear"]["stick"][0][1]
    assert c / b == pytest.approx(STICK_OF_SPENCE, rel=1e-13)
    # Dundurs' second constant of a rigid body on one with nu = 0.3: (1 - 2 nu)/(2 (1 - nu))
    given = {"half_width": b, "friction": 0.3, "dundurs": 2.0 / 7.0}
    load = spence.load(**given, coefficient=0.01, exponent=2.0, modulus=float(ONE_BODY))
    assert load == pytest.approx(500.0, rel=1e-11)


# -- where the files go ---------------------------------------------------------------------------


@pytest.fixture
def short(monkeypatch):
    """A set of two files, in place of the computed one."""
    texts = {"README.md": "µ", "hertz.csv": "x,p\n"}
    monkeypatch.setattr(module, "benchmark_set", lambda formats: texts)


@pytest.mark.usefixtures("short")
@pytest.mark.parametrize("there", [False, True], ids=["new", "empty"])
def test_the_command_writes_the_set_into_a_new_or_an_empty_directory(tmp_path, capsys, there):
    folder = tmp_path / "set"
    if there:
        folder.mkdir()
    assert main(["benchmark-set", str(folder)]) == 0
    found = {path.name: path.read_text(encoding="utf-8") for path in folder.iterdir()}
    assert found == {"README.md": "µ", "hertz.csv": "x,p\n"}
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


@pytest.mark.usefixtures("short")
@pytest.mark.parametrize("there", [False, True], ids=["new", "empty"])
def test_a_write_that_fails_leaves_no_file_and_no_new_directory(
    tmp_path, monkeypatch, capsys, there
):
    def full(part, data, like):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files, "_write_part", full)
    folder = tmp_path / "set"
    if there:
        folder.mkdir()
    assert main(["benchmark-set", str(folder)]) == 2
    assert "No space left" in capsys.readouterr().err
    assert list(tmp_path.rglob("*")) == ([folder] if there else [])
