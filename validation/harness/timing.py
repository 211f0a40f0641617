"""Run times on a busy machine: two programs in turns, and the median of their ratio.

The clock is that of the processor: what other programs take does not count.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from statistics import median
from typing import Any

REPEATS, MOST_LOOPS = 9, 20
FEWEST, SHORT = 3, 0.05  # repeats of what takes less than SHORT seconds, so that a median is one
PATIENCE = 0.25  # seconds for one measurement, about


def compared(
    run: Callable[[], Any], other: Callable[[], Any], patience: float = PATIENCE
) -> tuple[float, float]:
    """(median seconds of `run`, median of its ratio to `other`)."""
    (seconds, _), ratio = _in_turns((run, other), patience)
    return seconds, ratio


def medians(runs: Sequence[Callable[[], Any]], patience: float = PATIENCE) -> list[float]:
    """Median seconds of each, measured in turns."""
    return _in_turns(runs, patience)[0]


def fastest(runs: Sequence[Callable[[], Any]], patience: float = PATIENCE) -> list[float]:
    """Shortest seconds of each, in turns.

    They serve for growth, because the delay by a busy machine does not grow with the work.
    """
    return _in_turns(runs, patience, min)[0]


def _in_turns(
    runs: Sequence[Callable[[], Any]],
    patience: float,
    of: Callable[[Iterable[float]], float] = median,
) -> tuple[list[float], float]:
    once = sum(_timed(run, 1) for run in runs)  # the first call fills caches and is not kept
    once = min(once, sum(_timed(run, 1) for run in runs)) if once < patience else once
    repeats = max(min(REPEATS, int(patience / once)), FEWEST if once < SHORT else 1)
    loops = max(min(MOST_LOOPS, int(patience / (once * repeats))), 1)
    turns = [[_timed(run, loops) for run in runs] for _ in range(repeats)]
    return [of(column) for column in zip(*turns, strict=True)], median(
        turn[0] / turn[-1] for turn in turns
    )


def _timed(run: Callable[[], Any], loops: int) -> float:
    """The shortest of some calls."""
    best = float("inf")
    for _ in range(loops):
        start = time.process_time()
        run()
        best = min(best, time.process_time() - start)
    return best
