"""Tasks in an executor: each outcome as soon as it is there, whatever happens to a worker.

A worker process that dies breaks its whole pool: every task that the pool still holds fails,
further submissions fail too, and which task was the cause is not known. These tasks run again, each
in a pool of one process; only a task whose own process dies then has no result. Executors of other
kinds (threads, Dask, MPI) replace their workers themselves: what they report is the outcome.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Mapping
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    as_completed,
    wait,
)
from typing import Any

Tasks = Mapping[int, Any]
Task = Callable[[Any], Any]
Outcomes = Generator[tuple[int, Future[Any]]]


def outcomes(task: Task, of: Tasks, executor: Executor, left: dict[int, Future[Any]]) -> Outcomes:
    """(number, future) of each task, in the order in which they are done.

    When the generator is closed, what is done but was not given yet goes to `left`, and the rest is
    cancelled.
    """
    lost = {}
    for k, future in _together(task, of, executor, left):
        if isinstance(executor, ProcessPoolExecutor) and _broke(future):
            lost[k] = of[k]
        else:
            yield k, future
    if lost and isinstance(executor, ProcessPoolExecutor):
        yield from _alone(task, lost, executor, left)


def _together(task: Task, of: Tasks, executor: Executor, left: dict[int, Future[Any]]) -> Outcomes:
    pending: dict[Future[Any], int] = {}
    try:
        for k, argument in of.items():
            pending[_submitted(executor, task, argument)] = k
        for future in as_completed(list(pending)):
            yield pending.pop(future), future
    finally:
        left |= {
            k: future for future, k in pending.items() if not future.cancel() and future.done()
        }


def _alone(
    task: Task, of: Tasks, broken: ProcessPoolExecutor, left: dict[int, Future[Any]]
) -> Outcomes:
    """The same with as many processes as the broken pool had, each the only one of its pool."""
    waiting = deque(of.items())
    running: dict[Future[Any], tuple[int, ProcessPoolExecutor]] = {}
    free = [_pool_of_one(broken)]
    try:
        first = _submitted(free[0], int, 0)
        if _broke(first):  # no process can start: to try one for each task would only take long
            yield from ((k, first) for k in of)
            return
        while waiting or running:
            while waiting and len(running) < broken._max_workers:  # type: ignore[attr-defined]
                k, argument = waiting.popleft()
                pool = free.pop() if free else _pool_of_one(broken)
                running[_submitted(pool, task, argument)] = k, pool
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                k, pool = running.pop(future)
                free += [] if _broke(future) else [pool]
                yield k, future
    finally:
        left |= {k: future for future, (k, _) in running.items() if future.done()}
        for pool in (*free, *(pool for _, pool in running.values())):
            pool.shutdown(wait=False, cancel_futures=True)


def _pool_of_one(pool: Any) -> ProcessPoolExecutor:
    """A pool of one process that starts as those of the other do; the library has no public way."""
    return ProcessPoolExecutor(1, pool._mp_context, pool._initializer, pool._initargs)


def _submitted(executor: Executor, task: Task, argument: Any) -> Future[Any]:
    """The task's future; a failed one if the executor takes no more: it broke or was shut down."""
    try:
        return executor.submit(task, argument)
    except Exception as problem:
        failed: Future[Any] = Future()
        failed.set_exception(problem)
        return failed


def _broke(future: Future[Any]) -> bool:
    """Whether a task failed with its pool; waits until it is done."""
    return isinstance(future.exception(), BrokenExecutor)
