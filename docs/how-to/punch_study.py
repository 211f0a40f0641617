"""The mesh study of verify-a-mesh.md: its tables and its pictures. Needs CalculiX (ccx).

python docs/how-to/punch_study.py
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure
from punch_deck import deck, run

import sie
from sie.io.mesh_comparison import compare
from sie.io.mesh_result import read_mesh
from sie.plots import style
from sie.plots.comparison_plot import overlay

HERE = Path(__file__).parent
PER_HALF_WIDTH = (10, 20, 40, 80)
UNIFORM = "sxx less a uniform stress"
PUNCH = sie.Scene(
    profile=sie.RoundedFlat(half_flat=0.4, radius=20.0),
    body=sie.Elastic(young=210e3, poisson=0.3),
    normal_load=2286.558,
)
SCENES = {
    "without friction": PUNCH,
    "friction 0.3": replace(PUNCH, friction=0.3, tangential_load=343.0),
}


def studied(folder: Path, scene: sie.Scene, count: int):
    """The comparison of the mesh with `count` elements in the half-width."""
    file = folder / f"punch-{count}-{scene.friction}.inp"
    file.write_text(deck(scene, count), encoding="utf-8")
    return compare(sie.solve(scene), read_mesh(run(file)), tol=1e-2)


def errors(found) -> dict[str, float]:
    """The l2 error of each quantity, and of σ_xx without a uniform stress."""
    named = {name: difference.l2 for name, difference in found.differences.items()}
    return named | {UNIFORM: found.differences["sxx"].l2_uniform}


def surface_table(found) -> str:
    """The nodes of the surface that can touch, as ParaView exports them."""
    (x, _, p), (_, _, q) = found.mesh.points("p"), found.mesh.points("q")
    beside, depth, stress = found.mesh.points("sxx")
    sxx = dict(zip(beside[depth == 0.0], stress[depth == 0.0], strict=True))
    rows = [f"{a:g},0,{b:.6g},{-c:.6g},{sxx[a]:.6g}" for a, b, c in zip(x, p, q, strict=True)
            if abs(a) < 1.4]  # fmt: skip
    header = '"Points:0","Points:1","CONTACT:CPRESS","CONTACT:CSHEAR1","S:XX"'
    return "\n".join([header, *rows]) + "\n"


def convergence(results) -> Figure:
    """The errors over the number of elements."""
    figure = Figure(figsize=(style.WIDTH, 3.2), dpi=200, layout="constrained")
    axes = figure.subplots()
    style.plain(axes)
    marks = {"p": ("o", "$p$"), "q": ("s", "$q$"), UNIFORM: ("^", r"$\sigma_{xx}$ less a stress")}
    for title, colour in zip(SCENES, (style.BLUE, style.VERMILLION), strict=True):
        for quantity, (mark, symbol) in marks.items():
            if quantity == "q" and not SCENES[title].friction:
                continue
            values = [results[title, n][quantity] for n in PER_HALF_WIDTH]
            label = f"{symbol}, {title}"
            axes.plot(PER_HALF_WIDTH, values, mark + "-", color=colour, lw=0.9, ms=3, label=label)
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("elements in the half-width of contact", fontproperties=style.font())
    axes.set_ylabel("relative error in $l_2$", fontproperties=style.font())
    axes.set_xticks(PER_HALF_WIDTH, [str(n) for n in PER_HALF_WIDTH])
    ticks = (0.005, 0.01, 0.02, 0.05, 0.1)
    axes.set_yticks(ticks, [f"{t:g}" for t in ticks])
    axes.minorticks_off()
    style.legend(axes, columns=2)
    return figure


def main() -> None:
    results = {}
    with tempfile.TemporaryDirectory() as name:
        for title, scene in SCENES.items():
            for count in PER_HALF_WIDTH:
                found = studied(Path(name), scene, count)
                results[title, count] = errors(found)
                table = "  ".join(f"{n} {e:.1e}" for n, e in errors(found).items())
                print(f"{title}, dx = r / {count}: {table}", flush=True)
                if scene.friction and count == 20:
                    drawn = replace(found, differences=dict(list(found.differences.items())[:4]))
                    overlay(sie.solve(scene), drawn).savefig(HERE / "punch-compared.png", dpi=110)
                    table = surface_table(found)
                    (HERE / "punch-surface.csv").write_text(table, encoding="utf-8")
    convergence(results).savefig(HERE / "punch-convergence.png")


if __name__ == "__main__":
    main()
