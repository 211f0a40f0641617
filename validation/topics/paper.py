"""Ciavarella, Hills & Monno (1998), "The influence of rounded edges ...", computed anew.

Figs 2 to 8 come from the general solver, which uses only the slope of the rounded punch. Points on
top are those of the closed forms, which share no code with it. Numbers for the statements in the
paper's text follow. A statement that the numbers contradict is refuted, and listed among the
errata.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import sie
from analytic import interior, rounded_flat
from sie import charts
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Map, Record, checked, in_turn
from validation.rounded_punch import (
    NU,
    closed_tension,
    closed_weakest,
    form,
    limit,
    root_j2,
    weakest,
)
from validation.topics.paper_statements import ERRATA, statements

TITLE = "The paper: Figs 2 to 8 and its statements"
SECONDS = (5.0, 14.0)
TIMED = False

BAR = 1e-13
# Differences of limits, and of their places, where a gradient vanishes: known to half the digits
SAME, PLACE = 1e-10, 1e-6
FIGURE_4 = ((0.3, 0.0), (0.3, 0.3), (0.55, 0.0), (0.55, 0.3), (0.8, 0.0), (0.8, 0.3))


def compute(quick: bool) -> Iterator[Record]:
    yield from in_turn(
        ("Fig. 2", figure_2()),
        ("Fig. 3", figure_3()),
        ("Fig. 4", figure_4(quick)),
        ("Figs 5, 6, 7", figures_5_to_7(quick)),
        ("Fig. 8", figure_8(quick)),
        ("statements", statements()),
    )
    yield ERRATA


# -- pressures and stick zones --------------------------------------------------------------------


def figure_2() -> Iterator[Record]:
    x, marks = np.linspace(-1.0, 1.0, 401), np.linspace(-0.96, 0.96, 25)
    worst = spoiled = 0.0
    for ratio in np.arange(10) / 10:
        solution = charts.punch(float(ratio))
        P = rounded_flat.load(**form(ratio))
        exact = rounded_flat.pressure(marks, **form(ratio)) / P
        found = solution.pressure(marks) / solution.normal_load
        worst = largest((worst, float(np.abs(found - exact).max() / exact.max())))
        spoiled = largest((spoiled, float(np.abs(found * (1 + 1e-11) - exact).max() / exact.max())))
        yield Curve("figure 2", f"{ratio:g}", x, solution.pressure(x) / solution.normal_load)
        yield Curve("figure 2 points", f"{ratio:g}", marks, exact, "points")
    yield Claim("Fig. 2: general solver against closed form (32), largest difference / peak",
                "both packages", worst, spoiled,
                "pressures off by 1e-11", high=BAR)  # fmt: skip

    def centre(rim: float) -> float:
        """b p(0)/P - 1/π, a = 1."""
        solution = sie.solve(
            sie.Scene(profile=sie.RoundedFlat(1.0, 1.0), modulus=1.0, half_width=1.0 + rim)
        )
        return abs(float(solution.pressure(0.0)) * (1.0 + rim) / solution.normal_load - 1 / np.pi)

    yield Claim("§ 3.1: b p(0)/P tends to 1/π as a/b → 1; distance at 1 - a/b = 1e-9",
                "paper, § 3.1", centre(1e-9), centre(0.25),
                "a/b = 0.8", high=1e-8)  # fmt: skip


def stick_of(ratio: float, share: float) -> float:
    """c/b from Q/(fP) = share, by the partial-slip solver."""
    P = charts.punch(ratio).normal_load
    profile = sie.RoundedFlat(ratio, 1.0) if ratio else sie.Parabola(1.0)
    solution = sie.solve(
        sie.Scene(
            profile=profile,
            modulus=1.0,
            normal_load=P,
            friction=0.5,
            tangential_load=0.5 * P * share,
        )
    )
    return solution.stick[0][1] / solution.half_width


def equation_20(ratio: float, c: Any) -> Any:
    """Q/(fP), with θ0 = arcsin a/c and φ0 = arcsin a/b; 1 - c² for a = 0."""
    if ratio == 0.0:
        return 1 - np.square(c)

    def bracket(angle: Any) -> Any:
        return np.pi - 2 * angle - np.sin(2 * angle)

    return 1 - np.square(c) * bracket(np.arcsin(ratio / np.asarray(c))) / bracket(np.arcsin(ratio))


def figure_3() -> Iterator[Record]:
    # The points are closer to sliding, where the curves are steep.
    shares = 1.0 - (1.0 - np.linspace(0.005, 0.995, 33)) ** 2
    worst = spoiled = 0.0
    for ratio in (0.0, 0.2, 0.4, 0.6, 0.8, 0.9):
        c = np.array([stick_of(ratio, float(share)) for share in shares])
        yield Curve("figure 3", f"{ratio:g}", [1.0, *c, ratio], [0.0, *shares, 1.0])
        marks = ratio + (1 - ratio) * np.linspace(0.05, 0.95, 8)
        yield Curve("figure 3 points", f"{ratio:g}", marks, equation_20(ratio, marks), "points")
        worst = largest((worst, float(np.abs(equation_20(ratio, c) - shares).max())))
        spoiled = largest(
            (spoiled, float(np.abs(equation_20(ratio, c * (1 - 1e-11)) - shares).max()))
        )
    yield Claim("Fig. 3: (20) at the solver's stick zones against the Q/(fP) they were given, "
                "largest difference", "both packages", worst,
                spoiled, "zones off by 1e-11", high=2e-13)  # fmt: skip
    least = smallest(stick_of(ratio, 1 - 1e-12) / ratio for ratio in (0.2, 0.5, 0.8))
    yield Claim("§ 3.2: no stick zone inside the flat; smallest c/a as Q → fP", "paper, § 3.2",
                least, stick_of(0.0, 1 - 1e-12) / 0.2,
                "a parabola against a = 0.2", low=1.0)  # fmt: skip

    def steepness(load: Any) -> float:
        """d(Q/fP)/d(c/a) next to c = a, over its mean from there to b = 2a."""
        end, near = load(2.0), load(1.0 + 1e-6)
        return float((near - load(1.0)) / 1e-6 / (end - load(1.0)))

    smooth = steepness(
        lambda c: float(
            rounded_flat.load(
                half_flat=1.0, half_width=max(c, 1.0 + 1e-15), radius=1.0, modulus=1.0
            )
        )
    )
    yield Claim("§ 3.2: the passage to sliding is smooth in value and slope: slope there over the "
                "mean slope", "paper, § 3.2", smooth,
                steepness(lambda c: c), "a load linear in c, as a wedge's", high=0.02)  # fmt: skip


# -- stresses -------------------------------------------------------------------------------------


def figure_4(quick: bool) -> Iterator[Record]:
    x, y = np.linspace(-2.0, 2.0, 81 if quick else 121), np.linspace(0.0, 2.0, 41 if quick else 61)
    worst = spoiled = 0.0
    for ratio, f in FIGURE_4:
        found = charts.yield_parameter(ratio, f, x, y[:, None])
        exact = root_j2(ratio, f, x[::10], y[::10, None])
        worst = largest((worst, float(np.abs(found[::10, ::10] - exact).max() / exact.max())))
        spoiled = largest(
            (spoiled, float(np.abs(found[::10, ::10] * (1 + 1e-11) - exact).max() / exact.max()))
        )
        place = charts.punch(ratio, f).elastic_limit().places[-1]
        yield Map(
            "figure 4", x, y, found, {"title": f"a/b = {ratio:g}, f = {f:g}", "weakest": place}
        )
    yield Claim("Fig. 4: √J2 of the general solver against the closed form, largest difference / "
                "largest value", "both packages", worst,
                spoiled, "stresses off by 1e-11", high=BAR)  # fmt: skip


def figures_5_to_7(quick: bool) -> Iterator[Record]:
    ratios = charts.RATIOS[::6] if quick else charts.RATIOS
    frictions = charts.FRICTIONS[::5] if quick else charts.FRICTIONS
    chart = charts.elastic_limits(ratios, frictions)
    yield Curve("figure 5", "P/(bk)", chart.ratios, chart.limit[:, 0])
    yield Curve("figure 5", "depth of the weakest point / b", chart.ratios, chart.y[:, 0], "dashed")
    marks = ratios if quick else ratios[::3]
    closed = [closed_weakest(r, 0.0) for r in marks]
    yield Curve("figure 5", "P/(bk), closed form", marks, [w.limit for w in closed], "points")
    yield Curve("figure 5", "depth, closed form", marks, [w.y for w in closed], "points")
    for k, ratio in enumerate(chart.ratios):
        name, about = f"{ratio:g}", {"colour": "black" if ratio else "tab:blue"}
        style = "line" if ratio else "dashed"
        yield Curve("figure 6", name, chart.frictions, chart.limit[k], style, about)
        below = chart.y[k] > 0.0
        yield Curve("figure 7", name, chart.x[k][below], chart.y[k][below])
    yield from elastic_limits(quick)


def elastic_limits(quick: bool) -> Iterator[Record]:
    """Elastic limits and weakest points of the general solver against closed forms."""
    pairs = [(r, f) for r in ((0.6,) if quick else (0.0, 0.1, 0.3, 0.6, 0.9)) for f in (0.1, 0.4)]
    closed = [closed_weakest(*pair) for pair in pairs]
    frictions, exact = [f for _, f in pairs], [w.limit for w in closed]
    yield Curve("figure 6 points", "closed form", frictions, list(exact), "points")
    below = [w for w in closed if w.y > PLACE]
    x, y = [w.x for w in below], [w.y for w in below]
    yield Curve("figure 7 points", "closed form", x, y, "points")
    yield checked(
        lambda found: largest(np.hypot(a.x - b.x, a.y - b.y) for a,
                              b in zip(found, closed, strict=True)),
        [weakest(*pair) for pair in pairs], [w._replace(x=w.x + 1e-5) for w in closed],
        what="Fig. 7: where the material yields first, general solver against closed form, largest "
             "distance / b", by="both packages",
        named="places off by 1e-5", high=PLACE,
    )  # fmt: skip
    sliding = (0.3, 0.4, 0.5)
    on_surface = [float(interior.hertz_limit_on_surface(friction=f, poisson=NU)) for f in sliding]
    yield Curve("figure 6 points", "Hertz on its surface", sliding, on_surface, "points")
    exact += on_surface
    found = np.array([limit(*pair) for pair in [*pairs, *((0.0, f) for f in sliding)]])
    yield checked(
        lambda values: float(np.abs(values / exact - 1).max()), found, found * (1 + 1e-9),
        what="Figs 5, 6: elastic limits of the general solver against those of the closed forms, "
             "largest relative difference",
        by="both packages", named="limits off by 1e-9", high=SAME,
    )  # fmt: skip


def figure_8(quick: bool) -> Iterator[Record]:
    worst = spoiled = 0.0
    for ratio in (0.0, 0.2, 0.4, 0.6, 0.8, 0.9):
        c = np.linspace(0.0, 1.0, 21 if quick else 61)
        yield Curve("figure 8", f"{ratio:g}", c, charts.surface_tension(ratio, c))
        marks = np.array([0.0, *(ratio + (1 - ratio) * np.array([0.15, 0.4, 0.7, 0.9]))])
        exact = closed_tension(ratio, marks)
        found = charts.surface_tension(ratio, marks)
        worst = largest((worst, float(np.abs(found - exact).max() / exact.max())))
        spoiled = largest((spoiled, float(np.abs(found * (1 + 1e-11) - exact).max() / exact.max())))
        yield Curve("figure 8 points", f"{ratio:g}", marks, exact, "points")
    yield Claim("Fig. 8: largest tension against 2f [E*(b-a)/2R - F_c(b)], largest difference over "
                "the largest", "both packages", worst,
                spoiled, "tensions off by 1e-11", high=BAR)  # fmt: skip
