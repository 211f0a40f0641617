"""Ctrl-C ends the command with exit code 130 and a sentence, also during import and exit.

`main` handles an interruption while it runs. Before and after that, and only in a process that was
started as `sie` or `python -m sie`, the handler of this module takes the place of Python's own;
nothing is open then that has to be closed. Where `sie` is imported by a program of another name,
nothing changes.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from pathlib import Path
from typing import Any

INTERRUPTED, SENTENCE = 130, "interrupted by Ctrl-C"
# While a package is imported by "python -m", its name is not yet in sys.argv.
PROGRAM = "sie" in sys.orig_argv if sys.argv[:1] == ["-m"] else Path(*sys.argv[:1]).stem == "sie"


def _exit(*_: Any) -> None:
    with contextlib.suppress(OSError):  # standard error is closed
        os.write(2, f"sie: {SENTENCE}\n".encode())
    os._exit(INTERRUPTED)


def outside() -> None:
    """Let Ctrl-C end the process at once from here on."""
    if PROGRAM and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _exit)


def inside() -> None:
    """Let Ctrl-C raise KeyboardInterrupt again from here on."""
    if signal.getsignal(signal.SIGINT) is _exit:
        signal.signal(signal.SIGINT, signal.default_int_handler)


outside()
