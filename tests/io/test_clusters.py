"""A sweep on the processes of a cluster gives bitwise what one process gives, and loses nothing."""

import os
import shutil
import signal
import subprocess
import sys
from concurrent.futures import Executor, Future

import numpy as np
import pytest

import sie
from sie.sweeps import work as sweep_work
from sie.sweeps import workers

SCENE = sie.Scene(
    profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0, friction=0.5, tangential_load=0.1
)
MPIEXEC = shutil.which("mpiexec")
SCENES = {"normal_load": np.linspace(0.5, 2.0, 40), "friction": np.linspace(0.3, 1.0, 50)}


@pytest.fixture(scope="module")
def cluster():
    """An executor on a Dask cluster of two processes."""
    distributed = pytest.importorskip("distributed", reason='needs the extra "dask"')
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as processes,
        distributed.Client(processes) as client,
        client.get_executor(pure=False) as executor,
    ):
        yield executor


class KilledOnce:
    """A half-width; the first process that is asked for that under a load is killed."""

    def __init__(self, load, note):
        self.load, self.note = load, note

    def __call__(self, solution):
        if solution.normal_load == self.load and not self.note.exists():
            self.note.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return solution.half_width


def stick(solution):
    return solution.stick


def arrays(found):
    return {name: np.asarray(found[name]) for name in found}


@pytest.mark.slow
def test_two_thousand_scenes_on_two_processes_give_bitwise_the_serial_answers(cluster):
    want = {"half_width": "half_width", "stick": stick}
    serial, parallel = (
        arrays(sie.sweep(SCENE, SCENES, want, e, chunk=50)) for e in (None, cluster)
    )
    assert serial["half_width"].size == 2000 and parallel.keys() == serial.keys()
    assert all((parallel[name] == serial[name]).all() for name in serial)


@pytest.mark.slow  # a cluster starts interpreters, and a new one for that which is killed
@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")
def test_a_worker_that_is_killed_in_the_middle_costs_a_retry_and_no_result(cluster, tmp_path):
    note = tmp_path / "killed"
    killing = {"half_width": KilledOnce(SCENES["normal_load"][20], note)}
    found = arrays(sie.sweep(SCENE, SCENES, killing, cluster, chunk=50))
    serial = arrays(sie.sweep(SCENE, SCENES, "half_width"))
    assert note.exists()
    assert (found["half_width"] == serial["half_width"]).all()
    assert (found["reason"] == "").all()


class KilledWorker(Exception):
    """Dask's, for a task that was on several workers that died."""


class Losing(Executor):
    """Loses, of many chunks, the deadly one and its neighbour; of one chunk, only the deadly."""

    def __init__(self):
        self.asked = []

    def submit(self, function, chunk):
        again, future = chunk in self.asked, Future()
        self.asked.append(chunk)
        load = chunk[0]["normal_load"]
        if load == 3.0 or (load == 2.0 and not again):
            future.set_exception(KilledWorker("died"))
        else:
            future.set_result(function(chunk))
        return future


def test_chunks_that_were_on_a_dying_worker_run_again_one_after_the_other():
    loads, executor = [1.0, 2.0, 3.0, 4.0], Losing()
    found = arrays(sie.sweep(SCENE, {"normal_load": loads}, "half_width", executor, chunk=1))
    assert np.isfinite(found["half_width"]).tolist() == [True, True, False, True]
    assert "died" in found["reason"][2] and len(executor.asked) == 6


class Confused(Losing):
    """Runs each chunk, and reports an error of its own when the first two are fetched at first.

    Dask's executor does so where the worker that has a result dies while it is fetched.
    """

    def submit(self, function, chunk):
        future = Future()
        if len(self.asked) < 2:
            future.set_exception(ValueError("not enough values to unpack (expected 3, got 2)"))
        else:
            future.set_result(function(chunk))
        self.asked.append(chunk)
        return future


def test_a_result_that_an_executor_loses_is_computed_again():
    loads, executor = [1.0, 2.0, 3.0, 4.0], Confused()
    found = arrays(sie.sweep(SCENE, {"normal_load": loads}, "half_width", executor, chunk=1))
    assert np.isfinite(found["half_width"]).all() and (found["reason"] == "").all()
    assert len(executor.asked) == 6


SCRIPT = """
from mpi4py.futures import MPIPoolExecutor
import sie, test_clusters

if __name__ == "__main__":
    with MPIPoolExecutor() as pool:
        found = sie.sweep(test_clusters.SCENE, test_clusters.SCENES, "half_width", pool, chunk=500)
    test_clusters.np.save("half_width", test_clusters.np.asarray(found["half_width"]))
"""


@pytest.mark.skipif(not MPIEXEC, reason="needs mpiexec")
def test_an_mpi_executor_gives_bitwise_the_serial_answers(tmp_path):
    pytest.importorskip("mpi4py", reason="needs mpi4py")
    (tmp_path / "many.py").write_text(SCRIPT)
    subprocess.run(
        [MPIEXEC, "-n", "2", sys.executable, "-m", "mpi4py.futures", "many.py"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        check=True,
    )
    serial = sie.sweep(SCENE, SCENES, "half_width")
    assert (np.load(tmp_path / "half_width.npy") == np.asarray(serial["half_width"])).all()


# -- the size of chunks ----------------------------------------------------------------------------


def sizes(points, seconds):
    """The sizes of the chunks of points that take so long each."""
    chunks, found = workers.Chunks(points, None), []
    for chunk in iter(chunks.take, None):
        done = min(len(chunk), max(1, int(chunks.limit / seconds)))
        chunks.measured(chunk, done, done * seconds)
        found.append(done)
    return found


@pytest.mark.parametrize("seconds", [1e-5, 1e-3, 0.03, 0.4])
def test_chunks_take_at_least_a_tenth_of_a_second_once_the_time_of_a_scene_is_known(seconds):
    found = sizes(20_000, seconds)
    assert sum(found) == 20_000
    assert all(0.1 <= n * seconds <= max(1.0, seconds) for n in found[1:-1])


def test_a_worker_gives_back_what_it_has_not_begun_in_time(monkeypatch):
    seconds = iter(np.arange(100.0))
    monkeypatch.setattr(sweep_work, "perf_counter", lambda: next(seconds))
    work = sweep_work.Work(SCENE, {"half_width": "half_width"}, 1e-13)
    part = sweep_work.answers_of(work, 2.5, [{"normal_load": P} for P in (0.1, 0.2, 0.3, 0.4, 0.5)])
    assert 0 < len(part.answers) < 5


@pytest.mark.slow
def test_what_a_worker_gives_back_is_taken_again():
    chunks = workers.Chunks(10, 5)
    chunks.measured(chunks.take(), 2, 0.1)
    assert [list(chunk) for chunk in iter(chunks.take, None)] == [[2, 3, 4], [5, 6, 7, 8, 9]]
