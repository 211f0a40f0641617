"""The command line in a process of its own."""

import subprocess
import sys
from typing import Any


def run(*argv: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """`python -m sie` with these arguments; its status, output and messages."""
    return subprocess.run(
        [sys.executable, "-m", "sie", *argv],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        **options,
    )
