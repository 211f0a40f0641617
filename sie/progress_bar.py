"""A progress bar on standard error."""

from __future__ import annotations

import sys
import time

PATIENCE = 1.0  # seconds of work before a progress bar appears
REDRAWN, BAR = 0.2, 24  # seconds between two pictures of the bar; its length in columns


class Progress:
    """A bar on standard error, if that is a terminal and the work is long."""

    def __init__(self, total: int, wanted: bool) -> None:
        self.total, self.done, self.start, self.drawn = total, 0, time.monotonic(), 0.0
        self.seen = wanted and sys.stderr is not None and sys.stderr.isatty()

    def advance(self, points: int) -> None:
        """Counts further points as done, and draws the bar if it is due."""
        self.done += points
        now = time.monotonic()
        elapsed = now - self.start
        if not self.seen or elapsed < PATIENCE or now - self.drawn < REDRAWN:
            return
        self.drawn = now
        full = BAR * self.done // self.total
        left = elapsed / self.done * (self.total - self.done)
        bar = f"{'#' * full}{'-' * (BAR - full)}"
        told = f"\rsweep |{bar}| {self.done}/{self.total}, {left:.0f} s left "
        print(told, end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Wipes the bar, if it was drawn."""
        if self.drawn:
            print("\r" + " " * (BAR + 50) + "\r", end="", file=sys.stderr, flush=True)
