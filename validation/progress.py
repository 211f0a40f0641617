"""A progress bar on stderr, by the time that topics usually take; a line for each topic where stderr is not a terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from typing import TextIO

WIDTH = 24


class Progress:
    """`topic` begins one, `tell` says what is done in it, `behind` ends it; `done` ends the line."""

    def __init__(self, seconds: Mapping[str, float], stream: TextIO | None = None) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.seconds = dict(seconds)
        self.started = time.perf_counter()
        self.finished = 0.0
        self.name, self.began = "", self.started

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
            self.stream.write(f"\r\x1b[K{bar} {100 * share:3.0f} %  {self.name}{': ' if self.name else ''}{what}"[:118])
            self.stream.flush()

    def share(self) -> float:
        """Of the whole: the topics behind, and of this one what its usual time says, at most nearly all."""
        within = min(time.perf_counter() - self.began, 0.98 * self.seconds[self.name]) if self.name else 0.0
        return (self.finished + within) / sum(self.seconds.values())

    def done(self) -> float:
        """Seconds since the start."""
        if self.stream.isatty():
            self.stream.write("\r\x1b[K")
        return time.perf_counter() - self.started
