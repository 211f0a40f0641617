"""The figures of `validation.topics.sampled`."""

from __future__ import annotations

from collections.abc import Iterator

from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    for key, x, y, log, caption in (
        (
            "spline",
            "x",
            "p/E*",
            "",
            "Pressure under a profile known by samples, against 40 digits on the same spline.",
        ),
        (
            "growth",
            "samples and points",
            "time [ms]",
            "xy",
            "Solving a trace and asking for as many pressures as it has samples.",
        ),
        (
            "trace",
            "x/R",
            "height less x²/2, over R",
            "",
            "A trace with noise, and the smoothing spline chosen by cross validation; some points.",
        ),
        ("noise", "x/R", "p/E*", "", "The pressure under the trace with noise, against Hertz."),
    ):
        drawing, ax = axes()
        draw(ax, found.curves(key))
        labelled(ax, x, y, log=log)
        legend(ax)
        yield Figure("sampled-" + key, drawing, caption)
