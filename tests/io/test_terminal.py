"""What is printed fits in 80 columns, a picture fills the terminal."""

import io
import sys
from functools import partial

import pytest

from sie.arguments import WIDE
from sie.cli import main, streams
from sie.io import scene_file
from sie.io.report import table
from sie.io.scene_file import example
from sie.problem.request import WANTS

# Examples, and what each has no answer for.
SHOWN = {
    "rounded-flat": {"cycle", "crack"},
    "flat": {"cycle", "crack"},
    "fretting-cycle": {"cycle", "crack"},
    "fatigue": {"crack"},
    "row": {"cycle", "crack"},
    "sampled": {"cycle", "crack"},
    "sliding": {"cycle", "crack", "energy"},
}


@pytest.fixture
def answered(tmp_path, capsys):
    """What a command prints for an example."""

    def of(command, name, *options):
        path = tmp_path / "scene.toml"
        path.write_text(example(name).replace("parts = 4", "parts = 1"))
        assert main([command, str(path), *options]) == 0
        return capsys.readouterr().out

    return of


@pytest.fixture
def printed(answered):
    return partial(answered, "solve")


@pytest.fixture
def planned(answered):
    return partial(answered, "plan")


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("name", SHOWN)
def test_a_report_of_all_quantities_fits_in_80_columns(name, printed, monkeypatch):
    monkeypatch.setenv("COLUMNS", "150")
    fancy = printed(name, "--want", *(want for want in WANTS if want not in SHOWN[name]))
    assert max(map(len, fancy.splitlines())) <= WIDE == 80


def test_a_table_has_as_many_digits_as_fit():
    row = [-0.00123456789] * 6
    narrow, wide = table([""] * 6, [row]), table([""] * 8, [row[:2] + row])
    assert narrow.count("-0.00123457") == 6 and len(wide) <= WIDE and "-0.001" in wide


def test_a_terminal_without_unicode_gets_the_refusal_with_question_marks(tmp_path, monkeypatch):
    path, said = tmp_path / "scene.toml", io.BytesIO()
    path.write_text(example("wedge"))
    monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(said, encoding="ascii"))
    assert main(["solve", str(path), "--want", "yield"]) == 2
    assert said.getvalue().startswith(b"sie: ?_zz")


@pytest.mark.parametrize("wide", [50, 80, 150])
def test_the_picture_is_as_wide_as_the_terminal(wide, printed, monkeypatch):
    monkeypatch.setattr(streams.sys.stdout, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("COLUMNS", str(wide))
    picture = [line for line in printed("parabola").splitlines() if "│" in line]
    assert {len(line) for line in picture} == {wide}


@pytest.mark.parametrize("name", scene_file.examples())
def test_a_plan_that_goes_to_a_file_is_80_columns_wide(name, planned):
    wants = [want for want in WANTS if want not in {"cycle", "crack"}]
    for options in ([], ["--want", *wants]):
        assert max(map(len, planned(name, *options).splitlines())) <= WIDE
