"""What is printed fits in 80 columns, fills the terminal where it is a picture, and keeps its
columns in plain ASCII.
"""

import os
import re

import pytest
from command import run

from sie import streams
from sie.cli import main
from sie.io.report import table
from sie.io.scene_file import example
from sie.messages import WIDE
from sie.problem.request import WANTS

# Examples, and what each has no answer for.
SHOWN = {
    "rounded-flat": {"cycle"},
    "flat": {"cycle"},
    "fretting-cycle": {"cycle"},
    "fatigue": set(),
    "row": {"cycle"},
    "sampled": {"cycle"},
    "sliding": {"cycle", "energy"},
}


@pytest.fixture
def printed(tmp_path, capsys):
    def of(name, *options):
        path = tmp_path / "scene.toml"
        path.write_text(example(name).replace("parts = 4", "parts = 1"))
        assert main(["solve", str(path), *options]) == 0
        return capsys.readouterr().out

    return of


@pytest.mark.parametrize("name", SHOWN)
def test_a_report_of_all_quantities_fits_in_80_columns_which_ascii_keeps(name, printed):
    fancy = printed(name, "--want", *(want for want in WANTS if want not in SHOWN[name]))
    assert max(map(len, fancy.splitlines())) <= WIDE == 80
    plain = "".join(map(streams._plain, fancy.splitlines(keepends=True)))
    assert plain.isascii()
    for one, other in zip(fancy.splitlines(), plain.splitlines(), strict=True):
        if re.search(r"\S {4,}\S", one):
            assert len(one) == len(other)


def test_a_table_has_as_many_digits_as_fit():
    row = [-0.00123456789] * 6
    narrow, wide = table([""] * 6, [row]), table([""] * 8, [row[:2] + row])
    assert narrow.count("-0.00123457") == 6 and len(wide) <= WIDE and "-0.001" in wide


def test_a_terminal_without_unicode_gets_the_refusal_in_plain_letters(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(example("wedge"))
    ascii_only = {**os.environ, "PYTHONIOENCODING": "ascii"}
    refused = run("solve", str(path), "--want", "yield", env=ascii_only)
    assert refused.returncode == 2 and refused.stderr.startswith("sie: s_zz")


@pytest.mark.parametrize("wide", [50, 80, 150])
def test_the_picture_is_as_wide_as_the_terminal(wide, printed, monkeypatch):
    monkeypatch.setattr(streams.sys.stdout, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("COLUMNS", str(wide))
    picture = [line for line in printed("parabola").splitlines() if "│" in line]
    assert {len(line) for line in picture} == {wide}


def test_output_that_goes_to_a_file_is_80_columns_wide(printed, monkeypatch):
    monkeypatch.setenv("COLUMNS", "150")
    assert max(map(len, printed("parabola").splitlines())) == 80


@pytest.mark.parametrize("wide", [60, 80, 200])
def test_a_plan_is_broken_to_the_terminal_only(wide, tmp_path, monkeypatch, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(example("row"))
    main(["plan", str(path)])
    plan = capsys.readouterr().out
    monkeypatch.setattr(streams.sys.stdout, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("COLUMNS", str(wide))
    main(["plan", str(path)])
    broken = capsys.readouterr().out
    assert max(map(len, broken.splitlines())) <= wide < 150 or broken == plan
    assert broken.split() == plan.split()
