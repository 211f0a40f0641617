"""Error against run time: this package and other methods, on the same contacts, in the same run.

Each method computes the pressure at 1001 points, and its error is taken at about
24 of them, off every grid, against a truth of more than 16 digits; elements are measured at their
own centres. Times are medians over repeats in which the method and NumPy's closed form of the
rounded punch take turns. Gauss-Chebyshev, Erdogan-Gupta and collocation are given the edges of the
contact; this package and the boundary elements compute them. Tamaas and ContactMechanics run where
they are installed (pip install -e ".[peers]"); they are periodic, and so is their contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

import sie
from validation.harness.measures import smallest
from validation.harness.records import Claim, Doing, Record, Table, checked
from validation.harness.timing import compared
from validation.rivals import solvers
from validation.rivals.further_races import further
from validation.rivals.problems import Problem, problems
from validation.rivals.race import PATIENCE, PROMISE, closed_form, curve

TITLE = "Error against run time"
SECONDS = (1.5, 28.0)
TIMED = True
SLOWEST = 0.5  # seconds: a method that took longer is not tried at the next size
GRID_REACH = 1.6  # elements cover so many half-widths to each side


@dataclass(frozen=True)
class Method:
    """`answer(problem, n)` is the run to be timed; `error(problem, answer, n)` judges what it
    returned.
    """

    name: str
    sizes: tuple[int, ...]
    answer: Callable[[Problem, int], Callable[[], Any]]
    applies: Callable[[Problem], bool]


def _powers(lo: int, hi: int) -> tuple[int, ...]:
    return tuple(2**k for k in range(lo, hi + 1))


def _package(problem: Problem, n: int) -> Callable[[], Any]:
    tol = 10.0**-n
    return lambda: sie.solve(problem.scene, tol=tol).pressure(problem.x)


def _chebyshev(problem: Problem, n: int) -> Callable[[], Any]:
    return lambda: solvers.gauss_chebyshev(problem.slope, *problem.edges, n, problem.x)


def _dense(problem: Problem, n: int) -> Callable[[], Any]:
    return lambda: solvers.erdogan_gupta(problem.slope, *problem.edges, n, problem.x)


def _collocation(problem: Problem, n: int) -> Callable[[], Any]:
    """A constant is set free, for the sampled right-hand side need not be consistent with the
    ends.
    """
    tangent = math.tan(math.pi * problem.epsilon)

    def run() -> Any:
        equation = sie.CauchyEquation(
            problem.edges, g=lambda x: 0.5 * problem.slope(x), a=tangent, b=-1.0, ends="bounded",
            free=(1.0,)
        )  # fmt: skip
        return equation.solve(n=n)(problem.x)

    return run


def _elements(solver: Callable[..., Any]) -> Callable[[Problem, int], Callable[[], Any]]:
    def answer(problem: Problem, n: int) -> Callable[[], Any]:
        x, gap, load = _grid(problem, n)
        spacing = float(x[1] - x[0])
        return lambda: solver(gap, spacing, load)

    return answer


def _own_elements(problem: Problem, n: int) -> Callable[[], Any]:
    x, gap, load = _grid(problem, n)
    return lambda: solvers.boundary_elements(
        gap, float(x[1] - x[0]), load, periodic=bool(problem.period)
    )


def _grid(problem: Problem, n: int) -> tuple[Any, Any, float]:
    """Centres of the elements, the gap there, and the load."""
    width = problem.period or 2.0 * GRID_REACH * problem.edges[1]
    x = ((np.arange(n) + 0.5) / n - 0.5) * width
    assert problem.gap is not None
    load = problem.solution.normal_load
    if problem.period:
        u = np.tan(np.pi * x)
        load = float(_closed_on(problem, u).mean()) if n >= 4096 else _closed_load(problem)
    return x, problem.gap(x), load


def _closed_on(problem: Problem, x: Any) -> Any:
    assert problem.closed is not None
    inside = (x > problem.edges[0]) & (x < problem.edges[1])
    return np.where(inside, problem.closed(np.where(inside, x, 0.0)), 0.0)


def _closed_load(problem: Problem) -> float:
    """∫p dx over a period, by Gauss-Chebyshev quadrature in x/a: p is sqrt(a² - x²) times an
    analytic function.
    """
    a = math.atan(problem.edges[1]) / math.pi
    theta = (np.arange(1, 200)) * np.pi / 200
    return float(
        (_closed_on(problem, np.tan(np.pi * a * np.cos(theta))) * np.sin(theta)).sum()
        * np.pi
        / 200
        * a
    )


def _has_series(problem: Problem) -> bool:
    return problem.series


def _has_elements(problem: Problem) -> bool:
    return problem.gap is not None and problem.closed is not None


OURS_AND_TEXTBOOKS = (
    Method("this package", (3, 6, 9, 13), _package, lambda problem: True),
    Method("Gauss-Chebyshev, one series", (8, 32, 128, 512, 2048, 8192), _chebyshev, _has_series),
    Method("collocation (sie.CauchyEquation)", _powers(3, 9), _collocation, lambda problem: True),
    Method("Erdogan-Gupta, dense", _powers(3, 8), _dense, _has_series),
    Method("FFT boundary elements", (32, 128, 512, 2048), _own_elements, _has_elements),
)


def methods() -> tuple[Method, ...]:
    """The methods of this package and of textbooks, and the installed codes of others."""
    others = (
        Method(name, (32, 128, 512, 2048), _elements(solver), lambda problem: bool(problem.period))
        for name, (module, solver) in solvers.INSTALLABLE.items()
        if solvers.installed(module)
    )
    return (*OURS_AND_TEXTBOOKS, *others)


def error(problem: Problem, method: Method, n: int, answer: Any) -> float:
    if len(answer) == len(problem.x):
        return problem.error(answer)
    x, _, _ = _grid(problem, n)
    exact = _closed_on(problem, np.tan(np.pi * x) if problem.period else x)
    return float(np.abs(answer - exact).max() / exact.max())


def race(
    problem: Problem, method: Method, quick: bool
) -> Iterator[tuple[int, float, float, float]]:
    """(size, error, seconds, ratio to the closed form) at growing sizes."""
    polynomial = method.name == "this package" and not problem.scene.profile.pieces.functions
    sizes = method.sizes[-1:] if polynomial else method.sizes[:: 2 if quick else 1]
    for n in sizes:
        run = method.answer(problem, n)
        found = error(problem, method, n, run())
        seconds, ratio = compared(run, closed_form, PATIENCE / (3 if quick else 1))
        yield n, found, seconds, ratio
        if seconds > SLOWEST:
            return


def compute(quick: bool) -> Iterator[Record]:
    rows = []
    for problem in problems(quick):
        best: dict[str, tuple[float, float]] = {}
        for method in methods():
            if not method.applies(problem):
                continue
            yield Doing(f"{problem.name}, {method.name}")
            points = list(race(problem, method, quick))
            yield curve("race: " + problem.name, method.name, points, says=problem.says)
            n, least, seconds, ratio = min(points, key=lambda point: point[1])
            best[method.name] = least, seconds
            rows.append(
                (
                    problem.name,
                    method.name,
                    least,
                    n if method.name != "this package" else None,
                    1e3 * seconds,
                    ratio,
                )
            )
        yield from _claims(problem, best)
    yield from further(quick)
    yield Table(
        "The smallest error of each method",
        ("contact", "method", "error / peak", "unknowns", "time [ms]", "ratio to the closed form"),
        rows,
        "The ratio is to `analytic.rounded_flat` at as many points, in turns. The largest error of "
        "elements sits next to an edge. "
        "Not raced here: " + (", ".join(_absent()) or "none"),
    )  # fmt: skip


def _absent() -> list[str]:
    return [
        f"{name} (not installed)"
        for name, (module, _) in solvers.INSTALLABLE.items()
        if not solvers.installed(module)
    ]


def _claims(problem: Problem, best: dict[str, tuple[float, float]]) -> Iterator[Claim]:
    yield checked(
        problem.error, problem.solution.pressure(problem.x),
        solvers.gauss_chebyshev(problem.slope, *problem.edges, 6, problem.x),
        what=f"{problem.name}: error of this package's pressure / peak",
        by="README: to machine precision",
        named="one Chebyshev series of 6 terms", high=PROMISE,
    )  # fmt: skip
    rivals = {name: e for name, (e, _) in best.items() if name != "this package"}
    if problem.scene.profile.breaks:
        series = problem.error(solvers.gauss_chebyshev(problem.slope, *problem.edges, 6, problem.x))
        yield checked(
            lambda ours: smallest(rivals.values()) / ours, best["this package"][0], series,
            what=f"{problem.name}: the nearest rival's smallest error over this package's",
            by="this project: what no peer has",
            named="one Chebyshev series of 6 terms in its place", low=100.0,
        )  # fmt: skip
