"""Work that takes more than a second shows a bar on a terminal; short work opens none."""

import contextlib
import os
import subprocess
import sys

import numpy as np
import pytest

import sie
from sie import progress_bar
from sie.cli import main
from sie.io.scene_file import example, parse
from sie.progress_bar import Progress, counted, step_done


class Clock:
    """Seconds that pass when a test says so."""

    now = 0.0

    def __call__(self):
        return self.now


class Bar:
    """What is drawn, in place of a bar of tqdm."""

    def __init__(self, work):
        self.name, self.total, self.n, self.shown, self.open = work.name, work.total, 0, [], True

    def set_description_str(self, name, refresh):
        assert not refresh
        self.name = name

    def set_postfix_str(self, inside):
        self.shown.append((self.name, self.n, inside))

    def close(self):
        self.open = False


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(progress_bar, "perf_counter", clock)
    return clock


@pytest.fixture
def bars(monkeypatch, clock):
    drawn = []
    monkeypatch.setattr(progress_bar, "_bar", lambda work: drawn.append(Bar(work)) or drawn[-1])
    monkeypatch.setattr(progress_bar, "_seen", lambda: True)
    return drawn


def test_nothing_is_drawn_in_the_first_second(clock, bars):
    with Progress("search", 3) as work:
        clock.now = 0.99
        work.update()
    assert not bars


def test_steps_inside_are_named_behind_the_outermost_work(clock, bars):
    with Progress("sie solve"):
        for _ in counted("load path", range(2), 2):
            with Progress("patches, step"):
                step_done()
                clock.now += 0.6
                step_done()
    (bar,) = bars
    assert bar.shown == [("sie solve", 0, "load path 1/2, patches, step 2")]


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_the_line_is_wiped_whatever_ends_the_work(error, clock, bars):
    with contextlib.suppress(error), Progress("search", 2) as work:
        clock.now = 1.0
        work.update()
        raise error
    assert not bars[0].open
    with Progress("next", 2) as work:
        clock.now = 2.5
        work.update()
    assert [bar.name for bar in bars] == ["search", "next"]


@pytest.fixture
def told(monkeypatch):
    """The names of the works that were opened, and how often each told of a step."""
    counts = {}

    def update(work, steps=1):
        counts[work.name] = counts.get(work.name, 0) + 1

    entered = Progress.__enter__

    def enter(work):
        counts.setdefault(work.name, 0)
        return entered(work)

    monkeypatch.setattr(Progress, "update", update)
    monkeypatch.setattr(Progress, "__enter__", enter)
    return counts


X = np.linspace(-2.0, 2.0, 201)
ROW = sie.Row([sie.Parabola(1.0), sie.Parabola(1.0).shifted(3.0)])
SEVERAL = sie.Scene(profile=ROW, modulus=1.0, normal_load=0.3)
PUNCH = parse(example("rounded-flat")).scene
CYCLE = parse(example("fatigue"))
NODES = np.linspace(-1.0, 1.0, 17)
TRACE = sie.Sampled(NODES, NODES**2 / 2.0)
DISSIMILAR = sie.Scene(profile=TRACE, modulus=1.0, dundurs=0.1, friction=0.3, normal_load=0.3)


def followed():
    return sie.follow(CYCLE.scene, CYCLE.load_path)


def test_a_small_solve_opens_no_work(told):
    solution = sie.solve(PUNCH)
    solution.pressure(np.linspace(-1.0, 1.0, 1001))
    solution.stress(X, 0.1).mises  # noqa: B018 -- computed when it is read
    assert not told


@pytest.mark.slow(but=7)
@pytest.mark.parametrize(
    ("work", "name", "least"),
    [
        (lambda: sie.solve(SEVERAL).patches, "patches of contact, step", 5),
        (lambda: sie.solve(SEVERAL).check(), "certificate", 1),
        (lambda: sie.solve(PUNCH).elastic_limit(), "largest stress", 5),
        (lambda: sie.solve(PUNCH).stress(np.zeros(9000), 0.1).j2, "stress, part", 3),
        (followed, "load path", 4),
        (lambda: followed()[1].energy_lost, "dissipated energy, step", 2),
        (lambda: sie.solve(DISSIMILAR).edges, "contact of dissimilar bodies", 5),
    ],
)
def test_long_work_tells_its_steps(work, name, least, told):
    work()
    assert told[name] >= least, told


SEVERAL_TOML = """
[profile]
kind = "row"
of = [{ kind = "parabola", radius = 1.0 }, { kind = "parabola", radius = 1.0, shifted = 3.0 }]
[body]
young = 1.0
poisson = 0.3
[load]
normal_load = 0.3
"""
# The command, whose bars do not wait for a second.
COMMAND = (
    "import sys; from sie import progress_bar; progress_bar.PATIENCE = 0.0; "
    "from sie.cli import main; sys.exit(main())"
)


def on_terminal(arguments, folder):
    """The exit code of the command and what it writes on a terminal as its standard error."""
    pty = pytest.importorskip("pty")
    pytest.importorskip("tqdm")
    ours, theirs = pty.openpty()
    pytest.importorskip("termios").tcsetwinsize(theirs, (24, 80))
    command = [sys.executable, "-c", COMMAND, *arguments]
    done = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=theirs, cwd=folder)
    os.close(theirs)
    written = b""
    with contextlib.suppress(OSError):  # Linux's word for the end
        while piece := os.read(ours, 4096):
            written += piece
    os.close(ours)
    printed = done.communicate()[0]
    return done.returncode, printed.decode(), written.decode()


def test_a_long_solve_shows_what_it_does_and_wipes_it(tmp_path):
    (tmp_path / "scene.toml").write_text(SEVERAL_TOML)
    code, printed, shown = on_terminal(["solve", "scene.toml"], tmp_path)
    assert code == 0 and "contact" in printed
    assert "sie solve: 00:0" in shown and "patches of contact" in shown
    assert not shown.split("\r")[-1].strip() and "\n" not in shown


def test_no_bar_is_shown_where_silence_is_asked_for(tmp_path, monkeypatch, bars):
    scene = tmp_path / "scene.toml"
    scene.write_text(SEVERAL_TOML)
    monkeypatch.setattr(progress_bar, "PATIENCE", 0.0)
    assert main(["solve", str(scene), "--quiet"]) == 0
    assert not bars
    assert main(["solve", str(scene)]) == 0
    assert bars
