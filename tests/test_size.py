"""The size of the house, which is a promise too: each folder of `sie` has a budget of lines.

To raise a row is a decision, with its reason in docs/decisions/; a deletion lowers it.
"""

from pathlib import Path

import pytest

import sie

HOUSE = Path(sie.__file__).parent
LINES = {
    "": 1460,
    "answers": 1310,
    "benchmark_set": 10,
    "cracks": 780,
    "wear": 470,
    "cauchy": 2170,
    "certificate": 1540,
    "cli": 800,
    "contact": 2390,
    "examples": 10,
    "friction": 9930,
    "inverse": 310,
    "io": 4770,
    "live": 1140,
    "many": 770,
    "numerics": 2310,
    "patches": 4900,
    "paths": 1200,
    "plots": 960,
    "problem": 890,
    "profiles": 5270,
    "sensitivity": 1290,
    "stress": 2320,
    "sweeps": 720,
    "traction": 2490,
}
FILES = 254


def lines_of(folder):
    paths = (HOUSE / folder).rglob("*.py") if folder else HOUSE.glob("*.py")
    return sum(len(path.read_text(encoding="utf-8").splitlines()) for path in paths)


@pytest.mark.parametrize("folder", LINES)
def test_a_folder_has_no_more_lines_than_its_budget(folder):
    assert lines_of(folder) <= LINES[folder]


def test_every_folder_has_a_budget_and_the_files_are_few():
    assert {path.parent.relative_to(HOUSE).parts[:1] for path in HOUSE.rglob("*.py")} <= {
        (folder,) if folder else () for folder in LINES
    }
    assert len(list(HOUSE.rglob("*.py"))) <= FILES
