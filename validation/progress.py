"""A progress bar on stderr, by the time that topics usually take; a line for each topic where stderr is not a terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import TextIO

WIDTH = 24


class Progress:
    """`topic` begins one, `tell` says what is done in it, `done` ends the line."""

    def __init__(self, seconds: Sequence[float], stream: TextIO | None = None) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.seconds = list(seconds)
        self.started = time.perf_counter()
        self.current = -1
        self.name = ""
        self.began = self.started

    def topic(self, name: str) -> None:
        self.current, self.name, self.began = self.current + 1, name, time.perf_counter()
        if not self.stream.isatty():
            self.stream.write(f"{self.name} ...\n")
        self.tell("")

    def tell(self, what: str) -> None:
        if self.stream.isatty():
            share = self.share()
            bar = "█" * round(WIDTH * share) + "·" * (WIDTH - round(WIDTH * share))
            self.stream.write(f"\r\x1b[K{bar} {100 * share:3.0f} %  {self.name}: {what}"[:118])
            self.stream.flush()

    def share(self) -> float:
        """Of the whole: the topics behind, and of this one what its usual time says, at most nearly all."""
        if self.current < 0:
            return 0.0
        usual = self.seconds[self.current]
        within = min(time.perf_counter() - self.began, 0.98 * usual)
        return (sum(self.seconds[: self.current]) + within) / sum(self.seconds)

    def done(self) -> float:
        """Seconds since the start."""
        if self.stream.isatty():
            self.stream.write("\r\x1b[K")
        return time.perf_counter() - self.started
