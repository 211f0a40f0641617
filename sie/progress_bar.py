"""A progress bar, by tqdm where that is installed, on work that takes more than a second.

It is drawn on standard error where that is a terminal, and in a notebook, and wiped at the end.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from typing import Any, Protocol, TypeVar

PATIENCE = 1.0  # seconds of work before a bar appears
T = TypeVar("T")


class Bar(Protocol):
    """What is told how much work is done."""

    def update(self, n: int) -> Any:
        """Count further points as done."""

    def close(self) -> Any:
        """Wipe the bar."""


class _NoBar:
    def update(self, n: int) -> None: ...

    def close(self) -> None: ...


def bar(name: str, total: int, wanted: bool = True) -> Bar:
    """A bar for so many points."""
    notebook = _in_notebook()
    seen = notebook or (sys.stderr is not None and sys.stderr.isatty())
    if not (wanted and seen and find_spec("tqdm")):
        return _NoBar()
    if notebook and find_spec("ipywidgets"):
        from tqdm.notebook import tqdm  # noqa: PLC0415 -- an extra
    else:
        from tqdm import tqdm  # noqa: PLC0415
    # tqdm's own thread would be there when a pool forks its workers.
    threadless = type("tqdm", (tqdm,), {"monitor_interval": 0})
    made: Bar = threadless(desc=name, total=total, delay=PATIENCE, leave=False)
    return made


def _in_notebook() -> bool:
    """Whether a kernel runs this; a program that only imports ipykernel has none."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


def counted(name: str, items: Iterable[T], total: int) -> Iterator[T]:
    """The items one after the other, with a bar."""
    shown = bar(name, total)
    try:
        for item in items:
            yield item
            shown.update(1)
    finally:
        shown.close()
