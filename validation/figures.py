"""The paper's Figs 4 to 8 computed anew: its claims with what they measure, and the time of each chart.

`python -m validation.figures FOLDER` draws them (needs Matplotlib).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sie import charts

FIGURE_4 = ((0.3, 0.0), (0.3, 0.3), (0.55, 0.0), (0.55, 0.3), (0.8, 0.0), (0.8, 0.3))
STICK = np.linspace(0.0, 1.0, 61)
TENSION_RATIOS = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9)


@dataclass(frozen=True)
class Row:
    case: str
    paper: str
    measured: str
    seconds: float


def rows(quick: bool = False) -> Iterator[Row]:
    """What the paper says of each figure, and what comes out; `quick` leaves out the whole of Fig. 6."""
    start = time.perf_counter()
    chart = charts.elastic_limits(frictions=(0.0,))
    limit = chart.limit[:, 0] / chart.limit[0, 0]
    stronger = max(a for a, v in zip(chart.ratios, limit, strict=True) if v > 1.0)
    yield Row("Fig. 5: stronger than Hertz up to a/b", "0.55", f"{stronger:g} of steps of 0.05", time.perf_counter() - start)
    yield Row("Fig. 5: strength at a/b = 0.9 over Hertz", "almost halved", f"{limit[-1]:.4f}", 0.0)
    if not quick:
        start = time.perf_counter()
        chart = charts.elastic_limits()
        jump = chart.frictions[int((chart.y[0] == 0.0).argmax())]
        yield Row("Fig. 6, 19 x 41: Hertz yields on the surface from f", "about 0.3", f"{jump:g}", time.perf_counter() - start)
    start = time.perf_counter()
    tension = charts.surface_tension(0.8, [0.0]) / charts.surface_tension(0.0, [0.0])
    yield Row("Fig. 8: concentration at a/b = 0.8 over Hertz", "only double", f"{tension[0]:.4f}", time.perf_counter() - start)


def table(found: list[Row]) -> str:
    """Markdown."""
    lines = ["| figure | paper | measured | time |", "| --- | --- | --- | --- |"]
    return "\n".join(lines + [f"| {r.case} | {r.paper} | {r.measured} | {r.seconds:.2f} s |" for r in found])


def as_json(found: list[Row]) -> list[dict[str, Any]]:
    return [asdict(r) for r in found]


# -- drawing -----------------------------------------------------------------------------------------------------------


def draw(folder: Path) -> list[Path]:
    """Figs 4 to 8 as PNG files."""
    from matplotlib.figure import Figure  # noqa: PLC0415

    written = []
    chart = charts.elastic_limits()
    for name, panels, size, paint in (
        ("figure-4", (3, 2), (7.0, 7.5), _contours),
        ("figure-5", (1, 1), (4.0, 3.2), lambda axes: _normal(axes, chart)),
        ("figure-6", (1, 1), (4.5, 4.5), lambda axes: _sliding(axes, chart)),
        ("figure-7", (1, 1), (4.5, 3.5), lambda axes: _places(axes, chart)),
        ("figure-8", (1, 1), (4.5, 3.5), _tension),
    ):
        figure = Figure(figsize=size, dpi=150, layout="constrained")
        paint(figure.subplots(*panels, squeeze=False).ravel())
        written.append(folder / f"{name}.png")
        figure.savefig(written[-1])
    return written


def _contours(axes: Any) -> None:
    x, y = np.linspace(-2.0, 2.0, 161), np.linspace(0.0, 2.0, 81)
    for ax, (ratio, f) in zip(axes, FIGURE_4, strict=True):
        drawn = ax.contour(x, y, charts.yield_parameter(ratio, f, x, y[:, None]), levels=12, linewidths=0.7)
        ax.clabel(drawn, fontsize=6)
        (place,) = charts.punch(ratio, f).elastic_limit().places[-1:]
        ax.plot(*place, "kx")
        ax.set(title=f"$a/b$ = {ratio:g}, $f$ = {f:g}", xlabel="$x/b$", ylabel="$y/b$", aspect="equal", ylim=(2.0, -0.05))


def _normal(axes: Any, chart: charts.ElasticLimits) -> None:
    (ax,) = axes
    ax.plot(chart.ratios, chart.limit[:, 0], "k-", label="$P/(bk)$")
    ax.axhline(chart.limit[0, 0], color="k", linestyle=":")
    ax.set(xlabel="$a/b$", ylabel="$P/(bk)$", ylim=(0.0, None))
    depth = ax.twinx()
    depth.plot(chart.ratios, chart.y[:, 0], "b--")
    depth.set(ylabel="depth of the weakest point, $y/b$", ylim=(0.0, None))


def _sliding(axes: Any, chart: charts.ElasticLimits) -> None:
    (ax,) = axes
    for ratio, limit in zip(chart.ratios, chart.limit, strict=True):
        ax.plot(chart.frictions, limit, "k--" if ratio == 0.0 else "k-", linewidth=0.8)
        ax.annotate(f"{ratio:g}", (chart.frictions[-1], limit[-1]), fontsize=6, va="center")
    ax.set(xlabel="$f$", ylabel="$P/(bk)$", ylim=(0.0, None))


def _places(axes: Any, chart: charts.ElasticLimits) -> None:
    (ax,) = axes
    for ratio, x, y in zip(chart.ratios, chart.x, chart.y, strict=True):
        below = y > 0.0
        ax.plot(x[below], y[below], "+-", markersize=4, linewidth=0.5)
        ax.annotate(f"{ratio:g}", (x[below][-1], y[below][-1]), fontsize=6)
    ax.set(xlabel="$x/b$", ylabel="$y/b$", ylim=(0.9, 0.0))


def _tension(axes: Any) -> None:
    (ax,) = axes
    for ratio in TENSION_RATIOS:
        ax.plot(STICK, charts.surface_tension(ratio, STICK), label=f"{ratio:g}")
    ax.set(xlabel="$c/b$", ylabel=r"$\sigma_{xx}\,\pi b/(f P)$", ylim=(0.0, None))
    ax.legend(title="$a/b$", fontsize=7)


if __name__ == "__main__":
    for path in draw(Path(sys.argv[1] if len(sys.argv) > 1 else ".")):
        print(path)
