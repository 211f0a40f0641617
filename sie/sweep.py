"""Many scenes at once: one question over a grid of parameters, on one core or as many as an executor has.

    sweep(scene, over={"friction": f, "tilt": t}, want=["half_width", "elastic_limit"], executor=ProcessPoolExecutor())

`over` names fields of the scene, or parameters of its profile as "profile.half_flat"; or `scene` is a function of the named parameters that
returns a Scene. Points are taken in chunks of neighbours, last name fastest, so that what does not change between two of them (a normal
problem under many tangential loads) is solved once. Any `concurrent.futures.Executor` will do: a process pool, Dask's
`client.get_executor()`, `mpi4py.futures.MPIPoolExecutor()`. A scene without an answer leaves nan and the sentence that says why.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import closing
from dataclasses import fields, replace
from operator import attrgetter
from typing import Any, NamedTuple, cast

import numpy as np

from .errors import ContactError
from .scene import Scene
from .solution import Solution, solve

Point = dict[str, Any]
Answer = tuple[dict[str, Any], str]  # values by name, and why there are none ("" if there are)
Wanted = Callable[[Solution], Any]

DEFAULT = ("half_width", "centre", "normal_load", "moment", "tilt")
# A chunk is as long as this many would share the work evenly among themselves, in a pool whose size is not known.
CHUNKS, LONGEST_CHUNK = 64, 256
PATIENCE = 1.0  # seconds of work before a progress bar appears
REDRAWN, BAR = 0.2, 24  # seconds between two pictures of the bar; its length in columns


def _elastic_limit(solution: Solution) -> dict[str, float]:
    found = solution.elastic_limit()
    return {"elastic_limit": found.ratio, "elastic_limit_load": found.load, "elastic_limit_x": found.x, "elastic_limit_y": found.y}


def _peak_tension(solution: Solution) -> dict[str, float]:
    found = solution.peak_tension()
    return {"peak_tension": found.value, "peak_tension_x": found.x}


def _edges(solution: Solution) -> dict[str, float]:
    return dict(zip(("x1", "x2"), solution.edges, strict=True))


QUANTITIES: dict[str, Wanted] = {
    **{name: attrgetter(name) for name in DEFAULT},
    "edges": _edges,
    "shear_load": lambda s: s.shear.resultant,
    "elastic_limit": _elastic_limit,
    "peak_tension": _peak_tension,
    "error": lambda s: s.check().error,
}


# What of these is called otherwise in a result: nan where no point has an answer.
PARTS = {
    "edges": ("x1", "x2"),
    "elastic_limit": ("elastic_limit", "elastic_limit_load", "elastic_limit_x", "elastic_limit_y"),
    "peak_tension": ("peak_tension", "peak_tension_x"),
}


class Interrupted(KeyboardInterrupt):
    """A sweep that was interrupted; `result` is what it had found, the rest nan and "interrupted"."""

    def __init__(self, result: Any) -> None:
        super().__init__("the sweep was interrupted: what it found is in the exception's `result`")
        self.result = result


def sweep(
    scene: Scene | Callable[..., Scene],
    over: Mapping[str, Sequence[Any]],
    want: str | Iterable[str] | Mapping[str, Wanted] = DEFAULT,
    executor: Executor | None = None,
    *,
    tol: float = 1e-13,
    chunk: int | None = None,
    progress: bool = True,
) -> Any:
    """What is wanted of every scene of the grid: an xarray.Dataset where xarray is installed, otherwise a dict of NumPy arrays.

    over       the values of each parameter, by name; the results have one dimension for each, in this order
    want       names among `sie.QUANTITIES`, or functions of a Solution by name that return a number, an array or a dict of them
    executor   where chunks run; None is here. For a process pool, functions must be importable (no lambdas)
    chunk      points in a chunk; progress: a bar on standard error, if it is a terminal and the work takes more than a second

    Beside the values there is "reason", why a point has none. ValueError, before any work is done, for names that are not known.
    `Interrupted`, with all that was found, in place of KeyboardInterrupt.

    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
    >>> found = sie.sweep(scene, over={"normal_load": [0.25, 1.0]}, want="half_width")
    >>> [round(float(b), 6) for b in found["half_width"]]
    [0.56419, 1.128379]
    """
    axes = _axes(scene, over)
    wanted = _wanted(want)
    points = list(_points(axes))
    size = _chunk_size(chunk, len(points), executor)
    chunks = [points[i : i + size] for i in range(0, len(points), size)]
    found: dict[int, list[Answer]] = {}
    bar = _Progress(len(points), progress)
    try:
        with closing(_answered(Work(scene, wanted, tol), chunks, executor, found)) as answered:
            for k, answers in answered:
                found[k] = answers
                bar.show(sum(map(len, found.values())))
    except KeyboardInterrupt:
        raise Interrupted(_labelled(axes, wanted, chunks, found)) from None
    finally:
        bar.clear()
    return _labelled(axes, wanted, chunks, found)


# -- the grid ----------------------------------------------------------------------------------------------------------


def _axes(scene: Scene | Callable[..., Scene], over: Mapping[str, Sequence[Any]]) -> dict[str, list[Any]]:
    if not over:
        raise ValueError('nothing to sweep over: give over = {"normal_load": [...], ...}')
    for name, values in over.items():
        if isinstance(values, str) or not hasattr(values, "__len__") or not len(values):
            raise ValueError(f"over {name} = {values!r} holds no values: give a sequence of them")
        if isinstance(scene, Scene):
            _check_name(scene, name)
    return {name: [v.item() if isinstance(v, np.generic) else v for v in values] for name, values in over.items()}


def _check_name(scene: Scene, name: str) -> None:
    owner, _, parameter = name.rpartition(".")
    known = (
        {f.name for f in fields(cast(Any, scene.profile))}
        if owner == "profile"
        else {f.name for f in fields(Scene)}
        if not owner
        else set()
    )
    if parameter not in known:
        here = ", ".join(sorted(known)) if known else 'a field of a scene, or "profile." and a parameter of its profile'
        raise ValueError(f'over "{name}" is not known: choose {here}')


def _points(axes: dict[str, list[Any]]) -> Iterator[Point]:
    for index in np.ndindex(*map(len, axes.values())):
        yield {name: values[i] for (name, values), i in zip(axes.items(), index, strict=True)}


def _chunk_size(chunk: int | None, points: int, executor: Executor | None) -> int:
    if chunk is not None:
        if int(chunk) != chunk or chunk < 1:
            raise ValueError(f"chunk = {chunk!r} is not a number of points: give a whole number > 0")
        return int(chunk)
    return 1 if executor is None else min(max(math.ceil(points / CHUNKS), 1), LONGEST_CHUNK)


def _wanted(want: str | Iterable[str] | Mapping[str, Wanted]) -> dict[str, str | Wanted]:
    if isinstance(want, Mapping):
        return dict(want)
    names = (want,) if isinstance(want, str) else tuple(want)
    for name in names:
        if name not in QUANTITIES:
            raise ValueError(f'want "{name}" is not known: choose among {", ".join(QUANTITIES)}, or give a dict of functions of a solution')
    return {name: name for name in names}


# -- the work ----------------------------------------------------------------------------------------------------------


class Work(NamedTuple):
    """What is asked at every point."""

    scene: Scene | Callable[..., Scene]
    wanted: dict[str, str | Wanted]
    tol: float


def _answered(
    work: Work, chunks: list[list[Point]], executor: Executor | None, found: dict[int, list[Answer]]
) -> Generator[tuple[int, list[Answer]]]:
    """(number of a chunk, its answers), in the order in which they are ready; what an interruption leaves goes to `found`."""
    if executor is None:
        last: Solution | None = None
        for k, chunk in enumerate(chunks):
            found[k] = []
            last = _answer_into(found[k], work, chunk, last)
            yield k, found[k]
        return
    pending: dict[Future[list[Answer]], int] = {executor.submit(answers_of, work, chunk): k for k, chunk in enumerate(chunks)}
    try:
        while pending:
            for future in wait(pending, return_when=FIRST_COMPLETED)[0]:
                k = pending.pop(future)
                yield k, _chunk_result(future, len(chunks[k]))
    finally:
        for future, k in pending.items():
            if not future.cancel() and future.done():
                found[k] = _chunk_result(future, len(chunks[k]))


def _chunk_result(future: Future[list[Answer]], points: int) -> list[Answer]:
    """The answers of a chunk, or why there are none: a worker that died, or functions that cannot be sent to another process."""
    try:
        return future.result()
    except Exception as problem:  # whatever an executor raises
        return [({}, _reason(problem))] * points


def answers_of(work: Work, chunk: list[Point]) -> list[Answer]:
    """The answers of one chunk: what a worker runs."""
    answers: list[Answer] = []
    _answer_into(answers, work, chunk, None)
    return answers


def _answer_into(answers: list[Answer], work: Work, chunk: list[Point], last: Solution | None) -> Solution | None:
    """Appends the answer of each point; returns the last solution."""
    for point in chunk:
        try:
            last = _solution(work.scene, point, work.tol, last)
            answers.append((_values(last, work.wanted), ""))
        except Exception as problem:  # functions of a user raise what they like: one point must not cost the others
            answers.append(({}, _reason(problem)))
    return last


def _reason(problem: Exception) -> str:
    """The sentence that says why; of what is not ours, its kind too."""
    return str(problem) if isinstance(problem, (ContactError, ValueError)) else f"{type(problem).__name__}: {problem}"


def _solution(scene: Any, point: Point, tol: float, last: Solution | None) -> Solution:
    """The solution at a point, with the stages of the last one that cannot have changed."""
    if not isinstance(scene, Scene):
        return solve(scene(**point), tol=tol)
    changes = {name: value for name, value in point.items() if "." not in name}
    of_profile = {name.removeprefix("profile."): value for name, value in point.items() if "." in name}
    if of_profile:
        changes["profile"] = replace(changes.get("profile", scene.profile), **of_profile)
    base = last if last is not None else solve(replace(scene), tol=tol)
    return base.with_(**changes)


def _values(solution: Solution, wanted: dict[str, Any]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, quantity in wanted.items():
        value = (QUANTITIES[quantity] if isinstance(quantity, str) else quantity)(solution)
        values |= value if isinstance(value, Mapping) else {name: value}
    return {name: np.asarray(value, dtype=float) for name, value in values.items()}


# -- the result --------------------------------------------------------------------------------------------------------


def _labelled(axes: dict[str, list[Any]], wanted: dict[str, Any], chunks: list[list[Point]], found: dict[int, list[Answer]]) -> Any:
    answers: list[Answer] = []
    for k, chunk in enumerate(chunks):
        have = found.get(k, [])
        answers += [*have, *[({}, "interrupted")] * (len(chunk) - len(have))]
    shape = tuple(map(len, axes.values()))
    shapes: dict[str, tuple[int, ...]] = {}
    for values, _ in answers:
        for name, value in values.items():
            shapes[name] = tuple(map(max, zip(shapes[name], value.shape, strict=True))) if name in shapes else value.shape
    if not shapes:
        shapes = {part: () for name, of in wanted.items() for part in (PARTS.get(name, (name,)) if of == name else (name,))}
    data: dict[str, Any] = {}
    for name, inner in shapes.items():
        if name in axes:
            continue  # what is swept over is known
        array = np.full((len(answers), *inner), np.nan)
        for k, (values, _) in enumerate(answers):
            if name in values:
                place: Any = (k, *(slice(n) for n in values[name].shape))
                array[place] = values[name]
        data[name] = array.reshape(shape + inner)
    reasons = np.array([reason for _, reason in answers], dtype=object).reshape(shape)
    coordinates = {name: _coordinate(values) for name, values in axes.items()}
    try:
        import xarray  # type: ignore[import-not-found, unused-ignore]  # noqa: PLC0415
    except ImportError:
        return {**coordinates, **data, "reason": reasons}
    dims = tuple(axes)
    variables = {name: ((*dims, *(f"{name}_{i}" for i in range(a.ndim - len(dims)))), a) for name, a in data.items()}
    return xarray.Dataset({**variables, "reason": (dims, reasons)}, coords=coordinates)


def _coordinate(values: list[Any]) -> Any:
    if all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
        return np.array(values, dtype=float)
    return np.array([repr(v) for v in values], dtype=object)


class _Progress:
    """A bar on standard error, if someone sees it and it is worth while."""

    def __init__(self, total: int, wanted: bool) -> None:
        self.total, self.start, self.drawn = total, time.monotonic(), 0.0
        self.seen = wanted and sys.stderr is not None and sys.stderr.isatty()

    def show(self, done: int) -> None:
        now = time.monotonic()
        elapsed = now - self.start
        if not self.seen or elapsed < PATIENCE or now - self.drawn < REDRAWN:
            return
        self.drawn = now
        full = BAR * done // self.total
        left = elapsed / done * (self.total - done)
        print(f"\rsweep |{'#' * full}{'-' * (BAR - full)}| {done}/{self.total}, {left:.0f} s left ", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        if self.drawn:
            print("\r" + " " * (BAR + 50) + "\r", end="", file=sys.stderr, flush=True)
