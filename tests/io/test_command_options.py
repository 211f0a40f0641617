"""Options stand in any order, help names the exit codes, and what is not asked for is not said."""

from itertools import chain, combinations_with_replacement, permutations

import pytest

from sie.cli import main
from sie.cli.parser import COMMANDS, parse
from sie.io import scene_file

MESH = "x,p\n-1,240\n0,166\n1,240\n"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with scene.toml and fem.csv."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(scene_file.example("rounded-flat"))
    (tmp_path / "fem.csv").write_text(MESH)
    return tmp_path


OPTIONS = [["--want", "edges", "check"], ["--tol", "1e-12"], ["--json"]]


def test_options_stand_behind_the_scene_in_any_order():
    expected = parse(["solve", "scene.toml", *chain(*OPTIONS)])
    for parts in permutations(OPTIONS):
        assert parse(["solve", "scene.toml", *chain(*parts)]) == expected


def test_compare_takes_its_two_files_anywhere_among_the_options():
    options = [["--tol", "10"], ["--quiet"], ["--surface", "1"]]
    expected = parse(["compare", "scene.toml", "fem.csv", *chain(*options)])
    for first, second in combinations_with_replacement(range(4), 2):
        before, between, after = options[:first], options[first:second], options[second:]
        parts = [*before, ["scene.toml"], *between, ["fem.csv"], *after]
        assert parse(["compare", *chain(*parts)]) == expected


def test_want_given_twice_asks_for_both():
    asked = parse(["solve", "--want=gap", "scene.toml", "--want", "tension"])
    assert (asked.scene, asked.want) == ("scene.toml", ["gap", "tension"])


@pytest.mark.parametrize("command", [[], *([name] for name in COMMANDS)], ids=str)
def test_help_names_the_exit_codes_within_80_columns(command, capsys):
    assert main([*command, "--help"]) == 0
    out = capsys.readouterr().out
    codes = out.partition("exit codes:")[2].split("\n  ")
    numbers = [line.split()[0] for line in codes if line[:1].isdigit()]
    assert numbers == ["0", "1", "2", "130", "141"]
    assert max(map(len, out.splitlines())) <= 80


def test_quiet_leaves_the_files_what_goes_to_standard_output_and_a_refusal(folder, capsys):
    assert main(["solve", "scene.toml", "--quiet", "--csv", "out.csv"]) == 0
    assert main(["compare", "scene.toml", "fem.csv", "--quiet", "--tol", "10"]) == 0
    assert main(["compare", "scene.toml", "fem.csv", "--quiet"]) == 1
    assert capsys.readouterr() == ("", "")
    assert (folder / "out.csv").stat().st_size > 0
    main(["solve", "scene.toml", "--json"])
    printed = capsys.readouterr().out
    main(["solve", "scene.toml", "--json", "--quiet"])
    assert capsys.readouterr().out == printed
    assert main(["solve", "none.toml", "--quiet"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
