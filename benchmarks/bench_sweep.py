"""Sweeps on two processes of a Dask cluster, on an idle machine of two cores or more.

`speed_up` among the extra information is the time of one process over that of two; `per_chunk` is
the processor time in seconds that the calling process spends on a chunk, which Dask's scheduler
shares here.
"""

import time

import numpy as np
import pytest

import sie

SCENE = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
SCENES, SECONDS = 20_000, 1e-3


def a_millisecond(solution):
    """A half-width that takes a millisecond of processor time."""
    end = time.thread_time() + SECONDS
    while time.thread_time() < end:
        pass
    return solution.half_width


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None
        ) as processes,
        distributed.Client(processes) as client,
        client.get_executor(pure=False) as executor,
    ):
        yield executor


def swept(scenes, executor, chunk=None):
    over = {"normal_load": np.linspace(0.5, 2.0, scenes)}
    return sie.sweep(SCENE, over, {"b": a_millisecond}, executor, chunk=chunk)


def test_speed_up_of_two_workers(benchmark, cluster):
    swept(100, cluster, chunk=10)  # the workers import the package
    begin = time.perf_counter()
    alone = swept(SCENES, None)
    between = time.perf_counter()
    together = benchmark.pedantic(lambda: swept(SCENES, cluster), rounds=1)
    benchmark.extra_info["speed_up"] = (between - begin) / (time.perf_counter() - between)
    assert (np.asarray(together["b"]) == np.asarray(alone["b"])).all()


def test_cost_of_a_chunk(benchmark, cluster):
    """The same chunks as those of scenes of a millisecond, without the millisecond."""
    over, chunks = {"normal_load": np.linspace(0.5, 2.0, SCENES)}, SCENES // 200
    begin = time.process_time()
    benchmark.pedantic(lambda: sie.sweep(SCENE, over, "half_width", cluster, chunk=200), rounds=1)
    benchmark.extra_info["per_chunk"] = (time.process_time() - begin) / chunks
