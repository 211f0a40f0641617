"""A progress bar on stderr, by the usual times of the topics.

If stderr is not a terminal, it prints a line for each topic.
"""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Iterable, Mapping
from typing import TextIO

WIDTH = 24


class Progress:
    """`topic` begins one, `beside` several at once, `tell` shows the work, `behind` ends a topic.

    `done` ends the line.
    """

    def __init__(self, seconds: Mapping[str, float], stream: TextIO | None = None) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.seconds = dict(seconds)
        self.started = time.perf_counter()
        self.finished = 0.0
        self.name, self.began = "", self.started
        self.together, self.at_once = 0.0, 1  # usual seconds of the topics beside each other

    def beside(self, names: Iterable[str], at_once: int) -> None:
        self.together, self.at_once = sum(self.seconds[name] for name in names), at_once

    def topic(self, name: str) -> None:
        self.name, self.began = name, time.perf_counter()
        if not self.stream.isatty():
            self.stream.write(f"{name} ...\n")
        self.tell("")

    def behind(self, name: str) -> None:
        self.finished += self.seconds[name]
        if name == self.name:
            self.name = ""
        elif not self.stream.isatty():
            self.stream.write(f"{name} done\n")
        self.tell(name)

    def tell(self, what: str) -> None:
        if self.stream.isatty():
            share = self.share()
            bar = "█" * round(WIDTH * share) + "·" * (WIDTH - round(WIDTH * share))
            line = f"{bar} {100 * share:3.0f} %  {self.name}{': ' if self.name else ''}{what}"
            # A line that breaks would stay.
            self.stream.write("\r\x1b[K" + line[: shutil.get_terminal_size().columns - 1])
            self.stream.flush()

    def share(self) -> float:
        """The share of the work that is done, by usual times; less than 1 for topics under way."""
        now = time.perf_counter()
        within = min(now - self.began, 0.98 * self.seconds[self.name]) if self.name else 0.0
        beside = min(self.at_once * (now - self.started), 0.98 * self.together)
        return max(self.finished + within, beside) / sum(self.seconds.values())

    def done(self) -> float:
        """Seconds since the start."""
        if self.stream.isatty():
            self.stream.write("\r\x1b[K")
        return time.perf_counter() - self.started
