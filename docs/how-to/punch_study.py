"""The mesh study of verify-a-mesh.md: its table and its pictures. Needs CalculiX (ccx).

python docs/how-to/punch_study.py
"""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from punch_deck import deck, run

import sie
from sie.io.mesh_comparison import EXACT, Comparison, compare
from sie.io.mesh_result import read_mesh
from sie.plots import style
from sie.plots.comparison_plot import overlay

HERE = Path(__file__).parent
TABLE = HERE / "punch-study.csv"
PER_HALF_WIDTH = (10, 20, 40, 80)
ENDS = {False: "60 half-widths", True: "exact ends"}
PUNCH = sie.Scene(
    profile=sie.RoundedFlat(half_flat=0.4, radius=2000.0),
    body=sie.Elastic(young=210e3, poisson=0.3),
    normal_load=22.86558,
)
SCENES = {
    "without friction": PUNCH,
    "friction 0.3": replace(PUNCH, friction=0.3, tangential_load=3.43),
}
STRESSES = ("p", "q", "sxx", "syy", "sxy", "mises")


def studied(folder: Path, scene: sie.Scene, count: int, exact: bool) -> Comparison:
    """The comparison of the mesh with `count` elements in the half-width."""
    file = folder / f"punch-{count}-{scene.friction}-{exact}.inp"
    file.write_text(deck(scene, count, exact=exact), encoding="utf-8")
    return compare(sie.solve(scene), read_mesh(run(file)), tol=1e-2)


def of_peak(scene: sie.Scene, found: Comparison) -> dict[str, float]:
    """The root mean square of the error near the contact, over the peak, of each quantity."""
    solution, errors = sie.solve(scene), {}
    values = {}
    for name in found.mesh.fields:
        x, y, mesh = found.mesh.fields[name]
        values[name] = mesh, EXACT[name](solution, x, y)
    values["mises"] = [mises(*(values[n][k] for n in ("sxx", "syy", "szz", "sxy"))) for k in (0, 1)]
    for name in STRESSES:
        mesh, exact = values[name]
        if exact.any():
            errors[name] = float(np.sqrt(np.mean((mesh - exact) ** 2)) / np.abs(exact).max())
    return errors


def mises(xx, yy, zz, xy):
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2)


def surface_table(found) -> str:
    """The nodes of the surface that can touch, as ParaView exports them."""
    (x, _, p), (_, _, q) = (found.mesh.fields[name] for name in "pq")
    beside, depth, stress = found.mesh.fields["sxx"]
    sxx = dict(zip(beside[depth == 0.0], stress[depth == 0.0], strict=True))
    rows = [f"{a:g},0,{b:.6g},{-c:.6g},{sxx[a]:.6g}" for a, b, c in zip(x, p, q, strict=True)
            if abs(a) < 1.4]  # fmt: skip
    header = '"Points:0","Points:1","CONTACT:CPRESS","CONTACT:CSHEAR1","S:XX"'
    return "\n".join([header, *rows]) + "\n"


def stored() -> dict[tuple[str, bool, int], dict[str, float]]:
    """The errors of a study, as `main` wrote them: by scene, whether ends are exact, and mesh."""
    with TABLE.open(encoding="utf-8") as stream:
        rows = [*csv.DictReader(stream)]
    results: dict[tuple[str, bool, int], dict[str, float]] = {}
    for row in rows:
        key = row["scene"], row["ends"] == ENDS[True], int(row["elements"])
        results.setdefault(key, {})[row["quantity"]] = float(row["error"])
    return results


def convergence(results: dict, counts=PER_HALF_WIDTH) -> Figure:
    """The errors of σ_xx, σ_yy and the Mises stress over the number of elements."""
    figure = Figure(figsize=(1.7 * style.WIDTH, 2.8), dpi=200, layout="constrained")
    for axes, title in zip(figure.subplots(1, len(SCENES), sharey=True), SCENES, strict=True):
        style.plain(axes)
        marks = {"sxx": ("^", r"$\sigma_{xx}$"), "syy": ("s", r"$\sigma_{yy}$")}
        marks |= {"mises": ("o", "Mises")}
        for exact, colour in ((False, style.VERMILLION), (True, style.BLUE)):
            for quantity, (mark, symbol) in marks.items():
                values = [results[title, exact, n][quantity] for n in counts]
                label = f"{symbol}, {ENDS[exact]}"
                axes.plot(counts, values, mark + "-", color=colour, lw=0.9, ms=3, label=label)
        axes.set(xscale="log", yscale="log")
        axes.set_title(title, fontproperties=style.font())
        axes.set_xlabel("elements in the half-width of contact", fontproperties=style.font())
        axes.set_xticks(counts, [str(n) for n in counts])
        ticks = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05)
        axes.set_yticks(ticks, [f"{t:g}" for t in ticks])
        axes.minorticks_off()
    figure.axes[0].set_ylabel("error / peak, root mean square", fontproperties=style.font())
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right center", prop=style.font(), frameon=False)
    return figure


def study(
    counts=PER_HALF_WIDTH, scenes=tuple(SCENES), ends=tuple(ENDS)
) -> Iterator[tuple[tuple[str, bool, int], Comparison, dict[str, float]]]:
    """(scene, whether ends are exact, elements), its comparison and its errors, one by one."""
    with tempfile.TemporaryDirectory() as name:
        for title in scenes:
            for exact in ends:
                for count in counts:
                    found = studied(Path(name), SCENES[title], count, exact)
                    yield (title, exact, count), found, of_peak(SCENES[title], found)


def main() -> None:
    results = {}
    for key, found, errors in study():
        title, exact, count = key
        results[key] = errors
        table = "  ".join(f"{n} {e:.1e}" for n, e in errors.items())
        print(f"{title}, {ENDS[exact]}, dx = r / {count}: {table}", flush=True)
        if SCENES[title].friction and count == 20 and exact:
            drawn = replace(found, differences=dict(list(found.differences.items())[:4]))
            figure = overlay(sie.solve(SCENES[title]), drawn)
            figure.savefig(HERE / "punch-compared.png", dpi=110)
            (HERE / "punch-surface.csv").write_text(surface_table(found), encoding="utf-8")
    lines = ["scene,ends,elements,quantity,error"]
    lines += [
        f"{title},{ENDS[exact]},{count},{quantity},{error:.3e}"
        for (title, exact, count), errors in results.items()
        for quantity, error in errors.items()
    ]
    TABLE.write_text("\n".join([*lines, ""]), encoding="utf-8")
    convergence(results).savefig(HERE / "punch-convergence.png")


if __name__ == "__main__":
    main()
