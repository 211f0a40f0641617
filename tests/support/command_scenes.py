"""Scenes and outputs for tests of the command line."""

from pathlib import Path

import pytest

from sie.io import scene_file
from sie.profiles import kinds

KINDS = list(kinds.KINDS)


def example(kind: str, tmp_path: Path) -> str:
    path = tmp_path / f"{kind}.toml"
    path.write_text(scene_file.example(kind))
    return str(path)


def sentence(capsys: pytest.CaptureFixture[str]) -> str:
    """What standard error got: one line; and nothing on standard output."""
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("sie: ") and err.count("\n") == 1 and err.endswith("\n")
    return err
