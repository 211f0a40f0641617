"""A sweep on the processes of a cluster gives bitwise what one process gives, and loses nothing."""

import os
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest

import sie

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
    assert found["half_width"] == pytest.approx(serial["half_width"], rel=1e-14)
    assert (found["reason"] == "").all()


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
