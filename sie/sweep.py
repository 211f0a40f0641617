"""Many scenes at once: a parameter sweep, on one core or on the workers of an executor.

    sweep(scene, over={"friction": f, "tilt": t}, want=["half_width", "elastic_limit"],
    executor=ProcessPoolExecutor())

`over` names fields of the scene, or parameters of its profile as "profile.half_flat"; or `scene` is
a function of the named parameters that returns a Scene. Points are taken in chunks of neighbours,
last name fastest, so that what does not change between two of them (a normal problem under many
tangential loads) is solved once. Any `concurrent.futures.Executor` will do: a process pool, Dask's
`client.get_executor()`, `mpi4py.futures.MPIPoolExecutor()`. A scene without an answer leaves nan
and the sentence that says why.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import closing
from dataclasses import dataclass, field, fields, replace
from functools import partial
from numbers import Integral
from operator import attrgetter
from typing import Any, NamedTuple, cast

import numpy as np

from . import arguments
from .errors import ContactError
from .problem.scene import Scene
from .progress_bar import Bar, bar
from .solution import Solution, solve
from .sweep_result import Answer, labelled
from .unit_labels import labels
from .workers import outcomes

Point = dict[str, Any]
Wanted = Callable[[Solution], Any]

DEFAULT = ("half_width", "centre", "normal_load", "moment", "tilt")
# The number of chunks, at least, where the size of the pool is not known.
CHUNKS, LONGEST_CHUNK = 64, 256


def _elastic_limit(solution: Solution) -> dict[str, float]:
    found = solution.elastic_limit()
    return {
        "elastic_limit": found.ratio,
        "elastic_limit_load": found.load,
        "elastic_limit_x": found.x,
        "elastic_limit_y": found.y,
    }


def _peak_tension(solution: Solution) -> dict[str, float]:
    found = solution.peak_tension()
    return {"peak_tension": found.value, "peak_tension_x": found.x}


def _edges(solution: Solution) -> dict[str, float]:
    return dict(zip(("x1", "x2"), solution.edges, strict=True))


QUANTITIES: dict[str, Wanted] = {
    **{name: attrgetter(name) for name in DEFAULT},
    **{name: attrgetter(name) for name in ("contact_length", "gap_volume")},
    "patches": lambda s: float(len(s.patches)),
    "edges": _edges,
    "shear_load": lambda s: s.shear.resultant,
    "elastic_limit": _elastic_limit,
    "peak_tension": _peak_tension,
    "error": lambda s: s.check().error,
}


class Interrupted(KeyboardInterrupt):
    """A sweep that was interrupted from the keyboard.

    Parameters
    ----------
    result : xarray.Dataset or dict
        The answers up to then; the other points are nan with the reason "interrupted".
    """

    def __init__(self, result: Any) -> None:
        super().__init__(
            "the sweep was interrupted: its answers up to then are in the exception's `result`"
        )
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
    units: Mapping[str, str] | None = None,
) -> Any:
    """The wanted quantities of every scene of a grid of parameters.

    Parameters
    ----------
    scene : Scene or callable
        A scene whose fields are changed, or a function of the named parameters that returns a
        Scene.
    over : mapping of str to sequence
        The values of each parameter by name: fields of the scene, or "profile." and a parameter of
        its profile. The results have one dimension for each, in this order.
    want : str, iterable of str or mapping, optional
        Names among `sie.QUANTITIES`, or functions of a Solution by name that return a number, an
        array or a dict of them.
    executor : concurrent.futures.Executor, optional
        Where chunks run; None runs them in this process. For a process pool, functions must be
        importable (no lambdas).
    tol : float, optional
        As in `solve`.
    chunk : int, optional
        Points in a chunk.
    progress : bool, optional
        Whether a bar is drawn, on a terminal or in a notebook, if tqdm is installed (the extra
        `cli`) and the work takes more than a second.
    units : mapping of str to str, optional
        Labels of "length", "force" and "stress" for the attributes of the result; mm, N/mm and MPa
        if they are not given. Nothing is converted.

    Returns
    -------
    xarray.Dataset or dict of ndarray
        A Dataset where xarray is installed, with `long_name` and `units` of what the package names.
        Beside the values there is "reason", which says why a point has none.

    Raises
    ------
    ValueError
        For names that are not known, before any work is done.
    Interrupted
        In place of KeyboardInterrupt, with all that was found.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
    >>> found = sie.sweep(scene, over={"normal_load": [0.25, 1.0]}, want="half_width")
    >>> [round(float(b), 6) for b in found["half_width"]]
    [0.56419, 1.128379]
    """
    axes, named = _axes(scene, over), labels(units)
    wanted = _wanted(want)
    points = list(_points(axes))
    size = _chunk_size(chunk, len(points), executor)
    chunks = [points[i : i + size] for i in range(0, len(points), size)]
    run = _Run(Work(scene, wanted, tol), chunks, bar("sweep", len(points), progress))
    try:
        if executor is None:
            run.here()
        else:
            run.through(executor)
    except KeyboardInterrupt:
        raise Interrupted(labelled(axes, wanted, run.answers(), named)) from None
    finally:
        run.bar.close()
    return labelled(axes, wanted, run.answers(), named)


# -- the grid --------------------------------------------------------------------------------------


def _axes(
    scene: Scene | Callable[..., Scene], over: Mapping[str, Sequence[Any]]
) -> dict[str, list[Any]]:
    if not isinstance(over, Mapping) or not over:
        raise ValueError('nothing to sweep over: give over = {"normal_load": [...], ...}')
    for name, values in over.items():
        unsized = isinstance(values, (str, bytes)) or not hasattr(values, "__len__")
        if unsized or getattr(values, "ndim", 1) == 0 or not len(values):
            raise ValueError(f"over {name} = {values!r} holds no values: give a sequence of them")
        if isinstance(scene, Scene):
            _check_name(scene, name)
    return {
        name: [v.item() if isinstance(v, np.generic) else v for v in values]
        for name, values in over.items()
    }


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
        here = (
            ", ".join(sorted(known))
            if known
            else 'a field of a scene, or "profile." and a parameter of its profile'
        )
        raise ValueError(f'over "{name}" is not known: choose {here}')


def _points(axes: dict[str, list[Any]]) -> Iterator[Point]:
    for index in np.ndindex(*map(len, axes.values())):
        yield {name: values[i] for (name, values), i in zip(axes.items(), index, strict=True)}


def _chunk_size(chunk: int | None, points: int, executor: Executor | None) -> int:
    if chunk is not None:
        if isinstance(chunk, bool) or not isinstance(chunk, Integral) or chunk < 1:
            raise ValueError(
                f"chunk = {chunk!r} is not a number of points: give a whole number > 0"
            )
        return int(chunk)
    return 1 if executor is None else min(max(math.ceil(points / CHUNKS), 1), LONGEST_CHUNK)


def _wanted(want: str | Iterable[str] | Mapping[str, Wanted]) -> dict[str, str | Wanted]:
    remedy = "names, or a dict of functions of a solution"
    names = (want,) if isinstance(want, str) else arguments.listed("want", want, remedy)
    pairs = list(want.items() if isinstance(want, Mapping) else zip(names, names, strict=True))
    if not pairs:
        raise ValueError(f"nothing is wanted: ask for {', '.join(QUANTITIES)}")
    for name, quantity in pairs:
        if not callable(quantity) and not arguments.among(quantity, QUANTITIES):
            raise ValueError(
                f'want "{quantity}" is not known: choose among {", ".join(QUANTITIES)}, '
                "or give a dict of functions of a solution"
            )
        if name == "reason":
            raise ValueError(
                'want "reason" is what a sweep calls why a point has no answer: '
                "give the quantity another name"
            )
    return dict(pairs)


# -- the work --------------------------------------------------------------------------------------


class Work(NamedTuple):
    """The question at every point."""

    scene: Scene | Callable[..., Scene]
    wanted: dict[str, str | Wanted]
    tol: float


@dataclass
class _Run:
    """The chunks of a sweep and their answers, also after an interruption."""

    work: Work
    chunks: list[list[Point]]
    bar: Bar
    found: dict[int, list[Answer]] = field(default_factory=dict)

    def here(self) -> None:
        last: Solution | None = None
        for k, chunk in enumerate(self.chunks):
            self.found[k] = []
            last = _answer_into(self.found[k], self.work, chunk, last)
            self.bar.update(len(chunk))

    def through(self, executor: Executor) -> None:
        left: dict[int, Future[list[Answer]]] = {}
        try:
            task, chunks = partial(answers_of, self.work), dict(enumerate(self.chunks))
            with closing(outcomes(task, chunks, executor, left)) as done:
                for k, future in done:
                    self._keep(k, future)
                    self.bar.update(len(self.chunks[k]))
        finally:
            for k, future in left.items():
                self._keep(k, future)

    def _keep(self, k: int, future: Future[list[Answer]]) -> None:
        """The answers of a chunk, or why there are none.

        A process may have died, or a function could not be sent to another process.
        """
        try:
            self.found[k] = future.result()
        except Exception as problem:  # whatever an executor raises
            self.found[k] = [({}, _reason(problem))] * len(self.chunks[k])

    def answers(self) -> list[Answer]:
        """One answer for each point."""
        answers: list[Answer] = []
        for k, chunk in enumerate(self.chunks):
            have = self.found.get(k, [])
            answers += [*have, *[({}, "interrupted")] * (len(chunk) - len(have))]
        return answers


def answers_of(work: Work, chunk: list[Point]) -> list[Answer]:
    """The answers of one chunk: what a worker runs."""
    answers: list[Answer] = []
    _answer_into(answers, work, chunk, None)
    return answers


def _answer_into(
    answers: list[Answer], work: Work, chunk: list[Point], last: Solution | None
) -> Solution | None:
    """Appends the answer of each point; returns the last solution."""
    for point in chunk:
        try:
            last = _solution(work.scene, point, work.tol, last)
            answers.append((_values(last, work.wanted), ""))
        # a user's function may raise any error: one point must not lose the others
        except Exception as problem:
            answers.append(({}, _reason(problem)))
    return last


def _reason(problem: Exception) -> str:
    """The message of an error, after its class if it is none of this package."""
    if isinstance(problem, BrokenExecutor):
        return (
            "the process that computed this chunk died: its memory was exhausted, or a function "
            "that is wanted crashed; ask for these points alone, or with a smaller chunk"
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
    of_profile = {
        name.removeprefix("profile."): value for name, value in point.items() if "." in name
    }
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
