"""Tasks in an executor: each outcome as soon as it is there, whatever happens to a worker.

Tasks are taken one by one while others run, as their size may depend on what is done. Two are given
to the executor for each that is done; so any number of workers has work after a few rounds, and
nobody needs to know the number.

A worker process that dies breaks a whole `ProcessPoolExecutor`: every task that the pool still
holds fails, further submissions fail too, and which task was the cause is not known. These tasks
run again, each in a pool of one process. Dask starts another worker and gives it the tasks of the
first; it gives up those that were on four workers that died, of which any may be the cause, and
reports an error of its own where a result is lost while it is fetched. Tasks that any such executor
fails run again one after the other. Only a task whose own process dies then has no result.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from itertools import islice
from queue import SimpleQueue
from typing import Any

Task = Callable[[Any], Any]
Given = tuple[Any, Any]  # what names a task for the caller, and the argument of the task
Take = Callable[[], Given | None]
Outcome = tuple[Any, Future[Any]]
Outcomes = Generator[Outcome]

FIRST_ROUND = 8  # tasks that the executor gets before one is done


def outcomes(task: Task, take: Take, executor: Executor, left: list[Outcome]) -> Outcomes:
    """(name, future) of each task, in the order in which they are done.

    When the generator is closed, what is done but was not given yet goes to `left`, and the rest is
    cancelled.
    """
    pool = executor if isinstance(executor, ProcessPoolExecutor) else None
    taken: dict[Any, Any] = {}
    lost: list[Given] = []

    def take_noted() -> Given | None:
        given = None if pool and lost else take()
        taken.update([given] if given else ())
        return given

    for name, future in _together(task, take_noted, executor, left):
        argument = taken.pop(name)
        if _died(future) or not (pool or future.cancelled() or future.exception() is None):
            lost.append((name, argument))
        else:
            yield name, future
    again = iter(lost)

    def take_again() -> Given | None:
        return next(again, None) or take()

    if lost and pool:
        yield from _alone(task, take_again, pool, left)
    elif lost:
        yield from _together(task, take_again, executor, left, first=1, then=1)


def _together(
    task: Task,
    take: Take,
    executor: Executor,
    left: list[Outcome],
    *,
    first: int = FIRST_ROUND,
    then: int = 2,
) -> Outcomes:
    """The outcomes of tasks that run beside each other; for each that is done, `then` follow."""
    pending: dict[Future[Any], Any] = {}
    done: SimpleQueue[Future[Any]] = SimpleQueue()

    def submit(most: int) -> None:
        for name, argument in islice(iter(take, None), most):
            future = _submitted(executor, task, argument)
            pending[future] = name
            future.add_done_callback(done.put)

    try:
        submit(first)
        while pending:
            future = done.get()
            yield pending.pop(future), future
            submit(then)
    finally:
        left += [
            (name, future)
            for future, name in pending.items()
            if not future.cancel() and future.done()
        ]


def _alone(task: Task, take: Take, broken: ProcessPoolExecutor, left: list[Outcome]) -> Outcomes:
    """The same with as many processes as the broken pool had, each the only one of its pool."""
    running: dict[Future[Any], tuple[Any, ProcessPoolExecutor]] = {}
    free = [_pool_of_one(broken)]
    try:
        first = _submitted(free[0], int, 0)
        if _died(first):  # no process can start: to try one for each task would only take long
            yield from ((name, first) for name, _ in iter(take, None))
            return
        while True:
            room = broken._max_workers - len(running)  # type: ignore[attr-defined]
            for name, argument in islice(iter(take, None), room):
                pool = free.pop() if free else _pool_of_one(broken)
                running[_submitted(pool, task, argument)] = name, pool
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                name, pool = running.pop(future)
                free += [] if _died(future) else [pool]
                yield name, future
    finally:
        left += [(name, future) for future, (name, _) in running.items() if future.done()]
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


def _died(future: Future[Any]) -> bool:
    """Whether a task failed as its worker died, or with its pool; waits until it is done."""
    return not future.cancelled() and is_death(future.exception())


def is_death(problem: BaseException | None) -> bool:
    """Whether an executor raised this as a worker died; Dask has a class of its own for that."""
    return isinstance(problem, BrokenExecutor) or type(problem).__name__ == "KilledWorker"
