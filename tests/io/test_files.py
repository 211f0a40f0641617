"""Files are read if they are ordinary, and written whole or not at all."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from sie.cli import main

posix = pytest.mark.skipif(os.name == "nt", reason="devices, pipes and signals are otherwise")
TRACE = "x,h\n" + "".join(f"{k / 10.0},{(k / 10.0) ** 2}\n" for k in range(-20, 21))
SCENE = """
pair = { modulus = 1.0 }
load = { half_width = 1.0 }
[profile]
kind = "sampled"
path = "trace.csv"
"""
PLUS = SCENE.replace(
    'kind = "sampled"', 'kind = "parabola"\nradius = 1.0\n[[profile.plus]]\nkind = "sampled"'
)
ROW = SCENE.replace('kind = "sampled"', 'kind = "row"\n[[profile.of]]\nkind = "sampled"')
MESH = "x,p\n-0.5,0.4\n0.0,0.5\n0.5,0.4\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current directory, with a scene that reads a trace, and a mesh result."""
    monkeypatch.chdir(tmp_path)
    for name, text in {"scene.toml": SCENE, "trace.csv": TRACE, "mesh.csv": MESH}.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def listing(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def refused(argv, capsys):
    assert main(argv) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("sie: ") and err.count("\n") == 1
    return err


TARGETS = {"scene.toml": "the scene file", "trace.csv": "a trace", "mesh.csv": "the mesh result"}
LINKS = {
    "itself": lambda target: target,
    "by another way": lambda target: f"../{Path.cwd().name}/{target}",
    "by a hard link": lambda target: os.link(target, "link.csv") or "link.csv",
    "by links to links": lambda target: (
        os.symlink(target, "a") or os.symlink("a", "link.csv") or "link.csv"
    ),
}


@posix
@pytest.mark.parametrize("link", LINKS)
@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("text", [SCENE, PLUS, ROW], ids=["profile", "plus", "row"])
def test_no_output_replaces_a_file_that_is_read(text, target, link, folder, capsys):
    Path("scene.toml").write_text(text)
    name = LINKS[link](target)
    before = listing(folder)
    outputs = ["--csv", "--field"] if name == "trace.csv" else ["--csv"]
    solved = [["solve", "scene.toml", output, name] for output in outputs]
    compared = ["compare", "scene.toml", "mesh.csv", "--json", name]
    for argv in ([] if target == "mesh.csv" else solved) + [compared]:
        assert f"would overwrite {TARGETS[target]}" in refused(argv, capsys)
    assert listing(folder) == before


@pytest.mark.slow
@posix
def test_a_scene_on_standard_input_is_not_overwritten(folder):
    before = listing(folder)
    command = [sys.executable, "-m", "sie", "solve", "-", "--csv", "scene.toml"]
    with open("scene.toml", encoding="utf-8") as scene:
        found = subprocess.run(command, stdin=scene, capture_output=True, check=False)
    assert found.returncode == 2 and b"would overwrite the scene file" in found.stderr
    assert listing(folder) == before


def odd_file(kind):
    path = Path("odd.csv")
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "directory":
        path.mkdir()
    elif kind == "device":
        path.symlink_to("/dev/zero")
    elif kind == "too long":
        with open(path, "wb") as stream:
            stream.truncate(10**9)
    return "odd.csv"


@posix
@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("pipe", "is a pipe"),
        ("directory", "is a directory"),
        ("device", "is a device"),
        ("too long", "has more than"),
    ],
)
@pytest.mark.parametrize("role", ["scene", "trace", "topography", "mesh"])
def test_a_file_that_is_not_regular_is_refused_in_a_sentence(role, kind, said, folder, capsys):
    name = odd_file(kind)
    if role == "topography":
        Path(name).rename("odd.sur")
        name = "odd.sur"
    if role in ("trace", "topography"):
        Path("scene.toml").write_text(SCENE.replace("trace.csv", name))
    argv = ["solve", name if role == "scene" else "scene.toml"]
    assert said in refused(["compare", "scene.toml", name] if role == "mesh" else argv, capsys)


def test_a_trace_of_too_many_points_is_refused_before_it_is_taken_apart(folder, capsys):
    Path("trace.csv").write_text("0 0\n" * 200_000)
    assert "thin the points out" in refused(["solve", "scene.toml"], capsys)


KILLED = """
import os, signal, sys
from pathlib import Path
from sie import files
die = lambda *given, **named: os.kill(os.getpid(), signal.SIGKILL)
setattr(*eval(sys.argv[1]), die)
files.write_files({Path("out.csv"): b"new" * 10**6, Path("out.json"): b"new"})
"""


@pytest.mark.slow
@posix
@pytest.mark.parametrize("place", ["files, '_write_part'", "os, 'fsync'", "os, 'replace'"])
def test_a_killed_run_leaves_every_file_as_it_was(place, folder):
    for name in ("out.csv", "out.json"):
        Path(name).write_bytes(b"old")
    found = subprocess.run([sys.executable, "-c", KILLED, place], check=False, capture_output=True)
    assert found.returncode == -signal.SIGKILL, found.stderr
    assert Path("out.csv").read_bytes() == Path("out.json").read_bytes() == b"old"


@pytest.mark.slow
@posix
def test_standard_output_that_is_full_or_closed_is_reported_and_nothing_is_written(folder):
    before = listing(folder)
    command = [sys.executable, "-m", "sie", "solve", "scene.toml", "--csv", "out.csv"]
    with open("/dev/full", "wb") as full:
        found = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, check=False)
    full = b"sie: standard output: No space left on device\n"
    assert (found.returncode, found.stderr) == (2, full)
    closed = ["sh", "-c", '"$@" >&-', "sh", *command]
    found = subprocess.run(closed, stderr=subprocess.PIPE, check=False)
    assert found.returncode == 2 and found.stderr.count(b"\n") == 1
    assert found.stderr.startswith(b"sie: standard output is closed")
    assert listing(folder) == before


@pytest.fixture
def closed_pipe():
    read, write = os.pipe()
    os.close(read)
    yield write
    os.close(write)


@pytest.mark.slow(but=1)
@posix
@pytest.mark.parametrize(
    "argv",
    [
        ["solve", "scene.toml", "--csv", "out.csv"],
        ["example"],
        ["solve", "--help"],
        ["solve", "scene.toml", "--csv", "/dev/stdout"],
    ],
)
def test_a_pipe_closed_early_is_exit_code_141_and_costs_no_file(argv, folder, closed_pipe):
    command = [sys.executable, "-m", "sie", *argv]
    found = subprocess.run(command, stdout=closed_pipe, stderr=subprocess.PIPE, check=False)
    assert (found.returncode, found.stderr) == (141, b"")
    assert Path("out.csv").exists() == ("out.csv" in argv)
