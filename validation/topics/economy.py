"""The savings of economy: each scene solved with every skip, and with none.

The page lists what is skipped, the reason, the time saved, and the difference of the answers.

"run" and "skip" are those of `sie.plan` before anything is computed; the stages that were filled
afterwards are those it names. Times are medians in turns; `sie.solve(scene, economy=())` switches
all skips off, and then one of them at a time.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from functools import partial
from typing import Any

import numpy as np

import sie
from sie.problem.request import ECONOMY
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Doing, Record, Table, checked
from validation.harness.timing import medians

TITLE = "Economy: what a scene does not need is not computed"
SECONDS = (2.0, 5.0)
TIMED = True
SAME = 1e-13
# Least ratios of times; one skip alone may save little, which a busy machine hides, but must not
# cost
SAVED, NO_LOSS = 1.3, 0.7
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


def answers(solution: sie.Solution, x: Any) -> Any:
    """Pressure and shear."""
    return np.concatenate((solution.pressure(x), solution.shear(x)))


def _solved(scene: sie.Scene, x: Any, economy: Collection[str]) -> Any:
    return answers(sie.solve(scene, economy=economy), x)


def difference(pair: tuple[Any, Any]) -> float:
    """Largest, over the peak."""
    one, other = pair
    return float(np.abs(one - other).max() / np.abs(one).max())


def cost(scene: sie.Scene, x: Any, patience: float) -> list[float]:
    """Median seconds with the skips and without."""
    return medians(
        (lambda: answers(sie.solve(scene), x), lambda: answers(sie.solve(scene, economy=()), x)),
        patience,
    )


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
    rows, spoiled = [], np.inf
    for skip in sorted(ECONOMY):
        name = SKIPS.get(skip, "partial slip")
        yield Doing(f"without {skip}")
        scene, rest = SCENES[name], ECONOMY - {skip}
        x = np.linspace(*sie.solve(scene).edges, 1003)[1:-1]
        seconds = medians(
            (partial(_solved, scene, x, ECONOMY), partial(_solved, scene, x, rest)),
            0.05 if quick else 0.2,
        )
        apart = difference(
            (answers(sie.solve(scene), x), answers(sie.solve(scene, economy=rest), x))
        )
        spoiled = min(
            spoiled, difference((one := answers(sie.solve(scene), x), one * (1.0 + 1e-11)))
        )
        rows.append(
            (skip, name, 1e3 * seconds[0], 1e3 * seconds[1], seconds[1] / seconds[0], apart)
        )
    yield Table(
        "Each skip alone",
        (
            "skip",
            "scene",
            "time [ms]",
            "without it [ms]",
            "saving, times",
            "largest difference / peak",
        ),
        rows,
    )
    yield Claim(
        "each skip alone: largest difference of pressure and shear / peak",
        "this project: the answer is the same",
        largest(r[-1] for r in rows),
        spoiled,
        "answers off by 1e-11",
        high=SAME,
    )
    yield saved(
        "each skip alone: smallest saving, times", ((row[2], row[3]) for row in rows), NO_LOSS
    )


def saved(what: str, times: Iterable[tuple[float, float]], low: float) -> Claim:
    """The least quotient of the times without and with; exchanged, for the control."""
    pairs = list(times)
    return checked(
        lambda pairs: smallest(without / with_ for with_, without in pairs), pairs,
        [pair[::-1] for pair in pairs],
        what=what, by="this page", named="with and without exchanged", low=low,
    )  # fmt: skip


def stress_of(scene: sie.Scene) -> Iterator[Claim]:
    """The plan of the stress: one more stage than that of the pressure and the shear."""
    solution = sie.solve(scene)
    _ = solution.stress(0.3, 0.2).xx
    planned = sie.plan(scene, "stress").stages
    filled = {
        key for key in vars(solution) if key in {s.stage for s in sie.plan(scene, "check").steps}
    }
    without = sie.plan(scene, ("pressure", "shear")).stages
    yield Claim(
        "stress asked for: stages filled that were not planned, or planned and not filled",
        "this project: the footprint is the plan",
        len(filled ^ planned),
        len(filled ^ without),
        "the plan of pressure and shear",
        high=0,
    )


def compute(quick: bool) -> Iterator[Record]:
    header, rows, stages = ["scene"], [], []
    names, with_skips, without = list(SCENES), [], []
    for name, scene in SCENES.items():
        yield Doing(name)
        plan = sie.plan(scene, ("pressure", "shear"))
        saving, bare = sie.solve(scene), sie.solve(scene, economy=())
        x = np.linspace(*saving.edges, 1003)[1:-1]
        one, other = answers(saving, x), answers(bare, x)
        filled = {
            key for key in vars(saving) if key in {s.stage for s in sie.plan(scene, "check").steps}
        }
        yield checked(
            difference,
            (one, other),
            (one, other * (1 + 1e-11)),
            what=f"{name}: pressure and shear with and without the skips differ by",
            by="this project: the answer is the same",
            named="pressures off by 1e-11",
            high=SAME,
        )
        yield Claim(
            f"{name}: stages filled that were not planned, or planned and not filled",
            "this project: the footprint is the plan",
            len(filled ^ plan.stages),
            len((filled | {"certificate"}) ^ plan.stages),
            "a certificate that was not asked for",
            high=0,
        )
        seconds = cost(scene, x, 0.05 if quick else 0.3)
        with_skips.append(1e3 * seconds[0])
        without.append(1e3 * seconds[1])
        rows.append((name, *(f"{'run' if s.run else 'skip'}: {s.reason}" for s in plan.steps)))
        header = ["scene", *(s.name for s in plan.steps)]
        stages.append(
            (
                name,
                1e3 * seconds[0],
                1e3 * seconds[1],
                seconds[1] / seconds[0],
                difference((one, other)),
            )
        )
    yield Table("Scenes and stages", header, rows)
    yield Table(
        "What the skips save",
        ("scene", "time [ms]", "without skips [ms]", "saving, times", "largest difference / peak"),
        stages,
    )
    yield from one_by_one(quick)
    yield from stress_of(SCENES["partial slip"])
    yield saved(
        "the skips together: smallest saving over the scenes, times",
        zip(with_skips, without, strict=True),
        SAVED,
    )
    yield Curve(
        "economy", "with the skips", with_skips, list(range(len(names))), "points", {"names": names}
    )
    yield Curve("economy", "without", without, list(range(len(names))), "points")
