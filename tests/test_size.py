"""The size of the house, which is a promise too: each folder of `sie` has a budget of lines.

To raise a row is a decision, with its reason in docs/decisions/; a deletion lowers it.
"""

from pathlib import Path

import pytest

import sie

HOUSE = Path(sie.__file__).parent
LINES = {
    "": 1440,
    "answers": 1270,
    "benchmark_set": 10,
    "cracks": 760,
    "wear": 470,
    "cauchy": 1860,
    "certificate": 1400,
    "cli": 770,
    "contact": 2380,
    "examples": 10,
    "friction": 9290,
    "inverse": 310,
    "io": 4590,
    "live": 1130,
    "many": 760,
    "numerics": 2250,
    "patches": 4520,
    "paths": 1150,
    "plots": 940,
    "problem": 890,
    "profiles": 5110,
    "sensitivity": 1230,
    "stress": 2180,
    "sweeps": 700,
    "traction": 2310,
}
FILES = 245


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
