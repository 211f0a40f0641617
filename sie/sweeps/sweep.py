"""Many scenes at once: a parameter sweep, on one core or on the workers of an executor.

    sweep(scene, over={"friction": f, "tilt": t}, want=["half_width", "elastic_limit"],
    executor=ProcessPoolExecutor())

`over` names fields of the scene, or parameters of its profile as "profile.half_flat"; or `scene` is
a function of the named parameters that returns a Scene. An executor takes chunks of neighbours,
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
from dataclasses import fields
from numbers import Integral
from operator import attrgetter
from typing import Any, cast

import numpy as np

from sie import arguments
from sie.many.solve_many import ACTING, Many, many
from sie.problem.scene import Scene
from sie.profiles.shapes import Parabola, RoundedFlat
from sie.progress_bar import Progress

from .result import Answer, dataset, labelled, labels
from .work import DEFAULT, QUANTITIES, Point, Wanted, Work, answers_of, chunk_of, reason

CHUNKS = 64  # to which the points are cut

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
        Points in a chunk, of neighbours that are solved together; a 64th of all if not given.
    progress : bool, optional
        Whether a bar is drawn, on a terminal or in a notebook, if tqdm is installed (the extra
        `cli`) and the work takes more than a second.
    units : mapping of str to str, optional
        Labels of "length", "force" and "stress" for the attributes of the result; mm, N/mm and MPa
        if they are not given. Nothing is converted.

    Returns
    -------
    xarray.Dataset or dict of ndarray
        A Dataset where xarray is installed, with `long_name` and `units` of what the package names;
        `.to_netcdf("x.nc")` writes it. Beside the values there is "reason", which says why a point
        has none.

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
    if executor is None and isinstance(scene, Scene):
        at_once = as_arrays(scene, axes, wanted)
        if at_once is not None:
            return dataset(axes, wanted, *at_once, named)
    points, work = list(_points(axes)), Work(scene, wanted, tol)
    size = _chunk_size(chunk, len(points))
    answers = [INTERRUPTED] * len(points)
    try:
        with Progress("sweep", len(points), progress) as bar:
            if executor is None:
                for k, answer in enumerate(answers_of(work, points)):
                    answers[k] = answer
                    bar.update()
            else:
                for part in _done(executor, work, points, size, answers):
                    bar.update(part)
    except KeyboardInterrupt:
        done = len(points) - answers.count(INTERRUPTED)
        result = labelled(axes, wanted, answers, named)
        raise Interrupted(result, done, len(points)) from None
    return labelled(axes, wanted, answers, named)


def _done(
    executor: Executor, work: Work, points: list[Point], size: int, answers: list[Answer]
) -> Iterator[int]:
    """Fill in the answers chunk by chunk, as they are done; the numbers of their points.

    What is done at an interruption is kept.
    """
    starts: dict[Future[list[Answer]], int] = {}

    def keep(future: Future[list[Answer]]) -> int:
        start = starts.pop(future)
        chunk = range(start, min(start + size, len(points)))
        try:
            answers[start : chunk.stop] = future.result()
        except Exception as problem:  # whatever an executor raises, or a process that died
            answers[start : chunk.stop] = [({}, reason(problem))] * len(chunk)
        return len(chunk)

    try:
        for k in range(0, len(points), size):
            starts[_submitted(executor, work, points[k : k + size])] = k
        for future in as_completed([*starts]):
            yield keep(future)
    finally:
        for future in [*starts]:
            if not future.cancel() and future.done():
                keep(future)


def _submitted(executor: Executor, work: Work, points: list[Point]) -> Future[list[Answer]]:
    """The future of a chunk; a failed one if the executor takes no more: it broke, or ended."""
    try:
        return executor.submit(chunk_of, work, points)
    except Exception as problem:  # whatever an executor raises
        failed: Future[list[Answer]] = Future()
        failed.set_exception(problem)
        return failed


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
    of_profile = {f.name for f in fields(cast(Any, scene.profile))}
    of_scene = {f.name for f in fields(Scene)}
    known = {"profile": of_profile, "": of_scene}.get(owner, set())
    if parameter not in known:
        named = ", ".join(sorted(known or of_scene))
        here = f'"profile.{name}", the parameter of its profile' if name in of_profile else named
        raise ValueError(f'over "{name}" is not known: choose {here}')


def _points(axes: dict[str, list[Any]]) -> Iterator[Point]:
    for index in np.ndindex(*map(len, axes.values())):
        yield {name: values[i] for (name, values), i in zip(axes.items(), index, strict=True)}


def _chunk_size(chunk: int | None, points: int) -> int:
    if chunk is None:
        return math.ceil(points / CHUNKS)
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


# -- a sweep as arrays, where `many` answers all points --------------------------------------------

SIZES = "normal_load", "half_width"
KINDS = Parabola, RoundedFlat  # whose fields are their parameters
FEWEST = 32  # points: fewer are as soon solved one by one
PLAIN = "half_width", "centre", "normal_load", "moment", "tilt"
OF_ONE_PATCH: dict[str, Callable[[Many], Any]] = {
    "contact_length": lambda solved: 2.0 * solved.half_width,
    "gap_volume": lambda solved: np.zeros(solved.shape),
    "patches": lambda solved: np.ones(solved.shape),
    "peak_pressure": attrgetter("peak_pressure"),
}
KNOWN = (*PLAIN, "edges", *OF_ONE_PATCH)


def as_arrays(
    scene: Scene, axes: dict[str, list[Any]], wanted: dict[str, Any]
) -> tuple[dict[str, Any], Any] | None:
    """The wanted arrays and the reasons; None if some point has to be solved by itself."""
    numbers = all(type(v) in (int, float) for values in axes.values() for v in values)
    known = all(isinstance(of, str) and of in KNOWN for of in wanted.values())
    points = np.prod([len(values) for values in axes.values()])
    if not (numbers and known and points >= FEWEST and _takes(scene, axes)):
        return None
    solved = _solved(scene, axes)
    if (solved.refused != "").any():
        return None
    found: dict[str, Any] = {}
    for name, of in wanted.items():
        if of == "edges":
            found |= {"x1": solved.edges[..., 0], "x2": solved.edges[..., 1]}
        else:
            found[name] = OF_ONE_PATCH[of](solved) if of in OF_ONE_PATCH else getattr(solved, of)
    return {name: v for name, v in found.items() if name not in axes}, solved.refused


def _takes(scene: Scene, axes: dict[str, list[Any]]) -> bool:
    """Whether all scenes are of similar bodies, and all numbers those of arrays."""
    own = {f"profile.{name}" for name in _fields(scene)} & axes.keys()
    sheared = scene.friction or scene.bulk_stress or {"friction", "bulk_stress"} & axes.keys()
    return (
        not (scene.sliding or scene.moment is not None)
        and not (sheared and (scene.beta or scene.body != scene.indenter))
        and not {*SIZES} <= axes.keys()
        and axes.keys() <= {*SIZES, *ACTING, *own, *({"modulus"} if scene.body is None else ())}
        and all(1.0 / arguments.LARGEST <= v <= arguments.LARGEST for n in own for v in axes[n])
    )


def _solved(scene: Scene, axes: dict[str, list[Any]]) -> Many:
    """The scenes of the grid as arrays; what these do not answer is refused."""
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij"), strict=True))
    sizes = [name for name in SIZES if name in axes] or [
        name for name in SIZES if getattr(scene, name) is not None
    ]
    loads = {name: getattr(scene, name) for name in (*sizes, *ACTING)} | {"modulus": scene.Estar}
    loads |= {name: v for name, v in grid.items() if "." not in name}
    of_profile = {name: getattr(scene.profile, name) for name in _fields(scene)}
    of_profile |= {name.partition(".")[2]: v for name, v in grid.items() if "." in name}
    profile = type(scene.profile)(**of_profile) if of_profile else scene.profile
    return many(profile, loads, {}, alone=False)


def _fields(scene: Scene) -> tuple[str, ...]:
    """The parameters of the profile that may be arrays."""
    return kind.__match_args__ if (kind := type(scene.profile)) in KINDS else ()
