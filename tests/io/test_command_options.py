"""Options stand in any order, help names the exit codes, and what is not asked for is not said."""

import logging
import os
import shutil
import subprocess
from itertools import chain, combinations_with_replacement, permutations

import pytest

import sie
from sie.cli import main
from sie.cli.parser import COMMANDS, parse
from sie.io import scene_file
from sie.stages import LOG

MESH = "x,p\n-1,240\n0,166\n1,240\n"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with scene.toml, punch (a scene too) and fem.csv."""
    monkeypatch.chdir(tmp_path)
    for name in ("scene.toml", "punch"):
        (tmp_path / name).write_text(scene_file.example("rounded-flat"))
    (tmp_path / "fem.csv").write_text(MESH)
    return tmp_path


OPTIONS = [["--want", "edges", "check"], ["--tol", "1e-12"], ["--json"]]


@pytest.mark.parametrize("scene", ["scene.toml", "punch"])
def test_solve_takes_its_scene_and_options_in_any_order(scene):
    expected = parse(["solve", scene, *chain(*OPTIONS)])
    for parts in permutations([*OPTIONS, [scene]]):
        assert parse(["solve", *chain(*parts)]) == expected


def test_compare_takes_its_two_files_anywhere_among_the_options():
    options = [["--tol", "10"], ["--json"], ["--log", "info"]]
    expected = parse(["compare", "scene.toml", "fem.csv", *chain(*options)])
    for first, second in combinations_with_replacement(range(4), 2):
        before, between, after = options[:first], options[first:second], options[second:]
        parts = [*before, ["scene.toml"], *between, ["fem.csv"], *after]
        assert parse(["compare", *chain(*parts)]) == expected


@pytest.mark.parametrize("scene", ["scene.toml", "punch"])
def test_want_given_twice_asks_for_both_wherever_it_stands(scene):
    expected = parse(["solve", scene, "--want", "gap", "tension"])
    for parts in permutations([["--want=gap"], ["--want", "tension"], [scene]]):
        asked = parse(["solve", *chain(*parts)])
        assert (asked.scene, {*asked.want}) == (expected.scene, {*expected.want})


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


def test_the_log_says_what_is_read_computed_and_written_on_standard_error(capsys):
    main(["solve", "scene.toml", "--csv", "out.csv"])
    printed = capsys.readouterr().out
    assert main(["solve", "scene.toml", "--csv", "out.csv", "--log", "debug"]) == 0
    out, err = capsys.readouterr()
    assert out == printed
    assert "read scene.toml: Scene(" in err and "pressure: " in err and "wrote out.csv: " in err
    assert all(line.startswith("sie: ") for line in err.splitlines())


def test_the_log_of_a_command_ends_with_it(capsys):
    before = (LOG.level, list(LOG.handlers))
    main(["solve", "scene.toml", "--log", "debug", "--want", "edges"])
    main(["solve", "none.toml", "--log", "info"])
    assert (LOG.level, LOG.handlers) == before


def test_a_program_gets_the_stages_by_python_s_logging(caplog):
    solution = sie.solve(scene_file.read("scene.toml").scene)
    with caplog.at_level(logging.DEBUG, logger="sie"):
        assert solution.edges == solution.edges
    assert [record.getMessage().split(":")[0] for record in caplog.records].count("normal") == 1


# -- completion -----------------------------------------------------------------------------------


def completed(script, words):
    """What bash offers for the last of the words."""
    line = " ".join(words)
    code = (
        f"source {script}; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; "
        f"COMP_LINE='{line}'; _shtab_sie; echo ${{COMPREPLY[@]}}"
    )
    done = subprocess.run(["bash", "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.split()


@pytest.mark.skipif(not shutil.which("bash") or os.name == "nt", reason="no bash")
def test_bash_completes_commands_options_names_and_files(folder, capsys):
    pytest.importorskip("shtab")
    assert main(["completion", "bash"]) == 0
    (folder / "sie.bash").write_text(capsys.readouterr().out)
    assert completed("sie.bash", ["sie", "com"]) == ["compare", "completion"]
    assert completed("sie.bash", ["sie", "solve", "--w"]) == ["--want"]
    assert completed("sie.bash", ["sie", "solve", "--want", "e"]) == ["edges", "energy"]
    assert completed("sie.bash", ["sie", "example", "rou"]) == ["rounded-flat"]
    assert "scene.toml" in completed("sie.bash", ["sie", "solve", "sc"])
    assert "fem.csv" in completed("sie.bash", ["sie", "compare", "--nodes", "fe"])


@pytest.mark.parametrize("shell", ["zsh", "tcsh"])
def test_other_shells_have_a_script_too(shell, capsys):
    pytest.importorskip("shtab")
    assert main(["completion", shell]) == 0
    assert "sie" in capsys.readouterr().out


def test_completion_for_an_unknown_shell_is_refused_by_its_name(capsys):
    pytest.importorskip("shtab", reason="completion needs the extra `cli`")
    assert main(["completion", "bahs"]) == 2
    assert "bahs" in capsys.readouterr().err
