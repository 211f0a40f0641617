"""A sweep on the processes of a cluster gives bitwise what one process gives, and loses nothing."""

import numpy as np
import pytest

import sie

SCENE = sie.Scene(
    profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0, friction=0.5, tangential_load=0.1
)
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
