"""Compute and draw the topics.

Topics that measure time run one after the other while nothing else runs, the others in parallel. A
ratio of times measured in turns may run in parallel, because other work slows both.
"""

from __future__ import annotations

import importlib
import importlib.util
import multiprocessing
import os
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from validation.harness.drawing import Drawn, drawn
from validation.harness.progress import Progress
from validation.harness.records import Found, kept
from validation.harness.report import Section

TICK = 0.5  # seconds between two updates of the progress bar
TOPICS = "validation.topics"
FIGURES = f"{TOPICS}.figures"
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def run(names: Sequence[str], quick: bool) -> tuple[list[Section], float]:
    """The sections of the page in the order of the names, and the seconds they took."""
    found: dict[str, tuple[Found, float]] = {}
    with workers(len(names)) as pool:
        topics = {name: _topic(name) for name in names}
        progress = Progress({name: topic.SECONDS[not quick] for name, topic in topics.items()})
        longest = sorted(
            (name for name in names if not topics[name].TIMED),
            key=lambda name: -topics[name].SECONDS[not quick],
        )
        beside = {pool.submit(computed, name, quick): name for name in longest}
        progress.beside(longest, at_once=os.cpu_count() or 1)
        while waiting := [future for future in beside if beside[future] not in found]:
            for future in wait(waiting, TICK, FIRST_COMPLETED).done:
                found[beside[future]] = future.result()
                progress.behind(beside[future])
            progress.tell(f"{len(waiting)} topics beside each other")
        for name, topic in topics.items():
            if topic.TIMED:
                progress.topic(name)
                found[name] = computed(name, quick, progress.tell)
                progress.behind(name)
        progress.tell("figures")
        figures = {name: pool.submit(figures_of, name, found[name][0]) for name in names}
        sections = []
        for name, topic in topics.items():
            (records, computing), (drawings, drawing) = found[name], figures[name].result()
            sections.append(
                Section(
                    name, topic.TITLE, topic.__doc__ or "", records, drawings, computing + drawing
                )
            )
    return sections, progress.done()


def computed(
    name: str, quick: bool, tell: Callable[[str], None] = lambda what: None
) -> tuple[Found, float]:
    """The records of a topic, and the seconds it took."""
    start = time.perf_counter()
    return kept(_topic(name).compute(quick), tell), time.perf_counter() - start


def figures_of(name: str, found: Found) -> tuple[list[Drawn], float]:
    """A topic's figures as SVG, and their seconds; none if the topic broke off or has none."""
    start = time.perf_counter()
    if found.broken or importlib.util.find_spec(f"{FIGURES}.{name}") is None:
        return [], 0.0
    figures = importlib.import_module(f"{FIGURES}.{name}").figures(found)
    return [drawn(figure) for figure in figures], time.perf_counter() - start


@contextmanager
def workers(topics: int) -> Iterator[Executor]:
    """A process for each core, with one thread each; this process for a single topic or core."""
    cores = os.cpu_count() or 1
    if min(topics, cores) == 1:
        yield Here()
        return
    others = set(multiprocessing.active_children())
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    # Only processes that start from here on read them.
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    try:
        with ProcessPoolExecutor(
            min(topics, cores), mp_context=multiprocessing.get_context("spawn")
        ) as pool:
            try:
                for _ in range(cores):
                    pool.submit(awake)  # their imports run beside those of this process
                yield pool
            # An interrupt too: else the pool would compute all that it was given before it ends
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                for child in set(multiprocessing.active_children()) - others:
                    child.terminate()
                raise
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def awake() -> None:
    """Import the modules of most topics, which takes a process about a second."""
    _topic("paper")


class Here(Executor):
    """An executor that runs each task at once, in this process."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def _topic(name: str) -> ModuleType:
    return importlib.import_module(f"{TOPICS}.{name}")
