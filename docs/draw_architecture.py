"""Draw docs/architecture.svg: the folders and modules of `sie`, and what imports what.

    python docs/draw_architecture.py

A box is a folder of `sie` or a module beside them. A box stands above all boxes that it imports
from. An arrow is left out where a chain of other arrows says the same.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

DOCS = Path(__file__).parent
SOLVER = DOCS.parent / "sie"
PICTURE = DOCS / "architecture.svg"
# The face of the package, of the command, data, and the handler of Ctrl-C.
LEFT_OUT = {"__init__", "__main__", "examples"}
UPWARD = "-- a higher layer"  # the remark on an import that points upward
WIDTH, HEIGHT, ACROSS, DOWN, MARGIN = 128, 30, 18, 44, 16


def boxes() -> dict[str, set[str]]:
    """Each folder or module of the solver, and those that it imports from."""
    below: dict[str, set[str]] = {}
    for path in sorted(SOLVER.rglob("*.py")):
        box = path.relative_to(SOLVER).parts[0].removesuffix(".py")
        below.setdefault(box, set()).update(set(_imported(path)) - {box})
    return {box: {b for b in names if b in below} - LEFT_OUT
            for box, names in below.items() if box not in LEFT_OUT}  # fmt: skip


def _imported(path: Path) -> Iterator[str]:
    """The boxes that a file imports from, but those that a method hands its work up to."""
    package = ["sie", *path.relative_to(SOLVER).parts[:-1]]
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import | ast.ImportFrom) and UPWARD in lines[node.lineno - 1]:
            continue
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            start = package[: len(package) - node.level + 1] if node.level else []
            module = ".".join([*start, node.module or ""]).strip(".")
            names = [f"{module}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from (name.split(".")[1] for name in names if name.startswith("sie."))


def heights(below: dict[str, set[str]]) -> dict[str, int]:
    """The row of each box from the ground up: one above the highest that it imports from."""
    rows: dict[str, int] = {}

    def row(box: str, above: tuple[str, ...] = ()) -> int:
        if box not in rows:
            lower = sorted(below[box] - {*above, box})  # of a circle one arrow points upward
            height = 1 + max((row(b, (*above, box)) for b in lower), default=-1)
            rows[box] = height
        return rows[box]

    for box in sorted(below):
        row(box)
    return rows


def arrows(below: dict[str, set[str]]) -> list[tuple[str, str]]:
    """The imports that no chain of others implies."""

    def reach(box: str, seen: set[str]) -> set[str]:
        for b in below[box] - seen:
            seen.add(b)
            reach(b, seen)
        return seen

    return [
        (box, b)
        for box in sorted(below)
        for b in sorted(below[box])
        if not any(b in reach(other, set()) for other in below[box] - {b} if other != box)
    ]


def picture() -> str:
    """The drawing as SVG text."""
    below = boxes()
    rows = heights(below)
    top = max(rows.values())
    levels = [sorted(b for b in rows if rows[b] == top - k) for k in range(top + 1)]
    full = max(map(len, levels)) * (WIDTH + ACROSS) - ACROSS
    place = {}
    for k, level in enumerate(levels):
        start = 0.5 * (full - len(level) * (WIDTH + ACROSS) + ACROSS)
        for j, box in enumerate(level):
            place[box] = (MARGIN + start + j * (WIDTH + ACROSS), MARGIN + k * (HEIGHT + DOWN))
    size = full + 2 * MARGIN, (top + 1) * (HEIGHT + DOWN) - DOWN + 2 * MARGIN
    lines = [_line(place[box], place[b]) for box, b in arrows(below)]
    drawn = [_box(box, *place[box]) for box in sorted(place)]
    return "\n".join([_head(*size), *lines, *drawn, "</svg>", ""])


def _head(width: float, height: float) -> str:
    return f"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}"
  font-family="sans-serif" font-size="13" text-anchor="middle">
<title>What imports what in sie: every arrow points downward</title>
<defs><marker id="tip" markerWidth="7" markerHeight="6" refX="7" refY="3" orient="auto">
  <path d="M0,0 L7,3 L0,6 z" fill="#777"/></marker></defs>
<rect width="100%" height="100%" fill="white"/>"""


def _line(upper: tuple[float, float], lower: tuple[float, float]) -> str:
    x1, y1 = upper[0] + 0.5 * WIDTH, upper[1] + HEIGHT
    x2, y2 = lower[0] + 0.5 * WIDTH, lower[1]
    middle = 0.5 * (y1 + y2)
    curve = f"M{x1:g},{y1:g} C{x1:g},{middle:g} {x2:g},{middle:g} {x2:g},{y2:g}"
    return f'<path d="{curve}" fill="none" stroke="#777" marker-end="url(#tip)"/>'


def _box(name: str, x: float, y: float) -> str:
    is_folder = (SOLVER / name).is_dir()
    colour, label = ("#dbe9f6", f"{name}/") if is_folder else ("#f3f0e6", name)
    return (
        f'<rect x="{x:g}" y="{y:g}" width="{WIDTH}" height="{HEIGHT}" rx="4" fill="{colour}" '
        f'stroke="#345"/><text x="{x + 0.5 * WIDTH:g}" y="{y + 20:g}">{label}</text>'
    )


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
