"""The figures of `validation.topics.stability`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from validation.harness.drawing import Figure, axes, draw, heat, labelled, legend, legend_above
from validation.harness.records import Found
from validation.topics.stability import BAR, FLATNESS

STATES = {"full": "tab:green", "known": "gold", "lost": "tab:red"}


def figures(found: Found) -> Iterator[Figure]:
    yield _frontier(found)
    yield from _sweeps(found)
    yield from _maps(found)
    drawing, ax = axes()
    draw(ax, found.curves("condition"))
    labelled(ax, "unknowns n", "condition number (2-norm)", log="xy")
    legend(ax)
    caption = "Condition numbers of the square systems; the transform that β = 0 allows needs none."
    yield Figure("condition", drawing, caption)


def _sweeps(found: Found) -> Iterator[Figure]:
    for key in found.keys("sweep: "):
        curves = found.curves(key)
        drawing, ax = axes(height=2.9)
        draw(ax, curves, floor=1e-18)
        ax.axhline(BAR, color="tab:red", linewidth=0.8)
        ax.axvspan(*curves[0].about["promised"], color="tab:green", alpha=0.07, linewidth=0)
        labelled(
            ax, curves[0].about["axis"], "relative error", key.removeprefix("sweep: "), log="y"
        )
        legend(ax)
        name = "".join(c if c.isalnum() else "-" for c in key)
        yield Figure(
            name,
            drawing,
            "Shaded: the promised range. Line: the bar, 1e-13. A gap in a curve is a refusal.",
        )


def _maps(found: Found) -> Iterator[Figure]:
    for key, x, y, caption in (
        (
            "map: kink", FLATNESS, "decades of the distance to the kink",
            "Pressure next to the end of the flat, / peak.",
        ),
        (
            "map: scale", "decades of the length", "decades of the modulus",
            "The same contact at any scale: error of p / peak.",
        ),
    ):  # fmt: skip
        drawing, ax = axes()
        heat(ax, found.maps(key)[0], label="log10 of the error", high=-12)
        labelled(ax, x, y, key.removeprefix("map: "))
        yield Figure("map-" + key[5:], drawing, caption)


def _frontier(found: Found) -> Figure:
    keys = found.keys("sweep: ")
    drawing, ax = axes(height=0.33 * len(keys) + 1.3, head=0.4)
    for row, key in enumerate(keys):
        curve = found.curves(key)[0]
        x, states = np.array(curve.x), np.array(curve.about["states"])
        for state, colour in STATES.items():
            some = states == state
            ax.plot(
                _compressed(x[some]),
                np.full(some.sum(), row),
                "s",
                color=colour,
                ms=5,
                label=state if row == 0 else None,
            )
        ax.plot(
            _compressed(np.array(curve.about["promised"])),
            [row - 0.32] * 2,
            color="black",
            lw=1.2,
            label=None if row else "promised",
        )
    ax.set_yticks(range(len(keys)), [key.removeprefix("sweep: ") for key in keys])
    ticks = np.array([-300, -100, -15, 0, 15, 100, 300])
    ax.set_xticks(_compressed(ticks), [str(t) for t in ticks])
    labelled(ax, "decades, on a compressed axis", "")
    legend_above(ax, 4)
    return Figure(
        "frontier", drawing,
        "How far each number can be taken. Green: full accuracy; yellow: refused, or the "
        "certificate shows it; red: lost, and not stated. "
        "Below each row, what is promised.",
    )  # fmt: skip


def _compressed(decades: Any) -> Any:
    return np.sign(decades) * np.abs(decades) ** 0.4
