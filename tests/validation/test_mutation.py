"""Every wrong program that validation lists is caught by its checker, and the right program is
not.
"""

import pytest

from validation.wrong_programs.mutants import BAR, MUTANTS


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda m: m.name)
def test_each_wrong_program_is_caught_and_the_right_one_is_not(mutant):
    assert mutant.number(False) <= BAR
    assert mutant.number(True) > BAR
    assert mutant.number(False) <= BAR  # nothing stays replaced


def test_the_list_names_each_once():
    assert len({m.name for m in MUTANTS}) == len(MUTANTS) > 20
