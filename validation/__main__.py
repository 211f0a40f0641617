"""python -m validation [--quick] [--only NAME]: compute every claim anew.

The result is one HTML page with pictures, and one JSON file of every number.

The page and the numbers go to build/validation/ (or --out). The exit status is 1 if a claim fails,
or a check is blind.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from sie.files import write_files
from validation import readme
from validation.harness.report import Section, machine, number, page
from validation.harness.running import run

# Modules of this package, in the order of the page.
TOPICS = (
    "paper", "appendix", "pressure", "speed", "stress", "collocation", "work_precision", "slip",
    "histories", "sliding", "spence", "sampled", "patches", "reference_data", "cracks", "growth",
    "stability", "kinks", "certificate", "economy", "mutation",
)  # fmt: skip
NOT_WRITTEN = 2
INTERRUPTED = 130  # the exit status of shells for it


def main(arguments: Sequence[str] | None = None) -> int:
    given = parsed(arguments)
    names = [name for name in TOPICS if given.only is None or name in given.only]
    try:
        sections, seconds = run(names, given.quick)
    except KeyboardInterrupt:
        print("\ninterrupted: nothing was written", file=sys.stderr)
        return INTERRUPTED
    try:
        write_files(contents(given, sections, seconds))
    except OSError as problem:
        print(problem, file=sys.stderr)
        return NOT_WRITTEN
    return summary(sections, seconds, given.out)


def parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The options; a request that cannot be met ends the program before anything runs."""
    parser = argparse.ArgumentParser(
        prog="python -m validation",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    topics = f"one topic (may be repeated): {', '.join(TOPICS)}"
    folder = Path("build/validation")
    add("--quick", action="store_true", help="less of each topic: about a minute")
    add("--only", choices=TOPICS, metavar="NAME", action="append", help=topics)
    add("--out", type=Path, default=folder, metavar="DIR", help="where the report goes")
    add("--readme", action="store_true", help="write the README's table anew from this run")
    given = parser.parse_args(arguments)
    if importlib.util.find_spec("matplotlib") is None:
        parser.error("the report's figures need Matplotlib: pip install -e '.[plot]'")
    if given.readme and given.only and not set(readme.TOPICS) <= set(given.only):
        parser.error(
            f"--readme makes its table of the topics {' and '.join(readme.TOPICS)}: run it without "
            f"--only, or with both"
        )
    if not writable(given.out):
        parser.error(f"--out {given.out} is no folder that can be written to: give another")
    return given


def contents(
    given: argparse.Namespace, sections: Sequence[Section], seconds: float
) -> dict[Path, bytes]:
    """The page and the numbers, and the README with its numbers where that is asked for."""
    numbers = {
        "machine": machine(),
        "quick": given.quick,
        "seconds": seconds,
        "topics": {s.name: s.found.as_json() for s in sections},
    }
    text = json.dumps(numbers, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    html = page(sections, seconds, given.quick)
    files = {
        given.out / "report.html": html.encode(),
        given.out / "report.json": text.encode(),
    }
    return files | (readme.files(numbers) if given.readme else {})


def writable(out: Path) -> bool:
    """Whether the report can be written there, tested before the run; makes the folder."""
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(out, os.W_OK)


def summary(sections: Sequence[Section], seconds: float, out: Path) -> int:
    """The claims that failed, and the place of the page."""
    claims = [(s.name, c) for s in sections for c in s.found.claims]
    failed = [(name, c) for name, c in claims if not c.ok]
    for s in sections:
        print(
            f"{s.name:<16} {sum(c.ok for c in s.found.claims):3d} of {len(s.found.claims):3d} "
            f"claims, {s.seconds:6.1f} s"
        )
    for name, c in failed:
        print(
            f"{c.verdict.upper()}: {name}: {c.what} (measured {number(c.measured)}, bar {c.bar}; "
            f"{c.wrong}: {number(c.control)})"
        )
    print(
        f"{len(claims)} claims, {len(failed)} failed, {seconds:.0f} s: {out / 'report.html'}, "
        f"{out / 'report.json'}"
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
