"""The points of a sweep in an executor: chunks that take a worker some tenths of a second.

To send a chunk to a worker costs some milliseconds. How long a scene takes is measured on the
chunks that are done, the latest of which count most. Scenes of a grid may differ in cost by orders
of magnitude; a worker gives back what it has not begun within `LIMIT`.

Each outcome is given as soon as it is there, whatever happens to a worker. Tasks are taken one by
one while others run, as their size depends on what is done. Two are given to the executor for each
that is done; so any number of workers has work after a few rounds, and nobody needs to know the
number.

A worker process that dies breaks a whole `ProcessPoolExecutor`: every task that the pool still
holds fails, and which task was the cause is not known. Dask gives up the tasks that were on four
workers that died, and reports an error of its own where a result is lost while it is fetched. Lost
tasks run again, each alone, and the others in a new pool. Only a task whose own process dies then
has no result.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from itertools import chain, islice
from queue import SimpleQueue
from typing import Any

Task = Callable[[Any], Any]
Given = tuple[Any, Any]  # what names a task for the caller, and the argument of the task
Take = Callable[[], Given | None]
Outcome = tuple[Any, Future[Any]]

AIM = 0.2  # seconds a chunk, so that chunks stay above 0.1 s where the estimate is somewhat high
LIMIT = 1.0  # seconds after which a worker begins no further point of a chunk
FIRST_ROUND, THEN = 8, 2  # tasks that the executor gets before one is done, and for each that is


class Chunks:
    """What is left of the points 0, 1, ..., n-1.

    Parameters
    ----------
    points : int
        Their number n.
    size : int, optional
        Points in a chunk; None sizes chunks by their time.
    """

    def __init__(self, points: int, size: int | None) -> None:
        self.limit = LIMIT if size is None else math.inf
        self._size = size
        self._left = [range(points)] if points else []
        self._points, self._seconds = 0.0, 0.0

    def take(self) -> range | None:
        """The next chunk, or None where none is left."""
        if not self._left:
            return None
        points, size = self._left.pop(), self._size or self._timed_size()
        if len(points) > size:
            self._left.append(points[size:])
        return points[:size]

    def measured(self, chunk: range, done: int, seconds: float) -> None:
        """Learn from a chunk whose first points are done, and take back the others."""
        self._points = 0.5 * self._points + done
        self._seconds = 0.5 * self._seconds + seconds
        if done < len(chunk):
            self._left.append(chunk[done:])

    def _timed_size(self) -> int:
        """As many points as take the time aimed at; one where no time is known yet."""
        share = min(AIM / self._seconds, 1e9) if self._seconds else 0.0
        return max(math.ceil(share * self._points), 1)


def outcomes(
    task: Task, take: Take, executor: Executor, left: list[Outcome]
) -> Generator[Outcome, None, None]:
    """(name, future) of each task, in the order in which they are done.

    When the generator is closed, what is done but was not given yet goes to `left`, and the rest is
    cancelled.
    """
    own: list[ProcessPoolExecutor] = []
    try:
        lost = yield from _together(task, take, executor, left)
        while lost:
            alone = _anew(executor, own, 1)
            if own and _died(first := _submitted(alone, int, 0)):  # no process can start
                yield from ((name, first) for name, _ in chain(lost, iter(take, None)))
                return
            for name, argument in lost:
                future = _submitted(alone, task, argument)
                wait([future])
                if _died(future):
                    alone = _anew(executor, own, 1)
                yield name, future
            several = getattr(executor, "_max_workers", 1)
            lost = yield from _together(task, take, _anew(executor, own, several), left)
    finally:
        for pool in own:
            pool.shutdown(wait=False, cancel_futures=True)


def _together(
    task: Task, take: Take, executor: Executor, left: list[Outcome]
) -> Generator[Outcome, None, list[Given]]:
    """The outcomes of tasks that run beside each other until one is lost; returns the lost ones."""
    pending: dict[Future[Any], Given] = {}
    lost: list[Given] = []
    done: SimpleQueue[Future[Any]] = SimpleQueue()

    def submit(most: int) -> None:
        for given in islice(iter(take, None), 0 if lost else most):
            future = _submitted(executor, task, given[1])
            pending[future] = given
            future.add_done_callback(done.put)

    try:
        submit(FIRST_ROUND)
        while pending:
            future = done.get()
            given = pending.pop(future)
            if _is_lost(future, executor):
                lost.append(given)
            else:
                yield given[0], future
            submit(THEN)
    finally:
        left += [
            (name, future)
            for future, (name, _) in pending.items()
            if not future.cancel() and future.done()
        ]
    return lost


def _anew(executor: Executor, own: list[ProcessPoolExecutor], processes: int) -> Executor:
    """The executor, in place of a pool of processes a new one, which starts as that does.

    The library has no public way to start a pool as another.
    """
    if not isinstance(executor, ProcessPoolExecutor):
        return executor
    like: Any = executor
    own.append(ProcessPoolExecutor(processes, like._mp_context, like._initializer, like._initargs))
    return own[-1]


def _submitted(executor: Executor, task: Task, argument: Any) -> Future[Any]:
    """The task's future; a failed one if the executor takes no more: it broke or was shut down."""
    try:
        return executor.submit(task, argument)
    except Exception as problem:
        failed: Future[Any] = Future()
        failed.set_exception(problem)
        return failed


def _is_lost(future: Future[Any], executor: Executor) -> bool:
    """Whether a task has to run again: with its worker, or as its executor lost the result."""
    if isinstance(executor, ProcessPoolExecutor):
        return _died(future)
    return not future.cancelled() and future.exception() is not None


def _died(future: Future[Any]) -> bool:
    """Whether a task failed as its worker died, or with its pool; waits until it is done."""
    return not future.cancelled() and is_death(future.exception())


def is_death(problem: BaseException | None) -> bool:
    """Whether an executor raised this as a worker died; Dask has a class of its own for that."""
    return isinstance(problem, BrokenExecutor) or type(problem).__name__ == "KilledWorker"
