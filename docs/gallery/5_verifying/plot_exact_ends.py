"""
A mesh of four half-widths with exact ends
==========================================

CalculiX beside the exact contact: where the ends of the blocks have the displacements of
half-planes, blocks of four half-widths give better stresses than blocks of sixty. The mesh study of
the how-to page "Verify a mesh" is drawn anew from its table; where CalculiX is installed, one mesh
is run and compared here.
"""

# sphinx_gallery_thumbnail_number = 2
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import sie
from sie.io.calculix_deck import deck
from sie.io.mesh_comparison import compare
from sie.io.mesh_result import read_mesh

punch = sie.Scene(
    profile=sie.RoundedFlat(half_flat=0.4, radius=2000.0),
    body=sie.Elastic(young=210e3, poisson=0.3),
    half_width=1.0,
)
solution = sie.solve(punch)
box = solution.boundary_data(box=(-4.0, 4.0, 0.0, 4.0), spacing=0.25)
moved = 1e4  # times the displacement less that of the middle of the lower end
held = solution.displacement(0.0, 4.0)
fig, axes = plt.subplots(figsize=(5.6, 3.4), layout="constrained")
axes.plot(box.x, box.y, ".", color="0.6", label="nodes of the ends")
axes.quiver(
    *(box.x, box.y, moved * (box.values["u_x"] - held.x), moved * (box.values["u_y"] - held.y)),
    angles="xy",
    scale_units="xy",
    scale=1.0,
    width=0.003,
    color="C0",
)
axes.plot([-1, 1], [0, 0], color="C3", linewidth=3, label="contact")
axes.set(xlabel="x, mm", ylabel="depth y, mm", aspect="equal", xlim=(-4.8, 4.8), ylim=(4.4, -0.8))
fig.legend(loc="outside upper center", ncols=2)
plt.show()

# %%
# The study: root mean square error of stresses over their peak, on four meshes.
sys.path.insert(0, str(Path(sie.__file__).parents[1] / "docs" / "how-to"))
from punch_study import convergence, stored  # noqa: E402

convergence(stored())
plt.show()

# %%
# One mesh, run here.
if shutil.which("ccx"):
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "punch.inp").write_text(deck([solution], 10), encoding="utf-8")
        subprocess.run(["ccx", "punch"], cwd=folder, capture_output=True, check=True)
        found = compare(solution, read_mesh(Path(folder) / "punch.frd"), tol=1e-2)
    print(str(found).splitlines()[-2])
    x, _, mesh = found.mesh.fields["p"]
    fig, axes = plt.subplots(layout="constrained")
    fine = np.linspace(-1.0, 1.0, 801)
    axes.plot(fine, solution.pressure(fine), label="exact")
    axes.plot(x[abs(x) < 1.2], mesh[abs(x) < 1.2], "o", markersize=3, label="CalculiX, b/10")
    axes.set(xlabel="x, mm", ylabel="pressure, MPa")
    axes.legend()
    plt.show()
