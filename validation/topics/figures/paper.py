"""Figs 2 to 8 of the paper, drawn like the originals: lines from the general solver, points from
the closed forms.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from validation.harness.drawing import Figure, axes, labelled, legend
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    yield _lines(
        found,
        "figure 2",
        "x/b",
        "b p/P",
        "Fig. 2. Pressure for a/b = 0, 0.1, …, 0.9 (outermost peaks: largest a/b).",
        top=1.45,
    )
    yield _lines(
        found,
        "figure 3",
        "Q/(fP)",
        "c/b",
        "Fig. 3. Stick zone c/b against Q/(fP), for the a/b on the curves.",
        swap=True,
    )
    yield _contours(found)
    yield _limits(found)
    yield _lines(
        found,
        "figure 6",
        "f",
        "P/(bk)",
        "Fig. 6. Elastic limit in sliding, a/b on the right; dashed: Hertz. ν = 0.3.",
        names="right",
    )
    yield _places(found)
    yield _lines(
        found,
        "figure 8",
        "c/b",
        "π b σ_xx/(f P)",
        "Fig. 8. Largest surface tension against the stick zone, a/b on the left.",
        names="left",
    )


def _lines(
    found: Found,
    key: str,
    x: str,
    y: str,
    caption: str,
    *,
    swap: bool = False,
    names: str = "middle",
    top: float = 0.0,
) -> Figure:
    drawing, ax = axes()
    for curve in found.curves(key):
        u, v = (curve.y, curve.x) if swap else (curve.x, curve.y)
        dashed = curve.style == "dashed"
        ax.plot(u, v, "--" if dashed else "-", color="black", linewidth=1.1 if dashed else 0.8)
        k = {"right": -1, "left": 0, "middle": len(u) // 2}[names]
        if key != "figure 2":
            ax.annotate(
                curve.label,
                (u[k], v[k]),
                fontsize=7,
                va="center",
                ha="left",
                xytext=(2, 0),
                textcoords="offset points",
            )
    for curve in found.curves(key + " points"):
        u, v = (curve.y, curve.x) if swap else (curve.x, curve.y)
        ax.plot(u, v, ".", color="tab:red", markersize=3.5)
    labelled(ax, x, y)
    ax.set_ylim(0.0, top or None)
    return Figure(
        key.replace(" ", "-"), drawing, caption + " Lines: general solver; red: closed form."
    )


def _contours(found: Found) -> Figure:
    maps = found.maps("figure 4")
    drawing, panels = axes(len(maps), height=2.75)
    for ax, chart in zip(panels, maps, strict=True):
        values = np.array(chart.values, dtype=float)
        levels = np.linspace(0.0, values.max(), 13)[1:]
        ax.contour(chart.x, chart.y, values, levels=levels, linewidths=0.7, cmap="viridis")
        ax.plot(*chart.about["weakest"], "x", color="tab:red")
        labelled(ax, "x/b", "y/b", f"{chart.about['title']}: largest {values.max():.3f}")
        ax.set(aspect="equal", ylim=(2.0, -0.05))
    return Figure(
        "figure-4",
        drawing,
        "Fig. 4. b √J2/P under the punch in sliding, ν = 0.3, in twelfths of the largest; the "
        "weakest point.",
    )


def _limits(found: Found) -> Figure:
    limit, depth, points, deep = found.curves("figure 5")
    drawing, ax = axes()
    ax.plot(limit.x, limit.y, "k-", label=limit.label)
    ax.plot(points.x, points.y, ".", color="tab:red", label=points.label)
    ax.axhline(limit.y[0], color="black", linewidth=0.6, linestyle=":")
    labelled(ax, "a/b", "P/(bk)")
    ax.set_ylim(0.0, 6.5)
    other = ax.twinx()
    other.plot(depth.x, depth.y, "--", color="tab:blue", label=depth.label)
    other.plot(deep.x, deep.y, ".", color="tab:orange", label=deep.label)
    other.set(ylabel="depth y/b", ylim=(0.0, 1.0))
    other.spines[["top"]].set_visible(False)
    ax.legend(
        *(
            a + b
            for a, b in zip(
                ax.get_legend_handles_labels(), other.get_legend_handles_labels(), strict=True
            )
        ),
        fontsize=8,
        frameon=False,
    )
    return Figure(
        "figure-5",
        drawing,
        "Fig. 5. Elastic limit in normal indentation, and the depth at which it is reached; "
        "dotted: Hertz. ν = 0.3.",
    )


def _places(found: Found) -> Figure:
    drawing, ax = axes()
    for curve in found.curves("figure 7"):
        ax.plot(curve.x, curve.y, "+-", markersize=4, linewidth=0.5, label=curve.label)
    for curve in found.curves("figure 7 points"):
        ax.plot(
            curve.x,
            curve.y,
            "o",
            color="tab:red",
            markersize=6,
            mfc="none",
            zorder=4,
            label=curve.label,
        )
    labelled(ax, "x/b", "y/b")
    ax.set_ylim(0.9, 0.0)
    legend(ax, title="a/b", ncols=3, loc="upper left")
    caption = (
        "Fig. 7. Where the material yields first below the surface, as f grows (each cross a "
        "step), for each a/b. ν = 0.3."
    )
    return Figure("figure-7", drawing, caption)
