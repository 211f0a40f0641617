"""What the command line refuses is one sentence and leaves no trace."""

import shlex
import sys
from pathlib import Path

import pytest
from command_scenes import sentence

from sie import cli as command
from sie import files
from sie.cli import main
from sie.io import scene_file

BAD = {
    "no command": ("", "sie needs COMMAND"),
    "unknown command": ("slove scene.toml", "did you mean solve?"),
    "a file for a command": ("scene.toml", "like sie solve scene.toml"),
    "no scene": ("solve", "sie solve needs scene.toml: write files first, then options"),
    "an option that swallows the scene": ("solve --want scene.toml", "needs scene.toml"),
    "no mesh": ("compare scene.toml --json", "sie compare needs fem.csv"),
    "a command of an earlier version": ("completion bash", "`sie --help` lists them"),
    "no such scene": ("solve none.toml", "does not exist"),
    "directory": ("solve .", "is a directory"),
    "a scene without a name": ("solve ''", "the name of the scene file is empty"),
    "a mesh without a name": ("compare scene.toml ''", "the name of the mesh result is empty"),
    "an output without a name": ("solve scene.toml --csv ''", "after --csv is empty"),
    "a folder without a name": ("benchmark-set ''", "the name of the directory is empty"),
    "unknown option": ("solve scene.toml --polt out.png", "did you mean --plot?"),
    "unknown want": ("solve scene.toml --want edgse", 'did you mean "edges"?'),
    "unknown example": ("example wegde", 'did you mean "wedge"?'),
    "points": ("solve scene.toml --points many", "many is not a whole number"),
    "too many points": ("solve scene.toml --points 1000000000", "from 2 to"),
    "tolerance below rounding": ("solve scene.toml --tol 1e-30", "is below 4.4e-16"),
    "tolerance nan": ("solve scene.toml --tol nan", "tol is nan"),
    "a want that is empty": ("solve scene.toml --want ''", "--want names nothing"),
    "tolerance of a comparison": ("compare scene.toml fem.csv --tol inf",
        "tol = inf is no positive number"),
    "a height in words": ("compare scene.toml fem.csv --surface top", "top is not a height"),
    "a height that is none": ("compare scene.toml fem.csv --surface nan", "nan is not a height"),
    "an unknown body": ("compare scene.toml fem.csv --body left", "invalid choice: 'left'"),
    "a file too many": ("compare scene.toml fem.csv third.csv", '"third.csv" is not understood'),
    "unknown suffix of a field": ("solve scene.toml --field f.vti", "use .csv"),
    "a grid of one column": ("solve scene.toml --field f.csv --grid 1x5", "1x5 is not a grid"),
    "a grid without a field": ("solve scene.toml --grid 5x5", "give --field FILE too"),
    "no suffix": ("solve scene.toml --plot picture", ".png"),
    "unknown suffix": ("solve scene.toml --plot out.xyz", ".svg"),
    "output is a directory": ("solve scene.toml --csv .", "is a directory"),
    "output in no directory": ("solve scene.toml --json none/out.json", "no directory"),
    "output over the scene": ("solve scene.toml --csv scene.toml",
        "would overwrite the scene file"),
    "two outputs in one place": ("solve scene.toml --csv out --json ./out",
        "would overwrite what --csv writes"),
    "two outputs in letters of another size": ("solve scene.toml --csv out --json OUT",
        "would overwrite what --csv writes"),
    "two outputs to the terminal": ("solve scene.toml --csv - --json",
        "cannot both go to standard output"),
}  # fmt: skip


@pytest.mark.parametrize(("words", "said"), BAD.values(), ids=BAD)
def test_a_bad_request_is_one_sentence_and_exit_code_2(words, said, scene, capsys):
    assert main(shlex.split(words)) == 2
    assert said in sentence(capsys)


BAD_SCENES = {
    "not TOML": "[load\n",
    "load that no single contact carries": scene_file.example("flat").replace(
        "moment = 60.0", "moment = 600.0"
    ),
}


@pytest.mark.parametrize("text", BAD_SCENES.values(), ids=BAD_SCENES)
def test_a_refused_scene_leaves_the_outputs_of_the_last_one_alone(text, scene, tmp_path, capsys):
    (tmp_path / scene).write_text(text)
    outputs = [tmp_path / name for name in ("out.csv", "out.json", "out.png")]
    for path in outputs:
        path.write_text("as it was")
    assert (
        main(["solve", scene, "--csv", "out.csv", "--json", "out.json", "--plot", "out.png"]) == 2
    )
    sentence(capsys)
    assert [path.read_text() for path in outputs] == ["as it was"] * 3
    assert len(list(tmp_path.iterdir())) == 4


def test_a_disk_that_fills_up_leaves_every_file_as_it_was(scene, tmp_path, capsys, monkeypatch):
    (tmp_path / "out.csv").write_text("as it was")
    write = files._write_part

    def full(part, data, like):
        write(part, data[:100], like)
        if like.suffix == ".json":
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(files, "_write_part", full)
    assert main(["solve", scene, "--csv", "out.csv", "--json", "out.json"]) == 2
    assert "No space left on device" in sentence(capsys)
    assert (tmp_path / "out.csv").read_text() == "as it was"
    assert {path.name for path in tmp_path.iterdir()} == {"scene.toml", "out.csv"}


def test_a_written_file_keeps_its_permissions_and_a_link_stays_a_link(scene, tmp_path):
    (tmp_path / "real.csv").write_text("")
    (tmp_path / "real.csv").chmod(0o640)
    (tmp_path / "link.csv").symlink_to("real.csv")
    assert main(["solve", scene, "--csv", "link.csv"]) == 0
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "real.csv").stat().st_mode & 0o777 == 0o640 and (
        tmp_path / "real.csv"
    ).read_text().startswith("#")


@pytest.mark.skipif(sys.platform == "win32", reason="no device files")
def test_a_device_is_written_to_and_not_replaced(scene):
    assert main(["solve", scene, "--csv", "/dev/null"]) == 0
    assert Path("/dev/null").is_char_device()


ENDED = [(MemoryError, 2, "memory"), (KeyboardInterrupt, 130, "sie: interrupted by Ctrl-C\n")]


@pytest.mark.parametrize("ended", ENDED)
def test_exhausted_memory_and_an_interruption_are_a_sentence(ended, scene, monkeypatch, capsys):
    error, code, said = ended

    def solve(*args, **kwargs):
        raise error

    monkeypatch.setattr(command, "solve", solve)
    assert main(["solve", scene]) == code
    assert said in sentence(capsys)
