"""Many scenes at once: a parameter sweep, on one core or on the workers of an executor.

    sweep(scene, over={"friction": f, "tilt": t}, want=["half_width", "elastic_limit"],
    executor=ProcessPoolExecutor())

`over` names fields of the scene, or parameters of its profile as "profile.half_flat"; or `scene` is
a function of the named parameters that returns a Scene. Points are taken in chunks of neighbours,
last name fastest, so that what does not change between two of them (a normal problem under many
tangential loads) is solved once; in this process all points are solved as arrays where `many` does
so with the same answers. Any `concurrent.futures.Executor` will do: a process pool, Dask's
`client.get_executor(pure=False)`, `mpi4py.futures.MPIPoolExecutor()`. A scene without an answer
leaves nan and the sentence that says why.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from dataclasses import dataclass, fields
from numbers import Integral
from pathlib import Path
from time import perf_counter
from typing import Any, cast

import numpy as np

from sie import arguments
from sie.problem.scene import Scene
from sie.progress_bar import Progress
from sie.solution import Solution

from .as_arrays import as_arrays
from .file import SweepFile
from .result import Answer, dataset, labelled, labels
from .work import DEFAULT, QUANTITIES, Point, Wanted, Work, answer_at, answers_of, reason

AIM = 0.2  # seconds that a chunk takes a worker: to send it costs some milliseconds

NOT_YET: Answer = ({}, "not computed yet")
INTERRUPTED: Answer = ({}, "interrupted")


class Interrupted(KeyboardInterrupt):
    """A sweep that was interrupted from the keyboard.

    Parameters
    ----------
    result : xarray.Dataset or dict
        The answers up to then; the other points are nan with the reason "interrupted".
    done, points : int
        The number of points that were finished, and that of all.
    """

    def __init__(self, result: Any, done: int, points: int) -> None:
        super().__init__(
            f"{done} of {points} points were finished when the sweep was interrupted: they are in "
            "the exception's `result`; sweep over the others to go on"
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
    to: str | Path | None = None,
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
        Points in a chunk; if it is not given, the first points are solved here, and a chunk has as
        many as took some tenths of a second.
    to : str or Path, optional
        A new NetCDF file, "x.nc", that holds the result and grows while the work goes on, by
        xarray. It is readable at any moment, also after this process was killed; points that are
        not done are nan with the reason "not computed yet".
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
        For names that are not known, or a file that cannot be written, before any work is done.
    Interrupted
        In place of KeyboardInterrupt, with all that was found.
    OSError
        If the file could not be written at the end; its attribute `result` has the result.

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
    at_once = None
    if executor is None and to is None and isinstance(scene, Scene):
        at_once = as_arrays(scene, axes, wanted)
    if at_once is not None:
        return dataset(axes, wanted, *at_once, named)
    points = list(_points(axes))
    size, file = _chunk_size(chunk), SweepFile(to)
    run = _Run(
        Work(scene, wanted, tol),
        points,
        Progress("sweep", len(points), progress),
        lambda answers: file.grow(lambda: labelled(axes, wanted, answers, named)),
        [NOT_YET] * len(points),
    )
    try:
        with run.progress:
            if executor is None:
                run.here()
            else:
                run.through(executor, size)
    except KeyboardInterrupt:
        stopped = [INTERRUPTED if answer is NOT_YET else answer for answer in run.answers]
        done = len(points) - stopped.count(INTERRUPTED)
        result = file.finish(labelled(axes, wanted, stopped, named))
        raise Interrupted(result, done, len(points)) from None
    return file.finish(labelled(axes, wanted, run.answers, named))


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
        if name in {f.name for f in fields(cast(Any, scene.profile))}:
            here = f'"profile.{name}", the parameter of its profile'
        raise ValueError(f'over "{name}" is not known: choose {here}')


def _points(axes: dict[str, list[Any]]) -> Iterator[Point]:
    for index in np.ndindex(*map(len, axes.values())):
        yield {name: values[i] for (name, values), i in zip(axes.items(), index, strict=True)}


def _chunk_size(chunk: int | None) -> int | None:
    if chunk is None:
        return None
    if isinstance(chunk, bool) or not isinstance(chunk, Integral) or chunk < 1:
        raise ValueError(f"chunk = {chunk!r} is not a number of points: give a whole number > 0")
    return int(chunk)


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


@dataclass
class _Run:
    """The points of a sweep and their answers, also after an interruption."""

    work: Work
    points: list[Point]
    progress: Progress
    grow: Callable[[list[Answer]], None]
    answers: list[Answer]

    def here(self, seconds: float = math.inf) -> int:
        """Answer points in this process, for so long after the first; their number."""
        last: Solution | None = None
        end = math.inf
        for k, point in enumerate(self.points):
            self.answers[k], last = answer_at(self.work, point, last)
            self._count(1)
            end = end if k else perf_counter() + seconds  # the first point imports what it needs
            if perf_counter() > end:
                return k + 1
        return len(self.points)

    def through(self, executor: Executor, size: int | None) -> None:
        """Answer points in chunks of this size; if it is not given, of some tenths of a second."""
        start = self.here(AIM) if size is None else 0
        size = size or max(start - 1, 1)
        pending: dict[Future[list[Answer]], int] = {}
        try:
            for k in range(start, len(self.points), size):
                pending[self._submitted(executor, self.points[k : k + size])] = k
            for future in as_completed([*pending]):
                self._keep(pending.pop(future), size, future)
        finally:  # of an interruption too
            for future, k in pending.items():
                if not future.cancel() and future.done():
                    self._keep(k, size, future)

    def _submitted(self, executor: Executor, points: list[Point]) -> Future[list[Answer]]:
        """The future of a chunk; a failed one if the executor takes no more: it broke, or ended."""
        try:
            return executor.submit(answers_of, self.work, points)
        except Exception as problem:  # whatever an executor raises
            failed: Future[list[Answer]] = Future()
            failed.set_exception(problem)
            return failed

    def _keep(self, start: int, size: int, future: Future[list[Answer]]) -> None:
        """Take the answers of a chunk, or the reason why there are none.

        A process may have died, or a function could not be sent to another process.
        """
        points = range(start, min(start + size, len(self.points)))
        try:
            answers = future.result()
        except Exception as problem:  # whatever an executor raises
            answers = [({}, reason(problem))] * len(points)
        self.answers[points.start : points.stop] = answers
        self._count(len(points))

    def _count(self, points: int) -> None:
        self.progress.update(points)
        self.grow(self.answers)
