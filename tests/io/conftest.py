"""A scene file for tests of the command line, and the executors of a sweep."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import pytest

from sie.io import scene_file


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of a scene file in the current directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(scene_file.example("rounded-flat"))
    return "scene.toml"


@pytest.fixture(
    params=[None, ThreadPoolExecutor, ProcessPoolExecutor], ids=["here", "threads", "processes"]
)
def executor(request):
    if request.param is None:
        yield None
        return
    with request.param(max_workers=2) as pool:
        yield pool
