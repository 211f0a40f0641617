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
PER_HALF_WIDTH = (10, 20, 40)
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
    return named | {"sxx less a uniform stress": found.differences["sxx"].l2_uniform}


def main() -> None:
    results = {}
    with tempfile.TemporaryDirectory() as name:
        for title, scene in SCENES.items():
            for count in PER_HALF_WIDTH:
                results[title, count] = found = studied(Path(name), scene, count)
                table = "  ".join(f"{n} {e:.1e}" for n, e in errors(found).items())
                print(f"{title}, dx = r / {count}: {table}", flush=True)
                if scene.friction and count == 20:
                    picture = overlay(sie.solve(scene), found)
                    picture.savefig(HERE / "punch-compared.png", dpi=150)
    figure = Figure(figsize=(style.WIDTH, 2.6), dpi=200, layout="constrained")
    axes = figure.subplots()
    marks = {"p": "o", "q": "s", "sxx less a uniform stress": "^"}
    for title, colour in zip(SCENES, (style.BLUE, style.VERMILLION), strict=True):
        for quantity, mark in marks.items():
            values = [errors(results[title, n]).get(quantity) for n in PER_HALF_WIDTH]
            if quantity != "q" or SCENES[title].friction:
                label = f"{quantity}, {title}"
                axes.loglog(PER_HALF_WIDTH, values, mark + "-", color=colour, lw=0.9, ms=3, label=label)
    axes.set_xlabel("elements in the half-width of contact", fontproperties=style.font())
    axes.set_ylabel("relative error in $l_2$", fontproperties=style.font())
    axes.set_xticks(PER_HALF_WIDTH, [str(n) for n in PER_HALF_WIDTH])
    axes.minorticks_off()
    axes.legend(prop=style.font(style.SMALL), frameon=False)
    figure.savefig(HERE / "punch-convergence.png")


if __name__ == "__main__":
    main()
