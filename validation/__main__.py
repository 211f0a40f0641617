"""python -m validation [--quick] [--only NAME] [--json FILE]: claims computed anew, with every error and every run time."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from types import ModuleType

from . import collocation, figures, pressure, stress

TOPICS: dict[str, ModuleType] = {"pressure": pressure, "collocation": collocation, "stress": stress, "figures": figures}


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a few cases of each topic")
    parser.add_argument("--only", choices=TOPICS, help="one topic")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every number there as well")
    arguments = parser.parse_args()
    report = {}
    for name, topic in TOPICS.items():
        if arguments.only not in (None, name):
            continue
        found = []
        for row in topic.rows(arguments.quick):
            print(f"\r{name}: {row.case:<40}", end="", file=sys.stderr, flush=True)
            found.append(row)
        print(f"\r{'':<60}\r{topic.__doc__}\n{topic.table(found)}\n")
        report[name] = topic.as_json(found)
    if arguments.json:
        arguments.json.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
