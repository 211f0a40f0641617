"""The size of the house, which is a promise too: each folder of `sie` has a budget of lines.

To raise a row is a decision, with its reason in docs/decisions/; a deletion lowers it.
"""

from pathlib import Path

import pytest

import sie

HOUSE = Path(sie.__file__).parent
LINES = {
    "": 2840,
    "benchmark_set": 10,
    "cauchy": 2260,
    "certificate": 1710,
    "cli": 910,
    "contact": 2800,
    "examples": 10,
    "friction": 13670,
    "inverse": 320,
    "io": 4680,
    "live": 1190,
    "many": 960,
    "numerics": 2210,
    "patches": 5570,
    "paths": 1150,
    "plots": 1010,
    "problem": 980,
    "profiles": 5920,
    "sensitivity": 1500,
    "stress": 2230,
    "sweeps": 1190,
    "traction": 2720,
}
FILES = 303


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
