"""What a worker does for a sweep: the wanted quantities of some of its scenes.

Neighbouring points share what does not change between them, so that the normal problem under many
tangential loads is solved once. The answers do not depend on which points are asked together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, CancelledError
from dataclasses import replace
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from sie.errors import ContactError
from sie.problem.scene import Scene
from sie.progress_bar import Progress
from sie.sensitivity.derivative import peaks
from sie.solution import Solution, solve

from .result import PARTS, Answer

Point = dict[str, Any]
Wanted = Callable[[Solution], Any]

DEFAULT = ("half_width", "centre", "normal_load", "moment", "tilt")


def _parts(name: str, values: Callable[[Solution], tuple[float, ...]]) -> Wanted:
    """A quantity of several values, each with a name of its own."""
    return lambda solution: dict(zip(PARTS[name], values(solution), strict=True))


def _elastic_limit(solution: Solution) -> tuple[float, ...]:
    found = solution.elastic_limit()
    return found.ratio, found.load, found.x, found.y


QUANTITIES: dict[str, Wanted] = {
    **{name: attrgetter(name) for name in (*DEFAULT, "contact_length", "gap_volume")},
    "patches": lambda s: float(len(s.patches)),
    "edges": _parts("edges", lambda s: s.edges),
    "peak_pressure": lambda s: float(s.pressure(peaks(s)[0])),
    "shear_load": lambda s: s.shear.resultant,
    "elastic_limit": _parts("elastic_limit", _elastic_limit),
    "peak_tension": _parts("peak_tension", lambda s: s.peak_tension()),
    "error": lambda s: s.check().error,
}


class Work(NamedTuple):
    """The question at every point."""

    scene: Scene | Callable[..., Scene]
    wanted: dict[str, str | Wanted]
    tol: float


def answers_of(work: Work, points: Iterable[Point]) -> Iterator[Answer]:
    """The answers at points, one after the other."""
    last: Solution | None = None
    for point in points:
        try:
            last = _solution(work.scene, point, work.tol, last)
            answer: Answer = (_values(last, work.wanted), "")
        # a user's function may raise any error: one point must not lose the others
        except Exception as problem:
            answer = ({}, reason(problem))
        yield answer


def chunk_of(work: Work, points: list[Point]) -> list[Answer]:
    """The answers of one chunk, in another process or thread."""
    with Progress("chunk", shown=False):
        return list(answers_of(work, points))


def reason(problem: Exception) -> str:
    """The message of an error, after its class if it is none of this package."""
    if isinstance(problem, CancelledError):
        return "the executor was closed before it computed this chunk: ask for these points again"
    if isinstance(problem, BrokenExecutor) or type(problem).__name__ == "KilledWorker":  # of Dask
        return (
            "a process died, and with it its pool: its memory was exhausted, or a function that is "
            "wanted crashed; ask for these points again, with a smaller chunk"
        )
    return (
        str(problem)
        if isinstance(problem, (ContactError, ValueError))
        else f"{type(problem).__name__}: {problem}"
    )


def _solution(scene: Any, point: Point, tol: float, last: Solution | None) -> Solution:
    """The solution at a point, with the stages of the last one that cannot have changed."""
    if not isinstance(scene, Scene):
        return solve(scene(**point), tol=tol)
    changes = {name: value for name, value in point.items() if "." not in name}
    of_profile = {name.partition(".")[2]: point[name] for name in point.keys() - changes.keys()}
    if of_profile:
        changes["profile"] = replace(changes.get("profile", scene.profile), **of_profile)
    base = last if last is not None else solve(replace(scene), tol=tol)
    return base.with_(**changes)


def _values(solution: Solution, wanted: dict[str, Any]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, quantity in wanted.items():
        value = (QUANTITIES[quantity] if isinstance(quantity, str) else quantity)(solution)
        values |= value if isinstance(value, Mapping) else {name: value}
    return {name: _floats(name, value) for name, value in values.items()}


def _floats(name: str, value: Any) -> Any:
    if type(value) is float:
        return np.float64(value)
    try:
        array = np.asarray(value)
        if array.dtype.kind in "biuf":
            return array.astype(float)
    except ValueError:  # lists of unequal lengths
        pass
    raise ValueError(f"{name} is neither a number nor an array of numbers: {type(value).__name__}")
