"""Output of the command on standard output and standard error."""

from __future__ import annotations

import contextlib
import logging
import os
import sys
from collections.abc import Iterator

from .stages import LOG

# Characters that are printed at once: if standard output is not buffered, Python does not report an
# error that occurs in the midst of one piece.
PIECE = 4096
# For a terminal without block elements.
PLAIN = {
    ord(fancy): plain
    for fancy, plain in zip("▁▂▃▄▅▆▇█│└─↑∫", (*"..::--##|+-^", "int "), strict=True)
}


def print_text(text: str) -> None:
    """Print the text, in plain characters where the encoding has no others. Raises OSError."""
    if sys.stdout is None:
        raise OSError("standard output is closed: send it to a file, or to the null device")
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        text = text.translate(PLAIN).encode(encoding, "replace").decode(encoding)
    for start in range(0, len(text), PIECE):
        print(text[start : start + PIECE], end="")
    sys.stdout.flush()


def print_error(sentence: str) -> None:
    """Print a sentence on standard error, if that is open."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            print("sie:", sentence, file=sys.stderr, flush=True)


@contextlib.contextmanager
def logged(level: str | None) -> Iterator[None]:
    """Send the log to standard error in the block, from a level on; nothing without a level."""
    if level is None or sys.stderr is None:
        yield
        return
    handler, before = logging.StreamHandler(sys.stderr), LOG.level
    handler.setFormatter(logging.Formatter("sie: %(relativeCreated)d ms: %(message)s"))
    LOG.addHandler(handler)
    LOG.setLevel(level.upper())
    try:
        yield
    finally:
        LOG.removeHandler(handler)
        LOG.setLevel(before)


def discard_output() -> None:
    """Send a standard output that cannot be written to (closed pipe, full disk) to the null device.

    Python would report it again when it ends.
    """
    try:
        sys.stdout.flush()
    except (OSError, ValueError, AttributeError):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
