"""The figures of `validation.topics.spence`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    drawing, ax = axes()
    chart = found.maps("chart")[0]
    levels = [0.01, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 0.99]
    lines = ax.contour(chart.x, chart.y, chart.values, levels=levels, cmap="viridis_r")
    ax.clabel(lines, fmt="%g", fontsize=8)
    labelled(ax, "Dundurs' β", "coefficient of friction f")
    yield Figure(
        "chart",
        drawing,
        "The stick zone's part of the contact, under any symmetric convex profile.",
    )
    for name, x, y, log, caption in (
        ("stick ratio", "Dundurs' β", "c/b", "", "The stick zone's part of the contact."),
        (
            "grid", "cells in the half-width", "error of the load", "xy",
            "The load of a parabola, β = f = 0.3, by the printed equations on a grid, compared "
            "with the coupled answer and with Goodman's approximation.",
        ),
        (
            "Goodman", "Dundurs' β = f", "relative error", "xy",
            "Goodman's approximation against the coupled answer.",
        ),
        (
            "coupled zones", "Q/(f P)", "x/b", "",
            "Edges of contact and stick of a parabola under Q, β = f = 0.3, coupled.",
        ),
        (
            "tangential", "Q/(f P)", "x/b", "",
            "The stick zone of a parabola under Q, β = f = 0.1, in Goodman's approximation.",
        ),
    ):  # fmt: skip
        drawing, ax = axes()
        draw(ax, found.curves(name))
        labelled(ax, x, y, log=log)
        legend(ax)
        yield Figure(name.replace(" ", "-"), drawing, caption)
