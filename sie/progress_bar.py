"""A progress bar, by tqdm where that is installed, on work that takes more than a second.

It is one line on standard error where that is a terminal, and in a notebook, and wiped at the end.
What may take long opens a `Progress`, also inside another. The line counts the steps of the
outermost work, and names what is being done inside it. The open work is kept in a context variable,
so that a step deep in a solver needs no argument to be counted. Only the main thread of a main
process draws: workers of a pool would write over each other. `TQDM_DISABLE=1` in the environment,
or `with Progress("", shown=False):`, shows no bar.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from importlib.util import find_spec
from math import inf
from time import perf_counter
from typing import Any, TypeVar

PATIENCE = 1.0  # seconds of work before a bar appears ...
INTERVAL = 0.1  # ... and between two changes of it
WITHOUT_TOTAL = "{desc}: {elapsed}{postfix}"
T = TypeVar("T")


class Progress:
    """The progress of work that is done step by step in the block of a `with`.

    Parameters
    ----------
    name : str
        What is done, or what is counted.
    total : int, optional
        The number of steps; 0 if it is not known.
    shown : bool, optional
        Whether a bar is drawn for this work and all inside it.
    """

    def __init__(self, name: str, total: int = 0, shown: bool = True) -> None:
        self.name, self.total, self.done = name, total, 0
        self.start = perf_counter()
        self.works: tuple[Progress, ...] = (self,)  # after those around it, the outermost first
        self._due = self.start + PATIENCE if shown else inf
        self._bar: Any = None

    def __enter__(self) -> Progress:
        outer = _OPEN.get()
        if outer is not None:
            self.works = (*outer.works, self)
        _OPEN.set(self)
        return self

    def __exit__(self, *_: object) -> None:
        if _OPEN.get() is self:
            _OPEN.set(self.works[-2] if len(self.works) > 1 else None)
        if self._bar is not None:
            self._bar.close()

    def update(self, steps: int = 1) -> None:
        """Count further steps as done."""
        self.done += steps
        if perf_counter() >= self.works[0]._due:
            self.works[0]._draw(self.works[1:])

    def _draw(self, inside: tuple[Progress, ...]) -> None:
        """Draw what is done, if somebody sees it."""
        if not _seen():
            self._due = inf
            return
        if self._bar is None:
            self._bar = _bar(self)
        self._bar.n = self.done
        if not self.total:
            self._bar.set_description_str(_counts(self), refresh=False)
        self._bar.set_postfix_str(", ".join(map(_counts, inside)))  # and refreshes
        self._due = perf_counter() + INTERVAL


_OPEN: ContextVar[Progress | None] = ContextVar("open work", default=None)


def step_done(steps: int = 1) -> None:
    """Count a step of the innermost open work, if there is one; 0 only keeps its clock going."""
    work = _OPEN.get()
    if work is not None:
        work.update(steps)


@contextmanager
def reported(name: str) -> Iterator[None]:
    """The progress of a function that may take long; decorates it with the name of what it does."""
    with Progress(name):
        yield


def counted(name: str, items: Iterable[T], total: int) -> Iterator[T]:
    """The items one after the other, with a bar where there are several."""
    if total < 2:
        yield from items
        return
    with Progress(name, total) as work:
        for item in items:
            yield item
            work.update()


def _counts(work: Progress) -> str:
    """What is done, and how much of it where that is counted."""
    if work.total:
        return f"{work.name} {work.done}/{work.total}"
    return f"{work.name} {work.done}" if work.done else work.name


def _seen() -> bool:
    """Whether somebody sees a bar that this thread draws."""
    from multiprocessing import parent_process  # noqa: PLC0415 -- after a second only

    main = threading.current_thread() is threading.main_thread() and parent_process() is None
    terminal = sys.stderr is not None and sys.stderr.isatty()
    return main and (terminal or _in_notebook()) and find_spec("tqdm") is not None


def _in_notebook() -> bool:
    """Whether a kernel runs this; a program that only imports ipykernel has none."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


def _bar(work: Progress) -> Any:
    if _in_notebook() and find_spec("ipywidgets"):
        from tqdm.notebook import tqdm  # noqa: PLC0415 -- an extra
    else:
        from tqdm import tqdm  # noqa: PLC0415
    # tqdm's own thread would be there when a pool forks its workers.
    threadless = type("tqdm", (tqdm,), {"monitor_interval": 0})
    layout = {} if work.total else {"bar_format": WITHOUT_TOTAL}
    # With any delay tqdm draws when it is told to, and not before it knows the time of the start.
    made = threadless(desc=work.name, total=work.total or None, delay=1e-9, leave=False, **layout)
    if not made.disable:  # as by TQDM_DISABLE=1
        made.start_t -= perf_counter() - work.start
    return made
