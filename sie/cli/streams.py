"""Output of the command on standard output and standard error."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import textwrap
from typing import TextIO

from sie.arguments import WIDE

# Characters that are printed at once: if standard output is not buffered, Python does not report an
# error that occurs in the midst of one piece.
PIECE = 4096


def print_text(text: str) -> None:
    """Print the text, with question marks where the encoding has no character. Raises OSError."""
    if sys.stdout is None:
        raise OSError("standard output is closed: send it to a file, or to the null device")
    text = _encodable(text, sys.stdout)
    for start in range(0, len(text), PIECE):
        print(text[start : start + PIECE], end="")
    sys.stdout.flush()


def _encodable(text: str, stream: TextIO) -> str:
    """The text, with question marks for the characters that the stream has not."""
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "replace").decode(encoding)


def terminal_width() -> int:
    """The columns of the terminal; those of a report where output goes elsewhere."""
    return shutil.get_terminal_size((WIDE, 24)).columns if _on_terminal() else WIDE


def broken(text: str, width: int) -> str:
    """The text with lines of at most so many columns, as far as there are blanks to break at.

    What goes on below a line of a table, whose columns are two blanks apart, stands below the last.
    """
    return "\n".join(
        line if len(line) <= width else _broken(line, width) for line in text.splitlines()
    )


def _broken(line: str, width: int) -> str:
    indent = " " * (line.rfind("  ") + 2 if "  " in line else 0)
    return textwrap.fill(
        line, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def _on_terminal() -> bool:
    return sys.stdout is not None and sys.stdout.isatty()


def print_error(sentence: str) -> None:
    """Print a sentence on standard error, if that is open."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            print("sie:", _encodable(sentence, sys.stderr), file=sys.stderr, flush=True)


def discard_output() -> None:
    """Send a standard output that cannot be written to (closed pipe, full disk) to the null device.

    Python would report it again when it ends.
    """
    try:
        sys.stdout.flush()
    except (OSError, ValueError, AttributeError):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
