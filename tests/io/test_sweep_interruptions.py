"""An interrupt, a worker that dies or a function that raises costs a sweep its own points only."""

import os
import signal
import traceback
from concurrent.futures import Executor, Future, ProcessPoolExecutor

import numpy as np
import pytest
from sweep_cases import LOADS, SCENE, plain

import sie

FOUR_WIDTHS = {"over": {"normal_load": [0.1, 0.2, 0.3, 0.4]}, "want": "half_width"}


class Interrupting(Executor):
    """Runs two chunks and takes a third; then the user presses Ctrl-C."""

    def __init__(self):
        self.futures = []

    def submit(self, function, /, *args, **kwargs):
        if len(self.futures) == 3:
            raise KeyboardInterrupt
        future = Future()
        self.futures.append(future)
        if len(self.futures) <= 2:
            future.set_result(function(*args, **kwargs))
        return future


def test_an_interrupt_keeps_all_chunks_that_are_done():
    pool = Interrupting()
    with pytest.raises(sie.Interrupted) as caught:
        sie.sweep(SCENE, **FOUR_WIDTHS, executor=pool, chunk=1)
    found = plain(caught.value.result)
    assert np.isfinite(found["half_width"]).tolist() == [True, True, False, False]
    assert found["reason"].tolist() == ["", "", "interrupted", "interrupted"]
    assert all(future.done() or future.cancelled() for future in pool.futures)


def test_an_interrupt_within_a_chunk_keeps_its_first_points():
    asked = []

    def impatient(solution):
        asked.append(solution)
        if len(asked) == 3:
            raise KeyboardInterrupt
        return solution.half_width

    with pytest.raises(sie.Interrupted) as caught:
        sie.sweep(SCENE, FOUR_WIDTHS["over"], {"b": impatient}, chunk=4)
    assert np.isfinite(plain(caught.value.result)["b"]).tolist() == [True, True, False, False]


@pytest.fixture
def heeded():
    """Ctrl-C is heeded: a job in the background inherits that it is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heeded")
def test_an_interrupt_among_refused_scenes_is_one_sentence():
    """Ctrl-C comes while the reason of the third refusal is read."""
    read = []

    class Refused(ValueError):
        def __str__(self):
            read.append(1)
            if len(read) == 3:
                signal.raise_signal(signal.SIGINT)
            return "no such scene"

    def refused(normal_load):
        raise Refused

    with pytest.raises(sie.Interrupted) as caught:
        sie.sweep(refused, **FOUR_WIDTHS)
    found = plain(caught.value.result)
    assert found["reason"].tolist() == ["no such scene"] * 2 + ["interrupted"] * 2
    printed = "".join(traceback.format_exception(caught.value))
    assert printed.count("Traceback") == 1 and "During handling" not in printed
    assert "2 of 4 points were finished" in printed.splitlines()[-1]


def one_in_three(solution):
    return 1.0 / (solution.normal_load - 0.2)


def test_a_function_that_raises_costs_its_own_point_only(executor):
    found = plain(
        sie.sweep(SCENE, over={"normal_load": LOADS}, want={"f": one_in_three}, executor=executor)
    )
    assert np.isnan(found["f"]).tolist() == [False, True, False]
    assert found["reason"][1].startswith("ZeroDivisionError")


class Dying(Executor):
    """Its second worker dies; it is shut down after so many tasks."""

    def __init__(self, most):
        self.taken, self.most = 0, most

    def submit(self, function, /, *args, **kwargs):
        if self.taken == self.most:
            raise RuntimeError("cannot schedule new futures after shutdown")
        self.taken, future = self.taken + 1, Future()
        if self.taken == 2:
            future.set_exception(RuntimeError("a worker died"))
        else:
            future.set_result(function(*args, **kwargs))
        return future


@pytest.mark.parametrize(("most", "lost"), [(4, [False, True, False, False]), (0, [True] * 4)])
def test_an_executor_that_fails_costs_the_chunks_that_it_held(most, lost):
    found = plain(sie.sweep(SCENE, **FOUR_WIDTHS, executor=Dying(most), chunk=1))
    assert np.isnan(found["half_width"]).tolist() == lost
    assert [reason.startswith("RuntimeError: ") for reason in found["reason"]] == lost


def deadly(solution):
    """A half-width; loads above 1 kill the process, as the system does for want of memory."""
    if solution.normal_load > 1.0:
        os._exit(1)
    return solution.half_width


# From Python 3.12 on, a process that has threads (those of an older pool) warns when it is forked.
pools_of_processes = pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")


@pools_of_processes
def test_a_process_that_dies_costs_what_its_pool_still_held_and_each_point_says_so():
    loads = [0.1, 0.2, 10.0, 0.3]
    with ProcessPoolExecutor(1) as pool:
        over = {"normal_load": loads}
        found = plain(sie.sweep(SCENE, over, {"b": deadly}, executor=pool, chunk=1))
    lost = np.isnan(found["b"])
    assert lost[2] and (found["b"][~lost] > 0.0).all()
    assert ["died" in reason for reason in found["reason"]] == lost.tolist()
