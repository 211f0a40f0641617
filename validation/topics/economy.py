"""The savings of economy: each scene solved with every skip, and with none.

The page lists what is skipped, the reason, the time saved, and the difference of the answers.

"run" and "skip" are those of `sie.plan` before anything is computed; the stages that were filled
afterwards are those it names. What is saved is counted in steps; times are medians in turns;
`sie.solve(scene, economy=())` switches all skips off, and then one of them at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import sie
from sie.problem.request import ECONOMY
from validation.harness.counting import work
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Doing, Record, Table, checked
from validation.harness.timing import medians

TITLE = "Economy: what a scene does not need is not computed"
SECONDS = (2.0, 5.0)
TIMED = True
SAME = 1e-13
# least ratios of steps: all skips together, and one alone. The look at convexity, which is skipped,
# is a fourth of the steps of a tilted rounded flat no more.
SAVED, NO_LOSS = 1.1, 1.0
COLUMNS = (
    "time [ms]",
    "without skips [ms]",
    "saving of time, times",
    "saving of steps, times",
    "largest difference / peak",
)
TRACTIONS = ("pressure", "shear")
RIM = sie.RoundedFlat(0.5, 1.0)
SLOPE = sie.FromFunction(np.sinh, domain=(-30.0, 30.0), parity="even")
SLIPPING: dict[str, Any] = {"profile": RIM, "modulus": 1.0, "normal_load": 0.3, "friction": 0.5}
SCENES = {
    "parabola": sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=0.3),
    "rounded flat": sie.Scene(profile=RIM, modulus=1.0, normal_load=0.3),
    "rounded flat, tilted": sie.Scene(profile=RIM, modulus=1.0, normal_load=0.3, tilt=0.05),
    "smooth function": sie.Scene(profile=SLOPE, modulus=1.0, normal_load=1.0),
    "dissimilar, f = 0": sie.Scene(profile=RIM, modulus=1.0, dundurs=0.2, normal_load=0.3),
    "similar, sliding": sie.Scene(
        profile=RIM, modulus=1.0, friction=0.5, sliding=1, normal_load=0.3
    ),
    "stick zone inside the flat": sie.Scene(**SLIPPING, tangential_load=0.15 * (1 - 1e-12)),
    "without a shear load": sie.Scene(**SLIPPING),
    "partial slip": sie.Scene(**SLIPPING, tangential_load=0.09),
    "bulk stress": sie.Scene(**SLIPPING, tangential_load=0.09, bulk_stress=0.002),
    "dissimilar, sliding": sie.Scene(
        profile=RIM, modulus=1.0, dundurs=0.2, friction=0.5, sliding=1, normal_load=0.3
    ),
}


class Compared(NamedTuple):
    """A scene with all skips, and with fewer: milliseconds, steps and answers of both."""

    times: tuple[float, float]
    steps: tuple[float, float]
    answers: tuple[Any, Any]

    @property
    def row(self) -> tuple[float, ...]:
        """Both times, both savings, and the difference of the answers over the peak."""
        saved = (pair[1] / pair[0] for pair in (self.times, self.steps))
        return (*self.times, *saved, difference(self.answers))

    @property
    def spoiled(self) -> tuple[Any, Any]:
        return self.answers[0], self.answers[0] * (1.0 + 1e-11)


def compared(scene: sie.Scene, economy: Collection[str], patience: float) -> Compared:
    """Pressure and shear with all skips, and with these alone."""
    x = np.linspace(*sie.solve(scene).edges, 1003)[1:-1]
    runs = [partial(answers, scene, x, skips) for skips in (ECONOMY, economy)]
    saving, without = medians(runs, patience)
    steps = work(runs[0]).steps, work(runs[1]).steps
    return Compared((1e3 * saving, 1e3 * without), steps, (runs[0](), runs[1]()))


def answers(scene: sie.Scene, x: Any, economy: Collection[str]) -> Any:
    """Pressure and shear."""
    solution = sie.solve(scene, economy=economy)
    return np.concatenate((solution.pressure(x), solution.shear(x)))


def difference(pair: tuple[Any, Any]) -> float:
    """Largest, over the peak."""
    one, other = pair
    return float(np.abs(one - other).max() / np.abs(one).max())


# A skip by its name, and a scene that does not need the skipped work.
SKIPS = {
    "symmetry": "rounded flat",
    "transform": "smooth function",
    "convexity": "rounded flat",
    "zero panels": "rounded flat",
    "shear": "without a shear load",
    "sliding": "similar, sliding",
}


def one_by_one(quick: bool) -> Iterator[Record]:
    """Each skip alone switched off, in a scene that profits from it."""
    found = {}
    for skip in sorted(ECONOMY):
        yield Doing(f"without {skip}")
        scene = SCENES[SKIPS.get(skip, "partial slip")]
        found[skip] = compared(scene, ECONOMY - {skip}, 0.05 if quick else 0.2)
    yield Table(
        "Each skip alone",
        ("skip", "scene", *COLUMNS),
        [(skip, SKIPS.get(skip, "partial slip"), *c.row) for skip, c in found.items()],
    )
    yield Claim(
        "each skip alone: largest difference of pressure and shear / peak",
        "this project: the answer is the same",
        largest(difference(c.answers) for c in found.values()),
        smallest(difference(c.spoiled) for c in found.values()),
        "answers off by 1e-11",
        high=SAME,
    )
    steps = [c.steps for c in found.values()]
    yield saved("each skip alone: smallest saving of steps, times", steps, NO_LOSS)


def saved(what: str, steps: Sequence[tuple[float, float]], low: float) -> Claim:
    """The least quotient of the steps without and with; exchanged, for the control."""
    return checked(
        lambda pairs: smallest(without / saving for saving, without in pairs), steps,
        [pair[::-1] for pair in steps],
        what=what, by="this page", named="with and without exchanged", low=low,
    )  # fmt: skip


READ: dict[str, Callable[[sie.Solution], Any]] = {
    "pressure": lambda solution: solution.pressure(0.3),
    "shear": lambda solution: solution.shear(0.3),
    "stress": lambda solution: solution.stress(0.3, 0.2).xx,
}


def footprint(name: str, scene: sie.Scene, want: Sequence[str], other: Sequence[str]) -> Claim:
    """The stages that are filled when `want` is read are those of its plan, and of no other."""
    solution = sie.solve(scene)
    for quantity in want:
        READ[quantity](solution)
    filled = vars(solution).keys() & {s.stage for s in sie.plan(scene, "check").steps}
    return checked(
        lambda stages: len(filled ^ stages),
        sie.plan(scene, want).stages,
        sie.plan(scene, other).stages,
        what=f"{name}: stages filled that were not planned, or planned and not filled",
        by="this project: the footprint is the plan",
        named=f"the plan of {' and '.join(other)}",
        high=0,
    )


def of_scene(name: str, compared: Compared) -> Iterator[Claim]:
    yield checked(
        difference, compared.answers, compared.spoiled,
        what=f"{name}: pressure and shear with and without the skips differ by",
        by="this project: the answer is the same", named="pressures off by 1e-11", high=SAME,
    )  # fmt: skip
    yield footprint(name, SCENES[name], TRACTIONS, (*TRACTIONS, "check"))


def compute(quick: bool) -> Iterator[Record]:
    found: dict[str, Compared] = {}
    for name, scene in SCENES.items():
        yield Doing(name)
        found[name] = compared(scene, (), 0.05 if quick else 0.3)
        yield from of_scene(name, found[name])
    plans = {name: sie.plan(scene, TRACTIONS) for name, scene in SCENES.items()}
    yield Table(
        "Scenes and stages",
        ["scene", *(s.name for s in next(iter(plans.values())).steps)],
        [
            (name, *(f"{'run' if s.run else 'skip'}: {s.reason}" for s in plan.steps))
            for name, plan in plans.items()
        ],
    )
    rows = [(name, *c.row) for name, c in found.items()]
    yield Table("The savings of the skips", ("scene", *COLUMNS), rows)
    yield from one_by_one(quick)
    yield footprint("stress asked for", SCENES["partial slip"], ("stress",), TRACTIONS)
    times = [c.times for c in found.values()]
    steps = [c.steps for c in found.values()]
    yield saved("the skips together: smallest saving of steps over the scenes, times", steps, SAVED)
    places, names = list(range(len(found))), {"names": list(found)}
    yield Curve("economy", "with the skips", [t for t, _ in times], places, "points", names)
    yield Curve("economy", "without", [t for _, t in times], places, "points")
